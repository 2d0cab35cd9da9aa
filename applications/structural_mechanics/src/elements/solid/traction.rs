//! The traction on a face of a solid element, t = P·N with P = F S, and its derivative by the displacements of the nodes:
//! δt = (δF S + F δS)·N, δS = D δE, δE = sym(Fᵀ δF). For small displacements P is the stress, δt = (D sym δF)·N.

use nalgebra::Vector3;
use zelus_core::diagnostics::Result;
use zelus_core::entities::{EntityView, FacePoint};
use zelus_core::geometry::{local_gradients, shape_functions};

use super::Solid;
use super::kinematics::{Deformation, radius};
use crate::elements::formulation::Formulation;
use crate::elements::gradients::{gradient, physical_gradients};
use crate::elements::material::Material;
use crate::laws::{StrainState, StressMeasure};
use crate::tensor::{Tensor, strain_vector, stress_tensor};

fn along(tensor: &Tensor, normal: [f64; 3]) -> [f64; 3] {
    (tensor * Vector3::from(normal)).into()
}

impl<F: Formulation, const NODES: usize, const DIM: usize, const S: usize> Solid<F, NODES, DIM, S> {
    /// Why elements of this material have no traction that depends on displacements alone; `None` where they have.
    pub(super) fn unknown_tractions(material: &Material<S>) -> Option<&'static str> {
        if material.law.history() > 0 {
            Some("its law has a history at Gauss points, and faces have none")
        } else if material.law.expands() {
            Some("its law depends on the temperature")
        } else if material.law.has_axes() {
            Some("its law depends on the axes of the material, which faces do not have")
        } else if F::CONSTANT_PRESSURE {
            Some("its pressure is one number for the whole element")
        } else if F::PRESENT && material.law.ignores_measure(false) {
            Some("its law gives the same numbers for every measure of stress")
        } else {
            None
        }
    }

    /// Traction at a point of a face (force per initial area, in the plane times the thickness), and its derivatives.
    ///
    /// # Errors
    /// An element that is turned inside out there.
    pub(super) fn face_traction<const SIZE: usize>(
        &self,
        material: &Material<S>,
        entity: &EntityView<'_, NODES>,
        point: &FacePoint,
        u: &[[f64; 3]; NODES],
        by: Option<&mut [[f64; 3]; SIZE]>,
    ) -> Result<[f64; 3], String> {
        let mut n = [0.0; NODES];
        shape_functions(self.shape, point.local, &mut n);
        let mut local = [[0.0; 3]; 27];
        local_gradients(self.shape, point.local, &mut local);
        let mut own = [[0.0; DIM]; NODES];
        own.iter_mut().zip(&local).for_each(|(own, local)| own.copy_from_slice(&local[..DIM]));
        let (dn, _) = physical_gradients(&entity.initial, &own);
        let mean = Self::mean_gradients(material, entity);
        let (Deformation { strain, f, det_f }, excess) =
            Self::deformation(&n, &dn, &gradient(u, &dn), u, &mean, &entity.initial);
        if (F::FINITE || !material.law.is_linear()) && (det_f <= 0.0 || det_f.is_nan()) {
            return Err(format!("turned inside out at a face (det F = {det_f:.3e})"));
        }
        let state = StrainState { strain, f, det_f, small: !F::FINITE, ..StrainState::REST };
        let mut d = [[0.0; S]; S];
        let stress = material.law.stress(&state, StressMeasure::Pk2, if by.is_some() { Some(&mut d) } else { None });
        let stress = along(&stress_tensor(&stress), point.normal).map(|t| t * material.thickness);
        if let Some(by) = by {
            let r = radius(&n, &entity.initial);
            let mut around = [0.0; NODES];
            if Self::AXISYMMETRIC {
                around.iter_mut().zip(&n).for_each(|(around, n)| *around = n / r);
            }
            for (r, by) in by.iter_mut().enumerate() {
                let (i, a) = (r / DIM, r % DIM);
                let mut change = Tensor::zeros();
                (0..DIM).for_each(|b| change[(a, b)] = dn[i][b]);
                if a == 0 {
                    change[(2, 2)] += around[i];
                }
                (0..3).for_each(|c| change[(c, c)] += excess[i][a]);
                let strain: [f64; S] =
                    if F::FINITE { strain_vector(&(f.transpose() * change)) } else { strain_vector(&change) };
                let stiffened = d.map(|row| row.iter().zip(&strain).map(|(d, e)| d * e).sum::<f64>());
                let mut traction = along(&stress_tensor(&stiffened), point.normal).map(|t| t * material.thickness);
                if F::FINITE {
                    let (moved, turned) = (along(&f, traction), along(&change, stress));
                    traction = std::array::from_fn(|c| moved[c] + turned[c]);
                }
                *by = traction;
            }
        }
        Ok(if F::FINITE { along(&f, stress) } else { stress })
    }
}
