//! Whether a model says one thing once: entities listed twice, unknowns that are prescribed two values, loads that are given twice.

use std::collections::BTreeMap;

use rustc_hash::{FxHashMap, FxHashSet};
use zelus_linear_algebra::parallel;

use crate::assembly::{DofTable, Equations};
use crate::diagnostics::{Diagnostic, Report, Result, counted};
use crate::geometry::Shape;
use crate::model::flags::NEW_ENTITY;
use crate::model::{
    EntityRole, EntityTable, ModelPart, NodeUnknown, Owner, ScalarVariable, SubPart, SupportConflict,
    SupportedComponent, mesh_box, reduce_supports,
};
use crate::processes::{DirectionalPrescription, Load, LoadCarrier, Prescription, Process, conflict, is_body_load};
use crate::vector3::norm;

/// Difference of two values that are the same, as a share of the larger.
const SAME: f64 = 1e-12;

/// Height of a planar model, as a share of its size, that is round-off.
const FLAT: f64 = 1e-9;

/// Entities that a thread takes at a time, at least.
const ENTITIES: usize = 1 << 12;

/// Lists of entities that are sorted side by side.
const LISTS: usize = 64;

/// Warns of solid elements, and of conditions of one kind, on the same nodes as others of the mesh: their stiffness, mass and loads
/// count twice.
pub(super) fn warn_of_twins(part: &ModelPart, problems: &mut Report) {
    for (role, table) in [(EntityRole::Element, &part.elements), (EntityRole::Condition, &part.conditions)] {
        let solid = |at: u32| table.kinds[at as usize].cell.is_some_and(|cell| cell.dim() == part.info.domain_size);
        let of_mesh = |at: u32| table.kinds[at as usize].cell.is_some() && !table.flags.is(NEW_ENTITY, at as usize);
        let wanted = |at: u32| if role == EntityRole::Element { solid(at) } else { of_mesh(at) };
        // Two loads of one surface are two conditions, in parts of their own.
        let mut twins = twins(table, wanted);
        twins.retain(|pair| role == EntityRole::Element || share_part(&part.tree, pair));
        let Some(&[first, second]) = twins.first() else { continue };
        let [one, several] = match role {
            EntityRole::Element => ["element has", "elements have"],
            EntityRole::Condition => ["condition has", "conditions have"],
        };
        let (kind, ids) = (table.kinds[second as usize].name, &table.ids);
        let fact = format!(
            "{} the nodes of others, the first is {kind} {} with those of {}: their contribution counts twice",
            counted(twins.len(), one, several),
            ids[second as usize],
            ids[first as usize]
        );
        let remedy = "take them out of the mesh, unless bodies or loads are meant to lie over each other";
        problems.push(Diagnostic::warning("listed-twice", fact).remedy(remedy));
    }
}

/// Warns of a planar model whose nodes do not lie in one plane z: elements leave their heights out, distances do not. Collective.
pub(super) fn warn_of_height(part: &ModelPart, problems: &mut Report) {
    if part.info.domain_size != 2 {
        return;
    }
    let [low, high] = mesh_box(part);
    let size = norm([high[0] - low[0], high[1] - low[1], 0.0]);
    if high[2] - low[2] > FLAT * size {
        let fact = format!("a planar model, but z of its nodes is from {} to {}", low[2], high[2]);
        let remedy = "give all nodes the same z, or set \"domain_size\" to 3";
        problems.push(Diagnostic::warning("out-of-plane", fact).remedy(remedy));
    }
}

