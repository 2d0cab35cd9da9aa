//! A law by a function of the program that runs zelus, as of Python: stress, tangent and state by strain, for many points in a call.

use std::sync::Arc;

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::{Properties, PropertyValue};
use zelus_core::register;
use zelus_structural_mechanics::laws::{ConstitutiveLaw, LawEntry, LawFactory, Matrix, StrainState};

use crate::law_function::{LawFunction, Points, function, names};
use crate::material::list;
use crate::noted_points::respond;
use crate::tangent_check::{OF_FUNCTION, warning};

/// Places in the history: strain and stress of the last accepted step, work of the stress by volume, whether a step was accepted and its
/// TIME, then state variables less those at the start.
const MOST: usize = 6;
const STRESS: usize = MOST;
const WORK: usize = 2 * MOST;
const TIME: usize = WORK + 1;
const STATES: usize = TIME + 2;

/// Constants that no law but those by functions takes, and states.
const CONSTANTS: &[&str] = &["LAW_FUNCTION", "LAW_PARAMETERS", "STATE_VARIABLES", "LAW_IS_UNSYMMETRIC"];

/// Law by a function, with so many components of strain and stress.
struct FunctionLaw {
    function: Arc<dyn LawFunction>,
    parameters: Arc<[f64]>,
    /// State variables at the start.
    states: Vec<f64>,
    components: usize,
    is_symmetric: bool,
}

/// Stress and states of a point by the function.
struct Answer {
    stress: [f64; MOST],
    state: Vec<f64>,
}

impl FunctionLaw {
    /// The law of properties with `S` Voigt components and so many of the function.
    ///
    /// # Errors
    /// A function that is not there, or that fails for a point at rest.
    fn of<const S: usize>(properties: &Properties, components: usize) -> Result<Box<dyn ConstitutiveLaw<S>>> {
        let problem = |fact: String| Diagnostic::error("user-material", fact).at(properties.place.clone());
        let Some(PropertyValue::Text(name)) = properties.values.get("LAW_FUNCTION") else {
            let fact = format!("properties {} have no LAW_FUNCTION", properties.id);
            let problem = Diagnostic::error("missing-property", fact).at(properties.place.clone());
            return Err(problem.remedy("give the name of a function as a string").into());
        };
        let Some(function) = function(name) else {
            let known = names();
            let known = if known.is_empty() {
                "no function is known".to_owned()
            } else {
                format!("known: {}", known.join(", "))
            };
            let fact = format!("LAW_FUNCTION of properties {} is \"{name}\"; {known}", properties.id);
            let remedy = "register it by zelus.law in Python and run the deck there, or use a law of the program";
            return Err(problem(fact).remedy(remedy).into());
        };
        let is_symmetric = properties.number("LAW_IS_UNSYMMETRIC").is_none_or(|flag| flag == 0.0);
        let (parameters, states) = (list(properties, "LAW_PARAMETERS")?.into(), list(properties, "STATE_VARIABLES")?);
        let law = Self { function, parameters, states, components, is_symmetric };
        let history = vec![0.0; STATES + law.states.len()];
        let rest = law.point(&StrainState::<S> { history: &history, ..StrainState::REST }, true);
        let found = law.function.respond(&rest).and_then(|found| found.check(&rest));
        let fault = match found {
            Ok(found) if found.stress.iter().chain(&found.tangent).all(|number| number.is_finite()) => {
                return Ok(Box::new(law));
            }
            Ok(_) => "it gives no numbers".to_owned(),
            Err(why) => why,
        };
        let fact = format!("function \"{name}\" of properties {} fails at rest: {fault}", properties.id);
        let remedy = "it gets strains of some points, one row each, and gives stresses, tangents and state variables of all of them";
        Err(problem(fact).remedy(remedy).into())
    }

