//! The solid element: internal forces ∫ Bᵀ s dV, tangent ∫ (Bᵀ D B + ∇N·s·∇N 1) dV, body forces, mass.
//!
//! `dn` are gradients of the shape functions on the formulation's configuration, s the stress that works there. The rows of B follow
//! the Voigt order of [`crate::tensor`]; total Lagrangian B holds F, the others do not. With mean dilatation (B-bar, Hughes 1980) θ =
//! div u is replaced by its mean over the element, θ̄ = Σ (∫ ∂N_i dV / V) · u_i: ε̄ = ε + (θ̄ − θ)/3 1, in the plane with its component
//! across. The element keeps the history of its law at each point.

mod held_pressure;
mod kinematics;
mod traction;

use std::f64::consts::PI;
use std::marker::PhantomData;

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::entities::{
    AssumedSmall, BlockRequest, EntityView, FacePoint, Gauss, Kernel, LocalUnknown, Request, Round, StepView, Tangent,
    round,
};
use zelus_core::geometry::{Shape, ShapeTable};

use self::held_pressure::MODES;
use self::kinematics::radius;
use super::band::{self, BANDS_AS_KRATOS};
use super::formulation::Formulation;
use super::gradients::{displacements, nodal_vectors, physical_gradients};
use super::locking::locking;
use super::material::Material;
use super::results;
use super::small_motion::small_motion;
use super::stiffness::add_stiffness;
use crate::laws::{LawFactory, MakesLaw, StrainState};
use crate::tensor::{inverse, stress_vector};
use crate::variables::VOLUME_ACCELERATION;

/// Solid element with `NODES` nodes in `DIM` dimensions and `S` strains (3 plane, 4 axisymmetric or plane B-bar, 6 solid).
pub struct Solid<F, const NODES: usize, const DIM: usize, const S: usize> {
    pub(super) shape: Shape,
    pub(super) materials: Vec<Material<S>>,
    tangent: Tangent,
    formulation: PhantomData<fn() -> F>,
}

impl<F: Formulation, const NODES: usize, const DIM: usize, const S: usize> Solid<F, NODES, DIM, S> {
    fn material(&self, entity: &EntityView<'_, NODES>) -> &Material<S> {
        Material::find(&self.materials, entity.properties.id)
    }

    fn body_forces<const SIZE: usize>(
        &self,
        material: &Material<S>,
        n: &[f64; NODES],
        weight: f64,
        nodal: &[[f64; 3]; NODES],
        rhs: &mut [f64; SIZE],
    ) {
        for a in 0..DIM {
            let acceleration = material.acceleration[a] + n.iter().zip(nodal).map(|(n, v)| n * v[a]).sum::<f64>();
            let force = weight * material.density * acceleration;
            for (i, n) in n.iter().enumerate() {
                rhs[i * DIM + a] += n * force;
            }
        }
    }
}

/// Adds the mass matrix on `positions`; a thickness of `None` is that of a ring.
fn add_mass<const NODES: usize, const DIM: usize>(
    table: &ShapeTable,
    positions: &[[f64; 3]; NODES],
    density: f64,
    thickness: Option<f64>,
    lumped: bool,
    out: &mut [f64],
) {
    for g in 0..table.len() {
        let n = &table.n::<NODES>()[g];
        let (_, det) = physical_gradients(positions, &table.dn::<NODES, DIM>()[g]);
        let turn = thickness.unwrap_or_else(|| 2.0 * PI * radius(n, positions));
        let mass = density * table.weight(g) * det * turn;
        for i in 0..NODES {
            for j in 0..NODES {
                let share = match (lumped, i == j) {
                    (false, _) => n[i] * n[j],
                    (true, true) => n[i],
                    (true, false) => continue,
                };
                for a in 0..DIM {
                    out[(i * DIM + a) * NODES * DIM + j * DIM + a] += mass * share;
                }
            }
        }
    }
}

impl<F: Formulation, const NODES: usize, const DIM: usize, const S: usize, const SIZE: usize> Kernel<NODES, SIZE>
    for Solid<F, NODES, DIM, S>
