//! Large displacements with the change of volume as an unknown of the nodes, against volumetric locking.
//!
//! With θ = Σ N_i θ_i and d the number of dimensions, the law sees F̄ = ((1 + θ)/J)^{1/d} F, whose determinant in the
//! plane or in space is 1 + θ. With h_i = J F⁻ᵀ ∇N_i the forces are
//!
//! displacements: ∫ N_i b − F S(F̄) ∇N_i + κ τ_θ (θ − J + 1) h_i dV,
//! volumetric strain: κ ∫ (1 − τ_θ) N_i (θ − J + 1) + τ_u h_i · (b + κ Σ θ_j h_j) dV.
//!
//! The terms with τ are algebraic subscales, so that displacements and strain can have the same shape functions: that of the
//! displacements is τ_u times the out-of-balance force, where the pressure κ θ gives the force κ J F⁻ᵀ ∇θ (Piola's identity), and that
//! of θ is τ_θ (J − 1 − θ). τ_u = l²/μ with l the edge of a cube of the element's volume, τ_θ = 0.1 μ/(μ + κ), κ and μ those of the
//! law's matrix without strain. (In the reference program they are those of the present one, l is the present edge, and D : C/d (1 +
//! θ)^{2/d − 1} J^{−2/d}, the derivative of S by θ, stands for κ J C⁻¹ in both terms, without F in the first; for small strains this is
//! the same.)

use zelus_core::diagnostics::Result;
use zelus_core::entities::Request;

use super::gradients::{gradient, padded, strain_rows};
use super::mixed_volumetric_strain::{Matter, Place, Values, VolumetricForm, register_mixed};
use crate::laws::{ConstitutiveLaw, StrainState, StressMeasure};
use crate::tensor::{IDENTITY, Tensor, inverse, strain_vector, stress_tensor};

/// Share of μ/(μ + κ) that is τ_θ.
const TAU_THETA: f64 = 0.1;

/// Finite strain whose volume is that of the nodes.
#[derive(Debug)]
pub struct MixedTotalLagrangian;

/// Deformation of a point by its displacements, and θ.
struct MixedDeformation {
    f: Tensor,
    j: f64,
    theta: f64,
}

impl MixedDeformation {
    fn new<const NODES: usize, const DIM: usize>(at: &Place<'_, NODES, DIM>, values: &Values<NODES>) -> Self {
        let mut f = gradient(&values.u, &at.dn);
        (0..DIM).for_each(|a| f[a][a] += 1.0);
        let f = padded(&f);
        Self { f, j: f.determinant(), theta: at.n.iter().zip(&values.theta).map(|(n, theta)| n * theta).sum() }
    }

