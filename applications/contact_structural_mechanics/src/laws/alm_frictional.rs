//! Friction by the augmented Lagrangian with a vector multiplier.
//!
//! - inactive: p = 0, b_λ = −k² (A/c) [(λ·n) n + P λ/κ], with n constant: a multiplier is to vanish at once;
//! - slip: p = f (k λ + ε̂ g̃ n), b_λ = k g̃ n − k (A/c) (k P λ − P q) with q = b(k λ·n + ε̂ g̃) τ, b the bound of the law
//!   of friction;
//! - stick: p = f (k λ + ε̂ g̃ n + κ ε̂ s), b_λ = k g̃ n + k s.
//!
//! Over the pairs of a node g̃ and s add up to its gap and slip. So does A, the area that the pair has of the node: the
//! equations of a node do not depend on the number of its pairs. Where pairs augment, A is the area of the node in each of
//! them, for then their bounds hold gaps that add up to zero.
//!
//! In the regularised methods (1/ε > 0), g̃ − A k λ·n/ε and s − A (k P λ − P R t°)/(κ ε) take the places of g̃ and s: the inelastic
//! parts of gap and slip. t° is the traction of the last accepted state, rotated with the facet by R.
//!
//! With friction by direction slip is q = D^(1/2) b(…) τ with the root of the matrix D of the [ellipse](FrictionEllipse), and τ the
//! direction of sliding in the plane in which its limit is a circle.
//!
//! In space the direction τ of sliding rotates with the trial traction, which the tangent knows. The slip s is the objective one when
//! both operators changed by more than a threshold since the start of the step, otherwise −P [D δ¹ − M δ²] with δ = x − x_reference. In
//! dynamics and in the regularised methods it is that of [`SlipMeasure::Rotated`]: the tractions do work on its rate, so that friction
//! makes no energy. Where pairs augment, as in Kratos, it never is. In long static steps the objective one is nearer to the closed
//! forms: it measures the change of the facing points.

use zelus_core::scalar::Real;
use zelus_core::vector3::{add, constant, dot, scale, sub, value};

use crate::law::rules::{self, Decision, SlaveNumbers, SlipRule};
use crate::law::{
    Augmentation, DirectionRotation, FrictionEllipse, Multiplier, NodeForces, NodeInputs, NodeLaw, NodeState,
    SlaveNode, SlipMeasure, StepParameters,
};
use crate::mortar::{OperatorThreshold, tangential};
use crate::pairs::{Formulation, Friction};
use crate::register_contact_formulation;
use crate::variables::VECTOR_LAGRANGE_MULTIPLIER;

/// Augmented Lagrangian with friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlmFrictional {
    /// Scale factor k of the multipliers: traction = k λ.
    pub scale_factor: f64,
    /// Ratio κ > 0 of tangential to normal penalty.
    pub tangent_factor: f64,
    /// Change of D and of M beyond which the slip is taken as objective.
    pub operator_threshold: OperatorThreshold,
    /// Where gap and slip augment the force.
    pub augmentation: Augmentation,
    /// Whether contact is regularised by the nodes' [`SlaveNode::compliance`].
    pub regularised: bool,
    /// Whether bodies have inertia, so that friction must make no energy.
    pub dynamic: bool,
    /// Limit of friction by direction.
    pub ellipse: FrictionEllipse,
}

impl AlmFrictional {
    /// Gap and slip without their elastic parts.
    fn inelastic<T: Real>(&self, node: &SlaveNode, inputs: &NodeInputs<T>) -> (T, [T; 3]) {
        if !self.regularised {
            return (inputs.gap, inputs.slip);
        }
        let traction = scale(inputs.multiplier, T::constant(self.scale_factor));
        let give = inputs.area * node.compliance;
        let along = sub(tangential(traction, inputs.normal), inputs.history);
        let elastic = inputs.area * (self.tangent_factor * node.penalty).recip();
        (
            inputs.gap - (dot(traction, inputs.normal) - node.uzawa_pressure) * give,
            sub(inputs.slip, scale(along, elastic)),
        )
    }
}

/// The change of a vector across the direction of sliding: nothing but a derivative, for the direction itself is that of the
/// present state.
fn across<T: Real>(vector: [T; 3], node: &SlaveNode) -> [T; 3] {
    let change = vector.map(|x| x - x.value());
    let along = change[0] * node.tangent[0] + change[1] * node.tangent[1] + change[2] * node.tangent[2];
    std::array::from_fn(|c| change[c] - along * node.tangent[c])
}

impl NodeLaw for AlmFrictional {
    const MULTIPLIER: Multiplier = Multiplier::Vector(&VECTOR_LAGRANGE_MULTIPLIER);

