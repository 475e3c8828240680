//! The vehicle of a past live run, whose readings are in the journal.

use mission::EventKind;
use std::sync::mpsc::{Receiver, Sender, channel};
use vehicle::port::{CannotInject, Command, Live, Sensed, Stamps, StationFault, Stood, Vehicle};
use world::Truth;

/// A vehicle that repeats the readings of a journal; commands have no effect on it.
pub struct Recorded {
    fed: Receiver<Fed>,
    /// The link and the stop at the end of the mission, if the current tick is the last one.
    last: Option<Live>,
}

type Fed = (Sensed, Option<Live>);

/// Feeds a [`Recorded`] vehicle.
pub struct Feed(Sender<Fed>);

/// Creates a vehicle that repeats a journal, and its feed.
pub fn recorded() -> (Feed, Recorded) {
    let (feed, fed) = channel();
    (Feed(feed), Recorded { fed, last: None })
}

impl Feed {
    /// Feeds the recorded events of the tick that is about to begin.
    pub fn begin_tick<'a>(&self, events: impl Iterator<Item = &'a EventKind>) {
        let mut readings = world::Readings::default();
        let (mut first, mut last) = (Live::default(), None);
        // Events of the link and the stop that follow the decisions of a tick contain the vehicle's state at the end of
        // the mission.
        let mut is_decided = false;
        for event in events {
            match event {
                EventKind::Sensed { source_t_s, arrival_t_s, readings: sensed } => {
                    first.stamps = Some(Stamps { source_t_s: *source_t_s, arrival_t_s: *arrival_t_s });
                    readings.clone_from(sensed);
                }
                EventKind::Link(link) => {
                    live_of(is_decided, &mut first, &mut last).link = Some(link.clone());
                }
                EventKind::Stood { confirmed, after_s, moved } => {
                    let stood = Stood { confirmed: *confirmed, after_s: *after_s, moved: *moved };
                    live_of(is_decided, &mut first, &mut last).stood = Some(stood);
                }
                EventKind::Noticed(notice) => {
                    live_of(is_decided, &mut first, &mut last).notices.push(notice.clone());
                }
                EventKind::RunOpened(_) => {}
                _ => is_decided = true,
            }
        }
        let sensed = Sensed { readings, live: Some(first) };
        // The receiver is gone once the flight has ended.
        let _ = self.0.send((sensed, last));
    }
}

fn live_of<'a>(is_decided: bool, first: &'a mut Live, last: &'a mut Option<Live>) -> &'a mut Live {
    if is_decided { last.get_or_insert_default() } else { first }
}

impl Vehicle for Recorded {
    fn sense(&mut self) -> Sensed {
        let (sensed, last) = self.fed.try_recv().unwrap_or_default();
        self.last = last;
        sensed
    }

    fn act(&mut self, _: Command) {}

    fn settle(&mut self, _: bool) -> Option<Live> {
        self.last.take()
    }

    fn truth(&self) -> Option<Truth> {
        None
    }

    fn inject(&mut self, _: StationFault) -> Result<(), CannotInject> {
        Err(CannotInject)
    }
}
