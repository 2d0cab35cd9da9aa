//! Outer surface of a picture, body by body, as numbers of a page; of smaller meshes also the inside, for cuts.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

use serde_json::{Value, json};
use zelus_core::Result;
use zelus_core::geometry::{Facet, Shape};
use zelus_core::io::results::{Column, Dataset};

use super::deformation::displacements;
use super::results::Series;
use super::stress_columns::with_invariants;

/// Most numbers of all steps of a series in a page; beyond, steps are left out evenly.
const MOST_NUMBERS: usize = 8_000_000;
/// Most numbers of a step; fields beyond are left out, scalars and displacements last.
const MOST_OF_A_STEP: usize = 4_000_000;
/// Most tetrahedra of a page, by which it shows colours on a cut.
const MOST_TETRAHEDRA: usize = 400_000;
/// Most edges of cells of a page; more would hide the colours.
const MOST_EDGES: usize = 600_000;

/// A face that is seen: its corners in order, and where it has them the nodes in the middle of its edges and its own.
pub(super) struct Face {
    pub body: usize,
    pub ring: Vec<u32>,
    pub middle: Option<u32>,
    is_curved: bool,
}

impl Face {
    fn new(body: usize, corners: usize, nodes: &[u32]) -> Self {
        let is_curved = nodes.len() >= 2 * corners;
        let ring = match is_curved {
            true => (0..corners).flat_map(|at| [nodes[at], nodes[corners + at]]).collect(),
            false => nodes[..corners].to_vec(),
        };
        Self { body, ring, middle: nodes.get(2 * corners).copied(), is_curved }
    }

    /// Triangles that cover it, with its orientation.
    pub(super) fn triangles(&self, out: &mut Vec<u32>) {
        let count = self.ring.len();
        if let Some(middle) = self.middle {
            (0..count).for_each(|at| out.extend([middle, self.ring[at], self.ring[(at + 1) % count]]));
            return;
        }
        let inner: Vec<u32> = match self.is_curved {
            true => self.ring.iter().skip(1).step_by(2).copied().collect(),
            false => self.ring.clone(),
        };
        if self.is_curved {
            (0..count).step_by(2).for_each(|at| {
                out.extend([self.ring[(at + count - 1) % count], self.ring[at], self.ring[at + 1]]);
            });
        }
        (2..inner.len()).for_each(|at| out.extend([inner[0], inner[at - 1], inner[at]]));
    }

    fn edges(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let pairs = self.ring.iter().zip(self.ring.iter().cycle().skip(1));
        pairs.map(|(&a, &b)| [a.min(b), a.max(b)])
    }
}

/// The body of each cell: cells that share points and have the same properties; bodies are numbered in the order of their first cell.
pub(super) fn bodies(data: &Dataset) -> (Vec<usize>, usize) {
    let mut parent: Vec<u32> = (0..data.points.len() as u32).collect();
    fn root(parent: &mut [u32], mut at: u32) -> u32 {
        while parent[at as usize] != at {
            parent[at as usize] = parent[parent[at as usize] as usize];
            at = parent[at as usize];
        }
        at
    }
    for (_, points) in data.cells.iter().filter(|(shape, _)| shape.cell().dim >= 2) {
        let first = root(&mut parent, points[0]);
        for &point in points {
            let other = root(&mut parent, point);
            parent[other as usize] = first;
        }
    }
    let mut known: BTreeMap<(u32, i64), usize> = BTreeMap::new();
    let materials = data.cell_data.iter().find(|column| column.name == "PROPERTIES_ID");
    let of_cells = data.cells.iter().enumerate().map(|(cell, (_, points))| {
        let (next, material) = (known.len(), materials.map_or(0, |column| column.values.get(cell) as i64));
        *known.entry((root(&mut parent, points[0]), material)).or_insert(next)
    });
    let of_cells = of_cells.collect();
    (of_cells, known.len())
}

