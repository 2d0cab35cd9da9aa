//! The bond of a slave node: tractions by its opening, damage, and friction of its damaged share.
//!
//! With the opening w, its normal part w_n less that at the start, and the damage d:
//! - normal: t_n = (1 − d) K_n w_n where it is open, K_n w_n where it is closed;
//! - tangential: t_t = (1 − d) K_s w_t + f r. r is [friction](super::rubbing) under t_n, zero where the bond is open; f = d is the share of
//!   the surface that has failed, or 1 of bonds without K_s.
//!
//! d is the largest damage that the law has given, so that a bond unloads towards its origin. A node without bond has d = 1.

use serde::{Deserialize, Serialize};
use zelus_core::scalar::Real;
use zelus_core::vector3::{dot, value};

use super::cohesive_law::CohesiveLaw;
use super::friction_law::Bound;
use super::rubbing::{Rubbed, Rubbing};
use crate::mortar::Active;

/// Growth of damage up to which a bond counts as unloading, as all do at the start of a step: from there the iteration finds which are
/// loaded further. With the tangent of loading it would miss bonds that unload while others fail.
const AT_LARGEST: f64 = 1e-9;
/// Numbers of an opening: gap, tangential opening, trial traction of friction.
const NUMBERS: usize = 7;

/// State of a bond.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct BondState {
    /// Whether the node was bonded, once that is decided.
    pub bonded: Option<bool>,
    /// Gap of the node where its bond has no normal traction (length).
    pub start: f64,
    /// Damage, from 0 to 1.
    pub damage: f64,
    /// Energy by area that damage has dissipated.
    pub dissipated: f64,
    /// Tangential opening since the start, with the surface (length).
    pub sliding: [f64; 3],
    /// Elastic slip of friction on the failed share, times the tangential stiffness (force per area).
    pub friction: [f64; 3],
}

impl BondState {
    /// Whether it carries tension or shear.
    pub fn holds(&self) -> bool {
        self.bonded == Some(true) && self.damage < 1.0
    }

    /// Decides whether the node is bonded, at this gap.
    pub fn decide(&mut self, bonded: bool, gap: f64) {
        let (damage, start) = if bonded { (0.0, gap) } else { (1.0, 0.0) };
        *self = Self { bonded: Some(bonded), damage, start, ..Self::default() };
    }
}

/// Opening of a slave node over all its pairs.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct BondOpening {
    /// Gap (length).
    pub gap: f64,
    /// Tangential opening since the bond was made (length).
    pub sliding: [f64; 3],
    /// Elastic slip if nothing slid, times the tangential stiffness (force per area).
    pub trial: [f64; 3],
}

impl BondOpening {
    /// Its numbers, one after the other.
    fn numbers(&self) -> [f64; NUMBERS] {
        let ([a, b, c], [d, e, f]) = (self.sliding, self.trial);
        [self.gap, a, b, c, d, e, f]
    }
}

/// Tractions of a bond with their derivatives at an opening: what pairs need of it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BondTangent {
    /// The opening.
    pub at: BondOpening,
    /// Normal traction, tension positive (force per area).
    pub normal: f64,
    /// Tangential traction (force per area).
    pub tangential: [f64; 3],
    /// Derivatives of normal traction and tangential traction by the numbers of the opening.
    by: [[f64; NUMBERS]; 4],
}

impl BondTangent {
    /// Area times tractions at the opening of one pair, linear in its difference from that of the node: `weighted` are gap, tangential
    /// opening and trial traction times area.
    pub fn weighted<T: Real>(&self, area: T, weighted: (T, [T; 3], [T; 3])) -> (T, [T; 3]) {
        let (gap, [a, b, c], [d, e, f]) = weighted;
        let (opening, at) = ([gap, a, b, c, d, e, f], self.at.numbers());
        let component = |traction: f64, by: &[f64; NUMBERS]| {
            let mut sum = area * traction;
            for ((own, whole), slope) in opening.iter().zip(at).zip(by) {
                if *slope != 0.0 {
                    sum += (*own - area * whole) * *slope;
                }
            }
            sum
        };
        (component(self.normal, &self.by[0]), std::array::from_fn(|c| component(self.tangential[c], &self.by[c + 1])))
    }
}

