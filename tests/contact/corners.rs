//! Mesh nodes on two faces of a body: corners that are pressed into corners, ties and pairs that meet at a node, edges on flats.

use serde_json::{Value, json};

use crate::blocks::Vec3;
use crate::scene::{COMPONENTS, Corner, FRICTIONAL, FRICTIONLESS, Kind, Scene, all_nodes, corner, die, held, turned};

/// Forces on deformed faces, which stretch and turn by about 1e-3, against those on the undeformed ones.
const FOLLOWING: f64 = 3e-3;

fn close(found: f64, right: f64, tolerance: f64, what: &str) {
    assert!((found - right).abs() <= tolerance, "{what}: {found:e} in place of {right:e}");
}

/// The block in its die: displacements of uniaxial strain.
fn check_die(space: usize, angle: f64, size: f64, kind: Kind, block_is_slave: bool) {
    let (scene, block) = die(space, angle, size, kind, block_is_slave);
    let up = space - 1;
    let fields = scene.results();
    let (nu, young) = (scene.poisson, scene.young);
    let shortening = (1.0 + nu) * (1.0 - 2.0 * nu) / ((1.0 - nu) * young) / (size * size);
    for node in block {
        let x = turned(-angle)(scene.mesh.nodes[node - 1]);
        let u = turned(-angle)(fields.displacement[node - 1]);
        for c in 0..space {
            let right = if c == up { -shortening * x[up] } else { 0.0 };
            let what = format!(
                "{kind:?} in {space} dimensions, turned by {angle}, size {size}, block slave {block_is_slave}: u[{c}] of node {node}"
            );
            close(u[c], right, 1e-6 * 2.0 * size * shortening, &what);
        }
    }
}

/// ANALYTIC: uniaxial strain, u = −σ (1 + ν)(1 − 2ν) / (E (1 − ν)) y. Linear elements hold it exactly; the tolerance is that of
/// Newton's iteration.
#[test]
fn a_block_in_a_die_is_in_uniaxial_strain() {
    for kind in [FRICTIONLESS, COMPONENTS] {
        check_die(2, 0.0, 1.0, kind, true);
    }
    check_die(2, 0.0, 1.0, FRICTIONLESS, false);
    check_die(2, 0.7, 1.0, FRICTIONLESS, true);
    check_die(2, 0.0, 1e-3, FRICTIONLESS, true);
    check_die(3, 0.0, 1.0, FRICTIONLESS, true);
    check_die(3, 0.5, 1.0, FRICTIONLESS, true);
}

/// ANALYTIC: equilibrium. Without friction the floor carries the vertical load and the wall the horizontal one.
#[test]
fn floor_and_wall_share_the_load_of_a_corner() {
    for pairs in [
        vec![["Bottom", "FloorTop"], ["Left", "WallFace"]],
        vec![["FloorTop", "Bottom"], ["WallFace", "Left"]],
        vec![["Bottom", "FloorTop"], ["WallFace", "Left"]],
    ] {
        let Corner { mut scene, floor, wall } = corner(5);
        scene.loads = vec![("Top", [0.0, -1.0, 0.0]), ("Right", [-0.5, 0.0, 0.0])];
        (scene.pairs, scene.steps) = (pairs.clone(), 2);
        let fields = scene.results();
        for (nodes, right) in [(&floor, [0.0, 2.0]), (&wall, [1.0, 0.0])] {
            let force = fields.force(nodes);
            (0..2).for_each(|c| close(force[c], right[c], FOLLOWING, &format!("{pairs:?}: force {force:?}")));
        }
    }
}

