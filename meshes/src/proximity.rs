//! Finds surfaces of different bodies that lie close to each other, for a starter deck.

use rustc_hash::{FxHashMap, FxHashSet};
use zelus_core::geometry::mapping;
use zelus_core::vector3::{dot, norm, scale, sub};
use zelus_linear_algebra::Components;

use super::faces::{FaceCells, face_nodes, faces};
use super::mesh::{Mesh, Pair};

/// How near faces of two bodies must be to be a pair, in sizes of the larger face.
const REACH: f64 = 1.0;
/// How far behind a face another may lie, in sizes of the larger: bodies that are pressed into each other.
const BEHIND: f64 = 0.25;
/// Faces turned to each other: the largest product of their unit normals.
const OPPOSITE: f64 = -0.5;

/// A boundary face.
struct Side {
    element: usize,
    number: usize,
    body: u32,
    centre: [f64; 3],
    normal: [f64; 3],
    size: f64,
}

/// Bodies: for each node the smallest node that elements join it with.
fn bodies(mesh: &Mesh) -> Vec<u32> {
    let components = Components::new(mesh.points.len());
    let dimension = mesh.dimension();
    for cell in (0..mesh.cells.len()).filter(|&cell| mesh.cells.shapes[cell].dim() == dimension) {
        mesh.cells.nodes(cell).windows(2).for_each(|two| components.join(two[0], two[1]));
    }
    (0..mesh.points.len() as u32).map(|node| components.first(node)).collect()
}

fn sides(mesh: &Mesh) -> Vec<Side> {
    let body = bodies(mesh);
    let mut found: Vec<_> = faces(mesh).into_values().filter(|face| !face.is_inner).collect();
    found.sort_unstable_by_key(|face| (face.element, face.number));
    let side = |face: super::faces::Face| {
        let (shape, nodes) = face_nodes(mesh, face.element as usize, face.number);
        let points: Vec<[f64; 3]> = nodes.iter().map(|&node| mesh.points[node as usize]).collect();
        let normal = mapping::unit_normal(shape, &points, shape.cell().centre)?;
        let centre = mapping::centre(shape, &points);
        let size = points.iter().map(|point| norm(sub(*point, centre))).fold(0.0, f64::max) * 2.0;
        Some(Side {
            element: face.element as usize,
            number: face.number,
            body: body[nodes[0] as usize],
            centre,
            normal,
            size,
        })
    };
    found.into_iter().filter_map(side).collect()
}

/// Boundary faces of two bodies that face each other within reach, by bodies; the body with the smaller faces first.
fn close(all: &[Side]) -> Vec<[Vec<usize>; 2]> {
    let largest = all.iter().map(|side| side.size).fold(0.0, f64::max) * (1.0 + REACH);
    let key = |point: [f64; 3]| point.map(|x| (x / largest).floor() as i64);
    let mut grid: FxHashMap<[i64; 3], Vec<usize>> = FxHashMap::default();
    all.iter().enumerate().for_each(|(at, side)| grid.entry(key(side.centre)).or_default().push(at));
    let mut found: std::collections::BTreeMap<(u32, u32), [FxHashSet<usize>; 2]> = std::collections::BTreeMap::new();
    for (at, side) in all.iter().enumerate() {
        let [x, y, z] = key(side.centre);
        let near = (-1..=1).flat_map(|i| (-1..=1).flat_map(move |j| (-1..=1).map(move |k| [x + i, y + j, z + k])));
        for &other in near.filter_map(|key| grid.get(&key)).flatten().filter(|&&other| all[other].body > side.body) {
            let two = &all[other];
            let apart = sub(two.centre, side.centre);
            // the gap along the normal, and how far centres lie beside each other
            let gap = dot(apart, side.normal);
            let beside = norm(sub(apart, scale(side.normal, dot(apart, side.normal))));
            let size = side.size.max(two.size);
            let is_before = (-BEHIND * size..=REACH * size).contains(&gap);
            if is_before && beside <= size && dot(side.normal, two.normal) < OPPOSITE {
                let pair = found.entry((side.body, two.body)).or_default();
                pair[0].insert(at);
                pair[1].insert(other);
            }
        }
    }
    let mean = |list: &[usize]| list.iter().map(|&at| all[at].size).sum::<f64>() / list.len() as f64;
    let sorted = |set: FxHashSet<usize>| {
        let mut list: Vec<usize> = set.into_iter().collect();
        list.sort_unstable();
        list
    };
    let by_size = |[a, b]: [FxHashSet<usize>; 2]| {
        let (a, b) = (sorted(a), sorted(b));
        if mean(&b) < mean(&a) { [b, a] } else { [a, b] }
    };
    found.into_values().map(by_size).collect()
}

