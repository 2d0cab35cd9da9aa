//! Processes of a starter deck: supports, loads, couplings, contact, ties, temperatures and axes of materials.

use zelus_meshes::conditions::{
    Axes, Bolt, Clearance, Coupling, Cyclic, Load, LoadKind, MaterialAxes, Prescribed, Support, Temperature,
};
use zelus_meshes::history::History;
use zelus_meshes::mesh::{Mesh, Pair, Plane};

use super::histories::Histories;

const CORE: &str = "KratosMultiphysics";
const CONTACT: &str = "KratosMultiphysics.ContactStructuralMechanicsApplication";
const STRUCTURAL: &str = "KratosMultiphysics.StructuralMechanicsApplication";
/// Relative margin of the ends of an interval: its begin is the end of the step before.
const MARGIN: f64 = 1e-9;

/// One entry of a list of processes, with its parameters as lines `"key": value`.
fn process(module: &str, application: &str, parameters: &[String]) -> String {
    format!(
        r#"      {{
        "python_module": "{module}",
        "kratos_module": "{application}",
        "Parameters": {{
          {}
        }}
      }}"#,
        parameters.join(",\n          ")
    )
}

/// `"key": "text"`.
fn word(key: &str, text: &str) -> String {
    format!("\"{key}\": \"{text}\"")
}

fn vector(numbers: &[f64; 3]) -> String {
    format!("{numbers:?}")
}

/// The part of a group; the whole where it has no name.
fn part(group: &str) -> String {
    if group.is_empty() {
        word("model_part_name", "Structure")
    } else {
        word("model_part_name", &format!("Structure.{group}"))
    }
}

/// The entry `"interval"` of a span of time; none for all times.
fn interval(span: (f64, Option<f64>)) -> Option<String> {
    let begin = if span.0 == 0.0 { "0.0".to_owned() } else { format!("{:?}", span.0 * (1.0 + MARGIN)) };
    let end = span.1.map_or("\"End\"".to_owned(), |end| format!("{:?}", end * (1.0 + MARGIN)));
    (span != (0.0, None)).then(|| format!("\"interval\": [{begin}, {end}]"))
}

/// A support as one process, or one for each direction of its axes.
pub(super) fn support(support: &Support, space: usize, texts: &mut Histories) -> Vec<String> {
    if let Some(axes) = &support.axes {
        return along_axes(support, axes, texts);
    }
    // a planar model has no third displacement to hold, and a rotation about the third axis alone
    let is_kept = |at: usize| match support.quantity {
        Prescribed::Displacement => at < space,
        Prescribed::Rotation => space == 3 || at == 2,
    };
    let values = support.values.iter().enumerate().map(|(at, value)| value.as_ref().filter(|_| is_kept(at)));
    let values: Vec<Option<&History>> = values.collect();
    if values.iter().all(Option::is_none) {
        return Vec::new();
    }
    let held: Vec<String> = values.iter().map(|value| value.is_some().to_string()).collect();
    let texts: Vec<String> =
        values.iter().map(|value| value.map_or("null".to_owned(), |value| texts.value(value))).collect();
    let variable = match support.quantity {
        Prescribed::Displacement => "DISPLACEMENT",
        Prescribed::Rotation => "ROTATION",
    };
    let mut parameters = vec![
        part(&support.group),
        word("variable_name", variable),
        format!(
            "\"constrained\": [{}], // directions that are held\n          \"value\": [{}]",
            held.join(", "),
            texts.join(", ")
        ),
    ];
    parameters.extend(interval(support.interval));
    vec![process("assign_vector_variable_process", CORE, &parameters)]
}

fn along_axes(support: &Support, axes: &Axes, texts: &mut Histories) -> Vec<String> {
    let values = support.values.iter().enumerate().filter_map(|(at, value)| Some((at, value.as_ref()?)));
    let one = |(at, value): (usize, &History)| {
        let mut parameters = vec![part(&support.group)];
        match axes {
            Axes::Cartesian(all) => parameters.push(format!("\"direction\": {}", vector(&all[at]))),
            Axes::Cylindrical { origin, axis } => {
                parameters.push(word("direction", ["radial", "tangential", "axial"][at]));
                parameters.push(format!("\"origin\": {}", vector(origin)));
                parameters.push(format!("\"axis\": {}", vector(axis)));
            }
        }
        parameters.push(format!("\"value\": {}", texts.value(value)));
        parameters.extend(interval(support.interval));
        process("assign_displacement_along_direction_process", STRUCTURAL, &parameters)
    };
    values.map(one).collect()
}

