//! Energy balance of explicit steps, at the start of each: t_n, where the forces of the step are known.
//!
//! Works are those of the trapezoidal rule, W_n = Σ ½ (f_{n−1} + f_n) · Δu_n. With the rates of [`super::central_differences`] the
//! works of all forces add up to the change of
//!
//! ½ v_n·M v_n − U_n, U_n = ½ (Δt/2)² a_n·M a_n,
//!
//! exactly while steps are equal; of a mode of frequency ω, U is (ω Δt/2)² times its strain energy. So
//!
//! R_n = ½ v·M v − U + stored + penalty + dissipated + damping − loads − supports, less its first value,
//!
//! is energy that contact and changes of the step have made or lost. The first forces act for half a step: of supports that start with
//! a velocity U_0 is taken off their work. In a stable linear model U is less than the strain energy, so that the
//! kinetic energy is at most the supplied one; it is more where the step is longer than the critical one.

use serde::{Deserialize, Serialize};

use super::balance::{Balance, Energies};
use super::dof_name::DofName;
use crate::StateMapper;
use crate::assembly::{Assembler, DofTable, Equations, ForceKinds, System};
use crate::diagnostics::Diagnostic;
use crate::model::{FIRST, ModelPart, SECOND};

/// Remainder by the largest energy so far above which the balance is warned of.
const TOLERANCE: f64 = 0.01;
/// Kinetic energy by the supplied energy above which the motion is unstable.
const UNSTABLE: f64 = 2.0;
/// The same, above which the run ends.
const BLOWN_UP: f64 = 1e3;
/// Share of the forces at a node whose impulse in a step is round-off.
const ROUND_OFF: f64 = 1e-8;

/// Loads, elements, interactions, damping and supports.
const KINDS: usize = 5;
const LOADS: usize = 0;
const ELEMENTS: usize = 1;
const INTERACTIONS: usize = 2;
const DAMPING: usize = 3;
const SUPPORTS: usize = 4;

/// Energies of interactions in the state at the start of a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct InteractionEnergies {
    /// Energy in the springs of penalties; `None` where an interaction does not know it.
    stored: Option<f64>,
    /// Heat of friction since the step before.
    dissipated: f64,
}

impl InteractionEnergies {
    /// Of all interactions, the same on every rank.
    pub fn of(part: &ModelPart, system: &System) -> Self {
        let mut out = Self { stored: Some(0.0), dissipated: 0.0 };
        for interaction in &system.interactions {
            let pairs = interaction.pairs(part);
            if pairs.is_empty() && interaction.coupling().is_some_and(|coupling| !coupling.blocks().is_empty()) {
                out.stored = None;
            }
            for pair in pairs {
                out.stored = out.stored.zip(pair.stored).map(|(sum, own)| sum + own);
                out.dissipated += pair.dissipated;
            }
        }
        out
    }
}

/// Forces and motion of one step, numbers an unknown.
pub(super) struct ExplicitMotion<'a> {
    /// Shares of this rank in the forces at the start.
    pub kinds: &'a ForceKinds,
    /// Residual at the start.
    pub residual: &'a [f64],
    /// Lumped mass.
    pub mass: &'a [f64],
    /// Motion in the step.
    pub increment: Vec<f64>,
    /// Half the step that led to the start, of the first step half of itself (time).
    pub half: f64,
}

/// Finding in the energies of a step.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum EnergyFinding {
    /// Worth a warning.
    Warning(Diagnostic),
    /// The run has to end.
    BlownUp(String),
}

/// Energies of a stage of explicit steps.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct ExplicitEnergy {
    /// Works of the kinds up to the start of the last step.
    works: [f64; KINDS],
    /// Works of the forces at the start of the last step over half of its motion.
    halves: [f64; KINDS],
    /// Motion in the last step, a number an unknown; empty before the first.
    increment: Vec<f64>,
    /// Heat of friction up to the start of the last step.
    dissipated: f64,
    /// Sum of the balance at the start of the first step.
    first_sum: Option<f64>,
    /// Energies at the start of the first step that motion may come of.
    initial: f64,
    /// Largest work of loads and supports so far.
    most_work: f64,
    /// Most energy that elements have released.
    released: f64,
    /// Largest of the energies so far.
    largest: f64,
    /// Largest energy that round-off may have.
    round_off: f64,
    warned_of_remainder: bool,
    warned_of_instability: bool,
}

