//! Heat beside a structure: `thermal_solver_settings` of a structural solver.
//!
//! Both share the nodes. Each step solves for heat first, on the mesh as the last step left it, then for the structure, whose laws expand
//! with the temperatures just found; then both until they agree ([`crate::coupling_settings`]). Elements and faces of heat are made on those of the
//! structure, with materials of their own.

use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde::{Deserialize, Serialize};
use zelus_core::analysis::{ExtensionDefinition, SolverExtensionEntry, SolverSettings};
use zelus_core::assembly::{Assembler, System};
use zelus_core::diagnostics::{Diagnostic, Report, Result};
use zelus_core::entities::{EntityBlock, Interaction, OuterLoop};
use zelus_core::io::read_materials_of;
use zelus_core::model::{EntityRole, EntityTable, ModelPart, Properties};
use zelus_core::parameters::Settings;
use zelus_core::register;
use zelus_core::strategies::{Monitor, Phases, SolutionStrategy, StepRecord};
use zelus_linear_algebra::{State, StateMapper, Unknowns, stored_as_bytes};

use crate::adoption::{PROPERTIES, replace};
use crate::columns::Columns;
use crate::coupling_settings::CouplingStrategy;
use crate::elements::ABOUT_Y;
use crate::heat::Heat;
use crate::monolithic::MonolithicCoupling;
use crate::plastic_heat::PlasticHeat;
use crate::staggered::{StaggeredCoupling, StaggeredSettings};

/// Name of the extension.
pub const EXTENSION: &str = "thermal_solver_settings";

/// Reads the materials of heat beside those of the structure.
fn adopt(settings: &Settings, folder: &Path, part: &mut ModelPart, report: &mut Report) -> Result<()> {
    let is_round = part.elements.kinds.iter().any(|kind| kind.of_revolution);
    part.info.set(ABOUT_Y, is_round);
    let solver = SolverSettings::new(settings.node(), report)?;
    let mut heat = part.clone();
    heat.name = solver.settings.get_str("model_part_name")?.to_owned();
    heat.properties = [(0, Properties::new(0))].into();
    for table in [&mut heat.elements, &mut heat.conditions] {
        table.properties.fill(0);
    }
    solver.add_variables(&mut heat)?;
    let materials = solver.settings.get("material_import_settings.materials_filename")?;
    let warnings = read_materials_of(&folder.join(materials.str()?), &materials.place(), &mut heat)?;
    warnings.into_iter().for_each(|warning| report.push(warning));
    solver.adopt(folder, &mut heat, report)?;
    let base = part.properties.keys().max().map_or(1, |last| last + 1);
    for (own, of_heat) in [(&mut part.elements, &heat.elements), (&mut part.conditions, &heat.conditions)] {
        own.data.add_named(PROPERTIES, 1);
        let ids: Vec<f64> = of_heat.properties.iter().map(|id| (base + id) as f64).collect();
        own.data.write_level(PROPERTIES, 0, &ids);
    }
    for (id, mut properties) in std::mem::take(&mut heat.properties) {
        if let Some(own) = part.properties.get_mut(&id) {
            complete(own, &properties, report);
        }
        properties.id = base + id;
        part.properties.insert(base + id, properties);
    }
    (part.nodes, part.data, part.info) = (heat.nodes, heat.data, heat.info);
    Ok(())
}

/// Properties of one id are one material: the values of the materials of heat, which come later, count.
fn complete(own: &mut Properties, of_heat: &Properties, report: &mut Report) {
    for (name, value) in &of_heat.values {
        let Some(given) = own.values.get_mut(name).filter(|given| *given != value) else { continue };
        let fact = format!("{name} of properties {} is given by both materials files; that of heat counts", own.id);
        let warning = Diagnostic::warning("repeated-value", fact).at(of_heat.place.clone());
        report.push(warning.remedy("give both the same value, or properties of heat another id"));
        given.clone_from(value);
    }
}

/// The entities of the structure as those of heat.
fn table_of_heat(role: EntityRole, table: &EntityTable, settings: &Settings, space: usize) -> Result<EntityTable> {
    let mut out = table.clone();
    for (at, properties) in out.properties.iter_mut().enumerate() {
        let id = table.data.level(PROPERTIES, 0).get(at).copied().unwrap_or(0.0);
        if id > 0.0 {
            *properties = id as usize;
        }
    }
    let key = format!("element_replace_settings.{}_name", role.word());
    replace(role, &mut out, settings.get_str(&key)?, space).map_err(|problem| problem.at(settings.key_place(&key)))?;
    Ok(out)
}

