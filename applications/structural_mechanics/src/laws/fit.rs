//! Constants of hyperelastic materials from test data, by least squares.
//!
//! Minimised is Σ (w_i (P(λ_i) − P_i))² with the nominal stress P of the incompressible material in a homogeneous test
//! ([`super::stability`]) and w = 1, or 1/|P_i| for relative errors; by Levenberg's and Marquardt's iteration from several starts,
//! (JᵀJ + m diag JᵀJ) δ = −Jᵀr. Derivatives by the constants are central differences.

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::{Properties, PropertyValue};

use super::rubber::{Energy, EnergyKind};
use super::stability::{BiaxialResponse, HomogeneousTest};

/// Constants by name: a number is a list of one.
pub type Constants = Vec<(&'static str, Vec<f64>)>;

/// Largest number of iterations from one start.
const ITERATIONS: usize = 1000;
/// Step of differences over the size of a constant.
const STEP: f64 = 1e-5;
/// Damping at the start, and the damping that ends the iteration.
const DAMPING: [f64; 2] = [1e-3, 1e14];

/// Stretches and nominal stresses of a test.
#[derive(Debug, Clone, PartialEq)]
pub struct TestData {
    /// The test.
    pub test: HomogeneousTest,
    /// Stretch and force per initial area.
    pub points: Vec<[f64; 2]>,
}

/// Sizes from which an energy estimates its constants.
#[derive(Debug, Clone, Copy)]
pub struct FitStart {
    /// Shear modulus at small strains.
    pub modulus: f64,
    /// Largest I₁ of the data.
    pub invariant: f64,
    /// Number of terms that the user asks for.
    pub terms: Option<usize>,
}

/// Constants that fit test data.
pub struct Fit {
    /// The constants.
    pub constants: Constants,
    /// The energy with them.
    pub energy: Energy,
    /// Root mean square of P(λ_i) − P_i, over all data.
    pub residual: f64,
    /// The same over the root mean square of P_i.
    pub relative: f64,
}

/// An energy with given constants.
///
/// # Errors
/// Constants out of range.
pub fn energy_with(kind: &EnergyKind, constants: &Constants) -> Result<Energy> {
    let mut properties = Properties::new(1);
    for (name, values) in constants {
        let value = match values.as_slice() {
            [one] => PropertyValue::Number(*one),
            several => PropertyValue::Vector(several.to_vec()),
        };
        properties.values.insert((*name).to_owned(), value);
    }
    (kind.make)(&properties)
}

/// Constants of an energy that fit the data best.
///
/// # Errors
/// Too few data, an energy that is not fitted, or no constants that the iteration finds.
pub fn fit(kind: &EnergyKind, terms: Option<usize>, data: &[TestData], is_relative: bool) -> Result<Fit> {
    let problem = |fact: String, remedy: &str| Diagnostic::error("fit", fact).remedy(remedy.to_owned());
    let start = FitStart { modulus: shear_modulus(data), invariant: largest_invariant(data), terms };
    let starts = (kind.starts)(&start);
    let Some(first) = starts.first() else {
        let asked = terms.map_or_else(String::new, |terms| format!(" with {terms} terms"));
        let remedy = "fit HyperElasticMooneyRivlin (2 or 5 terms), …Ogden (1 to 6), …Yeoh, …ArrudaBoyce or …Gent";
        return Err(problem(format!("{}{asked} has no fit", kind.name), remedy).into());
    };
    let (count, unknowns) = (data.iter().map(|own| own.points.len()).sum::<usize>(), flat(first).len());
    if count < unknowns {
        let fact = format!("{count} points do not determine the {unknowns} constants of {}", kind.name);
        return Err(problem(fact, "give more points, or fewer terms").into());
    }
    let mut best: Option<(Vec<f64>, f64)> = None;
    for start in &starts {
        let residuals = |values: &[f64]| residuals(kind, &unflat(first, values), data, is_relative);
        let Some((values, sum)) = minimise(&residuals, flat(start)) else { continue };
        if best.as_ref().is_none_or(|(_, known)| sum < *known) {
            best = Some((values, sum));
        }
    }
    let found = best.map(|(values, _)| unflat(first, &values));
    let Some(constants) = found else {
        let fact = format!("no constants of {} fit the data", kind.name);
        return Err(problem(fact, "check that stresses grow with the stretch, and try another law").into());
    };
    let energy = energy_with(kind, &constants)?;
    let rms = |sum: f64| (sum / count as f64).sqrt();
    let errors = residuals(kind, &constants, data, false).unwrap_or_default();
    let residual = rms(errors.iter().map(|r| r * r).sum());
    let size = rms(data.iter().flat_map(|own| &own.points).map(|[_, stress]| stress * stress).sum());
    Ok(Fit { constants, energy, residual, relative: residual / size })
}

/// The stretches around 1, within `limits`, between which the incompressible material is stable in a test.
pub fn stable_stretches(energy: &Energy, test: HomogeneousTest, limits: [f64; 2]) -> [f64; 2] {
    const PARTS: i32 = 400;
    limits.map(|limit| {
        let stretch = |part: i32| limit.powf(f64::from(part) / f64::from(PARTS));
        let is_lost = |part: &i32| !BiaxialResponse::of(energy, test.stretches(stretch(*part))).is_stable();
        (1..=PARTS).find(is_lost).map_or(limit, |part| stretch(part - 1))
    })
}

fn flat(constants: &Constants) -> Vec<f64> {
    constants.iter().flat_map(|(_, values)| values.iter().copied()).collect()
}

fn unflat(like: &Constants, values: &[f64]) -> Constants {
    let mut rest = values;
    let each = like.iter().map(|(name, own)| {
        let (taken, others) = rest.split_at(own.len());
        rest = others;
        (*name, taken.to_vec())
    });
    each.collect()
}

/// Slope of the stress at small strains over that of the unit modulus: 3, 6 and 4 μ.
fn shear_modulus(data: &[TestData]) -> f64 {
    let slope = |test| match test {
        HomogeneousTest::Uniaxial => 3.0,
        HomogeneousTest::Equibiaxial => 6.0,
        HomogeneousTest::Planar => 4.0,
    };
    let points = data.iter().flat_map(|own| own.points.iter().map(move |point| (slope(own.test), point)));
    let mut each: Vec<(f64, f64)> = points
        .filter(|(_, [stretch, _])| *stretch != 1.0)
        .map(|(slope, [stretch, stress])| (stretch.ln().abs(), stress / (slope * stretch.ln())))
        .collect();
    each.sort_by(|a, b| a.0.total_cmp(&b.0));
    let near = each.len().div_ceil(4).max(1);
    let sum: f64 = each.iter().take(near).map(|(_, modulus)| modulus).sum();
    if sum > 0.0 { sum / near as f64 } else { 1.0 }
}

fn largest_invariant(data: &[TestData]) -> f64 {
    let of = |test: HomogeneousTest, stretch: f64| {
        let [a, b] = test.stretches(stretch);
        a * a + b * b + (a * b).powi(-2)
    };
    data.iter().flat_map(|own| own.points.iter().map(move |[stretch, _]| of(own.test, *stretch))).fold(3.0, f64::max)
}

/// Weighted differences between an energy and the data; `None` where the energy is not defined.
fn residuals(kind: &EnergyKind, constants: &Constants, data: &[TestData], is_relative: bool) -> Option<Vec<f64>> {
    let energy = energy_with(kind, constants).ok()?;
    let mut out = Vec::new();
    for own in data {
        for [stretch, stress] in &own.points {
            let weight = if is_relative && *stress != 0.0 { 1.0 / stress.abs() } else { 1.0 };
            out.push(weight * (own.test.nominal_stress(&energy, *stretch) - stress));
        }
    }
    out.iter().all(|r| r.is_finite()).then_some(out)
}

/// Values with the least sum of squared residuals near a start, and that sum.
fn minimise(residuals: &dyn Fn(&[f64]) -> Option<Vec<f64>>, start: Vec<f64>) -> Option<(Vec<f64>, f64)> {
    let square = |r: &[f64]| r.iter().map(|r| r * r).sum::<f64>();
    let mut values = start;
    let size = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let mut current = residuals(&values)?;
    let mut sum = square(&current);
    let mut damping = DAMPING[0];
    for _ in 0..ITERATIONS {
        let columns = jacobian(residuals, &values, size)?;
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let normal: Vec<Vec<f64>> = columns.iter().map(|a| columns.iter().map(|b| dot(a, b)).collect()).collect();
        let right: Vec<f64> = columns.iter().map(|a| -dot(a, &current)).collect();
        let before = sum;
        loop {
            let step = solve(&normal, &right, damping)?;
            let moved: Vec<f64> = values.iter().zip(&step).map(|(value, step)| value + step).collect();
            let tried = residuals(&moved).map(|r| (square(&r), r)).filter(|(tried, _)| *tried < sum);
            if let Some((lower, r)) = tried {
                (sum, current, values) = (lower, r, moved);
                damping = (0.1 * damping).max(1e-14);
                break;
            }
            damping *= 10.0;
            if damping > DAMPING[1] {
                return Some((values, sum));
            }
        }
        if before - sum <= 1e-15 * sum {
            break;
        }
    }
    Some((values, sum))
}

/// Derivatives of the residuals, a column for each value.
fn jacobian(residuals: &dyn Fn(&[f64]) -> Option<Vec<f64>>, values: &[f64], size: f64) -> Option<Vec<Vec<f64>>> {
    let column = |at: usize| {
        let h = STEP * values[at].abs().max(1e-3 * size);
        let moved = |by: f64| {
            let mut moved = values.to_vec();
            moved[at] += by;
            residuals(&moved)
        };
        let (plus, minus) = (moved(h)?, moved(-h)?);
        Some(plus.iter().zip(minus).map(|(a, b)| (a - b) / (2.0 * h)).collect())
    };
    (0..values.len()).map(column).collect()
}

/// Solution of (A + m diag A) x = b by Cholesky's method, A scaled to a unit diagonal.
fn solve(matrix: &[Vec<f64>], right: &[f64], damping: f64) -> Option<Vec<f64>> {
    let n = right.len();
    let scale: Vec<f64> = (0..n).map(|i| if matrix[i][i] > 0.0 { matrix[i][i].sqrt().recip() } else { 1.0 }).collect();
    let mut lower = vec![vec![0.0; n]; n];
    let mut x = vec![0.0; n];
    for i in 0..n {
        for j in 0..=i {
            let entry = matrix[i][j] * scale[i] * scale[j] + if i == j { damping } else { 0.0 };
            let rest = entry - (0..j).map(|k| lower[i][k] * lower[j][k]).sum::<f64>();
            if i == j && (rest <= 0.0 || rest.is_nan()) {
                return None;
            }
            lower[i][j] = if i == j { rest.sqrt() } else { rest / lower[j][j] };
        }
        x[i] = (right[i] * scale[i] - (0..i).map(|k| lower[i][k] * x[k]).sum::<f64>()) / lower[i][i];
    }
    for i in (0..n).rev() {
        x[i] = (x[i] - (i + 1..n).map(|k| lower[k][i] * x[k]).sum::<f64>()) / lower[i][i];
    }
    Some(x.iter().zip(&scale).map(|(x, scale)| x * scale).collect())
}
