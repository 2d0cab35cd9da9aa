//! Heat between two bars in contact, against closed forms: series of resistances, gas, radiation, a gap that heat closes.

use crate::blocks::{Deck, Joint, Mesh};
use crate::support::{Results, change, read_json, root, said, scratch_copy, zelus};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::Path;

const LENGTHS: [f64; 2] = [1.0, 0.5];
const CONDUCTIVITIES: [f64; 2] = [10.0, 2.0];

/// Two bars end to end along a line, the ends held at 400 and 300.
#[derive(Clone, Copy)]
struct Bars {
    space: usize,
    simplices: bool,
    gap: f64,
    /// Turn about z.
    angle: f64,
    /// Elements across the bars, from which those along them follow.
    across: [usize; 2],
    /// Temperature of the first bar's far end.
    hot: f64,
    /// Growth of the gap across the bars.
    slope: f64,
    /// Shape of the bodies.
    form: Form,
    /// The part that is the slave.
    slave: &'static str,
}

/// Shape of the bodies: bars, quarters of rings around each other, or bodies of revolution around each other.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    Bars,
    Rings,
    Revolution,
}

/// Inner radius of bodies that are round.
const INNER: f64 = 1.0;

const PLANE: Bars = Bars {
    space: 2,
    simplices: false,
    gap: 0.0,
    angle: 0.0,
    across: [2, 3],
    hot: 400.0,
    slope: 0.0,
    form: Form::Bars,
    slave: "SecondFace",
};

impl Bars {
    fn mesh(&self) -> Mesh {
        let mut mesh = if self.simplices { Mesh::of_simplices(self.space) } else { Mesh::new(self.space) };
        let (sin, cos) = self.angle.sin_cos();
        for (at, name) in ["First", "Second"].into_iter().enumerate() {
            let begin = if at == 0 { 0.0 } else { LENGTHS[0] + self.gap };
            let place = |x: [f64; 3]| {
                let length = LENGTHS[at] - if at == 0 { self.slope * x[1] } else { 0.0 };
                let (along, up) = (begin + length * x[0], x[1]);
                let (sin, cos, along, up) = match self.form {
                    Form::Bars => (sin, cos, along, up),
                    Form::Rings => ((FRAC_PI_2 * up).sin(), (FRAC_PI_2 * up).cos(), INNER + along, 0.0),
                    Form::Revolution => (1.0, 0.0, INNER + along, up),
                };
                [cos * along - sin * up, sin * along + cos * up, x[2]]
            };
            let across = self.across[at];
            let sides = mesh.block(name, [3, across, across], place);
            let [near, far] = [(0, at), (0, 1 - at)].map(|side| sides[&side].clone());
            mesh.part(&format!("{name}End"), near.0, near.1);
            mesh.part(&format!("{name}Face"), far.0, far.1);
        }
        mesh
    }

    fn material(&self, at: usize) -> Value {
        json!({"model_part_name": format!("Heat.{}", ["First", "Second"][at]), "properties_id": at + 1, "Material": {
            "Variables": {"DENSITY": 1.0, "SPECIFIC_HEAT": 1.0, "CONDUCTIVITY": CONDUCTIVITIES[at]}, "Tables": {}}})
    }

    fn solver(&self) -> Value {
        let mut solver = json!({"solver_type": "stationary", "model_part_name": "Heat", "domain_size": self.space, "echo_level": 0,
            "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
            "material_import_settings": {"materials_filename": "heat.json"}, "time_stepping": {"time_step": 1e12},
            "residual_relative_tolerance": 1e-12});
        if self.form == Form::Revolution {
            let names = json!({"element_name": "AxisymmetricEulerianConvectionDiffusion", "condition_name": "AxisymmetricThermalFace"});
            solver["element_replace_settings"] = names;
        }
        solver
    }

    fn processes(&self, laws: &Value) -> Vec<Value> {
        let hold = |part: &str, value: &Value| {
            json!({"python_module": "assign_scalar_variable_process", "Parameters": {"model_part_name": format!("Heat.{part}"),
                "variable_name": "TEMPERATURE", "value": value, "interval": [0.0, "End"]}})
        };
        let start = json!({"python_module": "assign_scalar_variable_process", "Parameters": {"model_part_name": "Heat",
            "variable_name": "TEMPERATURE", "value": 300.0, "constrained": false, "interval": [0.0, 0.0]}});
        let contact = json!({"python_module": "thermal_contact_process", "Parameters": {"model_part_name": "Heat",
            "contact_model_part": {"0": ["FirstFace", "SecondFace"]}, "assume_master_slave": {"0": [self.slave]},
            "conductance": laws, "axisymmetric": self.form == Form::Revolution}});
        let output = json!({"python_module": "json_output_process", "Parameters": {"model_part_name": "Heat",
            "output_file_name": "results.json", "output_variables": ["TEMPERATURE", "REACTION_FLUX"], "time_frequency": 0.0}});
        vec![start, hold("FirstEnd", &json!(self.hot)), hold("SecondEnd", &json!(300.0)), contact, output]
    }

