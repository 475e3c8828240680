//! Console commands from a file: the same model, rules and engine, but no terminal.
//!
//! ```text
//! # one a line
//! speed max
//! start
//! key enter
//! wait until phase ended within 2m
//! assert coverage >= 95
//! picture result.svg
//! ```

mod answers;
mod condition;
mod read;

use super::{
    foreground::Foreground,
    inbox::Outbox,
    line::Current,
    session::{Session, is_open},
    watch,
};
use answers::Answers;
use anyhow::Context;
use condition::Condition;
use flight::{
    failure::{COMPLETE, ENDED_OTHERWISE, bad_input},
    texts,
};
use mission::{Order, Readiness, Severity};
use ratatui::{Terminal, backend::TestBackend};
use report::print::warn_line;
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
    time::{Duration, Instant},
};
use tui::{
    Caps, Colours, Effect, Glyphs, Key, Model, Msg, Signal,
    actions::{ActionId, context::contexts, find, keymap::Keymap},
};

/// The initial columns and rows of the screen; `size` changes them.
const SIZE: (u16, u16) = (120, 36);
/// The interval at which a condition is rechecked even if no message arrives.
const LOOK_AGAIN: Duration = Duration::from_millis(50);
/// The longest wait for the scenario to open.
const OPENING: Duration = Duration::from_secs(30);
/// The longest wait for the mission to accept an order; the mission answers in the next tick, at any speed.
const ANSWERING: Duration = Duration::from_secs(30);

/// A step of a script.
#[derive(Debug, Clone, PartialEq)]
enum Step {
    /// Run a console command.
    Command(String),
    /// Press a key.
    Key(Key),
    /// Wait for a condition, at most for this many seconds of wall time.
    Wait(Condition, f64),
    /// Require a condition.
    Assert(Condition),
    /// Set the columns and rows of the screen.
    Size((u16, u16)),
    /// Write the screen to a file as a picture.
    Picture(PathBuf),
}

/// A parsed script.
#[derive(Debug)]
pub(super) struct Script {
    file: PathBuf,
    /// The steps with their line numbers.
    steps: Vec<(usize, Step)>,
}

impl Script {
    /// Reads a script.
    ///
    /// # Errors
    /// The file cannot be read, or lines are invalid; all of these are listed with their numbers.
    pub(super) fn read(file: &Path, keys: &Keymap) -> anyhow::Result<Self> {
        let shown = file.display();
        let text = texts::read(file)?;
        let steps = read::steps(&text, keys).map_err(|wrong| {
            let lines = wrong.iter().map(|(line, what)| format!("{shown}:{line}: {what}"));
            bad_input(lines.collect::<Vec<_>>().join("\n"))
        })?;
        Ok(Self { file: file.to_owned(), steps })
    }

    /// Runs the script; the inner error states the line that failed, and why.
    ///
    /// # Errors
    /// The signal thread cannot be started.
    pub(super) fn run(
        self,
        session: Session,
        outbox: &Outbox,
        engine: &Current,
    ) -> anyhow::Result<Result<(), String>> {
        watch::signals(outbox, engine.clone(), Foreground::new())?;
        let mut session = session;
        // A script decides about a better plan without reading it.
        session.model.console.preferences.slows_for_offers = false;
        let mut runner = Runner { session, answers: Answers::default(), is_left: false };
        runner.session.take(Msg::Resize { width: SIZE.0, height: SIZE.1 });
        Ok(runner.carry_out(&self))
    }
}

/// Reports the result of a script; returns the exit code.
pub(super) fn report(done: Result<(), String>) -> ExitCode {
    match done {
        Ok(()) => ExitCode::from(COMPLETE),
        Err(why) => {
            warn_line(&why);
            ExitCode::from(ENDED_OTHERWISE)
        }
    }
}

struct Runner {
    session: Session,
    answers: Answers,
    is_left: bool,
}

impl Runner {
    fn carry_out(&mut self, script: &Script) -> Result<(), String> {
        // Accept commands only once the scenario is open, because an operator would also wait to see the screen.
        self.hear_until(OPENING, is_open)?;
        for (line, step) in &script.steps {
            let done = self.step(step);
            done.map_err(|why| format!("{}:{line}: {why}", script.file.display()))?;
        }
        Ok(())
    }

