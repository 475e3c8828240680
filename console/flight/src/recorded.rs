//! The vehicle of a past live run, whose readings are in the journal.

use mission::EventKind;
use std::sync::mpsc::{Receiver, Sender, channel};
use vehicle::port::{CannotInject, Command, Live, Sensed, Stamps, StationFault, Stood, Vehicle};
use world::Truth;

/// A vehicle that repeats the readings of a journal; commands have no effect on it.
pub struct Recorded(Receiver<Sensed>);

/// Feeds a [`Recorded`] vehicle.
pub struct Feed(Sender<Sensed>);

/// Creates a vehicle that repeats a journal, and its feed.
pub fn recorded() -> (Feed, Recorded) {
    let (feed, fed) = channel();
    (Feed(feed), Recorded(fed))
}

impl Feed {
    /// Feeds the recorded events of the tick that is about to begin.
    pub fn begin_tick<'a>(&self, events: impl Iterator<Item = &'a EventKind>) {
        let mut sensed = Sensed { live: Some(Live::default()), ..Sensed::default() };
        let live = sensed.live.get_or_insert_default();
        for event in events {
            match event {
                EventKind::Sensed { source_t_s, arrival_t_s, readings } => {
                    live.stamps = Some(Stamps { source_t_s: *source_t_s, arrival_t_s: *arrival_t_s });
                    sensed.readings.clone_from(readings);
                }
                EventKind::Link(link) => live.link = Some(link.clone()),
                EventKind::Stood { confirmed, after_s, moved } => {
                    live.stood = Some(Stood { confirmed: *confirmed, after_s: *after_s, moved: *moved });
                }
                _ => {}
            }
        }
        // The receiver is gone once the flight has ended.
        let _ = self.0.send(sensed);
    }
}

impl Vehicle for Recorded {
    fn sense(&mut self) -> Sensed {
        self.0.try_recv().unwrap_or_default()
    }

    fn act(&mut self, _: Command) {}

    fn truth(&self) -> Option<Truth> {
        None
    }

    fn inject(&mut self, _: StationFault) -> Result<(), CannotInject> {
        Err(CannotInject)
    }
}
