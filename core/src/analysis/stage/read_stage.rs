//! Second phase of a stage's preparation: mesh and materials are read.

use std::path::Path;

use super::super::deck::{add_names_only, import, import_materials};
use super::super::sharing::read_the_same_deck;
use super::super::solver::check_dimensions;
use super::parsed_stage::ParsedStage;
use super::problems_of_ranks::{as_error, problems_of_ranks};
use crate::diagnostics::Result;
use crate::model::Model;
use crate::modelers::run_modelers;

/// A stage whose mesh and materials are read, whole and by one rank at least.
pub(super) struct ReadStage<'a> {
    /// The parsed deck.
    pub parsed: ParsedStage<'a>,
    /// Whether there is a mesh to go on with.
    pub has_mesh: bool,
    /// Whether mesh, materials and settings of the solver are all there.
    pub is_whole: bool,
    /// Whether rank 0 alone has read the mesh, for all ranks.
    pub by_root: bool,
}

impl<'a> ReadStage<'a> {
    /// Reads mesh and materials into the model; in the place of a mesh that cannot be read, the names of its parts. Files
    /// are named from `folder`. Collective.
    ///
    /// # Errors
    /// Ranks with different decks, no mesh and no names of parts; all other problems are gathered.
    pub fn read(mut parsed: ParsedStage<'a>, folder: &Path, model: &mut Model) -> Result<Self> {
        let ranks = model.ranks.clone();
        read_the_same_deck(&ranks, &parsed.deck)?;
        // Rank 0 alone reads the mesh of a first stage, and shares it out.
        let by_root = ranks.size() > 1 && model.parts.is_empty();
        let [mut has_mesh, mut is_whole] = [true; 2];
        if ranks.is_root() || !by_root {
            [has_mesh, is_whole] = read_model(&mut parsed, folder, model);
        }
        parsed.problems = problems_of_ranks(&ranks, parsed.problems)?;
        if !has_mesh && add_names_only(&parsed.solver, &parsed.root, folder, model).is_none() {
            return Err(as_error(parsed.problems));
        }
        Ok(Self { parsed, has_mesh, is_whole, by_root })
    }
}

/// Runs the modelers, then imports mesh and materials: whether there is a mesh to go on with, and whether all is there.
fn read_model(parsed: &mut ParsedStage<'_>, folder: &Path, model: &mut Model) -> [bool; 2] {
    let ParsedStage { stage, solver, root, domain_size, problems, .. } = parsed;
    let modelled = run_modelers(&stage.modelers, folder, model, problems);
    problems.absorb(modelled);
    let has_mesh = domain_size.is_some_and(|domain_size| {
        let imported = import(solver, root, folder, model, problems);
        let imported = imported.and_then(|()| check_dimensions(model.root(root)?, domain_size));
        problems.absorb(imported).is_some()
    });
    let materials = if has_mesh { import_materials(solver, root, folder, model, problems) } else { Ok(()) };
    [has_mesh, problems.absorb(materials).is_some() && has_mesh && solver.is_whole]
}
