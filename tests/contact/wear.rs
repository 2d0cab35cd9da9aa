//! Wear by Archard's law against closed forms: a sliding block, a crowned pin that wears flat, a spinning ring; its volume, ranks, saved runs.

use crate::support;
use std::collections::BTreeMap;
use std::path::Path;

use crate::blocks::{Deck, Joint, Mesh, Vec3};
use crate::support::{said, zelus};
use crate::thread_ranks::on_threads;
use serde_json::{Value, json};
use tempfile::TempDir;
use zelus::contact_structural_mechanics::variables::{CONTACT_PRESSURE, CONTACT_STATUS};
use zelus::core::communication::Ranks;
use zelus::wear::variables::WEAR_DEPTH;
use zelus::{RunOptions, Silent, Simulation};

const DECK: &str = "ProjectParameters.json";
const PRESSURE: f64 = 2.0;
/// Wear by pressure and way.
const WEAR: f64 = 1e-4;

/// A block of width 1 that slides on a rigid one of width 3.
#[derive(Clone, Copy)]
struct Sliding {
    space: usize,
    simplices: bool,
    second_order: bool,
    joint: Joint,
    /// Height by which the bottom of the upper block is cut back at a place along it.
    crown: fn(f64) -> f64,
    steps: usize,
    /// Way of sliding in the run.
    way: f64,
    wear: [f64; 2],
    /// Elements along, across and up the upper block.
    cells: [usize; 3],
}

const PLANE: Sliding = Sliding {
    space: 2,
    simplices: false,
    second_order: false,
    joint: Joint::Frictionless,
    crown: |_| 0.0,
    steps: 5,
    way: 1.5,
    wear: [WEAR, 0.0],
    cells: [4, 3, 3],
};

impl Sliding {
    fn mesh(&self) -> Mesh {
        let (space, up) = (self.space, self.space - 1);
        let mut mesh = if self.simplices { Mesh::of_simplices(space) } else { Mesh::new(space) };
        let [along, across, high] = self.cells;
        let cells = |along, high| if space == 2 { [along, high, 0] } else { [along, across, high] };
        let lower = mesh.block("Lower", cells(7, 1), |x| {
            let mut at = [4.0 * x[0] - 1.0, x[1], x[2]];
            at[up] -= 1.0;
            at
        });
        let upper = mesh.block("Upper", cells(along, high), |x| {
            let mut at = x;
            at[up] += (1.0 - x[up]) * (self.crown)(x[0]);
            at
        });
        let both = [lower[&(up, 1)].clone(), upper[&(up, 0)].clone()];
        mesh.part("Slave", both[1].0.clone(), both[1].1.clone());
        mesh.part(
            "Interface",
            both.iter().flat_map(|side| side.0.clone()),
            both.iter().flat_map(|side| side.1.clone()).collect(),
        );
        let mut tops = upper[&(up, 1)].clone();
        mesh.part("Top", std::mem::take(&mut tops.0), tops.1);
        if self.second_order {
            mesh.raise("Upper", false);
        }
        mesh
    }

    /// The deck in a folder; the laws of wear are those of slave and master.
    fn write(&self, folder: &Path, change: impl FnOnce(&mut Value)) {
        let slides = json!(format!("{}*t", self.way));
        let held = json!(0.0);
        let upper =
            if self.space == 2 { [slides, json!(null), held.clone()] } else { [slides, held.clone(), json!(null)] };
        let still = [held.clone(), held.clone(), held];
        let deck = Deck {
            mesh: self.mesh(),
            joint: self.joint,
            supports: vec![("Lower".to_owned(), still), ("Upper".to_owned(), upper)],
            pressure: PRESSURE,
            young: 1e3,
            steps: self.steps,
        };
        deck.write(folder, |deck| {
            deck["processes"]["wear"] = json!([self.process()]);
            change(deck);
        });
    }

