//! Outer surface of a picture, as numbers of a page.

use std::collections::HashMap;

use serde_json::{Value, json};
use zelus_core::Result;
use zelus_core::io::results::{Column, Dataset};

use super::results::Series;

/// Most numbers of all steps of a series in a page; beyond, steps are left out evenly.
const MOST_NUMBERS: usize = 8_000_000;

/// The corners of the faces that only one cell has; of surfaces all, and of lines none.
fn faces(data: &Dataset) -> Vec<Vec<u32>> {
    let mut found: HashMap<Vec<u32>, (Vec<u32>, usize)> = HashMap::new();
    let mut order = Vec::new();
    for (shape, points) in data.cells.iter() {
        let cell = shape.cell();
        let sides: Vec<Vec<u32>> = match cell.dim {
            2 => vec![points[..cell.edges.len()].to_vec()],
            3 => cell.faces.iter().map(|face| corners(face.shape.cell().edges.len(), face.nodes, points)).collect(),
            _ => Vec::new(),
        };
        for side in sides {
            let mut key = side.clone();
            key.sort_unstable();
            if cell.dim == 2 {
                // Cells that lie upon each other are all seen.
                key.push(order.len() as u32);
            }
            let entry = found.entry(key.clone()).or_insert_with(|| {
                order.push(key);
                (side, 0)
            });
            entry.1 += 1;
        }
    }
    let single = |key: Vec<u32>| found.remove(&key).filter(|(_, count)| *count == 1).map(|(side, _)| side);
    order.into_iter().filter_map(single).collect()
}

fn corners(count: usize, nodes: &[usize], points: &[u32]) -> Vec<u32> {
    nodes[..count].iter().map(|&node| points[node]).collect()
}

/// The skin of a series with its fields at all steps, arrays in base64; nothing where nothing is seen.
///
/// # Errors
/// Pictures that cannot be read.
pub(super) fn view(name: &str, series: &Series) -> Result<Option<Value>> {
    let Some(first) = series.first() else { return Ok(None) };
    let first = first.read()?;
    let faces = faces(&first);
    if faces.is_empty() {
        return Ok(None);
    }
    let mut place = vec![u32::MAX; first.points.len()];
    let mut seen: Vec<usize> = faces.iter().flatten().map(|&point| point as usize).collect();
    seen.sort_unstable();
    seen.dedup();
    seen.iter().enumerate().for_each(|(at, &point)| place[point] = at as u32);
    let at = |point: u32| place[point as usize];
    let triangles = faces.iter().flat_map(|face| (2..face.len()).flat_map(|k| [face[0], face[k - 1], face[k]])).map(at);
    let mut edges: Vec<[u32; 2]> = Vec::new();
    for face in &faces {
        let pairs = face.iter().zip(face.iter().cycle().skip(1));
        edges.extend(pairs.map(|(&a, &b)| [at(a).min(at(b)), at(a).max(at(b))]));
    }
    edges.sort_unstable();
    edges.dedup();
    let a_step: usize = first.point_data.iter().map(|column| column.components * seen.len()).sum();
    let every = (a_step * series.len()).div_ceil(MOST_NUMBERS).max(1);
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
        let displacement: Vec<f64> = match given {
            _ if moved => {
                seen.iter().flat_map(|&at| [0, 1, 2].map(|c| data.points[at][c] - first.points[at][c])).collect()
            }
            Some(column) => of_points(column, &seen),
            None => vec![0.0; 3 * seen.len()],
        };
        let fields = data.point_data.iter().filter(|column| !column.name.starts_with("KRATOS_"));
        let fields: Vec<Value> =
            fields.map(|column| json!([column.name, column.components, floats(&of_points(column, &seen))])).collect();
        steps.push(json!({ "time": frame.time, "displacement": floats(&displacement), "fields": fields }));
    }
    let points: Vec<f64> = seen.iter().flat_map(|&point| first.points[point]).collect();
    Ok(Some(json!({
        "name": name,
        "points": floats(&points),
        "triangles": whole(triangles),
        "edges": whole(edges.into_iter().flatten()),
        "steps": steps,
    })))
}

fn of_points(column: &Column, points: &[usize]) -> Vec<f64> {
    let of = |&point: &usize| (0..column.components).map(move |c| column.values.get(point * column.components + c));
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

    #[test]
    fn faces_between_cells_are_not_seen() {
        let mut data = Dataset::default();
        data.cells.push(1, 0, Shape::Hex8, 0..8);
        data.cells.push(2, 0, Shape::Hex8, [4, 5, 6, 7, 8, 9, 10, 11]);
        assert_eq!(faces(&data).len(), 10);
        data.cells.push(3, 0, Shape::Quad9, 0..9);
        data.cells.push(4, 0, Shape::Tri3, [0, 1, 2]);
        data.cells.push(5, 0, Shape::Line2, [0, 1]);
        let all = faces(&data);
        assert_eq!((all.len(), &all[10][..], &all[11][..]), (12, &[0, 1, 2, 3][..], &[0, 1, 2][..]));
    }
}
