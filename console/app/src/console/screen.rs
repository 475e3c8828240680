//! The drawing thread: messages in, model updated, effects carried out, a frame when something changed.

use super::{
    desk::{DeskHandle, Request},
    inbox::Inbox,
    line::Current,
    measure::Measure,
    watch::SharedPlaces,
};
use crate::{
    cli::Drill,
    failure::{COMPLETE, ENDED_OTHERWISE, exit_code},
};
use anyhow::Context;
use mission::{EventKind, Outcome};
use runs::Closed;
use std::{
    io::Write,
    process::ExitCode,
    time::{Duration, Instant, SystemTime},
};
use tui::{
    Cache, Caps, Effect, Model, Msg, Redraw, RunMsg, Signal, Times, redraw, terminal::TerminalGuard, update,
};

/// Messages that are taken in before the next frame, at most.
const BURST: usize = 256;
/// Time that is spent on them before the next frame, at most.
const BURST_TIME: Duration = Duration::from_millis(5);
/// Shortest time between two frames that only show new values of a robot that stands still.
const CALM_FRAME: Duration = Duration::from_secs(1);
/// Shortest time between two frames that answer keys.
const KEY_FRAME: Duration = Duration::from_millis(8);

/// The screen while the console is open.
pub(super) struct Screen {
    terminal: TerminalGuard,
    model: Model,
    caps: Caps,
    inbox: Inbox,
    engine: Current,
    desk: DeskHandle,
    began: Instant,
    drawn: Instant,
    frame_interval: Duration,
    /// How soon there is to be a frame.
    due: Redraw,
    cache: Cache,
    places: SharedPlaces,
    /// Whether the operator waits for something that the next frame shows.
    answer_seen: bool,
    measure: Measure,
    drill: Option<Drill>,
}

/// Why the screen was left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Left {
    /// The signal that asked for it, if one did.
    pub signal: Option<Signal>,
}

impl Screen {
    /// Takes the terminal over.
    pub(super) fn open(
        caps: Caps,
        mut model: Model,
        inbox: Inbox,
        (engine, desk): (Current, DeskHandle),
        places: SharedPlaces,
        drill: Option<Drill>,
    ) -> anyhow::Result<Self> {
        let mut terminal = TerminalGuard::enter().context("taking over the terminal")?;
        terminal.take_mouse(model.ui.mouse).context("taking the mouse")?;
        let (width, height) = crossterm::terminal::size().unwrap_or((80, 24));
        update(&mut model, Msg::Resize { width, height });
        let now = Instant::now();
        Ok(Self {
            terminal,
            model,
            caps,
            inbox,
            engine,
            desk,
            began: now,
            drawn: now,
            // A slow line gets fewer frames.
            frame_interval: Duration::from_millis(if caps.ssh { 100 } else { 33 }),
            due: Redraw::Soon,
            cache: Cache::default(),
            places,
            answer_seen: true,
            measure: Measure::since(now),
            drill,
        })
    }

    /// What the screen knows, for a crash report.
    pub(super) fn model(&self) -> &Model {
        &self.model
    }

    /// Runs until the operator or a signal wants to leave.
    pub(super) fn run(&mut self) -> anyhow::Result<Left> {
        loop {
            if let Some(left) = self.take_burst()? {
                return Ok(left);
            }
            if self.pause().is_some_and(|pause| self.drawn.elapsed() >= pause) {
                self.draw()?;
            }
        }
    }

    /// Shortest time between the last frame and the next; `None` if none is due.
    fn pause(&self) -> Option<Duration> {
        match self.due {
            Redraw::No => None,
            Redraw::Calm => Some(CALM_FRAME),
            Redraw::Soon if self.answer_seen => Some(KEY_FRAME),
            Redraw::Soon => Some(self.frame_interval),
        }
    }

    /// Waits for a message, then takes in what else is there.
    fn take_burst(&mut self) -> anyhow::Result<Option<Left>> {
        let first = self.wait();
        // What the screen waited for may be that it changes by itself.
        let by_itself = self.model.wakes_at_mono_s();
        self.update_time();
        if by_itself.is_some_and(|at_s| at_s <= self.model.console.now.mono_s) {
            self.due = Redraw::Soon;
        }
        let began = Instant::now();
        if let Some(measured) = self.measure.report(began) {
            update(&mut self.model, Msg::Measured(measured));
        }
        let until = Instant::now() + BURST_TIME;
        let mut next = first;
        for _ in 0..BURST {
            let Some(msg) = next else { break };
            self.answer_seen |= is_answer(&msg);
            let due = redraw(&self.model, &msg);
            self.due = self.due.max(due);
            if due == Redraw::Soon {
                self.measure.arrived(&msg, began);
            }
            let effects = update(&mut self.model, msg);
            let engine = self.engine.get();
            if let Some(engine) = &engine {
                engine.set_may_move(self.model.live.may_move());
            }
            for effect in effects {
                if let Some(left) = self.carry_out(effect)? {
                    return Ok(Some(left));
                }
            }
            let now = Instant::now();
            next = if now < until { self.inbox.next(Some(now)) } else { None };
        }
        Ok(None)
    }

