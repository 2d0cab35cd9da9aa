//! Nitsche's method: tractions of the slave's own element take the place of multipliers.
//!
//! With the traction t(u) on the slave, its normal part σ = n·t, the gap g, positive where open, and γ = γ₀ M A/V, each
//! integration point has the contact pressure and, with friction, the tangential traction
//! - P = σ + γ g, p = min(P, 0);
//! - q = t − σ n + r° + κ γ s, τ = q where |q| ≤ b(p) and else b(p) q/|q|, with the slip s of the step against the motion.
//!
//! r = τ − (t − σ n) is what the tractions of a mesh lack; r° is that of the last accepted state, averaged at the nodes and
//! turned with the facet. Without it bodies that stick would slip by it in every step.
//!
//! The force f = p n + τ acts on the slave, −f on the master, and the slave's element has the consistent term
//! −θ/γ ∫ (f − f°)·δt, where f° = t with friction and σ n without. θ = 1 is symmetric, 0 incomplete, −1 skew. The term is
//! there too where p = 0; beside the master there is none, and no force (Chouly, Hild and Renard 2015). M is the stiffness of
//! the material across the face, A the face, V the volume of the element, all in the initial state: γ = M A/V is what the
//! trace inequality of an element of constant stress asks of the symmetric variant; of one of linear stress in d dimensions it asks
//! 2 (d + 1)/d times as much (Warburton and Hesthaven 2003), which M has of faces of second order.
//!
//! Tractions are those of the initial area, P·N; along the facet they are interpolated between inner points, which is exact
//! where the element is a parallelepiped, and divided there by the change of area.

use super::LastState;
use crate::friction_law::Bound;
use crate::mortar::operators::least_overlap;
use crate::mortar::points::for_each_point;
use crate::mortar::{PairGeometry, SegmentationSettings, Turn, inner_point, inner_values, nodal_shares, tangential};
use zelus_core::geometry::{FacetShape, NodeArray};
use zelus_core::scalar::Real;
use zelus_core::vector3::{add, constant, dot, norm, normalised, scale, sub, value};

/// Weight of held nodes above which a point is held in contact.
const HELD: f64 = 0.5;

/// Which consistent term Nitsche's method has.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NitscheVariant {
    /// θ = 1: forces have a potential; stable for γ₀ that is large enough.
    Symmetric,
    /// θ = −1: stable for every γ₀.
    #[default]
    Skew,
    /// θ = 0: no consistent term.
    Incomplete,
}

/// Nitsche's method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nitsche {
    /// θ.
    pub theta: f64,
    /// γ₀ > 0.
    pub factor: f64,
    /// Ratio κ of what slips and gaps count with; `None` without friction.
    pub friction: Option<f64>,
}

impl Default for Nitsche {
    fn default() -> Self {
        Self::new(NitscheVariant::default(), None, None)
    }
}

impl Nitsche {
    /// The method of a variant and γ₀, by default 1 where every factor is stable and else 4, since elements whose stress
    /// varies need more than the 1 of those of constant stress.
    pub fn new(variant: NitscheVariant, factor: Option<f64>, friction: Option<f64>) -> Self {
        let theta = match variant {
            NitscheVariant::Symmetric => 1.0,
            NitscheVariant::Incomplete => 0.0,
            NitscheVariant::Skew => -1.0,
        };
        let factor = factor.unwrap_or(if variant == NitscheVariant::Skew { 1.0 } else { 4.0 });
        Self { theta, factor, friction }
    }
}

/// The face of the slave's element, in the initial state.
#[derive(Debug, Clone, Copy)]
pub struct SlaveFace<S: FacetShape> {
    /// Length or area by local coordinates at the inner points; about an axis times the radius.
    pub densities: S::Nodal<f64>,
    /// M A/V (stress by length, in the plane times the thickness).
    pub stiffness: f64,
    /// What tractions are multiplied by, where the weights of points are divided by it.
    pub thickness: f64,
}

/// What a point takes from the slave nodes around it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NodeOfPoints {
    /// Limit of the tangential traction.
    pub friction: Bound,
    /// r° of the last accepted state (force per area).
    pub carried: [f64; 3],
    /// 1 where points are in contact whatever their pressure, until the next solve; else 0.
    pub held: f64,
    /// 1 where points in contact stick whatever their traction, until the next solve; else 0.
    pub stuck: f64,
}

/// What the points of a pair add up to.
#[derive(Debug, Clone, Copy)]
pub struct PointForces<T: Real, S: FacetShape, M: FacetShape> {
    /// Forces on slave nodes.
    pub slave: S::Nodal<[T; 3]>,
    /// Forces on master nodes.
    pub master: M::Nodal<[T; 3]>,
    /// ∫ L f: area times traction of the slave nodes, with what they have of each point ([`nodal_shares`]).
    pub traction: S::Nodal<[f64; 3]>,
    /// ∫ L (τ − t + σ n) over the points in contact, with friction.
    pub carried: S::Nodal<[T; 3]>,
    /// What works on changes of the tractions at the inner points (a length times an area).
    pub by_traction: S::Nodal<[T; 3]>,
}

