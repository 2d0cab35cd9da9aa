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
//! Where surfaces give way (1/ε > 0), g̃ − A k λ·n/ε and s − A (k P λ − P R t°)/(κ ε) take the places of g̃ and s: what of gap and
//! slip is not elastic. t° is the traction of the last accepted state, turned with the facet by R.
//!
//! In space the direction τ of sliding turns with the trial traction, which the tangent knows.
//! The slip s is the objective one when both operators changed by more than a threshold since the start of the step,
//! otherwise −P [D δ¹ − M δ²] with δ = x − x_reference. In dynamics and where surfaces give way it is that of [`LastState::slip`]: its
//! rate is what the tractions do work on, so that friction makes no energy. Where pairs augment, as in Kratos, it never is. In long
//! static steps the objective one is nearer to the closed forms: it measures the change of what faces what.

use zelus_core::geometry::{FacetShape, NodeArray};
use zelus_core::scalar::Real;
use zelus_core::vector3::{constant, dot, scale, sub, value};

use crate::active_set;
use crate::formulations::{
    Augmentation, Formulation, Kinematics, LastState, Multiplier, NodeState, PairHistory, PairResidual, SlaveNode,
    StepParameters, Turning,
};
use crate::mortar::{
    OperatorThreshold, Operators, PairGeometry, incremental_slip, is_objective, objective_slip, tangential,
};
use crate::pairs::{Family, Friction};
use crate::register_contact_family;
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
    /// Whether surfaces give way by the nodes' [`SlaveNode::compliance`].
    pub compliant: bool,
    /// Whether bodies have inertia, so that friction must make no energy.
    pub dynamic: bool,
}

/// A pair as it was when slip began to be counted.
#[derive(Debug, Clone, Copy)]
pub struct SlipHistory<S: FacetShape, M: FacetShape> {
    /// D° and M°, at the start of the step.
    pub previous: Operators<f64, S, M>,
    /// Its last accepted state.
    pub last: LastState<S, M>,
}

impl<S: FacetShape, M: FacetShape> PairHistory<S, M> for SlipHistory<S, M> {
    fn of(previous: Operators<f64, S, M>, last: &PairGeometry<f64, S, M>) -> Self {
        Self { previous, last: PairHistory::of(previous, last) }
    }
}

impl AlmFrictional {
    /// Weighted slip vectors s of a pair.
    pub fn slip<T: Real, S: FacetShape, M: FacetShape>(
        &self,
        pair: &Kinematics<T, S, M>,
        history: &SlipHistory<S, M>,
    ) -> S::Nodal<[T; 3]> {
        if self.compliant || (self.dynamic && self.augmentation == Augmentation::Node) {
            return history.last.slip(pair);
        }
        if is_objective(&pair.operators, &history.previous, self.operator_threshold) {
            return objective_slip(&pair.operators, &history.previous, &pair.slave, &pair.master, &pair.normals);
        }
        let increment = |x: [T; 3], from: [f64; 3]| std::array::from_fn(|c| x[c] - from[c]);
        let delta_slave = S::nodal(|j| increment(pair.slave[j], history.last.slave[j]));
        let delta_master = M::nodal(|l| increment(pair.master[l], history.last.master[l]));
        incremental_slip(&pair.operators, &delta_slave, &delta_master, &pair.normals)
    }

    /// Takes from gap and slip what is elastic.
    fn take_elastic<T: Real, S: FacetShape, M: FacetShape>(
        &self,
        pair: &Kinematics<T, S, M>,
        nodes: &S::Nodal<SlaveNode>,
        history: &SlipHistory<S, M>,
        gap: &mut S::Nodal<T>,
        slip: &mut S::Nodal<[T; 3]>,
    ) {
        if !self.compliant {
            return;
        }
        let carried = history.last.carried(pair, nodes);
        for (j, node) in nodes.iter().enumerate() {
            let traction = scale(pair.multipliers[j], T::constant(self.scale_factor));
            let give = pair.area(j) * node.compliance;
            gap[j] -= dot(traction, pair.normals[j]) * give;
            let along = sub(tangential(traction, pair.normals[j]), carried[j]);
            slip[j] = sub(slip[j], scale(along, give * self.tangent_factor.recip()));
        }
    }
}

/// The part across the direction of sliding of what a vector changes by: nothing but a derivative, for the direction itself
/// is that of the present state.
fn across<T: Real>(vector: [T; 3], node: &SlaveNode) -> [T; 3] {
    let change = vector.map(|x| x - x.value());
    let along = change[0] * node.tangent[0] + change[1] * node.tangent[1] + change[2] * node.tangent[2];
    std::array::from_fn(|c| change[c] - along * node.tangent[c])
}

impl Formulation for AlmFrictional {
    const MULTIPLIER: Multiplier = Multiplier::Vector(&VECTOR_LAGRANGE_MULTIPLIER);
    type History<S: FacetShape, M: FacetShape> = SlipHistory<S, M>;