/// Warns of elements that name a node twice: a quadrilateral then is a triangle, and where that is a slip of the mesh there is a hole.
pub(super) fn warn_of_collapsed(part: &ModelPart, problems: &mut Report) {
    let table = &part.elements;
    let repeated = |at: u32| {
        let nodes = table.nodes(at);
        nodes.iter().enumerate().find(|(place, node)| nodes[..*place].contains(node)).map(|(_, &node)| node)
    };
    let found = parallel::select(table.len(), ENTITIES, |at| repeated(at as u32).is_some());
    let Some((&first, node)) = found.first().and_then(|first| Some((first, repeated(*first)?))) else { return };
    let kind = table.kinds[first as usize];
    let word = counted(found.len(), "element names", "elements name");
    let fact = format!(
        "{word} a node twice, the first is {} {} with node {}: an edge of it has no length",
        kind.name, table.ids[first as usize], part.nodes.ids[node as usize]
    );
    let smaller = match kind.cell {
        Some(Shape::Quad4 | Shape::Quad8 | Shape::Quad9) => "triangles",
        Some(Shape::Hex8 | Shape::Hex20 | Shape::Hex27) => "prisms",
        _ => "elements with fewer nodes",
    };
    let remedy =
        format!("name the node that is missing: the mesh has a hole there; where it has none, mesh it with {smaller}");
    problems.push(Diagnostic::warning("collapsed-element", fact).remedy(remedy));
}

/// Whether the smallest part that holds the later of two conditions, this one or one below it, holds both.
fn share_part(part: &SubPart, pair: &[u32; 2]) -> bool {
    let [earlier, later] = pair;
    let holds = |part: &SubPart, at: &u32| part.conditions.binary_search(at).is_ok();
    let below = part.children.values().filter(|child| holds(child, later)).min_by_key(|child| child.conditions.len());
    below.is_none_or(|child| holds(child, earlier) && share_part(child, pair))
}

/// Entities with the nodes of an earlier one, conditions of the same kind: the earlier and the later.
fn twins(table: &EntityTable, wanted: impl Fn(u32) -> bool + Sync) -> Vec<[u32; 2]> {
    // Key that twins share, and few others.
    let key = |at: u32| {
        let nodes = table.nodes(at);
        let kind =
            if table.kinds[at as usize].role == EntityRole::Element { "" } else { table.kinds[at as usize].name };
        let least = nodes.iter().copied().min().unwrap_or(0);
        (least, nodes.iter().map(|&node| u64::from(node).pow(2)).sum::<u64>(), kind)
    };
    let entities = parallel::select(table.len(), ENTITIES, |at| wanted(at as u32));
    let keys = parallel::map(entities.len(), ENTITIES, |at| (key(entities[at]), entities[at]));
    // Twins stand in one list, each of which is sorted by one thread.
    let mut lists = vec![Vec::new(); LISTS];
    keys.into_iter().for_each(|key| lists[key.0.0 as usize % LISTS].push(key));
    parallel::each_mut(&mut lists, 1, |_, list| list.sort_unstable());
    let sorted = |of: u32| {
        let mut nodes = table.nodes(of).to_vec();
        nodes.sort_unstable();
        nodes
    };
    let mut out = Vec::new();
    let groups = lists.iter().flat_map(|list| list.chunk_by(|a, b| a.0 == b.0));
    for alike in groups.filter(|alike| alike.len() > 1) {
        let (_, earlier) = alike[0];
        let later = alike[1..].iter().map(|&(_, later)| later);
        out.extend(later.filter(|&later| sorted(earlier) == sorted(later)).map(|later| [earlier, later]));
    }
    out.sort_unstable_by_key(|&[_, later]| later);
    out
}

/// Prescriptions of the processes on a root part at a time, in their order.
pub(super) fn prescriptions(part: &ModelPart, processes: &[Box<dyn Process>], time: f64) -> Vec<Prescription> {
    processes.iter().flat_map(|process| process.prescribes(part, time)).collect()
}