/// Two surfaces by their boundary faces.
struct Found {
    slave: Vec<usize>,
    masters: Vec<usize>,
}

/// Adds missing entries.
fn join(list: &mut Vec<usize>, more: &[usize]) {
    list.extend(more);
    list.sort_unstable();
    list.dedup();
}

/// Finds pairs: groups of faces that hold most of the close faces, else new groups `Contact_N_Slave` and `Contact_N_Master`. The side
/// with the smaller faces is the slave. A face is the slave of one pair, which then has the masters of all that it is close to: a node
/// has one multiplier. Pairs of the file itself are left alone.
pub fn find_pairs(mesh: &mut Mesh) -> Vec<Pair> {
    let all = sides(mesh);
    let mut made = FaceCells::new(mesh);
    let mut found: Vec<Found> = Vec::new();
    for [mut slave, mut masters] in close(&all) {
        let shares: Vec<bool> =
            found.iter().map(|own| slave.iter().any(|face| own.slave.binary_search(face).is_ok())).collect();
        let place = shares.iter().position(|shares| *shares).unwrap_or(found.len());
        let mut rest = Vec::with_capacity(found.len() + 1);
        for (own, shares) in found.into_iter().zip(shares) {
            if shares {
                join(&mut slave, &own.slave);
                join(&mut masters, &own.masters);
            } else {
                rest.push(own);
            }
        }
        found = rest;
        found.insert(place, Found { slave, masters });
    }
    let mut cells_of = |mesh: &mut Mesh, list: &[usize]| -> Vec<u32> {
        list.iter().map(|&side| made.cell(mesh, all[side].element, all[side].number)).collect()
    };
    let mut named_slaves: Vec<(String, Vec<usize>)> = Vec::new();
    for own in found {
        let name =
            group_of(mesh, &own.slave, &all, &mut cells_of, || format!("Contact_{}_Slave", named_slaves.len() + 1));
        match named_slaves.iter_mut().find(|(other, _)| *other == name) {
            None => named_slaves.push((name, own.masters)),
            Some((_, masters)) => join(masters, &own.masters),
        }
    }
    let pair = |(at, (slave, masters)): (usize, (String, Vec<usize>))| {
        let master = group_of(mesh, &masters, &all, &mut cells_of, || format!("Contact_{}_Master", at + 1));
        Pair::of(slave, master)
    };
    named_slaves.into_iter().enumerate().map(pair).collect()
}

/// The name of the group that holds these faces, which is made under a new name where there is none.
fn group_of(
    mesh: &mut Mesh,
    faces: &[usize],
    all: &[Side],
    cells_of: &mut impl FnMut(&mut Mesh, &[usize]) -> Vec<u32>,
    new: impl FnOnce() -> String,
) -> String {
    let cells = cells_of(mesh, faces);
    let body = all[faces[0]].body;
    let is_one = faces.iter().all(|&face| all[face].body == body);
    named(mesh, &cells, all, body).filter(|_| is_one).unwrap_or_else(|| {
        let name = new();
        mesh.group_mut(&name).cells.extend(cells);
        name
    })
}

