//! What computes: blocks of like entities, interactions between bodies.
//!
//! Dispatch happens once a block: a [`EntityBlock`] writes the local systems of a whole range of its entities into
//! buffers of the caller. A method is a [`Kernel`], the mathematics of one entity; [`KernelBlock`] makes a block of it.

mod block;
mod face_point;
mod interaction;
mod kernel;
mod view;

pub use block::{BlockRequest, EntityBlock, EntityError, Gauss, LocalSystems, LocalUnknown, Tangent, Want};
pub use face_point::FacePoint;
pub use interaction::{Interaction, MasslessNodes, Outer, SetChange};
pub use kernel::{Gather, Kernel, KernelBlock};
pub use view::{NORMALS_OF_FIRST_ITERATION, StepView};
