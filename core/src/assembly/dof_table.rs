//! Unknowns of a system: which exist, and their numbers.

use std::collections::BTreeMap;

use zelus_linear_algebra::Unknowns;
use zelus_linear_algebra::vector::zeros;

use crate::model::{ColumnOf, DofOwners, Field, ModelPart, Owner, Rates, ScalarVariable};
use crate::names::{Name, lasting};

/// "Not an unknown of the system" in the table of numbers.
pub const NONE: u32 = u32::MAX;

/// One unknown of the system.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dof {
    /// Index of the mesh node at which it stands.
    pub node: u32,
    /// Its owner, which has its value.
    pub owner: Owner,
    /// The unknown.
    pub variable: ScalarVariable,
    /// Whether it is a Lagrange multiplier.
    pub multiplier: bool,
}

impl Dof {
    /// The columns that go with it, where it has derivatives by time.
    pub fn rates(&self) -> Option<&'static Rates> {
        Rates::of(self.variable.column)
    }

    /// Whether it moves its node.
    pub fn moves_mesh(&self) -> bool {
        moves_mesh(self.variable)
    }

    /// Its value at a time level (0 the present); `None` where there is no such column or level.
    pub fn value(&self, part: &ModelPart, level: usize) -> Option<f64> {
        part.value_of(self.owner, self.variable, level)
    }

    /// Sets its present value.
    pub fn set_value(&self, part: &mut ModelPart, value: f64) {
        part.set_value_of(self.owner, self.variable, 0, value);
    }

    /// Takes its value back to that of the step before, where there is one.
    pub fn step_back(&self, part: &mut ModelPart) {
        if let Some(before) = self.value(part, 1) {
            self.set_value(part, before);
        }
    }
}

fn moves_mesh(unknown: ScalarVariable) -> bool {
    Rates::of(unknown.column).is_some_and(|rates| rates.moves_mesh)
}

/// Numbers of the unknowns of one variable by owner; [`NONE`] where an owner has none.
#[derive(Debug, Clone)]
struct VariableNumbers {
    nodes: Vec<u32>,
    slaves: Vec<u32>,
}

/// All unknowns, numbered by mesh node first so that those at a mesh node stand together: its own, then those of the slave
/// nodes there.
///
/// ```
/// use zelus_core::assembly::DofTable;
/// use zelus_core::model::{DofOwners, ModelPart, Nodes, Owner, ScalarVariable};
///
/// let mut part = ModelPart::new("Structure");
/// part.nodes = Nodes::new(vec![1, 2], vec![[0.0; 3], [1.0, 0.0, 0.0]]);
/// part.slave_nodes.set("floor", &[0]);
/// part.slave_nodes.set("wall", &[0]);
/// let [motion, pressure] = ["MOTION", "PRESSURE"].map(|column| ScalarVariable { column, component: None });
/// let mut dofs = DofTable::default();
/// dofs.number(&part, &[DofOwners::of_nodes(motion, vec![0, 1])], &[DofOwners::of_slaves(pressure, 0..2)]);
/// assert_eq!(dofs.number_of(pressure, Owner::Slave(1)), Some(2));
/// assert_eq!(dofs.number_of(motion, Owner::Node(1)), Some(3));
/// ```
#[derive(Debug, Clone, Default)]
pub struct DofTable {
    dofs: Vec<Dof>,
    /// Mask of unknowns that move their node.
    moving: Vec<bool>,
    /// Place of each unknown's variable among [`DofTable::variables`].
    kinds: Vec<u16>,
    /// Mask of variables that are Lagrange multipliers.
    multipliers: Vec<bool>,
    numbers: BTreeMap<ScalarVariable, VariableNumbers>,
    /// Names of the sets of slave nodes.
    sets: Vec<Name>,
    /// Set of each slave node.
    set_of: Vec<u32>,
    version: u64,
}

