//! A block of pairs by Nitsche's method: slave and master facets, and the slave's element with the tractions on its face.

use std::ops::Range;
use std::sync::Arc;
use zelus_core::model::EntityKind;

use zelus_core::entities::{EntityBlock, EntityError, LocalSystems, LocalUnknown, Request, StepView, Tangent};
use zelus_core::geometry::Nodal;
use zelus_core::scalar::Real;
use zelus_core::vector3::dot;

use super::contact_block::{ContactBlock, IntegrationState};
use super::pair::{Integral, Pair};
use super::pair_request::PairRequest;
use super::pairs_of_shapes::PairsOfShapes;
use crate::interface::{Bodies, SlaveIndex, Tractions};
use crate::law::{Multiplier, Nitsche, NodeOfPoints, PointForces};
use crate::mortar::{Active, LANES, PairGeometry, rotated_slip, variables_from};
use crate::slave_nodes::SlaveStates;

/// The block of Nitsche's method, with friction or without.
pub fn nitsche_block(request: PairRequest, friction: bool) -> Box<dyn ContactBlock> {
    let (bodies, parameters) = (request.bodies.clone(), request.parameters.clone());
    let friction = friction.then_some(parameters.tangent_factor);
    let formulation = Nitsche { friction, ..parameters.nitsche };
    Box::new(NitscheBlock { formulation, pairs: PairsOfShapes::new(request, Multiplier::Body), bodies })
}

/// Pairs of two shapes.
///
/// Variables of the formula of a pair are its displacements, the components of nodal normals, and the tractions at the inner
/// points of the slave. Other nodes of the slave's element are among those around the pair.
struct NitscheBlock {
    formulation: Nitsche,
    pairs: PairsOfShapes,
    bodies: Arc<Bodies>,
}

impl NitscheBlock {
    fn key(&self, at: usize) -> [u32; 2] {
        let key = self.pairs.pairs[at].key;
        [key.interface, key.slave]
    }

    fn nodes_of_points(&self, at: usize, states: &SlaveStates) -> Nodal<NodeOfPoints> {
        let slaves = self.pairs.slaves(at);
        Nodal::new(slaves.len(), |j| {
            let own = &states[slaves[j]];
            let (forced_active, forced_stick) =
                (f64::from(u8::from(own.law.forced_active)), f64::from(u8::from(own.law.forced_stick)));
            NodeOfPoints {
                history_traction: own.last.history_traction,
                friction: own.parameters.friction,
                forced_active,
                forced_stick,
            }
        })
    }

    fn forces<T: Real>(
        &self,
        at: usize,
        (view, states): (&StepView<'_>, &SlaveStates),
        geometry: &PairGeometry<T>,
        tractions: &[[T; 3]],
    ) -> Option<PointForces<T>> {
        let face = self.bodies.slave_face(self.key(at));
        let nodes = self.nodes_of_points(at, states);
        let last = self.pairs.history(at, view, false);
        let settings = &self.pairs.parameters.segmentation;
        self.formulation.forces(geometry, tractions, (&face, &nodes), (&last.slave, &last.master), settings)
    }

    /// The right-hand side alone.
    fn residual(&self, at: usize, view: &StepView<'_>, rhs: &mut [f64]) -> Result<(), EntityError> {
        let key = self.key(at);
        let consistent = self.formulation.theta != 0.0;
        let tractions = self.bodies.tractions(key, view, consistent)?;
        let states = &self.pairs.states;
        let geometry = self.pairs.geometry(at, view, states);
        let Some(out) = self.forces(at, (view, states), &geometry, &tractions.values) else { return Ok(()) };
        let dim = geometry.space();
        let facets = out.master.iter().chain(out.slave.iter()).flat_map(|force| &force[..dim]);
        rhs.iter_mut().zip(facets).for_each(|(row, force)| *row += force);
        if consistent {
            let unknowns = self.bodies.unknowns(key);
            for (r, &(node, c)) in unknowns.iter().enumerate() {
                let work = |g: usize| dot(out.by_traction[g], tractions.by[g * unknowns.len() + r]);
                rhs[self.pairs.first_row(at, node) + c] += (0..geometry.slave.len()).map(work).sum::<f64>();
            }
        }
        Ok(())
    }

    /// Right-hand side and tangent.
    fn system(
        &self,
        at: usize,
        view: &StepView<'_>,
        (lhs, width): (&mut [f64], usize),
        rhs: &mut [f64],
    ) -> Result<(), EntityError> {
        let key = self.key(at);
        let Tractions { values, by } = self.bodies.tractions(key, view, true)?;
        let states = &self.pairs.states;
        let plain = self.pairs.geometry(at, view, states);
        let (dim, slaves) = (plain.space(), plain.slave.len());
        let (displacements, normals) = (plain.unknowns(), plain.normal_components());
        let all = displacements + 2 * normals;
        let unknowns = self.bodies.unknowns(key);
        let size = unknowns.len();
        let places: Vec<usize> = unknowns.iter().map(|&(node, c)| self.pairs.first_row(at, node) + c).collect();
        let turns = self.pairs.parameters.normal_variation.knows_nodes();
        // The rows of all local unknowns by the variables of the formula, and the factors of the changes of the tractions.
        let mut rows = vec![0.0; width * all];
        let mut weights = Nodal::new(slaves, |_| [0.0; 3]);
        for first in (0..all).step_by(LANES) {
            let mut geometry = self.pairs.seeded(&plain, first);
            if turns {
                geometry.nodal_normals =
                    Nodal::new(slaves, |j| variables_from(first, displacements + dim * j, plain.nodal_normals[j], dim));
            }
            let tractions =
                Nodal::new(slaves, |g| variables_from(first, displacements + normals + dim * g, values[g], dim));
            let Some(out) = self.forces(at, (view, states), &geometry, &tractions) else { return Ok(()) };
            let mut add = |row: usize, factor: f64, force: Active| {
                if first == 0 {
                    rhs[row] += factor * force.value;
                }
                let of_row = &mut rows[row * all + first..(row + 1) * all];
                of_row.iter_mut().zip(force.gradient).for_each(|(sum, d)| *sum += factor * d);
            };
            let facets = out.master.iter().chain(out.slave.iter()).flat_map(|force| &force[..dim]);
            facets.enumerate().for_each(|(row, force)| add(row, 1.0, *force));
            for (r, &row) in places.iter().enumerate() {
                for g in 0..slaves {
                    (0..dim).for_each(|c| add(row, by[g * size + r][c], out.by_traction[g][c]));
                }
            }
            weights = out.by_traction.map(|work| work.map(|w| w.value));
        }

        for (row, derivatives) in rows.chunks_exact(all).enumerate() {
            let lhs = &mut lhs[row * width..(row + 1) * width];
            lhs.iter_mut().zip(&derivatives[..displacements]).for_each(|(entry, d)| *entry -= d);
            for (r, &column) in places.iter().enumerate() {
                let (by_traction, by) = (&derivatives[displacements + normals..], &by);
                let slope = |g: usize| (0..dim).map(move |c| by_traction[dim * g + c] * by[g * size + r][c]);
                lhs[column] -= (0..slaves).flat_map(slope).sum::<f64>();
            }
        }
        if turns {
            let of_normals = displacements..displacements + normals;
            let by_normals: Vec<f64> =
                rows.chunks_exact(all).flat_map(|row| row[of_normals.clone()].to_vec()).collect();
            self.pairs.spread_turning(at, view, &by_normals, (lhs, width));
        }
        if self.formulation.theta != 0.0 {
            self.bodies
                .add_second_derivative(key, view, &weights, |r, s, d| lhs[places[r] * width + places[s]] -= d)?;
        }
        Ok(())
    }
}

impl EntityBlock for NitscheBlock {
    fn entry(&self) -> &'static EntityKind {
        self.pairs.entry
    }

