//! Isotropic damage under small strain: σ = (1 − d) σ̄, σ̄ = D(T) (ε − α(T) (T − T₀) 1).
//!
//! With the equivalent stress q of σ̄, κ is the largest q/σ_y(T) so far, from 1 on. Softening over a band of the width l, the
//! element's, takes the fracture energy G by area of the crack, whatever the mesh: exponential, d = 1 − exp(A (1 − κ))/κ with 1/A = G
//! E/(l σ_y²) − ½; linear, d = (1 − 1/κ)/(1 − l σ_y²/(2 E G)). d does not fall and stays below 1, so that a broken point still holds
//! its nodes in place.
//!
//! The history of a point is κ and d.
//!
//! As in Kratos, where asked for: d stays below 0.99999, κ is q σ_y(T₀)/σ_y(T)² in the formulas of d alone, and stress across the plane does not count.

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::Properties;
use zelus_core::register;

use super::elastic::{Elasticity, multiply, quadratic_energy};
use super::equivalent_stress::EquivalentStress;
use super::expansion::{Expansion, in_form, without};
use super::law::{ConstitutiveLaw, LawEntry, LawFactory, Matrix, StrainState};
use super::quantity::Quantity;
use crate::tensor::{Tensor, pairs, stress_tensor};

/// The largest damage: the remaining stiffness takes no energy that counts, however small elements are.
const MOST: f64 = 1.0 - 1e-8;
/// Kratos' most damage.
const MOST_OF_KRATOS: f64 = 0.99999;
/// Excess of κ that still counts as elastic: round-off of accepted states.
const ON_SURFACE: f64 = 1e-12;

/// How strength falls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Softening {
    Linear,
    Exponential,
}

/// The law; `STRESS_FREE` across the plane.
#[derive(Debug, Clone, PartialEq)]
pub struct IsotropicDamage<const S: usize, const STRESS_FREE: bool> {
    measure: EquivalentStress,
    young: Quantity,
    poisson: f64,
    strength: Quantity,
    fracture_energy: Quantity,
    softening: Softening,
    expansion: Option<Expansion>,
}

/// A state as if nothing grew.
struct TrialDamage<const S: usize> {
    d: Matrix<S>,
    /// The strain without its thermal part.
    strain: [f64; S],
    /// σ̄.
    stress: [f64; S],
    /// q/σ_y.
    ratio: f64,
    /// Its derivative with respect to the strain.
    by_strain: [f64; S],
}

impl<const S: usize, const STRESS_FREE: bool> IsotropicDamage<S, STRESS_FREE> {
    /// # Errors
    /// Constants that are missing or out of range.
    fn new(properties: &Properties, measure: EquivalentStress, expands: bool) -> Result<Self> {
        let Elasticity { poisson, .. } = Elasticity::of(properties)?;
        let has =
            |name: &str| properties.number(name).is_some() || properties.table_over("TEMPERATURE", name).is_some();
        let strength = if has("YIELD_STRESS") { "YIELD_STRESS" } else { "YIELD_STRESS_TENSION" };
        let strength = if has(strength) { strength } else { "YIELD_STRESS" };
        let softening = match properties.require("SOFTENING_TYPE")? {
            0.0 => Softening::Linear,
            1.0 => Softening::Exponential,
            other => {
                let fact = format!("SOFTENING_TYPE {other} of properties {} is not there", properties.id);
                let problem = Diagnostic::error("softening", fact).at(properties.place.clone());
                return Err(problem.remedy("use 0 (linear) or 1 (exponential)").into());
            }
        };
        Ok(Self {
            measure,
            young: Quantity::positive(properties, "YOUNG_MODULUS")?,
            poisson,
            strength: Quantity::positive(properties, strength)?,
            fracture_energy: Quantity::positive(properties, "FRACTURE_ENERGY")?,
            softening,
            expansion: if expands { Some(Expansion::of(properties)?) } else { None },
        })
    }

    /// l σ_y²/(E G) at a temperature.
    fn brittleness(&self, band: f64, t: f64) -> f64 {
        band * self.strength.at(t).powi(2) / (self.young.at(t) * self.fracture_energy.at(t))
    }

