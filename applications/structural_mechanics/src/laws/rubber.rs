//! Hyperelastic materials of an energy W = W_iso(Ī₁, Ī₂ or λ̄_a) + U(J), with relaxation and softening where properties ask for them.
//!
//! U = ½ κ (J − 1)², so that S = S_iso + κ (J − 1) J K, K = C⁻¹. Mixed elements hold the pressure p = −κ (J̄ − 1) instead: then
//! S = S_iso − p J K. Mullins' softening multiplies S_iso by η; the tangent gets dη/dW S_iso ⊗ S_iso. Prony series relax the isochoric
//! stress: S_iso = J^(−2/3) dev(f S̄ + R) with the stress S̄ before its projection, dev(A) = A − ⅓ (A : C) K, and the memory R of earlier
//! steps, whose tangent is J^(−2/3) (2/9 (R : C) K ⊗ K − 2/3 (R ⊗ K + K ⊗ R) + ⅓ (R : C) 𝕂).
//!
//! J is that of C, so that the tangent is the derivative by the strain of the element also where that is small.

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::Properties;

use super::constants::positive;
use super::fit::{Constants, FitStart};
use super::hyper_elastic::right_cauchy_green;
use super::law::{ConstitutiveLaw, Matrix, StrainState};
use super::mullins::{Mullins, Softening};
use super::prony::PronySeries;
use super::stability::first_instability;
use super::strain_energy::{self, ElasticResponse, InvariantEnergy, Products, RightCauchyGreen};
use super::stretch_energy::{self, StretchEnergy};
use crate::tensor::{IDENTITY, Tensor, stress_vector};

/// An energy by invariants or by stretches.
pub enum Energy {
    /// By Ī₁, Ī₂ and J.
    Invariants(Box<dyn InvariantEnergy>),
    /// By principal stretches.
    Stretches(Box<dyn StretchEnergy>),
}

/// An energy with its name and constants, as its laws and the fit of test data need them.
pub struct EnergyKind {
    /// Beginning of the names of its laws.
    pub name: &'static str,
    /// Names of its constants.
    pub constants: &'static [&'static str],
    /// The energy with the constants of properties.
    pub make: fn(&Properties) -> Result<Energy>,
    /// Constants from which a fit to test data starts; none where the energy is not fitted.
    pub starts: fn(&FitStart) -> Vec<Constants>,
    /// Whether the energy depends on J; then no U is added.
    pub changes_volume: bool,
}

zelus_core::inventory::collect!(EnergyKind);

impl EnergyKind {
    /// All energies by name.
    pub fn all() -> Vec<&'static Self> {
        let mut all: Vec<&Self> = zelus_core::inventory::iter::<Self>().collect();
        all.sort_by_key(|kind| kind.name);
        all
    }

    /// The energy of a law, by the name of the law or its beginning.
    pub fn of_law(law: &str) -> Option<&'static Self> {
        let law = law.strip_prefix("Thermal").unwrap_or(law);
        Self::all().into_iter().find(|kind| {
            law.strip_prefix(kind.name)
                .is_some_and(|rest| ["", "3DLaw", "PlaneStrain2DLaw", "Axisym2DLaw"].contains(&rest))
        })
    }
}

impl Energy {
    /// Stress and, where wanted, tangent.
    pub fn respond(&self, point: &RightCauchyGreen, wants_tangent: bool) -> ElasticResponse {
        match self {
            Self::Invariants(energy) => strain_energy::respond(energy.as_ref(), point, wants_tangent),
            Self::Stretches(energy) => stretch_energy::respond(energy.as_ref(), point, wants_tangent),
        }
    }

    /// Shear modulus without strain.
    pub fn shear_modulus(&self) -> f64 {
        self.respond(&RightCauchyGreen::new(IDENTITY), true).tangent[3][3]
    }

