//! `zelus new`: a deck to start from, made of a mesh.

mod deck;
mod materials;
mod supports;

use std::io::Write;
use std::path::{Path, PathBuf};

use zelus_core::diagnostics::{Diagnostic, Place};
use zelus_core::entities::find_kind;
use zelus_core::io::mdpa::{self, MdpaDocument, MdpaEntities};
use zelus_core::io::replace_own_file;
use zelus_core::model::EntityRole;
use zelus_core::{Error, Result};
use zelus_meshes::document::{Names, document};
use zelus_meshes::mesh::{LoadKind, Material, Mesh, Plane};
use zelus_meshes::repair::is_planar;
use zelus_meshes::{format, proximity, read};

use super::meshes::counts;
use super::say::say;

/// Beginnings of the names of elements: the usual ones, and those for materials that hardly change their volume.
const PLAIN: &str = "SmallDisplacementElement";
const MIXED: &str = "SmallDisplacementMixedVolumetricStrainElement";
/// Poisson's ratio above which the usual ones of first order lock.
const LOCKS: f64 = 0.49;

/// The command line of `zelus new`.
#[derive(Debug, clap::Args)]
pub(super) struct NewArguments {
    /// The mesh, e.g. part.msh, part.inp, part.vtu or part.mdpa.
    #[arg(long, value_name = "MESH")]
    from: PathBuf,
    /// The folder of the deck; by default named after the mesh. No file in it is replaced.
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// The format of the mesh, whatever its ending.
    #[arg(long)]
    format: Option<String>,
    /// Beginning of the names of elements.
    #[arg(long, value_name = "NAME", default_value = PLAIN)]
    element_name: String,
}

/// Reads the mesh and writes deck, materials and mesh file.
pub(super) fn run(arguments: &NewArguments) -> Result<()> {
    let from = &arguments.from;
    let source = format(from, arguments.format.as_deref())?;
    if !from.is_file() {
        return Err(Diagnostic::error("missing-file", format!("there is no mesh file {}", from.display())).into());
    }
    let (mut mesh, mut said) = read(from, source)?;
    let stated = mesh.pairs.len();
    if stated == 0 {
        mesh.pairs = proximity::find_pairs(&mut mesh);
    }
    let names = Names { element: arguments.element_name.clone(), condition: String::new() };
    let mut document = document(&mesh, &names, &Place::file(from), &mut said);
    let mixed = arguments.element_name == PLAIN && take_mixed_elements(&mesh, &mut document);
    add_point_loads(&mesh, &mut document);
    let stem = from.file_stem().map_or("mesh".to_owned(), |stem| stem.to_string_lossy().into_owned());
    let folder = arguments.output.clone().unwrap_or_else(|| PathBuf::from(&stem));
    let space = if is_planar(&mesh) && mesh.dimension() < 3 { 2 } else { 3 };
    let supports = supports::of(&mesh);
    let (deck, materials) = (deck::text(&mesh, &stem, space, &supports), materials::text(&mesh, space));
    let files = ["ProjectParameters.json".to_owned(), "StructuralMaterials.json".to_owned(), format!("{stem}.mdpa")];
    std::fs::create_dir_all(&folder)
        .map_err(|error| Error::System(format!("{}: cannot be made: {error}", folder.display())))?;
    let paths = files.each_ref().map(|name| folder.join(name));
    if let Some(there) = paths.iter().find(|path| path.exists()) {
        let problem = Diagnostic::error("output-file", format!("{} is there already", there.display()));
        return Err(problem.remedy("name another folder by --output, or remove the file").into());
    }
    let [deck_path, materials_path, mesh_path] = &paths;
    put(deck_path, &deck)?;
    put(materials_path, &materials)?;
    mdpa::write(&document, mesh_path)?;
    said.iter().for_each(|problem| say(&problem.to_string()));
    say(&counts(&document));
    for pair in &mesh.pairs {
        let what = if pair.tied { "tied" } else { "contact" };
        let found = if stated == 0 { ", found by proximity" } else { "" };
        say(&format!("{what}: slave {}, master {}{found}", pair.slave, pair.master));
    }
    if mixed {
        say(&format!("elements: {MIXED}, since {PLAIN} locks at Poisson's ratios above {LOCKS}"));
    }
    if supports.is_empty() {
        say("no supports are known: state them in the deck before it is run");
    }
    say(&format!("written: {}; `zelus check {}` is next", folder.display(), deck_path.display()));
    Ok(())
}

fn put(path: &Path, text: &str) -> Result<()> {
    replace_own_file(path, |file| file.write_all(text.as_bytes()))
}

/// Takes elements that do not lock where a material of the mesh hardly changes its volume; whether it did. Elements of second order stay,
/// and rings and plane stress have none.
fn take_mixed_elements(mesh: &Mesh, document: &mut MdpaDocument) -> bool {
    let is_near_half = |material: &Material| material.young.is_some() && material.poisson > LOCKS;
    if matches!(mesh.plane, Some(Plane::Stress | Plane::Axial)) || !mesh.materials.iter().any(is_near_half) {
        return false;
    }
    let mut taken = false;
    for block in &mut document.elements {
        let mixed = block.name.strip_prefix(PLAIN).map(|suffix| format!("{MIXED}{suffix}"));
        if let Some(mixed) = mixed.filter(|name| find_kind(EntityRole::Element, name).is_some()) {
            (block.name, taken) = (mixed, true);
        }
    }
    taken
}

/// Gives each node with a force of its own a condition that carries it.
fn add_point_loads(mesh: &Mesh, document: &mut MdpaDocument) {
    let space = if is_planar(mesh) && mesh.dimension() < 3 { 2 } else { 3 };
    let mut next = document.conditions.iter().flat_map(|block| &block.ids).max().map_or(1, |id| id + 1);
    let mut block =
        MdpaEntities { name: format!("PointLoadCondition{space}D1N"), nodes_per_entity: 1, ..MdpaEntities::default() };
    for load in mesh.loads.iter().filter(|load| matches!(load.kind, LoadKind::Force(_))) {
        let Some(part) = document.sub_model_parts.iter_mut().find(|part| part.name == load.group) else { continue };
        for &node in &part.nodes {
            block.ids.push(next);
            block.properties.push(0);
            block.nodes.push(node);
            part.conditions.push(next);
            next += 1;
        }
    }
    if !block.ids.is_empty() {
        document.conditions.push(block);
    }
}
