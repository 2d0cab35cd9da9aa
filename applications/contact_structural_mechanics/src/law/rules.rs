//! The rules by which slave nodes enter and leave contact, stick and slide: pure functions of nodal numbers.
//!
//! The augmented normal pressure p̂ = k λ_n + c g decides: active if p̂ < 0. g is the gap of the node, WG/A with its weighted gap and
//! its area over all pairs, and c a stiffness by length. Tangentially q̂ = k P λ + κ c s with the slip s = WS/A is compared with the
//! bound that the law of friction sets under p̂. A sticking node slides when its traction k P λ is more than the bound; κ c s counts
//! only for nodes that enter. A sliding node, which is at the bound by its own equation, sticks again when its slip has turned against
//! its traction: then q̂ is below the bound, however small κ c s is. So the states of a solution do not depend on κ. The smallest
//! numbers that decide are those of [`crate::tolerances`]. Without friction a state that keeps its set obeys the conditions of Hertz,
//! Signorini and Moreau (eq. D.3a): g = 0 and λ_n ≤ 0, or g ≥ 0 and λ_n = 0.

use super::friction_ellipse::FrictionEllipse;
use super::friction_law::Bound;
use super::node_state::NodeState;
use crate::mortar::tangential;
use crate::tolerances::{Tolerances, is_more};
use zelus_core::vector3::{add, dot, norm, scale};

/// Decides for a frictionless node, whose active state is [`NodeState::Slip`].
///
/// A scalar multiplier enters along the normal, `multiplier` = λ n; penalty methods take none from the decision.
pub fn frictionless(node: &SlaveNumbers) -> Decision {
    let pressure = node.pressure();
    if !node.presses(pressure) {
        return inactive(node, pressure);
    }
    let entered = !node.state.is_active();
    Decision {
        pressure,
        traction: [0.0; 3],
        state: NodeState::Slip,
        changed: entered,
        slip_changed: false,
        multiplier: entered.then(|| scale(node.normal, pressure / node.scale_factor)),
        excess: if entered { pressure.abs() } else { 0.0 },
    }
}

/// How stick and slip are told apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SlipRule {
    /// Contact always slides; stick does not occur.
    Pure,
    /// The law's bound on the augmented tangential pressure.
    Bounded(Margin),
}

/// How far below its bound a sliding node whose slip has turned must be to stick; none in the default.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Margin {
    /// Weight of the slip in q̂ (`slip_augmentation_coefficient`).
    pub augmentation: f64,
    /// Share of the bound (`slip_threshold`); 0 lets every node stick whose slip has turned.
    pub threshold: f64,
}

impl SlipRule {
    /// Whether a sliding node whose slip has turned goes on sliding within a margin.
    fn holds(self, node: &SlaveNumbers, bound: f64) -> bool {
        let Self::Bounded(Margin { augmentation, threshold }) = self else { return false };
        let size = |coefficient: f64| norm(node.trial(coefficient));
        threshold > 0.0 && size(augmentation).min(size(1.0)) > (1.0 - threshold) * bound
    }
}

/// Slip against the traction, as a traction c s and as a share of the bound, that counts.
pub(crate) const TURNED: f64 = 1e-6;

/// Share of the bound below which the mean traction of a node's points counts as sliding.
const AT_BOUND: f64 = 1e-6;

