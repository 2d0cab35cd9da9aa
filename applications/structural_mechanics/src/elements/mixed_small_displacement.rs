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
use zelus_core::entities::Request;

use super::gradients::{gradient, padded, strain_rows};
use super::mixed_volumetric_strain::{Matter, Place, Values, VolumetricForm, register_mixed};
use crate::laws::{ConstitutiveLaw, Matrix, StrainState, StressMeasure};
use crate::tensor::{IDENTITY, Tensor, inverse, strain_vector};

/// Small strain whose volumetric part is that of the nodes.
#[derive(Debug)]
pub struct MixedSmallDisplacement;

/// Nodal less kinematic volumetric strain, e − div u.
fn excess<const NODES: usize, const DIM: usize>(at: &Place<'_, NODES, DIM>, values: &Values<NODES>) -> f64 {
    let nodal: f64 = at.n.iter().zip(&values.theta).map(|(n, e)| n * e).sum();
    let grad_u = gradient(&values.u, &at.dn);
    nodal - (0..DIM).map(|a| grad_u[a][a]).sum::<f64>()
}

/// τ₁, the trace of (Σ B_iᵀ D B_i)⁻¹.
fn flexibility<const NODES: usize, const DIM: usize, const S: usize>(d: &Matrix<S>, dn: &[[f64; DIM]; NODES]) -> f64 {
    let mut sum = [[0.0; DIM]; DIM];
    for b in dn.iter().map(|dn| strain_rows::<DIM, S>(&IDENTITY, dn)) {
        for (s, t) in (0..S).flat_map(|s| (0..S).map(move |t| (s, t))).filter(|&(s, t)| d[s][t] != 0.0) {
            for (sum, x) in sum.iter_mut().zip(&b[s]) {
                sum.iter_mut().zip(&b[t]).for_each(|(sum, y)| *sum += x * d[s][t] * y);
            }
        }
    }
    let flexibility = inverse(&padded(&sum));
    (0..DIM).map(|a| flexibility[(a, a)]).sum()
}

impl VolumetricForm for MixedSmallDisplacement {
    const FINITE: bool = false;

    fn state<'a, const NODES: usize, const DIM: usize, const S: usize>(
        at: &Place<'_, NODES, DIM>,
        values: &Values<NODES>,
        law: &dyn ConstitutiveLaw<S>,
        history: &'a [f64],
    ) -> Result<StrainState<'a, S>, String> {
        let grad_u = gradient(&values.u, &at.dn);
        let mut h = Tensor::zeros();
        for a in 0..DIM {
            for b in 0..DIM {
                h[(a, b)] = 0.5 * (grad_u[a][b] + grad_u[b][a]);
            }
        }
        let share = excess(at, values) / DIM as f64;
        (0..DIM).for_each(|a| h[(a, a)] += share);
        let f = IDENTITY + h;
        let det_f = f.determinant();
        if !law.is_linear() && (det_f <= 0.0 || det_f.is_nan()) {
            return Err(format!("turned inside out at Gauss point {} (det F = {det_f:.3e})", at.g + 1));
        }
        Ok(StrainState { strain: strain_vector(&h), f, det_f, small: true, history, ..StrainState::REST })
    }

    fn add<const NODES: usize, const DIM: usize, const S: usize, const SIZE: usize>(
        at: &Place<'_, NODES, DIM>,
        values: &Values<NODES>,
        matter: &Matter<'_, DIM, S>,
        state: &StrainState<'_, S>,
        request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    ) {
        let (step, bulk) = (DIM + 1, matter.bulk);
        let tau_1 = flexibility(matter.initial, &at.dn);
        let tau_2 = (4.0 * matter.shear / bulk).min(0.01);
        for (i, dn) in at.dn.iter().enumerate() {
            for a in 0..DIM {
                rhs[i * step + a] += at.weight * at.n[i] * matter.body[a];
                rhs[i * step + DIM] += at.weight * bulk * tau_1 * dn[a] * matter.body[a];
            }
        }
        if request == Request::External {
            return;
        }
        let theta = excess(at, values);
        let mut slopes = [0.0; DIM];
        for (dn, e) in at.dn.iter().zip(&values.theta) {
            slopes.iter_mut().zip(dn).for_each(|(sum, dn)| *sum += dn * e);
        }
        let mut d = [[0.0; S]; S];
        let wanted = if lhs.is_empty() { None } else { Some(&mut d) };
        let mut stress = matter.law.stress(state, StressMeasure::Pk2, wanted);
        stress[..DIM].iter_mut().for_each(|s| *s -= bulk * tau_2 * theta);
        let b = at.dn.map(|dn| strain_rows::<DIM, S>(&IDENTITY, &dn));
        for i in 0..NODES {
            for (row, s) in b[i].iter().zip(&stress) {
                row.iter().enumerate().for_each(|(a, b)| rhs[i * step + a] -= at.weight * b * s);
            }
            let slope: f64 = at.dn[i].iter().zip(&slopes).map(|(dn, e)| dn * e).sum();
            rhs[i * step + DIM] += at.weight * bulk * ((1.0 - tau_2) * at.n[i] * theta + bulk * tau_1 * slope);
        }
        if lhs.is_empty() {
            return;
        }
        // derivative of the stress with respect to θ
        let across: [f64; S] = std::array::from_fn(|s| {
            let normal = if s < DIM { bulk * tau_2 } else { 0.0 };
            d[s][..DIM].iter().sum::<f64>() / DIM as f64 - normal
        });
        for j in 0..NODES {
            // σ of a displacement of node j in each direction: D B_j less the part of θ
            let mut moved = [[0.0; DIM]; S];
            for s in 0..S {
                for a in 0..DIM {
                    let strained: f64 = (0..S).map(|t| d[s][t] * b[j][t][a]).sum();
                    moved[s][a] = strained - across[s] * at.dn[j][a];
                }
            }
            for i in 0..NODES {
                for s in 0..S {
                    for a in 0..DIM {
                        let entry = (i * step + a) * SIZE + j * step;
                        let force = at.weight * b[i][s][a];
                        (0..DIM).for_each(|c| lhs[entry + c] += force * moved[s][c]);
                        lhs[entry + DIM] += force * across[s] * at.n[j];
                    }
                }
                let entry = (i * step + DIM) * SIZE + j * step;
                let mean = at.weight * (1.0 - tau_2) * bulk * at.n[i];
                (0..DIM).for_each(|c| lhs[entry + c] += mean * at.dn[j][c]);
                let slopes: f64 = at.dn[i].iter().zip(&at.dn[j]).map(|(x, y)| x * y).sum();
                lhs[entry + DIM] -= mean * at.n[j] + at.weight * bulk * bulk * tau_1 * slopes;
            }
        }
    }
}

register_mixed! { "SmallDisplacementMixedVolumetricStrainElement", MixedSmallDisplacement, 3,
"Planar solid for small displacements with VOLUMETRIC_STRAIN at the nodes, against volumetric locking",
"∫ δε : σ(ε + θ/d 1) dV, (1 − τ₂) κ ∫ δe θ dV, θ = e − div u; ASGS";
2: "2D3N" 3, "2D4N" 4 }

register_mixed! { "SmallDisplacementMixedVolumetricStrainElement", MixedSmallDisplacement, 6,
"Solid for small displacements with VOLUMETRIC_STRAIN at the nodes, against volumetric locking",
"∫ δε : σ(ε + θ/d 1) dV, (1 − τ₂) κ ∫ δe θ dV, θ = e − div u; ASGS";
3: "3D4N" 4, "3D8N" 8 }