    /// Damage at κ, and its slope.
    fn damage(&self, state: &StrainState<'_, S>, ratio: f64) -> (f64, f64) {
        let t = state.temperature;
        let stretch = match &self.expansion {
            Some(own) if state.band_as_kratos => self.strength.at(own.reference()) / self.strength.at(t),
            _ => 1.0,
        };
        let most = if state.band_as_kratos { MOST_OF_KRATOS } else { MOST };
        let kappa = ratio * stretch;
        let brittleness = self.brittleness(state.band, t);
        if brittleness >= 2.0 {
            return (most, 0.0);
        }
        let (d, slope) = match self.softening {
            Softening::Exponential => {
                let a = 1.0 / (1.0 / brittleness - 0.5);
                let left = (a * (1.0 - kappa)).exp() / kappa;
                (1.0 - left, left * (1.0 / kappa + a))
            }
            Softening::Linear => {
                let all = 1.0 - 0.5 * brittleness;
                ((1.0 - 1.0 / kappa) / all, 1.0 / (kappa * kappa * all))
            }
        };
        if d < most { (d.max(0.0), slope * stretch) } else { (most, 0.0) }
    }

    /// Damage now, its slope by κ where it grows, and κ.
    fn grown(&self, state: &StrainState<'_, S>, ratio: f64) -> (f64, f64, f64) {
        let &[kappa, d] = state.history else { unreachable!("damage remembers two numbers") };
        let kappa = kappa.max(1.0);
        if state.elastic || ratio <= kappa * (1.0 + ON_SURFACE) || ratio.is_nan() {
            return (d, 0.0, kappa);
        }
        let (now, slope) = self.damage(state, ratio);
        if now > d { (now, slope, ratio) } else { (d, 0.0, ratio) }
    }

    fn trial(&self, state: &StrainState<'_, S>) -> TrialDamage<S> {
        let t = state.temperature;
        let elasticity = Elasticity { young: self.young.at(t), poisson: self.poisson };
        let free = self.expansion.as_ref().map_or(0.0, |own| own.strain(t));
        let strain = without(state.strain, in_form::<S>(free, self.poisson, STRESS_FREE));
        let d = elasticity.in_form(STRESS_FREE);
        let stress = multiply(&d, &strain);
        // Stress across the plane in plane strain.
        let across = S == 3 && !STRESS_FREE && !state.band_as_kratos;
        let mut whole: Tensor = stress_tensor(&stress);
        if across {
            whole[(2, 2)] = self.poisson * (stress[0] + stress[1]) - elasticity.young * free;
        }
        let (q, normal) = self.measure.of(&whole);
        let mut by_stress = pairs::<S>().map(|(i, j)| if i == j { normal[(i, j)] } else { 2.0 * normal[(i, j)] });
        if across {
            by_stress[..2].iter_mut().for_each(|by| *by += self.poisson * normal[(2, 2)]);
        }
        let strength = self.strength.at(t);
        let by_strain = multiply(&d, &by_stress).map(|by| by / strength);
        TrialDamage { d, strain, stress, ratio: q / strength, by_strain }
    }
}

impl<const S: usize, const STRESS_FREE: bool> ConstitutiveLaw<S> for IsotropicDamage<S, STRESS_FREE> {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let trial = self.trial(state);
        let (damage, slope, _) = self.grown(state, trial.ratio);
        if let Some(tangent) = tangent {
            for (i, row) in tangent.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    *entry = (1.0 - damage) * trial.d[i][j] - slope * trial.stress[i] * trial.by_strain[j];
                }
            }
        }
        trial.stress.map(|s| (1.0 - damage) * s)
    }

    /// (1 − d) times that of Hooke's law.
    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        let trial = self.trial(state);
        let (damage, ..) = self.grown(state, trial.ratio);
        (1.0 - damage) * quadratic_energy(&trial.d, &trial.strain)
    }

    fn is_symmetric(&self, _small: bool) -> bool {
        false
    }

    fn expands(&self) -> bool {
        self.expansion.is_some() || [&self.young, &self.strength, &self.fracture_energy].iter().any(|own| own.varies())
    }

    fn softens(&self) -> bool {
        true
    }

    fn widest_band(&self) -> f64 {
        let t = self.expansion.as_ref().map_or(0.0, |own| own.reference());
        2.0 / self.brittleness(1.0, t)
    }

    fn ignores_measure(&self, small: bool) -> bool {
        small
    }

    fn history(&self) -> usize {
        2
    }

    fn advance(&self, state: &StrainState<'_, S>, history: &mut [f64]) {
        let (damage, _, kappa) = self.grown(state, self.trial(state).ratio);
        history.copy_from_slice(&[kappa, damage]);
    }

    fn internal(&self, state: &StrainState<'_, S>, variable: &str, out: &mut Vec<f64>) -> bool {
        let strength = self.strength.at(state.temperature);
        match variable {
            "DAMAGE" => out.push(state.history[1]),
            "THRESHOLD" => out.push(strength * state.history[0].max(1.0)),
            "UNIAXIAL_STRESS" => out.push(strength * self.trial(state).ratio),
            _ => return false,
        }
        true
    }
}

