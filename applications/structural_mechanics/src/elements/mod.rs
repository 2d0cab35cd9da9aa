//! Solid elements: one kernel, four formulations.
//!
//! [`Solid`] does the integration; a [`Formulation`] says on which configuration and with which strain. A formulation's
//! file registers its elements for every shape.

mod axisymmetric;
mod formulation;
mod material;
mod results;
mod small_displacement;
mod small_displacement_bbar;
mod solid;
#[cfg(test)]
mod reference_tests;
#[cfg(test)]
mod tests;
mod total_lagrangian;
mod updated_lagrangian;

pub use formulation::Formulation;
pub use small_displacement::SmallDisplacement;
pub use small_displacement_bbar::SmallDisplacementBbar;
pub use solid::Solid;
pub use total_lagrangian::TotalLagrangian;
pub use updated_lagrangian::UpdatedLagrangian;

/// Registers a formulation for shapes: `kind!("Name", Formulation, S, "about", "source"; DIM: "2D3N" 3, …)`.
macro_rules! register_solids {
    ($name:literal, $formulation:ty, $strains:literal, $about:literal, $source:literal;
     $dim:literal: $($suffix:literal $nodes:literal),+) => {
        $(zelus_core::register! { Element concat!($name, $suffix),
            about: $about,
            source: $source,
            cell: zelus_core::geometry::Shape::of($dim, $nodes),
            space: $dim,
            build: zelus_core::registry::Build::Block(zelus_core::entities::KernelBlock::<
                $crate::elements::Solid<$formulation, $nodes, $dim, $strains>, $nodes, { $nodes * $dim }>::boxed),
        })+
    };
}

use register_solids;
