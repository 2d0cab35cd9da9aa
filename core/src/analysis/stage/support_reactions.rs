//! Reactions by support: sums over the unknowns that the processes of a stage fix on a part.

use std::collections::BTreeMap;

use crate::model::{ModelPart, Rates, ScalarVariable};
use crate::processes::Process;
use crate::strategies::{Balance, SupportReaction};
use crate::vector3::{add, cross, scale, sub};

/// The reactions of an accepted step, parts in the order of the deck; those of nodes are written. Collective.
pub(super) fn support_reactions(
    part: &ModelPart,
    processes: &[Box<dyn Process>],
    balance: &Balance,
) -> Vec<SupportReaction> {
    let time = part.info.time;
    let mut found: Vec<SupportReaction> = Vec::new();
    let mut taken: BTreeMap<ScalarVariable, Vec<bool>> = BTreeMap::new();
    // From the last process to the first: a value that a later one sets holds.
    for process in processes.iter().rev() {
        let along = process.prescribes_along(part, time);
        for own in process.prescribes(part, time).into_iter().rev() {
            let Some(sums) = Sums::of(part, own.variable, balance) else { continue };
            let taken = taken.entry(own.variable).or_insert_with(|| vec![false; part.nodes.len()]);
            let free = own.values.into_iter().filter(|(node, _)| !std::mem::replace(&mut taken[*node as usize], true));
            let mut sum = [[0.0; 3]; 2];
            free.for_each(|(node, _)| sums.add(&mut sum, node, None));
            if let Some(along) = along.iter().find(|_| own.variable.offset() == 0) {
                along.values.iter().for_each(|&(node, direction, _)| sums.add(&mut sum, node, Some(direction)));
            }
            let unknown = own.variable.column;
            let at = found.iter().position(|other| other.part == own.part && other.unknown == unknown);
            let at = at.unwrap_or_else(|| {
                found.push(SupportReaction {
                    part: own.part,
                    unknown: unknown.to_owned(),
                    ..SupportReaction::default()
                });
                found.len() - 1
            });
            found[at].reaction = add(found[at].reaction, sum[0]);
            found[at].moment = add(found[at].moment, sum[1]);
        }
    }
    found.reverse();
    let mut flat: Vec<f64> = found.iter().flat_map(|own| [own.reaction, own.moment]).flatten().collect();
    part.ranks.sum(&mut flat);
    for (own, sums) in found.iter_mut().zip(flat.chunks_exact(6)) {
        (own.reaction, own.moment) = ([sums[0], sums[1], sums[2]], [sums[3], sums[4], sums[5]]);
    }
    found
}

/// Sums of the reaction of one variable.
struct Sums<'a> {
    part: &'a ModelPart,
    /// Values of the reaction, `components` a node.
    reactions: &'a [f64],
    components: usize,
    offset: usize,
    centre: Option<[f64; 3]>,
}

impl<'a> Sums<'a> {
    /// `None` for variables without reactions, or where none are written.
    fn of(part: &'a ModelPart, variable: ScalarVariable, balance: &Balance) -> Option<Self> {
        let rates = Rates::of(variable.column)?;
        let field = part.nodes.history.get(rates.reaction?)?;
        let centre = balance.unknowns.iter().find(|own| own.unknown == variable.column && own.moments.is_some());
        Some(Self {
            part,
            reactions: &field.levels[0],
            components: field.components,
            offset: variable.offset(),
            centre: centre.map(|own| own.centre),
        })
    }

    /// Adds force and moment of a node: of the component, or along a direction.
    fn add(&self, [force, moment]: &mut [[f64; 3]; 2], node: u32, direction: Option<[f64; 3]>) {
        let node = node as usize;
        if !self.part.owns_node(node) {
            return;
        }
        let at = |component: usize| self.reactions[node * self.components + component];
        let mut own = [0.0; 3];
        match direction {
            Some(direction) => own = scale(direction, (0..3).map(|c| direction[c] * at(c)).sum()),
            None => own[self.offset] = at(self.offset),
        }
        *force = add(*force, own);
        if let Some(centre) = self.centre {
            *moment = add(*moment, cross(sub(self.part.nodes.current[node], centre), own));
        }
    }
}
