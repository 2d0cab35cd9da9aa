//! The bodies of a part by number.

use super::connected_bodies::bodies_of_nodes;
use super::model_part::ModelPart;

/// The bodies of connected elements, in the order of their first nodes; alike on all ranks but for `of_node`.
pub struct NumberedBodies {
    /// Number of the body of each node that is here; `None` for nodes of no element.
    pub of_node: Vec<Option<usize>>,
    /// Id of the first node of each body.
    pub first: Vec<usize>,
}

impl NumberedBodies {
    /// The bodies of a part; collective.
    pub fn of(part: &ModelPart) -> Self {
        let found = bodies_of_nodes(part);
        let sorted = |mut ids: Vec<usize>| {
            ids.sort_unstable();
            ids.dedup();
            ids
        };
        let own: Vec<f64> = sorted(found.iter().copied().flatten().collect()).into_iter().map(|id| id as f64).collect();
        let first = sorted(part.ranks.gather_numbers(&own).concat().into_iter().map(|id| id as usize).collect());
        let number = |id: Option<usize>| id.and_then(|id| first.binary_search(&id).ok());
        Self { of_node: found.into_iter().map(number).collect(), first }
    }
}
