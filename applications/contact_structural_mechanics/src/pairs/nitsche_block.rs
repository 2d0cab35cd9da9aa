//! A block of pairs by Nitsche's method: slave and master facets, and the slave's element with the tractions on its face.

use std::ops::Range;
use std::sync::Arc;
use zelus_core::model::EntityKind;

use zelus_core::entities::{EntityBlock, EntityError, LocalSystems, LocalUnknown, StepView, Tangent, Want};
use zelus_core::geometry::{FacetShape, NodeArray, Shape};
use zelus_core::scalar::{Dual, Real};
use zelus_core::vector3::dot;

use super::contact_block::{ContactBlock, Present};
use super::family::PairRequest;
use super::pair::{Integral, Pair};
use super::pairs_of_shapes::PairsOfShapes;
use crate::formulations::{Kinematics, LastState, Multiplier, Nitsche, NodeOfPoints, PointForces};
use crate::interface::{Bodies, Tractions};
use crate::mortar::shapes::for_shapes;
use crate::mortar::{PairGeometry, lanes, variables_from};
use crate::slave_states::SlaveStates;

/// The block of Nitsche's method for a pair of shapes (slave, master); `None` for shapes that carry no contact.
pub fn nitsche_block(
    slave: Shape,
    master: Shape,
    request: PairRequest,
    friction: bool,
) -> Option<Box<dyn ContactBlock>> {
    macro_rules! make {
        ($slave:ty, $master:ty, $end:literal) => {{
            const ALL: usize = variables::<$slave, $master>();
            const LANES: usize = lanes::<$slave, $master>(ALL);
            NitscheBlock::<$slave, $master, LANES>::boxed(request, friction)
        }};
    }
    for_shapes!(slave, master, make)
}

/// Variables of the formula of a pair: its displacements, components of nodal normals, and tractions at the inner points of the slave.
const fn variables<S: FacetShape, M: FacetShape>() -> usize {
    PairGeometry::<f64, S, M>::UNKNOWNS + 2 * PairGeometry::<f64, S, M>::NORMALS
}

/// Pairs of two shapes, differentiated by `LANES` variables at once.
///
/// Other nodes of the slave's element are among those around the pair.
struct NitscheBlock<S: FacetShape, M: FacetShape, const LANES: usize> {
    formulation: Nitsche,
    pairs: PairsOfShapes<S, M>,
    bodies: Arc<Bodies>,
}

impl<S: FacetShape, M: FacetShape, const LANES: usize> NitscheBlock<S, M, LANES> {
    /// The block of a request, with friction or without.
    fn boxed(request: PairRequest, friction: bool) -> Box<dyn ContactBlock> {
        let (bodies, parameters) = (request.bodies.clone(), request.parameters.clone());
        let friction = friction.then_some(parameters.tangent_factor);
        let formulation = Nitsche { friction, ..parameters.nitsche };
        Box::new(Self { formulation, pairs: PairsOfShapes::new(request, Multiplier::Body), bodies })
    }

    fn key(&self, at: usize) -> [u32; 2] {
        let key = self.pairs.pairs[at].key;
        [key.interface, key.slave]
    }

    fn last(&self, at: usize, view: &StepView<'_>, states: &SlaveStates) -> LastState<S, M> {
        let PairGeometry { slave, master, .. } = self.pairs.previous(at, view, states);
        LastState { slave, master }
    }

    fn nodes_of_points(&self, at: usize, states: &SlaveStates) -> S::Nodal<NodeOfPoints> {
        S::map(&self.pairs.slaves(at), |node| {
            let own = &states[node];
            let (held, stuck) = (f64::from(u8::from(own.pressed)), f64::from(u8::from(own.stuck)));
            NodeOfPoints { carried: own.last.carried, friction: own.friction, held, stuck }
        })
    }

