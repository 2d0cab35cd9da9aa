//! Everything that a deck names, found by that name.
//!
//! An object registers itself in its own file with [`crate::register`]; nothing else has to change. `zelus list` and
//! `zelus describe` read the same entries, and so does the check of a deck.

use std::any::Any;
use std::collections::BTreeMap;
use std::sync::LazyLock;

use crate::diagnostics::{Diagnostic, Result, did_you_mean};
use crate::entities::{BlockRequest, EntityBlock};
use crate::geometry::Shape;

/// The kinds of things a deck can name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// A piece of a body.
    Element,
    /// A piece of a boundary: a load or a contact pair.
    Condition,
    /// Stress from strain.
    ConstitutiveLaw,
    /// Limit of the tangential traction.
    FrictionLaw,
    /// Something done at fixed points of the stage loop.
    Process,
    /// Decides whether an iteration is good enough.
    ConvergenceCriterion,
    /// Integration in time.
    Scheme,
    /// The nonlinear solution of a step.
    Strategy,
    /// How constraints enter the system.
    BuilderAndSolver,
    /// Solves the linear system.
    LinearSolver,
    /// A relation between unknowns.
    Constraint,
    /// Prepares a model before a stage.
    Modeler,
    /// A solver of a stage (`solver_type`).
    Solver,
    /// A nested settings object of the solver that an application understands.
    SolverExtension,
}

impl Kind {
    /// The word used by `zelus list`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Element => "element",
            Self::Condition => "condition",
            Self::ConstitutiveLaw => "constitutive_law",
            Self::FrictionLaw => "friction_law",
            Self::Process => "process",
            Self::ConvergenceCriterion => "convergence_criterion",
            Self::Scheme => "scheme",
            Self::Strategy => "strategy",
            Self::BuilderAndSolver => "builder_and_solver",
            Self::LinearSolver => "linear_solver",
            Self::Constraint => "constraint",
            Self::Modeler => "modeler",
            Self::Solver => "solver",
            Self::SolverExtension => "solver_extension",
        }
    }

    /// All kinds in the order of the list.
    pub const ALL: [Self; 14] = [
        Self::Element,
        Self::Condition,
        Self::ConstitutiveLaw,
        Self::FrictionLaw,
        Self::Process,
        Self::ConvergenceCriterion,
        Self::Scheme,
        Self::Strategy,
        Self::BuilderAndSolver,
        Self::LinearSolver,
        Self::Constraint,
        Self::Modeler,
        Self::Solver,
        Self::SolverExtension,
    ];
}

/// How an entry makes its object.
pub enum Build {
    /// Elements and conditions: a block of them.
    Block(fn(&BlockRequest<'_>) -> Result<Box<dyn EntityBlock>>),
    /// Processes.
    Process(crate::processes::ProcessFactory),
    /// Any other factory, known to the code that asks for this kind: a reference to a function or a table.
    Factory(&'static (dyn Any + Send + Sync)),
    /// A name that is only known, with no object behind it.
    NameOnly,
}

/// One registered name.
pub struct Entry {
    /// What kind of thing.
    pub kind: Kind,
    /// The name decks use.
    pub name: &'static str,
    /// Other names of the same thing.
    pub aliases: &'static [&'static str],
    /// What it is, in a sentence.
    pub about: &'static str,
    /// Where its mathematics comes from: equation or literature.
    pub source: &'static str,
    /// Default settings in JSON with a comment on every key; empty when it has none.
    pub defaults: &'static str,
    /// Programs whose own defaults differ: their names, and the keys that differ with their values, JSON with comments.
    pub like: &'static [(&'static str, &'static str)],
    /// Reference cell of an element or condition.
    pub cell: Option<Shape>,
    /// Dimensions of the space an element or condition lives in: 2 or 3; 0 for everything else.
    pub space: usize,
    /// Variables with history that nodes of an element or condition have: name and number of components.
    pub nodal: &'static [(&'static str, usize)],
    /// Keys of a process whose parts, or nodes by id, every rank must have whole where several share a mesh.
    pub common: &'static [&'static str],
    /// How it is made.
    pub build: Build,
    /// Source file of the registration.
    pub file: &'static str,
    /// Line of the registration.
    pub line: u32,
}

impl Entry {
    /// An entry with nothing but its kind and name; [`crate::register`] fills the rest.
    pub const fn new(kind: Kind, name: &'static str, file: &'static str, line: u32) -> Self {
        Self {
            kind,
            name,
            aliases: &[],
            about: "",
            source: "",
            defaults: "",
            like: &[],
            cell: None,
            space: 0,
            nodal: &[],
            common: &[],
            build: Build::NameOnly,
            file,
            line,
        }
    }
}

impl Entry {
    /// Nodes of an element or condition; 0 for everything else.
    pub fn nodes(&self) -> usize {
        self.cell.map_or(0, Shape::nodes)
    }
}

impl std::fmt::Debug for Entry {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.kind.word(), self.name)
    }
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.kind == other.kind && self.name == other.name
    }
}

