//! A user material for small strain: stress and tangent by a UMAT from the increment of strain since the last accepted step.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;
use zelus_core::register;
use zelus_structural_mechanics::laws::{ConstitutiveLaw, LawEntry, LawFactory, Matrix, StrainState};

use crate::arguments::{Arguments, COMPONENTS};
use crate::material::{CONSTANTS, PastPoint, UserMaterial, components, places};
use crate::tangent_check::{OF_UMAT, warning};

/// User material for small strain, with this number of components of stress.
struct SmallStrainUmat {
    material: UserMaterial,
    components: usize,
}

impl SmallStrainUmat {
    fn boxed<const S: usize>(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<S>>> {
        Ok(Box::new(Self { material: UserMaterial::of(properties)?, components: components::<S>() }))
    }

    fn plane_stress(properties: &Properties) -> Result<Box<dyn ConstitutiveLaw<3>>> {
        Ok(Box::new(Self { material: UserMaterial::of(properties)?, components: 3 }))
    }

    /// Strain in the order of the calling convention.
    fn strain<const S: usize>(&self, state: &StrainState<'_, S>) -> [f64; COMPONENTS] {
        let mut out = [0.0; COMPONENTS];
        places::<S>(self.components).into_iter().zip(state.strain).for_each(|(at, value)| out[at] = value);
        out
    }

    fn respond<const S: usize>(&self, state: &StrainState<'_, S>, keep: &mut dyn FnMut(&[f64])) -> Arguments<'_> {
        let past = PastPoint::of(state.history);
        let mut arguments = self.material.arguments(&past, self.components, state);
        let now = self.strain(state);
        arguments.increment = std::array::from_fn(|c| now[c] - past.strain[c]);
        self.material.call(&mut arguments, state.history, keep);
        arguments
    }

    /// The accepted stress, where nothing has changed since.
    fn accepted<const S: usize>(&self, state: &StrainState<'_, S>) -> Option<[f64; COMPONENTS]> {
        let past = PastPoint::of(state.history);
        (self.material.is_past(&past, state) && past.strain == self.strain(state)).then_some(past.stress)
    }
}

impl<const S: usize> ConstitutiveLaw<S> for SmallStrainUmat {
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let places = places::<S>(self.components);
        if let (None, Some(stress)) = (&tangent, self.accepted(state)) {
            return places.map(|at| stress[at]);
        }
        let arguments = self.respond(state, &mut |_| ());
        if let Some(tangent) = tangent {
            for (row, i) in tangent.iter_mut().zip(places) {
                for (entry, j) in row.iter_mut().zip(places) {
                    *entry = arguments.tangent[j * self.components + i];
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
        self.material.is_symmetric
    }

    fn expands(&self) -> bool {
        self.material.needs_temperature()
    }

    fn reads_point(&self) -> bool {
        true
    }

    fn depends_on_time(&self) -> bool {
        true
    }

    fn ignores_measure(&self, small: bool) -> bool {
        small
    }

    fn history(&self) -> usize {
        self.material.history()
    }

    fn advance(&self, state: &StrainState<'_, S>, history: &mut [f64]) {
        let mut states = Vec::new();
        let stress = self.respond(state, &mut |now| states.extend_from_slice(now)).stress;
        self.material.remember(&self.material.reached(state, stress, self.strain(state)), &states, history);
    }

    fn internal(&self, state: &StrainState<'_, S>, variable: &str, out: &mut Vec<f64>) -> bool {
        self.material.internal(state.history, variable, out)
    }
}

register! { LawEntry "SmallStrainUMAT3DLaw",
    about: "User material for solids of small strain: subroutine UMAT of the library UDSM_NAME; UMAT_PARAMETERS, STATE_VARIABLES",
    source: "calling convention of Abaqus' UMAT",
    build: LawFactory::Space(SmallStrainUmat::boxed::<6>),
    takes: CONSTANTS,
    warns: |properties, element| warning::<6>(properties, element, SmallStrainUmat::boxed, true, OF_UMAT),
}

register! { LawEntry "SmallStrainUMAT2DPlaneStrainLaw",
    about: "User material in plane strain: subroutine UMAT of the library UDSM_NAME; UMAT_PARAMETERS, STATE_VARIABLES",
    source: "calling convention of Abaqus' UMAT, with NTENS = 4",
    build: LawFactory::PlaneStrain { plane: SmallStrainUmat::boxed::<3>, whole: SmallStrainUmat::boxed::<4> },
    takes: CONSTANTS,
    warns: |properties, element| warning::<4>(properties, element, SmallStrainUmat::boxed, true, OF_UMAT),
}

register! { LawEntry "SmallStrainUMAT2DPlaneStressLaw",
    about: "User material in plane stress: subroutine UMAT of the library UDSM_NAME; UMAT_PARAMETERS, STATE_VARIABLES",
    source: "calling convention of Abaqus' UMAT, with NTENS = 3",
    build: LawFactory::PlaneStress(SmallStrainUmat::plane_stress),
    takes: CONSTANTS,
    warns: |properties, element| warning::<3>(properties, element, SmallStrainUmat::plane_stress, true, OF_UMAT),
}

register! { LawEntry "SmallStrainUMATAxisym2DLaw",
    about: "User material with axial symmetry: subroutine UMAT of the library UDSM_NAME; UMAT_PARAMETERS, STATE_VARIABLES",
    source: "calling convention of Abaqus' UMAT, with NTENS = 4",
    build: LawFactory::Axisymmetric(SmallStrainUmat::boxed::<4>),
    takes: CONSTANTS,
    warns: |properties, element| warning::<4>(properties, element, SmallStrainUmat::boxed, true, OF_UMAT),
}
