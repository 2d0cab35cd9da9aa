//! Couples the nodes of a part to a reference node so that they move as a rigid body: [`super::kinematic_coupling`].

use zelus_core::assembly::System;
use zelus_core::diagnostics::{Diagnostic, Report, Result};
use zelus_core::entities::Interaction;
use zelus_core::model::{Model, ModelPart};
use zelus_core::parameters::{Interval, Settings};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest, Target, check_unknowns};
use zelus_core::register;
use zelus_core::vector3::sub;

use super::constraints_of_process::{couple, uncouple};
use super::kinematic_coupling::KinematicCoupling;
use super::large_rotation::LargeRotation;
use super::reference_node::{self, PART, ReferenceNode, refuse_explicit, refuse_revolution, required};
use super::rigid_body_mass::{self, add_to_mesh, part_of_masses};

/// A coupling with its reference node.
pub(super) struct KinematicCouplingProcess {
    target: Target,
    reference: ReferenceNode,
    coupling: KinematicCoupling,
    /// Whether the constraints follow large rotations.
    large: bool,
    /// Whether no step of the stage is accepted yet.
    is_first_step: bool,
}

/// The part that a coupling names, at all times.
pub(super) fn coupled_part(settings: &Settings, model: &Model) -> Result<Target> {
    let (path, place) = (settings.get_str("model_part_name")?.to_owned(), settings.key_place("model_part_name"));
    model.root(&path).and_then(|root| root.part(&path)).map_err(|error| error.at(&place))?;
    Ok(Target { path, interval: Interval::ALWAYS, place, process: settings.name().to_owned() })
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(required)?;
    let target = coupled_part(&settings, request.model)?;
    let part = request.model.root(&target.path)?;
    refuse_revolution(part, &target)?;
    refuse_explicit(part, &target)?;
    let reference = ReferenceNode::new(&settings, part, &target)?;
    let wanted: [bool; 3] = settings.get("components")?.parse("components")?;
    let coupled: Vec<u8> = (0..part.info.domain_size as u8).filter(|&c| wanted[usize::from(c)]).collect();
    if coupled.is_empty() {
        let problem = settings.error("components", "invalid-value", "no component is coupled");
        return Err(problem.remedy("write true for one at least, in planar models in the plane").into());
    }
    let large = has_large_rotations(&settings, part, &target)?;
    Ok(Box::new(KinematicCouplingProcess::new(&settings, part, target, reference, (coupled, large))?))
}

impl KinematicCouplingProcess {
    /// The coupling of the nodes of a part in these components, under large rotations or small ones.
    ///
    /// # Errors
    /// Masses that no body has.
    pub(super) fn new(
        settings: &Settings,
        part: &ModelPart,
        target: Target,
        reference: ReferenceNode,
        (coupled, large): (Vec<u8>, bool),
    ) -> Result<Self> {
        let nodes = &target.selection(&part.tree)?.nodes;
        let point = part.nodes.initial[reference.node as usize];
        let arm = |node: u32| sub(part.nodes.initial[node as usize], point);
        let arms = nodes.iter().map(|&node| (node, arm(node))).collect();
        let large = large && !part.info.solver.linear;
        let coupling = KinematicCoupling { arms, coupled, ..masses_at(settings, part, &reference)? };
        Ok(Self { target, reference, coupling, large, is_first_step: false })
    }
}

/// The coupling of the masses of the body alone.
///
/// # Errors
/// Masses that no body has.
pub(super) fn masses_at(settings: &Settings, part: &ModelPart, reference: &ReferenceNode) -> Result<KinematicCoupling> {
    let reference = reference.node;
    let point = part.nodes.initial[reference as usize];
    let masses = match rigid_body_mass::masses(settings, part.info.domain_size, point)?.len() {
        0 => Vec::new(),
        _ => {
            let nodes = part.part(&part_of_masses(settings.get_str(PART)?))?.nodes.iter().copied();
            let arm = |node: u32| sub(part.nodes.initial[node as usize], point);
            nodes.filter(|&node| node != reference).map(|node| (node, arm(node))).collect()
        }
    };
    Ok(KinematicCoupling { reference, arms: Vec::new(), coupled: Vec::new(), masses, by_spins: false, made: 0..0 })
}

