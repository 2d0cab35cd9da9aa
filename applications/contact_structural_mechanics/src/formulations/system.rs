//! Local systems of a pair: the residual alone, or with its exact tangent by dual numbers.

use super::held::restate;
use super::pair::{Kinematics, PairResidual, SlaveNode};
use super::{Formulation, Multiplier};
use crate::kratos::FirstIterateTangent;
use crate::mortar::{Operators, Overlap, PairGeometry, SegmentationSettings, dimension, operators};
use zelus_core::scalar::{Dual, Real};
use zelus_core::vector3::constant;

/// Number of local unknowns of a pair.
pub const fn local_size<F: Formulation, const NS: usize, const NM: usize>() -> usize {
    dimension(NS) * (NS + NM) + NS * F::MULTIPLIER.count(dimension(NS))
}

/// Writes the right-hand side of a pair; zero without overlap. Returns its operators.
///
/// # Panics
/// If `rhs` does not have [`local_size`] entries.
pub fn residual<F: Formulation, const NS: usize, const NM: usize>(
    formulation: &F,
    geometry: &PairGeometry<f64, NS, NM>,
    settings: &SegmentationSettings,
    nodes: &[SlaveNode; NS],
    multipliers: &[[f64; 3]; NS],
    history: &F::History<NS, NM>,
    rhs: &mut [f64],
) -> Overlap<Operators<f64, NS, NM>> {
    assert_eq!(rhs.len(), local_size::<F, NS, NM>(), "one entry per local unknown");
    rhs.fill(0.0);
    let found = operators(geometry, settings);
    if let Overlap::Cells(operators) = found {
        let out = stated(formulation, &kinematics(geometry, operators, multipliers), nodes, history);
        for_each_row::<_, NS, NM>(&out, F::MULTIPLIER, |row, value| rhs[row] = value);
    }
    found
}

/// Writes the right-hand side of a pair and its tangent −∂b/∂(unknowns); zero without overlap.
/// `geometry` comes from [`PairGeometry::seeded`]; `NU` is its number of displacement unknowns. `lhs` has a row for each
/// unknown, each of `width` numbers that begin with those of the unknowns. Returns the operators.
///
/// # Panics
/// If `rhs` does not have [`local_size`] entries, or `lhs` not `width` for each of them.
pub fn tangent<F: Formulation, const NS: usize, const NM: usize, const NU: usize>(
    formulation: &F,
    geometry: &PairGeometry<Dual<NU>, NS, NM>,
    settings: &SegmentationSettings,
    knows: FirstIterateTangent,
    nodes: &[SlaveNode; NS],
    multipliers: &[[f64; 3]; NS],
    history: &F::History<NS, NM>,
    (lhs, width): (&mut [f64], usize),
    rhs: &mut [f64],
) -> Overlap<Operators<f64, NS, NM>> {
    let n = local_size::<F, NS, NM>();
    assert_eq!(rhs.len(), n, "one entry per local unknown");
    assert_eq!(lhs.len(), n * width, "one row per local unknown");
    lhs.fill(0.0);
    rhs.fill(0.0);
    let found = knows.operators(geometry, settings);
    let Some(dual) = found else { return Overlap::None };

    let out = stated(formulation, &kinematics(geometry, dual, multipliers), nodes, history);
    for_each_row::<_, NS, NM>(&out, F::MULTIPLIER, |row, b: Dual<NU>| {
        rhs[row] = b.value;
        for column in 0..NU {
            lhs[row * width + column] = -b.gradient[column];
        }
    });

    // The residual is affine in the multipliers, so their columns need no operators with derivatives.
    let values = geometry.values();
    let plain = dual.values();
    let count = F::MULTIPLIER.count(dimension(NS));
    for c in 0..count {
        let mut pair: Kinematics<Dual<NS>, NS, NM> =
            kinematics(&values.as_constants(), plain.as_constants(), multipliers);
        for j in 0..NS {
            pair.multipliers[j][c] = Dual::variable(multipliers[j][c], j);
        }
        let out = stated(formulation, &pair, nodes, history);
        for_each_row::<_, NS, NM>(&out, F::MULTIPLIER, |row, b: Dual<NS>| {
            for j in 0..NS {
                lhs[row * width + NU + count * j + c] = -b.gradient[j];
            }
        });
    }
    Overlap::Cells(plain)
}

/// Visits the rows of a pair with ∂b/∂n: the derivatives by the components of the normals of its slave nodes, node by node;
/// nothing without overlap.
pub fn by_normals<F: Formulation, const NS: usize, const NM: usize, const NN: usize>(
    formulation: &F,
    geometry: &PairGeometry<f64, NS, NM>,
    settings: &SegmentationSettings,
    nodes: &[SlaveNode; NS],
    multipliers: &[[f64; 3]; NS],
    history: &F::History<NS, NM>,
    mut visit: impl FnMut(usize, &[f64; NN]),
) {
    let dim = dimension(NS);
    assert_eq!(NN, dim * NS, "one variable per component of a normal");
    let mut seeded: PairGeometry<Dual<NN>, NS, NM> = geometry.as_constants();
    for (j, normal) in seeded.nodal_normals.iter_mut().enumerate() {
        (0..dim).for_each(|c| normal[c] = Dual::variable(normal[c].value, dim * j + c));
    }
    let Some(operators) = operators(&seeded, settings).cells() else { return };
    let out = stated(formulation, &kinematics(&seeded, operators, multipliers), nodes, history);
    for_each_row::<_, NS, NM>(&out, F::MULTIPLIER, |row, b| visit(row, &b.gradient));
}

/// The residual of a pair, with the equations of nodes that supports hold.
fn stated<F: Formulation, T: Real, const NS: usize, const NM: usize>(
    formulation: &F,
    pair: &Kinematics<T, NS, NM>,
    nodes: &[SlaveNode; NS],
    history: &F::History<NS, NM>,
) -> PairResidual<T, NS, NM> {
    let mut out = formulation.residual(pair, nodes, history);
    restate(&mut out, F::MULTIPLIER, pair, nodes);
    out
}

fn kinematics<T: Real, const NS: usize, const NM: usize>(
    geometry: &PairGeometry<T, NS, NM>,
    operators: Operators<T, NS, NM>,
    multipliers: &[[f64; 3]; NS],
) -> Kinematics<T, NS, NM> {
    Kinematics {
        operators,
        slave: geometry.slave,
        master: geometry.master,
        normals: geometry.nodal_normals,
        multipliers: multipliers.map(constant),
    }
}

/// Visits the entries of a residual in the order of the local unknowns.
#[inline]
fn for_each_row<T: Real, const NS: usize, const NM: usize>(
    out: &PairResidual<T, NS, NM>,
    multipliers: Multiplier,
    mut visit: impl FnMut(usize, T),
) {
    let dim = dimension(NS);
    let displacements = out.master.iter().chain(&out.slave).flat_map(|b| &b[..dim]);
    let conditions = out.multipliers.iter().flat_map(|b| &b[..multipliers.count(dim)]);
    displacements.chain(conditions).enumerate().for_each(|(row, &b)| visit(row, b));
}
