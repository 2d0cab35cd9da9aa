//! Bonds between surfaces: the law of a block that is pulled off, and specimens of fracture mechanics.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Map, Value, json};
use tempfile::TempDir;
use zelus::core::communication::Ranks;
use zelus::{RunOptions, Silent, Simulation};

use crate::blocks::Vec3;
use crate::scene::{Kind, Scene, held};
use crate::support::{Results, read_json, said, zelus};
use crate::thread_ranks::on_threads;

const DECK: &str = "ProjectParameters.json";
const KIND: Kind = ("PenaltyContactFrictional", "Frictional");
const STIFFNESS: [f64; 2] = [1e4, 4e3];
const STRENGTH: [f64; 2] = [30.0, 40.0];
const ENERGY: [f64; 2] = [0.3, 0.8];
const EXPONENT: f64 = 1.6;

/// The bilinear law where lengths are larger by a factor.
fn bilinear(unit: f64) -> Value {
    let ([normal, shear], energy) = (STIFFNESS.map(|k| k / unit), ENERGY.map(|g| g * unit));
    json!({"law": "bilinear", "normal_stiffness": normal, "shear_stiffness": shear, "normal_strength": STRENGTH[0],
        "shear_strength": STRENGTH[1], "normal_energy": energy[0], "shear_energy": energy[1], "mixed_mode_exponent": EXPONENT})
}

/// Writes the deck of a scene with bonds, its pairs with these coefficients of friction.
fn write(scene: &Scene, folder: &Path, law: &Value, friction: &[f64], change: &dyn Fn(&mut Value)) {
    scene.write(folder);
    let path = folder.join(DECK);
    let mut deck = read_json(&path).expect("it was written");
    let contact = &mut deck["processes"]["contact_process_list"][0];
    contact["python_module"] = json!("penalty_contact_process");
    let keyed = friction.iter().enumerate().map(|(at, mu)| (at.to_string(), json!(mu)));
    contact["Parameters"]["friction_coefficients"] = Value::Object(keyed.collect::<Map<_, _>>());
    let mut shown = vec!["DISPLACEMENT", "REACTION"];
    if !law.is_null() {
        contact["Parameters"]["cohesive"] = law.clone();
        shown.push("COHESIVE_DAMAGE");
    }
    deck["processes"]["json_output_process_list"][0]["Parameters"]["output_variables"] = json!(shown);
    change(&mut deck);
    std::fs::write(path, deck.to_string()).expect("a file");
}

/// A block on a floor, both rigid, with its motion over the time 0 to 1.
struct Pulled {
    space: usize,
    /// Turns the scene about z.
    turn: f64,
    /// Whether the floor has the slave side.
    swapped: bool,
    /// Factor of all lengths.
    unit: f64,
    /// Elements of second order.
    second_order: bool,
    steps: usize,
    /// Further parameters of the process.
    extra: &'static str,
}

const PULLED: Pulled =
    Pulled { space: 2, turn: 0.0, swapped: false, unit: 1.0, second_order: false, steps: 24, extra: "{}" };
/// Friction by direction, for bonds: their own stiffness is that of contact.
const DIRECTED: &str = r#"{"friction_direction": [3.0, 0.0, 0.0], "friction_ratio": 0.5}"#;
/// Area of the lower face of the block.
const AREA: f64 = 2.0;

/// The deck of a pulled block.
struct PulledDeck {
    folder: TempDir,
    /// Tangential and normal direction of its path.
    axes: [Vec3; 2],
    /// Nodes of the block, the first ones.
    of_block: u64,
    /// Nodes of the slave side.
    slaves: Vec<usize>,
}