    fn new(parameters: &StepParameters) -> Self {
        Self {
            scale_factor: parameters.scale_factor,
            tangent_factor: parameters.tangent_factor,
            operator_threshold: parameters.operator_threshold,
            augmentation: parameters.augmentation,
            compliant: parameters.compliant,
            dynamic: parameters.dynamic,
        }
    }

    fn weighted_slip<S: FacetShape, M: FacetShape>(
        &self,
        pair: &Kinematics<f64, S, M>,
        history: &SlipHistory<S, M>,
    ) -> S::Nodal<[f64; 3]> {
        self.slip(pair, history)
    }

    fn weighted_trial<S: FacetShape, M: FacetShape>(
        &self,
        pair: &Kinematics<f64, S, M>,
        nodes: &S::Nodal<SlaveNode>,
        history: &SlipHistory<S, M>,
    ) -> Option<S::Nodal<[f64; 3]>> {
        self.compliant.then(|| history.last.weighted_trial(pair, nodes, self.tangent_factor))
    }

    fn residual<T: Real, S: FacetShape, M: FacetShape>(
        &self,
        pair: &Kinematics<T, S, M>,
        nodes: &S::Nodal<SlaveNode>,
        history: &SlipHistory<S, M>,
    ) -> PairResidual<T, S, M> {
        let k = self.scale_factor;
        let (mut gap, mut slip) = (pair.gap(), self.slip(pair, history));
        self.take_elastic(pair, nodes, history, &mut gap, &mut slip);
        let mut out = PairResidual::<T, S, M>::zero();
        for (j, node) in nodes.iter().enumerate() {
            let (lambda, n, penalty) = (pair.multipliers[j], pair.normals[j], self.augmentation.penalty(node));
            let lambda_n = dot(lambda, n);
            let lambda_t = tangential(lambda, n);
            let augmentation = gap[j] * penalty;
            let held = match node.state {
                NodeState::Inactive => {
                    let n = constant::<T>(value(n));
                    let normal = -k * k * node.area / node.stiffness;
                    let tangent = normal / self.tangent_factor;
                    let (lambda_n, lambda_t) = (dot(lambda, n), tangential(lambda, n));
                    out.multipliers[j] = std::array::from_fn(|c| n[c] * lambda_n * normal + lambda_t[c] * tangent);
                    continue;
                }
                NodeState::Slip => {
                    let bound = node.friction.at(lambda_n * k + augmentation);
                    let mut q = node.tangent.map(|t| bound * t);
                    let mut turning = [T::zero(); 3];
                    let Turning { by_slip, by_multiplier } = node.turning;
                    if by_slip != 0.0 || by_multiplier != 0.0 {
                        let by_multiplier = by_multiplier * bound.value();
                        (0..3).for_each(|c| q[c].add_scaled(across(lambda_t, node)[c], by_multiplier));
                        turning = tangential(across(slip[j], node).map(|s| s * by_slip), n);
                    }
                    let q = tangential(q, n);
                    let softness = node.area / node.stiffness;
                    out.multipliers[j] =
                        std::array::from_fn(|c| (n[c] * gap[j] + turning[c] - (lambda_t[c] * k - q[c]) * softness) * k);
                    0.0
                }
                NodeState::Stick => {
                    out.multipliers[j] = std::array::from_fn(|c| (n[c] * gap[j] + slip[j][c]) * k);
                    self.tangent_factor * penalty
                }
            };
            let force = std::array::from_fn(|c| {
                (lambda[c] * k + n[c] * augmentation + slip[j][c] * held) * node.dynamic_factor
            });
            out.add_nodal_force(&pair.operators, j, force);
        }
        out
    }
}

/// The family, with or without sticking.
const fn family(friction: Friction) -> Family {
    let variables = &[
        ("NORMAL", 3),
        ("VECTOR_LAGRANGE_MULTIPLIER", 3),
        ("WEIGHTED_GAP", 1),
        ("WEIGHTED_SLIP", 3),
        ("WEIGHTED_VECTOR_RESIDUAL", 3),
    ];
    Family {
        friction,
        decide: active_set::alm_frictional,
        weighted_gaps: true,
        ..Family::of::<AlmFrictional>("ALMFrictionalMortarContactCondition", variables)
    }
}

register_contact_family! { "ALMContactFrictional",
    about: "Coulomb friction, augmented Lagrangian, one multiplier a slave node and direction",
    source: "eq. 4.9, D.11, D.13",
    conditions: ["ALMFrictionalMortarContactCondition", "ALMFrictionalAxisymMortarContactCondition"],
    build: family(Friction::Coulomb),
}
register_contact_family! { "ALMContactFrictionalPureSlip",
    about: "ALMContactFrictional without sticking: every node in contact slides",
    source: "eq. 4.9, D.11, D.13",
    build: family(Friction::PureSlip),
}
