//! Elements: the balance of heat over a body.

mod marks;
mod balance;
mod contribution;
mod place;
mod plastic_heat_source;
mod equation;
mod explicit_element;
mod registered;

pub use balance::{BalancePoint, CROSS_WIND, DYNAMIC_TAU, LEAST_GRADIENT, Step, THETA, radial};
pub use equation::{Equation, Terms};
pub use explicit_element::{Explicit, STAGE, Subscales};
pub use marks::{
    ABOUT_Y, AT_CENTRE, AT_REST, CROSS_WIND_OF_ITERATE, CROSS_WIND_OF_STEP_START, PROJECTING, PURE_CONVECTION,
};
pub use place::full_order;
pub use plastic_heat_source::PLASTIC_HEAT_POWER;
