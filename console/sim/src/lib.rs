//! The truth: where the robot really is and what it would sense there.
//!
//! The simulator answers two calls, [`Simulator::sense`] and [`Simulator::act`]. It knows no clock: time is the number
//! of ticks. Chance comes from one seed; the same seed and the same drives give the same readings on every machine.
//! Cost: a tick takes a few distance queries, some microseconds.

pub mod config;
pub mod ranging;
pub mod simulator;

mod motion;
mod movers;
mod sweep;

mod chance;
mod sight;

pub use config::{
    AeConfig, BehindColumns, Disturbances, Mover, NoiseModel, RobotConfig, SimConfig, StationFault, Track,
    Truth,
};
pub use ranging::Sounder;
pub use simulator::Simulator;
