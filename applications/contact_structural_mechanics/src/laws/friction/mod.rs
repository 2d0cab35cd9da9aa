//! Laws of friction, one a file.

mod coulomb;
mod orowan;
mod static_kinetic;
mod thermal_softening;
mod tresca;

pub use coulomb::COULOMB;

#[cfg(test)]
mod tests;
