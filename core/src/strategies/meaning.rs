//! What an equation stands for, as messages name it.

use std::fmt;

use crate::assembly::DofTable;
use crate::model::{Nodes, ScalarVariable};

/// The unknown of an equation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Meaning {
    pub variable: ScalarVariable,
    /// Id of its node.
    pub node: usize,
    /// Whether it is a Lagrange multiplier.
    pub multiplier: bool,
}

impl fmt::Display for Meaning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of node {}", self.variable, self.node)
    }
}

impl Meaning {
    /// The meaning of an unknown.
    pub fn of(dofs: &DofTable, nodes: &Nodes, number: u32) -> Self {
        let dof = &dofs.dofs()[number as usize];
        Self { variable: dof.variable, node: nodes.ids[dof.node as usize], multiplier: dof.multiplier }
    }

    /// As numbers, which [`Meaning::unpack`] reads on any rank.
    pub fn pack(self, dofs: &DofTable) -> [f64; 3] {
        let variable = dofs.variables().position(|variable| variable == self.variable).unwrap_or(0);
        [variable as f64, self.node as f64, f64::from(u8::from(self.multiplier))]
    }

    /// What [`Meaning::pack`] made of a meaning.
    pub fn unpack(numbers: &[f64], dofs: &DofTable) -> Option<Self> {
        let variable = dofs.variables().nth(numbers[0] as usize)?;
        Some(Self { variable, node: numbers[1] as usize, multiplier: numbers[2] != 0.0 })
    }
}

/// Finds the meaning of an equation by its number.
pub(super) type Meanings<'a> = &'a dyn Fn(usize) -> Option<Meaning>;
