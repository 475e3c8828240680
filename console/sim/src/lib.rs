//! The truth: where the robot really is, and what it senses there.
//!
//! The simulator answers two calls, [`Simulator::sense`] and [`Simulator::act`]. It knows no clock: time is the number of
//! ticks. All randomness comes from one seed; the same seed and the same drives give the same readings on every machine.
//! Cost: a tick takes a few distance queries, some microseconds.

mod config;
mod motion;
mod movers;
mod random;
mod ranging;
mod sight;
mod simulator;
mod sweep;

pub use config::{
    AeConfig, BehindColumns, Disturbances, Mover, NoiseModel, RobotConfig, SimConfig, StationFault,
    TetherTruth, TimingErrors, Track, Truth,
};
pub use ranging::Sounder;
pub use simulator::Simulator;
