//! Supports along directions at nodes: d · u = g, the worker of processes that find the directions.
//!
//! Along an axis the component is fixed, as by [`super::AssignToNodes`]. Otherwise a linear constraint eliminates one component of the
//! node. Once every process has prescribed its values, the equations of a node are solved together
//! ([`reduce_supports`](crate::model::reduce_supports)). At the end of the step all is released.

use std::ops::Range;

use rustc_hash::{FxHashMap, FxHashSet};

use super::prescription::{DirectionalPrescription, Prescription};
use super::process::Process;
use super::scalar_value::ScalarValue;
use super::target::{Target, check_unknowns};
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Report, Result};
use crate::model::{
    DirectionalSupport, MasterSlaveConstraint, Model, ModelPart, NodeUnknown, ScalarVariable, SupportConflict,
    SupportedComponent, reduce_supports,
};
use crate::parameters::SpaceTime;

/// Component of a unit vector that is round-off.
const ROUND_OFF: f64 = 1e-12;

/// Prescribes a vector along one direction at each node of a part.
#[derive(Debug, Clone)]
pub struct DirectionalSupports {
    /// Where and when.
    target: Target,
    /// The vector.
    column: &'static str,
    value: ScalarValue,
    /// Nodes with axis directions: the component, and its sign in the direction.
    along_axes: Vec<(u32, u8, f64)>,
    /// The other nodes with unit vectors, one constraint each.
    oblique: Vec<(u32, [f64; 3])>,
    /// The constraints, by their place in the model part.
    made: Range<usize>,
    /// Whether it acts in this step.
    active: bool,
}

impl DirectionalSupports {
    /// Prescribes `value` along a direction at each node; directions have unit length.
    pub fn new(
        target: Target,
        column: &'static str,
        value: ScalarValue,
        directions: impl IntoIterator<Item = (u32, [f64; 3])>,
    ) -> Self {
        let (mut along_axes, mut oblique) = (Vec::new(), Vec::new());
        for (node, direction) in directions {
            let direction = direction.map(|d| if d.abs() <= ROUND_OFF { 0.0 } else { d });
            let mut parts = (0..3_u8).filter(|&c| direction[usize::from(c)] != 0.0);
            match (parts.next(), parts.next()) {
                (Some(c), None) => along_axes.push((node, c, direction[usize::from(c)].signum())),
                _ => oblique.push((node, direction)),
            }
        }
        Self { target, column, value, along_axes, oblique, made: 0..0, active: false }
    }

    fn variable(&self, c: u8) -> ScalarVariable {
        ScalarVariable { column: self.column, component: Some(c) }
    }

    fn value_at(&self, part: &ModelPart, node: u32, time: f64) -> f64 {
        let at = node as usize;
        self.value.value(&SpaceTime { current: part.nodes.current[at], initial: part.nodes.initial[at], time })
    }

    fn by(&self) -> String {
        format!("{} on {}", self.target.process, self.target.path)
    }

    /// Nodes along axes with the values of their components.
    fn components(&self, part: &ModelPart, time: f64, c: u8) -> Vec<(u32, f64)> {
        let own = self.along_axes.iter().filter(|along| along.1 == c);
        own.map(|&(node, _, sign)| (node, sign * self.value_at(part, node, time))).collect()
    }

    fn finite(&self, part: &ModelPart, node: u32, value: f64) -> Result<()> {
        if value.is_finite() {
            return Ok(());
        }
        let at = format!("node {}", part.nodes.ids[node as usize]);
        Err(self.target.not_finite(self.variable(0), value, part.info.time, at).into())
    }
}

/// The error that a support along a direction cannot hold beside others.
pub(crate) fn conflict(
    by: &str,
    node: usize,
    direction: [f64; 3],
    dimension: usize,
    conflict: &SupportConflict,
) -> Diagnostic {
    let along: Vec<String> = direction[..dimension].iter().map(|d| format!("{d:.6}")).collect();
    let along = along.join(", ");
    match conflict {
        SupportConflict::Contradiction(_, [other, own]) => {
            let fact =
                format!("{by} prescribes {own} along ({along}) at node {node}, and other supports give it {other}");
            Diagnostic::error("contradicting-supports", fact)
                .remedy("take the node out of one of the parts, or prescribe values that agree")
        }
        SupportConflict::Constrained(_) => {
            let fact =
                format!("{by} prescribes node {node} along ({along}), and constraints make it follow other nodes");
            Diagnostic::error("support-on-constraint", fact)
                .remedy("take the node out of the support, or make it a master of the constraint")
        }
    }
}

