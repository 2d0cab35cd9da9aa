//! The trait of constitutive laws, and how an element gets the one its properties name.

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::Properties;
use zelus_core::registered_kind;
use zelus_core::registry::{find, require};

use super::bar_law::MakeBarLaw;
use crate::tensor::{IDENTITY, Tensor, congruent, push_forward, stress_tensor, stress_vector};

/// A Voigt matrix `m[row][column]`.
pub type Matrix<const S: usize> = [[f64; S]; S];

/// Deformation of a material point as the element describes it.
#[derive(Debug, Clone, Copy)]
pub struct StrainState<'a, const S: usize> {
    /// Green–Lagrange strain, or the small strain of a small-displacement element (shear doubled).
    pub strain: [f64; S],
    /// Deformation gradient; 1 + strain in a small-displacement element.
    pub f: Tensor,
    /// Determinant of `f`, positive.
    pub det_f: f64,
    /// Whether `strain` is the small strain and `f` is 1 + strain.
    pub small: bool,
    /// Pressure that the element holds constant, positive in compression; 0 in all other elements.
    pub pressure: f64,
    /// TEMPERATURE, where the law asks for it ([`ConstitutiveLaw::expands`], [`ConstitutiveLaw::reads_point`]); 0 otherwise.
    pub temperature: f64,
    /// Where the point is, initially in a small-displacement element and else at present, if the law reads it
    /// ([`ConstitutiveLaw::reads_point`]); 0 otherwise.
    pub position: [f64; 3],
    /// TIME at the beginning and at the end of the step.
    pub step: [f64; 2],
    /// Width of the band in which an element softens, where the law asks for it ([`ConstitutiveLaw::softens`]); 0 otherwise.
    pub band: f64,
    /// Whether damage counts as in Kratos.
    pub band_as_kratos: bool,
    /// Whether the history stays as it is: the point neither yields nor is damaged further.
    pub elastic: bool,
    /// Axes of the element as rows, where it has some and the law asks for them ([`ConstitutiveLaw::has_axes`]); else those of the space.
    pub axes: Option<Tensor>,
    /// Id of the element and number of the Gauss point, from 1; zeros where unknown.
    pub place: [usize; 2],
    /// History of the law at the last accepted step: [`ConstitutiveLaw::history`] numbers.
    pub history: &'a [f64],
}

impl<'a, const S: usize> StrainState<'a, S> {
    /// A point without strain and history, at the temperature 0.
    pub const REST: Self = Self {
        strain: [0.0; S],
        f: IDENTITY,
        det_f: 1.0,
        small: true,
        pressure: 0.0,
        temperature: 0.0,
        position: [0.0; 3],
        step: [0.0; 2],
        band: 0.0,
        band_as_kratos: false,
        elastic: false,
        axes: None,
        place: [0; 2],
        history: &[],
    };

    /// The same with other components of strain.
    pub fn with_strain<const T: usize>(self, strain: [f64; T]) -> StrainState<'a, T> {
        let Self {
            f,
            det_f,
            small,
            pressure,
            temperature,
            position,
            step,
            band,
            band_as_kratos,
            elastic,
            axes,
            place,
            history,
            ..
        } = self;
        StrainState {
            strain,
            f,
            det_f,
            small,
            pressure,
            temperature,
            position,
            step,
            band,
            band_as_kratos,
            elastic,
            axes,
            place,
            history,
        }
    }
}

/// Stress measure that an element integrates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StressMeasure {
    /// Second Piola–Kirchhoff stress, on the initial configuration.
    Pk2,
    /// Cauchy stress, on the present configuration.
    Cauchy,
}