/// The smallest group of faces of that body alone which holds all of these cells.
fn named(mesh: &Mesh, cells: &[u32], all: &[Side], body: u32) -> Option<String> {
    let dimension = mesh.dimension();
    let nodes_of_body: FxHashSet<u32> = all
        .iter()
        .filter(|side| side.body == body)
        .flat_map(|side| face_nodes(mesh, side.element, side.number).1)
        .collect();
    let fits = |group: &&super::mesh::Group| {
        let own: FxHashSet<u32> = group.cells.iter().copied().collect();
        let is_surface = group.cells.iter().all(|&cell| {
            mesh.cells.shapes[cell as usize].dim() + 1 == dimension
                && mesh.cells.nodes(cell as usize).iter().all(|node| nodes_of_body.contains(node))
        });
        is_surface && cells.iter().all(|cell| own.contains(cell))
    };
    mesh.groups.iter().filter(fits).min_by_key(|group| group.cells.len()).map(|group| group.name.clone())
}

#[cfg(test)]
mod tests {
    use zelus_core::geometry::Shape;

    use super::*;

    /// Squares of size `size` in a row from `corner` on.
    fn add_row(mesh: &mut Mesh, corner: [f64; 2], size: f64, count: usize) {
        let first = mesh.points.len() as u32;
        for i in 0..=count {
            for j in [0.0, size] {
                mesh.points.push([corner[0] + size * i as f64, corner[1] + j, 0.0]);
                mesh.node_ids.push(mesh.points.len() as u32);
            }
        }
        for i in 0..count as u32 {
            let [a, b] = [first + 2 * i, first + 2 * i + 2];
            mesh.cells.push(mesh.cells.len() as u32 + 1, Shape::Quad4, vec![a, b, b + 1, a + 1]);
        }
    }

    /// How many faces the slave and the master of each pair have.
    fn sizes_of_pairs(mesh: &mut Mesh) -> Vec<[usize; 2]> {
        let pairs = find_pairs(mesh);
        let size = |name: &String| mesh.groups.iter().find(|group| group.name == *name).unwrap().cells.len();
        pairs.iter().map(|pair| [&pair.slave, &pair.master].map(size)).collect()
    }

    #[test]
    fn a_face_is_the_slave_of_one_pair() {
        // A row of small squares below two larger blocks, which are close to each other, too.
        let mut mesh = Mesh::default();
        add_row(&mut mesh, [0.0, 0.0], 0.5, 8);
        add_row(&mut mesh, [0.0, 0.5], 1.0, 2);
        add_row(&mut mesh, [2.05, 0.5], 1.0, 2);
        assert_eq!(sizes_of_pairs(&mut mesh), [[8, 4], [1, 1]]);
    }

    #[test]
    fn a_body_that_is_close_to_the_slaves_of_two_pairs_makes_them_one() {
        // Two blocks above a row of small squares, far apart, and a third body above both.
        let mut mesh = Mesh::default();
        add_row(&mut mesh, [0.0, 0.0], 0.5, 16);
        add_row(&mut mesh, [0.0, 0.5], 1.0, 2);
        add_row(&mut mesh, [5.0, 0.5], 1.0, 2);
        add_row(&mut mesh, [0.0, 0.55], 1.0, 8);
        assert_eq!(sizes_of_pairs(&mut mesh), [[16, 12]]);
    }

    #[test]
    fn faces_behind_others_are_no_pair() {
        // A thin plate on a block: its upper face looks away, and the lower face of the block is turned to it from behind.
        let mut mesh = Mesh::default();
        add_row(&mut mesh, [0.0, 0.0], 1.0, 2);
        add_row(&mut mesh, [0.0, 1.0], 0.5, 4);
        let pairs = find_pairs(&mut mesh);
        assert_eq!(pairs.len(), 1, "{pairs:?}");
        let group = mesh.groups.iter().find(|group| group.name == pairs[0].slave).unwrap();
        let heights = group
            .cells
            .iter()
            .flat_map(|&cell| mesh.cells.nodes(cell as usize))
            .map(|&node| mesh.points[node as usize][1]);
        assert!(heights.clone().count() == 8 && heights.into_iter().all(|y| y == 1.0));
    }
}
