//! The laws of conductance.

mod constant;
mod gas;
mod pressure;
mod radiation;