    fn members(&self) -> &[u32] {
        &[]
    }

    fn len(&self) -> usize {
        self.pairs.pairs.len()
    }

    fn nodes(&self, at: usize) -> &[u32] {
        self.pairs.nodes(at)
    }

    fn slave_owners(&self, at: usize) -> &[u32] {
        self.pairs.owners(at)
    }

    fn unknowns(&self) -> &[LocalUnknown] {
        &self.pairs.unknowns
    }

    fn tangent(&self) -> Tangent {
        Tangent::Unsymmetric
    }

    fn is_active(&self, at: usize, _view: &StepView<'_>) -> bool {
        self.pairs.pairs[at].overlapping
    }

    fn local_systems(
        &self,
        view: &StepView<'_>,
        range: Range<usize>,
        request: Request,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        for (slot, at) in range.enumerate() {
            if !self.is_active(at, view) {
                continue;
            }
            let width = out.size;
            let (lhs, rhs) = out.entity(slot);
            if request == Request::Both {
                self.system(at, view, (lhs, width), rhs)?;
            } else {
                self.residual(at, view, rhs)?;
            }
        }
        Ok(())
    }
}

impl ContactBlock for NitscheBlock {
    fn pairs(&self) -> &[Pair] {
        &self.pairs.pairs
    }

    fn pairs_mut(&mut self) -> &mut [Pair] {
        &mut self.pairs.pairs
    }

    fn slaves(&self, at: usize) -> &[SlaveIndex] {
        self.pairs.slaves(at)
    }

    fn masters(&self, at: usize) -> &[u32] {
        self.pairs.master_nodes(at)
    }

    fn set_states(&mut self, states: Arc<SlaveStates>) {
        self.pairs.states = states;
    }

    fn find_operators(&mut self, present: IntegrationState<'_>) {
        self.pairs.find_operators(present);
    }

    /// The forces of points stand for area times traction. Where an element is inverted there are none; the assembly, which
    /// meets the same element, says so.
    fn integrate(&self, present: IntegrationState<'_>) -> Vec<Integral> {
        let IntegrationState { view, states, .. } = present;
        self.pairs.integrate(present, false, &|at, geometry, operators, out| {
            let count = geometry.slave.len();
            if self.formulation.friction.is_some() {
                let last = self.pairs.history(at, view, false);
                let (slave, master) = ((&*geometry.slave, &*last.slave), (&*geometry.master, &*last.master));
                let slip = rotated_slip(&last.rotation(geometry), operators, slave, master, &geometry.nodal_normals);
                out.slip[..count].copy_from_slice(&slip);
            }
            let Ok(tractions) = self.bodies.tractions(self.key(at), view, false) else { return };
            if let Some(forces) = self.forces(at, (view, states), geometry, &tractions.values) {
                out.trial[..count].copy_from_slice(&forces.traction);
                out.history_traction[..count].copy_from_slice(&forces.history_traction);
            }
        })
    }

    fn master_weights(&self, present: IntegrationState<'_>) -> Vec<Option<Nodal<Nodal<f64>>>> {
        self.pairs.master_weights(present)
    }

    fn keep_operators(&mut self, present: IntegrationState<'_>) {
        self.pairs.keep_operators(present);
    }

    fn freeze_choices(&mut self, present: IntegrationState<'_>) {
        self.pairs.freeze_choices(present);
    }

    fn as_entities(&self) -> &dyn EntityBlock {
        self
    }
}