    fn process(&self) -> Value {
        let law = |factor: f64| match factor {
            0.0 => json!([]),
            _ => json!([{"law": "archard", "wear_coefficient": 50.0 * factor, "hardness": 50.0}]),
        };
        json!({"python_module": "wear_process", "Parameters": {"model_part_name": "Structure",
            "contact_model_part": {"0": ["Interface"]}, "assume_master_slave": {"0": ["Slave"]},
            "wear_of_slave": law(self.wear[0]), "wear_of_master": law(self.wear[1])}})
    }

    fn run(&self, change: impl FnOnce(&mut Value)) -> (TempDir, Worn) {
        let scratch = tempfile::tempdir().expect("a scratch folder");
        self.write(scratch.path(), change);
        let worn = worn(scratch.path(), Ranks::default());
        (scratch, worn)
    }
}

/// Wear of a run.
#[derive(Debug, PartialEq)]
struct Worn {
    /// Depth by node id, of nodes that this rank has.
    depths: BTreeMap<usize, f64>,
    /// Pressure of contact on slave nodes in the end.
    pressures: BTreeMap<usize, f64>,
    /// Places of the unloaded bodies at the start and in the end.
    places: BTreeMap<usize, [Vec3; 2]>,
    /// Volumes that slaves and masters have lost in each step.
    steps: Vec<[f64; 2]>,
}

fn open(folder: &Path, ranks: Ranks) -> Simulation {
    let options = RunOptions { threads: Some(1), ranks, ..RunOptions::default() };
    Simulation::open(&folder.join(DECK), &options).expect("a deck")
}

fn worn(folder: &Path, ranks: Ranks) -> Worn {
    let mut simulation = open(folder, ranks);
    simulation.prepare(&mut Silent).expect("a deck that is right");
    let places = |simulation: &Simulation| {
        let nodes = &simulation.part().expect("a part").nodes;
        nodes.ids.iter().copied().zip(nodes.initial.iter().copied()).collect::<BTreeMap<usize, Vec3>>()
    };
    let start = places(&simulation);
    simulation.run(&mut Silent).expect("it converges");
    let nodes = &simulation.part().expect("a part").nodes;
    let of_nodes = |variable| nodes.ids.iter().copied().zip(nodes.values.values(variable, 0).iter().copied()).collect();
    let status: BTreeMap<usize, f64> = of_nodes(&CONTACT_STATUS);
    let (depths, mut pressures) = (of_nodes(&WEAR_DEPTH), of_nodes(&CONTACT_PRESSURE));
    pressures.retain(|id, _| status[id] >= 0.0);
    let end = places(&simulation);
    let number = |record: &zelus::core::strategies::StepRecord, name: &str| {
        record.interactions.iter().find(|(own, _)| own == name).unwrap_or_else(|| panic!("no {name}")).1
    };
    let of_sides = |record| [number(record, "worn_from_slaves"), number(record, "worn_from_masters")];
    let records = simulation.records().iter().filter(|record| record.converged);
    Worn {
        depths,
        pressures,
        places: start.iter().map(|(id, x)| (*id, [*x, end[id]])).collect(),
        steps: records.map(of_sides).collect(),
    }
}

fn near(found: f64, exact: f64, tolerance: f64, what: &str) {
    assert!((found - exact).abs() <= tolerance * exact.abs(), "{what}: {found} {exact}");
}

impl Worn {
    fn total(&self, side: usize) -> f64 {
        self.steps.iter().map(|sides| sides[side]).sum()
    }

    /// Nodes at the bottom of the upper block, with their depths, and places before and after.
    fn bottom(&self, up: usize, crown: fn(f64) -> f64) -> Vec<(f64, [Vec3; 2])> {
        let at_bottom = |(id, [start, _]): &(&usize, &[Vec3; 2])| {
            (start[up] - crown(start[0])).abs() < 1e-9 && self.depths[*id] > 0.0
        };
        self.places.iter().filter(at_bottom).map(|(id, places)| (self.depths[id], *places)).collect()
    }
}

