//! The materials file: properties, laws and tables, given to the entities of model parts.

use std::collections::BTreeMap;
use std::path::Path;

use super::given_materials::{GivenMaterials, is_part_of};
use super::variable_names::{composed_law, kind_of, last_of_path, law_name, unknown_variable, without_effect};
use crate::diagnostics::{Diagnostic, Error, Place, Report, Result, did_you_mean};
use crate::model::{MaterialRange, ModelPart, Properties, PropertyValue, Table, VariableKind};
use crate::parameters::{Document, Node};

/// Reads a materials file and gives its properties to the parts it names; gives the warnings.
///
/// Entries act in the order of the file. Properties that exist are completed: values of the file win, others stay.
///
/// # Errors
/// Every key, name, type and part that does not fit, with its place.
pub fn read_materials(path: &Path, part: &mut ModelPart) -> Result<Vec<Diagnostic>> {
    let document = Document::read(path)?;
    let warnings = apply_materials(&document.root, part)?;
    Ok(document.warnings.into_iter().chain(warnings).collect())
}

/// Reads the materials file that a deck names at `place` into `part`; gives the warnings.
///
/// # Errors
/// No such file; as [`read_materials`].
pub fn read_materials_of(path: &Path, place: &Place, part: &mut ModelPart) -> Result<Vec<Diagnostic>> {
    if !path.is_file() {
        return Err(Diagnostic::error("missing-file", format!("there is no materials file {}", path.display()))
            .at(place.clone())
            .remedy("\"materials_filename\" is relative to the deck")
            .into());
    }
    read_materials(path, part)
}

/// As [`read_materials`], from a tree already read.
///
/// # Errors
/// As [`read_materials`].
pub fn apply_materials(root: &Node, part: &mut ModelPart) -> Result<Vec<Diagnostic>> {
    let mut report = Report::new();
    let mut seen: Vec<String> = Vec::new();
    let mut ids: BTreeMap<usize, Place> = BTreeMap::new();
    let mut given = GivenMaterials::new(part);
    warn_of_keys(root, "the materials file", &["properties"], &mut report);
    for item in root.require("properties")?.array()? {
        let Some((mut name, id)) = report.absorb(head(item)) else { continue };
        if !is_part_of(&name, &part.name)
            && let Some((full, warning)) = part.named_without_root(&name)
        {
            report.push(warning.at(item.key_place("model_part_name")));
            name = full;
        }
        if let Some(problem) = misplaced(&name, &seen, part) {
            report.push(problem.at(item.key_place("model_part_name")));
        }
        if let Some(first) = ids.insert(id, item.place()) {
            let fact =
                format!("properties {id} are given twice, first at {first}: the later ones would rule both parts");
            let remedy = "give each material a \"properties_id\" of its own";
            report.push(
                Diagnostic::error("repeated-properties", fact).at(item.key_place("properties_id")).remedy(remedy),
            );
        }
        let mut properties = part.properties.remove(&id).unwrap_or_else(|| Properties::new(id));
        properties.place = Some(item.place());
        read_item(item, &mut properties, part.info.domain_size, &mut report);
        part.properties.insert(id, properties);
        if let Ok(selected) = part.part(&name) {
            let (elements, conditions) = (selected.elements.clone(), selected.conditions.clone());
            let problem = given.give(&elements, &seen, &name, id, part);
            problem.into_iter().for_each(|problem| report.push(problem.at(item.key_place("model_part_name"))));
            elements.iter().for_each(|&at| part.elements.properties[at as usize] = id);
            conditions.iter().for_each(|&at| part.conditions.properties[at as usize] = id);
        }
        part.along(&name, |part| {
            if !part.properties.contains(&id) {
                part.properties.push(id);
                part.properties.sort_unstable();
            }
        });
        seen.push(name);
    }
    report.finish()
}

