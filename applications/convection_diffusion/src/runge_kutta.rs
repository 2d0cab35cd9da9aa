//! Explicit steps of heat: the classical method of Runge and Kutta, of fourth order, with storage lumped at the nodes.
//!
//! M dT/dt = R(t, T): K₁ = R(t, T₀), K₂ = R(t + Δt/2, T₀ + Δt/2 M⁻¹K₁), K₃ = R(t + Δt/2, T₀ + Δt/2 M⁻¹K₂),
//! K₄ = R(t + Δt, T₀ + Δt M⁻¹K₃), T = T₀ + Δt M⁻¹ (K₁ + 2K₂ + 2K₃ + K₄)/6. Prescribed unknowns go from the old to the new value on a
//! straight line. Interactions act as in their state at the start of the step.

use serde::{Deserialize, Serialize};
use zelus_core::assembly::{Assembler, AssemblerState, System, impose_constraints};
use zelus_core::diagnostics::{Diagnostic, Result, unfit};
use zelus_core::model::ModelPart;
use zelus_core::register;
use zelus_core::strategies::{
    IterationRecord, Monitor, SolutionStrategy, StepRecord, StrategyEntry, accept, critical_step, recorded,
    write_reactions,
};
use zelus_linear_algebra::{State, StateMapper, stored_as_bytes};

use crate::columns::Columns;
use crate::elements::{PROJECTING, STAGE};
use crate::variables::PROJECTED_SCALAR1;

/// Name of the strategy.
pub const RUNGE_KUTTA: &str = "runge_kutta_4";

/// Stages: how far each is from the beginning of the step to its end, and its weight.
const STAGES: [[f64; 2]; 4] = [[0.0, 1.0 / 6.0], [0.5, 1.0 / 3.0], [0.5, 1.0 / 3.0], [1.0, 1.0 / 6.0]];
/// The half disc of this radius in the left half plane lies in the region of stability.
const RADIUS: f64 = 2.5;
/// Steps after which the longest stable one is estimated again, and growth of the fastest flow at which it is at once.
const REFRESH: usize = 10;
const FASTER: f64 = 1.1;
/// Steps between two that are announced.
const ANNOUNCED: usize = 100;

/// Explicit steps of heat.
struct RungeKutta {
    assembler: Assembler,
    /// Storage of each unknown; empty before the first step.
    capacity: Vec<f64>,
    /// Whether subscales are orthogonal to the mesh.
    orthogonal: bool,
    /// Whether steps are shortened to stable ones.
    shortens: bool,
    compute_reactions: bool,
    reactions_of_constraints: bool,
    /// Longest stable step, the steps made since it was estimated, and the fastest flow then.
    stable: Option<(f64, usize, f64)>,
    warned: bool,
    messages: Vec<Diagnostic>,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Self")]
struct RungeKuttaState {
    assembler: AssemblerState,
    stable: Option<(f64, usize, f64)>,
    warned: bool,
}

stored_as_bytes!(RungeKuttaState);

#[typetag::serde(name = "runge_kutta_4")]
impl State for RungeKuttaState {
    fn remap(&mut self, mapper: &mut dyn StateMapper) {
        self.assembler.remap(mapper);
    }
}

impl RungeKutta {
    /// Lumps the storage, once.
    ///
    /// # Errors
    /// Unknowns that store nothing.
    fn lump(&mut self, part: &mut ModelPart, system: &System) -> Result<()> {
        if !self.capacity.is_empty() || system.dofs.is_empty() {
            return Ok(());
        }
        let capacity = self.assembler.lumped_mass(part, system)?;
        let empty = system.dofs.dofs().iter().zip(&capacity).find(|(_, stored)| **stored <= 0.0);
        let empty = empty
            .map(|(dof, _)| format!("node {} stores no {}", part.nodes.ids[dof.node as usize], dof.variable.column));
        if let Some(empty) = part.ranks.first_to_say(empty) {
            let fact = format!("{empty}: explicit steps divide by the storage");
            let remedy = "use elements QSConvectionDiffusionExplicit or DConvectionDiffusionExplicit, positive density and \
                          specific heat, or \"time_integration_method\": \"implicit\"";
            return Err(Diagnostic::error("no-storage", fact).remedy(remedy).into());
        }
        self.capacity = capacity;
        Ok(())
    }

