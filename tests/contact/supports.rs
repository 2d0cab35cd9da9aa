//! Contact and ties whose surfaces end on supports and planes of symmetry.
//!
//! ANALYTIC: patch tests, whose tolerance is the strain, by which loads and contact act on deformed facets. ANALYTIC: a half
//! or a quarter is the whole.

use crate::blocks;
use crate::blocks::{Deck, Joint, Mesh, POISSON, Vec3};
use crate::support::{Results, read_json, root, said, scratch_copy, zelus};
use serde_json::{Value, json};
use std::path::Path;
use zelus as _;

const NULL: Value = Value::Null;

/// Runs a deck; returns the output and the displacement of every node.
fn run(deck: &Deck, folder: &Path, change: impl FnOnce(&mut Value)) -> Result<(String, Vec<Vec3>), String> {
    deck.write(folder, change);
    let output = zelus(folder, &["run", "ProjectParameters.json", "--threads", "1"]);
    if !output.status.success() {
        return Err(format!("exit {:?}: {}", output.status.code(), said(&output)));
    }
    let results = Results::read(&folder.join("results.json"))?;
    let component = |name: &str| results.nodal(&format!("DISPLACEMENT_{name}"), results.len() - 1);
    let [x, y, z] = ["X", "Y", "Z"].map(component);
    let zero = |values: &std::collections::BTreeMap<u64, f64>, n: u64| values.get(&n).copied().unwrap_or(0.0);
    let count = deck.mesh.nodes.len() as u64;
    Ok((said(&output), (1..=count).map(|n| [zero(&x, n), zero(&y, n), zero(&z, n)]).collect()))
}

/// Two blocks in a box of size one on each other, cut at the height `middle` of the coordinates across, with the parts of their sides.
fn column(mut mesh: Mesh, divisions: [usize; 2], upper_is_slave: bool, middle: impl Fn(Vec3) -> f64) -> Mesh {
    let (space, last) = (mesh.space, mesh.space - 1);
    let grid = |n: usize| std::array::from_fn(|c| if c == last { (n / 2).max(2) } else { n });
    let lower = mesh.block("Lower", grid(divisions[0]), |mut x| {
        x[last] *= middle(x);
        x
    });
    let upper = mesh.block("Upper", grid(divisions[1]), |mut x| {
        x[last] = middle(x) + x[last] * (1.0 - middle(x));
        x
    });
    meet(&mut mesh, [&lower, &upper], upper_is_slave, space);
    mesh
}

/// The parts of two blocks that meet in the last coordinate.
fn meet(mesh: &mut Mesh, [lower, upper]: [&blocks::Sides; 2], upper_is_slave: bool, space: usize) {
    let last = space - 1;
    let (low, up) = (&lower[&(last, 1)], &upper[&(last, 0)]);
    let slave = if upper_is_slave { up } else { low };
    mesh.part("Slave", slave.0.clone(), slave.1.clone());
    mesh.part("Interface", [low.0.clone(), up.0.clone()].concat(), [low.1.clone(), up.1.clone()].concat());
    mesh.part("Bottom", lower[&(last, 0)].0.clone(), Vec::new());
    mesh.part("Top", upper[&(last, 1)].0.clone(), upper[&(last, 1)].1.clone());
    for (axis, name) in ["PlaneX", "PlaneY"].into_iter().enumerate().take(last) {
        let side = |end| [lower[&(axis, end)].0.clone(), upper[&(axis, end)].0.clone()].concat();
        mesh.part(name, side(0), Vec::new());
        mesh.part(&format!("All{name}"), [side(0), side(1)].concat(), Vec::new());
    }
}

/// Components of a support: 0 where it holds.
fn holds(axes: &[usize]) -> [Value; 3] {
    std::array::from_fn(|c| if axes.contains(&c) { json!(0.0) } else { NULL })
}

