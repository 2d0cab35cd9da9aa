//! Local systems of a pair: the right-hand side of a law, and its exact tangent (eq. D.2).
//!
//! Order of local unknowns: displacements of master nodes, displacements of slave nodes, multipliers of slave nodes; node by node,
//! each with its components. The law states forces and rows at each slave node; b_slave += Dᵀp and b_master −= Mᵀp stand here.

use std::cell::OnceCell;

use super::kinematics::{PairHistory, PairKinematics};
use crate::kratos::FirstIterateTangent;
use crate::law::constrained_multiplier::constrain;
use crate::law::{ContactLaw, Multiplier, NodeForces, NodeInputs, SlaveNode};
use crate::mortar::{
    Active, LANES, Operators, Overlap, PairGeometry, PairPoints, SegmentationSettings, find_operators_by_normals,
    variables_from,
};
use zelus_core::geometry::Nodal;
use zelus_core::model::SlaveNodes;
use zelus_core::scalar::Real;
use zelus_core::vector3::constant;

/// The scalars that laws are evaluated in.
trait LawScalar: Real {
    fn evaluate(law: &dyn ContactLaw, node: &SlaveNode, inputs: &NodeInputs<Self>) -> NodeForces<Self>;
}

impl LawScalar for f64 {
    fn evaluate(law: &dyn ContactLaw, node: &SlaveNode, inputs: &NodeInputs<f64>) -> NodeForces<f64> {
        law.values(node, inputs)
    }
}

impl LawScalar for Active {
    fn evaluate(law: &dyn ContactLaw, node: &SlaveNode, inputs: &NodeInputs<Active>) -> NodeForces<Active> {
        law.derivatives(node, inputs)
    }
}

/// A pair under a law, with the numbers that stay while its local system is computed.
pub struct PairSystem<'a> {
    /// The law.
    pub law: &'a dyn ContactLaw,
    /// The pair as it stands.
    pub geometry: &'a PairGeometry<f64>,
    /// How its overlap is integrated.
    pub settings: &'a SegmentationSettings,
    /// Constants of its slave nodes.
    pub nodes: &'a [SlaveNode],
    /// Multipliers of its slave nodes.
    pub multipliers: &'a [[f64; 3]],
    /// Its past.
    pub history: &'a PairHistory,
    /// Whether it has no overlap any more, and counts in the slip alone.
    pub is_left: bool,
    /// Points of its overlap, once they have been looked for.
    pub points: OnceCell<PairPoints>,
}

/// Forces on the nodes of a pair.
struct PairForces<T: Real> {
    master: Nodal<[T; 3]>,
    slave: Nodal<[T; 3]>,
}

/// Forces and rows of the slave nodes, as the law states them and constraints change them.
struct LawForces<T: Real> {
    forces: Nodal<Option<[T; 3]>>,
    rows: Nodal<[T; 3]>,
}

/// Adds the force vector p of slave node `j` to both sides: b_slave += D_jk p, b_master −= M_jl p.
#[inline]
fn add_nodal_force<T: Real>(out: &mut PairForces<T>, operators: &Operators<T>, j: usize, p: [T; 3]) {
    for (k, (force, d)) in out.slave.iter_mut().zip(operators.d[j].iter()).enumerate() {
        // Off the diagonal a zero is exact: dual functions.
        if k == j || d.value() != 0.0 {
            (0..3).for_each(|c| force[c].add_product(*d, p[c]));
        }
    }
    for (force, m) in out.master.iter_mut().zip(operators.m[j].iter()) {
        (0..3).for_each(|c| force[c].add_product(-*m, p[c]));
    }
}

