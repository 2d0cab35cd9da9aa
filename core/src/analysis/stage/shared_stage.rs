//! Third phase of a stage's preparation: the ranks share the mesh.

use std::path::{Path, PathBuf};

use zelus_linear_algebra::memory;

use super::super::deck::{Folders, mesh_file, prepare_mesh};
use super::super::driver::LoopPoint;
use super::super::older_decks::{complete_part_names, modernise};
use super::super::sharing::{distribute, read_the_same_files};
use super::parsed_stage::ParsedStage;
use super::problems_of_ranks::{as_error, problems_of_all};
use super::read_stage::ReadStage;
use super::run_context::RunContext;
use crate::assembly::System;
use crate::diagnostics::{Report, Result};
use crate::io::{FileUse, MeshFormatEntry};
use crate::parameters::Node;
use crate::processes::tables_of;
use crate::registry;

/// A stage of whose mesh each rank has its share.
pub(super) struct SharedStage<'a> {
    /// The parsed deck, with whole names of parts.
    pub parsed: ParsedStage<'a>,
    /// Whether mesh, materials and settings of the solver are all there.
    pub is_whole: bool,
    /// Files that the stage reads.
    pub inputs: Vec<FileUse>,
    /// Contents of the files that decide results, beside deck and mesh: materials and tables.
    pub contents: Vec<PathBuf>,
}

impl<'a> SharedStage<'a> {
    /// Lets processes change the mesh, gives each rank its share of it, then lets the driver see the model. Collective.
    ///
    /// # Errors
    /// Ranks with different files, a mesh that processes cannot change or that cannot be cut, an error of the driver; all other problems
    /// are gathered.
    pub fn share(read: ReadStage<'a>, folders: &Folders, run: &mut RunContext<'_>) -> Result<Self> {
        let ReadStage { mut parsed, has_mesh, is_whole, by_root } = read;
        let ParsedStage { stage, later, deck, root, problems, .. } = &mut parsed;
        complete_part_names(deck, root, run.model, problems);
        let mut decks = vec![deck.clone()];
        for later in later.iter() {
            let mut deck = modernise(&later.settings, &mut Report::new());
            complete_part_names(&mut deck, root, run.model, &mut Report::new());
            decks.push(deck);
        }
        let mut is_prepared = true;
        let changes = later.iter().any(|later| !later.modelers.is_empty());
        let ranks = run.model.ranks.clone();
        if has_mesh && run.model.parts.contains_key(root.as_str()) {
            let mut of_mesh = Report::new();
            prepare_mesh(deck, folders, run.model, &mut of_mesh);
            is_prepared = !of_mesh.has_errors();
            of_mesh.diagnostics().iter().for_each(|problem| problems.push(problem.clone()));
        }
        if ranks.any(!is_prepared) {
            return Err(as_error(problems_of_all(&ranks, std::mem::take(problems))?));
        }
        let folder = &*folders.deck;
        let of_mesh = mesh_files(deck, &stage.modelers, folder);
        let mut inputs = deck_files(deck);
        read_the_same_files(&ranks, &inputs)?;
        if !by_root {
            read_the_same_files(&ranks, &of_mesh)?;
        }
        inputs.extend(of_mesh);
        let mut contents: Vec<PathBuf> = materials_file(deck, folder).into_iter().collect();
        tables_of(deck, &mut contents);
        if has_mesh {
            distribute(run.model, root, &decks, changes, run.monitor)?;
        }
        memory::give_back();
        // Ranks that have read no mesh know its parts only now.
        complete_part_names(deck, root, run.model, problems);
        if is_whole && !problems.has_errors() {
            run.driver.at(LoopPoint::Read, root, run.model, &System::default(), &mut |_| Ok(()))?;
        }
        Ok(Self { parsed, is_whole, inputs, contents })
    }
}

/// Meshes and materials that a stage reads.
fn mesh_files(deck: &Node, modelers: &[Node], folder: &Path) -> Vec<FileUse> {
    let mesh = deck.get("solver_settings").and_then(|solver| mesh_file(solver, folder)).map(|(_, file)| file);
    let materials = materials_file(deck, folder);
    let of_modeler = |modeler: &Node| {
        let parameters = modeler.get("parameters").or_else(|| modeler.get("Parameters"))?;
        let name = parameters.get("input_filename")?.as_str()?;
        registry::find::<MeshFormatEntry>("mdpa").map(|format| format.file(&folder.join(name)))
    };
    let meshes = modelers.iter().filter_map(of_modeler);
    mesh.into_iter().chain(materials).chain(meshes).map(FileUse::Reads).collect()
}

/// The materials file that a deck names.
fn materials_file(deck: &Node, folder: &Path) -> Option<PathBuf> {
    let name = deck.get_path("solver_settings.material_import_settings.materials_filename").and_then(Node::as_str)?;
    (!name.is_empty()).then(|| folder.join(name))
}

/// The deck of a stage, and the tables that it names.
fn deck_files(deck: &Node) -> Vec<FileUse> {
    let mut files = vec![deck.place().file];
    tables_of(deck, &mut files);
    files.into_iter().map(FileUse::Reads).collect()
}
