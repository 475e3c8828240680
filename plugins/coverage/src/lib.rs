//! Planners that scan the whole floor: with consideration of the tether, as published, and without a tether.
//!
//! A tether-safe plan is made as follows. `cuts` divide the `workspace` of the site into a `slit_domain`, which has no
//! way around an obstacle. `lanes` are laid into it, ordered (`tour`) and joined to a path (`draft`). The path is
//! shortened and bent until it sweeps enough of the `floor` (`polish`). [`tether_safe`] does this for several patterns
//! of lanes and chooses the best. If obstacles are found during the mission, `repair` changes the plan only around
//! them. `tuning` holds the numbers.
#![forbid(unsafe_code)]

pub mod boustrophedon;
pub mod hull_partition;
pub mod tether_safe;

mod arrangement;
mod buckets;
mod cuts;
mod draft;
mod floor;
mod follow;
mod inflation;
mod jobs;
mod lanes;
mod pattern;
mod plane;
mod polish;
mod repair;
mod scan;
mod scope;
mod slit_domain;
mod stages;
mod tether;
mod touch_up;
mod tour;
mod triangulation;
mod tuning;
mod unreachable;
mod untethered_paths;
mod workspace;

#[cfg(test)]
mod bench;

planner_api::export_planners!(
    boustrophedon::Boustrophedon,
    hull_partition::HullPartition,
    tether_safe::TetherSafe
);
