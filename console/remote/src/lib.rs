//! A vehicle behind an adapter process.
//!
//! [`Remote`] is the port to such a vehicle ([`vehicle::port::Vehicle`]). One thread reads the adapter's stream and
//! folds its messages into an inbox; another writes the newest command from an outbox. Neither call of the port waits:
//! a tick takes the messages that have arrived. Memory grows neither with their number nor with the length of a line.
//!
//! [`server`] is the other end, for programs that offer a vehicle.

pub mod address;
mod began;
mod inbox;
mod loopback;
mod outbox;
mod remote;
mod said;
pub mod server;
mod stream;
mod taking;
mod trial;

pub use address::Address;
pub use remote::{ConnectError, Remote};
pub use taking::{Wanted, connected, fitting};
pub use trial::{Trial, TrialOptions, try_vehicle};