/// Nodal numbers that enter a decision; sums over the pairs of the node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlaveNumbers {
    /// State before the decision.
    pub state: NodeState,
    /// Unit normal out of the slave body.
    pub normal: [f64; 3],
    /// Multiplier λ, a scalar one times the normal; zero for penalty methods.
    pub multiplier: [f64; 3],
    /// Whether multipliers are unknowns of the solve.
    pub solved: bool,
    /// Gap g, negative in penetration (length).
    pub gap: f64,
    /// Slip s of the step (length).
    pub slip: [f64; 3],
    /// Traction q of a penalty method before the law limits it; the mean traction of integration points that decide.
    pub trial: [f64; 3],
    /// Unit tangent τ in which the last solve took a sliding node to slide.
    pub tangent: [f64; 3],
    /// Complementarity parameter c_n: the factor of a gap against tractions (stress by length).
    pub stiffness: f64,
    /// Whether supports move both sides: such a node cannot stick, however small its slip.
    pub driven: bool,
    /// Whether contact of the node does not open again, whatever its pressure.
    pub stays: bool,
    /// Limit of the tangential traction.
    pub friction: Bound,
    /// How that depends on the direction. Trial traction and tangent are in the plane in which the limit is a circle.
    pub ellipse: FrictionEllipse,
    /// Scale factor k.
    pub scale_factor: f64,
    /// Ratio κ of tangential to normal stiffness.
    pub tangent_factor: f64,
    /// Smallest lengths and tractions that decide; gaps and slips below are zero already.
    pub tolerances: Tolerances,
    /// Its bond, where the deck has a law of bonds.
    pub bond: Option<BondNumbers>,
}

/// Tractions and state of a slave node by its bond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondNumbers {
    /// Normal traction, tension positive (force per area).
    pub normal: f64,
    /// Normal traction that it would have if it were closed (force per area).
    pub closed: f64,
    /// Tangential traction (force per area).
    pub tangential: [f64; 3],
    /// Whether a bond held at the start of the step; such a node stays in contact until its end.
    pub holds: bool,
    /// Whether it has failed, is closed and slides.
    pub slides: bool,
}

impl SlaveNumbers {
    /// Augmented normal pressure p̂ = k λ_n + c g; compression is negative.
    ///
    /// After a solve, the remaining gap of a node in contact comes from the curvature of its path. Against c, the stiffness of solid
    /// bodies, that would let go of the nodes of slender ones. A node without contact has no multiplier but the remainder of an old
    /// one, or of the time when its masters were still opposite.
    pub fn pressure(&self) -> f64 {
        let by_multiplier = || self.scale_factor * dot(self.multiplier, self.normal);
        match (self.solved, self.state.is_active()) {
            (true, true) => by_multiplier(),
            (true, false) => self.stiffness * self.gap,
            (false, _) => by_multiplier() + self.stiffness * self.gap,
        }
    }

    /// Whether a node without contact is in the master by more than a state may leave: `allowed` is a traction.
    pub fn has_passed_through(&self, allowed: f64) -> bool {
        !self.state.is_active() && -self.stiffness * self.gap > allowed.max(self.tolerances.traction)
    }

    fn presses(&self, pressure: f64) -> bool {
        let active = self.state.is_active();
        (self.stays && active) || self.tolerances.exceeds(-pressure, 0.0, active)
    }

    /// Whether supports move the sides along each other.
    fn is_dragged(&self) -> bool {
        self.driven && norm(self.slip) > 0.0
    }

    /// Whether the slip of a sliding node is against the traction that should oppose it.
    fn has_turned(&self, bound: f64) -> bool {
        let back = -dot(self.tangent, self.ellipse.root(self.slip, self.normal));
        back > self.tolerances.length && back * self.stiffness > TURNED * bound
    }

    /// Trial traction k P λ + a κ c s, in the plane of the circle.
    fn trial(&self, coefficient: f64) -> [f64; 3] {
        let lambda_t = self.ellipse.inverse_root(tangential(self.multiplier, self.normal), self.normal);
        add(scale(lambda_t, self.scale_factor), scale(self.slip_traction(), coefficient))
    }

    /// Traction κ c s that the slip adds to the multiplier's, in the plane of the circle.
    fn slip_traction(&self) -> [f64; 3] {
        scale(self.ellipse.root(self.slip, self.normal), self.tangent_factor * self.stiffness)
    }
}

