//! Nitsche's method: tractions of the slave's own element take the place of multipliers.
//!
//! With the traction t(u) on the slave, its normal part σ = n·t, the gap g, positive where open, and γ = γ₀ M A/V, each
//! integration point has the contact pressure and, with friction, the tangential traction
//! - P = σ + γ g, p = min(P, 0);
//! - q = t − σ n + r° + κ γ s, τ = q where |q| ≤ b(p) and else b(p) q/|q|, with the slip s of the step against the motion.
//!
//! r = τ − (t − σ n) is the discretisation error of the traction; r° is that of the last accepted state, averaged at the nodes and
//! rotated with the facet. Without it bodies that stick would slip by it in every step.
//!
//! The force f = p n + τ acts on the slave, −f on the master, and the slave's element has the consistent term −θ/γ ∫ (f − f°)·δt, where
//! f° = t with friction and σ n without. θ = 1 is symmetric, 0 incomplete, −1 skew. The term is there too where p = 0; at the master's
//! edge, where no master is opposite, there is none, and no force (Chouly, Hild and Renard 2015). M is the stiffness of the material
//! across the face, A the face, V the volume of the element, all in the initial state: γ = M A/V is the bound of the trace inequality
//! of an element of constant stress for the symmetric variant; for one of linear stress in d dimensions it is 2 (d + 1)/d times as
//! large (Warburton and Hesthaven 2003), a factor that M includes for faces of second order.
//!
//! Tractions are those of the initial area, P·N; along the facet they are interpolated between inner points, which is exact
//! where the element is a parallelepiped, and divided there by the change of area.

use super::friction_law::Bound;
use crate::mortar::for_each_point;
use crate::mortar::operators::least_overlap;
use crate::mortar::{
    FacetRotation, PairGeometry, SegmentationSettings, inner_point, inner_values, nodal_shares, tangential,
};
use zelus_core::geometry::{Nodal, combine, interpolate};
use zelus_core::scalar::Real;
use zelus_core::vector3::{add, constant, dot, norm, normalised, scale, sub, value};

/// Weight of held nodes above which a point is held in contact.
const HELD: f64 = 0.5;

/// Variant of the consistent term of Nitsche's method.
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
    /// Ratio κ of the factors of slips and gaps; `None` without friction.
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
pub struct SlaveFace {
    /// Length or area by local coordinates at the inner points; about an axis times the radius.
    pub densities: Nodal<f64>,
    /// M A/V (stress by length, in the plane times the thickness).
    pub stiffness: f64,
    /// Factor of tractions where the weights of points are divided by it.
    pub thickness: f64,
}

/// Numbers that a point takes from the slave nodes around it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NodeOfPoints {
    /// Limit of the tangential traction.
    pub friction: Bound,
    /// r° of the last accepted state (force per area).
    pub history_traction: [f64; 3],
    /// 1 where points are in contact whatever their pressure, until the next solve; else 0.
    pub forced_active: f64,
    /// 1 where points in contact stick whatever their traction, until the next solve; else 0.
    pub forced_stick: f64,
}

/// Sums over the points of a pair.
#[derive(Debug, Clone, Copy)]
pub struct PointForces<T: Real> {
    /// Forces on slave nodes.
    pub slave: Nodal<[T; 3]>,
    /// Forces on master nodes.
    pub master: Nodal<[T; 3]>,
    /// ∫ L f: area times traction of the slave nodes, with their share of each point ([`nodal_shares`]).
    pub traction: Nodal<[f64; 3]>,
    /// ∫ L (τ − t + σ n) over the points in contact, with friction.
    pub history_traction: Nodal<[T; 3]>,
    /// Factor of changes of the tractions at the inner points (a length times an area).
    pub by_traction: Nodal<[T; 3]>,
}

