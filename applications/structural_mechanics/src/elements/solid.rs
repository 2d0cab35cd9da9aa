//! The solid element: internal forces ∫ Bᵀ s dV, tangent ∫ (Bᵀ D B + ∇N·s·∇N 1) dV, body forces, mass.
//!
//! `dn` are gradients of the shape functions on the formulation's configuration, s the stress that works there. The
//! rows of B follow the Voigt order of [`crate::tensor`]; total Lagrangian B holds F, the others do not. With mean
//! dilatation (B-bar, Hughes 1980) θ = div u gives way to its mean over the element, θ̄ = Σ (∫ ∂N_i dV / V) · u_i:
//! ε̄ = ε + (θ̄ − θ)/3 1, in the plane with its component across. The element remembers what its law does at each point.

use std::f64::consts::PI;
use std::marker::PhantomData;

use zelus_core::diagnostics::Result;
use zelus_core::entities::{BlockRequest, Gather, Gauss, Kernel, LocalUnknown, StepView, Tangent, Want};
use zelus_core::geometry::{Shape, ShapeTable};
use zelus_core::model::Variable;
use zelus_core::model::variables::DISPLACEMENT;

use super::formulation::Formulation;
use super::material::Material;
use super::results;
use crate::laws::StrainState;
use crate::tensor::{
    IDENTITY, Tensor, determinant, pairs, product, strain_vector, stress_tensor, stress_vector, transposed,
};
use crate::variables::VOLUME_ACCELERATION;

/// Solid element with `NODES` nodes in `DIM` dimensions and `S` strains (3 plane, 4 axisymmetric or plane B-bar, 6 solid).
pub struct Solid<F, const NODES: usize, const DIM: usize, const S: usize> {
    pub(super) shape: Shape,
    pub(super) materials: Vec<Material<S>>,
    tangent: Tangent,
    formulation: PhantomData<fn() -> F>,
}

/// One Gauss point of one element.
pub(super) struct Point<'a, const NODES: usize, const DIM: usize, const S: usize> {
    /// Gradients of the shape functions on the formulation's configuration.
    dn: [[f64; DIM]; NODES],
    /// Shape functions over the radius of that configuration; zero without axial symmetry.
    hoop: [f64; NODES],
    /// Mean gradients less those of the point, over 3; zero without mean dilatation.
    excess: [[f64; DIM]; NODES],
    /// Volume on the formulation's configuration that the point stands for.
    weight: f64,
    /// Strain, deformation gradient and what the law remembers.
    pub(super) state: StrainState<'a, S>,
}

/// The motion of an element's nodes as a formulation reads it.
pub(super) struct Motion<const NODES: usize> {
    /// Displacements that strain the element (length).
    u: [[f64; 3]; NODES],
    /// Where DISPLACEMENT is ahead of the mesh: present displacements less those of the step, and those at its start.
    ///
    /// The deformation of the step is then the one from the first to `u`, as in the reference program, whose updated
    /// Lagrangian elements take the start of the step from present positions and DISPLACEMENT.
    ahead: Option<[[[f64; 3]; NODES]; 2]>,
}

/// Σ x_i ⊗ ∂N_i: Jacobian of a map with values `x` at the nodes.
pub(super) fn gradient<const NODES: usize, const DIM: usize>(
    x: &[[f64; 3]; NODES],
    dn: &[[f64; DIM]; NODES],
) -> [[f64; DIM]; DIM] {
    let mut out = [[0.0; DIM]; DIM];
    for (x, dn) in x.iter().zip(dn) {
        for a in 0..DIM {
            for b in 0..DIM {
                out[a][b] += x[a] * dn[b];
            }
        }
    }
    out
}

/// A square matrix in the upper left of the unit tensor.
pub(super) fn padded<const DIM: usize>(a: &[[f64; DIM]; DIM]) -> Tensor {
    let mut out = IDENTITY;
    for i in 0..DIM {
        out[i][..DIM].copy_from_slice(&a[i]);
    }
    out
}

