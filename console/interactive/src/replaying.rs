//! The replay of a past run: a separate thread reads its journal, seeks to any moment and paces the playback.
//!
//! During the first reading of a journal, at most [`reel::MOST_FRAMES`] copies of the folded run are kept, evenly
//! spaced by bytes. A seek folds the events that follow the nearest earlier copy. This module does not use an engine.

mod deck;
mod player;
mod reel;
#[cfg(test)]
mod tests;

pub(super) use player::Player;
