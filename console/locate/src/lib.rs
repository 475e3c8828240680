//! Turns readings of other systems, for example of an acoustic-emission system on a real robot, into fixes and a track.
//! It uses the same estimator as a mission and produces the events of a run, so the journal, the recording and the
//! report are made as for any other run.
//!
//! A file is read row by row, once to check it and once to locate; memory use does not grow with the length of the
//! file. To estimate clock and sound errors, the file is read more often.

mod again;
mod clock;
mod columns;
mod doubts;
mod fixes;
mod found;
mod located;
mod measured;
mod moments;
mod problem;
mod pulsing;
mod repeats;
mod rows;
pub mod scan_log;
mod tally;
pub mod thickness;
mod tool;

pub use again::{Again, again};
pub use columns::Kind;
pub use doubts::{Doubts, Refused};
pub use fixes::Fixes;
pub use found::Found;
pub use located::{Survey, Task};
pub use measured::MeasuredWriter;
pub use problem::Problem;
pub use pulsing::Pulsed;
pub use repeats::{Repeated, Repeats};
pub use tally::Tally;

#[cfg(test)]
mod tests;