fn planes(space: usize) -> Vec<(String, [Value; 3])> {
    ["PlaneX", "PlaneY"]
        .into_iter()
        .enumerate()
        .take(space - 1)
        .map(|(c, name)| (name.to_owned(), holds(&[c])))
        .collect()
}

/// Largest difference from a field, over `scale`.
fn difference(found: &[Vec3], nodes: &[Vec3], field: impl Fn(Vec3) -> Vec3, scale: f64) -> f64 {
    let off = |(u, x): (&Vec3, &Vec3)| {
        let expected = field(*x);
        (0..3).map(|c| (u[c] - expected[c]).abs()).fold(0.0, f64::max)
    };
    found.iter().zip(nodes).map(off).fold(0.0, f64::max) / scale
}

const MESHES: [[usize; 2]; 12] =
    [[2, 3], [3, 2], [3, 5], [5, 3], [4, 4], [5, 6], [6, 5], [7, 4], [4, 7], [9, 10], [10, 9], [15, 15]];

#[test]
fn tilted_patches_with_friction_end_on_supports() {
    let (load, young, mut problems) = (1e4, 1e9, Vec::new());
    let strain = load / young;
    for (upper_is_slave, friction, tilt) in [true, false]
        .into_iter()
        .flat_map(|s| [0.3, 1.0].into_iter().flat_map(move |f| [20.0, -20.0].map(|t| (s, f, t))))
    {
        for divisions in MESHES {
            let rise = f64::to_radians(tilt).tan();
            let mesh = column(Mesh::new(2), divisions, upper_is_slave, |x| 0.5 + rise * (x[0] - 0.5));
            let supports = [vec![("Bottom".to_owned(), holds(&[1]))], planes(2)].concat();
            let deck = Deck { mesh, joint: Joint::Frictional(friction), supports, pressure: load, young, steps: 1 };
            let folder = tempfile::tempdir().expect("a folder");
            let place = format!("tilt {tilt}, friction {friction}, upper slave {upper_is_slave}, {divisions:?}");
            // Without slip the column is as one; with a friction below the slope it slides.
            match run(&deck, folder.path(), |_| {}) {
                Err(said) => problems.push(format!("{place}: {said}")),
                Ok((said, _)) if said.contains("warning[") => problems.push(format!("{place}: {said}")),
                Ok((_, found)) if friction == 1.0 => {
                    let field = |[x, y, _]: Vec3| {
                        [POISSON * (1.0 + POISSON) * strain * x, -(1.0 - POISSON * POISSON) * strain * y, 0.0]
                    };
                    let error = difference(&found, &deck.mesh.nodes, field, strain);
                    if error.is_nan() || error > 10.0 * strain {
                        problems.push(format!("{place}: off by {error:e}"));
                    }
                }
                Ok((_, found)) => {
                    let largest = found.iter().flatten().fold(0.0_f64, |most, u| most.max(u.abs()));
                    if largest > 2.0 * strain {
                        problems.push(format!("{place}: moves by {largest:e}"));
                    }
                }
            }
        }
    }
    assert!(problems.is_empty(), "{} fail\n{}", problems.len(), problems.join("\n"));
}