impl ExplicitEnergy {
    /// The balance at the start of a step whose motion is done, and its finding. Collective.
    pub fn balance(
        &mut self,
        part: &ModelPart,
        system: &System,
        assembler: &Assembler,
        motion: ExplicitMotion<'_>,
        interactions: InteractionEnergies,
    ) -> (Balance, Option<EnergyFinding>) {
        let sums = self.sums(part, system, assembler, &motion);
        for (kind, work) in self.works.iter_mut().enumerate() {
            *work += self.halves[kind] + sums.before[kind];
        }
        self.halves = sums.after;
        self.increment = motion.increment;
        self.dissipated += interactions.dissipated;
        let works = &self.works;
        let of_contact = -works[INTERACTIONS] - self.dissipated;
        let mut energies = Energies {
            stored: -works[ELEMENTS],
            loads: works[LOADS],
            supports: works[SUPPORTS],
            interactions: works[INTERACTIONS],
            dissipated: self.dissipated,
            kinetic: sums.kinetic,
            penalty: interactions.stored.unwrap_or(of_contact),
            damping: Some(-works[DAMPING]),
            unresolved: Some(sums.unresolved),
            remainder: None,
        };
        let damping = -works[DAMPING];
        let total =
            energies.kinetic - sums.unresolved + energies.stored + energies.penalty + energies.dissipated + damping
                - energies.loads
                - energies.supports;
        if self.first_sum.is_none() {
            self.initial = energies.kinetic + energies.penalty.max(0.0);
        }
        let remainder = total - *self.first_sum.get_or_insert(total);
        energies.remainder = Some(remainder);
        let terms = [energies.kinetic, energies.stored, energies.loads, energies.supports, energies.penalty];
        let terms = terms.into_iter().chain([energies.dissipated, damping]);
        self.largest = terms.map(f64::abs).fold(self.largest, f64::max);
        self.most_work = self.most_work.max(energies.loads + energies.supports);
        self.released = self.released.max(-energies.stored);
        self.round_off = self.round_off.max(sums.round_off);
        let finding =
            self.judge(part, energies.kinetic, remainder, || fastest(part, &system.dofs, assembler, motion.mass));
        (Balance { energies, ..Balance::default() }, finding)
    }

    /// Whether it can be that of as many unknowns.
    pub fn is_of(&self, unknowns: usize) -> bool {
        self.increment.is_empty() || self.increment.len() == unknowns
    }

    /// See [`State::remap`](crate::State::remap).
    pub fn remap(&mut self, mapper: &mut dyn StateMapper) {
        mapper.by_unknown(&mut self.increment);
    }

    fn judge(
        &mut self,
        part: &ModelPart,
        kinetic: f64,
        remainder: f64,
        fastest: impl FnOnce() -> String,
    ) -> Option<EnergyFinding> {
        let (step, time) = (part.info.step - 1, part.info.time - part.info.delta_time);
        let supplied = self.initial + self.most_work + self.released + self.round_off;
        if kinetic > BLOWN_UP * supplied {
            return Some(EnergyFinding::BlownUp(format!(
                "the motion is unstable: the kinetic energy, {kinetic:.3e}, is {BLOWN_UP:.0e} times the energy supplied, \
                 {supplied:.3e}; the fastest node is {}: the step is longer than the critical one, or contact is stiffer \
                 than it bears",
                fastest()
            )));
        }
        if kinetic > UNSTABLE * supplied && !self.warned_of_instability {
            self.warned_of_instability = true;
            let fact = format!(
                "after step {step}, time {time:.6e}, the kinetic energy, {kinetic:.3e}, is more than {UNSTABLE} times the energy \
                 supplied, {supplied:.3e}; the fastest node is {}",
                fastest()
            );
            let remedy = "the motion grows without bound: shorten \"time_step\", or let \"time_step_prediction_level\": 2 choose it; \
                          with contact leave the penalty to the estimate";
            return Some(EnergyFinding::Warning(Diagnostic::warning("explicit-unstable", fact).remedy(remedy)));
        }
        let scale = self.largest.max(self.round_off);
        if remainder.abs() > TOLERANCE * scale && !self.warned_of_remainder && !self.warned_of_instability {
            self.warned_of_remainder = true;
            let way = if remainder > 0.0 { "more" } else { "less" };
            let fact = format!(
                "after step {step}, time {time:.6e}, the model has {:.3e} {way} energy than its balance gives it, {:.1} % of the \
                 largest energy so far, {scale:.3e}",
                remainder.abs(),
                100.0 * remainder.abs() / scale
            );
            let remedy = "shorten the steps, by \"time_step\" or \"max_delta_time\": contact opens and closes within them; \"energies\" \
                          of the report have the terms";
            return Some(EnergyFinding::Warning(Diagnostic::warning("explicit-energy", fact).remedy(remedy)));
        }
        None
    }

