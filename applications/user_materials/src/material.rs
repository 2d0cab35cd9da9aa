//! Constants and library of a user material, and the history of a point of it.

use std::cell::RefCell;
use std::sync::Arc;

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::{Properties, PropertyValue};
use zelus_structural_mechanics::laws::StrainState;
use zelus_structural_mechanics::tensor::Tensor;

use crate::arguments::{Arguments, COMPONENTS, Name, name_of};
use crate::library::{Subroutine, subroutine};

/// Constants that user materials take and not every other law does.
pub const CONSTANTS: &[&str] = &[
    "REFERENCE_TEMPERATURE",
    "UDSM_NAME",
    "UMAT_PARAMETERS",
    "STATE_VARIABLES",
    "UMAT_NAME",
    "IS_FORTRAN_UDSM",
    "UMAT_IS_UNSYMMETRIC",
    "UMAT_IS_THREAD_SAFE",
];

/// Tensor components in the order of the calling convention.
pub const PAIRS: [(usize, usize); COMPONENTS] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// Places in the history: stress, strain, deformation gradient less 1, whether a step was accepted and its TIME, temperature less that of
/// reference, then states.
const STRAIN: usize = COMPONENTS;
const GRADIENT: usize = 2 * COMPONENTS;
const TIME: usize = GRADIENT + 9;
const HEATING: usize = TIME + 2;
const STATES: usize = HEATING + 1;

thread_local! {
    static SCRATCH: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
}

/// A subroutine with its constants.
pub struct UserMaterial {
    subroutine: Arc<Subroutine>,
    constants: Vec<f64>,
    /// State variables at the start.
    states: Vec<f64>,
    name: Name,
    in_turn: bool,
    /// Temperature before the first step, where it is given.
    reference: Option<f64>,
    /// Whether its tangent is symmetric.
    pub is_symmetric: bool,
}

/// The state of a point that was accepted last.
#[derive(Debug, Clone, Copy)]
pub struct PastPoint {
    /// Stress in the order of the calling convention (force per area).
    pub stress: [f64; COMPONENTS],
    /// Strain, engineering shear.
    pub strain: [f64; COMPONENTS],
    /// Deformation gradient.
    pub gradient: Tensor,
    /// TIME, where a step was accepted.
    pub time: Option<f64>,
    /// Temperature less that of reference.
    pub heating: f64,
}

impl PastPoint {
    /// That of a history.
    pub fn of(history: &[f64]) -> Self {
        let six = |at: usize| std::array::from_fn(|c| history[at + c]);
        let gradient = Tensor::from_fn(|i, j| history[GRADIENT + 3 * j + i]) + Tensor::identity();
        let time = (history[TIME] > 0.0).then_some(history[TIME + 1]);
        Self { stress: six(0), strain: six(STRAIN), gradient, time, heating: history[HEATING] }
    }

    fn write(&self, history: &mut [f64]) {
        history[..COMPONENTS].copy_from_slice(&self.stress);
        history[STRAIN..GRADIENT].copy_from_slice(&self.strain);
        let change = self.gradient - Tensor::identity();
        history[GRADIENT..TIME].copy_from_slice(change.as_slice());
        let time = [f64::from(u8::from(self.time.is_some())), self.time.unwrap_or(0.0)];
        history[TIME..HEATING].copy_from_slice(&time);
        history[HEATING] = self.heating;
    }
}

/// The numbers of a constant, none where it is not given.
///
/// # Errors
/// One that is no list of numbers.
pub fn list(properties: &Properties, name: &str) -> Result<Vec<f64>> {
    match properties.values.get(name) {
        Some(PropertyValue::Vector(values)) => Ok(values.clone()),
        Some(PropertyValue::Number(value)) => Ok(vec![*value]),
        None => Ok(Vec::new()),
        Some(_) => {
            let fact = format!("{name} of properties {} is no list of numbers", properties.id);
            let problem = Diagnostic::error("user-material", fact).at(properties.place.clone());
            Err(problem.remedy("write a list, as [210e9, 0.3]").into())
        }
    }
}

impl UserMaterial {
    /// That of properties.
    ///
    /// # Errors
    /// A library that cannot be used; constants that are no list of numbers.
    pub fn of(properties: &Properties) -> Result<Self> {
        let (constants, states) = (list(properties, "UMAT_PARAMETERS")?, list(properties, "STATE_VARIABLES")?);
        let name = match properties.values.get("UMAT_NAME") {
            Some(PropertyValue::Text(name)) => name_of(name),
            _ => name_of("USER"),
        };
        let in_turn = properties.number("UMAT_IS_THREAD_SAFE").is_none_or(|flag| flag == 0.0);
        let is_symmetric = properties.number("UMAT_IS_UNSYMMETRIC").is_none_or(|flag| flag == 0.0);
        let reference = properties.number("REFERENCE_TEMPERATURE");
        Ok(Self { subroutine: subroutine(properties)?, constants, states, name, in_turn, reference, is_symmetric })
    }

