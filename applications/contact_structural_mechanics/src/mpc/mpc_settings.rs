//! Settings of contact by constraints.

use std::collections::BTreeMap;

use zelus_core::Result;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::ModelPart;
use zelus_core::parameters::Interval;

use super::mpc_kind::MpcKind;
use super::node_relation::Weights;
use crate::friction::FrictionSettings;
use crate::interface::{Facet, Interface, Roles};
use crate::mortar::SegmentationSettings;
use crate::search::SearchSettings;
use crate::solver::ContactSolverSettings;

/// Settings of contact by constraints.
pub struct MpcSettings {
    /// Parts of the interfaces by key.
    pub parts: BTreeMap<String, Vec<String>>,
    /// Parts on the slave side by key.
    pub slaves: BTreeMap<String, Vec<String>>,
    /// The kind of constraints.
    pub kind: MpcKind,
    /// Whether contact always slides.
    pub pure_slip: bool,
    /// Friction.
    pub friction: FrictionSettings,
    /// Times in which the constraints act.
    pub interval: Interval,
    /// Settings of the search for pairs.
    pub search: SearchSettings,
    /// Steps between searches.
    pub database_step_update: usize,
    /// How overlaps are cut and integrated.
    pub segmentation: SegmentationSettings,
    /// Pressure, in Young's moduli, below which an active node is released.
    pub reaction_check_stiffness_factor: f64,
    /// Whether relations are made anew in every iteration.
    pub update_each_iteration: bool,
    /// Whether relations are made anew at each step.
    pub update_relations: bool,
    /// How the rows of a node make up its relation.
    pub weights: Weights,
    /// Whether openings stay as they are in the first step of a run.
    pub keeps_first_opening: bool,
    /// Whether sides are exchanged where supports hold all slaves of an interface.
    pub swaps_held_slaves: bool,
    /// Settings of contact at the solver.
    pub solver: ContactSolverSettings,
}

impl MpcSettings {
    /// Whether overlaps are tied for good.
    pub(crate) fn ties(&self) -> bool {
        self.kind == MpcKind::MeshTying
    }

    /// Whether relations hold all that their pairs integrate.
    pub(crate) fn consistent(&self) -> bool {
        self.weights == Weights::Consistent
    }
}

/// Refuses slaves of second order: their D has entries between nodes, while a constraint makes one node follow masters alone.
///
/// # Errors
/// The first such facet.
pub(crate) fn require_slaves_of_first_order(part: &ModelPart, interfaces: &[Interface]) -> Result<()> {
    let may_be_slave = |interface: &Interface, facet: &Facet| interface.open || facet.role == Roles::Slave;
    let slaves = interfaces.iter().flat_map(|i| i.facets.iter().filter(move |facet| may_be_slave(i, facet)));
    let Some(found) = slaves.into_iter().find(|facet| facet.shape != facet.shape.linear()) else { return Ok(()) };
    let id = part.elements.ids[found.element as usize];
    let fact = format!(
        "contact by constraints needs slaves of first order, and a slave facet of element {id} is of shape {:?}",
        found.shape
    );
    Err(Diagnostic::error("contact-facet", fact)
        .remedy("let the side of first order be the slave, or use alm_contact_process or mesh_tying_process, which take every shape")
        .into())
}

/// Refuses rigid shapes: a slave node would follow nodes that follow the reference node of the shape.
///
/// # Errors
/// A facet of a rigid shape.
pub(crate) fn refuse_rigid_shapes(interfaces: &[Interface]) -> Result<()> {
    let Some(own) = interfaces.iter().find(|own| own.facets.iter().any(Facet::is_rigid)) else { return Ok(()) };
    let fact = format!(
        "pair \"{}\" has a rigid shape, whose nodes are eliminated already: constraints cannot follow them",
        own.key
    );
    Err(Diagnostic::error("rigid-shape-mpc", fact).remedy("use alm_contact_process, or a penalty").into())
}
