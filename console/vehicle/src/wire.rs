//! The messages between the console and an adapter: one JSON object a line, in UTF-8.
//!
//! Suggested reading order: [`message`] (the types), [`Reader`] (bytes to messages and named faults), [`Writer`]
//! (messages to bytes). Messages pass the same checks on the way out as on the way in; both refuse numbers that are not
//! finite.

mod check;
mod differences;
mod fields;
mod lines;
pub mod message;
mod path;
mod reader;
mod session;
mod writer;

#[cfg(test)]
mod examples;
#[cfg(test)]
mod tests;

pub use check::Misfit;
pub use message::{FromVehicle, ToVehicle};
pub use reader::{Counts, Heard, Incoming, Reader, Unknown};
pub use session::{FromSession, ToSession};
pub use writer::Writer;

/// The version of the protocol. A vehicle with another version is refused; new keys and new kinds of messages do not
/// change the version, because both sides ignore the ones that they do not know.
pub const PROTOCOL: u32 = 1;

/// Maximum length of a line without its line feed, bytes.
pub const LINE_MAX: usize = 256 * 1024;

/// This many malformed lines without good readings in between are a fault of the link.
pub const FAULT_AFTER: u32 = 3;
