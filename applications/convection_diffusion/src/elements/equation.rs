//! The kernel of all elements of heat: the balance at the points of a Gauss rule.
//!
//! Gradients are those of each point: quadrilaterals and hexahedra are integrated in full, where Kratos takes their gradients
//! at the centre, as `"gradients": "at_centre"` does. Nodes stand where the mesh is, so that bodies that have moved conduct as they are.

use std::marker::PhantomData;

use zelus_core::diagnostics::Result;
use zelus_core::entities::{BlockRequest, EntityView, Kernel, LocalUnknown, Request, StepView, Tangent};
use zelus_core::geometry::{Shape, ShapeTable};
use zelus_structural_mechanics::elements::physical_gradients;

use super::balance::{BalancePoint, Step, radial, round};
use super::contribution::{add, slope};
use super::marks::{AT_CENTRE, PURE_CONVECTION};
use super::place::{check_volume, full_order, stream_size};
use super::plastic_heat_source::{PLASTIC_HEAT_POWER, plastic_heat, volume};
use crate::coefficient::Local;
use crate::columns::{Columns, nodal, velocities};
use crate::material::Material;

/// Terms of the balance that a kind of element has.
pub trait Terms: Send + Sync + 'static {
    /// Storage and convection.
    const TRANSIENT: bool;
    /// The value at the beginning of the step is the advected one; both ends of the step have weight 1/2.
    const ADVECTED: bool = false;
    /// A body of revolution about the x axis, beside a structure about the y axis.
    const AXISYMMETRIC: bool = false;
}

/// The elements of one block.
pub struct Equation<T, const NODES: usize, const DIM: usize> {
    columns: Columns,
    material: Material,
    rule: &'static ShapeTable,
    /// One point at the centre.
    centre: &'static ShapeTable,
    terms: PhantomData<fn() -> T>,
}

impl<T: Terms, const NODES: usize, const DIM: usize> Equation<T, NODES, DIM> {
    /// The gradients at the centre, and a share of the volume that is the same for all points.
    fn at_centre(&self, x: &[[f64; 3]; NODES]) -> ([[f64; DIM]; NODES], f64) {
        let volume = volume::<NODES, DIM>(self.rule, x, |_| 1.0);
        let (dn, _) = physical_gradients(x, &self.centre.dn::<NODES, DIM>()[0]);
        (dn, volume / self.rule.n::<NODES>().len() as f64)
    }
}

impl<T: Terms, const NODES: usize, const DIM: usize> Kernel<NODES, NODES> for Equation<T, NODES, DIM> {
    type State = ();

    fn unknowns() -> [LocalUnknown; NODES] {
        LocalUnknown::of_nodes(crate::variables::TEMPERATURE.scalar())
    }

    fn own_unknowns(&self) -> [LocalUnknown; NODES] {
        LocalUnknown::of_nodes(self.columns.unknown)
    }

    fn new(request: &BlockRequest<'_>) -> Result<Self> {
        let columns = Columns::of(request.part);
        let shape = Shape::of(DIM, NODES).expect("elements are registered for known shapes only");
        Ok(Self {
            material: Material::of(request, &columns),
            columns,
            rule: ShapeTable::get(shape, full_order(shape)),
            centre: ShapeTable::get(shape, 1),
            terms: PhantomData,
        })
    }

    fn state(&self, entity: &EntityView<'_, NODES>, view: &StepView<'_>) -> Result<(), String> {
        check_volume::<NODES, DIM>(self.rule, &entity.current)?;
        let radial = radial(view.info);
        if T::AXISYMMETRIC && entity.current.iter().any(|x| x[radial] < 0.0) {
            let [axis, radius] = if radial == 0 { ["y", "x"] } else { ["x", "y"] };
            return Err(format!("it reaches across the axis of revolution, which is {axis}: {radius} is the radius"));
        }
        Ok(())
    }