/// Decision of the active-set update for a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decision {
    /// Augmented normal pressure p̂; compression is negative.
    pub pressure: f64,
    /// Augmented tangential pressure: q̂, cut to the bound on sliding nodes; zero if inactive.
    pub traction: [f64; 3],
    /// State from now on.
    pub state: NodeState,
    /// Whether the node entered or left contact.
    pub changed: bool,
    /// Whether a node that stays in contact went from stick to slip or back.
    pub slip_changed: bool,
    /// New multiplier of a node that entered contact. One that left keeps its multiplier.
    pub multiplier: Option<[f64; 3]>,
    /// Traction by which the state before violates the conditions of contact; 0 where it stays.
    pub excess: f64,
}

impl Decision {
    /// The decision that leaves a node in `state`, where it `was` in another.
    pub(crate) fn stay(&mut self, state: NodeState, was: NodeState) {
        self.state = state;
        self.changed = state.is_active() != was.is_active();
        self.slip_changed = !self.changed && state != was;
        self.multiplier = None;
        self.excess = 0.0;
    }

    /// A decision for a state and nothing else.
    #[cfg(test)]
    pub(crate) fn plain(state: NodeState) -> Self {
        Self {
            pressure: 0.0,
            traction: [0.0; 3],
            state,
            changed: false,
            slip_changed: false,
            multiplier: None,
            excess: 0.0,
        }
    }
}

/// Decides for a node of the frictional augmented Lagrangian.
pub fn alm_frictional(node: &SlaveNumbers, rule: SlipRule) -> Decision {
    let pressure = node.pressure();
    if !node.presses(pressure) {
        return inactive(node, pressure);
    }
    let sliding = node.state == NodeState::Slip;
    let lambda_t = node.ellipse.inverse_root(tangential(node.multiplier, node.normal), node.normal);
    let bound = node.friction.at(pressure);
    let (q, over) = match node.state {
        // Sliding is at the bound by its own equation, and right as long as the slip goes along the traction. Comparing
        // sizes alone makes nodes stick and slide in turn while pressures and normals still move between iterations.
        NodeState::Slip if rule != SlipRule::Pure => {
            (node.trial(0.0), !node.has_turned(bound) || rule.holds(node, bound))
        }
        NodeState::Stick => {
            let q = node.trial(0.0);
            (q, node.is_dragged() || node.tolerances.exceeds(norm(q), bound, false))
        }
        _ => {
            // A node that enters while it moves more along the surface than into it was not held: holding it at once would
            // tear it off again. Rough surfaces hold up to their own slope.
            let least = node.friction.coefficient.max(1.0) * node.gap.abs();
            let dragged = is_more(norm(node.slip), least);
            let q = node.trial(1.0);
            (q, dragged || node.is_dragged() || node.tolerances.exceeds(norm(q), bound, false))
        }
    };
    let slips = rule == SlipRule::Pure || node.friction.is_smooth() || over;

    let entered = !node.state.is_active();
    let direction = if sliding && rule != SlipRule::Pure {
        node.tangent
    } else if node.tolerances.exceeds(node.scale_factor * norm(lambda_t), 0.0, false) {
        lambda_t
    } else {
        q
    };
    let traction = match (slips, norm(direction)) {
        (false, _) => q,
        (true, 0.0) => [0.0; 3],
        (true, length) => scale(direction, bound / length),
    };
    let traction = node.ellipse.root(traction, node.normal);
    Decision {
        pressure,
        traction,
        state: if slips { NodeState::Slip } else { NodeState::Stick },
        changed: entered,
        slip_changed: !entered && rule != SlipRule::Pure && slips != sliding,
        multiplier: entered.then(|| scale(add(scale(node.normal, pressure), traction), 1.0 / node.scale_factor)),
        excess: match (node.state, slips) {
            (NodeState::Inactive, _) => pressure.abs(),
            (NodeState::Stick, true) => norm(q) - bound,
            (NodeState::Slip, false) => node.stiffness * norm(node.slip),
            _ => 0.0,
        },
    }
}