impl Pulled {
    /// Writes the deck of the block on a path, tangential and normal, each a function of the time.
    fn deck(&self, law: &Value, friction: f64, path: [&str; 2]) -> PulledDeck {
        let (space, up) = (self.space, self.space - 1);
        let mut scene = Scene::new(space);
        (scene.kind, scene.steps) = (KIND, self.steps);
        let (sin, cos) = self.turn.sin_cos();
        let turned = |[x, y, z]: Vec3| [cos * x - sin * y, sin * x + cos * y, z];
        let flat = |x: Vec3| if space == 2 { [x[0], x[2], 0.0] } else { x };
        let place = |x: Vec3| turned(x).map(|c| c * self.unit);
        // The slave never leaves the master, whose nodes its edges do not meet.
        let sizes = [[[0.0, 0.0], [2.0, 1.0]], [[-1.1, -0.6], [3.2, 1.7]]];
        let [of_upper, of_lower] = if self.swapped { [sizes[1], sizes[0]] } else { sizes };
        let corners =
            |[[x, y], [to_x, to_y]]: [[f64; 2]; 2], low: f64| [flat([x, y, low]), flat([to_x, to_y, low + 1.0])];
        let block = scene.add("Block", corners(of_upper, 0.0), 3, &place);
        scene.part("Bottom", &block, &[(up, 0)]);
        if self.second_order {
            scene.mesh.raise("Block", false);
        }
        let of_block = scene.mesh.nodes.len() as u64;
        let floor = scene.add("Floor", corners(of_lower, -1.0), 4, &place);
        scene.part("Face", &floor, &[(up, 1)]);
        if self.second_order {
            scene.mesh.raise("Floor", false);
        }
        scene.pairs = vec![if self.swapped { ["Face", "Bottom"] } else { ["Bottom", "Face"] }];
        let along = turned([1.0, 0.0, 0.0]);
        let normal = turned(if space == 2 { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] });
        let motion = |c: usize| json!(format!("{:e}*({}) + {:e}*({})", along[c], path[0], normal[c], path[1]));
        let moved = std::array::from_fn(|c| if c < space { motion(c) } else { Value::Null });
        scene.supports = vec![("Floor", held(space)), ("Block", moved)];
        let folder = tempfile::tempdir().expect("a scratch folder");
        let extra: Value = serde_json::from_str(self.extra).expect("JSON");
        write(&scene, folder.path(), law, &[friction], &|deck| {
            let parameters = deck["processes"]["contact_process_list"][0]["Parameters"].as_object_mut().expect("keys");
            parameters.extend(extra.as_object().expect("keys").clone());
        });
        let slaves = if self.swapped { &floor[&(up, 1)].0 } else { &block[&(up, 0)].0 };
        PulledDeck { folder, axes: [along, normal], of_block, slaves: slaves.clone() }
    }

    /// Runs the block along a path; gives its force by step along the directions of the path, its damage, the energy that the pair has
    /// dissipated, and the force across.
    fn run(&self, law: &Value, friction: f64, path: [&str; 2]) -> Result<Vec<[f64; 5]>, String> {
        let PulledDeck { folder, axes: [along, normal], of_block, slaves } = self.deck(law, friction, path);
        let space = self.space;
        let output = zelus(folder.path(), &["run", DECK, "--threads", "1", "--report", "run.json"]);
        if !output.status.success() {
            return Err(said(&output));
        }
        let report = read_json(&folder.path().join("run.json")).expect("a report");
        let results = Results::read(&folder.path().join("results.json")).expect("results");
        let step = |at: usize| {
            let force: Vec<f64> = (0..space)
                .map(|c| {
                    let all = results.nodal(&format!("REACTION_{}", ["X", "Y", "Z"][c]), at);
                    (1..=of_block).map(|node| all[&node]).sum()
                })
                .collect();
            let part = |direction: Vec3| (0..space).map(|c| direction[c] * force[c]).sum::<f64>();
            let damages = results.nodal("COHESIVE_DAMAGE", at);
            let damage = damages.get(&(slaves[0] as u64)).copied().unwrap_or(0.0);
            assert!(
                damages.is_empty() || slaves.iter().all(|&n| (damages[&(n as u64)] - damage).abs() < 1e-9),
                "{damages:?}"
            );
            let dissipated = report["steps"][at]["balance"]["pairs"][0]["dissipated"].as_f64().expect("an energy");
            [part(along), part(normal), damage, dissipated, part([-along[1], along[0], 0.0])]
        };
        Ok((0..results.len()).map(step).collect())
    }
}