/// Material and sub-properties of one entry.
fn read_item(item: &Node, properties: &mut Properties, domain_size: usize, report: &mut Report) {
    let known = ["model_part_name", "properties_id", "Material", "sub_properties"];
    warn_of_keys(item, "a material", &known, report);
    if let Some(material) = item.get("Material") {
        read_material(material, properties, domain_size, report);
    }
    let Some(subs) = item.get("sub_properties") else { return };
    for sub in report.absorb(subs.array()).unwrap_or_default() {
        let Some(id) = report.absorb(sub.require("properties_id").and_then(Node::usize)) else { continue };
        let mut own = Properties::new(id);
        own.place = Some(sub.place());
        read_item(sub, &mut own, domain_size, report);
        properties.parts.push(own);
    }
    if !properties.law.as_ref().is_some_and(|law| law.contains("Mixtures")) {
        let fact = format!("the law of properties {} does not use sub-properties", properties.id);
        let remedy = "laws of mixtures do: ParallelRuleOfMixturesLaw3D or 2D";
        report.push(Diagnostic::warning("unused-key", fact).at(subs.place()).remedy(remedy));
    }
}

/// Warns of keys of `object` that nothing reads; those that begin with an underscore, "$" or "comment" are words to readers
/// and editors.
fn warn_of_keys(object: &Node, name: &str, known: &[&str], report: &mut Report) {
    let own = object.as_object().into_iter().flat_map(|object| object.in_source_order());
    let is_remark = |key: &str| key.starts_with(['_', '$']) || key.to_ascii_lowercase().starts_with("comment");
    for member in own.filter(|member| !known.contains(&member.key.as_str()) && !is_remark(&member.key)) {
        let remedy = did_you_mean(&member.key, known.iter().copied());
        let remedy = remedy.unwrap_or_else(|| format!("read are: {}", known.join(", ")));
        let fact = format!("nothing reads {:?} of {name}", member.key);
        let warning = Diagnostic::warning("unknown-key-ignored", fact).at(object.key_place(&member.key));
        report.push(warning.remedy(remedy));
    }
}

fn head(item: &Node) -> Result<(String, usize)> {
    Ok((item.require("model_part_name")?.str()?.to_owned(), item.require("properties_id")?.usize()?))
}

/// Why the entry for the part `name` cannot stand after those for `seen`.
fn misplaced(name: &str, seen: &[String], part: &ModelPart) -> Option<Diagnostic> {
    if !is_part_of(name, &part.name) {
        let fact = format!("{name:?} does not begin with the root model part {:?}", part.name);
        let remedy = format!("parts are addressed by full path, as \"{}.Parts\"", part.name);
        return Some(Diagnostic::error("unknown-model-part", fact).remedy(remedy));
    }
    if let Err(crate::Error::Input(mut problems)) = part.part(name) {
        return problems.pop();
    }
    if seen.iter().any(|other| other == name) {
        let fact = format!("{name:?} has material properties already");
        return Some(Diagnostic::error("repeated-material", fact).remedy("keep one entry a model part"));
    }
    let child = seen.iter().find(|other| *other != name && is_part_of(other, name))?;
    let fact = format!("{name:?} comes after its sub part {child:?} and would override it");
    Some(Diagnostic::error("material-order", fact).remedy("put the entry of the parent first"))
}

