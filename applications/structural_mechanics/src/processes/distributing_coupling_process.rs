//! Couples a reference node to the mean motion of a part, which stays deformable (RBE3): [`super::distributing_coupling`].
//!
//! For small rotations u_R and θ are the rigid-body mode that fits the displacement of the part best, in the mean square over its area:
//! u_R = ∫ u dA/A + θ × (x_R − c) and J θ = ∫ r × u dA. Weights are the nodal forces that a unit force and a unit moment at R give
//! ([`super::resultant`]): loads of R reach the nodes as uniform plus linear tractions with the same resultants.

use zelus_core::assembly::System;
use zelus_core::diagnostics::{Diagnostic, Report, Result};
use zelus_core::entities::Interaction;
use zelus_core::model::{Model, ModelPart};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest, Target, check_unknowns};
use zelus_core::register;

use super::constraints_of_process::{couple, uncouple};
use super::distributing_coupling::{DistributingCoupling, far_nodes};
use super::kinematic_coupling::KinematicCoupling;
use super::kinematic_coupling_process::{coupled_part, has_large_rotations, masses_at, prepare};
use super::large_rotation::LargeRotation;
use super::reference_node::{ReferenceNode, refuse_explicit, refuse_revolution, required};
use super::resultant::Resultant;
use crate::variables::DISPLACEMENT;

struct DistributingCouplingProcess {
    target: Target,
    reference: ReferenceNode,
    coupling: DistributingCoupling,
    /// Whether the constraints follow large rotations.
    large: bool,
    /// Whether no step of the stage is accepted yet.
    is_first_step: bool,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(required)?;
    let target = coupled_part(&settings, request.model)?;
    let part = request.model.root(&target.path)?;
    refuse_revolution(part, &target)?;
    refuse_explicit(part, &target)?;
    let reference = ReferenceNode::new(&settings, part, &target)?;
    let resultant = Resultant::of(part, target.selection(&part.tree)?);
    if !(resultant.area > 0.0 && resultant.area.is_finite()) {
        let problem = Diagnostic::error("zero-area", format!("the area of {} is {}", target.path, resultant.area));
        return Err(problem.at(target.place).remedy("check the nodes of its conditions").into());
    }
    let leads = settings.get_bool("reference_node_leads")?;
    let sample = if leads { Vec::new() } else { far_nodes(part, &resultant) };
    let coupling = DistributingCoupling {
        target: target.clone(),
        reference: reference.node,
        resultant,
        leads,
        sample,
        masses: KinematicCoupling { by_spins: !leads, ..masses_at(&settings, part, &reference)? },
        made: 0..0,
    };
    if coupling.small_rows(part).is_none() {
        let fact = format!("the nodes of {} lie on a line or at a point, whose rotation is unknown", target.path);
        let problem = Diagnostic::error("moment-without-arm", fact).at(target.place);
        return Err(problem.remedy("name a surface, or use kinematic_coupling_process").into());
    }
    let large = has_large_rotations(&settings, part, &target)?;
    Ok(Box::new(DistributingCouplingProcess { target, reference, coupling, large, is_first_step: false }))
}

impl Process for DistributingCouplingProcess {
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        let new = self.coupling.small_constraints(part).unwrap_or_default();
        self.coupling.made = couple(part, &self.target, new);
        let new = self.coupling.masses.constraints(part.info.domain_size, [0.0; 3], [0.0; 3]);
        self.coupling.masses.made = couple(part, &self.target, new);
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
        self.coupling.masses.weigh(part);
        Ok(())
    }

    fn check(&self, model: &Model, system: &System, warnings: &mut Report) -> Result<()> {
        let part = model.root(&self.target.path)?;
        self.reference.check(part, system)?;
        let unknowns = self.coupling.resultant.nodes().map(|node| (node, DISPLACEMENT.component(0)));
        check_unknowns(part, system, unknowns, &self.target.place)?;
        if !self.coupling.resultant.by_area {
            let count = self.coupling.resultant.nodes().len();
            let fact = format!("{} has no lines or surfaces: its {count} nodes have equal weights", self.target.path);
            let note = Diagnostic::note("equal-shares", fact).at(self.target.place.clone());
            warnings.push(note.remedy("name a part with conditions to weigh the nodes by area"));
        }
        Ok(())
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
        let part = model.root_mut(&self.target.path)?;
        uncouple(part, &self.coupling.made);
        uncouple(part, &self.coupling.masses.made);
        Ok(())
    }

    fn suspend(&mut self, _model: &mut Model) -> Result<()> {
        Ok(())
    }
}

register! { ProcessEntry "distributing_coupling_process",
    aliases: &["DistributingCouplingProcess"],
    about: "couples a reference node to the mean motion of a part, which stays deformable (RBE3)",
    source: "x_R = ∫ x dA/A + R (X_R − c), ∫ R r × x dA = 0",
    common: &["model_part_name", "reference_model_part_name"],
    prepares: prepare,
    defaults: include_str!("../../../../configs/processes/distributing_coupling_process.json"),
    build: build,
}