    fn write(&self, folder: &Path, deck: &Value) {
        std::fs::write(folder.join("mesh.mdpa"), self.mesh().text(&[])).expect("the mesh");
        let materials = json!({"properties": [self.material(0), self.material(1)]});
        for (name, value) in [("heat.json", &materials), ("ProjectParameters.json", deck)] {
            std::fs::write(folder.join(name), value.to_string()).expect("a file");
        }
    }

    fn deck(&self, laws: &Value) -> Value {
        json!({"problem_data": {"problem_name": "bars", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0,
            "end_time": 1e12}, "solver_settings": self.solver(), "processes": {"list": self.processes(laws)}})
    }

    /// Heat that supports feed and take up, with the heat from slaves to masters of the report.
    fn run(&self, laws: &Value) -> ([f64; 2], f64) {
        let scratch = tempfile::tempdir().expect("a scratch folder");
        self.write(scratch.path(), &self.deck(laws));
        let output = zelus(scratch.path(), &["run", "ProjectParameters.json", "--report", "report.json"]);
        assert!(output.status.success(), "{}", said(&output));
        let results = Results::read(&scratch.path().join("results.json")).expect("results");
        let report = read_json(&scratch.path().join("report.json")).expect("the report");
        (fed(&results, results.len() - 1), passed(&report, 0))
    }
}

/// Heat that enters at supports, and that leaves there.
fn fed(results: &Results, step: usize) -> [f64; 2] {
    let all = results.nodal("REACTION_FLUX", step);
    [1.0, -1.0].map(|sign| all.values().map(|value| (sign * value).max(0.0)).sum())
}

/// Heat from slaves to masters in a step, from the report.
fn passed(report: &Value, step: usize) -> f64 {
    number(report, step, "heat_from_slaves")
}

fn number(report: &Value, step: usize, name: &str) -> f64 {
    let numbers = report["steps"][step]["interactions"].as_array().expect("numbers of the interactions");
    let own = numbers.iter().find(|pair| pair[0] == name).unwrap_or_else(|| panic!("no {name}"));
    own[1].as_f64().expect("a number")
}

/// Heat by area through both bars and a contact of this resistance.
fn series(resistance: f64) -> f64 {
    100.0 / (LENGTHS[0] / CONDUCTIVITIES[0] + resistance + LENGTHS[1] / CONDUCTIVITIES[1])
}

fn check(bars: &Bars, laws: &Value, exact: f64) {
    let ([enters, leaves], passes) = bars.run(laws);
    assert!((enters - exact).abs() < 1e-9 * exact, "{enters} {exact}");
    assert!((enters - leaves).abs() < 1e-9 * exact, "{enters} {leaves}");
    // The second bar is the slave, and heat comes from the first.
    assert!((passes + exact).abs() < 1e-9 * exact, "{passes} {exact}");
}

#[test]
fn resistances_of_bars_and_contact_add_up() {
    let laws = json!([{"law": "constant", "conductance": 20.0}]);
    let space = Bars { space: 3, ..PLANE };
    for bars in [
        PLANE,
        Bars { simplices: true, ..PLANE },
        Bars { angle: 0.7, ..PLANE },
        Bars { across: [3, 2], ..PLANE },
        space,
        Bars { simplices: true, angle: 0.4, ..space },
    ] {
        check(&bars, &laws, series(1.0 / 20.0));
    }
}

#[test]
fn tied_temperatures_have_no_resistance() {
    let mut deck = PLANE.deck(&json!([]));
    deck["solver_settings"]["contact_settings"] = json!({"mortar_type": "ScalarMeshTying"});
    deck["processes"]["list"][3] = json!({"python_module": "mesh_tying_process",
        "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication", "Parameters": {"model_part_name": "Heat",
        "mesh_tying_model_part": {"0": ["FirstFace", "SecondFace"]}, "assume_master_slave": {"0": ["SecondFace"]},
        "variable_name": "TEMPERATURE"}});
    let scratch = tempfile::tempdir().expect("a scratch folder");
    PLANE.write(scratch.path(), &deck);
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
    assert!(output.status.success(), "{}", said(&output));
    let [enters, leaves] = fed(&Results::read(&scratch.path().join("results.json")).expect("results"), 0);
    let exact = series(0.0);
    assert!(
        (enters - exact).abs() < 1e-9 * exact && (leaves - exact).abs() < 1e-9 * exact,
        "{enters} {leaves} {exact}"
    );
}

#[test]
fn laws_act_beside_each_other() {
    let laws =
        json!([{"law": "constant", "conductance": 15.0}, {"law": "gas", "conductivity": 0.05, "jump_distance": 0.01}]);
    check(&PLANE, &laws, series(1.0 / 20.0));
}

#[test]
fn gas_conducts_across_a_gap() {
    let laws = json!([{"law": "gas", "conductivity": 0.5, "jump_distance": 0.01},
        {"law": "constant", "conductance": 1e3}]);
    check(&Bars { gap: 0.04, ..PLANE }, &laws, series(0.05 / 0.5));
}

