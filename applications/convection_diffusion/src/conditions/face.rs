//! Faces: given flux, exchange with surroundings by convection and radiation.
//!
//! f_i = ∫ N_i (q + h (Tₐ − T) + ε σ (Tₐ⁴ − T⁴)), into the body; T in kelvin where ε is given. Faces are implicit, whatever θ
//! is. q is FACE_HEAT_FLUX of the nodes and of the condition; h, ε and Tₐ are those of the properties, and once more those of the
//! condition, which `apply_thermal_face_process` sets.

use std::f64::consts::PI;

use zelus_core::diagnostics::Result;
use zelus_core::entities::{
    BlockRequest, Build, ConditionEntry, EntityView, Kernel, KernelBlock, LocalUnknown, Request, StepView, Tangent,
};
use zelus_core::geometry::{Shape, ShapeTable, mapping};
use zelus_core::model::Properties;
use zelus_core::register;

use crate::columns::{Columns, nodal};
use crate::elements::{full_order, radial};

/// Names of h, ε, Tₐ among properties and data of conditions.
pub const DATA: [&str; 3] = ["CONVECTION_COEFFICIENT", "EMISSIVITY", "AMBIENT_TEMPERATURE"];

/// σ where the properties give no other (W/(m² K⁴)).
const STEFAN_BOLTZMANN: f64 = 5.67e-8;

/// Surroundings of a face.
#[derive(Debug, Clone, Copy, Default)]
struct Surroundings {
    /// h.
    convection: f64,
    /// ε σ.
    radiation: f64,
    /// Tₐ.
    temperature: f64,
}

impl Surroundings {
    /// Power per area into the body at a temperature of the face, and its derivative.
    fn flux(&self, t: f64) -> [f64; 2] {
        let (cold, cubic) = (self.temperature, t * t * t);
        [
            self.convection * (cold - t) + self.radiation * (cold * cold * cold * cold - cubic * t),
            -self.convection - 4.0 * self.radiation * cubic,
        ]
    }
}

/// The faces of one block; `EXCHANGES` with the surroundings, `RING` about the x axis, beside a structure about the y axis.
pub struct Face<const EXCHANGES: bool, const RING: bool, const DIM: usize> {
    columns: Columns,
    rule: &'static ShapeTable,
}

impl<const EXCHANGES: bool, const RING: bool, const DIM: usize> Face<EXCHANGES, RING, DIM> {
    /// Surroundings that exchange heat with the face: by its properties, and by its data.
    fn surroundings(properties: &Properties, view: &StepView<'_>, index: u32) -> [Surroundings; 2] {
        if !EXCHANGES {
            return [Surroundings::default(); 2];
        }
        let sigma = properties.number("STEFAN_BOLTZMANN_CONSTANT").unwrap_or(STEFAN_BOLTZMANN);
        let from = |[convection, emissivity, temperature]: [f64; 3]| Surroundings {
            convection,
            radiation: emissivity * sigma,
            temperature,
        };
        let data = |name| view.conditions.data.level(name, 0).get(index as usize).copied();
        [
            from(DATA.map(|name| properties.number(name).unwrap_or(0.0))),
            from(DATA.map(|name| data(name).unwrap_or(0.0))),
        ]
    }
}

