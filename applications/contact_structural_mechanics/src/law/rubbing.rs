//! Friction of a slave node that its law of bonds or of friction by direction computes: elastic up to a limit.
//!
//! h = K e is the elastic slip e times the tangential stiffness K. The traction is r = D h with the matrix D of the
//! [ellipse](FrictionEllipse). It slides where √(h·D h) reaches the limit: the bound b, by which r lies on the ellipse, and the slip is
//! normal to it. The return along h is exact: D h is elastic with the stiffness K along a and ρ² K across it.
//!
//! With an elastic slip γ at the bound the limit is K γ, and r = b D h/(K γ), whatever the pressure.

use zelus_core::scalar::Real;
use zelus_core::vector3::{dot, value};

use super::friction_ellipse::FrictionEllipse;
use super::friction_law::Bound;
use crate::mortar::Active;

/// Friction by elastic slip and direction.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rubbing {
    /// Elastic slip γ at the bound (length); without it the stiffness alone limits it.
    pub elastic_slip: Option<f64>,
    /// Limit by direction.
    pub ellipse: FrictionEllipse,
}

/// Friction at an opening.
#[derive(Debug, Clone, Copy)]
pub struct Rubbed {
    /// Traction r (force per area).
    pub traction: [Active; 3],
    /// Elastic slip times stiffness h (force per area).
    pub elastic: [f64; 3],
    /// Whether it slides.
    pub slides: bool,
    /// Energy by area that it has dissipated.
    pub heat: f64,
}

impl Rubbed {
    /// Without friction.
    pub fn none() -> Self {
        Self { traction: [Active::zero(); 3], elastic: [0.0; 3], slides: true, heat: 0.0 }
    }
}

impl Rubbing {
    /// Friction with an elastic slip if nothing slid, times the `stiffness`, and the law's bound under a normal traction.
    pub fn at(&self, trial: [Active; 3], friction: Bound, normal: Active, stiffness: f64) -> Rubbed {
        let bound = friction.at(normal);
        if bound.value() <= 0.0 {
            return Rubbed::none();
        }
        let size = self.ellipse.square(trial);
        let (limit, share) = match self.elastic_slip {
            None => (bound, Active::constant(1.0)),
            Some(slip) => (Active::constant(stiffness * slip), bound / (stiffness * slip)),
        };
        let slides = size.value().sqrt() > limit.value();
        let kept = if slides { limit / size.sqrt() } else { Active::constant(1.0) };
        let elastic = trial.map(|h| h * kept);
        let traction = self.ellipse.product(elastic).map(|r| r * share);
        let slid: [f64; 3] = std::array::from_fn(|c| (trial[c].value() - elastic[c].value()) / stiffness);
        Rubbed { heat: dot(value(traction), slid), traction, elastic: value(elastic), slides }
    }
}