    /// Sums over the unknowns of all ranks; collective.
    fn sums(&self, part: &ModelPart, system: &System, assembler: &Assembler, motion: &ExplicitMotion<'_>) -> StepSums {
        let equations = assembler.equations();
        let mass = moving_mass(equations, motion.mass);
        let [velocity, acceleration] = [FIRST, SECOND].map(|column| system.dofs.column(part, column, 0));
        let ExplicitMotion { kinds, residual, increment, half, .. } = motion;
        let out_of_balance: Vec<f64> =
            residual.iter().zip(&mass).zip(&acceleration).map(|((r, m), a)| r - m * a).collect();
        let supports = equations.forces_of_supports(&out_of_balance);
        let shares = [&kinds.loads, &kinds.elements, &kinds.interactions, &kinds.damping];
        let mut own = [0.0; 2 * KINDS + 3];
        for (kind, forces) in shares.into_iter().enumerate() {
            own[kind] = product(forces, &self.increment);
            own[KINDS + kind] = product(forces, increment);
        }
        for n in (0..mass.len()).filter(|&n| assembler.counts(n)) {
            own[SUPPORTS] += supports[n] * self.increment.get(n).copied().unwrap_or(0.0);
            own[KINDS + SUPPORTS] += supports[n] * increment[n];
            own[2 * KINDS] += mass[n] * velocity[n] * velocity[n];
            let unresolved = mass[n] * (half * acceleration[n]).powi(2);
            if self.first_sum.is_none() && equations.is_fixed(n) {
                own[KINDS + SUPPORTS] -= unresolved;
            } else {
                own[2 * KINDS + 1] += unresolved;
            }
        }
        let step = part.info.delta_time;
        for n in (0..mass.len()).filter(|&n| mass[n] > 0.0) {
            let size: f64 = shares.iter().filter_map(|forces| forces.get(n)).map(|force| force.abs()).sum();
            own[2 * KINDS + 2] += (ROUND_OFF * size * step).powi(2) / mass[n];
        }
        own.iter_mut().for_each(|sum| *sum *= 0.5);
        part.ranks.sum(&mut own);
        StepSums {
            before: std::array::from_fn(|kind| own[kind]),
            after: std::array::from_fn(|kind| own[KINDS + kind]),
            kinetic: own[2 * KINDS],
            unresolved: own[2 * KINDS + 1],
            round_off: own[2 * KINDS + 2],
        }
    }
}

/// Sums over the unknowns at the start of a step.
struct StepSums {
    /// ½ f_n · Δu_n of the kinds.
    before: [f64; KINDS],
    /// ½ f_n · Δu_{n+1} of the kinds.
    after: [f64; KINDS],
    kinetic: f64,
    unresolved: f64,
    round_off: f64,
}

/// Masses that the unknowns move with: masters carry those of their slaves, as [`Equations::lump`] gives them.
fn moving_mass(equations: &Equations, mass: &[f64]) -> Vec<f64> {
    if !equations.has_slaves() {
        return mass.to_vec();
    }
    let fixed = |(n, &m): (usize, &f64)| if equations.is_fixed(n) { m } else { 0.0 };
    let mut out: Vec<f64> = mass.iter().enumerate().map(fixed).collect();
    equations.unknowns().iter().zip(equations.lump(mass)).for_each(|(&n, m)| out[n as usize] = m);
    out
}

/// The unknown with the largest kinetic energy, in words; collective.
fn fastest(part: &ModelPart, dofs: &DofTable, assembler: &Assembler, mass: &[f64]) -> String {
    let velocity = dofs.column(part, FIRST, 0);
    let energy = |n: usize| mass[n] * velocity[n] * velocity[n];
    let own = (0..mass.len()).filter(|&n| assembler.counts(n)).max_by(|&a, &b| energy(a).total_cmp(&energy(b)));
    let most = part.ranks.gather_numbers(&[own.map_or(-1.0, energy)]).concat().into_iter().fold(-1.0, f64::max);
    let named = own.filter(|&n| energy(n) >= most).map(|n| DofName::of(dofs, &part.nodes, n as u32).to_string());
    part.ranks.first_to_say(named).unwrap_or_default()
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
