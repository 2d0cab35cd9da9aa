//! Loads on lines: force per length, and in the plane pressure.
//!
//! f_i = ∫ N_i (q |t| − p (t_y, −t_x)) dξ with t = ∂x/∂ξ along the line: positive p pushes to the left of its direction,
//! into a body that runs counter-clockwise. K_ij = ∫ N_i N_j,ξ (p [[0, 1], [−1, 0]] − q ⊗ t/|t|) dξ; the second part is the
//! stretch of the line on which q acts. THICKNESS does not enter, except that axisymmetric loads carry the factor
//! 2πr/THICKNESS, as in Kratos.

use std::f64::consts::PI;

use zelus_core::entities::{EntityView, StepView};
use zelus_core::geometry::ShapeTable;

use super::load::{
    AtStart, DistributedLoad, Following, counts_stretch, interpolate, pressure, register_conditions, thickness,
    vector_load,
};
use crate::variables::LINE_LOAD;

/// Force per length and pressure on a line in the plane.
pub struct LineLoad<const AXISYMMETRIC: bool>;

/// Force per length on a line in space.
pub struct SpatialLineLoad;

/// Σ N_i,ξ x_i.
fn tangent_vector<const NODES: usize>(dn: &[[f64; 1]; NODES], x: &[[f64; 3]; NODES]) -> [f64; 3] {
    interpolate(&dn.map(|[d]| d), x)
}

fn length(t: [f64; 3]) -> f64 {
    (t[0] * t[0] + t[1] * t[1] + t[2] * t[2]).sqrt()
}

impl<const AXISYMMETRIC: bool, const NODES: usize, const SIZE: usize> DistributedLoad<NODES, SIZE>
    for LineLoad<AXISYMMETRIC>
{
    const CELL: usize = 1;
    const SPACE: usize = 2;

    fn add(
        rule: &ShapeTable,
        entity: &EntityView<'_, NODES>,
        view: &StepView<'_>,
        lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    ) {
        let q = vector_load(entity, view, &LINE_LOAD);
        let p = pressure(entity, view);
        let pressed = p.iter().any(|p| *p != 0.0);
        let circle = if AXISYMMETRIC { 2.0 * PI / thickness(entity) } else { 1.0 };
        for g in 0..rule.len() {
            let (n, dn) = (&rule.n::<NODES>()[g], &rule.dn::<NODES, 1>()[g]);
            let t = tangent_vector(dn, &entity.current);
            let radius = interpolate(n, &entity.current)[0];
            let weight = rule.weight(g) * circle * if AXISYMMETRIC { radius } else { 1.0 };
            let (load, size) = (interpolate(n, &q), length(t));
            let p = weight * n.iter().zip(&p).map(|(n, p)| n * p).sum::<f64>();
            for (i, n) in n.iter().enumerate() {
                rhs[2 * i] += n * (weight * size * load[0] - p * t[1]);
                rhs[2 * i + 1] += n * (weight * size * load[1] + p * t[0]);
            }
            if lhs.is_empty() {
                continue;
            }
            for (i, n_i) in n.iter().enumerate().filter(|_| counts_stretch(view)) {
                for (j, ([slope], n_j)) in dn.iter().zip(n).enumerate() {
                    for a in 0..2 {
                        for b in 0..2 {
                            lhs[(2 * i + a) * SIZE + 2 * j + b] -= weight * n_i * load[a] * slope * t[b] / size;
                        }
                        if AXISYMMETRIC {
                            // the circumference grows with the radius
                            lhs[(2 * i + a) * SIZE + 2 * j] -= weight / radius * size * n_i * load[a] * n_j;
                        }
                    }
                }
            }
            if pressed {
                for (i, n_i) in n.iter().enumerate() {
                    for (j, ([slope], n_j)) in dn.iter().zip(n).enumerate() {
                        let k = p * n_i * slope;
                        lhs[2 * i * SIZE + 2 * j + 1] += k;
                        lhs[(2 * i + 1) * SIZE + 2 * j] -= k;
                        if AXISYMMETRIC {
                            // the circumference grows with the radius
                            let ring = p / radius * n_i * n_j;
                            lhs[2 * i * SIZE + 2 * j] += ring * t[1];
                            lhs[(2 * i + 1) * SIZE + 2 * j] -= ring * t[0];
                        }
                    }
                }
            }
        }
    }
}

impl<const NODES: usize, const SIZE: usize> DistributedLoad<NODES, SIZE> for SpatialLineLoad {
    const CELL: usize = 1;
    const SPACE: usize = 3;

    fn add(
        rule: &ShapeTable,
        entity: &EntityView<'_, NODES>,
        view: &StepView<'_>,
        lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    ) {
        let q = vector_load(entity, view, &LINE_LOAD);
        for g in 0..rule.len() {
            let (n, dn) = (&rule.n::<NODES>()[g], &rule.dn::<NODES, 1>()[g]);
            let t = tangent_vector(dn, &entity.current);
            let (weight, size) = (rule.weight(g), length(t));
            let load = interpolate(n, &q);
            for (i, n) in n.iter().enumerate() {
                for a in 0..3 {
                    rhs[3 * i + a] += weight * size * n * load[a];
                }
            }
            if lhs.is_empty() || !counts_stretch(view) {
                continue;
            }
            for (i, n) in n.iter().enumerate() {
                for (j, [slope]) in dn.iter().enumerate() {
                    for a in 0..3 {
                        for b in 0..3 {
                            lhs[(3 * i + a) * SIZE + 3 * j + b] -= weight * n * load[a] * slope * t[b] / size;
                        }
                    }
                }
            }
        }
    }
}

register_conditions! { "LineLoadCondition", 1,
"Force per length (LINE_LOAD) and pressure on a line: NEGATIVE_FACE_PRESSURE presses a body on its left",
"f_i = ∫ N_i (q |t| − p (t_y, −t_x)) dξ", &super::load::loads("LINE_LOAD");
"2D2N": Following<LineLoad<false>>, 2, 4;
"2D3N": Following<LineLoad<false>>, 3, 6;
"3D2N": Following<SpatialLineLoad>, 2, 6;
"3D3N": Following<SpatialLineLoad>, 3, 9 }

register_conditions! { "AxisymLineLoadCondition", 1,
"Force per area (LINE_LOAD) and pressure on a surface of revolution: NEGATIVE_FACE_PRESSURE presses a body on its left",
"f_i = ∫ N_i (q |t| − p (t_y, −t_x)) 2πr/THICKNESS dξ", &super::load::loads("LINE_LOAD");
"2D2N": Following<LineLoad<true>>, 2, 4;
"2D3N": Following<LineLoad<true>>, 3, 6 }

register_conditions! { "SmallDisplacementLineLoadCondition", 1,
"Force per length (LINE_LOAD) and pressure on a line where it was at the start",
"f_i = ∫ N_i (q |t| − p (t_y, −t_x)) dξ with t of the initial positions", &super::load::loads("LINE_LOAD");
"2D2N": AtStart<LineLoad<false>>, 2, 4;
"2D3N": AtStart<LineLoad<false>>, 3, 6;
"3D2N": AtStart<SpatialLineLoad>, 2, 6;
"3D3N": AtStart<SpatialLineLoad>, 3, 9 }
