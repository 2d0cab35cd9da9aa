//! Prescribed unknowns and loads of a process, asked for before anything runs.

use crate::diagnostics::Place;
use crate::entities::{ConditionEntry, ElementEntry};
use crate::model::{Rates, ScalarVariable};
use crate::parameters::Interval;
use crate::registry;

/// Values of one unknown that a process fixes.
#[derive(Debug, Clone, PartialEq)]
pub struct Prescription {
    /// The process and its part, for messages.
    pub by: String,
    /// Full dotted path of the part.
    pub part: String,
    /// The unknown.
    pub variable: ScalarVariable,
    /// Nodes (index); the value, `None` where the unknown stays as it is.
    pub values: Vec<(u32, Option<f64>)>,
}

/// Values of a vector along directions, which a process prescribes at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct DirectionalPrescription {
    /// The process and its part, for messages.
    pub by: String,
    /// Where the deck names the part.
    pub place: Place,
    /// The vector.
    pub column: &'static str,
    /// Nodes (index), unit vectors and values.
    pub values: Vec<(u32, [f64; 3], f64)>,
}

/// Carrier of the loads of a process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadCarrier {
    /// Nodes, in columns with history.
    History,
    /// Nodes, in columns without history.
    Nodes,
    /// Conditions.
    Conditions,
    /// Elements.
    Elements,
}

/// A load that a process gives to members of a part.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// The process and its part, for messages.
    pub by: String,
    /// Where the deck names the part.
    pub place: Place,
    /// When it acts.
    pub interval: Interval,
    /// The numbers that it sets.
    pub variables: Vec<ScalarVariable>,
    /// Carrier of the loads.
    pub on: LoadCarrier,
    /// Their places there, ascending.
    pub members: Vec<u32>,
}

/// Whether conditions of any kind are loaded by that variable.
pub(super) fn is_load(name: &str) -> bool {
    let kinds = registry::all::<ConditionEntry>();
    kinds.iter().any(|kind| kind.loads.is_some_and(|loads| loads.contains(&name)))
}

/// Whether elements of any kind are loaded by that variable of their nodes.
pub(crate) fn is_body_load(name: &str) -> bool {
    registry::all::<ElementEntry>().iter().any(|kind| kind.body_load.is_some_and(|(variable, _)| variable == name))
}

/// Whether a variable is an unknown of mechanics or heat or one of its derivatives.
pub(super) fn is_motion(column: &str) -> bool {
    Rates::all().any(|rates| [Some(rates.unknown), Some(rates.first), rates.second].contains(&Some(column)))
}

/// Components that meet a condition, and all of them.
pub(super) fn of_components<T>(components: impl Iterator<Item = T>, condition: impl Fn(T) -> bool) -> (usize, usize) {
    components.fold((0, 0), |(some, all), component| (some + usize::from(condition(component)), all + 1))
}

/// Values of a process that have no effect, wholly or in part.
pub(super) struct WithoutEffect {
    /// The fact, in words.
    pub fact: String,
    /// Whether none of the values has an effect.
    pub is_whole: bool,
}

impl WithoutEffect {
    /// Values without any effect.
    pub fn whole(fact: String) -> Self {
        Self { fact, is_whole: true }
    }

    /// A planar model takes some or all of the components of a vector for nothing.
    pub fn in_the_plane(names: &str, path: &str, lost: usize, components: usize) -> Option<Self> {
        let is_whole = lost == components;
        let follows = if is_whole { " only" } else { ", which is lost" };
        let fact = format!("{names} of {path} has a component out of the plane{follows}");
        (lost > 0).then_some(Self { fact, is_whole })
    }
}
