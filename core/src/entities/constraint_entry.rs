//! Constraints that a mesh names: linear relations made of the rows of a `Constraints` block.

use crate::model::{MasterSlaveConstraint, Nodes, ScalarVariable};
use crate::{register, registered_kind};

/// One row of a `Constraints` block, its nodes by index.
pub struct ConstraintRow<'a> {
    /// Its id.
    pub id: usize,
    /// Variables of the heading: the slave's, then the masters' where given.
    pub variables: &'a [ScalarVariable],
    /// The constant term.
    pub constant: f64,
    /// One weight a master.
    pub weights: &'a [f64],
    /// The node that follows.
    pub slave: u32,
    /// The nodes that it follows.
    pub masters: &'a [u32],
    /// All nodes of the mesh.
    pub nodes: &'a Nodes,
}

/// Makes the relations of a row; the error names its fault.
pub type ConstraintFactory = fn(&ConstraintRow<'_>) -> Result<Vec<MasterSlaveConstraint>, String>;

registered_kind! {
    /// A constraint that meshes name.
    pub struct ConstraintEntry("constraint", "unknown-constraint") {
        build: ConstraintFactory;
        /// Whether it relates different variables; otherwise the first of the heading counts.
        mixes_variables: bool = false,
    }
}

register! { ConstraintEntry "LinearMasterSlaveConstraint",
    about: "a node's unknown is a constant and weights times that unknown of other nodes",
    source: "u_slave = Σ weight · u_master + constant",
    build: |row| {
        let masters = row.masters.iter().map(|&node| (node, row.variables[0]));
        Ok(vec![MasterSlaveConstraint {
            id: row.id,
            constant: row.constant,
            ..MasterSlaveConstraint::new(
                (row.slave, row.variables[0]),
                masters.zip(row.weights.iter().copied()).collect(),
            )
        }])
    },
}

register! { ConstraintEntry "LinearMasterSlaveConstraintOfComponents",
    about: "a node's unknown is a constant and weights times unknowns of other nodes, each with its own variable: the heading names that of the slave, then one for each master",
    source: "u_slave = Σ weight · u_master + constant",
    build: |row| {
        let [slave, masters @ ..] = row.variables else { return Err("it has no variables".to_owned()) };
        if masters.len() != row.masters.len() || row.weights.len() != row.masters.len() {
            return Err(format!("{} masters, but {} variables for them", row.masters.len(), masters.len()));
        }
        let unknowns = row.masters.iter().copied().zip(masters.iter().copied());
        Ok(vec![MasterSlaveConstraint {
            id: row.id,
            constant: row.constant,
            ..MasterSlaveConstraint::new((row.slave, *slave), unknowns.zip(row.weights.iter().copied()).collect())
        }])
    },
    mixes_variables: true,
}
