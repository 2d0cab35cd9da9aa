//! The names of conditions of contact by constraints; they add friction forces only.

use crate::register_pair_conditions;

register_pair_conditions! { "MPCMortarContactCondition", about: "pair of contact by constraints", source: "eqs. D.12a–e" }
