//! Share of a node in a load that is given by its resultant: f = RESULTANT_LOAD.

use zelus_core::model::Variable;

use super::load::{LoadAtNode, Nodal, register_conditions};
use crate::variables::{DISPLACEMENT, RESULTANT_LOAD};

/// Dead force on a node; its process makes one condition a node.
pub struct ResultantLoad;

impl LoadAtNode for ResultantLoad {
    const LOAD: &'static Variable<[f64; 3]> = &RESULTANT_LOAD;
    const ALONG: &'static Variable<[f64; 3]> = &DISPLACEMENT;
}

register_conditions! { "ResultantLoadCondition", 0, "Share of a node in a resultant: RESULTANT_LOAD", "f = RESULTANT_LOAD",
&["RESULTANT_LOAD"];
"2D1N": Nodal<ResultantLoad>, 1, 2;
"3D1N": Nodal<ResultantLoad>, 1, 3 }