/// ANALYTIC: equilibrium, as above. The floor and the wall are one body with a corner in its face.
#[test]
fn a_block_sits_in_the_corner_of_a_bracket() {
    let mut scene = Scene::new(2);
    scene.poisson = 0.0;
    let block = scene.add("Block", [[0.0; 3], [2.0, 2.0, 0.0]], 4, &|x| x);
    scene.part("Faces", &block, &[(0, 0), (1, 0)]);
    scene.load("Top", &block, (1, 1), [0.0, -1.0, 0.0]);
    scene.load("Right", &block, (0, 1), [-0.5, 0.0, 0.0]);
    // A strip that turns at half of its length: from the wall over the corner to the floor.
    let bend = |[s, t, _]: Vec3| {
        let along = 1.0 - 2.0 * s;
        let (inner, outer) = (3.0 * along.abs(), 4.0 * along.abs() - 1.0);
        let (far, off) = (inner * t + outer * (1.0 - t), t - 1.0);
        if along > 0.0 { [off, far, 0.0] } else { [far, off, 0.0] }
    };
    scene.bodies.push("Bracket");
    let bracket = scene.mesh.block("Bracket", [12, 3, 1], bend);
    scene.part("Inside", &bracket, &[(1, 1)]);
    scene.part("Outside", &bracket, &[(1, 0)]);
    scene.supports = vec![("Outside", held(2))];
    for pair in [["Faces", "Inside"], ["Inside", "Faces"]] {
        (scene.pairs, scene.steps) = (vec![pair], 2);
        let force = scene.results().force(&bracket[&(1, 0)].0);
        [1.0, 2.0]
            .into_iter()
            .enumerate()
            .for_each(|(c, right)| close(force[c], right, FOLLOWING, &format!("{pair:?}")));
    }
}

