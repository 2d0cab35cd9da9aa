//! Explicit integration: no iteration, one residual a step, a diagonal mass.
//!
//! Contact takes part as in Newton's iteration, but once a step and at the old positions: `begin_step`, `after_prediction`
//! and `after_update` of each interaction, then its blocks in the residual. An interaction may shorten the steps while it acts
//! ([`crate::entities::Interaction::step_factor`]). One that adds stiffness finds the longest step of the bodies there, [`CRITICAL_STEP`].
//! Each step has its energy balance ([`super::explicit_energy`]); mass may be added to small elements ([`super::mass_scaling`]).

use serde::{Deserialize, Serialize};
use zelus_linear_algebra::{State, StateMapper, stored_as_bytes};

use super::balance::Balance;
use super::central_differences::CentralDifferences;
use super::critical_step::critical_step;
use super::dof_name::DofName;
use super::explicit_energy::{EnergyFinding, ExplicitEnergy, ExplicitMotion, InteractionEnergies};
use super::mass_scaling::MassScaling;
use super::reactions::write_reactions;
use super::records::{IterationRecord, Monitor, StepRecord};
use super::scheme::{SchemeEntry, SchemeFactory};
use super::strategy::{SolutionStrategy, accept, recorded};
use crate::assembly::{Assembler, AssemblerState, Equations, Inertia, System, damped_by_properties, strongest_damping};
use crate::diagnostics::{Diagnostic, Result, unfit};
use crate::model::{ColumnOf, FIRST, ModelPart, Rates, SECOND};
use crate::parameters::Settings;
use crate::register;

/// Longest stable step of the bodies without contact, estimated last (time).
pub const CRITICAL_STEP: &str = "CRITICAL_STEP";

/// The residual that is accelerated.
const OUT_OF_BALANCE: ColumnOf = |rates| rates.out_of_balance;

/// Part of the critical step that a predicted step takes.
const SAFETY: f64 = 0.8;
/// Relative difference of steps that are the same.
const SAME: f64 = 1e-9;
/// Steps between two that are announced.
const ANNOUNCED: usize = 100;

/// How explicit steps are made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExplicitSettings {
    /// 0: the deck's steps; 1: the critical step of the start; 2 and more: estimated again while running.
    pub prediction_level: usize,
    /// Steps between two estimates.
    pub refresh: usize,
    /// Longest step that a prediction may give.
    pub max_delta_time: f64,
    /// Step that the mass of elements is raised for (time); 0 for none.
    pub mass_scaling_step: f64,
    /// Rayleigh's factors of mass (1/time) and stiffness (time).
    pub rayleigh: [f64; 2],
    /// Whether prescribed unknowns move to the values they are given.
    pub follow_prescribed: bool,
    /// Whether reactions are computed.
    pub compute_reactions: bool,
    /// Whether reactions of supports include the forces that constraints hand on to them.
    pub reactions_of_constraints: bool,
    /// Whether nodes follow the unknown that moves the mesh.
    pub move_mesh: bool,
}

impl ExplicitSettings {
    /// From the solver settings.
    ///
    /// # Errors
    /// Keys that are missing or of another type.
    pub fn new(settings: &Settings) -> Result<Self> {
        Ok(Self {
            prediction_level: settings.get_usize("time_step_prediction_level")?,
            refresh: settings.get_usize("delta_time_refresh")?.max(1),
            max_delta_time: settings.get_f64("max_delta_time")?,
            mass_scaling_step: settings.get_f64("mass_scaling_time_step")?,
            rayleigh: [settings.get_f64("rayleigh_alpha")?, settings.get_f64("rayleigh_beta")?],
            follow_prescribed: settings.get_bool("follow_prescribed_motion")?,
            compute_reactions: settings.get_bool("compute_reactions")?,
            reactions_of_constraints: settings.get_bool("reactions_of_constraints")?,
            move_mesh: settings.get_bool("move_mesh_flag")?,
        })
    }
}

