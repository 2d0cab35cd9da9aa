//! `zelus new`: a deck to start from, made of a mesh.

mod deck;
mod formulations;
mod histories;
mod known_materials;
mod materials;
mod options;
mod point_loads;
mod processes;
mod sides;
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
/// Elements for plastic flow, which changes no volume.
const MEAN_DILATATION: &str = "SmallDisplacementBbarElement";
const WITH_PRESSURE: &str = "TotalLagrangianQ1P0MixedElement";
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
    let reasons = if is_found { sides::order(&mut mesh, whole.as_ref()) } else { Vec::new() };
    for name in &arguments.options.slave {
        sides::make_slave(&mut mesh, name)?;
    }
    let formulation = arguments.options.formulation(&mesh)?;
    let by_file = if mesh.is_large || is_rubber(&mesh) { LARGE } else { PLAIN };
    let element = arguments.element_name.clone().unwrap_or_else(|| by_file.to_owned());
    mesh.is_large = !element.starts_with("SmallDisplacement");
    let space = if is_planar(&mesh) && mesh.dimension() < 3 { 2 } else { 3 };
    let forces = point_loads::join(&mut mesh);
    let names = Names { element: element.clone(), condition: String::new() };
    let mut document = document(&mesh, &names, &Place::file(from), &mut said);
    let mut take = || {
        take_elements_of_rubber(&mesh, &mut document).or_else(|| take_mixed_elements(&mesh, &element, &mut document))
    };
    let other = arguments.element_name.is_none().then(&mut take).flatten();
    point_loads::add(&mesh, &mut document, space, forces.as_ref());
    let stem = from.file_stem().map_or("mesh".to_owned(), |stem| stem.to_string_lossy().into_owned());
    let folder = arguments.output.clone().unwrap_or_else(|| PathBuf::from(&stem));
    let supports = supports::of(&mesh, &mut said);
    let materials = materials::text(&mesh, space, whole.as_ref(), &mut said);
    let mut texts = Histories::new(stepping::end(&mesh));
    let deck = deck::text(&mesh, &stem, space, formulation, &supports, forces.as_ref(), &mut texts);
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
    for (at, pair) in mesh.pairs.iter().enumerate() {
        let what = if pair.tied { "tied" } else { "contact" };
        let found = match reasons.get(at) {
            Some(_) if arguments.options.slave.contains(&pair.slave) => ", found by proximity".to_owned(),
            Some(reason) => format!(", found by proximity; the slave is the side that is {reason}"),
            None => String::new(),
        };
        say(&format!("{what}: slave {}, master {}{found}", pair.slave, pair.master));
    }
    if let Some(reason) = other {
        say(&format!("elements: without locking, since {element} locks {reason}"));
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

/// Whether all materials of the mesh are rubber.
fn is_rubber(mesh: &Mesh) -> bool {
    !mesh.materials.is_empty() && mesh.materials.iter().all(|material| material.rubber.is_some())
}

/// Takes elements that hold a pressure, or the volume at nodes, where all materials of the mesh are rubber; gives the reason, where it did.
fn take_elements_of_rubber(mesh: &Mesh, document: &mut MdpaDocument) -> Option<String> {
    let mut taken = false;
    for block in document.elements.iter_mut().filter(|_| is_rubber(mesh)) {
        let Some((axis, suffix)) = block.name.split_once(LARGE) else { continue };
        // one pressure does not help the tetrahedron of first order
        let with = if suffix == "3D4N" { MIXED_LARGE } else { WITH_PRESSURE };
        let found = [with, MIXED_LARGE].map(|stem| format!("{axis}{stem}{suffix}"));
        let known = found.into_iter().find(|name| find_kind(EntityRole::Element, name).is_some());
        if let Some(name) = known {
            (block.name, taken) = (name, true);
        }
    }
    taken.then(|| "with rubber, which hardly changes its volume".to_owned())
}

/// Takes elements that do not lock where a material of the mesh hardly changes its volume, or flows; gives the reason, where it did.
/// Elements of second order stay, and rings and plane stress have none.
fn take_mixed_elements(mesh: &Mesh, element: &str, document: &mut MdpaDocument) -> Option<String> {
    let is_near_half = |material: &Material| material.young.is_some() && material.poisson > LOCKS;
    let flows = |material: &Material| !material.yield_curve.is_empty();
    let (other, reason) = match element {
        _ if matches!(mesh.plane, Some(Plane::Stress | Plane::Axial)) => return None,
        PLAIN if mesh.materials.iter().any(is_near_half) => (MIXED, format!("at Poisson's ratios above {LOCKS}")),
        LARGE if mesh.materials.iter().any(is_near_half) => (MIXED_LARGE, format!("at Poisson's ratios above {LOCKS}")),
        PLAIN if mesh.materials.iter().any(flows) => (MEAN_DILATATION, "in plastic flow".to_owned()),
        _ => return None,
    };
    let mut taken = false;
    for block in &mut document.elements {
        let name = block.name.strip_prefix(element).map(|suffix| format!("{other}{suffix}"));
        if let Some(name) = name.filter(|name| find_kind(EntityRole::Element, name).is_some()) {
            (block.name, taken) = (name, true);
        }
    }
    taken.then_some(reason)
}
