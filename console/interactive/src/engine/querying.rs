//! Answers queries about the mission on separate threads, so that the engine can stop the robot meanwhile.

use super::{EngineThread, newest::Turn};
use crate::inbox::RunOutbox;
use mission::{Event, EventKind, Mission, Phase};
use std::thread;
use tui::{Query, RunMsg};

impl EngineThread {
    /// Answers a query with the state of the mission at this moment; nothing changes. The way back of a robot that still brakes
    /// is searched for once the robot stands: from elsewhere, the order could have no way or another one.
    pub(super) fn query(&mut self, query: Query) {
        if query == Query::WayBack && self.flight.mission().is_braking() {
            self.deferred = Some(query);
            return;
        }
        let mission = self.flight.mission().clone();
        answer_aside(self.queries.begin(), self.screen.clone(), move || answer(&mission, query));
    }

    /// Answers a query that waited until the robot stands.
    pub(super) fn answer_deferred(&mut self) {
        let query = self.deferred.take_if(|_| !self.flight.mission().is_braking());
        // A robot that has been resumed meanwhile has no way back.
        if let Some(query) = query.filter(|_| matches!(self.flight.phase(), Phase::Held(_))) {
            self.query(query);
        }
    }

    /// Drops answers that the events of a tick have outdated: a new zone changes the cost of every other one.
    pub(super) fn outdate_queries(&self, events: &[Event]) {
        if events.iter().any(|event| matches!(event.kind, EventKind::ZoneDrawn { .. })) {
            self.queries.outdate();
        }
    }
}

/// Computes an answer on its own thread and sends it to the screen, unless it is outdated by then.
fn answer_aside(turn: Turn, screen: RunOutbox, answer: impl FnOnce() -> RunMsg + Send + 'static) {
    // If the thread cannot be started, the answer is left out, and the operator may ask again.
    let _ = thread::Builder::new().name("query".into()).spawn(move || {
        let message = answer();
        turn.give(|| {
            screen.send(message);
        });
    });
}

fn answer(mission: &Mission, query: Query) -> RunMsg {
    match query {
        Query::WayBack => RunMsg::WayBack(mission.way_back()),
        Query::ZoneCost(corners) => {
            let cost = mission.zone_cost(&corners);
            RunMsg::ZoneCost(corners, cost)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{engine::newest::Newest, inbox::inbox};
    use std::sync::mpsc;
    use tui::{Msg, RunId};

    fn way(why: &str) -> RunMsg {
        RunMsg::WayBack(Err(why.to_owned()))
    }

    #[test]
    fn an_answer_that_takes_long_delays_nothing() {
        let (outbox, inbox) = inbox();
        let screen = RunOutbox { run: RunId(1), outbox };
        let (go_on, waits) = mpsc::channel::<()>();
        let queries = Newest::default();
        answer_aside(queries.begin(), screen.clone(), move || {
            let _ = waits.recv();
            way("slow")
        });
        // The engine reaches this line although the answer is not ready.
        screen.send(way("something else"));
        assert_eq!(inbox.next(None), Some(Msg::Run(RunId(1), way("something else"))));
        drop(go_on);
        assert_eq!(inbox.next(None), Some(Msg::Run(RunId(1), way("slow"))));
    }
}
