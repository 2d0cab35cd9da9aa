//! Objects that compute: blocks of like entities, interactions between bodies.
//!
//! Dispatch happens once a block: a [`EntityBlock`] writes the local systems of a whole range of its entities into
//! buffers of the caller. A method is a [`Kernel`], the mathematics of one entity; [`KernelBlock`] makes a block of it.

mod assumed_small;
mod block;
mod block_state;
mod complementary;
mod constraint_entry;
mod face_point;
mod interaction;
mod join;
mod kernel;
mod pair_state;
mod registered;
mod together;
mod view;

pub use assumed_small::AssumedSmall;
pub use block::{
    BlockRequest, EntityBlock, EntityError, Gauss, LocalOwner, LocalSystems, LocalUnknown, Request, Tangent,
};
pub(crate) use block_state::repartition;
pub use complementary::{Complementary, ComplementaryCondition, Responses};
pub use constraint_entry::{ConstraintEntry, ConstraintFactory, ConstraintRow};
pub use face_point::FacePoint;
pub use interaction::{
    ActiveSet, Coupling, FirstIterate, Follower, Interaction, Massless, MasslessNodes, Observer, OuterLoop, Retry,
    SetChange,
};
pub use join::Join;
pub use kernel::{EntityView, Kernel, KernelBlock};
pub use pair_state::PairState;
pub use registered::{
    BlockFactory, Build, ConditionEntry, ElementEntry, block_factory, block_kinds, find_kind, is_place, kind_names,
    require_kind,
};
pub use together::{Round, Work, note, round, together};
pub use view::{ELASTIC, NORMALS_OF_FIRST_ITERATION, StepView};
