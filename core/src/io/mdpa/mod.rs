//! The mesh file of Kratos (`.mdpa`), read and written as a plain document.
//!
//! The format is a stream of words; line ends mean nothing. `//` begins a comment even when glued to a word, `/* */`
//! encloses one. A number is the longest numeric beginning of its word, so `1.0D0` is 1.0 (said in a warning). The
//! document keeps the order of the file; sorting by id and the meaning of variables belong to who uses it.

mod blocks;
mod mdpa_check;
mod mdpa_document;
mod mdpa_problems;
mod reader;
#[cfg(test)]
mod tests;
mod tokens;
mod writer;

pub use blocks::DEPTH;
pub use mdpa_document::*;
pub use reader::{EntityNames, read, read_bytes};
pub use tokens::number_prefix;
pub use writer::{write, write_to};