/// The faces that only one cell of a body has, by body; of surfaces all, and of lines none.
pub(super) fn faces(data: &Dataset, bodies: &[usize]) -> Vec<Face> {
    const NOTHING: u32 = u32::MAX;
    // Corners in ascending order with the body; cell and face.
    let mut sides: Vec<([u32; 5], u32, u32)> = Vec::new();
    for (cell, ((shape, points), &body)) in data.cells.iter().zip(bodies).enumerate() {
        let reference = shape.cell();
        match reference.dim {
            // Cells that lie upon each other are all seen.
            2 => sides.push(([NOTHING, NOTHING, NOTHING, cell as u32, body as u32], cell as u32, 0)),
            3 => sides.extend(reference.faces.iter().enumerate().map(|(at, face)| {
                let mut key = [NOTHING; 5];
                let corners = corners_of(face);
                key.iter_mut().zip(&face.nodes[..corners]).for_each(|(own, &node)| *own = points[node]);
                key[..4].sort_unstable();
                key[4] = body as u32;
                (key, cell as u32, at as u32)
            })),
            _ => {}
        }
    }
    sides.sort_unstable();
    let mut single: Vec<(u32, u32, u32)> = Vec::new();
    for same in sides.chunk_by(|a, b| a.0 == b.0) {
        if let [(key, cell, face)] = same {
            single.push((key[4], *cell, *face));
        }
    }
    single.sort_unstable();
    let mut first = Vec::with_capacity(data.cells.len());
    let mut next = 0;
    for (shape, _) in data.cells.iter() {
        first.push(next);
        next += shape.nodes();
    }
    let made = single.into_iter().map(|(body, cell, at)| {
        let (shape, from) = (data.cells.shapes[cell as usize], first[cell as usize]);
        let (reference, points) = (shape.cell(), &data.cells.points[from..from + shape.nodes()]);
        if reference.dim == 2 {
            return Face::new(body as usize, reference.edges.len(), points);
        }
        let face = &reference.faces[at as usize];
        let nodes: Vec<u32> = face.nodes.iter().map(|&node| points[node]).collect();
        Face::new(body as usize, corners_of(face), &nodes)
    });
    made.collect()
}

fn corners_of(face: &Facet) -> usize {
    face.shape.cell().edges.len()
}

/// Tetrahedra between the corners of a cell.
fn tetrahedra(points: &[u32], corners: usize) -> Vec<[u32; 4]> {
    let of: &[[usize; 4]] = match corners {
        4 => &[[0, 1, 2, 3]],
        5 => &[[0, 1, 2, 4], [0, 2, 3, 4]],
        6 => &[[0, 1, 2, 5], [0, 1, 5, 4], [0, 4, 5, 3]],
        8 => &[[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]],
        _ => &[],
    };
    of.iter().map(|four| four.map(|at| points[at])).collect()
}

/// Tetrahedra of the cells of a picture, by body.
pub(super) fn inside(data: &Dataset, bodies: &[usize], count: usize) -> Vec<Vec<[u32; 4]>> {
    let mut out = vec![Vec::new(); count];
    for ((shape, points), &body) in data.cells.iter().zip(bodies).filter(|((shape, _), _)| shape.cell().dim == 3) {
        out[body].extend(tetrahedra(points, corners(shape)));
    }
    out
}

/// Corners of a solid cell: those of two opposite faces, or of a tetrahedron or pyramid.
fn corners(shape: Shape) -> usize {
    match shape.cell().faces.len() {
        4 => 4,
        5 if matches!(shape, Shape::Pyramid5 | Shape::Pyramid13) => 5,
        5 => 6,
        _ => 8,
    }
}