/// Whether friction pushes a node along its motion that slides on within a margin.
pub fn is_pushed(node: &SlaveNumbers, rule: SlipRule) -> bool {
    let along = dot(node.tangent, node.slip_traction());
    let has_margin = matches!(rule, SlipRule::Bounded(margin) if margin.threshold > 0.0);
    has_margin
        && node.state == NodeState::Slip
        && !node.friction.is_smooth()
        && along < -TURNED * node.friction.at(node.pressure())
}

/// Decides for a node of the frictional penalty method: it sticks while the trial traction is within the bound.
///
/// A sliding node whose trial traction has turned against its traction sticks, too: the spring is stiff, so that the little
/// that an iterate moves it back takes it from one bound beyond the other.
pub fn penalty_frictional(node: &SlaveNumbers, rule: SlipRule) -> Decision {
    let pressure = node.pressure();
    if !node.presses(pressure) {
        return inactive(node, pressure);
    }
    let q = node.trial;
    let (bound, length) = (node.friction.at(pressure), norm(q));
    let sliding = node.state == NodeState::Slip;
    let turned = sliding && rule != SlipRule::Pure && dot(q, node.tangent) < 0.0;
    let over = !turned && node.tolerances.exceeds(length, bound, sliding);
    let slips = rule == SlipRule::Pure || node.friction.is_smooth() || over;
    let entered = !node.state.is_active();
    Decision {
        pressure,
        traction: if slips && length > 0.0 { scale(q, bound / length) } else { q },
        state: if slips { NodeState::Slip } else { NodeState::Stick },
        changed: entered,
        slip_changed: !entered && rule != SlipRule::Pure && slips != sliding,
        multiplier: None,
        excess: match (entered, slips != sliding) {
            (true, _) => pressure.abs(),
            (false, true) => (length - bound).abs(),
            (false, false) => 0.0,
        },
    }
}

/// Decides for a node with a law of bonds: the bond itself tells.
pub fn cohesive(node: &SlaveNumbers, _rule: SlipRule) -> Decision {
    let Some(bond) = node.bond else { return inactive(node, 0.0) };
    if !bond.holds && !node.presses(bond.closed) {
        return inactive(node, bond.closed);
    }
    let (entered, was_sliding) = (!node.state.is_active(), node.state == NodeState::Slip);
    let whole = add(scale(node.normal, bond.closed), bond.tangential);
    let slip_changed = !entered && was_sliding != bond.slides && !node.friction.is_smooth();
    Decision {
        pressure: if entered { bond.closed } else { bond.normal },
        traction: bond.tangential,
        state: if bond.slides { NodeState::Slip } else { NodeState::Stick },
        changed: entered,
        slip_changed,
        multiplier: entered.then(|| scale(whole, 1.0 / node.scale_factor)),
        excess: if entered || slip_changed { norm(whole) } else { 0.0 },
    }
}

/// Decides for a node whose integration points have decided on contact already: `trial` is the mean of their tractions.
pub fn of_points(node: &SlaveNumbers) -> Decision {
    let pressure = dot(node.trial, node.normal);
    // Where no point presses there is exactly nothing.
    if pressure >= 0.0 || !node.presses(pressure) {
        return inactive(node, pressure);
    }
    let traction = tangential(node.trial, node.normal);
    let slips = node.friction.is_smooth() || norm(traction) >= (1.0 - AT_BOUND) * node.friction.at(pressure);
    let entered = !node.state.is_active();
    Decision {
        pressure,
        traction,
        state: if slips { NodeState::Slip } else { NodeState::Stick },
        changed: entered,
        slip_changed: !entered && slips != (node.state == NodeState::Slip),
        multiplier: None,
        excess: 0.0,
    }
}

