//! Library for adapters written in Rust: the messages of the wire, the console's commands with their lease, stamps on
//! one clock, and the pipes to the console. All modules except [`console`] are pure: times come from outside, in
//! seconds of an adapter's clock that never runs backwards. The wire is defined in
//! `console/docs/vehicle-protocol.md`.

pub mod clock;
pub mod commands;
pub mod console;
pub mod message;
pub mod pilot;
pub mod readings;
pub mod settings;
pub mod status;
pub mod trail;
