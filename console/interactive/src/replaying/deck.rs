//! A journal reader that is positioned at a moment and can seek to another.

use super::reel::Reel;
use mission::Event;
use recording::{JournalError, JournalReader};
use std::sync::Arc;
use tui::model::Run;

/// A time within this many seconds of the end of a tick counts as the end of that tick.
const SAME_S: f64 = 1e-6;

/// The change in the run between two moments.
#[derive(Debug)]
pub(super) enum Moved {
    /// The run continues with these events.
    On(Vec<Event>),
    /// The run was replaced by this one, after a seek.
    To(Box<Run>),
}

/// A journal that is read up to a moment; all events up to this moment have been returned.
pub(super) struct Deck {
    pub reel: Arc<Reel>,
    reader: Option<JournalReader>,
    /// The first event after the moment.
    ahead: Option<Event>,
    /// The mission time of the moment, in seconds.
    pub t_s: f64,
}

impl Deck {
    /// Creates a deck that is not positioned yet.
    pub(super) fn new(reel: Arc<Reel>) -> Self {
        Self { reel, reader: None, ahead: None, t_s: f64::NEG_INFINITY }
    }

    /// Seeks to a moment and returns the change. Returns `None` if no part of the run is loaded yet.
    ///
    /// # Errors
    /// The journal cannot be read at this position.
    pub(super) fn go_to(&mut self, t_s: f64) -> Result<Option<Moved>, JournalError> {
        let (t_s, bytes, frame) = {
            let content = self.reel.content();
            let t_s = t_s.min(content.until_s);
            let after = content.frames.partition_point(|frame| frame.t_s <= t_s + SAME_S);
            let index = after.saturating_sub(1);
            // If the moment is at most one or two stretches ahead, read on from here instead of seeking.
            let here = content.frames.partition_point(|frame| frame.t_s <= self.t_s + SAME_S);
            let goes_on = self.reader.is_some() && t_s >= self.t_s && after <= here + 1;
            let Some(frame) = content.frames.get(index) else { return Ok(None) };
            (t_s, content.bytes, (!goes_on).then(|| (frame.t_s, frame.place, Arc::clone(&frame.run))))
        };
        let Some((frame_s, place, run)) = frame else {
            self.t_s = t_s;
            return self.read(t_s, bytes).map(Moved::On).map(Some);
        };
        self.reader = Some(JournalReader::open_at(&self.reel.journal, place)?);
        self.ahead = None;
        self.t_s = t_s.max(frame_s);
        let mut run = Box::new((*run).clone());
        for event in self.read(t_s, bytes)? {
            run.fold(&event);
        }
        Ok(Some(Moved::To(run)))
    }

    /// The events up to a moment, within this many bytes of the journal.
    fn read(&mut self, t_s: f64, bytes: u64) -> Result<Vec<Event>, JournalError> {
        let mut events = Vec::new();
        let Some(reader) = &mut self.reader else { return Ok(events) };
        loop {
            let next = match self.ahead.take() {
                Some(event) => Some(event),
                None if reader.place().bytes >= bytes => None,
                None => reader.next().transpose()?,
            };
            let Some(event) = next else { return Ok(events) };
            if event.t_s > t_s + SAME_S {
                self.ahead = Some(event);
                return Ok(events);
            }
            events.push(event);
        }
    }
}
