//! Results of contact: nodal columns and forces, surfaces of interfaces, and the pairs of a deck by name.

mod interface_surfaces;
mod nodal_results;
mod pair_states;

pub(crate) use interface_surfaces::{InterfaceSurfaces, TiedColumns};
pub(crate) use nodal_results::{write_forces, write_masters, write_states};
pub(crate) use pair_states::{PartsOfPairs, heat, inelastic_heat, joins, name, pair_states, spring_energy};
