//! Isotropic elasticity: Lamé constants and the matrices of Hooke's law.

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::Properties;

use super::law::Matrix;
use crate::tensor::pairs;

/// Constants of an isotropic elastic material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elasticity {
    /// Young's modulus E.
    pub young: f64,
    /// Poisson's ratio ν.
    pub poisson: f64,
}

impl Elasticity {
    /// The constants YOUNG_MODULUS and POISSON_RATIO of the properties.
    ///
    /// # Errors
    /// A constant that is missing or out of range.
    pub fn of(properties: &Properties) -> Result<Self> {
        let young = properties.require("YOUNG_MODULUS")?;
        let poisson = properties.require("POISSON_RATIO")?;
        let problem = |name: &str, value: f64, range: &str| {
            Diagnostic::error("material-out-of-range", format!("{name} of properties {} is {value}", properties.id))
                .at(properties.place.clone())
                .remedy(format!("give a value {range}"))
        };
        if !(young > 0.0 && young.is_finite()) {
            return Err(problem("YOUNG_MODULUS", young, "above 0").into());
        }
        if !(poisson > -1.0 && poisson < 0.5) {
            return Err(problem("POISSON_RATIO", poisson, "between -1 and 0.5, both excluded").into());
        }
        Ok(Self { young, poisson })
    }

    /// First Lamé constant λ = Eν/((1 + ν)(1 − 2ν)).
    pub fn lambda(&self) -> f64 {
        self.young * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson))
    }

    /// Shear modulus μ = E/(2(1 + ν)).
    pub fn mu(&self) -> f64 {
        0.5 * self.young / (1.0 + self.poisson)
    }

    /// Hooke's matrix for solids, axial symmetry and plane strain: λ + 2μ, λ, μ.
    pub fn hooke<const S: usize>(&self) -> Matrix<S> {
        self.matrix(self.lambda())
    }

    /// Hooke's matrix for plane stress: the same with λ* = Eν/(1 − ν²).
    pub fn plane_stress(&self) -> Matrix<3> {
        self.matrix(self.lambda_of_plane_stress())
    }

    /// Hooke's matrix, that of plane stress where stress across the plane is free.
    pub fn in_form<const S: usize>(&self, stress_free: bool) -> Matrix<S> {
        self.matrix(if stress_free { self.lambda_of_plane_stress() } else { self.lambda() })
    }

    fn lambda_of_plane_stress(&self) -> f64 {
        self.young * self.poisson / (1.0 - self.poisson * self.poisson)
    }

    fn matrix<const S: usize>(&self, lambda: f64) -> Matrix<S> {
        let (pairs, mu) = (pairs::<S>(), self.mu());
        let mut d = [[0.0; S]; S];
        for s in 0..S {
            for t in 0..S {
                let normal = pairs[s].0 == pairs[s].1 && pairs[t].0 == pairs[t].1;
                d[s][t] = match (normal, s == t) {
                    (true, true) => lambda + 2.0 * mu,
                    (true, false) => lambda,
                    (false, true) => mu,
                    (false, false) => 0.0,
                };
            }
        }
        d
    }
}

/// `d · strain`.
pub(super) fn multiply<const S: usize>(d: &Matrix<S>, strain: &[f64; S]) -> [f64; S] {
    d.map(|row| row.iter().zip(strain).map(|(a, b)| a * b).sum())
}

/// ½ strain · d · strain.
pub(super) fn quadratic_energy<const S: usize>(d: &Matrix<S>, strain: &[f64; S]) -> f64 {
    0.5 * multiply(d, strain).iter().zip(strain).map(|(a, b)| a * b).sum::<f64>()
}
