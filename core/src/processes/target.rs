//! Targets in the settings of a process: its model part, its variable, a file.

use std::path::Path;

use super::prescription::{Load, LoadCarrier, is_body_load, is_load};
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Place, Report, Result};
use crate::model::{
    Model, ModelPart, Named, NodeUnknown, Owner, ScalarVariable, SubPart, VariableEntry, VariableKind, named,
};
use crate::parameters::{Defaults, Interval, Node, Settings};
use crate::registry::{Entry, Kind};

/// Data that most processes share: a part of the model, a time span, and the place in the deck to blame.
#[derive(Debug, Clone)]
pub struct Target {
    /// Full dotted path of the model part.
    pub path: String,
    /// When the process acts.
    pub interval: Interval,
    /// Where the deck names the part.
    pub place: Place,
    /// Name of the process, for messages.
    pub process: String,
}

impl Target {
    /// Reads `"model_part_name"`, which the model must have, and `"interval"`.
    ///
    /// # Errors
    /// `missing-key` without a name, `unknown-model-part`, `invalid-interval`.
    pub fn new(settings: &Settings, model: &Model) -> Result<Self> {
        let path = settings.get_str("model_part_name")?;
        let place = settings.key_place("model_part_name");
        if path.is_empty() {
            let problem =
                settings.error("model_part_name", "missing-key", "\"model_part_name\" must name a model part");
            return Err(problem.remedy("write the full path, e.g. \"Structure.Parts\"").into());
        }
        model.root(path).and_then(|root| root.part(path)).map_err(|e| e.at(&place))?;
        let interval = Interval::from_node(settings.get("interval")?)?;
        Ok(Self { path: path.to_owned(), interval, place, process: settings.name().to_owned() })
    }

    /// The path below the root part, for [`SubPart::find`].
    pub(super) fn below_root(&self) -> &str {
        self.path.split_once('.').map_or("", |(_, rest)| rest)
    }

    /// Whether its part lies in that root part.
    pub fn is_of(&self, root: &ModelPart) -> bool {
        self.path.split('.').next() == Some(root.tree.name.as_str())
    }

    /// The selection in the tree of its root part.
    pub fn selection<'t>(&self, tree: &'t SubPart) -> Result<&'t SubPart> {
        let gone = || Diagnostic::error("unknown-model-part", format!("the model part {:?} is gone", self.path));
        tree.find(self.below_root()).ok_or_else(|| gone().at(self.place.clone()).into())
    }

    /// The loads among these numbers, as given to members of its part; none where it is of another root than `part`.
    pub(super) fn load(
        &self,
        part: &ModelPart,
        variables: impl Iterator<Item = ScalarVariable>,
        on: LoadCarrier,
    ) -> Option<Load> {
        let variables: Vec<ScalarVariable> =
            variables.filter(|variable| is_load(variable.column) || is_body_load(variable.column)).collect();
        let selection = self.selection(&part.tree).ok().filter(|_| self.is_of(part) && !variables.is_empty())?;
        let members = match on {
            LoadCarrier::History | LoadCarrier::Nodes => &selection.nodes,
            LoadCarrier::Conditions => &selection.conditions,
            LoadCarrier::Elements => &selection.elements,
        };
        Some(Load {
            by: format!("{} on {}", self.process, self.path),
            place: self.place.clone(),
            interval: self.interval,
            variables,
            on,
            members: members.clone(),
        })
    }

    /// An error for a value that is not finite.
    pub fn not_finite(
        &self,
        variable: ScalarVariable,
        value: f64,
        time: f64,
        at: impl std::fmt::Display,
    ) -> Diagnostic {
        let fact = format!("{} gives {value} for {variable} at {at} at time {time}", self.process);
        Diagnostic::error("not-finite", fact)
            .at(self.place.clone())
            .remedy("check the function there, e.g. for a division by zero")
    }
}

