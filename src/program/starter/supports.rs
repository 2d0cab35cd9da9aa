//! Where a body is held: as the file says, or as the names of its groups do.

use zelus_core::geometry::mapping;
use zelus_core::vector3::{add, norm, scale};
use zelus_meshes::mesh::{Group, Mesh, Support};

/// Words in the names of groups that are held in all directions.
const HELD: [&str; 9] = ["fix", "clamp", "support", "encastre", "bottom", "base", "ground", "held", "einspann"];

/// The supports of a file; where it has none, those that names suggest: symmetry holds along the normal of a plane.
pub(super) fn of(mesh: &Mesh) -> Vec<Support> {
    if !mesh.supports.is_empty() {
        return mesh.supports.clone();
    }
    let dimension = mesh.dimension();
    let is_body = |group: &&Group| group.cells.iter().any(|&cell| mesh.cells.shapes[cell as usize].dim() == dimension);
    let suggested = |group: &Group| {
        let name = group.name.to_lowercase();
        let values = if name.contains("sym") {
            let direction = normal(mesh, group)?;
            [0, 1, 2].map(|at| (at == direction).then_some(0.0))
        } else if HELD.iter().any(|word| name.contains(word)) {
            [Some(0.0); 3]
        } else {
            return None;
        };
        Some(Support { group: group.name.clone(), values })
    };
    mesh.groups.iter().filter(|group| !is_body(group)).filter_map(suggested).collect()
}

/// The axis that the plane of a group is normal to.
fn normal(mesh: &Mesh, group: &Group) -> Option<usize> {
    let areas = group.cells.iter().map(|&cell| {
        let cell = cell as usize;
        mapping::vector_area(mesh.cells.shapes[cell], &mesh.points_of(cell))
    });
    let (sum, size) = areas.fold(([0.0; 3], 0.0), |(sum, size), area| (add(sum, area), size + norm(area)));
    let mean = scale(sum, 1.0 / size);
    (0..3).find(|&at| mean[at].abs() > 1.0 - 1e-6)
}