impl Nitsche {
    /// Forces of a pair whose slave has these tractions of the initial area at its inner points; `None` without overlap.
    pub fn forces<T: Real, S: FacetShape, M: FacetShape>(
        &self,
        pair: &PairGeometry<T, S, M>,
        tractions: &S::Nodal<[T; 3]>,
        (face, nodes): (&SlaveFace<S>, &S::Nodal<NodeOfPoints>),
        last: &LastState<S, M>,
        settings: &SegmentationSettings,
    ) -> Option<PointForces<T, S, M>> {
        let zero = [T::zero(); 3];
        let mut out = PointForces::<T, S, M> {
            slave: S::nodal(|_| zero),
            master: M::nodal(|_| zero),
            traction: S::nodal(|_| [0.0; 3]),
            carried: S::nodal(|_| zero),
            by_traction: S::nodal(|_| zero),
        };
        let origin = value(pair.slave[0]);
        let relative = |x: [T; 3]| std::array::from_fn(|c| x[c] - origin[c]);
        let (slave, master) = (S::map(&pair.slave, relative), M::map(&pair.master, relative));
        // By how much the facet has become smaller at its inner points.
        let shrunk: S::Nodal<T> = S::nodal(|g| {
            let xi = inner_point::<S>(g);
            let mut now = norm(S::area_normal(&pair.slave, xi));
            if settings.axisymmetric.is_some() {
                now *= S::combine(&S::values(xi), &pair.slave)[0];
            }
            now.recip() * (face.densities[g] * face.thickness)
        });
        let gamma = self.factor * face.stiffness * face.thickness;
        let turn = Turn::of_facet::<S>(&pair.slave, &last.slave);
        let covered = for_each_point(pair, settings, |point| {
            let normal = normalised(S::interpolate(&point.slave, &pair.nodal_normals));
            let inner = inner_values::<T, S>(point.local);
            let mut traction = zero;
            for g in 0..S::NODES {
                let share = inner[g] * shrunk[g];
                (0..3).for_each(|c| traction[c].add_product(share, tractions[g][c]));
            }
            let jump = sub(S::interpolate(&point.slave, &slave), M::interpolate(&point.master, &master));
            let stress = dot(normal, traction);
            let pressure = stress - dot(normal, jump) * gamma;
            let share = |of: fn(&NodeOfPoints) -> f64| {
                nodes.iter().zip(point.slave.iter()).map(|(node, n)| of(node) * n.value()).sum::<f64>() > HELD
            };
            let held = share(|node| node.held);
            let pressing = held || pressure.value() < 0.0;
            let mut force = if pressing { scale(normal, pressure) } else { zero };
            let mut own = scale(normal, stress);
            let shares = nodal_shares(point);
            if let Some(ratio) = self.friction {
                own = traction;
                if pressing {
                    let before = jump_before::<T, S, M>(&point.slave, &point.master, last);
                    let slip = tangential(sub(turn.apply(before), jump), normal);
                    let weights = S::map(&point.slave, T::value);
                    let mut carried = zero;
                    for (node, n) in nodes.iter().zip(point.slave.iter()) {
                        (0..3).for_each(|c| carried[c].add_scaled(*n, node.carried[c]));
                    }
                    let carried = tangential(turn.apply(carried), normal);
                    let along = sub(traction, scale(normal, stress));
                    let trial = add(add(along, carried), scale(slip, T::constant(gamma * ratio)));
                    let sticks = held || share(|node| node.stuck);
                    let friction = limited(trial, pressure, mean_bound::<S>(nodes, &weights), sticks);
                    force = add(force, friction);
                    let apart = sub(friction, along);
                    for k in 0..S::NODES {
                        let weight = shares[k] * point.weight;
                        (0..3).for_each(|c| out.carried[k][c].add_product(weight, apart[c]));
                    }
                }
            }
            for k in 0..S::NODES {
                let weight = point.slave[k] * point.weight;
                (0..3).for_each(|c| out.slave[k][c].add_product(weight, force[c]));
                let own = (shares[k] * point.weight).value();
                (0..3).for_each(|c| out.traction[k][c] += own * force[c].value());
            }
            for l in 0..M::NODES {
                let weight = point.master[l] * point.weight;
                (0..3).for_each(|c| out.master[l][c].add_product(weight, -force[c]));
            }
            if self.theta != 0.0 {
                let lack = sub(force, own);
                for g in 0..S::NODES {
                    let weight = inner[g] * shrunk[g] * point.weight * (-self.theta / gamma);
                    (0..3).for_each(|c| out.by_traction[g][c].add_product(weight, lack[c]));
                }
            }
        });
        (covered > least_overlap(pair)).then_some(out)
    }
}

/// x¹ − x² of a point in the last accepted state.
fn jump_before<T: Real, S: FacetShape, M: FacetShape>(
    slave: &S::Nodal<T>,
    master: &M::Nodal<T>,
    last: &LastState<S, M>,
) -> [T; 3] {
    let origin = last.slave[0];
    let relative = |x: [f64; 3]| constant(sub(x, origin));
    sub(S::interpolate(slave, &S::map(&last.slave, relative)), M::interpolate(master, &M::map(&last.master, relative)))
}

fn mean_bound<S: FacetShape>(nodes: &S::Nodal<NodeOfPoints>, weights: &S::Nodal<f64>) -> Bound {
    let mean = |of: fn(&Bound) -> f64| nodes.iter().zip(weights.iter()).map(|(node, n)| n * of(&node.friction)).sum();
    Bound { coefficient: mean(|bound| bound.coefficient), threshold: mean(|bound| bound.threshold) }
}

/// The trial traction, cut to the bound unless the point is made to stick.
fn limited<T: Real>(trial: [T; 3], pressure: T, bound: Bound, sticks: bool) -> [T; 3] {
    if bound.is_smooth() {
        return [T::zero(); 3];
    }
    let limit = bound.at(pressure);
    let size = norm(value(trial));
    if sticks || size <= limit.value() {
        trial
    } else if limit.value() <= 0.0 {
        [T::zero(); 3]
    } else {
        scale(trial, limit / norm(trial))
    }
}
