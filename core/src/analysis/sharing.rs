//! Who computes what: the mesh of a stage shared among the ranks, once they are seen to have read the same files.

use std::hash::{Hash, Hasher};

use crate::communication::world;
use crate::diagnostics::{Error, Result};
use crate::model::{ModelPart, Properties};
use crate::parameters::Node;
use crate::partition::{Partition, partition, surfaces};
use crate::strategies::Monitor;

/// Gives every rank its share of the mesh, where there are several ranks and enough to share.
///
/// # Errors
/// Ranks that have read different files; a mesh that cannot be cut.
pub(super) fn distribute(part: &mut ModelPart, deck: &Node, monitor: &mut dyn Monitor) -> Result<()> {
    let ranks = world().size();
    if ranks > 1 {
        read_the_same(part, deck)?;
    }
    // What elements remember of an earlier stage stays where it is.
    let fits = |p: &Partition| p.elements.len() == part.elements.len() && p.nodes.len() == part.nodes.len();
    if part.partition.as_ref().is_some_and(|p| fits(p) && p.conditions.len() == part.conditions.len()) {
        return Ok(());
    }
    part.partition = None;
    if ranks == 1 {
        return Ok(());
    }
    if part.elements.len() < ranks || part.interactions.iter().any(|interaction| interaction.needs_all_elements()) {
        monitor
            .note(&format!("{} elements: too few to share, each of {ranks} ranks computes all", part.elements.len()));
        return Ok(());
    }
    let shared = partition(part, &surfaces(deck, part), ranks)?;
    let mut facets = vec![0_usize; ranks];
    shared.facets.iter().filter(|f| f.slave).for_each(|f| facets[shared.elements[f.element as usize] as usize] += 1);
    let mut note = format!("{ranks} ranks share {} elements, {} faces are cut", part.elements.len(), shared.cut);
    if facets.iter().any(|&count| count > 0) {
        let all: usize = facets.iter().sum();
        let holders = facets.iter().filter(|&&count| count > 0).count();
        note.push_str(&format!("; {all} slave facets on {holders} of them"));
    }
    monitor.note(&note);
    part.partition = Some(shared);
    Ok(())
}

/// Errors when the ranks have not read the same files; collective.
fn read_the_same(part: &ModelPart, deck: &Node) -> Result<()> {
    for (what, number) in [("meshes", of_mesh(part)), ("materials", of_materials(part)), ("decks", of_deck(deck))] {
        if !world().is_same(number) {
            return Err(Error::System(format!(
                "the ranks have read different {what}\n    give all of them the same files, e.g. in a shared folder"
            )));
        }
    }
    Ok(())
}

/// A number that differs where decks differ.
fn of_deck(deck: &Node) -> u64 {
    let mut hasher = rustc_hash::FxHasher::default();
    deck.to_json().to_string().hash(&mut hasher);
    hasher.finish()
}

/// A number that differs where properties differ, wherever they stand.
fn of_materials(part: &ModelPart) -> u64 {
    let mut hasher = rustc_hash::FxHasher::default();
    for properties in part.properties.values() {
        format!("{:?}", Properties { place: None, ..properties.clone() }).hash(&mut hasher);
    }
    hasher.finish()
}

/// A number that differs where meshes differ.
fn of_mesh(part: &ModelPart) -> u64 {
    let mut hasher = rustc_hash::FxHasher::default();
    part.nodes.ids.hash(&mut hasher);
    part.nodes.initial.iter().flatten().for_each(|x| x.to_bits().hash(&mut hasher));
    for table in [&part.elements, &part.conditions] {
        table.ids.hash(&mut hasher);
        table.properties.hash(&mut hasher);
        (0..table.len() as u32).for_each(|at| table.nodes(at).hash(&mut hasher));
    }
    part.constraints.len().hash(&mut hasher);
    hasher.finish()
}
