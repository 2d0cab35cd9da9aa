//! Small displacements with the volumetric strain as an unknown of the nodes, against volumetric locking.
//!
//! With e = Σ N_i e_i, θ = e − div u and m the unit strain of a change of volume, the stress is that of the strain
//! ε = B u + m θ/d, d the number of dimensions, less κ τ₂ θ m. The forces are
//!
//! displacements: ∫ N_i b − B_iᵀ (σ(ε) − κ τ₂ θ m) dV,
//! volumetric strain: ∫ (1 − τ₂) κ N_i θ + κ τ₁ ∇N_i · (κ ∇e + b) dV.
//!
//! The terms with τ are algebraic subscales (ASGS; Cervera, Chiumenti and Codina 2010), so that displacements and
//! strain can have the same shape functions: τ₁ = tr (Σ B_iᵀ D B_i)⁻¹ (length² over stress), τ₂ = min(0.01, 4 μ/κ), κ
//! the sum of the normal block of D over d². D is the law's matrix without strain: the stabilisation does not change
//! with plastic flow (in the reference program it follows the law's matrix), and inertia stays out of it.

use zelus_core::diagnostics::Result;
use zelus_core::entities::{BlockRequest, Gather, Gauss, Kernel, KernelBlock, LocalUnknown, StepView, Tangent, Want};
use zelus_core::geometry::{Shape, ShapeTable};
use zelus_core::model::variables::DISPLACEMENT;
use zelus_core::registry::Build;

use super::material::Material;
use super::results;
use super::solid::{gradient, nodal_vectors, padded, physical_gradients};
use crate::laws::{ConstitutiveLaw, Matrix, StrainState, StressMeasure};
use crate::tensor::{IDENTITY, determinant, inverse, pairs, strain_vector};
use crate::variables::{VOLUME_ACCELERATION, VOLUMETRIC_STRAIN};

/// Order of the Gauss rule of every shape.
const ORDER: usize = 2;

/// Element of displacements and volumetric strain with `NODES` nodes in `DIM` dimensions and `S` strains.
pub struct MixedVolumetricStrain<const NODES: usize, const DIM: usize, const S: usize> {
    materials: Vec<Material<S>>,
    tangent: Tangent,
}

/// One Gauss point of one element.
struct Point<'a, const NODES: usize, const DIM: usize, const S: usize> {
    n: &'a [f64; NODES],
    dn: [[f64; DIM]; NODES],
    /// Volume that the point stands for.
    weight: f64,
    /// Nodal less kinematic volumetric strain, e − div u.
    theta: f64,
    /// ∇e.
    gradient: [f64; DIM],
    state: StrainState<'a, S>,
}

/// Constants of the stabilisation at a point.
struct Stabilisation {
    bulk: f64,
    tau_1: f64,
    tau_2: f64,
}

/// Nodal values of one element.
struct Values<const NODES: usize> {
    u: [[f64; 3]; NODES],
    e: [f64; NODES],
}

/// The law's matrix without strain.
fn initial_matrix<const S: usize>(law: &dyn ConstitutiveLaw<S>) -> Matrix<S> {
    let mut d = [[0.0; S]; S];
    let history = vec![0.0; law.history()];
    let state =
        StrainState { strain: [0.0; S], f: IDENTITY, det_f: 1.0, small: true, pressure: 0.0, history: &history };
    law.stress(&state, StressMeasure::Pk2, Some(&mut d));
    d
}

/// Bulk and shear modulus of an isotropic matrix, the bulk modulus that of the plane in the plane.
fn moduli<const S: usize>(d: &Matrix<S>, dim: usize) -> (f64, f64) {
    let bulk = d[..dim].iter().flat_map(|row| &row[..dim]).sum::<f64>() / (dim * dim) as f64;
    (bulk, d[dim][dim])
}

