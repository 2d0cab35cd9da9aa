//! Where an interaction joins two bodies before the first step.

/// A node of one body that meets another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Join {
    /// The node, and one of the other body (index).
    pub nodes: [u32; 2],
    /// Unit normal along which it is held; `None` where it is tied in all directions.
    pub normal: Option<[f64; 3]>,
    /// Whether friction holds it across that.
    pub friction: bool,
}
