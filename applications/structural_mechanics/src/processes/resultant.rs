//! Nodal forces of a force and a moment that are spread over a surface, an edge or points.
//!
//! The traction is t(x) = F/A + θ × (x − c), with the area A and its centre c, and J θ = M_c. M_c is the moment about the centre and
//! J = ∫ (r·r) I − r⊗r dA with r = x − c. Node i takes f_i = ∫ N_i t dA = w_i F/A + θ × s_i, with w_i = ∫ N_i dA and s_i = ∫ N_i r dA.
//! By the same quadrature A = Σ w_i, A c = Σ w_i x_i and J = Σ (x_i·s_i) I − s_i⊗x_i, so that the resultants of the nodal forces are
//! F and M_c but for round-off. Of all tractions with these resultants t is the least in the mean square. On bodies of revolution dA is
//! 2πr ds.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3};
use zelus_core::geometry::{Shape, ShapeTable, mapping};
use zelus_core::model::{ModelPart, SubPart};
use zelus_core::vector3::{add, cross, dot, norm, scale, sub};

/// Eigenvalue of J, over the largest, below which the nodes lie on a line.
const ON_LINE: f64 = 1e-12;
/// Share of a moment about such a line that is round-off.
const ROUND_OFF: f64 = 1e-9;

/// Integrals at the nodes of a part.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Resultant {
    /// Nodes (index), ascending, with w_i and s_i.
    nodes: Vec<(u32, f64, [f64; 3])>,
    /// Area, length or number of points.
    pub area: f64,
    /// Whether it is an area or a length.
    pub by_area: bool,
    /// Its centre.
    pub centre: [f64; 3],
    /// Eigenvalues and unit eigenvectors of J.
    principal: [(f64, [f64; 3]); 3],
}

impl Resultant {
    /// Of the conditions of a part of the highest dimension; of its nodes, all alike, where it has no conditions.
    pub fn of(part: &ModelPart, selection: &SubPart) -> Self {
        let shape = |at: u32| part.conditions.kinds[at as usize].cell;
        let of_revolution = is_of_revolution(part);
        let dim = selection.conditions.iter().filter_map(|&at| shape(at)).map(Shape::dim).max();
        let position = |node: u32| part.nodes.initial[node as usize];
        // w_i, and ∫ N_i x dA.
        let mut sums: BTreeMap<u32, (f64, [f64; 3])> = BTreeMap::new();
        let mut put = |node: u32, weight: f64, x: [f64; 3]| {
            let (sum, moment) = sums.entry(node).or_insert((0.0, [0.0; 3]));
            *sum += weight;
            *moment = add(*moment, scale(x, weight));
        };
        match dim {
            None | Some(0) => selection.nodes.iter().for_each(|&node| put(node, 1.0, position(node))),
            Some(dim) => {
                for &at in &selection.conditions {
                    let Some(shape) = shape(at).filter(|shape| shape.dim() == dim) else { continue };
                    let nodes = part.conditions.nodes(at);
                    let x: Vec<[f64; 3]> = nodes.iter().map(|&node| position(node)).collect();
                    let table = ShapeTable::get(shape, shape.cell().default_order + usize::from(of_revolution));
                    for (g, point) in table.points().iter().enumerate() {
                        let weight = point.weight * mapping::det_jacobian(shape, &x, point.xi);
                        let at = mapping::position(shape, &x, point.xi);
                        let weight = if of_revolution { TAU * at[0] * weight } else { weight };
                        nodes.iter().zip(table.n_at(g)).for_each(|(&node, n)| put(node, n * weight, at));
                    }
                }
            }
        }
        let area: f64 = sums.values().map(|(weight, _)| weight).sum();
        let centre =
            sums.iter().fold([0.0; 3], |sum, (&node, (weight, _))| add(sum, scale(position(node), weight / area)));
        let nodes: Vec<_> = sums
            .into_iter()
            .map(|(node, (weight, moment))| (node, weight, sub(moment, scale(centre, weight))))
            .collect();
        let mut inertia = [[0.0; 3]; 3];
        for &(node, _, s) in &nodes {
            let x = sub(position(node), centre);
            for (r, row) in inertia.iter_mut().enumerate() {
                for (c, entry) in row.iter_mut().enumerate() {
                    *entry += if r == c { dot(x, s) } else { 0.0 } - s[r] * x[c];
                }
            }
        }
        Self { nodes, area, by_area: dim.is_some_and(|dim| dim > 0), centre, principal: principal(inertia) }
    }

