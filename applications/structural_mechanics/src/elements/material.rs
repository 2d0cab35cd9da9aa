//! Material of an element, read once from its properties.

use zelus_core::diagnostics::{Diagnostic, Report, Result};
use zelus_core::entities::{BlockRequest, StepView};
use zelus_core::geometry::{MAX_ORDER, Shape, ShapeTable};
use zelus_core::model::Properties;

use crate::laws::{ConstitutiveLaw, LawFactory, MakesLaw, StrainState, law_of};
use crate::variables::VOLUME_ACCELERATION;

/// Reason why a law with thermal expansion has no solution.
pub(super) const NO_TEMPERATURE: &str =
    "its law expands with TEMPERATURE, which nodes do not have: solve for heat, too";

/// Law and constants of one set of properties for one shape.
pub(super) struct Material<const S: usize> {
    /// Id of the properties.
    id: usize,
    /// The law.
    pub(super) law: Box<dyn ConstitutiveLaw<S>>,
    /// Shear modulus without strain, of materials whose law leaves the volume to the element; else 0.
    pub(super) shear: f64,
    /// Mass per initial volume, 0 when not given.
    pub(super) density: f64,
    /// Thickness of planar elements; 1 for all others.
    pub(super) thickness: f64,
    /// YIELD_STRESS of the properties, or YIELD_STRESS_TENSION.
    pub(super) yield_stress: Option<f64>,
    /// VOLUME_ACCELERATION of the properties.
    pub(super) acceleration: [f64; 3],
    /// COMPUTE_LUMPED_MASS_MATRIX of the properties.
    pub(super) lumped: bool,
    /// Gauss rule of forces and stiffness.
    pub(super) rule: &'static ShapeTable,
}

/// Shear modulus without strain.
fn shear_modulus<const S: usize>(law: &dyn ConstitutiveLaw<S>) -> f64 {
    let history = vec![0.0; law.history()];
    let mut d = [[0.0; S]; S];
    law.pk2(&StrainState { small: false, history: &history, ..StrainState::REST }, Some(&mut d));
    let at = if S == 6 { 3 } else { S - 1 };
    d[at][at]
}

impl<const S: usize> Material<S> {
    fn new(properties: &Properties, shape: Shape, plane: bool, pressure: bool) -> Result<Self>
    where
        LawFactory: MakesLaw<S>,
    {
        let order = properties.number("INTEGRATION_ORDER").unwrap_or(shape.cell().default_order as f64);
        if !(1.0..=MAX_ORDER as f64).contains(&order) || order.fract() != 0.0 {
            let fact = format!("INTEGRATION_ORDER of properties {} is {order}", properties.id);
            let problem = Diagnostic::error("integration-order", fact).at(properties.place.clone());
            return Err(problem.remedy("give a whole number from 1 to 5").into());
        }
        let thickness = properties.number("THICKNESS").filter(|_| plane).unwrap_or(1.0);
        let density = properties.number("DENSITY").unwrap_or(0.0);
        for (name, value, bad) in [
            ("THICKNESS", thickness, !(thickness > 0.0 && thickness.is_finite())),
            ("DENSITY", density, !(density >= 0.0 && density.is_finite())),
        ] {
            if bad {
                let fact = format!("{name} of properties {} is {value}", properties.id);
                let problem = Diagnostic::error("material-out-of-range", fact).at(properties.place.clone());
                return Err(problem.remedy("give a positive number").into());
            }
        }
        let mut law = law_of::<S>(properties, plane)?;
        if pressure && law.bulk_of_element().is_none() {
            law.leave_volume();
        }
        if law.bulk_of_element().is_some() != pressure {
            let both = if pressure {
                "resists changes of volume, and so do"
            } else {
                "does not resist changes of volume, nor do"
            };
            let fact = format!("the law of properties {} {both} these elements", properties.id);
            let problem = Diagnostic::error("law-does-not-fit", fact).at(properties.place.clone());
            let remedy = "TotalLagrangianQ1P0MixedElement goes with HyperElasticMooneyRivlin…, …Yeoh…, …Ogden…, …ArrudaBoyce…, \
                          …Gent… and HyperElasticIsotropicQuasiIncompressibleIshochoricNeoHookean3D, the last with no other element";
            return Err(problem.remedy(remedy).into());
        }
        Ok(Self {
            id: properties.id,
            shear: if pressure { shear_modulus(law.as_ref()) } else { 0.0 },
            law,
            density,
            thickness,
            yield_stress: properties.number("YIELD_STRESS").or_else(|| properties.number("YIELD_STRESS_TENSION")),
            acceleration: properties.vector3("VOLUME_ACCELERATION").unwrap_or_default(),
            lumped: properties.number("COMPUTE_LUMPED_MASS_MATRIX").is_some_and(|flag| flag != 0.0),
            rule: ShapeTable::get(shape, order as usize),
        })
    }

    /// The materials of all entities of a block, by ascending id of the properties; `plane` means a slab, not a ring,
    /// `pressure` that the element holds it.
    ///
    /// # Errors
    /// Every set of properties that an element cannot compute with.
    pub(super) fn all(request: &BlockRequest<'_>, shape: Shape, plane: bool, pressure: bool) -> Result<Vec<Self>>
    where
        LawFactory: MakesLaw<S>,
    {
        let mut ids: Vec<usize> = request.members.iter().map(|&m| request.table.properties[m as usize]).collect();
        ids.sort_unstable();
        ids.dedup();
        let mut report = Report::new();
        let mut materials = Vec::with_capacity(ids.len());
        for id in ids {
            let made = match request.part.properties.get(&id) {
                Some(properties) => Self::new(properties, shape, plane, pressure),
                None => {
                    let fact = format!("{} uses properties {id}, which do not exist", request.entry.name);
                    Err(Diagnostic::error("missing-properties", fact)
                        .remedy("define them in the mesh file or the materials file")
                        .into())
                }
            };
            materials.extend(report.absorb(made));
        }
        report.finish()?;
        Ok(materials)
    }

    /// # Errors
    /// A band that would have to snap back as it softens.
    pub(super) fn accepts_band(&self, width: &dyn Fn() -> f64) -> Result<(), String> {
        let widest = self.law.widest_band();
        if widest == f64::INFINITY {
            return Ok(());
        }
        let width = width();
        if width <= widest {
            return Ok(());
        }
        Err(format!(
            "the band in which it softens, {width:.3e} wide, holds more energy than FRACTURE_ENERGY: at most {widest:.3e}, \
             2 E G/σ_y², can break without snapping back; make elements smaller"
        ))
    }

    /// History of the law at Gauss point `g`, from the history of all points of an element.
    pub(super) fn remembered<'a>(&self, g: usize, state: &'a [f64]) -> &'a [f64] {
        let size = self.law.history();
        &state[g * size..(g + 1) * size]
    }

    /// Whether elements of these materials weigh anything: they have mass, and an acceleration of volume acts somewhere.
    pub(super) fn have_weight(materials: &[Self], view: &StepView<'_>) -> bool {
        materials.iter().any(|m| m.density > 0.0)
            && (materials.iter().any(|m| m.acceleration != [0.0; 3])
                || view.nodes.history.values(&VOLUME_ACCELERATION, 0).iter().any(|v| *v != 0.0))
    }

    /// The material of the properties with that id.
    pub(super) fn find(materials: &[Self], id: usize) -> &Self {
        match materials {
            [only] => only,
            _ => &materials[materials.partition_point(|m| m.id < id)],
        }
    }
}
