//! MED files, as SALOME and Gmsh write them: HDF5 with the nodes, cells and families of one mesh.
//!
//! A family is a set of cells or nodes with the names of all groups it belongs to; its groups become those of the mesh. Source:
//! documentation of MED fichier 4, "Modèle de données".

use std::collections::BTreeMap;
use std::path::Path;

use hdf5_pure::{AttrValue, Dataset, File, Group};
use zelus_core::diagnostics::{Diagnostic, Place, Result};
use zelus_core::geometry::Shape;
use zelus_core::io::MeshFormatEntry;
use zelus_core::io::mdpa::MdpaDocument;
use zelus_core::parameters::Settings;
use zelus_core::register;

use super::document::finish;
use super::mesh::{Mesh, word};

/// Letters of a group's name.
const NAME: usize = 80;

/// Types of cells; for each node of the shape the place at which MED writes it.
const TYPES: [(&str, Shape, &[usize]); 14] = [
    ("PO1", Shape::Point1, &[0]),
    ("SE2", Shape::Line2, &[0, 1]),
    ("SE3", Shape::Line3, &[0, 1, 2]),
    ("TR3", Shape::Tri3, &[0, 1, 2]),
    ("TR6", Shape::Tri6, &[0, 1, 2, 3, 4, 5]),
    ("QU4", Shape::Quad4, &[0, 1, 2, 3]),
    ("QU8", Shape::Quad8, &[0, 1, 2, 3, 4, 5, 6, 7]),
    ("QU9", Shape::Quad9, &[0, 1, 2, 3, 4, 5, 6, 7, 8]),
    ("TE4", Shape::Tet4, &[0, 2, 1, 3]),
    ("T10", Shape::Tet10, &[0, 2, 1, 3, 6, 5, 4, 7, 9, 8]),
    ("PE6", Shape::Prism6, &[0, 2, 1, 3, 5, 4]),
    ("P15", Shape::Prism15, &[0, 2, 1, 3, 5, 4, 8, 7, 6, 12, 14, 13, 11, 10, 9]),
    ("HE8", Shape::Hex8, &[0, 3, 2, 1, 4, 7, 6, 5]),
    ("H20", Shape::Hex20, &[0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 16, 19, 18, 17, 15, 14, 13, 12]),
];

/// Names of groups by number of the family.
type Families = BTreeMap<i64, Vec<String>>;

/// Reads the mesh of a file.
///
/// # Errors
/// A file that is damaged, has no mesh or several, or cells that no element has.
pub(crate) fn read_mesh(path: &Path) -> Result<Mesh> {
    read_from(path).map_err(|fact| Diagnostic::error("mesh-syntax", fact).at(Place::file(path)).into())
}

