//! STL files: triangles with normals, as text or as bytes.
//!
//! Text: `solid name`, then for each triangle `facet normal …`, `outer loop`, three lines `vertex x y z`, `endloop`, `endfacet`. Bytes: 80
//! of a header, a count (u32), then for each triangle a normal and three vertices (f32, little endian) and two bytes. Normals are not
//! read: triangles go round so that they point out of the body.

use std::collections::BTreeMap;
use std::path::Path;

use zelus_core::diagnostics::Diagnostic;

use super::shape_facets::ShapeFacets;

/// Bytes of a header, of the count after it, and of a triangle.
const HEADER: usize = 80;
const COUNT: usize = 4;
const TRIANGLE: usize = 50;

fn wrong(fact: String, remedy: &str) -> Diagnostic {
    Diagnostic::error("stl-file", fact).remedy(remedy.to_owned())
}

/// Reads a file.
///
/// # Errors
/// A file that is not there, or no STL file.
pub(super) fn read(path: &Path) -> Result<ShapeFacets, Diagnostic> {
    let name = path.display();
    let bytes = std::fs::read(path).map_err(|error| {
        wrong(format!("{name} cannot be read: {error}"), "write the name from the folder of the deck")
    })?;
    let triangles = if is_binary(&bytes) {
        of_bytes(&bytes)
    } else {
        of_text(&String::from_utf8_lossy(&bytes), &name.to_string())?
    };
    if triangles.is_empty() {
        return Err(wrong(format!("{name} has no triangles"), "export the surface again, as STL"));
    }
    if let Some(at) = triangles.iter().position(|own| own.as_flattened().iter().any(|x| !x.is_finite())) {
        return Err(wrong(
            format!("triangle {} of {name} has a coordinate that is no number", at + 1),
            "export it again",
        ));
    }
    Ok(joined(&triangles))
}

/// Whether the length of a file is that of the triangles that its header counts.
fn is_binary(bytes: &[u8]) -> bool {
    let count = bytes.get(HEADER..HEADER + COUNT).and_then(|own| own.try_into().ok()).map(u32::from_le_bytes);
    count.is_some_and(|count| bytes.len() == HEADER + COUNT + TRIANGLE * count as usize)
}

fn of_bytes(bytes: &[u8]) -> Vec<[[f64; 3]; 3]> {
    let number = |at: &[u8]| f64::from(f32::from_le_bytes([at[0], at[1], at[2], at[3]]));
    let triangle = |own: &[u8]| -> [[f64; 3]; 3] {
        std::array::from_fn(|k| std::array::from_fn(|c| number(&own[12 * (k + 1) + 4 * c..])))
    };
    bytes[HEADER + COUNT..].chunks_exact(TRIANGLE).map(triangle).collect()
}

fn of_text(text: &str, name: &str) -> Result<Vec<[[f64; 3]; 3]>, Diagnostic> {
    if !text.trim_start().starts_with("solid") {
        let fact = format!("{name} is no STL file: it starts with neither \"solid\" nor a count of its triangles");
        return Err(wrong(fact, "export the surface as STL, ASCII or binary"));
    }
    let mut points = Vec::new();
    for (line, words) in text.lines().enumerate().map(|(at, line)| (at + 1, line.trim())) {
        let Some(numbers) = words.strip_prefix("vertex") else { continue };
        let found: Vec<f64> = numbers.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let Ok(point) = <[f64; 3]>::try_from(found) else {
            return Err(wrong(format!("line {line} of {name} is no vertex: {words}"), "write vertex x y z"));
        };
        points.push(point);
    }
    if points.len() % 3 != 0 {
        let fact = format!("{name} has {} vertices, which are no whole triangles", points.len());
        return Err(wrong(fact, "give each facet three vertices"));
    }
    Ok(points.as_chunks().0.to_vec())
}

/// Triangles whose equal vertices are one point.
fn joined(triangles: &[[[f64; 3]; 3]]) -> ShapeFacets {
    let mut out = ShapeFacets::default();
    let mut known: BTreeMap<[u64; 3], u32> = BTreeMap::new();
    for corners in triangles {
        // Zeros of both signs are one.
        let points = corners.map(|x| *known.entry(x.map(|c| (c + 0.0).to_bits())).or_insert_with(|| out.point(x)));
        out.triangle(points, None);
    }
    out
}

/// Text of an STL file with these triangles.
#[cfg(test)]
pub(super) fn text(facets: &ShapeFacets, name: &str) -> String {
    use std::fmt::Write;
    use zelus_core::vector3::{cross, normalised, sub};
    let mut out = format!("solid {name}\n");
    for facet in &facets.facets {
        let [a, b, c] = facet.points.map(|at| facets.points[at as usize]);
        let [x, y, z] = normalised(cross(sub(b, a), sub(c, a)));
        let _ = writeln!(out, "facet normal {x} {y} {z}\n outer loop");
        for [x, y, z] in [a, b, c] {
            let _ = writeln!(out, "  vertex {x} {y} {z}");
        }
        out.push_str(" endloop\nendfacet\n");
    }
    let _ = writeln!(out, "endsolid {name}");
    out
}

