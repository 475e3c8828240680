//! The drawing thread: takes messages, updates the model, carries out effects, and draws a frame when something has
//! changed.

use super::{
    backlog::{self, Line},
    measure::Measure,
    reading::Frames,
    session::Session,
    watch::SharedPlaces,
};
use crate::Drill;
use anyhow::Context;
use flight::failure::{COMPLETE, exit_code, mission_code};
use mission::EventKind;
use runs::{Closed, Kept};
use std::{
    io::Write,
    process::ExitCode,
    time::{Duration, Instant},
};
use tui::{
    Cache, Caps, Effect, Glyphs, Model, Msg, Redraw, ReplayMsg, RunMsg, Signal, ThemeName, redraw,
    terminal::TerminalGuard,
};

/// The largest number of messages taken before the next frame.
const BURST: usize = 256;
/// The longest time spent on these messages before the next frame.
const BURST_TIME: Duration = Duration::from_millis(5);
/// Maximum time for which a suspension waits until the hold is in the journal on disk.
const SETTLE: Duration = Duration::from_secs(1);
/// The shortest time between two frames that only show new values of a robot at rest.
const CALM_FRAME: Duration = Duration::from_secs(1);
/// The largest data rate for new values while the robot is at rest, in bytes per second.
const CALM_RATE: f64 = 200.0;
/// The longest time between two frames that show a robot at rest.
const LONGEST_CALM: Duration = Duration::from_secs(4);
/// The shortest time between two frames that answer keys.
const KEY_FRAME: Duration = Duration::from_millis(8);

/// The screen of an open console.
pub(super) struct Screen {
    terminal: TerminalGuard,
    session: Session,
    caps: Caps,
    drawn: Instant,
    frame_interval: Duration,
    /// The shortest time between the last frame and a frame that only shows new values of a robot at rest.
    calm_pause: Duration,
    line: Line,
    /// How soon a frame must be drawn.
    due: Redraw,
    cache: Cache,
    places: SharedPlaces,
    frames: Frames,
    /// Whether the operator is waiting for something that the next frame shows.
    answer_seen: bool,
    measure: Measure,
    drill: Option<Drill>,
}

/// The reason why the operator left the screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Left {
    /// The signal that asked to leave, if any.
    pub signal: Option<Signal>,
}

impl Screen {
    /// Takes over the terminal.
    pub(super) fn open(
        caps: Caps,
        mut session: Session,
        places: SharedPlaces,
        frames: Frames,
        drill: Option<Drill>,
    ) -> anyhow::Result<Self> {
        let mut terminal = TerminalGuard::enter(backlog::clock).context("taking over the terminal")?;
        terminal.take_mouse(session.model.ui.mouse).context("enabling the mouse")?;
        let (width, height) = crossterm::terminal::size().unwrap_or((80, 24));
        session.take(Msg::Resize { width, height });
        session.model.console.keys.spells_arrows = caps.glyphs == Glyphs::Ascii;
        Ok(Self {
            terminal,
            session,
            caps,
            drawn: Instant::now(),
            // A slow line gets fewer frames.
            frame_interval: Duration::from_millis(if caps.ssh { 100 } else { 33 }),
            calm_pause: CALM_FRAME,
            line: Line::new(caps.ssh),
            due: Redraw::Soon,
            cache: Cache::default(),
            places,
            frames,
            answer_seen: true,
            measure: Measure::since(Instant::now()),
            drill,
        })
    }

    /// The model, for a crash report.
    pub(super) fn model(&self) -> &Model {
        &self.session.model
    }

    /// Chooses the theme for the terminal's background: red, green and blue.
    pub(super) fn suit(&mut self, background: [u8; 3]) {
        self.session.model.ui.theme = ThemeName::on(background);
    }

    /// Runs until the operator leaves or a signal asks to leave.
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

    /// The shortest time between the last frame and the next; `None` if no frame is due.
    fn pause(&self) -> Option<Duration> {
        match self.due {
            Redraw::No => None,
            Redraw::Calm => Some(self.calm_pause.max(self.line.busy())),
            // On a slow line, an early answer would only wait behind the frame before.
            Redraw::Soon if self.answer_seen && !self.line.is_slow() => Some(KEY_FRAME),
            Redraw::Soon if self.answer_seen => Some(KEY_FRAME.max(self.line.busy())),
            Redraw::Soon => Some(self.frame_interval.max(self.line.busy())),
        }
    }

