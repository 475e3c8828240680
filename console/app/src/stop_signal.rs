//! Stop requests by signal: SIGINT, SIGTERM, SIGHUP, SIGQUIT. Other signals do not end a run.

use planner_host::Waker;
use signal_hook::{
    consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM},
    iterator::Signals,
};
use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
};

const SIGNALS: [i32; 4] = [SIGINT, SIGTERM, SIGHUP, SIGQUIT];

/// A flag that records whether a signal asked this process to stop.
#[derive(Debug, Clone)]
pub(crate) struct StopSignal(Arc<AtomicBool>);

impl StopSignal {
    /// Whether a signal has arrived since [`listen`].
    pub(crate) fn requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Starts listening. The first signal requests a stop; a second signal of the same kind ends the process immediately.
pub(crate) fn listen() -> StopSignal {
    let asked = Arc::new(AtomicBool::new(false));
    for signal in SIGNALS {
        // The order of registration matters: the second signal must find the flag set by the first.
        let registered =
            signal_hook::flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(&asked))
                .and_then(|_| signal_hook::flag::register(signal, Arc::clone(&asked)));
        // If this fails, the signal ends the process, as it does by default.
        drop(registered);
    }
    for signal in interactive::STRAY_SIGNALS.into_iter().filter(|signal| !SIGNALS.contains(signal)) {
        // A handler without effect: without it, the signal would end the run and leave the vehicle to its lease.
        drop(signal_hook::flag::register(signal, Arc::default()));
    }
    StopSignal(asked)
}

/// Wakes the host at every signal, to interrupt a wait for planners.
pub(crate) fn wake_on_signal(waker: Waker) {
    let Ok(mut signals) = Signals::new(SIGNALS) else { return };
    let watch = move || signals.forever().for_each(|_| waker.wake());
    // Without this thread, the signal is noticed only when the planner answers.
    drop(thread::Builder::new().name("stop signal".into()).spawn(watch));
}