/// The decision for a node that is not in contact, whatever its pressure.
pub fn inactive(node: &SlaveNumbers, pressure: f64) -> Decision {
    Decision {
        pressure,
        traction: [0.0; 3],
        state: NodeState::Inactive,
        changed: node.state.is_active(),
        slip_changed: false,
        multiplier: None,
        excess: if node.state.is_active() { pressure.abs() } else { 0.0 },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COULOMB: SlipRule = SlipRule::Bounded(Margin { augmentation: 0.0, threshold: 0.0 });

    fn node(state: NodeState, multiplier: [f64; 3]) -> SlaveNumbers {
        SlaveNumbers {
            state,
            normal: [0.0, 0.0, 1.0],
            multiplier,
            solved: false,
            gap: -0.5,
            slip: [0.1, 0.0, 0.0],
            trial: [0.0; 3],
            tangent: [1.0, 0.0, 0.0],
            stiffness: 2.0,
            driven: false,
            stays: false,
            friction: Bound { coefficient: 0.3, threshold: 0.0 },
            ellipse: FrictionEllipse::default(),
            scale_factor: 4.0,
            tangent_factor: 0.5,
            tolerances: Tolerances::of(1.0, 4.0, 0.0),
            bond: None,
        }
    }

    #[test]
    fn zero_pressure_changes_nothing() {
        for round_off in [-1e-16, 0.0, 1e-16] {
            let touching = |state| SlaveNumbers { gap: 0.0, ..node(state, [0.0, 0.0, round_off]) };
            assert_eq!(frictionless(&touching(NodeState::Slip)).state, NodeState::Slip);
            assert_eq!(frictionless(&touching(NodeState::Inactive)).state, NodeState::Inactive);
        }
        let pulled = SlaveNumbers { gap: 0.0, ..node(NodeState::Slip, [0.0, 0.0, 1e-6]) };
        assert!(frictionless(&pulled).changed);
    }

    #[test]
    fn nodes_whose_multiplier_is_solved_for_are_let_go_by_it_alone() {
        let solved = |state, lambda: f64| SlaveNumbers { solved: true, gap: 100.0, ..node(state, [0.0, 0.0, lambda]) };
        assert_eq!(frictionless(&solved(NodeState::Slip, -1.0)).state, NodeState::Slip);
        assert_eq!(frictionless(&solved(NodeState::Slip, 1.0)).state, NodeState::Inactive);
        assert_eq!(frictionless(&solved(NodeState::Inactive, 0.0)).state, NodeState::Inactive);
    }

    #[test]
    fn what_is_left_of_a_multiplier_decides_nothing_without_contact() {
        let left = |lambda: f64| SlaveNumbers { solved: true, ..node(NodeState::Inactive, [0.0, 0.0, lambda]) };
        for lambda in [-1e20, 0.0, 1e20] {
            assert!(frictionless(&left(lambda)).state.is_active());
            assert!(left(lambda).has_passed_through(0.5) && !left(lambda).has_passed_through(1.5));
        }
        assert!(
            !node(NodeState::Slip, [0.0; 3]).has_passed_through(0.0),
            "nodes in contact are held by their equations"
        );
    }

    #[test]
    fn at_the_bound_nodes_stay() {
        // p̂ = −4, bound 1.2 and q̂ = 4 λ_t.
        for round_off in [-1e-15, 0.0, 1e-15] {
            let at = |state| SlaveNumbers { gap: 0.0, slip: [0.0; 3], ..node(state, [0.3 + round_off, 0.0, -1.0]) };
            for state in [NodeState::Stick, NodeState::Slip] {
                assert_eq!(alm_frictional(&at(state), COULOMB).state, state);
            }
        }
    }

    #[test]
    fn entering_contact_sets_the_multiplier() {
        let decision = frictionless(&node(NodeState::Inactive, [0.0; 3]));
        assert_eq!((decision.pressure, decision.state, decision.changed), (-1.0, NodeState::Slip, true));
        assert_eq!(decision.multiplier, Some([0.0, 0.0, -0.25]));
        assert_eq!(frictionless(&node(NodeState::Slip, [0.0; 3])).multiplier, None);
        // With friction the tangential part comes along: q̂ = κ c s = 0.1.
        let decision = alm_frictional(&node(NodeState::Inactive, [0.0; 3]), COULOMB);
        assert_eq!(decision.multiplier, Some([0.025, 0.0, -0.25]));
        assert_eq!((decision.state, decision.changed, decision.slip_changed), (NodeState::Stick, true, false));
        // One that is dragged along more than pressed in enters sliding, with the traction of the bound.
        let dragged = SlaveNumbers { slip: [0.6, 0.0, 0.0], ..node(NodeState::Inactive, [0.0; 3]) };
        let decision = alm_frictional(&dragged, COULOMB);
        assert_eq!((decision.state, decision.traction), (NodeState::Slip, [0.3, 0.0, 0.0]));
        assert_eq!(decision.multiplier, Some([0.075, 0.0, -0.25]));
    }

    #[test]
    fn coulomb_by_traction_and_by_the_sign_of_slip() {
        // p̂ = −4·1 − 1 = −5, bound 1.5; q̂ = 4 λ_t + 2 κ s.
        for tangent_factor in [0.5, 1e4] {
            let decide = |state, lambda_t: f64| {
                alm_frictional(&SlaveNumbers { tangent_factor, ..node(state, [lambda_t, 0.0, -1.0]) }, COULOMB)
            };
            assert_eq!(decide(NodeState::Stick, 0.374).state, NodeState::Stick);
            let slips = decide(NodeState::Stick, 0.376);
            assert_eq!((slips.state, slips.slip_changed), (NodeState::Slip, true));
            assert!((slips.traction[0] - 1.5).abs() < 1e-15, "cut to the bound");
            // Sliding along the traction goes on, whatever its size; against it never, however small the slip.
            assert_eq!(decide(NodeState::Slip, 0.1).state, NodeState::Slip);
            for slip in [-0.1, -1e-5] {
                let node = SlaveNumbers { tangent_factor, ..node(NodeState::Slip, [0.375, 0.0, -1.0]) };
                let turned = alm_frictional(&SlaveNumbers { slip: [slip, 0.0, 0.0], ..node }, COULOMB);
                assert_eq!((turned.state, turned.slip_changed), (NodeState::Stick, true));
            }
        }
        // With a margin the slip must have turned by enough.
        let margin = SlipRule::Bounded(Margin { augmentation: 0.0, threshold: 0.02 });
        let turned =
            |lambda_t: f64| SlaveNumbers { slip: [-0.1, 0.0, 0.0], ..node(NodeState::Slip, [lambda_t, 0.0, -1.0]) };
        assert_eq!(alm_frictional(&turned(0.4), margin).state, NodeState::Slip);
        assert_eq!(alm_frictional(&turned(0.39), margin).state, NodeState::Stick);
        let pure = alm_frictional(&node(NodeState::Slip, [0.0, 0.0, -1.0]), SlipRule::Pure);
        assert_eq!((pure.state, pure.slip_changed), (NodeState::Slip, false));
    }

    #[test]
    fn the_limit_depends_on_the_direction() {
        // Bound 1.5 along x, 0.6 across it; multipliers times 4 are tractions.
        let decide = |lambda_t: [f64; 2]| {
            let multiplier = [lambda_t[0], lambda_t[1], -1.0];
            let ellipse = FrictionEllipse { direction: [1.0, 0.0, 0.0], ratio: 0.4 };
            alm_frictional(&SlaveNumbers { ellipse, ..node(NodeState::Stick, multiplier) }, COULOMB)
        };
        for (lambda_t, state) in [
            ([0.374, 0.0], NodeState::Stick),
            ([0.376, 0.0], NodeState::Slip),
            ([0.0, 0.149], NodeState::Stick),
            ([0.0, 0.151], NodeState::Slip),
        ] {
            assert_eq!(decide(lambda_t).state, state, "{lambda_t:?}");
        }
        // Beyond the limit the traction lies on the ellipse, at its point along the multiplier.
        let [x, y, _] = decide([0.3, 0.3]).traction;
        assert!((x - y).abs() < 1e-14 && (x * x + (y / 0.4).powi(2) - 2.25).abs() < 1e-14, "{x} {y}");
        assert_eq!(decide([0.1, 0.05]).traction.map(|t| (t * 1e12).round() / 1e12), [0.4, 0.2, 0.0]);
    }

    #[test]
    fn what_supports_move_slides_however_little() {
        let little = SlaveNumbers { slip: [-1e-9, 0.0, 0.0], ..node(NodeState::Stick, [-1e-9, 0.0, -1.0]) };
        assert_eq!(alm_frictional(&little, COULOMB).state, NodeState::Stick);
        let driven = alm_frictional(&SlaveNumbers { driven: true, ..little }, COULOMB);
        assert_eq!((driven.state, driven.slip_changed), (NodeState::Slip, true));
        let at_rest = SlaveNumbers { driven: true, slip: [0.0; 3], ..little };
        assert_eq!(alm_frictional(&at_rest, COULOMB).state, NodeState::Stick);
    }

    #[test]
    fn leaving_contact_keeps_the_multiplier() {
        let open = SlaveNumbers { gap: 5.0, ..node(NodeState::Stick, [0.1, 0.0, -1.0]) };
        let decision = alm_frictional(&open, COULOMB);
        assert_eq!((decision.state, decision.changed, decision.multiplier), (NodeState::Inactive, true, None));
    }

    #[test]
    fn penalty_sticks_up_to_the_bound() {
        // p̂ = −1, bound 0.3.
        let decide = |trial| {
            let node = SlaveNumbers { trial: [0.0, trial, 0.0], ..node(NodeState::Stick, [0.0; 3]) };
            penalty_frictional(&node, COULOMB)
        };
        assert_eq!(decide(0.3).state, NodeState::Stick);
        let slips = decide(0.6);
        assert_eq!((slips.state, slips.slip_changed), (NodeState::Slip, true));
        assert!((slips.traction[1] - 0.3).abs() < 1e-15);
        // A sliding node goes on along its direction; turned back it sticks, however far.
        let slid = |trial| {
            let node = SlaveNumbers { trial: [trial, 0.0, 0.0], ..node(NodeState::Slip, [0.0; 3]) };
            penalty_frictional(&node, COULOMB).state
        };
        assert_eq!(
            [0.6, 0.2, -0.2, -6.0].map(slid),
            [NodeState::Slip, NodeState::Stick, NodeState::Stick, NodeState::Stick]
        );
    }

    #[test]
    fn contact_without_separation_carries_tension() {
        let pulled = |state| SlaveNumbers {
            stays: true,
            solved: true,
            gap: 5.0,
            friction: Bound::default(),
            ..node(state, [0.0, 0.0, 1.0])
        };
        for decide in [|own: &SlaveNumbers| frictionless(own), |own: &SlaveNumbers| alm_frictional(own, COULOMB)] {
            let decision = decide(&pulled(NodeState::Slip));
            assert_eq!((decision.state, decision.changed, decision.pressure), (NodeState::Slip, false, 4.0));
            assert_eq!(decision.traction, [0.0; 3]);
            assert_eq!(decide(&pulled(NodeState::Inactive)).state, NodeState::Inactive);
        }
    }

    #[test]
    fn no_friction_always_slides() {
        let smooth = SlaveNumbers { friction: Bound::default(), ..node(NodeState::Inactive, [0.0; 3]) };
        let decision = alm_frictional(&smooth, COULOMB);
        assert_eq!((decision.state, decision.traction), (NodeState::Slip, [0.0; 3]));
        assert_eq!(decision.multiplier, Some([0.0, 0.0, -0.25]));
    }
}