    /// Temperature before the first step.
    fn reference(&self) -> f64 {
        self.reference.unwrap_or(0.0)
    }

    /// Whether nodes must have a temperature.
    pub fn needs_temperature(&self) -> bool {
        self.reference.is_some()
    }

    /// Numbers of history of a point.
    pub fn history(&self) -> usize {
        STATES + self.states.len()
    }

    /// A call from a past point with `components` of stress, whose increment is still to be given.
    pub fn arguments<const S: usize>(
        &self,
        past: &PastPoint,
        components: usize,
        state: &StrainState<'_, S>,
    ) -> Arguments<'_> {
        let identity = std::array::from_fn(|at| if at % 4 == 0 { 1.0 } else { 0.0 });
        Arguments {
            stress: past.stress,
            tangent: [0.0; COMPONENTS * COMPONENTS],
            strain: past.strain,
            increment: [0.0; COMPONENTS],
            gradients: [identity; 2],
            rotation: identity,
            time: [past.time.unwrap_or(state.step[0]), state.step[1]],
            temperature: [self.reference() + past.heating, state.temperature],
            position: state.position,
            components,
            constants: &self.constants,
            name: &self.name,
            place: state.place,
            energies: [0.0; 3],
            next_step: 1.0,
        }
    }

    /// The point that a state reaches with this stress and strain.
    pub fn reached<const S: usize>(
        &self,
        state: &StrainState<'_, S>,
        stress: [f64; COMPONENTS],
        strain: [f64; COMPONENTS],
    ) -> PastPoint {
        let heating = state.temperature - self.reference();
        PastPoint { stress, strain, gradient: state.f, time: Some(state.step[1]), heating }
    }

    /// Whether a state is the accepted one, but for its strain: no time has passed since, and no heat.
    pub fn is_past<const S: usize>(&self, past: &PastPoint, state: &StrainState<'_, S>) -> bool {
        past.time.is_some_and(|time| time >= state.step[1]) && self.reference() + past.heating == state.temperature
    }

    /// Calls the subroutine with the states of a history; `keep` gets those at the end. Stresses are not numbers where the routine asks
    /// for a shorter step.
    pub fn call(&self, arguments: &mut Arguments<'_>, history: &[f64], keep: &mut dyn FnMut(&[f64])) {
        SCRATCH.with_borrow_mut(|states| {
            states.clear();
            states.extend(self.states.iter().zip(&history[STATES..]).map(|(start, change)| start + change));
            arguments.call(&self.subroutine, self.in_turn, states);
            keep(states);
        });
        if self.is_symmetric {
            arguments.take_symmetric_tangent();
        }
        if arguments.next_step < 1.0 {
            arguments.stress = [f64::NAN; COMPONENTS];
        }
    }

    /// Writes a point and its states into a history.
    pub fn remember(&self, point: &PastPoint, states: &[f64], history: &mut [f64]) {
        point.write(history);
        for ((to, state), start) in history[STATES..].iter_mut().zip(states).zip(&self.states) {
            *to = state - start;
        }
    }

    /// STATEV of a history, as the values of STATE_VARIABLES; `false` for another variable.
    pub fn internal(&self, history: &[f64], variable: &str, out: &mut Vec<f64>) -> bool {
        let is_known = variable == "STATE_VARIABLES";
        if is_known {
            out.extend(self.states.iter().zip(&history[STATES..]).map(|(start, change)| start + change));
        }
        is_known
    }
}

/// Components of stress of a law with `S` Voigt components, unless the stress across a plane is zero: plane strain has the one across
/// it, too.
pub const fn components<const S: usize>() -> usize {
    if S == 6 { 6 } else { 4 }
}

/// The place of each of `S` Voigt components among `components` of the calling convention.
pub fn places<const S: usize>(components: usize) -> [usize; S] {
    std::array::from_fn(|c| match (S, c) {
        (6, 4) => 5,
        (6, 5) => 4,
        (3, 2) => components - 1,
        _ => c,
    })
}

/// A symmetric tensor from a vector; shear components times `shear`.
pub fn tensor(vector: &[f64; COMPONENTS], shear: f64) -> Tensor {
    let mut out = Tensor::zeros();
    for (c, (i, j)) in PAIRS.into_iter().enumerate() {
        let value = if i == j { vector[c] } else { shear * vector[c] };
        (out[(i, j)], out[(j, i)]) = (value, value);
    }
    out
}

/// The vector of a symmetric tensor; shear components times `shear`.
pub fn vector(tensor: &Tensor, shear: f64) -> [f64; COMPONENTS] {
    PAIRS.map(|(i, j)| if i == j { tensor[(i, j)] } else { shear * tensor[(i, j)] })
}
