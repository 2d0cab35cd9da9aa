//! Heat between bodies in contact: through the contact area, through the gas between, by radiation across.
//!
//! A [`law`] says how much heat passes at a point, by the pressure, the gap and the temperatures there; `laws` are those there are, one a
//! file. A [`block`] sums them up over the points at which facets face each other, the [`interaction`] finds these. A module uses only
//! those above it in the list below.

pub mod law;
mod laws;
pub mod block;
pub mod interaction;
mod process;