where
    LawFactory: MakesLaw<S>,
{
    type State = Box<[f64]>;

    fn unknowns() -> [LocalUnknown; SIZE] {
        displacements(DIM)
    }

    fn new(request: &BlockRequest<'_>) -> Result<Self> {
        let shape = Shape::of(DIM, NODES).expect("solids are registered for known shapes only");
        let materials = Material::all(request, shape, DIM == 2 && !Self::AXISYMMETRIC, F::CONSTANT_PRESSURE)?;
        let constant = !F::FINITE && materials.iter().all(|m| m.law.is_linear());
        let tangent = if constant {
            Tangent::Constant
        } else if materials.iter().any(|m| !m.law.is_symmetric(!F::FINITE)) {
            Tangent::Unsymmetric
        } else {
            Tangent::Symmetric
        };
        Ok(Self { shape, materials, tangent, formulation: PhantomData })
    }

    fn fits(&self, own: &Self::State, saved: &Self::State) -> bool {
        own.len() == saved.len()
    }

    fn state(&self, entity: &EntityView<'_, NODES>, view: &StepView<'_>) -> Result<Box<[f64]>, String> {
        let material = self.material(entity);
        let table = material.rule;
        if material.law.has_axes() {
            Self::axes(entity, view)?;
        }
        material.accepts_band(&|| band::width(table, &entity.initial, view.info.has(BANDS_AS_KRATOS)))?;
        if (0..table.len()).all(|g| Self::initial_weight(table, g, entity) > 0.0) {
            Ok(vec![0.0; table.len() * material.law.history()].into())
        } else if Self::AXISYMMETRIC {
            Err("inverted in the mesh, without area, or on the negative side of the axis x = 0".into())
        } else {
            Err("inverted in the mesh or without volume".into())
        }
    }

    fn tangent(&self) -> Tangent {
        self.tangent
    }

    fn local_system(
        &self,
        entity: &EntityView<'_, NODES>,
        state: &Box<[f64]>,
        view: &StepView<'_>,
        request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    ) -> Result<(), String> {
        let material = self.material(entity);
        let motion = self.motion(entity, view);
        let acceleration = nodal_vectors(entity, view, &VOLUME_ACCELERATION);
        let whole = self.tangent == Tangent::Unsymmetric;
        let mut upper = [[0.0; SIZE]; SIZE];
        let mut d = [[0.0; S]; S];
        let mean = Self::mean_gradients(material, entity);
        let pressure = Self::pressure(material, entity, &motion, state)?;
        let before = if lhs.is_empty() { None } else { Self::pressure_before(material, entity, view, &motion, state) };
        // ∫ φ_k J Bᵀ C⁻¹ dV
        let mut of_volume = [[0.0; SIZE]; MODES];
        for g in 0..material.rule.len() {
            let mut point = Self::point(material, g, entity, &motion, &mean, state)?;
            let modes = Self::modes(&material.rule.n()[g], entity);
            point.state.pressure = pressure.at(&modes);
            point.state.small &= !view.decides_normals();
            if material.density > 0.0 {
                self.body_forces(material, &material.rule.n()[g], point.weight, &acceleration, rhs);
            }
            if request == Request::External {
                continue;
            }
            let mut stress =
                material.law.stress(&point.state, F::MEASURE, if lhs.is_empty() { None } else { Some(&mut d) });
            Self::subtract_internal(&point, &stress, rhs);
            if lhs.is_empty() {
                continue;
            }
            if let Some(before) = &before {
                let (own, start) = (point.state.pressure, before.at(&modes));
                if (own - start).abs() > material.shear {
                    point.state.pressure = own.clamp(start - material.shear, start + material.shear);
                    stress = material.law.stress(&point.state, F::MEASURE, Some(&mut d));
                }
            }
            let b = Self::b_matrix::<SIZE>(&point);
            add_stiffness(point.weight, &d, &b, whole, &mut upper);
            if F::CONSTANT_PRESSURE {
                let f = inverse(&point.state.f);
                let inverse_c = stress_vector::<S>(&(f * f.transpose()));
                for (row, k) in b.iter().zip(inverse_c) {
                    for (sums, mode) in of_volume.iter_mut().zip(modes).filter(|(_, mode)| *mode != 0.0) {
                        let factor = mode * point.weight * point.state.det_f * k;
                        sums.iter_mut().zip(row).for_each(|(sum, b)| *sum += factor * b);
                    }
                }
            }
            if F::FINITE {
                Self::add_geometric(&point, &stress, whole, &mut upper);
            }
        }
        if let Some(bulk) = material.law.bulk_of_element().filter(|_| !lhs.is_empty()) {
            let held = if F::LINEAR_PRESSURE { DIM + 1 } else { 1 };
            for (k, l) in (0..held).flat_map(|k| (0..held).map(move |l| (k, l))) {
                let factor = bulk * pressure.inverse[(k, l)];
                for (row, x) in upper.iter_mut().zip(&of_volume[k]) {
                    row.iter_mut().zip(&of_volume[l]).for_each(|(out, y)| *out += factor * x * y);
                }
            }
        }
        if !lhs.is_empty() {
            for r in 0..SIZE {
                lhs[r * SIZE + r] += upper[r][r];
                for c in r + 1..SIZE {
                    lhs[r * SIZE + c] += upper[r][c];
                    lhs[c * SIZE + r] += if whole { upper[c][r] } else { upper[r][c] };
                }
            }
        }
        Ok(())
    }

    fn has_external(&self, view: &StepView<'_>) -> bool {
        Material::have_weight(&self.materials, view)
    }

    /// Consistent: ∫ ρ N_i N_j on the initial configuration, one Gauss order above the element's.
    /// Lumped: ∫ ρ N_i on the present configuration; middles of 8-node quadrilaterals then outweigh the corners.
    fn mass(
        &self,
        entity: &EntityView<'_, NODES>,
        _state: &Box<[f64]>,
        _view: &StepView<'_>,
        lumped: bool,
        out: &mut [f64],
    ) -> bool {
        let material = self.material(entity);
        let lumped = lumped || material.lumped;
        let order = self.shape.cell().default_order + usize::from(!lumped);
        let table = ShapeTable::get(self.shape, order);
        let positions = if lumped { &entity.current } else { &entity.initial };
        let thickness = (!Self::AXISYMMETRIC).then_some(material.thickness);
        add_mass::<NODES, DIM>(table, positions, material.density, thickness, lumped, out);
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
        let material = self.material(entity);
        if matches!(round(), Round::Noting(_)) && !material.law.is_computed_together() {
            return Ok(());
        }
        let (motion, mean) = (self.motion(entity, view), Self::mean_gradients(material, entity));
        let before = state.clone();
        for (g, history) in state.chunks_exact_mut(material.law.history()).enumerate() {
            material.law.advance(&Self::point(material, g, entity, &motion, &mean, &before)?.state, history);
        }
        Ok(())
    }

    fn accepts_together(&self) -> bool {
        self.materials.iter().any(|material| material.law.is_computed_together())
    }

    /// A law with as many numbers of history is taken to be the same.
    fn inherit(&self, state: &mut Box<[f64]>, earlier: &Box<[f64]>) {
        if state.len() == earlier.len() {
            state.copy_from_slice(earlier);
        }
    }

    fn gauss(
        &self,
        entity: &EntityView<'_, NODES>,
        state: &Box<[f64]>,
        view: &StepView<'_>,
        variable: &str,
    ) -> Option<Gauss> {
        let material = self.material(entity);
        let (motion, mean) = (self.motion(entity, view), Self::mean_gradients(material, entity));
        let pressure = Self::pressure(material, entity, &motion, state).ok()?;
        results::gauss(material, F::MEASURE, S == 4 && !F::MEAN_DILATATION, variable, &|g| {
            let point = Self::point(material, g, entity, &motion, &mean, state).ok()?;
            let weight = Self::initial_weight(material.rule, g, entity);
            let pressure = pressure.at(&Self::modes(&material.rule.n()[g], entity));
            Some((StrainState { pressure, ..point.state }, weight))
        })
    }

    fn gauss_variables(&self) -> &'static [&'static str] {
        results::variables(&self.materials)
    }

    fn warnings(request: &BlockRequest<'_>) -> Vec<Diagnostic> {
        let averages_volume = F::MEAN_DILATATION || F::CONSTANT_PRESSURE;
        if averages_volume { Vec::new() } else { locking(request, F::FINITE).into_iter().collect() }
    }

    fn assumed_small(&self, entity: &EntityView<'_, NODES>, view: &StepView<'_>) -> Option<AssumedSmall> {
        (!F::FINITE).then(|| small_motion::<NODES, DIM>(self.shape, entity, view))
    }

    fn lacks_tractions(&self, entity: &EntityView<'_, NODES>) -> Option<&'static str> {
        Self::unknown_tractions(self.material(entity))
    }

    fn traction(
        &self,
        entity: &EntityView<'_, NODES>,
        point: &FacePoint,
        displacements: &[[f64; 3]; NODES],
        by: Option<&mut [[f64; 3]; SIZE]>,
    ) -> Result<[f64; 3], String> {
        self.face_traction(self.material(entity), entity, point, displacements, by)
    }
}
