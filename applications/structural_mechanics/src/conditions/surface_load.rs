//! Loads on surfaces: force per area, and pressure.
//!
//! f_i = ∫ N_i (q |n| + p n) dξ dη with n = t_1 × t_2, t_1 = ∂x/∂ξ, t_2 = ∂x/∂η: positive p pushes along n.
//! K_ij = ∫ N_i (p (N_j,ξ [t_2]× − N_j,η [t_1]×) − q ⊗ (N_j,ξ t_2 × n̂ + N_j,η n̂ × t_1)) dξ dη with [a]× v = a × v and
//! n̂ = n/|n|: the second part is the stretch of the area on which q acts.

use zelus_core::entities::{EntityView, StepView};
use zelus_core::geometry::ShapeTable;
use zelus_core::vector3::{cross, norm, scale};

use super::load::{
    AtStart, DistributedLoad, Following, counts_stretch, interpolate, pressure, register_conditions, vector_load,
};
use crate::variables::SURFACE_LOAD;

/// Force per area and pressure on a surface in space.
pub struct SurfaceLoad;

impl<const NODES: usize, const SIZE: usize> DistributedLoad<NODES, SIZE> for SurfaceLoad {
    const CELL: usize = 2;
    const SPACE: usize = 3;

    fn add(
        rule: &ShapeTable,
        entity: &EntityView<'_, NODES>,
        view: &StepView<'_>,
        lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    ) {
        let q = vector_load(entity, view, &SURFACE_LOAD);
        let p = pressure(entity, view);
        let pressed = p.iter().any(|p| *p != 0.0);
        for g in 0..rule.len() {
            let (n, dn) = (&rule.n::<NODES>()[g], &rule.dn::<NODES, 2>()[g]);
            let [t1, t2] = [0, 1].map(|k| interpolate(&dn.map(|d| d[k]), &entity.current));
            let (normal, weight) = (cross(t1, t2), rule.weight(g));
            let (load, area) = (interpolate(n, &q), norm(normal));
            let p = weight * n.iter().zip(&p).map(|(n, p)| n * p).sum::<f64>();
            for (i, n) in n.iter().enumerate() {
                for a in 0..3 {
                    rhs[3 * i + a] += n * (weight * area * load[a] + p * normal[a]);
                }
            }
            if lhs.is_empty() {
                continue;
            }
            if counts_stretch(view) && load.iter().any(|q| *q != 0.0) {
                let unit = scale(normal, 1.0 / area);
                let (along, across) = (cross(t2, unit), cross(unit, t1));
                for (j, slope) in dn.iter().enumerate() {
                    for (i, n) in n.iter().enumerate() {
                        for a in 0..3 {
                            for b in 0..3 {
                                let stretch = slope[0] * along[b] + slope[1] * across[b];
                                lhs[(3 * i + a) * SIZE + 3 * j + b] -= weight * n * load[a] * stretch;
                            }
                        }
                    }
                }
            }
            if pressed {
                for (j, slope) in dn.iter().enumerate() {
                    let axis: [f64; 3] = std::array::from_fn(|a| p * (slope[0] * t2[a] - slope[1] * t1[a]));
                    let skew = [[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]];
                    for (i, n) in n.iter().enumerate() {
                        for a in 0..3 {
                            for b in 0..3 {
                                lhs[(3 * i + a) * SIZE + 3 * j + b] += n * skew[a][b];
                            }
                        }
                    }
                }
            }
        }
    }
}

register_conditions! { "SurfaceLoadCondition", 2,
"Force per area (SURFACE_LOAD) and pressure on a surface: POSITIVE_FACE_PRESSURE presses a body its normal points out of",
"f_i = ∫ N_i (q |n| + p n) dξ dη, n = t_1 × t_2", &super::load::loads("SURFACE_LOAD");
"3D3N": Following<SurfaceLoad>, 3, 9;
"3D4N": Following<SurfaceLoad>, 4, 12;
"3D6N": Following<SurfaceLoad>, 6, 18;
"3D8N": Following<SurfaceLoad>, 8, 24;
"3D9N": Following<SurfaceLoad>, 9, 27 }

register_conditions! { "SmallDisplacementSurfaceLoadCondition", 2,
"Force per area (SURFACE_LOAD) and pressure on a surface where it was at the start",
"f_i = ∫ N_i (q |n| + p n) dξ dη with n of the initial positions", &super::load::loads("SURFACE_LOAD");
"3D3N": AtStart<SurfaceLoad>, 3, 9;
"3D4N": AtStart<SurfaceLoad>, 4, 12;
"3D6N": AtStart<SurfaceLoad>, 6, 18;
"3D8N": AtStart<SurfaceLoad>, 8, 24;
"3D9N": AtStart<SurfaceLoad>, 9, 27 }
