//! Slave and master of a contact pair that `zelus new` has found.

use zelus_core::diagnostics::Diagnostic;
use zelus_core::vector3::{cross, norm, sub};
use zelus_core::{Error, Result};
use zelus_meshes::mesh::{Material, Mesh};

use super::materials::STEEL;

/// Ratio of Young's moduli from which on the softer side is the slave, and ratio of face sizes from which on the finer one is.
const SOFTER: f64 = 2.0;
const FINER: f64 = 1.5;

/// A side of a pair.
#[derive(Debug, Clone, Copy)]
struct Side {
    young: f64,
    /// Mean length of a face.
    size: f64,
    area: f64,
    is_one_body: bool,
}

/// Orders the pairs that were found: the softer side is the slave, of like materials the finer, of like meshes the smaller in area, so
/// that meshes of one geometry have the same order. A pair keeps its order where a surface is in several pairs or of several bodies.
/// Gives for each pair the reason in words.
pub(super) fn order(mesh: &mut Mesh, whole: Option<&Material>) -> Vec<&'static str> {
    let mut reasons = Vec::with_capacity(mesh.pairs.len());
    for at in 0..mesh.pairs.len() {
        let pair = mesh.pairs[at].clone();
        let [slave, master] = [&pair.slave, &pair.master].map(|name| side(mesh, name, whole));
        let is_free = |name: &str| mesh.pairs.iter().filter(|own| own.slave == name || own.master == name).count() == 1;
        let (turns, reason) = if !(slave.is_one_body && master.is_one_body) {
            (false, "finer")
        } else if let Some(first) = less(slave.young, master.young, SOFTER) {
            (!first, "softer")
        } else if let Some(first) = less(slave.size, master.size, FINER) {
            (!first, "finer")
        } else {
            (master.area < (1.0 - 1e-6) * slave.area, "smaller, of like meshes")
        };
        let may_turn = is_free(&pair.slave) && is_free(&pair.master);
        if turns && may_turn {
            mesh.pairs[at].slave = pair.master;
            mesh.pairs[at].master = pair.slave;
        }
        reasons.push(if turns && !may_turn { "finer, and in several pairs" } else { reason });
    }
    reasons
}

/// Whether the first value is the less by this ratio; nothing where both are alike.
fn less(first: f64, second: f64, ratio: f64) -> Option<bool> {
    if first * ratio <= second {
        Some(true)
    } else if second * ratio <= first {
        Some(false)
    } else {
        None
    }
}

/// Makes a surface the slave of its pair.
///
/// # Errors
/// A name that no pair has, or a pair that shares its surfaces with others.
pub(super) fn make_slave(mesh: &mut Mesh, name: &str) -> Result<()> {
    let wrong = |fact: String, remedy: String| Error::from(Diagnostic::error("command-line", fact).remedy(remedy));
    let of: Vec<usize> =
        (0..mesh.pairs.len()).filter(|&at| mesh.pairs[at].slave == name || mesh.pairs[at].master == name).collect();
    let [at] = of[..] else {
        let mut known: Vec<&str> =
            mesh.pairs.iter().flat_map(|own| [own.slave.as_str(), own.master.as_str()]).collect();
        known.sort_unstable();
        known.dedup();
        let fact =
            if of.is_empty() { "no contact pair has this surface" } else { "several contact pairs have this surface" };
        let all =
            if known.is_empty() { "no pairs are known".to_owned() } else { format!("surfaces: {}", known.join(", ")) };
        return Err(wrong(format!("--slave {name}: {fact}"), all));
    };
    let pair = &mut mesh.pairs[at];
    if pair.master == name {
        std::mem::swap(&mut pair.slave, &mut pair.master);
    }
    Ok(())
}

fn side(mesh: &Mesh, name: &str, whole: Option<&Material>) -> Side {
    let mut side = Side { young: f64::NAN, size: 0.0, area: 0.0, is_one_body: true };
    let Some(group) = mesh.group(name) else { return side };
    for &cell in &group.cells {
        let corners = mesh.cells.shapes[cell as usize].cell().edges.len().max(2);
        let nodes = mesh.cells.nodes(cell as usize);
        let points: Vec<[f64; 3]> = nodes.iter().take(corners).map(|&node| mesh.points[node as usize]).collect();
        let way = |at: usize| sub(points[at], points[0]);
        let area = match points.len() {
            2 => norm(way(1)),
            3 => norm(cross(way(1), way(2))) / 2.0,
            _ => norm(cross(way(2), sub(points[3], points[1]))) / 2.0,
        };
        side.area += area;
        side.size += if points.len() == 2 { area } else { area.sqrt() };
    }
    side.size /= group.cells.len().max(1) as f64;
    let youngs = youngs(mesh, &group.cells, whole);
    side.is_one_body = youngs.len() <= 1;
    side.young = youngs.first().copied().unwrap_or(f64::NAN);
    side
}

/// Young's moduli of the bodies behind faces, each once.
fn youngs(mesh: &Mesh, faces: &[u32], whole: Option<&Material>) -> Vec<f64> {
    let dimension = mesh.dimension();
    let mut on_faces = vec![false; mesh.points.len()];
    for &face in faces {
        mesh.cells.nodes(face as usize).iter().for_each(|&node| on_faces[node as usize] = true);
    }
    let of_name = |name: &str| mesh.materials.iter().find(|material| material.name == name);
    let young = |material: Option<&Material>| material.or(whole).and_then(|own| own.young).unwrap_or(STEEL);
    let mut of_cells = vec![young(None); mesh.cells.len()];
    for section in &mesh.sections {
        let value = young(of_name(&section.material));
        for &cell in mesh.group(&section.group).map_or(&[][..], |group| &group.cells[..]) {
            of_cells[cell as usize] = value;
        }
    }
    let is_behind = |cell: &usize| {
        mesh.cells.shapes[*cell].dim() == dimension
            && mesh.cells.nodes(*cell).iter().filter(|&&node| on_faces[node as usize]).count() >= dimension
    };
    let mut found: Vec<f64> = (0..mesh.cells.len()).filter(is_behind).map(|cell| of_cells[cell]).collect();
    found.sort_unstable_by(f64::total_cmp);
    found.dedup();
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_decide() {
        assert_eq!(less(1.0, 2.0, 2.0), Some(true));
        assert_eq!(less(3.0, 1.0, 2.0), Some(false));
        assert_eq!(less(1.0, 1.4, 1.5), None);
        assert_eq!(less(f64::NAN, 1.0, 1.5), None);
    }
}
