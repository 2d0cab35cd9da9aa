//! A model at a step, drawn: surfaces, sections, edges of cells and of bodies.

use std::collections::BTreeMap;

use super::super::colours::MAP;
use super::camera::{Camera, cross, unit};
use super::canvas::{Canvas, Corner};
use super::image::Colour;
use super::model::{Model, Patch};
use super::pose::{Pose, Vertex};

/// Ground of a picture, and colour of lines and words.
pub(super) const GROUND: Colour = [255, 255, 255];
pub(super) const INK: Colour = [22, 25, 37];
/// Colour of surfaces without value.
const PLAIN: Colour = [204, 206, 210];
/// Faces that meet at less than this are one smooth surface (cosine).
const SMOOTH: f64 = 0.8;
/// Distance of the edges of cells, in points of the picture, from which on they begin to show, and from which on they do so fully.
const EDGES: [f64; 2] = [8.0, 15.0];

/// Share of the ink on rims of bodies, and on edges of cells.
const RIM: f64 = 0.85;
const CELL: f64 = 0.42;
/// Steps in which edges of cells begin to show: the file of few shades is smaller.
const SHADES: f64 = 4.0;
/// Steps of the colours, about as fine as the eye tells apart, which keeps files small.
const STEPS: f64 = 40.0;

/// Least and largest value of the colours.
pub(super) type Limits = [f64; 2];

