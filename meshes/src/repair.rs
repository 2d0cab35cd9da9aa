//! Makes a mesh fit for a deck: no node or cell twice or in vain, elements and surfaces turned outward.

use rustc_hash::FxHashMap;
use zelus_core::diagnostics::{Diagnostic, Place, Result};
use zelus_core::geometry::{Shape, mapping};
use zelus_core::vector3::dot;

use super::faces::{Corners, corners, face_nodes, faces};
use super::mesh::Mesh;

/// Mends the mesh of the file at `place` and returns notes of the repairs.
///
/// # Errors
/// A mesh without elements, or of surfaces that do not lie in a plane z = constant: there are no shells.
pub fn repair(mesh: &mut Mesh, place: &Place) -> Result<Vec<Diagnostic>> {
    let mut said = Vec::new();
    let mut note = |count: usize, fact: &str| {
        if count > 0 {
            said.push(Diagnostic::note("mended-mesh", format!("{count} {fact}")).at(place.clone()));
        }
    };
    let dimension = mesh.dimension();
    merge_cells(mesh, dimension);
    if dimension == 0 {
        let problem = Diagnostic::error("empty-mesh", "the mesh has no elements").at(place.clone());
        return Err(problem.remedy("mesh the bodies, and in Gmsh give those to be saved a physical group").into());
    }
    note(drop_nodes(mesh), "nodes that no element and no face has are left out");
    if dimension == 2 && !is_planar(mesh) {
        let fact = "the mesh has surfaces in space and no solid cells, and there are no shells";
        let remedy = "mesh the volumes, or put the plane of a planar model at z = 0";
        return Err(Diagnostic::error("no-shells", fact).at(place.clone()).remedy(remedy).into());
    }
    note(turn_elements(mesh, dimension), "elements were inside out and are turned");
    let (turned, inner) = turn_faces(mesh, dimension);
    note(turned, "faces pointed into their body and are turned");
    note(inner, "faces lie between two elements of one body; contact there needs two sides of separate nodes");
    Ok(said)
}

/// Whether all nodes have the same z, to round-off of the size of the mesh.
pub fn is_planar(mesh: &Mesh) -> bool {
    let first = mesh.points.first().map_or(0.0, |point| point[2]);
    let size = mesh.points.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    mesh.points.iter().all(|point| (point[2] - first).abs() <= 1e-12 * size)
}

/// Keeps of cells with the same corners the first, and of those that are neither elements nor faces the nodes; groups that name another
/// have the kept one.
fn merge_cells(mesh: &mut Mesh, dimension: usize) {
    let mut first: FxHashMap<(usize, Corners), u32> = FxHashMap::default();
    let mut cells = super::mesh::Cells::default();
    let mut place = Vec::with_capacity(mesh.cells.len());
    for cell in 0..mesh.cells.len() {
        let (shape, nodes) = (mesh.cells.shapes[cell], mesh.cells.nodes(cell));
        place.push((shape.dim() + 1 >= dimension).then(|| {
            *first
                .entry((shape.dim(), corners(shape, nodes)))
                .or_insert_with(|| cells.push(mesh.cells.ids[cell], shape, nodes.iter().copied()))
        }));
    }
    let before = std::mem::replace(&mut mesh.cells, cells);
    for group in &mut mesh.groups {
        let lost = group.cells.iter().filter(|&&cell| place[cell as usize].is_none());
        group.nodes.extend(lost.flat_map(|&cell| before.nodes(cell as usize)));
        group.cells = group.cells.iter().filter_map(|&cell| place[cell as usize]).collect();
        for list in [&mut group.cells, &mut group.nodes] {
            list.sort_unstable();
            list.dedup();
        }
    }
}

/// Leaves out the nodes that nothing uses; gives their number.
fn drop_nodes(mesh: &mut Mesh) -> usize {
    let mut used = vec![false; mesh.points.len()];
    let of_cells = (0..mesh.cells.len()).flat_map(|cell| mesh.cells.nodes(cell));
    of_cells.for_each(|&node| used[node as usize] = true);
    let of_equations = mesh.equations.iter().flat_map(|equation| &equation.terms);
    of_equations.for_each(|&(node, ..)| used[node as usize] = true);
    let of_discrete = mesh.discrete.iter().flat_map(|own| &own.nodes);
    of_discrete.for_each(|&node| used[node as usize] = true);
    let count = used.iter().filter(|used| !**used).count();
    if count == 0 {
        return 0;
    }
    let mut place = vec![None; used.len()];
    place.iter_mut().zip(&used).filter(|(_, used)| **used).zip(0..).for_each(|((place, _), at)| *place = Some(at));
    let kept = |at: &usize| used[*at];
    mesh.node_ids = (0..used.len()).filter(kept).map(|at| mesh.node_ids[at]).collect();
    mesh.points = (0..used.len()).filter(kept).map(|at| mesh.points[at]).collect();
    for cell in 0..mesh.cells.len() {
        mesh.cells.nodes_mut(cell).iter_mut().for_each(|node| *node = place[*node as usize].expect("it is used"));
    }
    for (node, ..) in mesh.equations.iter_mut().flat_map(|equation| &mut equation.terms) {
        *node = place[*node as usize].expect("it is used");
    }
    for node in mesh.discrete.iter_mut().flat_map(|own| &mut own.nodes) {
        *node = place[*node as usize].expect("it is used");
    }
    for group in &mut mesh.groups {
        group.nodes = group.nodes.iter().filter_map(|&node| place[node as usize]).collect();
    }
    count
}

