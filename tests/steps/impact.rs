//! Impacts keep energy and momentum and last as long as waves travel, with every implicit scheme.
//!
//! `cargo test --release --test steps impact:: -- --nocapture --test-threads 1` prints the table of docs/theory/time_integration.md.

use std::f64::consts::PI;

use crate::boxes::{Boxes, State};
use crate::support::{Results, said, zelus};
use serde_json::{Value, json};

/// E, ν, ρ: waves travel with speed 1.
const UNIT: [f64; 3] = [1.0, 0.0, 1.0];
const SPEED: f64 = 1e-3;
const GAP: f64 = 7e-5;

fn solve(boxes: &Boxes, write: impl Fn(&std::path::Path)) -> Results {
    let (results, said) = attempt(boxes, write);
    results.unwrap_or_else(|| panic!("{said}"))
}

/// Results, where the run has ended well, and the output of the program.
fn attempt(boxes: &Boxes, write: impl Fn(&std::path::Path)) -> (Option<Results>, String) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path());
    let output = zelus(folder.path(), &["run", "ProjectParameters.json", "--threads", "2"]);
    assert!(!boxes.nodes.is_empty());
    let results = || Results::read(&folder.path().join("results.json")).expect("results");
    (output.status.success().then(results), said(&output))
}

/// A bar of length 1 flies onto a rigid wall, or to and fro between two.
struct Bar {
    boxes: Boxes,
    count: usize,
    walls: usize,
}

impl Bar {
    fn new(count: usize, walls: usize) -> Self {
        let h = 1.0 / count as f64;
        let mut boxes = Boxes::new(2);
        let faces = [("y-", "Bottom"), ("y+", "Top")];
        boxes.add("Bar", [[0.0; 3], [h, 1.0, 0.0]], [1, count, 0], 0.0, &faces, |_| [0.0, -SPEED, 0.0]);
        let wall = |low: f64, high: f64| [[-h, low, 0.0], [2.0 * h, high, 0.0]];
        boxes.add("Lower", wall(-GAP - h, -GAP), [1, 1, 0], 0.0, &[("y+", "Low")], |_| [0.0; 3]);
        if walls == 2 {
            boxes.add("Upper", wall(1.0 + GAP, 1.0 + GAP + h), [1, 1, 0], 0.0, &[("y-", "Up")], |_| [0.0; 3]);
        }
        Self { boxes, count, walls }
    }

    fn run(&self, time_step: f64, end: f64, scheme: &Value) -> Results {
        let pairs = [("Bottom", "Low"), ("Top", "Up")];
        let fixed = [("Bar", [true, false, true]), ("Lower", [true; 3]), ("Upper", [true; 3])];
        let process = ("alm_contact_process", &json!({}));
        let (pairs, fixed) = (&pairs[..self.walls], &fixed[..=self.walls]);
        solve(&self.boxes, |folder| {
            self.boxes.write(folder, UNIT, pairs, fixed, [time_step, end], scheme, process);
        })
    }

    fn state(&self, results: &Results, step: Option<usize>) -> State {
        self.boxes.state("Bar", UNIT, results, step)
    }

    /// First and last time at which the bar stands on the wall.
    fn contact(&self, results: &Results) -> [f64; 2] {
        let foot = self.boxes.part("Bottom")[0] as u64 + 1;
        let stands = |step: &usize| results.nodal("DISPLACEMENT_Y", *step)[&foot] < -GAP * (1.0 - 1e-6);
        let steps: Vec<usize> = (0..results.len()).filter(stands).collect();
        let end = |step: Option<&usize>| results.times()[*step.expect("the bar touches the wall")];
        [end(steps.first()), end(steps.last())]
    }
}

fn scheme(name: &str) -> Value {
    json!({ "scheme_type": name })
}

