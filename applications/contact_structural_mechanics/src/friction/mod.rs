//! Friction at slave nodes: coefficients, slips, and tractions at their bounds.
//!
//! Friction laws are in [`law`](crate::law), decisions on stick and slip in `active_set`.

mod bounds;
mod coefficients;
mod step_slip;
mod temperatures;

pub(crate) use bounds::{meet_bounds, start_in_stick, warn_of_pushing};
pub use coefficients::FrictionSettings;
pub(crate) use coefficients::{prepare, unread_coefficient};
pub(crate) use step_slip::slip;
pub(crate) use temperatures::find_temperatures;
