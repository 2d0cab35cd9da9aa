//! Time spent on assembly.

/// Seconds spent assembling, by quantity.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct AssemblySeconds {
    /// Residuals.
    pub residual: f64,
    /// Tangents of elements.
    pub bulk: f64,
    /// Tangents of interactions.
    pub coupling: f64,
}