impl Nitsche {
    /// Forces of a pair whose slave has these tractions of the initial area at its inner points; `None` without overlap.
    ///
    /// `last` are the positions of slave and master nodes in the last accepted state.
    pub fn forces<T: Real>(
        &self,
        pair: &PairGeometry<T>,
        tractions: &[[T; 3]],
        (face, nodes): (&SlaveFace, &[NodeOfPoints]),
        last: (&[[f64; 3]], &[[f64; 3]]),
        settings: &SegmentationSettings,
    ) -> Option<PointForces<T>> {
        let shape = pair.slave_shape;
        let zero = [T::zero(); 3];
        let mut out = PointForces::<T> {
            slave: shape.nodal(|_| zero),
            master: pair.master.map(|_| zero),
            traction: shape.nodal(|_| [0.0; 3]),
            history_traction: shape.nodal(|_| zero),
            by_traction: shape.nodal(|_| zero),
        };
        let origin = value(pair.slave[0]);
        let relative = |x: [T; 3]| std::array::from_fn(|c| x[c] - origin[c]);
        let (slave, master) = (pair.slave.map(relative), pair.master.map(relative));
        // By how much the facet has become smaller at its inner points.
        let shrunk: Nodal<T> = shape.nodal(|g| {
            let xi = inner_point(shape, g);
            let mut now = norm(shape.area_normal(&pair.slave, xi));
            if settings.axisymmetric.is_some() {
                now *= combine(&shape.values(xi), &pair.slave)[0];
            }
            now.recip() * (face.densities[g] * face.thickness)
        });
        let gamma = self.factor * face.stiffness * face.thickness;
        let rotation = FacetRotation::of_facet(shape, &pair.slave, last.0);
        let covered = for_each_point(pair, settings, &mut |point| {
            let normal = normalised(interpolate(&point.slave, &pair.nodal_normals));
            let inner = inner_values(shape, point.local);
            let mut traction = zero;
            for g in 0..shape.nodes {
                let share = inner[g] * shrunk[g];
                (0..3).for_each(|c| traction[c].add_product(share, tractions[g][c]));
            }
            let jump = sub(interpolate(&point.slave, &slave), interpolate(&point.master, &master));
            let stress = dot(normal, traction);
            let pressure = stress - dot(normal, jump) * gamma;
            let share = |of: fn(&NodeOfPoints) -> f64| {
                nodes.iter().zip(point.slave.iter()).map(|(node, n)| of(node) * n.value()).sum::<f64>() > HELD
            };
            let forced = share(|node| node.forced_active);
            let pressing = forced || pressure.value() < 0.0;
            let mut force = if pressing { scale(normal, pressure) } else { zero };
            let mut own = scale(normal, stress);
            let shares = nodal_shares(shape, point);
            if let Some(ratio) = self.friction {
                own = traction;
                if pressing {
                    let before = jump_before(&point.slave, &point.master, last);
                    let slip = tangential(sub(rotation.apply(before), jump), normal);
                    let weights = point.slave.map(T::value);
                    let mut history_traction = zero;
                    for (node, n) in nodes.iter().zip(point.slave.iter()) {
                        (0..3).for_each(|c| history_traction[c].add_scaled(*n, node.history_traction[c]));
                    }
                    let history_traction = tangential(rotation.apply(history_traction), normal);
                    let along = sub(traction, scale(normal, stress));
                    let trial = add(add(along, history_traction), scale(slip, T::constant(gamma * ratio)));
                    let sticks = forced || share(|node| node.forced_stick);
                    let friction = limited(trial, pressure, mean_bound(nodes, &weights), sticks);
                    force = add(force, friction);
                    let apart = sub(friction, along);
                    for k in 0..shape.nodes {
                        let weight = shares[k] * point.weight;
                        (0..3).for_each(|c| out.history_traction[k][c].add_product(weight, apart[c]));
                    }
                }
            }
            for k in 0..shape.nodes {
                let weight = point.slave[k] * point.weight;
                (0..3).for_each(|c| out.slave[k][c].add_product(weight, force[c]));
                let own = (shares[k] * point.weight).value();
                (0..3).for_each(|c| out.traction[k][c] += own * force[c].value());
            }
            for l in 0..pair.master.len() {
                let weight = point.master[l] * point.weight;
                (0..3).for_each(|c| out.master[l][c].add_product(weight, -force[c]));
            }
            if self.theta != 0.0 {
                let lack = sub(force, own);
                for g in 0..shape.nodes {
                    let weight = inner[g] * shrunk[g] * point.weight * (-self.theta / gamma);
                    (0..3).for_each(|c| out.by_traction[g][c].add_product(weight, lack[c]));
                }
            }
        });
        (covered > least_overlap(pair)).then_some(out)
    }
}

/// x¹ − x² of a point in the last accepted state.
fn jump_before<T: Real>(slave: &[T], master: &[T], last: (&[[f64; 3]], &[[f64; 3]])) -> [T; 3] {
    let origin = last.0[0];
    let relative = |x: [f64; 3]| constant(sub(x, origin));
    let before = |nodes: &[[f64; 3]]| Nodal::of(nodes).map(relative);
    sub(interpolate(slave, &before(last.0)), interpolate(master, &before(last.1)))
}

fn mean_bound(nodes: &[NodeOfPoints], weights: &[f64]) -> Bound {
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
