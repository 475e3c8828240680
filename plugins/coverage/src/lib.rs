//! Planners that scan the whole floor: with regard to the tether, as published, and without.
#![forbid(unsafe_code)]

pub mod ground;
pub mod slit;
pub mod cuts;
pub mod lanes;
pub mod floor;
pub mod tour;
pub mod touch;
pub mod scan;
pub mod polish;
