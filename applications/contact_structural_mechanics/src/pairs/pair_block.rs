//! A block of pairs of two shapes under one law.

use std::cell::OnceCell;
use std::ops::Range;
use std::sync::Arc;

use zelus_core::entities::{EntityBlock, EntityError, LocalSystems, LocalUnknown, Request, StepView, Tangent};
use zelus_core::geometry::Nodal;
use zelus_core::model::EntityKind;
use zelus_core::vector3::{add, scale};

use super::contact_block::{ContactBlock, IntegrationState};
use super::kinematics::PairHistory;
use super::local_system::{PairSystem, multipliers_of};
use super::pair::{Integral, Pair};
use super::pair_request::PairRequest;
use super::pairs_of_shapes::PairsOfShapes;
use crate::interface::SlaveIndex;
use crate::kratos::FirstIterateTangent;
use crate::law::{Augmentation, ContactLaw, SlipMeasure};
use crate::mortar::{Active, Operators};
use crate::slave_nodes::SlaveStates;

/// Pairs of two shapes under one law.
pub(super) struct PairBlock {
    law: Box<dyn ContactLaw>,
    pairs: PairsOfShapes,
}

impl PairBlock {
    /// The block of a request.
    pub(super) fn new(law: Box<dyn ContactLaw>, request: PairRequest) -> Self {
        let pairs = PairsOfShapes::new(request, law.multiplier());
        Self { law, pairs }
    }

    fn history(&self, at: usize, view: &StepView<'_>) -> PairHistory {
        self.pairs.history(at, view, matches!(self.law.slip(), SlipMeasure::OfOperators(_)))
    }

    /// Whether a pair has no overlap any more, and still counts in the slip: the facets are where its nodes were at the start of the step.
    fn is_left(&self, at: usize) -> bool {
        let pair = &self.pairs.pairs[at];
        !pair.overlapping && !pair.previous.is_empty() && self.counts_left_pairs()
    }

    /// Not where pairs augment, as in Kratos.
    fn counts_left_pairs(&self) -> bool {
        matches!(self.law.slip(), SlipMeasure::OfOperators(_))
            && self.pairs.parameters.augmentation == Augmentation::Node
    }

    /// Adds to the tangent of a pair the effect of the rotation of its nodal normals: −∂b/∂n ∂n/∂x.
    fn add_turning(
        &self,
        at: usize,
        view: &StepView<'_>,
        system: &PairSystem<'_>,
        (lhs, width): (&mut [f64], usize),
        room: &mut Operators<Active>,
    ) {
        let (rows, count) = (self.pairs.equations(), system.geometry.normal_components());
        let mut by_normals = vec![0.0; rows * count];
        system.by_normals(room, &mut |row, first, derivatives| {
            let at = row * count + first;
            by_normals[at..at + derivatives.len()].copy_from_slice(derivatives);
        });
        self.pairs.spread_turning(at, view, &by_normals, (lhs, width));
    }
}

impl EntityBlock for PairBlock {
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

    fn equations(&self) -> usize {
        self.pairs.equations()
    }

    fn tangent(&self) -> Tangent {
        Tangent::Unsymmetric
    }

    fn is_active(&self, at: usize, _view: &StepView<'_>) -> bool {
        self.pairs.pairs[at].overlapping || self.is_left(at)
    }

    fn local_systems(
        &self,
        view: &StepView<'_>,
        range: Range<usize>,
        request: Request,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        let Self { law, pairs } = self;
        let mut room = Operators::room();
        for (slot, at) in range.enumerate() {
            let is_left = self.is_left(at);
            if !pairs.pairs[at].overlapping && !is_left {
                continue;
            }
            let geometry = pairs.geometry(at, view, &pairs.states);
            let nodes = pairs.slave_constants(at, &pairs.states);
            let multipliers =
                multipliers_of(law.multiplier(), pairs.slaves(at).len(), pairs.owners(at), view.slave_nodes);
            let history = self.history(at, view);
            let system = PairSystem {
                law: law.as_ref(),
                geometry: &geometry,
                settings: &pairs.parameters.segmentation,
                nodes: &nodes,
                multipliers: &multipliers,
                history: &history,
                is_left,
                points: OnceCell::new(),
            };
            let (width, rows) = (out.size, self.equations());
            let (lhs, rhs) = out.entity(slot);
            let rhs = &mut rhs[..rows];
            if request == Request::Both {
                let lhs = &mut lhs[..rows * width];
                let knows = FirstIterateTangent::of(view, geometry.space());
                let found = || system.present(&|| pairs.operators_of(at, &geometry));
                system.tangent(&found, &|first| pairs.seeded(&geometry, first), knows, (lhs, width), rhs, &mut room);
                let acts = nodes.iter().any(|node| node.state.is_active());
                if acts && pairs.parameters.normal_variation.knows_nodes() {
                    self.add_turning(at, view, &system, (lhs, width), &mut room);
                }
            } else {
                system.residual(&system.present(&|| pairs.operators_of(at, &geometry)), rhs);
            }
        }
        Ok(())
    }
}

impl ContactBlock for PairBlock {
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

    fn integrate(&self, present: IntegrationState<'_>) -> Vec<Integral> {
        let IntegrationState { view, states, .. } = present;
        self.pairs.integrate(present, self.counts_left_pairs(), &|at, geometry, operators, out| {
            let system = PairSystem {
                law: self.law.as_ref(),
                geometry,
                settings: &self.pairs.parameters.segmentation,
                nodes: &self.pairs.slave_constants(at, states),
                multipliers: &Nodal::new(geometry.slave.len(), |_| [0.0; 3]),
                history: &self.history(at, view),
                is_left: !out.overlapping,
                points: OnceCell::new(),
            };
            system.inputs_and_trial(operators, &mut |j, inputs, trial| {
                out.slip[j] = inputs.slip;
                out.sliding[j] = add(inputs.slip, scale(inputs.sliding, inputs.area));
                out.trial[j] = trial.unwrap_or(out.trial[j]);
            });
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
