//! Materials of one's own: constitutive laws in libraries by the calling convention of Abaqus' UMAT.
//!
//! `library` loads the subroutine, `ending` names the element in which a library ends the program, [`arguments`] is one call,
//! [`material`] has its constants and the history of a point, `tangent_check` compares its tangent with differences before the run. The laws
//! for small and for finite strain are one file each. A module uses only those above it in the list below.

pub mod variables;
mod ending;
mod library;
pub mod arguments;
pub mod material;
mod tangent_check;
mod small_strain_umat;
mod finite_strain_umat;
