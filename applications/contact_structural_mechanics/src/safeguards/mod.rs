//! Checks of states that the active set alone would accept: missed pairs, penetration, energy of impacts, pairs never in contact.

mod free_bodies;
mod impact;
mod initial_overlap;
mod interfaces_in_contact;
mod largest_penetration;
mod missed_pairs;
mod penetration_check;
mod piercing;
mod step_search;
mod work;

pub(crate) use free_bodies::FreeBodies;
pub(crate) use impact::{coarse_impact, near_nodes};
pub(crate) use initial_overlap::settle_all;
pub(crate) use interfaces_in_contact::InterfacesInContact;
pub(crate) use largest_penetration::{SHORTER, STIFFER, too_deep};
pub(crate) use penetration_check::PenetrationCheck;
pub(crate) use piercing::pierced;
pub(crate) use step_search::StepSearch;
pub(crate) use work::{ContactWork, overlap_at_start};
