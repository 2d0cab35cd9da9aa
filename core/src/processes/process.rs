//! The trait of processes, and the request from which one is made.

use std::path::{Path, PathBuf};

use zelus_linear_algebra::State;

use super::prescription::{DirectionalPrescription, Load, Prescription};
use super::time_table::TimeTable;
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Report, Result};
use crate::entities::Interaction;
use crate::io::FileUse;
use crate::model::{Model, ModelPart};
use crate::parameters::{Defaults, Node, Settings};
use crate::registered_kind;
use crate::registry::Entry;

/// Something done at fixed points of the stage loop, in the order in which the deck lists it.
///
/// Points in time: [`initialize`](Process::initialize), [`check`](Process::check),
/// [`before_loop`](Process::before_loop); then each step
/// [`begin_step`](Process::begin_step) – solve – [`end_step`](Process::end_step) – output; at last
/// [`finalize`](Process::finalize). A step that is cut and retried calls `begin_step` again for each part of it.
///
/// ```
/// use std::path::Path;
/// use zelus_core::diagnostics::{Report, Result};
/// use zelus_core::model::{Model, ModelPart};
/// use zelus_core::parameters::Document;
/// use zelus_core::processes::{Process, ProcessEntry, ProcessRequest};
/// use zelus_core::{register, registry};
///
/// /// WIND of the model: a rate times the time.
/// struct Wind(f64);
///
/// impl Process for Wind {
///     fn begin_step(&mut self, model: &mut Model) -> Result<()> {
///         let info = &mut model.root_mut("Structure")?.info;
///         info.values.insert("WIND", self.0 * info.time);
///         Ok(())
///     }
/// }
/// register! { ProcessEntry "wind_process",
///     about: "WIND: a rate times the time",
///     defaults: r#"{ "rate": 1.0 }"#,
///     build: |request| Ok(Box::new(Wind(request.settings()?.get_f64("rate")?))),
/// }
/// # let mut model = Model::default();
/// # model.add(ModelPart::new("Structure"));
/// # let (entry, folder) = (registry::require::<ProcessEntry>("wind_process")?, Path::new("."));
/// # let parameters = Document::from_str(r#"{ "rate": 3.0 }"#, "deck.json")?.root;
/// # let report = &mut Report::new();
/// # let mut request = ProcessRequest { entry, parameters: &parameters, model: &mut model, folder, results: folder, report };
/// # let mut process = (entry.build)(&mut request)?;
/// // A deck that names "wind_process" with "rate" 3:
/// model.root_mut("Structure")?.info.time = 2.0;
/// process.begin_step(&mut model)?;
/// assert_eq!(model.root("Structure")?.info.value_or("WIND", 0.0), 6.0);
/// # Ok::<(), zelus_core::Error>(())
/// ```
pub trait Process: Send {
    /// Mesh and materials are read, the solver is not ready yet (Kratos: `ExecuteInitialize`).
    ///
    /// # Errors
    /// Whatever the deck asks for that the model cannot give.
    fn initialize(&mut self, _model: &mut Model) -> Result<()> {
        Ok(())
    }

    /// Interaction between bodies that the process makes, and its part: asked once, after [`Process::initialize`].
    ///
    /// # Errors
    /// As [`Process::initialize`].
    fn interaction(&mut self, _model: &mut Model) -> Result<Option<(String, Box<dyn Interaction>)>> {
        Ok(None)
    }

    /// All unknowns are known, nothing has run and nothing is written; `zelus check` ends here.
    ///
    /// # Errors
    /// As [`Process::initialize`].
    fn check(&self, _model: &Model, _system: &System, _warnings: &mut Report) -> Result<()> {
        Ok(())
    }

    /// Unknowns of a root part that it fixes at a time, with their values, as far as that is known before the run.
    fn prescribes(&self, _part: &ModelPart, _time: f64) -> Vec<Prescription> {
        Vec::new()
    }

    /// Directions, other than axes, along which it prescribes the nodes of a root part at a time, with their values.
    fn prescribes_along(&self, _part: &ModelPart, _time: f64) -> Option<DirectionalPrescription> {
        None
    }

