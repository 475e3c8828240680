//! The hybrid planner of Yang et al. 2021: a potential field with virtual goals chooses the direction, and a dynamic
//! window chooses the motion.
//!
//! The planner is for a robot that walks and swims, whose limits depend on the zone of the floor. Frame: the tank
//! frame, metres, radians.
#![forbid(unsafe_code)]

pub mod window;

pub mod guide;
pub mod hybrid;
pub mod near;
pub mod surroundings;

mod apf_dwa;
mod parameters;

pub use hybrid::{Hybrid, HybridSettings, State};
pub use window::{Twist, Weights, Window};

planner_api::export_planners!(apf_dwa::ApfDwa);
