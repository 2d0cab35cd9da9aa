//! The kernel of explicit heat: the rate at which heat comes to a node, with subscales.
//!
//! R_i = ∫ N_i (Q − ρc v·∇T) − k ∇N_i·∇T + ρc (v·∇N_i) s. The subscale s is the part of T that the mesh does not resolve: s = τ (r + ρc
//! π), r = Q − ρc (∂T/∂t + v·∇T), 1/τ = ρc (β/Δt + 2|v|/h) + 4k/h²; π is zero, or minus the projection of r/ρc onto the mesh
//! (orthogonal subscales). Dynamic subscales evolve in time: β is 1, s = τ (r + ρc (π + s₀/Δt)), and ∫ N_i ρc (s − s₀)/Δt is taken off
//! R. ∂T/∂t is the mean rate since the beginning of the step. Codina, Principe and Avila (2011).

use std::marker::PhantomData;

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::entities::{BlockRequest, EntityView, Kernel, LocalUnknown, Request, StepView, Tangent};
use zelus_core::geometry::{Shape, ShapeTable};
use zelus_core::scalar::Real;
use zelus_structural_mechanics::elements::physical_gradients;

use super::balance::{DYNAMIC_TAU, along};
use super::contribution::{Pointwise, add, slope};
use super::marks::PROJECTING;
use super::place::{check_volume, full_order, stream_size};
use super::plastic_heat_source::plastic_heat;
use crate::coefficient::Local;
use crate::columns::{Columns, nodal, velocities};
use crate::material::{Material, properties_of};

/// Value of the step data: how far the present stage is from the beginning of the step to its end.
pub const STAGE: &str = "RUNGE_KUTTA_STAGE";

/// Whether subscales evolve in time.
pub trait Subscales: Send + Sync + 'static {
    /// Whether an element has a history of them.
    const DYNAMIC: bool;
}

/// The explicit elements of one block.
pub struct Explicit<T, const NODES: usize, const DIM: usize> {
    columns: Columns,
    material: Material,
    rule: &'static ShapeTable,
    subscales: PhantomData<fn() -> T>,
}

/// Data of a point that do not depend on its temperature.
struct ExplicitPoint {
    /// k.
    conductivity: f64,
    /// ρc.
    capacity: f64,
    velocity: [f64; 3],
    source: f64,
    /// τ.
    tau: f64,
    /// Temperature at the beginning of the step.
    old: f64,
    /// Time since then; 0 in the first stage.
    since: f64,
    /// π, with s₀/Δt where subscales are dynamic (temperature by time).
    known: f64,
    /// Subscale at the beginning of the step and length of the step, where it is dynamic.
    before: Option<[f64; 2]>,
    /// Whether only the strong form is asked for.
    projecting: bool,
}

impl ExplicitPoint {
    /// The mean rate since the beginning of the step, and the convected heat.
    fn strong<R: Real>(&self, temperature: R, gradient: [R; 3]) -> (R, R) {
        let rate = if self.since > 0.0 { (temperature - self.old) / self.since } else { R::zero() };
        (rate, along(self.velocity, gradient))
    }

    /// s.
    fn subscale<R: Real>(&self, temperature: R, gradient: [R; 3]) -> R {
        let (rate, advected) = self.strong(temperature, gradient);
        ((R::constant(self.known) - rate - advected) * self.capacity + self.source) * self.tau
    }
}

impl Pointwise for ExplicitPoint {
    fn balance<R: Real>(&self, temperature: R, gradient: [R; 3]) -> (R, [R; 3]) {
        let (rate, advected) = self.strong(temperature, gradient);
        let galerkin = advected * self.capacity - self.source;
        let conducted = gradient.map(|g| g * self.conductivity);
        if self.projecting {
            let gone = self.before.map_or(0.0, |[before, length]| before / length);
            return (galerkin + (rate - gone) * self.capacity, conducted);
        }
        let s = self.subscale(temperature, gradient);
        let stored = match self.before {
            Some([before, length]) => (s - before) * (self.capacity / length),
            None => R::zero(),
        };
        let flux = |i: usize| conducted[i] - s * (self.capacity * self.velocity[i]);
        (galerkin + stored, [flux(0), flux(1), flux(2)])
    }
}

