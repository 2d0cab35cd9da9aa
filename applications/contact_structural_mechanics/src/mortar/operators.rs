//! Mortar operators D and M of one pair, with dual shape functions built on the overlap of that pair.
//!
//! With N¹, N² the shape functions of slave and master: Me = ∫ N¹⊗N¹, De = ∫ diag N¹, Ae = De Me⁻¹, Φ = Ae N¹ and
//! D = ∫ Φ⊗N¹ = De, M = ∫ Φ⊗N² = Ae ∫ N¹⊗N². Integrals run over the cells of the overlap, current configuration.
//!
//! Where Me cannot be inverted, Φ = N¹ and D = Me is full. With the usual three points a triangle this is so for every
//! quadrilateral slave whose overlap is a single triangle: three points cannot tell four functions apart.

use super::choices::Choices;
use super::geometry::PairGeometry;
use super::points::{ExactMotion, MasterMotion, Point, Points};
use super::segmentation_3d::Polygon;
use super::settings::SegmentationSettings;
use super::shape;
use zelus_core::scalar::Real;
use zelus_core::vector3::value;

/// Share of the slave's measure below which an overlap is a sliver.
pub(crate) const SLIVER: f64 = 1e-5;
/// Condition number (Frobenius) of Me beyond which the plain shape functions serve as Φ.
const WORST_CONDITION: f64 = 1e-4 / f64::EPSILON;

/// The operators of a pair.
/// Row j belongs to the multiplier of slave node j; entries have the unit of a length (lines) or an area (surfaces).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Operators<T, const NS: usize, const NM: usize> {
    /// D_jk = ∫ Φ_j N¹_k; diagonal whenever the dual functions exist.
    pub d: [[T; NS]; NS],
    /// M_jl = ∫ Φ_j N²_l.
    pub m: [[T; NM]; NS],
}

/// Whether the facets of a pair face each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Overlap<O> {
    /// They do, on one or more cells.
    Cells(O),
    /// They do, on a negligible part: the pair contributes nothing, yet may when the bodies move on.
    Sliver,
    /// They do not: the pair contributes nothing.
    None,
}

impl<O> Overlap<O> {
    /// The operators, if any.
    pub fn cells(self) -> Option<O> {
        match self {
            Self::Cells(operators) => Some(operators),
            Self::Sliver | Self::None => None,
        }
    }
}

/// Computes D and M of a pair: 2–2 nodes in the plane, 3 or 4 nodes a side in space.
///
/// With dual numbers the gradients are exact derivatives of the values, through cells, points and dual functions, as
/// long as the kinds of the overlap's vertices do not change.
pub fn operators<T: Real, const NS: usize, const NM: usize>(
    pair: &PairGeometry<T, NS, NM>,
    settings: &SegmentationSettings,
) -> Overlap<Operators<T, NS, NM>> {
    operators_by(pair, settings, &ExactMotion)
}

/// The same with the derivatives of another motion of points on the master.
pub fn operators_by<T: Real, P: MasterMotion<T, NS>, const NS: usize, const NM: usize>(
    pair: &PairGeometry<T, NS, NM>,
    settings: &SegmentationSettings,
    motion: &P,
) -> Overlap<Operators<T, NS, NM>> {
    let mut sums = Sums::new();
    let covered = Points { pair, motion }.visit(settings, |point| sums.add_point(point));
    match covered {
        covered if covered > least_overlap(pair) => Overlap::Cells(sums.finish(pair.choices)),
        covered if covered > 0.0 => Overlap::Sliver,
        _ => Overlap::None,
    }
}

/// The choices that gave the operators `found` of a pair.
pub fn choices_of<const NS: usize, const NM: usize>(
    pair: &PairGeometry<f64, NS, NM>,
    settings: &SegmentationSettings,
    found: &Operators<f64, NS, NM>,
) -> Choices {
    let origin = || {
        // Intervals of the plane have no such choice.
        let polygon = if NS == 2 { None } else { Polygon::new(pair, settings) }?;
        Some(polygon.local(polygon.vertices()[0]))
    };
    Choices {
        origin: pair.choices.origin.or_else(origin),
        plain: pair.choices.plain || !found.is_diagonal(),
        slivers: true,
    }
}

/// Length or area above which an overlap counts.
pub(crate) fn least_overlap<T: Real, const NS: usize, const NM: usize>(pair: &PairGeometry<T, NS, NM>) -> f64 {
    if pair.choices.slivers { 0.0 } else { SLIVER * shape::measure(&pair.slave.map(value)) }
}

impl<T: Real, const NS: usize, const NM: usize> Operators<T, NS, NM> {
    /// No overlap at all.
    pub fn zero() -> Self {
        Self { d: [[T::zero(); NS]; NS], m: [[T::zero(); NM]; NS] }
    }

    /// The same operators in another scalar, without derivatives.
    pub fn as_constants<S: Real>(&self) -> Operators<S, NS, NM> {
        Operators {
            d: self.d.map(|row| row.map(|x| S::constant(x.value()))),
            m: self.m.map(|row| row.map(|x| S::constant(x.value()))),
        }
    }

