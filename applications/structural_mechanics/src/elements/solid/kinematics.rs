//! How a solid element's nodes move: strain, deformation gradient and the rows of B at a Gauss point.

use std::f64::consts::PI;

use crate::variables::{DISPLACEMENT, LOCAL_AXIS_1, LOCAL_AXIS_2, TEMPERATURE};
use zelus_core::diagnostics::Result;
use zelus_core::entities::{ELASTIC, EntityView, StepView};
use zelus_core::geometry::ShapeTable;

use super::Solid;
use crate::elements::band::{self, BANDS_AS_KRATOS};
use crate::elements::formulation::Formulation;
use crate::elements::gradients::{determinant, gradient, nodal_vectors, padded, physical_gradients};
use crate::elements::material::{Material, NO_TEMPERATURE};
use crate::laws::{StrainState, axes_of_element};
use crate::tensor::{IDENTITY, Tensor, inverse, pairs, strain_vector, stress_tensor};

/// One Gauss point of one element.
pub(super) struct Point<'a, const NODES: usize, const DIM: usize, const S: usize> {
    /// Gradients of the shape functions on the formulation's configuration.
    pub(super) dn: [[f64; DIM]; NODES],
    /// Shape functions over the radius of that configuration; zero without axial symmetry.
    pub(super) hoop: [f64; NODES],
    /// Mean gradients less those of the point, over 3; zero without mean dilatation.
    pub(super) excess: [[f64; DIM]; NODES],
    /// Volume on the formulation's configuration that the point stands for.
    pub(super) weight: f64,
    /// Strain, deformation gradient and history of the law.
    pub(super) state: StrainState<'a, S>,
}

/// How the material is deformed at a point.
pub(super) struct Deformation<const S: usize> {
    /// Green–Lagrange strain, or the small strain (shear doubled).
    pub(super) strain: [f64; S],
    /// Deformation gradient; 1 + strain for small displacements.
    pub(super) f: Tensor,
    /// Its determinant.
    pub(super) det_f: f64,
}

/// The motion of an element's nodes as a formulation reads it.
#[derive(Clone)]
pub(super) struct ElementMotion<const NODES: usize> {
    /// Displacements that strain the element (length).
    u: [[f64; 3]; NODES],
    /// Where DISPLACEMENT is ahead of the mesh: present displacements less those of the step, and those at its start.
    ///
    /// The deformation of the step is then the one from the first to `u`, as in the reference program, whose updated
    /// Lagrangian elements take the start of the step from present positions and DISPLACEMENT.
    ahead: Option<[[[f64; 3]; NODES]; 2]>,
    /// TEMPERATURE of the nodes, where they have it.
    temperatures: Option<[f64; NODES]>,
    /// Width of the band in which the element softens, and whether that is Kratos'.
    band: (f64, bool),
    /// Whether the history of the law stays as it is.
    elastic: bool,
    /// TIME at the beginning and at the end of the step.
    step: [f64; 2],
    /// Id of the element.
    element: usize,
    /// Axes of the material, where the law asks for them.
    axes: Result<Option<Tensor>, &'static str>,
}

impl<const NODES: usize> ElementMotion<NODES> {
    /// The temperature where the shape functions are `n`, for laws that ask for it.
    fn temperature<const S: usize>(&self, material: &Material<S>, n: &[f64; NODES]) -> Result<f64, String> {
        let must = material.law.expands();
        match self.temperatures {
            Some(nodal) if must || material.law.reads_point() => Ok(n.iter().zip(nodal).map(|(n, t)| n * t).sum()),
            None if must => Err(NO_TEMPERATURE.into()),
            _ => Ok(0.0),
        }
    }
}

/// Σ N_i x_i.
fn position<const NODES: usize>(n: &[f64; NODES], x: &[[f64; 3]; NODES]) -> [f64; 3] {
    std::array::from_fn(|c| n.iter().zip(x).map(|(n, x)| n * x[c]).sum())
}

/// Σ N_i x_i of the first coordinate.
pub(super) fn radius<const NODES: usize>(n: &[f64; NODES], x: &[[f64; 3]; NODES]) -> f64 {
    n.iter().zip(x).map(|(n, x)| n * x[0]).sum()
}

impl<F: Formulation, const NODES: usize, const DIM: usize, const S: usize> Solid<F, NODES, DIM, S> {
    pub(in crate::elements) const AXISYMMETRIC: bool = S == 4 && !F::MEAN_DILATATION;