/// ANALYTIC: the bilinear law along a straight path with the parts a and b: onset, opening of failure, and energy by Benzeggagh and
/// Kenane.
fn of_path([along, normal]: [f64; 2]) -> [f64; 3] {
    let parts = [STIFFNESS[0] * normal * normal, STIFFNESS[1] * along * along];
    let mix = (parts[1] / (parts[0] + parts[1])).powf(EXPONENT);
    let [onset, energy] = [[0, 1].map(|mode: usize| 0.5 * STRENGTH[mode].powi(2) / STIFFNESS[mode]), ENERGY]
        .map(|own| own[0] + (own[1] - own[0]) * mix);
    let first = (2.0 * onset / (parts[0] + parts[1])).sqrt();
    [first, first * energy / onset, energy]
}

/// ANALYTIC: force, damage and dissipated energy of a rigid block that is pulled off along a straight path, in modes I and II and
/// mixtures, on meshes that do not match, turned, in another unit, with sides swapped, in the plane and in space. Round-off.
#[test]
fn a_block_is_pulled_off_by_the_law() {
    let cases = [
        (PULLED, [0.0, 1.0]),
        (PULLED, [1.0, 0.0]),
        (PULLED, [0.6, 0.8]),
        (Pulled { turn: 0.7, ..PULLED }, [0.6, 0.8]),
        (Pulled { space: 3, turn: 0.4, ..PULLED }, [0.8, 0.3]),
        (Pulled { swapped: true, ..PULLED }, [0.6, 0.8]),
        (Pulled { unit: 1e-3, ..PULLED }, [0.6, 0.8]),
        (Pulled { second_order: true, ..PULLED }, [0.6, 0.8]),
        (Pulled { second_order: true, space: 3, ..PULLED }, [0.6, 0.8]),
    ];
    for (pulled, path) in cases {
        let [first, last, energy] = of_path(path);
        let (way, unit) = (1.2 * last, pulled.unit);
        let area = AREA * if pulled.space == 2 { unit } else { unit * unit };
        let courses = path.map(|c| format!("{:e}*t", c * way * unit));
        let found = pulled.run(&bilinear(unit), 0.0, courses.each_ref().map(String::as_str)).expect("it runs");
        let what = format!("space {}, turned {}, along {path:?}", pulled.space, pulled.turn);
        for (at, [along, normal, damage, dissipated, _]) in found.iter().enumerate() {
            let own = way * (at + 1) as f64 / pulled.steps as f64;
            let exact = (last * (own - first) / (own * (last - first))).clamp(0.0, 1.0);
            assert!((damage - exact).abs() < 1e-10, "{what}, step {at}: {damage} {exact}");
            let right = [path[0] * STIFFNESS[1], path[1] * STIFFNESS[0]].map(|k| area * (1.0 - exact) * k * own);
            let off = (along - right[0]).abs().max((normal - right[1]).abs());
            assert!(off < 1e-10 * area * STRENGTH[0], "{what}, step {at}: {along} {normal}, {right:?}");
            if exact >= 1.0 {
                assert!(
                    (dissipated - area * energy * unit).abs() < 1e-10 * area * energy * unit,
                    "{what}: {dissipated}"
                );
            }
        }
    }
}