impl<T: Subscales, const NODES: usize, const DIM: usize> Explicit<T, NODES, DIM> {
    /// Acts on each Gauss point: its number, shape functions, their gradients and weight.
    fn points(
        &self,
        entity: &EntityView<'_, NODES>,
        subscales: &[f64],
        view: &StepView<'_>,
        mut act: impl FnMut(usize, &ExplicitPoint, [&[f64; NODES]; 2], &[[f64; DIM]; NODES], f64),
    ) -> Result<(), String> {
        let share = view.info.value_or(STAGE, 0.0);
        let length = view.info.delta_time;
        let unknown = Some(self.columns.unknown.column);
        let [now, old] = [0, 1].map(|level| nodal(entity, view, unknown, level));
        let [source, earlier] = [0, 1].map(|level| nodal(entity, view, self.columns.volume_source, level));
        let projection = nodal(entity, view, Some("PROJECTED_SCALAR1"), 0);
        let velocity = velocities(entity, view, &self.columns, share);
        let [conductivity, density, specific_heat] = self.material.in_element(entity, view, &now);
        self.material.check_conductivity(entity, &conductivity)?;
        let plastic = plastic_heat::<NODES, DIM>(view, entity.index, (self.rule, &entity.current), |_| 1.0);
        let size = stream_size(self.rule.shape(), &entity.current);
        let beta = if T::DYNAMIC { 1.0 } else { view.info.value_or(DYNAMIC_TAU, 1.0) };
        for (g, n) in self.rule.n::<NODES>().iter().enumerate() {
            let (dn, determinant) = physical_gradients(&entity.current, &self.rule.dn::<NODES, DIM>()[g]);
            if determinant <= 0.0 {
                return Err("it is inverted".to_owned());
            }
            let value = |at: &[f64; NODES]| n.iter().zip(at).map(|(n, value)| n * value).sum::<f64>();
            let temperature = value(&now);
            let capacity = Self::capacity([&density, &specific_heat], temperature);
            let conductivity = conductivity.at(n, temperature);
            let velocity: [f64; 3] =
                std::array::from_fn(|a| if a < DIM { (0..NODES).map(|i| n[i] * velocity[i][a]).sum() } else { 0.0 });
            let speed = along(velocity, velocity).sqrt();
            let inverse = capacity * (beta / length + 2.0 * speed / size) + 4.0 * conductivity / (size * size);
            let before = T::DYNAMIC.then(|| [subscales[g], length]);
            let point = ExplicitPoint {
                conductivity,
                capacity,
                velocity,
                source: (1.0 - share) * value(&earlier) + share * value(&source) + plastic,
                tau: if inverse > 0.0 { inverse.recip() } else { 0.0 },
                old: value(&old),
                since: share * length,
                known: value(&projection) + before.map_or(0.0, |[before, length]| before / length),
                before,
                projecting: view.info.has(PROJECTING),
            };
            act(g, &point, [n, &now], &dn, self.rule.weight(g) * determinant);
        }
        Ok(())
    }

    /// ρc.
    fn capacity([density, specific_heat]: [&Local<'_, NODES>; 2], temperature: f64) -> f64 {
        density.mean(temperature) * specific_heat.mean(temperature)
    }
}

impl<T: Subscales, const NODES: usize, const DIM: usize> Kernel<NODES, NODES> for Explicit<T, NODES, DIM> {
    /// Subscales at the points, where they are dynamic.
    type State = Box<[f64]>;

    fn unknowns() -> [LocalUnknown; NODES] {
        LocalUnknown::of_nodes(crate::variables::TEMPERATURE.scalar())
    }