    /// Motion of the nodes, as the formulation reads it.
    pub(super) fn motion(&self, entity: &EntityView<'_, NODES>, view: &StepView<'_>) -> ElementMotion<NODES> {
        let (material, as_kratos) = (self.material(entity), view.info.has(BANDS_AS_KRATOS));
        let width = if material.law.softens() { band::width(material.rule, &entity.initial, as_kratos) } else { 0.0 };
        let band = (width, as_kratos);
        let elastic = view.info.has(ELASTIC);
        let step = [view.info.time - view.info.delta_time, view.info.time];
        let axes = if material.law.has_axes() { Self::axes(entity, view) } else { Ok(None) };
        let element = view.elements.ids.get(entity.index as usize).copied().unwrap_or(0);
        let displacement = nodal_vectors(entity, view, &DISPLACEMENT);
        let column = view.nodes.history.values(&TEMPERATURE, 0);
        let temperatures = (!column.is_empty()).then(|| entity.scalars(column));
        if !F::FINITE {
            return ElementMotion { u: displacement, ahead: None, temperatures, band, elastic, step, element, axes };
        }
        let (x, initial) = (&entity.current, &entity.initial);
        let nodes = |of: &dyn Fn(usize, usize) -> f64| {
            let mut out = [[0.0; 3]; NODES];
            for (i, out) in out.iter_mut().enumerate() {
                (0..3).for_each(|c| out[c] = of(i, c));
            }
            out
        };
        let trails = (0..NODES).any(|i| (0..3).any(|c| x[i][c] != initial[i][c] + displacement[i][c]));
        let ahead = (F::PRESENT && trails).then(|| {
            let old: [[f64; 3]; NODES] = match view.nodes.history.values(&DISPLACEMENT, 1) {
                [] => [[0.0; 3]; NODES],
                column => entity.vectors(column),
            };
            [nodes(&|i, c| x[i][c] - initial[i][c] - (displacement[i][c] - old[i][c])), old]
        });
        ElementMotion {
            u: nodes(&|i, c| x[i][c] - initial[i][c]),
            ahead,
            temperatures,
            band,
            elastic,
            step,
            element,
            axes,
        }
    }

    /// The motion with the displacements at the start of the step.
    pub(super) fn motion_before(
        entity: &EntityView<'_, NODES>,
        view: &StepView<'_>,
        motion: &ElementMotion<NODES>,
    ) -> ElementMotion<NODES> {
        let u = match view.nodes.history.values(&DISPLACEMENT, 1) {
            [] => [[0.0; 3]; NODES],
            column => entity.vectors(column),
        };
        ElementMotion { u, ahead: None, ..motion.clone() }
    }