    /// Whether it may load or move that root part at any time.
    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        true
    }

    /// Loads that it gives to a root part; each replaces that of an earlier process there.
    fn loads(&self, _part: &ModelPart) -> Vec<Load> {
        Vec::new()
    }

    /// All is ready, time is still zero (Kratos: `ExecuteBeforeSolutionLoop`).
    ///
    /// # Errors
    /// As [`Process::initialize`].
    fn before_loop(&mut self, _model: &mut Model) -> Result<()> {
        Ok(())
    }

    /// Takes the state at the start, once every process is ready, to be written once a step is done; not of a restarted run.
    ///
    /// # Errors
    /// A file that cannot be written.
    fn print_start(&mut self, _model: &mut Model, _system: &System) -> Result<()> {
        Ok(())
    }

    /// Time has advanced, nothing is solved (Kratos: `ExecuteInitializeSolutionStep`): boundary conditions and loads.
    ///
    /// # Errors
    /// As [`Process::initialize`].
    fn begin_step(&mut self, _model: &mut Model) -> Result<()> {
        Ok(())
    }

    /// All processes have prescribed the values of the step: constraints that depend on them.
    ///
    /// # Errors
    /// As [`Process::initialize`].
    fn constrain(&mut self, _model: &mut Model) -> Result<()> {
        Ok(())
    }

    /// The step is solved and accepted (Kratos: `ExecuteFinalizeSolutionStep`).
    ///
    /// # Errors
    /// As [`Process::initialize`]; a check of results that fails.
    fn end_step(&mut self, _model: &mut Model, _system: &System) -> Result<()> {
        Ok(())
    }

    /// Numbers of the accepted step by name, the same on every rank, for its report; asked once a step, after every
    /// [`Process::end_step`].
    fn summary(&self) -> Vec<(&'static str, f64)> {
        Vec::new()
    }

    /// Whether it writes output after this step; asked once a step, after every [`Process::end_step`].
    fn is_output_step(&mut self, _model: &Model) -> bool {
        false
    }

    /// Some process writes output now (Kratos: `ExecuteBeforeOutputStep`).
    ///
    /// # Errors
    /// As [`Process::initialize`].
    fn before_output(&mut self, _model: &mut Model, _system: &System) -> Result<()> {
        Ok(())
    }

    /// Writes output; returns the path of the file to open, to be named at the end of the run.
    ///
    /// # Errors
    /// A file that cannot be written.
    fn print_output(&mut self, _model: &mut Model, _system: &System) -> Result<()> {
        Ok(())
    }

    /// Output is written (Kratos: `ExecuteAfterOutputStep`).
    ///
    /// # Errors
    /// As [`Process::initialize`].
    fn after_output(&mut self, _model: &mut Model, _system: &System) -> Result<()> {
        Ok(())
    }

    /// Writes the state of a step that has failed, apart from results; gives where. On several ranks it is collective.
    ///
    /// # Errors
    /// A file that cannot be written.
    fn print_last_iterate(&mut self, _model: &mut Model, _system: &System) -> Result<Option<PathBuf>> {
        Ok(None)
    }

    /// Where the whole run is to be saved now; asked after each step of the deck, and remembered by its state as done.
    fn saves(&mut self, _model: &Model) -> Option<PathBuf> {
        None
    }

    /// Whether it is there to save the run now and then.
    fn saves_runs(&self) -> bool {
        false
    }

    /// State between steps, for the file of a saved run.
    fn state(&self) -> Option<Box<dyn State>> {
        None
    }

    /// Restores a saved state in place of [`Process::before_loop`]; files that grow are cut to their length at the time of saving.
    ///
    /// # Errors
    /// The state of another kind of process; a file that is no longer there.
    fn resume(&mut self, _model: &mut Model, _state: Box<dyn State>) -> Result<()> {
        Ok(())
    }

    /// Tables over time that it reads from files of its own.
    fn time_tables(&self) -> Vec<TimeTable> {
        Vec::new()
    }

    /// After the last step, also when a step failed (Kratos: `ExecuteFinalize`).
    ///
    /// # Errors
    /// A file that cannot be written.
    fn finalize(&mut self, _model: &mut Model) -> Result<()> {
        Ok(())
    }

    /// The run ends here and is restarted later from its saved state, which this must not change.
    ///
    /// # Errors
    /// As [`Process::finalize`].
    fn suspend(&mut self, model: &mut Model) -> Result<()> {
        self.finalize(model)
    }

    /// Notes and warnings since they were last asked for; the stage passes them on.
    fn messages(&mut self) -> Vec<Diagnostic> {
        Vec::new()
    }

    /// Warnings at the end of the run, e.g. of an output without numbers.
    fn last_messages(&self, _model: &Model) -> Vec<Diagnostic> {
        Vec::new()
    }

    /// Files that it reads and writes: no output may be an input or another output, and no other run may write it meanwhile.
    fn files(&self) -> Vec<FileUse> {
        Vec::new()
    }

    /// Files that it reads and whose content decides results.
    fn decisive_files(&self) -> Vec<std::path::PathBuf> {
        Vec::new()
    }

    /// Files or folders a user would open, for the last lines of the program.
    fn outputs(&self) -> Vec<std::path::PathBuf> {
        Vec::new()
    }
}

