//! The differences between solid formulations.

use crate::laws::StressMeasure;

/// Strain measure and configuration of a solid element.
pub trait Formulation: Send + Sync + 'static {
    /// Whether strain is Green–Lagrange's of the moved mesh; otherwise the small strain of DISPLACEMENT.
    const FINITE: bool;

    /// Whether gradients and weights belong to the present configuration; otherwise to the initial one.
    const PRESENT: bool;

    /// Whether the dilatation is its mean over the element (B-bar); small strain only.
    const MEAN_DILATATION: bool = false;

    /// Whether the law leaves the volume to the element, which holds one pressure; finite strain only.
    const CONSTANT_PRESSURE: bool = false;

    /// Whether that pressure is linear in the coordinates instead of constant.
    const LINEAR_PRESSURE: bool = false;

    /// The stress that works on the strain: Cauchy on the present, Piola–Kirchhoff on the initial configuration.
    const MEASURE: StressMeasure = if Self::PRESENT { StressMeasure::Cauchy } else { StressMeasure::Pk2 };
}