/// A bond that is damaged, unloads, is pressed and loaded again, follows the line to its origin until it is opened farther; ANALYTIC,
/// round-off. Damage and energy stay meanwhile.
#[test]
fn a_damaged_bond_unloads_towards_its_origin() {
    let [first, last, _] = of_path([0.0, 1.0]);
    let top = 0.4 * last;
    let path = format!("{top:e}*(4*t if t < 0.25 else (2 - 4*t if t < 0.6 else 6*t - 4))");
    let found = PULLED.run(&bilinear(1.0), 0.0, ["0", &path]).expect("it runs");
    let damage = |own: f64| (last * (own - first) / (own * (last - first))).clamp(0.0, 1.0);
    let mut largest = 0.0_f64;
    for (at, [_, normal, found, dissipated, _]) in found.iter().enumerate() {
        let t = (at + 1) as f64 / PULLED.steps as f64;
        let own = top
            * if t < 0.25 {
                4.0 * t
            } else if t < 0.6 {
                2.0 - 4.0 * t
            } else {
                6.0 * t - 4.0
            };
        largest = largest.max(damage(own.max(0.0)));
        let exact = AREA * STIFFNESS[0] * own * if own > 0.0 { 1.0 - largest } else { 1.0 };
        assert!((normal - exact).abs() < 1e-10 * AREA * STRENGTH[0], "step {at}: {normal} {exact}");
        assert!((found - largest).abs() < 1e-12, "step {at}: {found} {largest}");
        let energy = AREA * 0.5 * first * first * STIFFNESS[0] * largest * last / (last - largest * (last - first));
        assert!((dissipated - energy).abs() < 1e-10, "step {at}: {dissipated} {energy}");
    }
}

/// ANALYTIC: shear under pressure: (1 − d) K_s w + d μ p while the bond fails, μ p after it, the last force of a slider. Round-off.
#[test]
fn a_failed_bond_has_friction() {
    let [first, last, _] = of_path([1.0, 0.0]);
    let (depth, friction) = (1e-3, 0.3);
    let found = PULLED
        .run(&bilinear(1.0), friction, [&format!("{:e}*t", 1.5 * last), &format!("-{depth:e}")])
        .expect("it runs");
    let pressure = STIFFNESS[0] * depth;
    for (at, [along, normal, damage, _, _]) in found.iter().enumerate() {
        let own = 1.5 * last * (at + 1) as f64 / PULLED.steps as f64;
        let exact = (last * (own - first) / (own * (last - first))).clamp(0.0, 1.0);
        let elastic = STIFFNESS[1] * own;
        let right = AREA * ((1.0 - exact) * elastic + exact * elastic.min(friction * pressure));
        assert!((along - right).abs() < 1e-9 * AREA * STRENGTH[1], "step {at}: {along} {right}");
        assert!(
            (normal + AREA * pressure).abs() < 1e-9 * AREA * pressure && (damage - exact).abs() < 1e-10,
            "step {at}"
        );
    }
    assert!((found.last().expect("steps")[0] - AREA * friction * pressure).abs() < 1e-9);
}

/// Loading of a specimen of two arms that a layer joins.
#[derive(Clone, Copy, PartialEq)]
enum Specimen {
    /// Double cantilever beam: the ends of the arms are pulled apart.
    Cantilevers,
    /// End-notched flexure: three points, both arms on the left support.
    Flexure,
}

const YOUNG: f64 = 1e5;
const HEIGHT: f64 = 2.0;
/// Facets of the lips of a crack that touch.
const LIP: usize = 3;

