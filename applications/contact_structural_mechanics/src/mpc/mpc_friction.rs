//! Friction of contact by constraints: which nodes slide, and in which direction friction pushes them.

use std::collections::BTreeMap;

use zelus_core::entities::SetChange;
use zelus_core::model::{EntityKind, ModelPart};
use zelus_core::vector3::{dot, norm, scale, sub};
use zelus_structural_mechanics::variables::REACTION;

use super::node_relation::NodeRelation;
use super::slider_forces::{Slider, SliderForces};
use crate::active_set::length_tolerance;
use crate::law::{Bound, NodeState, SlipRule};
use crate::mortar::tangential;
use crate::slave_nodes::SlaveStates;
use crate::tolerances::is_more;

/// Stiffness of the trial force, in those of the body: large, so that its direction is that of the slip.
const DIRECTION: f64 = 1e3;

/// The nodes that slide on their constraints.
pub(crate) struct MpcFriction {
    /// How stick and slip are told apart.
    pub rule: SlipRule,
    /// The condition of sliders, where there is friction.
    pub entry: Option<&'static EntityKind>,
    /// Blocks of those that slide.
    pub sliders: Vec<SliderForces>,
    /// Unit direction of friction on each of them.
    pub directions: BTreeMap<u32, [f64; 3]>,
    /// Number of the present set of blocks.
    pub graph: u64,
    saved: BTreeMap<u32, [f64; 3]>,
}

impl Default for MpcFriction {
    fn default() -> Self {
        let (directions, saved) = (BTreeMap::new(), BTreeMap::new());
        Self { rule: SlipRule::Pure, entry: None, sliders: Vec::new(), directions, graph: 1, saved }
    }
}

impl MpcFriction {
    /// Friction at the active nodes: which of them slide, and the forces on those that do.
    pub(crate) fn update(
        &mut self,
        part: &ModelPart,
        relations: &BTreeMap<u32, NodeRelation>,
        states: &mut SlaveStates,
        stiffness: impl Fn(u32) -> f64,
        change: &mut SetChange,
    ) {
        let before = std::mem::take(&mut self.directions);
        states.for_all(|state| state.kinematics.weighted_slip = [0.0; 3]);
        let mut sliders = Vec::new();
        let resolved = length_tolerance(part, &states.mesh_nodes());
        for (&node, relation) in relations {
            let slave = states.only_at(node);
            let state = &mut states[slave];
            if !state.law.active {
                continue;
            }
            let n = relation.normal;
            let moved = tangential(sub(relation.lead(part, node, 0), relation.lead(part, node, 1)), n);
            let moved = if norm(moved) > resolved { moved } else { [0.0; 3] };
            let area = state.kinematics.area;
            state.kinematics.weighted_slip = scale(moved, area);
            let held = reaction(part, node);
            let Bound { coefficient, threshold } = state.parameters.friction;
            let constant = threshold * area;
            let bound = Bound { coefficient, threshold: constant }.at(dot(held, n).min(0.0));
            let sliding = state.law.slides == Some(true);
            let stiffness = stiffness(node) * area;
            // The friction of a sliding node keeps its direction but for the rotation by the slip.
            let kept = direction_along(before.get(&node), n);
            // A node that slides along with its friction would gain energy: it sticks, or turns where it slides far.
            let near = stiffness * norm(moved) < 2.0 * bound;
            let slides = match (self.rule, sliding) {
                (SlipRule::Pure, _) => true,
                (_, true) => !near || dot(moved, kept) <= 0.0,
                (_, false) => is_more(norm(tangential(held, n)), bound),
            };
            let stiffness = DIRECTION * stiffness;
            let trial = if sliding { sub(scale(kept, bound), scale(moved, stiffness)) } else { tangential(held, n) };
            if slides != sliding {
                state.law.slides = Some(slides);
                change.stick_slip.push(part.nodes.ids[node as usize]);
            }
            if slides {
                sliders.push(Slider::new(node, relation.weights.clone(), n, trial, [bound, constant], stiffness));
            }
        }
        self.set_sliders(sliders, part.info.domain_size);
    }

    /// Takes these sliders in place of those there are.
    pub(crate) fn set_sliders(&mut self, sliders: Vec<Slider>, dimension: usize) {
        self.directions = sliders.iter().map(|slider| (slider.node, slider.direction)).collect();
        let Some(entry) = self.entry else { return };
        let blocks = SliderForces::blocks(entry, sliders, dimension);
        if !blocks.iter().map(SliderForces::all_nodes).eq(self.sliders.iter().map(SliderForces::all_nodes)) {
            self.graph += 1;
        }
        self.sliders = blocks;
    }

    /// Nodes that slide from the step before begin in the direction they had.
    pub(crate) fn slide_on(&mut self, part: &ModelPart, relations: &BTreeMap<u32, NodeRelation>, states: &SlaveStates) {
        let before = std::mem::take(&mut self.directions);
        let slides = |node: u32| states[states.only_at(node)].contact() == NodeState::Slip;
        let sliders = relations.iter().filter(|(node, _)| slides(**node)).map(|(&node, relation)| {
            let direction = direction_along(before.get(&node), relation.normal);
            let state = &states[states.only_at(node)];
            let constant = state.parameters.friction.threshold * state.kinematics.area;
            Slider::new(node, relation.weights.clone(), relation.normal, direction, [constant; 2], 0.0)
        });
        let sliders = sliders.collect();
        self.set_sliders(sliders, part.info.domain_size);
    }

    /// Keeps the directions of an accepted state.
    pub(crate) fn save(&mut self) {
        self.saved = self.directions.clone();
    }

    /// Goes back to the directions kept last.
    pub(crate) fn restore(&mut self) {
        self.directions = std::mem::take(&mut self.saved);
    }
}

/// The unit vector of the part of a direction in the tangent of a normal; none where there is none.
fn direction_along(direction: Option<&[f64; 3]>, normal: [f64; 3]) -> [f64; 3] {
    let along = direction.map_or([0.0; 3], |direction| tangential(*direction, normal));
    let size = norm(along);
    if size > 0.0 { scale(along, size.recip()) } else { along }
}

/// Force of the constraint on a node.
pub(crate) fn reaction(part: &ModelPart, node: u32) -> [f64; 3] {
    part.nodes.history.get(REACTION.name()).map_or([0.0; 3], |field| field.vector(0, node as usize))
}
