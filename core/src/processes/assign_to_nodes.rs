//! Prescribes values and fixities of nodal unknowns: the worker of the nodal processes.
//!
//! While TIME is in the interval, at the beginning of a step the unknown is fixed and its value set; at the end of that
//! step it is released on all nodes of the part. Between steps all such unknowns are therefore free, a later process on
//! the same unknown wins, and fixities of the mesh file on the same unknown last one step only.

use super::face_direction;
use super::local_axes::LocalAxes;
use super::prescription::{Load, LoadCarrier, Prescription, WithoutEffect, is_load, is_motion, of_components};
use super::process::Process;
use super::scalar_value::ScalarValue;
use super::target::Target;
use crate::assembly::{DofTable, System};
use crate::diagnostics::{Diagnostic, Report, Result};
use crate::model::{Model, ModelPart, Rates, ScalarVariable};
use crate::parameters::SpaceTime;

/// Value prescribed for one unknown.
#[derive(Debug, Clone)]
pub struct NodalComponent {
    /// The unknown.
    pub variable: ScalarVariable,
    /// Its value; `None` leaves it as it is.
    pub value: Option<ScalarValue>,
    /// Whether it is fixed during the step; if not, the value is only where iterations start.
    pub fixed: bool,
}

/// Sets and fixes unknowns on the nodes of a part, in the order of the components.
#[derive(Debug, Clone)]
pub struct AssignToNodes {
    /// Where and when.
    pub target: Target,
    /// Values to assign.
    pub components: Vec<NodalComponent>,
    /// Axes of the functions.
    pub axes: Option<LocalAxes>,
    /// Whether it also acts before the first step, at TIME 0.
    pub before_loop: bool,
    /// Whether it acts in this step.
    active: bool,
    /// Whether it has acted before the first step, which lasts until the end of that.
    held: bool,
    messages: Vec<Diagnostic>,
}

impl AssignToNodes {
    /// A process that acts before the first step and at the beginning of each.
    pub fn new(target: Target, components: Vec<NodalComponent>, axes: Option<LocalAxes>) -> Self {
        Self { target, components, axes, before_loop: true, active: false, held: false, messages: Vec::new() }
    }

    /// Fixes and sets if the time is right; whether it is. A value that is not finite stops the run if `strict`.
    fn apply(&self, part: &mut ModelPart, strict: bool) -> Result<bool> {
        let time = part.info.time;
        if !self.target.interval.contains(time) {
            return Ok(false);
        }
        let nodes = &self.target.selection(&part.tree)?.nodes;
        for component in &self.components {
            let variable = component.variable;
            if component.fixed {
                part.nodes.set_fixed(variable, nodes, true);
            }
            let Some(value) = &component.value else { continue };
            let field = part.nodes.history.field_mut(variable.column).map_err(|e| e.at(&self.target.place))?;
            let stride = field.components;
            let column = &mut *field.levels[0];
            let constant = (!value.uses_space()).then(|| value.value(&SpaceTime { time, ..SpaceTime::default() }));
            for &node in nodes {
                let at = node as usize;
                let number = constant.unwrap_or_else(|| {
                    let here = SpaceTime { current: part.nodes.current[at], initial: part.nodes.initial[at], time };
                    value.value(&self.axes.as_ref().map_or(here, |axes| axes.map(&here)))
                });
                if !number.is_finite() {
                    if !strict {
                        continue;
                    }
                    let at = format!("node {}", part.nodes.ids[at]);
                    return Err(self.target.not_finite(variable, number, time, at).into());
                }
                column[at * stride + variable.offset()] = number;
            }
        }
        Ok(true)
    }

    fn release(&self, part: &mut ModelPart) -> Result<()> {
        let nodes = &self.target.selection(&part.tree)?.nodes;
        for component in self.components.iter().filter(|c| c.fixed) {
            part.nodes.set_fixed(component.variable, nodes, false);
        }
        Ok(())
    }

