//! The port to a vehicle: the messages on the wire between the console and an adapter
//! process ([`wire`]), the state of that link ([`link`]), and the evaluation of a vehicle's trial ([`trial`]).
//!
//! Everything here is pure: bytes and stamps come from outside. This crate uses no clock, thread, file or socket.
//! `console/docs/vehicle-protocol.md` describes the wire for the authors of adapters.

pub mod link;
pub mod port;
pub mod trial;
pub mod wire;
