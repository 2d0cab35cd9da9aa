//! Direction of a load on faces, by the force of the faces' own conditions under a unit value.
//!
//! Face pressures have opposite signs in the plane and in space, as in Kratos, and follow the order of a face's nodes; a deck that
//! means to press may pull. Numbers of which faces make no force along their normals are passed over.

use std::collections::BTreeMap;

use super::assign_to_entities::centre;
use crate::diagnostics::{Diagnostic, counted};
use crate::entities::{BlockFactory, BlockRequest, LocalSystems, Request, block_factory};
use crate::model::{EntityKind, Field, ModelPart, ScalarVariable};
use crate::vector3::{dot, sub};

/// How many faces a positive number presses on, and how many it pulls.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct Faces {
    pressed: usize,
    pulled: usize,
}

/// Where the number stands that faces read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LoadTable {
    Conditions,
    /// Nodes, in columns with history.
    Nodes,
}

impl LoadTable {
    /// The column of the number.
    fn column(self, part: &mut ModelPart, variable: ScalarVariable) -> Option<&mut Field> {
        match self {
            Self::Conditions => part.conditions.data.get_mut(variable.column),
            Self::Nodes => part.nodes.history.get_mut(variable.column),
        }
    }
}

/// Warning where `variable`, given to `conditions`, pulls at some of them; `sign` is that of the value where it is a constant.
pub(super) fn pulling(
    part: &mut ModelPart,
    conditions: &[u32],
    variable: ScalarVariable,
    sign: Option<f64>,
) -> Option<Diagnostic> {
    pulling_by(part, conditions, variable, sign, LoadTable::Conditions)
}

/// As [`pulling`], of the faces all of whose nodes are among `nodes`, which are given the number.
pub(super) fn pulling_of_nodes(
    part: &mut ModelPart,
    nodes: &[u32],
    variable: ScalarVariable,
    sign: Option<f64>,
) -> Option<Diagnostic> {
    let is_one = |node: &u32| nodes.binary_search(node).is_ok();
    let table = &part.conditions;
    let faces = (0..table.len() as u32).filter(|&at| table.nodes(at).iter().all(is_one)).collect::<Vec<u32>>();
    if faces.is_empty() || part.nodes.history.get(variable.column).is_none_or(|field| field.components != 1) {
        return None;
    }
    pulling_by(part, &faces, variable, sign, LoadTable::Nodes)
}

