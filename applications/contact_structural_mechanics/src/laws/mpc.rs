//! The names of conditions of contact by constraints; they add friction forces only.

use crate::register_pair_conditions;

register_pair_conditions! { "MPCMortarContactCondition", "pair of contact by constraints" }
