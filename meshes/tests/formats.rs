//! Files that Gmsh has written, read in every form, and written back.

use std::path::{Path, PathBuf};

use zelus_core::diagnostics::Result;
use zelus_core::geometry::mapping;
use zelus_core::io::mdpa::MdpaDocument;
use zelus_core::io::{MeshFormatEntry, format_of};
use zelus_core::parameters::{Node, Object, Value};
use zelus_core::registry;
use zelus_core::vector3::{cross, dot, norm, sub};
use zelus_meshes::Mesh;
use zelus_meshes::document;
use zelus_structural_mechanics as _;

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

fn read(path: &Path) -> Result<MdpaDocument> {
    let format = format_of(path).expect("a known ending");
    let nothing = Node::new(Value::Object(Object::default()), &zelus_core::diagnostics::Place::file("test"));
    Ok((format.build)(path, &format.settings(&nothing)?)?.0)
}

fn mesh(path: &Path) -> Mesh {
    document::mesh(&read(path).unwrap()).unwrap()
}

/// Length, area or volume of the cells of a group with that dimension.
fn size(mesh: &Mesh, group: &str, dimension: usize) -> f64 {
    let cells = &mesh.group(group).unwrap_or_else(|| panic!("no group {group}")).cells;
    let own = cells.iter().map(|&cell| cell as usize).filter(|&cell| mesh.cells.shapes[cell].dim() == dimension);
    own.map(|cell| mapping::domain_size(mesh.cells.shapes[cell], &mesh.points_of(cell))).sum()
}

/// Every node of a cell with straight edges is where its corners say.
fn nodes_are_in_order(mesh: &Mesh) {
    for cell in 0..mesh.cells.len() {
        let (shape, points) = (mesh.cells.shapes[cell], mesh.points_of(cell));
        let linear = shape.linear();
        for (point, xi) in points.iter().zip(shape.cell().points) {
            let wanted = mapping::position(linear, &points[..linear.nodes()], *xi);
            assert!((0..3).all(|i| (point[i] - wanted[i]).abs() < 1e-9), "{shape:?}: {point:?} is not {wanted:?}");
        }
        assert!(!mapping::is_inverted(shape, mesh.dimension(), &points), "{shape:?}");
    }
}

fn has_three_cubes(mesh: &Mesh) {
    nodes_are_in_order(mesh);
    for (group, dimension) in [("Tets", 3), ("Hexes", 3), ("Prisms", 3), ("Bottom", 2), ("Top", 2)] {
        let found = size(mesh, group, dimension);
        assert!((found - 1.0).abs() < 1e-9, "{group}: {found}");
    }
    let bottom = mesh.group("Bottom").unwrap();
    for &cell in &bottom.cells {
        let normal = mapping::vector_area(mesh.cells.shapes[cell as usize], &mesh.points_of(cell as usize));
        assert!(normal[2] < 0.0, "the normal of Bottom is {normal:?}");
    }
}

#[test]
fn every_form_of_gmsh_gives_the_same_mesh() {
    for order in ["1", "2"] {
        for form in ["22", "22b", "41", "41b"] {
            let mesh = mesh(&data(&format!("solids_{order}_{form}.msh")));
            has_three_cubes(&mesh);
            assert_eq!(mesh.group("Corner").unwrap().nodes.len(), 1, "{order} {form}");
        }
    }
}

#[test]
fn med_files_give_the_same_mesh() {
    for order in ["1", "2"] {
        let mesh = mesh(&data(&format!("solids_{order}.med")));
        has_three_cubes(&mesh);
        assert_eq!(mesh.group("Corner").unwrap().nodes.len(), 1, "{order}");
    }
}

#[test]
fn damaged_med_files_are_refused() {
    let whole = std::fs::read(data("solids_1.med")).unwrap();
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("part.med");
    for length in (0..whole.len()).step_by(1999) {
        std::fs::write(&path, &whole[..length]).unwrap();
        assert!(read(&path).is_err(), "{length} bytes");
    }
    // A changed byte may be one of a coordinate; nothing must panic.
    for at in (0..whole.len()).step_by(97) {
        let mut bytes = whole.clone();
        bytes[at] ^= 0xff;
        std::fs::write(&path, bytes).unwrap();
        let _ = read(&path);
    }
}

#[test]
fn gmsh_s_abaqus_files_give_the_same_mesh() {
    for order in ["1", "2"] {
        has_three_cubes(&mesh(&data(&format!("solids_{order}.inp"))));
    }
}