/// The depth of a block under a constant pressure is k p s, and so is the change of its shape.
#[test]
fn a_sliding_block_wears_by_pressure_and_way() {
    let space = Sliding { space: 3, cells: [3, 2, 2], ..PLANE };
    for sliding in [
        PLANE,
        Sliding { simplices: true, ..PLANE },
        Sliding { second_order: true, ..PLANE },
        space,
        Sliding { simplices: true, ..space },
        Sliding { simplices: true, second_order: true, ..space },
    ] {
        let (_folder, worn) = sliding.run(|_| {});
        let what = format!("{} {} {}", sliding.space, sliding.simplices, sliding.second_order);
        let depth = WEAR * PRESSURE * sliding.way;
        // Pressures of contact between cut facets in space are the mean one to 1e-3, else to the last digits.
        let tolerance = if sliding.space == 3 && sliding.simplices { 2e-3 } else { 1e-10 };
        near(worn.total(0), depth, tolerance, &what);
        assert_eq!(worn.total(1), 0.0);
        let bottom: Vec<_> =
            worn.bottom(sliding.space - 1, |_| 0.0).into_iter().filter(|(depth, _)| *depth > 0.0).collect();
        assert!(bottom.len() > 4, "{what}: {}", bottom.len());
        for (own, [start, end]) in bottom {
            near(own, depth, tolerance.max(1e-9), &what);
            near(end[sliding.space - 1] - start[sliding.space - 1], depth, tolerance.max(1e-9), &what);
        }
    }
}

/// Volumes of slave and master are each their coefficient times force and way, whatever the method of contact.
#[test]
fn every_method_wears_the_volume_of_its_force() {
    let shared = Sliding { wear: [WEAR, 0.5 * WEAR], ..PLANE };
    let exact = PRESSURE * PLANE.way;
    for (mortar, frictional) in [
        ("ALMContactFrictionless", false),
        ("ALMContactFrictionlessComponents", false),
        ("PenaltyContactFrictionless", false),
        ("ALMContactFrictional", true),
        ("PenaltyContactFrictional", true),
    ] {
        let joint = if frictional { Joint::Frictional(0.1) } else { Joint::Frictionless };
        let (_folder, worn) = Sliding { joint, ..shared }.run(|deck| {
            deck["solver_settings"]["contact_settings"]["mortar_type"] = json!(mortar);
            let process = &mut deck["processes"]["contact_process_list"][0];
            if mortar.ends_with("Components") {
                process["Parameters"]["contact_type"] = json!("FrictionlessComponents");
            }
            if mortar.starts_with("Penalty") {
                process["python_module"] = json!("penalty_contact_process");
            }
        });
        // Where the master wears beside the block it slopes: by so much more presses across than along the force.
        near(worn.total(0), WEAR * exact, 1e-5, mortar);
        near(worn.total(1), 0.5 * worn.total(0), 1e-12, mortar);
        assert!(worn.depths.values().all(|depth| *depth >= 0.0), "{mortar}");
    }
}

/// A crowned pin wears until its pressure is uniform: then its bottom is flat, and its mean depth k p s.
#[test]
fn a_crowned_pin_wears_flat() {
    let crown = |x: f64| 4e-3 * (x - 0.5) * (x - 0.5);
    let pin = Sliding { crown, steps: 100, way: 1.5, wear: [10.0 * WEAR, 0.0], cells: [10, 1, 4], ..PLANE };
    let (_folder, worn) = pin.run(|deck| {
        // The motion is short; the rest of the way is across the plane.
        deck["processes"]["wear"][0]["Parameters"]["sliding_speed"] = json!(5.0);
    });
    let way = 5.0_f64.hypot(1.5);
    let mean = 10.0 * WEAR * PRESSURE * way;
    near(worn.total(0), mean, 1e-4, "volume");
    let bottom = worn.bottom(1, crown);
    assert_eq!(bottom.len(), 11);
    // The crown cuts back as much over the width of the bottom as one twelfth of its curvature, on straight facets a little more.
    let lacking =
        bottom.windows(2).map(|two| 0.05 * two.iter().map(|(_, [start, _])| start[1]).sum::<f64>()).sum::<f64>();
    for (depth, [start, end]) in bottom {
        near(end[1], mean + lacking, 1e-3, "the bottom is flat");
        near(depth, mean + lacking - start[1], 1e-3, "depth");
    }
}

