//! A block of pairs by Nitsche's method: slave and master facets, and the slave's element with the tractions on its face.

use std::ops::Range;
use std::sync::Arc;
use zelus_core::model::EntityKind;

use rayon::prelude::*;
use zelus_core::entities::{EntityBlock, EntityError, LocalSystems, LocalUnknown, StepView, Tangent, Want};
use zelus_core::geometry::Shape;
use zelus_core::scalar::{Dual, Real};
use zelus_core::vector3::{constant, dot};

use super::contact_block::{ContactBlock, Present};
use super::family::PairRequest;
use super::pair::{Integral, Pair};
use super::pair_block::PairBlock;
use crate::formulations::{LastState, Nitsche, NodeOfPoints, PointForces};
use crate::interface::{Bodies, Tractions};
use crate::mortar::shapes::for_shapes;
use crate::mortar::{PairGeometry, dimension};
use crate::slave_states::SlaveStates;

/// The block of Nitsche's method for a pair of shapes (slave, master); `None` for shapes that carry no contact.
pub fn nitsche_block(
    slave: Shape,
    master: Shape,
    request: PairRequest,
    friction: bool,
) -> Option<Box<dyn ContactBlock>> {
    macro_rules! make {
        ($ns:literal, $nm:literal, $nu:literal, $nn:literal, $nv:literal) => {
            NitscheBlock::<$ns, $nm, $nu, $nn, $nv>::boxed(request, friction)
        };
    }
    for_shapes!(slave, master, make)
}

/// Pairs with `NS` slave and `NM` master nodes, `NU` displacement unknowns of the facets, `NN` components of nodal normals,
/// and `NV` = `NU` + 2 `NN` variables: displacements, normals, and tractions at the inner points of the slave.
///
/// Other nodes of the slave's element are among those around the pair.
struct NitscheBlock<const NS: usize, const NM: usize, const NU: usize, const NN: usize, const NV: usize> {
    pairs: PairBlock<Nitsche, NS, NM, NU, NN>,
    bodies: Arc<Bodies>,
}