/// Heat that supports feed and take up where the bars themselves have next to no resistance; nothing is said of their temperature
/// at the start.
fn through_the_gap(bars: &Bars, laws: &Value) -> [f64; 2] {
    let mut deck = bars.deck(laws);
    deck["processes"]["list"].as_array_mut().expect("processes").remove(0);
    deck["solver_settings"].as_object_mut().expect("settings").remove("residual_relative_tolerance");
    let scratch = tempfile::tempdir().expect("a scratch folder");
    bars.write(scratch.path(), &deck);
    for conductivity in CONDUCTIVITIES {
        let [own, none] = [conductivity, 1e7].map(|number| format!("\"CONDUCTIVITY\":{number:?}"));
        change(scratch.path(), "heat.json", &own, &none);
    }
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
    assert!(output.status.success(), "{}", said(&output));
    let results = Results::read(&scratch.path().join("results.json")).expect("results");
    fed(&results, results.len() - 1)
}

#[test]
fn gas_conducts_across_a_wedge_on_meshes_of_any_size() {
    let laws = json!([{"law": "gas", "conductivity": 1.0, "jump_distance": 1e-9}]);
    // ANALYTIC: ∫ k ΔT/g dy with the gap g = 0.05 + 0.2 y; the Gauss rule of four facets is off by 1e-3.
    let exact = 100.0 / 0.2 * 5.0_f64.ln();
    for (across, tolerance) in [(4, 2e-3), (12, 1e-4), (48, 1e-5)] {
        let bars = Bars { gap: 0.05, slope: 0.2, across: [across, across + 1], ..PLANE };
        let [enters, leaves] = through_the_gap(&bars, &laws);
        assert!((enters - exact).abs() < tolerance * exact, "{across}: {enters} {exact}");
        assert!((enters - leaves).abs() < 1e-5 * exact, "{across}: {enters} {leaves}");
    }
}

/// Heat through the gap between cylinders is that of the closed form with either side as the slave.
#[test]
fn gaps_between_cylinders_conduct_and_radiate_alike_from_both_sides() {
    let [inner, outer] = [INNER + LENGTHS[0], INNER + LENGTHS[0] + 0.4];
    // ANALYTIC, for the whole turn: 2π k ΔT/ln(R₂/R₁), and σ (T₁⁴ − T₂⁴) 2π R₁/(1/ε₁ + R₁/R₂ (1/ε₂ − 1)).
    let conducted = TAU * 100.0 / (outer / inner).ln();
    let exchanged = TAU * inner / (1.0 / 0.8 + inner / outer * (1.0 / 0.5 - 1.0));
    let radiated = 5.67e-8 * (400.0_f64.powi(4) - 300.0_f64.powi(4)) * exchanged;
    let gas = json!([{"law": "gas", "conductivity": 1.0, "jump_distance": 1e-9}]);
    for slave in ["FirstFace", "SecondFace"] {
        let of_slave = if slave == "FirstFace" { [0.8, 0.5] } else { [0.5, 0.8] };
        let radiation =
            json!([{"law": "radiation", "emissivity_of_slave": of_slave[0], "emissivity_of_master": of_slave[1]}]);
        for (laws, exact) in [(&gas, conducted), (&radiation, radiated)] {
            // Chords of a quarter turn, whose ends have one-sided normals, are off by 4e-3 (24 of them); of revolution the faces are exact.
            for (form, share, tolerance) in [(Form::Rings, 0.25, 5e-3), (Form::Revolution, 1.0, 1e-4)] {
                let bars = Bars { gap: 0.4, across: [24, 25], form, slave, ..PLANE };
                let [enters, leaves] = through_the_gap(&bars, laws);
                let wanted = share * exact;
                assert!((enters - wanted).abs() < tolerance * wanted, "{slave}: {enters} {wanted}");
                assert!((enters - leaves).abs() < 1e-5 * wanted, "{slave}: {enters} {leaves}");
            }
        }
    }
}

#[test]
fn thin_sheets_that_radiate_are_in_balance() {
    let laws = json!([{"law": "radiation", "emissivity_of_slave": 1.0, "emissivity_of_master": 1.0}]);
    // ANALYTIC: σ (T₁⁴ − T₂⁴); 1e-5 covers the tolerance of the residual and the resistance of the bars.
    let exact = 5.67e-8 * (400.0_f64.powi(4) - 300.0_f64.powi(4));
    let [enters, leaves] = through_the_gap(&Bars { gap: 0.04, ..PLANE }, &laws);
    assert!(
        (enters - exact).abs() < 1e-5 * exact && (leaves - exact).abs() < 1e-5 * exact,
        "{enters} {leaves} {exact}"
    );
}

