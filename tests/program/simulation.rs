//! The library: decks step by step, fields between steps, processes of the caller, several simulations side by side.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use crate::support::root;
use serde_json::{Value, json};
use zelus::core::analysis::{Driver, LoopPoint};
use zelus::core::assembly::System;
use zelus::core::model::Model;
use zelus::core::parameters::Node;
use zelus::core::processes::Process;
use zelus::{Error, Result, RunOptions, Silent, Simulation};

fn folder() -> PathBuf {
    root().join("tests/cases/contact_2d/matching")
}

/// The deck without its output, in `steps` steps, with a part of its load.
fn deck(steps: usize, share: f64) -> Value {
    let text = std::fs::read_to_string(folder().join("ProjectParameters.json")).expect("the deck");
    let mut deck: Value = serde_json::from_str(&text).expect("JSON");
    deck["problem_data"]["end_time"] = json!(1.0);
    deck["solver_settings"]["time_stepping"] = json!({"time_step": 1.0 / steps as f64});
    deck["processes"].as_object_mut().expect("lists").remove("json_output_process_list");
    let load = &mut deck["processes"]["loads_process_list"][0]["Parameters"]["modulus"];
    *load = json!(format!("{}*t", share * load.as_f64().expect("a number")));
    deck
}

fn simulation(steps: usize, share: f64) -> Simulation {
    let options = RunOptions { threads: Some(1), ..RunOptions::default() };
    Simulation::of_value(&deck(steps, share), &folder(), &options).expect("a deck")
}

fn displacement(simulation: &Simulation) -> Vec<f64> {
    simulation.field("DISPLACEMENT").expect("a field").to_vec()
}

#[test]
fn steps_end_where_the_whole_run_does() {
    let mut whole = simulation(4, 1.0);
    assert!(whole.part().is_none() && whole.time().is_none());
    whole.run(&mut Silent).expect("a run");
    let mut stepped = simulation(4, 1.0);
    let mut times = Vec::new();
    while stepped.step(&mut Silent).expect("a step") {
        times.push(stepped.time().expect("a stage"));
    }
    assert_eq!(times, [0.25, 0.5, 0.75, 1.0]);
    assert_eq!(displacement(&stepped), displacement(&whole));
    assert!(displacement(&whole).iter().any(|u| *u != 0.0));
    assert!(stepped.report().converged && whole.report().converged);
    assert_eq!(stepped.records().len(), 4);
    assert!(!stepped.step(&mut Silent).expect("the end"), "there is no step after the last");
}

#[test]
fn simulations_side_by_side_know_nothing_of_each_other() {
    let alone = [1.0, 0.5].map(|share| {
        let mut simulation = simulation(3, share);
        simulation.run(&mut Silent).expect("a run");
        displacement(&simulation)
    });
    let mut both = [1.0, 0.5].map(|share| simulation(3, share));
    for _ in 0..3 {
        both.iter_mut().for_each(|simulation| assert!(simulation.step(&mut Silent).expect("a step")));
    }
    assert_eq!(both.each_ref().map(displacement), alone);
    assert_ne!(alone[0], alone[1]);
}