impl<const EXCHANGES: bool, const RING: bool, const DIM: usize, const NODES: usize> Kernel<NODES, NODES>
    for Face<EXCHANGES, RING, DIM>
{
    type State = ();

    fn unknowns() -> [LocalUnknown; NODES] {
        LocalUnknown::of_nodes(crate::variables::TEMPERATURE.scalar())
    }

    fn own_unknowns(&self) -> [LocalUnknown; NODES] {
        LocalUnknown::of_nodes(self.columns.unknown)
    }

    fn new(request: &BlockRequest<'_>) -> Result<Self> {
        let shape = Shape::of(DIM, NODES).expect("faces are registered for known shapes only");
        // As Kratos integrates the fourth power: three points an axis on quadrilaterals.
        let order = full_order(shape) + usize::from(shape == Shape::Quad4 && EXCHANGES);
        Ok(Self { columns: Columns::of(request.part), rule: ShapeTable::get(shape, order) })
    }

    fn state(&self, entity: &EntityView<'_, NODES>, _view: &StepView<'_>) -> Result<(), String> {
        match mapping::domain_size(self.rule.shape(), &entity.current) > 0.0 {
            true => Ok(()),
            false => Err("it has no size".to_owned()),
        }
    }

    fn tangent(&self) -> Tangent {
        if EXCHANGES { Tangent::Symmetric } else { Tangent::Zero }
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, NODES>,
        (): &(),
        view: &StepView<'_>,
        _request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; NODES],
    ) -> Result<(), String> {
        let t = nodal(entity, view, Some(self.columns.unknown.column), 0);
        let q = nodal(entity, view, self.columns.surface_source, 0);
        let own = self.columns.surface_source.map_or(&[][..], |name| view.conditions.data.level(name, 0));
        let own = own.get(entity.index as usize).copied().unwrap_or(0.0);
        let surroundings = Self::surroundings(entity.properties, view, entity.index);
        let radial = radial(view.info);
        for (g, n) in self.rule.n::<NODES>().iter().enumerate() {
            let at = |values: &[f64; NODES]| n.iter().zip(values).map(|(n, value)| n * value).sum::<f64>();
            let area = mapping::det_jacobian(self.rule.shape(), &entity.current, self.rule.points()[g].xi);
            let round =
                if RING { 2.0 * PI * (0..NODES).map(|i| n[i] * entity.current[i][radial]).sum::<f64>() } else { 1.0 };
            let weight = self.rule.weight(g) * area * round;
            let temperature = at(&t);
            let [mut flux, mut slope] = [at(&q) + own, 0.0];
            for [more, by] in surroundings.map(|outside| outside.flux(temperature)) {
                flux += more;
                slope += by;
            }
            for i in 0..NODES {
                rhs[i] += weight * n[i] * flux;
                if !lhs.is_empty() {
                    (0..NODES).for_each(|j| lhs[i * NODES + j] -= weight * slope * n[i] * n[j]);
                }
            }
        }
        Ok(())
    }
}

macro_rules! face {
    ($name:literal, $exchanges:literal, $ring:literal, $about:literal, $source:literal; $($suffix:literal: $nodes:literal, $dim:literal;)+) => {
        $(register! { ConditionEntry concat!($name, $suffix),
            about: $about,
            source: $source,
            loads: &["FACE_HEAT_FLUX", "CONVECTION_COEFFICIENT", "EMISSIVITY", "AMBIENT_TEMPERATURE"],
            cell: Shape::of($dim, $nodes),
            space: $dim + 1,
            build: Build::Block(KernelBlock::<Face<$exchanges, $ring, $dim>, $nodes, $nodes>::boxed),
        })+
    };
}

/// Registers a kind of face on the shapes in the plane, or on all.
macro_rules! faces {
    (plane; $($kind:tt)+) => {
        face! { $($kind)+;
            "2D2N": 2, 1;
            "2D3N": 3, 1;
        }
    };
    (all; $($kind:tt)+) => {
        faces! { plane; $($kind)+ }
        face! { $($kind)+;
            "3D3N": 3, 2;
            "3D4N": 4, 2;
            "3D6N": 6, 2;
            "3D8N": 8, 2;
            "3D9N": 9, 2;
        }
    };
}

faces! { all; "ThermalFace", true, false,
"a face with FACE_HEAT_FLUX into the body, exchange by CONVECTION_COEFFICIENT and EMISSIVITY with AMBIENT_TEMPERATURE",
"f = ∫ N (q + h (Tₐ − T) + ε σ (Tₐ⁴ − T⁴))" }

faces! { all; "FluxCondition", false, false,
"a face with FACE_HEAT_FLUX into the body",
"f = ∫ N q" }

faces! { plane; "AxisymmetricThermalFace", true, true,
"ThermalFace of a body of revolution about the x axis: y is the radius; about the y axis where a structure is",
"f = ∫ N (q + h (Tₐ − T) + ε σ (Tₐ⁴ − T⁴)) 2πy" }
