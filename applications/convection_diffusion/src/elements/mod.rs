//! Elements: the balance of heat over a body.

mod balance;
mod contribution;
mod place;
mod plastic_heat;
mod equation;
mod explicit;
mod registered;

pub use balance::{
    ABOUT_Y, AT_CENTRE, AT_REST, CROSS_WIND, DYNAMIC_TAU, LEAST_GRADIENT, LINEAR, PURE_CONVECTION, Point, Step, THETA,
    radial,
};
pub use equation::{Equation, Terms};
pub use explicit::{Explicit, PROJECTING, STAGE, Subscales};
pub use place::full_order;
pub use plastic_heat::PLASTIC_HEAT_POWER;
