//! The text of a starter deck.

use zelus_meshes::mesh::{LoadKind, Mesh, Pair, Plane, Support};

/// `ProjectParameters.json` with comments on the decisions to take.
pub(super) fn text(mesh: &Mesh, stem: &str, space: usize, supports: &[Support]) -> String {
    let contact: Vec<&Pair> = mesh.pairs.iter().filter(|pair| !pair.tied).collect();
    let tied: Vec<&Pair> = mesh.pairs.iter().filter(|pair| pair.tied).collect();
    let friction = contact.iter().any(|pair| pair.friction > 0.0);
    let kind = if friction { "Frictional" } else { "Frictionless" };
    let settings = if contact.is_empty() {
        String::new()
    } else {
        format!("\n    \"contact_settings\": {{\"mortar_type\": \"ALMContact{kind}\"}},")
    };
    let criterion = if contact.is_empty() { "residual_criterion" } else { "contact_residual_criterion" };
    let step = if contact.is_empty() { 1.0 } else { 0.25 };
    let parts: Vec<&str> = mesh.groups.iter().map(|group| group.name.as_str()).collect();
    let mut lists = vec![
        list("constraints_process_list", supports.iter().map(|support| support_text(support, space)).collect()),
        list("loads_process_list", loads(mesh, space)),
    ];
    lists.extend(
        (!contact.is_empty())
            .then(|| list("contact_process_list", vec![contact_text(&contact, kind, friction, mesh.plane)])),
    );
    lists.extend((!tied.is_empty()).then(|| list("tying_process_list", vec![tie_text(&tied)])));
    format!(
        r#"// A deck to start from. Go through supports, loads and materials, then: zelus check, zelus run.
// Parts of the mesh: {}.
{{
  "problem_data": {{
    "problem_name": "{stem}",
    "parallel_type": "OpenMP",
    "echo_level": 1,
    "start_time": 0.0,
    "end_time": 1.0 // time is the load factor: a load "1.0*t" ramps to its full value at t = 1
  }},
  "solver_settings": {{
    "solver_type": "Static", // "Dynamic" with inertia; `zelus describe Dynamic`
    "model_part_name": "Structure",
    "domain_size": {space},
    "echo_level": 1,
    "analysis_type": "non_linear",
    "model_import_settings": {{"input_type": "mdpa", "input_filename": "{stem}"}},
    "material_import_settings": {{"materials_filename": "StructuralMaterials.json"}},{settings}
    "time_stepping": {{"time_step": {step:?}}}, // steps that do not converge are cut by themselves
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

fn process(module: &str, application: &str, parameters: &str) -> String {
    format!(
        r#"      {{
        "python_module": "{module}",
        "kratos_module": "{application}",
        "Parameters": {{
{parameters}
        }}
      }}"#
    )
}

const CORE: &str = "KratosMultiphysics";
const CONTACT: &str = "KratosMultiphysics.ContactStructuralMechanicsApplication";

fn support_text(support: &Support, space: usize) -> String {
    // a planar model has no third displacement to hold
    let values = support.values.iter().enumerate().map(|(at, value)| value.filter(|_| at < space));
    let values: Vec<Option<f64>> = values.collect();
    let held: Vec<String> = values.iter().map(|value| value.is_some().to_string()).collect();
    let number = |value: &Option<f64>| match value {
        None => "null".to_owned(),
        Some(0.0) => "0.0".to_owned(),
        Some(value) => format!("\"{value:?}*t\""),
    };
    let values: Vec<String> = values.iter().map(number).collect();
    process(
        "assign_vector_variable_process",
        CORE,
        &format!(
            r#"          "model_part_name": "Structure.{}",
          "variable_name": "DISPLACEMENT",
          "constrained": [{}], // directions that are held
          "value": [{}]"#,
            support.group,
            held.join(", "),
            values.join(", ")
        ),
    )
}

fn loads(mesh: &Mesh, space: usize) -> Vec<String> {
    let surface = if space == 3 { "SURFACE_LOAD" } else { "LINE_LOAD" };
    let by_direction = |group: &str, variable: &str, modulus: f64, direction: &str| {
        process(
            "assign_vector_by_direction_to_condition_process",
            CORE,
            &format!(
                r#"          "model_part_name": "Structure.{group}",
          "variable_name": "{variable}",
          "modulus": "{modulus:?}*t",
          "direction": {direction}"#
            ),
        )
    };
    let all =
        mesh.loads.iter().filter(|load| !(mesh.plane == Some(Plane::Axial) && matches!(load.kind, LoadKind::Force(_))));
    all.map(|load| match load.kind {
        LoadKind::Pressure(value) => by_direction(&load.group, surface, value, "\"automatic_inwards_normal\""),
        LoadKind::Force(force) => {
            let size = force.iter().map(|x| x * x).sum::<f64>().sqrt();
            by_direction(&load.group, "POINT_LOAD", size, &format!("{:?}", force.map(|x| x / size)))
        }
    })
    .collect()
}

/// `{"0": ["Part"], "1": […]}` with `name` of each pair.
fn by_pair(pairs: &[&Pair], name: impl Fn(&Pair) -> String) -> String {
    let items: Vec<String> = pairs.iter().enumerate().map(|(at, pair)| format!("\"{at}\": {}", name(pair))).collect();
    format!("{{{}}}", items.join(", "))
}

fn surfaces(pair: &Pair) -> String {
    if pair.slave == pair.master {
        format!("[\"{}\"]", pair.slave)
    } else {
        format!("[\"{}\", \"{}\"]", pair.slave, pair.master)
    }
}

fn slaves(pair: &Pair) -> String {
    if pair.slave == pair.master { "[]".to_owned() } else { format!("[\"{}\"]", pair.slave) }
}

fn contact_text(pairs: &[&Pair], kind: &str, friction: bool, plane: Option<Plane>) -> String {
    let coefficients = if friction {
        format!(",\n          \"friction_coefficients\": {}", by_pair(pairs, |pair| format!("{:?}", pair.friction)))
    } else {
        String::new()
    };
    let about = match plane {
        Some(Plane::Axial) => ",\n          \"alternative_formulations\": {\"axisymmetric\": true}",
        _ => "",
    };
    process(
        "alm_contact_process",
        CONTACT,
        &format!(
            r#"          "model_part_name": "Structure",
          "contact_type": "{kind}",
          "contact_model_part": {},
          // slaves: the finer side, of like meshes the softer
          "assume_master_slave": {}{coefficients}{about}"#,
            by_pair(pairs, surfaces),
            by_pair(pairs, slaves),
        ),
    )
}

fn tie_text(pairs: &[&Pair]) -> String {
    process(
        "mesh_tying_process",
        CONTACT,
        &format!(
            r#"          "model_part_name": "Structure",
          "mesh_tying_model_part": {},
          "assume_master_slave": {}"#,
            by_pair(pairs, surfaces),
            by_pair(pairs, slaves),
        ),
    )
}