#[test]
fn faces_radiate_across_a_gap() {
    let laws = json!([{"law": "radiation", "emissivity_of_slave": 0.8, "emissivity_of_master": 0.5}]);
    let emissivity = 1.0 / (1.0 / 0.8 + 1.0 / 0.5 - 1.0);
    let (mut low, mut high) = (0.0, series(0.0));
    for _ in 0..200 {
        let q = 0.5 * (low + high);
        let (hot, cold) = (400.0 - q * LENGTHS[0] / CONDUCTIVITIES[0], 300.0 + q * LENGTHS[1] / CONDUCTIVITIES[1]);
        let radiated = emissivity * 5.67e-8 * (hot.powi(4) - cold.powi(4));
        if radiated > q { low = q } else { high = q }
    }
    check(&Bars { gap: 0.04, ..PLANE }, &laws, low);
}

/// Two bars between walls, with heat and mechanics by a strategy of coupling; the temperature of the first end rises with time.
fn growing(gap: f64, laws: &Value, steps: usize, hot: &str, strategy: &str) -> (Results, Value) {
    let bars = Bars { gap, across: [2, 2], ..PLANE };
    let mut structure = json!({"solver_type": "Static", "model_part_name": "Structure", "domain_size": 2, "echo_level": 0,
        "analysis_type": "non_linear", "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
        "material_import_settings": {"materials_filename": "law.json"}, "time_stepping": {"time_step": 1.0},
        "convergence_criterion": "contact_residual_criterion", "residual_relative_tolerance": 1e-9,
        "contact_settings": {"mortar_type": "ALMContactFrictionless", "contact_residual_relative_tolerance": 1e-9}});
    structure["max_iteration"] = json!(30);
    let mut warm = bars.solver();
    warm["model_import_settings"] = json!({"input_type": "use_input_model_part"});
    warm["element_replace_settings"] = json!({"element_name": "LaplacianElement"});
    let hold = |part: &str, variable: &str| {
        json!({"python_module": "assign_scalar_variable_process", "Parameters": {"model_part_name": format!("Structure.{part}"),
            "variable_name": variable, "value": 0.0, "interval": [0.0, "End"]}})
    };
    let mut processes = bars.processes(laws);
    processes[1]["Parameters"]["value"] = json!(hot);
    let across = ["First", "Second"].map(|part| hold(part, "DISPLACEMENT_Y"));
    let along = ["FirstEnd", "SecondEnd"].map(|part| hold(part, "DISPLACEMENT_X"));
    processes.extend(across.into_iter().chain(along));
    processes.push(json!({"python_module": "alm_contact_process", "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication",
        "Parameters": {"model_part_name": "Structure", "contact_model_part": {"0": ["FirstFace", "SecondFace"]},
            "assume_master_slave": {"0": ["SecondFace"]}, "contact_type": "Frictionless"}}));
    let deck = json!({"problem_data": {"problem_name": "bars", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0,
        "end_time": steps as f64}, "solver_settings": {"solver_type": "ThermoMechanicallyCoupled", "domain_size": 2,
        "structural_solver_settings": structure, "thermal_solver_settings": warm,
        "coupling_settings": {"strategy": strategy}}, "processes": {"list": processes}});
    let scratch = tempfile::tempdir().expect("a scratch folder");
    bars.write(scratch.path(), &deck);
    let law = |at: usize, name: &str| {
        json!({"model_part_name": format!("Structure.{name}"), "properties_id": at, "Material": {
            "constitutive_law": {"name": "ThermalLinearPlaneStress"}, "Tables": {}, "Variables": {"DENSITY": 1.0,
            "YOUNG_MODULUS": 1e5, "POISSON_RATIO": 0.0, "THERMAL_EXPANSION_COEFFICIENT": 1e-4, "REFERENCE_TEMPERATURE": 300.0}}})
    };
    let laws = json!({"properties": [law(1, "First"), law(2, "Second")]});
    std::fs::write(scratch.path().join("law.json"), laws.to_string()).expect("a file");
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json", "--report", "report.json"]);
    assert!(output.status.success(), "{}", said(&output));
    let results = Results::read(&scratch.path().join("results.json")).expect("results");
    (results, read_json(&scratch.path().join("report.json")).expect("the report"))
}

/// A bar that is alone is of its end's temperature throughout and grows by α L ΔT, more than the gap in the fourth step. Heat passes
/// from that one on in staggered or monolithic coupling, else from the next.
#[test]
fn a_bar_grows_into_contact_and_conducts_from_then_on() {
    let laws = json!([{"law": "constant", "conductance": 20.0}]);
    for (strategy, first) in [("staggered", 3), ("monolithic", 3), ("sequential", 4)] {
        let (results, report) = growing(0.0035, &laws, 8, "300+10*t", strategy);
        for step in 0..8 {
            let exact = if step < first { 0.0 } else { 10.0 * (step as f64 + 1.0) / 100.0 * series(1.0 / 20.0) };
            let found = -passed(&report, step);
            // Bars that press on each other are shorter, and conduct as they are.
            assert!((found - exact).abs() < 5e-3 * exact + 1e-9, "{strategy}, step {}: {found} {exact}", step + 1);
            let [enters, leaves] = fed(&results, step);
            assert!((enters - found).abs() < 1e-9 * found.max(1.0) && (leaves - found).abs() < 1e-9 * found.max(1.0));
        }
    }
}