    /// Axes of the material of an element.
    ///
    /// # Errors
    /// Axes that are not perpendicular, or incomplete.
    pub(super) fn axes(entity: &EntityView<'_, NODES>, view: &StepView<'_>) -> Result<Option<Tensor>, &'static str> {
        let axis = |variable| match view.elements.data.values(variable, 0) {
            [] => [0.0; 3],
            column => std::array::from_fn(|c| column[3 * entity.index as usize + c]),
        };
        axes_of_element(axis(&LOCAL_AXIS_1), axis(&LOCAL_AXIS_2), DIM == 2)
    }

    /// Volume on the initial configuration that Gauss point `g` stands for, without thickness.
    pub(super) fn initial_weight(table: &ShapeTable, g: usize, entity: &EntityView<'_, NODES>) -> f64 {
        let det = determinant(&entity.initial, &table.dn::<NODES, DIM>()[g]);
        let turn = if Self::AXISYMMETRIC { 2.0 * PI * radius(&table.n()[g], &entity.initial) } else { 1.0 };
        table.weight(g) * det * turn
    }

    /// Mean over the element of the gradients of the shape functions; zero without mean dilatation.
    pub(super) fn mean_gradients(material: &Material<S>, entity: &EntityView<'_, NODES>) -> [[f64; DIM]; NODES] {
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

    /// How an element is deformed where its shape functions are `n` and their gradients on the initial configuration `dn`,
    /// and the mean gradients less `dn`, over 3.
    pub(super) fn deformation(
        n: &[f64; NODES],
        dn: &[[f64; DIM]; NODES],
        grad_u: &[[f64; DIM]; DIM],
        u: &[[f64; 3]; NODES],
        mean: &[[f64; DIM]; NODES],
        initial: &[[f64; 3]; NODES],
    ) -> (Deformation<S>, [[f64; DIM]; NODES]) {
        let mut f = IDENTITY;
        let mut h = Tensor::zeros();
        for a in 0..DIM {
            for b in 0..DIM {
                h[(a, b)] = if F::FINITE { grad_u[a][b] } else { 0.5 * (grad_u[a][b] + grad_u[b][a]) };
                f[(a, b)] += h[(a, b)];
            }
        }
        let mut excess = [[0.0; DIM]; NODES];
        if F::MEAN_DILATATION {
            let mut more = 0.0;
            for (((excess, mean), dn), u) in excess.iter_mut().zip(mean).zip(dn).zip(u) {
                for a in 0..DIM {
                    excess[a] = (mean[a] - dn[a]) / 3.0;
                    more += excess[a] * u[a];
                }
            }
            (0..3).for_each(|a| {
                h[(a, a)] += more;
                f[(a, a)] += more;
            });
        }
        if Self::AXISYMMETRIC {
            h[(2, 2)] = radius(n, u) / radius(n, initial);
            f[(2, 2)] += h[(2, 2)];
        }
        let mut strain = strain_vector(&h);
        if F::FINITE {
            let square = strain_vector::<S>(&(h.transpose() * h));
            strain.iter_mut().zip(square).for_each(|(e, q)| *e += 0.5 * q);
        }
        let det_f = f.determinant();
        (Deformation { strain, f, det_f }, excess)
    }

    /// Kinematics at Gauss point `g` of a motion; `mean` are the mean gradients, `state` is the element's.
    pub(super) fn point<'a>(
        material: &Material<S>,
        g: usize,
        entity: &EntityView<'_, NODES>,
        motion: &ElementMotion<NODES>,
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
                (0..DIM).for_each(|a| f[(a, a)] += 1.0);
                f
            };
            let total = f(u) * inverse(&f(reference)) * f(old);
            for a in 0..DIM {
                for b in 0..DIM {
                    grad_u[a][b] = total[(a, b)] - IDENTITY[(a, b)];
                }
            }
        }
        let (Deformation { strain, f, det_f }, excess) = Self::deformation(n, &dn, &grad_u, u, mean, &entity.initial);
        let mut hoop = [0.0; NODES];
        let mut turn = material.thickness;
        if Self::AXISYMMETRIC {
            let initial = radius(n, &entity.initial);
            let r = if F::PRESENT { radius(n, &entity.current) } else { initial };
            if r <= 0.0 || r.is_nan() {
                return Err(format!("the radius at Gauss point {} is {r}, not positive", g + 1));
            }
            hoop.iter_mut().zip(n).for_each(|(hoop, n)| *hoop = n / r);
            turn = 2.0 * PI * r;
        }
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
                temperature: motion.temperature(material, n)?,
                position: if material.law.reads_point() {
                    position(n, if F::FINITE { &entity.current } else { &entity.initial })
                } else {
                    [0.0; 3]
                },
                step: motion.step,
                band: motion.band.0,
                band_as_kratos: motion.band.1,
                elastic: motion.elastic,
                axes: motion.axes?,
                place: [motion.element, g + 1],
                history: material.remembered(g, state),
            },
        })
    }

    /// Derivative of the strain with respect to the displacements, one row a Voigt component.
    pub(super) fn b_matrix<const SIZE: usize>(point: &Point<'_, NODES, DIM, S>) -> [[f64; SIZE]; S] {
        let total = F::FINITE && !F::PRESENT;
        let mut b = [[0.0; SIZE]; S];
        for (row, (p, q)) in b.iter_mut().zip(pairs::<S>()) {
            for (i, dn) in point.dn.iter().enumerate() {
                if p >= DIM {
                    row[i * DIM] = if total { point.state.f[(2, 2)] } else { 1.0 } * point.hoop[i];
                } else if total {
                    for a in 0..DIM {
                        let f = point.state.f.row(a);
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

    /// Subtracts Bᵀ s times the weight: with T = F s where B holds F, else s, this is T ∇N_i, and T_θθ N_i/r about an axis.
    pub(super) fn subtract_internal<const SIZE: usize>(
        point: &Point<'_, NODES, DIM, S>,
        stress: &[f64; S],
        rhs: &mut [f64; SIZE],
    ) {
        let s = stress_tensor(stress);
        let t = if F::FINITE && !F::PRESENT { point.state.f * s } else { s } * point.weight;
        let trace = if F::MEAN_DILATATION { point.weight * s.trace() } else { 0.0 };
        for (i, (r, dn)) in rhs.chunks_exact_mut(DIM).zip(&point.dn).enumerate() {
            for a in 0..DIM {
                r[a] -= (0..DIM).map(|b| t[(a, b)] * dn[b]).sum::<f64>() + trace * point.excess[i][a];
            }
            r[0] -= t[(2, 2)] * point.hoop[i];
        }
    }

    /// ∇N_i · s · ∇N_j on the diagonal of each block of nodes, times the weight; the upper triangle unless the `whole` is asked for.
    pub(super) fn add_geometric<const SIZE: usize>(
        point: &Point<'_, NODES, DIM, S>,
        stress: &[f64; S],
        whole: bool,
        lhs: &mut [[f64; SIZE]; SIZE],
    ) {
        let s = stress_tensor(stress);
        for i in 0..NODES {
            let mut traction = [0.0; DIM];
            for (b, t) in traction.iter_mut().enumerate() {
                *t = point.weight * (0..DIM).map(|a| point.dn[i][a] * s[(a, b)]).sum::<f64>();
            }
            for j in if whole { 0 } else { i }..NODES {
                let k: f64 = (0..DIM).map(|b| traction[b] * point.dn[j][b]).sum();
                for a in 0..DIM {
                    lhs[i * DIM + a][j * DIM + a] += k;
                }
                lhs[i * DIM][j * DIM] += point.weight * s[(2, 2)] * point.hoop[i] * point.hoop[j];
            }
        }
    }
}