/// Refuses a surface that does not enclose a body, or has normals that point into it.
///
/// # Errors
/// Edges of one triangle or of several, neighbours that go round oppositely, normals that point inwards.
pub(super) fn check_closed(facets: &ShapeFacets, name: &str) -> Result<(), Diagnostic> {
    let mut edges: BTreeMap<[u32; 2], [usize; 2]> = BTreeMap::new();
    for facet in &facets.facets {
        let [a, b, c] = facet.points;
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let (key, side) = if from < to { ([from, to], 0) } else { ([to, from], 1) };
            edges.entry(key).or_default()[side] += 1;
        }
    }
    let place = |[a, b]: [u32; 2]| {
        let text = |at: u32| {
            let [x, y, z] = facets.points[at as usize];
            format!("({x}, {y}, {z})")
        };
        format!("{} to {}", text(a), text(b))
    };
    let count = |of: &dyn Fn([usize; 2]) -> bool| edges.values().filter(|own| of(**own)).count();
    let first = |of: &dyn Fn([usize; 2]) -> bool| edges.iter().find(|(_, own)| of(**own)).map(|(key, _)| place(*key));
    let open = |[a, b]: [usize; 2]| a + b != 2;
    if let Some(at) = first(&open) {
        let fact = format!(
            "the surface of {name} is not closed: {} edges have not two triangles, the first from {at}",
            count(&open)
        );
        let remedy = "close it in the program that made it, or write \"check_closed\": false for an open surface";
        return Err(wrong(fact, remedy));
    }
    let turned = |[a, b]: [usize; 2]| a != b;
    if let Some(at) = first(&turned) {
        let fact = format!(
            "triangles of {name} are turned inside out beside others: {} edges run the same way in both, the first from {at}",
            count(&turned)
        );
        return Err(wrong(fact, "let all triangles go round anticlockwise, seen from outside"));
    }
    if facets.enclosed() <= 0.0 {
        let fact = format!("the surface of {name} is turned inside out: its normals point into the body");
        let remedy = "turn all triangles round; for a hollow, write \"check_closed\": false";
        return Err(wrong(fact, remedy));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron with unit legs, as triangles that go round outwards.
    fn tetrahedron() -> Vec<[[f64; 3]; 3]> {
        let [o, x, y, z] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        vec![[o, y, x], [o, x, z], [o, z, y], [x, y, z]]
    }

    fn bytes(triangles: &[[[f64; 3]; 3]]) -> Vec<u8> {
        let mut out = vec![0; HEADER];
        out.extend((triangles.len() as u32).to_le_bytes());
        for own in triangles {
            out.extend([0; 12]);
            own.as_flattened().iter().for_each(|x| out.extend((*x as f32).to_le_bytes()));
            out.extend([0; 2]);
        }
        out
    }

    /// ANALYTIC: volume 1/6; the same triangles from text and from bytes.
    #[test]
    fn text_and_bytes_give_the_same_body() {
        let facets = joined(&tetrahedron());
        assert!((facets.enclosed() - 1.0).abs() < 1e-15 && facets.points.len() == 4);
        let written = text(&facets, "body");
        assert_eq!(joined(&of_text(&written, "body").unwrap()), facets);
        let binary = bytes(&tetrahedron());
        assert!(is_binary(&binary) && !is_binary(written.as_bytes()));
        assert_eq!(joined(&of_bytes(&binary)), facets);
        check_closed(&facets, "body").unwrap();
    }

    #[test]
    fn open_and_inverted_surfaces_are_refused() {
        let said = |triangles: &[[[f64; 3]; 3]]| check_closed(&joined(triangles), "body.stl").unwrap_err().to_string();
        let all = tetrahedron();
        assert!(said(&all[1..]).contains("not closed: 3 edges"), "{}", said(&all[1..]));
        let inverted: Vec<_> = all.iter().map(|&[a, b, c]| [a, c, b]).collect();
        assert!(said(&inverted).contains("normals point into the body"));
        let mut one = all.clone();
        one[0].swap(1, 2);
        assert!(said(&one).contains("inside out beside others"));
        let wrong = of_text("nothing", "body.stl").unwrap_err().to_string();
        assert!(wrong.contains("no STL file"), "{wrong}");
        let wrong = of_text("solid s\nvertex 1 2\n", "body.stl").unwrap_err().to_string();
        assert!(wrong.contains("line 2"), "{wrong}");
    }
}
