//! The simulator: where the robot really is, and what its sensors read there.
//!
//! The simulator has two main calls, [`Simulator::sense`] and [`Simulator::act`]. It has no clock: time is the number of
//! ticks. All randomness comes from one seed; the same seed and the same drives produce the same readings on every
//! machine. A tick costs a few distance queries, which take a few microseconds.

mod config;
mod laid;
mod motion;
mod movers;
mod random;
mod ranging;
mod scanner;
mod sight;
mod simulator;
mod sweep;

pub use cable::Law as CableLaw;
pub use config::{
    AeConfig, BehindColumns, ChannelFault, Clocks, Disturbances, Mover, NoiseModel, PhysicalCable,
    RobotConfig, SimConfig, StationFault, TimingErrors, Track,
};
pub use ranging::Sounder;
pub use simulator::Simulator;
