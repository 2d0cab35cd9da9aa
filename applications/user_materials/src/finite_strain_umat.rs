//! A user material for finite strain: Cauchy stress by a UMAT from the deformation gradients of the step.
//!
//! With L = (F₁ − F₀) (½ F₀ + ½ F₁)⁻¹ the increment of strain is D = sym L, and the rotation of the step (1 − ½ W)⁻¹ (1 + ½ W) with
//! W = skw L (Hughes and Winget, 1980). Stress and strain of the start are rotated before the call. The routine's tangent C belongs to Jaumann's
//! rate of Kirchhoff stress, J C : D; Truesdell's has C − ½ (δ_ik σ_jl + δ_il σ_jk + σ_ik δ_jl + σ_il δ_jk), and pulled back it is dS/dE.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;
use zelus_core::register;
use zelus_structural_mechanics::laws::{ConstitutiveLaw, LawEntry, LawFactory, Matrix, StrainState};
use zelus_structural_mechanics::tensor::{IDENTITY, Tensor, congruent, inverse, pairs, push_forward};

use crate::arguments::{Arguments, COMPONENTS};
use crate::material::{CONSTANTS, PAIRS, PastPoint, UserMaterial, components, tensor, vector};
use crate::tangent_check::{OF_UMAT, warning};

/// User material for finite strain.
struct FiniteStrainUmat(UserMaterial);

/// Increment of strain and rotation from one deformation gradient to another.
fn increment(before: &Tensor, now: &Tensor) -> [Tensor; 2] {
    let rate = (now - before) * inverse(&(0.5 * (before + now)));
    let (strain, spin) = (0.5 * (rate + rate.transpose()), 0.5 * (rate - rate.transpose()));
    [strain, inverse(&(IDENTITY - 0.5 * spin)) * (IDENTITY + 0.5 * spin)]
}

fn columns(tensor: &Tensor) -> [f64; 9] {
    std::array::from_fn(|at| tensor.as_slice()[at])
}

impl FiniteStrainUmat {
    fn boxed<const S: usize>(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>> {
        Ok(Box::new(Self(UserMaterial::of(properties)?)))
    }

    fn respond<const S: usize>(&self, state: &StrainState<'_, S>, keep: &mut dyn FnMut(&[f64])) -> Arguments<'_> {
        let past = PastPoint::of(state.history);
        let [strain, rotation] = increment(&past.gradient, &state.f);
        let rotated = PastPoint {
            stress: vector(&congruent(&rotation, &tensor(&past.stress, 1.0)), 1.0),
            strain: vector(&congruent(&rotation, &tensor(&past.strain, 0.5)), 2.0),
            ..past
        };
        let mut arguments = self.0.arguments(&rotated, components::<S>(), state);
        arguments.increment = vector(&strain, 2.0);
        arguments.gradients = [columns(&past.gradient), columns(&state.f)];
        arguments.rotation = columns(&rotation);
        self.0.call(&mut arguments, state.history, keep);
        arguments
    }

    /// The accepted stress, where nothing has changed since.
    fn accepted<const S: usize>(&self, state: &StrainState<'_, S>) -> Option<[f64; COMPONENTS]> {
        let past = PastPoint::of(state.history);
        (self.0.is_past(&past, state) && past.gradient == state.f).then_some(past.stress)
    }
}

/// dσ/dD by Truesdell's rate, from that by Jaumann's.
fn truesdell<const S: usize>(arguments: &Arguments<'_>, stress: &Tensor) -> Matrix<S> {
    let at = |pair: (usize, usize)| {
        let sorted = (pair.0.min(pair.1), pair.0.max(pair.1));
        PAIRS.iter().position(|known| *known == sorted).unwrap_or(0)
    };
    let unit = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
    pairs::<S>().map(|(i, j)| {
        pairs::<S>().map(|(k, l)| {
            let rotated = unit(i, k) * stress[(j, l)]
                + unit(i, l) * stress[(j, k)]
                + stress[(i, k)] * unit(j, l)
                + stress[(i, l)] * unit(j, k);
            arguments.tangent[at((k, l)) * components::<S>() + at((i, j))] - 0.5 * rotated
        })
    })
}

impl<const S: usize> ConstitutiveLaw<S> for FiniteStrainUmat {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let back = inverse(&state.f);
        let pulled = |stress: &Tensor| {
            let stress = state.det_f * congruent(&back, stress);
            pairs::<S>().map(|pair| stress[pair])
        };
        if let (None, Some(stress)) = (&tangent, self.accepted(state)) {
            return pulled(&tensor(&stress, 1.0));
        }
        let arguments = self.respond(state, &mut |_| ());
        let stress = tensor(&arguments.stress, 1.0);
        if let Some(tangent) = tangent {
            *tangent = push_forward(&truesdell::<S>(&arguments, &stress), &back, state.det_f.recip());
        }
        pulled(&stress)
    }

    /// SSE of the routine, per initial volume.
    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        state.det_f * self.respond(state, &mut |_| ()).energies[0]
    }

    fn is_symmetric(&self, _small: bool) -> bool {
        self.0.is_symmetric
    }

    fn expands(&self) -> bool {
        self.0.needs_temperature()
    }

    fn reads_point(&self) -> bool {
        true
    }

    fn depends_on_time(&self) -> bool {
        true
    }

    fn history(&self) -> usize {
        self.0.history()
    }

    fn advance(&self, state: &StrainState<'_, S>, history: &mut [f64]) {
        let mut states = Vec::new();
        let arguments = self.respond(state, &mut |now| states.extend_from_slice(now));
        let strain = std::array::from_fn(|c| arguments.strain[c] + arguments.increment[c]);
        self.0.remember(&self.0.reached(state, arguments.stress, strain), &states, history);
    }

    fn internal(&self, state: &StrainState<'_, S>, variable: &str, out: &mut Vec<f64>) -> bool {
        self.0.internal(state.history, variable, out)
    }
}

register! { LawEntry "FiniteStrainUMAT3DLaw",
    about: "User material for solids of finite strain: subroutine UMAT of the library UDSM_NAME; UMAT_PARAMETERS, STATE_VARIABLES",
    source: "calling convention of Abaqus' UMAT",
    build: LawFactory::Space(FiniteStrainUmat::boxed::<6>),
    takes: CONSTANTS,
    warns: |properties, element| warning::<6>(properties, element, FiniteStrainUmat::boxed, false, OF_UMAT),
}

register! { LawEntry "FiniteStrainUMAT2DPlaneStrainLaw",
    about: "User material of finite strain in plane strain: subroutine UMAT of the library UDSM_NAME; UMAT_PARAMETERS, STATE_VARIABLES",
    source: "calling convention of Abaqus' UMAT, with NTENS = 4",
    build: LawFactory::PlaneStrain { plane: FiniteStrainUmat::boxed::<3>, whole: FiniteStrainUmat::boxed::<4> },
    takes: CONSTANTS,
    warns: |properties, element| warning::<4>(properties, element, FiniteStrainUmat::boxed, false, OF_UMAT),
}

register! { LawEntry "FiniteStrainUMATAxisym2DLaw",
    about: "User material of finite strain with axial symmetry: subroutine UMAT of the library UDSM_NAME; UMAT_PARAMETERS, STATE_VARIABLES",
    source: "calling convention of Abaqus' UMAT, with NTENS = 4",
    build: LawFactory::Axisymmetric(FiniteStrainUmat::boxed::<4>),
    takes: CONSTANTS,
    warns: |properties, element| warning::<4>(properties, element, FiniteStrainUmat::boxed, false, OF_UMAT),
}