    /// The energy that properties with a hyperelastic law describe, and the bulk modulus κ beside it.
    ///
    /// # Errors
    /// Constants that are missing or out of range, a shear modulus at rest that is not positive.
    fn with_bulk(kind: &EnergyKind, properties: &Properties) -> Result<(Self, Option<f64>)> {
        let energy = (kind.make)(properties)?;
        let modulus = energy.shear_modulus();
        if !(modulus > 0.0 && modulus.is_finite()) {
            let fact = format!("{} of properties {} has the shear modulus {modulus} at rest", kind.name, properties.id);
            let problem = Diagnostic::error("material-out-of-range", fact).at(properties.place.clone());
            let remedy = format!("give constants with a positive one: {}", kind.constants.join(", "));
            return Err(problem.remedy(remedy).into());
        }
        let bulk = if kind.changes_volume { None } else { Some(positive(properties, "BULK_MODULUS")?) };
        Ok((energy, bulk))
    }
}

/// Hyperelastic law.
pub struct Rubber {
    energy: Energy,
    /// κ; `None` where the energy depends on J itself.
    bulk: Option<f64>,
    /// Whether the element holds the pressure.
    volume_of_element: bool,
    relaxation: Option<PronySeries>,
    softening: Option<Mullins>,
}

impl Rubber {
    /// The law of an energy with the constants of the properties.
    ///
    /// # Errors
    /// Constants that are missing or out of range.
    pub(super) fn boxed<const S: usize>(
        kind: &EnergyKind,
        properties: &Properties,
    ) -> Result<Box<dyn ConstitutiveLaw<S>>> {
        let (energy, bulk) = Energy::with_bulk(kind, properties)?;
        // softening and relaxation act on the isochoric part, which an energy of J does not have
        let (relaxation, softening) = match bulk {
            Some(_) => (PronySeries::of(properties)?, Mullins::of(properties)?),
            None => (None, None),
        };
        Ok(Box::new(Self { energy, bulk, volume_of_element: false, relaxation, softening }))
    }

    /// Poisson's ratio without strain of properties with such a law.
    pub(crate) fn poisson_ratio(properties: &Properties) -> Option<f64> {
        let kind = EnergyKind::of_law(properties.law.as_deref()?)?;
        let (energy, bulk) = Energy::with_bulk(kind, properties).ok()?;
        let (modulus, bulk) = (energy.shear_modulus(), bulk?);
        Some((3.0 * bulk - 2.0 * modulus) / (6.0 * bulk + 2.0 * modulus))
    }

    /// A warning where the material of properties with such a law is not stable at usual stretches.
    pub(crate) fn instability(properties: &Properties) -> Option<Diagnostic> {
        let kind = EnergyKind::of_law(properties.law.as_deref()?)?;
        let (energy, bulk) = Energy::with_bulk(kind, properties).ok()?;
        bulk?;
        let (test, stretch) = first_instability(&energy)?;
        let fact = format!(
            "{} of properties {} is not stable from the {} stretch {stretch:.2} on: stress falls with strain (Drucker)",
            kind.name,
            properties.id,
            test.name()
        );
        let remedy = "take constants that are stable in the stretches of the model; zelus fit names the range of a fit";
        Some(Diagnostic::warning("unstable-material", fact).at(properties.place.clone()).remedy(remedy))
    }

