//! Distribution of the mesh of a stage over the ranks, which must have read the same files.

use std::hash::{Hash, Hasher};
use std::path::Path;

use super::solver::has_inertia;
use crate::communication::Ranks;
use crate::diagnostics::{Error, Result};
use crate::io::FileUse;
use crate::model::{Model, ModelPart};
use crate::parameters::Node;
use crate::partition::{Partition, Shares, Surface, common_nodes, everywhere, partition, surfaces};
use crate::strategies::Monitor;

/// Partition of a mesh, and the nodes that all ranks have.
struct Cut {
    partition: Partition,
    common: Vec<bool>,
    note: String,
}

/// Gives every rank its share of the part `root`, where there are several ranks, from the mesh of rank 0; from then on a rank has
/// its own elements with their nodes, and all of the interfaces. Ranks that have no such part get all other parts of rank 0,
/// too. `decks` are this stage and those after it. Collective.
///
/// # Errors
/// A mesh that cannot be cut.
pub(super) fn distribute(
    model: &mut Model,
    root: &str,
    decks: &[Node],
    changes: bool,
    monitor: &mut dyn Monitor,
) -> Result<()> {
    let ranks = model.ranks.clone();
    // A part that an earlier stage has distributed stays so, unless a modeler has changed it: then every rank has it whole.
    if ranks.size() == 1 || model.parts.get(root).is_some_and(is_shared) {
        return Ok(());
    }
    let cut = if ranks.is_root() { cut(model.root_mut(root)?, decks, changes).map(Some) } else { Ok(None) };
    let cut = ranks.agree(cut)?;
    let others_have_none = ranks.any(!model.parts.contains_key(root));
    let shares = cut.as_ref().map(|Cut { partition, common, .. }| Shares::new(&model.parts[root], partition, common));
    let mut sent = Ok(());
    for rank in 1..ranks.size() {
        // One share after the other, so that rank 0 holds one of them at a time.
        let parts = shares.as_ref().map(|shares| {
            let others = model.parts.values().filter(|part| others_have_none && part.name != root);
            others.cloned().chain([shares.of(&model.parts[root], rank)]).collect::<Vec<ModelPart>>()
        });
        match ranks.send_from_root(parts, rank) {
            Ok(parts) => parts.into_iter().flatten().for_each(|part| model.add(part)),
            Err(error) => sent = Err(error),
        }
    }
    ranks.agree(sent)?;
    if let Some(shares) = shares {
        model.add(shares.of(&model.parts[root], 0));
    }
    *model = std::mem::take(model).shared_by(&ranks);
    let part = model.root(root)?;
    let most = ranks.gather_numbers(&[part.nodes.len() as f64]).concat().into_iter().fold(0.0, f64::max);
    if let Some(Cut { note, .. }) = cut {
        monitor.note(&format!("{note}; the fullest has {most} of {} nodes", part.sizes().nodes));
    }
    Ok(())
}

/// Whether a part is shared out, and nothing has joined it since.
fn is_shared(part: &ModelPart) -> bool {
    part.share.as_ref().is_some_and(|share| {
        let counts = [share.owners.len(), share.elements.len(), share.conditions.len()];
        counts == [part.nodes.len(), part.elements.len(), part.conditions.len()]
    })
}

/// Cuts a mesh for the ranks; one computes all where there is too little to share.
fn cut(part: &mut ModelPart, decks: &[Node], changes: bool) -> Result<Cut> {
    part.share = None;
    let (ranks, elements) = (part.ranks.size(), part.elements.len());
    if elements < ranks {
        let note = format!("{elements} elements: too few to share among {ranks} ranks, one computes all");
        let common = vec![true; part.nodes.len()];
        return Ok(Cut { partition: Partition::on_one_rank(part, ranks), common, note });
    }
    let partition = partition(part, &surfaces(&decks[0], part), ranks)?;
    let mut common = vec![changes; part.nodes.len()];
    for deck in decks {
        let of_stage = common_of_stage(part, &surfaces(deck, part), deck);
        common.iter_mut().zip(of_stage).for_each(|(common, of_stage)| *common |= of_stage);
    }
    let mut facets = vec![0_usize; ranks];
    let slaves = partition.facets.iter().filter(|facet| facet.slave);
    slaves.for_each(|facet| facets[partition.elements[facet.element as usize] as usize] += 1);
    let mut note = format!("{ranks} ranks share {elements} elements, {} faces are cut", partition.cut);
    if facets.iter().any(|&count| count > 0) {
        let all: usize = facets.iter().sum();
        let holders = facets.iter().filter(|&&count| count > 0).count();
        note.push_str(&format!("; {all} slave facets on {holders} of them"));
    }
    Ok(Cut { partition, common, note })
}

/// The nodes of a stage that every rank keeps with the elements at them. In motion with inertia those next to surfaces are among
/// them: they carry the mass of nodes in contact.
pub(super) fn common_of_stage(part: &ModelPart, surfaces: &[Surface], deck: &Node) -> Vec<bool> {
    let common = common_nodes(part, surfaces, deck);
    if surfaces.is_empty() || !has_inertia(deck) { common } else { everywhere(part, &common) }
}

/// Errors when the ranks have not read the same settings; collective.
pub(super) fn read_the_same_deck(ranks: &Ranks, deck: &Node) -> Result<()> {
    let mut hasher = rustc_hash::FxHasher::default();
    deck.to_json().to_string().hash(&mut hasher);
    if ranks.is_same(hasher.finish()) { Ok(()) } else { Err(different("decks")) }
}

/// Errors when the ranks have not read the same files; collective.
pub(super) fn read_the_same_files(ranks: &Ranks, files: &[FileUse]) -> Result<()> {
    if ranks.size() == 1 {
        return Ok(());
    }
    let mut inputs: Vec<&Path> = files.iter().filter_map(FileUse::input).collect();
    inputs.sort_unstable();
    inputs.dedup();
    for path in inputs {
        let checksum =
            std::fs::read(path).map_or(0, |bytes| u64::from(crc32fast::hash(&bytes)) | (bytes.len() as u64) << 32);
        if !ranks.is_same(checksum) {
            return Err(different(&format!("files {}", path.display())));
        }
    }
    Ok(())
}

fn different(what: &str) -> Error {
    let remedy = "give all of them the same files, e.g. in a shared folder";
    Error::System(format!("the ranks have read different {what}\n    {remedy}"))
}
