//! Finite-element framework of zelus; it knows no physics and names no application.
pub mod diagnostics;
