//! Motion and strain beyond sense: displacements far beyond the size of the model, and numbers that elements take to be small.

use zelus_linear_algebra::parallel;

use crate::assembly::System;
use crate::diagnostics::Diagnostic;
use crate::entities::{AssumedSmall, EntityBlock};
use crate::model::{ModelPart, Rates, mesh_box};
use crate::strategies::location;
use crate::vector3::{norm, sub};

/// Ratio of a displacement to the size of the model from which on it makes no sense.
const MOST: f64 = 10.0;
/// Entities that a thread takes at a time, at least.
const ENTITIES: usize = 1 << 10;

/// The largest displacement and the largest number assumed small of the accepted steps of a stage, those of this rank.
#[derive(Debug, Default)]
pub(super) struct LargeMotion {
    displacement: Option<LargestDisplacement>,
    small: Option<LargestSmall>,
}

/// The largest displacement so far.
#[derive(Debug)]
struct LargestDisplacement {
    /// Length.
    size: f64,
    /// Index of the node.
    node: u32,
    time: f64,
}

/// The number of an element that is largest beside its limit so far.
#[derive(Debug)]
struct LargestSmall {
    number: AssumedSmall,
    /// Index of the element in the model part.
    element: u32,
    time: f64,
}

impl LargeMotion {
    /// Takes the present state as accepted.
    pub(super) fn see(&mut self, part: &ModelPart, system: &System) {
        let time = part.info.time;
        if let Some(column) = Rates::moving(&part.nodes.history) {
            let values = part.nodes.history.level(column, 0).as_chunks::<3>().0;
            let sizes = values.iter().map(|&value| norm(value)).enumerate();
            if let Some((node, size)) = sizes.max_by(|a, b| a.1.total_cmp(&b.1))
                && self.displacement.as_ref().is_none_or(|most| size > most.size)
            {
                self.displacement = Some(LargestDisplacement { size, node: node as u32, time });
            }
        }
        for block in &system.elements {
            let Some((at, number)) = largest_of(block.as_ref(), part) else { continue };
            if self.small.as_ref().is_none_or(|most| number.ratio() > most.number.ratio()) {
                self.small = Some(LargestSmall { number, element: block.members()[at], time });
            }
        }
    }

    /// Warnings of what is beyond sense, at the end of the run; collective.
    pub(super) fn warnings(&self, part: &ModelPart) -> Vec<Diagnostic> {
        let mut out = Vec::new();
        let [low, high] = mesh_box(part);
        let size = norm(sub(high, low));
        let ratio = self.displacement.as_ref().map_or(0.0, |most| if size > 0.0 { most.size / size } else { 0.0 });
        let is_here = is_largest(part, ratio) && ratio > MOST;
        if let Some(LargestDisplacement { size, node, time }) = self.displacement.as_ref().filter(|_| is_here) {
            let (id, place) = (part.nodes.ids[*node as usize], location(part, *node));
            let fact = format!(
                "the displacement {size:.3e} of node {id}{place} at time {time} is {ratio:.3e} times the size of the model"
            );
            let remedy = "check the units of materials, loads and lengths, and the supports";
            out.push(Diagnostic::warning("large-motion", fact).remedy(remedy));
        }
        let ratio = self.small.as_ref().map_or(0.0, |most| most.number.ratio());
        let is_here = is_largest(part, ratio) && ratio > 1.0;
        if let Some(LargestSmall { number, element, time }) = self.small.as_ref().filter(|_| is_here) {
            let AssumedSmall { name, value, limit, remedy } = number;
            let (kind, id) = (part.elements.kinds[*element as usize].name, part.elements.ids[*element as usize]);
            let place = location(part, part.elements.nodes(*element)[0]);
            let fact = format!(
                "the {name} {value:.3e} of {kind} {id}{place} at time {time} is above {limit}: the element holds for small \
                 displacements only"
            );
            out.push(Diagnostic::warning("large-strain", fact).remedy(*remedy));
        }
        out
    }
}

/// The entity of a block whose number is largest beside its limit.
fn largest_of(block: &dyn EntityBlock, part: &ModelPart) -> Option<(usize, AssumedSmall)> {
    let view = part.view();
    block.assumed_small(&view, 0)?;
    let numbers = parallel::map(block.len(), ENTITIES, |at| block.assumed_small(&view, at));
    let known = numbers.into_iter().enumerate().filter_map(|(at, number)| Some((at, number?)));
    known.max_by(|a, b| a.1.ratio().total_cmp(&b.1.ratio()))
}

/// Whether this is the first rank with the largest of these values; collective.
fn is_largest(part: &ModelPart, value: f64) -> bool {
    let all = part.ranks.gather_numbers(&[value]).concat();
    let most = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    all.iter().position(|&one| one == most) == Some(part.ranks.rank())
}
