//! The variables of wear.

use zelus_core::{register_usual_results, register_variable};

register_variable! {
    pub WEAR_DEPTH: f64 = "Worn depth of a node since the start, along the normal of the body (length).";
}

register_usual_results! { values: ["WEAR_DEPTH"], gauss: [] }