    /// The next message, or `None` when it is time to draw; with nothing due it sleeps for as long as it takes.
    fn wait(&self) -> Option<Msg> {
        let frame = self.pause().map(|pause| self.drawn + pause);
        let by_itself =
            self.model.wakes_at_mono_s().map(|at_s| self.began + Duration::from_secs_f64(at_s.max(0.0)));
        // By itself the screen changes a little after the moment, so that the moment has passed then.
        let by_itself = by_itself.map(|at| at + Duration::from_millis(1));
        self.inbox.next(frame.into_iter().chain(by_itself).min())
    }

    fn update_time(&mut self) {
        let since_epoch = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
        let now =
            Times { mono_s: self.began.elapsed().as_secs_f64(), wall_unix_s: since_epoch.as_secs_f64() };
        update(&mut self.model, Msg::Time(now));
    }

    fn carry_out(&mut self, effect: Effect) -> anyhow::Result<Option<Left>> {
        match effect {
            Effect::Open { id, source, planner } => self.desk.request(Request::Open { id, source, planner }),
            Effect::Check { needed_bytes } => self.desk.request(Request::Check { needed_bytes }),
            Effect::Compare(choice) => self.desk.request(Request::Compare(choice)),
            Effect::Forecast(choices) => self.desk.request(Request::Forecast(choices)),
            Effect::StopForecasting => self.desk.request(Request::StopForecasting),
            Effect::StopComparing => self.desk.request(Request::StopComparing),
            Effect::Survey => self.desk.request(Request::Survey),
            Effect::Look => self.desk.request(Request::Look),
            Effect::Do(job) => self.desk.request(Request::Do(job)),
            Effect::Order(order) => {
                self.engine.get().into_iter().for_each(|engine| engine.order(order.clone()))
            }
            Effect::Speed(speed) => self.engine.get().into_iter().for_each(|engine| engine.speed(speed)),
            Effect::Redraw => self.terminal.redraw().context("drawing")?,
            Effect::Bell => ring()?,
            Effect::Mouse(taken) => self.terminal.take_mouse(taken).context("taking the mouse")?,
            Effect::Copy(line) => self.terminal.copy(&line).context("copying")?,
            Effect::Suspend => self.suspend()?,
            Effect::Quit { signal } => return Ok(Some(Left { signal })),
        }
        Ok(None)
    }

    /// Gives the terminal back and stops the process until the shell continues it.
    fn suspend(&mut self) -> anyhow::Result<()> {
        self.terminal.suspend();
        rustix::process::kill_process(rustix::process::getpid(), rustix::process::Signal::STOP)
            .context("stopping the process")?;
        self.terminal.resume().context("taking the terminal over again")?;
        self.due = Redraw::Soon;
        Ok(())
    }

    fn draw(&mut self) -> anyhow::Result<()> {
        let failing = self.drill == Some(Drill::PanicScreen) && self.model.live.run.clock.tick > 5;
        assert!(!failing, "drill: the screen fails on purpose");
        let (model, caps, cache) = (&self.model, &self.caps, &mut self.cache);
        self.terminal.draw(|frame| tui::view_cached(model, caps, cache, frame)).context("drawing")?;
        if model.ui.mouse {
            self.places.set(self.cache.places());
        }
        let now = Instant::now();
        self.measure.drew(now, now - self.drawn, self.frame_interval);
        (self.drawn, self.due, self.answer_seen) = (now, Redraw::No, false);
        Ok(())
    }
}

/// Whether an operator waits to see this: a key, or that the robot was stopped.
fn is_answer(msg: &Msg) -> bool {
    match msg {
        Msg::Key(_) | Msg::Paste(_) | Msg::Mouse(_) | Msg::Resize { .. } | Msg::Signal(_) => true,
        Msg::Run(_, RunMsg::Events(events)) => {
            events.iter().any(|event| matches!(event.kind, EventKind::Held { .. }))
        }
        _ => false,
    }
}

fn ring() -> anyhow::Result<()> {
    let mut out = std::io::stdout();
    out.write_all(b"\x07").and_then(|()| out.flush()).context("ringing the bell")
}

impl Left {
    /// Reports on the normal screen how the run ended; the exit code reports it to scripts.
    pub(super) fn report_end(self, closed: Option<&Closed>) -> ExitCode {
        let kept = closed.and_then(|closed| closed.kept.as_ref());
        // A terminal that was closed shows nothing.
        if let Some(closed) = closed.filter(|_| self.signal != Some(Signal::Hangup)) {
            let line = kept.map(|kept| kept.text() + "\n").unwrap_or_default();
            let text = report::human(&closed.summary) + &line;
            let _ = std::io::stdout().write_all(text.as_bytes());
        }
        if let Some(signal) = self.signal {
            return ExitCode::from(128 + number(signal));
        }
        let code = match closed.and_then(|closed| closed.summary.outcome) {
            None | Some(Outcome::Complete) => COMPLETE,
            Some(_) => ENDED_OTHERWISE,
        };
        ExitCode::from(exit_code(code, kept))
    }
}

fn number(signal: Signal) -> u8 {
    let number = match signal {
        Signal::Interrupt => signal_hook::consts::SIGINT,
        Signal::Terminate => signal_hook::consts::SIGTERM,
        Signal::Hangup => signal_hook::consts::SIGHUP,
        Signal::Stop => signal_hook::consts::SIGTSTP,
        Signal::Continue => signal_hook::consts::SIGCONT,
    };
    number.unsigned_abs() as u8
}
