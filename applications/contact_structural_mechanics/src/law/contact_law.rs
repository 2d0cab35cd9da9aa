//! The trait of contact laws.
//!
//! A law is written once over the scalar ([`NodeLaw`]); the framework uses it as an object ([`ContactLaw`]), with plain numbers
//! for the residual and with [`Active`] ones, which carry the derivatives of a pair, for the tangent. So a law is compiled for
//! two scalars, whatever the shapes of facets.

use super::rules::{self, Decision, SlaveNumbers, SlipRule};
use super::{Multiplier, SlaveNode, StepParameters};
use crate::mortar::{Active, OperatorThreshold};
use zelus_core::scalar::Real;
use zelus_core::vector3::constant;

/// Active inputs of a law at one slave node: the share of one pair, with derivatives where the scalar has them.
#[derive(Debug, Clone, Copy)]
pub struct NodeInputs<T> {
    /// Weighted gap g̃ of the pair, negative in penetration (length times area).
    pub gap: T,
    /// Weighted slip s of the pair, as [`NodeLaw::slip`] measures it (length times area); zero without a measure.
    pub slip: [T; 3],
    /// Unit normal out of the slave body.
    pub normal: [T; 3],
    /// Multiplier λ, compression negative; a scalar one in the first component.
    pub multiplier: [T; 3],
    /// History traction P R t° of the last accepted state, rotated with the facet (force per area).
    pub history: [T; 3],
    /// Tangential opening P R w_t° of a bond in the last accepted state, rotated with the facet (length).
    pub sliding: [T; 3],
    /// Area that the pair has of the node.
    pub area: T,
}

impl NodeInputs<f64> {
    /// The same inputs, those that follow from the positions of nodes as variables: gap, slip, normal, history traction, area;
    /// the opening of a bond as one, which tells whether it has derivatives and no more.
    pub fn seeded(&self) -> NodeInputs<Active> {
        let vector = |first: usize, v: [f64; 3]| std::array::from_fn(|c| Active::variable(v[c], first + c));
        NodeInputs {
            gap: Active::variable(self.gap, 0),
            slip: vector(1, self.slip),
            normal: vector(4, self.normal),
            multiplier: constant(self.multiplier),
            history: vector(7, self.history),
            area: Active::variable(self.area, 10),
            sliding: self.sliding.map(|x| Active::variable(x, 11)),
        }
    }
}

/// Result of a law at one slave node.
#[derive(Debug, Clone, Copy)]
pub struct NodeForces<T> {
    /// Nodal force vector p (force per area), spread over both sides by D and M; `None` for a node without contact.
    pub force: Option<[T; 3]>,
    /// Rows of the multiplier; a scalar one in the first component.
    pub multiplier: [T; 3],
}

impl<T: Real> NodeForces<T> {
    /// A force alone, of laws without multiplier.
    pub fn force(force: [T; 3]) -> Self {
        Self { force: Some(force), multiplier: [T::zero(); 3] }
    }

    /// Neither force nor equation: a node without contact of a law without multiplier.
    pub fn none() -> Self {
        Self { force: None, multiplier: [T::zero(); 3] }
    }
}

/// Measure of the weighted slip of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum SlipMeasure {
    /// None: laws without friction.
    #[default]
    None,
    /// Since the last accepted state, rotated with the slave facet. Tractions do work on its rate.
    Rotated,
    /// By the change of the operators in the step where both change by more than the threshold, else by displacement increments.
    OfOperators(OperatorThreshold),
}

