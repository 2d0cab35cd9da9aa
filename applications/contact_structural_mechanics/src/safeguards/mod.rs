//! Checks of states that the active set alone would accept: missed pairs, penetration, energy of impacts, pairs never in contact.

mod free_bodies;
mod impact;
mod initial_overlap;
mod late_pairs;
mod meetings;
mod penetration;
mod piercing;
mod step_search;
mod unseen;
mod work;

pub(crate) use free_bodies::FreeBodies;
pub(crate) use impact::{coarse_impact, near_nodes};
pub(crate) use initial_overlap::settle_all;
pub(crate) use meetings::InterfacesInContact;
pub(crate) use penetration::too_deep;
pub(crate) use piercing::pierced;
pub(crate) use step_search::StepSearch;
pub(crate) use unseen::PenetrationCheck;
pub(crate) use work::ContactWork;
