//! Laws that expand: any other law, of the deformation that is not thermal.
//!
//! Under small strain ε_m = ε − α(T) (T − T₀) 1 and σ = σ(ε_m). Where the strain is Green–Lagrange's, F = θ F_m with θ = 1 + α (T − T₀)
//! (Lu and Pister, 1975), so that E_m = (E − ½ (θ² − 1) 1)/θ²; the energy is stored by the volume that has expanded, θ³ times the
//! initial one, hence S = θ S_m(E_m) and dS/dE = dS_m/dE_m / θ. Under plane stress the thickness expands, too; under plane strain it is
//! held, and the mechanical strain across the plane compensates for the thermal one. The energy is by initial volume.
//!
//! α may follow a table over TEMPERATURE; other constants do where the law itself reads tables, as that of creep does.

use zelus_core::diagnostics::Result;
use zelus_core::model::Properties;
use zelus_core::register;
use zelus_core::registry::require;

use super::bar_law::BarLaw;
use super::expansion::{self, Expansion, without};
use super::law::{ConstitutiveLaw, LawEntry, LawFactory, MakesLaw, Matrix, StrainState};
use super::small_strain_plasticity::PLASTIC_WORK;
use crate::tensor::Tensor;

/// Components of plane strain among those with the strain across the plane.
const IN_PLANE: [usize; 3] = [0, 1, 3];

/// The state without its thermal part, and the factors of stress and tangent.
fn mechanical<'a, const S: usize>(state: &StrainState<'a, S>, thermal: f64) -> (StrainState<'a, S>, [f64; 2]) {
    let mut inner = *state;
    if state.small {
        inner.strain = without(state.strain, thermal);
        inner.f = state.f - thermal * Tensor::identity();
        inner.det_f = inner.f.determinant();
        return (inner, [1.0; 2]);
    }
    let stretch = 1.0 + thermal;
    let square = stretch * stretch;
    inner.strain = without(state.strain, 0.5 * (square - 1.0)).map(|strain| strain / square);
    inner.f = state.f / stretch;
    inner.det_f = state.det_f / (square * stretch);
    (inner, [stretch, 1.0 / stretch])
}

/// A law of the deformation that is not thermal.
struct Expanding<const S: usize> {
    law: Box<dyn ConstitutiveLaw<S>>,
    expansion: Expansion,
}

impl<const S: usize> Expanding<S> {
    fn inner<'a>(&self, state: &StrainState<'a, S>) -> (StrainState<'a, S>, [f64; 2], f64) {
        let thermal = self.expansion.strain(state.temperature);
        let (inner, factors) = mechanical(state, thermal);
        (inner, factors, if state.small { 1.0 } else { self.free_volume(state.temperature) })
    }
}

impl<const S: usize> ConstitutiveLaw<S> for Expanding<S> {
    fn pk2(&self, state: &StrainState<'_, S>, mut tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        let (inner, [of_stress, of_tangent], _) = self.inner(state);
        let stress = self.law.pk2(&inner, tangent.as_deref_mut());
        tangent.into_iter().flatten().flatten().for_each(|entry| *entry *= of_tangent);
        stress.map(|stress| of_stress * stress)
    }

    fn energy(&self, state: &StrainState<'_, S>) -> f64 {
        let (inner, _, volume) = self.inner(state);
        volume * self.law.energy(&inner)
    }

    fn is_symmetric(&self, small: bool) -> bool {
        self.law.is_symmetric(small)
    }

    fn bulk_of_element(&self) -> Option<f64> {
        self.law.bulk_of_element()
    }

    fn leave_volume(&mut self) -> bool {
        self.law.leave_volume()
    }

    fn free_volume(&self, temperature: f64) -> f64 {
        (1.0 + self.expansion.strain(temperature)).powi(3)
    }

    fn expands(&self) -> bool {
        true
    }

    fn depends_on_time(&self) -> bool {
        self.law.depends_on_time()
    }

    fn has_axes(&self) -> bool {
        self.law.has_axes()
    }

    fn history(&self) -> usize {
        self.law.history()
    }

    fn advance(&self, state: &StrainState<'_, S>, history: &mut [f64]) {
        self.law.advance(&self.inner(state).0, history);
    }

    fn internal(&self, state: &StrainState<'_, S>, variable: &str, out: &mut Vec<f64>) -> bool {
        let (inner, _, volume) = self.inner(state);
        let begin = out.len();
        let knows = self.law.internal(&inner, variable, out);
        if variable == PLASTIC_WORK {
            out[begin..].iter_mut().for_each(|work| *work *= volume);
        }
        knows
    }