    fn step(&mut self, step: &Step) -> Result<(), String> {
        if self.is_left {
            return Err("an earlier line closed the console".into());
        }
        match step {
            Step::Size((width, height)) => self.take(Msg::Resize { width: *width, height: *height }),
            Step::Picture(file) => {
                let screen =
                    drawn(&self.session.model, Colours::True).map_err(|error| format!("{error:#}"))?;
                let picture = tui::picture::svg(screen.backend().buffer());
                std::fs::write(file, picture).map_err(|error| format!("{}: {error}", file.display()))
            }
            Step::Command(line) => {
                self.see_opened()?;
                let first = line.split(' ').next().unwrap_or_default();
                let action = find::named(first).map(|action| action.id);
                self.see_plan(action)?;
                self.see_question(action)?;
                self.order(Msg::Line(line.clone()))
            }
            Step::Key(key) => {
                self.see_opened()?;
                let model = &self.session.model;
                let action = find::action_for(&model.console.keys, *key, &contexts(model));
                let action = action.map(|action| action.id);
                self.see_plan(action)?;
                self.see_question(action)?;
                self.order(Msg::Key((*key).into()))
            }
            Step::Wait(condition, within_s) => {
                let within = Duration::from_secs_f64(*within_s);
                if self.hear_until(within, |model| condition.holds(model, screen))? {
                    return Ok(());
                }
                let model = &self.session.model;
                let is_paused = model.live.replay.as_ref().is_some_and(|replay| !replay.is_playing);
                let paused =
                    if is_paused { "; the replay is paused: write `play` before this line" } else { "" };
                Err(format!(
                    "timed out after {within_s} s waiting for: {condition}; {}{paused}",
                    condition.instead(model)
                ))
            }
            Step::Assert(condition) if condition.holds(&self.session.model, screen) => Ok(()),
            Step::Assert(condition) => {
                Err(format!("assertion failed: {condition}; {}", condition.instead(&self.session.model)))
            }
        }
    }

    /// Waits for a scenario or a re-scan that is being opened, as an operator would. Reading the journals of long runs
    /// takes time, and an order given meanwhile would be lost.
    fn see_opened(&mut self) -> Result<(), String> {
        while self.session.model.live.is_opening && !self.is_left {
            self.hear_until(LOOK_AGAIN, |model| !model.live.is_opening)?;
        }
        Ok(())
    }

    /// Waits until it is known whether a real vehicle stands still, or why it cannot be driven. The link has its own time
    /// limits for both.
    fn see_standstill(&mut self) -> Result<(), String> {
        let is_open = |model: &Model| {
            let run = &model.live.run;
            let is_known = run
                .vehicle
                .as_ref()
                .is_some_and(|seen| seen.stands.is_some() || seen.link.trouble().is_some());
            model.live.waits() && run.is_live() && !is_known
        };
        while is_open(&self.session.model) && !self.is_left {
            self.hear_until(LOOK_AGAIN, |model| !is_open(model))?;
        }
        Ok(())
    }

    /// Waits for the plan before a start, as an operator would. The planner has its own time limit for planning.
    fn see_plan(&mut self, action: Option<ActionId>) -> Result<(), String> {
        if action != Some(ActionId::Start) {
            return Ok(());
        }
        let readiness = |model: &Model| match model.live.run.standing.standing().readiness {
            Readiness::NoPlan => Some(false),
            Readiness::Preparing => Some(true),
            Readiness::Unseen | Readiness::Failed(_) | Readiness::Plan(_) => None,
        };
        self.see_standstill()?;
        // A plan is requested when the scenario opens.
        self.hear_until(ANSWERING, |model| !model.live.waits() || readiness(model) != Some(false))?;
        let is_planning = |model: &Model| model.live.waits() && readiness(model) == Some(true);
        while is_planning(&self.session.model) && !self.is_left {
            self.hear_until(LOOK_AGAIN, |model| !is_planning(model))?;
        }
        Ok(())
    }

