//! Arc length: the load factor is an unknown, so that the path is followed through points where the load falls.
//!
//! R(u, λ) = λ q − f_int(u) = 0. Predictor: Δλ = ± r/‖δ_q‖, Δu = Δλ δ_q with K δ_q = q, in the direction of the last step.
//! Corrections stay in the plane normal to the predictor p: K δ_R = R, dλ = −(p·δ_R)/(p·δ_q), du = δ_R + dλ δ_q. The first
//! radius is ‖K⁻¹ q‖, that of the whole load; then r grows by √(desired/needed iterations).

use serde::{Deserialize, Serialize};
use zelus_linear_algebra::{State, StateMapper, stored_as_bytes};

use super::linear_solve::{Failed, Solved};
use super::newton::{NewtonRaphson, References};
use super::phases::Phases;
use super::records::{IterationRecord, Monitor, StepRecord};
use super::strategy::{SolutionStrategy, accept, after_prediction, recorded, relaxation, update_interactions};
use super::strategy_entry::StrategyEntry;
use crate::assembly::{Assembler, System};
use crate::diagnostics::{Diagnostic, Result, unfit};
use crate::model::ModelPart;
use crate::parameters::{Defaults, Node, Settings};
use crate::register;

const DEFAULTS: &str = include_str!("../../../configs/strategies/arc_length.json");

/// How the path is followed.
#[derive(Debug, Clone, PartialEq)]
pub struct ArcLengthSettings {
    desired: usize,
    most: f64,
    least: f64,
    /// Parts and variables of the loads that are scaled; empty for all loads of conditions.
    loads: Vec<(String, String)>,
}

impl ArcLengthSettings {
    /// From `advanced_settings` of the strategy.
    ///
    /// # Errors
    /// Keys that are not known, lists of different lengths.
    pub fn new(advanced: &Node) -> Result<Self> {
        let (settings, _) = Settings::check(advanced, &Defaults::parse("arc_length", DEFAULTS)?)?;
        let parts = settings.get_strings("loads_sub_model_part_list")?;
        let variables = settings.get_strings("loads_variable_list")?;
        if parts.len() != variables.len() {
            let fact = format!("{} sub model parts but {} variables", parts.len(), variables.len());
            let remedy = "give one variable for each part of \"loads_sub_model_part_list\"";
            return Err(settings.error("loads_variable_list", "arc-length", fact).remedy(remedy).into());
        }
        Ok(Self {
            desired: settings.get_usize("desired_iterations")?.max(1),
            most: settings.get_f64("max_radius_factor")?,
            least: settings.get_f64("min_radius_factor")?,
            loads: parts.into_iter().zip(variables).collect(),
        })
    }
}

/// Regularisation of multipliers where constraints are redundant, and whether it acts in this step.
struct Relaxation {
    amount: Option<f64>,
    taken: bool,
}

/// Newton's iteration with the load factor as a further unknown.
pub struct ArcLength {
    settings: ArcLengthSettings,
    newton: NewtonRaphson,
    /// Load factor of the last accepted step.
    factor: f64,
    /// First and present radius, once known.
    radius: Option<[f64; 2]>,
    /// Increment of the last accepted step.
    last: Vec<f64>,
    /// Values to keep when the present step is accepted: factor, increment, iterations.
    pending: Option<(f64, Vec<f64>, usize)>,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Self")]
struct ArcLengthState {
    factor: f64,
    radius: Option<[f64; 2]>,
    last: Vec<f64>,
    newton: Option<Box<dyn State>>,
}

stored_as_bytes!(ArcLengthState);

#[typetag::serde(name = "arc_length")]
impl State for ArcLengthState {
    fn remap(&mut self, mapper: &mut dyn StateMapper) {
        mapper.by_unknown(&mut self.last);
        self.newton.iter_mut().for_each(|state| state.remap(mapper));
    }
}

impl ArcLength {
    /// Follows the path with the scheme, criterion and solver of `newton`.
    pub fn new(settings: ArcLengthSettings, newton: NewtonRaphson) -> Self {
        Self { settings, newton, factor: 0.0, radius: None, last: Vec::new(), pending: None }
    }

