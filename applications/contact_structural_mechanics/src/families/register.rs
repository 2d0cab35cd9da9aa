//! How a family gets its names.

/// Registers a [`Family`](crate::pairs::Family) under its `mortar_type`, and its conditions, one a pair of shapes, under Kratos'
/// names: `conditions` are their beginnings, in plane and space and about an axis.
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
        $crate::register_pair_conditions! { @ $axisymmetric, concat!("pair of the family ", $name),
            (Line2, Line2, "2D2N") (Line2, Line3, "2D2N3N") (Line3, Line2, "2D3N2N") (Line3, Line3, "2D3N")
        }
    };
}

/// Registers conditions that pairs are named by, one a pair of shapes.
#[macro_export]
macro_rules! register_pair_conditions {
    ($stem:literal, $about:expr) => {
        $crate::with_pairs_of_shapes! { [$crate::register_pair_conditions] @ $stem, $about, }
    };
    (@ $stem:literal, $about:expr, $(($slave:ident, $master:ident, $end:literal))*) => {$(
        const _: () = {
            use zelus_core::entities::ConditionEntry;
            use zelus_core::geometry::{self, FacetShape};
            zelus_core::register! { ConditionEntry concat!($stem, $end),
                about: $about,
                cell: Some(geometry::$slave::SHAPE),
                space: geometry::$slave::SPACE,
                build: zelus_core::entities::Build::Pairs,
            }
        };
    )*};
}
