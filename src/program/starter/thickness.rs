//! Thickness of planar bodies at loaded faces.

use std::collections::BTreeSet;

use zelus_meshes::faces::{corners, faces};
use zelus_meshes::mesh::{Mesh, Plane};

/// Thickness of the bodies to which the faces of a group belong: that of the first section which has one; 1 in space and of bodies of
/// revolution.
pub(super) fn of(mesh: &Mesh, group: &str, space: usize) -> f64 {
    let is_flat = space == 2 && mesh.plane != Some(Plane::Axial);
    if !is_flat || mesh.sections.iter().all(|section| section.thickness == 1.0) {
        return 1.0;
    }
    let owners = faces(mesh);
    let cells = mesh.group(group).map(|group| group.cells.as_slice()).unwrap_or_default();
    let owner = |&cell: &u32| owners.get(&corners(mesh.cells.shapes[cell as usize], mesh.cells.nodes(cell as usize)));
    let elements: BTreeSet<u32> = cells.iter().filter_map(owner).map(|face| face.element).collect();
    let holds =
        |name: &str| mesh.group(name).is_some_and(|group| group.cells.iter().any(|cell| elements.contains(cell)));
    mesh.sections.iter().rfind(|section| holds(&section.group)).map_or(1.0, |section| section.thickness)
}
