//! The text of a starter deck.

use zelus_meshes::conditions::Support;
use zelus_meshes::mesh::{Mesh, Pair};

use super::formulations::Formulation;
use super::histories::Histories;
use super::point_loads::ForceFile;
use super::{processes, stepping, thickness};

/// `ProjectParameters.json` with comments on the decisions to take.
pub(super) fn text(
    mesh: &Mesh,
    stem: &str,
    space: usize,
    formulation: Formulation,
    supports: &[Support],
    forces: Option<&ForceFile>,
    texts: &mut Histories,
) -> String {
    let contact: Vec<&Pair> = mesh.pairs.iter().filter(|pair| !pair.tied).collect();
    let tied: Vec<&Pair> = mesh.pairs.iter().filter(|pair| pair.tied).collect();
    let friction = contact.iter().any(|pair| pair.friction > 0.0);
    // ties have vectors as multipliers: so must contact beside them
    let kind = match (friction, tied.is_empty()) {
        (true, _) => "Frictional",
        (false, true) => "Frictionless",
        (false, false) => "FrictionlessComponents",
    };
    let adjusted = if contact.iter().any(|pair| pair.adjusted) { ", \"adjust_initial\": true" } else { "" };
    let settings = match (contact.is_empty(), tied.is_empty(), formulation.mortar) {
        (true, true, _) => String::new(),
        (true, false, _) => "\n    \"contact_settings\": {\"mortar_type\": \"ComponentsMeshTying\"},".to_owned(),
        (false, _, Some(mortar)) => {
            format!("\n    \"contact_settings\": {{\"mortar_type\": \"{mortar}{kind}\"{adjusted}}},")
        }
        (false, _, None) => format!("\n    \"mpc_contact_settings\": {{\"contact_type\": \"{kind}\"}},"),
    };
    let criterion = if contact.is_empty() || formulation.mortar.is_none() {
        "residual_criterion"
    } else {
        "contact_residual_criterion"
    };
    let temperature = if mesh.temperatures.is_empty() {
        ""
    } else {
        "\n    \"auxiliary_variables_list\": [\"TEMPERATURE\"], // prescribed below; it expands the bodies"
    };
    let parts: Vec<&str> = mesh.groups.iter().map(|group| group.name.as_str()).collect();
    let mut loads: Vec<String> = mesh
        .loads
        .iter()
        .filter_map(|load| processes::load(load, space, thickness::of(mesh, &load.group, space), texts))
        .collect();
    loads.extend(processes::accelerations(mesh, texts));
    loads.extend(forces.map(|file| processes::forces_of_file(&file.group, &file.name, space)).unwrap_or_default());
    let held = supports.iter().flat_map(|support| processes::support(support, space, texts)).collect();
    let mut lists = vec![list("constraints_process_list", held), list("loads_process_list", loads)];
    let mut add = |name: &str, items: Vec<String>| lists.extend((!items.is_empty()).then(|| list(name, items)));
    add("couplings_process_list", mesh.couplings.iter().map(|own| processes::coupling(own, supports, space)).collect());
    add("periodicity_process_list", mesh.sectors.iter().map(processes::sector).collect());
    add("clearances_process_list", mesh.clearances.iter().map(processes::clearance).collect());
    add("bolts_process_list", mesh.bolts.iter().filter_map(|bolt| processes::bolt(bolt, texts)).collect());
    add("axes_process_list", mesh.material_axes.iter().map(processes::material_axes).collect());
    add("temperatures_process_list", mesh.temperatures.iter().map(|own| processes::temperature(own, texts)).collect());
    if !contact.is_empty() {
        add(
            "contact_process_list",
            vec![processes::contact(&contact, formulation.process, kind, friction, mesh.plane)],
        );
    }
    if !tied.is_empty() {
        add("tying_process_list", vec![processes::tie(&tied)]);
    }
    format!(
        r#"// A deck to start from. Go through supports, loads and materials, then: zelus check, zelus run.
// Parts of the mesh: {}.
{{
  "problem_data": {{
    "problem_name": "{stem}",
    "parallel_type": "OpenMP",
    "echo_level": 1,
    "start_time": 0.0,
    "end_time": {:?} // time is the load factor: a load "1.0*t" ramps to its full value at t = 1
  }},
  "solver_settings": {{
    "solver_type": "Static", // "Dynamic" with inertia; `zelus describe Dynamic`
    "model_part_name": "Structure",
    "domain_size": {space},
    "echo_level": 1,
    "analysis_type": "non_linear",
    "model_import_settings": {{"input_type": "mdpa", "input_filename": "{stem}"}},
    "material_import_settings": {{"materials_filename": "StructuralMaterials.json"}},{settings}{temperature}
    "time_stepping": {}, // steps that do not converge are cut by themselves
    "convergence_criterion": "{criterion}"
  }},
  "processes": {{
{}
  }},
  "output_processes": {{
    "vtu_output": [
      {{
        "python_module": "vtu_output_process",
        "kratos_module": "KratosMultiphysics",
        "Parameters": {{
          "model_part_name": "Structure",
          "output_path": "vtu_output" // open the .pvd file in ParaView; without lists it has the default output variables
        }}
      }}
    ]
  }}
}}
"#,
        if parts.is_empty() { "none but Structure, the whole".to_owned() } else { parts.join(", ") },
        stepping::end(mesh),
        stepping::text(mesh),
        lists.join(",\n")
    )
}

fn list(name: &str, items: Vec<String>) -> String {
    if items.is_empty() {
        return format!(
            "    \"{name}\": [\n      // none is known of the mesh; `zelus describe assign_vector_by_direction_to_condition_process` for \
             loads,\n      // assign_vector_variable_process for displacements\n    ]"
        );
    }
    format!("    \"{name}\": [\n{}\n    ]", items.join(",\n"))
}
