//! Results at Gauss points.
//!
//! Stresses follow the law (a LinearElastic law gives the same numbers for every measure). VON_MISES_STRESS is that of
//! the stress the formulation integrates; principal stresses, TRESCA_STRESS and HYDROSTATIC_PRESSURE are those of the Cauchy stress. In the
//! plane all of them take in-plane components only, as VON_MISES_STRESS does in Kratos, and 0 across the plane. Cauchy stress
//! and strains of axisymmetric elements have two zeros appended, as in Kratos.

use zelus_core::entities::Gauss;

use super::material::Material;
use crate::laws::{ConstitutiveLaw, PLASTIC_WORK, StrainState, StressMeasure};
use crate::stress_invariant::{StressInvariant, principal_stresses};
use crate::tensor::{Tensor, strain_tensor, stress_tensor};

/// Largest safety factor, that of material without stress.
const LARGEST_FACTOR: f64 = 1000.0;
const SAFETY_FACTOR: &str = "SAFETY_FACTOR";

/// Names that the elements answer with these materials: a safety factor where one of them has a yield stress.
pub(super) fn variables<const S: usize>(materials: &[Material<S>]) -> &'static [&'static str] {
    let last = VARIABLES.len() - 1;
    if materials.iter().any(|material| material.yield_stress.is_some()) { VARIABLES } else { &VARIABLES[..last] }
}

const VARIABLES: &[&str] = &[
    "CAUCHY_STRESS_VECTOR",
    "PK2_STRESS_VECTOR",
    "KIRCHHOFF_STRESS_VECTOR",
    "STRAIN",
    "GREEN_LAGRANGE_STRAIN_VECTOR",
    "ALMANSI_STRAIN_VECTOR",
    "CAUCHY_STRESS_TENSOR",
    "PK2_STRESS_TENSOR",
    "KIRCHHOFF_STRESS_TENSOR",
    "GREEN_LAGRANGE_STRAIN_TENSOR",
    "ALMANSI_STRAIN_TENSOR",
    "DEFORMATION_GRADIENT",
    "VON_MISES_STRESS",
    "STRAIN_ENERGY",
    "INTEGRATION_WEIGHT",
    "EQUIVALENT_PLASTIC_STRAIN",
    "ACCUMULATED_PLASTIC_STRAIN",
    "PLASTIC_STRAIN_VECTOR",
    "UNIAXIAL_STRESS",
    "BACK_STRESS_VECTOR",
    "STATE_VARIABLES",
    "EQUIVALENT_CREEP_STRAIN",
    "CREEP_STRAIN_VECTOR",
    PLASTIC_WORK,
    "DAMAGE",
    "THRESHOLD",
    "PRINCIPAL_CAUCHY_STRESS_VECTOR",
    "MAX_PRINCIPAL_STRESS",
    "MIN_PRINCIPAL_STRESS",
    "TRESCA_STRESS",
    "HYDROSTATIC_PRESSURE",
    SAFETY_FACTOR,
];

/// A variable at all Gauss points of one element; `None` when unknown or when the element is turned inside out.
///
/// `point` gives the strain of a point and the initial volume it stands for, per thickness. `measure` is that of the stress
/// the formulation integrates; the vectors of a `ring` end in two zeros.
pub(super) fn gauss<'a, const S: usize>(
    material: &Material<S>,
    measure: StressMeasure,
    ring: bool,
    variable: &str,
    point: &dyn Fn(usize) -> Option<(StrainState<'a, S>, f64)>,
) -> Option<Gauss> {
    let mut out = Gauss::default();
    for g in 0..material.rule.len() {
        let (state, weight) = point(g)?;
        match variable {
            "INTEGRATION_WEIGHT" => out.values.push(weight * material.thickness),
            SAFETY_FACTOR => {
                let stress = von_mises(material.law.as_ref(), &state, measure);
                out.values.push((material.yield_stress? / stress).min(LARGEST_FACTOR));
            }
            _ => value(material.law.as_ref(), &state, measure, ring, variable, &mut out.values)?,
        }
        out.weights.push(weight);
        out.shape.extend_from_slice(material.rule.n_at(g));
    }
    out.components = out.values.len() / material.rule.len();
    Some(out)
}

/// Appends a variable of one Gauss point; `None` when unknown.
fn value<const S: usize>(
    law: &dyn ConstitutiveLaw<S>,
    state: &StrainState<'_, S>,
    measure: StressMeasure,
    ring: bool,
    variable: &str,
    out: &mut Vec<f64>,
) -> Option<()> {
    if law.internal(state, variable, out) {
        return Some(());
    }
    let cauchy = || stress_tensor(&law.stress(state, StressMeasure::Cauchy, None));
    if variable == "PRINCIPAL_CAUCHY_STRESS_VECTOR" {
        out.extend(principal_stresses(&cauchy()));
    } else if let Some(stem) = variable.strip_suffix("_STRESS_VECTOR") {
        vector(&stress(law, state, stem)?, ring, out);
    } else if let Some(stem) = variable.strip_suffix("_STRESS_TENSOR") {
        tensor::<S>(&stress_tensor(&stress(law, state, stem)?), out);
    } else if let Some(stem) = variable.strip_suffix("_STRAIN_VECTOR") {
        vector(&strain(law, state, stem)?, ring, out);
    } else if let Some(stem) = variable.strip_suffix("_STRAIN_TENSOR") {
        tensor::<S>(&strain_tensor(&strain(law, state, stem)?), out);
    } else {
        match variable {
            "STRAIN" => vector(&state.strain, ring, out),
            "DEFORMATION_GRADIENT" => tensor::<S>(&state.f, out),
            "STRAIN_ENERGY" => out.push(law.energy(state)),
            "VON_MISES_STRESS" => out.push(von_mises(law, state, measure)),
            _ => out.push(StressInvariant::named(variable)?.of(&cauchy())),
        }
    }
    Some(())
}

fn stress<const S: usize>(law: &dyn ConstitutiveLaw<S>, state: &StrainState<'_, S>, stem: &str) -> Option<[f64; S]> {
    Some(match stem {
        "PK2" => law.stress(state, StressMeasure::Pk2, None),
        "CAUCHY" => law.stress(state, StressMeasure::Cauchy, None),
        "KIRCHHOFF" => {
            let factor = if law.ignores_measure(state.small) { 1.0 } else { state.det_f };
            law.stress(state, StressMeasure::Cauchy, None).map(|s| factor * s)
        }
        _ => return None,
    })
}

fn strain<const S: usize>(law: &dyn ConstitutiveLaw<S>, state: &StrainState<'_, S>, stem: &str) -> Option<[f64; S]> {
    match stem {
        "GREEN_LAGRANGE" => Some(state.strain),
        "ALMANSI" => Some(law.almansi(state)),
        _ => None,
    }
}

fn vector<const S: usize>(values: &[f64; S], ring: bool, out: &mut Vec<f64>) {
    out.extend_from_slice(values);
    if ring {
        out.extend_from_slice(&[0.0; 2]);
    }
}

fn tensor<const S: usize>(values: &Tensor, out: &mut Vec<f64>) {
    let dim = if S == 3 { 2 } else { 3 };
    (0..dim).for_each(|i| out.extend((0..dim).map(|j| values[(i, j)])));
}

fn von_mises<const S: usize>(law: &dyn ConstitutiveLaw<S>, state: &StrainState<'_, S>, measure: StressMeasure) -> f64 {
    StressInvariant::VonMises.of(&stress_tensor(&law.stress(state, measure, None)))
}