impl DofTable {
    /// Numbers the unknowns of `primary` and, after them, the Lagrange multipliers of `multipliers`.
    ///
    /// At a mesh node its own unknowns come first, then those of each slave node there in ascending order, each time in the
    /// order in which the variables are given.
    pub fn number(&mut self, part: &ModelPart, primary: &[DofOwners], multipliers: &[DofOwners]) {
        struct Present {
            variable: ScalarVariable,
            multiplier: bool,
            nodes: Vec<bool>,
            slaves: Vec<bool>,
        }
        let [nodes, slaves] = [part.nodes.len(), part.slave_nodes.len()];
        let mut present: Vec<Present> = Vec::new();
        let all = primary.iter().map(|own| (own, false)).chain(multipliers.iter().map(|own| (own, true)));
        for (own, multiplier) in all {
            let at = present.iter().position(|known| known.variable == own.variable).unwrap_or_else(|| {
                let (nodes, slaves) = (vec![false; nodes], vec![false; slaves]);
                present.push(Present { variable: own.variable, multiplier, nodes, slaves });
                present.len() - 1
            });
            own.nodes.iter().for_each(|&node| present[at].nodes[node as usize] = true);
            own.slaves.iter().for_each(|&slave| present[at].slaves[slave as usize] = true);
        }
        self.dofs.clear();
        self.moving.clear();
        self.kinds.clear();
        let mut ordered: Vec<(ScalarVariable, bool)> =
            present.iter().map(|own| (own.variable, own.multiplier)).collect();
        ordered.sort_unstable();
        let place = |variable| ordered.iter().position(|(other, _)| *other == variable).expect("it is among them");
        let kinds: Vec<u16> = present.iter().map(|own| place(own.variable) as u16).collect();
        self.multipliers = ordered.iter().map(|(_, is)| *is).collect();
        let moving: Vec<bool> = present.iter().map(|own| moves_mesh(own.variable)).collect();
        let mut numbers = vec![VariableNumbers { nodes: vec![NONE; nodes], slaves: vec![NONE; slaves] }; present.len()];
        let mut add = |at: usize, node: u32, owner: Owner| {
            let Present { variable, multiplier, .. } = present[at];
            let number = match owner {
                Owner::Node(node) => &mut numbers[at].nodes[node as usize],
                Owner::Slave(slave) => &mut numbers[at].slaves[slave as usize],
            };
            *number = self.dofs.len() as u32;
            self.moving.push(moving[at]);
            self.kinds.push(kinds[at]);
            self.dofs.push(Dof { node, owner, variable, multiplier });
        };
        let slaves = part.slave_nodes.by_mesh_node();
        let mut slaves = slaves.into_iter().peekable();
        for node in 0..nodes as u32 {
            for (at, _) in present.iter().enumerate().filter(|(_, own)| own.nodes[node as usize]) {
                add(at, node, Owner::Node(node));
            }
            while let Some(slave) = slaves.next_if(|&slave| part.slave_nodes.mesh_node(slave) == node) {
                for (at, _) in present.iter().enumerate().filter(|(_, own)| own.slaves[slave as usize]) {
                    add(at, node, Owner::Slave(slave));
                }
            }
        }
        self.numbers = present.iter().map(|own| own.variable).zip(numbers).collect();
        self.sets = part.slave_nodes.sets().map(|(name, _)| lasting(name)).collect();
        let of_set = |(at, (_, range)): (usize, (&str, std::ops::Range<u32>))| range.map(move |_| at as u32);
        self.set_of = part.slave_nodes.sets().enumerate().flat_map(of_set).collect();
        self.version += 1;
    }

    /// Names of the unknowns of each mesh node; a slave node's carry the name of its set.
    pub fn layout(&self) -> Unknowns {
        let nodes = self.dofs.last().map_or(0, |last| last.node + 1);
        let mut runs: Vec<(u32, &[Dof])> = Vec::new();
        let mut left = self.dofs.as_slice();
        for node in 0..nodes {
            let (own, others) = left.split_at(left.partition_point(|dof| dof.node <= node));
            left = others;
            let is_like =
                |known: &[Dof]| known.iter().map(|dof| self.kind(dof)).eq(own.iter().map(|dof| self.kind(dof)));
            match runs.last_mut().filter(|(_, known)| is_like(known)) {
                Some((nodes, _)) => *nodes += 1,
                None => runs.push((1, own)),
            }
        }
        let name = |dof: &Dof| match self.kind(dof) {
            (variable, None) => variable.to_string(),
            (variable, Some(set)) => format!("{variable} of {}", self.sets[set as usize]),
        };
        let names = |dofs: &[Dof]| dofs.iter().map(name).collect();
        Unknowns(runs.into_iter().map(|(nodes, dofs)| (nodes, names(dofs))).collect())
    }