/// A load of nodes or faces as a process. `thickness` is that of the bodies of its faces: loads of lines are forces per length.
pub(super) fn load(load: &Load, space: usize, thickness: f64, texts: &mut Histories) -> Option<String> {
    let on_conditions = |variable: &str, values: String| {
        let parameters = [part(&load.group), word("variable_name", variable), format!("\"value\": [{values}]")];
        process("assign_vector_variable_to_conditions_process", CORE, &parameters)
    };
    let mut all = |values: &[History; 3]| values.each_ref().map(|value| texts.value(value)).join(", ");
    Some(match &load.kind {
        // of a body of revolution: the force of the whole circumference
        LoadKind::Force(values) => on_conditions("POINT_LOAD", all(values)),
        LoadKind::Total(values) => {
            let values = format!("\"load\": [{}]", all(values));
            process("distribute_load_on_surface_process", STRUCTURAL, &[part(&load.group), values])
        }
        LoadKind::Moment(values) => on_conditions("POINT_MOMENT", all(values)),
        LoadKind::Traction(values) => {
            let values = values.each_ref().map(|value| value.scaled(thickness));
            on_conditions(if space == 3 { "SURFACE_LOAD" } else { "LINE_LOAD" }, all(&values))
        }
        LoadKind::Pressure(value) => {
            // the variable that presses: signs differ in the plane and in space
            let variable = if space == 3 { "POSITIVE_FACE_PRESSURE" } else { "NEGATIVE_FACE_PRESSURE" };
            let value = format!("\"value\": {}", texts.value(&value.scaled(thickness)));
            let parameters = [part(&load.group), word("variable_name", variable), value];
            process("assign_scalar_variable_to_conditions_process", CORE, &parameters)
        }
        LoadKind::Acceleration(_) | LoadKind::Centrifugal { .. } => return None,
    })
}

/// Accelerations of bodies: those of one group add up in one process.
pub(super) fn accelerations(mesh: &Mesh, texts: &Histories) -> Vec<String> {
    let mut by_group: Vec<(&str, [Vec<String>; 3])> = Vec::new();
    for load in &mesh.loads {
        let terms: [Option<String>; 3] = match &load.kind {
            LoadKind::Acceleration(values) => values
                .each_ref()
                .map(|value| (value.as_constant() != Some(0.0)).then(|| format!("({})", texts.expression(value)))),
            LoadKind::Centrifugal { square, origin, axis } => {
                // a = ω² (1 − e eᵀ) (X − X₀)
                let square = texts.expression(square);
                [0, 1, 2].map(|i| {
                    let term = |j: usize| {
                        let factor = f64::from(u8::from(i == j)) - axis[i] * axis[j];
                        let name = ["X", "Y", "Z"][j];
                        (factor != 0.0).then(|| format!("({factor:?})*({name} - ({:?}))", origin[j]))
                    };
                    let terms: Vec<String> = (0..3).filter_map(term).collect();
                    (!terms.is_empty()).then(|| format!("({square})*({})", terms.join(" + ")))
                })
            }
            _ => continue,
        };
        let at = by_group.iter().position(|(group, _)| *group == load.group).unwrap_or_else(|| {
            by_group.push((&load.group, [Vec::new(), Vec::new(), Vec::new()]));
            by_group.len() - 1
        });
        by_group[at].1.iter_mut().zip(terms).for_each(|(all, term)| all.extend(term));
    }
    let text = |(group, components): (&str, [Vec<String>; 3])| {
        let value = |terms: Vec<String>| {
            if terms.is_empty() { "0.0".to_owned() } else { format!("\"{}\"", terms.join(" + ")) }
        };
        let values = format!("\"value\": [{}]", components.map(value).join(", "));
        let free = "\"constrained\": false".to_owned();
        process(
            "assign_vector_variable_process",
            CORE,
            &[part(group), word("variable_name", "VOLUME_ACCELERATION"), free, values],
        )
    };
    by_group.into_iter().map(text).collect()
}

/// Forces of many nodes, which a file gives node by node.
pub(super) fn forces_of_file(group: &str, file: &str, space: usize) -> Vec<String> {
    let components = ["X", "Y", "Z"].into_iter().take(space);
    let one = |component| {
        let variable = word("variable_name", &format!("POINT_LOAD_{component}"));
        process("assign_scalar_input_to_conditions_process", CORE, &[part(group), variable, word("file", file)])
    };
    components.map(one).collect()
}

/// A coupling; supports of the reference node decide who leads.
pub(super) fn coupling(coupling: &Coupling, supports: &[Support], space: usize) -> String {
    let mut parameters = vec![
        part(&coupling.group),
        word("reference_model_part_name", &format!("Structure.{}", coupling.reference)),
        format!("\"reference_point\": {}", vector(&coupling.point)),
    ];
    let module = if coupling.is_rigid { "kinematic_coupling_process" } else { "distributing_coupling_process" };
    if coupling.is_rigid && coupling.components != [true; 3] {
        parameters.push(format!("\"components\": {:?}", coupling.components));
    }
    if coupling.mass != 0.0 {
        parameters.push(format!("\"mass\": {:?}", coupling.mass));
    }
    if let Some(inertia) = coupling.inertia {
        let text = if space == 3 { format!("{inertia:?}") } else { format!("{:?}", inertia[2][2]) };
        parameters.push(format!("\"inertia\": {text}"));
    }
    if !coupling.is_rigid && supports.iter().any(|support| support.group == coupling.reference) {
        parameters.push("\"reference_node_leads\": true".to_owned());
    }
    process(module, STRUCTURAL, &parameters)
}