    /// Why it does nothing, where that is so.
    fn without_effect(&self, part: &ModelPart) -> Result<Option<WithoutEffect>> {
        let Target { path, process, .. } = &self.target;
        if self.target.selection(&part.tree)?.nodes.is_empty() && part.share.is_none() {
            return Ok(Some(WithoutEffect::whole(format!("{path} has no nodes that {process} could act on"))));
        }
        if self.components.iter().all(|component| component.value.is_none() && !component.fixed) {
            return Ok(Some(WithoutEffect::whole(format!(
                "{process} on {path} gives no component a value, and fixes none"
            ))));
        }
        let acts = |c: &&NodalComponent| c.value.as_ref().is_some_and(|value| !value.is_zero());
        let out_of_plane = |c: &NodalComponent| -> bool {
            let name = c.variable.column;
            c.variable.component == Some(2) && part.info.domain_size == 2 && (is_motion(name) || is_load(name))
        };
        let name = self.components[0].variable.column;
        let (lost, of_value) = of_components(self.components.iter().filter(acts), out_of_plane);
        if let Some(lost) = WithoutEffect::in_the_plane(name, path, lost, of_value) {
            return Ok(Some(lost));
        }
        if let Some(guess) = self.components.iter().find(|component| self.is_guess(part, component)) {
            let is_whole = self.components.iter().all(|component| !component.fixed);
            let fact = format!(
                "{process} gives {} of {path} a value that is not constrained: in statics iterations only begin there",
                guess.variable
            );
            return Ok(Some(WithoutEffect { fact, is_whole }));
        }
        let loads: Vec<&str> =
            self.components.iter().filter(acts).map(|c| c.variable.column).filter(|column| is_load(column)).collect();
        if let Some(name) = loads.first()
            && part.share.is_none()
            && !self.is_taken(part, &loads)?
        {
            return Ok(Some(WithoutEffect::whole(format!("no condition at the nodes of {path} takes {name}"))));
        }
        Ok(None)
    }

    /// Whether a value of steps is only the first iterate of an equilibrium. Zeros beside fixed components are no mistake.
    fn is_guess(&self, part: &ModelPart, component: &NodalComponent) -> bool {
        let history = &part.nodes.history;
        let of_statics = |rates: &Rates| rates.moves_mesh && !history.has(rates.first);
        let is_meant =
            component.value.as_ref().is_some_and(|value| !value.is_zero() || self.components.iter().all(|c| !c.fixed));
        let of_steps = self.target.interval.end > part.info.time;
        !component.fixed && is_meant && of_steps && Rates::of(component.variable.column).is_some_and(of_statics)
    }

    /// Whether a condition at one of the nodes takes one of these loads from them.
    fn is_taken(&self, part: &ModelPart, loads: &[&str]) -> Result<bool> {
        let mut selected = vec![false; part.nodes.len()];
        self.target.selection(&part.tree)?.nodes.iter().for_each(|&node| selected[node as usize] = true);
        let table = &part.conditions;
        let takes = |at: usize| {
            // A plain condition stands for whatever the solver makes of it.
            let of_kind = table.kinds[at].loads.filter(|own| !own.is_empty());
            let kind_takes = of_kind.is_none_or(|own| loads.iter().any(|load| own.contains(load)));
            kind_takes && table.nodes(at as u32).iter().any(|&node| selected[node as usize])
        };
        Ok((0..table.len()).any(takes))
    }

    /// The warning that a variable is fixed which is never solved for, e.g. a load: its values act all the same.
    fn fixed_in_vain(&self, dofs: &DofTable) -> Option<Diagnostic> {
        let solved = |column: &str| is_motion(column) || dofs.variables().any(|variable| variable.column == column);
        let component = self.components.iter().find(|c| c.fixed && !solved(c.variable.column))?;
        let Target { process, place, .. } = &self.target;
        let fact = format!("{process} fixes {}, which is not an unknown: it gives a value only", component.variable);
        let warning = Diagnostic::warning("not-an-unknown", fact).at(place.clone());
        (!dofs.is_empty()).then(|| warning.remedy("set \"constrained\": false"))
    }
}