/// The same in space, tilted along one or both coordinates: without slip the column is as one, at any friction it is held by
/// its planes of symmetry and its bottom carries the load.
#[test]
fn tilted_patches_in_space_end_on_supports() {
    let (load, young, mut problems) = (1e4, 1e9, Vec::new());
    let strain = load / young;
    let joints = [Joint::Frictionless, Joint::Frictional(0.3), Joint::Frictional(1.0)];
    for (simplices, upper_is_slave, joint) in [false, true]
        .into_iter()
        .flat_map(|of| [true, false].into_iter().flat_map(move |s| joints.map(|joint| (of, s, joint))))
    {
        for (divisions, rises) in [
            ([2, 3], [0.36, 0.0]),
            ([3, 2], [-0.36, 0.0]),
            ([3, 4], [0.25, -0.25]),
            ([4, 3], [-0.3, -0.2]),
            ([4, 4], [0.25, 0.3]),
        ] {
            let mesh = if simplices { Mesh::of_simplices(3) } else { Mesh::new(3) };
            let middle = |x: Vec3| 0.5 + (0..2).map(|c| rises[c] * (x[c] - 0.5)).sum::<f64>();
            let mesh = column(mesh, divisions, upper_is_slave, middle);
            let supports = [vec![("Bottom".to_owned(), holds(&[2]))], planes(3)].concat();
            let deck = Deck { mesh, joint, supports, pressure: load, young, steps: 1 };
            let folder = tempfile::tempdir().expect("a folder");
            let place = format!(
                "rises {rises:?}, {joint:?}, tetrahedra {simplices}, upper slave {upper_is_slave}, {divisions:?}"
            );
            match run(&deck, folder.path(), |_| {}) {
                Err(said) => problems.push(format!("{place}: {said}")),
                Ok((said, _)) if said.contains("warning[") => problems.push(format!("{place}: {said}")),
                Ok((_, found)) if joint == Joint::Frictional(1.0) => {
                    let field = |[x, y, z]: Vec3| [POISSON * strain * x, POISSON * strain * y, -strain * z];
                    let error = difference(&found, &deck.mesh.nodes, field, strain);
                    if error.is_nan() || error > 10.0 * strain {
                        problems.push(format!("{place}: off by {error:e}"));
                    }
                }
                Ok((_, found)) => {
                    let largest = found.iter().flatten().fold(0.0_f64, |most, u| most.max(u.abs()));
                    if largest.is_nan() || largest > 2.5 * strain || largest < strain {
                        problems.push(format!("{place}: moves by {largest:e}"));
                    }
                }
            }
        }
    }
    assert!(problems.is_empty(), "{} fail\n{}", problems.len(), problems.join("\n"));
}

/// An affine field on a column, prescribed all around its faces, or by its planes of symmetry and its top.
fn patch(
    space: usize,
    divisions: [usize; 2],
    upper_is_slave: bool,
    rise: f64,
    joint: Joint,
    all: bool,
) -> Result<f64, String> {
    let strain = 1e-5;
    let mesh = column(Mesh::new(space), divisions, upper_is_slave, |x| 0.5 + rise * (x[0] - 0.5));
    let last = space - 1;
    let across = if space == 2 { POISSON / (1.0 - POISSON) } else { POISSON };
    let gradient: [Vec3; 3] = if all {
        [[-0.5, 0.2, -0.1], [-0.2, -1.0, 0.2], [0.1, -0.1, -1.0]]
    } else {
        std::array::from_fn(|r| {
            std::array::from_fn(|c| {
                if r != c {
                    0.0
                } else if c == last {
                    -1.0
                } else {
                    across
                }
            })
        })
    };
    let field = |x: Vec3| -> Vec3 {
        std::array::from_fn(|r| if r < space { (0..space).map(|c| strain * gradient[r][c] * x[c]).sum() } else { 0.0 })
    };
    let supports = if all {
        let given = |r: usize| {
            let terms = (0..space).map(|c| format!("({})*{}", strain * gradient[r][c], ["X", "Y", "Z"][c]));
            json!(format!("t*({})", terms.collect::<Vec<_>>().join("+")))
        };
        let value: [Value; 3] = std::array::from_fn(|r| if r < space { given(r) } else { NULL });
        let sides = ["AllPlaneX", "AllPlaneY"].into_iter().take(last);
        ["Bottom", "Top"].into_iter().chain(sides).map(|part| (part.to_owned(), value.clone())).collect()
    } else {
        let pressed = std::array::from_fn(|c| if c == last { json!(-strain) } else { NULL });
        [vec![("Bottom".to_owned(), holds(&[last])), ("Top".to_owned(), pressed)], planes(space)].concat()
    };
    let deck = Deck { mesh, joint, supports, pressure: 0.0, young: 1e9, steps: 1 };
    let folder = tempfile::tempdir().expect("a folder");
    let (said, found) = run(&deck, folder.path(), |_| {})?;
    let tied = joint == Joint::Tied;
    let error = difference(&found, &deck.mesh.nodes, field, strain);
    let multipliers = Results::read(&folder.path().join("slave.json"))?;
    let spread = ["X", "Y", "Z"].map(|c| {
        let values = multipliers.nodal(&format!("VECTOR_LAGRANGE_MULTIPLIER_{c}"), 0).into_values();
        values.fold([f64::MAX, f64::MIN], |[least, most], v| [least.min(v), most.max(v)])
    });
    let largest = spread.iter().flatten().filter(|v| v.abs() < f64::MAX).fold(0.0_f64, |most, v| most.max(v.abs()));
    let uneven = spread.iter().map(|[least, most]| most - least).fold(0.0, f64::max);
    let tolerance = if tied { 1e-9 } else { 20.0 * strain };
    if said.contains("warning[") {
        return Err(said);
    }
    if tied && uneven > 1e-8 * largest {
        return Err(format!("tractions differ by {:e}", uneven / largest));
    }
    if error.is_nan() || error > tolerance { Err(format!("off by {error:e}")) } else { Ok(error) }
}

