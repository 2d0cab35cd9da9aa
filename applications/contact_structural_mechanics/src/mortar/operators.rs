//! Mortar operators D and M of one pair, with dual shape functions built on the overlap of that pair.
//!
//! With N¹, N² the shape functions of slave and master: Me = ∫ N¹⊗N¹, De = ∫ diag N¹, Ae = De Me⁻¹, Φ = Ae N¹ and
//! D = ∫ Φ⊗N¹ = De, M = ∫ Φ⊗N² = Ae ∫ N¹⊗N². Integrals run over the cells of the overlap, current configuration.
//!
//! Where Me cannot be inverted, Φ = N¹ and D = Me is full. With the usual three points a triangle this is so for every
//! quadrilateral slave whose overlap is a single triangle: three points cannot tell four functions apart.

use std::marker::PhantomData;

use super::choices::Choices;
use super::curved;
use super::geometry::PairGeometry;
use super::points::{ExactMotion, MasterMotion, Point, Points};
use super::segmentation_3d::Polygon;
use super::settings::SegmentationSettings;
use zelus_core::geometry::{FacetShape, NodeArray};
use zelus_core::scalar::{Dual, Real};
use zelus_core::vector3::value;

/// Share of the slave's measure below which an overlap is a sliver.
pub(crate) const SLIVER: f64 = 1e-5;
/// Condition number (Frobenius) of Me beyond which the plain shape functions serve as Φ.
const WORST_CONDITION: f64 = 1e-4 / f64::EPSILON;

/// The operators of a pair.
/// Row j belongs to the multiplier of slave node j; entries have the unit of a length (lines) or an area (surfaces).
#[derive(Debug, Clone, Copy)]
pub struct Operators<T: Real, S: FacetShape, M: FacetShape> {
    /// D_jk = ∫ Φ_j N¹_k; diagonal whenever the dual functions exist.
    pub d: S::Nodal<S::Nodal<T>>,
    /// M_jl = ∫ Φ_j N²_l.
    pub m: S::Nodal<M::Nodal<T>>,
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
    /// That of a pair whose cells have this length or area.
    fn of<T: Real, S: FacetShape, M: FacetShape>(
        covered: f64,
        pair: &PairGeometry<T, S, M>,
        operators: impl FnOnce() -> O,
    ) -> Self {
        match covered {
            covered if covered > least_overlap(pair) => Self::Cells(operators()),
            covered if covered > 0.0 => Self::Sliver,
            _ => Self::None,
        }
    }

    /// The operators, if any.
    pub fn cells(self) -> Option<O> {
        match self {
            Self::Cells(operators) => Some(operators),
            Self::Sliver | Self::None => None,
        }
    }
}

/// Computes D and M of a pair: lines in the plane, triangles and quadrilaterals in space; those of second order as `curved` says.
///
/// With dual numbers the gradients are exact derivatives of the values, through cells, points and dual functions, as
/// long as the kinds of the overlap's vertices do not change.
pub fn operators<T: Real, S: FacetShape, M: FacetShape>(
    pair: &PairGeometry<T, S, M>,
    settings: &SegmentationSettings,
) -> Overlap<Operators<T, S, M>> {
    operators_by(pair, settings, &ExactMotion)
}

/// The same with the derivatives of another motion of points on the master.
pub fn operators_by<T: Real, P: MasterMotion<T, S>, S: FacetShape, M: FacetShape>(
    pair: &PairGeometry<T, S, M>,
    settings: &SegmentationSettings,
    motion: &P,
) -> Overlap<Operators<T, S, M>> {
    ByOrder::<T, P, S, M>::OPERATORS(pair, settings, motion)
}

/// The same with derivatives by components of the nodal normals, `LANES` of them from the one numbered `first` on, node by node.
pub fn operators_by_normals<S: FacetShape, M: FacetShape, const LANES: usize>(
    pair: &PairGeometry<f64, S, M>,
    settings: &SegmentationSettings,
    first: usize,
) -> Overlap<Operators<Dual<LANES>, S, M>> {
    ByNormals::<S, M, LANES>::OPERATORS(pair, settings, first)
}

/// How derivatives by normals are found, by the dimension and the order of the shapes.
struct ByNormals<S: FacetShape, M: FacetShape, const LANES: usize>(PhantomData<(S, M)>);