    fn kind(&self, dof: &Dof) -> (ScalarVariable, Option<u32>) {
        (dof.variable, self.set_of(dof))
    }

    /// Set of the slave node that owns an unknown, as [`DofTable::sets`] counts them; `None` for an unknown of a mesh node.
    pub fn set_of(&self, dof: &Dof) -> Option<u32> {
        match dof.owner {
            Owner::Node(_) => None,
            Owner::Slave(slave) => Some(self.set_of[slave as usize]),
        }
    }

    /// Names of the sets of slave nodes, the same on all ranks.
    pub fn sets(&self) -> &[Name] {
        &self.sets
    }

    /// Whether other slave nodes stand at the mesh node of the one that owns an unknown.
    pub fn is_one_of_several(&self, number: usize) -> bool {
        let dof = &self.dofs[number];
        let is_other = |other: &Dof| matches!(other.owner, Owner::Slave(_)) && other.owner != dof.owner;
        let at_node = |other: &&Dof| other.node == dof.node;
        let (before, after) = self.dofs.split_at(number);
        matches!(dof.owner, Owner::Slave(_))
            && (before.iter().rev().take_while(at_node).any(is_other) || after.iter().take_while(at_node).any(is_other))
    }

    /// All unknowns in the order of their numbers.
    pub fn dofs(&self) -> &[Dof] {
        &self.dofs
    }

    /// Whether an unknown moves its node.
    pub fn moves_mesh(&self, number: usize) -> bool {
        self.moving[number]
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.dofs.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.dofs.is_empty()
    }

    /// Changes with every renumbering.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Numbers of a variable by mesh node; [`NONE`] where the node does not own it. Empty when nothing owns it.
    pub fn numbers(&self, variable: ScalarVariable) -> &[u32] {
        self.numbers.get(&variable).map_or(&[], |numbers| &numbers.nodes)
    }

    /// As [`DofTable::numbers`], by slave node.
    pub fn slave_numbers(&self, variable: ScalarVariable) -> &[u32] {
        self.numbers.get(&variable).map_or(&[], |numbers| &numbers.slaves)
    }