/// ANALYTIC: waves run up the bar and back in 2L/c, and it leaves as fast as it came. Schemes with damping lose the energy of waves in
/// frequencies they do not resolve; none gains.
#[test]
fn a_bar_rebounds_with_its_energy_after_twice_the_time_of_a_wave() {
    let bar = Bar::new(50, 1);
    let h = 1.0 / bar.count as f64;
    println!("| scheme | c Δt/h | energy | momentum after | contact, L/c |\n|---|---|---|---|---|");
    for (name, loss) in [
        ("newmark", [3e-3, 3e-3, 8e-3]),
        ("generalized_alpha", [3e-3, 3e-3, 3e-3]),
        ("bossak", [3e-3, 2e-2, 4e-2]),
        ("bdf2", [5e-3, 3e-2, 6e-2]),
    ] {
        for (ratio, loss) in [0.1, 0.5, 1.0].into_iter().zip(loss) {
            let results = bar.run(ratio * h, 2.3, &scheme(name));
            let begin = bar.state(&results, None);
            let energies = (0..results.len()).map(|step| bar.state(&results, Some(step)).energy() / begin.energy());
            let (least, most) = energies.fold((1.0_f64, 1.0_f64), |(a, b), e| (a.min(e), b.max(e)));
            let end = bar.state(&results, Some(results.len() - 1));
            let [first, last] = bar.contact(&results);
            let back = -end.momentum[1] / begin.momentum[1];
            let time = last - first;
            println!("| `{name}` | {ratio} | {least:.4} to {most:.4} | {back:.4} | {time:.3} |");
            assert!(most < 1.001 && least > 1.0 - loss, "{name}, {ratio}: energy from {least} to {most}");
            assert!((time - 2.0).abs() < 0.02 + ratio * h, "{name}, {ratio}: contact for {time}");
            assert!(back > 0.95 && back < 1.0, "{name}, {ratio}: leaves with {back} of its momentum");
        }
    }
}

/// Between two walls the energy stays through twenty rebounds; the oscillation that each leaves in the bar does not add to it.
#[test]
fn energy_stays_through_twenty_rebounds() {
    let bar = Bar::new(20, 2);
    let h = 1.0 / bar.count as f64;
    let round = 2.0 + 2.0 * GAP / SPEED;
    for (name, named, ratio) in
        [("newmark", scheme("newmark"), 0.2), ("default", json!({}), 0.2), ("default", json!({}), 1.0)]
    {
        let results = bar.run(ratio * h, 20.0 * round, &named);
        let begin = bar.state(&results, None).energy();
        let energies: Vec<f64> =
            (0..results.len()).step_by(10).map(|step| bar.state(&results, Some(step)).energy() / begin).collect();
        let (least, most) = energies.iter().fold((1.0_f64, 1.0_f64), |(a, b), e| (a.min(*e), b.max(*e)));
        let sides: Vec<bool> = ["Bottom", "Top"]
            .iter()
            .flat_map(|part| {
                let node = bar.boxes.part(part)[0] as u64 + 1;
                let sign = if *part == "Bottom" { -1.0 } else { 1.0 };
                let touches = |step: usize| sign * results.nodal("DISPLACEMENT_Y", step)[&node] > GAP * (1.0 - 1e-6);
                let states: Vec<bool> = (0..results.len()).map(touches).collect();
                states.windows(2).filter(|pair| pair[0] && !pair[1]).map(|pair| pair[0]).collect::<Vec<_>>()
            })
            .collect();
        println!("{name}, {ratio}: energy from {least:.4} to {most:.4} in {} rebounds", sides.len());
        assert!(sides.len() >= 20, "{name}: {} rebounds", sides.len());
        assert!(least > 0.98 && most < 1.002, "{name}: energy from {least} to {most}");
    }
}

/// The difference without redistribution: with their own mass nodes in contact jump, and Newmark's scheme makes energy of it.
#[test]
fn without_redistribution_energy_grows() {
    let bar = Bar::new(50, 1);
    let own = json!({"scheme_type": "newmark", "contact_settings": {"contact_stabilisation": "none", "impact_energy_tolerance": 0.0}});
    let results = bar.run(0.002, 2.3, &own);
    let begin = bar.state(&results, None).energy();
    let end = bar.state(&results, Some(results.len() - 1)).energy();
    println!("newmark without redistribution: {:.2} of the energy", end / begin);
    assert!(end > 2.0 * begin, "{}", end / begin);
}

