//! A block of pairs of one family and one pair of shapes.

use std::ops::Range;
use std::sync::Arc;

use zelus_core::entities::{EntityBlock, EntityError, LocalSystems, LocalUnknown, StepView, Tangent, Want};
use zelus_core::geometry::{FacetShape, NodeArray, Shape};
use zelus_core::model::EntityKind;

use super::contact_block::{ContactBlock, Present};
use super::family::PairRequest;
use super::pair::{Integral, Pair};
use super::pairs_of_shapes::PairsOfShapes;
use crate::formulations::{self, Formulation, Kinematics, PairHistory, SlaveNode};
use crate::kratos::FirstIterateTangent;
use crate::mortar::shapes::for_shapes;
use crate::mortar::{PairGeometry, lanes};
use crate::slave_states::SlaveStates;

/// The block of a formulation for a pair of shapes (slave, master); `None` for shapes that carry no contact.
pub(super) fn pair_block<F: Formulation>(
    slave: Shape,
    master: Shape,
    request: PairRequest,
) -> Option<Box<dyn ContactBlock>> {
    macro_rules! make {
        ($slave:ty, $master:ty, $end:literal) => {{
            const NU: usize = lanes::<$slave, $master>(PairGeometry::<f64, $slave, $master>::UNKNOWNS);
            const NN: usize = lanes::<$slave, $master>(PairGeometry::<f64, $slave, $master>::NORMALS);
            PairBlock::<F, $slave, $master, NU, NN>::boxed(request)
        }};
    }
    for_shapes!(slave, master, make)
}

/// Pairs of two shapes, differentiated by `NU` displacement unknowns and by `NN` components of nodal normals at once.
struct PairBlock<F, S: FacetShape, M: FacetShape, const NU: usize, const NN: usize> {
    formulation: F,
    pairs: PairsOfShapes<S, M>,
}

impl<F: Formulation, S: FacetShape, M: FacetShape, const NU: usize, const NN: usize> PairBlock<F, S, M, NU, NN> {
    /// The block of a request.
    fn boxed(request: PairRequest) -> Box<dyn ContactBlock> {
        let formulation = F::new(&request.parameters);
        Box::new(Self { formulation, pairs: PairsOfShapes::new(request, F::MULTIPLIER) })
    }

    fn history(&self, at: usize, view: &StepView<'_>, states: &SlaveStates) -> F::History<S, M> {
        F::History::of(self.pairs.pairs[at].previous.operators(), &self.pairs.previous(at, view, states))
    }

    fn multipliers(&self, at: usize, view: &StepView<'_>) -> S::Nodal<[f64; 3]> {
        S::map(&self.pairs.slaves(at), |n| F::MULTIPLIER.value(view.nodes, n))
    }

    /// Adds to the tangent of a pair what the turning of its nodal normals does: −∂b/∂n ∂n/∂x.
    fn add_turning(
        &self,
        at: usize,
        view: &StepView<'_>,
        geometry: &PairGeometry<f64, S, M>,
        nodes: &S::Nodal<SlaveNode>,
        multipliers: &S::Nodal<[f64; 3]>,
        history: &F::History<S, M>,
        (lhs, width): (&mut [f64], usize),
    ) {
        let (rows, count) = (self.pairs.equations(), PairGeometry::<f64, S, M>::NORMALS);
        let mut by_normals = vec![0.0; rows * count];
        let keep = |row: usize, first: usize, derivatives: &[f64]| {
            let at = row * count + first;
            by_normals[at..at + derivatives.len()].copy_from_slice(derivatives);
        };
        formulations::by_normals::<_, _, _, NN>(
            &self.formulation,
            geometry,
            &self.pairs.parameters.segmentation,
            nodes,
            multipliers,
            history,
            keep,
        );
        self.pairs.spread_turning(at, view, &by_normals, (lhs, width));
    }
}

impl<F: Formulation, S: FacetShape, M: FacetShape, const NU: usize, const NN: usize> EntityBlock
    for PairBlock<F, S, M, NU, NN>
{
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

    fn equations(&self) -> usize {
        self.pairs.equations()
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
        let Self { formulation, pairs } = self;
        for (slot, at) in range.enumerate() {
            if !pairs.pairs[at].overlapping {
                continue;
            }
            let geometry = pairs.geometry(at, view, &pairs.states);
            let nodes = pairs.slave_constants(at, &pairs.states);
            let multipliers = self.multipliers(at, view);
            let history = self.history(at, view, &pairs.states);
            let settings = &pairs.parameters.segmentation;
            let (width, rows) = (out.size, self.equations());
            let (lhs, rhs) = out.entity(slot);
            let rhs = &mut rhs[..rows];
            if want == Want::Both {
                let lhs = &mut lhs[..rows * width];
                formulations::tangent(
                    formulation,
                    |first| pairs.seeded::<NU>(&geometry, first),
                    settings,
                    FirstIterateTangent::of(view, S::SPACE),
                    &nodes,
                    &multipliers,
                    &history,
                    (lhs, width),
                    rhs,
                );
                let acts = nodes.iter().any(|node| node.state.is_active());
                if acts && pairs.parameters.normal_variation.knows_nodes() {
                    self.add_turning(at, view, &geometry, &nodes, &multipliers, &history, (lhs, width));
                }
            } else {
                let found = pairs.operators_of(at, &geometry);
                formulations::residual(formulation, &geometry, found, &nodes, &multipliers, &history, rhs);
            }
        }
        Ok(())
    }
}

impl<F: Formulation, S: FacetShape, M: FacetShape, const NU: usize, const NN: usize> ContactBlock
    for PairBlock<F, S, M, NU, NN>
{
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

    fn integrate(&self, present: Present<'_>) -> Vec<Integral> {
        let Present { view, states, .. } = present;
        self.pairs.integrate(present, &|at, geometry, operators, out| {
            let history = self.history(at, view, states);
            let pair = Kinematics::new(geometry, operators, &S::nodal(|_| [0.0; 3]));
            let slip = self.formulation.weighted_slip(&pair, &history);
            let trial = self.formulation.weighted_trial(&pair, &self.pairs.slave_constants(at, states), &history);
            out.slip[..S::NODES].copy_from_slice(slip.as_slice());
            if let Some(trial) = trial {
                out.trial[..S::NODES].copy_from_slice(trial.as_slice());
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
