//! zelus: the façade library.
