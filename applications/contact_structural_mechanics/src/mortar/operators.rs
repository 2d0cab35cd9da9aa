//! Mortar operators D and M of one pair, with dual shape functions built on the overlap of that pair.
//!
//! With N¹, N² the shape functions of slave and master: Me = ∫ N¹⊗N¹, De = ∫ diag N¹, Ae = De Me⁻¹, Φ = Ae N¹ and
//! D = ∫ Φ⊗N¹ = De, M = ∫ Φ⊗N² = Ae ∫ N¹⊗N². Integrals run over the cells of the overlap, current configuration.
//!
//! Where Me cannot be inverted, Φ = N¹ and D = Me is full. With the usual three points a triangle this is so for every
//! quadrilateral slave whose overlap is a single triangle: three points cannot tell four functions apart.

use super::choices::Choices;
use super::geometry::{Active, LANES, PairGeometry};
use super::overlap_point::OverlapPoint;
use zelus_core::geometry::{FacetShape, Nodal};
use zelus_core::scalar::{Dual, Real};
use zelus_core::vector3::value;

/// Share of the slave's measure below which an overlap is a sliver.
pub(crate) const SLIVER: f64 = 1e-5;
/// Condition number (Frobenius) of Me beyond which the standard shape functions serve as Φ.
const WORST_CONDITION: f64 = 1e-4 / f64::EPSILON;

/// The operators of a pair.
/// Row j belongs to the multiplier of slave node j; entries have the unit of a length (lines) or an area (surfaces).
#[derive(Debug, Clone, Copy)]
pub struct Operators<T: Real> {
    /// D_jk = ∫ Φ_j N¹_k; diagonal whenever the dual functions exist.
    pub d: Nodal<Nodal<T>>,
    /// M_jl = ∫ Φ_j N²_l.
    pub m: Nodal<Nodal<T>>,
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

    /// The same kind of overlap with a function of the operators.
    pub fn map<P>(self, of: impl FnOnce(O) -> P) -> Overlap<P> {
        match self {
            Self::Cells(operators) => Overlap::Cells(of(operators)),
            Self::Sliver => Overlap::Sliver,
            Self::None => Overlap::None,
        }
    }
}

/// Length or area above which an overlap counts.
pub(crate) fn least_overlap<T: Real>(pair: &PairGeometry<T>) -> f64 {
    if pair.choices.slivers { 0.0 } else { SLIVER * pair.slave_shape.measure(&pair.slave.map(value)) }
}

/// The kind of overlap of a pair whose cells have this length or area.
pub(super) fn overlap_of<T: Real>(covered: f64, pair: &PairGeometry<T>) -> Overlap<()> {
    match covered {
        covered if covered > least_overlap(pair) => Overlap::Cells(()),
        covered if covered > 0.0 => Overlap::Sliver,
        _ => Overlap::None,
    }
}

impl<T: Real> Operators<T> {
    /// No overlap at all.
    pub fn zero(slave: &FacetShape, master: &FacetShape) -> Self {
        let (d, m) = (slave.nodal(|_| T::zero()), master.nodal(|_| T::zero()));
        Self { d: slave.nodal(|_| d), m: slave.nodal(|_| m) }
    }

    /// Room for operators, which with derivatives are large: 17 kB.
    pub fn room() -> Self {
        Self { d: Nodal::empty(), m: Nodal::empty() }
    }

    /// Takes no overlap at all in place of what there is.
    pub fn reset(&mut self, slave: &FacetShape, master: &FacetShape) {
        for (rows, width) in [(&mut self.d, slave.nodes), (&mut self.m, master.nodes)] {
            rows.refill_in_place(slave.nodes, Nodal::empty, |_, row| row.refill(width, |_| T::zero()));
        }
    }

    /// Takes operators without derivatives in place of those there are.
    pub fn take_constants(&mut self, from: &Operators<f64>) {
        for (rows, from) in [(&mut self.d, &from.d), (&mut self.m, &from.m)] {
            rows.refill_in_place(from.len(), Nodal::empty, |j, row| {
                row.refill(from[j].len(), |k| T::constant(from[j][k]));
            });
        }
    }

    /// Sets all entries to zero.
    pub fn clear(&mut self) {
        self.d.iter_mut().chain(self.m.iter_mut()).for_each(|row| row.fill(T::zero()));
    }