/// Writes the deck of a specimen: arms of this length, joined from `crack` on, in elements of second order of length 1. Gives the node
/// that is moved.
fn specimen(specimen: Specimen, length: f64, crack: f64, deflection: f64, steps: usize) -> (TempDir, usize) {
    let mut scene = Scene::new(2);
    (scene.kind, scene.steps, scene.young, scene.poisson) = (KIND, steps, YOUNG, 0.0);
    let divisions = [length as usize, 2, 1];
    let arm = |scene: &mut Scene, name: &'static str, low: f64| {
        scene.bodies.push(name);
        scene.mesh.block(name, divisions, |x| [length * x[0], low + HEIGHT * x[1], 0.0])
    };
    let (upper, lower) = (arm(&mut scene, "Upper", 0.0), arm(&mut scene, "Lower", -HEIGHT));
    let notch = crack as usize;
    for (side, bond, lip) in [(&upper[&(1, 0)], "UpperBond", "UpperLip"), (&lower[&(1, 1)], "LowerBond", "LowerLip")] {
        let (nodes, facets) = side;
        scene.mesh.part(bond, nodes[notch..].to_vec(), facets[notch..].to_vec());
        // The arms touch above the support.
        scene.mesh.part(lip, nodes[..=LIP].to_vec(), facets[..LIP].to_vec());
    }
    let last = divisions[0];
    let of_upper = |top: usize, at: usize| upper[&(1, top)].0[at];
    let of_lower = |top: usize, at: usize| lower[&(1, top)].0[at];
    scene.pairs = vec![["UpperBond", "LowerBond"]];
    let free = Value::Null;
    let vertical = |course: String| [Value::Null, json!(course), Value::Null];
    let measured = if specimen == Specimen::Cantilevers {
        scene.mesh.part("Rear", upper[&(0, 1)].0.iter().chain(&lower[&(0, 1)].0).copied(), Vec::new());
        scene.mesh.part("UpperTip", [of_upper(0, 0)], Vec::new());
        scene.mesh.part("LowerTip", [of_lower(1, 0)], Vec::new());
        let half = 0.5 * deflection;
        scene.supports = vec![
            ("Rear", [json!(0.0), json!(0.0), free]),
            ("UpperTip", vertical(format!("{half}*t"))),
            ("LowerTip", vertical(format!("-{half}*t"))),
        ];
        of_upper(0, 0)
    } else {
        scene.pairs.push(["UpperLip", "LowerLip"]);
        scene.mesh.part("Left", [of_lower(0, 0)], Vec::new());
        scene.mesh.part("Right", [of_lower(0, last)], Vec::new());
        scene.mesh.part("Middle", [of_upper(1, last / 2)], Vec::new());
        scene.supports = vec![
            ("Left", vertical("0".to_owned())),
            ("Right", [json!(0.0), json!(0.0), free]),
            ("Middle", vertical(format!("-{deflection}*t"))),
        ];
        of_upper(1, last / 2)
    };
    scene.mesh.raise("Upper", false);
    scene.mesh.raise("Lower", false);
    let law = json!({"law": "bilinear", "normal_stiffness": 1e5, "shear_stiffness": 1e5, "normal_strength": 30.0,
        "shear_strength": 50.0, "normal_energy": ENERGY[0], "shear_energy": ENERGY[1], "mixed_mode_exponent": EXPONENT});
    let folder = tempfile::tempdir().expect("a scratch folder");
    let friction = vec![0.0; scene.pairs.len()];
    write(&scene, folder.path(), &law, &friction, &|deck| {
        let settings = &mut deck["solver_settings"];
        settings["residual_relative_tolerance"] = json!(1e-6);
        settings["contact_settings"]["contact_residual_relative_tolerance"] = json!(1e-6);
        deck["processes"]["contact_process_list"][0]["Parameters"]["cohesive_pairs"] = json!(["0"]);
    });
    (folder, measured)
}

/// Deflection and force of a [`specimen`] by step.
fn bent(kind: Specimen, length: f64, crack: f64, deflection: f64, steps: usize) -> Vec<[f64; 2]> {
    let (folder, measured) = specimen(kind, length, crack, deflection, steps);
    let output = zelus(folder.path(), &["run", DECK, "--threads", "1", "-q"]);
    assert!(output.status.success(), "{}", said(&output));
    let results = Results::read(&folder.path().join("results.json")).expect("results");
    let sign = if kind == Specimen::Cantilevers { 1.0 } else { -1.0 };
    let of = |step: usize| {
        let number = |quantity: &str| results.nodal(quantity, step)[&(measured as u64)];
        let moved = if kind == Specimen::Cantilevers { 2.0 } else { 1.0 };
        [sign * moved * number("DISPLACEMENT_Y"), sign * number("REACTION_Y")]
    };
    (0..results.len()).map(of).collect()
}

