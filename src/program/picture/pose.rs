//! A model at a step: places, values, and the section of a cutting plane.

use super::model::Model;
use super::section::{Outline, outlines};

/// A plane: points with n · x greater than `at` are cut away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Plane {
    pub normal: [f64; 3],
    pub at: f64,
}

impl Plane {
    /// The height of an initial place over the plane.
    pub fn height(&self, point: [f64; 3]) -> f64 {
        self.normal.iter().zip(point).map(|(n, x)| n * x).sum::<f64>() - self.at
    }
}

/// A vertex at a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vertex {
    /// Displaced place.
    pub place: [f64; 3],
    /// Height of the initial place over the cutting plane; negative where there is none.
    pub height: f64,
    pub value: f64,
}

impl Vertex {
    /// The point of the line to another vertex that lies in the plane.
    pub fn towards_plane(&self, other: &Self) -> Self {
        let share = self.height / (self.height - other.height);
        let mix = |x: f64, y: f64| x + share * (y - x);
        let place = std::array::from_fn(|c| mix(self.place[c], other.place[c]));
        Self { place, height: -1.0, value: mix(self.value, other.value) }
    }
}

/// All vertices of a model at a step, and triangles of the section.
pub(super) struct Pose {
    pub vertices: Vec<Vertex>,
    pub section: Vec<[Vertex; 3]>,
    /// Outlines of cells in the section.
    pub outlines: Vec<Outline>,
}

impl Pose {
    pub fn new(
        model: &Model,
        points: &[[f64; 3]],
        displacements: &[[f64; 3]],
        factor: f64,
        values: &[f64],
        plane: Option<Plane>,
    ) -> Self {
        let vertex = |(at, &(node, _)): (usize, &(u32, u32))| {
            let (point, way) = (points[node as usize], displacements[node as usize]);
            Vertex {
                place: model.moved(at, std::array::from_fn(|c| point[c] + factor * way[c])),
                height: plane.map_or(-1.0, |plane| plane.height(model.moved(at, point))),
                value: values[node as usize],
            }
        };
        let vertices: Vec<Vertex> = model.vertices.iter().enumerate().map(vertex).collect();
        let mut section = Vec::new();
        if plane.is_some() {
            for four in &model.tetrahedra {
                cut(&four.map(|own| vertices[own as usize]), &mut section);
            }
        }
        let outlines = if plane.is_some() { outlines(&model.solids, &vertices) } else { Vec::new() };
        Self { vertices, section, outlines }
    }
}

/// Triangles of the section of a tetrahedron, with linear values.
fn cut(four: &[Vertex; 4], out: &mut Vec<[Vertex; 3]>) {
    let (above, below): (Vec<&Vertex>, Vec<&Vertex>) = four.iter().partition(|own| own.height > 0.0);
    let between = Vertex::towards_plane;
    match (&above[..], &below[..]) {
        ([a], [p, q, r]) | ([p, q, r], [a]) => out.push([between(a, p), between(a, q), between(a, r)]),
        ([a, b], [p, q]) => {
            let [ap, aq, bq, bp] = [between(a, p), between(a, q), between(b, q), between(b, p)];
            out.extend([[ap, aq, bq], [ap, bq, bp]]);
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_section_has_the_area_and_the_values_of_the_plane() {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        // ANALYTIC: at the height z = h the triangle has the legs 1 − h; x + y = 0.5 cuts a rectangle of √½ · ½
        let plane = |normal, at| Plane { normal, at };
        for (plane, area) in
            [(plane([0.0, 0.0, 1.0], 0.25), 0.5 * 0.75 * 0.75), (plane([1.0, 1.0, 0.0], 0.5), 0.5_f64.sqrt() * 0.5)]
        {
            let four =
                corners.map(|place| Vertex { place, height: plane.height(place), value: 3.0 * place[0] - place[2] });
            let mut found = Vec::new();
            cut(&four, &mut found);
            let of = |three: &[Vertex; 3]| {
                let way = |own: &Vertex| std::array::from_fn(|c| own.place[c] - three[0].place[c]);
                super::super::camera::cross(way(&three[1]), way(&three[2])).iter().map(|x| x * x).sum::<f64>().sqrt()
                    / 2.0
            };
            let sum: f64 = found.iter().map(of).sum();
            assert!((sum - area).abs() < 1e-12, "{sum} instead of {area}");
            for own in found.iter().flatten() {
                assert!((own.value - 3.0 * own.place[0] + own.place[2]).abs() < 1e-12);
                assert!(plane.height(own.place).abs() < 1e-12);
            }
        }
    }
}