/// Constants that laws of damage take.
const CONSTANTS: &[&str] = &["YIELD_STRESS", "YIELD_STRESS_TENSION", "FRACTURE_ENERGY", "SOFTENING_TYPE"];

/// Constants that laws of damage with expansion take.
const EXPANDING_CONSTANTS: &[&str] = &[
    "YIELD_STRESS",
    "YIELD_STRESS_TENSION",
    "FRACTURE_ENERGY",
    "SOFTENING_TYPE",
    "THERMAL_EXPANSION_COEFFICIENT",
    "REFERENCE_TEMPERATURE",
];

/// Registers the laws of an equivalent stress, with and without expansion.
macro_rules! damage {
    ($($surface:ident, $word:literal;)+) => {
        $(
            damage! { @forms "SmallStrainIsotropicDamage", $surface, $word, false, CONSTANTS,
                "constants YOUNG_MODULUS, POISSON_RATIO, YIELD_STRESS, FRACTURE_ENERGY, SOFTENING_TYPE 0 (linear) or 1 (exponential)" }
            damage! { @forms "SmallStrainThermalIsotropicDamage", $surface, $word, true, EXPANDING_CONSTANTS,
                "thermal expansion; constants of SmallStrainIsotropicDamage, THERMAL_EXPANSION_COEFFICIENT, REFERENCE_TEMPERATURE; reads tables over TEMPERATURE" }
        )+
    };
    (@forms $name:literal, $surface:ident, $word:literal, $expands:literal, $takes:expr, $needs:literal) => {
        register! { LawEntry concat!($name, "3D", stringify!($surface)),
            about: concat!("damage of solids by ", $word, "; ", $needs),
            source: "σ = (1 − d) D ε; the energy of the crack is FRACTURE_ENERGY by area; Oliver 1989",
            takes: $takes,
            build: LawFactory::Space(|properties| Ok(Box::new(IsotropicDamage::<6, false>::new(properties, EquivalentStress::$surface, $expands)?))),
        }
        register! { LawEntry concat!($name, "PlaneStrain", stringify!($surface)),
            about: concat!("damage in plane strain by ", $word, "; ", $needs),
            source: "σ = (1 − d) D ε with ε_zz = 0; the energy of the crack is FRACTURE_ENERGY by area; Oliver 1989",
            takes: $takes,
            build: LawFactory::PlaneStrain {
                plane: |properties| Ok(Box::new(IsotropicDamage::<3, false>::new(properties, EquivalentStress::$surface, $expands)?)),
                whole: |properties| Ok(Box::new(IsotropicDamage::<4, false>::new(properties, EquivalentStress::$surface, $expands)?)),
            },
        }
        register! { LawEntry concat!($name, "PlaneStress", stringify!($surface)),
            about: concat!("damage in plane stress by ", $word, "; ", $needs),
            source: "σ = (1 − d) D ε with σ_zz = 0; the energy of the crack is FRACTURE_ENERGY by area; Oliver 1989",
            takes: $takes,
            build: LawFactory::PlaneStress(|properties| Ok(Box::new(IsotropicDamage::<3, true>::new(properties, EquivalentStress::$surface, $expands)?))),
        }
    };
}

damage! {
    VonMises, "the stress of von Mises";
    Rankine, "the largest principal stress";
    Tresca, "the largest shear stress";
}
