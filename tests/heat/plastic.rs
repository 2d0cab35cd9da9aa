//! Heat of plastic flow, and laws that expand beside heat.

use serde_json::{Value, json};

use crate::slab::{Deck, Slab};
use crate::support::{Results, read_json, said, zelus};

const YIELD: f64 = 2.0;
const YOUNG: f64 = 2e5;
const POISSON: f64 = 0.3;
/// Share of plastic work that becomes heat.
const SHARE: f64 = 0.9;

/// Heat that stays where it is made, beside a structure of this law.
fn coupled(slab: &Slab, law: &str, values: Value, strategy: &str, step: f64, supports: Vec<Value>) -> (Results, Value) {
    let mut deck = Deck::new("ThermoMechanicallyCoupled", step, 1.0, 0.0);
    let mut structure = deck.solver.clone();
    structure["solver_type"] = json!("Static");
    structure["material_import_settings"]["materials_filename"] = json!("law.json");
    structure["max_iteration"] = json!(30);
    let mut heat = deck.solver.clone();
    heat["solver_type"] = json!("transient");
    heat["model_import_settings"] = json!({"input_type": "use_input_model_part"});
    heat["transient_parameters"] = json!({"theta": 1.0});
    deck.solver = json!({"solver_type": "ThermoMechanicallyCoupled", "domain_size": 2, "structural_solver_settings": structure,
        "thermal_solver_settings": heat, "coupling_settings": {"strategy": strategy}});
    deck.materials[0]["Material"]["Variables"]["TAYLOR_QUINNEY_COEFFICIENT"] = json!(SHARE);
    deck.materials[0]["Material"]["Variables"]["DENSITY"] = json!(1.0);
    deck.processes = supports;
    let scratch = tempfile::tempdir().unwrap();
    deck.write(scratch.path(), slab);
    let mut variables = json!({"DENSITY": 1.0, "YOUNG_MODULUS": YOUNG, "POISSON_RATIO": POISSON});
    variables.as_object_mut().unwrap().extend(values.as_object().unwrap().clone());
    let law = json!({"properties": [{"model_part_name": "Heat.Body", "properties_id": 1, "Material": {
        "constitutive_law": {"name": law}, "Tables": {}, "Variables": variables}}]});
    std::fs::write(scratch.path().join("law.json"), law.to_string()).unwrap();
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json", "--report", "report.json"]);
    assert!(output.status.success(), "{}", said(&output));
    let results = Results::read(&scratch.path().join("results.json")).unwrap();
    (results, read_json(&scratch.path().join("report.json")).unwrap())
}

fn moved(part: &str, component: &str, value: &str) -> Value {
    json!({"python_module": "assign_scalar_variable_process", "Parameters": {"model_part_name": format!("Heat.{part}"),
        "variable_name": format!("DISPLACEMENT_{component}"), "value": value}})
}

/// A strip that is pulled far beyond its yield stress under plane strain carries 2/√3 of it: its temperature rises by the plastic work
/// by volume, σ_y ε_p + ½ H ε_p², where ε_p is 2/√3 times the strain (the logarithm of the stretch where strains are finite).
#[test]
fn plastic_work_heats() {
    let laws = [
        ("SmallDisplacementElement", "SmallStrainJ2PlasticityPlaneStrain2DLaw"),
        ("TotalLagrangianElement", "ThermalFiniteStrainIsotropicPlasticityPlaneStrainVonMisesVonMises"),
    ];
    let (strain, steps, hardening) = (0.02_f64, 100, 1.0);
    for (element, law) in laws {
        let slab = Slab { element, rows: 2, triangles: true, ..Slab::new(6) };
        let properties = json!({"YIELD_STRESS": YIELD, "ISOTROPIC_HARDENING_MODULUS": hardening,
            "THERMAL_EXPANSION_COEFFICIENT": 0.0, "REFERENCE_TEMPERATURE": 0.0});
        let pulled =
            vec![moved("Left", "X", "0.0"), moved("Foot", "Y", "0.0"), moved("Right", "X", &format!("{strain}*t"))];
        for (strategy, steps_late) in [("staggered", 0), ("monolithic", 0), ("sequential", 1)] {
            let step = 1.0 / f64::from(steps);
            let (results, report) = coupled(&slab, law, properties.clone(), strategy, step, pulled.clone());
            let at = strain * f64::from(steps - steps_late) / f64::from(steps);
            let stretch = if element.starts_with("Small") { at } else { at.ln_1p() };
            let plastic = 2.0 / 3.0_f64.sqrt() * stretch;
            let exact = SHARE * (YIELD * plastic + 0.5 * hardening * plastic * plastic);
            for (node, temperature) in results.nodal("TEMPERATURE", results.len() - 1) {
                // Elastic energy is 1e-4 of the work, the way to full flow another part; meshes of triangles spread it a little.
                assert!(
                    (temperature / exact - 1.0).abs() < 5e-3,
                    "{law} {strategy} node {node}: {temperature} {exact}"
                );
            }
            // Heat that enters in a step, by the report, is stored in it.
            let last = report["steps"].as_array().unwrap().last().unwrap();
            let heat =
                last["balance"]["unknowns"].as_array().unwrap().iter().find(|own| own["unknown"] == "TEMPERATURE");
            let flows = &heat.unwrap_or_else(|| panic!("no balance of heat: {}", last["balance"]))["flows"];
            let [entering, stored] = ["entering", "stored"].map(|name| flows[name].as_f64().unwrap());
            assert!((entering - stored).abs() < 1e-9 * entering && entering > 0.0, "{flows}");
        }
    }
}

/// A strip between walls under plane strain that cools is pulled in two directions alike: ε_y = (1 + ν)/(1 - ν) α ΔT while it is elastic,
/// and 3 α ΔT + 2 (1 - 2ν) σ_y/E once it yields.
#[test]
fn a_plastic_strip_that_shrinks_yields_between_walls() {
    let slab = Slab { element: "SmallDisplacementElement", rows: 2, ..Slab::new(4) };
    let expansion = 1e-4;
    let properties = json!({"YIELD_STRESS": YIELD, "HARDENING_CURVE": 3, "THERMAL_EXPANSION_COEFFICIENT": expansion,
        "REFERENCE_TEMPERATURE": 0.0});
    let cooled = json!({"python_module": "assign_scalar_variable_process", "Parameters": {"model_part_name": "Heat.Body",
        "variable_name": "TEMPERATURE", "value": "-4*t"}});
    let held = vec![moved("Left", "X", "0.0"), moved("Right", "X", "0.0"), moved("Foot", "Y", "0.0"), cooled];
    let law = "ThermalSmallStrainJ2PlasticityPlaneStrain2DLaw";
    let (results, _) = coupled(&slab, law, properties, "staggered", 0.01, held);
    let shrunk = |step: usize| results.nodal("DISPLACEMENT_Y", step)[&(slab.node(2, 2) as u64)] / slab.height;
    let elastic = -(1.0 + POISSON) / (1.0 - POISSON) * expansion * 0.04;
    assert!((shrunk(0) - elastic).abs() < 1e-9 * elastic.abs(), "{} {elastic}", shrunk(0));
    let plastic = -3.0 * expansion * 4.0 + 2.0 * (1.0 - 2.0 * POISSON) * YIELD / YOUNG;
    assert!((shrunk(99) - plastic).abs() < 1e-6 * plastic.abs(), "{} {plastic}", shrunk(99));
}