#[test]
fn without_physical_groups_entities_are_parts() {
    let mesh = mesh(&data("disc_41.msh"));
    assert!((size(&mesh, "Surface_1", 2) - std::f64::consts::PI).abs() < 0.02);
    assert!((size(&mesh, "Surface_2", 2) - 1.0).abs() < 1e-9);
    assert!(mesh.group("Curve_1").is_some());
}

#[test]
fn what_is_written_reads_back() {
    let folder = tempfile::tempdir().unwrap();
    for order in ["1", "2"] {
        let document = read(&data(&format!("solids_{order}_41.msh"))).unwrap();
        for format in registry::all::<MeshFormatEntry>() {
            let Some(write) = format.write.filter(|_| format.name != "mdpa") else { continue };
            let path = folder.path().join(format!("again.{}", format.endings[0]));
            write(&document, &path).unwrap();
            let mesh = mesh(&path);
            has_three_cubes(&mesh);
            assert_eq!(mesh.group("Corner").unwrap().nodes.len(), 1, "{}", format.name);
        }
    }
}

#[test]
fn damaged_files_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["solids_1_22.msh", "solids_1_22b.msh", "solids_1_41.msh", "solids_1_41b.msh", "solids_1.inp"] {
        let whole = std::fs::read(data(name)).unwrap();
        for share in 1..20 {
            let path = folder.path().join(name);
            std::fs::write(&path, &whole[..whole.len() * share / 20]).unwrap();
            // a truncated file may still be a mesh; it must never cause a panic
            if let Err(error) = read(&path) {
                assert!(!error.to_string().is_empty());
            }
        }
        std::fs::write(folder.path().join(name), b"nothing of the kind").unwrap();
        assert!(read(&folder.path().join(name)).is_err(), "{name}");
    }
}

/// Triangles of a file of bytes.
fn triangles_of(path: &Path) -> Vec<[[f64; 3]; 3]> {
    let bytes = std::fs::read(path).unwrap();
    let number = |at: usize| f64::from(f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()));
    let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
    assert_eq!(bytes.len(), 84 + 50 * count);
    let corner = |triangle: usize, k: usize| std::array::from_fn(|c| number(84 + 50 * triangle + 12 * (k + 1) + 4 * c));
    (0..count).map(|triangle| std::array::from_fn(|k| corner(triangle, k))).collect()
}

/// ANALYTIC: the surface of three unit cubes encloses their volume (Σ a · (b × c)/6, positive where triangles point outwards), that of a
/// part its own; each edge belongs to two triangles, in both directions. A part of faces alone is as large as they are. Single precision.
#[test]
fn surfaces_are_written_as_stl() {
    let scratch = tempfile::tempdir().unwrap();
    let to = scratch.path().join("surface.stl");
    for name in ["solids_1_41.msh", "solids_2_41b.msh"] {
        let document = read(&data(name)).unwrap();
        let whole = size(&mesh(&data(name)), "Hexes", 3) * 3.0;
        for (part, volume) in [(None, whole), (Some("Hexes"), 1.0), (Some("Prisms"), 1.0)] {
            let count = zelus_meshes::write_stl(&document, part, &to).unwrap();
            let triangles = triangles_of(&to);
            assert_eq!(triangles.len(), count);
            let found: f64 = triangles.iter().map(|[a, b, c]| dot(*a, cross(*b, *c)) / 6.0).sum();
            assert!((found - volume).abs() < 1e-6, "{name} {part:?}: {found}");
            let bits = |x: [f64; 3]| x.map(|c| (c + 0.0).to_bits());
            let mut edges = std::collections::BTreeMap::new();
            for own in &triangles {
                for k in 0..3 {
                    *edges.entry([bits(own[k]), bits(own[(k + 1) % 3])]).or_insert(0) += 1;
                }
            }
            let is_closed = edges.iter().all(|([a, b], count)| *count == 1 && edges.get(&[*b, *a]) == Some(&1));
            assert!(part.is_none() || is_closed, "{name} {part:?}");
        }
        zelus_meshes::write_stl(&document, Some("Top"), &to).unwrap();
        let area: f64 = triangles_of(&to).iter().map(|[a, b, c]| 0.5 * norm(cross(sub(*b, *a), sub(*c, *a)))).sum();
        assert!((area - 1.0).abs() < 1e-6, "{name}: {area}");
        let said = zelus_meshes::write_stl(&document, Some("Hexen"), &to).unwrap_err().to_string();
        assert!(said.contains("no part Hexen") && said.contains("Hexes"), "{said}");
    }
    let said = zelus_meshes::write_stl(&read(&data("disc_41.msh")).unwrap(), None, &to).unwrap_err().to_string();
    assert!(said.contains("surfaces in space"), "{said}");
}