    /// The nodes, ascending.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = u32> + '_ {
        self.nodes.iter().map(|(node, ..)| *node)
    }

    /// The nodes with w_i/A and s_i.
    pub fn shares(&self) -> impl ExactSizeIterator<Item = (u32, f64, [f64; 3])> + '_ {
        self.nodes.iter().map(|&(node, weight, s)| (node, weight / self.area, s))
    }

    /// The mean rotation of the part from the initial to the present positions, by the polar decomposition of ∫ x⊗r dA; `None` in
    /// space where the nodes lie on a line.
    pub fn rotation(&self, part: &ModelPart) -> Option<[[f64; 3]; 3]> {
        let x: Vec<[f64; 3]> = self.nodes().map(|node| part.nodes.current[node as usize]).collect();
        self.rotation_to(&x, part.info.domain_size)
    }

    /// As [`Resultant::rotation`], to these positions of the nodes.
    pub fn rotation_to(&self, positions: &[[f64; 3]], space: usize) -> Option<[[f64; 3]; 3]> {
        let mut sum = Matrix3::zeros();
        for (&(_, _, s), x) in self.nodes.iter().zip(positions) {
            sum += Vector3::from(*x) * Vector3::from(s).transpose();
        }
        if space == 2 {
            let (sine, cosine) = (sum[(1, 0)] - sum[(0, 1)]).atan2(sum[(0, 0)] + sum[(1, 1)]).sin_cos();
            return Some([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]]);
        }
        let parts = sum.svd(true, true);
        let (left, right) = (parts.u?, parts.v_t?);
        if parts.singular_values[1] <= ON_LINE.sqrt() * parts.singular_values[0] {
            return None;
        }
        // A plane part has no extent across it: the third axes form a rotation with the others.
        let third = Vector3::new(1.0, 1.0, (left * right).determinant().signum());
        let rotation = left * Matrix3::from_diagonal(&third) * right;
        Some(std::array::from_fn(|r| std::array::from_fn(|c| rotation[(r, c)])))
    }

    /// The forces at the nodes that a force and a moment about a point give; `None` for the moment about a line of nodes.
    pub fn forces(&self, force: [f64; 3], moment: [f64; 3], point: [f64; 3]) -> Option<Vec<[f64; 3]>> {
        let by_force = cross(sub(point, self.centre), force);
        let about_centre = add(moment, by_force);
        let size = norm(moment).max(norm(by_force));
        let largest = self.principal.iter().map(|(value, _)| *value).fold(0.0, f64::max);
        let mut rotation = [0.0; 3];
        for &(value, axis) in &self.principal {
            let along = dot(axis, about_centre);
            if value > ON_LINE * largest {
                rotation = add(rotation, scale(axis, along / value));
            } else if along.abs() > ROUND_OFF * size {
                return None;
            }
        }
        let share = |&(_, weight, s): &(u32, f64, [f64; 3])| add(scale(force, weight / self.area), cross(rotation, s));
        Some(self.nodes.iter().map(share).collect())
    }
}

/// Whether the elements are rings of bodies of revolution.
pub(super) fn is_of_revolution(part: &ModelPart) -> bool {
    part.elements.kinds.iter().any(|kind| kind.name.contains("Axisym"))
}

/// Eigenvalues and eigenvectors of a symmetric matrix, by Jacobi's rotations.
fn principal(mut a: [[f64; 3]; 3]) -> [(f64, [f64; 3]); 3] {
    const SWEEPS: usize = 30;
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
            let t = 1.0_f64.copysign(theta) / (theta.abs() + theta.hypot(1.0));
            let (c, s) = (t.hypot(1.0).recip(), t / t.hypot(1.0));
            for row in &mut a {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            for k in 0..3 {
                (a[p][k], a[q][k]) = (c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]);
                (v[p][k], v[q][k]) = (c * v[p][k] - s * v[q][k], s * v[p][k] + c * v[q][k]);
            }
        }
    }
    std::array::from_fn(|i| (a[i][i], v[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvectors_of_a_symmetric_matrix() {
        let a = [[2.0, 1.0, 0.0], [1.0, 2.0, 0.5], [0.0, 0.5, 1.0]];
        for (value, axis) in principal(a) {
            (0..3).for_each(|r| assert!((dot(a[r], axis) - value * axis[r]).abs() < 1e-14));
        }
    }
}
