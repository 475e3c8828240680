//! Planners that scan the whole floor: with regard to the tether, as published, and without.
//!
//! How a tether-safe plan comes about: the `workspace` of the site is divided by `cuts` into a `slit_domain` that has no way
//! round an obstacle; `lanes` are laid into it, put into an order (`tour`) and joined to a path (`draft`), which is shortened
//! and bent until it sweeps enough of the `floor` (`polish`). [`tether_safe`] does so for several patterns of lanes and
//! chooses. What is found on the way changes the plan only round itself (`repair`). `tuning` holds the numbers.
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