    /// The same operators in another scalar, without derivatives.
    pub fn as_constants<C: Real>(&self) -> Operators<C> {
        let constants = |row: Nodal<T>| row.map(|x| C::constant(x.value()));
        Operators { d: self.d.map(constants), m: self.m.map(constants) }
    }

    /// The same operators without derivatives.
    pub fn values(&self) -> Operators<f64> {
        self.as_constants()
    }

    /// Frobenius norms of the values of D and M.
    pub fn norms(&self) -> [f64; 2] {
        [&self.d, &self.m].map(|rows| frobenius(rows.iter().flat_map(|row| row.iter().map(|x| x.value()))))
    }

    /// Frobenius norms of the change of D and M since `previous`.
    pub fn norms_of_change(&self, previous: &Operators<f64>) -> [f64; 2] {
        [(&self.d, &previous.d), (&self.m, &previous.m)].map(|(rows, before)| {
            let entries = rows.iter().zip(before.iter()).flat_map(|(row, before)| row.iter().zip(before.iter()));
            frobenius(entries.map(|(x, before)| x.value() - before))
        })
    }

    /// Whether all entries are numbers.
    pub(super) fn is_finite(&self) -> bool {
        self.d.iter().chain(self.m.iter()).flat_map(|row| row.iter()).all(|x| x.value().is_finite())
    }

    /// Whether D is diagonal, so that dual functions were in use.
    pub fn is_diagonal(&self) -> bool {
        self.d.iter().enumerate().all(|(j, row)| row.iter().enumerate().all(|(k, x)| j == k || x.value() == 0.0))
    }

    /// (D v¹ − M v²)_j, the weighted jump of a nodal vector field across the pair.
    pub fn jump(&self, slave: &[[T; 3]], master: &[[T; 3]]) -> Nodal<[T; 3]> {
        self.jump_of(slave, master, &|_, _| [0.0; 2])
    }

    /// ((D − D°) v¹ − (M − M°) v²)_j with the operators `previous`.
    pub fn jump_since(&self, previous: &Operators<f64>, slave: &[[T; 3]], master: &[[T; 3]]) -> Nodal<[T; 3]> {
        let entry = |rows: &Nodal<Nodal<f64>>, j: usize, k: usize| rows[j].get(k).copied().unwrap_or(0.0);
        self.jump_of(slave, master, &|j, k| [entry(&previous.d, j, k), entry(&previous.m, j, k)])
    }

    /// The jump by D and M less the entries in a row and column that `without` gives.
    #[inline(always)]
    fn jump_of(
        &self,
        slave: &[[T; 3]],
        master: &[[T; 3]],
        without: &impl Fn(usize, usize) -> [f64; 2],
    ) -> Nodal<[T; 3]> {
        Nodal::new(self.d.len(), |j| {
            let mut sum = [T::zero(); 3];
            for (k, (d, v)) in self.d[j].iter().zip(slave).enumerate() {
                let d = *d - without(j, k)[0];
                (0..3).for_each(|c| sum[c].add_product(d, v[c]));
            }
            for (l, (m, v)) in self.m[j].iter().zip(master).enumerate() {
                let m = *m - without(j, l)[1];
                (0..3).for_each(|c| sum[c].add_product(-m, v[c]));
            }
            sum
        })
    }

    /// Adds a point to the integrals Me (upper triangle, in place of D) and ∫ N¹⊗N² (in place of M).
    pub(super) fn add_point(&mut self, point: &OverlapPoint<T>) {
        let nodes = point.slave.len();
        for j in 0..nodes {
            let weighted = point.slave[j] * point.weight;
            for k in j..nodes {
                self.d[j][k].add_product(weighted, point.slave[k]);
            }
            for (sum, shape) in self.m[j].iter_mut().zip(point.master.iter()) {
                sum.add_product(weighted, *shape);
            }
        }
    }

    /// Makes D and M of the integrals of a pair whose cells have this length or area.
    pub(super) fn finish<R: Real>(&mut self, covered: f64, pair: &PairGeometry<R>) -> Overlap<()> {
        // Points have no place on a master that is folded.
        if !self.m.iter().flat_map(|row| row.iter()).all(|x| x.value().is_finite()) {
            return Overlap::None;
        }
        let found = overlap_of(covered, pair);
        if matches!(found, Overlap::Cells(())) {
            self.take_dual_functions(pair.choices);
        }
        found
    }

