//! Whether a part that was read from a file can be one: all lists as long as they must be, all indices of something that is there.

use super::entity_table::EntityTable;
use super::fields::Fields;
use super::mesh_share::MeshShare;
use super::model_part::ModelPart;
use super::nodes::Nodes;
use super::sub_part::SubPart;

/// Time levels are fewer than this.
const MOST_LEVELS: usize = 100;

type CheckResult = Result<(), String>;

fn holds(condition: bool, fact: &str) -> CheckResult {
    if condition { Ok(()) } else { Err(fact.to_owned()) }
}

fn ascends<T: PartialOrd>(list: &[T]) -> bool {
    list.windows(2).all(|pair| pair[0] < pair[1])
}

impl ModelPart {
    /// Whether it can be a part.
    ///
    /// # Errors
    /// The first thing that cannot be.
    pub fn check(&self) -> CheckResult {
        let counts = EntityCounts {
            nodes: self.nodes.len(),
            elements: self.elements.len(),
            conditions: self.conditions.len(),
            geometries: self.geometries.ids.len(),
            constraints: self.constraints.len(),
        };
        check_nodes(&self.nodes)?;
        holds(self.slave_nodes.is_sound(counts.nodes), "its slave nodes are not those of its nodes")?;
        check_fields(&self.slave_nodes.history, self.slave_nodes.len())?;
        self.elements.check(counts.nodes)?;
        self.conditions.check(counts.nodes)?;
        holds(self.geometries.is_sound(counts.nodes), "its geometries are not whole")?;
        check_tree(&self.tree, &counts)?;
        for constraint in &self.constraints {
            let mut nodes = constraint.masters.iter().map(|((node, _), _)| *node).chain([constraint.slave.0]);
            let known = nodes.all(|node| (node as usize) < counts.nodes);
            let forces = constraint.forces.as_ref().is_none_or(|forces| forces.len() == constraint.masters.len());
            let mut unknowns = constraint.masters.iter().map(|((_, unknown), _)| *unknown).chain([constraint.slave.1]);
            let real = unknowns.all(|unknown| unknown.component.is_none_or(|component| component < 3));
            holds(known && forces && real, "a constraint is not whole")?;
        }
        self.share.as_ref().map_or(Ok(()), |share| check_share(share, &counts))
    }
}

struct EntityCounts {
    nodes: usize,
    elements: usize,
    conditions: usize,
    geometries: usize,
    constraints: usize,
}

fn check_nodes(nodes: &Nodes) -> CheckResult {
    let count = nodes.len();
    holds(ascends(&nodes.ids), "ids of nodes do not ascend")?;
    holds(nodes.initial.len() == count && nodes.current.len() == count, "not every node has coordinates")?;
    check_fields(&nodes.history, count)?;
    check_fields(&nodes.values, count)?;
    holds(nodes.flags.is_sound(count), "flags are not those of its nodes")?;
    holds(nodes.fixities.is_sound(count), "prescribed unknowns are not those of its nodes")
}

fn check_fields(fields: &Fields, count: usize) -> CheckResult {
    if fields.iter().next().is_none() {
        return holds(fields.len() <= count && fields.levels() < MOST_LEVELS, "a table of values has another length");
    }
    holds(fields.len() == count, "a table of values has another length")?;
    for (name, field) in fields.iter() {
        let whole = field.levels.iter().all(|level| level.len() == count * field.components);
        let known = matches!(field.components, 1 | 3) && field.levels.len() == fields.levels().max(1);
        holds(whole && known, &format!("values of {name} are not those of its nodes or entities"))?;
    }
    Ok(())
}

impl EntityTable {
    fn check(&self, nodes: usize) -> CheckResult {
        holds(self.is_sound(nodes), "a table of entities is not whole")?;
        let mut ids = self.ids.clone();
        ids.sort_unstable();
        holds(ascends(&ids), "an id is given twice")?;
        check_fields(&self.data, self.len())
    }
}

fn check_tree(tree: &SubPart, counts: &EntityCounts) -> CheckResult {
    let lists = [
        (&tree.nodes, counts.nodes),
        (&tree.elements, counts.elements),
        (&tree.conditions, counts.conditions),
        (&tree.geometries, counts.geometries),
        (&tree.constraints, counts.constraints),
    ];
    let known =
        |(list, count): (&Vec<u32>, usize)| ascends(list) && list.last().is_none_or(|&at| (at as usize) < count);
    holds(lists.into_iter().all(known), &format!("the sub part {} selects entities that do not exist", tree.name))?;
    tree.children.values().try_for_each(|child| check_tree(child, counts))
}

fn check_share(share: &MeshShare, counts: &EntityCounts) -> CheckResult {
    let ranks = share.halo.copied.len();
    let lengths = [&share.owners, &share.pairs, &share.places].iter().all(|list| list.len() == counts.nodes)
        && share.common.len() == counts.nodes
        && share.elements.len() == counts.elements
        && share.conditions.len() == counts.conditions;
    let owners = [&share.owners, &share.pairs, &share.elements, &share.conditions];
    let known = owners.into_iter().flatten().all(|&rank| (rank as usize) < ranks);
    let places =
        ascends(&share.places) && share.places.last().is_none_or(|&place| (place as usize) < share.whole.nodes);
    let lists = [&share.halo.copied, &share.halo.copies, &share.halo.everywhere];
    let here = lists.into_iter().flatten().flatten().all(|&node| (node as usize) < counts.nodes);
    let halo = share.halo.copies.len() == ranks && share.halo.everywhere.len() == ranks && here;
    holds(lengths && known && places && halo, "the share of a rank is not whole")
}