impl<S: FacetShape, M: FacetShape, const LANES: usize> ByNormals<S, M, LANES> {
    const OPERATORS: fn(
        &PairGeometry<f64, S, M>,
        &SegmentationSettings,
        usize,
    ) -> Overlap<Operators<Dual<LANES>, S, M>> =
        if S::SPACE == 2 || S::CURVED || M::CURVED { Self::of_any } else { Self::in_space };

    /// In space the overlap is cut along the slave's normal: those of nodes say where points meet the master and nothing else, each point
    /// by the one interpolated there. That has three components, whatever the number of nodes.
    fn in_space(
        pair: &PairGeometry<f64, S, M>,
        settings: &SegmentationSettings,
        first: usize,
    ) -> Overlap<Operators<Dual<LANES>, S, M>> {
        let still: PairGeometry<Dual<3>, S, M> = pair.as_constants();
        let mut sums = Sums::<Dual<LANES>, S, M>::new();
        let covered = Points { pair, motion: &ExactMotion }.visit(settings, |point| {
            let normal = S::interpolate(&point.slave, &pair.nodal_normals);
            let normal = std::array::from_fn(|c| Dual::variable(normal[c], c));
            let x = S::interpolate(&point.slave, &pair.slave).map(Dual::constant);
            let master = Points { pair: &still, motion: &ExactMotion }.along(normal, x, Dual::zero());
            sums.add_point_by_normals(point, &master, first);
        });
        sums.found(covered, pair)
    }

    fn of_any(
        pair: &PairGeometry<f64, S, M>,
        settings: &SegmentationSettings,
        first: usize,
    ) -> Overlap<Operators<Dual<LANES>, S, M>> {
        operators(&pair.seeded_by_normals(first), settings)
    }
}

/// What differs by the order of the shapes. As constants, so that only what a pair of shapes needs is compiled for it.
struct ByOrder<T: Real, P, S: FacetShape, M: FacetShape>(PhantomData<(T, P, S, M)>);

impl<T: Real, P: MasterMotion<T, S>, S: FacetShape, M: FacetShape> ByOrder<T, P, S, M> {
    const OPERATORS: fn(&PairGeometry<T, S, M>, &SegmentationSettings, &P) -> Overlap<Operators<T, S, M>> =
        if S::CURVED || M::CURVED { Self::curved } else { Self::straight };

    fn straight(
        pair: &PairGeometry<T, S, M>,
        settings: &SegmentationSettings,
        motion: &P,
    ) -> Overlap<Operators<T, S, M>> {
        let mut sums = Sums::new();
        let covered = Points { pair, motion }.visit(settings, |point| sums.add_point(point));
        sums.found(covered, pair)
    }

    fn curved(pair: &PairGeometry<T, S, M>, settings: &SegmentationSettings, _: &P) -> Overlap<Operators<T, S, M>> {
        let (found, covered) = curved::operators(pair, settings);
        if found.is_finite() { Overlap::of(covered, pair, || found) } else { Overlap::None }
    }
}

/// The choices that gave operators, by the order of the shapes.
struct ChoicesByOrder<S: FacetShape, M: FacetShape>(PhantomData<(S, M)>);

impl<S: FacetShape, M: FacetShape> ChoicesByOrder<S, M> {
    const OF: fn(&PairGeometry<f64, S, M>, &SegmentationSettings, &Operators<f64, S, M>) -> Choices =
        if S::CURVED || M::CURVED { Self::curved } else { Self::straight };

    fn straight(
        pair: &PairGeometry<f64, S, M>,
        settings: &SegmentationSettings,
        found: &Operators<f64, S, M>,
    ) -> Choices {
        let origin = || {
            // Intervals of the plane have no such choice.
            let polygon = if S::SPACE == 2 { None } else { Polygon::new(pair, settings) }?;
            Some(polygon.local(polygon.vertices()[0]))
        };
        Choices {
            origin: pair.choices.origin.or_else(origin),
            plain: pair.choices.plain | u8::from(!found.is_diagonal()),
            slivers: true,
        }
    }

    fn curved(pair: &PairGeometry<f64, S, M>, settings: &SegmentationSettings, _: &Operators<f64, S, M>) -> Choices {
        Choices { plain: curved::plain_pieces(pair, settings), slivers: true, ..pair.choices }
    }
}

/// The choices that gave the operators `found` of a pair.
pub fn choices_of<S: FacetShape, M: FacetShape>(
    pair: &PairGeometry<f64, S, M>,
    settings: &SegmentationSettings,
    found: &Operators<f64, S, M>,
) -> Choices {
    ChoicesByOrder::<S, M>::OF(pair, settings, found)
}

