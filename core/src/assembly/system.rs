//! Objects that compute on a model part for one solver.

use std::collections::BTreeMap;

use super::dof_table::DofTable;
use crate::diagnostics::{Diagnostic, Report, Result};
use crate::entities::{BlockRequest, EntityBlock, Interaction, block_factory, is_place};
use crate::model::{EntityKind, EntityRole, EntityTable, ModelPart};

/// Unknowns of a model part, the blocks over its entities, and the interactions between bodies.
#[derive(Default)]
pub struct System {
    /// Unknowns and their numbers.
    pub dofs: DofTable,
    /// Kernels over the elements of this rank.
    pub elements: Vec<Box<dyn EntityBlock>>,
    /// Kernels over the conditions of this rank.
    pub conditions: Vec<Box<dyn EntityBlock>>,
    /// Interactions between bodies, e.g. contact.
    pub interactions: Vec<Box<dyn Interaction>>,
}

impl System {
    /// Makes the blocks from the tables of a part: one for each kind and properties, with the entities of this rank. Elements take over
    /// the states of an earlier stage.
    ///
    /// # Errors
    /// Every block that cannot be made and every entity that cannot be computed with.
    pub fn make_blocks(&mut self, part: &ModelPart) -> Result<()> {
        let mut report = Report::new();
        let mut both = [Vec::new(), Vec::new()];
        let tables = [(EntityRole::Element, &part.elements), (EntityRole::Condition, &part.conditions)];
        let still = (!part.info.solver.follower_loads).then(|| NodesOfSmallDisplacement::of(part));
        for (blocks, (role, table)) in both.iter_mut().zip(tables) {
            let is_own = |at: usize| part.evaluates(role, at);
            let still = still.as_ref().filter(|_| role == EntityRole::Condition);
            let on_initial = |at: usize| still.is_some_and(|still| still.hold(table.nodes(at as u32)));
            for Group { entry, on_initial, members } in groups(table, is_own, on_initial) {
                let Some(make) = block_factory(entry) else {
                    if is_place(entry) {
                        let fact = format!("{} {} has no physics", entry.name, table.ids[members[0] as usize]);
                        let remedy = "name an element in the mesh, or use a solver that puts its own there";
                        report.push(Diagnostic::error("no-physics", fact).remedy(remedy));
                        continue;
                    }
                    let fact = format!(
                        "{} {} of the mesh is a pair, which a search makes",
                        entry.name, table.ids[members[0] as usize]
                    );
                    let problem = Diagnostic::error("pair-in-mesh", fact);
                    report.push(
                        problem.remedy("take these conditions out: processes of contact find their pairs themselves"),
                    );
                    continue;
                };
                let request = BlockRequest { entry, members, table, nodes: &part.nodes, part, on_initial };
                if let Some(block) = report.absorb(make(&request)) {
                    blocks.push(block);
                }
            }
        }
        for blocks in &mut both {
            for block in blocks.iter_mut() {
                report.absorb(block.initialize(&part.view()));
            }
        }
        report.finish()?;
        let [mut elements, conditions] = both;
        // A part that has made no step yet is another than the one before of that name.
        for earlier in self.elements.iter().filter(|_| part.info.step > 0) {
            elements.iter_mut().for_each(|block| block.inherit(earlier.as_ref()));
        }
        (self.elements, self.conditions) = (elements, conditions);
        Ok(())
    }

    /// The blocks over elements (or conditions).
    pub fn blocks(&self, role: EntityRole) -> &[Box<dyn EntityBlock>] {
        if role == EntityRole::Element { &self.elements } else { &self.conditions }
    }
}

/// Entities that make one block.
struct Group {
    entry: &'static EntityKind,
    on_initial: bool,
    members: Vec<u32>,
}

fn groups(table: &EntityTable, is_own: impl Fn(usize) -> bool, on_initial: impl Fn(usize) -> bool) -> Vec<Group> {
    let mut groups: BTreeMap<(&'static str, usize, bool), Vec<u32>> = BTreeMap::new();
    for at in (0..table.len()).filter(|&at| is_own(at)) {
        groups.entry((table.kinds[at].name, table.properties[at], on_initial(at))).or_default().push(at as u32);
    }
    let group = |((_, _, on_initial), members): (_, Vec<u32>)| Group {
        entry: table.kinds[members[0] as usize],
        on_initial,
        members,
    };
    groups.into_iter().map(group).collect()
}

/// Nodes of bodies of small displacements, and of no other.
struct NodesOfSmallDisplacement {
    /// Elements of small displacements at each node, and other solid elements.
    counts: [Vec<f64>; 2],
}

impl NodesOfSmallDisplacement {
    /// The counts of a part; collective.
    fn of(part: &ModelPart) -> Self {
        let mut counts = [vec![0.0; part.nodes.len()], vec![0.0; part.nodes.len()]];
        let (elements, space) = (&part.elements, part.info.domain_size);
        for at in 0..elements.len() {
            let kind = elements.kinds[at];
            if kind.cell.is_some_and(|cell| cell.dim() == space) {
                let counts = &mut counts[usize::from(!kind.small_displacement)];
                elements.nodes(at as u32).iter().for_each(|&node| counts[node as usize] = 1.0);
            }
        }
        if let Some(share) = &part.share {
            counts.iter_mut().for_each(|counts| share.halo.sum(counts));
        }
        Self { counts }
    }

    /// Whether all of some nodes are such.
    fn hold(&self, nodes: &[u32]) -> bool {
        let [small, other] = &self.counts;
        nodes.iter().all(|&node| small[node as usize] > 0.0 && other[node as usize] == 0.0)
    }
}
