//! The request channel to the engine's thread, used by every thread that may have to stop the robot.

use super::typing::Reports;
use flight::Forked;
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
use tui::{Query, Speed};
use vehicle::port::Brake;

/// A request to the engine's thread.
pub(super) enum Request {
    /// An order, and when it was received.
    Order(Order, Instant),
    /// Answer a question about the mission on the screen; nothing changes.
    Ask(Query),
    /// Change the speed.
    Speed(Speed),
    /// Answer immediately, to measure how long an order waits.
    Answer(Sender<()>),
    /// Answer when the journal has been handed to the system, with the effects of all orders before this request.
    Settle(Sender<()>),
    /// Return a copy of the mission in its current state, for forecasts.
    Fork(Sender<Forked>),
    /// End the run, close everything and stop.
    Close {
        /// Whether a signal has asked the process to exit; if so, the time limit is shorter.
        hurry: bool,
    },
}

/// The sending end of the channel.
#[derive(Clone)]
pub(super) struct EngineHandle {
    requests: Sender<Request>,
    waker: Waker,
    /// Stops a real vehicle before the mission has processed the order; `None` for the simulator.
    brake: Option<Brake>,
    /// Whether the robot moves or may start to move, as last reported by the screen.
    may_move: Arc<AtomicBool>,
}

/// Creates a channel to an engine; `waker` interrupts its waits for planners.
pub(super) fn line(waker: Waker, brake: Option<Brake>) -> (EngineHandle, Receiver<Request>) {
    let (requests, asked) = mpsc::channel();
    (EngineHandle { requests, waker, brake, may_move: Arc::default() }, asked)
}

impl EngineHandle {
    /// Sends an order to the mission, which receives it with the next tick. An order that stops the robot triggers that
    /// tick immediately.
    pub(super) fn order(&self, order: Order) {
        let is_urgent = order.brakes();
        if is_urgent {
            self.brake.iter().for_each(Brake::pull);
        }
        self.request(Request::Order(order, Instant::now()), is_urgent);
    }

    /// Whether the robot moves or may start to move, as last reported by the screen.
    pub(super) fn may_move(&self) -> bool {
        self.may_move.load(Ordering::Relaxed)
    }

    /// Records whether the robot may move, as reported by the screen.
    pub(super) fn report(&self, may_move: bool) {
        self.may_move.store(may_move, Ordering::Relaxed);
    }

    /// Sends a query to the mission; the answer goes to the screen.
    pub(super) fn ask(&self, query: Query) {
        self.request(Request::Ask(query), false);
    }

    /// Sets the speed.
    pub(super) fn speed(&self, speed: Speed) {
        self.request(Request::Speed(speed), false);
    }

    /// Measures how long an order that stops the robot waits for the engine; `None` if the wait exceeds `patience`.
    pub(super) fn measure(&self, patience: Duration) -> Option<Duration> {
        let (answer, answered) = mpsc::channel();
        let asked = Instant::now();
        self.request(Request::Answer(answer), true);
        answered.recv_timeout(patience).ok().map(|()| asked.elapsed())
    }

    /// Waits until the effects of all orders sent before are in the journal on disk, but not longer than `patience`; returns
    /// whether they are.
    pub(super) fn settle(&self, patience: Duration) -> bool {
        let (answer, answered) = mpsc::channel();
        self.request(Request::Settle(answer), true);
        answered.recv_timeout(patience).is_ok()
    }

    /// Copies the flight in its current state, for forecasts; `None` if the engine does not answer within `patience`.
    pub(super) fn fork(&self, patience: Duration) -> Option<Forked> {
        let (answer, answered) = mpsc::channel();
        self.request(Request::Fork(answer), false);
        answered.recv_timeout(patience).ok()
    }

    /// Ends the run and closes its files.
    pub(super) fn close(&self, hurry: bool) {
        self.request(Request::Close { hurry }, true);
    }

    fn request(&self, request: Request, is_urgent: bool) {
        // If the engine has ended, it has already sent the reason to the screen.
        let _ = self.requests.send(request);
        if is_urgent {
            self.waker.wake();
        }
    }
}

/// The engine of the open run, if any, for the threads that may have to stop the robot.
#[derive(Clone, Default)]
pub(super) struct Current {
    engine: Arc<Mutex<Option<EngineHandle>>>,
    /// Whether the operator is typing text, as reported by the screen.
    pub typing: Reports,
}

impl Current {
    /// Replaces the engine of the open run; `None` if no run is open.
    pub(super) fn set(&self, engine: Option<EngineHandle>) {
        *self.engine.lock().unwrap_or_else(PoisonError::into_inner) = engine;
    }

    /// The engine of the open run.
    pub(super) fn get(&self) -> Option<EngineHandle> {
        self.engine.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
