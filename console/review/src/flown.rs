//! Repeats a past run. The readings of a simulated run are computed again; those of a live run are taken from its
//! journal.

use flight::{
    Flight,
    answers::Answers,
    recorded::{Feed, recorded},
};
use mission::Event;
use recording::RecordedTick;
use scenario::Scenario;
use vehicle::port::VehicleInfo;
use world::Readings;

/// A flight that repeats a journal.
pub(crate) struct Flown {
    flight: Flight,
    /// Receives the recorded readings of a live run; `None` for a simulation.
    feed: Option<Feed>,
}

impl Flown {
    pub(crate) fn of(flight: Flight, scenario: &Scenario, vehicle: Option<&VehicleInfo>) -> Self {
        let Some(info) = vehicle else { return Self { flight, feed: None } };
        let (feed, vehicle) = recorded();
        let flight = flight.with_vehicle(scenario, Box::new(vehicle), info.clone());
        Self { flight, feed: Some(feed) }
    }

    pub(crate) fn is_live(&self) -> bool {
        self.feed.is_some()
    }

    pub(crate) fn opened(&self) -> Event {
        self.flight.opened()
    }

    /// Runs the tick that is recorded next.
    pub(crate) fn tick(&mut self, recorded: &RecordedTick, answers: &mut impl Answers) -> Vec<Event> {
        self.feed.iter().for_each(|feed| feed.begin_tick(recorded.events()));
        self.flight.tick(&recorded.orders(), answers)
    }

    /// The readings of the last tick.
    pub(crate) fn readings(&self) -> &Readings {
        self.flight.readings()
    }
}
