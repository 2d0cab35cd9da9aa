//! Bars that carry force along their axis only.
//!
//! With l_0, l the initial and present length, A CROSS_AREA, S_0 TRUSS_PRESTRESS_PK2 and x_21 = x_2 − x_1:
//! E_gl = (l² − l_0²)/2l_0², f = A l_0 S x_21/l_0², S = S(E_gl) on the first node, the opposite on the second.
//! The linear bar has ε = (u_2 − u_1)·t/l_0 along its initial direction t. Mass: A l_0 DENSITY, half a node when lumped.
//! S follows from the strain by the law of bars that the properties name. Bars that expand by θ = 1 + α (T − T₀), T the mean of
//! both ends, are of θ³ their volume: S = θ S_m((E_gl − ½ (θ² − 1))/θ²); the linear bar has S = S_m(ε − (θ − 1)).

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::entities::{
    BlockRequest, Build, ElementEntry, EntityView, Kernel, KernelBlock, LocalUnknown, Request, StepView, Tangent,
};
use zelus_core::geometry::Shape;
use zelus_core::register;
use zelus_core::registry::find;
use zelus_core::vector3::{dot, norm, sub};

use super::gradients::nodal_vectors;
use super::material::NO_TEMPERATURE;
use crate::laws::{BarLaw, LawEntry, LawFactory, positive};
use crate::variables::{DISPLACEMENT, TEMPERATURE, VOLUME_ACCELERATION};

/// A bar in `DIM` dimensions; `LINEAR` for small displacements.
pub struct Truss<const DIM: usize, const LINEAR: bool> {
    law: Box<dyn BarLaw>,
    area: f64,
    density: f64,
    prestress: f64,
    lumped: bool,
    acceleration: [f64; 3],
}

impl<const DIM: usize, const LINEAR: bool> Truss<DIM, LINEAR> {
    /// Unit direction and initial length.
    fn axis(entity: &EntityView<'_, 2>) -> ([f64; 3], f64) {
        let along = sub(entity.initial[1], entity.initial[0]);
        let length = norm(along);
        (along.map(|x| x / length), length)
    }

    /// Axial strain: of Green and Lagrange, or the small one.
    fn strain(entity: &EntityView<'_, 2>, view: &StepView<'_>) -> f64 {
        let (direction, length) = Self::axis(entity);
        if LINEAR {
            let [first, second] = nodal_vectors(entity, view, &DISPLACEMENT);
            return dot(sub(second, first), direction) / length;
        }
        let now = sub(entity.current[1], entity.current[0]);
        0.5 * (dot(now, now) / (length * length) - 1.0)
    }
}

impl<const DIM: usize, const LINEAR: bool> Truss<DIM, LINEAR> {
    /// Stress at a strain, its derivative, and the history after a step that ends so.
    fn response(
        &self,
        strain: f64,
        entity: &EntityView<'_, 2>,
        state: &[f64; 2],
        view: &StepView<'_>,
    ) -> Result<(f64, f64, [f64; 2]), String> {
        let Some(expansion) = self.law.expansion() else {
            return Ok(self.law.response(strain, self.prestress, *state));
        };
        let column = view.nodes.history.values(&TEMPERATURE, 0);
        if column.is_empty() {
            return Err(NO_TEMPERATURE.into());
        }
        let [first, second] = entity.scalars(column);
        let thermal = expansion.strain(0.5 * (first + second));
        if LINEAR {
            return Ok(self.law.response(strain - thermal, self.prestress, *state));
        }
        let stretch = 1.0 + thermal;
        let square = stretch * stretch;
        let (stress, modulus, after) =
            self.law.response((strain - 0.5 * (square - 1.0)) / square, self.prestress, *state);
        Ok((stretch * stress, modulus / stretch, after))
    }
}

impl<const DIM: usize, const LINEAR: bool, const SIZE: usize> Kernel<2, SIZE> for Truss<DIM, LINEAR> {
    type State = [f64; 2];

    fn unknowns() -> [LocalUnknown; SIZE] {
        std::array::from_fn(|row| LocalUnknown::of_node((row / DIM) as u8, DISPLACEMENT.component((row % DIM) as u8)))
    }

    fn new(request: &BlockRequest<'_>) -> Result<Self> {
        let id = request.table.properties[request.members[0] as usize];
        let Some(properties) = request.part.properties.get(&id) else {
            let fact = format!("{} uses properties {id}, which do not exist", request.entry.name);
            let remedy = "define them in the mesh file or the materials file";
            return Err(Diagnostic::error("missing-properties", fact).remedy(remedy).into());
        };
        let law = properties.law.as_deref();
        let Some(LawFactory::Bar(make)) = law.and_then(find::<LawEntry>).map(|entry| entry.build) else {
            let fact = format!("the law of properties {id}, {}, does not fit trusses", law.unwrap_or("none"));
            let problem = Diagnostic::error("law-does-not-fit", fact).at(properties.place.clone());
            return Err(problem.remedy("use TrussConstitutiveLaw or TrussPlasticityConstitutiveLaw").into());
        };
        let law = make(properties)?;
        let area = properties.require("CROSS_AREA")?;
        positive(properties, "CROSS_AREA", area)?;
        let number = |name: &str| properties.number(name).unwrap_or(0.0);
        Ok(Self {
            law,
            area,
            density: number("DENSITY"),
            prestress: number("TRUSS_PRESTRESS_PK2"),
            lumped: number("COMPUTE_LUMPED_MASS_MATRIX") != 0.0,
            acceleration: properties.vector3("VOLUME_ACCELERATION").unwrap_or_default(),
        })
    }