/// Warns of unknowns that two processes fix at different values at one of these times: the later process wins.
pub(super) fn warn_of_contradictions(
    part: &ModelPart,
    processes: &[Box<dyn Process>],
    times: [f64; 2],
    problems: &mut Report,
) {
    for time in times {
        let all = prescriptions(part, processes, time);
        let mut known: FxHashMap<(ScalarVariable, u32), (usize, f64)> = FxHashMap::default();
        // First node, its two values and the number of nodes, by the two contradicting processes.
        let mut found: Vec<([usize; 2], u32, [f64; 2], usize)> = Vec::new();
        for (at, own) in all.iter().enumerate() {
            for &(node, value) in &own.values {
                let Some(value) = value else { continue };
                let Some((before, other)) = known.insert((own.variable, node), (at, value)) else { continue };
                if (value - other).abs() <= SAME * value.abs().max(other.abs()) {
                    continue;
                }
                match found.iter_mut().find(|(pair, ..)| *pair == [before, at]) {
                    Some((.., count)) => *count += 1,
                    None => found.push(([before, at], node, [other, value], 1)),
                }
            }
        }
        for ([before, at], node, [other, value], count) in &found {
            let fact = format!(
                "at time {time}, {} two values of {}, the first is node {}: {other} by {} and {value} by {}, which wins",
                counted(*count, "node gets", "nodes get"),
                all[*at].variable,
                part.nodes.ids[*node as usize],
                all[*before].by,
                all[*at].by
            );
            let remedy = "take the nodes out of one of the parts, or leave the unknown to one of the processes";
            problems.push(Diagnostic::warning("contradicting-values", fact).remedy(remedy));
        }
        if !found.is_empty() {
            return;
        }
    }
}

/// Checks linear constraints against the supports of the processes at a time: a supported slave may follow supported nodes alone,
/// and only at the value that they give it.
///
/// # Errors
/// As [`Equations::with_supports`].
pub(super) fn check_constraints(
    part: &ModelPart,
    dofs: &DofTable,
    processes: &[Box<dyn Process>],
    time: f64,
) -> Result<()> {
    let along: Vec<DirectionalPrescription> =
        processes.iter().filter_map(|process| process.prescribes_along(part, time)).collect();
    if part.constraints.is_empty() && along.is_empty() {
        return Ok(());
    }
    let mut known: FxHashMap<(ScalarVariable, u32), Option<f64>> = FxHashMap::default();
    for prescription in prescriptions(part, processes, time) {
        let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
        known.extend(prescription.values.iter().map(|&(node, value)| ((prescription.variable, node), finite(value))));
    }
    Equations::with_supports(dofs, part, &|variable, node| known.get(&(variable, node)).copied())?;
    check_directions(part, &along, &known)
}

