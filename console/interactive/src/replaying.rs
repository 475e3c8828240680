//! A past run, played back: a thread of its own reads its journal, goes to any moment of it, and keeps the pace.
//!
//! While a journal is read for the first time, at most [`reel::MOST_FRAMES`] copies of the folded run are kept, evenly spaced
//! by its bytes: going to a moment means to fold on from the nearest copy before it. Nothing here knows an engine.

mod deck;
mod player;
mod reel;
#[cfg(test)]
mod tests;

pub(super) use player::Player;
