//! Types of elements, their order of nodes and their faces.

use zelus_core::geometry::Shape;

use crate::mesh::Plane;

/// Types: how they begin, their dimension, and the assumption of a planar one.
const TYPES: [(&str, usize, Option<Plane>); 22] = [
    ("C3D", 3, None),
    ("DC3D", 3, None),
    ("AC3D", 3, None),
    ("CPS", 2, Some(Plane::Stress)),
    ("CPE", 2, Some(Plane::Strain)),
    ("CAX", 2, Some(Plane::Axial)),
    ("CGAX", 2, Some(Plane::Axial)),
    ("DC2D", 2, None),
    ("DCAX", 2, Some(Plane::Axial)),
    ("SFM3D", 2, None),
    ("M3D", 2, None),
    ("R3D", 2, None),
    ("DS", 2, None),
    ("STRI", 2, None),
    ("S", 2, None),
    ("T3D", 1, None),
    ("T2D", 1, None),
    ("R2D", 1, None),
    ("RAX", 1, Some(Plane::Axial)),
    ("B3", 1, None),
    ("B2", 1, None),
    ("D1D", 1, None),
];

/// Shape of a type of elements, and its assumption in the plane.
pub(super) fn of(name: &str) -> Option<(Shape, Option<Plane>)> {
    let name = name.to_ascii_uppercase();
    let (start, dimension, plane) = TYPES.iter().find(|(start, ..)| {
        name.strip_prefix(start).is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
    })?;
    let rest = &name[start.len()..];
    let digits = &rest[..rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len())];
    let nodes = match (*start, digits) {
        // beams: 1 linear, 2 quadratic, 3 cubic of two nodes
        ("B2" | "B3", _) => {
            if digits.ends_with('2') {
                3
            } else {
                2
            }
        }
        _ => digits.parse().ok()?,
    };
    Some((Shape::of(*dimension, nodes)?, *plane))
}

/// Whether elements of that type have stiffness that no solid has: they come in as cells only.
pub(super) fn is_structural(name: &str) -> bool {
    let name = name.to_ascii_uppercase();
    let digit = |rest: &str| rest.starts_with(|c: char| c.is_ascii_digit());
    ["S", "STRI", "M3D", "B"].iter().any(|start| name.strip_prefix(start).is_some_and(digit))
}

/// Features of elements of that type that the imported ones lack, with the remedy.
pub(super) fn left_out(name: &str, shape: Shape) -> Option<(&'static str, &'static str)> {
    let name = name.to_ascii_uppercase();
    let letters = &name[name.rfind(|c: char| c.is_ascii_digit()).map_or(0, |last| last + 1)..];
    let is_block = matches!(shape, Shape::Quad4 | Shape::Hex8);
    if letters.contains('H') {
        return Some((
            "a pressure of their own",
            "take SmallDisplacementMixedVolumetricStrainElement as \"element_name\" for nearly incompressible materials",
        ));
    }
    if is_block && letters.contains('I') {
        return Some((
            "incompatible modes: bent, they are stiffer here",
            "mesh parts under bending with elements of second order, or finer",
        ));
    }
    (is_block && letters.contains('R')).then_some((
        "one integration point: integrated in full, they are stiffer here",
        "mesh parts under bending with elements of second order, or finer",
    ))
}

/// The name under which a shape is written.
pub(super) fn name(shape: Shape, plane: Option<Plane>) -> Option<String> {
    let nodes = shape.nodes();
    let start = match (shape.dim(), plane) {
        (3, _) if shape != Shape::Hex27 => "C3D",
        (2, _) if shape == Shape::Quad9 => return None,
        (2, Some(Plane::Strain)) => "CPE",
        (2, Some(Plane::Axial)) => "CAX",
        (2, _) => "CPS",
        (1, _) => "T3D",
        _ => return None,
    };
    Some(format!("{start}{nodes}"))
}

/// For each place at which a file writes a node, the node of the shape; as VTK has it.
pub(super) fn order(shape: Shape) -> &'static [usize] {
    shape.cell().vtk_order
}

/// Corners of the faces S1, S2, … by the places of the file, from 0.
pub(super) fn faces(shape: Shape) -> &'static [&'static [usize]] {
    match shape.linear() {
        Shape::Tri3 => &[&[0, 1], &[1, 2], &[2, 0]],
        Shape::Quad4 => &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
        Shape::Tet4 => &[&[0, 1, 2], &[0, 3, 1], &[1, 3, 2], &[2, 3, 0]],
        Shape::Prism6 => &[&[0, 1, 2], &[3, 5, 4], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]],
        Shape::Hex8 => &[&[0, 1, 2, 3], &[4, 7, 6, 5], &[0, 4, 5, 1], &[1, 5, 6, 2], &[2, 6, 7, 3], &[3, 7, 4, 0]],
        _ => &[],
    }
}

/// The number of the face of a reference cell that the file calls S`number`.
pub(super) fn face(shape: Shape, number: usize) -> Option<usize> {
    let wanted = faces(shape).get(number.checked_sub(1)?)?;
    let cell = shape.cell();
    cell.faces.iter().position(|face| {
        let corners = &face.nodes[..face.shape.cell().corners()];
        corners.len() == wanted.len() && corners.iter().all(|node| wanted.contains(node))
    })
}
