//! Goal planners that either arrive or prove that the goal cannot be reached.
#![forbid(unsafe_code)]

pub mod navfn;
pub mod shortest;

mod flight;
pub mod marching;
mod navigation;
mod problem;
mod raster;

#[cfg(test)]
mod trial;

planner_api::export_planners!(navfn::Navfn, shortest::Shortest);
