//! Planners that scan the whole floor: with regard to the tether, as published, and without.
#![forbid(unsafe_code)]

pub mod boustrophedon;
pub mod hull_partition;
pub mod tether_safe;

pub mod answer;
pub mod candidate;
pub mod cuts;
pub mod floor;
pub mod follow;
pub mod genetic;
pub mod ground;
pub mod lanes;
pub mod partition;
pub mod polish;
pub mod roam;
pub mod scan;
pub mod side_by_side;
pub mod slit;
pub mod stages;
pub mod touch;
pub mod tour;

#[cfg(test)]
mod bench;

planner_api::export_planners!(
    boustrophedon::Boustrophedon,
    hull_partition::HullPartition,
    tether_safe::TetherSafe
);