    /// Waits for a message, then takes all others that are waiting.
    fn take_burst(&mut self) -> anyhow::Result<Option<Left>> {
        let first = self.wait();
        // The time may have come at which the model changes without a message.
        let by_itself = self.session.model.wakes_at_mono_s();
        self.session.update_time();
        if by_itself.is_some_and(|at_s| at_s <= self.session.model.console.now.mono_s) {
            self.due = Redraw::Soon;
        }
        let began = Instant::now();
        if let Some(measured) = self.measure.report(began) {
            for effect in self.take(Msg::Measured(measured)) {
                self.carry_out(&effect)?;
            }
        }
        let until = Instant::now() + BURST_TIME;
        let mut next = first;
        for _ in 0..BURST {
            let Some(msg) = next else { break };
            self.answer_seen |= is_answer(&self.session.model, &msg);
            if matches!(msg, Msg::Signal(Signal::Continue)) {
                self.measure = Measure::since(Instant::now());
            }
            let due = redraw(&self.session.model, &msg);
            self.due = self.due.max(due);
            if due == Redraw::Soon {
                self.measure.arrived(&msg, began);
            }
            for effect in self.take(msg) {
                if let Some(left) = self.carry_out(&effect)? {
                    return Ok(Some(left));
                }
            }
            let now = Instant::now();
            if now >= until {
                return Ok(None);
            }
            next = self.session.next(Some(now));
        }
        self.settle()
    }

    /// Carries out the action of a pending key, now that no other key press is waiting.
    fn settle(&mut self) -> anyhow::Result<Option<Left>> {
        if !self.session.model.has_settled() {
            return Ok(None);
        }
        self.due = Redraw::Soon;
        for effect in self.take(Msg::Settled) {
            if let Some(left) = self.carry_out(&effect)? {
                return Ok(Some(left));
            }
        }
        Ok(None)
    }

    /// Takes a message. A measurement of the console is shown only if it raises or clears an alarm.
    fn take(&mut self, msg: Msg) -> Vec<Effect> {
        let alarms = |screen: &Self| screen.session.model.live.run.alarms.clone();
        let before = matches!(msg, Msg::Measured(_)).then(|| alarms(self));
        let effects = self.session.take(msg);
        if before.is_some_and(|before| before != alarms(self)) {
            self.due = Redraw::Soon;
        }
        effects
    }

    /// The next message, or `None` when it is time to draw; if no frame is due, waits indefinitely.
    fn wait(&self) -> Option<Msg> {
        let frame = self.pause().map(|pause| self.drawn + pause);
        self.session.next(frame.into_iter().chain(self.session.wakes_at()).min())
    }

    fn carry_out(&mut self, effect: &Effect) -> anyhow::Result<Option<Left>> {
        match effect {
            Effect::Redraw => {
                // The operator may redraw because the line is another one now; a slow one is noticed again.
                self.line = Line::new(self.caps.ssh);
                self.terminal.set_slow(None);
                self.terminal.redraw().context("drawing")?;
            }
            Effect::Bell => ring()?,
            Effect::Mouse(taken) => self.terminal.take_mouse(*taken).context("enabling the mouse")?,
            Effect::Copy(line) => self.terminal.copy(line).context("copying")?,
            Effect::Suspend => self.suspend()?,
            Effect::Quit { signal } => return Ok(Some(Left { signal: *signal })),
            // The session has already carried out all other effects.
            _ => {}
        }
        Ok(None)
    }

    /// Releases the terminal and stops the process until the shell continues it. The hold that was ordered before takes effect
    /// first, and is in the journal: while the process is stopped, nothing else would carry it out.
    fn suspend(&mut self) -> anyhow::Result<()> {
        self.session.settle(SETTLE);
        self.terminal.suspend();
        rustix::process::kill_process(rustix::process::getpid(), rustix::process::Signal::STOP)
            .context("stopping the process")?;
        self.terminal.resume().context("taking over the terminal again")?;
        // No frames were needed while the process was stopped.
        self.measure = Measure::since(Instant::now());
        self.due = Redraw::Soon;
        Ok(())
    }