/// Bars between walls press on each other the more the warmer they are, and so conduct the better: staggered iteration finds all of it
/// in the first step, a sequential one over several steps.
#[test]
fn conductance_follows_the_pressure() {
    let laws = json!([{"law": "pressure", "conductance": 100.0, "hardness": 5e3}]);
    // Mean temperatures of both bars make the pressure, which makes the conductance, which makes the temperatures.
    let mut q = series(0.01);
    for _ in 0..200 {
        let hot = 100.0 - 0.5 * q * LENGTHS[0] / CONDUCTIVITIES[0];
        let cold = 0.5 * q * LENGTHS[1] / CONDUCTIVITIES[1];
        let pressure = 1e5 * 1e-4 * (hot * LENGTHS[0] + cold * LENGTHS[1]) / (LENGTHS[0] + LENGTHS[1]);
        q = series(1.0 / (100.0 * (pressure / 5e3).powf(0.95)));
    }
    let (_, report) = growing(0.0, &laws, 2, "400.0", "staggered");
    let [first, second] = [0, 1].map(|step| -passed(&report, step));
    // Strains are not small beside the tolerance: lengths change by 0.5 %.
    assert!((first - q).abs() < 1e-2 * q, "{first} {q}");
    assert!((first - second).abs() < 1e-6 * q, "the second step differs by {}", first - second);
    let sweeps = number(&report, 0, "heat_sweeps");
    assert!((2.0..=8.0).contains(&sweeps), "{sweeps} sweeps");
    assert_eq!(number(&report, 1, "heat_sweeps"), 1.0, "nothing changes in the second step");

    let (_, report) = growing(0.0, &laws, 2, "400.0", "monolithic");
    let together = -passed(&report, 0);
    // Two more iterations than the structure alone needs, the last of which squares the residual.
    assert!((together - first).abs() < 1e-6 * q, "monolithic {together}, staggered {first}");
    let residual = |iteration: usize| {
        let check = &report["steps"][0]["iterations"][iteration]["checks"][0];
        check["ratio"].as_f64().unwrap_or_else(|| panic!("no residual in iteration {iteration}: {check}"))
    };
    let last = report["steps"][0]["iterations"].as_array().map_or(0, Vec::len) - 1;
    assert!(last <= 5 && residual(last) < 1e-4 * residual(last - 1), "{}", report["steps"][0]["iterations"]);

    let (_, report) = growing(0.0, &laws, 12, "400.0", "sequential");
    let last = -passed(&report, 11);
    assert!((last - first).abs() < 1e-5 * q, "in time {last}, staggered {first}");
    assert!((passed(&report, 0) + q).abs() > 1e-2 * q, "the first step alone would do");
}

/// The module of the process of contact that brings a formulation.
fn process_of(mortar: &str) -> &'static str {
    match mortar {
        _ if mortar.starts_with("Penalty") => "penalty_contact_process",
        _ if mortar.starts_with("Nitsche") => "nitsche_contact_process",
        _ if mortar.starts_with("Uzawa") => "uzawa_contact_process",
        _ if mortar.starts_with("PerturbedLagrangian") => "perturbed_lagrangian_contact_process",
        _ => "alm_contact_process",
    }
}

/// Two blocks of height 1, "Upper" of width 1 on "Lower" of this width, pressed together at the top.
fn blocks(width: f64, joint: Joint, slides: Value) -> Deck {
    let mut mesh = Mesh::new(2);
    let lower = mesh.block("Lower", [6, 2, 0], |x| [width * x[0] - (width - 1.0) / 2.0, x[1] - 1.0, 0.0]);
    let upper = mesh.block("Upper", [3, 2, 0], |x| [x[0], x[1], 0.0]);
    mesh.part("Slave", upper[&(1, 0)].0.clone(), upper[&(1, 0)].1.clone());
    let both = [lower[&(1, 1)].clone(), upper[&(1, 0)].clone()];
    mesh.part(
        "Interface",
        both.iter().flat_map(|side| side.0.clone()),
        both.iter().flat_map(|side| side.1.clone()).collect(),
    );
    mesh.part("Bottom", lower[&(1, 0)].0.clone(), Vec::new());
    mesh.part("Top", upper[&(1, 1)].0.clone(), upper[&(1, 1)].1.clone());
    let supports = vec![
        ("Bottom".to_owned(), [json!(0.0), json!(0.0), json!(0.0)]),
        ("Upper".to_owned(), [slides, json!(null), json!(0.0)]),
    ];
    Deck { mesh, joint, supports, pressure: 2.0, young: 1e4, steps: 10 }
}

/// Runs blocks with heat beside, contact by a formulation: the report, and heat at nodes; bottom and top are held at these temperatures.
fn warm_blocks(blocks: &Deck, mortar: &str, strategy: &str, held: [f64; 2], laws: &Value) -> (Value, Results) {
    warm_blocks_with(blocks, mortar, strategy, (held, laws), &|_| {})
}

