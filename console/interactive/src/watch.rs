//! The threads that only listen: keys, signals, a terminal that is closed.

use super::{
    foreground::Foreground,
    inbox::Outbox,
    line::{Current, EngineHandle},
};
use anyhow::Context;
use crossterm::event::{self, Event};
use mission::Order;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use signal_hook::{
    consts::{SIGCONT, SIGHUP, SIGINT, SIGTERM, SIGTSTP, SIGTTIN},
    iterator::Signals,
};
use std::{
    path::Path,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    thread,
    time::{Duration, Instant},
};
use tui::{
    Key, Measured, Msg, Places, Signal,
    terminal::{self, Keyboard, Pointer},
};

/// How long the console may take to exit cleanly after a signal; then it exits anyway.
const GRACE: Duration = Duration::from_secs(1);

/// Signals that nobody sends to a console on purpose, and that end a process which does not listen to them: the terminal would
/// stay as the screen has it. A file that grows too large is noticed where it is written.
const OTHERS: [i32; 11] = [
    libc::SIGQUIT,
    libc::SIGTRAP,
    libc::SIGUSR1,
    libc::SIGUSR2,
    libc::SIGALRM,
    libc::SIGSTKFLT,
    libc::SIGXCPU,
    libc::SIGVTALRM,
    libc::SIGPROF,
    libc::SIGIO,
    libc::SIGPWR,
];

/// How often it is looked at who has the terminal.
const TERMINAL_PERIOD: Timespec = Timespec { tv_sec: 1, tv_nsec: 0 };

/// How often the disk is asked how much space is left: at 100 MB an hour that is less than a megabyte.
const DISK_PERIOD: Duration = Duration::from_secs(10);

/// Space left where runs are kept, whenever it has changed by a megabyte. A disk may answer late: only this thread waits.
pub(super) fn disk(outbox: &Outbox, logs: &Path) -> anyhow::Result<()> {
    let (outbox, logs) = (outbox.clone(), logs.to_owned());
    let megabytes = |bytes: Option<u64>| bytes.map(|bytes| bytes >> 20);
    spawn("disk", move || {
        let mut before = None;
        loop {
            let free = runs::free_bytes(&logs);
            let is_news = megabytes(free) != megabytes(before);
            if let Some(bytes) = free.filter(|_| is_news)
                && !outbox.send(Msg::Measured(Measured::Disk(bytes)))
            {
                return;
            }
            before = free;
            thread::sleep(DISK_PERIOD);
        }
    })
}

/// Where the last frame put what a mouse can hit, for the thread that listens to it.
#[derive(Clone, Default)]
pub(super) struct SharedPlaces(Arc<Mutex<Places>>);

impl SharedPlaces {
    pub(super) fn set(&self, places: &Places) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = places.clone();
    }

    fn get(&self) -> MutexGuard<'_, Places> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Keys, mouse, pastes and sizes. A key that stops the robot does so from here, whatever the screen is doing.
pub(super) fn keys(outbox: &Outbox, engine: Current, places: SharedPlaces) -> anyhow::Result<()> {
    let outbox = outbox.clone();
    spawn("keys", move || {
        let (mut pointer, mut keyboard) = (Pointer::default(), Keyboard::default());
        while let Ok(event) = event::read() {
            let msg = match event {
                Event::Key(key) => keyboard.take(&key, Instant::now()).map(Msg::Key),
                Event::Paste(text) => Some(Msg::Paste(text)),
                Event::Resize(width, height) => Some(Msg::Resize { width, height }),
                Event::Mouse(mouse) => pointer.take(&mouse, &places.get()).map(Msg::Mouse),
                Event::FocusGained | Event::FocusLost => None,
            };
            let Some(msg) = msg else { continue };
            let stops = is_stop_key(&msg, engine.get().is_some_and(|engine| engine.is_typing()));
            if !send_and_hold(&outbox, &engine, msg, stops) {
                return;
            }
        }
    })
}

