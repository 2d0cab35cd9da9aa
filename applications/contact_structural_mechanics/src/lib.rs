//! Mortar contact.
