//! The sections of two planar bodies that meet: their thickness, and whether stress or strain across the plane is zero.

use std::collections::BTreeMap;

use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::ModelPart;
use zelus_core::registry::find;
use zelus_structural_mechanics::laws::{LawEntry, LawFactory};

use super::facet::Roles;
use super::facets::Interface;

/// Difference of two thicknesses that are the same, as a share of the larger.
const SAME: f64 = 1e-9;

/// Section of a planar body.
#[derive(Debug, Clone, Copy)]
struct Section {
    /// Thickness (length).
    thickness: f64,
    /// The state across the plane; `None` where the law says none.
    state: Option<&'static str>,
    /// Id of the properties that give it.
    properties: usize,
}

/// Warnings of pairs whose sides are bodies of unlike thickness, or one in plane stress and one in plane strain.
pub fn unlike_sections(part: &ModelPart, interfaces: &[Interface]) -> Vec<Diagnostic> {
    if part.info.domain_size != 2 {
        return Vec::new();
    }
    let mut out = Vec::new();
    for interface in interfaces {
        let [slaves, masters] = [Roles::Slave, Roles::Master].map(|role| sections(part, interface, role));
        let pairs = || slaves.iter().flat_map(|one| masters.iter().map(move |two| (one, two)));
        let key = &interface.key;
        let is_thicker = |(one, two): &(&Section, &Section)| {
            (one.thickness - two.thickness).abs() > SAME * one.thickness.max(two.thickness)
        };
        if let Some((one, two)) = pairs().find(is_thicker) {
            let fact = format!(
                "pair \"{key}\" joins bodies of THICKNESS {} (properties {}) and {} (properties {})",
                one.thickness, one.properties, two.thickness, two.properties
            );
            let remedy = "give both bodies one thickness: contact forces of a plane model act across all of it";
            out.push(Diagnostic::warning("unlike-sections", fact).remedy(remedy));
        }
        let differs = |(one, two): &(&Section, &Section)| one.state.zip(two.state).is_some_and(|(a, b)| a != b);
        if let Some((one, two)) = pairs().find(differs) {
            let [a, b] = [one, two].map(|of| of.state.unwrap_or_default());
            let fact = format!(
                "pair \"{key}\" joins a body in {a} (properties {}) and one in {b} (properties {})",
                one.properties, two.properties
            );
            let remedy = "use laws of one plane state on both sides";
            out.push(Diagnostic::warning("unlike-sections", fact).remedy(remedy));
        }
    }
    out
}

/// The sections behind the facets of one side, by properties.
fn sections(part: &ModelPart, interface: &Interface, role: Roles) -> Vec<Section> {
    let mut by_id: BTreeMap<usize, Section> = BTreeMap::new();
    for facet in interface.facets.iter().filter(|facet| facet.role == role && !facet.is_rigid()) {
        let element = facet.element as usize;
        let properties = part.elements.properties[element];
        if part.elements.kinds[element].of_revolution || by_id.contains_key(&properties) {
            continue;
        }
        let Some(own) = part.properties.get(&properties) else { continue };
        let state = match own.law.as_deref().and_then(find::<LawEntry>).map(|law| law.build) {
            Some(LawFactory::PlaneStress(_)) => Some("plane stress"),
            Some(LawFactory::PlaneStrain { .. }) => Some("plane strain"),
            _ => None,
        };
        by_id.insert(properties, Section { thickness: own.number("THICKNESS").unwrap_or(1.0), state, properties });
    }
    by_id.into_values().collect()
}