    /// History of softening and of relaxation.
    fn split<'a>(&self, history: &'a [f64]) -> (&'a [f64], &'a [f64]) {
        history.split_at(usize::from(self.softening.is_some()))
    }

    /// The isochoric response with softening; both stresses and the tangent are multiplied by η.
    fn softened(&self, point: &RightCauchyGreen, history: &[f64], wants_tangent: bool) -> (ElasticResponse, Softening) {
        let mut out = self.energy.respond(point, wants_tangent);
        let Some(softening) = &self.softening else {
            return (out, Softening { factor: 1.0, slope: 0.0, energy: out.energy });
        };
        let softening = softening.at(out.energy, history[0]);
        out.tangent.as_flattened_mut().iter_mut().for_each(|entry| *entry *= softening.factor);
        if wants_tangent && softening.slope > 0.0 {
            let s = stress_vector::<6>(&out.stress);
            for (row, own) in out.tangent.iter_mut().zip(s) {
                row.iter_mut().zip(s).for_each(|(entry, other)| *entry += softening.slope * own * other);
            }
        }
        out.stress *= softening.factor;
        out.unprojected *= softening.factor;
        (out, softening)
    }

    /// Stress and tangent with all parts.
    fn respond(&self, c: Tensor, pressure: f64, step: Step<'_>, tangent: Option<&mut Matrix<6>>) -> Tensor {
        let point = RightCauchyGreen::new(c);
        let RightCauchyGreen { inverse, j, .. } = &point;
        let (of_softening, of_relaxation) = self.split(step.history);
        let (mut out, _) = self.softened(&point, of_softening, tangent.is_some());
        let mut weights = [[0.0; 2]; 2];
        let mut crossed = 0.0;
        let mut remembered = Tensor::zeros();
        if let Some(series) = &self.relaxation {
            let relaxation = series.step(of_relaxation, step.time, step.elastic);
            remembered = relaxation.remembered;
            let (shrink, third) = (j.powf(-2.0 / 3.0), remembered.dot(&c) / 3.0);
            out.stress = relaxation.factor * out.stress + shrink * (remembered - third * inverse);
            out.tangent.as_flattened_mut().iter_mut().for_each(|entry| *entry *= relaxation.factor);
            weights = [[2.0 / 3.0 * shrink * third, -2.0 / 3.0 * shrink], [-2.0 / 3.0 * shrink, 0.0]];
            crossed = shrink * third;
        }
        // ∂(q J K)/∂E with q = κ (J − 1), or the pressure that the element holds constant
        let (tension, slope) = match self.bulk {
            Some(_) if self.volume_of_element => (-pressure, 0.0),
            Some(bulk) => (bulk * (j - 1.0), bulk),
            None => (0.0, 0.0),
        };
        if let Some(tangent) = tangent {
            weights[0][0] += tension * j + slope * j * j;
            crossed -= tension * j;
            Products { tensors: [inverse, &remembered], weights, inverse, crossed, unit: 0.0 }.add_to(&mut out.tangent);
            *tangent = out.tangent;
        }
        out.stress + tension * *j * inverse
    }
}

/// History of a point before the step, and the step.
#[derive(Clone, Copy)]
struct Step<'a> {
    history: &'a [f64],
    time: [f64; 2],
    elastic: bool,
}

impl<'a> Step<'a> {
    fn of<const S: usize>(state: &StrainState<'a, S>) -> Self {
        Self { history: state.history, time: state.step, elastic: state.elastic }
    }
}

/// Places of the components of a law among the six.
fn components<const S: usize>() -> [usize; S] {
    let all: &[usize] = match S {
        3 => &[0, 1, 3],
        4 => &[0, 1, 2, 3],
        _ => &[0, 1, 2, 3, 4, 5],
    };
    std::array::from_fn(|at| all[at])
}

impl<const S: usize> ConstitutiveLaw<S> for Rubber {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let (c, step) = (right_cauchy_green(state), Step::of(state));
        let stress = match tangent {
            None => self.respond(c, state.pressure, step, None),
            Some(tangent) => {
                let mut all = [[0.0; 6]; 6];
                let stress = self.respond(c, state.pressure, step, Some(&mut all));
                let at = components::<S>();
                *tangent = at.map(|row| at.map(|column| all[row][column]));
                stress
            }
        };
        stress_vector(&stress)
    }

    /// The energy that can be recovered, without relaxation, and without the part of the volume where that is the element's.
    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        let point = RightCauchyGreen::new(right_cauchy_green(state));
        let (_, softening) = self.softened(&point, self.split(state.history).0, false);
        let bulk = self.bulk.filter(|_| !self.volume_of_element).unwrap_or(0.0);
        softening.energy + 0.5 * bulk * (point.j - 1.0) * (point.j - 1.0)
    }

    fn depends_on_time(&self) -> bool {
        self.relaxation.is_some()
    }

    fn bulk_of_element(&self) -> Option<f64> {
        self.bulk.filter(|_| self.volume_of_element)
    }

    fn leave_volume(&mut self) -> bool {
        self.volume_of_element = self.bulk.is_some();
        self.volume_of_element
    }

    fn history(&self) -> usize {
        usize::from(self.softening.is_some()) + self.relaxation.as_ref().map_or(0, PronySeries::history)
    }

    fn advance(&self, state: &StrainState<'_, S>, history: &mut [f64]) {
        if history.is_empty() || state.elastic {
            return;
        }
        let point = RightCauchyGreen::new(right_cauchy_green(state));
        let (of_softening, of_relaxation) = history.split_at_mut(usize::from(self.softening.is_some()));
        let (response, _) = self.softened(&point, of_softening, false);
        if let [largest] = of_softening {
            *largest = largest.max(response.energy);
        }
        if let Some(series) = &self.relaxation {
            series.advance(&response.unprojected, state.step, state.elastic, of_relaxation);
        }
    }

    fn internal(&self, state: &StrainState<'_, S>, variable: &str, out: &mut Vec<f64>) -> bool {
        if variable != "DAMAGE" || self.softening.is_none() {
            return false;
        }
        let point = RightCauchyGreen::new(right_cauchy_green(state));
        out.push(1.0 - self.softened(&point, self.split(state.history).0, false).1.factor);
        true
    }
}

