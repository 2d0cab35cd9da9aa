//! Pairs of facets that are near each other and do not face the same way.

use zelus_core::model::ModelPart;
use zelus_core::parallel;
use zelus_core::vector3::{dot, norm, scale, sub};

use super::along_normals::farthest_master;
use super::tree::{Bounds, Tree};
use crate::interface::{Facet, Interface, Roles};

/// Facets or nodes that a thread looks around at a time.
pub(super) const AT_A_TIME: usize = 64;

/// Radii within which circles count as meeting.
pub(super) const SLACK: f64 = 1.1;

/// How a search decides which slave nodes start the step in contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GapCheck {
    /// By the gap of the mortar mapping.
    #[serde(alias = "mapping_check")]
    CheckMapping,
    /// By the distance of each node to the master facets.
    DirectCheck,
    /// Every node that has a pair.
    NoCheck,
}

/// Which slave nodes of bodies that are in contact already begin a step in contact.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SetAtStart {
    /// Nodes that ended the last step so, and nodes that the edge of contact will reach.
    Kept,
    /// All near nodes, as between bodies that are not in contact.
    #[default]
    Near,
}

/// Between which points of two facets the search radius is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SearchDistance {
    /// Between the boxes around them: facets that may overlap are a pair, whatever its size.
    BetweenFacets,
    /// Between their centres: masters much larger than the slave may be left out.
    BetweenCentres,
    /// Between the boxes, beyond the first masters along the slave's normal: whatever faces the slave is a pair, however far.
    #[serde(skip)]
    BeyondFirst,
}

/// Pairs that arise within a step and are added before it ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WithinStep {
    /// All that face nodes in contact or show nodes to be in a master.
    Facing,
    /// Pairs of nodes that are in a master by more than the gap at which nodes start in contact.
    Lost,
}

/// Settings of the search for candidates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchSettings {
    /// Reach of the search in radii of the slave facet: facets farther apart are not a pair.
    pub factor: f64,
    /// How far apart two facets are.
    pub distance: SearchDistance,
    /// Least difference of the unit normals: facets that face the same way are not a pair.
    pub normal_orientation_threshold: f64,
    /// Pairs that are searched within a step.
    pub within_step: WithinStep,
    /// How contact starts.
    pub check: GapCheck,
    /// Whether nodes are looked for where their velocities take them (`dynamic_search`).
    pub dynamic: bool,
}

/// A pair of facets near each other that do not face the same way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Candidate {
    /// Slave facet of the interface.
    pub slave: u32,
    /// Master facet of the interface.
    pub master: u32,
    /// Whether the facets are within the search radius.
    pub within_reach: bool,
}

/// Candidates of an interface in the present configuration, ascending; none of those that certainly share no area there, unless nodes are
/// looked for elsewhere.
///
/// The search radius is a multiple of the distance from the centre of the slave to its farthest node, as decks set it. Where it is
/// measured between centres, facets whose boxes meet although their centres are farther apart are given too, marked.
pub fn candidates(part: &ModelPart, interface: &Interface, settings: &SearchSettings) -> Vec<Candidate> {
    let of_role = |role: Roles| -> Vec<u32> {
        (0..interface.facets.len() as u32).filter(|&f| interface.facets[f as usize].role == role).collect()
    };
    // Moved bodies and nodes that touch are judged by near facets, not by overlapping ones.
    let overlapping = !settings.dynamic && settings.check != GapCheck::DirectCheck;
    among(part, interface, &of_role(Roles::Slave), &of_role(Roles::Master), settings, overlapping)
}

/// Candidates between two lists of facets; `overlapping` leaves out those that certainly share no area.
pub(super) fn among(
    part: &ModelPart,
    interface: &Interface,
    slaves: &[u32],
    masters: &[u32],
    settings: &SearchSettings,
    overlapping: bool,
) -> Vec<Candidate> {
    let place = |f: u32| FacetExtent::of(part, &interface.facets[f as usize]);
    let places: Vec<FacetExtent> = masters.iter().map(|&m| place(m)).collect();
    let tree = Tree::new(places.iter().map(|p| p.bounds).collect());
    let of_slave = |at: usize| {
        let slave = slaves[at];
        let own = place(slave);
        let mut search_radius = settings.factor * own.radius;
        if settings.distance == SearchDistance::BeyondFirst {
            let facet = (&interface.facets[slave as usize], own.centre, own.normal);
            search_radius +=
                farthest_master(part, interface, facet, (masters, &tree), settings.normal_orientation_threshold);
        }
        let near = tree.meeting(&own.bounds.grown(search_radius));
        let found: Vec<Candidate> = near
            .into_iter()
            .map(|m| (masters[m as usize], &places[m as usize]))
            .filter(|(_, other)| norm(sub(own.normal, other.normal)) >= settings.normal_orientation_threshold)
            .filter(|(_, other)| !overlapping || own.may_overlap(other))
            .filter_map(|(master, other)| {
                let within_reach = match settings.distance {
                    SearchDistance::BetweenFacets | SearchDistance::BeyondFirst => true,
                    SearchDistance::BetweenCentres => norm(sub(own.centre, other.centre)) <= search_radius,
                };
                let meets = within_reach || own.bounds.grown(0.1 * own.radius).meets(&other.bounds);
                meets.then_some(Candidate { slave, master, within_reach })
            })
            .collect();
        found
    };
    parallel::map(slaves.len(), AT_A_TIME, of_slave).concat()
}

/// Extent of a facet: its box, centre, radius and normal.
pub(super) struct FacetExtent {
    bounds: Bounds,
    pub(super) centre: [f64; 3],
    pub(super) normal: [f64; 3],
    /// Distance from the centre to the farthest node.
    pub(super) radius: f64,
    /// Whether it is a surface.
    is_surface: bool,
}

impl FacetExtent {
    pub(super) fn of(part: &ModelPart, facet: &Facet) -> Self {
        let points = facet.positions(part);
        let centre: [f64; 3] = std::array::from_fn(|c| points.iter().map(|p| p[c]).sum::<f64>() / points.len() as f64);
        Self {
            bounds: Bounds::of(&points),
            centre,
            normal: facet.normal_at(&points),
            radius: points.iter().map(|p| norm(sub(*p, centre))).fold(0.0, f64::max),
            is_surface: facet.shape.dim() == 2,
        }
    }

    /// Whether this slave and that master may share an area: seen along the slave's normal, as surfaces are cut by lines between their
    /// nodes, the circles around both meet.
    fn may_overlap(&self, master: &Self) -> bool {
        let way = sub(master.centre, self.centre);
        let along = dot(way, self.normal);
        let across = norm(sub(way, scale(self.normal, along)));
        !(self.is_surface && master.is_surface) || across <= SLACK * (self.radius + master.radius)
    }
}