    /// The largest velocity of a node of any rank.
    fn fastest(part: &ModelPart) -> f64 {
        let values = Columns::of(part).velocity.map_or(&[][..], |column| part.nodes.history.level(column, 0));
        let own = values.chunks_exact(3).map(|v| v.iter().map(|v| v * v).sum::<f64>()).fold(0.0, f64::max).sqrt();
        let all = part.ranks.for_root(vec![own]);
        let largest = all.iter().flatten().fold(0.0_f64, |largest, own| largest.max(*own));
        part.ranks.total(if part.ranks.is_root() { largest } else { 0.0 })
    }

    /// The longest stable step: 2.5 over the largest eigenvalue of M⁻¹ ∂R/∂T.
    fn longest(&mut self, part: &mut ModelPart, system: &System) -> Result<f64> {
        self.assembler.begin_step(part, system)?;
        part.info.values.insert(STAGE, 1.0);
        self.assembler.tangents(part, system, None)?;
        // Central differences are stable up to 2/ω, where the eigenvalue is ω².
        let capacity = self.assembler.equations().lump(&self.capacity);
        let critical = critical_step(&self.assembler, &system.dofs, &capacity, [0.0; 2]);
        Ok(RADIUS * critical * critical / 4.0)
    }

    fn advance(&mut self, part: &mut ModelPart, system: &mut System) -> Result<(Vec<IterationRecord>, Option<String>)> {
        part.info.nl_iteration = 0;
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
        self.lump(part, system)?;
        let length = part.info.delta_time;
        let end = self.assembler.values(part, system);
        let start = system.dofs.gather(part, 1);
        let mut rate = vec![0.0; start.len()];
        let mut mean = [rate.clone(), rate.clone()];
        for [share, weight] in STAGES {
            self.put(part, system, &start, &end, &rate, share * length);
            part.info.values.insert(STAGE, share);
            self.project(part, system)?;
            let residual = self.assembler.residual(part, system, None)?;
            rate = self.rates(&residual);
            for (mean, value) in mean.iter_mut().zip([&residual, &rate]) {
                mean.iter_mut().zip(value).for_each(|(mean, value)| *mean += weight * value);
            }
        }
        let [residual, rate] = mean;
        self.put(part, system, &start, &end, &rate, length);
        self.project(part, system)?;
        if self.compute_reactions {
            let now = self.assembler.values(part, system);
            let stored = |n: usize| self.capacity[n] * (now[n] - start[n]) / length;
            let unbalanced: Vec<f64> = residual.iter().enumerate().map(|(n, r)| r - stored(n)).collect();
            let handed_on = self.reactions_of_constraints.then(|| self.assembler.equations());
            write_reactions(part, &system.dofs, &unbalanced, handed_on);
        }
        let broken = self.assembler.values(part, system).iter().any(|value| !value.is_finite());
        let failure = "temperatures are no longer finite: the step is longer than a stable one";
        Ok((Vec::new(), part.ranks.any(broken).then(|| failure.to_owned())))
    }

    /// M⁻¹ R of the free unknowns.
    fn rates(&self, residual: &[f64]) -> Vec<f64> {
        let equations = self.assembler.equations();
        let force = equations.reduce(residual);
        equations.expand(&force.iter().zip(equations.lump(&self.capacity)).map(|(f, m)| f / m).collect::<Vec<f64>>())
    }

    /// Sets the unknowns a time after the start: prescribed ones on the line to their end, others by their rate.
    fn put(&self, part: &mut ModelPart, system: &System, start: &[f64], end: &[f64], rate: &[f64], time: f64) {
        let length = part.info.delta_time;
        let (equations, share) = (self.assembler.equations(), time / length);
        let present = self.assembler.values(part, system);
        let wanted = |n: usize| match equations.is_fixed(n) {
            true if time == length => end[n],
            true => start[n] + share * (end[n] - start[n]),
            false => start[n] + time * rate[n],
        };
        for (number, dof) in system.dofs.dofs().iter().enumerate().filter(|(n, _)| present[*n] != wanted(*n)) {
            dof.set_value(part, wanted(number));
        }
        if !part.constraints.is_empty() {
            impose_constraints(part);
        }
    }