    /// The same operators without derivatives.
    pub fn values(&self) -> Operators<f64, NS, NM> {
        self.as_constants()
    }

    /// The change since the operators `previous`.
    pub fn minus(&self, previous: &Operators<f64, NS, NM>) -> Self {
        Self {
            d: std::array::from_fn(|j| std::array::from_fn(|k| self.d[j][k] - previous.d[j][k])),
            m: std::array::from_fn(|j| std::array::from_fn(|l| self.m[j][l] - previous.m[j][l])),
        }
    }

    /// Whether D is diagonal, so that dual functions were in use.
    pub fn is_diagonal(&self) -> bool {
        (0..NS).all(|j| (0..NS).all(|k| j == k || self.d[j][k].value() == 0.0))
    }

    /// (D v¹ − M v²)_j, the weighted jump of a nodal vector field across the pair.
    #[inline]
    pub fn jump(&self, slave: &[[T; 3]; NS], master: &[[T; 3]; NM]) -> [[T; 3]; NS] {
        std::array::from_fn(|j| {
            let mut sum = [T::zero(); 3];
            for c in 0..3 {
                for k in 0..NS {
                    sum[c].add_product(self.d[j][k], slave[k][c]);
                }
                for l in 0..NM {
                    sum[c].add_product(-self.m[j][l], master[l][c]);
                }
            }
            sum
        })
    }
}

/// Integrals gathered over the cells: Me (upper triangle) and ∫ N¹⊗N².
struct Sums<T, const NS: usize, const NM: usize> {
    me: [[T; NS]; NS],
    mixed: [[T; NM]; NS],
}

impl<T: Real, const NS: usize, const NM: usize> Sums<T, NS, NM> {
    fn new() -> Self {
        Self { me: [[T::zero(); NS]; NS], mixed: [[T::zero(); NM]; NS] }
    }

    #[inline]
    fn add_point(&mut self, point: &Point<T, NS, NM>) {
        for j in 0..NS {
            let weighted = point.slave[j] * point.weight;
            for k in j..NS {
                self.me[j][k].add_product(weighted, point.slave[k]);
            }
            for l in 0..NM {
                self.mixed[j][l].add_product(weighted, point.master[l]);
            }
        }
    }

    /// D and M from the integrals.
    fn finish(mut self, choices: Choices) -> Operators<T, NS, NM> {
        for j in 0..NS {
            for k in 0..j {
                self.me[j][k] = self.me[k][j];
            }
        }
        let inverse = inverse(self.me.map(|row| row.map(T::value))).filter(|_| !choices.plain);
        let Some(inverse) = inverse else {
            return Operators { d: self.me, m: self.mixed };
        };
        // X = Me⁻¹ ∫ N¹⊗N² on values, then one correction, which brings the derivative.
        let mut solution = [[0.0; NM]; NS];
        for j in 0..NS {
            for l in 0..NM {
                solution[j][l] = (0..NS).map(|k| inverse[j][k] * self.mixed[k][l].value()).sum();
            }
        }
        let mut residual = self.mixed;
        for j in 0..NS {
            for l in 0..NM {
                for k in 0..NS {
                    residual[j][l].add_scaled(self.me[j][k], -solution[k][l]);
                }
            }
        }
        let mut operators = Operators::zero();
        for j in 0..NS {
            // The shape functions add up to one, so De is the row sum of Me.
            let mut de = self.me[j][0];
            (1..NS).for_each(|k| de += self.me[j][k]);
            operators.d[j][j] = de;
            for l in 0..NM {
                let mut x = T::constant(solution[j][l]);
                (0..NS).for_each(|k| x.add_scaled(residual[k][l], inverse[j][k]));
                operators.m[j][l] = de * x;
            }
        }
        operators
    }
}

/// Inverse by elimination with row exchanges; `None` if the matrix is too badly conditioned to trust it.
fn inverse<const N: usize>(matrix: [[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let frobenius = |m: &[[f64; N]; N]| m.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
    let mut work = matrix;
    let mut inverse: [[f64; N]; N] = std::array::from_fn(|j| std::array::from_fn(|k| f64::from(u8::from(j == k))));
    for pivot in 0..N {
        let best = (pivot..N).max_by(|&a, &b| work[a][pivot].abs().total_cmp(&work[b][pivot].abs()))?;
        work.swap(pivot, best);
        inverse.swap(pivot, best);
        let scale = 1.0 / work[pivot][pivot];
        work[pivot] = work[pivot].map(|x| x * scale);
        inverse[pivot] = inverse[pivot].map(|x| x * scale);
        for row in 0..N {
            let factor = work[row][pivot];
            if row != pivot && factor != 0.0 {
                for c in 0..N {
                    work[row][c] -= factor * work[pivot][c];
                    inverse[row][c] -= factor * inverse[pivot][c];
                }
            }
        }
    }
    // Written so that NaN counts as bad.
    (frobenius(&matrix) * frobenius(&inverse) < WORST_CONDITION).then_some(inverse)
}
