//! Tests that the documentation is true: the book, documents, examples, the atlas, and the order of the code.

mod atlas;
mod book;
mod documents;
mod examples;
mod layers;
#[path = "../support/mod.rs"]
mod support;