/// Registers the laws of an energy in space, in plane strain and about an axis, and the energy itself:
/// `register!("BeginningOfName", energy, starts, "about", "constants", "source", constants…)`.
macro_rules! register_rubber {
    ($name:literal, $make:path, $starts:expr, $about:literal, $needs:literal, $source:literal, $($constant:literal),+) => {
        $crate::laws::rubber::register_rubber! { @ $name, $make, $starts, false, $about, $needs, $source,
            &[$($constant,)+ "BULK_MODULUS", "PRONY_SHARES", "PRONY_TIMES", "MULLINS_R", "MULLINS_M", "MULLINS_BETA"],
            &[$($constant),+] }
    };
    (@ $name:literal, $make:path, $starts:expr, $changes:literal, $about:literal, $needs:literal, $source:literal, $takes:expr, $constants:expr) => {
        const KIND: $crate::laws::rubber::EnergyKind =
            $crate::laws::rubber::EnergyKind { name: $name, constants: $constants, make: $make, starts: $starts, changes_volume: $changes };
        zelus_core::inventory::submit! { KIND }

        const _: () = { use $crate::laws::LawEntry; zelus_core::register! { LawEntry concat!($name, "3DLaw"),
            about: concat!($about, " for solids; ", $needs),
            source: $source,
            takes: $takes,
            warns: |properties, _| $crate::laws::rubber::Rubber::instability(properties),
            build: $crate::laws::LawFactory::Space(|properties| $crate::laws::rubber::Rubber::boxed::<6>(&KIND, properties)),
        } };

        const _: () = { use $crate::laws::LawEntry; zelus_core::register! { LawEntry concat!($name, "PlaneStrain2DLaw"),
            about: concat!($about, " in plane strain; ", $needs),
            source: $source,
            takes: $takes,
            warns: |properties, _| $crate::laws::rubber::Rubber::instability(properties),
            build: $crate::laws::LawFactory::PlaneStrain {
                plane: |properties| $crate::laws::rubber::Rubber::boxed::<3>(&KIND, properties),
                whole: |properties| $crate::laws::rubber::Rubber::boxed::<4>(&KIND, properties),
            },
        } };

        const _: () = { use $crate::laws::LawEntry; zelus_core::register! { LawEntry concat!($name, "Axisym2DLaw"),
            about: concat!($about, " with axial symmetry; ", $needs),
            source: $source,
            takes: $takes,
            warns: |properties, _| $crate::laws::rubber::Rubber::instability(properties),
            build: $crate::laws::LawFactory::Axisymmetric(|properties| $crate::laws::rubber::Rubber::boxed::<4>(&KIND, properties)),
        } };
    };
}

/// As [`register_rubber!`], of an energy that depends on J itself.
macro_rules! register_foam {
    ($name:literal, $make:path, $starts:expr, $about:literal, $needs:literal, $source:literal, $($constant:literal),+) => {
        $crate::laws::rubber::register_rubber! { @ $name, $make, $starts, true, $about, $needs, $source, &[$($constant),+], &[$($constant),+] }
    };
}

pub(super) use {register_foam, register_rubber};
