//! Readings measured by others, an acoustic-emission system on a real robot for example: to fixes and a track, by the same
//! estimator as in a mission, as the events of a run, so that journal, recording and report are made of them as of any run.
//!
//! A file is read twice, row by row: once to check it and to find out about clocks and sound, once to locate. Memory does not
//! grow with it.

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
mod repeats;
mod rows;
mod tally;
mod tool;

pub use again::{Again, again};
pub use columns::Kind;
pub use doubts::{Doubts, Refused};
pub use fixes::Fixes;
pub use found::Found;
pub use located::{Survey, Task};
pub use measured::MeasuredWriter;
pub use problem::Problem;
pub use repeats::{Repeated, Repeats};
pub use tally::Tally;

#[cfg(test)]
mod tests;
