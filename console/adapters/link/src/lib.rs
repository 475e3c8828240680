//! What every adapter written in Rust needs: the messages of the wire, the console's commands with their lease, stamps
//! on one clock, and the pipes to the console. All but [`console`] is pure: times come from outside, in seconds of a
//! clock of the adapter that never runs backwards. The wire is defined in `console/docs/vehicle-protocol.md`.

pub mod clock;
pub mod commands;
pub mod console;
pub mod message;
pub mod pilot;
pub mod readings;
pub mod settings;
pub mod status;
