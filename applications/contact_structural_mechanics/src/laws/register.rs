//! Registration of formulations and of their conditions.

/// Registers a [`Formulation`](crate::pairs::Formulation) under its `mortar_type`, and its conditions, one a pair of shapes, under Kratos'
/// names: `conditions` are their beginnings, in plane and space and about an axis.
#[macro_export]
macro_rules! register_contact_formulation {
    ($name:literal, about: $about:literal, source: $source:literal, build: $formulation:expr $(,)?) => {
        const _: () = {
            use $crate::pairs::FormulationEntry;
            zelus_core::register! { FormulationEntry $name, about: $about, source: $source, build: $formulation }
        };
    };
    (
        $name:literal, about: $about:literal, source: $source:literal,
        conditions: [$stem:literal, $axisymmetric:literal], build: $formulation:expr $(,)?
    ) => {
        $crate::register_contact_formulation! { $name, about: $about, source: $source, build: $formulation }
        $crate::register_pair_conditions! { $stem, about: concat!("pair of the formulation ", $name), source: $source }
        $crate::register_pair_conditions! { @ $axisymmetric, concat!("pair of the formulation ", $name), $source,
            (Line2, 2, "2D2N") (Line2, 2, "2D2N3N") (Line3, 2, "2D3N2N") (Line3, 2, "2D3N")
        }
    };
}

/// Registers conditions that pairs are named by, one for each two shapes of facets: slave, master and the end of the name.
#[macro_export]
macro_rules! register_pair_conditions {
    ($stem:literal, about: $about:expr, source: $source:literal) => {
        $crate::register_pair_conditions! { @ $stem, $about, $source,
            (Line2, 2, "2D2N") (Line2, 2, "2D2N3N") (Line3, 2, "2D3N2N") (Line3, 2, "2D3N")
            (Tri3, 3, "3D3N") (Tri3, 3, "3D3N4N") (Tri3, 3, "3D3N6N") (Tri3, 3, "3D3N8N") (Tri3, 3, "3D3N9N")
            (Quad4, 3, "3D4N3N") (Quad4, 3, "3D4N") (Quad4, 3, "3D4N6N") (Quad4, 3, "3D4N8N") (Quad4, 3, "3D4N9N")
            (Tri6, 3, "3D6N3N") (Tri6, 3, "3D6N4N") (Tri6, 3, "3D6N") (Tri6, 3, "3D6N8N") (Tri6, 3, "3D6N9N")
            (Quad8, 3, "3D8N3N") (Quad8, 3, "3D8N4N") (Quad8, 3, "3D8N6N") (Quad8, 3, "3D8N") (Quad8, 3, "3D8N9N")
            (Quad9, 3, "3D9N3N") (Quad9, 3, "3D9N4N") (Quad9, 3, "3D9N6N") (Quad9, 3, "3D9N8N") (Quad9, 3, "3D9N")
        }
    };
    (@ $stem:literal, $about:expr, $source:literal, $(($slave:ident, $space:literal, $end:literal))*) => {$(
        const _: () = {
            use zelus_core::entities::ConditionEntry;
            zelus_core::register! { ConditionEntry concat!($stem, $end),
                about: $about,
                source: $source,
                cell: Some(zelus_core::geometry::Shape::$slave),
                space: $space,
                build: zelus_core::entities::Build::Pairs,
            }
        };
    )*};
}
