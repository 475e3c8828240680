//! tankops.

mod scenario;

fn main() {}
