//! Options of `zelus new`: supports, loads, friction and materials, by names of parts.

use zelus_core::Result;
use zelus_core::diagnostics::{Diagnostic, did_you_mean};
use zelus_meshes::conditions::{Load, LoadKind, Support};
use zelus_meshes::history::History;
use zelus_meshes::mesh::{Material, Mesh, Section, word};

use super::formulations::Formulation;
use super::{known_materials, stepping};

/// Supports, loads, friction and materials of the command line.
#[derive(Debug, clap::Args)]
pub(super) struct Options {
    /// Part that is fixed, e.g. Base, or Base=xy for some directions. May be repeated. Replaces supports that names suggest.
    #[arg(long, value_name = "PART[=xyz]")]
    fix: Vec<String>,
    /// Load on a part: a total force with its direction, e.g. Top=1000N,-z, or a pressure, e.g. Bore=5MPa. It grows with the time. May be
    /// repeated. Units: N, kN; MPa (N and mm). A number without unit is a force.
    #[arg(long, value_name = "PART=SIZE[,DIRECTION]")]
    load: Vec<String>,
    /// Coefficient of friction of all contact pairs.
    #[arg(long, value_name = "NUMBER")]
    friction: Option<f64>,
    /// Formulation of the contact: alm (augmented Lagrangian, the default), penalty, uzawa, perturbed_lagrangian, nitsche or mpc.
    #[arg(long, value_name = "NAME")]
    formulation: Option<String>,
    /// Surface that is the slave of its contact pair. May be repeated. By default the softer side, of like materials the finer, of like
    /// meshes that of the smaller area.
    #[arg(long, value_name = "PART")]
    pub(super) slave: Vec<String>,
    /// Material by name: steel, stainless_steel, aluminium, titanium, concrete; for one part Body=aluminium. In N and mm. May be repeated.
    #[arg(long, value_name = "[PART=]NAME")]
    material: Vec<String>,
}

impl Options {
    /// The formulation of the contact.
    ///
    /// # Errors
    /// A name that is not known, or a formulation that does not go with friction or ties.
    pub(super) fn formulation(&self, mesh: &Mesh) -> Result<Formulation> {
        let is_soft = mesh.pairs.iter().any(|pair| !pair.soft.is_empty());
        let Some(name) = self.formulation.as_deref().or(is_soft.then_some("penalty")) else {
            return Ok(Formulation::default());
        };
        let friction = mesh.pairs.iter().any(|pair| !pair.tied && pair.friction > 0.0);
        Formulation::find(name, friction, mesh.pairs.iter().any(|pair| pair.tied || pair.stays))
    }

    /// Puts supports, loads, friction and materials of parts into the mesh; gives the material of all other parts.
    ///
    /// # Errors
    /// Parts and materials that are not there, values that cannot be read.
    pub(super) fn apply(&self, mesh: &mut Mesh) -> Result<Option<Material>> {
        for text in &self.fix {
            let (part, directions) = text.split_once('=').unwrap_or((text, "xyz"));
            let part = part_named(mesh, part, "--fix")?;
            let is_known = !directions.is_empty() && directions.chars().all(|c| "xyz".contains(c));
            if !is_known {
                return Err(wrong(format!("--fix {text}: {directions:?} are no directions"), "write e.g. Base=xy"));
            }
            let values = ['x', 'y', 'z'].map(|axis| directions.contains(axis).then(History::default));
            mesh.supports.push(Support::of(part, values));
        }
        for text in &self.load {
            let load = load_of(text, mesh)?;
            mesh.loads.push(load);
        }
        if let Some(friction) = self.friction {
            if !(friction.is_finite() && friction >= 0.0) {
                return Err(wrong(format!("--friction {friction} is no coefficient"), "it is 0 or more, e.g. 0.2"));
            }
            mesh.pairs.iter_mut().filter(|pair| !pair.tied).for_each(|pair| pair.friction = friction);
        }
        let mut whole = None;
        for text in &self.material {
            let Some((part, name)) = text.split_once('=') else {
                whole = Some(known_materials::find(text)?);
                continue;
            };
            let part = part_named(mesh, part, "--material")?;
            let dimension = mesh.dimension();
            let is_body = |cell: &u32| mesh.cells.shapes[*cell as usize].dim() == dimension;
            if !mesh.group(&part).is_some_and(|group| group.cells.iter().any(is_body)) {
                return Err(wrong(format!("--material {text}: the part {part} has no elements"), "name a body"));
            }
            let material = known_materials::find(name)?;
            let section = Section { group: part, material: material.name.clone(), thickness: 1.0 };
            mesh.sections.push(section);
            mesh.materials.push(material);
        }
        Ok(whole)
    }
}

