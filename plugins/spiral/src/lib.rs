//! Planners for the preset spiral.
#![forbid(unsafe_code)]

mod rpf;

planner_api::export_planners!(rpf::Rpf);