/// Whether the constraints of a part follow large rotations; collective.
pub(super) fn has_large_rotations(settings: &Settings, part: &ModelPart, target: &Target) -> Result<bool> {
    let large = match settings.get("large_rotations")? {
        node if node.is_null() => !is_of_small_displacements(part, &target.selection(&part.tree)?.nodes),
        node => node.bool()?,
    };
    Ok(large && !part.info.solver.linear)
}

/// Makes the reference node and the masses of the body where they are missing.
pub(super) fn prepare(request: &mut ProcessRequest<'_>) -> Result<()> {
    reference_node::prepare(request)?;
    // Faults of the settings are told when the process is made.
    let Ok(settings) = request.settings_with(required) else { return Ok(()) };
    prepare_masses(request.model, &settings)
}

/// Makes the masses of the body where they are missing.
pub(super) fn prepare_masses(model: &mut Model, settings: &Settings) -> Result<()> {
    let path = settings.get_str(PART)?;
    let Ok(part) = model.root_mut(path) else { return Ok(()) };
    let Some(&[node]) = part.part(path).ok().map(|own| &own.nodes[..]) else { return Ok(()) };
    let point = part.nodes.initial[node as usize];
    let Ok(masses) = rigid_body_mass::masses(settings, part.info.domain_size, point) else { return Ok(()) };
    add_to_mesh(part, (path, node), &masses, settings)
}

/// Whether all elements at some nodes are of small displacements; collective.
fn is_of_small_displacements(part: &ModelPart, nodes: &[u32]) -> bool {
    let is_other = |at: usize| {
        let is_at = part.elements.nodes(at as u32).iter().any(|node| nodes.binary_search(node).is_ok());
        is_at && !part.elements.kinds[at].small_displacement
    };
    !part.ranks.any((0..part.elements.len()).any(is_other))
}

impl Process for KinematicCouplingProcess {
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        let new = self.coupling.constraints(part.info.domain_size, [0.0; 3], [0.0; 3]);
        self.coupling.made = couple(part, &self.target, new);
        Ok(())
    }

    fn interaction(&mut self, _model: &mut Model) -> Result<Option<(String, Box<dyn Interaction>)>> {
        let made = || Box::new(LargeRotation::new(Box::new(self.coupling.clone()))) as Box<dyn Interaction>;
        Ok(self.large.then(|| (self.target.path.clone(), made())))
    }

    fn before_loop(&mut self, _model: &mut Model) -> Result<()> {
        self.is_first_step = true;
        Ok(())
    }

    fn constrain(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        if self.is_first_step {
            self.coupling.start(part, self.large);
        }
        self.coupling.weigh(part);
        Ok(())
    }

    fn check(&self, model: &Model, system: &System, _warnings: &mut Report) -> Result<()> {
        let part = model.root(&self.target.path)?;
        self.reference.check(part, system)?;
        let slaves = part.constraints[self.coupling.made.clone()].iter().map(|constraint| constraint.slave);
        check_unknowns(part, system, slaves, &self.target.place)
    }

    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        false
    }

    fn end_step(&mut self, model: &mut Model, _system: &System) -> Result<()> {
        self.is_first_step = false;
        self.reference.see(model.root(&self.target.path)?);
        Ok(())
    }

    fn summary(&self) -> Vec<(&'static str, f64)> {
        self.reference.summary()
    }

    fn last_messages(&self, model: &Model) -> Vec<Diagnostic> {
        let part = model.root(&self.target.path).ok().filter(|_| !self.large);
        part.and_then(|part| self.reference.large_rotation(part)).into_iter().collect()
    }

    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        uncouple(model.root_mut(&self.target.path)?, &self.coupling.made);
        Ok(())
    }

    fn suspend(&mut self, _model: &mut Model) -> Result<()> {
        Ok(())
    }
}

register! { ProcessEntry "kinematic_coupling_process",
    aliases: &["KinematicCouplingProcess"],
    about: "couples the nodes of a part to a reference node as a rigid body (RBE2)",
    source: "u_i = u_R + (exp [θ]× − I) r_i",
    common: &["model_part_name", "reference_model_part_name"],
    prepares: prepare,
    defaults: include_str!("../../../../configs/processes/kinematic_coupling_process.json"),
    build: build,
}
