//! Points of the overlap of lines in the plane, of which one at least is of second order.

use super::super::choices::Choices;
use super::super::geometry::PairGeometry;
use super::super::overlap_point::OverlapPoint;
use super::super::segmentation_2d;
use super::super::settings::SegmentationSettings;
use zelus_core::geometry::{FacetShape, LINE_2, Nodal, ShapeTable, interpolate};
use zelus_core::scalar::Real;
use zelus_core::vector3::norm;

/// A pair of lines that is walked.
pub(super) struct CurvedLines<'a, T: Real> {
    pub(super) pair: &'a PairGeometry<T>,
    pub(super) settings: &'a SegmentationSettings,
}

impl<T: Real> CurvedLines<'_, T> {
    /// Points of a chord of the slave before those of the master.
    pub(super) fn of_sub_facet(&self, sub_facet: usize, covered: &mut f64, visit: &mut dyn FnMut(&OverlapPoint<T>)) {
        let pair = self.pair;
        let own = pair.slave_shape.sub_facets[sub_facet];
        for other in pair.master_shape.sub_facets {
            let slave = LINE_2.nodal(|n| pair.slave[own[n]]);
            let master = LINE_2.nodal(|n| pair.master[other[n]]);
            let chords = PairGeometry {
                slave_shape: &LINE_2,
                master_shape: &LINE_2,
                slave,
                master,
                nodal_normals: LINE_2.nodal(|n| pair.nodal_normals[own[n]]),
                slave_normal: LINE_2.unit_normal(&slave, LINE_2.centre),
                master_normal: LINE_2.unit_normal(&master, LINE_2.centre),
                exact: None,
                choices: Choices::default(),
            };
            if let Some(ends) = segmentation_2d::interval(&chords, self.settings) {
                let [a, b] = [0, 1].map(|n| pair.slave_shape.corner(own[n])[0]);
                let ends = ends.map(|xi| (xi + 1.0) * (0.5 * (b - a)) + a);
                *covered += self.of_interval(ends, visit);
            }
        }
    }

    /// Points between two local coordinates of the slave; gives the length.
    fn of_interval(&self, ends: [T; 2], visit: &mut dyn FnMut(&OverlapPoint<T>)) -> f64 {
        let share = (ends[1] - ends[0]) * (1.0 / LINE_2.cell_size);
        let mut covered = 0.0;
        let rule = ShapeTable::get(LINE_2.shape, self.settings.rule_of_second_order());
        for (weights, point) in rule.n::<2>().iter().zip(rule.points()) {
            let local = [ends[0] * weights[0] + ends[1] * weights[1], T::zero()];
            let normal = self.pair.slave_shape.area_normal_at(&self.pair.slave, local);
            let length = norm(normal) * share * point.weight;
            covered += length.value();
            self.visit(local, length, visit);
        }
        covered
    }

    /// The point at local coordinates of the slave that stands for `measure`.
    fn visit(&self, local: [T; 2], measure: T, visit: &mut dyn FnMut(&OverlapPoint<T>)) {
        let (pair, master) = (self.pair, self.pair.master_shape);
        let slave = pair.slave_shape.values(local);
        let x = interpolate(&slave, &pair.slave);
        let weight = self.settings.revolution().map_or(measure, |per_radius| measure * x[0] * per_radius);
        let direction = interpolate(&slave, &pair.nodal_normals);
        let mut at = Nodal::empty();
        let is_exact = pair.exact.is_some_and(|exact| exact.write_along(master, &pair.master, x, direction, &mut at));
        let master = if is_exact { at } else { on_master(master, &pair.master, x, direction) };
        visit(&OverlapPoint { local, slave, master, weight });
    }
}

/// Shape functions of a master where a point `x` of the slave goes along a direction.
fn on_master<T: Real>(shape: &FacetShape, nodes: &[[T; 3]], x: [T; 3], direction: [T; 3]) -> Nodal<T> {
    let along = shape.point_along(nodes, x, direction, shape.centre);
    shape.values(along.unwrap_or_else(|| shape.closest_point(nodes, x, shape.centre)))
}
