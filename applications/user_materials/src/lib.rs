//! Materials of one's own: constitutive laws in libraries by the calling convention of Abaqus' UMAT, and by functions of the program that
//! runs zelus, as of Python.
//!
//! `library` loads the subroutine, `ending` names the element in which a library ends the program, [`arguments`] is one call,
//! [`material`] has its constants and the history of a point, `tangent_check` compares its tangent with differences before the run. The laws
//! for small and for finite strain are one file each. [`law_function`] has the functions by name, `noted_points` calls them for the points of
//! many elements, `function_law` is their law. A module uses only those above it in the list below.

pub mod variables;
mod ending;
mod library;
pub mod arguments;
pub mod material;
mod tangent_check;
mod small_strain_umat;
mod finite_strain_umat;
pub mod law_function;
mod noted_points;
mod function_law;
