//! How a family gets its names.

/// Registers a [`Family`](crate::pairs::Family) under its `mortar_type`, and its conditions, one a pair of shapes, under Kratos'
/// names: `conditions` are their beginning and the name of the one about an axis.
#[macro_export]
macro_rules! register_contact_family {
    ($name:literal, about: $about:literal, source: $source:literal, build: $family:expr $(,)?) => {
        const _: () = {
            use $crate::pairs::FamilyEntry;
            zelus_core::register! { FamilyEntry $name, about: $about, source: $source, build: $family }
        };
    };
    (
        $name:literal, about: $about:literal, source: $source:literal,
        conditions: [$stem:literal, $axisymmetric:literal], build: $family:expr $(,)?
    ) => {
        $crate::register_contact_family! { $name, about: $about, source: $source, build: $family }
        $crate::register_pair_conditions! { $stem, concat!("pair of the family ", $name) }
        $crate::register_pair_conditions! { @ $axisymmetric, Line2, 2, concat!("pair of the family ", $name) }
    };
}

/// Registers conditions that pairs are named by, one a pair of shapes.
#[macro_export]
macro_rules! register_pair_conditions {
    ($stem:literal, $about:expr) => {
        $crate::register_pair_conditions! { @ concat!($stem, "2D2N"), Line2, 2, $about }
        $crate::register_pair_conditions! { @ concat!($stem, "3D3N"), Tri3, 3, $about }
        $crate::register_pair_conditions! { @ concat!($stem, "3D4N"), Quad4, 3, $about }
        $crate::register_pair_conditions! { @ concat!($stem, "3D3N4N"), Tri3, 3, $about }
        $crate::register_pair_conditions! { @ concat!($stem, "3D4N3N"), Quad4, 3, $about }
    };
    (@ $name:expr, $shape:ident, $space:literal, $about:expr) => {
        const _: () = {
            use zelus_core::entities::ConditionEntry;
            zelus_core::register! { ConditionEntry $name,
                about: $about,
                cell: Some(zelus_core::geometry::Shape::$shape),
                space: $space,
                build: zelus_core::entities::Build::Pairs,
            }
        };
    };
}