    /// Waits for the figures of an open question, as an operator would before an answer. HOLD does not wait.
    fn see_question(&mut self, action: Option<ActionId>) -> Result<(), String> {
        if action != Some(ActionId::Hold) {
            self.hear_until(ANSWERING, |model| !model.awaits_figures())?;
        }
        Ok(())
    }

    /// Sends a command or a key to the console; a refusal by the console or the mission counts as a failure.
    fn order(&mut self, msg: Msg) -> Result<(), String> {
        self.hear_until(Duration::ZERO, |_| false)?;
        self.session.model.console.notice = None;
        self.answers = Answers::default();
        let given = match &msg {
            Msg::Line(line) => line.clone(),
            Msg::Key(press) => format!("key {}", press.key.name()),
            other => format!("{other:?}"),
        };
        self.take(msg)?;
        self.accepted()?;
        if self.session.model.live.preflight.is_starting {
            self.hear_until(ANSWERING, |model| !model.live.preflight.is_starting)?;
            self.accepted()?;
        }
        if self.session.model.is_pricing_zone() {
            self.hear_until(ANSWERING, |model| !model.is_pricing_zone())?;
            self.accepted()?;
        }
        let end = Instant::now() + ANSWERING;
        while self.answers.is_waiting() && !self.is_left {
            let next = self.session.next(Some(end));
            let next = next.ok_or_else(|| format!("timed out: the mission did not acknowledge `{given}`"))?;
            self.session.update_time();
            self.take(next)?;
        }
        self.answers.refusal().map_or(Ok(()), |why| Err(format!("order refused: {why}")))
    }

    /// Checks whether the console has accepted the last input.
    fn accepted(&self) -> Result<(), String> {
        let model = &self.session.model;
        if let tui::model::Overlay::Commands(palette) = &model.ui.overlay
            && let Some(fault) = &palette.fault
        {
            return Err(fault.what.clone());
        }
        match model.notice() {
            Some(notice) if notice.severity >= Severity::Watch => Err(notice.text.clone()),
            _ => Ok(()),
        }
    }

    /// Takes messages until a condition holds or the time is up; returns whether the condition holds.
    fn hear_until(&mut self, within: Duration, holds: impl Fn(&Model) -> bool) -> Result<bool, String> {
        let end = Instant::now() + within;
        loop {
            self.session.update_time();
            let look_again = Instant::now() + LOOK_AGAIN;
            while let Some(msg) = self.session.next(Some(Instant::now())) {
                self.take(msg)?;
                if Instant::now() >= look_again {
                    break;
                }
            }
            if holds(&self.session.model) {
                return Ok(true);
            }
            if Instant::now() >= end || self.is_left {
                return Ok(false);
            }
            if let Some(msg) = self.session.next(Some(end.min(look_again))) {
                self.take(msg)?;
            }
        }
    }

    fn take(&mut self, msg: Msg) -> Result<(), String> {
        if let Msg::Signal(
            signal @ (Signal::Interrupt | Signal::Terminate | Signal::Hangup | Signal::End(_)),
        ) = msg
        {
            return Err(format!("interrupted ({signal})"));
        }
        self.answers.hear(&msg);
        let effects = self.session.take(msg);
        // If the robot is already held for good, HOLD changes nothing and gets no answer.
        let may_move = self.session.model.live.may_move();
        let sent = self.session.sent().iter().filter(|order| may_move || **order != Order::Hold);
        self.answers.await_for(sent);
        self.is_left |= effects.iter().any(|effect| matches!(effect, Effect::Quit { .. }));
        Ok(())
    }
}

/// The text of the screen.
fn screen(model: &Model) -> anyhow::Result<String> {
    Ok(drawn(model, Colours::None)?.backend().to_string())
}

/// The screen, drawn in memory.
fn drawn(model: &Model, colours: Colours) -> anyhow::Result<Terminal<TestBackend>> {
    let caps = Caps { colours, glyphs: Glyphs::Braille, ssh: false };
    let mut terminal = Terminal::new(TestBackend::new(model.ui.width, model.ui.height)).context("drawing")?;
    terminal.draw(|frame| tui::view(model, &caps, frame)).context("drawing")?;
    Ok(terminal)
}