/// A series as a page shows it: surface, bodies, and fields at all steps, arrays in base64; nothing where nothing is seen.
///
/// # Errors
/// Pictures that cannot be read.
pub(super) fn view(name: &str, series: &Series) -> Result<Option<Value>> {
    let Some(first) = series.first() else { return Ok(None) };
    let first = first.read()?;
    let (bodies, count) = bodies(&first);
    let faces = faces(&first, &bodies);
    if faces.is_empty() {
        return Ok(None);
    }
    let numbers = |points: usize| {
        let columns: usize = with_invariants(&first).iter().map(|column| column.components).sum();
        (columns + 3) * points * series.len()
    };
    let mut solid = inside(&first, &bodies, count);
    let tetrahedra: usize = solid.iter().map(Vec::len).sum();
    let has_inside = tetrahedra <= MOST_TETRAHEDRA && numbers(first.points.len()) <= MOST_NUMBERS;
    if !has_inside {
        solid.iter_mut().for_each(Vec::clear);
    }
    let of_faces = faces.iter().flat_map(|face| face.ring.iter().chain(&face.middle));
    let mut seen: Vec<u32> = of_faces.chain(solid.iter().flatten().flatten()).copied().collect();
    seen.sort_unstable();
    seen.dedup();
    let mut place = vec![u32::MAX; first.points.len()];
    seen.iter().enumerate().for_each(|(at, &point)| place[point as usize] = at as u32);
    let at = |point: u32| place[point as usize];
    let (mut triangles, mut edges, mut cut) = (Vec::new(), Vec::new(), Vec::new());
    let mut listed: Vec<Value> = Vec::with_capacity(count);
    let mut least: Vec<usize> = vec![usize::MAX; count];
    for ((_, points), &body) in first.cells.iter().zip(&bodies) {
        let ids = points.iter().map(|&point| first.point_ids.get(point as usize).copied().unwrap_or(point as usize));
        least[body] = least[body].min(ids.min().unwrap_or(usize::MAX));
    }
    let mut rest = &faces[..];
    for body in 0..count {
        let (own, others) = rest.split_at(rest.partition_point(|face| face.body <= body));
        rest = others;
        let from = [triangles.len(), edges.len(), cut.len()];
        own.iter().for_each(|face| face.triangles(&mut triangles));
        let mut of_body: Vec<[u32; 2]> = own.iter().flat_map(Face::edges).collect();
        of_body.sort_unstable();
        of_body.dedup();
        edges.extend(of_body.into_iter().flatten());
        cut.extend(solid[body].iter().flatten().copied());
        if own.is_empty() {
            continue;
        }
        let range = |range: Range<usize>| json!([range.start, range.len()]);
        listed.push(json!({
            "node": least[body],
            "is_solid": !is_flat(&first, &bodies, body),
            "triangles": range(from[0]..triangles.len()),
            "edges": range(from[1]..edges.len()),
            "tetrahedra": range(from[2]..cut.len()),
        }));
    }
    let has_edges = edges.len() / 2 <= MOST_EDGES;
    if !has_edges {
        edges.clear();
        listed.iter_mut().for_each(|body| body["edges"] = json!([0, 0]));
    }
    let left_out = left_out(&with_invariants(&first), seen.len());
    let dropped: usize = left_out.values().sum();
    let every = (numbers(seen.len()) - dropped * seen.len() * series.len()).div_ceil(MOST_NUMBERS).max(1);
    let mut steps = Vec::new();
    for (number, frame) in series.iter().enumerate() {
        if !number.is_multiple_of(every) && number + 1 != series.len() {
            continue;
        }
        let data = frame.read()?;
        if data.points.len() != first.points.len() {
            continue;
        }
        let moved = data.points.iter().zip(&first.points).any(|(x, y)| x != y);
        let given = data.point_data.iter().find(|column| column.name == "DISPLACEMENT" && column.components == 3);
        let ways = displacements(&data, &first);
        let displacement: Vec<f64> = seen.iter().flat_map(|&point| ways[point as usize]).collect();
        let fields = with_invariants(&data);
        let kept = fields.iter().filter(|column| !left_out.contains_key(&column.name));
        // Without a text of its own a field is that of the displacements.
        let text = |column: &Column| match given {
            Some(given) if given.name == column.name && !moved => Value::Null,
            _ => json!(floats(&of_points(column, &seen))),
        };
        let fields: Vec<Value> = kept.map(|column| json!([column.name, column.components, text(column)])).collect();
        steps.push(json!({ "time": frame.time, "displacement": floats(&displacement), "fields": fields }));
    }
    let points: Vec<f64> = seen.iter().flat_map(|&point| first.points[point as usize]).collect();
    let ids = seen.iter().filter_map(|&point| first.point_ids.get(point as usize)).map(|&id| id as u32);
    Ok(Some(json!({
        "name": name,
        "points": floats(&points),
        "ids": whole(ids),
        "triangles": whole(triangles.into_iter().map(at)),
        "edges": whole(edges.into_iter().map(at)),
        "has_edges": has_edges,
        "tetrahedra": whole(cut.into_iter().map(at)),
        "has_inside": has_inside,
        "bodies": listed,
        "fields_left_out": left_out.keys().collect::<Vec<_>>(),
        "steps_left_out": series.len() - steps.len(),
        "steps": steps,
    })))
}

