//! Gives conditions, elements or nodes data of their own: the worker of the processes on entities.
//!
//! Acts at the beginning of each step whose TIME is in the interval, not before the first. Nothing is undone afterwards:
//! the last value stays.

use super::local_axes::LocalAxes;
use super::prescription::{Load, LoadCarrier, WithoutEffect, is_body_load, is_load, is_motion, of_components};
use super::process::Process;
use super::scalar_value::ScalarValue;
use super::target::Target;
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Report, Result, did_you_mean};
use crate::model::{EntityTable, Fields, Model, ModelPart, Nodes, ScalarVariable, SubPart};
use crate::parameters::{Settings, SpaceTime};

/// Entities of a model part that can carry data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Container {
    /// Nodes.
    Nodes,
    /// Conditions.
    Conditions,
    /// Elements.
    Elements,
}

impl Container {
    const NAMES: [(&'static str, Self); 3] =
        [("nodes", Self::Nodes), ("conditions", Self::Conditions), ("elements", Self::Elements)];

    /// Load carrier of its data.
    pub(super) fn carrier(self) -> LoadCarrier {
        match self {
            Self::Nodes => LoadCarrier::Nodes,
            Self::Conditions => LoadCarrier::Conditions,
            Self::Elements => LoadCarrier::Elements,
        }
    }

    /// Reads the list `"entities"`.
    ///
    /// # Errors
    /// `invalid-value` for an empty list or a word that is none of these.
    pub fn list(settings: &Settings) -> Result<Vec<Self>> {
        let words = settings.get_strings("entities")?;
        if words.is_empty() {
            let problem = settings.error("entities", "invalid-value", "\"entities\" is empty");
            return Err(problem.remedy("list some of nodes, conditions, elements").into());
        }
        let find = |word: &String| {
            Self::NAMES.iter().find(|(name, _)| name == word).map(|(_, container)| *container).ok_or_else(|| {
                let problem = settings.error("entities", "invalid-value", format!("there are no entities {word:?}"));
                let near = did_you_mean(word, Self::NAMES.iter().map(|(name, _)| *name));
                problem.remedy(near.unwrap_or_else(|| "list some of nodes, conditions, elements".to_owned())).into()
            })
        };
        words.iter().map(find).collect()
    }
}

/// Value of one number of the data.
#[derive(Debug, Clone)]
pub struct EntityComponent {
    /// The number.
    pub variable: ScalarVariable,
    /// Its value; functions see the centre of the entity, where it is (`x y z`) and where it was (`X Y Z`).
    pub value: ScalarValue,
}

/// Sets data of the entities of a part, in the order of containers and components.
#[derive(Debug, Clone)]
pub struct AssignToEntities {
    /// Where and when.
    pub target: Target,
    /// Containers to assign to.
    pub containers: Vec<Container>,
    /// Values to assign.
    pub components: Vec<EntityComponent>,
    /// Axes of the functions.
    pub axes: Option<LocalAxes>,
}

impl AssignToEntities {
    fn apply(&self, part: &mut ModelPart) -> Result<()> {
        let time = part.info.time;
        if !self.target.interval.contains(time) {
            return Ok(());
        }
        let selection = self.target.selection(&part.tree)?;
        for container in &self.containers {
            match container {
                Container::Nodes => {
                    let nodes = &mut part.nodes;
                    let (ids, current, initial) = (&nodes.ids, &nodes.current, &nodes.initial);
                    let at = |n: usize| SpaceTime { current: current[n], initial: initial[n], time };
                    self.set(&mut nodes.values, &selection.nodes, time, at, |n| format!("node {}", ids[n]))?;
                }
                Container::Conditions => {
                    self.set_table(&mut part.conditions, &selection.conditions, &part.nodes, time, "condition")?
                }
                Container::Elements => {
                    self.set_table(&mut part.elements, &selection.elements, &part.nodes, time, "element")?
                }
            }
        }
        Ok(())
    }

    fn set_table(&self, table: &mut EntityTable, selected: &[u32], nodes: &Nodes, time: f64, word: &str) -> Result<()> {
        let mut data = std::mem::take(&mut table.data);
        let at = |n: usize| {
            let of = table.nodes(n as u32);
            SpaceTime { current: centre(of, &nodes.current), initial: centre(of, &nodes.initial), time }
        };
        let done = self.set(&mut data, selected, time, at, |n| format!("{word} {}", table.ids[n]));
        table.data = data;
        done
    }

    fn set(
        &self,
        data: &mut Fields,
        selected: &[u32],
        time: f64,
        at: impl Fn(usize) -> SpaceTime,
        name: impl Fn(usize) -> String,
    ) -> Result<()> {
        for EntityComponent { variable, value } in &self.components {
            data.add_named(variable.column, if variable.component.is_some() { 3 } else { 1 });
            let field = data.field_mut(variable.column)?;
            let stride = field.components;
            let constant = (!value.uses_space()).then(|| value.value(&SpaceTime { time, ..SpaceTime::default() }));
            for &index in selected {
                let index = index as usize;
                let number = constant.unwrap_or_else(|| {
                    let here = at(index);
                    value.value(&self.axes.as_ref().map_or(here, |axes| axes.map(&here)))
                });
                if !number.is_finite() {
                    return Err(self.target.not_finite(*variable, number, time, name(index)).into());
                }
                field.levels[0][index * stride + variable.offset()] = number;
            }
        }
        Ok(())
    }
}

/// Mean of the positions of the nodes.
pub(super) fn centre(nodes: &[u32], positions: &[[f64; 3]]) -> [f64; 3] {
    let sum = nodes.iter().fold([0.0; 3], |sum, &n| crate::vector3::add(sum, positions[n as usize]));
    crate::vector3::scale(sum, 1.0 / nodes.len() as f64)
}

impl AssignToEntities {
    /// Reasons why the values set on entities of a kind have no effect.
    fn without_effect(&self, part: &ModelPart) -> Result<Vec<WithoutEffect>> {
        let selection = self.target.selection(&part.tree)?;
        let reasons =
            self.containers.iter().filter_map(|container| self.without_effect_on(*container, part, selection));
        Ok(reasons.collect())
    }

    fn without_effect_on(&self, container: Container, part: &ModelPart, selection: &SubPart) -> Option<WithoutEffect> {
        let path = &self.target.path;
        let mut names: Vec<&str> = self.components.iter().map(|c| c.variable.column).collect();
        names.dedup();
        let loads = || names.iter().all(|name| is_load(name) || is_body_load(name) || is_motion(name));
        let names_in_words = names.join(", ");
        let (word, table, selected) = match container {
            // Loads and motions have a history, and nothing reads them elsewhere.
            Container::Nodes => {
                let fact =
                    format!("{names_in_words} of {path} is given to nodes without history, where nothing reads it");
                return loads().then(|| WithoutEffect::whole(fact));
            }
            Container::Conditions => ("condition", &part.conditions, &selection.conditions),
            Container::Elements => ("element", &part.elements, &selection.elements),
        };
        let Some(first) = selected.first() else {
            let fact = format!("{path} has no {word}s that {names_in_words} could act on");
            return part.share.is_none().then(|| WithoutEffect::whole(fact));
        };
        let reads = |at: &u32| match table.kinds[*at as usize].loads {
            Some(own) => names.iter().any(|name| own.contains(name)),
            None => container == Container::Conditions || !loads(),
        };
        if !selected.iter().any(reads) {
            let kind = table.kinds[*first as usize].name;
            let fact = format!("no {word} of {path} takes {names_in_words}; the first is a {kind}");
            return Some(WithoutEffect::whole(fact));
        }
        // moments of the plane act about the axis across it
        let turns = |name: &str| {
            let kinds = selected.iter().map(|&at| table.kinds[at as usize]);
            kinds.into_iter().any(|kind| kind.turns && kind.loads.is_some_and(|own| own.contains(&name)))
        };
        let is_planar = part.info.domain_size == 2;
        let out_of_plane =
            |c: &EntityComponent| c.variable.component == Some(2) && is_planar && !turns(c.variable.column);
        let acts = self.components.iter().filter(|c| !c.value.is_zero());
        let (lost, all) = of_components(acts, out_of_plane);
        WithoutEffect::in_the_plane(&names_in_words, path, lost, all)
    }
}

impl Process for AssignToEntities {
    fn check(&self, model: &Model, _system: &System, warnings: &mut Report) -> Result<()> {
        for idle in self.without_effect(model.root(&self.target.path)?)? {
            let problem = Diagnostic::warning("acts-on-nothing", idle.fact).at(self.target.place.clone());
            warnings.push(problem.remedy(
                "name the part that holds the conditions to load, and the variable they take: `zelus describe` of a condition says it",
            ));
        }
        Ok(())
    }

    fn drives(&self, part: &ModelPart, _system: &System) -> bool {
        let gives = self.components.iter().any(|component| !component.value.is_zero());
        let idle = || {
            self.without_effect(part)
                .is_ok_and(|idle| idle.iter().filter(|idle| idle.is_whole).count() == self.containers.len())
        };
        gives && !(self.target.is_of(part) && idle())
    }

    fn loads(&self, part: &ModelPart) -> Vec<Load> {
        let variables = || self.components.iter().map(|component| component.variable);
        self.containers.iter().filter_map(|of| self.target.load(part, variables(), of.carrier())).collect()
    }

    fn begin_step(&mut self, model: &mut Model) -> Result<()> {
        self.apply(model.root_mut(&self.target.path)?)
    }
}
