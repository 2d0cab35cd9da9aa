//! The pairs of shapes that carry contact: the only list of them.

use zelus_core::geometry::{FacetShape, Shape};

/// Calls the macro in brackets with every pair of shapes that carries contact: slave, master and how the names of its conditions
/// end, after other arguments.
#[doc(hidden)]
#[macro_export]
macro_rules! with_pairs_of_shapes {
    ([$($with:tt)*] $($first:tt)*) => {
        $($with)*! { $($first)*
            (Line2, Line2, "2D2N")
            (Line2, Line3, "2D2N3N")
            (Line3, Line2, "2D3N2N")
            (Line3, Line3, "2D3N")
            (Triangle3, Triangle3, "3D3N")
            (Triangle3, Quadrilateral4, "3D3N4N")
            (Quadrilateral4, Triangle3, "3D4N3N")
            (Quadrilateral4, Quadrilateral4, "3D4N")
            (Triangle3, Triangle6, "3D3N6N")
            (Quadrilateral4, Triangle6, "3D4N6N")
            (Triangle6, Triangle3, "3D6N3N")
            (Triangle6, Quadrilateral4, "3D6N4N")
            (Triangle6, Triangle6, "3D6N")
            (Quadrilateral4, Quadrilateral8, "3D4N8N")
            (Quadrilateral8, Quadrilateral4, "3D8N4N")
            (Quadrilateral8, Quadrilateral8, "3D8N")
            (Triangle3, Quadrilateral8, "3D3N8N")
            (Quadrilateral8, Triangle3, "3D8N3N")
            (Triangle6, Quadrilateral8, "3D6N8N")
            (Quadrilateral8, Triangle6, "3D8N6N")
            (Quadrilateral4, Quadrilateral9, "3D4N9N")
            (Quadrilateral9, Quadrilateral4, "3D9N4N")
            (Quadrilateral9, Quadrilateral9, "3D9N")
        }
    };
}

/// What `$make!` gives for the types of a slave's and a master's shape; `None` for pairs that carry no contact.
macro_rules! for_shapes {
    ($slave:expr, $master:expr, $make:ident) => {
        $crate::with_pairs_of_shapes! { [$crate::mortar::shapes::for_shapes] @ $slave, $master, $make; }
    };
    (@ $slave:expr, $master:expr, $make:ident; $(($s:ident, $m:ident, $end:literal))*) => {{
        use zelus_core::geometry::{self, FacetShape};
        match ($slave, $master) {
            $((<geometry::$s as FacetShape>::SHAPE, <geometry::$m as FacetShape>::SHAPE) => {
                Some($make!(geometry::$s, geometry::$m, $end))
            })*
            _ => None,
        }
    }};
}
pub(crate) use for_shapes;

macro_rules! list {
    ($(($s:ident, $m:ident, $end:literal))*) => {
        [$([<zelus_core::geometry::$s as FacetShape>::SHAPE, <zelus_core::geometry::$m as FacetShape>::SHAPE]),*]
    };
}

const PAIRS: &[[Shape; 2]] = &with_pairs_of_shapes! { [list] };

/// Nodes of the largest facet.
pub const MOST_NODES: usize = {
    let (mut most, mut at) = (0, 0);
    while at < PAIRS.len() {
        let nodes = PAIRS[at][0].nodes();
        most = if nodes > most { nodes } else { most };
        at += 1;
    }
    most
};

/// Variables by which pairs with a facet of second order are differentiated at once.
const LANES: usize = 12;

/// By how many of its variables a pair is differentiated at once: by all, where both facets are of first order. Others would
/// make code that takes long to compile and is no faster.
pub const fn lanes<S: FacetShape, M: FacetShape>(variables: usize) -> usize {
    if S::CURVED || M::CURVED { LANES } else { variables }
}

/// Whether facets of a shape carry contact.
pub fn carries_contact(shape: Shape) -> bool {
    PAIRS.as_flattened().contains(&shape)
}

/// Whether facets of two shapes, slave and master, make pairs.
pub fn makes_pairs(slave: Shape, master: Shape) -> bool {
    PAIRS.contains(&[slave, master])
}

/// Kratos' name of the condition of a pair of shapes; `stem` is the name up to the shape.
pub fn condition_name(stem: &str, slave: Shape, master: Shape) -> String {
    macro_rules! make {
        ($slave:ty, $master:ty, $end:literal) => {
            $end
        };
    }
    match for_shapes!(slave, master, make) {
        Some(end) => format!("{stem}{end}"),
        None => format!("{stem} of {slave:?} and {master:?}"),
    }
}
