//! Keeps the run on disk, and reports the health of its recording to the screen.

use super::EngineThread;
use crate::pace::Reached;
use account::Stops;
use flight::{hosts, remains};
use mission::Event;
use runs::{CLOSE_TIMEOUT, Closed, Kept, RunLog};
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};
use tui::{Health, Recording, RunMsg, RunResult};

/// The interval at which the screen receives the recorder's health. Together with the recorder's own check of its
/// files, this interval lets the operator learn within a second if the run is not being recorded.
pub(super) const HEALTH_PERIOD: Duration = Duration::from_millis(400);

impl EngineThread {
    pub(super) fn open_log(&mut self) -> anyhow::Result<()> {
        let mut log = RunLog::create(
            &self.logs,
            &self.scenario.name,
            self.flight.mission().planner_id(),
            self.scenario.seed,
        )?;
        log.sync()?;
        self.log = Some(log);
        self.health_sent_at = Instant::now();
        self.reached = Reached::since(self.health_sent_at);
        self.keep(&[self.flight.opened()]);
        let early = std::mem::take(&mut self.early);
        self.keep(&early);
        Ok(())
    }

    pub(super) fn keep(&mut self, events: &[Event]) {
        match &mut self.log {
            Some(log) => log.keep(events),
            None if self.closed.is_none() => self.early.extend_from_slice(events),
            None => {}
        }
    }

    /// Answers when the journal has been handed to the system; at once if nothing is recorded.
    pub(super) fn settle(&self, answer: Sender<()>) {
        match &self.log {
            Some(log) => log.flush(answer),
            // The screen may have stopped waiting.
            None => drop(answer.send(())),
        }
    }

    pub(super) fn send_health(&mut self) {
        let Some(log) = &self.log else { return };
        let now = Instant::now();
        if now.saturating_duration_since(self.health_sent_at) < HEALTH_PERIOD {
            return;
        }
        self.health_sent_at = now;
        let health = log.health();
        let recording = health.error.map_or(Recording::On, Recording::Failed);
        let reached = self.reached.take(now, self.flight.tick_length());
        // While the mission waits, its measured speed does not show how fast the mission will continue.
        let reached_speed = (!self.waits()).then_some(reached);
        self.send(RunMsg::Health(Health { recording, reached_speed, recorder_lag: health.lag }));
    }

    /// Closes the journal and the recording, and writes the report.
    pub(super) fn close_log(&mut self, within: Duration) {
        if self.log.is_none() {
            return;
        }
        if within == CLOSE_TIMEOUT {
            self.host.finish();
        }
        let last = remains::keep(&mut self.host, self.log.as_mut(), self.now);
        self.send(RunMsg::Events(last));
        let Some(log) = self.log.take() else { return };
        let (calls, stops) = (hosts::calls(&self.host), Stops::of(&self.stops_ms));
        let closed = log.close(within, calls, stops, &self.scenario.expect);
        let problem = closed.kept.as_ref().and_then(Kept::problem);
        let result = result(&closed);
        self.closed = Some(closed);
        let recording = problem.map_or(Recording::Off, Recording::Failed);
        self.send(RunMsg::Health(Health { recording, ..Health::default() }));
        self.send(RunMsg::Closed(Box::new(result)));
    }
}

/// The result of a closed run for the screen.
fn result(closed: &Closed) -> RunResult {
    RunResult {
        summary: Box::new(closed.summary.clone()),
        name: closed.kept.as_ref().map(Kept::name),
        kept: closed.kept.as_ref().map_or_else(|| "not recorded".to_owned(), Kept::text),
        is_kept: closed.kept.as_ref().is_some_and(|kept| kept.problem().is_none()),
    }
}
