//! Local systems of a pair: the residual alone, or with its exact tangent by dual numbers.

use super::held::restate;
use super::pair::{Kinematics, PairResidual, SlaveNode};
use super::{Formulation, Multiplier};
use crate::kratos::FirstIterateTangent;
use crate::mortar::{Operators, Overlap, PairGeometry, SegmentationSettings, operators_by_normals};
use zelus_core::geometry::{FacetShape, NodeArray};
use zelus_core::scalar::{Differentiated, Dual, Real};

/// Number of local unknowns of a pair.
pub const fn local_size<F: Formulation, S: FacetShape, M: FacetShape>() -> usize {
    S::SPACE * (S::NODES + M::NODES) + S::NODES * F::MULTIPLIER.count(S::SPACE)
}

/// Writes the right-hand side of a pair with these operators; zero without overlap.
///
/// # Panics
/// If `rhs` does not have [`local_size`] entries.
pub fn residual<F: Formulation, S: FacetShape, M: FacetShape>(
    formulation: &F,
    geometry: &PairGeometry<f64, S, M>,
    found: Overlap<Operators<f64, S, M>>,
    nodes: &S::Nodal<SlaveNode>,
    multipliers: &S::Nodal<[f64; 3]>,
    history: &F::History<S, M>,
    rhs: &mut [f64],
) {
    assert_eq!(rhs.len(), local_size::<F, S, M>(), "one entry per local unknown");
    rhs.fill(0.0);
    if let Overlap::Cells(operators) = found {
        let out = stated(formulation, &Kinematics::new(geometry, operators, multipliers), nodes, history);
        for_each_row::<_, S, M>(&out, F::MULTIPLIER, |row, value| rhs[row] = value);
    }
}

/// Writes the right-hand side of a pair and its tangent −∂b/∂(unknowns); zero without overlap.
/// `seeded` gives the pair with `LANES` of its displacement unknowns as variables, from a number on. `lhs` has a row for each
/// unknown, each of `width` numbers that begin with those of the unknowns.
///
/// # Panics
/// If `rhs` does not have [`local_size`] entries, or `lhs` not `width` for each of them.
pub fn tangent<F: Formulation, S: FacetShape, M: FacetShape, const LANES: usize>(
    formulation: &F,
    seeded: impl Fn(usize) -> PairGeometry<Dual<LANES>, S, M>,
    settings: &SegmentationSettings,
    knows: FirstIterateTangent,
    nodes: &S::Nodal<SlaveNode>,
    multipliers: &S::Nodal<[f64; 3]>,
    history: &F::History<S, M>,
    (lhs, width): (&mut [f64], usize),
    rhs: &mut [f64],
) {
    let n = local_size::<F, S, M>();
    assert_eq!(rhs.len(), n, "one entry per local unknown");
    assert_eq!(lhs.len(), n * width, "one row per local unknown");
    lhs.fill(0.0);
    rhs.fill(0.0);
    let unknowns = PairGeometry::<f64, S, M>::UNKNOWNS;
    let mut last = None;
    for first in (0..unknowns).step_by(LANES) {
        let geometry = seeded(first);
        let Some(dual) = knows.operators(&geometry, settings) else { return };
        let out = stated(formulation, &Kinematics::new(&geometry, dual, multipliers), nodes, history);
        for_each_row::<_, S, M>(&out, F::MULTIPLIER, |row, b: Dual<LANES>| {
            rhs[row] = b.value;
            for lane in 0..LANES.min(unknowns - first) {
                lhs[row * width + first + lane] = -b.gradient[lane];
            }
        });
        last = Some((geometry.values(), dual.values()));
    }

    // The residual is affine in the multipliers, so their columns need no operators with derivatives.
    let (values, plain) = last.expect("a pair has unknowns");
    let count = F::MULTIPLIER.count(S::SPACE);
    for c in 0..count {
        let mut pair: Kinematics<S::ByNode, S, M> =
            Kinematics::new(&values.as_constants(), plain.as_constants(), multipliers);
        for j in 0..S::NODES {
            pair.multipliers[j][c] = S::ByNode::of_variable(multipliers[j][c], j);
        }
        let out = stated(formulation, &pair, nodes, history);
        for_each_row::<_, S, M>(&out, F::MULTIPLIER, |row, b: S::ByNode| {
            for (j, derivative) in b.derivatives().iter().enumerate() {
                lhs[row * width + unknowns + count * j + c] = -derivative;
            }
        });
    }
}

/// Visits the rows of a pair with ∂b/∂n: the derivatives by the components of the normals of its slave nodes, node by node,
/// `LANES` at once from a number on; nothing without overlap.
pub fn by_normals<F: Formulation, S: FacetShape, M: FacetShape, const LANES: usize>(
    formulation: &F,
    geometry: &PairGeometry<f64, S, M>,
    settings: &SegmentationSettings,
    nodes: &S::Nodal<SlaveNode>,
    multipliers: &S::Nodal<[f64; 3]>,
    history: &F::History<S, M>,
    mut visit: impl FnMut(usize, usize, &[f64]),
) {
    let count = PairGeometry::<f64, S, M>::NORMALS;
    for first in (0..count).step_by(LANES) {
        let Some(operators) = operators_by_normals(geometry, settings, first).cells() else { return };
        let seeded: PairGeometry<Dual<LANES>, S, M> = geometry.seeded_by_normals(first);
        let out = stated(formulation, &Kinematics::new(&seeded, operators, multipliers), nodes, history);
        let known = LANES.min(count - first);
        for_each_row::<_, S, M>(&out, F::MULTIPLIER, |row, b| visit(row, first, &b.gradient[..known]));
    }
}

/// The residual of a pair, with the equations of nodes that supports hold.
fn stated<F: Formulation, T: Real, S: FacetShape, M: FacetShape>(
    formulation: &F,
    pair: &Kinematics<T, S, M>,
    nodes: &S::Nodal<SlaveNode>,
    history: &F::History<S, M>,
) -> PairResidual<T, S, M> {
    let mut out = formulation.residual(pair, nodes, history);
    restate(&mut out, F::MULTIPLIER, pair, nodes);
    out
}

/// Visits the entries of a residual in the order of the local unknowns.
#[inline]
fn for_each_row<T: Real, S: FacetShape, M: FacetShape>(
    out: &PairResidual<T, S, M>,
    multipliers: Multiplier,
    mut visit: impl FnMut(usize, T),
) {
    let dim = S::SPACE;
    let mut row = 0;
    let mut visit_all = |nodes: &[[T; 3]], count: usize| {
        for &b in nodes.iter().flat_map(|node| &node[..count]) {
            visit(row, b);
            row += 1;
        }
    };
    visit_all(out.master.as_slice(), dim);
    visit_all(out.slave.as_slice(), dim);
    visit_all(out.multipliers.as_slice(), multipliers.count(dim));
}
