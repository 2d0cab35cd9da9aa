//! Nodes that move with a reference node R as a rigid body.
//!
//! u_i = u_R + (exp [θ]× − I) r_i with r_i = x_i − x_R in the initial geometry; for small rotations u_i = u_R + θ × r_i. The
//! constraint of a component is linearised at the present θ: its weights are the derivatives, its constant makes it exact there.

use std::ops::Range;

use zelus_core::diagnostics::Result;
use zelus_core::entities::{ActiveSet, Interaction, Join, SetChange};
use zelus_core::model::{MasterSlaveConstraint, ModelPart, Variable};
use zelus_core::vector3::{add, cross, sub};

use super::reference_node::components;
use super::rotation_vector::{rotated, spin};
use crate::variables::{
    ACCELERATION, ANGULAR_ACCELERATION, ANGULAR_VELOCITY, DISPLACEMENT, ROTATION, VELOCITY, VOLUME_ACCELERATION,
};

/// Time level of the start of a step.
const START: usize = 1;

/// Nodes coupled to a reference node.
#[derive(Debug, Clone)]
pub(super) struct KinematicCoupling {
    /// Reference node.
    pub reference: u32,
    /// Coupled nodes with their arms.
    pub arms: Vec<(u32, [f64; 3])>,
    /// Components of them that follow.
    pub coupled: Vec<u8>,
    /// Masses of the rigid body with their arms: all components follow.
    pub masses: Vec<(u32, [f64; 3])>,
    /// Its constraints, by their place in the model part.
    pub made: Range<usize>,
}

impl KinematicCoupling {
    /// The constraints at a rotation, node by node.
    pub fn constraints(&self, space: usize, theta: [f64; 3]) -> Vec<MasterSlaveConstraint> {
        let [translations, rotations] = components(space);
        let unit = |k: u8| std::array::from_fn(|c| f64::from(u8::from(c == usize::from(k))));
        let of_node = |(&(node, arm), coupled): (&(u32, [f64; 3]), &[u8])| {
            let now = rotated(theta, arm);
            let slopes: Vec<[f64; 3]> = rotations.iter().map(|&k| cross(spin(theta, unit(k)), now)).collect();
            let of_component = move |&c: &u8| {
                let at = usize::from(c);
                let by_rotation = rotations.iter().zip(&slopes).map(|(&k, slope)| (k, slope[at]));
                let linear: f64 = by_rotation.clone().map(|(k, slope)| slope * theta[usize::from(k)]).sum();
                let masters = by_rotation.filter(|(_, slope)| *slope != 0.0);
                let masters = masters.map(|(k, slope)| ((self.reference, ROTATION.component(k)), slope));
                let translation = ((self.reference, DISPLACEMENT.component(c)), 1.0);
                let masters = std::iter::once(translation).chain(masters).collect();
                let constant = sub(now, arm)[at] - linear;
                MasterSlaveConstraint {
                    constant,
                    ..MasterSlaveConstraint::new((node, DISPLACEMENT.component(c)), masters)
                }
            };
            coupled.iter().map(of_component).collect::<Vec<_>>()
        };
        let nodes = self.arms.iter().map(|arm| (arm, &*self.coupled));
        nodes.chain(self.masses.iter().map(|arm| (arm, translations))).flat_map(of_node).collect()
    }

    /// Gives the nodes VELOCITY and ACCELERATION of a rigid body at the start of the step from those of the reference node; nothing
    /// where that is at rest. v = v_R + ω × r and a = a_R + α × r, plus ω × (ω × r) under large rotations.
    pub fn start(&self, part: &mut ModelPart, large: bool) {
        let history = &mut part.nodes.history;
        let of_reference = |variable: &Variable<[f64; 3]>| {
            history.get(variable.name()).map_or([0.0; 3], |field| field.vector(START, self.reference as usize))
        };
        let [v, a] = [&VELOCITY, &ACCELERATION].map(of_reference);
        let [omega, alpha] = [&ANGULAR_VELOCITY, &ANGULAR_ACCELERATION].map(of_reference);
        if [v, a, omega, alpha] == [[0.0; 3]; 4] {
            return;
        }
        let space = part.info.domain_size;
        let nodes = self.arms.iter().map(|arm| (arm, &*self.coupled));
        for (&(node, arm), coupled) in nodes.chain(self.masses.iter().map(|arm| (arm, components(space)[0]))) {
            let by_spin = cross(omega, arm);
            let inward = if large { cross(omega, by_spin) } else { [0.0; 3] };
            let acceleration = add(add(a, cross(alpha, arm)), inward);
            for (variable, value) in [(&VELOCITY, add(v, by_spin)), (&ACCELERATION, acceleration)] {
                for &c in coupled {
                    history.set_value(variable.component(c), node as usize, START, value[usize::from(c)]);
                }
            }
        }
    }

    /// Gives the masses VOLUME_ACCELERATION of the reference node.
    pub fn weigh(&self, part: &mut ModelPart) {
        let Some(field) = part.nodes.history.get_mut(VOLUME_ACCELERATION.name()) else { return };
        let gravity = field.vector(0, self.reference as usize);
        for &(node, _) in &self.masses {
            field.levels[0][3 * node as usize..][..3].copy_from_slice(&gravity);
        }
    }

    /// Takes the constraints at the present rotation.
    fn renew(&self, part: &mut ModelPart) {
        let field = part.nodes.history.get(ROTATION.name());
        let theta = field.map_or([0.0; 3], |field| field.vector(0, self.reference as usize));
        let new = self.constraints(part.info.domain_size, theta);
        for (own, new) in part.constraints[self.made.clone()].iter_mut().zip(new) {
            (own.masters, own.constant) = (new.masters, new.constant);
        }
    }
}

/// A coupling whose constraints follow large rotations.
pub(super) struct LargeRotation {
    pub coupling: KinematicCoupling,
    version: u64,
}

impl LargeRotation {
    /// The coupling at rest.
    pub fn new(coupling: KinematicCoupling) -> Self {
        Self { coupling, version: 0 }
    }

    fn renew(&mut self, part: &mut ModelPart) {
        self.coupling.renew(part);
        self.version += 1;
    }
}

impl Interaction for LargeRotation {
    fn name(&self) -> &str {
        "kinematic coupling"
    }

    fn drives(&self) -> bool {
        false
    }

    fn begin_step(&mut self, part: &mut ModelPart) -> Result<()> {
        self.renew(part);
        Ok(())
    }

    fn constraints_version(&self) -> u64 {
        self.version
    }

    fn joins(&self, _part: &ModelPart) -> Option<Vec<Join>> {
        Some(Vec::new())
    }

    fn active_set(&mut self) -> Option<&mut dyn ActiveSet> {
        Some(self)
    }
}

impl ActiveSet for LargeRotation {
    fn after_update(&mut self, part: &mut ModelPart, _iteration: usize) -> Result<SetChange> {
        self.renew(part);
        Ok(SetChange::default())
    }
}