    fn whole<const S: usize>(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>> {
        Self::of(properties, if S == 6 { 6 } else { 4 })
    }

    fn plane_stress(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<3>>> {
        Self::of(properties, 3)
    }

    /// The place of each of `S` Voigt components among those of the function.
    fn places<const S: usize>(&self) -> [usize; S] {
        std::array::from_fn(|c| if S == 3 && c == 2 { self.components - 1 } else { c })
    }

    /// State variables of a history.
    fn states_of(&self, history: &[f64]) -> impl Iterator<Item = f64> {
        self.states.iter().zip(&history[STATES..]).map(|(start, change)| start + change)
    }

    fn strain<const S: usize>(&self, state: &StrainState<'_, S>) -> [f64; MOST] {
        let mut out = [0.0; MOST];
        self.places::<S>().into_iter().zip(state.strain).for_each(|(at, value)| out[at] = value);
        out
    }

    fn point<const S: usize>(&self, state: &StrainState<'_, S>, wants_tangent: bool) -> Points {
        Points {
            components: self.components,
            states: self.states.len(),
            strain: self.strain(state)[..self.components].to_vec(),
            state: self.states_of(state.history).collect(),
            time: state.step,
            wants_tangent,
            parameters: Arc::clone(&self.parameters),
            places: vec![state.place],
        }
    }

    /// The answer of the function, and its tangent where that is wanted; `None` while points are noted. Stresses are not numbers where it
    /// fails.
    fn respond<const S: usize>(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> Option<Answer> {
        let places = self.places::<S>();
        let point = self.point(state, tangent.is_some());
        let answer = respond(&self.function, point, |stress, matrix, own| {
            if let Some(tangent) = tangent {
                let entry = |i: usize, j: usize| matrix[i * self.components + j];
                for (row, i) in tangent.iter_mut().zip(places) {
                    for (out, j) in row.iter_mut().zip(places) {
                        *out = if self.is_symmetric { 0.5 * (entry(i, j) + entry(j, i)) } else { entry(i, j) };
                    }
                }
            }
            let mut all = [0.0; MOST];
            all[..self.components].copy_from_slice(stress);
            Answer { stress: all, state: own.to_vec() }
        });
        answer.unwrap_or_else(|_| Some(Answer { stress: [f64::NAN; MOST], state: Vec::new() }))
    }

    /// Stress of the last accepted step, where nothing has changed since.
    fn accepted<const S: usize>(&self, state: &StrainState<'_, S>) -> Option<[f64; MOST]> {
        let history = state.history;
        let is_same = history[TIME] > 0.0
            && history[TIME + 1] >= state.step[1]
            && self.strain(state).iter().zip(history).all(|(now, then)| now == then);
        is_same.then(|| std::array::from_fn(|c| history[STRESS + c]))
    }

    /// Work of the stress by volume up to a state with this stress, by the trapezoidal rule.
    fn work<const S: usize>(&self, state: &StrainState<'_, S>, stress: &[f64; MOST]) -> f64 {
        let (strain, history) = (self.strain(state), state.history);
        let added = |c: usize| 0.5 * (stress[c] + history[STRESS + c]) * (strain[c] - history[c]);
        history[WORK] + (0..self.components).map(added).sum::<f64>()
    }
}

impl<const S: usize> ConstitutiveLaw<S> for FunctionLaw {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let known = if tangent.is_none() { self.accepted(state) } else { None };
        let stress = known.or_else(|| Some(self.respond(state, tangent)?.stress)).unwrap_or_default();
        self.places::<S>().map(|at| stress[at])
    }

    /// Work of the stress: a function may store it or not.
    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        let stress = self.accepted(state).or_else(|| Some(self.respond(state, None)?.stress));
        stress.map_or(0.0, |stress| self.work(state, &stress))
    }

    fn is_symmetric(&self, _small: bool) -> bool {
        self.is_symmetric
    }

    fn depends_on_time(&self) -> bool {
        true
    }

    fn ignores_measure(&self, small: bool) -> bool {
        small
    }

    fn is_computed_together(&self) -> bool {
        true
    }

    fn history(&self) -> usize {
        STATES + self.states.len()
    }

    fn advance(&self, state: &StrainState<'_, S>, history: &mut [f64]) {
        let Some(Answer { stress, state: own }) = self.respond(state, None) else { return };
        let work = self.work(state, &stress);
        history[..STRESS].copy_from_slice(&self.strain(state));
        history[STRESS..WORK].copy_from_slice(&stress);
        history[WORK..STATES].copy_from_slice(&[work, 1.0, state.step[1]]);
        for ((to, now), start) in history[STATES..].iter_mut().zip(own).zip(&self.states) {
            *to = now - start;
        }
    }

    fn internal(&self, state: &StrainState<'_, S>, variable: &str, out: &mut Vec<f64>) -> bool {
        let is_known = variable == "STATE_VARIABLES";
        if is_known {
            out.extend(self.states_of(state.history));
        }
        is_known
    }
}

register! { LawEntry "FunctionLaw3D",
    about: "Stress of solids by a function of Python, many points in a call: LAW_FUNCTION; LAW_PARAMETERS, STATE_VARIABLES",
    source: "the function",
    build: LawFactory::Space(FunctionLaw::whole::<6>),
    takes: CONSTANTS,
    warns: |properties, element| warning::<6>(properties, element, FunctionLaw::whole, true, OF_FUNCTION),
}

register! { LawEntry "FunctionLaw2DPlaneStrain",
    about: "Stress in plane strain by a function of Python, many points in a call: LAW_FUNCTION; LAW_PARAMETERS, STATE_VARIABLES",
    source: "the function",
    build: LawFactory::PlaneStrain { plane: FunctionLaw::whole::<3>, whole: FunctionLaw::whole::<4> },
    takes: CONSTANTS,
    warns: |properties, element| warning::<4>(properties, element, FunctionLaw::whole, true, OF_FUNCTION),
}

register! { LawEntry "FunctionLaw2DPlaneStress",
    about: "Stress in plane stress by a function of Python, many points in a call: LAW_FUNCTION; LAW_PARAMETERS, STATE_VARIABLES",
    source: "the function",
    build: LawFactory::PlaneStress(FunctionLaw::plane_stress),
    takes: CONSTANTS,
    warns: |properties, element| warning::<3>(properties, element, FunctionLaw::plane_stress, true, OF_FUNCTION),
}

register! { LawEntry "FunctionLawAxisym2D",
    about: "Stress with axial symmetry by a function of Python, many points in a call: LAW_FUNCTION; LAW_PARAMETERS, STATE_VARIABLES",
    source: "the function",
    build: LawFactory::Axisymmetric(FunctionLaw::whole::<4>),
    takes: CONSTANTS,
    warns: |properties, element| warning::<4>(properties, element, FunctionLaw::whole, true, OF_FUNCTION),
}