/// Bodies are of revolution for both or for none.
///
/// # Errors
/// Else their elements do not fit.
fn check_revolution(part: &ModelPart, system: &System, settings: &Settings) -> Result<()> {
    let of_structure = part.elements.kinds.iter().find(|kind| kind.of_revolution);
    let heat = system.elements.iter().any(|block| block.entry().of_revolution);
    let round = of_structure.is_some();
    let any_heat = !system.elements.is_empty();
    if round == heat || !any_heat {
        return Ok(());
    }
    let (fact, remedy) = match of_structure {
        Some(kind) => (
            format!("the structure is of revolution ({}), and its elements of heat are plane", kind.name),
            "write \"element_replace_settings\": {\"element_name\": \"AxisymmetricEulerianConvectionDiffusion\", \
             \"condition_name\": \"AxisymmetricThermalFace\"}",
        ),
        None => (
            "its elements of heat are of revolution, and the structure is plane".to_owned(),
            "take elements of the structure whose names begin with Axisym, or plane ones of heat",
        ),
    };
    Err(Diagnostic::error("revolution", fact).at(settings.place()).remedy(remedy).into())
}

/// Puts heat before the strategy of the structure.
fn around(
    settings: &Settings,
    part: &mut ModelPart,
    structure: Box<dyn SolutionStrategy>,
    interactions: Vec<Box<dyn Interaction>>,
    report: &mut Report,
) -> Result<Box<dyn SolutionStrategy>> {
    let solver = SolverSettings::new(settings.node(), &mut Report::new())?;
    let space = part.info.domain_size;
    let elements = table_of_heat(EntityRole::Element, &part.elements, &solver.settings, space)?;
    let conditions = table_of_heat(EntityRole::Condition, &part.conditions, &solver.settings, space)?;
    let own = (std::mem::replace(&mut part.elements, elements), std::mem::replace(&mut part.conditions, conditions));
    let mut system = System { interactions, ..System::default() };
    let made = system.make_blocks(part);
    (part.elements, part.conditions) = own;
    made?;
    check_revolution(part, &system, settings)?;
    let unknown = Columns::of(part).unknown;
    let is_thermal = |block: &dyn EntityBlock| block.unknowns().first().is_some_and(|row| row.variable == unknown);
    system.elements.retain(|block| is_thermal(block.as_ref()));
    system.conditions.retain(|block| is_thermal(block.as_ref()));
    let (strategy, _) = solver.strategy(part, &mut system, report)?;
    let plastic = PlasticHeat::of(part);
    let mut heat = Heat { strategy, system, plastic, last: None, sweeps: 0 };
    let coupling = match CouplingStrategy::of(part) {
        // Steps that are explicit are too short to be worth a second look.
        CouplingStrategy::Staggered(_) if !(structure.can_retry() && heat.strategy.can_retry()) => {
            CouplingStrategy::Sequential
        }
        CouplingStrategy::Monolithic if !structure.takes_followers() || heat.strategy.linearized().is_none() => {
            let fact = "\"strategy\": \"monolithic\" of \"coupling_settings\" needs implicit steps of heat and of the structure, \
                        these by Newton's iteration (\"analysis_type\": \"non_linear\", no \"arc_length\")";
            let problem = Diagnostic::error("invalid-value", fact).at(settings.place());
            return Err(problem.remedy("choose such steps, or \"strategy\": \"staggered\"").into());
        }
        coupling => coupling,
    };
    Ok(Box::new(Coupled { heat: Arc::new(Mutex::new(heat)), structure, coupling }))
}

/// Heat first, then the structure.
struct Coupled {
    /// Shared with the interaction that solves for heat again while the structure iterates.
    heat: Arc<Mutex<Heat>>,
    structure: Box<dyn SolutionStrategy>,
    /// How both are solved.
    coupling: CouplingStrategy,
}

