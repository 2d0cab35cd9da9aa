//! Name of a degree of freedom, as messages state it.

use std::fmt;

use crate::assembly::DofTable;
use crate::model::{Nodes, ScalarVariable};
use crate::names::Name;

/// The unknown of an equation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct DofName {
    pub variable: ScalarVariable,
    /// Id of its node.
    pub node: usize,
    /// Whether it is a Lagrange multiplier.
    pub multiplier: bool,
    /// Set of its slave node, where several stand at the mesh node.
    pub set: Option<Name>,
}

impl fmt::Display for DofName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of node {}", self.variable, self.node)?;
        self.set.map_or(Ok(()), |set| write!(f, " on {set}"))
    }
}

impl DofName {
    /// The name of an unknown.
    pub fn of(dofs: &DofTable, nodes: &Nodes, number: u32) -> Self {
        let dof = &dofs.dofs()[number as usize];
        let set = dofs.set_of(dof).filter(|_| dofs.is_one_of_several(number as usize));
        Self {
            variable: dof.variable,
            node: nodes.ids[dof.node as usize],
            multiplier: dof.multiplier,
            set: set.map(|set| dofs.sets()[set as usize]),
        }
    }

    /// As numbers, which [`DofName::unpack`] reads on any rank.
    pub fn pack(self, dofs: &DofTable) -> [f64; 4] {
        let variable = dofs.variables().position(|variable| variable == self.variable).unwrap_or(0);
        // 0 stands for no set.
        let set = self.set.and_then(|set| dofs.sets().iter().position(|known| *known == set)).map_or(0, |at| at + 1);
        [variable as f64, self.node as f64, f64::from(u8::from(self.multiplier)), set as f64]
    }

    /// The name that [`DofName::pack`] has packed.
    pub fn unpack(numbers: &[f64], dofs: &DofTable) -> Option<Self> {
        let variable = dofs.variables().nth(numbers[0] as usize)?;
        let set = (numbers[3] as usize).checked_sub(1).and_then(|at| dofs.sets().get(at).copied());
        Some(Self { variable, node: numbers[1] as usize, multiplier: numbers[2] != 0.0, set })
    }
}

/// Finds the name of an equation by its number.
pub(super) type DofNames<'a> = &'a dyn Fn(usize) -> Option<DofName>;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::test_variables::{DISPLACEMENT, NORMAL};
    use crate::model::{DofOwners, ModelPart};

    #[test]
    fn sets_tell_the_multipliers_of_a_node_apart() {
        let mut part = ModelPart::new("Structure");
        part.nodes = Nodes::new(vec![4, 9], vec![[0.0; 3], [1.0, 0.0, 0.0]]);
        part.slave_nodes.set("floor", &[0, 1]);
        part.slave_nodes.set("wall", &[1]);
        let mut dofs = DofTable::default();
        let displacements = DofOwners::of_nodes(DISPLACEMENT.component(0), vec![0, 1]);
        dofs.number(&part, &[displacements], &[DofOwners::of_slaves(NORMAL.component(1), 0..3)]);
        let said: Vec<String> = (0..dofs.len() as u32)
            .map(|number| {
                let dof_name = DofName::of(&dofs, &part.nodes, number);
                assert_eq!(DofName::unpack(&dof_name.pack(&dofs), &dofs), Some(dof_name));
                dof_name.to_string()
            })
            .collect();
        let expected = [
            "DISPLACEMENT_X of node 4",
            "NORMAL_Y of node 4",
            "DISPLACEMENT_X of node 9",
            "NORMAL_Y of node 9 on floor",
            "NORMAL_Y of node 9 on wall",
        ];
        assert_eq!(said, expected);
    }
}
