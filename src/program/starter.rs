//! `zelus new`: a deck to start from, made of a mesh.

mod deck;
mod histories;
mod known_materials;
mod materials;
mod options;
mod point_loads;
mod processes;
mod stepping;
mod supports;
mod thickness;

use std::io::Write;
use std::path::{Path, PathBuf};

use zelus_core::diagnostics::{Diagnostic, Place};
use zelus_core::entities::find_kind;
use zelus_core::io::mdpa::{self, MdpaDocument};
use zelus_core::io::replace_own_file;
use zelus_core::model::EntityRole;
use zelus_core::{Error, Result};
use zelus_meshes::document::{Names, document};
use zelus_meshes::mesh::{Material, Mesh, Plane};
use zelus_meshes::repair::is_planar;
use zelus_meshes::{format, proximity, read};

use self::histories::Histories;
use super::meshes::counts;
use super::say::say;

/// Beginnings of the names of elements: the usual ones, and those for materials that hardly change their volume.
const PLAIN: &str = "SmallDisplacementElement";
const LARGE: &str = "TotalLagrangianElement";
const MIXED: &str = "SmallDisplacementMixedVolumetricStrainElement";
const MIXED_LARGE: &str = "TotalLagrangianMixedVolumetricStrainElement";
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
    /// Beginning of the names of elements; by default SmallDisplacementElement, or TotalLagrangianElement where the file says NLGEOM.
    #[arg(long, value_name = "NAME")]
    element_name: Option<String>,
    #[command(flatten)]
    options: options::Options,
}

/// Reads the mesh and writes deck, materials and mesh file.
pub(super) fn run(arguments: &NewArguments) -> Result<()> {
    let from = &arguments.from;
    let source = format(from, arguments.format.as_deref())?;
    if !from.is_file() {
        return Err(Diagnostic::error("missing-file", format!("there is no mesh file {}", from.display())).into());
    }
    let (mut mesh, mut said) = read(from, source)?;
    // a file with steps states all of its pairs
    let is_found = mesh.pairs.is_empty() && mesh.steps.is_empty();
    if is_found {
        mesh.pairs = proximity::find_pairs(&mut mesh);
    }
    let whole = arguments.options.apply(&mut mesh)?;
    let by_file = if mesh.is_large { LARGE } else { PLAIN };
    let element = arguments.element_name.clone().unwrap_or_else(|| by_file.to_owned());
    mesh.is_large = !element.starts_with("SmallDisplacement");
    let space = if is_planar(&mesh) && mesh.dimension() < 3 { 2 } else { 3 };
    let forces = point_loads::join(&mut mesh);
    let names = Names { element: element.clone(), condition: String::new() };
    let mut document = document(&mesh, &names, &Place::file(from), &mut said);
    let mixed = arguments.element_name.is_none() && take_mixed_elements(&mesh, &element, &mut document);
    point_loads::add(&mesh, &mut document, space, forces.as_ref());
    let stem = from.file_stem().map_or("mesh".to_owned(), |stem| stem.to_string_lossy().into_owned());
    let folder = arguments.output.clone().unwrap_or_else(|| PathBuf::from(&stem));
    let supports = supports::of(&mesh, &mut said);
    let materials = materials::text(&mesh, space, whole.as_ref(), &mut said);
    let mut texts = Histories::new(stepping::end(&mesh));
    let deck = deck::text(&mesh, &stem, space, &supports, forces.as_ref(), &mut texts);
    let mut files =
        vec![("ProjectParameters.json".to_owned(), deck), ("StructuralMaterials.json".to_owned(), materials)];
    files.extend(forces.map(|file| (file.name, file.text)));
    files.extend(texts.files);
    std::fs::create_dir_all(&folder)
        .map_err(|error| Error::System(format!("{}: cannot be made: {error}", folder.display())))?;
    let mesh_path = folder.join(format!("{stem}.mdpa"));
    let paths: Vec<PathBuf> = files.iter().map(|(name, _)| folder.join(name)).collect();
    if let Some(there) = paths.iter().chain([&mesh_path]).find(|path| path.exists()) {
        let problem = Diagnostic::error("output-file", format!("{} is there already", there.display()));
        return Err(problem.remedy("name another folder by --output, or remove the file").into());
    }
    for ((_, text), path) in files.iter().zip(&paths) {
        put(path, text)?;
    }
    mdpa::write(&document, &mesh_path)?;
    said.iter().for_each(|problem| say(&problem.to_string()));
    say(&counts(&document));
    for pair in &mesh.pairs {
        let what = if pair.tied { "tied" } else { "contact" };
        let found = if is_found { ", found by proximity" } else { "" };
        say(&format!("{what}: slave {}, master {}{found}", pair.slave, pair.master));
    }
    if mixed {
        say(&format!("elements: without locking, since {element} locks at Poisson's ratios above {LOCKS}"));
    }
    if supports.is_empty() {
        say("no supports are known: state them in the deck before it is run");
    }
    say(&format!("written: {}; `zelus check {}` is next", folder.display(), paths[0].display()));
    Ok(())
}

fn put(path: &Path, text: &str) -> Result<()> {
    replace_own_file(path, |file| file.write_all(text.as_bytes()))
}

/// Takes elements that do not lock where a material of the mesh hardly changes its volume; whether it did. Elements of second order stay,
/// and rings and plane stress have none.
fn take_mixed_elements(mesh: &Mesh, element: &str, document: &mut MdpaDocument) -> bool {
    let is_near_half = |material: &Material| material.young.is_some() && material.poisson > LOCKS;
    if matches!(mesh.plane, Some(Plane::Stress | Plane::Axial)) || !mesh.materials.iter().any(is_near_half) {
        return false;
    }
    let mixed = if element == LARGE { MIXED_LARGE } else { MIXED };
    let mut taken = false;
    for block in &mut document.elements {
        let mixed = block.name.strip_prefix(element).map(|suffix| format!("{mixed}{suffix}"));
        if let Some(mixed) = mixed.filter(|name| find_kind(EntityRole::Element, name).is_some()) {
            (block.name, taken) = (mixed, true);
        }
    }
    taken
}
