//! Artificial potential field planners.
#![forbid(unsafe_code)]

mod apf;

planner_api::export_planners!(apf::Apf);