/// A contact law, written once over the scalar.
///
/// It must be affine in the multiplier for given states. Frictionless contact without penalty in the force is p = k λ n with the row
/// k g̃:
///
/// ```
/// # use zelus_contact_structural_mechanics::law::*;
/// # use zelus_contact_structural_mechanics::laws::alm_frictionless::AlmFrictionless;
/// # let node = SlaveNode {
/// #     state: NodeState::Slip, penalty: 1.0, compliance: 0.0, uzawa_pressure: 0.0, stiffness: 1.0, area: 1.0,
/// #     dynamic_factor: 1.0, friction: Bound { coefficient: 0.0, threshold: 0.0 }, tangent: [0.0; 3],
/// #     rotation: DirectionRotation::default(), constraints: Default::default(), constraint_weight: 1.0,
/// #     history_traction: [0.0; 3], history_sliding: [0.0; 3], bond: None, traction: [0.0; 3],
/// # };
/// // A slave node in contact, of area 1, whose pair has closed by 0.25.
/// assert!(node.state.is_active());
/// let inputs = NodeInputs {
///     gap: -0.25,
///     normal: [0.0, 0.0, 1.0],
///     multiplier: [-3.0, 0.0, 0.0],
///     area: 1.0,
///     slip: [0.0; 3],
///     history: [0.0; 3],
///     sliding: [0.0; 3],
/// };
/// let law = AlmFrictionless { scale_factor: 10.0, augmentation: Augmentation::Node };
/// let forces = law.evaluate(&node, &inputs);
/// assert_eq!((forces.force, forces.multiplier[0]), (Some([0.0, 0.0, -30.0]), -2.5));
/// ```
pub trait NodeLaw: Send + Sync + 'static {
    /// Its multiplier.
    const MULTIPLIER: Multiplier;

    /// The law with the numbers of the step.
    fn new(parameters: &StepParameters) -> Self;

    /// The measure of slip that it reads.
    fn slip(&self) -> SlipMeasure {
        SlipMeasure::None
    }

    /// Whether it reads the history traction.
    fn has_history(&self) -> bool {
        false
    }

    /// Force and multiplier rows of a slave node.
    fn evaluate<T: Real>(&self, node: &SlaveNode, inputs: &NodeInputs<T>) -> NodeForces<T>;

    /// Area times trial traction, for laws with a history traction.
    fn weighted_trial(&self, _node: &SlaveNode, _inputs: &NodeInputs<f64>) -> Option<[f64; 3]> {
        None
    }

    /// Its rule of the active set: whether a slave node is in contact, sticks or slides.
    fn decide(node: &SlaveNumbers, _rule: SlipRule) -> Decision {
        rules::frictionless(node)
    }
}

/// A contact law as an object; every [`NodeLaw`] is one.
pub trait ContactLaw: Send + Sync {
    /// Its multiplier.
    fn multiplier(&self) -> Multiplier;

    /// The measure of slip that it reads.
    fn slip(&self) -> SlipMeasure;

    /// Whether it reads the history traction.
    fn has_history(&self) -> bool;

    /// Force and multiplier rows of a slave node.
    fn values(&self, node: &SlaveNode, inputs: &NodeInputs<f64>) -> NodeForces<f64>;

    /// The same with derivatives.
    fn derivatives(&self, node: &SlaveNode, inputs: &NodeInputs<Active>) -> NodeForces<Active>;

    /// Area times trial traction, for laws with a history traction.
    fn weighted_trial(&self, node: &SlaveNode, inputs: &NodeInputs<f64>) -> Option<[f64; 3]>;
}

impl<L: NodeLaw> ContactLaw for L {
    fn multiplier(&self) -> Multiplier {
        L::MULTIPLIER
    }

    fn slip(&self) -> SlipMeasure {
        NodeLaw::slip(self)
    }

    fn has_history(&self) -> bool {
        NodeLaw::has_history(self)
    }

    fn values(&self, node: &SlaveNode, inputs: &NodeInputs<f64>) -> NodeForces<f64> {
        self.evaluate(node, inputs)
    }

    fn derivatives(&self, node: &SlaveNode, inputs: &NodeInputs<Active>) -> NodeForces<Active> {
        self.evaluate(node, inputs)
    }

    fn weighted_trial(&self, node: &SlaveNode, inputs: &NodeInputs<f64>) -> Option<[f64; 3]> {
        NodeLaw::weighted_trial(self, node, inputs)
    }
}
