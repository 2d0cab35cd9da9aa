//! Mesh of a solver of heat: its own elements and faces, turned the right way, and materials at nodes.

use zelus_core::diagnostics::{Diagnostic, Report, Result, counted};
use zelus_core::entities::find_kind;
use zelus_core::geometry::{Shape, mapping};
use zelus_core::model::{EntityRole, EntityTable, ModelPart, Properties};
use zelus_core::parameters::{Node, Settings};

use crate::columns::Columns;
use crate::semi_implicit::DIFFUSION;

/// Data of elements and conditions: id of the properties that heat has there, 0 for none.
pub(crate) const PROPERTIES: &str = "THERMAL_PROPERTIES";

/// The properties that heat has in an element, be it alone or beside a structure.
pub fn properties_of_heat(part: &ModelPart, element: u32) -> Option<&Properties> {
    let beside = part.elements.data.level(PROPERTIES, 0).get(element as usize).copied().unwrap_or(0.0);
    let own = part.elements.properties.get(element as usize).copied();
    part.properties.get(&if beside > 0.0 { beside as usize } else { own? })
}

/// Takes up a part as the settings say.
///
/// # Errors
/// Elements that are not there for a shape of the mesh, names of variables that are none.
pub fn adopt(settings: &Settings, part: &mut ModelPart, report: &mut Report) -> Result<()> {
    Columns::store(settings, part)?;
    if !settings.get_bool("skip_entities_replace_and_check")? {
        let ModelPart { nodes, elements, conditions, info, .. } = &mut *part;
        for (role, table) in [(EntityRole::Element, &mut *elements), (EntityRole::Condition, &mut *conditions)] {
            let key = format!("element_replace_settings.{}_name", role.word());
            let name = match settings.node().get("time_integration_method").and_then(Node::as_str) {
                Some("semi_implicit") if role == EntityRole::Element => DIFFUSION,
                _ => settings.get_str(&key)?,
            };
            replace(role, table, name, info.domain_size).map_err(|problem| problem.at(settings.key_place(&key)))?;
        }
        let turned = turn(elements, &nodes.initial, info.domain_size);
        if turned > 0 {
            let fact = format!(
                "the order of nodes is reversed in {} inside out",
                counted(turned, "element, which was", "elements, which were")
            );
            report.push(Diagnostic::note("turned-elements", fact).remedy("nothing to do"));
        }
    }
    write_materials(part);
    Ok(())
}

/// The name without the shape at its end: `ThermalFace` of `ThermalFace2D2N`.
fn stem(name: &str) -> &str {
    let bare = name.strip_suffix('N').map_or(name, |rest| rest.trim_end_matches(|c: char| c.is_ascii_digit()));
    ["2D", "3D"].iter().find_map(|space| bare.strip_suffix(space)).unwrap_or(name)
}

/// Puts the named kind in the place of each piece of the body or its boundary, by its shape; others stay as they are.
///
/// # Errors
/// A kind that is not there for a shape of the mesh.
pub fn replace(role: EntityRole, table: &mut EntityTable, name: &str, space: usize) -> Result<(), Diagnostic> {
    let dim = if role == EntityRole::Element { space } else { space - 1 };
    for at in 0..table.len() {
        let Some(cell) = table.kinds[at].cell.filter(|cell| cell.dim() == dim) else { continue };
        let full = format!("{}{space}D{}N", stem(name), cell.nodes());
        table.kinds[at] = find_kind(role, &full).filter(|kind| kind.cell == Some(cell)).ok_or_else(|| {
            let fact = format!(
                "{} {} of the mesh cannot become {full}: there is no such {}",
                table.kinds[at].name,
                table.ids[at],
                role.word()
            );
            Diagnostic::error(if role == EntityRole::Element { "unknown-element" } else { "unknown-condition" }, fact)
                .remedy("`zelus list element` and `zelus list condition` show what there is")
        })?;
    }
    Ok(())
}

/// Turns triangles of the plane and tetrahedra of negative size; how many there were.
fn turn(table: &mut EntityTable, positions: &[[f64; 3]], space: usize) -> usize {
    let mut count = 0;
    for at in 0..table.len() {
        let simplex = matches!((space, table.kinds[at].cell), (2, Some(Shape::Tri3)) | (3, Some(Shape::Tet4)));
        let Some(cell) = table.kinds[at].cell.filter(|_| simplex) else { continue };
        let x: Vec<[f64; 3]> = table.nodes(at as u32).iter().map(|&node| positions[node as usize]).collect();
        if mapping::signed_det_jacobian(cell, &x, cell.cell().centre) < 0.0 {
            table.nodes_mut(at as u32).swap(0, 1);
            count += 1;
        }
    }
    count
}

/// Warns of materials without heat storage, and of the consequence, `follows`.
pub fn warn_of_no_storage(part: &ModelPart, follows: &str, report: &mut Report) {
    let columns = Columns::of(part);
    let mut ids = part.elements.properties.clone();
    ids.sort_unstable();
    ids.dedup();
    for properties in ids.iter().filter_map(|id| part.properties.get(id)) {
        let says =
            |name: &str| properties.values.contains_key(name) || properties.tables.keys().any(|(_, of)| of == name);
        if let Some(name) = [columns.density, columns.specific_heat].into_iter().flatten().find(|name| !says(name)) {
            let fact = format!("properties {} have no {name}: {follows}", properties.id);
            let warning = Diagnostic::warning("no-storage", fact).at(properties.place.clone());
            report.push(warning.remedy(format!("add \"{name}\" to the \"Variables\" of this material")));
        }
    }
}

/// Writes density, conductivity and specific heat of the materials to the nodes, those of later properties over those of earlier ones,
/// and keeps a copy: where they differ later, a process has set them.
pub fn write_materials(part: &mut ModelPart) {
    let columns = Columns::of(part);
    let mut order: Vec<u32> = (0..part.elements.len() as u32).collect();
    order.sort_by_key(|&at| part.elements.properties[at as usize]);
    for column in [columns.density, columns.diffusion, columns.specific_heat].into_iter().flatten() {
        part.nodes.values.add_named(column, 1);
        let mut values = part.nodes.history.level(column, 0).to_vec();
        for &at in &order {
            let properties = part.properties.get(&part.elements.properties[at as usize]);
            if let Some(value) = properties.and_then(|properties| properties.number(column)) {
                part.elements.nodes(at).iter().for_each(|&node| values[node as usize] = value);
            }
        }
        part.nodes.history.write_level(column, 0, &values);
        part.nodes.values.write_level(column, 0, &values);
    }
}