    /// Derivative of the residual by the load factor in the present state.
    fn reference_load(&mut self, part: &mut ModelPart, system: &System) -> Result<Vec<f64>> {
        if self.settings.loads.is_empty() {
            return self.newton.assembler.loads(part, system);
        }
        let mut full = self.newton.assembler.residual(part, system, None)?;
        let nodes = part.nodes.history.clone();
        let conditions = part.conditions.data.clone();
        for (name, variable) in &self.settings.loads {
            let chosen = part.part(name)?;
            let (at_nodes, at_conditions) = (chosen.nodes.clone(), chosen.conditions.clone());
            for (fields, members) in [(&mut part.nodes.history, at_nodes), (&mut part.conditions.data, at_conditions)] {
                if let Some(field) = fields.get_mut(variable) {
                    let components = field.components;
                    for at in members {
                        let at = at as usize * components;
                        field.levels[0][at..at + components].fill(0.0);
                    }
                }
            }
        }
        let rest = self.newton.assembler.residual(part, system, None);
        part.nodes.history = nodes;
        part.conditions.data = conditions;
        full.iter_mut().zip(rest?).for_each(|(all, rest)| *all -= rest);
        Ok(full)
    }

    /// The solve, and its increment of all unknowns; `relaxation` is taken on where multipliers make it singular.
    fn solve(
        &mut self,
        part: &mut ModelPart,
        system: &System,
        rhs: &[f64],
        relaxation: &mut Relaxation,
    ) -> Result<(Vec<f64>, Solved)> {
        let rhs = self.newton.assembler.equations().reduce(rhs);
        let mut solved = self.newton.solve(part, system, &rhs);
        if let (Err(Failed::Singular(why, _)), Relaxation { amount: Some(amount), taken: taken @ false }) =
            (&solved, relaxation)
        {
            *taken = true;
            self.newton.assembler.relax_multipliers(&system.dofs, *amount);
            let relaxed = self.newton.solve(part, system, &rhs)?;
            self.newton.warn_of_redundancy(why);
            solved = Ok(relaxed);
        }
        let solved = solved?;
        Ok((self.newton.assembler.equations().expand(&solved.increment), solved))
    }

    fn residual(&mut self, part: &mut ModelPart, system: &System, factor: f64) -> Result<(Vec<f64>, Vec<f64>)> {
        let load = self.reference_load(part, system)?;
        let mut residual = self.newton.assembler.residual(part, system, None)?;
        residual.iter_mut().zip(&load).for_each(|(r, q)| *r += (factor - 1.0) * q);
        Ok((residual, load))
    }

    fn iterate(
        &mut self,
        part: &mut ModelPart,
        system: &mut System,
        monitor: &mut dyn Monitor,
    ) -> Result<(Vec<IterationRecord>, Option<String>)> {
        self.pending = None;
        self.newton.solver.forget();
        part.info.nl_iteration = 0;
        for interaction in &mut system.interactions {
            interaction.begin_step(part)?;
        }
        self.newton.assembler.begin_step(part, system)?;
        let prescribed = self.newton.start(part, system, None)?;
        if part.ranks.any(prescribed.iter().any(|d| *d != 0.0)) {
            let fact = "arc length scales loads, but a prescribed displacement changes";
            return Err(Diagnostic::error("arc-length", fact)
                .remedy("keep it constant, or use \"newton_raphson\"")
                .into());
        }
        after_prediction(part, &mut system.interactions)?;
        let amount = relaxation(&system.interactions);
        let mut relaxation = Relaxation { amount, taken: false };
        let mut factor = self.factor;
        let mut predictor = Vec::new();
        let mut step = vec![0.0; system.dofs.len()];
        let mut references = References::default();
        let mut records = Vec::new();
        let (mut residual, mut load) = self.residual(part, system, factor)?;
        for iteration in 1..=self.newton.settings.max_iteration {
            part.info.nl_iteration = iteration;
            self.newton.assembler.tangents(part, system, None)?;
            if self.settings.loads.is_empty() {
                self.newton.assembler.scale_load_tangents(factor);
            }
            if let Relaxation { amount: Some(amount), taken: true } = relaxation {
                self.newton.assembler.relax_multipliers(&system.dofs, amount);
            }
            let (along, mut solved) = self.solve(part, system, &load, &mut relaxation)?;
            let increment: Vec<f64> = if iteration == 1 {
                let size = self.newton.assembler.dot(&along, &along).sqrt();
                if size == 0.0 {
                    let fact = "no load acts that arc length could scale";
                    let remedy =
                        "check \"loads_sub_model_part_list\" and \"loads_variable_list\", and the loads' values";
                    return Err(Diagnostic::error("arc-length", fact).remedy(remedy).into());
                }
                let [_, radius] = *self.radius.get_or_insert([size; 2]);
                let forward = self.last.is_empty() || self.newton.assembler.dot(&along, &self.last) >= 0.0;
                let more = if forward { radius / size } else { -radius / size };
                factor += more;
                predictor = along.iter().map(|d| more * d).collect();
                predictor.clone()
            } else {
                let back;
                (back, solved) = self.solve(part, system, &residual, &mut relaxation)?;
                let assembler = &self.newton.assembler;
                let more = -assembler.dot(&predictor, &back) / assembler.dot(&predictor, &along);
                factor += more;
                back.iter().zip(&along).map(|(b, d)| b + more * d).collect()
            };
            step.iter_mut().zip(&increment).for_each(|(sum, d)| *sum += d);
            self.newton.move_by(part, system, &increment);
            let change = update_interactions(part, &mut system.interactions, iteration)?;
            (residual, load) = self.residual(part, system, factor)?;
            let assembler = &self.newton.assembler;
            let balanced = assembler.equations().balanced(&residual);
            if iteration == 1 {
                let whole: Vec<f64> = load.iter().map(|q| factor * q).collect();
                references.start = vec![assembler.equations().balanced(&whole).into_owned(), balanced.to_vec()];
            }
            if change.count() > 0 {
                references.switched = Some(balanced.to_vec());
            }
            let verdict = self.newton.judge(part, system, iteration, &balanced, &references, &increment);
            let record = IterationRecord::new(iteration, verdict.checks, &change, &solved);
            monitor.iteration(&record);
            records.push(record);
            if self.newton.first_infinite(part, system, &residual).is_some() {
                break;
            }
            if verdict.converged && change.count() == 0 {
                self.newton.keep_reactions(part, system, &residual);
                let more: Vec<f64> = load.iter().map(|q| (factor - 1.0) * q).collect();
                if self.newton.keep_balance(part, system, &residual, &references, Some(&more))?.is_none() {
                    self.pending = Some((factor, step, iteration));
                    return Ok((records, None));
                }
            }
        }
        if let Some([_, radius]) = &mut self.radius {
            *radius *= 0.5;
        }
        let failure = self.newton.explain(part, system, &records, &residual);
        Ok((records, Some(failure)))
    }
}

impl SolutionStrategy for ArcLength {
    fn solve_step(
        &mut self,
        part: &mut ModelPart,
        system: &mut System,
        monitor: &mut dyn Monitor,
    ) -> Result<StepRecord> {
        let mut record = recorded(part, system, |part, system| self.iterate(part, system, monitor))?;
        if let Some((factor, ..)) = &self.pending {
            record.balance = self.newton.balance.take();
            record.interactions.push(("load factor".to_owned(), *factor));
        }
        Ok(record)
    }

