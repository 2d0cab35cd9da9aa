//! The yield stress over the equivalent plastic strain α, as properties give it.
//!
//! Without HARDENING_CURVE, σ_y is the sum of YIELD_STRESS, ISOTROPIC_HARDENING_MODULUS α and
//! (EXPONENTIAL_SATURATION_YIELD_STRESS − YIELD_STRESS)(1 − exp(−HARDENING_EXPONENT α)).
//! HARDENING_CURVE 3 is constant, 4 a polynomial up to a strain and constant or straight after it, 6 a broken line through
//! points. After the last strain of curves 4 and 6 the yield stress stays (Kratos softens there by FRACTURE_ENERGY); the
//! curves 0, 1, 2 and 5, which soften all along, are refused: results depend on the mesh.

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::{Properties, PropertyValue};

/// Yield stress over equivalent plastic strain; does not fall.
#[derive(Debug, Clone, PartialEq)]
pub enum Hardening {
    /// σ_y = σ_0 + H α + (σ_∞ − σ_0)(1 − exp(−δ α)).
    Saturating {
        /// Initial yield stress σ_0.
        yield_stress: f64,
        /// Slope H that lasts.
        modulus: f64,
        /// Yield stress σ_∞ that the exponential part tends to.
        saturation: f64,
        /// Rate δ of saturation.
        exponent: f64,
    },
    /// Straight between points (α, σ_y) of ascending α, constant after the last.
    Points(Vec<[f64; 2]>),
    /// σ_y = Σ c_k α^k up to `first`, straight with the slope `slope` up to `last`, constant after it.
    Polynomial {
        /// Coefficients c_k.
        coefficients: Vec<f64>,
        /// End of the polynomial.
        first: f64,
        /// End of the straight part.
        last: f64,
        /// Slope of the straight part.
        slope: f64,
    },
}

impl Hardening {
    /// The hardening that the properties describe.
    ///
    /// # Errors
    /// A constant that is missing or out of range, a curve that softens or does not exist.
    pub fn of(properties: &Properties) -> Result<Self> {
        let problem = |fact: String, remedy: &str| {
            Diagnostic::error("hardening", format!("{fact} of properties {}", properties.id))
                .at(properties.place.clone())
                .remedy(remedy)
        };
        let hardening = match properties.number("HARDENING_CURVE") {
            None => saturating(properties)?,
            Some(3.0) => Self::Points(vec![[0.0, yield_stress(properties)?]]),
            Some(4.0) => polynomial(properties)?,
            Some(6.0) => points(properties)?,
            Some(curve) => {
                let remedy = "use 3 (constant), 4 (polynomial) or 6 (points), or ISOTROPIC_HARDENING_MODULUS instead";
                let fact = if matches!(curve, 0.0 | 1.0 | 2.0 | 5.0) {
                    format!(
                        "HARDENING_CURVE {curve} softens, so that results depend on the mesh; it is not available. In Variables"
                    )
                } else {
                    format!("HARDENING_CURVE {curve} is unknown. In Variables")
                };
                return Err(problem(fact, remedy).into());
            }
        };
        if let Some(fact) = hardening.fault() {
            return Err(problem(fact, "give a positive yield stress that does not fall with plastic strain").into());
        }
        Ok(hardening)
    }

    /// Yield stress and its slope at the equivalent plastic strain `alpha`.
    pub fn at(&self, alpha: f64) -> (f64, f64) {
        match self {
            Self::Saturating { yield_stress, modulus, saturation, exponent } => {
                let (gain, decay) = (saturation - yield_stress, (-exponent * alpha).exp());
                (yield_stress + modulus * alpha + gain * (1.0 - decay), modulus + gain * exponent * decay)
            }
            Self::Points(points) => {
                let next = points.partition_point(|p| p[0] <= alpha);
                match (points.get(next.wrapping_sub(1)), points.get(next)) {
                    (Some(a), Some(b)) => {
                        let slope = (b[1] - a[1]) / (b[0] - a[0]);
                        (a[1] + slope * (alpha - a[0]), slope)
                    }
                    (Some(end), None) | (None, Some(end)) => (end[1], 0.0),
                    (None, None) => (0.0, 0.0),
                }
            }
            Self::Polynomial { coefficients, first, last, slope } => {
                let value = |x: f64| coefficients.iter().rev().fold((0.0, 0.0), |(p, d), c| (p * x + c, d * x + p));
                if alpha < *first {
                    return value(alpha);
                }
                let end = value(*first).0 + slope * (alpha.min(*last) - first);
                (end, if alpha < *last { *slope } else { 0.0 })
            }
        }
    }