fn pulling_by(
    part: &mut ModelPart,
    conditions: &[u32],
    variable: ScalarVariable,
    sign: Option<f64>,
    carrier: LoadTable,
) -> Option<Diagnostic> {
    let sign = sign.unwrap_or(1.0);
    if variable.component.is_some() || sign == 0.0 || part.share.is_some() {
        return None;
    }
    let mut by_kind: BTreeMap<&str, (&'static EntityKind, Vec<u32>)> = BTreeMap::new();
    for &at in conditions {
        let entry = part.conditions.kinds[at as usize];
        if entry.cell.is_some_and(|shape| shape.dim() > 0)
            && part.properties.contains_key(&part.conditions.properties[at as usize])
        {
            by_kind.entry(entry.name).or_insert((entry, Vec::new())).1.push(at);
        }
    }
    let owners = owners(part, conditions);
    let mut faces = Faces::default();
    for (entry, members) in by_kind.into_values() {
        for (at, force) in unit_forces(part, entry, &members, variable, carrier).unwrap_or_default() {
            let Some(element) = owners.get(&at) else { continue };
            let middle = |nodes| centre(nodes, &part.nodes.initial);
            let outward = sub(middle(part.conditions.nodes(at)), middle(part.elements.nodes(*element)));
            let along = sign * dot(force, outward);
            faces.pressed += usize::from(along < 0.0);
            faces.pulled += usize::from(along > 0.0);
        }
    }
    let (above, which) = (if sign > 0.0 { "above" } else { "below" }, variable.column);
    let rule = "face pressures have opposite signs in the plane and in space, and follow the order of a face's nodes";
    match faces {
        Faces { pulled: 0, .. } => None,
        Faces { pressed: 0, pulled } => {
            let fact = format!("{which} {above} zero pulls at all {pulled} faces it is given to: {rule}");
            Some(Diagnostic::note("face-pressure-pulls", fact).remedy("to press, change the sign of the value"))
        }
        Faces { pressed, pulled } => {
            let fact = format!(
                "{which} {above} zero presses on {} and pulls at {pulled} of the same part: {rule}",
                counted(pressed, "face", "faces")
            );
            let remedy = "list the nodes of all faces the same way round, seen from outside";
            Some(Diagnostic::warning("face-pressure-mixed", fact).remedy(remedy))
        }
    }
}

/// Force of each condition for the number one less that for zero; `None` where its kind makes none.
fn unit_forces(
    part: &mut ModelPart,
    entry: &'static EntityKind,
    members: &[u32],
    variable: ScalarVariable,
    carrier: LoadTable,
) -> Option<Vec<(u32, [f64; 3])>> {
    let make = block_factory(entry)?;
    if carrier == LoadTable::Conditions {
        part.conditions.data.add_named(variable.column, 1);
    }
    let before = carrier.column(part, variable)?.levels[0].clone();
    let items: Vec<u32> = match carrier {
        LoadTable::Conditions => members.to_vec(),
        LoadTable::Nodes => members.iter().flat_map(|&at| part.conditions.nodes(at)).copied().collect(),
    };
    let mut forces = Vec::new();
    for number in [1.0, 0.0] {
        let values = &mut carrier.column(part, variable)?.levels[0];
        items.iter().for_each(|&at| values[at as usize] = number);
        forces.push(forces_of(part, entry, make, members));
    }
    carrier.column(part, variable)?.levels[0] = before;
    let (none, one) = (forces.pop()??, forces.pop()??);
    Some(members.iter().zip(one.into_iter().zip(none)).map(|(&at, (one, none))| (at, sub(one, none))).collect())
}

fn forces_of(
    part: &ModelPart,
    entry: &'static EntityKind,
    make: BlockFactory,
    members: &[u32],
) -> Option<Vec<[f64; 3]>> {
    let (table, nodes) = (&part.conditions, &part.nodes);
    let mut block =
        make(&BlockRequest { entry, members: members.to_vec(), table, nodes, part, on_initial: true }).ok()?;
    block.initialize(&part.view()).ok()?;
    // A flux of heat presses on nothing: it has no direction.
    if block.unknowns().iter().any(|unknown| unknown.variable.component.is_none()) {
        return None;
    }
    let (size, mut out) = (block.unknowns().len(), LocalSystems::default());
    out.reset(members.len(), size, Request::Residual);
    block.local_systems(&part.view(), 0..members.len(), Request::Residual, &mut out).ok()?;
    let force = |at: usize| {
        let rows = block.unknowns().iter().zip(&out.rhs[at * size..(at + 1) * size]);
        rows.fold([0.0; 3], |mut sum: [f64; 3], (unknown, value)| {
            sum[unknown.variable.offset()] += value;
            sum
        })
    };
    Some((0..members.len()).map(force).collect())
}

/// An element behind each condition that is a face of one.
fn owners(part: &ModelPart, conditions: &[u32]) -> BTreeMap<u32, u32> {
    let mut around: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    conditions.iter().flat_map(|&at| part.conditions.nodes(at)).for_each(|&node| {
        around.entry(node).or_default();
    });
    for element in 0..part.elements.len() as u32 {
        for node in part.elements.nodes(element) {
            if let Some(list) = around.get_mut(node) {
                list.push(element);
            }
        }
    }
    let holds = |element: u32, nodes: &[u32]| nodes.iter().all(|node| part.elements.nodes(element).contains(node));
    let owner = |at: u32| {
        let nodes = part.conditions.nodes(at);
        around.get(nodes.first()?)?.iter().copied().find(|&element| holds(element, nodes))
    };
    conditions.iter().filter_map(|&at| Some((at, owner(at)?))).collect()
}