/// Other faults in the parameters of a process that could not be made: the part and the variable that they name.
pub fn other_problems(entry: &Entry, parameters: &Node, model: &Model) -> Vec<Diagnostic> {
    let mut problems = Report::new();
    let Ok(defaults) = Defaults::parse(entry.name, entry.defaults) else { return Vec::new() };
    let Some((settings, _)) = Settings::complete(parameters, &defaults.lenient(), &mut Report::new()) else {
        return Vec::new();
    };
    let given = |key: &str| parameters.get(key).and_then(Node::as_str).filter(|name| !name.is_empty());
    if let Some(path) = given("model_part_name") {
        let found = model.root(path).and_then(|root| root.part(path));
        problems.absorb(found.map_err(|e| e.at(&settings.key_place("model_part_name"))));
    }
    if let Some(name) = given("variable_name").filter(|name| named(name).is_none()) {
        problems.push(unknown_variable(&settings, name, "variable"));
    }
    problems.diagnostics().to_vec()
}

fn unknown_variable(settings: &Settings, name: &str, wanted: &str) -> Diagnostic {
    let problem = settings.error("variable_name", "unknown-variable", format!("there is no {wanted} {name:?}"));
    problem.remedy(Kind::of::<VariableEntry>().remedy(name))
}

/// The content of the text file that `key` names.
///
/// # Errors
/// `missing-file`, at the key.
pub(super) fn read_text(settings: &Settings, key: &str, path: &Path) -> Result<String> {
    std::fs::read_to_string(path).map_err(|error| {
        let fact = format!("{} cannot be read: {error}", path.display());
        settings.error(key, "missing-file", fact).remedy("the path is relative to the deck").into()
    })
}

/// The scalar or component that `"variable_name"` names.
///
/// # Errors
/// `unknown-variable`.
pub(super) fn scalar_variable(settings: &Settings) -> Result<ScalarVariable> {
    let name = settings.get_str("variable_name")?;
    match named(name) {
        Some(Named::Component(variable)) => Ok(variable),
        Some(Named::Whole(column, VariableKind::Scalar)) => Ok(ScalarVariable { column, component: None }),
        Some(_) => {
            let fact = format!("{name} is not one number");
            let problem = settings.error("variable_name", "unknown-variable", fact);
            Err(problem.remedy(format!("name a scalar variable or a component, e.g. \"{name}_X\"")).into())
        }
        None => Err(unknown_variable(settings, name, "variable").into()),
    }
}

/// The numbers that a variable of nodes stands for: a scalar or a component, or the components of a vector in space or plane.
pub fn scalars_of(name: &str, domain_size: usize) -> Option<Vec<ScalarVariable>> {
    match named(name)? {
        Named::Component(variable) => Some(vec![variable]),
        Named::Whole(column, VariableKind::Scalar) => Some(vec![ScalarVariable { column, component: None }]),
        Named::Whole(column, VariableKind::Vector3) => {
            Some((0..domain_size as u8).map(|c| ScalarVariable { column, component: Some(c) }).collect())
        }
        Named::Whole(..) => None,
    }
}

/// The three components of the vector that `"variable_name"` names.
///
/// # Errors
/// `unknown-variable`.
pub(super) fn vector_variable(settings: &Settings) -> Result<[ScalarVariable; 3]> {
    let name = settings.get_str("variable_name")?;
    match named(name) {
        Some(Named::Whole(column, VariableKind::Vector3)) => {
            Ok([0, 1, 2].map(|c| ScalarVariable { column, component: Some(c) }))
        }
        Some(_) => {
            let problem =
                settings.error("variable_name", "unknown-variable", format!("{name} is not a vector of three"));
            Err(problem.remedy("name a variable of three components").into())
        }
        None => Err(unknown_variable(settings, name, "vector variable").into()),
    }
}

/// An error where constraints relate a variable that is not an unknown of the system; `place` is where the deck names it.
///
/// # Errors
/// `not-an-unknown`.
pub fn check_unknowns(
    part: &ModelPart,
    system: &System,
    mut unknowns: impl Iterator<Item = NodeUnknown>,
    place: &Place,
) -> Result<()> {
    match unknowns.find(|&(node, variable)| system.dofs.number_of(variable, Owner::Node(node)).is_none()) {
        None => Ok(()),
        Some((node, variable)) => {
            let fact = format!("{variable} is not an unknown of node {}", part.nodes.ids[node as usize]);
            Err(Diagnostic::error("not-an-unknown", fact)
                .at(place.clone())
                .remedy("tie unknowns of nodes that belong to elements")
                .into())
        }
    }
}