    /// Takes the integrals with dual functions in place of the standard ones, where there are any.
    fn take_dual_functions(&mut self, choices: Choices) {
        let (slaves, masters) = (self.d.len(), self.m[0].len());
        for j in 0..slaves {
            for k in 0..j {
                self.d[j][k] = self.d[k][j];
            }
        }
        let values = self.d.map(|row| row.map(T::value));
        let Some(inverse) = inverse(&values).filter(|_| choices.plain == 0) else { return };
        // X = Me⁻¹ ∫ N¹⊗N² on values, then one correction, which brings the derivative.
        let zero = Nodal::new(masters, |_| 0.0);
        let mut solution = Nodal::new(slaves, |_| zero);
        for j in 0..slaves {
            for l in 0..masters {
                solution[j][l] = (0..slaves).map(|k| inverse[j][k] * self.m[k][l].value()).sum();
            }
        }
        for j in 0..slaves {
            for l in 0..masters {
                for k in 0..slaves {
                    self.m[j][l].add_scaled(self.d[j][k], -solution[k][l]);
                }
            }
        }
        for j in 0..slaves {
            // The shape functions add up to one, so De is the row sum of Me.
            let mut de = self.d[j][0];
            (1..slaves).for_each(|k| de += self.d[j][k]);
            self.d[j].fill(T::zero());
            self.d[j][j] = de;
        }
        for l in 0..masters {
            let residual = Nodal::new(slaves, |k| self.m[k][l]);
            for j in 0..slaves {
                let mut x = T::constant(solution[j][l]);
                (0..slaves).for_each(|k| x.add_scaled(residual[k], inverse[j][k]));
                self.m[j][l] = self.d[j][j] * x;
            }
        }
    }
}

impl Operators<Active> {
    /// Adds a point whose shape functions on the master have derivatives by the normal that is interpolated there.
    pub(super) fn add_point_by_normals(&mut self, point: &OverlapPoint<f64>, master: &[Dual<3>], first: usize) {
        let nodes = point.slave.len();
        let weighted = point.slave.map(|shape| shape * point.weight);
        for j in 0..nodes {
            (j..nodes).for_each(|k| self.d[j][k].value += weighted[j] * point.slave[k]);
        }
        for (l, shape) in master.iter().enumerate() {
            let moved = by_nodal_normals(*shape, &point.slave, first);
            (0..nodes).for_each(|j| self.m[j][l].add_scaled(moved, weighted[j]));
        }
    }
}

/// A number with derivatives by the normal interpolated at a point of the slave, as one with those by the normals of nodes: [`LANES`]
/// components from the one numbered `first` on, node by node.
pub(super) fn by_nodal_normals(number: Dual<3>, slave: &[f64], first: usize) -> Active {
    let mut out = Active::constant(number.value);
    for lane in 0..LANES.min((3 * slave.len()).saturating_sub(first)) {
        let (node, c) = ((first + lane) / 3, (first + lane) % 3);
        out.gradient[lane] = slave[node] * number.gradient[c];
    }
    out
}

/// Square root of the sum of the squares of a matrix.
fn frobenius(entries: impl Iterator<Item = f64>) -> f64 {
    entries.map(|x| x * x).sum::<f64>().sqrt()
}

/// Inverse by elimination with row exchanges; `None` if the matrix is too badly conditioned to trust it.
pub(super) fn inverse(matrix: &Nodal<Nodal<f64>>) -> Option<Nodal<Nodal<f64>>> {
    let count = matrix.len();
    let mut work = *matrix;
    let mut inverse = Nodal::new(count, |j| Nodal::new(count, |k| f64::from(u8::from(j == k))));
    for pivot in 0..count {
        let best = (pivot..count).max_by(|&a, &b| work[a][pivot].abs().total_cmp(&work[b][pivot].abs()))?;
        work.swap(pivot, best);
        inverse.swap(pivot, best);
        let scale = 1.0 / work[pivot][pivot];
        work[pivot] = work[pivot].map(|x| x * scale);
        inverse[pivot] = inverse[pivot].map(|x| x * scale);
        for row in 0..count {
            let factor = work[row][pivot];
            if row != pivot && factor != 0.0 {
                for c in 0..count {
                    work[row][c] -= factor * work[pivot][c];
                    inverse[row][c] -= factor * inverse[pivot][c];
                }
            }
        }
    }
    // Written so that NaN counts as bad.
    let norm = |matrix: &Nodal<Nodal<f64>>| frobenius(matrix.iter().flat_map(|row| row.iter().copied()));
    (norm(matrix) * norm(&inverse) < WORST_CONDITION).then_some(inverse)
}
