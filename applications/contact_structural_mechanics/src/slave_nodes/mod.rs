//! Slave nodes of an interaction: their states, their owners of unknowns, and their columns at mesh nodes.

mod bonds;
mod following_multipliers;
pub(crate) mod multiplier_columns;
mod owners;
mod slave_bond;
mod slave_state;
mod slave_states;
mod slave_status;
mod slave_sums;

pub(crate) use owners::owners_name;
pub use slave_bond::SlaveBond;
pub use slave_state::{Accepted, SlaveKinematics, SlaveLawState, SlaveParameters, SlaveState};
pub use slave_states::{NodalCombination, SlaveColumns, SlaveStates, SlaveTable, set_name};
pub use slave_status::SlaveStatus;
pub(crate) use slave_status::write_status;
pub(crate) use slave_sums::{SlaveSums, Summands};
