//! Unknowns of a system: which exist, and their numbers.

use std::collections::BTreeMap;

use zelus_linear_algebra::Unknowns;
use zelus_linear_algebra::vector::zeros;

use crate::model::{ColumnOf, Fields, Nodes, Rates, ScalarVariable};

/// "Not an unknown of the system" in the table of numbers.
pub const NONE: u32 = u32::MAX;

/// One unknown of the system.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dof {
    /// Node index.
    pub node: u32,
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
}

fn moves_mesh(unknown: ScalarVariable) -> bool {
    Rates::of(unknown.column).is_some_and(|rates| rates.moves_mesh)
}

/// All unknowns, numbered by node first so that those of a node stand together.
#[derive(Debug, Clone, Default)]
pub struct DofTable {
    dofs: Vec<Dof>,
    /// Which of them move their node.
    moving: Vec<bool>,
    /// Of each the place of its variable among [`DofTable::variables`].
    kinds: Vec<u16>,
    /// Which of the variables are Lagrange multipliers.
    multipliers: Vec<bool>,
    numbers: BTreeMap<ScalarVariable, Vec<u32>>,
    version: u64,
}

impl DofTable {
    /// Numbers the unknowns of `carriers`: (variable, is a multiplier, nodes that carry it).
    ///
    /// Order: by node, displacement-like unknowns before multipliers in the order given.
    pub fn number(&mut self, nodes: &Nodes, carriers: &[(ScalarVariable, bool, Vec<u32>)]) {
        let mut present: Vec<(ScalarVariable, bool, Vec<bool>)> = Vec::new();
        for (variable, multiplier, list) in carriers {
            let at = present.iter().position(|(known, ..)| known == variable).unwrap_or_else(|| {
                present.push((*variable, *multiplier, vec![false; nodes.len()]));
                present.len() - 1
            });
            list.iter().for_each(|&node| present[at].2[node as usize] = true);
        }
        self.dofs.clear();
        self.moving.clear();
        self.kinds.clear();
        let mut ordered: Vec<(ScalarVariable, bool)> = present.iter().map(|(own, is, _)| (*own, *is)).collect();
        ordered.sort_unstable();
        let place = |variable| ordered.iter().position(|(other, _)| *other == variable).expect("it is among them");
        let kinds: Vec<u16> = present.iter().map(|(variable, ..)| place(*variable) as u16).collect();
        self.multipliers = ordered.iter().map(|(_, is)| *is).collect();
        let moving: Vec<bool> = present.iter().map(|(variable, ..)| moves_mesh(*variable)).collect();
        let mut numbers = vec![vec![NONE; nodes.len()]; present.len()];
        for node in 0..nodes.len() {
            for (at, (variable, multiplier, carried)) in present.iter().enumerate() {
                if carried[node] {
                    numbers[at][node] = self.dofs.len() as u32;
                    self.moving.push(moving[at]);
                    self.kinds.push(kinds[at]);
                    self.dofs.push(Dof { node: node as u32, variable: *variable, multiplier: *multiplier });
                }
            }
        }
        self.numbers = present.iter().map(|(variable, ..)| *variable).zip(numbers).collect();
        self.version += 1;
    }

    /// Which nodes have which unknowns.
    pub fn layout(&self) -> Unknowns {
        let nodes = self.dofs.last().map_or(0, |last| last.node + 1);
        let mut runs: Vec<(u32, &[Dof])> = Vec::new();
        let mut left = self.dofs.as_slice();
        for node in 0..nodes {
            let (own, others) = left.split_at(left.partition_point(|dof| dof.node <= node));
            left = others;
            let is_like = |known: &[Dof]| known.iter().map(|dof| dof.variable).eq(own.iter().map(|dof| dof.variable));
            match runs.last_mut().filter(|(_, known)| is_like(known)) {
                Some((nodes, _)) => *nodes += 1,
                None => runs.push((1, own)),
            }
        }
        let names = |dofs: &[Dof]| dofs.iter().map(|dof| dof.variable.to_string()).collect();
        Unknowns(runs.into_iter().map(|(nodes, dofs)| (nodes, names(dofs))).collect())
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

    /// Numbers of a variable by node; [`NONE`] where the node does not carry it. Empty when no node does.
    pub fn numbers(&self, variable: ScalarVariable) -> &[u32] {
        self.numbers.get(&variable).map_or(&[], Vec::as_slice)
    }

    /// Of each unknown the place of its variable among [`DofTable::variables`].
    pub fn kinds(&self) -> &[u16] {
        &self.kinds
    }

    /// Which of [`DofTable::variables`] are Lagrange multipliers.
    pub fn multipliers(&self) -> &[bool] {
        &self.multipliers
    }

    /// The variables of unknowns, those of other ranks too, in one order on all of them.
    pub fn variables(&self) -> impl Iterator<Item = ScalarVariable> + '_ {
        self.numbers.keys().copied()
    }

    /// Number of one unknown.
    pub fn number_of(&self, variable: ScalarVariable, node: u32) -> Option<u32> {
        self.numbers.get(&variable).map(|list| list[node as usize]).filter(|&number| number != NONE)
    }

    /// Values of all unknowns at a time level (0 the present).
    pub fn gather(&self, nodes: &Nodes, level: usize) -> Vec<f64> {
        let mut out = zeros(self.dofs.len());
        for (variable, numbers) in &self.numbers {
            let Some(field) = nodes.history.get(variable.column) else { continue };
            let (values, offset) = (&field.levels[level.min(field.levels.len() - 1)], variable.offset());
            for (node, &number) in numbers.iter().enumerate().filter(|(_, number)| **number != NONE) {
                out[number as usize] = values[node * field.components + offset];
            }
        }
        out
    }

    /// Adds an increment to the present values of all unknowns.
    pub fn scatter_add(&self, increment: &[f64], nodes: &mut Nodes) {
        for (variable, numbers) in &self.numbers {
            let Some(field) = nodes.history.get_mut(variable.column) else { continue };
            let (components, offset, present) = (field.components, variable.offset(), &mut *field.levels[0]);
            for (node, &number) in numbers.iter().enumerate().filter(|(_, number)| **number != NONE) {
                present[node * components + offset] += increment[number as usize];
            }
        }
    }

    /// One of the columns that go with unknowns at a time level (0 the present), a number an unknown; 0 where there is none.
    pub fn column(&self, fields: &Fields, column: ColumnOf, level: usize) -> Vec<f64> {
        let mut out = zeros(self.dofs.len());
        for (variable, numbers) in &self.numbers {
            let Some(field) = Rates::of(variable.column).and_then(column).and_then(|name| fields.get(name)) else {
                continue;
            };
            let (values, offset) = (&field.levels[level], variable.offset());
            for (node, &number) in numbers.iter().enumerate().filter(|(_, number)| **number != NONE) {
                out[number as usize] = values[node * field.components + offset];
            }
        }
        out
    }

    /// Writes what [`DofTable::column`] gives; other entries of the columns stay.
    pub fn write_column(&self, fields: &mut Fields, column: ColumnOf, level: usize, values: &[f64]) {
        for (variable, numbers) in &self.numbers {
            let name = Rates::of(variable.column).and_then(column);
            let Some(field) = name.and_then(|name| fields.get_mut(name)) else { continue };
            let (components, offset, column) = (field.components, variable.offset(), &mut *field.levels[level]);
            for (node, &number) in numbers.iter().enumerate().filter(|(_, number)| **number != NONE) {
                column[node * components + offset] = values[number as usize];
            }
        }
    }
}