/// Notes the calls of a process.
struct Clock(std::sync::Arc<std::sync::Mutex<Vec<&'static str>>>);

impl Process for Clock {
    fn begin_step(&mut self, _model: &mut Model) -> zelus::Result<()> {
        self.0.lock().expect("no one panics").push("begin");
        Ok(())
    }

    fn finalize(&mut self, _model: &mut Model) -> zelus::Result<()> {
        self.0.lock().expect("no one panics").push("end");
        Ok(())
    }
}

#[test]
fn processes_of_the_caller_act_and_come_to_their_end() {
    let calls = std::sync::Arc::default();
    let mut simulation = simulation(5, 1.0);
    simulation.add_process(Box::new(Clock(std::sync::Arc::clone(&calls))));
    for _ in 0..2 {
        assert!(simulation.step(&mut Silent).expect("a step"));
    }
    simulation.finish().expect("an end");
    assert_eq!(*calls.lock().expect("no one panics"), ["begin", "begin", "end"]);
    assert!(!simulation.report().converged, "three steps are missing");
    assert!(!simulation.step(&mut Silent).expect("the end"));
    assert!(displacement(&simulation).iter().any(|u| *u != 0.0), "fields can be read at the end");
}

/// Values written to a field are the start of the next step: a start at the solution needs only the iteration that detects it.
#[test]
fn the_next_step_begins_with_what_was_written() {
    let mut known = simulation(1, 1.0);
    known.run(&mut Silent).expect("a run");
    let answer = displacement(&known);
    let mut begun = simulation(1, 1.0);
    begun.prepare(&mut Silent).expect("a deck");
    assert_eq!(begun.time(), Some(0.0));
    begun.field_mut("DISPLACEMENT").expect("a field").copy_from_slice(&answer);
    begun.run(&mut Silent).expect("a run");
    let far = displacement(&begun).iter().zip(&answer).fold(0.0_f64, |far, (a, b)| far.max((a - b).abs()));
    let size = answer.iter().fold(0.0_f64, |size, u| size.max(u.abs()));
    assert!(far < 1e-9 * size, "{far} of {size}");
    assert_ne!(begun.records()[0].iterations[0].checks, known.records()[0].iterations[0].checks);
}

#[test]
fn errors_are_values() {
    let mut wrong = deck(1, 1.0);
    wrong["processes"]["loads_process_list"][0]["Parameters"]["model_part_name"] = json!("Structure.Nowhere");
    let mut simulation = Simulation::of_value(&wrong, &folder(), &RunOptions::default()).expect("a deck");
    let problems = match simulation.step(&mut Silent) {
        Err(Error::Input(problems)) => problems,
        other => panic!("a part that is not there gives {other:?}"),
    };
    assert!(problems.iter().any(|problem| problem.to_string().contains("Nowhere")), "{problems:?}");
    assert!(Simulation::open(Path::new("no/such/deck.json"), &RunOptions::default()).is_err());
}

/// Notes the points of the loop, does nothing at one of them, and makes the processes named "counting".
struct Noting {
    points: Arc<Mutex<Vec<LoopPoint>>>,
    leaves_out: Option<LoopPoint>,
    counts: Arc<Mutex<usize>>,
}

impl Driver for Noting {
    fn process(&mut self, entry: &Node, _model: &mut Model) -> Result<Option<Box<dyn Process>>> {
        let is_own = entry.get("python_module").and_then(Node::as_str) == Some("counting");
        let count = Arc::clone(&self.counts);
        Ok(is_own.then(|| Box::new(Counting(count)) as Box<dyn Process>))
    }

    fn at(
        &mut self,
        point: LoopPoint,
        root: &str,
        model: &mut Model,
        _system: &System,
        act: &mut dyn FnMut(&mut Model) -> Result<()>,
    ) -> Result<()> {
        assert_eq!(root, "Structure");
        self.points.lock().expect("one thread").push(point);
        if self.leaves_out == Some(point) { Ok(()) } else { act(model) }
    }
}

struct Counting(Arc<Mutex<usize>>);

impl Process for Counting {
    fn begin_step(&mut self, _model: &mut Model) -> Result<()> {
        *self.0.lock().expect("one thread") += 1;
        Ok(())
    }
}

#[test]
fn a_driver_makes_processes_and_decides_when_the_stage_acts() {
    let run = |leaves_out: Option<LoopPoint>| {
        let mut deck = deck(2, 1.0);
        deck["processes"]["own"] = json!([{"python_module": "counting", "Parameters": {}}]);
        let (points, counts) = (Arc::default(), Arc::default());
        let mut simulation = Simulation::of_value(&deck, &folder(), &RunOptions::default()).expect("a deck");
        let driver = Noting { points: Arc::clone(&points), leaves_out, counts: Arc::clone(&counts) };
        simulation.set_driver(Box::new(driver));
        simulation.run(&mut Silent).expect("a run");
        let moved = displacement(&simulation).iter().any(|u| *u != 0.0);
        (points.lock().expect("one thread").clone(), *counts.lock().expect("one thread"), moved)
    };
    let step = [LoopPoint::BeginStep, LoopPoint::EndStep, LoopPoint::Output];
    let all = [&[LoopPoint::Read, LoopPoint::Ready, LoopPoint::BeforeLoop][..], &step, &step, &[LoopPoint::Finalize]]
        .concat();
    assert_eq!(run(None), (all.clone(), 2, true));
    // nothing loads the bodies then
    assert_eq!(run(Some(LoopPoint::BeginStep)), (all, 0, false));
}