    fn tangent(&self) -> Tangent {
        if self.material.varies() || T::TRANSIENT && !T::ADVECTED { Tangent::Unsymmetric } else { Tangent::Symmetric }
    }

    fn has_external(&self, view: &StepView<'_>) -> bool {
        self.columns.volume_source.is_some() || view.elements.data.has(PLASTIC_HEAT_POWER)
    }

    fn has_storage(&self) -> bool {
        T::TRANSIENT
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, NODES>,
        (): &(),
        view: &StepView<'_>,
        request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; NODES],
    ) -> Result<(), String> {
        let mut step = Step::of(view.info);
        if T::ADVECTED {
            step.theta = 0.5;
        } else if !T::TRANSIENT {
            step.theta = 1.0;
        }
        let unknown = self.columns.unknown.column;
        let now = nodal(entity, view, Some(unknown), 0);
        let old = match T::ADVECTED {
            true => nodal(entity, view, Some("PROJECTED_SCALAR1"), 0),
            false => nodal(entity, view, Some(unknown), 1),
        };
        let source = nodal(entity, view, self.columns.volume_source, 0);
        let velocity = match T::TRANSIENT && !T::ADVECTED {
            true => velocities(entity, view, &self.columns, step.theta),
            false => [[0.0; 3]; NODES],
        };
        let [mut conductivity, density, specific_heat] = self.material.in_element(entity, view, &now);
        if T::ADVECTED && view.info.has(PURE_CONVECTION) {
            conductivity = Local::Nodal([0.0; NODES]);
        } else {
            self.material.check_conductivity(entity, &conductivity)?;
        }
        if velocity.iter().flatten().any(|component| *component != 0.0) {
            self.material.check_capacity(entity, [&density, &specific_heat])?;
        }
        let size = stream_size(self.rule.shape(), &entity.current);
        let is_centred = view.info.has(AT_CENTRE) && T::TRANSIENT && !T::ADVECTED && !T::AXISYMMETRIC;
        let at_centre = is_centred.then(|| self.at_centre(&entity.current));
        let radial = radial(view.info);
        let radius =
            |n: &[f64; NODES]| T::AXISYMMETRIC.then(|| (0..NODES).map(|i| n[i] * entity.current[i][radial]).sum());
        let of_shape = (self.rule, &entity.current);
        let plastic = plastic_heat::<NODES, DIM>(view, entity.index, of_shape, |n| round(radius(n)));
        for (g, n) in self.rule.n::<NODES>().iter().enumerate() {
            let (dn, determinant) = physical_gradients(&entity.current, &self.rule.dn::<NODES, DIM>()[g]);
            if determinant <= 0.0 {
                return Err("it is inverted".to_owned());
            }
            let weight = self.rule.weight(g) * determinant;
            let (dn, weight) = at_centre.unwrap_or((dn, weight));
            let value = |at: &[f64; NODES]| n.iter().zip(at).map(|(n, value)| n * value).sum::<f64>();
            let part = |a: usize| (0..NODES).map(|i| n[i] * velocity[i][a]).sum();
            let point = BalancePoint {
                step,
                n,
                conductivity: &conductivity,
                density: &density,
                specific_heat: &specific_heat,
                stores: T::TRANSIENT,
                old: value(&old),
                old_gradient: slope(&dn, &old),
                velocity: std::array::from_fn(|a| if a < DIM { part(a) } else { 0.0 }),
                source: value(&source) + plastic,
                size,
                radius: radius(n),
                radial,
            };
            let weight = weight * point.round();
            let apart = match request {
                Request::External => Some(point.source),
                Request::Storage => Some(-point.stored(value(&now))),
                Request::Residual | Request::Both => None,
            };
            if let Some(apart) = apart {
                (0..NODES).for_each(|i| rhs[i] += weight * n[i] * apart);
                continue;
            }
            add(&point, [n, &now], &dn, weight, lhs, rhs);
        }
        Ok(())
    }
}