impl Process for AssignToNodes {
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        for component in &self.components {
            part.nodes.history.field(component.variable.column).map_err(|e| e.at(&self.target.place))?;
        }
        let nodes = self.target.selection(&part.tree)?.nodes.clone();
        for NodalComponent { variable, value, .. } in self.components.iter().filter(|c| is_load(c.variable.column)) {
            let constant = if let Some(ScalarValue::Number(number)) = value { Some(*number) } else { None };
            let said = face_direction::pulling_of_nodes(part, &nodes, *variable, constant);
            self.messages.extend(said.map(|said| said.at(self.target.place.clone())));
        }
        Ok(())
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.messages)
    }

    fn check(&self, model: &Model, system: &System, warnings: &mut Report) -> Result<()> {
        if let Some(warning) = self.fixed_in_vain(&system.dofs) {
            warnings.push(warning);
        }
        if let Some(idle) = self.without_effect(model.root(&self.target.path)?)? {
            let problem = Diagnostic::warning("acts-on-nothing", idle.fact).at(self.target.place.clone());
            warnings.push(problem.remedy("name the part and the components that are meant, or remove the process"));
        }
        Ok(())
    }

    fn drives(&self, part: &ModelPart, system: &System) -> bool {
        // An unknown that is given in each step and not fixed is where the iteration begins.
        let of_steps = self.target.interval.end > part.info.time;
        let begins =
            |c: &NodalComponent| of_steps && !c.fixed && system.dofs.variables().any(|v| v.column == c.variable.column);
        let given = |c: &NodalComponent| c.value.as_ref().is_some_and(|value| !value.is_zero()) && !begins(c);
        let idle = || matches!(self.without_effect(part), Ok(Some(idle)) if idle.is_whole);
        self.components.iter().any(given) && !(self.target.is_of(part) && idle())
    }

    fn prescribes(&self, part: &ModelPart, time: f64) -> Vec<Prescription> {
        let Some(selection) = self.target.selection(&part.tree).ok().filter(|_| self.target.is_of(part)) else {
            return Vec::new();
        };
        if !self.target.interval.contains(time) {
            return Vec::new();
        }
        let of_component = |component: &NodalComponent| {
            let value = |&node: &u32| {
                let at = node as usize;
                let here = SpaceTime { current: part.nodes.current[at], initial: part.nodes.initial[at], time };
                let here = self.axes.as_ref().map_or(here, |axes| axes.map(&here));
                (node, component.value.as_ref().map(|value| value.value(&here)))
            };
            Prescription {
                by: format!("{} on {}", self.target.process, self.target.path),
                part: self.target.path.clone(),
                variable: component.variable,
                values: selection.nodes.iter().map(value).collect(),
            }
        };
        self.components.iter().filter(|component| component.fixed).map(of_component).collect()
    }

    fn loads(&self, part: &ModelPart) -> Vec<Load> {
        let set = self.components.iter().filter(|component| component.value.is_some());
        let variables = set.map(|component| component.variable);
        self.target.load(part, variables, LoadCarrier::History).into_iter().collect()
    }

    fn before_loop(&mut self, model: &mut Model) -> Result<()> {
        if self.before_loop {
            let part = model.root_mut(&self.target.path)?;
            // A function like 1/t has no value at TIME 0, and needs none where a step sets it.
            let only_now = self.target.interval.end <= part.info.time;
            self.held = self.apply(part, only_now)?;
        }
        Ok(())
    }

    fn begin_step(&mut self, model: &mut Model) -> Result<()> {
        self.active = self.apply(model.root_mut(&self.target.path)?, true)?;
        Ok(())
    }

    fn end_step(&mut self, model: &mut Model, _system: &System) -> Result<()> {
        if std::mem::take(&mut self.active) | std::mem::take(&mut self.held) {
            self.release(model.root_mut(&self.target.path)?)?;
        }
        Ok(())
    }
}