    fn own_unknowns(&self) -> [LocalUnknown; NODES] {
        LocalUnknown::of_nodes(self.columns.unknown)
    }

    fn new(request: &BlockRequest<'_>) -> Result<Self> {
        let columns = Columns::of(request.part);
        let Material { conductivity, density, specific_heat } = Material::of(request, &columns);
        if density.varies() || specific_heat.varies() {
            let fact = "explicit steps hold density and specific heat, which a table lets depend on the temperature";
            let place = properties_of(request).map(|properties| properties.place.clone()).unwrap_or_default();
            let remedy = "give them as numbers, or use \"time_integration_method\": \"implicit\"";
            return Err(Diagnostic::error("unsupported", fact).at(place).remedy(remedy).into());
        }
        let shape = Shape::of(DIM, NODES).expect("elements are registered for known shapes only");
        Ok(Self {
            material: Material { conductivity, density: density.or(1.0), specific_heat: specific_heat.or(1.0) },
            columns,
            rule: ShapeTable::get(shape, full_order(shape)),
            subscales: PhantomData,
        })
    }

    fn fits(&self, own: &Self::State, saved: &Self::State) -> bool {
        own.len() == saved.len()
    }

    fn state(&self, entity: &EntityView<'_, NODES>, _view: &StepView<'_>) -> Result<Box<[f64]>, String> {
        check_volume::<NODES, DIM>(self.rule, &entity.current)?;
        Ok(vec![0.0; if T::DYNAMIC { self.rule.len() } else { 0 }].into())
    }

    fn tangent(&self) -> Tangent {
        Tangent::Unsymmetric
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, NODES>,
        state: &Box<[f64]>,
        view: &StepView<'_>,
        request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; NODES],
    ) -> Result<(), String> {
        self.points(entity, state, view, |_, point, [n, now], dn, weight| match request {
            Request::External => (0..NODES).for_each(|i| rhs[i] += weight * n[i] * point.source),
            Request::Storage => {}
            Request::Residual | Request::Both => add(point, [n, now], dn, weight, lhs, rhs),
        })
    }

    fn mass(
        &self,
        entity: &EntityView<'_, NODES>,
        _state: &Box<[f64]>,
        view: &StepView<'_>,
        lumped: bool,
        out: &mut [f64],
    ) -> bool {
        let now = nodal(entity, view, Some(self.columns.unknown.column), 0);
        let [_, density, specific_heat] = self.material.in_element(entity, view, &now);
        for (g, n) in self.rule.n::<NODES>().iter().enumerate() {
            let (_, determinant) = physical_gradients(&entity.current, &self.rule.dn::<NODES, DIM>()[g]);
            let capacity = Self::capacity([&density, &specific_heat], 0.0);
            let weight = capacity * self.rule.weight(g) * determinant;
            for i in 0..NODES {
                match lumped {
                    true => out[i * NODES + i] += weight * n[i],
                    false => (0..NODES).for_each(|j| out[i * NODES + j] += weight * n[i] * n[j]),
                }
            }
        }
        true
    }

    fn has_history(&self, state: &Box<[f64]>) -> bool {
        !state.is_empty()
    }

    fn accept(
        &self,
        entity: &EntityView<'_, NODES>,
        state: &mut Box<[f64]>,
        view: &StepView<'_>,
    ) -> Result<(), String> {
        if state.is_empty() {
            return Ok(());
        }
        let before = state.clone();
        self.points(entity, &before, view, |g, point, [n, now], dn, _| {
            let value = n.iter().zip(now).map(|(n, value)| n * value).sum::<f64>();
            state[g] = point.subscale(value, slope(dn, now));
        })
    }

    fn inherit(&self, state: &mut Box<[f64]>, earlier: &Box<[f64]>) {
        if state.len() == earlier.len() {
            state.copy_from_slice(earlier);
        }
    }
}
