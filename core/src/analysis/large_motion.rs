//! Motion and strain beyond sense: displacements far beyond the size of the model, and numbers that elements take to be small.

use zelus_linear_algebra::parallel;

use crate::assembly::System;
use crate::diagnostics::Diagnostic;
use crate::entities::{AssumedSmall, EntityBlock};
use crate::model::{ModelPart, Rates};
use crate::strategies::whereabouts;
use crate::vector3::{norm, sub};

/// Ratio of a displacement to the size of the model from which on it makes no sense.
const MOST: f64 = 10.0;
/// Entities that a thread takes at a time, at least.
const ENTITIES: usize = 1 << 10;

/// The largest displacement and the largest number assumed small of the accepted steps of a stage, those of this rank.
#[derive(Debug, Default)]
pub(super) struct LargeMotion {
    /// Size of the displacement (length), and where and when it is.
    displacement: Option<(f64, String)>,
    /// The number beside its limit, and where and when it is.
    small: Option<(AssumedSmall, String)>,
}

impl LargeMotion {
    /// Takes the present state as accepted.
    pub(super) fn see(&mut self, part: &ModelPart, system: &System) {
        let time = part.info.time;
        if let Some(column) = Rates::moving(&part.nodes.history) {
            let values = part.nodes.history.level(column, 0).as_chunks::<3>().0;
            let sizes = values.iter().map(|&value| norm(value)).enumerate();
            if let Some((node, size)) = sizes.max_by(|a, b| a.1.total_cmp(&b.1))
                && self.displacement.as_ref().is_none_or(|(most, _)| size > *most)
            {
                let place = whereabouts(part, node as u32);
                self.displacement = Some((size, format!("of node {}{place} at time {time}", part.nodes.ids[node])));
            }
        }
        for block in &system.elements {
            let Some((at, number)) = largest_of(block.as_ref(), part) else { continue };
            if self.small.as_ref().is_none_or(|(most, _)| number.ratio() > most.ratio()) {
                let id = part.elements.ids[block.members()[at] as usize];
                let place = whereabouts(part, block.nodes(at)[0]);
                self.small = Some((number, format!("of {} {id}{place} at time {time}", block.entry().name)));
            }
        }
    }

    /// Warnings of what is beyond sense, at the end of the run; collective.
    pub(super) fn warnings(&self, part: &ModelPart) -> Vec<Diagnostic> {
        let mut out = Vec::new();
        let size = size_of(part);
        let length = self.displacement.as_ref().map_or(0.0, |(length, _)| *length);
        let ratio = if size > 0.0 { length / size } else { 0.0 };
        let is_here = is_largest(part, ratio) && ratio > MOST;
        if let Some((_, place)) = self.displacement.as_ref().filter(|_| is_here) {
            let fact = format!("the displacement {length:.3e} {place} is {ratio:.3e} times the size of the model");
            let remedy = "check the units of materials, loads and lengths, and the supports";
            out.push(Diagnostic::warning("large-motion", fact).remedy(remedy));
        }
        let ratio = self.small.as_ref().map_or(0.0, |(number, _)| number.ratio());
        let is_here = is_largest(part, ratio) && ratio > 1.0;
        if let Some((number, place)) = self.small.as_ref().filter(|_| is_here) {
            let AssumedSmall { name, value, limit, remedy } = number;
            let fact = format!(
                "the {name} {value:.3e} {place} is above {limit}: the element holds for small displacements only"
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

/// Diagonal of the box around the whole initial mesh (length); collective.
fn size_of(part: &ModelPart) -> f64 {
    let nothing = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    let around = |[low, high]: [[f64; 3]; 2], x: [f64; 3]| {
        [std::array::from_fn(|c| low[c].min(x[c])), std::array::from_fn(|c| high[c].max(x[c]))]
    };
    let own = part.nodes.initial.iter().fold(nothing, |ends, &x| around(ends, x));
    let all = part.ranks.gather_numbers(&own.concat()).concat();
    let corners = all.as_chunks::<3>().0.iter().filter(|x| x.iter().all(|x| x.is_finite()));
    let [low, high] = corners.fold(nothing, |ends, &x| around(ends, x));
    norm(sub(high, low))
}

/// Whether this is the first rank with the largest of these values; collective.
fn is_largest(part: &ModelPart, value: f64) -> bool {
    let all = part.ranks.gather_numbers(&[value]).concat();
    let most = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    all.iter().position(|&one| one == most) == Some(part.ranks.rank())
}
