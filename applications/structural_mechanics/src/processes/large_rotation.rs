//! Couplings whose constraints follow the rotation of a reference node: R = exp [θ − β]×.
//!
//! θ is ROTATION and counts on beyond a whole turn; the turns β are taken out of it where |θ − β| passes half a turn at the start of a
//! step, so that T is regular. Then the rates of θ change, T θ̇ and T θ̈ + Ṫ θ̇ do not. With β = 0 the reference node has supports for its
//! rotation about all axes: θ is then prescribed, of any size.

use zelus_core::diagnostics::Result;
use zelus_core::entities::{
    ActiveSet, Coupling, EntityBlock, Interaction, Join, LocalUnknown, SetChange, require_kind,
};
use zelus_core::model::{EntityRole, ModelPart, Variable};
use zelus_core::vector3::{add, sub};

use super::reference_node::components;
use super::rotation_stiffness::{RotationStiffness, RotationTangent};
use super::rotation_vector::{spin, spin_rate, unspin, within_half_turn};
use crate::variables::{ANGULAR_ACCELERATION, ANGULAR_VELOCITY, DISPLACEMENT, ROTATION, WHOLE_TURNS};

/// A coupling that follows the rotation of its reference node.
pub(super) trait RotatingCoupling: Send + Sync {
    /// The reference node.
    fn reference(&self) -> u32;

    /// Takes the constraints at the present state; a step `begins` or goes on.
    ///
    /// # Errors
    /// A state whose rotation is unknown.
    fn follow(&mut self, part: &mut ModelPart, begins: bool) -> Result<()>;

    /// Nodes whose displacements state the rotation; none where ROTATION of the reference node does.
    fn sample(&self) -> &[u32] {
        &[]
    }

    /// The tangent of its forces at the present state, whose forces are minus REACTION and REACTION_MOMENT; `None` where it has none.
    /// Collective.
    fn tangent(&self, part: &ModelPart) -> Option<RotationTangent>;
}

/// A vector of a node now; zero where the model has none.
pub(super) fn vector_at(part: &ModelPart, variable: &Variable<[f64; 3]>, node: u32) -> [f64; 3] {
    part.nodes.history.get(variable.name()).map_or([0.0; 3], |field| field.vector(0, node as usize))
}

/// θ − β of a reference node.
pub(super) fn rotation_of(part: &ModelPart, node: u32) -> [f64; 3] {
    sub(vector_at(part, &ROTATION, node), vector_at(part, &WHOLE_TURNS, node))
}

/// Takes whole turns out of a rotation beyond half a turn.
fn take_turns(part: &mut ModelPart, node: u32) {
    let [_, rotations] = components(part.info.domain_size);
    let before = rotation_of(part, node);
    let after = within_half_turn(before);
    if after == before || rotations.iter().all(|&c| part.nodes.is_fixed(ROTATION.component(c), node)) {
        return;
    }
    let turns = sub(vector_at(part, &ROTATION, node), after);
    let [rate, change] = [&ANGULAR_VELOCITY, &ANGULAR_ACCELERATION].map(|of| vector_at(part, of, node));
    let new_rate = unspin(after, spin(before, rate));
    let turning = sub(spin_rate(before, rate), spin_rate(after, new_rate));
    let new_change = unspin(after, add(spin(before, change), turning));
    let new = [(&WHOLE_TURNS, turns), (&ANGULAR_VELOCITY, new_rate), (&ANGULAR_ACCELERATION, new_change)];
    for (variable, value) in new {
        let Some(field) = part.nodes.history.get_mut(variable.name()) else { continue };
        // The step begins from the last one, and both are levels of it.
        field.levels.iter_mut().take(2).for_each(|level| level[3 * node as usize..][..3].copy_from_slice(&value));
    }
}

/// A coupling whose constraints follow large rotations.
pub(super) struct LargeRotation {
    coupling: Box<dyn RotatingCoupling>,
    version: u64,
    /// The tangent of its forces; `None` before it is made.
    stiffness: Option<RotationStiffness>,
    /// Whether it acts in this step: supports do not prescribe the rotation.
    is_free: bool,
}

impl LargeRotation {
    /// The coupling at rest.
    pub fn new(coupling: Box<dyn RotatingCoupling>) -> Self {
        Self { coupling, version: 0, stiffness: None, is_free: false }
    }

    /// Makes the block of the tangent.
    fn make_stiffness(&self, part: &ModelPart) -> Result<RotationStiffness> {
        let space = part.info.domain_size;
        let entry = require_kind(EntityRole::Condition, &format!("PointMomentCondition{space}D1N"))?;
        let [translations, rotations] = components(space);
        let sample = self.coupling.sample();
        if sample.is_empty() {
            let unknowns = rotations.iter().map(|&c| LocalUnknown::of_node(0, ROTATION.component(c))).collect();
            return Ok(RotationStiffness::new(entry, vec![self.coupling.reference()], unknowns));
        }
        let of_node = |node| translations.iter().map(move |&c| LocalUnknown::of_node(node, DISPLACEMENT.component(c)));
        let unknowns = (0..sample.len() as u8).flat_map(of_node).collect();
        Ok(RotationStiffness::new(entry, sample.to_vec(), unknowns))
    }

    fn follow(&mut self, part: &mut ModelPart, begins: bool) -> Result<()> {
        self.version += 1;
        self.coupling.follow(part, begins)
    }
}

impl Interaction for LargeRotation {
    fn name(&self) -> &str {
        "coupling"
    }

    fn drives(&self) -> bool {
        false
    }

    fn initialize(&mut self, part: &mut ModelPart) -> Result<()> {
        // Explicit steps take no tangent.
        self.stiffness = if part.info.solver.explicit { None } else { Some(self.make_stiffness(part)?) };
        Ok(())
    }

    fn begin_step(&mut self, part: &mut ModelPart) -> Result<()> {
        let [_, rotations] = components(part.info.domain_size);
        let node = self.coupling.reference();
        self.is_free = !rotations.iter().all(|&c| part.nodes.is_fixed(ROTATION.component(c), node));
        // Forces of this step are not known yet.
        self.stiffness.iter_mut().for_each(|own| own.tangent = RotationTangent::default());
        take_turns(part, self.coupling.reference());
        self.follow(part, true)
    }

    fn constraints_version(&self) -> u64 {
        self.version
    }

    fn joins(&self, _part: &ModelPart) -> Option<Vec<Join>> {
        Some(Vec::new())
    }

    fn coupling(&self) -> Option<&dyn Coupling> {
        Some(self)
    }

    fn active_set(&mut self) -> Option<&mut dyn ActiveSet> {
        Some(self)
    }
}

impl Coupling for LargeRotation {
    fn blocks(&self) -> Vec<&dyn EntityBlock> {
        self.stiffness.iter().filter(|_| self.is_free).map(|own| own as &dyn EntityBlock).collect()
    }

    fn graph_version(&self) -> u64 {
        u64::from(self.is_free)
    }
}

impl ActiveSet for LargeRotation {
    fn needs_reactions(&self) -> bool {
        self.is_free && self.stiffness.is_some()
    }

    fn after_update(&mut self, part: &mut ModelPart, _iteration: usize) -> Result<SetChange> {
        if let Some(own) = self.stiffness.as_mut().filter(|_| self.is_free) {
            let tangent = self.coupling.tangent(part).unwrap_or_default();
            // One rank assembles it.
            let is_own = part.owns_node(self.coupling.reference() as usize);
            own.tangent = if is_own { tangent } else { RotationTangent::default() };
        }
        self.follow(part, false)?;
        Ok(SetChange::default())
    }
}