/// As [`warm_blocks`], with changes of the folder.
fn warm_blocks_with(
    blocks: &Deck,
    mortar: &str,
    strategy: &str,
    (held, laws): ([f64; 2], &Value),
    change: &dyn Fn(&Path),
) -> (Value, Results) {
    let scratch = tempfile::tempdir().expect("a scratch folder");
    blocks.write(scratch.path(), |deck| {
        let mut structure = deck["solver_settings"].take();
        structure["contact_settings"]["mortar_type"] = json!(mortar);
        let process = &mut deck["processes"]["contact_process_list"][0];
        process["python_module"] = json!(process_of(mortar));
        if mortar.ends_with("Components") {
            process["Parameters"]["contact_type"] = json!("FrictionlessComponents");
        }
        let mut heat = PLANE.solver();
        heat["model_import_settings"] = json!({"input_type": "use_input_model_part"});
        heat["element_replace_settings"] = json!({"element_name": "LaplacianElement"});
        deck["solver_settings"] = json!({"solver_type": "ThermoMechanicallyCoupled", "domain_size": 2,
            "structural_solver_settings": structure, "thermal_solver_settings": heat,
            "coupling_settings": {"strategy": strategy}});
        let hold = |part: &str, value: f64| {
            json!({"python_module": "assign_scalar_variable_process", "Parameters": {"model_part_name": format!("Heat.{part}"),
                "variable_name": "TEMPERATURE", "value": value, "interval": [0.0, "End"]}})
        };
        deck["processes"]["heat"] = json!([hold("Bottom", held[0]), hold("Top", held[1]),
            {"python_module": "thermal_contact_process", "Parameters": {"model_part_name": "Heat",
                "contact_model_part": {"0": ["Interface"]}, "assume_master_slave": {"0": ["Slave"]}, "conductance": laws}}]);
        deck["processes"]["json_output_process_list"] = json!([{"python_module": "json_output_process",
            "Parameters": {"model_part_name": "Heat", "output_file_name": "heat_results.json",
                "output_variables": ["REACTION_FLUX"], "time_frequency": 0.0}}]);
    });
    let of = |name: &str, id: usize| {
        json!({"model_part_name": format!("Heat.{name}"), "properties_id": id, "Material": {
            "Variables": {"DENSITY": 1.0, "SPECIFIC_HEAT": 1.0, "CONDUCTIVITY": 5.0}, "Tables": {}}})
    };
    let materials = json!({"properties": [of("Lower", 1), of("Upper", 2)]});
    std::fs::write(scratch.path().join("heat.json"), materials.to_string()).expect("a file");
    change(scratch.path());
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json", "--report", "report.json"]);
    assert!(output.status.success(), "{mortar}: {}", said(&output));
    let results = Results::read(&scratch.path().join("heat_results.json")).expect("results");
    (read_json(&scratch.path().join("report.json")).expect("the report"), results)
}

/// Contact formulations, without friction and with it.
const FRICTIONLESS: [&str; 6] = [
    "ALMContactFrictionless",
    "ALMContactFrictionlessComponents",
    "PenaltyContactFrictionless",
    "NitscheContactFrictionless",
    "UzawaContactFrictionless",
    "PerturbedLagrangianContactFrictionless",
];
const FRICTIONAL: [&str; 3] = ["ALMContactFrictional", "PenaltyContactFrictional", "NitscheContactFrictional"];

/// Pressed blocks conduct by their pressure, whatever the method of contact: q = ΔT/(L/k + 1/h(p) + L/k).
#[test]
fn every_formulation_conducts_by_its_pressure() {
    let laws = json!([{"law": "pressure", "conductance": 100.0, "hardness": 5.0}]);
    let exact = 100.0 / (1.0 / 5.0 + 1.0 / (100.0 * 0.4_f64.powf(0.95)) + 1.0 / 5.0);
    let with = |mortar: &str, strategy: &str, joint: Joint| {
        let (report, results) = warm_blocks(&blocks(1.0, joint, json!(0.0)), mortar, strategy, [100.0, 0.0], &laws);
        for step in 1..results.len() {
            let [enters, leaves] = fed(&results, step);
            let passes = -passed(&report, step);
            // Bodies under pressure are shorter by 2e-4 of their length.
            assert!((passes - exact).abs() < 1e-3 * exact, "{mortar}, step {step}: {passes} {exact}");
            let friction = number(&report, step, "heat_of_friction");
            assert!((0.0..1e-6 * exact).contains(&friction), "{mortar}, step {step}: bodies at rest rub by {friction}");
            assert!((leaves - enters - friction).abs() < 1e-10 * exact, "{mortar}, step {step}: {enters} {leaves}");
        }
    };
    for strategy in ["staggered", "monolithic"] {
        FRICTIONLESS.into_iter().for_each(|mortar| with(mortar, strategy, Joint::Frictionless));
        FRICTIONAL.into_iter().for_each(|mortar| with(mortar, strategy, Joint::Frictional(0.3)));
    }
}

