//! Makes elements and conditions on the geometries of model parts.

use std::path::Path;

use super::modeler::{Modeler, ModelerEntry};
use crate::diagnostics::{Diagnostic, Error, Place, Report, Result};
use crate::entities::{find_kind, kind_names, require_kind};
use crate::model::{EntityKind, EntityRole, EntityTable, Model, ModelPart};
use crate::parameters::{Node, Settings};
use crate::register;

/// One row of a list: the part whose geometries are used, and the kind of entity to make.
struct EntityRow {
    role: EntityRole,
    part: String,
    /// Candidates; the one on the cell and space of a geometry is made of it.
    entries: Vec<&'static EntityKind>,
    name: String,
    place: Place,
}

struct CreateEntities {
    all: Vec<EntityRow>,
}

fn build(settings: &Settings, _folder: &Path) -> Result<Box<dyn Modeler>> {
    let mut all = Vec::new();
    for (list, key, role) in [
        ("elements_list", "element_name", EntityRole::Element),
        ("conditions_list", "condition_name", EntityRole::Condition),
    ] {
        for item in settings.items(list)? {
            let part = item.require("model_part_name")?.str()?.to_owned();
            let name = item.require(key)?;
            let entries = candidates(role, name)?;
            all.push(EntityRow { role, part, entries, name: name.str()?.to_owned(), place: name.place() });
        }
    }
    Ok(Box::new(CreateEntities { all }))
}

/// Registered kinds that a name stands for: itself, several with `;` between, or all that fit `#D` and `#N`.
///
/// # Errors
/// Names that are not registered.
fn candidates(role: EntityRole, node: &Node) -> Result<Vec<&'static EntityKind>> {
    let name = node.str()?;
    let Some((stem, rest)) = name.split_once('#') else {
        let found = name.split(';').map(|one| require_kind(role, one).map_err(|d| Error::from(d.at(node.place()))));
        return found.collect();
    };
    let rest = rest.strip_prefix('D').unwrap_or(rest);
    let fits = |known: &&str| {
        let shape = known.strip_prefix(stem).and_then(|k| k.strip_prefix("2D").or_else(|| k.strip_prefix("3D")));
        shape.is_some_and(|shape| match rest.split_once("#N") {
            None => shape == rest,
            Some((before, after)) => {
                let number = shape.strip_prefix(before).and_then(|s| s.strip_suffix(after));
                let number = number.and_then(|s| s.strip_suffix('N'));
                number.is_some_and(|n| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit()))
            }
        })
    };
    let found: Vec<_> =
        kind_names(role).into_iter().filter(|known| fits(known)).filter_map(|known| find_kind(role, known)).collect();
    if found.is_empty() {
        let fact = format!("no {} has a name of the form {name:?}", role.word());
        let remedy = format!("`zelus list {}` shows the names; #D stands for 2D or 3D, #N for the nodes", role.word());
        return Err(Diagnostic::error("unknown-name", fact).at(node.place()).remedy(remedy).into());
    }
    Ok(found)
}

impl EntityRow {
    fn make(&self, model: &mut Model, report: &mut Report) -> Result<()> {
        let root = model.root_mut(&self.part).map_err(|error| error.at(&self.place))?;
        let selected = root.part(&self.part).map_err(|error| error.at(&self.place))?.clone();
        let present = if self.role == EntityRole::Element { &selected.elements } else { &selected.conditions };
        if !present.is_empty() {
            let fact = format!("{:?} has {} {}s already", self.part, present.len(), self.role.word());
            let remedy = "leave them out of the mesh file, or this part out of the list: nothing is replaced";
            return Err(Diagnostic::error("not-empty", fact).at(self.place.clone()).remedy(remedy).into());
        }
        let ModelPart { geometries, elements, conditions, .. } = &mut *root;
        let table: &mut EntityTable = if self.role == EntityRole::Element { elements } else { conditions };
        let (mut id, mut made) = (table.max_id(), Vec::new());
        for &geometry in &selected.geometries {
            let cell = geometries.cells[geometry as usize];
            let fitting = self.entries.iter().find(|entry| (entry.cell, entry.space) == (Some(cell.0), cell.1));
            let Some(entry) = fitting else { continue };
            id += 1;
            made.push(table.push(id, entry, 0, geometries.nodes(geometry)));
        }
        table.finish();
        geometries.used |= !made.is_empty();
        // Faces may stand in the list of a body: geometries of other shapes are left alone.
        if made.is_empty() {
            let fact = match selected.geometries.len() {
                0 => format!("{:?} has no geometries", self.part),
                count => format!("none of the {count} geometries of {:?} has the shape of {}", self.part, self.name),
            };
            report.push(Diagnostic::warning("other-geometry", fact).at(self.place.clone()));
        }
        root.along(&self.part, |part| {
            let list = if self.role == EntityRole::Element { &mut part.elements } else { &mut part.conditions };
            list.extend(&made);
            list.sort_unstable();
        });
        Ok(())
    }
}

impl Modeler for CreateEntities {
    fn setup_model_part(&mut self, model: &mut Model, report: &mut Report) -> Result<()> {
        self.all.iter().try_for_each(|wanted| wanted.make(model, report))
    }
}

register! { ModelerEntry "CreateEntitiesFromGeometriesModeler",
    aliases: &["create_entities_from_geometries_modeler"],
    about: "makes elements and conditions on the geometries of model parts",
    defaults: include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../configs/modelers/CreateEntitiesFromGeometriesModeler.json"
    )),
    build: build,
}
