//! A reader of a journal at some moment, and how it gets to another one.

use super::reel::Reel;
use mission::Event;
use recording::{JournalError, JournalReader};
use std::sync::Arc;
use tui::model::Run;

/// A moment and the end of its tick are one, seconds.
const SAME_S: f64 = 1e-6;

/// How the run changed between two moments.
#[derive(Debug)]
pub(super) enum Moved {
    /// It went on by these events.
    On(Vec<Event>),
    /// It is another one.
    To(Box<Run>),
}

/// A journal that is read at some moment: everything up to it was given away.
pub(super) struct Deck {
    pub reel: Arc<Reel>,
    reader: Option<JournalReader>,
    /// The first event of what comes next.
    ahead: Option<Event>,
    /// Mission time of the moment, seconds.
    pub t_s: f64,
}

impl Deck {
    /// A deck that is nowhere yet.
    pub(super) fn new(reel: Arc<Reel>) -> Self {
        Self { reel, reader: None, ahead: None, t_s: f64::NEG_INFINITY }
    }

    /// Goes to a moment: everything that happened up to it. `None` as long as nothing of the run is loaded.
    ///
    /// # Errors
    /// The journal cannot be read there.
    pub(super) fn go_to(&mut self, t_s: f64) -> Result<Option<Moved>, JournalError> {
        let (t_s, bytes, frame) = {
            let content = self.reel.content();
            let t_s = t_s.min(content.until_s);
            let after = content.frames.partition_point(|frame| frame.t_s <= t_s + SAME_S);
            let index = after.saturating_sub(1);
            // As long as no more than a stretch or two are to be read, they are read.
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

    /// The events up to a moment, in so many bytes of the journal.
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
