//! A user material for small strain: stress and tangent by a UMAT from the increment of strain since the last accepted step.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;
use zelus_core::register;
use zelus_structural_mechanics::laws::{ConstitutiveLaw, LawEntry, LawFactory, Matrix, StrainState};

use crate::arguments::{Arguments, COMPONENTS};
use crate::material::{PastPoint, UserMaterial, components, places};
use crate::tangent_check::warning;

/// User material for small strain.
struct SmallStrainUmat(UserMaterial);

/// Strain in the order of the calling convention.
fn strain<const S: usize>(state: &StrainState<'_, S>) -> [f64; COMPONENTS] {
    let mut out = [0.0; COMPONENTS];
    places::<S>().into_iter().zip(state.strain).for_each(|(at, value)| out[at] = value);
    out
}

impl SmallStrainUmat {
    fn boxed<const S: usize>(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>> {
        Ok(Box::new(Self(UserMaterial::of(properties)?)))
    }

    fn respond<const S: usize>(&self, state: &StrainState<'_, S>, keep: &mut dyn FnMut(&[f64])) -> Arguments<'_> {
        let past = PastPoint::of(state.history);
        let mut arguments = self.0.arguments(&past, components::<S>(), state.step, state.place);
        let now = strain(state);
        arguments.increment = std::array::from_fn(|c| now[c] - past.strain[c]);
        self.0.call(&mut arguments, state.history, keep);
        arguments
    }

    /// The accepted stress, where no time has passed since.
    fn accepted<const S: usize>(state: &StrainState<'_, S>) -> Option<[f64; COMPONENTS]> {
        let past = PastPoint::of(state.history);
        past.time.filter(|time| *time >= state.step[1] && past.strain == strain(state)).map(|_| past.stress)
    }
}

impl<const S: usize> ConstitutiveLaw<S> for SmallStrainUmat {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let places = places::<S>();
        if let (None, Some(stress)) = (&tangent, Self::accepted(state)) {
            return places.map(|at| stress[at]);
        }
        let arguments = self.respond(state, &mut |_| ());
        if let Some(tangent) = tangent {
            for (row, i) in tangent.iter_mut().zip(places) {
                for (entry, j) in row.iter_mut().zip(places) {
                    *entry = arguments.tangent[j * components::<S>() + i];
                }
            }
        }
        places.map(|at| arguments.stress[at])
    }

    /// SSE of the routine.
    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        self.respond(state, &mut |_| ()).energies[0]
    }

    fn is_symmetric(&self, _small: bool) -> bool {
        self.0.is_symmetric
    }

    fn depends_on_time(&self) -> bool {
        true
    }

    fn ignores_measure(&self, small: bool) -> bool {
        small
    }

    fn history(&self) -> usize {
        self.0.history()
    }

    fn advance(&self, state: &StrainState<'_, S>, history: &mut [f64]) {
        let mut states = Vec::new();
        let stress = self.respond(state, &mut |now| states.extend_from_slice(now)).stress;
        let past = PastPoint::of(state.history);
        let point = PastPoint { stress, strain: strain(state), time: Some(state.step[1]), ..past };
        self.0.remember(&point, &states, history);
    }

    fn internal(&self, state: &StrainState<'_, S>, variable: &str, out: &mut Vec<f64>) -> bool {
        self.0.internal(state.history, variable, out)
    }
}

register! { LawEntry "SmallStrainUMAT3DLaw",
    about: "User material for solids of small strain: subroutine UMAT of the library UDSM_NAME; UMAT_PARAMETERS, STATE_VARIABLES",
    source: "calling convention of Abaqus' UMAT",
    build: LawFactory::Space(SmallStrainUmat::boxed::<6>),
    warns: |properties, element| warning::<6>(properties, element, SmallStrainUmat::boxed, true),
}

register! { LawEntry "SmallStrainUMAT2DPlaneStrainLaw",
    about: "User material in plane strain: subroutine UMAT of the library UDSM_NAME; UMAT_PARAMETERS, STATE_VARIABLES",
    source: "calling convention of Abaqus' UMAT, with NTENS = 4",
    build: LawFactory::PlaneStrain { plane: SmallStrainUmat::boxed::<3>, whole: SmallStrainUmat::boxed::<4> },
    warns: |properties, element| warning::<4>(properties, element, SmallStrainUmat::boxed, true),
}

register! { LawEntry "SmallStrainUMATAxisym2DLaw",
    about: "User material with axial symmetry: subroutine UMAT of the library UDSM_NAME; UMAT_PARAMETERS, STATE_VARIABLES",
    source: "calling convention of Abaqus' UMAT, with NTENS = 4",
    build: LawFactory::Axisymmetric(SmallStrainUmat::boxed::<4>),
    warns: |properties, element| warning::<4>(properties, element, SmallStrainUmat::boxed, true),
}
