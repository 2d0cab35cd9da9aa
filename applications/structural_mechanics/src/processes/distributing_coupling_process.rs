//! Couples a reference node R to the mean motion of a part, which stays deformable (RBE3).
//!
//! u_R and θ are the rigid-body mode that fits the displacement of the part best, in the mean square over its area:
//! u_R = ∫ u dA/A + θ × (x_R − c) and J θ = ∫ r × u dA. Weights are the nodal forces that a unit force and a unit moment at R give
//! ([`super::resultant`]): loads of R reach the nodes as uniform plus linear tractions with the same resultants.

use std::ops::Range;

use zelus_core::assembly::System;
use zelus_core::diagnostics::{Diagnostic, Report, Result};
use zelus_core::model::{MasterSlaveConstraint, Model, ModelPart, ScalarVariable};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest, Target, check_unknowns};
use zelus_core::register;

use super::kinematic_coupling_process::coupled_part;
use super::reference_node::{ReferenceNode, components, prepare, required};
use super::resultant::Resultant;
use crate::variables::{DISPLACEMENT, ROTATION};

/// Share of the largest weight that is round-off.
const ROUND_OFF: f64 = 1e-15;

struct DistributingCoupling {
    target: Target,
    reference: ReferenceNode,
    resultant: Resultant,
    /// Unknown of the reference node, and the weights of the nodes.
    rows: Vec<(ScalarVariable, Vec<[f64; 3]>)>,
    /// Its constraints, by their place in the model part.
    made: Range<usize>,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(required)?;
    let target = coupled_part(&settings, request.model)?;
    let part = request.model.root(&target.path)?;
    let reference = ReferenceNode::new(&settings, part, &target)?;
    let resultant = Resultant::of(part, target.selection(&part.tree)?);
    if !(resultant.area > 0.0 && resultant.area.is_finite()) {
        let problem = Diagnostic::error("zero-area", format!("the area of {} is {}", target.path, resultant.area));
        return Err(problem.at(target.place).remedy("check the nodes of its conditions").into());
    }
    let rows = rows(&resultant, part, reference.node).ok_or_else(|| {
        let fact = format!("the nodes of {} lie on a line or at a point, whose rotation is unknown", target.path);
        let problem = Diagnostic::error("moment-without-arm", fact).at(target.place.clone());
        problem.remedy("name a surface, or use kinematic_coupling_process")
    })?;
    Ok(Box::new(DistributingCoupling { target, reference, resultant, rows, made: 0..0 }))
}

/// The weights of each unknown of the reference node; `None` where nodes on a line do not determine a rotation.
fn rows(resultant: &Resultant, part: &ModelPart, reference: u32) -> Option<Vec<(ScalarVariable, Vec<[f64; 3]>)>> {
    let at = part.nodes.initial[reference as usize];
    let unit = |c: u8| std::array::from_fn(|d| f64::from(u8::from(d == usize::from(c))));
    let [translations, rotations] = components(part.info.domain_size);
    let by_force =
        translations.iter().map(|&c| Some((DISPLACEMENT.component(c), resultant.forces(unit(c), [0.0; 3], at)?)));
    let by_moment = rotations.iter().map(|&c| Some((ROTATION.component(c), resultant.forces([0.0; 3], unit(c), at)?)));
    by_force.chain(by_moment).collect()
}

impl Process for DistributingCoupling {
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        let space = part.info.domain_size;
        let origin = format!("{} on {}", self.target.process, self.target.path);
        let follows = |(variable, weights): &(ScalarVariable, Vec<[f64; 3]>)| {
            let largest = weights.iter().flatten().fold(0.0_f64, |most, weight| most.max(weight.abs()));
            let terms = self.resultant.nodes().zip(weights).flat_map(|(node, weight)| {
                (0..space).map(move |c| ((node, DISPLACEMENT.component(c as u8)), weight[c]))
            });
            let masters = terms.filter(|(_, weight)| weight.abs() > ROUND_OFF * largest).collect();
            let slave = (self.reference.node, *variable);
            MasterSlaveConstraint { origin: origin.clone(), ..MasterSlaveConstraint::new(slave, masters) }
        };
        let new: Vec<_> = self.rows.iter().map(follows).collect();
        self.made = part.add_constraints(new);
        Ok(())
    }

    fn check(&self, model: &Model, system: &System, warnings: &mut Report) -> Result<()> {
        let part = model.root(&self.target.path)?;
        self.reference.check(part, system)?;
        let unknowns = self.resultant.nodes().map(|node| (node, DISPLACEMENT.component(0)));
        check_unknowns(part, system, unknowns, &self.target.place)?;
        if !self.resultant.by_area {
            let count = self.resultant.nodes().len();
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
        self.reference.see(model.root(&self.target.path)?);
        Ok(())
    }

    fn summary(&self) -> Vec<(&'static str, f64)> {
        self.reference.summary()
    }

    fn last_messages(&self, model: &Model) -> Vec<Diagnostic> {
        let part = model.root(&self.target.path).ok();
        part.and_then(|part| self.reference.large_rotation(part)).into_iter().collect()
    }

    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        // Later stages have couplings of their own.
        let part = model.root_mut(&self.target.path)?;
        part.constraints[self.made.clone()].iter_mut().for_each(|constraint| constraint.active = false);
        Ok(())
    }

    fn suspend(&mut self, _model: &mut Model) -> Result<()> {
        Ok(())
    }
}

register! { ProcessEntry "distributing_coupling_process",
    aliases: &["DistributingCouplingProcess"],
    about: "couples a reference node to the mean motion of a part, which stays deformable (RBE3)",
    source: "u_R = ∫ u dA/A + θ × (x_R − c), J θ = ∫ r × u dA",
    common: &["model_part_name", "reference_model_part_name"],
    prepares: prepare,
    defaults: include_str!("../../../../configs/processes/distributing_coupling_process.json"),
    build: build,
}