impl PairSystem<'_> {
    /// Number of local unknowns.
    pub fn size(&self) -> usize {
        let count = self.law.multiplier().count(self.geometry.space());
        self.geometry.unknowns() + self.geometry.slave.len() * count
    }

    /// The operators of the pair, which `found` gives: zero for one that is left.
    pub fn present(&self, found: &dyn Fn() -> Overlap<Operators<f64>>) -> Overlap<Operators<f64>> {
        if !self.is_left {
            return found();
        }
        Overlap::Cells(Operators::zero(self.geometry.slave_shape, self.geometry.master_shape))
    }

    /// Forces and rows at the slave nodes.
    fn evaluate<T: LawScalar>(&self, pair: &PairKinematics<'_, T>, multipliers: &[[T; 3]]) -> LawForces<T> {
        let (nodes, zero) = (self.nodes, [T::zero(); 3]);
        let mut out = LawForces { forces: Nodal::empty(), rows: Nodal::empty() };
        out.forces.refill(nodes.len(), |_| None);
        out.rows.refill(nodes.len(), |_| zero);
        for (j, node) in nodes.iter().enumerate() {
            let found = T::evaluate(self.law, node, &pair.inputs(j, multipliers[j]));
            (out.forces[j], out.rows[j]) = (found.force, found.multiplier);
        }
        let kind = self.law.multiplier();
        constrain(&mut out.rows, kind, &pair.geometry.nodal_normals, multipliers, nodes);
        out
    }

    /// Visits the rows of the right-hand side of a pair that stands like this, with these operators.
    fn visit_rows<T: LawScalar>(
        &self,
        geometry: &PairGeometry<T>,
        operators: &Operators<T>,
        visit: &mut dyn FnMut(usize, &T),
    ) {
        let pair = PairKinematics::new(self.law, geometry, operators, self.nodes, self.history);
        let zero = [T::zero(); 3];
        let multipliers = Nodal::new(self.nodes.len(), |j| constant(self.multipliers[j]));
        let law = self.evaluate(&pair, &multipliers);
        let mut out = PairForces { master: Nodal::empty(), slave: Nodal::empty() };
        out.master.refill(geometry.master.len(), |_| zero);
        out.slave.refill(geometry.slave.len(), |_| zero);
        for (j, force) in law.forces.iter().enumerate() {
            if let Some(force) = force {
                add_nodal_force(&mut out, operators, j, *force);
            }
        }
        let (space, count) = (geometry.space(), self.law.multiplier().count(geometry.space()));
        let mut row = 0;
        for (nodes, count) in [(&out.master, space), (&out.slave, space), (&law.rows, count)] {
            for b in nodes.iter().flat_map(|node| &node[..count]) {
                visit(row, b);
                row += 1;
            }
        }
    }

    /// Writes the right-hand side of a pair with these operators; zero without overlap.
    ///
    /// # Panics
    /// If `rhs` does not have [`PairSystem::size`] entries.
    pub fn residual(&self, found: &Overlap<Operators<f64>>, rhs: &mut [f64]) {
        assert_eq!(rhs.len(), self.size(), "one entry per local unknown");
        rhs.fill(0.0);
        if let Overlap::Cells(operators) = found {
            self.visit_rows(self.geometry, operators, &mut |row, value| rhs[row] = *value);
        }
    }

    /// Writes the right-hand side of a pair and its tangent −∂b/∂(unknowns); zero without overlap.
    /// `found` gives the operators without derivatives, `seeded` the pair with [`LANES`] of its displacement unknowns as variables,
    /// from a number on. `lhs` has a row for each unknown, each of `width` numbers that begin with those of the unknowns.
    /// `room` is room for the operators.
    ///
    /// # Panics
    /// If `rhs` does not have [`PairSystem::size`] entries, or `lhs` not `width` for each of them.
    pub fn tangent(
        &self,
        found: &dyn Fn() -> Overlap<Operators<f64>>,
        seeded: &dyn Fn(usize) -> PairGeometry<Active>,
        knows: FirstIterateTangent,
        (lhs, width): (&mut [f64], usize),
        rhs: &mut [f64],
        room: &mut Operators<Active>,
    ) {
        let n = self.size();
        assert_eq!(rhs.len(), n, "one entry per local unknown");
        assert_eq!(lhs.len(), n * width, "one row per local unknown");
        lhs.fill(0.0);
        rhs.fill(0.0);
        if let Some(operators) = self.inert_operators(found) {
            self.visit_rows(self.geometry, &operators, &mut |row, value| rhs[row] = *value);
            return self.add_multiplier_columns(&operators, (lhs, width), room);
        }
        let unknowns = self.geometry.unknowns();
        let operators = &mut *room;
        operators.reset(self.geometry.slave_shape, self.geometry.master_shape);
        for first in (0..unknowns).step_by(LANES) {
            if first > 0 {
                operators.clear();
            }
            let geometry = seeded(first);
            if !self.is_left
                && knows.find_operators(&geometry, self.settings, self.points(), operators).cells().is_none()
            {
                return;
            }
            let lanes = LANES.min(unknowns - first);
            self.visit_rows(&geometry, operators, &mut |row, b: &Active| {
                rhs[row] = b.value;
                let entries = &mut lhs[row * width + first..][..lanes];
                entries.iter_mut().zip(&b.gradient).for_each(|(entry, derivative)| *entry = -derivative);
            });
        }
        let values = operators.values();
        self.add_multiplier_columns(&values, (lhs, width), room);
    }

    /// Points of the overlap.
    fn points(&self) -> &PairPoints {
        self.points.get_or_init(|| PairPoints::new(self.geometry, self.settings))
    }

    /// The operators of a pair without force whose rows do not change with the place of its nodes, so that their derivatives are
    /// not needed: one that is open and has no multiplier left.
    fn inert_operators(&self, found: &dyn Fn() -> Overlap<Operators<f64>>) -> Option<Operators<f64>> {
        if self.nodes.iter().any(|node| node.state.is_active()) {
            return None;
        }
        let operators = found().cells()?;
        let pair = PairKinematics::new(self.law, self.geometry, &operators, self.nodes, self.history);
        let is_inert = |(j, node): (usize, &SlaveNode)| {
            let forces = self.law.derivatives(node, &pair.inputs(j, self.multipliers[j]).seeded());
            forces.force.is_none() && forces.multiplier.iter().all(Real::is_constant)
        };
        self.nodes.iter().enumerate().all(is_inert).then_some(operators)
    }

    /// Writes the columns of the multipliers: rows are affine in them, so that operators need no derivatives.
    fn add_multiplier_columns(
        &self,
        operators: &Operators<f64>,
        (lhs, width): (&mut [f64], usize),
        room: &mut Operators<Active>,
    ) {
        let (kind, space) = (self.law.multiplier(), self.geometry.space());
        let (count, slaves, masters) = (kind.count(space), self.geometry.slave.len(), self.geometry.master.len());
        let (unknowns, all) = (self.geometry.unknowns(), count * slaves);
        if all == 0 {
            return;
        }
        let geometry = self.geometry.as_constants::<Active>();
        room.take_constants(operators);
        let pair = PairKinematics::new(self.law, &geometry, room, self.nodes, self.history);
        for first in (0..all).step_by(LANES) {
            let seeded = |j: usize| variables_from(first, count * j, self.multipliers[j], count);
            let law = self.evaluate(&pair, &Nodal::new(slaves, seeded));
            let lanes = LANES.min(all - first);
            let mut add = |row: usize, factor: f64, b: &Active| {
                let entries = &mut lhs[row * width + unknowns + first..][..lanes];
                entries.iter_mut().zip(&b.gradient).for_each(|(entry, derivative)| *entry -= factor * derivative);
            };
            for (j, force) in law.forces.iter().enumerate() {
                let Some(force) = force else { continue };
                for c in 0..space {
                    for l in 0..masters {
                        add(space * l + c, -operators.m[j][l], &force[c]);
                    }
                    for k in (0..slaves).filter(|&k| k == j || operators.d[j][k] != 0.0) {
                        add(space * (masters + k) + c, operators.d[j][k], &force[c]);
                    }
                }
            }
            for (j, row) in law.rows.iter().enumerate() {
                (0..count).for_each(|c| add(unknowns + count * j + c, 1.0, &row[c]));
            }
        }
    }

    /// Visits the rows of a pair with ∂b/∂n: the derivatives by the components of the normals of its slave nodes, node by node,
    /// some at once from a number on; nothing without overlap. `operators` is room for the operators.
    pub fn by_normals(&self, operators: &mut Operators<Active>, visit: &mut dyn FnMut(usize, usize, &[f64])) {
        let count = self.geometry.normal_components();
        operators.reset(self.geometry.slave_shape, self.geometry.master_shape);
        for first in (0..count).step_by(LANES) {
            if first > 0 {
                operators.clear();
            }
            if !self.is_left {
                let found = find_operators_by_normals(self.geometry, self.settings, self.points(), first, operators);
                if found.cells().is_none() {
                    return;
                }
            }
            let seeded = self.geometry.seeded_by_normals(first);
            let known = LANES.min(count - first);
            self.visit_rows(&seeded, operators, &mut |row, b: &Active| visit(row, first, &b.gradient[..known]));
        }
    }

    /// Inputs of the law at the slave nodes of a pair with these operators, and areas times trial tractions.
    pub fn inputs_and_trial(
        &self,
        operators: &Operators<f64>,
        visit: &mut dyn FnMut(usize, &NodeInputs<f64>, Option<[f64; 3]>),
    ) {
        let pair = PairKinematics::new(self.law, self.geometry, operators, self.nodes, self.history);
        for (j, node) in self.nodes.iter().enumerate() {
            let inputs = pair.inputs(j, [0.0; 3]);
            visit(j, &inputs, self.law.weighted_trial(node, &inputs));
        }
    }
}

/// Multipliers of so many slave nodes with these owners, for laws with this kind of them.
pub(super) fn multipliers_of(
    kind: Multiplier,
    count: usize,
    owners: &[u32],
    slave_nodes: &SlaveNodes,
) -> Nodal<[f64; 3]> {
    Nodal::new(count, |j| owners.get(j).map_or([0.0; 3], |&owner| kind.value(slave_nodes, owner)))
}