/// Gradients with respect to the positions `x`, and the determinant of the map from the reference cell.
pub(super) fn physical_gradients<const NODES: usize, const DIM: usize>(
    x: &[[f64; 3]; NODES],
    local: &[[f64; DIM]; NODES],
) -> ([[f64; DIM]; NODES], f64) {
    let jacobian = padded(&gradient(x, local));
    let inverse = crate::tensor::inverse(&jacobian);
    let dn = local.map(|dn| {
        let mut out = [0.0; DIM];
        for (a, out) in out.iter_mut().enumerate() {
            *out = (0..DIM).map(|k| dn[k] * inverse[k][a]).sum();
        }
        out
    });
    (dn, determinant(&jacobian))
}

/// Σ N_i x_i of the first coordinate.
fn radius<const NODES: usize>(n: &[f64; NODES], x: &[[f64; 3]; NODES]) -> f64 {
    n.iter().zip(x).map(|(n, x)| n * x[0]).sum()
}

/// Three numbers a node of a column, zeros when nothing has added it.
pub(super) fn nodal_vectors<const NODES: usize>(
    entity: &Gather<'_, NODES>,
    view: &StepView<'_>,
    variable: &Variable<[f64; 3]>,
) -> [[f64; 3]; NODES] {
    match view.nodes.history.values(variable, 0) {
        [] => [[0.0; 3]; NODES],
        column => entity.vectors(column),
    }
}

impl<F: Formulation, const NODES: usize, const DIM: usize, const S: usize> Solid<F, NODES, DIM, S> {
    const AXISYMMETRIC: bool = S == 4 && !F::MEAN_DILATATION;

    fn material(&self, entity: &Gather<'_, NODES>) -> &Material<S> {
        Material::find(&self.materials, entity.properties.id)
    }

    /// What the formulation reads of the motion of the nodes.
    fn motion(&self, entity: &Gather<'_, NODES>, view: &StepView<'_>) -> Motion<NODES> {
        let displacement = nodal_vectors(entity, view, &DISPLACEMENT);
        if !F::FINITE {
            return Motion { u: displacement, ahead: None };
        }
        let (x, initial) = (&entity.current, &entity.initial);
        let nodes = |of: &dyn Fn(usize, usize) -> f64| std::array::from_fn(|i| std::array::from_fn(|c| of(i, c)));
        let trails = (0..NODES).any(|i| (0..3).any(|c| x[i][c] != initial[i][c] + displacement[i][c]));
        let ahead = (F::PRESENT && trails).then(|| {
            let old: [[f64; 3]; NODES] = match view.nodes.history.values(&DISPLACEMENT, 1) {
                [] => [[0.0; 3]; NODES],
                column => entity.vectors(column),
            };
            [nodes(&|i, c| x[i][c] - initial[i][c] - (displacement[i][c] - old[i][c])), old]
        });
        Motion { u: nodes(&|i, c| x[i][c] - initial[i][c]), ahead }
    }

    /// Volume on the initial configuration that Gauss point `g` stands for, without thickness.
    fn initial_weight(table: &ShapeTable, g: usize, entity: &Gather<'_, NODES>) -> f64 {
        let (_, det) = physical_gradients(&entity.initial, &table.dn::<NODES, DIM>()[g]);
        let turn = if Self::AXISYMMETRIC { 2.0 * PI * radius(&table.n()[g], &entity.initial) } else { 1.0 };
        table.weight(g) * det * turn
    }

    /// Mean over the element of the gradients of the shape functions; zero without mean dilatation.
    fn mean_gradients(material: &Material<S>, entity: &Gather<'_, NODES>) -> [[f64; DIM]; NODES] {
        let mut sum = [[0.0; DIM]; NODES];
        if F::MEAN_DILATATION {
            let mut volume = 0.0;
            for g in 0..material.rule.len() {
                let (dn, det) = physical_gradients(&entity.initial, &material.rule.dn::<NODES, DIM>()[g]);
                let weight = material.rule.weight(g) * det;
                volume += weight;
                for (sum, dn) in sum.iter_mut().zip(&dn) {
                    sum.iter_mut().zip(dn).for_each(|(sum, d)| *sum += weight * d);
                }
            }
            sum.as_flattened_mut().iter_mut().for_each(|d| *d /= volume);
        }
        sum
    }

