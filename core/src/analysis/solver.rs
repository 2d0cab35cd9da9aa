//! The solver of a stage as `solver_settings` describes it, made from registered objects.

use std::path::Path;

use zelus_linear_algebra::Multipliers;

use super::cutting::Cutting;
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Error, Report, Result};
use crate::entities::{Interaction, find_kind};
use crate::model::{
    EntityKind, EntityRole, ModelPart, MultiplierRequest, Named, Rates, SolverInfo, VariableEntry, named,
};
use crate::parameters::{Defaults, Node, Settings, Value};
use crate::registered_kind;
use crate::registry::{self, Kind, Registered};

use crate::strategies::{
    BodyBalance, BuilderAction, BuilderEntry, CentralDifferences, ConvergenceCriterion, CriterionEntry,
    CriterionRequest, ExplicitSettings, ExplicitStrategy, LineSearch, LinearSolverRequest, NewtonSettings, Scheme,
    SchemeEntry, SchemeFactory, SchemeRequest, SolutionStrategy, StrategyEntry, StrategyRequest, frugal_linear_solver,
    linear_tolerance, make_linear_solver, multipliers,
};

/// Most time levels of nodes.
const MOST_LEVELS: usize = 100;
/// Further variables with history.
const AUXILIARY: &str = "auxiliary_variables_list";
/// Objects of the settings that name strategy and builder.
const STRATEGY: &str = "solving_strategy_settings";
const BUILDER: &str = "builder_and_solver_settings";