    /// ((1 + θ)/J)^{1/d}, by which F is stretched.
    fn stretch(&self, dim: usize) -> f64 {
        ((1.0 + self.theta) / self.j).powf(1.0 / dim as f64)
    }
}

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl VolumetricForm for MixedTotalLagrangian {
    const FINITE: bool = true;

    fn state<'a, const NODES: usize, const DIM: usize, const S: usize>(
        at: &Place<'_, NODES, DIM>,
        values: &Values<NODES>,
        _law: &dyn ConstitutiveLaw<S>,
        history: &'a [f64],
    ) -> Result<StrainState<'a, S>, String> {
        let motion = MixedDeformation::new(at, values);
        for (name, volume) in [("det F", motion.j), ("1 + VOLUMETRIC_STRAIN", 1.0 + motion.theta)] {
            if volume <= 0.0 || volume.is_nan() {
                return Err(format!("turned inside out at Gauss point {} ({name} = {volume:.3e})", at.g + 1));
            }
        }
        let mut f = motion.f;
        let stretch = motion.stretch(DIM);
        (0..DIM).for_each(|a| (0..DIM).for_each(|b| f[(a, b)] *= stretch));
        let strain = strain_vector::<S>(&(f.transpose() * f - IDENTITY)).map(|e| 0.5 * e);
        Ok(StrainState { strain, f, det_f: 1.0 + motion.theta, small: false, history, ..StrainState::REST })
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
        let (step, bulk, weight) = (DIM + 1, matter.bulk, at.weight);
        let tau_u = matter.size * matter.size / matter.shear;
        let tau_theta = TAU_THETA * matter.shear / (matter.shear + bulk);
        let motion = MixedDeformation::new(at, values);
        let (f, j, theta) = (&motion.f, motion.j, motion.theta);
        let back = inverse(f);
        let h = at.dn.map(|dn| -> [f64; DIM] {
            std::array::from_fn(|a| j * (0..DIM).map(|b| back[(b, a)] * dn[b]).sum::<f64>())
        });
        for i in 0..NODES {
            (0..DIM).for_each(|a| rhs[i * step + a] += weight * at.n[i] * matter.body[a]);
            rhs[i * step + DIM] += weight * bulk * tau_u * dot(&h[i], &matter.body);
        }
        if request == Request::External {
            return;
        }
        let mut d = [[0.0; S]; S];
        let wanted = if lhs.is_empty() { None } else { Some(&mut d) };
        let s = stress_tensor(&matter.law.stress(state, StressMeasure::Pk2, wanted));
        let excess = theta - j + 1.0;
        // S ∇N_i, and the out-of-balance force without the body force: κ Σ θ_i h_i
        let pulled =
            at.dn.map(|dn| -> [f64; DIM] { std::array::from_fn(|a| (0..DIM).map(|b| s[(a, b)] * dn[b]).sum()) });
        let mut load = matter.body;
        for (h, theta) in h.iter().zip(&values.theta) {
            load.iter_mut().zip(h).for_each(|(sum, h)| *sum += bulk * theta * h);
        }
        for i in 0..NODES {
            for a in 0..DIM {
                let force: f64 = (0..DIM).map(|b| f[(a, b)] * pulled[i][b]).sum();
                rhs[i * step + a] -= weight * (force - bulk * tau_theta * excess * h[i][a]);
            }
            let sub = tau_u * (dot(&h[i], &load) - dot(&h[i], &matter.body));
            rhs[i * step + DIM] += weight * bulk * ((1.0 - tau_theta) * at.n[i] * excess + sub);
        }
        if lhs.is_empty() {
            return;
        }
        let dim = DIM as f64;
        let scale = motion.stretch(DIM).powi(2);
        // F is that of the displacements alone: C = Fᵀ F as a strain vector
        let c: [f64; S] = strain_vector(&(f.transpose() * f));
        let b = at.dn.map(|dn| strain_rows::<DIM, S>(f, &dn));
        // D times the change of the law's strain with the volume at fixed displacements, of 1 + θ to its first power
        let swollen: [f64; S] = std::array::from_fn(|s| scale / dim * dot(&d[s], &c));
        for k in 0..NODES {
            // D times the change of the law's strain with each displacement of node k
            let mut strained = [[0.0; DIM]; S];
            for s in 0..S {
                for a in 0..DIM {
                    let sheared: f64 = (0..S).map(|t| d[s][t] * b[k][t][a]).sum();
                    strained[s][a] = scale * sheared - swollen[s] * h[k][a] / j;
                }
            }
            for i in 0..NODES {
                let geometric = dot(&pulled[i], &at.dn[k]);
                for a in 0..DIM {
                    let entry = (i * step + a) * SIZE + k * step;
                    for e in 0..DIM {
                        let material: f64 = (0..S).map(|s| b[i][s][a] * strained[s][e]).sum();
                        let turned = excess * (h[i][a] * h[k][e] - h[i][e] * h[k][a]) / j - h[k][e] * h[i][a];
                        lhs[entry + e] += weight * (material - bulk * tau_theta * turned);
                    }
                    lhs[entry + a] += weight * geometric;
                    let swelling: f64 = (0..S).map(|s| b[i][s][a] * swollen[s]).sum::<f64>() / (1.0 + theta);
                    lhs[entry + DIM] += weight * at.n[k] * (swelling - bulk * tau_theta * h[i][a]);
                }
                let entry = (i * step + DIM) * SIZE + k * step;
                // Σ θ_j ∂h_j · h_i goes as ∂h_i · Σ θ_j h_j does, with the roles of both changed
                let (of_i, of_k) = (dot(&h[i], &load), dot(&h[k], &load));
                let slope: [f64; DIM] = std::array::from_fn(|a| load[a] - matter.body[a]);
                let (slope_i, between) = (dot(&h[i], &slope), dot(&h[i], &h[k]));
                for e in 0..DIM {
                    let own = (of_i * h[k][e] - h[i][e] * of_k) / j;
                    let others = (slope_i * h[k][e] - slope[e] * between) / j;
                    let mean = (1.0 - tau_theta) * at.n[i] * h[k][e];
                    lhs[entry + e] += weight * bulk * (mean - tau_u * (own + others));
                }
                let mean = (1.0 - tau_theta) * at.n[i] * at.n[k];
                lhs[entry + DIM] -= weight * bulk * (mean + tau_u * bulk * between);
            }
        }
    }
}

register_mixed! { "TotalLagrangianMixedVolumetricStrainElement", MixedTotalLagrangian, 3,
"Planar solid for finite deformations with VOLUMETRIC_STRAIN at the nodes, against volumetric locking",
"∫ δE : S(F̄) dV, det F̄ = 1 + θ, κ ∫ δθ (θ − J + 1) dV; ASGS";
2: "2D3N" 3 }

register_mixed! { "TotalLagrangianMixedVolumetricStrainElement", MixedTotalLagrangian, 6,
"Solid for finite deformations with VOLUMETRIC_STRAIN at the nodes, against volumetric locking",
"∫ δE : S(F̄) dV, det F̄ = 1 + θ, κ ∫ δθ (θ − J + 1) dV; ASGS";
3: "3D4N" 4 }