    /// Numbers of a variable: those of mesh nodes, then those of slave nodes, each in ascending order.
    pub fn of_variable(&self, variable: ScalarVariable) -> impl Iterator<Item = usize> + '_ {
        let all = self.numbers(variable).iter().chain(self.slave_numbers(variable));
        all.filter(|number| **number != NONE).map(|&number| number as usize)
    }

    /// Place of each unknown's variable among [`DofTable::variables`].
    pub fn kinds(&self) -> &[u16] {
        &self.kinds
    }

    /// Mask of [`DofTable::variables`] that are Lagrange multipliers.
    pub fn multipliers(&self) -> &[bool] {
        &self.multipliers
    }

    /// The variables of unknowns, those of other ranks too, in one order on all of them.
    pub fn variables(&self) -> impl Iterator<Item = ScalarVariable> + '_ {
        self.numbers.keys().copied()
    }

    /// Number of one unknown.
    pub fn number_of(&self, variable: ScalarVariable, owner: Owner) -> Option<u32> {
        let number = match owner {
            Owner::Node(node) => self.numbers(variable).get(node as usize),
            Owner::Slave(slave) => self.slave_numbers(variable).get(slave as usize),
        };
        number.copied().filter(|&number| number != NONE)
    }

    /// Values of all unknowns at a time level (0 the present).
    pub fn gather(&self, part: &ModelPart, level: usize) -> Vec<f64> {
        let mut out = zeros(self.dofs.len());
        for (variable, numbers) in &self.numbers {
            let fields = [(&numbers.nodes, &part.nodes.history), (&numbers.slaves, &part.slave_nodes.history)];
            for (numbers, field) in fields.into_iter().filter_map(|(n, fields)| Some((n, fields.get(variable.column)?)))
            {
                read(numbers, field, variable.offset(), level.min(field.levels.len() - 1), &mut out);
            }
        }
        out
    }

    /// Adds an increment to the present values of all unknowns.
    pub fn scatter_add(&self, increment: &[f64], part: &mut ModelPart) {
        for (variable, numbers) in &self.numbers {
            let fields = [(&numbers.nodes, &mut part.nodes.history), (&numbers.slaves, &mut part.slave_nodes.history)];
            for (numbers, fields) in fields {
                let Some(field) = fields.get_mut(variable.column) else { continue };
                let (components, offset, present) = (field.components, variable.offset(), &mut *field.levels[0]);
                for (at, &number) in numbers.iter().enumerate().filter(|(_, number)| **number != NONE) {
                    present[at * components + offset] += increment[number as usize];
                }
            }
        }
    }

    /// One of the columns that go with unknowns at a time level (0 the present), a number an unknown; 0 where there is none.
    pub fn column(&self, part: &ModelPart, column: ColumnOf, level: usize) -> Vec<f64> {
        let mut out = zeros(self.dofs.len());
        for (variable, numbers) in &self.numbers {
            let Some(name) = Rates::of(variable.column).and_then(column) else { continue };
            for (numbers, fields) in
                [(&numbers.nodes, &part.nodes.history), (&numbers.slaves, &part.slave_nodes.history)]
            {
                if let Some(field) = fields.get(name) {
                    read(numbers, field, variable.offset(), level, &mut out);
                }
            }
        }
        out
    }

    /// Writes a vector as [`DofTable::column`] gives it; other entries of the columns stay.
    pub fn write_column(&self, part: &mut ModelPart, column: ColumnOf, level: usize, values: &[f64]) {
        for (variable, numbers) in &self.numbers {
            let Some(name) = Rates::of(variable.column).and_then(column) else { continue };
            let fields = [(&numbers.nodes, &mut part.nodes.history), (&numbers.slaves, &mut part.slave_nodes.history)];
            for (numbers, fields) in fields {
                let Some(field) = fields.get_mut(name) else { continue };
                let (components, offset) = (field.components, variable.offset());
                let Some(column) = field.levels.get_mut(level).map(|level| &mut **level) else { continue };
                for (at, &number) in numbers.iter().enumerate().filter(|(_, number)| **number != NONE) {
                    column[at * components + offset] = values[number as usize];
                }
            }
        }
    }
}

