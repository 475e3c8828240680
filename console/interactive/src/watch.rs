//! The listening threads: keys, signals, and a closed terminal.

use super::{
    foreground::Foreground,
    inbox::Outbox,
    line::{Current, EngineHandle},
    reading::Reader,
    typing::Follower,
};
use anyhow::Context;
use mission::Order;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use signal_hook::{
    consts::{SIGCONT, SIGHUP, SIGINT, SIGTERM, SIGTSTP, SIGTTIN, SIGWINCH},
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
    terminal::{self, Input, Keyboard, Pointer},
};

/// The time for a clean exit after a signal, which includes closing the recording; once it is over, the process exits in
/// any case. The robot is held at once.
pub(crate) const GRACE: Duration = Duration::from_secs(6);

/// Signals that are not meant for a console, but would end a process without a handler and leave the terminal as the
/// screen has set it. SIGXFSZ is not listed: the failing write reports it.
pub const STRAY_SIGNALS: [i32; 11] = [
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

/// The interval at which the terminal's ownership is checked.
const TERMINAL_PERIOD: Timespec = Timespec { tv_sec: 1, tv_nsec: 0 };

/// The interval at which free space is checked; at 100 MB per hour, less than a megabyte is written in between.
const DISK_PERIOD: Duration = Duration::from_secs(10);

/// Reports the free space for runs whenever it changes by a megabyte. A slow disk delays only this thread.
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

/// The positions of clickable items in the last frame, for the thread that listens to the mouse.
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

/// Listens for keys, mouse and pastes. A key that stops the robot takes effect from this thread, whatever the screen is
/// doing. `openers` are the keys that open an input line.
pub(super) fn keys(
    outbox: &Outbox,
    engine: Current,
    mut reader: Reader,
    (places, openers): (SharedPlaces, Vec<Key>),
) -> anyhow::Result<()> {
    let outbox = outbox.clone();
    let mut follower = Follower::new(engine.typing.clone(), openers);
    spawn("keys", move || {
        let (mut pointer, mut keyboard) = (Pointer::default(), Keyboard::default());
        while let Some((input, seen)) = reader.next() {
            let msg = match input {
                Input::Key(_) | Input::OtherKey => keyboard.take(&input, Instant::now(), seen).map(Msg::Key),
                Input::Stop => Some(Msg::Stop),
                Input::Paste(text) => Some(Msg::Paste(text)),
                Input::Mouse(pointed) => pointer.take(pointed, &places.get()).map(Msg::Mouse),
                Input::Background(_) | Input::Kind => None,
            };
            let Some(msg) = msg else { continue };
            let now = Instant::now();
            let stops = is_stop_key(&msg, follower.is_typing(now));
            follower.sends(&msg, now);
            if !send_and_hold(&outbox, &engine, msg, stops) {
                return;
            }
        }
    })
}

/// Listens for signals. After a signal that ends the process, the process ends within [`GRACE`], whatever the other
/// threads do.
pub(super) fn signals(outbox: &Outbox, engine: Current, foreground: Foreground) -> anyhow::Result<()> {
    let outbox = outbox.clone();
    let others = STRAY_SIGNALS.into_iter().chain(libc::SIGRTMIN()..=libc::SIGRTMAX());
    let all = [SIGINT, SIGTERM, SIGHUP, SIGTSTP, SIGCONT, SIGTTIN].into_iter().chain(others);
    let mut signals = Signals::new(all).context("listening for signals")?;
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
            // Stop the robot from this thread, whatever the screen is doing.
            if !send_and_hold(&outbox, &engine, Msg::Signal(signal), signal != Signal::Continue) {
                return;
            }
            if matches!(signal, Signal::Terminate | Signal::Hangup | Signal::End(_)) {
                leave_in_any_case(number);
            }
        }
    })
}

/// Listens for changes in the terminal's size.
pub(super) fn sizes(outbox: &Outbox) -> anyhow::Result<()> {
    let outbox = outbox.clone();
    let mut changes = Signals::new([SIGWINCH]).context("listening for changes in the terminal's size")?;
    spawn("sizes", move || {
        // The size may have changed before this thread began to listen.
        for _ in std::iter::once(SIGWINCH).chain(changes.forever()) {
            let Ok((width, height)) = crossterm::terminal::size() else { continue };
            if !outbox.send_urgent(Msg::Resize { width, height }) {
                return;
            }
        }
    })
}

/// Sends a message to the screen, and orders a hold if the message stops the robot and the robot may move. Returns
/// `false` if the inbox is closed.
///
/// The screen gets the message first, because its handling of the key must not depend on the hold that follows. The
/// screen also orders a hold: the hold from here may overtake an order to move that the screen has not sent yet, but
/// the screen's hold cannot.
fn send_and_hold(outbox: &Outbox, engine: &Current, msg: Msg, stops: bool) -> bool {
    let is_delivered = outbox.send_urgent(msg);
    if stops && let Some(engine) = engine.get().filter(EngineHandle::may_move) {
        engine.order(Order::Hold);
    }
    is_delivered
}

/// Whether a key stops a moving robot. While text is being typed, the space key enters a space.
fn is_stop_key(msg: &Msg, is_typing: bool) -> bool {
    match msg {
        Msg::Key(press) if !press.repeat => {
            press.key == Key::Ctrl('c') || press.key == Key::Char(' ') && !is_typing
        }
        Msg::Stop => !is_typing,
        _ => false,
    }
}

fn leave_in_any_case(signal: i32) {
    thread::sleep(GRACE);
    terminal::restore_from_signal();
    std::process::exit(128 + signal);
}

/// Detects a terminal that is closed while SIGHUP is ignored, as under nohup, and a terminal that another process has
/// taken.
pub(super) fn terminal(outbox: &Outbox, engine: Current, foreground: Foreground) -> anyhow::Result<()> {
    let outbox = outbox.clone();
    spawn("terminal", move || {
        let stdin = std::io::stdin();
        let mut watched = [PollFd::new(&stdin, PollFlags::empty())];
        let mut was_lost = false;
        loop {
            let waited = poll(&mut watched, Some(&TERMINAL_PERIOD));
            // Only after two checks in a row: a console continued in the background must first receive the signal that
            // says so.
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