/// Stress, tangent and energy of a material point with `S` Voigt components.
///
/// ```
/// use zelus_core::model::{Properties, PropertyValue};
/// use zelus_structural_mechanics::laws::{ConstitutiveLaw, StrainState, law_of};
///
/// let mut steel = Properties::new(1);
/// steel.law = Some("LinearElastic3DLaw".to_owned());
/// steel.values.insert("YOUNG_MODULUS".to_owned(), PropertyValue::Number(200e9));
/// steel.values.insert("POISSON_RATIO".to_owned(), PropertyValue::Number(0.25));
/// let law = law_of::<6>(&steel, false)?;
///
/// // Uniaxial strain: σ_xx = (λ + 2μ) ε with λ = μ = 80 GPa.
/// let state = StrainState { strain: [1e-3, 0.0, 0.0, 0.0, 0.0, 0.0], ..StrainState::REST };
/// let stress = law.pk2(&state, None);
/// assert!((stress[0] / 240e6 - 1.0).abs() < 1e-14 && (stress[1] / 80e6 - 1.0).abs() < 1e-14);
/// # Ok::<(), zelus_core::Error>(())
/// ```
pub trait ConstitutiveLaw<const S: usize>: Send + Sync {
    /// Second Piola–Kirchhoff stress; its derivative with respect to the strain too, when asked.
    fn pk2(&self, state: &StrainState<'_, S>, tangent: Option<&mut Matrix<S>>) -> [f64; S];

    /// Stored energy per initial volume.
    fn energy(&self, state: &StrainState<'_, S>) -> f64;

    /// Whether the stress is a constant matrix times the strain.
    fn is_linear(&self) -> bool {
        false
    }

    /// Whether the tangent is symmetric, for the small strain of a small-displacement element or for Green–Lagrange's.
    fn is_symmetric(&self, _small: bool) -> bool {
        true
    }

    /// Whether the stress depends on the temperature.
    fn expands(&self) -> bool {
        false
    }

    /// Whether the law is given the position of the point, and TEMPERATURE where nodes have one.
    fn reads_point(&self) -> bool {
        false
    }

    /// Whether the stress depends on the time that a step takes.
    fn depends_on_time(&self) -> bool {
        false
    }

    /// Whether the stress depends on the axes of the material.
    fn has_axes(&self) -> bool {
        false
    }

    /// Whether strength falls, so that a band as wide as an element breaks.
    fn softens(&self) -> bool {
        false
    }

    /// The widest band that can soften without snapping back.
    fn widest_band(&self) -> f64 {
        f64::INFINITY
    }

    /// Bulk modulus where the law leaves the volume to the element, which adds the pressure.
    fn bulk_of_element(&self) -> Option<f64> {
        None
    }

    /// Leaves the volume to the element from now on; whether the law can.
    fn leave_volume(&mut self) -> bool {
        self.bulk_of_element().is_some()
    }

    /// Volume of an unconstrained specimen at a temperature, over its initial one.
    fn free_volume(&self, _temperature: f64) -> f64 {
        1.0
    }

    /// Numbers of history of a point; all 0 before the first step.
    fn history(&self) -> usize {
        0
    }

    /// History of the law after a step accepted in `state`, whose history is that before the step.
    fn advance(&self, _state: &StrainState<'_, S>, _history: &mut [f64]) {}

    /// Whether stresses are computed for many points [`together`](zelus_core::entities::together); [`ConstitutiveLaw::advance`] leaves the
    /// history alone while points are noted.
    fn is_computed_together(&self) -> bool {
        false
    }

    /// Appends a variable of the history, or one derived from it; whether the law knows the name.
    fn internal(&self, _state: &StrainState<'_, S>, _variable: &str, _out: &mut Vec<f64>) -> bool {
        false
    }

    /// Whether the same numbers serve as every stress measure, as if deformations were small; `small` as in the state.
    fn ignores_measure(&self, _small: bool) -> bool {
        false
    }

    /// Strain to report as Almansi's; the Green–Lagrange strain unless the law distinguishes them.
    fn almansi(&self, state: &StrainState<'_, S>) -> [f64; S] {
        state.strain
    }

    /// Stress in the wanted measure with its tangent: dS/dE, or its push-forward for Cauchy stress.
    fn stress(&self, state: &StrainState<'_, S>, measure: StressMeasure, tangent: Option<&mut Matrix<S>>) -> [f64; S] {
        if measure == StressMeasure::Pk2 || self.ignores_measure(state.small) {
            return self.pk2(state, tangent);
        }
        let pk2 = match tangent {
            None => self.pk2(state, None),
            Some(tangent) => {
                let pk2 = self.pk2(state, Some(tangent));
                *tangent = push_forward(tangent, &state.f, state.det_f);
                pk2
            }
        };
        stress_vector(&congruent(&state.f, &stress_tensor(&pk2))).map(|s| s / state.det_f)
    }
}

/// A function that makes a law with `S` Voigt components from the properties.
pub type MakeLaw<const S: usize> = fn(&Properties) -> Result<Box<dyn ConstitutiveLaw<S>>>;

/// Elements that a law is for, with its factory.
#[derive(Clone, Copy)]
pub enum LawFactory {
    /// For elements in space.
    Space(MakeLaw<6>),
    /// For planar elements whose stress across the plane is zero.
    PlaneStress(MakeLaw<3>),
    /// For planar elements whose strain across the plane is zero: on (xx, yy, xy), and on (xx, yy, zz, xy).
    PlaneStrain {
        /// Without the strain across the plane.
        plane: MakeLaw<3>,
        /// With it.
        whole: MakeLaw<4>,
    },
    /// For elements of revolution, on (rr, zz, tt, rz).
    Axisymmetric(MakeLaw<4>),
    /// For bars.
    Bar(MakeBarLaw),
}

registered_kind! {
    /// A constitutive law that materials name.
    pub struct LawEntry("constitutive_law", "unknown-law") {
        build: LawFactory;
        /// Constants that not every law takes.
        takes: &'static [&'static str] = &[],
        /// Whether its stress depends on the axes of the material.
        has_axes: bool = false,
        /// A warning about properties of such a law before the run; the id is that of an element that has them.
        warns: fn(&Properties, usize) -> Option<Diagnostic> = |_, _| None,
    }
}

impl LawEntry {
    /// Whether it takes a constant that not every law takes. A law that expands takes those of the law that it expands, too.
    pub fn takes_constant(&self, name: &str) -> bool {
        let expanded = self.name.strip_prefix("Thermal").and_then(find::<Self>);
        self.takes.contains(&name) || expanded.is_some_and(|law| law.takes.contains(&name))
    }
}

/// Whether the law of the properties, or of one of their layers, depends on the axes of the material.
pub fn has_axes(properties: &Properties) -> bool {
    let own = properties.law.as_deref().and_then(find::<LawEntry>);
    let expanded = || own.and_then(|law| law.name.strip_prefix("Thermal")).and_then(find::<LawEntry>);
    own.is_some_and(|law| law.has_axes)
        || expanded().is_some_and(|law| law.has_axes)
        || properties.parts.iter().any(has_axes)
}

/// Laws for `S` Voigt components.
pub trait MakesLaw<const S: usize> {
    /// Function that makes the law for them, `plane` as in [`law_of`]; `None` where it is for other elements.
    fn make(self, plane: bool) -> Option<MakeLaw<S>>;
}

impl MakesLaw<3> for LawFactory {
    fn make(self, _plane: bool) -> Option<MakeLaw<3>> {
        match self {
            Self::PlaneStress(make) | Self::PlaneStrain { plane: make, .. } => Some(make),
            _ => None,
        }
    }
}

impl MakesLaw<4> for LawFactory {
    fn make(self, plane: bool) -> Option<MakeLaw<4>> {
        match self {
            Self::PlaneStrain { whole, .. } if plane => Some(whole),
            Self::Axisymmetric(make) if !plane => Some(make),
            _ => None,
        }
    }
}

impl MakesLaw<6> for LawFactory {
    fn make(self, _plane: bool) -> Option<MakeLaw<6>> {
        if let Self::Space(make) = self { Some(make) } else { None }
    }
}

/// The law that the properties name, for an element with `S` Voigt components.
///
/// `plane` asks for a law of plane strain also with 4 components; otherwise those are the ones of axial symmetry.
///
/// # Errors
/// No law, an unknown one, one of another dimension, or missing material constants.
pub fn law_of<const S: usize>(properties: &Properties, plane: bool) -> Result<Box<dyn ConstitutiveLaw<S>>>
where
    LawFactory: MakesLaw<S>,
{
    let place = properties.place.clone();
    let Some(name) = &properties.law else {
        let fact = format!("properties {} are used by solid elements but have no constitutive law", properties.id);
        let remedy = "give a \"constitutive_law\" in the materials file, or CONSTITUTIVE_LAW in the mesh file";
        return Err(Diagnostic::error("missing-law", fact).at(place).remedy(remedy).into());
    };
    let entry = require::<LawEntry>(name).map_err(|problem| problem.at(place.clone()))?;
    if let Some(make) = MakesLaw::<S>::make(entry.build, plane) {
        return make(properties);
    }
    let (kind, wanted) = match S {
        3 => ("planar", "a law for planar elements (3 strain components)"),
        4 if plane => ("planar mean-dilatation", "a law of plane strain"),
        4 => ("axisymmetric", "a law for axisymmetric elements (4 strain components)"),
        _ => ("three-dimensional", "a law for three-dimensional elements (6 strain components)"),
    };
    let fact = format!("the law {} of properties {} does not fit {kind} elements", entry.name, properties.id);
    Err(Diagnostic::error("law-does-not-fit", fact).at(place).remedy(format!("use {wanted}")).into())
}
