//! Additions to zelus, one file each: every file ends in the registration that makes its name known to decks.

mod diffusion_element;
mod elastic_foundation_condition;
mod energy_criterion;
mod hardening_contact;
mod scale_load_process;
