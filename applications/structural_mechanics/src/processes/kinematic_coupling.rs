//! Nodes that move with a reference node R as a rigid body.
//!
//! u_i = u_R + (exp [θ]× − I) r_i with r_i = x_i − x_R in the initial geometry; for small rotations u_i = u_R + θ × r_i. The
//! constraint of a component is linearised at the present θ: its weights are the derivatives, its constant makes it exact there.

use std::ops::Range;

use zelus_core::diagnostics::Result;
use zelus_core::entities::{ActiveSet, Interaction, Join, SetChange};
use zelus_core::model::{MasterSlaveConstraint, ModelPart};
use zelus_core::vector3::{cross, sub};

use super::reference_node::components;
use super::rotation_vector::{rotated, spin};
use crate::variables::{DISPLACEMENT, ROTATION};

/// Nodes coupled to a reference node.
#[derive(Debug, Clone)]
pub(super) struct KinematicCoupling {
    /// Reference node.
    pub reference: u32,
    /// Coupled nodes with their arms.
    pub arms: Vec<(u32, [f64; 3])>,
    /// Components that follow.
    pub coupled: Vec<u8>,
    /// Its constraints, by their place in the model part.
    pub made: Range<usize>,
}

impl KinematicCoupling {
    /// The constraints at a rotation, node by node.
    pub fn constraints(&self, space: usize, theta: [f64; 3]) -> Vec<MasterSlaveConstraint> {
        let [_, rotations] = components(space);
        let unit = |k: u8| std::array::from_fn(|c| f64::from(u8::from(c == usize::from(k))));
        let of_node = |&(node, arm): &(u32, [f64; 3])| {
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
            self.coupled.iter().map(of_component).collect::<Vec<_>>()
        };
        self.arms.iter().flat_map(of_node).collect()
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