fn read_from(path: &Path) -> std::result::Result<Mesh, String> {
    let said = |why: hdf5_pure::Error| why.to_string();
    let file = File::open(path).map_err(said)?;
    let names = file.group("ENS_MAA").and_then(|all| all.groups()).map_err(|_| "it holds no mesh of MED".to_owned())?;
    let [name] = names.as_slice() else {
        return Err(format!("it holds {} meshes, and one is read: {}", names.len(), names.join(", ")));
    };
    let whole = file.group(&format!("ENS_MAA/{name}")).map_err(said)?;
    let steps = whole.groups().map_err(said)?;
    let step = steps.first().ok_or("its mesh is empty")?;
    let mesh = whole.group(step).map_err(said)?;
    let space =
        number(&whole, "ESP").filter(|space| (1..=3).contains(space)).ok_or("its mesh has no dimension")? as usize;

    let mut out = Mesh::default();
    let coordinates = dataset(&mesh, "NOE/COO")?.read_f64().map_err(said)?;
    let count = coordinates.len() / space;
    out.points = (0..count)
        .map(|node| std::array::from_fn(|a| if a < space { coordinates[a * count + node] } else { 0.0 }))
        .collect();
    out.node_ids = ids(&mesh, "NOE/NUM", count);
    let families = |kind: &str| families(&file, &format!("FAS/{name}/{kind}"));
    let (of_nodes, of_cells) = (families("NOEUD"), families("ELEME"));
    let numbers = |path: &str| dataset(&mesh, path).and_then(|own| own.read_i64().map_err(said)).unwrap_or_default();
    for (node, family) in numbers("NOE/FAM").into_iter().enumerate().take(count) {
        for group in of_nodes.get(&family).into_iter().flatten() {
            out.group_mut(&word(group)).nodes.push(node as u32);
        }
    }
    let mut kinds = mesh.group("MAI").and_then(|all| all.groups()).map_err(said)?;
    kinds.sort();
    for kind in &kinds {
        let found = TYPES.iter().find(|(own, ..)| own == kind);
        let (_, shape, order) = found.ok_or_else(|| format!("cells of type {kind} are not known"))?;
        let nodes = dataset(&mesh, &format!("MAI/{kind}/NOD"))?.read_i64().map_err(said)?;
        let cells = nodes.len() / shape.nodes();
        let of_family = numbers(&format!("MAI/{kind}/FAM"));
        for cell in 0..cells {
            let node = |place: &usize| -> std::result::Result<u32, String> {
                let node = usize::try_from(nodes[place * cells + cell] - 1).ok().filter(|node| *node < count);
                node.map(|node| node as u32).ok_or_else(|| format!("a cell {kind} has a node that is not there"))
            };
            let own = order.iter().map(node).collect::<std::result::Result<Vec<_>, _>>()?;
            let at = out.cells.push(out.cells.len() as u32 + 1, *shape, own);
            for group in of_family.get(cell).and_then(|family| of_cells.get(family)).into_iter().flatten() {
                out.group_mut(&word(group)).cells.push(at);
            }
        }
    }
    Ok(out)
}

fn dataset(group: &Group, path: &str) -> std::result::Result<Dataset, String> {
    group.dataset(path).map_err(|_| format!("it has no {path}"))
}

fn number(group: &Group, name: &str) -> Option<i64> {
    group.attrs().ok()?.get(name).and_then(AttrValue::as_i64)
}

/// Ids of nodes; numbers from 1 where the file gives none that serve.
fn ids(mesh: &Group, path: &str, count: usize) -> Vec<u32> {
    let given = dataset(mesh, path).ok().and_then(|own| own.read_i64().ok()).unwrap_or_default();
    let own: Vec<u32> = given.iter().filter_map(|&id| u32::try_from(id).ok().filter(|&id| id > 0)).collect();
    let mut sorted = own.clone();
    sorted.sort_unstable();
    sorted.dedup();
    if sorted.len() == count { own } else { (1..=count as u32).collect() }
}

fn families(file: &File, path: &str) -> Families {
    let mut out = Families::new();
    let Ok(all) = file.group(path) else { return out };
    for name in all.groups().unwrap_or_default() {
        let Ok(family) = all.group(&name) else { continue };
        let Some(number) = number(&family, "NUM") else { continue };
        let letters = family.dataset("GRO/NOM").and_then(|own| own.read_raw()).unwrap_or_default();
        let groups = letters.chunks(NAME).map(|name| {
            let end = name.iter().position(|&letter| letter == 0).unwrap_or(name.len());
            String::from_utf8_lossy(&name[..end]).trim().to_owned()
        });
        out.insert(number, groups.filter(|name| !name.is_empty()).collect());
    }
    out
}

fn build(path: &Path, settings: &Settings) -> Result<(MdpaDocument, Vec<Diagnostic>)> {
    finish(read_mesh(path)?, settings, path)
}

register! { MeshFormatEntry "med",
    about: "meshes of SALOME (MED 3 and 4), as Gmsh writes them too; groups become sub model parts",
    source: "documentation of MED fichier 4",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/mesh_formats/med.json")),
    build: build,
    endings: &["med"],
    write: None,
}