pub(super) fn sector(sector: &Cyclic) -> String {
    let rotation = format!(
        "\"transformation_settings\": {{\"rotation_settings\": {{\"center\": {}, \"axis_of_rotation\": {}, \"angle_degree\": {:?}}}}}",
        vector(&sector.origin),
        vector(&sector.axis),
        sector.angle
    );
    let parameters = [
        word("model_part_name", "Structure"),
        word("first_model_part_name", &sector.first),
        word("second_model_part_name", &sector.second),
        "\"variable_names\": [\"DISPLACEMENT\"]".to_owned(),
        rotation,
    ];
    process("apply_periodic_condition_process", CORE, &parameters)
}

pub(super) fn clearance(clearance: &Clearance) -> String {
    let parameters = [
        part(&clearance.slave),
        word("master_model_part_name", &format!("Structure.{}", clearance.master)),
        format!("\"clearance\": {:?}", clearance.value),
    ];
    process("initial_clearance_process", CONTACT, &parameters)
}

pub(super) fn bolt(bolt: &Bolt, texts: &mut Histories) -> Option<String> {
    let (key, value) = match (&bolt.force, &bolt.shortening) {
        (Some(force), _) => ("force", force),
        (None, Some(shortening)) => ("shortening", shortening),
        (None, None) => return None,
    };
    let mut parameters = vec![
        part(&bolt.group),
        word("section_model_part_name", &format!("Structure.{}", bolt.section)),
        format!("\"{key}\": {}", texts.value(value)),
    ];
    parameters.extend(interval((0.0, bolt.until)));
    Some(process("bolt_pretension_process", STRUCTURAL, &parameters))
}

pub(super) fn material_axes(axes: &MaterialAxes) -> String {
    let group = part(&axes.group);
    match &axes.axes {
        Axes::Cartesian([first, second, _]) => {
            let both = format!("\"cartesian_local_axis\": [{}, {}]", vector(first), vector(second));
            process("set_cartesian_local_axes_process", STRUCTURAL, &[group, both])
        }
        Axes::Cylindrical { origin, axis } => {
            let axis = format!("\"cylindrical_generatrix_axis\": {}", vector(axis));
            let point = format!("\"cylindrical_generatrix_point\": {}", vector(origin));
            process("set_cylindrical_local_axes_process", STRUCTURAL, &[group, axis, point])
        }
    }
}

pub(super) fn temperature(temperature: &Temperature, texts: &mut Histories) -> String {
    let value = format!("\"value\": {}", texts.value(&temperature.value));
    let free = "\"constrained\": false".to_owned();
    let parameters = [part(&temperature.group), word("variable_name", "TEMPERATURE"), free, value];
    process("assign_scalar_variable_process", CORE, &parameters)
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

pub(super) fn contact(pairs: &[&Pair], module: &str, kind: &str, friction: bool, plane: Option<Plane>) -> String {
    let mut parameters = vec![
        word("model_part_name", "Structure"),
        word("contact_type", kind),
        format!("\"contact_model_part\": {}", by_pair(pairs, surfaces)),
        format!(
            "// slaves: the softer side, of like materials the finer\n          \"assume_master_slave\": {}",
            by_pair(pairs, slaves)
        ),
    ];
    if friction {
        parameters
            .push(format!("\"friction_coefficients\": {}", by_pair(pairs, |pair| format!("{:?}", pair.friction))));
    }
    let soft = pairs.first().filter(|pair| module == "penalty_contact_process" && !pair.soft.is_empty());
    if let Some(pair) = soft {
        parameters.push(format!("\"pressure_overclosure\": {{\"law\": \"table\", \"rows\": {:?}}}", pair.soft));
    }
    let stays: Vec<String> = (0..pairs.len()).filter(|&at| pairs[at].stays).map(|at| format!("\"{at}\"")).collect();
    if !stays.is_empty() {
        parameters.push(format!("\"no_separation\": [{}]", stays.join(", ")));
    }
    if plane == Some(Plane::Axial) {
        parameters.push("\"alternative_formulations\": {\"axisymmetric\": true}".to_owned());
    }
    process(module, CONTACT, &parameters)
}

pub(super) fn tie(pairs: &[&Pair]) -> String {
    let parameters = [
        word("model_part_name", "Structure"),
        format!("\"mesh_tying_model_part\": {}", by_pair(pairs, surfaces)),
        format!("\"assume_master_slave\": {}", by_pair(pairs, slaves)),
    ];
    process("mesh_tying_process", CONTACT, &parameters)
}