    fn ignores_measure(&self, small: bool) -> bool {
        small && self.law.ignores_measure(small)
    }

    fn almansi(&self, state: &StrainState<'_, S>) -> [f64; S] {
        self.law.almansi(state)
    }
}

/// A law of plane strain of the deformation that is not thermal, which has a part across the plane.
struct ExpandingPlane(Expanding<4>);

impl ExpandingPlane {
    fn whole<'a>(state: &StrainState<'a, 3>) -> StrainState<'a, 4> {
        let [xx, yy, xy] = state.strain;
        state.with_strain([xx, yy, 0.0, xy])
    }
}

impl ConstitutiveLaw<3> for ExpandingPlane {
    fn pk2(&self, state: &StrainState<'_, 3>, tangent: Option<&mut Matrix<3>>) -> [f64; 3] {
        let whole = Self::whole(state);
        let stress = match tangent {
            None => self.0.pk2(&whole, None),
            Some(tangent) => {
                let mut all = [[0.0; 4]; 4];
                let stress = self.0.pk2(&whole, Some(&mut all));
                *tangent = IN_PLANE.map(|row| IN_PLANE.map(|column| all[row][column]));
                stress
            }
        };
        IN_PLANE.map(|at| stress[at])
    }

    fn energy(&self, state: &StrainState<'_, 3>) -> f64 {
        self.0.energy(&Self::whole(state))
    }

    fn is_symmetric(&self, small: bool) -> bool {
        self.0.is_symmetric(small)
    }

    fn expands(&self) -> bool {
        true
    }

    fn depends_on_time(&self) -> bool {
        self.0.depends_on_time()
    }

    fn has_axes(&self) -> bool {
        self.0.has_axes()
    }

    fn history(&self) -> usize {
        self.0.history()
    }

    fn advance(&self, state: &StrainState<'_, 3>, history: &mut [f64]) {
        self.0.advance(&Self::whole(state), history);
    }

    fn internal(&self, state: &StrainState<'_, 3>, variable: &str, out: &mut Vec<f64>) -> bool {
        let begin = out.len();
        let knows = self.0.internal(&Self::whole(state), variable, out);
        if out.len() == begin + 4 {
            out.remove(begin + 2);
        }
        knows
    }

    fn ignores_measure(&self, small: bool) -> bool {
        self.0.ignores_measure(small)
    }

    fn almansi(&self, state: &StrainState<'_, 3>) -> [f64; 3] {
        let whole = self.0.almansi(&Self::whole(state));
        IN_PLANE.map(|at| whole[at])
    }
}

/// A law of bars of the strain that is not thermal.
struct ExpandingBar {
    law: Box<dyn BarLaw>,
    expansion: Expansion,
}

impl ExpandingBar {
    /// The law of bars `name` with thermal expansion.
    ///
    /// # Errors
    /// Constants that are missing or out of range.
    fn of(name: &str, properties: &Properties) -> Result<Self> {
        let LawFactory::Bar(make) = require::<LawEntry>(name)?.build else { unreachable!("{name} is a law of bars") };
        Ok(Self { law: make(properties)?, expansion: Expansion::of(properties)? })
    }
}

impl BarLaw for ExpandingBar {
    fn response(&self, strain: f64, prestress: f64, remembered: [f64; 2]) -> (f64, f64, [f64; 2]) {
        self.law.response(strain, prestress, remembered)
    }

    fn expansion(&self) -> Option<&Expansion> {
        Some(&self.expansion)
    }
}

/// The law `name` with thermal expansion.
///
/// # Errors
/// Constants that are missing or out of range.
fn expanding<const S: usize>(name: &str, plane: bool, properties: &Properties) -> Result<Expanding<S>>
where
    LawFactory: MakesLaw<S>,
{
    let make = MakesLaw::<S>::make(require::<LawEntry>(name)?.build, plane).expect("a law of as many components");
    Ok(Expanding { law: make(properties)?, expansion: Expansion::of(properties)? })
}