impl<const NS: usize, const NM: usize, const NU: usize, const NN: usize, const NV: usize>
    NitscheBlock<NS, NM, NU, NN, NV>
{
    /// The block of a request, with friction or without.
    fn boxed(request: PairRequest, friction: bool) -> Box<dyn ContactBlock> {
        const { assert!(NV == NU + 2 * NN && NN == dimension(NS) * NS, "a variable for each unknown of the formula") };
        let (bodies, parameters) = (request.bodies.clone(), request.parameters.clone());
        let friction = friction.then_some(parameters.tangent_factor);
        let formulation = Nitsche { friction, ..parameters.nitsche };
        Box::new(Self { pairs: PairBlock::new(request, formulation), bodies })
    }

    fn key(&self, at: usize) -> [u32; 2] {
        let key = self.pairs.pairs()[at].key;
        [key.interface, key.slave]
    }

    fn nodes_of_points(&self, at: usize, states: &SlaveStates) -> [NodeOfPoints; NS] {
        self.pairs.slaves(at).map(|node| {
            let own = &states[node];
            let (held, stuck) = (f64::from(u8::from(own.pressed)), f64::from(u8::from(own.stuck)));
            NodeOfPoints { carried: own.last.carried, friction: own.friction, held, stuck }
        })
    }

    fn forces<T: Real>(
        &self,
        at: usize,
        (view, states): (&StepView<'_>, &SlaveStates),
        geometry: &PairGeometry<T, NS, NM>,
        tractions: &[[T; 3]; NS],
    ) -> Option<PointForces<T, NS, NM>> {
        let face = self.bodies.slave_face(self.key(at));
        let nodes = self.nodes_of_points(at, states);
        let previous = self.pairs.previous(at, view, states);
        let last = LastState { slave: previous.slave, master: previous.master };
        let settings = &self.pairs.parameters().segmentation;
        self.pairs.formulation().forces(geometry, tractions, (&face, &nodes), &last, settings)
    }

    /// The right-hand side alone.
    fn residual(&self, at: usize, view: &StepView<'_>, rhs: &mut [f64]) -> Result<(), EntityError> {
        let key = self.key(at);
        let consistent = self.pairs.formulation().theta != 0.0;
        let tractions = self.bodies.tractions::<NS>(key, view, consistent)?;
        let states = self.pairs.states();
        let geometry = self.pairs.geometry(at, view, states);
        let Some(out) = self.forces(at, (view, states), &geometry, &tractions.values) else { return Ok(()) };
        let dim = dimension(NS);
        let facets = out.master.iter().chain(&out.slave).flat_map(|force| &force[..dim]);
        rhs.iter_mut().zip(facets).for_each(|(row, force)| *row += force);
        if consistent {
            let unknowns = self.bodies.unknowns(key);
            for (r, &(node, c)) in unknowns.iter().enumerate() {
                let work = |g: usize| dot(out.by_traction[g], tractions.by[g * unknowns.len() + r]);
                rhs[self.pairs.first_row(at, node) + c] += (0..NS).map(work).sum::<f64>();
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
        let (key, dim) = (self.key(at), dimension(NS));
        let Tractions { values, by } = self.bodies.tractions::<NS>(key, view, true)?;
        let states = self.pairs.states();
        let plain = self.pairs.geometry(at, view, states);
        let mut geometry = self.pairs.seeded::<NV>(&plain);
        let variable = |vector: [f64; 3], first: usize| -> [Dual<NV>; 3] {
            let mut out = constant(vector);
            (0..dim).for_each(|c| out[c] = Dual::variable(vector[c], first + c));
            out
        };
        if self.pairs.parameters().normal_variation.knows_nodes() {
            geometry.nodal_normals = std::array::from_fn(|j| variable(plain.nodal_normals[j], NU + dim * j));
        }
        let tractions = std::array::from_fn(|g| variable(values[g], NU + NN + dim * g));
        let Some(out) = self.forces(at, (view, states), &geometry, &tractions) else { return Ok(()) };

        // The rows of all local unknowns by the variables of the formula.
        let mut rows = vec![[0.0; NV]; width];
        let facets = out.master.iter().chain(&out.slave).flat_map(|force| &force[..dim]);
        for (row, force) in facets.enumerate() {
            rhs[row] += force.value;
            rows[row] = force.gradient;
        }
        let unknowns = self.bodies.unknowns(key);
        let size = unknowns.len();
        let places: Vec<usize> = unknowns.iter().map(|&(node, c)| self.pairs.first_row(at, node) + c).collect();
        for (r, &row) in places.iter().enumerate() {
            for g in 0..NS {
                for c in 0..dim {
                    let factor = by[g * size + r][c];
                    rhs[row] += out.by_traction[g][c].value * factor;
                    let gradient = &out.by_traction[g][c].gradient;
                    rows[row].iter_mut().zip(gradient).for_each(|(sum, d)| *sum += factor * d);
                }
            }
        }

        for (row, derivatives) in rows.iter().enumerate() {
            let lhs = &mut lhs[row * width..(row + 1) * width];
            lhs.iter_mut().zip(&derivatives[..NU]).for_each(|(entry, d)| *entry -= d);
            for (r, &column) in places.iter().enumerate() {
                let (by_traction, by) = (&derivatives[NU + NN..], &by);
                let slope = |g: usize| (0..dim).map(move |c| by_traction[dim * g + c] * by[g * size + r][c]);
                lhs[column] -= (0..NS).flat_map(slope).sum::<f64>();
            }
        }
        if self.pairs.parameters().normal_variation.knows_nodes() {
            let by_normals: Vec<[f64; NN]> = rows.iter().map(|row| std::array::from_fn(|n| row[NU + n])).collect();
            self.pairs.spread_turning(at, view, &by_normals, (lhs, width));
        }
        if self.pairs.formulation().theta != 0.0 {
            let weights = out.by_traction.map(|work| work.map(|w| w.value));
            self.bodies
                .add_second_derivative(key, view, &weights, |r, s, d| lhs[places[r] * width + places[s]] -= d)?;
        }
        Ok(())
    }
}

impl<const NS: usize, const NM: usize, const NU: usize, const NN: usize, const NV: usize> EntityBlock
    for NitscheBlock<NS, NM, NU, NN, NV>
{
    fn entry(&self) -> &'static EntityKind {
        self.pairs.entry()
    }

    fn members(&self) -> &[u32] {
        &[]
    }

    fn len(&self) -> usize {
        self.pairs.len()
    }

    fn nodes(&self, at: usize) -> &[u32] {
        self.pairs.nodes(at)
    }

    fn unknowns(&self) -> &[LocalUnknown] {
        self.pairs.unknowns()
    }

    fn tangent(&self) -> Tangent {
        Tangent::General
    }

    fn is_active(&self, at: usize, view: &StepView<'_>) -> bool {
        self.pairs.is_active(at, view)
    }

    fn local_systems(
        &self,
        view: &StepView<'_>,
        range: Range<usize>,
        want: Want,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        for (slot, at) in range.enumerate() {
            if !self.pairs.is_active(at, view) {
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

impl<const NS: usize, const NM: usize, const NU: usize, const NN: usize, const NV: usize> ContactBlock
    for NitscheBlock<NS, NM, NU, NN, NV>
{
    fn pairs(&self) -> &[Pair] {
        self.pairs.pairs()
    }

    fn pairs_mut(&mut self) -> &mut [Pair] {
        self.pairs.pairs_mut()
    }

    fn slave_nodes(&self, at: usize) -> &[u32] {
        self.pairs.slave_nodes(at)
    }

    fn set_states(&mut self, states: Arc<SlaveStates>) {
        self.pairs.set_states(states);
    }

    /// The forces of points stand for area times traction. Where an element is inverted there are none; the assembly, which
    /// meets the same element, says so.
    fn integrate(&self, present: Present<'_>) -> Vec<Integral> {
        let Present { view, states, .. } = present;
        let mut integrals = self.pairs.integrate(present);
        integrals.par_iter_mut().enumerate().with_min_len(32).filter(|(_, found)| found.overlapping).for_each(
            |(at, found)| {
                let Ok(tractions) = self.bodies.tractions::<NS>(self.key(at), view, false) else { return };
                let geometry = self.pairs.geometry(at, view, states);
                if let Some(forces) = self.forces(at, (view, states), &geometry, &tractions.values) {
                    found.trial[..NS].copy_from_slice(&forces.slave);
                    found.carried[..NS].copy_from_slice(&forces.carried);
                }
            },
        );
        integrals
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
