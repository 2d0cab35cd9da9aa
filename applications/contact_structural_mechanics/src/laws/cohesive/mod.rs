//! Laws of bonds, one a file.

mod adhesion;
mod bilinear;
mod exponential;
mod mixed_mode;

#[cfg(test)]
mod tests;
