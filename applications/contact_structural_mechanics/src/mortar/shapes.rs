//! The pairs of shapes that carry contact: the only list of them.

/// What `$make!` gives for the shapes of a slave and a master, from their numbers of nodes, of displacement unknowns, of components
/// of nodal normals, and of those three kinds of variables with tractions at inner points; `None` for other shapes.
macro_rules! for_shapes {
    ($slave:expr, $master:expr, $make:ident) => {{
        use zelus_core::geometry::Shape;
        match ($slave, $master) {
            (Shape::Line2, Shape::Line2) => Some($make!(2, 2, 8, 4, 16)),
            (Shape::Tri3, Shape::Tri3) => Some($make!(3, 3, 18, 9, 36)),
            (Shape::Tri3, Shape::Quad4) => Some($make!(3, 4, 21, 9, 39)),
            (Shape::Quad4, Shape::Tri3) => Some($make!(4, 3, 21, 12, 45)),
            (Shape::Quad4, Shape::Quad4) => Some($make!(4, 4, 24, 12, 48)),
            _ => None,
        }
    }};
}
pub(crate) use for_shapes;