    fn forces<T: Real>(
        &self,
        at: usize,
        (view, states): (&StepView<'_>, &SlaveStates),
        geometry: &PairGeometry<T, S, M>,
        tractions: &S::Nodal<[T; 3]>,
    ) -> Option<PointForces<T, S, M>> {
        let face = self.bodies.slave_face(self.key(at));
        let nodes = self.nodes_of_points(at, states);
        let last = self.last(at, view, states);
        let settings = &self.pairs.parameters.segmentation;
        self.formulation.forces(geometry, tractions, (&face, &nodes), &last, settings)
    }

    /// The right-hand side alone.
    fn residual(&self, at: usize, view: &StepView<'_>, rhs: &mut [f64]) -> Result<(), EntityError> {
        let key = self.key(at);
        let consistent = self.formulation.theta != 0.0;
        let tractions = self.bodies.tractions::<S>(key, view, consistent)?;
        let states = &self.pairs.states;
        let geometry = self.pairs.geometry(at, view, states);
        let Some(out) = self.forces(at, (view, states), &geometry, &tractions.values) else { return Ok(()) };
        let dim = S::SPACE;
        let facets = out.master.iter().chain(out.slave.iter()).flat_map(|force| &force[..dim]);
        rhs.iter_mut().zip(facets).for_each(|(row, force)| *row += force);
        if consistent {
            let unknowns = self.bodies.unknowns(key);
            for (r, &(node, c)) in unknowns.iter().enumerate() {
                let work = |g: usize| dot(out.by_traction[g], tractions.by[g * unknowns.len() + r]);
                rhs[self.pairs.first_row(at, node) + c] += (0..S::NODES).map(work).sum::<f64>();
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
        let (key, dim) = (self.key(at), S::SPACE);
        let Tractions { values, by } = self.bodies.tractions::<S>(key, view, true)?;
        let states = &self.pairs.states;
        let plain = self.pairs.geometry(at, view, states);
        let (displacements, normals) = (PairGeometry::<f64, S, M>::UNKNOWNS, PairGeometry::<f64, S, M>::NORMALS);
        let all = variables::<S, M>();
        let unknowns = self.bodies.unknowns(key);
        let size = unknowns.len();
        let places: Vec<usize> = unknowns.iter().map(|&(node, c)| self.pairs.first_row(at, node) + c).collect();
        let turns = self.pairs.parameters.normal_variation.knows_nodes();
        // The rows of all local unknowns by the variables of the formula, and what works on changes of the tractions.
        let mut rows = vec![0.0; width * all];
        let mut weights = S::nodal(|_| [0.0; 3]);
        for first in (0..all).step_by(LANES) {
            let mut geometry = self.pairs.seeded::<LANES>(&plain, first);
            if turns {
                geometry.nodal_normals =
                    S::nodal(|j| variables_from(first, displacements + dim * j, plain.nodal_normals[j], dim));
            }
            let tractions = S::nodal(|g| variables_from(first, displacements + normals + dim * g, values[g], dim));
            let Some(out) = self.forces(at, (view, states), &geometry, &tractions) else { return Ok(()) };
            let mut add = |row: usize, factor: f64, force: Dual<LANES>| {
                if first == 0 {
                    rhs[row] += factor * force.value;
                }
                let of_row = &mut rows[row * all + first..(row + 1) * all];
                of_row.iter_mut().zip(force.gradient).for_each(|(sum, d)| *sum += factor * d);
            };
            let facets = out.master.iter().chain(out.slave.iter()).flat_map(|force| &force[..dim]);
            facets.enumerate().for_each(|(row, force)| add(row, 1.0, *force));
            for (r, &row) in places.iter().enumerate() {
                for g in 0..S::NODES {
                    (0..dim).for_each(|c| add(row, by[g * size + r][c], out.by_traction[g][c]));
                }
            }
            weights = S::map(&out.by_traction, |work| work.map(|w| w.value));
        }

        for (row, derivatives) in rows.chunks_exact(all).enumerate() {
            let lhs = &mut lhs[row * width..(row + 1) * width];
            lhs.iter_mut().zip(&derivatives[..displacements]).for_each(|(entry, d)| *entry -= d);
            for (r, &column) in places.iter().enumerate() {
                let (by_traction, by) = (&derivatives[displacements + normals..], &by);
                let slope = |g: usize| (0..dim).map(move |c| by_traction[dim * g + c] * by[g * size + r][c]);
                lhs[column] -= (0..S::NODES).flat_map(slope).sum::<f64>();
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
                .add_second_derivative::<S>(key, view, &weights, |r, s, d| lhs[places[r] * width + places[s]] -= d)?;
        }
        Ok(())
    }
}

impl<S: FacetShape, M: FacetShape, const LANES: usize> EntityBlock for NitscheBlock<S, M, LANES> {
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

    fn unknowns(&self) -> &[LocalUnknown] {
        &self.pairs.unknowns
    }

    fn tangent(&self) -> Tangent {
        Tangent::General
    }

    fn is_active(&self, at: usize, _view: &StepView<'_>) -> bool {
        self.pairs.pairs[at].overlapping
    }

    fn local_systems(
        &self,
        view: &StepView<'_>,
        range: Range<usize>,
        want: Want,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        for (slot, at) in range.enumerate() {
            if !self.is_active(at, view) {
                continue;
            }
            let width = out.size;
            let (lhs, rhs) = out.entity(slot);
            if want == Want::Both {
                self.system(at, view, (lhs, width), rhs)?;
            } else {
                self.residual(at, view, rhs)?;
            }
        }
        Ok(())
    }
}

impl<S: FacetShape, M: FacetShape, const LANES: usize> ContactBlock for NitscheBlock<S, M, LANES> {
    fn pairs(&self) -> &[Pair] {
        &self.pairs.pairs
    }

    fn pairs_mut(&mut self) -> &mut [Pair] {
        &mut self.pairs.pairs
    }

    fn slave_nodes(&self, at: usize) -> &[u32] {
        self.pairs.slave_nodes(at)
    }

    fn set_states(&mut self, states: Arc<SlaveStates>) {
        self.pairs.states = states;
    }

    fn find_operators(&mut self, present: Present<'_>) {
        self.pairs.find_operators(present);
    }

    /// The forces of points stand for area times traction. Where an element is inverted there are none; the assembly, which
    /// meets the same element, says so.
    fn integrate(&self, present: Present<'_>) -> Vec<Integral> {
        let Present { view, states, .. } = present;
        self.pairs.integrate(present, &|at, geometry, operators, out| {
            if self.formulation.friction.is_some() {
                let pair = Kinematics::new(geometry, operators, &S::nodal(|_| [0.0; 3]));
                out.slip[..S::NODES].copy_from_slice(self.last(at, view, states).slip(&pair).as_slice());
            }
            let Ok(tractions) = self.bodies.tractions::<S>(self.key(at), view, false) else { return };
            if let Some(forces) = self.forces(at, (view, states), geometry, &tractions.values) {
                out.trial[..S::NODES].copy_from_slice(forces.traction.as_slice());
                out.carried[..S::NODES].copy_from_slice(forces.carried.as_slice());
            }
        })
    }

    fn keep_operators(&mut self, present: Present<'_>) {
        self.pairs.keep_operators(present);
    }

    fn freeze_choices(&mut self, present: Present<'_>) {
        self.pairs.freeze_choices(present);
    }

    fn as_entities(&self) -> &dyn EntityBlock {
        self
    }
}