/// The colour of a value; grey where there is none.
pub(super) fn colour(value: f64, [low, high]: Limits) -> Colour {
    if !value.is_finite() {
        return PLAIN;
    }
    let share = if high > low { ((value - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 };
    let at = (share * STEPS).round() / STEPS * (MAP.len() - 1) as f64;
    let first = (at as usize).min(MAP.len() - 2);
    let mix = |c: usize| {
        let [a, b] = [MAP[first][c], MAP[first + 1][c]].map(f64::from);
        (a + (at - first as f64) * (b - a)).round() as u8
    };
    [0, 1, 2].map(mix)
}

/// Draws all of it; `thick` is the width of the lines of bodies.
pub(super) fn draw(canvas: &mut Canvas, model: &Model, pose: &Pose, camera: &Camera, limits: Limits, thick: f64) {
    let colours = |value: f64| colour(value, limits);
    let corner = |own: &Vertex, normal: [f64; 3]| Corner {
        place: camera.place(own.place),
        value: own.value,
        light: camera.light(normal),
        height: own.height,
    };
    let normals: Vec<[f64; 3]> = model.patches.iter().map(|patch| normal(patch, pose)).collect();
    let at_vertices = vertex_normals(model, &normals, pose.vertices.len());
    for (patch, &own) in model.patches.iter().zip(&normals) {
        let own = unit(own);
        for three in &patch.triangles {
            let corners = three.map(|at| {
                let near = at_vertices.of(at).iter().filter_map(|&other| {
                    let normal = normals[other as usize];
                    let same = model.patches[other as usize].body == patch.body;
                    (same && dot(unit(normal), own).abs() > SMOOTH)
                        .then(|| normal.map(|part| part * dot(normal, own).signum()))
                });
                let sum = near.fold([0.0; 3], |sum, normal| std::array::from_fn(|c| sum[c] + normal[c]));
                corner(&pose.vertices[at as usize], unit(sum))
            });
            canvas.triangle(&corners, &colours);
        }
    }
    for three in &pose.section {
        let [a, b, c] = three.map(|own| own.place);
        let way = |p: [f64; 3]| std::array::from_fn(|at| p[at] - a[at]);
        let normal = unit(cross(way(b), way(c)));
        canvas.triangle(&three.map(|own| corner(&own, normal)), &colours);
    }
    for ends in rims(model, pose) {
        let [a, b] = ends.map(|own| corner(&own, [0.0; 3]));
        canvas.line([&a, &b], thick, INK, RIM, 2.0);
    }
    for (ends, distance) in cut_cells(pose, camera) {
        let [a, b] = ends.map(|own| corner(&own, [0.0; 3]));
        canvas.line([&a, &b], 0.6 * thick, INK, of_cell(distance), 2.0);
    }
    for (ends, is_rim, distance) in edges(model, pose, camera, &normals) {
        let share = if is_rim { RIM } else { of_cell(distance) };
        if share > 0.0 {
            let [a, b] = ends.map(|at| corner(&pose.vertices[at as usize], [0.0; 3]));
            let width = if is_rim { thick } else { 0.6 * thick };
            canvas.line([&a, &b], width, INK, share, 2.0);
        }
    }
}

/// Share of the ink on the edge of a cell of this width on the picture.
fn of_cell(width: f64) -> f64 {
    let share = ((width - EDGES[0]) / (EDGES[1] - EDGES[0])).clamp(0.0, 1.0);
    CELL * (SHADES * share).round() / SHADES
}

/// Width of a convex face on the picture from the area of its sides' triangles and their length: that of a strip of this area and rim.
fn strip(area: f64, around: f64) -> f64 {
    if around > 0.0 { 4.0 * area.abs() / around } else { 0.0 }
}

/// Lines of the section, each once, with the width of the narrower of its cells.
fn cut_cells(pose: &Pose, camera: &Camera) -> Vec<([Vertex; 2], f64)> {
    let flat = |own: &Vertex| {
        let [x, y, _] = camera.place(own.place);
        [x, y]
    };
    let mut found: BTreeMap<[u32; 4], ([Vertex; 2], f64)> = BTreeMap::new();
    for cell in pose.outlines.chunk_by(|a, b| a.cell == b.cell) {
        let sides: Vec<[[f64; 2]; 2]> = cell.iter().map(|own| own.ends.each_ref().map(flat)).collect();
        let ends = || sides.iter().flatten();
        let centre: [f64; 2] = std::array::from_fn(|c| ends().map(|end| end[c]).sum::<f64>() / ends().count() as f64);
        let (area, around) = sides.iter().fold((0.0, 0.0), |(area, around), [a, b]| {
            let double = (a[0] - centre[0]) * (b[1] - centre[1]) - (b[0] - centre[0]) * (a[1] - centre[1]);
            (area + double.abs() / 2.0, around + (b[0] - a[0]).hypot(b[1] - a[1]))
        });
        let width = strip(area, around);
        for own in cell {
            found.entry(own.face).and_modify(|known| known.1 = known.1.min(width)).or_insert((own.ends, width));
        }
    }
    found.into_values().filter(|(_, width)| of_cell(*width) > 0.0).collect()
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Where surfaces meet the cutting plane.
fn rims(model: &Model, pose: &Pose) -> Vec<[Vertex; 2]> {
    let mut found = Vec::new();
    for three in model.patches.iter().flat_map(|patch| &patch.triangles) {
        let corners = three.map(|at| &pose.vertices[at as usize]);
        let ends: Vec<Vertex> = [[0, 1], [1, 2], [2, 0]]
            .iter()
            .map(|side| side.map(|at| corners[at]))
            .filter(|[a, b]| (a.height > 0.0) != (b.height > 0.0))
            .map(|[a, b]| a.towards_plane(b))
            .collect();
        if let [a, b] = ends[..] {
            found.push([a, b]);
        }
    }
    found
}

/// Normal of a face, as long as twice its area (Newell).
fn normal(patch: &Patch, pose: &Pose) -> [f64; 3] {
    let mut sum = [0.0; 3];
    let first = pose.vertices[patch.ring[0] as usize].place;
    let way = |at: u32| std::array::from_fn(|c| pose.vertices[at as usize].place[c] - first[c]);
    for (&a, &b) in patch.ring.iter().zip(patch.ring.iter().cycle().skip(1)) {
        let part = cross(way(a), way(b));
        sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
    }
    sum
}

/// The faces at each vertex.
struct AtVertices {
    from: Vec<u32>,
    faces: Vec<u32>,
}

impl AtVertices {
    fn of(&self, vertex: u32) -> &[u32] {
        &self.faces[self.from[vertex as usize] as usize..self.from[vertex as usize + 1] as usize]
    }
}

fn vertex_normals(model: &Model, normals: &[[f64; 3]], count: usize) -> AtVertices {
    let mut from = vec![0_u32; count + 1];
    let corners = |patch: &Patch| {
        let mut all: Vec<u32> = patch.triangles.iter().flatten().copied().collect();
        all.sort_unstable();
        all.dedup();
        all
    };
    let of_patches: Vec<Vec<u32>> = model.patches.iter().map(corners).collect();
    of_patches.iter().flatten().for_each(|&at| from[at as usize + 1] += 1);
    (0..count).for_each(|at| from[at + 1] += from[at]);
    let mut next = from.clone();
    let mut faces = vec![0; from[count] as usize];
    for (face, _) in normals.iter().enumerate() {
        for &at in &of_patches[face] {
            faces[next[at as usize] as usize] = face as u32;
            next[at as usize] += 1;
        }
    }
    AtVertices { from, faces }
}

/// Edges with whether they are a rim of a body or a kink of its surface, and their distance to the next ones on the picture.
fn edges(model: &Model, pose: &Pose, camera: &Camera, normals: &[[f64; 3]]) -> Vec<([u32; 2], bool, f64)> {
    let mut known: BTreeMap<(usize, u32, u32), Vec<usize>> = BTreeMap::new();
    for (at, patch) in model.patches.iter().enumerate() {
        for (&a, &b) in patch.ring.iter().zip(patch.ring.iter().cycle().skip(1)) {
            known.entry((patch.body, a.min(b), a.max(b))).or_default().push(at);
        }
    }
    let flat = |at: u32| {
        let [x, y, _] = camera.place(pose.vertices[at as usize].place);
        [x, y]
    };
    let sizes: Vec<f64> = model
        .patches
        .iter()
        .map(|patch| {
            let ring: Vec<[f64; 2]> = patch.ring.iter().map(|&at| flat(at)).collect();
            let sides = ring.iter().zip(ring.iter().cycle().skip(1));
            let (area, around) = sides.fold((0.0, 0.0), |(area, around), (a, b)| {
                (area + (a[0] * b[1] - a[1] * b[0]) / 2.0, around + (b[0] - a[0]).hypot(b[1] - a[1]))
            });
            strip(area, around)
        })
        .collect();
    let of = |((_, a, b), faces): ((usize, u32, u32), Vec<usize>)| {
        let is_rim = match faces[..] {
            [one, other] => dot(unit(normals[one]), unit(normals[other])).abs() < SMOOTH,
            _ => true,
        };
        let is_cell = faces.iter().all(|&at| model.patches[at].is_cell);
        let distance = if is_cell { faces.iter().map(|&at| sizes[at]).fold(f64::INFINITY, f64::min) } else { 0.0 };
        ([a, b], is_rim, distance)
    };
    known.into_iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_go_from_end_to_end_of_the_map() {
        assert_eq!(colour(2.0, [2.0, 4.0]), MAP[0]);
        assert_eq!(colour(3.0, [2.0, 4.0]), MAP[6]);
        assert_eq!(colour(9.0, [2.0, 4.0]), MAP[12]);
        assert_eq!(colour(f64::NAN, [2.0, 4.0]), PLAIN);
    }
}