fn read_material(material: &Node, properties: &mut Properties, domain_size: usize, report: &mut Report) {
    let known = ["name", "constitutive_law", "Variables", "Tables", "accessors", "sub_properties"];
    warn_of_keys(material, "\"Material\"", &known, report);
    if let Some(given) = material.get("constitutive_law")
        && let Some(law) = given.get("name")
        && let Some(name) = report.absorb(law.str())
    {
        let parts = ["yield_surface", "plastic_potential"].map(|key| given.get(key).and_then(Node::as_str));
        let composed = match parts {
            [Some(surface), Some(potential)] => composed_law(name, [surface, potential], domain_size),
            _ => None,
        };
        match law_name(composed.as_deref().unwrap_or(name)) {
            Ok(name) => properties.law = Some(name),
            Err(problem) => report.push(problem.at(law.place())),
        }
    }
    let law = material.get("constitutive_law");
    for member in law.and_then(Node::as_object).into_iter().flat_map(|o| o.in_source_order()) {
        let known = ["name", "yield_surface", "plastic_potential"];
        if member.node.as_array().is_none()
            && let Some(law) = law
            && !known.contains(&member.key.as_str())
        {
            let fact = format!("nothing reads {:?} of \"constitutive_law\"", member.key);
            let warning = Diagnostic::warning("unknown-key-ignored", fact).at(law.key_place(&member.key));
            report.push(warning.remedy(format!("read are: {}, and lists of numbers", known.join(", "))));
        }
        if let Some(list) = member.node.as_array()
            && let Some(numbers) = report.absorb(list.iter().map(Node::f64).collect())
        {
            properties.law_lists.insert(member.key.clone(), numbers);
        }
    }
    for member in material.get("Variables").and_then(Node::as_object).into_iter().flat_map(|o| o.in_source_order()) {
        let name = last_of_path(&member.key);
        let Some(kind) = kind_of(name) else {
            report.push(unknown_variable(name).at(material.get("Variables").map(|v| v.key_place(&member.key))));
            continue;
        };
        if let Some(warning) = without_effect(name) {
            report.push(warning.at(material.get("Variables").map(|v| v.key_place(&member.key))));
        }
        if let Some(value) = report.absorb(value(&member.node, kind).map_err(|error| about(&member.key, error))) {
            if let PropertyValue::Number(number) = value {
                check_range(name, number, properties.id, &member.node, report);
            }
            properties.values.insert(name.to_owned(), value);
        }
    }
    for member in material.get("Tables").and_then(Node::as_object).into_iter().flat_map(|o| o.in_source_order()) {
        let read = table(&member.key, &member.node, report);
        if let Some((names, table)) = report.absorb(read) {
            for name in [&names.0, &names.1] {
                if kind_of(name).is_none() {
                    report.push(unknown_variable(name).at(member.node.place()));
                }
            }
            table.points.iter().for_each(|[_, number]| {
                check_range(&names.1, *number, properties.id, &member.node, report);
            });
            properties.tables.insert(names, table);
        }
    }
    if let Some(inner) = material.get("sub_properties") {
        let remedy = "put \"sub_properties\" beside \"Material\", as Kratos reads them";
        let problem = Diagnostic::error("misplaced-key", "\"sub_properties\" inside \"Material\" are not read");
        report.push(problem.at(inner.place()).remedy(remedy));
    }
}

/// Reports a constant outside the range of its variable.
fn check_range(name: &str, number: f64, properties: usize, node: &Node, report: &mut Report) {
    let Some(range) = MaterialRange::of(name).filter(|range| !range.holds(number)) else { return };
    let fact = format!("{name} of properties {properties} is {number}, it must be {range}");
    report.push(Diagnostic::error("material-out-of-range", fact).at(node.place()));
}

/// The same problems, named after the variable.
fn about(key: &str, error: Error) -> Error {
    match error {
        Error::Input(mut problems) => {
            problems.iter_mut().for_each(|problem| problem.fact = format!("{key}: {}", problem.fact));
            Error::Input(problems)
        }
        other => other,
    }
}

fn value(node: &Node, kind: VariableKind) -> Result<PropertyValue> {
    let numbers = |node: &Node| node.array()?.iter().map(Node::f64).collect::<Result<Vec<f64>>>();
    Ok(match kind {
        VariableKind::Scalar => PropertyValue::Number(node.f64()?),
        VariableKind::Integer => PropertyValue::Number(node.i64()? as f64),
        VariableKind::Boolean => PropertyValue::Boolean(node.bool()?),
        VariableKind::Vector => PropertyValue::Vector(numbers(node)?),
        VariableKind::Vector3 => {
            let values = numbers(node)?;
            if values.len() != 3 {
                let fact = format!("expected three numbers, found {}", values.len());
                return Err(Diagnostic::error("wrong-size", fact).at(node.place()).into());
            }
            PropertyValue::Vector(values)
        }
        VariableKind::Matrix => PropertyValue::Matrix(node.array()?.iter().map(numbers).collect::<Result<_>>()?),
        VariableKind::Text => PropertyValue::Text(node.str()?.to_owned()),
    })
}

fn table(name: &str, node: &Node, report: &mut Report) -> Result<((String, String), Table)> {
    let variable = |key: &str| Ok::<_, crate::Error>(last_of_path(node.require(key)?.str()?).to_owned());
    let names = (variable("input_variable")?, variable("output_variable")?);
    let mut points = Vec::new();
    for row in node.require("data")?.array()? {
        match row.array()? {
            [x, y] => points.push([x.f64()?, y.f64()?]),
            other => {
                let fact = format!("a row of a table has two numbers, this one {}", other.len());
                return Err(Diagnostic::error("wrong-size", fact).at(row.place()).into());
            }
        }
    }
    Table::fault(&format!("{name:?}"), &points).into_iter().for_each(|fault| report.push(fault.at(node.place())));
    Ok((names, Table::new(points)))
}