/// Steps of an explicit scheme with its lumped mass.
pub struct ExplicitStrategy {
    settings: ExplicitSettings,
    scheme: CentralDifferences,
    assembler: Assembler,
    /// Lumped mass of each unknown, with the added one.
    mass: Vec<f64>,
    /// Whether some rank has unknowns without mass, of nodes of no body.
    has_massless: bool,
    /// Mass added to elements, once there is any.
    scaling: Option<MassScaling>,
    /// Whether the masses of the nodes are still to be written.
    writes_masses: bool,
    energy: ExplicitEnergy,
    /// Balance of the step that has just been made.
    balance: Option<Balance>,
    /// Numbers chosen for the run that have not been asked for.
    numbers: Vec<(&'static str, f64)>,
    /// The predicted step and the steps made since.
    predicted: Option<(f64, usize)>,
    warned: bool,
    messages: Vec<Diagnostic>,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Self")]
struct ExplicitState {
    scheme: CentralDifferences,
    assembler: AssemblerState,
    predicted: Option<(f64, usize)>,
    warned: bool,
    scaling: Option<MassScaling>,
    energy: ExplicitEnergy,
}

stored_as_bytes!(ExplicitState);

#[typetag::serde(name = "explicit")]
impl State for ExplicitState {
    fn remap(&mut self, mapper: &mut dyn StateMapper) {
        self.assembler.remap(mapper);
        self.energy.remap(mapper);
        self.scaling.iter_mut().for_each(|scaling| mapper.by_unknown(&mut scaling.added));
    }
}

impl ExplicitStrategy {
    /// Numbers the unknowns of `part`, whose blocks and interactions are ready, and lumps the mass.
    ///
    /// # Errors
    /// Lagrange multipliers and other unknowns without mass; an entity that cannot be computed.
    pub fn new(
        settings: ExplicitSettings,
        scheme: CentralDifferences,
        part: &mut ModelPart,
        system: &mut System,
    ) -> Result<Self> {
        let mut assembler = Assembler::new(part, system, true);
        part.ranks.agree(only_with_mass(system))?;
        scheme.prepare(part);
        Rates::add(&mut part.nodes.history, &[OUT_OF_BALANCE]);
        let mass = assembler.lumped_mass(part, system)?;
        write_masses(part, system, &mass);
        // Rigid shapes have unknowns without mass, at nodes of no body; supports and constraints hold them in each step.
        let mut is_of_body = vec![false; part.nodes.len()];
        let elements =
            (0..part.elements.len() as u32).map(|at| part.elements.nodes(at)).filter(|nodes| nodes.len() > 1);
        elements.flatten().for_each(|&node| is_of_body[node as usize] = true);
        let mut worst: Option<(usize, f64)> = None;
        let mut has_massless = false;
        for (dof, &m) in system.dofs.dofs().iter().zip(&mass) {
            if m == 0.0 && !is_of_body[dof.node as usize] {
                has_massless = true;
            } else if worst.is_none_or(|(_, smallest)| m < smallest) {
                worst = Some((part.nodes.ids[dof.node as usize], m));
            }
        }
        let has_massless = part.ranks.any(has_massless);
        let massless = worst.filter(|(_, m)| *m <= 0.0).map(|(node, m)| format!("of node {node} is {m}"));
        if let Some(massless) = part.ranks.first_to_say(massless) {
            let fact = format!("the lumped mass {massless}, explicit integration needs a positive one");
            let remedy =
                "give a positive density, or elements whose lumped mass is positive (e.g. 2D4N instead of 2D8N)";
            return Err(Diagnostic::error("lumped-mass", fact).remedy(remedy).into());
        }
        Ok(Self {
            settings,
            scheme,
            assembler,
            mass,
            has_massless,
            scaling: None,
            writes_masses: false,
            energy: ExplicitEnergy::default(),
            balance: None,
            numbers: Vec::new(),
            predicted: None,
            warned: false,
            messages: Vec::new(),
        })
    }

    /// Estimates the longest stable step in the present state.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn critical_step(&mut self, part: &mut ModelPart, system: &System) -> Result<f64> {
        self.assembler.begin_step(part, system)?;
        self.assembler.tangents(part, system, None)?;
        let rayleigh = strongest_damping(part, self.settings.rayleigh);
        let mass = self.assembler.equations().lump(&self.mass);
        Ok(critical_step(&self.assembler, &system.dofs, &mass, rayleigh))
    }

    /// Adds mass to elements whose critical step is too short for the step that the settings name, where the model does not reach it by
    /// itself. Collective.
    fn scale_mass(&mut self, part: &mut ModelPart, system: &System) -> Result<()> {
        let critical = self.settings.mass_scaling_step / SAFETY;
        let rayleigh = strongest_damping(part, self.settings.rayleigh);
        let (scaling, said) = if self.critical_step(part, system)? < critical {
            MassScaling::of(part, system, &self.assembler, &self.mass, critical, rayleigh)?
        } else {
            (MassScaling::none(self.mass.len()), None)
        };
        self.messages.extend(said);
        self.numbers.push(("added mass by mass", scaling.share));
        self.numbers.push(("largest added mass by mass of a body", scaling.largest_of_body));
        self.add_mass(&scaling.added);
        self.scaling = Some(scaling);
        Ok(())
    }

    fn add_mass(&mut self, added: &[f64]) {
        self.mass.iter_mut().zip(added).for_each(|(mass, added)| *mass += added);
        self.writes_masses = true;
    }

    fn advance(&mut self, part: &mut ModelPart, system: &mut System) -> Result<(Vec<IterationRecord>, Option<String>)> {
        part.info.nl_iteration = 0;
        let targets = self.assembler.values(part, system);
        self.step_back(part, system);
        for interaction in &mut system.interactions {
            interaction.begin_step(part)?;
        }
        self.assembler.begin_step(part, system)?;
        for interaction in &mut system.interactions {
            if let Some(set) = interaction.active_set() {
                set.after_prediction(part)?;
                set.after_update(part, 1)?;
            }
        }
        self.assembler.begin_step(part, system)?;
        let damping = self.damping(part, system);
        let (residual, kinds) = self.assembler.residual_by_kind(part, system, damping.as_ref())?;
        let interactions = InteractionEnergies::of(part, system);
        let equations = self.assembler.equations();
        let force = equations.reduce(&residual);
        let mass = equations.lump(&self.mass);
        if self.has_massless {
            part.ranks.agree(only_massive(part, system, equations, &mass))?;
        }
        let acceleration = equations.expand(&force.iter().zip(&mass).map(|(f, m)| f / m).collect::<Vec<f64>>());
        let start = self.assembler.values(part, system);
        let half = self.scheme.half_before().unwrap_or(0.5 * part.info.delta_time);
        let moved = (0..targets.len()).find(|&n| equations.is_fixed(n) && targets[n] != start[n]);
        let target = |n: usize| {
            let follow = self.settings.follow_prescribed;
            equations.is_fixed(n).then(|| if follow { targets[n] } else { start[n] })
        };
        let follows = |n: usize| !equations.is_free(n) && !equations.is_fixed(n);
        self.scheme.advance(part, &system.dofs, &acceleration, target, follows);
        let increment =
            self.assembler.values(part, system).iter().zip(&start).map(|(now, before)| now - before).collect();
        let motion = ExplicitMotion { kinds: &kinds, residual: &residual, mass: &self.mass, increment, half };
        let (balance, finding) = self.energy.balance(part, system, &self.assembler, motion, interactions);
        self.balance = Some(balance);
        self.write_residual(part, system, &residual);
        if self.settings.compute_reactions {
            let unbalanced = self.unbalanced(part, system, &residual);
            let handed_on = self.settings.reactions_of_constraints.then(|| self.assembler.equations());
            write_reactions(part, &system.dofs, &unbalanced, handed_on);
        }
        if self.settings.move_mesh {
            part.nodes.move_all();
        }
        if !self.settings.follow_prescribed && !self.warned {
            self.warn_of_motion(part, system, moved);
        }
        match finding {
            Some(EnergyFinding::BlownUp(why)) => return Ok((Vec::new(), Some(why))),
            Some(EnergyFinding::Warning(warning)) => self.messages.push(warning),
            None => {}
        }
        let broken = self.assembler.values(part, system).iter().position(|v| !v.is_finite());
        Ok((Vec::new(), part.ranks.first_to_say(broken.map(|number| self.explain(part, system, number)))))
    }

    /// Warns where mass scaling does not give the step it is for.
    fn warn_of_short_step(&mut self, longest: f64) {
        let wanted = self.settings.mass_scaling_step;
        if longest < (1.0 - SAME) * wanted {
            let fact = format!(
                "with the mass added, steps of {longest:.3e} are safe, shorter than the {wanted:.3e} it is for"
            );
            let remedy = "stiffness without mass, as of springs, or stiffness that has grown since the start limits the step: give springs \
                          masses, or lower \"mass_scaling_time_step\"";
            self.messages.push(Diagnostic::warning("mass-scaling-step", fact).remedy(remedy));
        }
    }

    /// Puts prescribed unknowns back to where they are now: forces are those of the step's start.
    fn step_back(&self, part: &mut ModelPart, system: &System) {
        for dof in system.dofs.dofs() {
            if part.nodes.is_fixed(dof.variable, dof.node) {
                dof.step_back(part);
            }
        }
    }

    /// Damping forces of the velocity stored with the last step.
    fn damping(&self, part: &ModelPart, system: &System) -> Option<Inertia> {
        if self.settings.rayleigh == [0.0; 2] && !damped_by_properties(part, system) {
            return None;
        }
        Some(Inertia {
            alpha: self.settings.rayleigh[0],
            beta: self.settings.rayleigh[1],
            acceleration: vec![0.0; system.dofs.len()],
            velocity: system.dofs.column(part, FIRST, 0),
            ..Inertia::default()
        })
    }

    /// Force that supports and constraints must carry: the residual less the inertia.
    fn unbalanced(&self, part: &ModelPart, system: &System, residual: &[f64]) -> Vec<f64> {
        let acceleration = system.dofs.column(part, SECOND, 0);
        residual.iter().zip(acceleration).zip(&self.mass).map(|((r, a), m)| r - m * a).collect()
    }

    fn write_residual(&self, part: &mut ModelPart, system: &System, residual: &[f64]) {
        system.dofs.write_column(part, OUT_OF_BALANCE, 0, residual);
    }

    /// Warns, once, of a fixed unknown on any rank that is given another value; collective.
    fn warn_of_motion(&mut self, part: &mut ModelPart, system: &System, moved: Option<usize>) {
        let moved = moved.map(|number| DofName::of(&system.dofs, &part.nodes, number as u32).to_string());
        if let Some(moved) = part.ranks.first_to_say(moved) {
            let fact = format!("{moved} is fixed and given another value: it stays where it is");
            let remedy = "\"follow_prescribed_motion\" of the solver settings is false: true moves fixed unknowns";
            self.messages.push(Diagnostic::warning("prescribed-motion", fact).remedy(remedy));
            self.warned = true;
        }
    }

    fn explain(&self, part: &ModelPart, system: &System, number: usize) -> String {
        let unknown = DofName::of(&system.dofs, &part.nodes, number as u32);
        format!("{unknown} is no longer finite: the step is longer than the critical one")
    }
}

/// Writes the lumped masses of unknowns to the nodes.
fn write_masses(part: &mut ModelPart, system: &System, mass: &[f64]) {
    for (dof, &m) in system.dofs.dofs().iter().zip(mass) {
        if let Some(column) = dof.rates().and_then(|rates| rates.mass) {
            part.nodes.values.add_named(column, 1);
            let field = part.nodes.values.get_mut(column).expect("added above");
            field.levels[0][dof.node as usize] = m;
        }
    }
}

/// # Errors
/// A free unknown without mass: no force accelerates it by a number.
fn only_massive(part: &ModelPart, system: &System, equations: &Equations, mass: &[f64]) -> Result<()> {
    let Some((&number, _)) = equations.unknowns().iter().zip(mass).find(|(_, m)| **m <= 0.0) else { return Ok(()) };
    let unknown = DofName::of(&system.dofs, &part.nodes, number);
    let fact = format!("{unknown} is free and has no mass, and explicit integration needs one");
    Err(Diagnostic::error("lumped-mass", fact).remedy("give it a support, or its node a mass").into())
}

/// # Errors
/// Unknowns that central differences cannot move.
fn only_with_mass(system: &System) -> Result<()> {
    if let Some(dof) = system.dofs.dofs().iter().find(|dof| dof.multiplier) {
        let fact = format!("explicit integration cannot carry the Lagrange multipliers {}", dof.variable.column);
        let remedy = "use contact by penalty, \"mortar_type\": \"PenaltyContactFrictionless\"";
        return Err(Diagnostic::error("explicit-multipliers", fact).remedy(remedy).into());
    }
    if let Some(dof) = system.dofs.dofs().iter().find(|dof| dof.rates().is_none_or(|rates| rates.second.is_none())) {
        let fact = format!("explicit integration cannot carry {}, which has no mass", dof.variable.column);
        let remedy = "use elements of displacements only, e.g. SmallDisplacementBbarElement2D4N or 3D8N";
        return Err(Diagnostic::error("explicit-unknowns", fact).remedy(remedy).into());
    }
    Ok(())
}

impl SolutionStrategy for ExplicitStrategy {
    fn step_length(&mut self, part: &mut ModelPart, system: &System, asked: f64) -> Result<f64> {
        if self.settings.mass_scaling_step > 0.0 && self.scaling.is_none() {
            self.scale_mass(part, system)?;
        }
        if std::mem::take(&mut self.writes_masses) {
            write_masses(part, system, &self.mass);
        }
        let stale = match self.predicted {
            None => true,
            Some((_, steps)) => self.settings.prediction_level > 1 && steps >= self.settings.refresh,
        };
        if stale {
            let critical = self.critical_step(part, system)?;
            part.info.values.insert(CRITICAL_STEP, critical);
            if self.settings.prediction_level == 0 && asked > critical {
                let fact = format!("the step {asked:.3e} is longer than the critical one, {critical:.3e}");
                let remedy = "the motion can grow without bound: shorten \"time_step\", or let \
                              \"time_step_prediction_level\": 1 choose it";
                self.messages.push(Diagnostic::warning("critical-step", fact).remedy(remedy));
            }
            let mut longest = self.settings.max_delta_time;
            if self.settings.mass_scaling_step > 0.0 {
                longest = longest.min(self.settings.mass_scaling_step);
                self.warn_of_short_step(SAFETY * critical);
            }
            self.predicted = Some(((SAFETY * critical).min(longest), 0));
        }
        let mut length = asked;
        if let Some((predicted, steps)) = &mut self.predicted {
            *steps += 1;
            if self.settings.prediction_level > 0 {
                length = *predicted;
            }
        }
        let factors = system.interactions.iter().map(|interaction| interaction.step_factor(part));
        Ok(length * factors.fold(1.0, f64::min))
    }