/// Compares forces with a curve of cracks, each with deflection and force, within its range; how many steps are in it.
fn compare(found: &[[f64; 2]], curve: &dyn Fn(f64) -> [f64; 2], [first, last]: [f64; 2], what: &str) -> usize {
    let mut count = 0;
    for &[deflection, force] in found {
        let (mut low, mut high) = (first, last);
        if deflection < curve(low)[0] || deflection > curve(high)[0] {
            continue;
        }
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if curve(middle)[0] < deflection { low = middle } else { high = middle }
        }
        let right = curve(low)[1];
        assert!((force - right).abs() < 0.03 * right, "{what} at {deflection}: {force}, {right}");
        count += 1;
    }
    count
}

/// ANALYTIC: forces of a double cantilever beam while its crack grows, by linear fracture mechanics: G = 12 F² a²/(E h³) and the deflection
/// 8 F a³/(E h³). 3 %: the rotation at the crack tip and the zone of softening lengthen the crack, which leaves F √δ as it is; shear of the
/// arms and the mesh remain.
#[test]
fn a_double_cantilever_beam_splits_by_fracture_mechanics() {
    let stiffness = YOUNG * HEIGHT.powi(3);
    let curve = |crack: f64| {
        let force = (ENERGY[0] * stiffness / 12.0).sqrt() / crack;
        [8.0 * force * crack.powi(3) / stiffness, force]
    };
    let found = bent(Specimen::Cantilevers, 80.0, 30.0, 3.5, 40);
    assert!(compare(&found, &curve, [35.0, 50.0], "DCB") > 15);
}

/// ANALYTIC: the same of end-notched flexure, lips in contact: G = 9 F² a²/(16 E h³), deflection F (3 a³ + 2 L³)/(8 E h³).
#[test]
fn end_notched_flexure_follows_fracture_mechanics() {
    let (stiffness, half) = (YOUNG * HEIGHT.powi(3), 100.0_f64);
    let curve = |crack: f64| {
        let force = (16.0 * ENERGY[1] * stiffness / 9.0).sqrt() / crack;
        [force * (3.0 * crack.powi(3) + 2.0 * half.powi(3)) / (8.0 * stiffness), force]
    };
    let found = bent(Specimen::Flexure, 2.0 * half, 75.0, 9.0, 30);
    assert!(compare(&found, &curve, [84.0, 97.0], "ENF") > 2);
}

/// Decks whose bonds fail while the run lasts: a specimen, and a block that is torn off while it is dragged, then pressed, with friction that
/// depends on the direction in space.
fn failing() -> Vec<(&'static str, TempDir)> {
    let way = "0.05*t";
    let lift = "0.004*t if t < 0.4 else 0.0056 - 0.01*t";
    let directed = Pulled { space: 3, turn: 0.4, steps: 12, extra: DIRECTED, ..PULLED };
    vec![
        ("cantilevers", specimen(Specimen::Cantilevers, 60.0, 30.0, 1.8, 12).0),
        ("block", Pulled { steps: 12, ..PULLED }.deck(&bilinear(1.0), 0.3, [way, lift]).folder),
        ("block in space", directed.deck(&bilinear(1.0), 0.3, [way, lift]).folder),
    ]
}

/// Changes the deck of a folder.
fn change_deck(folder: &Path, change: impl Fn(&mut Value)) {
    let mut deck = read_json(&folder.join(DECK)).expect("the deck");
    change(&mut deck);
    std::fs::write(folder.join(DECK), deck.to_string()).expect("the deck");
}

