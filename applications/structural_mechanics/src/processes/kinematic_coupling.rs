//! Nodes that move with a reference node R as a rigid body.
//!
//! u_i = u_R + (exp [θ]× − I) r_i with r_i = x_i − x_R in the initial geometry; for small rotations u_i = u_R + θ × r_i. The
//! constraint of a component is linearised at the present θ: its weights are the derivatives by θ, its constant makes it exact there.
//! Forces f_i give the reference node the moment Σ R r_i × f_i about the axes of the space, which is that of δω and not of δθ.

use std::ops::Range;

use zelus_core::diagnostics::Result;
use zelus_core::model::{MasterSlaveConstraint, ModelPart, Variable};
use zelus_core::vector3::{add, cross, sub};

use super::constraints_of_process::passing_on;
use super::large_rotation::{RotatingCoupling, rotation_of, vector_at};
use super::reference_node::components;
use super::rotation_stiffness::{Matrix, RotationTangent, add_scaled, of_arm};
use super::rotation_vector::{rotated, spin};
use crate::variables::{
    ACCELERATION, ANGULAR_ACCELERATION, ANGULAR_VELOCITY, DISPLACEMENT, REACTION, ROTATION, VELOCITY,
    VOLUME_ACCELERATION, WHOLE_TURNS,
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
    /// Whether ROTATION of the reference node follows others, by spins δω in place of δθ.
    pub by_spins: bool,
    /// Its constraints, by their place in the model part.
    pub made: Range<usize>,
}

impl KinematicCoupling {
    /// The constraints at a rotation θ − β, with the whole turns β that ROTATION counts beside it, node by node.
    pub fn constraints(&self, space: usize, theta: [f64; 3], turns: [f64; 3]) -> Vec<MasterSlaveConstraint> {
        let [translations, rotations] = components(space);
        let counted = add(theta, turns);
        let unit = |k: u8| std::array::from_fn(|c| f64::from(u8::from(c == usize::from(k))));
        let way = |k: u8| if self.by_spins { unit(k) } else { spin(theta, unit(k)) };
        let of_node = |(&(node, arm), coupled): (&(u32, [f64; 3]), &[u8])| {
            let now = rotated(theta, arm);
            let slopes: Vec<[[f64; 3]; 2]> =
                rotations.iter().map(|&k| [way(k), unit(k)].map(|axis| cross(axis, now))).collect();
            let of_component = move |&c: &u8| {
                let at = usize::from(c);
                let by_rotation = rotations.iter().zip(&slopes).map(|(&k, slopes)| (k, slopes.map(|slope| slope[at])));
                let linear: f64 = by_rotation.clone().map(|(k, [slope, _])| slope * counted[usize::from(k)]).sum();
                let terms = by_rotation.filter(|(_, slopes)| *slopes != [0.0; 2]);
                let terms = terms.map(|(k, slopes)| ((self.reference, ROTATION.component(k)), slopes));
                let translation = ((self.reference, DISPLACEMENT.component(c)), [1.0; 2]);
                let terms = std::iter::once(translation).chain(terms).collect();
                let constant = sub(now, arm)[at] - linear;
                passing_on((node, DISPLACEMENT.component(c)), terms, constant)
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
        // Explicit steps begin from the present level, which no prediction overwrites.
        let levels = if part.info.solver.explicit { 0..=START } else { START..=START };
        let nodes = self.arms.iter().map(|arm| (arm, &*self.coupled));
        for (&(node, arm), coupled) in nodes.chain(self.masses.iter().map(|arm| (arm, components(space)[0]))) {
            let by_spin = cross(omega, arm);
            let inward = if large { cross(omega, by_spin) } else { [0.0; 3] };
            let acceleration = add(add(a, cross(alpha, arm)), inward);
            for (variable, value) in [(&VELOCITY, add(v, by_spin)), (&ACCELERATION, acceleration)] {
                for (level, &c) in levels.clone().flat_map(|level| coupled.iter().map(move |c| (level, c))) {
                    history.set_value(variable.component(c), node as usize, level, value[usize::from(c)]);
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

    /// Takes the constraints at a rotation θ − β, with the whole turns β.
    pub fn renew(&self, part: &mut ModelPart, theta: [f64; 3], turns: [f64; 3]) {
        let new = self.constraints(part.info.domain_size, theta, turns);
        for (own, new) in part.constraints[self.made.clone()].iter_mut().zip(new) {
            (own.masters, own.forces, own.constant) = (new.masters, new.forces, new.constant);
        }
    }
}

impl RotatingCoupling for KinematicCoupling {
    fn reference(&self) -> u32 {
        self.reference
    }

    fn follow(&mut self, part: &mut ModelPart, _begins: bool) -> Result<()> {
        let theta = rotation_of(part, self.reference);
        let turns = vector_at(part, &WHOLE_TURNS, self.reference);
        self.renew(part, theta, turns);
        Ok(())
    }

    fn tangent(&self, part: &ModelPart) -> Option<RotationTangent> {
        let theta = rotation_of(part, self.reference);
        let [translations, rotations] = components(part.info.domain_size);
        let nodes = self.arms.iter().map(|arm| (arm, &*self.coupled));
        let nodes = nodes.chain(self.masses.iter().map(|arm| (arm, translations)));
        let own = nodes.filter(|((node, _), _)| part.owns_node(*node as usize));
        let mut l = own.fold(Matrix::default(), |sum, (&(node, arm), coupled)| {
            let reaction = vector_at(part, &REACTION, node);
            let force = std::array::from_fn(|c| if coupled.contains(&(c as u8)) { -reaction[c] } else { 0.0 });
            add_scaled(sum, of_arm(rotated(theta, arm), force), 1.0)
        });
        if part.share.is_some() {
            part.ranks.sum(l.as_flattened_mut());
        }
        let unit = |k: u8| std::array::from_fn(|c| f64::from(u8::from(c == usize::from(k))));
        Some(RotationTangent { l, ways: rotations.iter().map(|&k| [unit(k), spin(theta, unit(k))]).collect() })
    }
}
