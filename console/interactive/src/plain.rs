//! The console in sentences: changes go to stdout, and commands come from stdin.

use super::{
    foreground::Foreground,
    inbox::Outbox,
    line::Current,
    screen::Left,
    session::{Session, is_open},
    watch,
};
use anyhow::Context;
use report::print::say_line;
use std::{
    io::BufRead,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
};
use tui::{
    Effect, Key, Model, Msg, Signal,
    plain::{Said, help, no_question, status},
};

/// The words that the plain console accepts besides the commands of the console.
const STATUS: &str = "status";
const HELP: [&str; 2] = ["help", ":help"];
const YES: &str = "yes";
const NO: &str = "no";

/// Prints sentences until the operator leaves. The end of stdin holds the robot, ends the mission and leaves the
/// console.
///
/// # Errors
/// A thread cannot be started, or stdout cannot be written to.
pub(super) fn speak(mut session: Session, outbox: &Outbox, engine: &Current) -> anyhow::Result<Left> {
    watch::signals(outbox, engine.clone(), Foreground::new())?;
    let is_over = Arc::new(AtomicBool::new(false));
    let mut is_listening = false;
    let mut said = Said::default();
    session.model.console.keys.spells_commands = true;
    loop {
        // Accept commands only once the scenario is open, because an operator would also wait to see the screen.
        if !is_listening && is_open(&session.model) {
            listen(outbox, Arc::clone(&is_over))?;
            is_listening = true;
        }
        for line in said.next(&session.model) {
            say_line(&line)?;
        }
        let msg = session.next(session.wakes_at());
        session.update_time();
        let Some(msg) = msg else { continue };
        let effects = match answered(&session.model, &msg) {
            Some(lines) => {
                lines.iter().try_for_each(|line| say_line(line))?;
                continue;
            }
            None => session.take(pressed(msg)),
        };
        if let Some(fault) = fault(&session.model) {
            say_line(&fault)?;
            session.take(Msg::Key(Key::Esc.into()));
        }
        for effect in effects {
            if let Effect::Quit { signal } = effect {
                return Ok(Left { signal: signal.filter(|_| !is_over.load(Ordering::Relaxed)) });
            }
        }
    }
}

/// The answer to `status` or `help`, which only print text; `None` for any other message.
fn answered(model: &Model, msg: &Msg) -> Option<Vec<String>> {
    match msg {
        Msg::Line(line) if line == STATUS => Some(status(model)),
        Msg::Line(line) if HELP.contains(&line.as_str()) => Some(help(model)),
        Msg::Line(line) if line == YES || line == NO => Some(vec![no_question(model)?.to_owned()]),
        _ => None,
    }
}

/// Converts `yes` or `no` to the key press that it stands for.
fn pressed(msg: Msg) -> Msg {
    match msg {
        Msg::Line(line) if line == YES => Msg::Key(Key::Enter.into()),
        Msg::Line(line) if line == NO => Msg::Key(Key::Esc.into()),
        msg => msg,
    }
}

/// The fault in the last command.
fn fault(model: &Model) -> Option<String> {
    let tui::model::Overlay::Commands(palette) = &model.ui.overlay else { return None };
    palette.fault.as_ref().map(|fault| format!("Refused: {}.", fault.what))
}

/// Reads commands from stdin: `yes` and `no` answer a question, `status` prints the state, `help`
/// prints the commands, `key NAME` presses a key, and
/// everything else is a command line. `is_over` becomes true at the end of stdin.
fn listen(outbox: &Outbox, is_over: Arc<AtomicBool>) -> anyhow::Result<()> {
    let outbox = outbox.clone();
    let began = thread::Builder::new().name("stdin".into()).spawn(move || {
        for line in std::io::stdin().lock().split(b'\n').map_while(Result::ok) {
            // A line that is not valid text is refused as an unknown command; later lines are still carried out.
            let msg = match String::from_utf8_lossy(&line).trim() {
                "" => continue,
                line => match line.strip_prefix("key ").and_then(|name| Key::named(name.trim())) {
                    Some(key) => Msg::Key(key.into()),
                    None => Msg::Line(line.to_owned()),
                },
            };
            if !outbox.send_urgent(msg) {
                return;
            }
        }
        is_over.store(true, Ordering::Relaxed);
        outbox.send_urgent(Msg::Signal(Signal::Hangup));
    });
    began.map(drop).context("starting the stdin thread")
}