inventory::collect!(Entry);

/// Names of the reference program that are known and not there, by how they begin.
pub struct Absent {
    /// What kind of thing.
    pub kind: Kind,
    /// Beginnings of the names.
    pub stems: &'static [&'static str],
    /// What to use instead.
    pub remedy: &'static str,
}

inventory::collect!(Absent);

/// What to use instead of a known name that is not there; of several beginnings the longest counts.
pub fn instead_of(kind: Kind, name: &str) -> Option<&'static str> {
    let all = inventory::iter::<Absent>().filter(|absent| absent.kind == kind);
    let known = all.flat_map(|absent| absent.stems.iter().map(|stem| (*stem, absent.remedy)));
    known.filter(|(stem, _)| name.starts_with(stem)).max_by_key(|(stem, _)| stem.len()).map(|(_, remedy)| remedy)
}

type Index = BTreeMap<Kind, BTreeMap<&'static str, &'static Entry>>;

static INDEX: LazyLock<Index> = LazyLock::new(|| {
    let mut index = Index::new();
    for entry in inventory::iter::<Entry>() {
        let names = index.entry(entry.kind).or_default();
        names.insert(entry.name, entry);
        for alias in entry.aliases {
            names.insert(alias, entry);
        }
    }
    index
});

/// All entries, sorted by kind and name.
pub fn entries() -> Vec<&'static Entry> {
    let mut all: Vec<_> = inventory::iter::<Entry>().collect();
    all.sort_by_key(|entry| (entry.kind, entry.name, entry.file, entry.line));
    all
}

/// Names and aliases of a kind, sorted.
pub fn names(kind: Kind) -> impl Iterator<Item = &'static str> {
    INDEX.get(&kind).into_iter().flat_map(|names| names.keys().copied())
}

/// The entry of that kind and name or alias.
pub fn find(kind: Kind, name: &str) -> Option<&'static Entry> {
    INDEX.get(&kind)?.get(name).copied()
}

/// As [`find`].
///
/// # Errors
/// Input error `unknown-<kind>` with the nearest names; the caller adds the place.
pub fn require(kind: Kind, name: &str) -> Result<&'static Entry, Diagnostic> {
    find(kind, name).ok_or_else(|| {
        let instead = instead_of(kind, name).map(str::to_owned);
        let remedy = instead
            .or_else(|| did_you_mean(name, names(kind)))
            .unwrap_or_else(|| format!("`zelus list {}` shows what there is", kind.word()));
        let code = match kind {
            Kind::Element => "unknown-element",
            Kind::Condition => "unknown-condition",
            Kind::ConstitutiveLaw => "unknown-law",
            Kind::Process => "unknown-process",
            Kind::ConvergenceCriterion => "unknown-criterion",
            Kind::LinearSolver => "unknown-linear-solver",
            Kind::Solver => "unknown-solver",
            _ => "unknown-name",
        };
        Diagnostic::error(code, format!("there is no {} {name:?}", kind.word().replace('_', " "))).remedy(remedy)
    })
}

/// Names registered more than once, with both places; empty when all is well.
pub fn duplicates() -> Vec<String> {
    let mut seen: BTreeMap<(Kind, &str), &Entry> = BTreeMap::new();
    let mut out = Vec::new();
    for entry in entries() {
        for name in std::iter::once(&entry.name).chain(entry.aliases) {
            if let Some(first) = seen.insert((entry.kind, name), entry) {
                out.push(format!(
                    "{} {name}: {}:{} and {}:{}",
                    entry.kind.word(),
                    first.file,
                    first.line,
                    entry.file,
                    entry.line
                ));
            }
        }
    }
    out
}

/// Registers beginnings of names that are known and not there, with what to use instead.
///
/// ```ignore
/// register_absent! { Element ["Shell", "Sprism"] => "use solid elements, three or more across the thickness" }
/// ```
#[macro_export]
macro_rules! register_absent {
    ($kind:ident [$($stem:literal),+ $(,)?] => $remedy:literal) => {
        $crate::inventory::submit! { $crate::registry::Absent {
            kind: $crate::registry::Kind::$kind, stems: &[$($stem),+], remedy: $remedy } }
    };
}

/// Registers one object under its name: the last lines of its file.
///
/// ```ignore
/// register! { Process "assign_flag_process",
///     aliases: &["AssignFlagProcess"],
///     about: "sets or unsets a flag of nodes or entities",
///     defaults: include_str!("…/configs/processes/assign_flag_process.json"),
///     build: Build::Process(AssignFlag::boxed),
/// }
/// ```
#[macro_export]
macro_rules! register {
    ($kind:ident $name:expr, $($field:ident : $value:expr),* $(,)?) => {
        $crate::inventory::submit! { $crate::registry::Entry {
            $($field: $value,)*
            ..$crate::registry::Entry::new($crate::registry::Kind::$kind, $name, file!(), line!())
        } }
    };
}