/// The widest columns of a step that is too large, by name with their components: tensors first, then vectors.
fn left_out(columns: &[Cow<'_, Column>], points: usize) -> BTreeMap<String, usize> {
    let mut widths: Vec<(usize, &str)> = columns
        .iter()
        .filter(|own| own.name != "DISPLACEMENT")
        .map(|own| (own.components, own.name.as_str()))
        .collect();
    widths.sort_unstable();
    let mut sum = 3 + widths.iter().map(|(width, _)| width).sum::<usize>();
    let mut out = BTreeMap::new();
    while sum * points > MOST_OF_A_STEP {
        let Some((width, name)) = widths.pop().filter(|(width, _)| *width > 1) else { break };
        sum -= width;
        out.insert(name.to_owned(), width);
    }
    out
}

/// Whether the first cell of a body is a surface.
pub(super) fn is_flat(data: &Dataset, bodies: &[usize], body: usize) -> bool {
    let first = bodies.iter().position(|own| *own == body);
    first.is_some_and(|cell| data.cells.shapes[cell].cell().dim < 3)
}

fn of_points(column: &Column, points: &[u32]) -> Vec<f64> {
    let of =
        |&point: &u32| (0..column.components).map(move |c| column.values.get(point as usize * column.components + c));
    points.iter().flat_map(of).collect()
}

fn floats(values: &[f64]) -> String {
    base64(values.iter().flat_map(|&value| (value as f32).to_le_bytes()))
}

fn whole(values: impl Iterator<Item = u32>) -> String {
    base64(values.flat_map(u32::to_le_bytes))
}

/// Bytes as a page may hold them (RFC 4648).
fn base64(bytes: impl Iterator<Item = u8>) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let bytes: Vec<u8> = bytes.collect();
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let number = (0..3).fold(0_u32, |sum, at| sum << 8 | u32::from(three.get(at).copied().unwrap_or(0)));
        for at in 0..4 {
            let letter = LETTERS[(number >> (18 - 6 * at)) as usize & 63];
            out.push(if at <= three.len() { letter as char } else { '=' });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use zelus_core::geometry::Shape;

    #[test]
    fn base64_is_that_of_the_standard() {
        let said = ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(|text| base64(text.bytes()));
        assert_eq!(said, ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"]);
    }

    fn two_cells() -> Dataset {
        let mut data = Dataset { points: vec![[0.0; 3]; 12], ..Dataset::default() };
        data.cells.push(1, 0, Shape::Hex8, 0..8);
        data.cells.push(2, 0, Shape::Hex8, [4, 5, 6, 7, 8, 9, 10, 11]);
        data
    }

    fn seen(data: &Dataset) -> Vec<Face> {
        faces(data, &bodies(data).0)
    }

    #[test]
    fn faces_between_cells_of_a_body_are_not_seen() {
        let mut data = two_cells();
        assert_eq!(seen(&data).len(), 10);
        data.cell_data.push(Column::ids("PROPERTIES_ID", &[1, 2]));
        assert_eq!(seen(&data).len(), 12);
        data.cell_data.clear();
        data.cells.push(3, 0, Shape::Quad9, 0..9);
        data.cells.push(4, 0, Shape::Tri3, [0, 1, 2]);
        data.cells.push(5, 0, Shape::Line2, [0, 1]);
        let all = seen(&data);
        assert_eq!(
            (all.len(), &all[10].ring[..], &all[11].ring[..]),
            (12, &[0, 4, 1, 5, 2, 6, 3, 7][..], &[0, 1, 2][..])
        );
    }

    #[test]
    fn large_steps_keep_scalars_and_displacements() {
        let column = |name: &str, width: usize| Cow::Owned(Column::real(name, width, Vec::new()));
        let columns =
            [column("DISPLACEMENT", 3), column("STRESS", 6), column("REACTION", 3), column("VON_MISES_STRESS", 1)];
        let names = |points: usize| left_out(&columns, points).into_keys().collect::<Vec<_>>();
        assert!(names(MOST_OF_A_STEP / 13).is_empty());
        assert_eq!(names(MOST_OF_A_STEP / 12), ["STRESS"]);
        assert_eq!(names(MOST_OF_A_STEP / 6), ["REACTION", "STRESS"]);
        assert_eq!(names(MOST_OF_A_STEP), ["REACTION", "STRESS"]);
    }

    #[test]
    fn bodies_are_cells_that_share_points_and_material() {
        let mut data = two_cells();
        data.points.extend([[0.0; 3]; 4]);
        data.cells.push(3, 0, Shape::Tet4, [12, 13, 14, 15]);
        assert_eq!(bodies(&data), (vec![0, 0, 1], 2));
        data.cell_data.push(Column::ids("PROPERTIES_ID", &[1, 2, 2]));
        assert_eq!(bodies(&data), (vec![0, 1, 2], 3));
    }

    #[test]
    fn triangles_and_tetrahedra_fill_a_cell() {
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let shapes =
            [Shape::Hex8, Shape::Hex20, Shape::Hex27, Shape::Tet4, Shape::Tet10, Shape::Prism6, Shape::Prism15];
        for shape in shapes.into_iter().chain([Shape::Pyramid5, Shape::Pyramid13]) {
            let points = shape.cell().points;
            let mut data = Dataset { points: points.to_vec(), ..Dataset::default() };
            data.cells.push(1, 0, shape, 0..points.len() as u32);
            let volume = |at: &[u32], from: [f64; 3]| {
                let way = |k: usize| std::array::from_fn(|c| points[at[k] as usize][c] - from[c]);
                let (a, normal) = (way(0), cross(way(1), way(2)));
                a.iter().zip(normal).map(|(x, n)| x * n).sum::<f64>() / 6.0
            };
            let mut triangles = Vec::new();
            seen(&data).iter().for_each(|face| face.triangles(&mut triangles));
            // outward triangles enclose the volume, which tetrahedra fill
            let enclosed: f64 = triangles.chunks(3).map(|at| volume(at, [0.0; 3])).sum();
            let filled: f64 =
                inside(&data, &[0], 1)[0].iter().map(|at| volume(&at[1..], points[at[0] as usize]).abs()).sum();
            assert!(enclosed > 0.1 && (enclosed - filled).abs() < 1e-12, "{shape:?}: {enclosed} and {filled}");
        }
    }
}
