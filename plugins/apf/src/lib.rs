//! Artificial potential field planners: the classical field, the tangent field and the field with virtual goals.
#![forbid(unsafe_code)]

pub mod apf;
mod apf_virtual_goals;
mod goal_flight;
mod tapf;

planner_api::export_planners!(apf::Apf, tapf::Tapf, apf_virtual_goals::ApfVirtualGoals);
