//! The names of conditions of contact by constraints; they add friction forces only.

use super::shapes::register_shapes;

register_shapes!("MPCMortarContactCondition", "pair of contact by constraints");
