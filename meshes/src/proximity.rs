//! Finds surfaces of different bodies that lie close to each other, for a starter deck.

use rustc_hash::{FxHashMap, FxHashSet};
use zelus_core::geometry::mapping;
use zelus_core::vector3::{dot, norm, scale, sub};

use super::faces::{FaceCells, face_nodes, faces};
use super::mesh::{Mesh, Pair};

/// How near faces of two bodies must be to be a pair, in sizes of the larger face.
const REACH: f64 = 1.0;
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
    fn root(of: &mut [u32], mut node: u32) -> u32 {
        while of[node as usize] != node {
            of[node as usize] = of[of[node as usize] as usize];
            node = of[node as usize];
        }
        node
    }
    let mut of: Vec<u32> = (0..mesh.points.len() as u32).collect();
    let dimension = mesh.dimension();
    for cell in (0..mesh.cells.len()).filter(|&cell| mesh.cells.shapes[cell].dim() == dimension) {
        let nodes = mesh.cells.nodes(cell);
        for two in nodes.windows(2) {
            let (a, b) = (root(&mut of, two[0]), root(&mut of, two[1]));
            of[a.max(b) as usize] = a.min(b);
        }
    }
    (0..of.len() as u32).map(|node| root(&mut of, node)).collect()
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
            let gap = dot(apart, side.normal).abs();
            let beside = norm(sub(apart, scale(side.normal, dot(apart, side.normal))));
            let size = side.size.max(two.size);
            if gap <= REACH * size && beside <= size && dot(side.normal, two.normal) < OPPOSITE {
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

/// Finds pairs: groups of faces that hold most of what is close, else new groups `Contact_N_Slave` and `Contact_N_Master`. The side
/// with the smaller faces is the slave. What the file pairs itself is left alone.
pub fn find_pairs(mesh: &mut Mesh) -> Vec<Pair> {
    let all = sides(mesh);
    let mut made = FaceCells::new(mesh);
    let mut out = Vec::new();
    for (at, lists) in close(&all).into_iter().enumerate() {
        let mut names = Vec::new();
        for (list, role) in lists.iter().zip(["Slave", "Master"]) {
            let cells: Vec<u32> =
                list.iter().map(|&side| made.cell(mesh, all[side].element, all[side].number)).collect();
            let body = all[list[0]].body;
            names.push(named(mesh, &cells, &all, body).unwrap_or_else(|| {
                let name = format!("Contact_{}_{role}", at + 1);
                mesh.group_mut(&name).cells.extend(cells);
                name
            }));
        }
        let master = names.pop().expect("two sides");
        let slave = names.pop().expect("two sides");
        out.push(Pair { tied: false, slave, master, friction: 0.0 });
    }
    out
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
