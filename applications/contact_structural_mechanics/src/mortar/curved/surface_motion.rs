//! Derivatives of the points of the overlap of surfaces: each follows from where it is by one step of the implicit function theorem.

use super::super::geometry::PairGeometry;
use super::super::overlap_point::OverlapPoint;
use super::super::segmentation_3d::Plane;
use super::surface_points::{Cell, SurfacePoint, SurfacePoints, area_of_cell, outline};
use zelus_core::geometry::{MOST_FACET_NODES, Nodal, interpolate};
use zelus_core::scalar::Real;
use zelus_core::vector3::{cross, dot, norm, scale, sub, value};

/// A pair in a scalar with derivatives, with the data that all its points share.
pub(super) struct SurfaceMotion<'a, T: Real> {
    pair: &'a PairGeometry<T>,
    found: &'a SurfacePoints,
    values: PairGeometry<f64>,
    /// Nodes of the slave in its plane.
    flat: Nodal<[T; 2]>,
    outline: Nodal<[T; 2]>,
    /// Motions, whose values are zero.
    slave: Moving<T, 3>,
    in_plane: Moving<T, 2>,
    normals: Moving<T, 3>,
    master: Moving<T, 3>,
    slave_normal: [T; 3],
    normal_moves: bool,
    /// ∂²x/∂ξ², ∂²x/∂ξ∂η, ∂²x/∂η² of the slave where they are the same everywhere.
    bend: Option<[[f64; 3]; 3]>,
}

/// The nodes that move, with their motions.
struct Moving<T: Real, const C: usize> {
    nodes: Nodal<usize>,
    motions: Nodal<[T; C]>,
}

impl<T: Real, const C: usize> Moving<T, C> {
    fn new(all: &[[T; C]]) -> Self {
        let moves = |x: &[T; C]| x.iter().any(|x| !x.is_constant());
        let mut nodes = [0; MOST_FACET_NODES];
        let mut count = 0;
        for (n, _) in all.iter().enumerate().filter(|(_, x)| moves(x)) {
            nodes[count] = n;
            count += 1;
        }
        let nodes = Nodal::of(&nodes[..count]);
        Self { nodes, motions: nodes.map(|n| motion(all[n])) }
    }

    /// Adds Σ wₖ dxₖ times a factor.
    #[inline(always)]
    fn add_to(&self, weights: &[f64], factor: f64, sum: &mut [T; C]) {
        for (&n, motion) in self.nodes.iter().zip(self.motions.iter()) {
            let weight = factor * weights[n];
            (0..C).for_each(|c| sum[c].add_scaled(motion[c], weight));
        }
    }

    /// Adds Σ wₖ·dxₖ with a vector wₖ for each node.
    #[inline(always)]
    fn add_products(&self, weights: impl Fn(usize) -> [f64; C], sum: &mut T) {
        for (&n, motion) in self.nodes.iter().zip(self.motions.iter()) {
            let weights = weights(n);
            (0..C).for_each(|c| sum.add_scaled(motion[c], weights[c]));
        }
    }
}

/// The derivative of a vector alone: the value is zero.
fn motion<T: Real, const C: usize>(x: [T; C]) -> [T; C] {
    x.map(|x| x - x.value())
}

impl<'a, T: Real> SurfaceMotion<'a, T> {
    /// Motion of a pair whose points have been found on its values.
    pub(super) fn new(pair: &'a PairGeometry<T>, found: &'a SurfacePoints) -> Self {
        let plane = Plane::new(pair);
        let values = pair.values();
        let flat = pair.slave.map(|x| plane.coordinates(x));
        let shape = pair.slave_shape;
        Self {
            pair,
            found,
            outline: outline(pair, &plane),
            slave: Moving::new(&pair.slave),
            in_plane: Moving::new(&flat),
            normals: Moving::new(&pair.nodal_normals),
            master: Moving::new(&pair.master),
            slave_normal: motion(pair.slave_normal),
            normal_moves: pair.slave_normal.iter().any(|x| !x.is_constant()),
            bend: shape.has_constant_bend().then(|| shape.bend_at(&values.slave, shape.centre)),
            flat,
            values,
        }
    }

    /// Visits the points of a sub-facet of the slave.
    pub(super) fn of_sub_facet(&self, sub_facet: usize, visit: &mut dyn FnMut(&OverlapPoint<T>)) {
        for cell in self.found.cells(sub_facet) {
            self.of_cell(cell, visit);
        }
    }