fn patches(joint: Joint, rises: &[f64], all: &[bool]) {
    let plane = [[2, 2], [2, 3], [3, 2], [3, 7], [7, 3], [2, 4], [4, 2], [5, 5], [1, 3], [3, 1]];
    let solid = [[2, 2], [2, 3], [3, 2], [2, 4]];
    let mut problems = Vec::new();
    for (space, meshes) in [(2, &plane[..]), (3, &solid[..])] {
        for (&rise, &all) in rises.iter().flat_map(|rise| all.iter().map(move |all| (rise, all))) {
            for (&divisions, upper_is_slave) in meshes.iter().flat_map(|m| [(m, true), (m, false)]) {
                if let Err(why) = patch(space, divisions, upper_is_slave, rise, joint, all) {
                    problems.push(format!(
                        "{space}D {divisions:?} upper slave {upper_is_slave} rise {rise} all {all}: {why}"
                    ));
                }
            }
        }
    }
    assert!(problems.is_empty(), "{} fail\n{}", problems.len(), problems.join("\n"));
}

#[test]
fn ties_end_on_planes_of_symmetry_and_on_clamps() {
    patches(Joint::Tied, &[0.0, 0.25], &[false, true]);
}

#[test]
fn contact_ends_on_planes_of_symmetry() {
    patches(Joint::Frictionless, &[0.0], &[false]);
    patches(Joint::Frictional(1.0), &[0.0, 0.25], &[false]);
}

#[test]
fn sticking_contact_ends_on_clamps() {
    patches(Joint::Frictional(3.0), &[0.0, 0.25], &[true]);
}

