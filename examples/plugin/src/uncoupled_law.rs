//! A planar law whose directions know nothing of each other: σ = E ε, τ = E/2 γ.

use zelus::structural_mechanics::laws::{ConstitutiveLaw, LawEntry, LawFactory, Matrix, StrainState};
use zelus_core::register;

struct Uncoupled {
    young: f64,
}

impl Uncoupled {
    fn moduli(&self) -> [f64; 3] {
        [self.young, self.young, 0.5 * self.young]
    }
}

impl ConstitutiveLaw<3> for Uncoupled {
    fn pk2(&self, state: &StrainState<'_, 3>, tangent: Option<&mut Matrix<3>>) -> [f64; 3] {
        let moduli = self.moduli();
        if let Some(tangent) = tangent {
            *tangent = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { moduli[i] } else { 0.0 }));
        }
        std::array::from_fn(|i| moduli[i] * state.strain[i])
    }

    fn energy(&self, state: &StrainState<'_, 3>) -> f64 {
        self.moduli().iter().zip(state.strain).map(|(modulus, strain)| 0.5 * modulus * strain * strain).sum()
    }

    fn is_linear(&self) -> bool {
        true
    }
}

register! { LawEntry "UncoupledPlaneStress2DLaw",
    about: "stresses from their own strains alone; needs YOUNG_MODULUS",
    source: "σ = E ε, τ = E/2 γ",
    build: LawFactory::PlaneStress(|properties| Ok(Box::new(Uncoupled { young: properties.require("YOUNG_MODULUS")? }))),
}