fn wrong(fact: String, remedy: &str) -> zelus_core::Error {
    Diagnostic::error("command-line", fact).remedy(remedy).into()
}

/// The part of a name as the file has it.
fn part_named(mesh: &Mesh, part: &str, option: &str) -> Result<String> {
    let name = word(part);
    if mesh.group(&name).is_some() {
        return Ok(name);
    }
    let names: Vec<&str> = mesh.groups.iter().map(|group| group.name.as_str()).collect();
    let known =
        if names.is_empty() { "the mesh has no parts".to_owned() } else { format!("parts: {}", names.join(", ")) };
    let remedy = did_you_mean(part, names.iter().copied()).unwrap_or(known);
    Err(wrong(format!("{option}: the mesh has no part {part:?}"), &remedy))
}

/// `Top=1000N,-z` or `Bore=5MPa`.
fn load_of(text: &str, mesh: &Mesh) -> Result<Load> {
    let form = "write a force as Top=1000N,-z and a pressure as Bore=5MPa";
    let (part, value) = text.split_once('=').ok_or_else(|| wrong(format!("--load {text} has no value"), form))?;
    let part = part_named(mesh, part, "--load")?;
    let (size, direction) = value.split_once(',').map_or((value, None), |(size, direction)| (size, Some(direction)));
    let units = [("MPa", 1.0), ("kN", 1000.0), ("N", 1.0)];
    let unit = units.iter().find_map(|(unit, factor)| Some((size.strip_suffix(unit)?, *unit, *factor)));
    let (number, unit, factor) = unit.unwrap_or((size, "", 1.0));
    let number: f64 = number.trim().parse().unwrap_or(f64::NAN);
    if !number.is_finite() {
        return Err(wrong(format!("--load {text}: {size:?} is no number with unit"), form));
    }
    let course = |value: f64| History::ramp(stepping::end(mesh), value);
    let kind = match (unit, direction) {
        ("MPa", None) => LoadKind::Pressure(course(number)),
        ("MPa", Some(_)) => return Err(wrong(format!("--load {text}: a pressure acts along the normal"), form)),
        (_, None) => return Err(wrong(format!("--load {text}: a force has a direction"), form)),
        (_, Some(direction)) => {
            let (sign, axis) = match direction.strip_prefix('-') {
                Some(axis) => (-1.0, axis),
                None => (1.0, direction.trim_start_matches('+')),
            };
            let at = ["x", "y", "z"].iter().position(|own| *own == axis);
            let at = at.ok_or_else(|| wrong(format!("--load {text}: {direction:?} is no direction"), form))?;
            LoadKind::Total(
                [0, 1, 2].map(|i| if i == at { course(sign * factor * number) } else { History::default() }),
            )
        }
    };
    let has_faces = mesh.group(&part).is_some_and(|group| {
        group.cells.iter().any(|&cell| mesh.cells.shapes[cell as usize].dim() + 1 == mesh.dimension())
    });
    if matches!(kind, LoadKind::Pressure(_)) && !has_faces {
        return Err(wrong(format!("--load {text}: the part {part} has no faces"), "name a surface"));
    }
    Ok(Load { group: part, kind })
}
