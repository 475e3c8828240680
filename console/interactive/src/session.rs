//! The model with its connections; shared by the screen, scripts and the console that prints sentences.

use super::{
    desk::{DeskHandle, Request},
    history,
    inbox::Inbox,
    line::Current,
    typing,
};
use mission::Order;
use std::time::{Duration, Instant, SystemTime};
use tui::{Effect, Model, Msg, Times, is_typing, update};

/// The model with its connections to the engine and the desk.
pub(super) struct Session {
    pub model: Model,
    inbox: Inbox,
    engine: Current,
    desk: DeskHandle,
    began: Instant,
    /// The command line that was saved last; `None` if command lines are not saved.
    kept: Option<String>,
    /// The orders that the last message caused.
    sent: Vec<Order>,
}

impl Session {
    /// Creates a session that begins now.
    pub(super) fn new(model: Model, inbox: Inbox, (engine, desk): (Current, DeskHandle)) -> Self {
        Self { model, inbox, engine, desk, began: Instant::now(), kept: None, sent: Vec::new() }
    }

    /// Loads the command lines of earlier sessions, and saves those of this session.
    pub(super) fn remember(&mut self) {
        self.model.console.history = history::load();
        self.kept = Some(self.model.console.history.last().cloned().unwrap_or_default());
    }

    /// Takes the next message. Waits until the given time; if none is given, waits indefinitely.
    pub(super) fn next(&self, until: Option<Instant>) -> Option<Msg> {
        self.inbox.next(until)
    }

    /// The time at which the model next changes without a message, plus a millisecond. The extra millisecond makes sure
    /// that this time has passed when the caller wakes.
    pub(super) fn wakes_at(&self) -> Option<Instant> {
        let at_s = self.model.wakes_at_mono_s()?;
        Some(self.began + Duration::from_secs_f64(at_s.max(0.0)) + Duration::from_millis(1))
    }

    /// Sends the current time to the model.
    pub(super) fn update_time(&mut self) {
        let since_epoch = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
        let now =
            Times { mono_s: self.began.elapsed().as_secs_f64(), wall_unix_s: since_epoch.as_secs_f64() };
        update(&mut self.model, Msg::Time(now));
    }

    /// Takes a message and carries out its effects. Returns the effects that concern the terminal.
    pub(super) fn take(&mut self, msg: Msg) -> Vec<Effect> {
        let is_input = typing::is_input(&msg);
        let effects = update(&mut self.model, msg);
        if let (Some(kept), Some(line)) = (&mut self.kept, self.model.console.history.last())
            && kept != line
        {
            kept.clone_from(line);
            self.desk.request(Request::Remember(line.clone()));
        }
        if let Some(engine) = self.engine.get() {
            engine.report(self.model.live.may_move());
        }
        self.engine.typing.report(is_input, is_typing(&self.model));
        self.sent.clear();
        effects.into_iter().filter_map(|effect| self.carry_out(effect)).collect()
    }

    /// Waits until the orders sent so far have taken effect and are in the journal on disk, but not longer than `patience`.
    pub(super) fn settle(&self, patience: Duration) {
        if let Some(engine) = self.engine.get() {
            engine.settle(patience);
        }
    }

    /// The orders that the last message caused; a later message accepts or refuses them.
    pub(super) fn sent(&self) -> &[Order] {
        &self.sent
    }

    fn carry_out(&mut self, effect: Effect) -> Option<Effect> {
        match effect {
            Effect::Open { id, source, planner, speed } => {
                self.desk.request(Request::Open { id, source, planner, speed });
            }
            Effect::Replay { id, run } => self.desk.request(Request::Replay { id, run }),
            Effect::Transport(transport) => self.desk.request(Request::Transport(transport)),
            Effect::Check { needed_bytes } => self.desk.request(Request::Check { needed_bytes }),
            Effect::Compare(choice) => self.desk.request(Request::Compare(choice)),
            Effect::Forecast(choices) => self.desk.request(Request::Forecast(choices)),
            Effect::StopForecasting => self.desk.request(Request::StopForecasting),
            Effect::StopComparing => self.desk.request(Request::StopComparing),
            Effect::SavePreset { name, choice } => self.desk.request(Request::SavePreset { name, choice }),
            Effect::Combine(runs) => self.desk.request(Request::Combine(runs)),
            Effect::Survey => self.desk.request(Request::Survey),
            Effect::Look => self.desk.request(Request::Look),
            Effect::Glimpse(key) => self.desk.request(Request::Glimpse(key)),
            Effect::StopGlimpsing => self.desk.request(Request::StopGlimpsing),
            Effect::Do(job) => self.desk.request(Request::Do(job)),
            Effect::HandOver { file, page, overwrite } => {
                self.desk.request(Request::HandOver { file, page, overwrite });
            }
            Effect::Order(order) => {
                if let Some(engine) = self.engine.get() {
                    engine.order(order.clone());
                    self.sent.push(order);
                }
            }
            Effect::Ask(query) => {
                if let Some(engine) = self.engine.get() {
                    engine.ask(query);
                }
            }
            Effect::Speed(speed) => match self.engine.get() {
                Some(engine) => engine.speed(speed),
                None => self.desk.request(Request::Pace(speed)),
            },
            Effect::Redraw
            | Effect::Bell
            | Effect::Mouse(_)
            | Effect::Copy(_)
            | Effect::Suspend
            | Effect::Quit { .. } => {
                return Some(effect);
            }
        }
        None
    }
}

/// Whether the scenario or the home screen is open, or the scenario failed to open.
pub(super) fn is_open(model: &Model) -> bool {
    !model.live.is_opening && model.home.found.is_some()
}
