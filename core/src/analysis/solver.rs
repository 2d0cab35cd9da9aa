//! The solver of a stage: what `solver_settings` asks for, made from registered pieces.

use super::cutting::Cutting;
use super::linear_solvers::{self, EngineRequest};
use crate::assembly::System;
use crate::communication::world;
use crate::diagnostics::{Diagnostic, Report, Result};
use crate::model::ModelPart;
use crate::model::variables::ACCELERATION;
use crate::parameters::{Defaults, Node, Settings, Value};
use crate::registry::{self, Build, Entry, Kind};
use crate::strategies::{
    ArcLength, ArcLengthSettings, CONDITION_NUMBER, CentralDifferences, ConvergenceCriterion, CriterionFactory,
    CriterionRequest, ExplicitSchemeFactory, ExplicitSettings, ExplicitStrategy, LineSearch, NewtonRaphson,
    NewtonSettings, Scheme, SchemeFactory, SchemeRequest, SolutionStrategy, multipliers,
};

/// A variable with history on the nodes: name and number of components.
pub type NodalVariable = (&'static str, usize);

/// Mark of the step data: steps are explicit.
pub const EXPLICIT: &str = "EXPLICIT";

/// Mark of the step data: the load factor is an unknown.
pub const ARC_LENGTH: &str = "ARC_LENGTH";

/// What an application registers for a `solver_type`, as `Build::Factory(&SolverDefinition {…})`.
pub struct SolverDefinition {
    /// Registered solver that these settings, as the user wrote them, ask for instead; `None` for this one.
    pub variant: fn(&Node) -> Option<&'static str>,
    /// Variables with history that every node gets.
    pub variables: &'static [NodalVariable],
    /// Whether steps are explicit: without iterations, with a lumped mass.
    pub explicit: bool,
    /// Registered name of the time scheme that these settings ask for.
    pub scheme: fn(&Settings) -> Result<String>,
    /// Names the deprecated spellings of settings.
    pub adapt: fn(Defaults) -> Defaults,
}

/// What an application registers for a nested object of `solver_settings`, as `Build::Factory(&ExtensionDefinition {…})`.
pub struct ExtensionDefinition {
    /// Further variables with history, for these settings of the nested object.
    ///
    /// An error names a setting that does not fit.
    pub variables: fn(&Settings) -> Result<Vec<NodalVariable>>,
    /// Marks of the model part that are set, for interactions to read.
    ///
    /// An error names a setting that does not fit.
    pub marks: fn(&Settings) -> Result<Vec<&'static str>>,
    /// How steps that fail are cut, where the nested object says so.
    ///
    /// An error names a setting that does not fit.
    pub cutting: fn(&Settings) -> Result<Option<Cutting>>,
    /// Numbers of the model part's step data that are set, for strategies and interactions to read.
    ///
    /// An error names a setting that does not fit.
    pub values: fn(&Settings) -> Result<Vec<(&'static str, f64)>>,
}

/// A time scheme of one of the two methods.
pub enum TimeScheme {
    /// Solved for by iteration.
    Implicit(Box<dyn Scheme>),
    /// From forces to motion directly.
    Explicit(CentralDifferences),
}

/// The settings of a stage's solver, checked, with what they ask for.
pub struct SolverSettings {
    /// All settings, nested objects of extensions included, defaults filled in.
    pub settings: Settings,
    /// As the user wrote them.
    pub user: Node,
    definition: &'static SolverDefinition,
    variables: Vec<NodalVariable>,
    marks: Vec<&'static str>,
    cutting: Option<Cutting>,
    values: Vec<(&'static str, f64)>,
}

impl SolverSettings {
    /// Checks `solver_settings`.
    ///
    /// # Errors
    /// Everything that does not fit, gathered.
    pub fn new(user: &Node, report: &mut Report) -> Result<Self> {
        let entry = solver_entry(user)?;
        let definition = definition_of(entry);
        let mut own = user.clone();
        let mut extensions = Vec::new();
        let mut lenient = false;
        if let Value::Object(members) = &mut own.value {
            let known: Vec<&'static Entry> =
                registry::entries().into_iter().filter(|e| e.kind == Kind::SolverExtension).collect();
            for extension in known {
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
        let mut problems = Report::new();
        let settings = Settings::validate(&own, &defaults, &mut problems);
        let mut variables = definition.variables.to_vec();
        let mut marks = Vec::new();
        let mut cutting = None;
        let mut values = Vec::new();
        let mut merged = settings.as_ref().map(|s| s.node().clone());
        for (extension, mut member) in extensions {
            let defaults = Defaults::parse(extension.name, extension.defaults)?;
            let Some(checked) = Settings::validate(&member.node, &defaults, &mut problems) else { continue };
            let Build::Factory(factory) = extension.build else { unreachable!("extensions register a factory") };
            let factory = factory.downcast_ref::<ExtensionDefinition>().expect("an ExtensionDefinition");
            if let Some(more) = problems.absorb((factory.variables)(&checked)) {
                variables.extend(more);
            }
            if let Some(more) = problems.absorb((factory.marks)(&checked)) {
                marks.extend(more);
            }
            cutting = problems.absorb((factory.cutting)(&checked)).flatten().or(cutting);
            if let Some(more) = problems.absorb((factory.values)(&checked)) {
                values.extend(more);
            }
            if let Some(Node { value: Value::Object(members), .. }) = &mut merged {
                member.node = checked.node().clone();
                members.insert(member);
            }
        }
        for warning in problems.finish()? {
            report.push(warning);
        }
        let node = merged.unwrap_or_else(|| user.clone());
        Ok(Self {
            settings: Settings::unchecked(entry.name, node),
            user: user.clone(),
            definition,
            variables,
            marks,
            cutting,
            values,
        })
    }

    /// Gives the nodes their variables with history, the buffer its length, and the part its marks.
    ///
    /// # Errors
    /// Settings that are not what they should be.
    pub fn prepare(&self, part: &mut ModelPart) -> Result<()> {
        part.info.domain_size = self.settings.get_usize("domain_size")?;
        let levels = self.settings.get_usize("buffer_size")?.max(2);
        part.nodes.history.set_levels(levels);
        part.info.marks.insert(EXPLICIT, self.definition.explicit);
        let follows_path = self.way_of_solution().is_ok_and(|(way, _)| way == "arc_length");
        part.info.marks.insert(ARC_LENGTH, follows_path);
        for &(name, components) in &self.variables {
            part.nodes.history.add_named(name, components);
        }
        for mark in &self.marks {
            part.info.marks.insert(mark, true);
        }
        if self.settings.node().get("condn_convergence_criterion").and_then(Node::as_bool) == Some(true) {
            part.info.marks.insert(CONDITION_NUMBER, true);
        }
        for &(name, value) in &self.values {
            part.info.values.insert(name, value);
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
        let entry = registry::require(Kind::Scheme, &name).map_err(|d| d.at(self.settings.key_place("scheme_type")))?;
        let Build::Factory(factory) = entry.build else { unreachable!("schemes register a factory") };
        let request = SchemeRequest { settings: &self.settings };
        let explicit = factory.downcast_ref::<ExplicitSchemeFactory>();
        if explicit.is_some() != self.definition.explicit {
            let fact = format!("\"scheme_type\" {name:?} does not fit the \"time_integration_method\"");
            let remedy = "\"central_differences\" is explicit, all others are implicit";
            return Err(self.settings.error("scheme_type", "scheme-method", fact).remedy(remedy).into());
        }
        Ok(match explicit {
            Some(make) => TimeScheme::Explicit(make(&request)?),
            None => TimeScheme::Implicit(factory.downcast_ref::<SchemeFactory>().expect("a SchemeFactory")(&request)?),
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
        if registry::find(Kind::ConvergenceCriterion, given).is_some() {
            given.clone_into(&mut name);
        } else if registry::find(Kind::ConvergenceCriterion, &name).is_some() {
            let fact = format!("the convergence criterion {given:?} is now {name:?}");
            let warning = Diagnostic::warning("old-deck", fact).at(place.clone());
            report.push(warning.remedy(format!("write \"{name}\"")));
        }
        let entry = registry::require(Kind::ConvergenceCriterion, &name).map_err(|d| d.at(place))?;
        let Build::Factory(factory) = entry.build else { unreachable!("criteria register a factory") };
        let make = factory.downcast_ref::<CriterionFactory>().expect("a CriterionFactory");
        make(&mut CriterionRequest { settings: &self.settings, user: &self.user, report })
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
        let scheme = match self.scheme()? {
            TimeScheme::Explicit(scheme) => {
                let strategy = ExplicitStrategy::new(ExplicitSettings::new(&self.settings)?, scheme, part, system)?;
                return Ok((Box::new(strategy), "explicit: no linear solver".to_owned()));
            }
            TimeScheme::Implicit(scheme) => scheme,
        };
        let named = self.settings.sub("linear_solver_settings")?;
        let analysis = self.settings.get_str("analysis_type")?;
        if !matches!(analysis, "linear" | "non_linear") {
            let fact = format!("\"analysis_type\" is \"{analysis}\"");
            return Err(self
                .settings
                .error("analysis_type", "analysis-type", fact)
                .remedy("use \"linear\" or \"non_linear\"")
                .into());
        }
        let max_iteration = self.settings.get_usize("max_iteration")?;
        if max_iteration == 0 {
            let fact = "\"max_iteration\" is 0: no step could be solved";
            return Err(self.settings.error("max_iteration", "invalid-value", fact).remedy("write at least 1").into());
        }
        let linear = analysis == "linear";
        let residual = if linear { 0.0 } else { self.settings.get_f64("residual_relative_tolerance")? };
        let (solver, says) = linear_solvers::make(&EngineRequest {
            settings: &named,
            multipliers: multipliers(&part.info),
            tolerance: linear_solvers::tolerance(residual),
        })?;
        let (way, advanced) = self.way_of_solution()?;
        let searched = way == "line_search" && !linear;
        let settings = NewtonSettings {
            max_iteration,
            continue_if_converging: self.settings.get_bool("continue_if_converging")?,
            linear,
            compute_reactions: self.settings.get_bool("compute_reactions")?,
            reactions_of_constraints: self.settings.get_bool("reactions_of_constraints")?,
            move_mesh: self.settings.get_bool("move_mesh_flag")?,
            line_search: if searched { Some(LineSearch::new(&advanced)?) } else { None },
        };
        let arc = if way == "arc_length" && !linear { Some(ArcLengthSettings::new(&advanced)?) } else { None };
        if arc.is_some() && (self.definition.scheme)(&self.settings)? != "static" {
            let fact = "\"arc_length\" follows states of equilibrium, the solver is dynamic";
            let place = "solving_strategy_settings.type";
            return Err(self
                .settings
                .error(place, "arc-length", fact)
                .remedy("use \"solver_type\": \"Static\"")
                .into());
        }
        scheme.prepare(part);
        let criterion = self.criterion(report)?;
        let mut newton = NewtonRaphson::new(settings, scheme, criterion, solver, part, system);
        newton.solver_named_at(named.key_place("solver_type"));
        #[cfg(feature = "petsc")]
        let mut says = says;
        #[cfg(feature = "petsc")]
        let has_multipliers = system.dofs.dofs().iter().any(|dof| dof.multiplier);
        #[cfg(feature = "petsc")]
        if part.share.is_some()
            && let Some((petsc, by_petsc)) =
                linear_solvers::petsc(&named, unknowns_of_all(part, system), has_multipliers)?
        {
            newton.solve_by_petsc(petsc, multipliers(&part.info));
            says = by_petsc;
        }
        Ok(match arc {
            Some(arc) => (Box::new(ArcLength::new(arc, newton)), says),
            None => (Box::new(newton), says),
        })
    }

    /// The registered strategy with its settings; checks the name of the builder too.
    fn way_of_solution(&self) -> Result<(String, Node)> {
        let mut found = Vec::new();
        for (kind, key, usual) in [
            (Kind::Strategy, "solving_strategy_settings", "newton_raphson"),
            (Kind::BuilderAndSolver, "builder_and_solver_settings", "block"),
        ] {
            let path = format!("{key}.type");
            let name = self.settings.node().get_path(&path).map_or(Ok(usual), Node::str)?;
            let name = if name.is_empty() { usual } else { name };
            let entry = registry::require(kind, name).map_err(|d| d.at(self.settings.key_place(&path)))?;
            let empty = Node::from_json(&serde_json::json!({}), &self.settings.place())?;
            let advanced = self.settings.node().get_path(&format!("{key}.advanced_settings")).cloned();
            found.push((entry.name.to_owned(), advanced.unwrap_or(empty)));
        }
        Ok(found.swap_remove(0))
    }
}

/// The registered solver that `solver_settings` ask for.
///
/// # Errors
/// No `solver_type`, or one that is not registered.
pub(super) fn solver_entry(user: &Node) -> Result<&'static Entry> {
    let solver_type = user.require("solver_type")?;
    let entry = registry::require(Kind::Solver, solver_type.str()?).map_err(|d| d.at(solver_type.place()))?;
    match (definition_of(entry).variant)(user) {
        Some(name) => Ok(registry::require(Kind::Solver, name)?),
        None => Ok(entry),
    }
}

fn definition_of(entry: &'static Entry) -> &'static SolverDefinition {
    let Build::Factory(definition) = entry.build else { unreachable!("solvers register a factory") };
    definition.downcast_ref::<SolverDefinition>().expect("solvers register a SolverDefinition")
}

/// Whether the solver that a deck names moves bodies against inertia, by iteration.
pub(super) fn has_inertia(deck: &Node) -> bool {
    let Some(settings) = deck.get("solver_settings") else { return false };
    solver_entry(settings).is_ok_and(|entry| {
        let definition = definition_of(entry);
        !definition.explicit && definition.variables.iter().any(|(name, _)| *name == ACCELERATION.name())
    })
}

/// Unknowns of all ranks; collective.
pub(super) fn unknowns_of_all(part: &ModelPart, system: &System) -> usize {
    let own = system.dofs.dofs().iter().filter(|dof| part.owns_node(dof.node as usize)).count();
    if part.share.is_some() { world().total(own as f64) as usize } else { own }
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
            let is_same = entry.space == 3 && (dim == 0 || dim == 1 && entry.kind == Kind::Element);
            let Some(flat) = is_same.then(|| entry.name.replacen("3D", "2D", 1)) else { continue };
            let Some(flat) = registry::find(entry.kind, &flat) else { continue };
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
        let mut last: Option<&Entry> = None;
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
