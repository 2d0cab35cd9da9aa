//! Laws of soft contact, one a file.

mod exponential;
mod table;

#[cfg(test)]
mod tests;