/// Two free blocks of unlike meshes, one on the skew into the other: the momentum that one loses the other gains.
#[test]
fn free_blocks_hand_on_their_momentum() {
    for dimension in [2, 3] {
        let material = [1.0, 0.3, 1.0];
        let mut boxes = Boxes::new(dimension);
        let counts = [[4, 3, 4], [3, 3, 3]];
        boxes.add("Upper", [[0.1, 0.0, 0.1], [0.9, 1.0, 0.8]], counts[0], PI / 180.0, &[("y-", "Foot")], |x| {
            [0.002 - 0.001 * x[1], -0.02 + 0.001 * x[0], if dimension == 3 { 0.001 } else { 0.0 }]
        });
        boxes.add("Lower", [[0.0, -1.02, 0.0], [1.0, -0.02, 1.0]], counts[1], 0.0, &[("y+", "Head")], |_| [0.0; 3]);
        for name in ["newmark", "bossak", "generalized_alpha", "bdf2"] {
            let process = ("alm_contact_process", &json!({}));
            let results = solve(&boxes, |folder| {
                boxes.write(folder, material, &[("Foot", "Head")], &[], [0.05, 4.0], &scheme(name), process);
            });
            let of = |step| ["Upper", "Lower"].map(|body| boxes.state(body, material, &results, step));
            let begin = of(None);
            let total = |states: &[State; 2], of: &dyn Fn(&State) -> f64| states.iter().map(of).sum::<f64>();
            let energy = total(&begin, &State::energy);
            let (mut off, mut spin, mut most) = (0.0_f64, 0.0_f64, 0.0_f64);
            for step in 0..results.len() {
                let now = of(Some(step));
                for c in 0..3 {
                    off = off.max((total(&now, &|s| s.momentum[c]) - total(&begin, &|s| s.momentum[c])).abs());
                    spin = spin.max((total(&now, &|s| s.spin[c]) - total(&begin, &|s| s.spin[c])).abs());
                }
                most = most.max(total(&now, &State::energy) / energy);
            }
            let size = begin[0].momentum[1].abs();
            let end = of(Some(results.len() - 1));
            println!(
                "{dimension}D {name}: momentum off by {:.1e}, spin by {:.1e}, energy at most {most:.4}, at the end {:.4}",
                off / size,
                spin / size,
                total(&end, &State::energy) / energy
            );
            assert!(end[1].momentum[1] / begin[0].momentum[1] > 0.3, "the lower block is not hit");
            assert!(off < 1e-10 * size, "{dimension}D {name}: momentum {off}");
            assert!(spin < 1e-2 * size, "{dimension}D {name}: spin {spin}");
            assert!(most < 1.005, "{dimension}D {name}: energy {most}");
        }
    }
}

/// Where a gap closes within a long step, the step is cut: a tenth of the time of a wave is enough.
#[test]
fn long_steps_keep_the_energy_where_gaps_close() {
    let bar = Bar::new(50, 1);
    for (name, step) in [("newmark", 0.04), ("newmark", 0.1), ("generalized_alpha", 0.04)] {
        let results = bar.run(step, 2.5, &scheme(name));
        let begin = bar.state(&results, None).energy();
        let energies = (0..results.len()).map(|step| bar.state(&results, Some(step)).energy() / begin);
        let (least, most) = energies.fold((1.0_f64, 1.0_f64), |(a, b), e| (a.min(e), b.max(e)));
        println!("{name}, steps of {step} L/c: energy from {least:.4} to {most:.4} in {} steps", results.len());
        assert!(least > 0.98 && most < 1.002, "{name}, {step}: energy from {least} to {most}");
    }
}

/// A block whose whole skin is the slave lands flat, on an edge or on a corner: without friction nothing pushes it aside.
#[test]
fn a_thrown_block_keeps_its_energy_and_its_way() {
    let blocks = [(2, 4, 0.0), (2, 4, 0.3), (3, 2, 0.0), (3, 3, 0.0), (3, 3, 0.3)];
    throw_blocks(&blocks, "alm_contact_process", &json!({}));
}

