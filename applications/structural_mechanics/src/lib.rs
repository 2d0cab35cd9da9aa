//! Structural mechanics.
