//! The bodies of a picture: faces and inside, mirrored at planes of symmetry or turned about the axis of revolution.

use std::collections::BTreeMap;

use zelus_core::geometry::Shape;
use zelus_core::io::results::Dataset;

use super::super::skin::{Face, bodies, faces, inside, is_flat};

/// Turns of a body of revolution by 5°.
const TURN: f64 = 5.0;

/// A face with its rim, and triangles that cover it.
#[derive(Debug, Clone)]
pub(super) struct Patch {
    pub body: usize,
    pub ring: Vec<u32>,
    pub triangles: Vec<[u32; 3]>,
    /// Whether its rim is that of a cell.
    pub is_cell: bool,
}

/// A cell of a body in space: its shape of first order, and its corners.
#[derive(Debug, Clone)]
pub(super) struct Solid {
    pub shape: Shape,
    pub corners: Vec<u32>,
}

/// Rows of a matrix and what is added after it.
type Move = [[f64; 4]; 3];

const STAY: Move = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

/// Vertices, each a node that is moved to another place of the whole body, with what is made of them.
#[derive(Debug)]
pub(super) struct Model {
    /// Node and number of the move.
    pub vertices: Vec<(u32, u32)>,
    moves: Vec<Move>,
    pub patches: Vec<Patch>,
    pub tetrahedra: Vec<[u32; 4]>,
    pub solids: Vec<Solid>,
    /// Least id of the nodes of each body that is drawn.
    pub names: BTreeMap<usize, usize>,
    pub is_solid: bool,
}

impl Model {
    /// The bodies of a picture for which `is_shown` holds, by their least node and their place.
    pub fn new(data: &Dataset, is_shown: &dyn Fn(usize, usize) -> bool) -> Self {
        let (of_cells, count) = bodies(data);
        let all = faces(data, &of_cells);
        let mut least: Vec<usize> = vec![usize::MAX; count];
        for ((_, points), &body) in data.cells.iter().zip(&of_cells) {
            let ids = points.iter().map(|&point| data.point_ids.get(point as usize).copied().unwrap_or(point as usize));
            least[body] = least[body].min(ids.min().unwrap_or(usize::MAX));
        }
        let mut seen: Vec<usize> = all.iter().map(|face| face.body).collect();
        seen.dedup();
        let is_shown = |(at, body): (usize, &usize)| is_shown(least[*body], at).then_some((*body, least[*body]));
        let names: BTreeMap<usize, usize> = seen.iter().enumerate().filter_map(is_shown).collect();
        let patch = |face: &Face| {
            let mut triangles = Vec::new();
            face.triangles(&mut triangles);
            let triangles = triangles.chunks_exact(3).map(|three| [three[0], three[1], three[2]]).collect();
            Patch { body: face.body, ring: face.ring.clone(), triangles, is_cell: true }
        };
        let cells = data
            .cells
            .iter()
            .zip(&of_cells)
            .filter(|((shape, _), body)| shape.cell().dim == 3 && names.contains_key(body));
        let solids = cells.map(|((shape, points), _)| {
            let shape = shape.linear();
            Solid { shape, corners: points[..shape.nodes()].to_vec() }
        });
        let solids: Vec<Solid> = solids.collect();
        let solid = inside(data, &of_cells, count);
        Self {
            vertices: (0..data.points.len() as u32).map(|node| (node, 0)).collect(),
            moves: vec![STAY],
            patches: all.iter().filter(|face| names.contains_key(&face.body)).map(patch).collect(),
            tetrahedra: names.keys().flat_map(|&body| solid[body].iter().copied()).collect(),
            solids,
            is_solid: names.keys().any(|&body| !is_flat(data, &of_cells, body)),
            names,
        }
    }

    /// Adds the mirror image at a plane across an axis; nodes on the plane are shared, and faces on it are inside.
    pub fn mirror(&mut self, axis: usize, at: f64, points: &[[f64; 3]]) {
        let size = points.iter().map(|point| (point[axis] - at).abs()).fold(0.0, f64::max);
        let count = self.vertices.len();
        let on_plane: Vec<bool> =
            (0..count).map(|own| (self.position(own, points)[axis] - at).abs() <= 1e-6 * size).collect();
        self.patches.retain(|patch| !patch.ring.iter().all(|&own| on_plane[own as usize]));
        let moves = self.moves.len();
        for own in 0..moves {
            let mut mirrored = self.moves[own];
            mirrored[axis] = mirrored[axis].map(|part| -part);
            mirrored[axis][3] += 2.0 * at;
            self.moves.push(mirrored);
        }
        let mut image: Vec<u32> = Vec::with_capacity(count);
        for (own, &on_plane) in on_plane.iter().enumerate() {
            if on_plane {
                image.push(own as u32);
            } else {
                image.push(self.vertices.len() as u32);
                let (node, by) = self.vertices[own];
                self.vertices.push((node, by + moves as u32));
            }
        }
        let of = |own: u32| image[own as usize];
        let mirrored = |patch: &Patch| Patch {
            ring: patch.ring.iter().map(|&own| of(own)).collect(),
            triangles: patch.triangles.iter().map(|three| three.map(of)).collect(),
            ..patch.clone()
        };
        let patches: Vec<Patch> = self.patches.iter().map(mirrored).collect();
        self.patches.extend(patches);
        let tetrahedra: Vec<[u32; 4]> = self.tetrahedra.iter().map(|four| four.map(of)).collect();
        self.tetrahedra.extend(tetrahedra);
        let moved = |own: &Solid| Solid { corners: own.corners.iter().map(|&own| of(own)).collect(), ..own.clone() };
        let solids: Vec<Solid> = self.solids.iter().map(moved).collect();
        self.solids.extend(solids);
    }