/// A ring that spins on a disc wears until depths are uniform, as in a clutch: p r = F/(2π (b − a)).
#[test]
fn a_spinning_ring_comes_to_uniform_wear() {
    let (inner, outer, spin) = (1.0, 2.0, 6.0);
    let cells = 12;
    let mut mesh = Mesh::new(2);
    let lower = mesh.block("Lower", [12, 1, 0], |x| [0.5 + 2.0 * x[0], x[1] - 1.0, 0.0]);
    let upper = mesh.block("Upper", [cells, 6, 0], |x| [inner + (outer - inner) * x[0], 1.5 * x[1], 0.0]);
    let both = [lower[&(1, 1)].clone(), upper[&(1, 0)].clone()];
    mesh.part("Slave", both[1].0.clone(), both[1].1.clone());
    let facets = both.iter().flat_map(|side| side.1.clone()).collect();
    mesh.part("Interface", both.iter().flat_map(|side| side.0.clone()), facets);
    mesh.part("Top", upper[&(1, 1)].0.clone(), upper[&(1, 1)].1.clone());
    let held = json!(0.0);
    let supports = vec![("Lower".to_owned(), [held.clone(), held.clone(), held])];
    let (steps, factor, pressure) = (1200, 60.0 * WEAR, 0.5);
    let deck = Deck { mesh, joint: Joint::Frictionless, supports, pressure, young: 1e3, steps };
    let scratch = tempfile::tempdir().expect("a scratch folder");
    deck.write(scratch.path(), |deck| {
        deck["processes"]["contact_process_list"][0]["Parameters"]["alternative_formulations"] =
            json!({"axisymmetric": true});
        let mut wear = Sliding { wear: [factor, 0.0], ..PLANE }.process();
        wear["Parameters"]["axisymmetric"] = json!(true);
        wear["Parameters"]["sliding_speed"] = json!(format!("{spin}*x"));
        deck["processes"]["wear"] = json!([wear]);
    });
    support::change(scratch.path(), "mesh.mdpa", "SmallDisplacementElement2D4N", "AxisymSmallDisplacementElement2D4N");
    support::change(scratch.path(), "mesh.mdpa", "LineLoadCondition2D2N", "AxisymLineLoadCondition2D2N");
    support::change(
        scratch.path(),
        "StructuralMaterials.json",
        "LinearElasticPlaneStrain2DLaw",
        "LinearElasticAxisym2DLaw",
    );
    let worn = worn(scratch.path(), Ranks::default());
    let force = pressure * std::f64::consts::PI * (outer * outer - inner * inner);
    // Every point has the same p r, hence the same rate k ω p r.
    let rate = factor * spin * force / (std::f64::consts::TAU * (outer - inner)) / steps as f64;
    let volume = rate * std::f64::consts::PI * (outer * outer - inner * inner);
    near(worn.steps[steps - 1][0], volume, 1e-3, "volume of the last step");
    let mean = force / (std::f64::consts::TAU * (outer - inner));
    assert_eq!(worn.bottom(1, |_| 0.0).len(), cells + 1);
    for (id, pressure) in worn.pressures.iter().filter(|(_, pressure)| **pressure > 0.0) {
        let radius = worn.places[id][0][0];
        // At the rims a node stands for half as much; pressures of the last nodes swing about the mean by 2 %.
        let tolerance = if (1.2..1.8).contains(&radius) { 2e-3 } else { 3e-2 };
        near(pressure * radius, mean, tolerance, "p r");
    }
}

