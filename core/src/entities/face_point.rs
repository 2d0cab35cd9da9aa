//! Where on the skin of a body a traction is asked for.

/// A point on a face of an element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FacePoint {
    /// Local coordinates in the element's cell.
    pub local: [f64; 3],
    /// Unit normal of the face in the initial configuration, out of the element.
    pub normal: [f64; 3],
}