/// Both ties hold at the node they share. ANALYTIC: with cells that match, ties are those of one body, whichever side is the
/// slave, and the corners of the three bodies move together.
#[test]
fn a_corner_may_be_tied_to_two_bodies() {
    let run = |pairs: [[&'static str; 2]; 2], fine: usize| {
        let Corner { mut scene, floor, wall } = corner(fine);
        scene.loads = vec![("Right", [1.0, 0.0, 0.0])];
        scene.ties = pairs.to_vec();
        let fields = scene.results();
        let moved: Vec<Vec3> = scene.nodes_at([0.0; 3]).iter().map(|node| fields.displacement[node - 1]).collect();
        (moved, fields.force(&floor)[0], fields.force(&wall)[0])
    };
    let block = [["Bottom", "FloorTop"], ["Left", "WallFace"]];
    let others = [["FloorTop", "Bottom"], ["WallFace", "Left"]];
    let (moved, floor, wall) = run(block, 4);
    let (same, same_floor, same_wall) = run(others, 4);
    assert_eq!((moved.len(), same.len()), (3, 3));
    for u in moved.iter().chain(&same) {
        (0..2).for_each(|c| close(u[c], moved[0][c], 1e-9 * 5e-4, "the corner"));
    }
    close(floor, same_floor, 1e-8, "the floor");
    close(wall, same_wall, 1e-8, "the wall");
    close(floor + wall, -2.0, FOLLOWING, "both");
    // Ties of non-matching cells take means: EXTERNAL, the other choice of slaves, within the accuracy of the mesh.
    let (moved, floor, _) = run(block, 5);
    let (same, same_floor, _) = run(others, 5);
    for u in moved.iter().chain(&same) {
        (0..2).for_each(|c| close(u[c], same[0][c], 0.02 * same[0][0], "the corner"));
    }
    close(floor, same_floor, 2e-3 * floor.abs(), "the floor");
}

/// ANALYTIC: equilibrium. A slave node that is tied to the floor and leaves the wall hangs on the floor alone; no body penetrates
/// another, however large the load.
#[test]
fn a_tie_and_an_open_pair_meet_at_a_corner() {
    for kind in [FRICTIONLESS, COMPONENTS] {
        for load in [1.0, 1e-6] {
            let Corner { mut scene, floor, wall } = corner(5);
            scene.loads = vec![("Right", [load, 0.0, 0.0])];
            (scene.ties, scene.pairs) = (vec![["Bottom", "FloorTop"]], vec![["Left", "WallFace"]]);
            scene.kind = kind;
            let fields = scene.results();
            let (floor, wall) = (fields.force(&floor), fields.force(&wall));
            close(floor[0], -2.0 * load, FOLLOWING * load, &format!("{kind:?}: floor {floor:?}"));
            (0..2).for_each(|c| close(wall[c], 0.0, 1e-8 * load, &format!("{kind:?}: wall {wall:?}")));
        }
    }
}

/// ANALYTIC: equilibrium. The same corner pressed on the wall: floor and wall carry the load together, and the tie holds.
#[test]
fn a_tie_and_a_closed_pair_meet_at_a_corner() {
    for kind in [FRICTIONLESS, COMPONENTS] {
        let Corner { mut scene, floor, wall } = corner(5);
        scene.loads = vec![("Right", [-1.0, 0.0, 0.0])];
        (scene.ties, scene.pairs) = (vec![["Bottom", "FloorTop"]], vec![["Left", "WallFace"]]);
        scene.kind = kind;
        let fields = scene.results();
        let (floor, wall) = (fields.force(&floor), fields.force(&wall));
        close(floor[0] + wall[0], 2.0, FOLLOWING, &format!("{kind:?}: {floor:?} {wall:?}"));
        close(wall[1], 0.0, FOLLOWING, &format!("{kind:?}: wall {wall:?}"));
        assert!(wall[0] > 1.0 && floor[0] > 0.0, "{kind:?}: {floor:?} {wall:?}");
        let corner: Vec<Vec3> = scene.nodes_at([0.0; 3]).iter().map(|node| fields.displacement[node - 1]).collect();
        (0..2).for_each(|c| close(corner[0][c], corner[1][c], 0.05 * 1e-3, &format!("{kind:?}: corner {corner:?}")));
    }
}

/// A block turned by `angle` whose lowest edge is pressed into a flat one. `slave` and `master` are "Face", the block's lower face,
/// "Skin", its lower faces on both sides of the edge, and "Flat".
fn edge_on_flat(space: usize, angle: f64, [slave, master]: [&'static str; 2], steps: usize) -> (Scene, Vec<usize>) {
    let mut scene = Scene::new(space);
    scene.steps = steps;
    let height = |x: f64| if space == 2 { 0.0 } else { x };
    let (low, high) = ([0.0, 0.0, 0.0], [2.0, 1.0, height(1.0)]);
    let flat = scene.add("Lower", [low, high], 4, &|x| x);
    let turn = turned(angle);
    let edge = [0.9, 1.0];
    let place = |x: Vec3| {
        let [a, b, z] = turn(x);
        [edge[0] + a, edge[1] + b, z]
    };
    let block = scene.add("Upper", [[0.0; 3], [0.8, 0.8, height(1.0)]], 3, &place);
    scene.part("Flat", &flat, &[(1, 1)]);
    scene.part("Base", &flat, &[(1, 0)]);
    scene.part("Face", &block, &[(1, 0)]);
    scene.part("Skin", &block, &[(0, 0), (1, 0)]);
    scene.part("Head", &block, &[(1, 1)]);
    scene.pairs = vec![[slave, master]];
    let down = std::array::from_fn(|c| if c >= space { Value::Null } else { json!(0.0) });
    let mut moved = down.clone();
    moved[1] = json!("-0.03*t");
    scene.supports = vec![("Base", down), ("Head", moved)];
    (scene, flat[&(1, 0)].0.clone())
}

/// ANALYTIC: without friction the force is normal to the flat face, whose middle the pressed edge indents evenly enough.
#[test]
fn an_edge_presses_along_the_normal_of_a_flat() {
    for (space, angle) in [(2, 0.5), (2, 1.1), (3, 0.5)] {
        for slave in ["Face", "Skin"] {
            let (scene, base) = edge_on_flat(space, angle, [slave, "Flat"], 4);
            let force = scene.results().force(&base);
            assert!(force[1] > 0.1, "{space} {angle} {slave}: {force:?}");
            let share = force[0].abs().max(force[2].abs()) / force[1];
            assert!(share < 0.02, "{space} {angle} {slave}: {share:e} of the force is tangential");
        }
    }
}

/// With the flat as the slave its nodes do not see the edge between them: no such state is a result.
#[test]
fn an_edge_between_the_nodes_of_a_slave_is_refused() {
    for steps in [1, 4] {
        let (scene, _) = edge_on_flat(2, 0.5, ["Flat", "Face"], steps);
        let (status, said, _) = scene.run();
        assert_eq!(status, Some(3), "{said}");
        let words = ["at an edge of a master", "slave facet", "assume_master_slave"];
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    }
}

/// ANALYTIC: equilibrium and Coulomb's law. A block that sticks to a floor and to a wall has more equations of contact at its corner than
/// displacements: the friction of each face along the normal of the other is statically indeterminate there.
#[test]
fn a_block_sticks_to_floor_and_wall() {
    for pairs in [
        vec![["Bottom", "FloorTop"], ["Left", "WallFace"]],
        vec![["FloorTop", "Bottom"], ["WallFace", "Left"]],
        vec![["Bottom", "FloorTop"], ["WallFace", "Left"]],
    ] {
        for (friction, pushed) in [(0.3, 0.5), (0.6, 1.0), (0.1, 0.05)] {
            let Corner { mut scene, floor, wall } = corner(5);
            (scene.kind, scene.friction, scene.poisson) = (FRICTIONAL, friction, 0.3);
            scene.loads = vec![("Top", [0.0, -1.0, 0.0]), ("Right", [-pushed, 0.0, 0.0])];
            (scene.pairs, scene.steps) = (pairs.clone(), 2);
            let fields = scene.results();
            let what = format!("{pairs:?}, friction {friction}, pushed {pushed}");
            let [of_floor, of_wall] = [&floor, &wall].map(|nodes| fields.force(nodes));
            close(of_floor[0] + of_wall[0], 2.0 * pushed, FOLLOWING, &what);
            close(of_floor[1] + of_wall[1], 2.0, FOLLOWING, &what);
            assert!(of_floor[0].abs() <= friction * of_floor[1] + FOLLOWING, "{what}: floor {of_floor:?}");
            assert!(of_wall[1].abs() <= friction * of_wall[0] + FOLLOWING, "{what}: wall {of_wall:?}");
        }
    }
}

/// ANALYTIC: equilibrium. A block in a rigid die with rough walls: floor and walls carry the load, turned as not turned.
#[test]
fn a_block_sticks_in_a_die() {
    for (space, angle, block_is_slave) in
        [(2, 0.0, true), (2, 0.7, true), (2, 0.0, false), (3, 0.0, true), (3, 0.5, true)]
    {
        let (mut scene, block) = die(space, angle, 1.0, FRICTIONAL, block_is_slave);
        scene.friction = 0.2;
        let fields = scene.results();
        let walls: Vec<usize> =
            (1..=scene.mesh.nodes.len()).filter(|node| block.binary_search(node).is_err()).collect();
        let force = turned(-angle)(fields.force(&walls));
        let what = format!("in {space} dimensions, turned by {angle}, block slave {block_is_slave}: {force:?}");
        close(force[space - 1], if space == 2 { 2.0 } else { 4.0 }, FOLLOWING, &what);
        (0..space - 1).for_each(|c| close(force[c], 0.0, FOLLOWING, &what));
    }
}

/// ANALYTIC: Coulomb's law. A wall pushes a loaded block along a floor: the floor resists by μ times its pressure, at the corner between
/// both faces too, and the wall gives that force.
#[test]
fn a_wall_pushes_a_block_along_a_floor() {
    let friction = 0.3;
    for space in [2, 3] {
        let mut scene = Scene::new(space);
        (scene.kind, scene.friction, scene.steps) = (FRICTIONAL, friction, 3);
        let up = space - 1;
        let flat = |x: Vec3| if space == 2 { [x[0], x[2], 0.0] } else { x };
        let still = |x: Vec3| x;
        let block = scene.add("Block", [[0.0; 3], flat([2.0, 2.0, 2.0])], 4, &still);
        scene.part("Skin", &block, &[(0, 0), (up, 0)]);
        scene.load("Top", &block, (up, 1), flat([0.0, 0.0, -1.0]));
        let floor = scene.add("Floor", [flat([-0.5, -0.5, -1.0]), flat([3.5, 2.5, 0.0])], 5, &still);
        let wall = scene.add("Wall", [flat([-1.0, -0.5, 0.0]), flat([0.0, 2.5, 2.2])], 5, &still);
        let (mut nodes, mut facets) = (Vec::new(), Vec::new());
        for side in [&floor[&(up, 1)], &wall[&(0, 1)]] {
            nodes.extend(&side.0);
            facets.extend(&side.1);
        }
        scene.mesh.part("Walls", nodes, facets);
        scene.pairs = vec![["Skin", "Walls"]];
        let mut moved = held(space);
        moved[0] = json!("0.3*t");
        scene.supports = vec![("Floor", held(space)), ("Wall", moved)];
        let fields = scene.results();
        let [of_floor, of_wall] = [&floor, &wall].map(|body| fields.force(&all_nodes(body)));
        let what = format!("in {space} dimensions: floor {of_floor:?}, wall {of_wall:?}");
        close(of_floor[0], -friction * of_floor[up], 1e-5 * of_floor[up], &what);
        close(of_wall[0], -of_floor[0], 1e-6, &what);
        let load = if space == 2 { 2.0 } else { 4.0 };
        close(of_floor[up] + of_wall[up], load, FOLLOWING, &what);
    }
}
