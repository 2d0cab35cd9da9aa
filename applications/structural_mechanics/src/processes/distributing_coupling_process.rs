//! Couples a reference node R to the mean motion of a part, which stays deformable (RBE3).
//!
//! u_R and θ are the rigid-body mode that fits the displacement of the part best, in the mean square over its area:
//! u_R = ∫ u dA/A + θ × (x_R − c) and J θ = ∫ r × u dA. Weights are the nodal forces that a unit force and a unit moment at R give
//! ([`super::resultant`]): loads of R reach the nodes as uniform plus linear tractions with the same resultants. The constraints
//! eliminate the unknowns of R or, where supports prescribe them, as many unknowns of the part.

use std::ops::Range;

use zelus_core::assembly::System;
use zelus_core::diagnostics::{Diagnostic, Report, Result};
use zelus_core::model::{MasterSlaveConstraint, Model, ModelPart, NodeUnknown, ScalarVariable};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest, Target, check_unknowns};
use zelus_core::register;

use super::constraints_of_process::{couple, uncouple};
use super::kinematic_coupling_process::coupled_part;
use super::reference_node::{ReferenceNode, components, prepare, refuse_revolution, required};
use super::resultant::Resultant;
use crate::variables::{DISPLACEMENT, ROTATION};

/// Share of the largest weight that is round-off.
const ROUND_OFF: f64 = 1e-15;

/// An unknown of the reference node, and the weights of the nodes of the part.
type MeanMotion = (ScalarVariable, Vec<[f64; 3]>);

struct DistributingCoupling {
    target: Target,
    reference: ReferenceNode,
    resultant: Resultant,
    rows: Vec<MeanMotion>,
    /// Whether the unknowns of the reference node stay, and those of nodes are eliminated.
    leads: bool,
    /// Its constraints, by their place in the model part.
    made: Range<usize>,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(required)?;
    let target = coupled_part(&settings, request.model)?;
    let part = request.model.root(&target.path)?;
    refuse_revolution(part, &target)?;
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
    let leads = settings.get_bool("reference_node_leads")?;
    Ok(Box::new(DistributingCoupling { target, reference, resultant, rows, leads, made: 0..0 }))
}

/// The weights of each unknown of the reference node; `None` where nodes on a line do not determine a rotation.
fn rows(resultant: &Resultant, part: &ModelPart, reference: u32) -> Option<Vec<MeanMotion>> {
    let at = part.nodes.initial[reference as usize];
    let unit = |c: u8| std::array::from_fn(|d| f64::from(u8::from(d == usize::from(c))));
    let [translations, rotations] = components(part.info.domain_size);
    let by_force =
        translations.iter().map(|&c| Some((DISPLACEMENT.component(c), resultant.forces(unit(c), [0.0; 3], at)?)));
    let by_moment = rotations.iter().map(|&c| Some((ROTATION.component(c), resultant.forces([0.0; 3], unit(c), at)?)));
    by_force.chain(by_moment).collect()
}

/// Terms with weights beyond round-off of the largest.
fn masters(terms: Vec<(NodeUnknown, f64)>) -> Vec<(NodeUnknown, f64)> {
    let largest = terms.iter().fold(0.0_f64, |most, (_, weight)| most.max(weight.abs()));
    terms.into_iter().filter(|(_, weight)| weight.abs() > ROUND_OFF * largest).collect()
}

/// The unknowns of the reference node by those of the nodes.
fn reference_follows(rows: &[(NodeUnknown, Vec<f64>)], of_nodes: &[NodeUnknown]) -> Vec<MasterSlaveConstraint> {
    let follows = |(unknown, weights): &(NodeUnknown, Vec<f64>)| {
        let terms = of_nodes.iter().copied().zip(weights.iter().copied()).collect();
        MasterSlaveConstraint::new(*unknown, masters(terms))
    };
    rows.iter().map(follows).collect()
}

/// As many unknowns of the nodes by the others and those of the reference node: Gauss–Jordan elimination with full pivoting.
fn nodes_follow(rows: &[(NodeUnknown, Vec<f64>)], of_nodes: &[NodeUnknown]) -> Vec<MasterSlaveConstraint> {
    // Σ a u − Σ b u_R = 0, row by row, each scaled to its largest weight.
    let size = |weights: &[f64]| weights.iter().fold(0.0_f64, |most, weight| most.max(weight.abs()));
    let scaled = |(at, (_, weights)): (usize, &(NodeUnknown, Vec<f64>))| {
        let factor = size(weights).recip();
        let of_reference = (0..rows.len()).map(|other| if other == at { -factor } else { 0.0 });
        weights.iter().map(|weight| factor * weight).chain(of_reference).collect::<Vec<f64>>()
    };
    let mut system: Vec<Vec<f64>> = rows.iter().enumerate().map(scaled).collect();
    let mut pivots: Vec<Option<usize>> = vec![None; rows.len()];
    for _ in 0..rows.len() {
        let open = (0..rows.len()).filter(|&row| pivots[row].is_none());
        let entries = open.flat_map(|row| (0..of_nodes.len()).map(move |column| (row, column)));
        let largest = entries.max_by(|a, b| system[a.0][a.1].abs().total_cmp(&system[b.0][b.1].abs()));
        let Some((row, column)) = largest else { break };
        pivots[row] = Some(column);
        let lead = system[row][column];
        system[row].iter_mut().for_each(|entry| *entry /= lead);
        let own = system[row].clone();
        for other in (0..rows.len()).filter(|&other| other != row) {
            let factor = system[other][column];
            system[other].iter_mut().zip(&own).for_each(|(entry, own)| *entry -= factor * own);
        }
    }
    let all: Vec<NodeUnknown> = of_nodes.iter().copied().chain(rows.iter().map(|(unknown, _)| *unknown)).collect();
    let follows = |(row, pivot): (&Vec<f64>, &Option<usize>)| {
        let pivot = (*pivot)?;
        let is_pivot = |at: usize| pivots.contains(&Some(at));
        let others = (0..all.len()).filter(|&at| !is_pivot(at)).map(|at| (all[at], -row[at])).collect();
        Some(MasterSlaveConstraint::new(all[pivot], masters(others)))
    };
    system.iter().zip(&pivots).filter_map(follows).collect()
}

impl Process for DistributingCoupling {
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        let space = part.info.domain_size;
        let unknowns = |node| (0..space).map(move |c| (node, DISPLACEMENT.component(c as u8)));
        let of_nodes: Vec<NodeUnknown> = self.resultant.nodes().flat_map(unknowns).collect();
        let weights =
            |row: &MeanMotion| row.1.iter().flat_map(|weight| &weight[..space]).copied().collect::<Vec<f64>>();
        let rows: Vec<(NodeUnknown, Vec<f64>)> =
            self.rows.iter().map(|row| ((self.reference.node, row.0), weights(row))).collect();
        let new = if self.leads { nodes_follow(&rows, &of_nodes) } else { reference_follows(&rows, &of_nodes) };
        self.made = couple(part, &self.target, new);
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
        uncouple(model.root_mut(&self.target.path)?, &self.made);
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
