//! Who computes what: the mesh of a stage shared among the ranks, which must have read the same files.

use std::hash::{Hash, Hasher};
use std::path::Path;

use super::solver::has_inertia;
use crate::communication::Ranks;
use crate::diagnostics::{Error, Result};
use crate::io::FileUse;
use crate::model::{ModelPart, Share};
use crate::parameters::Node;
use crate::partition::{Partition, Surface, common_nodes, everywhere, keep_share, partition, surfaces};
use crate::strategies::Monitor;

/// Gives every rank its share of the mesh, where there are several ranks and enough to share; from then on a rank has its
/// own elements with their nodes, and all of the interfaces. `decks` are this stage and those after it.
///
/// # Errors
/// A mesh that cannot be cut.
pub(super) fn distribute(part: &mut ModelPart, decks: &[Node], changes: bool, monitor: &mut dyn Monitor) -> Result<()> {
    let ranks = part.ranks.size();
    if ranks == 1 {
        return Ok(());
    }
    // What an earlier stage has shared out stays where it is, unless a modeler has changed it: then every rank has it whole.
    let fits = |share: &Share| share.elements.len() == part.elements.len() && share.owners.len() == part.nodes.len();
    if part.share.as_ref().is_some_and(|share| fits(share) && share.conditions.len() == part.conditions.len()) {
        return Ok(());
    }
    part.share = None;
    if part.elements.len() < ranks {
        monitor
            .note(&format!("{} elements: too few to share among {ranks} ranks, one computes all", part.elements.len()));
        keep_share(part, &Partition::on_one_rank(part, ranks), &vec![true; part.nodes.len()]);
        return Ok(());
    }
    let cut = cut_on_rank_0(part, &decks[0], ranks)?;
    let mut common = vec![changes; part.nodes.len()];
    for deck in decks {
        let of_stage = common_of_stage(part, &surfaces(deck, part), deck);
        common.iter_mut().zip(of_stage).for_each(|(common, of_stage)| *common |= of_stage);
    }
    let mut facets = vec![0_usize; ranks];
    cut.facets.iter().filter(|f| f.slave).for_each(|f| facets[cut.elements[f.element as usize] as usize] += 1);
    let mut note = format!("{ranks} ranks share {} elements, {} faces are cut", part.elements.len(), cut.cut);
    if facets.iter().any(|&count| count > 0) {
        let all: usize = facets.iter().sum();
        let holders = facets.iter().filter(|&&count| count > 0).count();
        note.push_str(&format!("; {all} slave facets on {holders} of them"));
    }
    keep_share(part, &cut, &common);
    let whole = part.sizes().nodes;
    let most = part.ranks.gather_numbers(&[part.nodes.len() as f64]).concat().into_iter().fold(0.0, f64::max);
    note.push_str(&format!("; the fullest has {most} of {whole} nodes"));
    monitor.note(&note);
    Ok(())
}

/// The nodes of a stage that every rank keeps with the elements at them. In motion with inertia those next to surfaces are among
/// them: they carry the mass of nodes in contact.
pub(super) fn common_of_stage(part: &ModelPart, surfaces: &[Surface], deck: &Node) -> Vec<bool> {
    let common = common_nodes(part, surfaces, deck);
    if surfaces.is_empty() || !has_inertia(deck) { common } else { everywhere(part, &common) }
}

/// The partition, which rank 0 makes for all; without facets on the others. Collective.
fn cut_on_rank_0(part: &ModelPart, deck: &Node, ranks: usize) -> Result<Partition> {
    let made = if part.ranks.is_root() { partition(part, &surfaces(deck, part), ranks).map(Some) } else { Ok(None) };
    let made = part.ranks.agree(made)?;
    let owners = made.iter().flat_map(|cut| [&cut.elements, &cut.conditions, &cut.nodes]).flatten().copied().collect();
    let owners = part.ranks.exchange_indices(&vec![owners; ranks]).swap_remove(0);
    Ok(made.unwrap_or_else(|| {
        let (elements, others) = owners.split_at(part.elements.len());
        let (conditions, nodes) = others.split_at(part.conditions.len());
        let [elements, conditions, nodes] = [elements, conditions, nodes].map(<[u32]>::to_vec);
        Partition { ranks, elements, conditions, nodes, facets: Vec::new(), cut: 0 }
    }))
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
