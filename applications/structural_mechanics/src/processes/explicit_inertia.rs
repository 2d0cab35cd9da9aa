//! The inertia of a rigid body that explicit steps accelerate: a diagonal mass of the six unknowns of its reference node.
//!
//! Lumped on the reference node, masses m_i at arms r_i give its displacements m = Σ m_i and, in the plane with Σ m_i r_i = 0, its
//! rotation J = Σ m_i |r_i|². In space the inertia about the reference node is a matrix that turns with the body, which is not lumped.

use zelus_core::diagnostics::{Diagnostic, Place, Result};
use zelus_core::model::{ModelPart, Variable};
use zelus_core::parameters::Settings;
use zelus_core::vector3::{add, dot, norm, scale};

use super::reference_node::{PART, ReferenceNode, components};
use super::rigid_body_mass;
use crate::variables::{DISPLACEMENT, ROTATION};

/// Distance of the centre of mass from the reference node that is round-off, as a share of the mean arm.
const AT_CENTRE: f64 = 1e-9;

/// Inertia of a rigid body in explicit steps.
pub(super) struct ExplicitInertia {
    node: u32,
    /// Where the deck names the reference node.
    place: Place,
    has_mass: bool,
    /// Whether masses off the reference node give it a moment of inertia.
    has_moment: bool,
    /// Whether the centre of mass is the reference node.
    is_centred: bool,
}

impl ExplicitInertia {
    /// Of the masses that the settings give.
    ///
    /// # Errors
    /// Masses that no body has.
    pub fn of(settings: &Settings, part: &ModelPart, reference: &ReferenceNode) -> Result<Self> {
        let point = part.nodes.initial[reference.node as usize];
        let masses = rigid_body_mass::masses(settings, part.info.domain_size, point)?;
        let (moment, arms) = masses.iter().fold(([0.0; 3], 0.0), |(moment, arms), (arm, mass)| {
            (add(moment, scale(*arm, *mass)), arms + mass * norm(*arm))
        });
        Ok(Self {
            node: reference.node,
            place: settings.key_place(PART),
            has_mass: !masses.is_empty(),
            has_moment: masses.iter().any(|(arm, _)| dot(*arm, *arm) > 0.0),
            is_centred: norm(moment) <= AT_CENTRE * arms,
        })
    }

    /// # Errors
    /// An unknown of the reference node that is free in this step and that explicit steps cannot accelerate.
    pub fn check(&self, part: &ModelPart) -> Result<()> {
        let space = part.info.domain_size;
        let [u, theta] = components(space);
        let is_free = |variable: &Variable<[f64; 3]>, own: &[u8]| {
            own.iter().any(|&c| !part.nodes.is_fixed(variable.component(c), self.node))
        };
        let (moves, rotates) = (is_free(&DISPLACEMENT, u), is_free(&ROTATION, theta));
        let (fact, remedy) = match true {
            _ if moves && !self.has_mass => {
                ("is free to move and has no mass", "give \"mass\", or prescribe DISPLACEMENT of the reference node")
            }
            _ if rotates && space == 3 => (
                "is free to rotate in space, and explicit steps have no inertia for that",
                "prescribe ROTATION of the reference node, or use implicit steps",
            ),
            _ if rotates && !self.has_moment => (
                "is free to rotate and has no inertia",
                "give \"inertia\", or prescribe ROTATION of the reference node",
            ),
            _ if (moves || rotates) && !self.is_centred => (
                "is free and is not the centre of mass, as explicit steps need it",
                "put \"reference_point\" there, or use implicit steps",
            ),
            _ => return Ok(()),
        };
        let fact = format!("reference node {} {fact}", part.nodes.ids[self.node as usize]);
        Err(Diagnostic::error("explicit-coupling", fact).at(self.place.clone()).remedy(remedy).into())
    }
}
