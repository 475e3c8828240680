//! The threads that only listen: keys, signals, a terminal that goes away, the survey of planners.

use super::{engine::Line, inbox::Outbox};
use anyhow::Context;
use crossterm::event::{self, Event};
use mission::Order;
use planner_host::PluginDirs;
use rustix::event::{PollFd, PollFlags, poll};
use signal_hook::{
    consts::{SIGCONT, SIGHUP, SIGINT, SIGTERM, SIGTSTP},
    iterator::Signals,
};
use std::{thread, time::Duration};
use tui::{Key, Msg, Refused, Signal, terminal};

/// How long the console may take to leave in good order after a signal; then it leaves anyway.
const GRACE: Duration = Duration::from_secs(1);

/// Keys, pastes and sizes. A key that stops the robot does so from here, whatever the screen is doing.
pub fn keys(tell: &Outbox, line: Line) -> anyhow::Result<()> {
    let tell = tell.clone();
    spawn("keys", move || {
        while let Ok(event) = event::read() {
            let msg = match event {
                Event::Key(key) => terminal::key_from_crossterm(&key).map(Msg::Key),
                Event::Paste(text) => Some(Msg::Paste(text)),
                Event::Resize(width, height) => Some(Msg::Resize { width, height }),
                Event::FocusGained | Event::FocusLost | Event::Mouse(_) => None,
            };
            let Some(msg) = msg else { continue };
            let stops = is_stop_key(&msg);
            if !tell_and_stop(&tell, &line, msg, stops) {
                return;
            }
        }
    })
}

/// Signals; one that ends the process ends it within [`GRACE`], whatever the other threads do.
pub fn signals(tell: &Outbox, line: Line) -> anyhow::Result<()> {
    let tell = tell.clone();
    let mut signals =
        Signals::new([SIGINT, SIGTERM, SIGHUP, SIGTSTP, SIGCONT]).context("listening to signals")?;
    spawn("signals", move || {
        for number in signals.forever() {
            let signal = match number {
                SIGTERM => Signal::Terminate,
                SIGHUP => Signal::Hangup,
                SIGTSTP => Signal::Stop,
                SIGCONT => Signal::Continue,
                _ => Signal::Interrupt,
            };
            // The robot is stopped from here, whatever the screen is doing.
            if !tell_and_stop(&tell, &line, Msg::Signal(signal), signal != Signal::Continue) {
                return;
            }
            if matches!(signal, Signal::Terminate | Signal::Hangup) {
                leave_in_any_case(number);
            }
        }
    })
}

/// Passes on what was heard, and stops the robot if it may move and this stops it; `false` if nobody listens any more.
///
/// The screen hears of it first: what it makes of the key must not depend on the hold that follows.
fn tell_and_stop(tell: &Outbox, line: &Line, msg: Msg, stops: bool) -> bool {
    if !(stops && line.may_move()) {
        return tell.urge(msg);
    }
    let is_heard = tell.urge_stopped(msg);
    line.order(Order::Hold);
    is_heard
}

/// Whether a key stops a robot that moves, whatever is open on the screen.
fn is_stop_key(msg: &Msg) -> bool {
    matches!(msg, Msg::Key(press) if !press.repeat && matches!(press.key, Key::Char(' ') | Key::Ctrl('c')))
}

fn leave_in_any_case(signal: i32) {
    thread::sleep(GRACE);
    terminal::restore_from_signal();
    std::process::exit(128 + signal);
}

/// A terminal that is closed while SIGHUP is ignored, as under nohup, is noticed here.
pub fn terminal(tell: &Outbox, line: Line) -> anyhow::Result<()> {
    let tell = tell.clone();
    spawn("terminal", move || {
        let stdin = std::io::stdin();
        let mut watched = [PollFd::new(&stdin, PollFlags::empty())];
        loop {
            let waited = poll(&mut watched, None);
            let gone = watched[0].revents().intersects(PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL);
            if waited.is_ok() && gone {
                tell_and_stop(&tell, &line, Msg::Signal(Signal::Hangup), true);
                leave_in_any_case(SIGHUP);
            }
        }
    })
}

/// Which planners there are; asks every plugin in a process of its own, so it may take a while.
pub fn planners(plugins: &PluginDirs, tell: &Outbox) -> anyhow::Result<()> {
    let (plugins, tell) = (plugins.clone(), tell.clone());
    spawn("planners", move || {
        let (found, refused) = crate::planners::surveyed(&plugins);
        let refused = refused.into_iter().map(|(plugin, reason)| Refused { plugin, reason }).collect();
        // A screen that is gone needs no list.
        tell.tell(Msg::Planners { found, refused });
    })
}

fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> anyhow::Result<()> {
    let started = thread::Builder::new().name(name.into()).spawn(work);
    started.map(drop).with_context(|| format!("starting the thread for {name}"))
}