/// Arguments from which a process is made.
pub struct ProcessRequest<'a> {
    /// Its registered entry.
    pub entry: &'static Entry,
    /// The `Parameters` object of the deck.
    pub parameters: &'a Node,
    /// The model as read: parts can be looked up, nothing has run.
    pub model: &'a mut Model,
    /// Folder of the deck; relative names of files that are read start there.
    pub folder: &'a Path,
    /// Where relative names of files that are written start: the folder of the deck unless the caller names another.
    pub results: &'a Path,
    /// Takes warnings.
    pub report: &'a mut Report,
}

impl ProcessRequest<'_> {
    /// The parameters checked against the entry's defaults.
    ///
    /// # Errors
    /// Every key or type that does not fit.
    pub fn settings(&mut self) -> Result<Settings> {
        self.settings_with(|defaults| defaults)
    }

    /// As [`ProcessRequest::settings`], after `adapt` has named deprecated spellings.
    ///
    /// # Errors
    /// As [`ProcessRequest::settings`].
    pub fn settings_with(&mut self, adapt: impl FnOnce(Defaults) -> Defaults) -> Result<Settings> {
        let defaults = adapt(Defaults::parse(self.entry.name, self.entry.defaults)?);
        let (settings, warnings) = Settings::check(self.parameters, &defaults)?;
        warnings.into_iter().for_each(|warning| self.report.push(warning));
        Ok(settings)
    }
}

/// Makes a process.
pub type ProcessFactory = fn(&mut ProcessRequest<'_>) -> Result<Box<dyn Process>>;

/// Surfaces of one pair by the names of their parts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NamedSurface {
    /// Everything outside.
    WholeSkin,
    /// The parts of both sides, and those where pairs are evaluated; none of the latter when that is not known.
    Parts {
        /// Both sides.
        both: Vec<String>,
        /// The side where pairs are evaluated.
        slaves: Vec<String>,
    },
}

registered_kind! {
    /// A process that decks name.
    pub struct ProcessEntry("process", "unknown-process") {
        build: ProcessFactory;
        /// Changes that it makes to the mesh as read, before ranks share it and before any process is made. Faults of the settings
        /// are left to `build`.
        prepares: fn(&mut ProcessRequest<'_>) -> Result<()> = |_| Ok(()),
        /// Keys whose parts, or nodes by id, every rank must have whole where several share a mesh.
        common: &'static [&'static str] = &[],
        /// Word for what it puts between its surfaces that must be there once only, e.g. "contact"; empty where it puts nothing.
        puts: &'static str = "",
        /// The surfaces that may touch by its doing, as its `Parameters` name them where the deck gives them.
        surfaces: fn(Option<&Node>) -> Vec<NamedSurface> = |_| Vec::new(),
    }
}