/// A block that slides on another under a pressure p dissipates μ p v by area, which leaves through the ends of both.
#[test]
fn friction_heats_both_bodies() {
    let (friction, way) = (0.3, 0.2);
    let laws = json!([{"law": "constant", "conductance": 20.0}]);
    let both = FRICTIONAL.into_iter().flat_map(|mortar| ["staggered", "monolithic"].map(|strategy| (mortar, strategy)));
    for (mortar, strategy) in both {
        let blocks = blocks(3.0, Joint::Frictional(friction), json!(format!("{way}*t")));
        let exact = friction * blocks.pressure * way;
        let (report, results) = warm_blocks(&blocks, mortar, strategy, [0.0; 2], &laws);
        for step in 3..results.len() {
            let heat = number(&report, step, "heat_of_friction");
            // The lower body deforms, so that slips are not quite those of the upper one.
            assert!((heat - exact).abs() < 2e-2 * exact, "{mortar}, step {step}: {heat} {exact}");
            let [enters, leaves] = fed(&results, step);
            assert!((leaves - enters - heat).abs() < 1e-9 * heat, "{mortar}, step {step}: {enters} {leaves} {heat}");
            // The report counts slave nodes that slide; by Nitsche's method points do, beside nodes that stick.
            if mortar != "NitscheContactFrictional" {
                let sum = |step: usize| {
                    report["steps"][step]["balance"]["pairs"][0]["dissipated"].as_f64().expect("heat of a pair")
                };
                let last = sum(step) - sum(step - 1);
                assert!((last - heat * 0.1).abs() < 1e-9 * last, "{mortar}, step {step}: {last} {heat}");
            }
        }
    }
}

/// ANALYTIC: friction that heats two blocks softens by that heat. Half of q = f μ p v leaves by each block of length L, so that the
/// surfaces have T = q L/(2 k), and with μ = μ₀ (1 − T/T_m) the heat is q = q₀/(1 + q₀ L/(2 k T_m)), q₀ = f μ₀ p v. 5e-3: friction
/// tilts the lower block, so that pressure and heat are not quite uniform; softening takes 11 %.
#[test]
fn friction_softens_by_its_own_heat() {
    let (friction, speed, factor, melting) = (0.3, 2e-3, 1e3, 1.0);
    let laws = json!([{"law": "constant", "conductance": 20.0}]);
    for mortar in ["ALMContactFrictional", "PenaltyContactFrictional"] {
        for strategy in ["staggered", "monolithic"] {
            let blocks = blocks(1.0, Joint::Frictional(friction), json!(format!("{speed}*t")));
            let soften = |folder: &Path| {
                let edit = |file: &str, change: &dyn Fn(&mut Value)| {
                    let mut value = read_json(&folder.join(file)).expect("it was written");
                    change(&mut value);
                    std::fs::write(folder.join(file), value.to_string()).expect("a file");
                };
                edit("ProjectParameters.json", &|deck| {
                    deck["processes"]["contact_process_list"][0]["Parameters"]["frictional_law"] =
                        json!("ThermalSoftening");
                    deck["processes"]["heat"][2]["Parameters"]["friction_heat"] = json!(factor);
                });
                edit("StructuralMaterials.json", &|materials| {
                    for material in materials["properties"].as_array_mut().expect("materials") {
                        let variables = &mut material["Material"]["Variables"];
                        variables["FRICTION_SOFTENING_EXPONENT"] = json!(1.0);
                        variables["FRICTION_REFERENCE_TEMPERATURE"] = json!(0.0);
                        variables["FRICTION_MELTING_TEMPERATURE"] = json!(melting);
                    }
                });
            };
            let (report, results) = warm_blocks_with(&blocks, mortar, strategy, ([0.0; 2], &laws), &soften);
            let cold = factor * friction * blocks.pressure * speed;
            let exact = cold / (1.0 + cold * 0.5 / 5.0 / melting);
            for step in 5..results.len() {
                let heat = number(&report, step, "heat_of_friction");
                assert!((heat - exact).abs() < 5e-3 * exact, "{mortar}, {strategy}, step {step}: {heat} {exact}");
            }
        }
    }
}

/// Steady state of Barber's rod, in one step: a warm rod closes its gap, and conduction in contact cools it again. Staggered coupling
/// of heat and structure oscillates between contact and none; monolithic coupling finds the state at once (the numbers of
/// `examples/barber_rod`).
#[test]
fn barbers_rod_comes_to_rest_in_one_step() {
    let scratch = scratch_copy(&root().join("examples/barber_rod"));
    let output = zelus(scratch.path(), &["run", "AtRest.json"]);
    assert!(output.status.success(), "{}", said(&output));
    for (file, variable, exact) in
        [("end.json", "TEMPERATURE", 53.1973), ("pressure.json", "CONTACT_PRESSURE", 15.9866)]
    {
        let results = Results::read(&scratch.path().join(file)).expect("results");
        assert_eq!(results.len(), 1, "one step");
        for value in results.nodal(variable, 0).into_values() {
            // The formula takes strains for small: the rod is shorter by 1e-4, where conductance is steep in the pressure.
            assert!((value / exact - 1.0).abs() < 5e-4, "{variable}: {value} {exact}");
        }
    }
}

