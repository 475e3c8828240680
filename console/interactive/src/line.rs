//! The line to the engine's thread: orders and other requests, from every thread that may have to stop the robot.

use flight::Flight;
use mission::Order;
use planner_host::Waker;
use std::{
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
        mpsc::{self, Receiver, Sender},
    },
    time::{Duration, Instant},
};
use tui::Speed;

/// A request to the engine's thread.
pub(super) enum Request {
    /// An order, and when it was received.
    Order(Order, Instant),
    /// Change the pace.
    Speed(Speed),
    /// Answer, so that somebody knows how long an order waits.
    Answer(Sender<()>),
    /// Copy the flight as it stands, for forecasts.
    Fork(Sender<Flight>),
    /// End the run, close everything, stop.
    Close {
        /// Whether a signal has asked the process to exit: then less time is allowed.
        hurry: bool,
    },
}

/// The sending end.
#[derive(Clone)]
pub(super) struct EngineHandle {
    requests: Sender<Request>,
    waker: Waker,
    /// Whether the robot moves or may begin to, as the screen knows it.
    may_move: Arc<AtomicBool>,
    /// Whether the operator types text, as the screen knows it.
    is_typing: Arc<AtomicBool>,
}

/// A line to an engine whose planners this waker interrupts.
pub(super) fn line(waker: Waker) -> (EngineHandle, Receiver<Request>) {
    let (requests, asked) = mpsc::channel();
    (EngineHandle { requests, waker, may_move: Arc::default(), is_typing: Arc::default() }, asked)
}

impl EngineHandle {
    /// Hands an order to the mission; it enters with the next tick. What stops the robot makes that tick begin now.
    pub(super) fn order(&self, order: Order) {
        let is_urgent = matches!(order, Order::Hold | Order::Abort);
        self.request(Request::Order(order, Instant::now()), is_urgent);
    }

    /// Whether the robot moves or may begin to, as the screen knows it.
    pub(super) fn may_move(&self) -> bool {
        self.may_move.load(Ordering::Relaxed)
    }

    /// Whether the operator types text, as the screen knows it.
    pub(super) fn is_typing(&self) -> bool {
        self.is_typing.load(Ordering::Relaxed)
    }

    /// The screen reports whether the robot may move, and whether the operator types text.
    pub(super) fn report(&self, may_move: bool, is_typing: bool) {
        self.may_move.store(may_move, Ordering::Relaxed);
        self.is_typing.store(is_typing, Ordering::Relaxed);
    }

    /// Sets the pace.
    pub(super) fn speed(&self, speed: Speed) {
        self.request(Request::Speed(speed), false);
    }

    /// How long an order that stops the robot waits until the engine takes it; `None` if that takes too long.
    pub(super) fn measure(&self, patience: Duration) -> Option<Duration> {
        let (answer, answered) = mpsc::channel();
        let asked = Instant::now();
        self.request(Request::Answer(answer), true);
        answered.recv_timeout(patience).ok().map(|()| asked.elapsed())
    }

    /// The flight as it stands now, for forecasts; `None` if the engine does not answer in time.
    pub(super) fn fork(&self, patience: Duration) -> Option<Flight> {
        let (answer, answered) = mpsc::channel();
        self.request(Request::Fork(answer), false);
        answered.recv_timeout(patience).ok()
    }

    /// Ends the run and closes its files.
    pub(super) fn close(&self, hurry: bool) {
        self.request(Request::Close { hurry }, true);
    }

    fn request(&self, request: Request, is_urgent: bool) {
        // An engine that has ended has already sent the reason to the screen.
        let _ = self.requests.send(request);
        if is_urgent {
            self.waker.wake();
        }
    }
}

/// The engine of the run that is open, if one is, for the threads that may have to stop the robot.
#[derive(Clone, Default)]
pub(super) struct Current(Arc<Mutex<Option<EngineHandle>>>);

impl Current {
    /// Another engine, or none, is the one of the run that is open.
    pub(super) fn set(&self, engine: Option<EngineHandle>) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = engine;
    }

    /// The engine of the run that is open.
    pub(super) fn get(&self) -> Option<EngineHandle> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