/// Length or area above which an overlap counts.
pub(crate) fn least_overlap<T: Real, S: FacetShape, M: FacetShape>(pair: &PairGeometry<T, S, M>) -> f64 {
    if pair.choices.slivers { 0.0 } else { SLIVER * S::measure(&S::map(&pair.slave, value)) }
}

impl<T: Real, S: FacetShape, M: FacetShape> Operators<T, S, M> {
    /// No overlap at all.
    pub fn zero() -> Self {
        Self { d: S::nodal(|_| S::nodal(|_| T::zero())), m: S::nodal(|_| M::nodal(|_| T::zero())) }
    }

    /// The same operators in another scalar, without derivatives.
    pub fn as_constants<C: Real>(&self) -> Operators<C, S, M> {
        Operators {
            d: S::map(&self.d, |row| S::map(&row, |x| C::constant(x.value()))),
            m: S::map(&self.m, |row| M::map(&row, |x| C::constant(x.value()))),
        }
    }

    /// The same operators without derivatives.
    pub fn values(&self) -> Operators<f64, S, M> {
        self.as_constants()
    }

    /// Frobenius norms of D and M.
    pub fn norms(&self) -> [f64; 2] {
        let values = self.values();
        [frobenius(values.d.as_slice()), frobenius(values.m.as_slice())]
    }

    /// The change since the operators `previous`.
    pub fn minus(&self, previous: &Operators<f64, S, M>) -> Self {
        Self {
            d: S::nodal(|j| S::nodal(|k| self.d[j][k] - previous.d[j][k])),
            m: S::nodal(|j| M::nodal(|l| self.m[j][l] - previous.m[j][l])),
        }
    }

    /// Whether all entries are numbers.
    fn is_finite(&self) -> bool {
        let d = self.d.iter().flat_map(|row| row.iter());
        d.chain(self.m.iter().flat_map(|row| row.iter())).all(|x| x.value().is_finite())
    }

    /// Whether D is diagonal, so that dual functions were in use.
    pub fn is_diagonal(&self) -> bool {
        (0..S::NODES).all(|j| (0..S::NODES).all(|k| j == k || self.d[j][k].value() == 0.0))
    }

    /// (D v¹ − M v²)_j, the weighted jump of a nodal vector field across the pair.
    #[inline]
    pub fn jump(&self, slave: &S::Nodal<[T; 3]>, master: &M::Nodal<[T; 3]>) -> S::Nodal<[T; 3]> {
        S::nodal(|j| {
            let mut sum = [T::zero(); 3];
            for c in 0..3 {
                for k in 0..S::NODES {
                    sum[c].add_product(self.d[j][k], slave[k][c]);
                }
                for l in 0..M::NODES {
                    sum[c].add_product(-self.m[j][l], master[l][c]);
                }
            }
            sum
        })
    }
}

/// Integrals gathered over the cells: Me (upper triangle) and ∫ N¹⊗N².
struct Sums<T: Real, S: FacetShape, M: FacetShape> {
    me: S::Nodal<S::Nodal<T>>,
    mixed: S::Nodal<M::Nodal<T>>,
}

impl<T: Real, S: FacetShape, M: FacetShape> Sums<T, S, M> {
    fn new() -> Self {
        Self { me: S::nodal(|_| S::nodal(|_| T::zero())), mixed: S::nodal(|_| M::nodal(|_| T::zero())) }
    }

    #[inline]
    fn add_point(&mut self, point: &Point<T, S, M>) {
        for j in 0..S::NODES {
            let weighted = point.slave[j] * point.weight;
            for k in j..S::NODES {
                self.me[j][k].add_product(weighted, point.slave[k]);
            }
            for l in 0..M::NODES {
                self.mixed[j][l].add_product(weighted, point.master[l]);
            }
        }
    }

    /// The operators of a pair whose cells have this length or area.
    fn found<R: Real>(self, covered: f64, pair: &PairGeometry<R, S, M>) -> Overlap<Operators<T, S, M>> {
        // Points have no place on a master that is folded.
        if self.is_finite() { Overlap::of(covered, pair, || self.finish(pair.choices)) } else { Overlap::None }
    }

    fn is_finite(&self) -> bool {
        self.mixed.iter().flat_map(|row| row.iter()).all(|x| x.value().is_finite())
    }