/// So it does where linear constraints are its contact.
#[test]
fn a_block_thrown_on_constraints_keeps_its_energy_and_its_way() {
    let blocks = [(2, 4, 0.0), (2, 4, 0.3), (3, 2, 0.0), (3, 3, 0.0)];
    throw_blocks(&blocks, "mpc_contact_process", &json!({"mpc_contact_settings": {"contact_type": "Frictionless"}}));
}

/// Throws blocks (dimension, elements, angle) on a ground, with contact by `process` and these settings of the solver.
fn throw_blocks(blocks: &[(usize, usize, f64)], process: &str, settings: &Value) {
    let material = [1.0, 0.3, 1.0];
    for &(dimension, count, angle) in blocks {
        let mut boxes = Boxes::new(dimension);
        let faces = ["x-", "x+", "y-", "y+", "z-", "z+"].map(|face| (face, "Skin"));
        let velocity = |_| [0.01, -0.02, 0.0];
        boxes.add("Block", [[0.0; 3], [1.0; 3]], [count; 3], angle, &faces[..2 * dimension], velocity);
        let lowest = boxes.nodes.iter().map(|x| x[1]).fold(f64::INFINITY, f64::min) - 0.001;
        let ground = [[-1.0, lowest - 1.0, -1.0], [2.0, lowest, 2.0]];
        boxes.add("Ground", ground, [3, 1, 3], 0.0, &[("y+", "Top")], |_| [0.0; 3]);
        let results = solve(&boxes, |folder| {
            let fixed = [("Ground", [true; 3])];
            boxes.write(folder, material, &[("Skin", "Top")], &fixed, [0.05, 5.0], settings, (process, &json!({})));
        });
        let state = |step| boxes.state("Block", material, &results, step);
        let begin = state(None);
        let (mut aside, mut least, mut most) = (0.0_f64, 1.0_f64, 1.0_f64);
        for step in 0..results.len() {
            let now = state(Some(step));
            let share = now.energy() / begin.energy();
            (least, most) = (least.min(share), most.max(share));
            aside = aside.max((now.momentum[0] - begin.momentum[0]).abs().max(now.momentum[2].abs()));
        }
        let end = state(Some(results.len() - 1));
        println!(
            "{process}, {dimension}D, {count} elements, turned by {angle}: energy from {least:.4} to {most:.4}, aside {aside:.1e}, \
             momentum {:?} to {:?}",
            begin.momentum, end.momentum
        );
        assert!(end.momentum[1] > -0.5 * begin.momentum[1].abs(), "the block has not landed");
        assert!(aside < 1e-10 * begin.momentum[1].abs(), "pushed aside by {aside}");
        assert!(most < 1.002 && least > 0.995, "energy from {least} to {most}");
    }
}

