//! What a plan costs on the random traps.
fn main() {}
