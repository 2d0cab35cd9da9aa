//! A node that follows the mean of others, whatever weights are given.

use zelus_core::entities::ConstraintEntry;
use zelus_core::model::MasterSlaveConstraint;
use zelus_core::register;

register! { ConstraintEntry "MeanConstraint",
    about: "a node's unknown is the mean of that unknown of other nodes, and a constant",
    source: "u_slave = Σ u_master / n + constant",
    build: |row| {
        if row.masters.is_empty() {
            return Err("there is no mean of no nodes".to_owned());
        }
        let share = 1.0 / row.masters.len() as f64;
        let masters = row.masters.iter().map(|&node| ((node, row.variables[0]), share));
        Ok(vec![MasterSlaveConstraint {
            id: row.id,
            constant: row.constant,
            ..MasterSlaveConstraint::new((row.slave, row.variables[0]), masters.collect())
        }])
    },
}