/// The node that takes the place of each when a cell is turned inside out.
fn mirrored(shape: Shape) -> Vec<usize> {
    let image = |[a, b, c]: [f64; 3]| if shape.dim() == 1 { [-a, b, c] } else { [b, a, c] };
    let points = shape.cell().points;
    let place = |point: &[f64; 3]| {
        points.iter().position(|other| *other == image(*point)).expect("every reference cell has this symmetry")
    };
    points.iter().map(place).collect()
}

fn turn(mesh: &mut Mesh, cell: usize) {
    let order = mirrored(mesh.cells.shapes[cell]);
    let before = mesh.cells.nodes(cell).to_vec();
    let nodes = mesh.cells.nodes_mut(cell);
    nodes.iter_mut().zip(&order).for_each(|(node, &at)| *node = before[at]);
}

fn turn_elements(mesh: &mut Mesh, dimension: usize) -> usize {
    if dimension == 1 {
        return 0;
    }
    let is_inside_out = |mesh: &Mesh, cell: usize| {
        let shape = mesh.cells.shapes[cell];
        let points = mesh.points_of(cell);
        let corners = &points[..shape.cell().corners()];
        let centre = shape.linear().cell().centre;
        let size = match dimension {
            2 => mapping::area_normal(shape.linear(), corners, centre)[2],
            _ => mapping::signed_det_jacobian(shape.linear(), corners, centre),
        };
        shape.dim() == dimension && size < 0.0
    };
    let wrong: Vec<usize> = (0..mesh.cells.len()).filter(|&cell| is_inside_out(mesh, cell)).collect();
    wrong.iter().for_each(|&cell| turn(mesh, cell));
    wrong.len()
}

/// Turns faces as their elements have them; gives the number of those, and of those between two elements.
fn turn_faces(mesh: &mut Mesh, dimension: usize) -> (usize, usize) {
    let (mut turned, mut inner) = (0, 0);
    let of = faces(mesh);
    for cell in 0..mesh.cells.len() {
        let shape = mesh.cells.shapes[cell];
        let found = of.get(&corners(shape, mesh.cells.nodes(cell))).filter(|_| shape.dim() + 1 == dimension);
        let Some(face) = found else { continue };
        inner += usize::from(face.is_inner);
        let (of_face, nodes) = face_nodes(mesh, face.element as usize, face.number);
        let points: Vec<_> = nodes.iter().map(|&node| mesh.points[node as usize]).collect();
        let area = |shape: Shape, points: &[[f64; 3]]| {
            let linear = shape.linear();
            mapping::area_normal(linear, &points[..linear.nodes()], linear.cell().centre)
        };
        if dot(area(of_face, &points), area(shape, &mesh.points_of(cell))) < 0.0 {
            turn(mesh, cell);
            turned += 1;
        }
    }
    (turned, inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cell of this shape where its reference cell is, inside out, with each of its faces inward.
    fn inside_out(shape: Shape) -> Mesh {
        let cell = shape.cell();
        let mut mesh = Mesh {
            node_ids: (1..=cell.points.len() as u32).collect(),
            points: cell.points.to_vec(),
            ..Mesh::default()
        };
        let all: Vec<u32> = (0..cell.points.len() as u32).collect();
        mesh.cells.push(1, shape, all.clone());
        for (at, face) in cell.faces.iter().enumerate() {
            mesh.cells.push(2 + at as u32, face.shape, face.nodes.iter().map(|&node| node as u32));
        }
        (0..mesh.cells.len()).for_each(|cell| turn(&mut mesh, cell));
        mesh
    }

    #[test]
    fn every_shape_is_turned_outward_with_its_faces() {
        for shape in Shape::ALL.into_iter().filter(|shape| shape.dim() > 1) {
            let mut mesh = inside_out(shape);
            let said = repair(&mut mesh, &Place::file("x")).unwrap();
            assert_eq!(said.len(), 2, "{shape:?}: {said:?}");
            let space = shape.dim();
            assert!(!mapping::is_inverted(shape, space, &mesh.points_of(0)), "{shape:?}");
            for (at, face) in (1..mesh.cells.len()).zip(shape.cell().faces) {
                let points = mesh.points_of(at);
                let centre = mapping::centre(face.shape, &points);
                let normal = mapping::area_normal(face.shape, &points, face.shape.cell().centre);
                let outward = zelus_core::vector3::sub(centre, mapping::centre(shape, &mesh.points_of(0)));
                assert!(dot(normal, outward) > 0.0, "{shape:?} face {at}");
            }
        }
    }

    #[test]
    fn cells_that_are_listed_twice_and_nodes_in_vain_go() {
        let mut mesh = inside_out(Shape::Quad4);
        mesh.node_ids.insert(0, 77);
        mesh.points.insert(0, [9.0; 3]);
        for cell in 0..mesh.cells.len() {
            mesh.cells.nodes_mut(cell).iter_mut().for_each(|node| *node += 1);
        }
        let again = mesh.cells.nodes(0).to_vec();
        let copy = mesh.cells.push(50, Shape::Quad4, again);
        mesh.group_mut("Body").cells.push(copy);
        repair(&mut mesh, &Place::file("x")).unwrap();
        assert_eq!((mesh.node_ids.as_slice(), mesh.cells.len()), (&[1, 2, 3, 4][..], 5));
        assert_eq!(mesh.groups[0].cells, [0]);
    }

    #[test]
    fn surfaces_in_space_are_no_mesh_of_elements() {
        let mut mesh = inside_out(Shape::Tri3);
        mesh.points[0][2] = 1.0;
        let error = repair(&mut mesh, &Place::file("x")).unwrap_err().to_string();
        assert!(error.contains("no shells"), "{error}");
    }
}
