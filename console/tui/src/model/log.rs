//! The log: what happened, newest last, limited both in lines and in bytes.

mod alike;
mod chunk;
mod entry;
pub mod filter;
mod lines;
pub mod matches;
mod occurrence;

pub use account::clock;
pub use entry::{Entry, severity_word};
pub use lines::{Log, MAX_LINES};
pub(in crate::model) use occurrence::slim;
pub use occurrence::{Occurrence, Robot, What};