    fn of_cell(&self, cell: &Cell, visit: &mut dyn FnMut(&OverlapPoint<T>)) {
        let corners = self.found.corners_of(cell, self.pair.slave_shape, &self.flat, &self.outline);
        let area = area_of_cell(&corners);
        let motions = corners.map(motion);
        let zero = T::zero();
        let mut out = OverlapPoint::room();
        out.slave.refill(self.pair.slave_shape.nodes, |_| zero);
        out.master.refill(self.pair.master_shape.nodes, |_| zero);
        for point in self.found.points(cell) {
            self.find(point, &motions, area, &mut out);
            visit(&out);
        }
    }

    /// The point with derivatives; `corners` are the motions of the corners of its cell.
    fn find(&self, point: &SurfacePoint, corners: &[[T; 2]; 3], area: T, out: &mut OverlapPoint<T>) {
        let slave = &point.slave;
        let mut place = [T::zero(); 2];
        for (corner, &share) in corners.iter().zip(&point.barycentric) {
            (0..2).for_each(|c| place[c].add_scaled(corner[c], share));
        }
        self.in_plane.add_to(&slave.values, -1.0, &mut place);
        let along = point.inverse.map(|row| {
            let mut sum = T::zero();
            (0..2).for_each(|c| sum.add_scaled(place[c], row[c]));
            sum
        });
        set(&mut out.local, &slave.local, &along, [&[1.0, 0.0], &[0.0, 1.0]]);
        set(&mut out.slave, &slave.values, &along, [&slave.gradients[0], &slave.gradients[1]]);
        let tangents = slave.derivatives(&self.values.slave);
        out.weight = area * (point.share * point.stretch);
        out.weight.add_scaled(self.stretch(point, tangents, &along), area.value() * point.share);
        match &point.way {
            Some(way) => {
                let turns = slave.derivatives(&self.values.nodal_normals);
                let mut apart = [T::zero(); 3];
                self.master.add_to(&point.master.values, 1.0, &mut apart);
                self.slave.add_to(&slave.values, -1.0, &mut apart);
                self.normals.add_to(&slave.values, -way.distance, &mut apart);
                for (a, along) in along.iter().enumerate() {
                    (0..3).for_each(|c| apart[c].add_scaled(*along, -(tangents[a][c] + way.distance * turns[a][c])));
                }
                let along = way.rows.map(|row| {
                    let mut sum = T::zero();
                    (0..3).for_each(|c| sum.add_scaled(apart[c], -row[c]));
                    sum
                });
                set(
                    &mut out.master,
                    &point.master.values,
                    &along,
                    [&point.master.gradients[0], &point.master.gradients[1]],
                );
            }
            None => {
                let (pair, x) = (self.pair, interpolate(&out.slave, &self.pair.slave));
                let shape = pair.master_shape;
                out.master = shape.values(shape.closest_point(&pair.master, x, shape.centre));
            }
        }
    }

    /// The derivative of the area of the true surface by that in the plane, |m|/|m·n| with m = t×s.
    fn stretch(&self, point: &SurfacePoint, [t, s]: [[f64; 3]; 2], along: &[T; 2]) -> T {
        let (slave, normal) = (&point.slave, value(self.pair.slave_normal));
        let m = cross(t, s);
        let (length, across) = (norm(m), dot(m, normal));
        // ∂/∂m, and from there by the tangents.
        let by_m = sub(scale(m, 1.0 / (length * across.abs())), scale(normal, point.stretch / across));
        let by_tangents = [cross(s, by_m), cross(by_m, t)];
        let mut out = T::zero();
        self.slave.add_products(
            |n| {
                let [a, b] = [slave.gradients[0][n], slave.gradients[1][n]];
                std::array::from_fn(|c| a * by_tangents[0][c] + b * by_tangents[1][c])
            },
            &mut out,
        );
        let [first, mixed, last] =
            self.bend.unwrap_or_else(|| self.pair.slave_shape.bend_at(&self.values.slave, slave.local));
        for (along, [by_t, by_s]) in along.iter().zip([[first, mixed], [mixed, last]]) {
            out.add_scaled(*along, dot(by_tangents[0], by_t) + dot(by_tangents[1], by_s));
        }
        if self.normal_moves {
            (0..3).for_each(|c| out.add_scaled(self.slave_normal[c], -point.stretch / across * m[c]));
        }
        out
    }
}

/// Numbers at local coordinates that move along.
#[inline(always)]
fn set<T: Real>(out: &mut [T], values: &[f64], along: &[T; 2], gradients: [&[f64]; 2]) {
    for (n, out) in out.iter_mut().enumerate() {
        *out = T::constant(values[n]);
        out.add_scaled(along[0], gradients[0][n]);
        out.add_scaled(along[1], gradients[1][n]);
    }
}
