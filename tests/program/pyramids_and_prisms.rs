//! Meshes of Gmsh with pyramids between hexahedra and tetrahedra, and with prisms of 18 nodes (ANALYTIC): a displacement prescribed on the
//! skin that is linear in the position is exact inside, as neighbours of all shapes meet; round-off remains.

use crate::support::{Results, read_nodes, root, said, zelus};
use serde_json::json;

/// Value and gradient of each component.
const FIELD: [[f64; 4]; 3] = [[1e-4, 1e-3, 4e-4, -3e-4], [2e-4, 2e-4, -5e-4, 6e-4], [3e-4, 7e-4, -2e-4, 8e-4]];

/// Imports a mesh and prescribes the field on its skin; the largest error, and the words of the import.
fn error(mesh: &str) -> (f64, String) {
    let scratch = tempfile::tempdir().expect("a folder");
    let file = root().join("meshes/tests/data").join(mesh).with_extension("msh");
    let imported = zelus(scratch.path(), &["import", file.to_str().expect("a path"), "-o", "mesh.mdpa"]);
    assert!(imported.status.success(), "{}", said(&imported));
    let value = FIELD.map(|[a, x, y, z]| format!("({a:?})+({x:?})*X+({y:?})*Y+({z:?})*Z"));
    let processes = json!([
        {"python_module": "assign_vector_variable_process", "Parameters": {"model_part_name": "Structure.Skin",
            "variable_name": "DISPLACEMENT", "constrained": [true, true, true], "value": value}},
        {"python_module": "json_output_process", "Parameters": {"model_part_name": "Structure",
            "output_file_name": "results.json", "output_variables": ["DISPLACEMENT"], "time_frequency": 0.0}}]);
    let solver = json!({"solver_type": "Static", "model_part_name": "Structure", "domain_size": 3,
        "analysis_type": "linear", "time_stepping": {"time_step": 1.0},
        "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
        "material_import_settings": {"materials_filename": "materials.json"}});
    let deck = json!({"problem_data": {"problem_name": "patch", "parallel_type": "OpenMP", "echo_level": 0,
        "start_time": 0.0, "end_time": 1.0}, "solver_settings": solver, "processes": {"list": processes}});
    let material = json!({"properties": [{"model_part_name": "Structure.Body", "properties_id": 1, "Material": {
        "constitutive_law": {"name": "LinearElastic3DLaw"},
        "Variables": {"YOUNG_MODULUS": 1000.0, "POISSON_RATIO": 0.3}, "Tables": {}}}]});
    for (name, text) in [("ProjectParameters.json", deck), ("materials.json", material)] {
        std::fs::write(scratch.path().join(name), text.to_string()).expect("a file");
    }
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
    assert!(output.status.success(), "{}", said(&output));
    let results = Results::read(&scratch.path().join("results.json")).expect("results");
    let nodes = read_nodes(&scratch.path().join("mesh.mdpa"));
    let mut most = 0.0_f64;
    for (name, [a, x, y, z]) in ["X", "Y", "Z"].into_iter().zip(FIELD) {
        for (node, value) in results.nodal(&format!("DISPLACEMENT_{name}"), 0) {
            let at = nodes[&node];
            most = most.max((value - (a + x * at[0] + y * at[1] + z * at[2])).abs());
        }
    }
    (most, said(&imported))
}

#[test]
fn patches_of_mixed_cells_are_exact() {
    for (mesh, elements) in [
        ("pyramids_1", ["Element3D5N", "Element3D8N", "Element3D4N"]),
        ("pyramids_2", ["Element3D13N", "Element3D20N", "Element3D10N"]),
        ("prisms_18", ["Element3D18N", "Condition3D9N", "Condition3D6N"]),
    ] {
        let (most, said) = error(mesh);
        assert!(elements.iter().all(|name| said.contains(name)), "{mesh}: {said}");
        assert!(most < 1e-15, "{mesh}: {most:.1e}");
    }
}