/// The rows of B that belong to one node.
fn b_of<const DIM: usize, const S: usize>(dn: &[f64; DIM]) -> [[f64; DIM]; S] {
    pairs::<S>().map(|(p, q)| {
        let mut row = [0.0; DIM];
        row[p] += if p == q { dn[p] } else { dn[q] };
        if p != q {
            row[q] += dn[p];
        }
        row
    })
}

impl<const NODES: usize, const DIM: usize, const S: usize> MixedVolumetricStrain<NODES, DIM, S> {
    fn material(&self, entity: &Gather<'_, NODES>) -> &Material<S> {
        Material::find(&self.materials, entity.properties.id)
    }

    fn values(entity: &Gather<'_, NODES>, view: &StepView<'_>) -> Values<NODES> {
        let e = match view.nodes.history.values(&VOLUMETRIC_STRAIN, 0) {
            [] => [0.0; NODES],
            column => entity.scalars(column),
        };
        Values { u: nodal_vectors(entity, view, &DISPLACEMENT), e }
    }

    fn point<'a>(
        material: &Material<S>,
        g: usize,
        entity: &Gather<'_, NODES>,
        values: &Values<NODES>,
        state: &'a [f64],
    ) -> Result<Point<'a, NODES, DIM, S>, String> {
        let n = &material.rule.n::<NODES>()[g];
        let (dn, det) = physical_gradients(&entity.initial, &material.rule.dn::<NODES, DIM>()[g]);
        let grad_u = gradient(&values.u, &dn);
        let mut theta = n.iter().zip(&values.e).map(|(n, e)| n * e).sum::<f64>();
        let mut h = [[0.0; 3]; 3];
        for a in 0..DIM {
            theta -= grad_u[a][a];
            for b in 0..DIM {
                h[a][b] = 0.5 * (grad_u[a][b] + grad_u[b][a]);
            }
        }
        (0..DIM).for_each(|a| h[a][a] += theta / DIM as f64);
        let mut f = h;
        (0..3).for_each(|a| f[a][a] += 1.0);
        let det_f = determinant(&f);
        if !material.law.is_linear() && (det_f <= 0.0 || det_f.is_nan()) {
            return Err(format!("turned inside out at Gauss point {} (det F = {det_f:.3e})", g + 1));
        }
        let mut gradient = [0.0; DIM];
        for (dn, e) in dn.iter().zip(&values.e) {
            gradient.iter_mut().zip(dn).for_each(|(sum, dn)| *sum += dn * e);
        }
        let history = material.remembered(g, state);
        let state = StrainState { strain: strain_vector(&h), f, det_f, small: true, pressure: 0.0, history };
        Ok(Point { n, dn, weight: material.rule.weight(g) * det * material.thickness, theta, gradient, state })
    }

    fn stabilisation(d: &Matrix<S>, dn: &[[f64; DIM]; NODES]) -> Stabilisation {
        let mut sum = [[0.0; DIM]; DIM];
        for b in dn.iter().map(|dn| b_of::<DIM, S>(dn)) {
            for (s, t) in (0..S).flat_map(|s| (0..S).map(move |t| (s, t))).filter(|&(s, t)| d[s][t] != 0.0) {
                for (sum, x) in sum.iter_mut().zip(&b[s]) {
                    sum.iter_mut().zip(&b[t]).for_each(|(sum, y)| *sum += x * d[s][t] * y);
                }
            }
        }
        let flexibility = inverse(&padded(&sum));
        let (bulk, shear) = moduli(d, DIM);
        Stabilisation { bulk, tau_1: (0..DIM).map(|a| flexibility[a][a]).sum(), tau_2: (4.0 * shear / bulk).min(0.01) }
    }
}