/// A bulged block pressed on a wider flat one, whole or cut at planes of symmetry; lengths times `unit`.
fn bulged(space: usize, cut: usize, divisions: [usize; 2], upper_is_slave: bool, joint: Joint, unit: f64) -> Deck {
    let (last, mut mesh) = (space - 1, Mesh::new(space));
    let divide = |n: usize| {
        std::array::from_fn(|c| match c {
            c if c == last => 2,
            c if c < cut => n,
            _ => 2 * n,
        })
    };
    let whole = move |c: usize, x: f64| if c < cut { x } else { 2.0 * x - 1.0 };
    let lower = mesh.block("Lower", divide(divisions[0]), |x| {
        std::array::from_fn(|c| {
            unit * if c == last {
                x[c] - 1.0
            } else if c < last {
                1.5 * whole(c, x[c])
            } else {
                0.0
            }
        })
    });
    let upper = mesh.block("Upper", divide(divisions[1]), |x| {
        let bulge: f64 = 0.1 / last as f64 * (0..last).map(|c| whole(c, x[c]).powi(2)).sum::<f64>();
        std::array::from_fn(|c| {
            unit * if c == last {
                bulge + x[c] * (1.0 - bulge)
            } else if c < last {
                whole(c, x[c])
            } else {
                0.0
            }
        })
    });
    meet(&mut mesh, [&lower, &upper], upper_is_slave, space);
    let all: Vec<usize> = (0..space).collect();
    let pressed = std::array::from_fn(|c| match c {
        c if c == last => json!(format!("{}*t", -0.02 * unit)),
        c if c < last => json!(0.0),
        _ => NULL,
    });
    let planes = planes(space).into_iter().take(cut);
    let supports =
        [("Bottom".to_owned(), holds(&all)), ("Top".to_owned(), pressed)].into_iter().chain(planes).collect();
    Deck { mesh, joint, supports, pressure: 0.0, young: 1e9 / unit / unit, steps: 2 }
}

/// Largest difference between a part of a model and the whole, over the motion of the top.
fn part_and_whole(
    space: usize,
    cut: usize,
    divisions: [usize; 2],
    upper_is_slave: bool,
    joint: Joint,
) -> Result<f64, String> {
    let order = |deck: &mut Value| {
        // The rule by which overlaps in space are integrated is not the same for mirror images; a fine one shows it less.
        deck["processes"]["contact_process_list"][0]["Parameters"]["integration_order"] = json!(5);
    };
    let solved = |cut: usize| {
        let deck = bulged(space, cut, divisions, upper_is_slave, joint, 1.0);
        let folder = tempfile::tempdir().expect("a folder");
        let (said, found) = run(&deck, folder.path(), order)?;
        if said.contains("warning[") { Err(said) } else { Ok((deck.mesh.nodes, found)) }
    };
    let ((whole, by_whole), (part, by_part)) = (solved(0)?, solved(cut)?);
    let mut worst = 0.0_f64;
    for (place, u) in part.iter().zip(&by_part) {
        // Nodes of both bodies may share a place: the nearest displacement is that of the same body.
        let same = whole.iter().zip(&by_whole).filter(|(x, _)| (0..3).all(|c| (x[c] - place[c]).abs() < 1e-9));
        let off = |v: &Vec3| (0..3).map(|c| (u[c] - v[c]).abs()).fold(0.0, f64::max);
        worst = worst.max(same.map(|(_, v)| off(v)).fold(f64::INFINITY, f64::min));
    }
    Ok(worst / 0.02)
}

#[test]
fn halves_and_quarters_are_the_whole() {
    let mut problems = Vec::new();
    for joint in [Joint::Frictionless, Joint::Frictional(0.2)] {
        for (space, cut, divisions, tolerance) in [
            (2, 1, [4, 3], 1e-9),
            (2, 1, [3, 5], 1e-9),
            (2, 1, [6, 6], 1e-9),
            (2, 1, [8, 5], 1e-9),
            (3, 1, [2, 3], 1e-4),
            (3, 2, [2, 3], 1e-4),
            (3, 2, [3, 2], 1e-4),
        ] {
            for upper_is_slave in [true, false] {
                let place = format!("{space}D, {cut} planes, {divisions:?}, upper slave {upper_is_slave}, {joint:?}");
                match part_and_whole(space, cut, divisions, upper_is_slave, joint) {
                    Ok(difference) if difference <= tolerance => {}
                    Ok(difference) => problems.push(format!("{place}: differs by {difference:e}")),
                    Err(why) => problems.push(format!("{place}: {why}")),
                }
            }
        }
    }
    assert!(problems.is_empty(), "{} fail\n{}", problems.len(), problems.join("\n"));
}