    fn new(parameters: &StepParameters) -> Self {
        Self {
            scale_factor: parameters.scale_factor,
            tangent_factor: parameters.tangent_factor,
            operator_threshold: parameters.operator_threshold,
            augmentation: parameters.augmentation,
            regularised: parameters.regularised,
            dynamic: parameters.dynamic,
            ellipse: parameters.ellipse,
        }
    }

    fn slip(&self) -> SlipMeasure {
        if self.regularised || (self.dynamic && self.augmentation == Augmentation::Node) {
            SlipMeasure::Rotated
        } else {
            SlipMeasure::OfOperators(self.operator_threshold)
        }
    }

    fn has_history(&self) -> bool {
        self.regularised
    }

    fn weighted_trial(&self, node: &SlaveNode, inputs: &NodeInputs<f64>) -> Option<[f64; 3]> {
        let elastic = scale(inputs.slip, self.tangent_factor * node.penalty);
        self.regularised.then(|| add(scale(inputs.history, inputs.area), elastic))
    }

    fn decide(node: &SlaveNumbers, rule: SlipRule) -> Decision {
        rules::alm_frictional(node, rule)
    }

    fn evaluate<T: Real>(&self, node: &SlaveNode, inputs: &NodeInputs<T>) -> NodeForces<T> {
        let k = self.scale_factor;
        let (gap, slip) = self.inelastic(node, inputs);
        let (lambda, n, penalty) = (inputs.multiplier, inputs.normal, self.augmentation.penalty(node));
        let lambda_n = dot(lambda, n);
        let lambda_t = tangential(lambda, n);
        let augmentation = gap * penalty;
        let (multiplier, held) = match node.state {
            NodeState::Inactive => {
                let n = constant::<T>(value(n));
                let normal = -k * k * node.area / node.stiffness;
                let tangent = normal / self.tangent_factor;
                let (lambda_n, lambda_t) = (dot(lambda, n), tangential(lambda, n));
                let multiplier = std::array::from_fn(|c| n[c] * lambda_n * normal + lambda_t[c] * tangent);
                return NodeForces { force: None, multiplier };
            }
            NodeState::Slip => {
                let bound = node.friction.at(lambda_n * k + augmentation);
                let mut q = node.tangent.map(|t| bound * t);
                let mut rotation = [T::zero(); 3];
                let DirectionRotation { by_slip, by_multiplier } = node.rotation;
                if by_slip != 0.0 || by_multiplier != 0.0 {
                    let by_multiplier = by_multiplier * bound.value();
                    let turns = across(self.ellipse.inverse_root(lambda_t, n), node);
                    (0..3).for_each(|c| q[c].add_scaled(turns[c], by_multiplier));
                    let turns = across(self.ellipse.root(slip, n), node).map(|s| s * by_slip);
                    rotation = tangential(self.ellipse.root(turns, n), n);
                }
                let q = tangential(self.ellipse.root(q, n), n);
                let softness = node.area / node.stiffness;
                let row = |c: usize| (n[c] * gap + rotation[c] - (lambda_t[c] * k - q[c]) * softness) * k;
                (std::array::from_fn(row), 0.0)
            }
            NodeState::Stick => (std::array::from_fn(|c| (n[c] * gap + slip[c]) * k), self.tangent_factor * penalty),
        };
        let force = |c: usize| (lambda[c] * k + n[c] * augmentation + slip[c] * held) * node.dynamic_factor;
        NodeForces { force: Some(std::array::from_fn(force)), multiplier }
    }
}

/// The formulation, with or without sticking.
const fn formulation(friction: Friction) -> Formulation {
    let variables = &[
        ("NORMAL", 3),
        ("VECTOR_LAGRANGE_MULTIPLIER", 3),
        ("WEIGHTED_GAP", 1),
        ("WEIGHTED_SLIP", 3),
        ("WEIGHTED_VECTOR_RESIDUAL", 3),
    ];
    Formulation {
        friction,
        weighted_gaps: true,
        ..Formulation::of::<AlmFrictional>("ALMFrictionalMortarContactCondition", variables)
    }
}

register_contact_formulation! { "ALMContactFrictional",
    about: "Coulomb friction, augmented Lagrangian, one multiplier a slave node and direction",
    source: "normal: eqs. 4.9, D.11; friction: Alart and Curnier (1991), Gitterle, Popp, Gee and Wall (2010)",
    conditions: ["ALMFrictionalMortarContactCondition", "ALMFrictionalAxisymMortarContactCondition"],
    build: formulation(Friction::Coulomb),
}
register_contact_formulation! { "ALMContactFrictionalPureSlip",
    about: "ALMContactFrictional without sticking: every node in contact slides",
    source: "normal: eqs. 4.9, D.11; friction: Alart and Curnier (1991), Gitterle, Popp, Gee and Wall (2010)",
    build: formulation(Friction::PureSlip),
}