impl Coupled {
    fn heat(&self) -> MutexGuard<'_, Heat> {
        self.heat.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The structure's step, with heat solved for again whenever it has converged.
    fn solve_staggered(
        &mut self,
        goal: StaggeredSettings,
        part: &mut ModelPart,
        system: &mut System,
        monitor: &mut dyn Monitor,
        start: Vec<f64>,
    ) -> Result<StepRecord> {
        let sweeps = StaggeredCoupling::new(self.heat.clone(), goal, part, start);
        if system.interactions.iter_mut().any(|interaction| interaction.active_set().is_some()) {
            // The contact state of the step must not begin anew: its iteration goes on.
            system.interactions.push(Box::new(sweeps));
            let record = self.structure.solve_step(part, system, monitor);
            system.interactions.pop();
            return record;
        }
        let mut sweeps = sweeps;
        loop {
            let mut record = self.structure.solve_step(part, system, monitor)?;
            let outer = if record.converged {
                self.heat().plastic.take(part, &system.elements);
                sweeps.solve_heat_again(part)?
            } else {
                OuterLoop::Done
            };
            match outer {
                OuterLoop::Continue => continue,
                OuterLoop::Failed(why) => {
                    record.converged = false;
                    record.failure = Some(why);
                }
                _ => {}
            }
            return Ok(record);
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Self")]
struct CoupledState {
    unknowns_of_heat: Unknowns,
    heat: Option<Box<dyn State>>,
    structure: Option<Box<dyn State>>,
}

stored_as_bytes!(CoupledState);

#[typetag::serde(name = "thermo_mechanically_coupled")]
impl State for CoupledState {
    fn remap(&mut self, mapper: &mut dyn StateMapper) {
        let of_structure = mapper.begin_unknowns(&self.unknowns_of_heat);
        self.heat.iter_mut().for_each(|state| state.remap(mapper));
        mapper.begin_unknowns(&of_structure);
        self.structure.iter_mut().for_each(|state| state.remap(mapper));
    }
}

impl SolutionStrategy for Coupled {
    fn step_length(&mut self, part: &mut ModelPart, system: &System, asked: f64) -> Result<f64> {
        self.structure.step_length(part, system, asked)
    }

    fn can_retry(&self) -> bool {
        self.structure.can_retry()
    }

    fn remedy(&self) -> &'static str {
        match self.coupling {
            CouplingStrategy::Staggered(_) => {
                "\"coupling_settings\": {\"strategy\": \"monolithic\"} where heat and structure drive each other, a shorter \
                 \"time_step\", more \"max_iteration\", the strategy \"line_search\""
            }
            _ => self.structure.remedy(),
        }
    }

    fn announce_every(&self) -> usize {
        self.structure.announce_every()
    }

    fn solve_step(
        &mut self,
        part: &mut ModelPart,
        system: &mut System,
        monitor: &mut dyn Monitor,
    ) -> Result<StepRecord> {
        let unknown = Columns::of(part).unknown.column;
        let start = part.nodes.history.level(unknown, 0).to_vec();
        let heat = self.heat().solve_step(part, monitor)?;
        if !heat.converged {
            return Ok(StepRecord { failure: heat.failure.map(|why| format!("heat: {why}")), ..heat });
        }
        self.heat().sweeps = 0;
        let mut record = match self.coupling {
            CouplingStrategy::Sequential => {
                let record = self.structure.solve_step(part, system, monitor)?;
                self.heat().plastic.take(part, &system.elements);
                record
            }
            CouplingStrategy::Staggered(goal) => self.solve_staggered(goal, part, system, monitor, start)?,
            CouplingStrategy::Monolithic => {
                system.interactions.push(Box::new(MonolithicCoupling::new(self.heat.clone(), start)));
                let record = self.structure.solve_step(part, system, monitor);
                system.interactions.pop();
                record?
            }
        };
        if self.coupling != CouplingStrategy::Sequential {
            record.interactions.push(("heat_sweeps".to_owned(), self.heat().sweeps as f64));
        }
        let heat = self.heat().last.take().unwrap_or(heat);
        record.interactions.push(("heat_iterations".to_owned(), heat.iterations.len() as f64));
        record.interactions.extend(heat.interactions);
        if let (Some(all), Some(of_heat)) = (&mut record.balance, heat.balance) {
            all.unknowns.extend(of_heat.unknowns);
        }
        Ok(record)
    }

    /// The mesh has moved with the structure, which carries no heat through itself.
    fn finalize_step(&mut self, part: &mut ModelPart, system: &mut System) -> Result<()> {
        self.heat().finalize_step(part)?;
        self.structure.finalize_step(part, system)?;
        if let Some(mesh) = Columns::of(part).mesh_velocity.filter(|_| part.nodes.history.has("ACCELERATION")) {
            let velocity = part.nodes.history.level("VELOCITY", 0).to_vec();
            part.nodes.history.write_level(mesh, 0, &velocity);
        }
        Ok(())
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        let mut all = self.heat().messages();
        all.extend(self.structure.messages());
        all
    }

    fn last_messages(&self, part: &ModelPart) -> Vec<Diagnostic> {
        let mut all = self.heat().last_messages(part);
        all.extend(self.structure.last_messages(part));
        all
    }

    fn assembler(&self) -> &Assembler {
        self.structure.assembler()
    }

    fn state(&self) -> Option<Box<dyn State>> {
        let heat = self.heat();
        Some(Box::new(CoupledState {
            unknowns_of_heat: heat.system.dofs.layout(),
            heat: heat.strategy.state(),
            structure: self.structure.state(),
        }))
    }

    fn resume(&mut self, part: &ModelPart, system: &System, state: Box<dyn State>) -> Result<()> {
        let CoupledState { heat, structure, .. } = state.take()?;
        heat.map_or(Ok(()), |state| self.heat().resume(part, state))?;
        structure.map_or(Ok(()), |state| self.structure.resume(part, system, state))
    }

    fn phases(&self) -> Phases {
        self.structure.phases()
    }
}

register! { SolverExtensionEntry "thermal_solver_settings",
    about: "heat beside the structure: the settings of a solver of heat, \"stationary\" or \"transient\"",
    defaults: r#"// Settings of a solver of heat, all of them: `zelus describe stationary` and transient.
{
    "$example": {"solver_type": "transient", "time_stepping": {"time_step": 0.25}}
}"#,
    build: ExtensionDefinition { adopt, around, acts_alone: true, ..ExtensionDefinition::NOTHING },
}
