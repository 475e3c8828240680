//! The events of the current tick.

use crate::{
    ask::Said,
    event::{Event, EventKind},
};

/// The events of the current tick so far, in the order in which they are reported.
#[derive(Clone, Default)]
pub(super) struct Happened {
    events: Vec<EventKind>,
    /// Events from the answers of the planner in shadow; they are reported last, in whatever order the answers arrive.
    pub of_shadow: Vec<EventKind>,
    /// The end of the mission, reported after all other events of the tick.
    pub ending: Option<EventKind>,
}

impl Happened {
    pub(super) fn push(&mut self, kind: EventKind) {
        self.events.push(kind);
    }

    pub(super) fn extend(&mut self, kinds: impl IntoIterator<Item = EventKind>) {
        self.events.extend(kinds);
    }

    /// Passes on the drawings, figures and log messages that came with a planner's answer.
    pub(super) fn pass_on(&mut self, said: Said, planner: &str) {
        self.extend(said.into_events(planner));
    }

    /// Whether an event of this kind has happened, not counting the planner in shadow.
    pub(super) fn has(&self, is_kind: impl Fn(&EventKind) -> bool) -> bool {
        self.events.iter().any(is_kind)
    }

    /// The events of a tick that ends at this mission time, seconds.
    pub(super) fn report(&mut self, tick: u64, t_s: f64) -> Vec<Event> {
        // The capacity of the list is kept for the next tick.
        let happened = self.events.drain(..).chain(self.of_shadow.drain(..)).chain(self.ending.take());
        happened.map(|kind| Event { tick, t_s, kind }).collect()
    }
}

impl Said {
    /// The drawings, figures and log messages of a planner, as events.
    pub(super) fn into_events(self, planner: &str) -> impl Iterator<Item = EventKind> {
        let Self { drawings, scalars, logs } = self;
        let drawn = (!drawings.is_empty()).then_some(EventKind::Drawn { drawings });
        let figures = (!scalars.is_empty()).then_some(EventKind::Scalars { scalars });
        let logged =
            move |(level, message)| EventKind::PlannerLogged { planner: planner.to_owned(), level, message };
        drawn.into_iter().chain(figures).chain(logs.into_iter().map(logged))
    }
}
