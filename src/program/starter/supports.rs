//! Where a body is held: as the file says, or as the names of its groups do.

use zelus_core::diagnostics::Diagnostic;
use zelus_core::geometry::mapping;
use zelus_core::vector3::{add, norm, scale};
use zelus_meshes::conditions::Support;
use zelus_meshes::history::History;
use zelus_meshes::mesh::{Group, Mesh};

/// Words in the names of groups that are held in all directions.
const HELD: [&str; 9] = ["fix", "clamp", "support", "encastre", "bottom", "base", "ground", "held", "einspann"];

/// The supports of a file; where it has neither these nor steps, those that names suggest: symmetry holds along the normal of a plane.
/// Supports of nodes that no element has are reported.
pub(super) fn of(mesh: &Mesh, said: &mut Vec<Diagnostic>) -> Vec<Support> {
    if !mesh.supports.is_empty() || !mesh.steps.is_empty() {
        let is_reference = |name: &str| mesh.couplings.iter().any(|coupling| coupling.reference == name);
        let (kept, lost): (Vec<Support>, Vec<Support>) = mesh
            .supports
            .iter()
            .cloned()
            .partition(|support| is_reference(&support.group) || mesh.group(&support.group).is_some());
        let report = |support: &Support| {
            let fact = format!("{} is held, but no element has its nodes: this support is left out", support.group);
            Diagnostic::warning("not-taken-over", fact)
        };
        said.extend(lost.iter().map(report));
        return kept.into_iter().map(along_space).collect();
    }
    let dimension = mesh.dimension();
    let is_body = |group: &&Group| group.cells.iter().any(|&cell| mesh.cells.shapes[cell as usize].dim() == dimension);
    let suggested = |group: &Group| {
        let name = group.name.to_lowercase();
        let values = if name.contains("sym") {
            let direction = normal(mesh, group)?;
            [0, 1, 2].map(|at| (at == direction).then(History::default))
        } else if HELD.iter().any(|word| name.contains(word)) {
            [0; 3].map(|_| Some(History::default()))
        } else {
            return None;
        };
        Some(Support::of(group.name.clone(), values))
    };
    mesh.groups.iter().filter(|group| !is_body(group)).filter_map(suggested).collect()
}

/// The same support along the axes of the space, where its own do not matter: nodes on the axis of a cylinder have no radial direction.
fn along_space(support: Support) -> Support {
    let is_zero = |value: &Option<History>| value.as_ref().and_then(History::as_constant) == Some(0.0);
    let is_fixed = support.values.iter().all(is_zero);
    Support { axes: support.axes.filter(|_| !is_fixed), ..support }
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