/// Ranks wear as one process does.
#[test]
fn ranks_wear_alike() {
    let shared = Sliding { wear: [WEAR, 0.5 * WEAR], crown: |x| 1e-3 * x, joint: Joint::Frictional(0.1), ..PLANE };
    let (folder, whole) = shared.run(|_| {});
    for count in [2, 3] {
        for own in on_threads(count, |ranks| worn(folder.path(), ranks)) {
            for (a, b) in own.steps.iter().flatten().zip(whole.steps.iter().flatten()) {
                near(*a, *b, 1e-9, "volume");
            }
            let most = whole.depths.values().fold(0.0, |most: f64, depth| most.max(*depth));
            for (id, depth) in &own.depths {
                assert!((depth - whole.depths[id]).abs() < 1e-9 * most, "node {id} of {count} ranks");
            }
        }
    }
}

/// A run that is saved after each step and goes on comes to the same bits.
#[test]
fn saved_runs_keep_the_worn_shape() {
    let shared = Sliding { wear: [WEAR, 0.5 * WEAR], crown: |x| 1e-3 * x, joint: Joint::Frictional(0.1), ..PLANE };
    let (folder, whole) = shared.run(|_| {});
    let bits = |simulation: &Simulation| -> Vec<u64> {
        let nodes = &simulation.part().expect("a part").nodes;
        let places = nodes.initial.as_flattened().iter().chain(nodes.current.as_flattened());
        places.chain(nodes.values.values(&WEAR_DEPTH, 0)).map(|x| x.to_bits()).collect()
    };
    let mut straight = open(folder.path(), Ranks::default());
    straight.run(&mut Silent).expect("it converges");
    let file = folder.path().join("saved.rest");
    let mut simulation = open(folder.path(), Ranks::default());
    for _ in 0..shared.steps - 1 {
        assert!(simulation.step(&mut Silent).expect("it converges"));
        simulation.save(&file).expect("a saved run");
        simulation = open(folder.path(), Ranks::default());
        simulation.load(&file, &mut Silent).expect("the same deck");
    }
    simulation.run(&mut Silent).expect("it converges");
    assert!(bits(&simulation) == bits(&straight), "another shape");
    assert_eq!(simulation.records().len(), whole.steps.len());
}

#[test]
fn what_is_wrong_is_said() {
    let says = |sliding: Sliding, change: fn(&mut Value), code: i32, words: &[&str]| {
        let scratch = tempfile::tempdir().expect("a scratch folder");
        sliding.write(scratch.path(), |deck| change(&mut deck["processes"]["wear"][0]["Parameters"]));
        let output = zelus(scratch.path(), &["run", DECK]);
        assert_eq!(output.status.code(), Some(code), "{}", said(&output));
        words.iter().for_each(|word| assert!(said(&output).contains(word), "{word}: {}", said(&output)));
    };
    says(Sliding { wear: [0.0; 2], ..PLANE }, |_| (), 2, &["neither side has a law of wear"]);
    says(PLANE, |own| own["wear_of_slave"][0]["law"] = json!("archrad"), 2, &["archard"]);
    says(PLANE, |own| own["wear_of_slave"] = json!([{"law": "archard"}]), 2, &["wear_coefficient"]);
    says(PLANE, |own| own["largest_share"] = json!(1.5), 2, &["largest_share"]);
    says(PLANE, |own| own["assume_master_slave"]["0"] = json!(["Interface"]), 2, &["slave"]);
    let much = Sliding { wear: [0.1, 0.0], ..PLANE };
    says(much, |_| (), 3, &["would have lost", "largest_share", "mesh the worn bodies anew"]);
    says(Sliding { wear: [0.02, 0.0], ..PLANE }, |_| (), 0, &["pressures may swing", "times shorter"]);
}