/// Signals; one that ends the process ends it within [`GRACE`], whatever the other threads do.
pub(super) fn signals(outbox: &Outbox, engine: Current, foreground: Foreground) -> anyhow::Result<()> {
    let outbox = outbox.clone();
    let others = OTHERS.into_iter().chain(libc::SIGRTMIN()..=libc::SIGRTMAX());
    let all = [SIGINT, SIGTERM, SIGHUP, SIGTSTP, SIGCONT, SIGTTIN].into_iter().chain(others);
    let mut signals = Signals::new(all).context("listening to signals")?;
    spawn("signals", move || {
        for number in signals.forever() {
            match number {
                SIGTTIN => {
                    foreground.missed_key();
                    continue;
                }
                SIGCONT => foreground.continued(),
                _ => {}
            }
            let signal = match number {
                SIGTERM => Signal::Terminate,
                SIGHUP => Signal::Hangup,
                SIGTSTP => Signal::Stop,
                SIGCONT => Signal::Continue,
                SIGINT => Signal::Interrupt,
                other => Signal::End(other),
            };
            // The robot is stopped from here, whatever the screen is doing.
            if !send_and_hold(&outbox, &engine, Msg::Signal(signal), signal != Signal::Continue) {
                return;
            }
            if matches!(signal, Signal::Terminate | Signal::Hangup | Signal::End(_)) {
                leave_in_any_case(number);
            }
        }
    })
}

/// Sends a message to the screen, and orders a hold if the message stops the robot and the robot may move; `false` if the
/// inbox is closed.
///
/// The screen gets the message first: how it handles the key must not depend on the hold that follows. It orders a hold
/// itself as well: this one may overtake an order to move that the screen has not sent yet, that one cannot.
fn send_and_hold(outbox: &Outbox, engine: &Current, msg: Msg, stops: bool) -> bool {
    let is_delivered = outbox.send_urgent(msg);
    if stops && let Some(engine) = engine.get().filter(EngineHandle::may_move) {
        engine.order(Order::Hold);
    }
    is_delivered
}

/// Whether a key stops a robot that moves. Where text is typed the space is a letter.
///
/// What the screen reports may be a key behind: a space that follows the key that opens a text line may hold, and one that
/// follows the key that closes it is left to the screen.
fn is_stop_key(msg: &Msg, is_typing: bool) -> bool {
    match msg {
        Msg::Key(press) if !press.repeat => {
            press.key == Key::Ctrl('c') || press.key == Key::Char(' ') && !is_typing
        }
        _ => false,
    }
}

fn leave_in_any_case(signal: i32) {
    thread::sleep(GRACE);
    terminal::restore_from_signal();
    std::process::exit(128 + signal);
}

/// A terminal that is closed while SIGHUP is ignored, as under nohup, is noticed here, and one that others have taken.
pub(super) fn terminal(outbox: &Outbox, engine: Current, foreground: Foreground) -> anyhow::Result<()> {
    let outbox = outbox.clone();
    spawn("terminal", move || {
        let stdin = std::io::stdin();
        let mut watched = [PollFd::new(&stdin, PollFlags::empty())];
        let mut was_lost = false;
        loop {
            let waited = poll(&mut watched, Some(&TERMINAL_PERIOD));
            // Twice in a row: whoever continues a stopped console in the background has it heard of that first.
            let is_lost = foreground.is_lost();
            if is_lost && was_lost {
                foreground.keep();
            }
            was_lost = is_lost;
            let is_closed =
                watched[0].revents().intersects(PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL);
            if waited.is_ok() && is_closed {
                send_and_hold(&outbox, &engine, Msg::Signal(Signal::Hangup), true);
                leave_in_any_case(SIGHUP);
            }
        }
    })
}

fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> anyhow::Result<()> {
    let started = thread::Builder::new().name(name.into()).spawn(work);
    started.map(drop).with_context(|| format!("starting the thread for {name}"))
}