    /// Turns a section about the axis of revolution, which is y, by an angle in degrees.
    pub fn revolve(&mut self, degrees: f64, points: &[[f64; 3]]) {
        let steps = (degrees / TURN).ceil().max(1.0) as u32;
        let is_whole = degrees >= 360.0 - 1e-9;
        self.moves = (0..=steps)
            .map(|step| {
                let (sin, cos) = (degrees.to_radians() * f64::from(step) / f64::from(steps)).sin_cos();
                [[cos, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [-sin, 0.0, 0.0, 0.0]]
            })
            .collect();
        let size = points.iter().map(|point| point[0].abs()).fold(0.0, f64::max);
        let sections = std::mem::take(&mut self.patches);
        let nodes = self.vertices.len() as u32;
        self.vertices = (0..=steps).flat_map(|step| (0..nodes).map(move |node| (node, step))).collect();
        let at = |node: u32, step: u32| {
            let on_axis = points[node as usize][0].abs() <= 1e-9 * size;
            node + if on_axis || (is_whole && step == steps) { 0 } else { step * nodes }
        };
        let mut rims: BTreeMap<(usize, u32, u32), Option<[u32; 2]>> = BTreeMap::new();
        for patch in &sections {
            for (&a, &b) in patch.ring.iter().zip(patch.ring.iter().cycle().skip(1)) {
                let rim = rims.entry((patch.body, a.min(b), a.max(b))).or_insert(Some([a, b]));
                // an edge between two cells of a body is inside
                if *rim != Some([a, b]) {
                    *rim = None;
                }
            }
        }
        for ((body, ..), rim) in rims {
            let Some([a, b]) = rim else { continue };
            for step in 0..steps {
                let ring = [at(a, step), at(b, step), at(b, step + 1), at(a, step + 1)];
                let mut own: Vec<u32> = ring.to_vec();
                own.dedup();
                if own.first() == own.last() {
                    own.pop();
                }
                let triangles = (2..own.len()).map(|last| [own[0], own[last - 1], own[last]]).collect();
                if own.len() > 2 {
                    self.patches.push(Patch { body, ring: own, triangles, is_cell: false });
                }
            }
        }
        if is_whole {
            return;
        }
        for step in [0, steps] {
            let turned = |patch: &Patch| Patch {
                ring: patch.ring.iter().map(|&node| at(node, step)).collect(),
                triangles: patch.triangles.iter().map(|three| three.map(|node| at(node, step))).collect(),
                ..patch.clone()
            };
            self.patches.extend(sections.iter().map(turned));
        }
    }

    /// A point as the move of a vertex takes it.
    pub fn moved(&self, vertex: usize, point: [f64; 3]) -> [f64; 3] {
        let by = &self.moves[self.vertices[vertex].1 as usize];
        by.map(|row| row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3])
    }

    fn position(&self, vertex: usize, points: &[[f64; 3]]) -> [f64; 3] {
        self.moved(vertex, points[self.vertices[vertex].0 as usize])
    }

    /// Vertices that faces or the inside use.
    pub fn used(&self) -> Vec<u32> {
        let of_patches = self.patches.iter().flat_map(|patch| patch.triangles.iter().flatten());
        let mut all: Vec<u32> = of_patches.chain(self.tetrahedra.iter().flatten()).copied().collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(model: &Model, points: &[[f64; 3]]) -> f64 {
        let of = |three: &[u32; 3]| {
            let [a, b, c] = three.map(|own| model.position(own as usize, points));
            let way = |p: [f64; 3]| std::array::from_fn(|c| p[c] - a[c]);
            super::super::camera::cross(way(b), way(c)).iter().map(|x| x * x).sum::<f64>().sqrt() / 2.0
        };
        model.patches.iter().flat_map(|patch| &patch.triangles).map(of).sum()
    }

    #[test]
    fn an_eighth_of_a_cube_becomes_the_cube() {
        let shape = Shape::Hex8;
        let points: Vec<[f64; 3]> = shape.cell().points.iter().map(|point| point.map(|x| (x + 1.0) / 2.0)).collect();
        let mut data = Dataset { points: points.clone(), ..Dataset::default() };
        data.cells.push(1, 0, shape, 0..8);
        let mut model = Model::new(&data, &|_, _| true);
        // ANALYTIC: area of a cube of edge 1 and, after three planes, of edge 2
        assert!((area(&model, &points) - 6.0).abs() < 1e-12);
        (0..3).for_each(|axis| model.mirror(axis, 0.0, &points));
        assert!((area(&model, &points) - 24.0).abs() < 1e-12);
        assert_eq!((model.vertices.len(), model.tetrahedra.len()), (27, 48));
    }

    #[test]
    fn a_rectangle_becomes_a_tube() {
        let points = vec![[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 3.0, 0.0], [1.0, 3.0, 0.0]];
        let mut data = Dataset { points: points.clone(), ..Dataset::default() };
        data.cells.push(1, 0, Shape::Quad4, 0..4);
        let mut model = Model::new(&data, &|_, _| true);
        model.revolve(360.0, &points);
        // ANALYTIC: chords of 72 turns instead of circles: 2 π r becomes 144 r sin(2.5°); rings by chords, too
        let chord = 144.0 * 2.5_f64.to_radians().sin();
        let rings = 72.0 * 5.0_f64.to_radians().sin() * (4.0 - 1.0);
        let exact = chord * 3.0 * (2.0 + 1.0) + rings;
        assert!((area(&model, &points) / exact - 1.0).abs() < 1e-9, "{} instead of {exact}", area(&model, &points));
    }
}
