//! State of one pair of bodies, as an interaction reports it after an accepted step.

/// A pair of bodies that an interaction acts between, with the state of its first side; every node counts in one pair.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PairState {
    /// Name for reports: the key in the deck and the parts.
    pub name: String,
    /// Nodes of the first side without contact.
    pub open: usize,
    /// Nodes of the first side in contact that stick.
    pub sticking: usize,
    /// Nodes of the first side in contact that slide, with friction or without.
    pub slipping: usize,
    /// The node (index) that is deepest in the other side, and its depth (length); `None` where none is inside.
    pub deepest: Option<(u32, f64)>,
    /// Forces of linear constraints on nodes (index) of the first side; those of blocks are added to them.
    pub constraint_forces: Vec<(u32, [f64; 3])>,
    /// Energy that friction has turned into heat in the step.
    pub dissipated: f64,
    /// Energy in the springs of a penalty; `None` where the forces are none of springs.
    pub stored: Option<f64>,
}
