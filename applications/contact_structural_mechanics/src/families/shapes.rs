//! The pairs of shapes on which every family works, and the names of their conditions.

use zelus_core::geometry::Shape;

use crate::pairs::{ContactBlock, NitscheBlock, PairBlock, PairFormulation, PairRequest};

/// The block of a family for a pair of shapes (slave, master); `None` for shapes that carry no contact.
pub(super) fn block<F: PairFormulation>(
    slave: Shape,
    master: Shape,
    request: PairRequest,
) -> Option<Box<dyn ContactBlock>> {
    Some(match (slave, master) {
        (Shape::Line2, Shape::Line2) => PairBlock::<F, 2, 2, 8, 4>::boxed(request),
        (Shape::Tri3, Shape::Tri3) => PairBlock::<F, 3, 3, 18, 9>::boxed(request),
        (Shape::Tri3, Shape::Quad4) => PairBlock::<F, 3, 4, 21, 9>::boxed(request),
        (Shape::Quad4, Shape::Tri3) => PairBlock::<F, 4, 3, 21, 12>::boxed(request),
        (Shape::Quad4, Shape::Quad4) => PairBlock::<F, 4, 4, 24, 12>::boxed(request),
        _ => return None,
    })
}

/// The same for families whose forces are those of points.
pub(super) fn nitsche_block(
    slave: Shape,
    master: Shape,
    request: PairRequest,
    friction: bool,
) -> Option<Box<dyn ContactBlock>> {
    Some(match (slave, master) {
        (Shape::Line2, Shape::Line2) => NitscheBlock::<2, 2, 8, 4, 16>::boxed(request, friction),
        (Shape::Tri3, Shape::Tri3) => NitscheBlock::<3, 3, 18, 9, 36>::boxed(request, friction),
        (Shape::Tri3, Shape::Quad4) => NitscheBlock::<3, 4, 21, 9, 39>::boxed(request, friction),
        (Shape::Quad4, Shape::Tri3) => NitscheBlock::<4, 3, 21, 12, 45>::boxed(request, friction),
        (Shape::Quad4, Shape::Quad4) => NitscheBlock::<4, 4, 24, 12, 48>::boxed(request, friction),
        _ => return None,
    })
}

/// Registers the conditions of a family, one a pair of shapes, under Kratos' names.
macro_rules! register_shapes {
    ($stem:literal, $axisymmetric:expr, $about:literal) => {
        $crate::families::shapes::register_shapes!($stem, $about);
        $crate::families::shapes::register_shapes!(@ $axisymmetric, Line2, 2, $about);
    };
    ($stem:literal, $about:literal) => {
        $crate::families::shapes::register_shapes!(@ concat!($stem, "2D2N"), Line2, 2, $about);
        $crate::families::shapes::register_shapes!(@ concat!($stem, "3D3N"), Tri3, 3, $about);
        $crate::families::shapes::register_shapes!(@ concat!($stem, "3D4N"), Quad4, 3, $about);
        $crate::families::shapes::register_shapes!(@ concat!($stem, "3D3N4N"), Tri3, 3, $about);
        $crate::families::shapes::register_shapes!(@ concat!($stem, "3D4N3N"), Quad4, 3, $about);
    };
    (@ $name:expr, $shape:ident, $space:literal, $about:literal) => {
        const _: () = { use zelus_core::entities::ConditionEntry; zelus_core::register! { ConditionEntry $name,
            about: $about,
            cell: Some(zelus_core::geometry::Shape::$shape),
            space: $space,
            build: zelus_core::entities::Build::Pairs,
        } };
    };
}
pub(super) use register_shapes;