impl<const NODES: usize, const DIM: usize, const S: usize, const SIZE: usize> Kernel<NODES, SIZE>
    for MixedVolumetricStrain<NODES, DIM, S>
{
    type State = Box<[f64]>;

    fn unknowns() -> [LocalUnknown; SIZE] {
        std::array::from_fn(|row| LocalUnknown {
            node: (row / (DIM + 1)) as u8,
            variable: match row % (DIM + 1) {
                a if a < DIM => DISPLACEMENT.component(a as u8),
                _ => VOLUMETRIC_STRAIN.scalar(),
            },
        })
    }

    fn new(request: &BlockRequest<'_>) -> Result<Self> {
        let shape = Shape::of(DIM, NODES).expect("registered for known shapes only");
        let mut materials = Material::all(request, shape, DIM == 2, false)?;
        materials.iter_mut().for_each(|material| material.rule = ShapeTable::get(shape, ORDER));
        let linear = materials.iter().all(|m| m.law.is_linear());
        Ok(Self { materials, tangent: if linear { Tangent::Constant } else { Tangent::General } })
    }

    fn state(&self, entity: &Gather<'_, NODES>, _view: &StepView<'_>) -> Result<Box<[f64]>, String> {
        let material = self.material(entity);
        let table = material.rule;
        let det = |g| physical_gradients::<NODES, DIM>(&entity.initial, &table.dn::<NODES, DIM>()[g]).1;
        if (0..table.len()).all(|g| det(g) > 0.0) {
            Ok(vec![0.0; table.len() * material.law.history()].into())
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
        let values = Self::values(entity, view);
        let acceleration = nodal_vectors(entity, view, &VOLUME_ACCELERATION);
        let initial = initial_matrix(material.law.as_ref());
        let step = DIM + 1;
        let mut d = [[0.0; S]; S];
        for g in 0..material.rule.len() {
            let point = Self::point(material, g, entity, &values, state)?;
            let Stabilisation { bulk, tau_1, tau_2 } = Self::stabilisation(&initial, &point.dn);
            let body: [f64; DIM] = std::array::from_fn(|a| {
                let nodal: f64 = point.n.iter().zip(&acceleration).map(|(n, v)| n * v[a]).sum();
                material.density * (material.acceleration[a] + nodal)
            });
            for (i, dn) in point.dn.iter().enumerate() {
                for a in 0..DIM {
                    rhs[i * step + a] += point.weight * point.n[i] * body[a];
                    rhs[i * step + DIM] += point.weight * bulk * tau_1 * dn[a] * body[a];
                }
            }
            if want == Want::External {
                continue;
            }
            let wanted = if lhs.is_empty() { None } else { Some(&mut d) };
            let mut stress = material.law.stress(&point.state, StressMeasure::Pk2, wanted);
            stress[..DIM].iter_mut().for_each(|s| *s -= bulk * tau_2 * point.theta);
            let b = point.dn.map(|dn| b_of::<DIM, S>(&dn));
            for i in 0..NODES {
                for (row, s) in b[i].iter().zip(&stress) {
                    row.iter().enumerate().for_each(|(a, b)| rhs[i * step + a] -= point.weight * b * s);
                }
                let slope: f64 = point.dn[i].iter().zip(&point.gradient).map(|(dn, e)| dn * e).sum();
                rhs[i * step + DIM] +=
                    point.weight * bulk * ((1.0 - tau_2) * point.n[i] * point.theta + bulk * tau_1 * slope);
            }
            if lhs.is_empty() {
                continue;
            }
            // derivative of the stress with respect to θ
            let across: [f64; S] = std::array::from_fn(|s| {
                let normal = if s < DIM { bulk * tau_2 } else { 0.0 };
                d[s][..DIM].iter().sum::<f64>() / DIM as f64 - normal
            });
            for j in 0..NODES {
                // σ of a displacement of node j in each direction: D B_j less what θ takes away
                let mut moved = [[0.0; DIM]; S];
                for s in 0..S {
                    for a in 0..DIM {
                        let strained: f64 = (0..S).map(|t| d[s][t] * b[j][t][a]).sum();
                        moved[s][a] = strained - across[s] * point.dn[j][a];
                    }
                }
                for i in 0..NODES {
                    for s in 0..S {
                        for a in 0..DIM {
                            let at = (i * step + a) * SIZE + j * step;
                            let force = point.weight * b[i][s][a];
                            (0..DIM).for_each(|c| lhs[at + c] += force * moved[s][c]);
                            lhs[at + DIM] += force * across[s] * point.n[j];
                        }
                    }
                    let at = (i * step + DIM) * SIZE + j * step;
                    let mean = point.weight * (1.0 - tau_2) * bulk * point.n[i];
                    (0..DIM).for_each(|c| lhs[at + c] += mean * point.dn[j][c]);
                    let slopes: f64 = point.dn[i].iter().zip(&point.dn[j]).map(|(x, y)| x * y).sum();
                    lhs[at + DIM] -= mean * point.n[j] + point.weight * bulk * bulk * tau_1 * slopes;
                }
            }
        }
        Ok(())
    }

    fn has_external(&self, view: &StepView<'_>) -> bool {
        Material::have_weight(&self.materials, view)
    }

    /// ∫ ρ N_i N_j on the displacements, its row sums when lumped.
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
        for g in 0..material.rule.len() {
            let n = &material.rule.n::<NODES>()[g];
            let (_, det) = physical_gradients::<NODES, DIM>(&entity.initial, &material.rule.dn::<NODES, DIM>()[g]);
            let mass = material.density * material.rule.weight(g) * det * material.thickness;
            for (i, j) in (0..NODES).flat_map(|i| (0..NODES).map(move |j| (i, j))) {
                let (share, j) = if lumped { (n[i] * n[j], i) } else { (n[i] * n[j], j) };
                for a in 0..DIM {
                    out[(i * (DIM + 1) + a) * SIZE + j * (DIM + 1) + a] += mass * share;
                }
            }
        }
        true
    }

    fn accept(&self, entity: &Gather<'_, NODES>, state: &mut Box<[f64]>, view: &StepView<'_>) -> Result<(), String> {
        if state.is_empty() {
            return Ok(());
        }
        let (material, values) = (self.material(entity), Self::values(entity, view));
        let before = state.clone();
        for (g, history) in state.chunks_exact_mut(material.law.history()).enumerate() {
            material.law.advance(&Self::point(material, g, entity, &values, &before)?.state, history);
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
        let (material, values) = (self.material(entity), Self::values(entity, view));
        results::gauss(material, StressMeasure::Pk2, false, variable, |g| {
            let point = Self::point(material, g, entity, &values, state).ok()?;
            Some((point.state, point.weight / material.thickness))
        })
    }

    fn gauss_variables() -> &'static [&'static str] {
        results::VARIABLES
    }
}

/// Registers the element for shapes.
macro_rules! register_mixed {
    ($about:literal, $strains:literal, $dim:literal: $($suffix:literal $nodes:literal),+) => {
        $(zelus_core::register! { Element concat!("SmallDisplacementMixedVolumetricStrainElement", $suffix),
            about: $about,
            source: "∫ δε : σ(ε + θ/d 1) dV, (1 − τ₂) κ ∫ δe θ dV, θ = e − div u; ASGS",
            cell: Shape::of($dim, $nodes),
            space: $dim,
            nodal: &[("VOLUMETRIC_STRAIN", 1)],
            build: Build::Block(
                KernelBlock::<MixedVolumetricStrain<$nodes, $dim, $strains>, $nodes, { $nodes * ($dim + 1) }>::boxed),
        })+
    };
}

register_mixed! { "Planar solid for small displacements with VOLUMETRIC_STRAIN at the nodes, against volumetric locking",
3, 2: "2D3N" 3, "2D4N" 4 }

register_mixed! { "Solid for small displacements with VOLUMETRIC_STRAIN at the nodes, against volumetric locking",
6, 3: "3D4N" 4, "3D8N" 8 }