/// The equations of the supports at the nodes of these constraints, solved together, replace those constraints.
///
/// # Errors
/// The constraint that cannot hold beside the others.
fn resolve(part: &mut ModelPart, own: Range<usize>) -> std::result::Result<(), (usize, SupportConflict)> {
    let key = |constraint: &MasterSlaveConstraint| (constraint.slave.0, constraint.slave.1.column);
    let wanted: FxHashSet<(u32, &str)> = part.constraints[own].iter().map(key).collect();
    let mut groups: FxHashMap<(u32, &'static str), Vec<usize>> = FxHashMap::default();
    let mut following: FxHashSet<NodeUnknown> = FxHashSet::default();
    let mut order = Vec::new();
    for (at, constraint) in part.constraints.iter().enumerate().filter(|(_, c)| wanted.contains(&key(c))) {
        match constraint.support {
            Some(support) if support.acts => {
                let group = groups.entry(key(constraint)).or_default();
                if group.is_empty() {
                    order.push(key(constraint));
                }
                group.push(at);
            }
            None if constraint.active && constraint.set.is_none() => {
                following.insert(constraint.slave);
            }
            _ => {}
        }
    }
    let dimension = part.info.domain_size;
    for (node, column) in order {
        let members = &groups[&(node, column)];
        let variable = |c: usize| ScalarVariable { column, component: Some(c as u8) };
        let role = |c: usize| match () {
            () if following.contains(&(node, variable(c))) => SupportedComponent::Follows,
            () if part.nodes.is_fixed(variable(c), node) => {
                SupportedComponent::Prescribed(part.nodes.history.value(variable(c), node as usize, 0))
            }
            () => SupportedComponent::Free,
        };
        let equation = |&at: &usize| {
            let support = part.constraints[at].support.expect("that of a group has one");
            (support.direction, Some(support.value))
        };
        let equations: Vec<_> = members.iter().map(equation).collect();
        let reduced = reduce_supports(&equations, std::array::from_fn(role), dimension).map_err(|conflict| {
            let (SupportConflict::Contradiction(of, _) | SupportConflict::Constrained(of)) = conflict;
            (members[of], conflict)
        })?;
        for (&at, form) in members.iter().zip(reduced) {
            let constraint = &mut part.constraints[at];
            constraint.active = form.is_some();
            if let Some((c, masters, constant)) = form {
                constraint.slave = (node, variable(c));
                constraint.masters = masters.into_iter().map(|(m, weight)| ((node, variable(m)), weight)).collect();
                constraint.constant = constant;
            }
        }
    }
    Ok(())
}

impl Process for DirectionalSupports {
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        part.nodes.history.field(self.column).map_err(|e| e.at(&self.target.place))?;
        let follows = |&(node, direction): &(u32, [f64; 3])| MasterSlaveConstraint {
            active: false,
            support: Some(DirectionalSupport { direction, value: 0.0, acts: false }),
            ..MasterSlaveConstraint::new((node, self.variable(0)), Vec::new())
        };
        let new: Vec<_> = self.oblique.iter().map(follows).collect();
        self.made = part.add_constraints(new);
        Ok(())
    }

    fn check(&self, model: &Model, system: &System, _warnings: &mut Report) -> Result<()> {
        let part = model.root(&self.target.path)?;
        let along = self.along_axes.iter().map(|&(node, c, _)| (node, self.variable(c)));
        let all = self.oblique.iter().map(|&(node, _)| (node, self.variable(0)));
        check_unknowns(part, system, along.chain(all), &self.target.place)
    }

    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        !self.value.is_zero()
    }

    fn prescribes(&self, part: &ModelPart, time: f64) -> Vec<Prescription> {
        if !self.target.is_of(part) || !self.target.interval.contains(time) {
            return Vec::new();
        }
        let of_component = |c: u8| {
            let values = self.components(part, time, c).into_iter().map(|(node, value)| (node, Some(value))).collect();
            Prescription { by: self.by(), part: self.target.path.clone(), variable: self.variable(c), values }
        };
        // Also without nodes here: ranks list the same supports.
        (0..3).map(of_component).collect()
    }

    fn prescribes_along(&self, part: &ModelPart, time: f64) -> Option<DirectionalPrescription> {
        if !self.target.is_of(part) || !self.target.interval.contains(time) || self.oblique.is_empty() {
            return None;
        }
        let value = |&(node, direction): &(u32, [f64; 3])| (node, direction, self.value_at(part, node, time));
        let (by, place) = (self.by(), self.target.place.clone());
        Some(DirectionalPrescription {
            by,
            place,
            column: self.column,
            values: self.oblique.iter().map(value).collect(),
        })
    }

    fn begin_step(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        let time = part.info.time;
        self.active = self.target.interval.contains(time);
        if !self.active {
            return Ok(());
        }
        for c in 0..3 {
            let values = self.components(part, time, c);
            let nodes: Vec<u32> = values.iter().map(|(node, _)| *node).collect();
            part.nodes.set_fixed(self.variable(c), &nodes, true);
            for (node, value) in values {
                self.finite(part, node, value)?;
                let field = part.nodes.history.field_mut(self.column)?;
                let stride = field.components;
                field.levels[0][node as usize * stride + usize::from(c)] = value;
            }
        }
        for (at, &(node, direction)) in self.made.clone().zip(&self.oblique) {
            let value = self.value_at(part, node, time);
            self.finite(part, node, value)?;
            part.constraints[at].support = Some(DirectionalSupport { direction, value, acts: true });
        }
        Ok(())
    }

    fn constrain(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        if !self.active || self.oblique.is_empty() {
            return Ok(());
        }
        resolve(part, self.made.clone()).map_err(|(at, why)| {
            let constraint = &part.constraints[at];
            let id = part.nodes.ids[constraint.slave.0 as usize];
            let direction = constraint.support.map_or([0.0; 3], |support| support.direction);
            let problem = conflict(&self.by(), id, direction, part.info.domain_size, &why);
            problem.at(self.target.place.clone()).into()
        })
    }

    fn end_step(&mut self, model: &mut Model, _system: &System) -> Result<()> {
        if std::mem::take(&mut self.active) {
            let part = model.root_mut(&self.target.path)?;
            for c in 0..3 {
                let own = self.along_axes.iter().filter(|along| along.1 == c);
                let nodes: Vec<u32> = own.map(|along| along.0).collect();
                part.nodes.set_fixed(self.variable(c), &nodes, false);
            }
            for constraint in &mut part.constraints[self.made.clone()] {
                constraint.active = false;
                constraint.support.iter_mut().for_each(|support| support.acts = false);
            }
        }
        Ok(())
    }
}