/// A bond at an opening.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bond {
    /// Its tractions.
    pub tangent: BondTangent,
    /// Its state there.
    pub state: BondState,
    /// Normal traction that the surface would have if it were closed (force per area).
    pub closed: f64,
    /// Whether the surface has failed, is closed and slides.
    pub slides: bool,
    /// Energy by area that friction has dissipated since the last accepted state.
    pub heat: f64,
}

/// Laws that the bonds of all slave nodes share.
#[derive(Clone, Copy)]
pub struct SurfaceLaw<'a> {
    /// The law of bonds, if there is one.
    pub cohesive: Option<&'a dyn CohesiveLaw>,
    /// Friction.
    pub rubbing: Rubbing,
}

/// Friction and stiffness of a slave node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceNumbers {
    /// Limit of friction.
    pub friction: Bound,
    /// Normal and tangential stiffness of contact (stress by length).
    pub stiffness: [f64; 2],
    /// Whether it is in contact: a node without bond carries what its state says.
    pub active: bool,
    /// Whether damage is constant in the tangent.
    pub secant: bool,
}

/// The bond of a node whose accepted state was `last`, at an opening.
pub fn bond(of: SurfaceLaw<'_>, last: &BondState, at: BondOpening, numbers: SurfaceNumbers) -> Bond {
    let number = at.numbers();
    let variable = |place: usize| Active::variable(number[place], place);
    let [normal_stiffness, shear_stiffness] = of.cohesive.map_or([numbers.stiffness[0], 0.0], |law| law.stiffness());
    let opening = variable(0) - last.start;
    let sliding: [Active; 3] = std::array::from_fn(|c| variable(1 + c));
    let trial: [Active; 3] = std::array::from_fn(|c| variable(4 + c));
    let sound_law = of.cohesive.filter(|_| last.damage < 1.0);
    let is_open = if sound_law.is_some() { opening.value() > 0.0 } else { !numbers.active };
    let stored = if is_open { opening * opening * (0.5 * normal_stiffness) } else { Active::zero() };
    let energies = [stored, dot(sliding, sliding) * (0.5 * shear_stiffness)];
    let damage = sound_law.map_or(Active::constant(1.0), |law| damage(law, last.damage, energies));
    let damage = if numbers.secant { Active::constant(damage.value()) } else { damage };
    let sound = -damage + 1.0;
    let normal = opening * normal_stiffness * if is_open { sound } else { Active::constant(1.0) };
    let failed = if shear_stiffness > 0.0 { damage } else { Active::constant(1.0) };
    let rubbed =
        if is_open { Rubbed::none() } else { of.rubbing.at(trial, numbers.friction, normal, numbers.stiffness[1]) };
    let traction: [Active; 3] =
        std::array::from_fn(|c| sliding[c] * sound * shear_stiffness + rubbed.traction[c] * failed);
    let gradient = |traction: &Active| std::array::from_fn(|place| traction.gradient[place]);
    let mut state = BondState { damage: damage.value(), sliding: at.sliding, friction: rubbed.elastic, ..*last };
    if let Some(law) = sound_law.filter(|_| state.damage > last.damage) {
        let energies = energies.map(|energy| energy.value());
        state.dissipated += law.dissipated(energies, state.damage) - law.dissipated(energies, last.damage);
    }
    let slides = state.damage >= 1.0 && !is_open && rubbed.slides;
    let closed = opening.value() * normal_stiffness;
    let tangent = BondTangent {
        at,
        normal: normal.value(),
        tangential: value(traction),
        by: [gradient(&normal), gradient(&traction[0]), gradient(&traction[1]), gradient(&traction[2])],
    };
    Bond { tangent, state, closed, slides, heat: failed.value() * rubbed.heat }
}

/// Damage of a bond with damage already, at most 1.
fn damage(law: &dyn CohesiveLaw, last: f64, energies: [Active; 2]) -> Active {
    let damage = law.damage(energies);
    match damage.value() {
        value if value >= 1.0 => Active::constant(1.0),
        value if value <= last + AT_LARGEST => Active::constant(value.max(last)),
        _ => damage,
    }
}