    fn state(&self, entity: &EntityView<'_, 2>, _view: &StepView<'_>) -> Result<[f64; 2], String> {
        let (_, length) = Self::axis(entity);
        if length > 0.0 { Ok([0.0; 2]) } else { Err("both ends are at the same place".into()) }
    }

    fn tangent(&self) -> Tangent {
        if LINEAR && self.law.is_linear() { Tangent::Constant } else { Tangent::Symmetric }
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, 2>,
        state: &[f64; 2],
        view: &StepView<'_>,
        request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    ) -> Result<(), String> {
        let (direction, length) = Self::axis(entity);
        let gravity = nodal_vectors(entity, view, &VOLUME_ACCELERATION);
        for a in 0..DIM {
            let of = [0, 1].map(|i: usize| self.acceleration[a] + gravity[i][a]);
            let sixth = self.density * self.area * length / 6.0;
            rhs[a] += sixth * (2.0 * of[0] + of[1]);
            rhs[DIM + a] += sixth * (of[0] + 2.0 * of[1]);
        }
        // a linear elastic bar has its external forces, the prestress among them, apart from those of the strain
        let strain = if request == Request::External { 0.0 } else { Self::strain(entity, view) };
        let (stress, modulus, _) = self.response(strain, entity, state, view)?;
        // derivative of the strain along x_2
        let along = match LINEAR {
            true => direction.map(|t| t / length),
            false => sub(entity.current[1], entity.current[0]).map(|x| x / (length * length)),
        };
        let volume = self.area * length;
        for a in 0..DIM {
            rhs[a] += volume * stress * along[a];
            rhs[DIM + a] -= volume * stress * along[a];
        }
        if lhs.is_empty() {
            return Ok(());
        }
        for a in 0..DIM {
            for b in 0..DIM {
                let geometric = if !LINEAR && a == b { stress / (length * length) } else { 0.0 };
                let k = volume * (modulus * along[a] * along[b] + geometric);
                for (i, j, sign) in [(0, 0, 1.0), (0, 1, -1.0), (1, 0, -1.0), (1, 1, 1.0)] {
                    lhs[(i * DIM + a) * SIZE + j * DIM + b] += sign * k;
                }
            }
        }
        Ok(())
    }

    fn has_external(&self, view: &StepView<'_>) -> bool {
        let gravity = self.acceleration != [0.0; 3]
            || view.nodes.history.values(&VOLUME_ACCELERATION, 0).iter().any(|v| *v != 0.0);
        self.prestress != 0.0 || (self.density > 0.0 && gravity)
    }

    fn accept(&self, entity: &EntityView<'_, 2>, state: &mut [f64; 2], view: &StepView<'_>) -> Result<(), String> {
        *state = self.response(Self::strain(entity, view), entity, state, view)?.2;
        Ok(())
    }

    fn inherit(&self, state: &mut [f64; 2], earlier: &[f64; 2]) {
        *state = *earlier;
    }

    fn mass(
        &self,
        entity: &EntityView<'_, 2>,
        _state: &[f64; 2],
        _view: &StepView<'_>,
        lumped: bool,
        out: &mut [f64],
    ) -> bool {
        let whole = self.density * self.area * Self::axis(entity).1;
        let [same, other] = if lumped || self.lumped { [0.5, 0.0] } else { [1.0 / 3.0, 1.0 / 6.0] };
        for a in 0..DIM {
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                out[(i * DIM + a) * SIZE + j * DIM + a] += whole * if i == j { same } else { other };
            }
        }
        true
    }
}

register! { ElementEntry "TrussElement3D2N",
    aliases: &["TotalLagrangianTrussElement3D2N"],
    about: "Bar under finite displacements: CROSS_AREA, TRUSS_PRESTRESS_PK2",
    source: "f = A S x_21/l_0, S = E (l² − l_0²)/2l_0² + S_0",
    cell: Shape::of(1, 2),
    space: 3,
    build: Build::Block(KernelBlock::<Truss<3, false>, 2, 6>::boxed),
}

register! { ElementEntry "TrussLinearElement3D2N",
    aliases: &["LinearTrussElement3D2N"],
    about: "Bar under small displacements: CROSS_AREA, TRUSS_PRESTRESS_PK2",
    source: "f = A (E (u_2 − u_1)·t/l_0 + S_0) t",
    cell: Shape::of(1, 2),
    space: 3,
    build: Build::Block(KernelBlock::<Truss<3, true>, 2, 6>::boxed),
}

register! { ElementEntry "TotalLagrangianTrussElement2D2N",
    aliases: &["TrussElement2D2N"],
    about: "Bar of the plane under finite displacements: CROSS_AREA, TRUSS_PRESTRESS_PK2",
    source: "f = A S x_21/l_0, S = E (l² − l_0²)/2l_0² + S_0",
    cell: Shape::of(1, 2),
    space: 2,
    build: Build::Block(KernelBlock::<Truss<2, false>, 2, 4>::boxed),
}

register! { ElementEntry "LinearTrussElement2D2N",
    aliases: &["TrussLinearElement2D2N"],
    about: "Bar of the plane under small displacements: CROSS_AREA, TRUSS_PRESTRESS_PK2",
    source: "f = A (E (u_2 − u_1)·t/l_0 + S_0) t",
    cell: Shape::of(1, 2),
    space: 2,
    build: Build::Block(KernelBlock::<Truss<2, true>, 2, 4>::boxed),
}
