//! Planners that scan the whole floor: one that protects the tether, one as published, and one that ignores the tether.
//!
//! A tether-safe plan is made as follows. `cuts` turn the `workspace` of the site into a `slit_domain`, in which no
//! path leads around an obstacle. `lanes` are laid in it, ordered (`tour`) and joined into a path (`draft`). The path
//! is shortened and bent until it sweeps enough of the `floor` (`polish`). [`tether_safe`] does this for several
//! patterns of lanes and chooses the best. If obstacles are found during the mission, `repair` changes the plan only
//! around them. `tuning` contains the numbers.
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
