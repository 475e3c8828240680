//! tankops.
fn main() {}
