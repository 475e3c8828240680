//! Being asked to stop from outside: SIGINT, SIGTERM, SIGHUP.

use planner_host::Waker;
use signal_hook::{
    consts::{SIGHUP, SIGINT, SIGTERM},
    iterator::Signals,
};
use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
};

const SIGNALS: [i32; 3] = [SIGINT, SIGTERM, SIGHUP];

/// Whether somebody asked this process to stop.
#[derive(Debug, Clone)]
pub(crate) struct StopSignal(Arc<AtomicBool>);

impl StopSignal {
    /// Whether a signal has come since listening began.
    pub(crate) fn requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Listens from now on; the first signal asks, a second one of the same kind ends the process at once.
pub(crate) fn listen() -> StopSignal {
    let asked = Arc::new(AtomicBool::new(false));
    for signal in SIGNALS {
        // The order matters: the second signal finds the flag set by the first.
        let registered =
            signal_hook::flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(&asked))
                .and_then(|_| signal_hook::flag::register(signal, Arc::clone(&asked)));
        // Without a handler the signal ends the process, as it does by default.
        drop(registered);
    }
    StopSignal(asked)
}

/// Wakes the host at every signal, so that a wait for planners is interrupted.
pub(crate) fn wake_on_signal(waker: Waker) {
    let Ok(mut signals) = Signals::new(SIGNALS) else { return };
    let watch = move || signals.forever().for_each(|_| waker.wake());
    // Without the thread the signal is noticed when the planner answers.
    drop(thread::Builder::new().name("stop signal".into()).spawn(watch));
}
