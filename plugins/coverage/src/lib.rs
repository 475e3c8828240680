//! Planners that scan the whole floor: with regard to the tether, as published, and without.
#![forbid(unsafe_code)]

pub mod tether_safe;

pub mod answer;
pub mod candidate;
pub mod cuts;
pub mod floor;
pub mod follow;
pub mod ground;
pub mod lanes;
pub mod polish;
pub mod scan;
pub mod slit;
pub mod touch;
pub mod tour;

planner_api::export_planners!(tether_safe::TetherSafe);