/// A run that goes on from a saved step in the middle of the failure writes the same bits as the whole run.
#[test]
fn a_restart_keeps_the_damage_of_bonds() {
    for (what, folder) in failing() {
        let folder = folder.path();
        change_deck(folder, |deck| {
            // Of 12 steps the seventh alone is saved.
            let saved =
                json!({"model_part_name": "Structure", "restart_control_type": "step", "restart_save_frequency": 7});
            deck["output_processes"] =
                json!({"saved": [{"python_module": "save_restart_process", "Parameters": saved}]});
        });
        let output = zelus(folder, &["run", DECK, "--threads", "1"]);
        assert!(output.status.success(), "{what}: {}", said(&output));
        let whole = std::fs::read(folder.join("results.json")).expect("results");
        let results = Results::read(&folder.join("results.json")).expect("results");
        let damage = |step: usize| results.nodal("COHESIVE_DAMAGE", step).into_values().sum::<f64>();
        assert!(damage(0) < damage(6) && damage(6) < damage(11), "{what}: nothing fails on both sides of the restart");
        let output = zelus(folder, &["run", DECK, "--resume", "--threads", "1"]);
        assert!(output.status.success(), "{what}: {}", said(&output));
        assert!(said(&output).contains("step 8,") && !said(&output).contains("step 7,"), "{what}: {}", said(&output));
        assert!(std::fs::read(folder.join("results.json")).expect("results") == whole, "{what}: other results");
    }
}

/// Two and three ranks give the displacements of one, and take the same iterations; round-off, which softening enlarges.
#[test]
fn bonds_over_ranks_are_those_of_one() {
    for (what, folder) in failing() {
        let run = |ranks: Ranks| {
            let options = RunOptions { threads: Some(1), ranks, ..RunOptions::default() };
            let mut simulation = Simulation::open(&folder.path().join(DECK), &options).expect("a deck");
            simulation.run(&mut Silent).expect("it converges");
            let displacement = simulation.field("DISPLACEMENT").expect("a field");
            let ids = &simulation.part().expect("a part").nodes.ids;
            let by_node: BTreeMap<usize, Vec3> =
                ids.iter().copied().zip(displacement.as_chunks().0.iter().copied()).collect();
            (by_node, simulation.records().iter().map(|step| step.iterations.len()).collect::<Vec<_>>())
        };
        let (whole, iterations) = run(Ranks::default());
        let largest = whole.values().flatten().fold(0.0_f64, |most, u| most.max(u.abs()));
        for count in [2, 3] {
            let of_ranks = on_threads(count, run);
            let nodes: usize = of_ranks.iter().map(|(found, _)| found.len()).sum();
            assert!(nodes < count * whole.len(), "{what} on {count} ranks: nothing is shared out");
            for (found, own) in of_ranks {
                assert_eq!(own, iterations, "{what} on {count} ranks");
                let difference =
                    |(id, u): (&usize, &Vec3)| u.iter().zip(whole[id]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                let off = found.iter().map(difference).fold(0.0, f64::max) / largest;
                assert!(off < 1e-10, "{what} on {count} ranks: off by {off:e}");
            }
        }
    }
}

/// ANALYTIC: a block that is pressed and dragged at an angle to the axes of friction. The slip is normal to the elliptic limit, so that
/// the traction is μ p (cos θ, ρ² sin θ)/√(cos² θ + ρ² sin² θ), and its angle has the tangent ρ² tan θ. Exact but for Newton's iteration.
#[test]
fn friction_by_direction_is_normal_to_its_ellipse() {
    let (friction, ratio, depth) = (0.4, 0.5, 1e-3);
    let extra = r#"{"friction_direction": [3.0, 0.0, 0.0], "friction_ratio": 0.5,
        "advance_ALM_parameters": {"manual_ALM": true, "penalty": 1e4}}"#;
    for angle in [0.0, 0.3, 0.9, 1.4, -0.6] {
        let pulled = Pulled { space: 3, turn: angle, steps: 4, extra, ..PULLED };
        let found = pulled.run(&Value::Null, friction, ["0.2*t", &format!("-{depth:e}")]).expect("it runs");
        let (sin, cos) = f64::sin_cos(angle);
        let size = (cos * cos + ratio * ratio * sin * sin).sqrt();
        let traction = [cos / size, ratio * ratio * sin / size].map(|part| friction * 1e4 * depth * part);
        let right = [traction[0] * cos + traction[1] * sin, traction[1] * cos - traction[0] * sin].map(|t| AREA * t);
        let [along, normal, _, dissipated, across] = found.last().expect("steps");
        assert!((along - right[0]).abs() < 1e-9 * right[0], "{angle}: {along} {}", right[0]);
        assert!((across - right[1]).abs() < 1e-9 * right[0], "{angle}: {across} {}", right[1]);
        assert!((normal + AREA * 1e4 * depth).abs() < 1e-9 * AREA * 1e4 * depth, "{normal}");
        // All of the way but the elastic slip, μ p/(K √(…)), turns into heat.
        let heat = right[0] * (0.2 - friction * depth / size);
        assert!((dissipated - heat).abs() < 1e-8 * heat, "{angle}: {dissipated} {heat}");
    }
}

