//! Elements: solids (one kernel, six formulations), trusses, springs and masses.
//!
//! [`Solid`] does the integration; a [`Formulation`] says on which configuration and with which strain. A formulation's
//! file registers its elements for every shape. The framework makes blocks of the elements of a part and assembles them:
//!
//! ```
//! # use zelus_core::assembly::{Assembler, System};
//! # use zelus_core::entities::require_kind;
//! # use zelus_core::model::{EntityRole, ModelPart, Nodes, Properties, PropertyValue};
//! # use zelus_structural_mechanics::variables::DISPLACEMENT;
//! // A bar of length 2, A = 3 and E = 10, fixed at its left end: EA/L = 15 remains.
//! let mut part = ModelPart::new("Structure");
//! part.nodes = Nodes::new(vec![1, 2], vec![[0.0; 3], [2.0, 0.0, 0.0]]);
//! part.nodes.history.add(&DISPLACEMENT);
//! let mut material = Properties { law: Some("TrussConstitutiveLaw".to_owned()), ..Properties::new(1) };
//! for (name, value) in [("YOUNG_MODULUS", 10.0), ("CROSS_AREA", 3.0)] {
//!     material.values.insert(name.to_owned(), PropertyValue::Number(value));
//! }
//! part.properties.insert(1, material);
//! part.elements.push(1, require_kind(EntityRole::Element, "LinearTrussElement2D2N")?, 1, &[0, 1]);
//! part.elements.finish();
//! part.nodes.set_fixed(DISPLACEMENT.component(0), &[0], true);
//! part.nodes.set_fixed(DISPLACEMENT.component(1), &[0, 1], true);
//!
//! let mut system = System::default();
//! system.make_blocks(&part)?;
//! let mut assembler = Assembler::new(&part, &mut system, false);
//! assembler.begin_step(&part, &system)?;
//! assembler.tangents(&part, &system, None)?;
//! assembler.reduce();
//! assert_eq!(assembler.equations().len(), 1);
//! assert_eq!(assembler.system().bulk.get(0, 0), 15.0);
//! # Ok::<(), zelus_core::Error>(())
//! ```

mod absent;
mod axial_spring;
mod axisymmetric;
mod band;
mod formulation;
mod gradients;
mod locking;
mod material;
mod mixed_small_displacement;
mod mixed_total_lagrangian;
mod mixed_volumetric_strain;
mod nodal_concentrated;
#[cfg(test)]
mod nodal_tests;
mod nodal_values;
mod results;
mod small_displacement;
mod small_displacement_bbar;
mod small_motion;
mod solid;
mod spring_damper;
mod stiffness;
#[cfg(test)]
mod reference_tests;
#[cfg(test)]
mod tests;
mod total_lagrangian;
mod total_lagrangian_q1p0;
mod total_lagrangian_q2p1;
mod truss;
mod updated_lagrangian;

pub use band::BANDS_AS_KRATOS;
pub use formulation::Formulation;
pub use gradients::physical_gradients;
pub use mixed_small_displacement::MixedSmallDisplacement;
pub use mixed_total_lagrangian::MixedTotalLagrangian;
pub use mixed_volumetric_strain::{MixedVolumetricStrain, VolumetricForm};
pub use nodal_concentrated::NodalConcentrated;
pub use small_displacement::SmallDisplacement;
pub use small_displacement_bbar::SmallDisplacementBbar;
pub use solid::Solid;
pub use spring_damper::SpringDamper;
pub use total_lagrangian::TotalLagrangian;
pub use total_lagrangian_q1p0::TotalLagrangianQ1P0;
pub use total_lagrangian_q2p1::TotalLagrangianQ2P1;
pub use truss::Truss;
pub use updated_lagrangian::UpdatedLagrangian;

/// Registers a formulation for shapes: `kind!("Name", Formulation, S, "about", "source"; DIM: "2D3N" 3, …)`.
macro_rules! register_solids {
    ($name:literal, $formulation:ty, $strains:literal, $about:literal, $source:literal;
     $dim:literal: $($suffix:literal $nodes:literal),+) => {
        $(const _: () = { use zelus_core::entities::ElementEntry; zelus_core::register! { ElementEntry concat!($name, $suffix),
            about: $about,
            source: $source,
            cell: zelus_core::geometry::Shape::of($dim, $nodes),
            space: $dim,
            body_load: ("VOLUME_ACCELERATION", "DENSITY"),
            small_displacement: !<$formulation as $crate::elements::Formulation>::FINITE,
            of_revolution: $crate::elements::Solid::<$formulation, $nodes, $dim, $strains>::AXISYMMETRIC,
            build: zelus_core::entities::Build::Block(zelus_core::entities::KernelBlock::<
                $crate::elements::Solid<$formulation, $nodes, $dim, $strains>, $nodes, { $nodes * $dim }>::boxed),
        } };)+
    };
}

use register_solids;