    fn chosen_numbers(&mut self) -> Vec<(&'static str, f64)> {
        std::mem::take(&mut self.numbers)
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.messages)
    }

    fn can_retry(&self) -> bool {
        false
    }

    fn remedy(&self) -> &'static str {
        "a shorter \"time_step\", or \"time_step_prediction_level\": 1, which chooses it"
    }

    fn announce_every(&self) -> usize {
        ANNOUNCED
    }

    fn solve_step(
        &mut self,
        part: &mut ModelPart,
        system: &mut System,
        _monitor: &mut dyn Monitor,
    ) -> Result<StepRecord> {
        let record = recorded(part, system, |part, system| self.advance(part, system))?;
        Ok(StepRecord { balance: self.balance.take(), ..record })
    }

    fn finalize_step(&mut self, part: &mut ModelPart, system: &mut System) -> Result<()> {
        accept(part, system)
    }

    fn assembler(&self) -> &Assembler {
        &self.assembler
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(ExplicitState {
            scheme: self.scheme,
            assembler: self.assembler.state(),
            predicted: self.predicted,
            warned: self.warned,
            scaling: self.scaling.clone(),
            energy: self.energy.clone(),
        }))
    }

    fn resume(&mut self, part: &ModelPart, system: &System, state: Box<dyn State>) -> Result<()> {
        let ExplicitState { scheme, assembler, predicted, warned, scaling, energy } = state.take()?;
        self.assembler.resume(part, system, assembler)?;
        if predicted.is_some_and(|(length, _)| !(length > 0.0 && length.is_finite())) {
            return Err(unfit("the step it has predicted is none"));
        }
        let unknowns = system.dofs.len();
        if !energy.is_of(unknowns) || scaling.as_ref().is_some_and(|scaling| scaling.added.len() != unknowns) {
            return Err(unfit("the motion and the masses it remembers are not those of its unknowns"));
        }
        if let Some(scaling) = &scaling {
            self.add_mass(&scaling.added);
        }
        (self.scheme, self.predicted, self.warned) = (scheme, predicted, warned);
        (self.scaling, self.energy) = (scaling, energy);
        Ok(())
    }
}

register! { SchemeEntry "central_differences",
    about: "explicit central differences with a lumped mass, for \"time_integration_method\": \"explicit\"",
    source: "M a = f_ext − f_int(u) − C v; Belytschko, Liu and Moran, Nonlinear Finite Elements, box 6.1",
    build: SchemeFactory::Explicit(|_| Ok(CentralDifferences::default())),
}