/// ANALYTIC: friction that grows linearly up to the elastic slip, whatever the pressure, and stays at μ p.
#[test]
fn friction_reaches_its_limit_at_the_elastic_slip() {
    for depth in [1e-3, 4e-3] {
        let extra = r#"{"elastic_slip": 0.05, "advance_ALM_parameters": {"manual_ALM": true, "penalty": 1e4}}"#;
        let pulled = Pulled { steps: 8, extra, ..PULLED };
        let found = pulled.run(&Value::Null, 0.3, ["0.1*t", &format!("-{depth:e}")]).expect("it runs");
        for (at, [along, ..]) in found.iter().enumerate() {
            let share = (0.1 * (at + 1) as f64 / 8.0 / 0.05).min(1.0);
            let right = AREA * 0.3 * 1e4 * depth * share;
            assert!((along - right).abs() < 1e-9 * right, "step {at}: {along} {right}");
        }
    }
}

#[test]
fn mistakes_in_bonds_are_named() {
    let run = |extra: &'static str, law: Value| Pulled { steps: 1, extra, ..PULLED }.run(&law, 0.1, ["0", "0"]);
    let weak = |key: &str, value: f64| {
        let mut law = bilinear(1.0);
        law[key] = json!(value);
        law
    };
    for (extra, law, words) in [
        ("{}", weak("normal_energy", 0.04), "would fail before it is damaged"),
        ("{}", weak("shear_energy", 0.0), "\"shear_energy\" is 0"),
        ("{}", weak("shear_strength", -1.0), "shear_strength"),
        (r#"{"contact_type": "Frictionless"}"#, bilinear(1.0), "\"Frictional\""),
        (r#"{"cohesive_pairs": ["7"]}"#, bilinear(1.0), "pairs: 0"),
        (r#"{"cohesive_pairs": ["0"]}"#, Value::Null, "no law of their bonds"),
        (
            r#"{"pressure_overclosure": {"law": "table", "rows": [[0.0, 0.0], [1.0, 1.0]]}}"#,
            bilinear(1.0),
            "take one of the two out",
        ),
        (r#"{"advance_ALM_parameters": {"adapt_penalty": true}}"#, bilinear(1.0), "adapts a penalty"),
        (r#"{"friction_direction": [1.0, 0.0, 0.0]}"#, Value::Null, "model in space"),
    ] {
        let said = run(extra, law).expect_err("it is wrong");
        assert!(said.contains(words), "{extra}: {said}");
    }
}
