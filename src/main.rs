//! The program `zelus`.
fn main() {}