/// Reads one component of a column at a level into the unknowns of these owners.
fn read(numbers: &[u32], field: &Field, offset: usize, level: usize, out: &mut [f64]) {
    let Some(values) = field.levels.get(level) else { return };
    for (at, &number) in numbers.iter().enumerate().filter(|(_, number)| **number != NONE) {
        out[number as usize] = values[at * field.components + offset];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Nodes;
    use crate::model::test_variables::{DISPLACEMENT, NORMAL};

    fn part() -> ModelPart {
        let mut part = ModelPart::new("Structure");
        part.nodes = Nodes::new(vec![10, 20, 30], vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
        part.nodes.history.add(&DISPLACEMENT);
        part.set_levels(2);
        part
    }

    /// Two displacements a node; the node 20 has two slave nodes, each with a multiplier, and the node 30 one.
    fn numbered() -> (ModelPart, DofTable) {
        let mut part = part();
        let floor = part.slave_nodes.set("floor", &[1, 2]);
        let wall = part.slave_nodes.set("wall", &[1]);
        part.slave_nodes.history.add(&NORMAL);
        let mut dofs = DofTable::default();
        let displacements = [0, 1].map(|c| DofOwners::of_nodes(DISPLACEMENT.component(c), vec![0, 1, 2]));
        let multipliers = [floor, wall].map(|range| DofOwners::of_slaves(NORMAL.component(0), range));
        dofs.number(&part, &displacements, &multipliers);
        (part, dofs)
    }

    #[test]
    fn slave_nodes_follow_their_mesh_node() {
        let (_, dofs) = numbered();
        let owners: Vec<Owner> = dofs.dofs().iter().map(|dof| dof.owner).collect();
        let [a, b, c] = [0, 1, 2].map(Owner::Node);
        let [floor, other, wall] = [0, 1, 2].map(Owner::Slave);
        assert_eq!(owners, [a, a, b, b, floor, wall, c, c, other]);
        assert_eq!(dofs.dofs().iter().map(|dof| dof.node).collect::<Vec<_>>(), [0, 0, 1, 1, 1, 1, 2, 2, 2]);
        let x = NORMAL.component(0);
        let found = [Owner::Node(1), floor, wall, other].map(|owner| dofs.number_of(x, owner));
        assert_eq!(found, [None, Some(4), Some(5), Some(8)]);
        assert_eq!((dofs.slave_numbers(x), dofs.numbers(x)), (&[4, 8, 5][..], &[NONE; 3][..]));
        assert_eq!(dofs.of_variable(x).collect::<Vec<_>>(), [4, 8, 5]);
        assert_eq!([3, 4, 5, 8].map(|number| dofs.is_one_of_several(number)), [false, true, true, false]);
        let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
        let [u, v] = ["DISPLACEMENT_X", "DISPLACEMENT_Y"];
        let expected = [
            (1, names(&[u, v])),
            (1, names(&[u, v, "NORMAL_X of floor", "NORMAL_X of wall"])),
            (1, names(&[u, v, "NORMAL_X of floor"])),
        ];
        assert_eq!(dofs.layout().0, expected);
    }

    #[test]
    fn values_are_those_of_the_owners() {
        let (mut part, dofs) = numbered();
        let values: Vec<f64> = (1..=9).map(f64::from).collect();
        dofs.scatter_add(&values, &mut part);
        assert_eq!(dofs.gather(&part, 0), values);
        assert_eq!(dofs.gather(&part, 1), [0.0; 9]);
        assert_eq!(part.slave_nodes.history.values(&NORMAL, 0), [5.0, 0.0, 0.0, 9.0, 0.0, 0.0, 6.0, 0.0, 0.0]);
        for (dof, value) in dofs.dofs().iter().zip(&values) {
            assert_eq!(dof.value(&part, 0), Some(*value));
            dof.set_value(&mut part, -value);
        }
        assert_eq!(dofs.gather(&part, 0), values.iter().map(|value| -value).collect::<Vec<_>>());
        part.clone_time_step(1.0);
        dofs.scatter_add(&values, &mut part);
        dofs.dofs().iter().for_each(|dof| dof.step_back(&mut part));
        assert_eq!(dofs.gather(&part, 0), dofs.gather(&part, 1));
    }

    #[test]
    fn numbers_of_mesh_nodes_alone_stay() {
        let mut part = part();
        let mut dofs = DofTable::default();
        let carriers = |variable, nodes: &[u32]| DofOwners::of_nodes(variable, nodes.to_vec());
        let displacements = [0, 1].map(|c| carriers(DISPLACEMENT.component(c), &[0, 1, 2]));
        let multipliers = [carriers(NORMAL.component(0), &[2, 1])];
        dofs.number(&part, &displacements, &multipliers);
        let before = dofs.dofs().to_vec();
        assert_eq!(before.iter().map(|dof| dof.node).collect::<Vec<_>>(), [0, 0, 1, 1, 1, 2, 2, 2]);
        assert_eq!(dofs.multipliers(), [false, false, true]);
        // Slave nodes without unknowns change nothing.
        part.slave_nodes.set("floor", &[0, 2]);
        dofs.number(&part, &displacements, &multipliers);
        assert_eq!(dofs.dofs(), before);
    }
}