/// Monolithic coupling needs Newton's iteration, and is refused without one.
#[test]
fn both_together_need_newtons_iteration() {
    let scratch = scratch_copy(&root().join("examples/barber_rod"));
    change(scratch.path(), "AtRest.json", "\"non_linear\"", "\"linear\"");
    let refused = |words: &str| {
        let output = zelus(scratch.path(), &["run", "AtRest.json"]);
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        assert!(said(&output).contains(words), "{}", said(&output));
    };
    refused("error[linear-contact]");
    // Without contact, the coupling itself.
    let path = scratch.path().join("AtRest.json");
    let mut deck = read_json(&path).expect("the deck");
    deck["processes"]["contact"] = json!([]);
    std::fs::write(&path, deck.to_string()).expect("a file");
    refused("\"monolithic\"");
}

/// A bar that grows by the heat of its friction between fixed ends settles at p₀/(1 - V), V the speed over the critical one, where that is below 1.
#[test]
fn below_the_critical_speed_pressures_settle() {
    let critical = 0.2 / 3.0;
    for share in [0.25, 0.5] {
        let scratch = scratch_copy(&root().join("examples/thermoelastic_instability"));
        let deck = "ProjectParameters.json";
        change(scratch.path(), deck, "0.133333333333*t", &format!("{}*t", share * critical));
        change(scratch.path(), deck, "\"time_step\": 0.0005", "\"time_step\": 0.02");
        change(scratch.path(), deck, "\"end_time\": 1.0", "\"end_time\": 10.0");
        let output = zelus(scratch.path(), &["run", deck]);
        assert!(output.status.success(), "{}", said(&output));
        let results = Results::read(&scratch.path().join("pressure.json")).expect("results");
        for pressure in results.nodal("CONTACT_PRESSURE", results.len() - 1).into_values() {
            let exact = 1.0 / (1.0 - share);
            // The change of the bar's shape is 1e-4.
            assert!((pressure - exact).abs() < 1e-3 * exact, "{share}: {pressure} {exact}");
        }
    }
}

/// A disc that spins under a ring takes up 2π f p ω (R₂³ − R₁³)/3 with it, all of which is stored.
#[test]
fn a_braked_disc_takes_up_what_rubbing_gives() {
    let scratch = scratch_copy(&root().join("examples/brake_disc"));
    let deck = "ProjectParameters.json";
    change(scratch.path(), deck, "\"end_time\": 1.0", "\"end_time\": 0.05");
    let output = zelus(scratch.path(), &["run", deck, "--report", "report.json"]);
    assert!(output.status.success(), "{}", said(&output));
    let report = read_json(&scratch.path().join("report.json")).expect("the report");
    let exact = std::f64::consts::TAU * 0.3 * 10.0 * 7.0 / 3.0;
    for step in 0..5 {
        // Two points of Gauss on a cell integrate the square of the radius exactly, its nodes carry a pressure of 1 to 1e-6.
        let heat = number(&report, step, "heat_of_friction");
        assert!((heat - exact).abs() < 1e-5 * exact, "step {step}: {heat} {exact}");
        let balance = &report["steps"][step]["balance"]["unknowns"];
        let of_heat = balance.as_array().and_then(|all| all.iter().find(|own| own["unknown"] == "TEMPERATURE"));
        let stored = of_heat.expect("a balance of heat")["flows"]["stored"].as_f64().expect("a number");
        assert!((stored - heat).abs() < 1e-8 * exact, "step {step}: {stored} {heat}");
    }
}

/// Bodies of revolution for one physics alone are none.
#[test]
fn plane_heat_beside_a_structure_of_revolution_is_refused() {
    let scratch = scratch_copy(&root().join("examples/brake_disc"));
    let deck = "ProjectParameters.json";
    change(scratch.path(), deck, "AxisymmetricEulerianConvectionDiffusion", "EulerianConvDiff");
    change(scratch.path(), deck, "AxisymmetricThermalFace", "ThermalFace");
    let output = zelus(scratch.path(), &["run", deck]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("error[revolution]"), "{}", said(&output));
}

#[test]
fn what_is_wrong_is_said() {
    let says = |bars: &Bars, laws: Value, code: i32, word: &str| {
        let scratch = tempfile::tempdir().expect("a scratch folder");
        bars.write(scratch.path(), &bars.deck(&laws));
        let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
        assert_eq!(output.status.code(), Some(code), "{}", said(&output));
        assert!(said(&output).contains(word), "{word}: {}", said(&output));
    };
    says(&PLANE, json!([]), 2, "names no law");
    says(&PLANE, json!([{"law": "constnat", "conductance": 1.0}]), 2, "constant");
    says(&PLANE, json!([{"law": "constant"}]), 2, "conductance");
    says(&PLANE, json!([{"law": "constant", "conductance": 1.0, "colour": 1}]), 2, "colour");
    says(&Bars { gap: 0.3, ..PLANE }, json!([{"law": "constant", "conductance": 1.0}]), 0, "no heat has passed");
}