/// A variable with history on the nodes: name and number of components.
pub type NodalVariable = (&'static str, usize);

registered_kind! {
    /// A `solver_type` that decks name.
    pub struct SolverEntry("solver", "unknown-solver") {
        build: SolverDefinition;
    }
}

registered_kind! {
    /// A nested settings object of the solver that an application understands.
    pub struct SolverExtensionEntry("solver_extension", "unknown-name") {
        build: ExtensionDefinition;
    }
}

/// Entry that an application registers for a `solver_type`.
pub struct SolverDefinition {
    /// Registered solver that these settings, as the user wrote them, ask for instead; `None` for this one.
    pub variant: fn(&Node) -> Option<&'static str>,
    /// Variables with history that every node gets.
    pub variables: &'static [NodalVariable],
    /// Whether steps are explicit: without iterations, with a lumped mass.
    pub explicit: bool,
    /// Whether one step far longer than the run stands for the steady state.
    pub long_step: bool,
    /// Registered name of the time scheme that these settings ask for.
    pub scheme: fn(&Settings) -> Result<String>,
    /// Names the deprecated spellings of settings.
    pub adapt: fn(Defaults) -> Defaults,
    /// Prepares the part as read, with its materials, for the solver.
    ///
    /// An error names the fault of mesh or settings.
    pub adopt: fn(&Settings, &mut ModelPart, &mut Report) -> Result<()>,
    /// Puts a deck of several solvers into the form of one with extensions.
    ///
    /// An error names the fault.
    pub unfold: fn(&mut Node) -> Result<()>,
}

impl SolverDefinition {
    /// Solvers of one object, on the part as read, by the scheme that `scheme_type` names; struct update fills the rest from it.
    pub const PLAIN: Self = Self {
        variant: |_| None,
        variables: &[],
        explicit: false,
        long_step: false,
        scheme: |settings| settings.get_str("scheme_type").map(str::to_owned),
        adapt: |defaults| defaults,
        adopt: |_, _, _| Ok(()),
        unfold: |_| Ok(()),
    };
}

/// Entry that an application registers for a nested object of `solver_settings`.
pub struct ExtensionDefinition {
    /// Further variables with history, for these settings of the nested object.
    ///
    /// An error names a setting that does not fit.
    pub variables: fn(&Settings) -> Result<Vec<NodalVariable>>,
    /// Marks of the model part that are set, for interactions to read.
    ///
    /// An error names a setting that does not fit.
    pub marks: fn(&Settings) -> Result<Vec<&'static str>>,
    /// Whether the condition number of every system is computed.
    ///
    /// An error names a setting that does not fit.
    pub condition_number: fn(&Settings) -> Result<bool>,
    /// Treatment of multipliers by iterative linear solvers.
    ///
    /// An error names a setting that does not fit.
    pub multipliers: fn(&Settings) -> Result<MultiplierRequest>,
    /// How steps that fail are cut, where the nested object says so.
    ///
    /// An error names a setting that does not fit.
    pub cutting: fn(&Settings) -> Result<Option<Cutting>>,
    /// Numbers of the model part's step data that are set, for strategies and interactions to read.
    ///
    /// An error names a setting that does not fit.
    pub values: fn(&Settings) -> Result<Vec<(&'static str, f64)>>,
    /// Changes the part as read, with its materials; the folder is that of the deck.
    ///
    /// An error names the fault of mesh or settings.
    pub adopt: fn(&Settings, &Path, &mut ModelPart, &mut Report) -> Result<()>,
    /// The strategy around that of the solver; that itself where nothing is to be added. The interactions are those of this extension
    /// ([`Interaction::extension`]).
    ///
    /// An error names a setting that does not fit.
    pub around: fn(
        &Settings,
        &mut ModelPart,
        Box<dyn SolutionStrategy>,
        Vec<Box<dyn Interaction>>,
        &mut Report,
    ) -> Result<Box<dyn SolutionStrategy>>,
    /// Whether its settings act without an interaction.
    pub acts_alone: bool,
}

impl ExtensionDefinition {
    /// One that adds nothing; struct update fills the rest from it.
    pub const NOTHING: Self = Self {
        variables: |_| Ok(Vec::new()),
        marks: |_| Ok(Vec::new()),
        condition_number: |_| Ok(false),
        multipliers: |_| Ok(MultiplierRequest::default()),
        cutting: |_| Ok(None),
        values: |_| Ok(Vec::new()),
        adopt: |_, _, _, _| Ok(()),
        around: |_, _, strategy, _, _| Ok(strategy),
        acts_alone: false,
    };
}

/// A time scheme of one of the two methods.
pub enum TimeScheme {
    /// Solved for by iteration.
    Implicit(Box<dyn Scheme>),
    /// From forces to motion directly.
    Explicit(CentralDifferences),
}

/// The checked settings of a stage's solver, with the objects that they name.
pub struct SolverSettings {
    /// All settings, nested objects of extensions included, defaults filled in.
    pub settings: Settings,
    /// As the user wrote them.
    pub user: Node,
    /// Whether those of the solver itself fit; else defaults stand in the places of those that do not.
    pub is_sound: bool,
    /// Whether all fit, also those of extensions.
    pub is_whole: bool,
    definition: &'static SolverDefinition,
    variables: Vec<NodalVariable>,
    marks: Vec<&'static str>,
    condition_number: bool,
    multipliers: MultiplierRequest,
    cutting: Option<Cutting>,
    values: Vec<(&'static str, f64)>,
    extensions: Vec<(&'static ExtensionDefinition, Settings)>,
}

impl SolverSettings {
    /// Checks `solver_settings`.
    ///
    /// Unsuitable settings go to `report`.
    ///
    /// # Errors
    /// No such solver, settings that are no object.
    pub fn new(user: &Node, report: &mut Report) -> Result<Self> {
        let entry = solver_entry(user)?;
        let definition = &entry.build;
        let mut own = user.clone();
        let mut extensions = Vec::new();
        let mut lenient = false;
        if let Value::Object(members) = &mut own.value {
            for extension in registry::all::<SolverExtensionEntry>() {
                if let Some(member) = members.remove(extension.name) {
                    extensions.push((extension, member));
                    lenient = true;
                }
            }
        }
        let mut defaults = (definition.adapt)(Defaults::parse(entry.name, entry.defaults)?);
        if lenient {
            defaults = defaults.lenient();
        }
        let mut is_whole = true;
        let mut problems = Report::new();
        let Some((settings, is_sound)) = Settings::complete(&own, &defaults, &mut problems) else {
            return Err(Error::Input(problems.diagnostics().to_vec()));
        };
        let mut variables = definition.variables.to_vec();
        let mut marks = Vec::new();
        let mut condition_number = false;
        let mut multipliers = MultiplierRequest::default();
        let mut cutting = None;
        let mut values = Vec::new();
        let mut present = Vec::new();
        let mut merged = settings.node().clone();
        for (extension, mut member) in extensions {
            let defaults = Defaults::parse(extension.name, extension.defaults)?;
            let Some(checked) = Settings::validate(&member.node, &defaults, &mut problems) else {
                is_whole = false;
                continue;
            };
            let factory = &extension.build;
            if let Some(more) = problems.absorb((factory.variables)(&checked)) {
                variables.extend(more);
            }
            if let Some(more) = problems.absorb((factory.marks)(&checked)) {
                marks.extend(more);
            }
            condition_number |= problems.absorb((factory.condition_number)(&checked)).unwrap_or_default();
            let more = problems.absorb((factory.multipliers)(&checked));
            multipliers = multipliers.and(more.unwrap_or_default());
            cutting = problems.absorb((factory.cutting)(&checked)).flatten().or(cutting);
            if let Some(more) = problems.absorb((factory.values)(&checked)) {
                values.extend(more);
            }
            if let Value::Object(members) = &mut merged.value {
                member.node = checked.node().clone();
                members.insert(member);
            }
            present.push((factory, checked));
        }
        is_whole &= !problems.has_errors();
        problems.diagnostics().iter().for_each(|problem| report.push(problem.clone()));
        Ok(Self {
            settings: Settings::unchecked(entry.name, merged),
            is_sound,
            is_whole,
            user: user.clone(),
            definition,
            variables,
            marks,
            condition_number,
            multipliers,
            cutting,
            values,
            extensions: present,
        })
    }

    /// Gives the nodes their variables with history, the buffer its length, and the part its marks.
    ///
    /// # Errors
    /// Unsuitable settings.
    pub fn prepare(&self, part: &mut ModelPart) -> Result<()> {
        part.info.domain_size = self.settings.get_usize("domain_size")?;
        let levels = self.settings.get_usize("buffer_size")?.max(2);
        if levels > MOST_LEVELS {
            let fact = format!("\"buffer_size\" is {levels}: every node would hold the values of so many steps");
            let problem = self.settings.error("buffer_size", "invalid-value", fact);
            return Err(problem.remedy(format!("write at most {MOST_LEVELS}; schemes take what they need")).into());
        }
        part.set_levels(levels);
        // Names that are not registered are reported where the strategy is made.
        let strategy = self.named::<StrategyEntry>(STRATEGY).ok();
        let condition_number =
            self.settings.node().get("condn_convergence_criterion").and_then(Node::as_bool) == Some(true);
        let earlier = part.info.solver;
        part.info.solver = SolverInfo {
            explicit: self.definition.explicit,
            linear: !self.definition.explicit
                && self.settings.node().get("analysis_type").and_then(Node::as_str) == Some("linear"),
            follower_loads: self.settings.node().get("follower_loads").and_then(Node::as_bool) == Some(true),
            incomplete: !self.is_whole,
            unknown_load_factor: earlier.unknown_load_factor
                || strategy.is_some_and(|strategy| strategy.unknown_load_factor),
            condition_number: earlier.condition_number || self.condition_number || condition_number,
            multipliers: earlier.multipliers.and(self.multipliers),
        };
        self.add_variables(part)?;
        for mark in &self.marks {
            part.info.marks.insert(mark, true);
        }
        for &(name, value) in &self.values {
            part.info.values.insert(name, value);
        }
        Ok(())
    }

    /// Lets the solver prepare the part for its computations.
    ///
    /// # Errors
    /// Faults of the mesh or the settings.
    pub fn adopt(&self, folder: &Path, part: &mut ModelPart, report: &mut Report) -> Result<()> {
        (self.definition.adopt)(&self.settings, part, report)?;
        self.extensions.iter().try_for_each(|(extension, own)| (extension.adopt)(own, folder, part, report))
    }

    /// Gives every node its variables with history, those of `auxiliary_variables_list` among them.
    ///
    /// # Errors
    /// A name of no variable.
    pub fn add_variables(&self, part: &mut ModelPart) -> Result<()> {
        for &(name, components) in &self.variables {
            part.nodes.history.add_named(name, components);
        }
        if self.settings.node().get(AUXILIARY).is_none() {
            return Ok(());
        }
        for name in self.settings.get_strings(AUXILIARY)? {
            let Some(variable @ Named::Whole(..)) = named(&name) else {
                let problem =
                    self.settings.error(AUXILIARY, "unknown-variable", format!("there is no variable {name:?}"));
                return Err(problem.remedy(Kind::of::<VariableEntry>().remedy(&name)).into());
            };
            let (column, _, components) = variable.column();
            part.nodes.history.add_named(column, components);
        }
        Ok(())
    }

    /// How steps that fail are cut.
    ///
    /// # Errors
    /// A `step_cutting` that is neither true nor false.
    pub fn cutting(&self) -> Result<Cutting> {
        let allowed = self.settings.node().get("step_cutting").map_or(Ok(true), Node::bool)?;
        let asked = self.cutting.unwrap_or_default();
        Ok(Cutting { times: if allowed { asked.times } else { 0 }, ..asked })
    }

    /// Whether one step far longer than the run stands for the steady state.
    pub fn takes_long_step(&self) -> bool {
        self.definition.long_step
    }

    /// Dimensions of the problem.
    ///
    /// # Errors
    /// Anything but 2 and 3.
    pub fn domain_size(&self) -> Result<usize> {
        match self.settings.get_i64("domain_size")? {
            2 => Ok(2),
            3 => Ok(3),
            other => Err(self
                .settings
                .error("domain_size", "domain-size", format!("\"domain_size\" is {other}"))
                .remedy("use 2 in the plane, 3 in space")
                .into()),
        }
    }

    /// The time scheme.
    ///
    /// # Errors
    /// A name that is not registered, or a scheme of the other time integration method.
    pub fn scheme(&self) -> Result<TimeScheme> {
        let name = (self.definition.scheme)(&self.settings)?;
        let entry =
            registry::require::<SchemeEntry>(&name).map_err(|d| d.at(self.settings.key_place("scheme_type")))?;
        let request = SchemeRequest { settings: &self.settings };
        if matches!(entry.build, SchemeFactory::Explicit(_)) != self.definition.explicit {
            let fact = format!("\"scheme_type\" {name:?} does not fit the \"time_integration_method\"");
            let remedy = "\"central_differences\" is explicit, all others are implicit";
            return Err(self.settings.error("scheme_type", "scheme-method", fact).remedy(remedy).into());
        }
        Ok(match entry.build {
            SchemeFactory::Explicit(make) => TimeScheme::Explicit(make(&request)?),
            SchemeFactory::Implicit(make) => TimeScheme::Implicit(make(&request)?),
        })
    }

    /// The convergence criterion.
    ///
    /// # Errors
    /// A name that is not registered.
    pub fn criterion(&self, report: &mut Report) -> Result<Box<dyn ConvergenceCriterion>> {
        let place = self.settings.key_place("convergence_criterion");
        let given = self.settings.get_str("convergence_criterion")?;
        let mut name = given.to_lowercase();
        if registry::find::<CriterionEntry>(given).is_some() {
            given.clone_into(&mut name);
        } else if registry::find::<CriterionEntry>(&name).is_some() {
            let fact = format!("the convergence criterion {given:?} is now {name:?}");
            let warning = Diagnostic::warning("old-deck", fact).at(place.clone());
            report.push(warning.remedy(format!("write \"{name}\"")));
        }
        let entry = registry::require::<CriterionEntry>(&name).map_err(|d| d.at(place))?;
        (entry.build)(&mut CriterionRequest { settings: &self.settings, user: &self.user, report })
    }

    /// The strategy over a part whose blocks and interactions are ready, and a sentence on its linear solver.
    ///
    /// # Errors
    /// Names that are not registered.
    pub fn strategy(
        &self,
        part: &mut ModelPart,
        system: &mut System,
        report: &mut Report,
    ) -> Result<(Box<dyn SolutionStrategy>, String)> {
        let theirs: Vec<Vec<_>> = self
            .extensions
            .iter()
            .map(|(_, settings)| {
                let is_theirs = |own: &mut Box<dyn Interaction>| own.extension() == Some(settings.name());
                system.interactions.extract_if(.., is_theirs).collect()
            })
            .collect();
        let (mut strategy, says) = self.own_strategy(part, system, report)?;
        for ((extension, own), theirs) in self.extensions.iter().zip(theirs) {
            strategy = (extension.around)(own, part, strategy, theirs, report)?;
        }
        Ok((strategy, says))
    }

    /// The rule for bodies out of balance; solvers without the setting leave it to the criterion.
    fn body_balance(&self) -> Result<BodyBalance> {
        Ok(match self.settings.node().get("check_body_balance").map(Node::bool).transpose()? {
            Some(true) => BodyBalance::Required,
            Some(false) => BodyBalance::Told,
            None => BodyBalance::Unchecked,
        })
    }

    /// The strategy without wrappers of extensions.
    fn own_strategy(
        &self,
        part: &mut ModelPart,
        system: &mut System,
        report: &mut Report,
    ) -> Result<(Box<dyn SolutionStrategy>, String)> {
        let scheme = match self.scheme()? {
            TimeScheme::Explicit(scheme) => {
                let strategy = ExplicitStrategy::new(ExplicitSettings::new(&self.settings)?, scheme, part, system)?;
                return Ok((Box::new(strategy), "explicit: no linear solver".to_owned()));
            }
            TimeScheme::Implicit(scheme) => scheme,
        };
        self.check_names()?;
        let named = self.settings.sub("linear_solver_settings")?;
        let max_iteration = self.settings.get_usize("max_iteration")?;
        let linear = self.settings.get_str("analysis_type")? == "linear";
        let residual = if linear { 0.0 } else { self.settings.get_f64("residual_relative_tolerance")? };
        let request = LinearSolverRequest {
            settings: &named,
            multipliers: multipliers(&part.info),
            tolerance: linear_tolerance(residual),
        };
        let (solver, mut says) = make_linear_solver(&request)?;
        let strategy = self.named::<StrategyEntry>(STRATEGY)?;
        let builder = self.named::<BuilderEntry>(BUILDER)?;
        let (solver, replaceable) = match builder.build {
            BuilderAction::Direct => (solver, true),
            BuilderAction::Around(make) => (make(&self.settings, solver)?, false),
        };
        let is_on = |key: &str| self.settings.node().get(key).map_or(Ok(false), Node::bool);
        let search_after_failure = is_on("line_search_after_failure")?;
        let empty = Node::from_json(&serde_json::json!({}), &self.settings.place())?;
        let iteration = NewtonSettings {
            max_iteration,
            continue_if_converging: self.settings.get_bool("continue_if_converging")?,
            linear,
            compute_reactions: self.settings.get_bool("compute_reactions")?,
            reactions_of_constraints: self.settings.get_bool("reactions_of_constraints")?,
            move_mesh: self.settings.get_bool("move_mesh_flag")?,
            body_balance: self.body_balance()?,
            line_search: None,
            contact_stabilization: is_on("contact_stabilization")?,
            elastic_start_after_failure: is_on("elastic_start_after_failure")?,
            line_search_after_failure: search_after_failure.then(|| LineSearch::new(&empty)).transpose()?,
        };
        if !scheme.takes_first_order()
            && let Some(column) = part.ranks.first_to_say(first_order(system))
        {
            let fact = format!("{column} has no second derivative by time, which the scheme integrates");
            let remedy = "use a scheme for rates of the first order: \"bdf1\" to \"bdf5\", \"pseudo_static\"";
            return Err(self.settings.error("scheme_type", "first-order", fact).remedy(remedy).into());
        }
        scheme.prepare(part);
        let criterion = self.criterion(report)?;
        let made = (strategy.build)(StrategyRequest {
            settings: &self.settings,
            advanced: self.settings.node().get_path(&format!("{STRATEGY}.advanced_settings")).unwrap_or(&empty),
            iteration,
            scheme_name: &(self.definition.scheme)(&self.settings)?,
            scheme,
            criterion,
            solver,
            frugal: if replaceable { Some(frugal_linear_solver(&request)?) } else { None },
            report,
            part,
            system,
            replaceable,
            says: &mut says,
        })?;
        Ok((made, says))
    }

    /// Checks that builder and objects of the iterations exist.
    ///
    /// # Errors
    /// Names that are not registered, a number of iterations that is none, gathered.
    pub fn check_names(&self) -> Result<()> {
        let mut problems = Report::new();
        problems.absorb(self.named::<BuilderEntry>(BUILDER));
        if self.definition.explicit {
            return problems.finish().map(|_| ());
        }
        let analysis = self.settings.get_str("analysis_type")?;
        if !matches!(analysis, "linear" | "non_linear") {
            let fact = format!("\"analysis_type\" is \"{analysis}\"");
            let problem = self.settings.error("analysis_type", "analysis-type", fact);
            problems.push(problem.remedy("use \"linear\" or \"non_linear\""));
        }
        if self.settings.get_usize("max_iteration")? == 0 {
            let fact = "\"max_iteration\" is 0: no step could be solved";
            problems.push(self.settings.error("max_iteration", "invalid-value", fact).remedy("write at least 1"));
        }
        let named = self.settings.sub("linear_solver_settings")?;
        let request = LinearSolverRequest {
            settings: &named,
            multipliers: Multipliers::default(),
            tolerance: linear_tolerance(0.0),
        };
        problems.absorb(make_linear_solver(&request));
        problems.absorb(self.named::<StrategyEntry>(STRATEGY));
        problems.finish().map(|_| ())
    }

    /// Entry named by the `type` of an object of the settings; without one, `newton_raphson` or `block`.
    fn named<R: Registered>(&self, key: &str) -> Result<&'static R> {
        let path = format!("{key}.type");
        let name = self.settings.node().get_path(&path).map_or(Ok(""), Node::str)?;
        let usual = if key == STRATEGY { "newton_raphson" } else { "block" };
        let name = if name.is_empty() { usual } else { name };
        Ok(registry::require::<R>(name).map_err(|d| d.at(self.settings.key_place(&path)))?)
    }
}

/// The registered solver that `solver_settings` ask for.
///
/// # Errors
/// No `solver_type`, or one that is not registered.
pub(super) fn solver_entry(user: &Node) -> Result<&'static SolverEntry> {
    let solver_type = user.require("solver_type")?;
    let entry = registry::require::<SolverEntry>(solver_type.str()?).map_err(|d| d.at(solver_type.place()))?;
    match (entry.build.variant)(user) {
        Some(name) => Ok(registry::require(name)?),
        None => Ok(entry),
    }
}

/// Whether the solver that a deck names moves bodies against inertia, by iteration.
pub(super) fn has_inertia(deck: &Node) -> bool {
    let Some(settings) = deck.get("solver_settings") else { return false };
    solver_entry(settings).is_ok_and(|entry| {
        let moves = |name: &str| Rates::all().any(|rates| rates.second == Some(name));
        !entry.build.explicit && entry.build.variables.iter().any(|(name, _)| moves(name))
    })
}

/// An unknown of blocks of this rank that changes by its first derivative alone.
fn first_order(system: &System) -> Option<String> {
    let unknowns = system.elements.iter().chain(&system.conditions).flat_map(|block| block.unknowns());
    let mut columns = unknowns.map(|unknown| unknown.variable.column);
    columns.find(|column| Rates::of(column).is_some_and(|rates| rates.second.is_none())).map(str::to_owned)
}

/// Replaces points and bars of space by those of the plane in a plane problem, where they are the same.
pub fn flatten_bars(part: &mut ModelPart, domain_size: usize, report: &mut Report) {
    if domain_size != 2 {
        return;
    }
    for table in [&mut part.elements, &mut part.conditions] {
        for at in 0..table.len() {
            let entry = table.kinds[at];
            let dim = entry.cell.map_or(3, |cell| cell.cell().dim);
            let is_same = entry.space == 3 && (dim == 0 || dim == 1 && entry.role == EntityRole::Element);
            let Some(flat) = is_same.then(|| entry.name.replacen("3D", "2D", 1)) else { continue };
            let Some(flat) = find_kind(entry.role, &flat) else { continue };
            table.kinds[at] = flat;
            let fact = format!("{} in a plane problem is taken as {}", entry.name, flat.name);
            report.push(Diagnostic::warning("wrong-dimension", fact).remedy(format!("write {}", flat.name)));
        }
    }
}

/// An element or condition kind of the wrong dimension for the problem.
///
/// # Errors
/// Input error naming the first such entity of each kind.
pub fn check_dimensions(part: &ModelPart, domain_size: usize) -> Result<()> {
    let mut report = Report::new();
    for table in [&part.elements, &part.conditions] {
        let mut last: Option<&EntityKind> = None;
        for (at, entry) in table.kinds.iter().enumerate() {
            if last == Some(entry) {
                continue;
            }
            last = Some(entry);
            if entry.space != 0 && entry.space != domain_size {
                let fact = format!(
                    "{} {} is {}-dimensional, but \"domain_size\" is {domain_size}",
                    entry.name, table.ids[at], entry.space
                );
                report.push(
                    Diagnostic::error("wrong-dimension", fact)
                        .remedy("use the kind for this dimension, or correct \"domain_size\""),
                );
            }
        }
    }
    report.finish().map(|_| ())
}