    /// D and M from the integrals.
    fn finish(mut self, choices: Choices) -> Operators<T, S, M> {
        for j in 0..S::NODES {
            for k in 0..j {
                self.me[j][k] = self.me[k][j];
            }
        }
        let inverse = inverse::<S>(&S::map(&self.me, |row| S::map(&row, T::value))).filter(|_| choices.plain == 0);
        let Some(inverse) = inverse else {
            return Operators { d: self.me, m: self.mixed };
        };
        // X = Me⁻¹ ∫ N¹⊗N² on values, then one correction, which brings the derivative.
        let mut solution = S::nodal(|_| M::nodal(|_| 0.0));
        for j in 0..S::NODES {
            for l in 0..M::NODES {
                solution[j][l] = (0..S::NODES).map(|k| inverse[j][k] * self.mixed[k][l].value()).sum();
            }
        }
        let mut residual = self.mixed;
        for j in 0..S::NODES {
            for l in 0..M::NODES {
                for k in 0..S::NODES {
                    residual[j][l].add_scaled(self.me[j][k], -solution[k][l]);
                }
            }
        }
        let mut operators = Operators::<T, S, M>::zero();
        for j in 0..S::NODES {
            // The shape functions add up to one, so De is the row sum of Me.
            let mut de = self.me[j][0];
            (1..S::NODES).for_each(|k| de += self.me[j][k]);
            operators.d[j][j] = de;
            for l in 0..M::NODES {
                let mut x = T::constant(solution[j][l]);
                (0..S::NODES).for_each(|k| x.add_scaled(residual[k][l], inverse[j][k]));
                operators.m[j][l] = de * x;
            }
        }
        operators
    }
}

impl<S: FacetShape, M: FacetShape, const LANES: usize> Sums<Dual<LANES>, S, M> {
    /// Adds a point whose shape functions on the master have derivatives by the normal that is interpolated there.
    #[inline]
    fn add_point_by_normals(&mut self, point: &Point<f64, S, M>, master: &M::Nodal<Dual<3>>, first: usize) {
        let weighted = S::map(&point.slave, |shape| shape * point.weight);
        for j in 0..S::NODES {
            (j..S::NODES).for_each(|k| self.me[j][k].value += weighted[j] * point.slave[k]);
        }
        let known = LANES.min(PairGeometry::<f64, S, M>::NORMALS - first);
        for l in 0..M::NODES {
            let mut moved = Dual::constant(master[l].value);
            for lane in 0..known {
                let (node, c) = ((first + lane) / S::SPACE, (first + lane) % S::SPACE);
                moved.gradient[lane] = point.slave[node] * master[l].gradient[c];
            }
            (0..S::NODES).for_each(|j| self.mixed[j][l].add_scaled(moved, weighted[j]));
        }
    }
}

/// Square root of the sum of the squares of a matrix.
fn frobenius<R: NodeArray<f64>>(rows: &[R]) -> f64 {
    rows.iter().flat_map(|row| row.iter()).map(|x| x * x).sum::<f64>().sqrt()
}

/// Inverse by elimination with row exchanges; `None` if the matrix is too badly conditioned to trust it.
pub(super) fn inverse<S: FacetShape>(matrix: &S::Nodal<S::Nodal<f64>>) -> Option<S::Nodal<S::Nodal<f64>>> {
    let mut work = *matrix;
    let mut inverse = S::nodal(|j| S::nodal(|k| f64::from(u8::from(j == k))));
    for pivot in 0..S::NODES {
        let best = (pivot..S::NODES).max_by(|&a, &b| work[a][pivot].abs().total_cmp(&work[b][pivot].abs()))?;
        work.as_mut_slice().swap(pivot, best);
        inverse.as_mut_slice().swap(pivot, best);
        let scale = 1.0 / work[pivot][pivot];
        work[pivot] = S::map(&work[pivot], |x| x * scale);
        inverse[pivot] = S::map(&inverse[pivot], |x| x * scale);
        for row in 0..S::NODES {
            let factor = work[row][pivot];
            if row != pivot && factor != 0.0 {
                for c in 0..S::NODES {
                    work[row][c] -= factor * work[pivot][c];
                    inverse[row][c] -= factor * inverse[pivot][c];
                }
            }
        }
    }
    // Written so that NaN counts as bad.
    (frobenius(matrix.as_slice()) * frobenius(inverse.as_slice()) < WORST_CONDITION).then_some(inverse)
}