    /// Minus the projection of the strong residual onto the mesh, where subscales are orthogonal to it.
    fn project(&mut self, part: &mut ModelPart, system: &System) -> Result<()> {
        if !self.orthogonal {
            return Ok(());
        }
        part.info.set(PROJECTING, true);
        let residual = self.assembler.residual(part, system, None);
        part.info.set(PROJECTING, false);
        let residual = residual?;
        let values = part.nodes.history.values_mut(&PROJECTED_SCALAR1, 0);
        for (dof, (r, m)) in system.dofs.dofs().iter().zip(residual.iter().zip(&self.capacity)) {
            values[dof.node as usize] = -r / m;
        }
        Ok(())
    }
}

impl SolutionStrategy for RungeKutta {
    fn step_length(&mut self, part: &mut ModelPart, system: &System, asked: f64) -> Result<f64> {
        let fastest = Self::fastest(part);
        let stale = |(_, steps, flow): &(f64, usize, f64)| *steps >= REFRESH || fastest > FASTER * flow;
        if self.stable.as_ref().is_none_or(stale) {
            self.assembler.begin_step(part, system)?;
            self.lump(part, system)?;
            let before = std::mem::replace(&mut part.info.delta_time, asked);
            let longest = self.longest(part, system);
            part.info.delta_time = before;
            let longest = longest?;
            if !self.shortens && asked > longest && !self.warned {
                let fact = format!("the step {asked:.3e} is longer than the longest stable one, about {longest:.3e}");
                let remedy = "temperatures can grow without bound: shorten \"time_step\", or let \
                              \"time_step_prediction_level\": 1 do it";
                self.messages.push(Diagnostic::warning("critical-step", fact).remedy(remedy));
                self.warned = true;
            }
            self.stable = Some((longest, 0, fastest));
        }
        let Some((longest, steps, _)) = &mut self.stable else { return Ok(asked) };
        *steps += 1;
        Ok(if self.shortens && asked > *longest { asked / (asked / *longest).ceil() } else { asked })
    }

    fn remedy(&self) -> &'static str {
        "a shorter \"time_step\", or \"time_step_prediction_level\": 1, which shortens it"
    }

    fn announce_every(&self) -> usize {
        ANNOUNCED
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.messages)
    }

    fn solve_step(&mut self, part: &mut ModelPart, system: &mut System, _: &mut dyn Monitor) -> Result<StepRecord> {
        recorded(part, system, |part, system| self.advance(part, system))
    }

    fn finalize_step(&mut self, part: &mut ModelPart, system: &mut System) -> Result<()> {
        accept(part, system)
    }

    fn assembler(&self) -> &Assembler {
        &self.assembler
    }

    fn state(&self) -> Option<Box<dyn State>> {
        let (assembler, stable) = (self.assembler.state(), self.stable);
        Some(Box::new(RungeKuttaState { assembler, stable, warned: self.warned }))
    }

    fn resume(&mut self, part: &ModelPart, system: &System, state: Box<dyn State>) -> Result<()> {
        let RungeKuttaState { assembler, stable, warned } = state.take()?;
        self.assembler.resume(part, system, assembler)?;
        if stable.is_some_and(|(longest, _, flow)| !(longest > 0.0 && flow >= 0.0)) {
            return Err(unfit("the longest stable step it knows is none"));
        }
        (self.stable, self.warned) = (stable, warned);
        Ok(())
    }
}

register! { StrategyEntry RUNGE_KUTTA,
    about: "explicit steps of heat: four stages, storage lumped at the nodes, no linear system",
    source: "M dT/dt = R(t, T); Kutta 1901",
    build: |request| {
        let settings = request.settings;
        let assembler = Assembler::new(request.part, request.system, true);
        request.part.nodes.history.add(&PROJECTED_SCALAR1);
        "explicit: no linear solver".clone_into(request.says);
        Ok(Box::new(RungeKutta {
            assembler,
            capacity: Vec::new(),
            orthogonal: settings.get_bool("use_orthogonal_subscales")?,
            shortens: settings.get_usize("time_step_prediction_level")? > 0,
            compute_reactions: settings.get_bool("compute_reactions")?,
            reactions_of_constraints: settings.get_bool("reactions_of_constraints")?,
            stable: None,
            warned: false,
            messages: Vec::new(),
        }))
    },
}