/// Checks supports along directions against each other, and against prescribed components and constraints of the same nodes.
fn check_directions(
    part: &ModelPart,
    along: &[DirectionalPrescription],
    known: &FxHashMap<(ScalarVariable, u32), Option<f64>>,
) -> Result<()> {
    if along.is_empty() {
        return Ok(());
    }
    let dimension = part.info.domain_size;
    let following = part.constraints.iter().filter(|own| own.active && own.set.is_none() && own.support.is_none());
    let following: FxHashSet<NodeUnknown> = following.map(|constraint| constraint.slave).collect();
    // Process, direction and value of each equation, by node.
    let mut of_nodes: BTreeMap<(u32, &'static str), Vec<(usize, [f64; 3], f64)>> = BTreeMap::new();
    for (process, own) in along.iter().enumerate() {
        for &(node, direction, value) in &own.values {
            of_nodes.entry((node, own.column)).or_default().push((process, direction, value));
        }
    }
    for ((node, column), equations) in of_nodes {
        let role = |c: usize| {
            let variable = ScalarVariable { column, component: Some(c as u8) };
            let by_mesh = || part.nodes.is_fixed(variable, node).then_some(None);
            match known.get(&(variable, node)).copied().or_else(by_mesh) {
                _ if following.contains(&(node, variable)) => SupportedComponent::Follows,
                Some(value) => SupportedComponent::Prescribed(value),
                None => SupportedComponent::Free,
            }
        };
        let rows: Vec<_> = equations.iter().map(|&(_, direction, value)| (direction, Some(value))).collect();
        if let Err(why) = reduce_supports(&rows, std::array::from_fn(role), dimension) {
            let (SupportConflict::Contradiction(at, _) | SupportConflict::Constrained(at)) = why;
            let (process, direction, _) = equations[at];
            let DirectionalPrescription { by, place, .. } = &along[process];
            let problem = conflict(by, part.nodes.ids[node as usize], direction, dimension, &why);
            return Err(problem.at(place.clone()).into());
        }
    }
    Ok(())
}

/// Warns of loads that a later process gives in place of those of an earlier one, where both act at once; collective.
pub(super) fn warn_of_loads_given_twice(part: &ModelPart, processes: &[Box<dyn Process>], problems: &mut Report) {
    let loads: Vec<Load> = processes.iter().flat_map(|process| process.loads(part)).collect();
    let pairs =
        loads.iter().enumerate().flat_map(|(at, later)| loads[..at].iter().map(move |earlier| (earlier, later)));
    let acts_with = |(one, other): &(&Load, &Load)| {
        let [begin, end] = [one.interval.begin.max(other.interval.begin), one.interval.end.min(other.interval.end)];
        one.on == other.on && begin < end && one.variables.iter().any(|variable| other.variables.contains(variable))
    };
    let pairs: Vec<(&Load, &Load)> = pairs.filter(acts_with).collect();
    let shared = |(one, other): &(&Load, &Load)| {
        let nodes = matches!(one.on, LoadCarrier::History | LoadCarrier::Nodes);
        let own = one.members.iter().filter(|&&member| !nodes || part.owns_node(member as usize));
        own.filter(|member| other.members.binary_search(member).is_ok()).count() as f64
    };
    let mut counts: Vec<f64> = pairs.iter().map(shared).collect();
    part.ranks.sum(&mut counts);
    for ((earlier, later), count) in pairs.into_iter().zip(counts).filter(|(_, count)| *count > 0.0) {
        let word = match later.on {
            LoadCarrier::History | LoadCarrier::Nodes => "nodes",
            LoadCarrier::Conditions => "conditions",
            LoadCarrier::Elements => "elements",
        };
        let fact = format!(
            "{} of {count} {word} is given by {} at {}, and by {}, which takes its place: they do not add up",
            later.variables[0].column, earlier.by, earlier.place, later.by
        );
        let remedy = "give the sum in one process, take what both have out of one of the parts, or let their intervals follow each other";
        problems.push(Diagnostic::warning("load-given-twice", fact).at(later.place.clone()).remedy(remedy));
    }
}

/// Warns of loads on conditions and nodes whose unknowns supports prescribe one and all at both `times`: they act on the supports alone.
/// Collective.
pub(super) fn warn_of_supported_loads(
    part: &ModelPart,
    dofs: &DofTable,
    processes: &[Box<dyn Process>],
    times: [f64; 2],
    problems: &mut Report,
) {
    let loads: Vec<Load> = processes.iter().flat_map(|process| process.loads(part)).collect();
    let prescribed = times.map(|time| -> FxHashSet<(ScalarVariable, u32)> {
        let all = prescriptions(part, processes, time).into_iter();
        all.flat_map(|own| own.values.into_iter().map(move |(node, _)| (own.variable, node))).collect()
    });
    let variables: Vec<ScalarVariable> = dofs.variables().collect();
    let is_free = |node: u32| {
        let own = variables.iter().filter(|&&variable| dofs.number_of(variable, Owner::Node(node)).is_some());
        own.into_iter().any(|&variable| prescribed.iter().any(|held| !held.contains(&(variable, node))))
    };
    let acts = |load: &Load| match load.on {
        LoadCarrier::Elements => true,
        LoadCarrier::Conditions => {
            load.members.iter().flat_map(|&at| part.conditions.nodes(at)).any(|&node| is_free(node))
        }
        LoadCarrier::History | LoadCarrier::Nodes => load.members.iter().any(|&node| is_free(node)),
    };
    let mut free: Vec<[f64; 2]> =
        loads.iter().map(|load| [load.members.len() as f64, f64::from(u8::from(acts(load)))]).collect();
    part.ranks.sum(free.as_flattened_mut());
    let all_in_supports = loads.iter().zip(free).filter(|(_, [members, acts])| *members > 0.0 && *acts == 0.0);
    for (load, _) in all_in_supports.filter(|(load, _)| load.variables.iter().all(|of| !is_body_load(of.column))) {
        let fact = format!(
            "{} by {} acts on supports alone: they hold every node of it in all directions",
            load.variables[0].column, load.by
        );
        let remedy = "take the nodes out of the support, or leave the load out";
        problems.push(Diagnostic::warning("load-on-support", fact).at(load.place.clone()).remedy(remedy));
    }
}