    /// The fault that makes the curve unusable.
    fn fault(&self) -> Option<String> {
        let (start, _) = self.at(0.0);
        if !(start > 0.0 && start.is_finite()) {
            return Some(format!("the yield stress is {start}, not positive, in the Variables"));
        }
        let falls = match self {
            Self::Saturating { yield_stress, modulus, saturation, exponent } => {
                !(*modulus >= 0.0 && *exponent >= 0.0 && saturation >= yield_stress)
            }
            Self::Points(points) => !points.windows(2).all(|p| p[1][0] > p[0][0] && p[1][1] >= p[0][1]),
            Self::Polynomial { first, last, slope, .. } => {
                let sampled = |k: i32| self.at(first * f64::from(k) / 100.0).1 >= 0.0;
                !(*first >= 0.0 && last >= first && *slope >= 0.0 && (0..100).all(sampled))
            }
        };
        falls.then(|| "the yield stress falls with plastic strain in the Variables".to_owned())
    }
}

/// Constants that laws with hardening take; other programs ask for FRACTURE_ENERGY beside a curve.
pub const CONSTANTS: &[&str] = &[
    "YIELD_STRESS",
    "YIELD_STRESS_TENSION",
    "ISOTROPIC_HARDENING_MODULUS",
    "EXPONENTIAL_SATURATION_YIELD_STRESS",
    "HARDENING_EXPONENT",
    "HARDENING_CURVE",
    "CURVE_FITTING_PARAMETERS",
    "PLASTIC_STRAIN_INDICATORS",
    "TANGENCY_REGION2",
    "EQUIVALENT_STRESS_VECTOR_PLASTICITY_POINT_CURVE",
    "TOTAL_STRAIN_VECTOR_PLASTICITY_POINT_CURVE",
    "PLASTIC_STRAIN_VECTOR_PLASTICITY_POINT_CURVE",
    "FRACTURE_ENERGY",
    "SOFTENING_TYPE",
];

/// YIELD_STRESS, or YIELD_STRESS_TENSION where only that is given.
fn yield_stress(properties: &Properties) -> Result<f64> {
    match (properties.number("YIELD_STRESS"), properties.number("YIELD_STRESS_TENSION")) {
        (None, Some(value)) => Ok(value),
        _ => properties.require("YIELD_STRESS"),
    }
}

fn saturating(properties: &Properties) -> Result<Hardening> {
    let start = yield_stress(properties)?;
    let number = |name: &str| properties.number(name).unwrap_or(0.0);
    Ok(Hardening::Saturating {
        yield_stress: start,
        modulus: number("ISOTROPIC_HARDENING_MODULUS"),
        saturation: properties.number("EXPONENTIAL_SATURATION_YIELD_STRESS").unwrap_or(start),
        exponent: number("HARDENING_EXPONENT"),
    })
}

fn polynomial(properties: &Properties) -> Result<Hardening> {
    let coefficients = list(properties, "CURVE_FITTING_PARAMETERS")?.to_vec();
    let (first, last) = match list(properties, "PLASTIC_STRAIN_INDICATORS")? {
        [first, last] => (*first, *last),
        other => return Err(wrong_size(properties, "PLASTIC_STRAIN_INDICATORS", "2", other.len())),
    };
    let tangent = properties.number("TANGENCY_REGION2").is_some_and(|flag| flag != 0.0);
    let power = |(k, c): (usize, &f64)| k as f64 * c * first.powi(k as i32 - 1);
    let slope = if tangent { coefficients.iter().enumerate().skip(1).map(power).sum() } else { 0.0 };
    Ok(Hardening::Polynomial { coefficients, first, last, slope })
}

fn points(properties: &Properties) -> Result<Hardening> {
    const STRESS: &str = "EQUIVALENT_STRESS_VECTOR_PLASTICITY_POINT_CURVE";
    const TOTAL: &str = "TOTAL_STRAIN_VECTOR_PLASTICITY_POINT_CURVE";
    const PLASTIC: &str = "PLASTIC_STRAIN_VECTOR_PLASTICITY_POINT_CURVE";
    let stress = list(properties, STRESS)?;
    let total = properties.values.contains_key(TOTAL) && !properties.values.contains_key(PLASTIC);
    let strain = list(properties, if total { TOTAL } else { PLASTIC })?;
    if stress.is_empty() || strain.len() != stress.len() {
        return Err(wrong_size(properties, STRESS, "as many numbers as its strains", stress.len()));
    }
    let young = properties.require("YOUNG_MODULUS")?;
    let elastic = |s: f64| if total { s / young } else { 0.0 };
    let start = strain[0] - elastic(stress[0]);
    // the first point is where yielding begins, whatever round-off its total strain carries
    Ok(Hardening::Points(strain.iter().zip(stress).map(|(e, s)| [e - elastic(*s) - start, *s]).collect()))
}

fn list<'a>(properties: &'a Properties, name: &str) -> Result<&'a [f64]> {
    match properties.values.get(name) {
        Some(PropertyValue::Vector(values)) => Ok(values),
        _ => properties.require(name).map(|_| &[][..]),
    }
}

fn wrong_size(properties: &Properties, name: &str, wanted: &str, found: usize) -> zelus_core::diagnostics::Error {
    let fact = format!("{name} of properties {} has {found} numbers", properties.id);
    Diagnostic::error("wrong-size", fact).at(properties.place.clone()).remedy(format!("give {wanted}")).into()
}