    /// Kinematics at Gauss point `g` of a motion; `mean` are the mean gradients, `state` is the element's.
    fn point<'a>(
        material: &Material<S>,
        g: usize,
        entity: &Gather<'_, NODES>,
        motion: &Motion<NODES>,
        mean: &[[f64; DIM]; NODES],
        state: &'a [f64],
    ) -> Result<Point<'a, NODES, DIM, S>, String> {
        let table = material.rule;
        let (n, local) = (&table.n::<NODES>()[g], &table.dn::<NODES, DIM>()[g]);
        let (mut dn, mut det) = physical_gradients(&entity.initial, local);
        let u = &motion.u;
        let mut grad_u = gradient(u, &dn);
        if let Some([reference, old]) = &motion.ahead {
            let f = |u| {
                let mut f = padded(&gradient(u, &dn));
                (0..DIM).for_each(|a| f[a][a] += 1.0);
                f
            };
            let since = product(&f(u), &crate::tensor::inverse(&f(reference)));
            let total = product(&since, &f(old));
            for a in 0..DIM {
                for b in 0..DIM {
                    grad_u[a][b] = total[a][b] - IDENTITY[a][b];
                }
            }
        }
        let mut f = IDENTITY;
        let mut h = [[0.0; 3]; 3];
        for a in 0..DIM {
            for b in 0..DIM {
                h[a][b] = if F::FINITE { grad_u[a][b] } else { 0.5 * (grad_u[a][b] + grad_u[b][a]) };
                f[a][b] += h[a][b];
            }
        }
        let mut excess = [[0.0; DIM]; NODES];
        if F::MEAN_DILATATION {
            let mut more = 0.0;
            for (((excess, mean), dn), u) in excess.iter_mut().zip(mean).zip(&dn).zip(u) {
                for a in 0..DIM {
                    excess[a] = (mean[a] - dn[a]) / 3.0;
                    more += excess[a] * u[a];
                }
            }
            (0..3).for_each(|a| {
                h[a][a] += more;
                f[a][a] += more;
            });
        }
        let mut hoop = [0.0; NODES];
        let mut turn = material.thickness;
        if Self::AXISYMMETRIC {
            let present = radius(n, &entity.current);
            let strained = if F::FINITE { radius(n, &entity.initial) } else { present };
            h[2][2] = radius(n, u) / strained;
            f[2][2] += h[2][2];
            let r = if F::FINITE && !F::PRESENT { strained } else { present };
            if r <= 0.0 || r.is_nan() {
                return Err(format!("the radius at Gauss point {} is {r}, not positive", g + 1));
            }
            hoop = n.map(|n| n / r);
            turn = 2.0 * PI * r;
        }
        let mut strain = strain_vector(&h);
        if F::FINITE {
            let square = strain_vector::<S>(&product(&transposed(&h), &h));
            strain.iter_mut().zip(square).for_each(|(e, q)| *e += 0.5 * q);
        }
        let det_f = determinant(&f);
        if (F::FINITE || !material.law.is_linear()) && (det_f <= 0.0 || det_f.is_nan()) {
            return Err(format!("turned inside out at Gauss point {} (det F = {det_f:.3e})", g + 1));
        }
        if F::PRESENT {
            (dn, det) = physical_gradients(&entity.current, local);
        }
        Ok(Point {
            dn,
            hoop,
            excess,
            weight: table.weight(g) * det * turn,
            state: StrainState {
                strain,
                f,
                det_f,
                small: !F::FINITE,
                pressure: 0.0,
                history: material.remembered(g, state),
            },
        })
    }

    /// Volume and pressure of an element that holds one, p = −κ (J̄ − 1); no pressure in others.
    fn pressure(
        material: &Material<S>,
        entity: &Gather<'_, NODES>,
        motion: &Motion<NODES>,
        state: &[f64],
    ) -> Result<[f64; 2], String> {
        let (mut volume, mut change) = (0.0, 0.0);
        if let Some(bulk) = material.law.bulk_of_element() {
            for g in 0..material.rule.len() {
                let point = Self::point(material, g, entity, motion, &[[0.0; DIM]; NODES], state)?;
                volume += point.weight;
                change += point.weight * (point.state.det_f - 1.0);
            }
            change *= -bulk / volume;
        }
        Ok([volume, change])
    }

    /// Derivative of the strain with respect to the displacements, one row a Voigt component.
    fn b_matrix<const SIZE: usize>(point: &Point<'_, NODES, DIM, S>) -> [[f64; SIZE]; S] {
        let total = F::FINITE && !F::PRESENT;
        let mut b = [[0.0; SIZE]; S];
        for (row, (p, q)) in b.iter_mut().zip(pairs::<S>()) {
            for (i, dn) in point.dn.iter().enumerate() {
                if p >= DIM {
                    row[i * DIM] = if total { point.state.f[2][2] } else { 1.0 } * point.hoop[i];
                } else if total {
                    for a in 0..DIM {
                        let f = &point.state.f[a];
                        row[i * DIM + a] = if p == q { f[p] * dn[p] } else { f[p] * dn[q] + f[q] * dn[p] };
                    }
                } else if p == q {
                    row[i * DIM + p] = dn[p];
                } else {
                    row[i * DIM + p] = dn[q];
                    row[i * DIM + q] = dn[p];
                }
                if F::MEAN_DILATATION && p == q {
                    (0..DIM).for_each(|a| row[i * DIM + a] += point.excess[i][a]);
                }
            }
        }
        b
    }

    /// ∇N_i · s · ∇N_j on the diagonal of each block of nodes, times the weight; upper triangle.
    fn add_geometric<const SIZE: usize>(
        point: &Point<'_, NODES, DIM, S>,
        stress: &[f64; S],
        lhs: &mut [[f64; SIZE]; SIZE],
    ) {
        let s = stress_tensor(stress);
        for i in 0..NODES {
            let mut traction = [0.0; DIM];
            for (b, t) in traction.iter_mut().enumerate() {
                *t = point.weight * (0..DIM).map(|a| point.dn[i][a] * s[a][b]).sum::<f64>();
            }
            for j in i..NODES {
                let k: f64 = (0..DIM).map(|b| traction[b] * point.dn[j][b]).sum();
                for a in 0..DIM {
                    lhs[i * DIM + a][j * DIM + a] += k;
                }
                lhs[i * DIM][j * DIM] += point.weight * s[2][2] * point.hoop[i] * point.hoop[j];
            }
        }
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

impl<F: Formulation, const NODES: usize, const DIM: usize, const S: usize, const SIZE: usize> Kernel<NODES, SIZE>
    for Solid<F, NODES, DIM, S>
{
    type State = Box<[f64]>;

    fn unknowns() -> [LocalUnknown; SIZE] {
        std::array::from_fn(|row| LocalUnknown {
            node: (row / DIM) as u8,
            variable: DISPLACEMENT.component((row % DIM) as u8),
        })
    }

    fn new(request: &BlockRequest<'_>) -> Result<Self> {
        let shape = Shape::of(DIM, NODES).expect("solids are registered for known shapes only");
        let materials = Material::all(request, shape, DIM == 2 && !Self::AXISYMMETRIC, F::CONSTANT_PRESSURE)?;
        let constant = !F::FINITE && !Self::AXISYMMETRIC && materials.iter().all(|m| m.law.is_linear());
        let tangent = if constant {
            Tangent::Constant
        } else if materials.iter().any(|m| !m.law.is_symmetric(!F::FINITE)) {
            Tangent::General
        } else {
            Tangent::Symmetric
        };
        Ok(Self { shape, materials, tangent, formulation: PhantomData })
    }

    fn state(&self, entity: &Gather<'_, NODES>, _view: &StepView<'_>) -> Result<Box<[f64]>, String> {
        let material = self.material(entity);
        let table = material.rule;
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
        entity: &Gather<'_, NODES>,
        state: &Box<[f64]>,
        view: &StepView<'_>,
        want: Want,
        lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    ) -> Result<(), String> {
        let material = self.material(entity);
        let motion = self.motion(entity, view);
        let acceleration = nodal_vectors(entity, view, &VOLUME_ACCELERATION);
        let whole = self.tangent == Tangent::General;
        let mut upper = [[0.0; SIZE]; SIZE];
        let mut d = [[0.0; S]; S];
        let mean = Self::mean_gradients(material, entity);
        let [volume, pressure] = Self::pressure(material, entity, &motion, state)?;
        // ∫ J Bᵀ C⁻¹ dV
        let mut of_volume = [0.0; SIZE];
        for g in 0..material.rule.len() {
            let mut point = Self::point(material, g, entity, &motion, &mean, state)?;
            point.state.pressure = pressure;
            point.state.small &= !view.decides_normals();
            if material.density > 0.0 {
                self.body_forces(material, &material.rule.n()[g], point.weight, &acceleration, rhs);
            }
            if want == Want::External {
                continue;
            }
            let stress =
                material.law.stress(&point.state, F::MEASURE, if lhs.is_empty() { None } else { Some(&mut d) });
            let b = Self::b_matrix::<SIZE>(&point);
            for (row, s) in b.iter().zip(&stress) {
                for (r, b) in rhs.iter_mut().zip(row) {
                    *r -= point.weight * s * b;
                }
            }
            if lhs.is_empty() {
                continue;
            }
            let mut db = [[0.0; SIZE]; S];
            for (row, d) in db.iter_mut().zip(&d) {
                for (d, b) in d.iter().zip(&b) {
                    let factor = point.weight * d;
                    row.iter_mut().zip(b).for_each(|(out, b)| *out += factor * b);
                }
            }
            for (b, db) in b.iter().zip(&db) {
                for (r, (out, &b)) in upper.iter_mut().zip(b).enumerate() {
                    let first = if whole { 0 } else { r };
                    out[first..].iter_mut().zip(&db[first..]).for_each(|(out, db)| *out += b * db);
                }
            }
            if F::CONSTANT_PRESSURE {
                let f = crate::tensor::inverse(&point.state.f);
                let inverse_c = stress_vector::<S>(&product(&f, &transposed(&f)));
                for (row, k) in b.iter().zip(inverse_c) {
                    let factor = point.weight * point.state.det_f * k;
                    of_volume.iter_mut().zip(row).for_each(|(sum, b)| *sum += factor * b);
                }
            }
            if F::FINITE {
                Self::add_geometric(&point, &stress, &mut upper);
            }
        }
        if let Some(bulk) = material.law.bulk_of_element().filter(|_| !lhs.is_empty()) {
            for (row, x) in upper.iter_mut().zip(&of_volume) {
                row.iter_mut().zip(&of_volume).for_each(|(out, y)| *out += bulk / volume * x * y);
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
        entity: &Gather<'_, NODES>,
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
        for g in 0..table.len() {
            let n = &table.n::<NODES>()[g];
            let (_, det) = physical_gradients(positions, &table.dn::<NODES, DIM>()[g]);
            let turn = if Self::AXISYMMETRIC { 2.0 * PI * radius(n, &entity.current) } else { material.thickness };
            let mass = material.density * table.weight(g) * det * turn;
            for i in 0..NODES {
                for j in 0..NODES {
                    let share = match (lumped, i == j) {
                        (false, _) => n[i] * n[j],
                        (true, true) => n[i],
                        (true, false) => continue,
                    };
                    for a in 0..DIM {
                        out[(i * DIM + a) * SIZE + j * DIM + a] += mass * share;
                    }
                }
            }
        }
        true
    }

    fn accept(&self, entity: &Gather<'_, NODES>, state: &mut Box<[f64]>, view: &StepView<'_>) -> Result<(), String> {
        if state.is_empty() {
            return Ok(());
        }
        let material = self.material(entity);
        let (motion, mean) = (self.motion(entity, view), Self::mean_gradients(material, entity));
        let before = state.clone();
        for (g, history) in state.chunks_exact_mut(material.law.history()).enumerate() {
            material.law.advance(&Self::point(material, g, entity, &motion, &mean, &before)?.state, history);
        }
        Ok(())
    }

    /// A law that remembers as many numbers is taken to be the same.
    fn inherit(&self, state: &mut Box<[f64]>, earlier: &Box<[f64]>) {
        if state.len() == earlier.len() {
            state.copy_from_slice(earlier);
        }
    }

    fn gauss(
        &self,
        entity: &Gather<'_, NODES>,
        state: &Box<[f64]>,
        view: &StepView<'_>,
        variable: &str,
    ) -> Option<Gauss> {
        let material = self.material(entity);
        let (motion, mean) = (self.motion(entity, view), Self::mean_gradients(material, entity));
        let [_, pressure] = Self::pressure(material, entity, &motion, state).ok()?;
        results::gauss(material, F::MEASURE, S == 4 && !F::MEAN_DILATATION, variable, |g| {
            let point = Self::point(material, g, entity, &motion, &mean, state).ok()?;
            let weight = Self::initial_weight(material.rule, g, entity);
            Some((StrainState { pressure, ..point.state }, weight))
        })
    }

    fn gauss_variables() -> &'static [&'static str] {
        results::VARIABLES
    }
}
