//! The potential field with virtual obstacles of Xu et al. 2022 (BVO-APF), as published and with our improvements.
//!
//! In a trap, the robot retreats along its own track, closes the mouth of the trap with virtual circles, and goes
//! around the whole trap. If the wall forms the trap, the robot follows the outlines. Frame: the tank frame, metres,
//! radians. Distances are measured from the hull.
#![forbid(unsafe_code)]

pub mod clusters;
pub mod view;

pub mod machine;
pub mod mouth;
pub mod news;
pub mod settings;

pub mod ahead;
pub mod escape;
pub mod outline;
pub mod taut;
pub mod thought;

mod bvo_apf;
mod parameters;

pub use machine::{Machine, Next, Phase};
pub use settings::{MachineSettings, Mode};

planner_api::export_planners!(bvo_apf::BvoApf);