/// Registers a law with thermal expansion under the name of another with "Thermal" before it.
macro_rules! register_expanding {
    ($($kind:ident $name:literal)*) => { $( register_expanding! { @ $kind $name } )* };
    (@ space $name:literal) => { register_expanding! { $name,
        LawFactory::Space(|properties| Ok(Box::new(expanding::<6>($name, false, properties)?))) } };
    (@ bar $name:literal) => { register_expanding! { $name,
        LawFactory::Bar(|properties| Ok(Box::new(ExpandingBar::of($name, properties)?))) } };
    (@ plane_stress $name:literal) => { register_expanding! { $name,
        LawFactory::PlaneStress(|properties| Ok(Box::new(expanding::<3>($name, true, properties)?))) } };
    (@ plane_strain $name:literal) => { register_expanding! { $name,
        LawFactory::PlaneStrain {
            plane: |properties| Ok(Box::new(ExpandingPlane(expanding::<4>($name, true, properties)?))),
            whole: |properties| Ok(Box::new(expanding::<4>($name, true, properties)?)),
        } } };
    (@ revolution $name:literal) => { register_expanding! { $name,
        LawFactory::Axisymmetric(|properties| Ok(Box::new(expanding::<4>($name, false, properties)?))) } };
    ($name:literal, $build:expr) => {
        register! { LawEntry concat!("Thermal", $name),
            about: concat!($name, " with thermal expansion; needs THERMAL_EXPANSION_COEFFICIENT and REFERENCE_TEMPERATURE beside its properties"),
            source: "ε_m = ε − α (T − T₀) 1 under small strain, F = (1 + α (T − T₀)) F_m else; Lu and Pister, Int. J. Solids Structures 11 (1975)",
            takes: expansion::CONSTANTS,
            build: $build,
        }
    };
}

register_expanding! {
    space "SmallStrainJ2Plasticity3DLaw"
    plane_strain "SmallStrainJ2PlasticityPlaneStrain2DLaw"
    revolution "SmallStrainJ2PlasticityAxisym2DLaw"
    space "SmallStrainIsotropicPlasticity3DVonMisesVonMises"
    plane_strain "SmallStrainIsotropicPlasticityPlaneStrainVonMisesVonMises"
    space "FiniteStrainIsotropicPlasticity3DVonMisesVonMises"
    plane_strain "FiniteStrainIsotropicPlasticityPlaneStrainVonMisesVonMises"
    revolution "FiniteStrainIsotropicPlasticityAxisymVonMisesVonMises"
    space "KirchhoffSaintVenant3DLaw"
    plane_strain "KirchhoffSaintVenantPlaneStrain2DLaw"
    plane_stress "KirchhoffSaintVenantPlaneStress2DLaw"
    revolution "KirchhoffSaintVenantAxisym2DLaw"
    space "HyperElastic3DLaw"
    plane_strain "HyperElasticPlaneStrain2DLaw"
    revolution "HyperElasticAxisym2DLaw"
    space "HyperElasticIsotropicQuasiIncompressibleIshochoricNeoHookean3D"
    space "HyperElasticMooneyRivlin3DLaw"
    plane_strain "HyperElasticMooneyRivlinPlaneStrain2DLaw"
    revolution "HyperElasticMooneyRivlinAxisym2DLaw"
    space "HyperElasticYeoh3DLaw"
    plane_strain "HyperElasticYeohPlaneStrain2DLaw"
    revolution "HyperElasticYeohAxisym2DLaw"
    space "HyperElasticOgden3DLaw"
    plane_strain "HyperElasticOgdenPlaneStrain2DLaw"
    revolution "HyperElasticOgdenAxisym2DLaw"
    space "HyperElasticArrudaBoyce3DLaw"
    plane_strain "HyperElasticArrudaBoycePlaneStrain2DLaw"
    revolution "HyperElasticArrudaBoyceAxisym2DLaw"
    space "HyperElasticGent3DLaw"
    plane_strain "HyperElasticGentPlaneStrain2DLaw"
    revolution "HyperElasticGentAxisym2DLaw"
    space "HyperElasticBlatzKo3DLaw"
    plane_strain "HyperElasticBlatzKoPlaneStrain2DLaw"
    revolution "HyperElasticBlatzKoAxisym2DLaw"
    space "SmallStrainViscoelasticity3D"
    plane_strain "SmallStrainViscoelasticityPlaneStrain"
    revolution "SmallStrainViscoelasticityAxisym"
    space "SmallStrainNortonCreep3D"
    plane_strain "SmallStrainNortonCreepPlaneStrain"
    revolution "SmallStrainNortonCreepAxisym"
    space "SmallStrainKinematicPlasticity3DVonMisesVonMises"
    plane_strain "SmallStrainKinematicPlasticityPlaneStrainVonMisesVonMises"
    revolution "SmallStrainKinematicPlasticityAxisymVonMisesVonMises"
    space "LinearElasticOrthotropic3DLaw"
    plane_strain "LinearElasticOrthotropicPlaneStrain2DLaw"
    plane_stress "LinearElasticOrthotropic2DLaw"
    revolution "LinearElasticOrthotropicAxisym2DLaw"
    bar "TrussConstitutiveLaw"
    bar "TrussPlasticityConstitutiveLaw"
}