#[test]
fn a_quarter_with_friction_is_the_same_in_metres_and_millimetres() {
    let solved = |unit: f64| {
        let deck = bulged(3, 2, [3, 4], true, Joint::Frictional(0.3), unit);
        let folder = tempfile::tempdir().expect("a folder");
        let (said, found) = run(&deck, folder.path(), |_| {}).unwrap_or_else(|why| panic!("lengths x {unit}: {why}"));
        assert!(said.contains("note[held-multipliers]"), "{said}");
        found.into_iter().map(|u| u.map(|x| x / unit)).collect::<Vec<_>>()
    };
    let (metres, millimetres) = (solved(1.0), solved(1e3));
    let error = difference(&millimetres, &metres, |_| [0.0; 3], 1.0);
    assert!(error > 0.0, "nothing moves");
    let off = metres.iter().zip(&millimetres).map(|(a, b)| (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f64::max));
    let off = off.fold(0.0, f64::max) / 0.02;
    assert!(off < 1e-9, "differ by {off:e}");
}

/// Where the coordinates have their origin changes nothing, also if a slave node lies there.
#[test]
fn a_slave_node_at_the_origin_is_as_any_other() {
    let (load, young) = (1e4, 1e9);
    for shift in [[0.0, -0.5, 0.0], [-1.0 / 3.0, -0.5, 0.0], [1e-9, -0.5, 0.0]] {
        let mut mesh = column(Mesh::new(2), [3, 2], false, |_| 0.5);
        mesh.nodes.iter_mut().for_each(|x| (0..3).for_each(|c| x[c] += shift[c]));
        let supports = [vec![("Bottom".to_owned(), holds(&[1]))], planes(2)].concat();
        let deck = Deck { mesh, joint: Joint::Frictional(0.3), supports, pressure: load, young, steps: 1 };
        let folder = tempfile::tempdir().expect("a folder");
        let (_, found) = run(&deck, folder.path(), |_| {}).unwrap_or_else(|why| panic!("{why}"));
        let strain = load / young;
        let field = |[x, y, _]: Vec3| {
            let (x, y) = (x - shift[0], y - shift[1]);
            [POISSON * (1.0 + POISSON) * strain * x, -(1.0 - POISSON * POISSON) * strain * y, 0.0]
        };
        let error = difference(&found, &deck.mesh.nodes, field, strain);
        assert!(error < 10.0 * strain, "shift {shift:?}: off by {error:e}");
    }
}

/// A node that supports move on both sides slides, however little: the friction is that of Coulomb's law for any length of the slip.
#[test]
fn driven_sides_slide_however_little() {
    let force = |motion: &str| {
        let scratch = scratch_copy(&root().join("examples/thermoelastic_instability"));
        let path = scratch.path().join("ProjectParameters.json");
        let mut deck = read_json(&path).expect("the deck");
        deck["problem_data"]["end_time"] = json!(0.005);
        for list in deck["processes"].as_object_mut().expect("lists").values_mut() {
            for process in list.as_array_mut().expect("a list") {
                let parameters = &mut process["Parameters"];
                if parameters["variable_name"] == "DISPLACEMENT_X" {
                    parameters["value"] = json!(motion);
                }
                if parameters["friction_heat"].is_number() {
                    parameters["friction_heat"] = json!(0.0);
                }
            }
        }
        std::fs::write(&path, deck.to_string()).expect("the deck");
        let output = zelus(scratch.path(), &["run", "ProjectParameters.json", "--report", "run.json"]);
        assert!(output.status.success(), "{}", said(&output));
        let report = read_json(&scratch.path().join("run.json")).expect("the report");
        let steps = report["steps"].as_array().expect("steps");
        let pair = &steps[steps.len() - 1]["balance"]["pairs"][0];
        [0, 1].map(|c| pair["force"][c].as_f64().expect("a force"))
    };
    for share in [1.0, -1.0, 1e-2, -1e-2, 1e-4] {
        // On and on, and back in the second half.
        for (motion, sign) in [(format!("{}*t", 0.1 * share), -1.0), (format!("{}*t*(0.003-t)", 30.0 * share), 1.0)] {
            let [along, across] = force(&motion);
            let wanted = sign * 0.3 * across * f64::signum(share);
            assert!(across > 0.5 && (along - wanted).abs() < 1e-6 * across, "{motion}: {along}, not {wanted}");
        }
    }
}

