//! The constants of user materials.

use zelus_core::register_variable;

register_variable! {
    kind UMAT_PARAMETERS: Vector = "Constants of the material that a UMAT gets as PROPS.";
    kind STATE_VARIABLES: Vector = "State variables of a user material at the start, STATEV of a UMAT; as many as it has.";
    kind UDSM_NAME: Text = "Path of the library with the subroutine UMAT, from the folder of the materials file.";
    kind UMAT_NAME: Text = "Name of the material that a UMAT gets as CMNAME; USER unless given.";
    kind IS_FORTRAN_UDSM: Boolean = "Whether the library has the symbol umat_ of a Fortran compiler (the default), or umat.";
    kind UMAT_IS_UNSYMMETRIC: Boolean = "Whether DDSDDE is not symmetric. By default its symmetric part is the tangent, and solvers are those of symmetric matrices.";
    kind UMAT_IS_THREAD_SAFE: Boolean = "Whether threads may call the subroutine at once: without SAVE, COMMON and static arrays. By default one at a time.";
    kind LAW_FUNCTION: Text = "Name of the function of Python that gives the stress, as zelus.law registers it.";
    kind LAW_PARAMETERS: Vector = "Constants of the material that the function gets.";
    kind LAW_IS_UNSYMMETRIC: Boolean = "Whether the tangent of the function is not symmetric. By default its symmetric part is the tangent, and solvers are those of symmetric matrices.";
}