/// With friction a block that lands on an edge rolls on it, and friction takes energy: it pushes no node along its motion.
#[test]
fn friction_makes_no_energy_where_a_thrown_block_rolls() {
    let material = [1.0, 0.2, 1.0];
    for (dimension, count, angle) in [(2, 4, 0.0), (2, 4, 0.2), (2, 4, 0.6), (3, 2, 0.2)] {
        for friction in [0.1, 0.3, 1.0] {
            let mut boxes = Boxes::new(dimension);
            let faces = ["x-", "x+", "y-", "y+", "z-", "z+"].map(|face| (face, "Skin"));
            let velocity = |_| [0.009, -0.012, 0.0];
            boxes.add("Block", [[0.0; 3], [1.0; 3]], [count; 3], angle, &faces[..2 * dimension], velocity);
            let lowest = boxes.nodes.iter().map(|x| x[1]).fold(f64::INFINITY, f64::min) - 0.03;
            let ground = [[-2.0, lowest - 0.5, -1.0], [4.0, lowest, 2.0]];
            boxes.add("Ground", ground, [6, 1, 3], 0.0, &[("y+", "Top")], |_| [0.0; 3]);
            let contact = json!({"contact_type": "Frictional", "friction_coefficients": {"0": friction}});
            let settings = json!({"contact_settings": {"mortar_type": "ALMContactFrictional"}});
            let results = solve(&boxes, |folder| {
                let process = ("alm_contact_process", &contact);
                let fixed = [("Ground", [true; 3])];
                boxes.write(folder, material, &[("Skin", "Top")], &fixed, [0.6, 60.0], &settings, process);
            });
            let state = |step| boxes.state("Block", material, &results, step);
            let begin = state(None);
            let energies = (0..results.len()).map(|step| state(Some(step)).energy() / begin.energy());
            let (mut least, mut gain) = (1.0_f64, 0.0_f64);
            for energy in energies {
                least = least.min(energy);
                gain = gain.max(energy - least);
            }
            let end = state(Some(results.len() - 1));
            let along = end.momentum[0] / begin.momentum[0];
            println!("{dimension}D, turned by {angle}, {friction}: gain {gain:.4}, least {least:.4}, along {along:.3}");
            assert!(end.momentum[1] > 0.0, "the block has not rebounded");
            assert!(along < 0.99, "friction has not acted");
            assert!(gain < 0.02, "{dimension}D, {angle}, {friction}: {gain} of the energy is gained");
        }
    }
}

/// A block rotated by `angle` that is thrown on a coarser ground, which is the slave; the results and the output of the program.
fn coarse_slave(angle: f64, settings: &Value) -> (Boxes, (Option<Results>, String)) {
    let boxes = Boxes::thrown_on_coarse_ground(angle);
    let outcome = attempt(&boxes, |folder| boxes.write_thrown(folder, [1.0, 0.2, 1.0], 128.0, settings));
    (boxes, outcome)
}

/// A corner that goes in between the nodes of a coarser slave side makes or takes energy: no such motion passes unnoticed.
#[test]
fn energy_that_a_coarse_slave_makes_is_named() {
    let material = [1.0, 0.2, 1.0];
    let (mut refused, mut warned) = (0, 0);
    for angle in [0.09_f64, 0.21, 0.35, 0.58, 0.785] {
        // Energy alone is to speak: corners deep in the ground are refused by default.
        let (boxes, (results, said)) = coarse_slave(angle, &json!({"contact_settings": {"largest_penetration": 0.0}}));
        let Some(results) = results else {
            assert!(said.contains("from nothing") || said.contains("inside out"), "turned by {angle}: {said}");
            refused += usize::from(said.contains("from nothing"));
            continue;
        };
        let energy = |step| boxes.state("Block", material, &results, step).energy();
        let shares = (0..results.len()).map(|step| energy(Some(step)) / energy(None));
        let [least, most] = shares.fold([1.0_f64; 2], |[least, most], share| [least.min(share), most.max(share)]);
        let named = said.contains("contact-energy");
        println!("turned by {angle}: energy from {least:.4} to {most:.4}, named: {named}");
        assert!(most < 1.15, "turned by {angle}: {most} of the energy was accepted");
        assert!(
            named || (least > 0.95 && most < 1.05),
            "turned by {angle}: energy from {least} to {most}, and no word of it"
        );
        warned += usize::from(named);
    }
    assert!(refused >= 2 && warned >= 1, "{refused} refused, {warned} named");
}

/// Without a largest gain the motion that is refused by default runs, and wins energy.
#[test]
fn energy_that_a_coarse_slave_makes_is_accepted_by_name() {
    let (boxes, (results, said)) = coarse_slave(0.21, &json!({"contact_settings": {"largest_energy_gain": 0.0}}));
    let results = results.unwrap_or_else(|| panic!("{said}"));
    let energy = |step| boxes.state("Block", [1.0, 0.2, 1.0], &results, step).energy();
    let gain = energy(Some(results.len() - 1)) / energy(None);
    assert!(gain > 1.1, "energy is {gain} of that at the start");
}