/// A rotation by 0.5 about z, in space by 0.7 about x after it.
fn turned(space: usize, [x, y, z]: Vec3) -> Vec3 {
    let ((s, c), (t, d)) = (0.5_f64.sin_cos(), 0.7_f64.sin_cos());
    let [x, y] = [c * x - s * y, s * x + c * y];
    if space == 2 { [x, y, z] } else { [x, d * y - t * z, t * y + d * z] }
}

/// ANALYTIC: a turned column on supports along turned directions has the turned displacements: slave nodes on one or two planes of
/// symmetry, with friction, without, and tied.
#[test]
fn turned_supports_have_turned_contact() {
    let mut problems = Vec::new();
    for (space, joint) in [2, 3].into_iter().flat_map(|space| {
        [Joint::Frictional(0.3), Joint::Frictional(1.0), Joint::Frictionless, Joint::Tied].map(|joint| (space, joint))
    }) {
        for upper_is_slave in [true, false] {
            let answer = |is_turned: bool| {
                let mut mesh = column(Mesh::new(space), [3, 4], upper_is_slave, |x| 0.5 + 0.2 * (x[0] - 0.5));
                let mut supports = [vec![("Bottom".to_owned(), holds(&[space - 1]))], planes(space)].concat();
                let turn = |x: Vec3| if is_turned { turned(space, x) } else { x };
                mesh.nodes.iter_mut().for_each(|x| *x = turn(*x));
                let mut along = Vec::new();
                if is_turned {
                    along = std::mem::take(&mut supports);
                }
                let deck = Deck { mesh, joint, supports, pressure: 1e4, young: 1e9, steps: 2 };
                let folder = tempfile::tempdir().expect("a folder");
                let change = |deck: &mut Value| {
                    let lists = &mut deck["processes"];
                    for (part, value) in &along {
                        let unit = std::array::from_fn(|c| if value[c].is_null() { 0.0 } else { 1.0 });
                        let process = json!({"python_module": "assign_displacement_along_direction_process",
                            "Parameters": {"model_part_name": format!("Structure.{part}"), "direction": turn(unit)}});
                        lists["constraints_process_list"].as_array_mut().expect("a list").push(process);
                    }
                    let down: Vec3 = std::array::from_fn(|c| if c + 1 == space { -1.0 } else { 0.0 });
                    lists["loads_process_list"][0]["Parameters"]["direction"] = json!(turn(down));
                };
                run(&deck, folder.path(), change).map(|(_, found)| found)
            };
            let place = format!("{space}D, {joint:?}, upper slave {upper_is_slave}");
            match (answer(false), answer(true)) {
                (Ok(straight), Ok(oblique)) => {
                    let expected: Vec<Vec3> = straight.into_iter().map(|u| turned(space, u)).collect();
                    let size = expected.iter().flatten().fold(0.0_f64, |most, u| most.max(u.abs()));
                    let pairs = oblique.iter().zip(&expected).flat_map(|(a, b)| (0..3).map(|c| (a[c] - b[c]).abs()));
                    let off = pairs.fold(0.0, f64::max) / size;
                    println!("{place}: {off:.1e}");
                    if off.is_nan() || off > 1e-9 {
                        problems.push(format!("{place}: off by {off:e}"));
                    }
                }
                (Err(said), _) => problems.push(format!("{place}, straight: {said}")),
                (_, Err(said)) => problems.push(format!("{place}, turned: {said}")),
            }
        }
    }
    assert!(problems.is_empty(), "{} fail\n{}", problems.len(), problems.join("\n"));
}
