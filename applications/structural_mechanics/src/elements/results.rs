//! Results at Gauss points.
//!
//! Stresses follow the law (a LinearElastic law gives the same numbers for every measure). VON_MISES_STRESS is that of
//! the stress the formulation integrates; in the plane it takes in-plane components only, as in Kratos. Cauchy stress
//! and strains of axisymmetric elements have two zeros appended, as in Kratos.

use zelus_core::entities::Gauss;

use super::material::Material;
use crate::laws::{ConstitutiveLaw, PLASTIC_WORK, StrainState, StressMeasure};
use crate::tensor::{Tensor, strain_tensor, stress_tensor};

/// Names that the elements answer.
pub(super) const VARIABLES: &[&str] = &[
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
    "EQUIVALENT_CREEP_STRAIN",
    "CREEP_STRAIN_VECTOR",
    PLASTIC_WORK,
    "DAMAGE",
    "THRESHOLD",
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
    if let Some(stem) = variable.strip_suffix("_STRESS_VECTOR") {
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
            "VON_MISES_STRESS" => out.push(von_mises(&law.stress(state, measure, None))),
            _ => return None,
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

fn von_mises<const S: usize>(stress: &[f64; S]) -> f64 {
    let t = stress_tensor(stress);
    // with s_zz = 0 this is the plane formula sqrt(sx² − sx sy + sy² + 3 txy²)
    let normal = (t[(0, 0)] - t[(1, 1)]).powi(2) + (t[(1, 1)] - t[(2, 2)]).powi(2) + (t[(2, 2)] - t[(0, 0)]).powi(2);
    (0.5 * normal + 3.0 * (t[(0, 1)].powi(2) + t[(1, 2)].powi(2) + t[(0, 2)].powi(2))).sqrt()
}