    fn finalize_step(&mut self, part: &mut ModelPart, system: &mut System) -> Result<()> {
        if let Some((factor, step, iterations)) = self.pending.take() {
            (self.factor, self.last) = (factor, step);
            part.info.values.insert("LOAD_FACTOR", factor);
            if let Some([first, radius]) = &mut self.radius {
                let grown = *radius * (self.settings.desired as f64 / iterations as f64).sqrt();
                *radius = grown.clamp(self.settings.least * *first, self.settings.most * *first);
            }
        }
        self.newton.energy_balance.accept();
        accept(part, system)
    }

    fn assembler(&self) -> &Assembler {
        &self.newton.assembler
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        self.newton.messages()
    }

    fn state(&self) -> Option<Box<dyn State>> {
        let (last, newton) = (self.last.clone(), self.newton.state());
        Some(Box::new(ArcLengthState { factor: self.factor, radius: self.radius, last, newton }))
    }

    fn resume(&mut self, part: &ModelPart, system: &System, state: Box<dyn State>) -> Result<()> {
        let ArcLengthState { factor, radius, last, newton } = state.take()?;
        let real = |radius: &f64| *radius > 0.0 && radius.is_finite();
        if ![0, system.dofs.len()].contains(&last.len()) || !radius.iter().flatten().all(real) || !factor.is_finite() {
            return Err(unfit("the path it remembers is not that of its unknowns"));
        }
        (self.factor, self.radius, self.last) = (factor, radius, last);
        newton.map_or(Ok(()), |state| self.newton.resume(part, system, state))
    }

    fn phases(&self) -> Phases {
        self.newton.phases()
    }
}

register! { StrategyEntry "arc_length",
    about: "arc-length method: the load factor is an unknown, and the equilibrium path passes limit points",
    source: "Riks 1979; Ramm 1981",
    defaults: DEFAULTS,
    build: |request| {
        if request.iteration.linear {
            return Ok(Box::new(request.newton()?));
        }
        let settings = ArcLengthSettings::new(request.advanced)?;
        if request.scheme_name != "static" {
            let fact = "\"arc_length\" follows states of equilibrium, the solver is dynamic";
            let problem = request.settings.error("solving_strategy_settings.type", "arc-length", fact);
            return Err(problem.remedy("use \"solver_type\": \"Static\"").into());
        }
        Ok(Box::new(ArcLength::new(settings, request.newton()?)))
    },
    unknown_load_factor: true,
}