    fn draw(&mut self) -> anyhow::Result<()> {
        let run = &self.session.model.live.run;
        let is_under_way = run.phase().may_move() && run.clock.tick > 5;
        let failing = self.drill == Some(Drill::PanicScreen) && is_under_way;
        assert!(!failing, "drill: the screen fails on purpose");
        let (model, caps, cache) = (&self.session.model, &self.caps, &mut self.cache);
        let sent =
            self.terminal.draw(|frame| tui::view_cached(model, caps, cache, frame)).context("drawing")?;
        // A frame that was delayed because the line was busy was not skipped.
        let interval = self.frame_interval.max(self.line.busy());
        let calm = Duration::from_secs_f64(sent.bytes as f64 / CALM_RATE);
        self.calm_pause = calm.clamp(CALM_FRAME, LONGEST_CALM);
        self.line.sent(sent, self.drawn.elapsed());
        self.terminal.set_slow(self.line.most_bytes());
        if model.ui.mouse {
            self.places.set(self.cache.places());
        }
        self.session.take(Msg::Drawn(self.frames.count()));
        let now = Instant::now();
        self.measure.drew(now, now - self.drawn, interval);
        let due = if self.terminal.is_behind() { Redraw::Soon } else { Redraw::No };
        (self.drawn, self.due, self.answer_seen) = (now, due, false);
        Ok(())
    }
}

/// Whether the operator is waiting to see this message: a key, a stop of the robot, or the result of seeking in a past
/// run.
fn is_answer(model: &Model, msg: &Msg) -> bool {
    match msg {
        Msg::Key(_) | Msg::Stop | Msg::Paste(_) | Msg::Mouse(_) | Msg::Resize { .. } | Msg::Signal(_) => true,
        Msg::Run(_, RunMsg::Events(events)) => {
            events.iter().any(|event| matches!(event.kind, EventKind::Held { .. }))
        }
        Msg::Run(_, RunMsg::Replay(ReplayMsg::At(..) | ReplayMsg::Moved(..))) => {
            model.live.replay.as_ref().is_some_and(|replay| !replay.is_playing)
        }
        _ => false,
    }
}

fn ring() -> anyhow::Result<()> {
    let mut out = std::io::stdout();
    out.write_all(b"\x07").and_then(|()| out.flush()).context("ringing the bell")
}

impl Left {
    /// Prints on the normal screen how the run ended; the exit code reports it to scripts.
    pub(super) fn report_end(self, closed: Option<&Closed>) -> ExitCode {
        let kept = closed.and_then(|closed| closed.kept.as_ref());
        // A closed terminal cannot show anything.
        if let Some(closed) = closed.filter(|_| self.signal != Some(Signal::Hangup)) {
            let columns = crossterm::terminal::size().map_or(80, |(columns, _)| usize::from(columns));
            let sentence = kept.map(Kept::text);
            let name = kept.filter(|kept| kept.problem().is_none()).map(Kept::name);
            let text = report::human::short(&closed.summary, sentence.as_deref(), name.as_deref(), columns);
            let _ = report::print::say(&text);
        }
        if let Some(signal) = self.signal {
            return ExitCode::from(128 + number(signal));
        }
        let flown = closed.map(|closed| &closed.summary).filter(|summary| summary.outcome.is_some());
        let code = flown.map_or(COMPLETE, mission_code);
        ExitCode::from(exit_code(code, kept))
    }
}

fn number(signal: Signal) -> u8 {
    let number = match signal {
        Signal::Interrupt => signal_hook::consts::SIGINT,
        Signal::Terminate => signal_hook::consts::SIGTERM,
        Signal::Hangup => signal_hook::consts::SIGHUP,
        Signal::End(number) => number,
        Signal::Stop => signal_hook::consts::SIGTSTP,
        Signal::Continue => signal_hook::consts::SIGCONT,
    };
    number.unsigned_abs() as u8
}
