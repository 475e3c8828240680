//! The engine's waits between two ticks.

use super::{EngineThread, keeping::HEALTH_PERIOD};
use crate::{line::Request, pace::Pace};
use mission::{Order, Phase};
use runs::RunLog;
use std::{
    sync::mpsc::{RecvTimeoutError, TryRecvError},
    time::{Duration, Instant},
};
use vehicle::port::Brake;

/// If more messages than this are waiting for the screen, the simulation waits.
const MOST_BACKLOG: usize = 64;
/// The interval at which a simulation that waits checks the number of messages again, unless an order arrives.
const LOOK_AGAIN: Duration = Duration::from_millis(1);
/// The interval at which ending workers are checked while no ticks pass, and at which requests are checked while a
/// planner owes an answer.
const LOOK_AFTER: Duration = Duration::from_millis(20);
/// The interval at which the processes of planners are checked while no ticks pass.
const LOOK_FOR_PLANNERS: Duration = Duration::from_millis(250);

impl EngineThread {
    /// Waits for the next tick or, while no ticks pass, for a request. Returns the orders received; the second value is
    /// `Some` if the engine must close, and states whether it must do so in a hurry.
    pub(super) fn wait_for(&mut self, pace: &Pace) -> (Vec<Order>, Option<bool>) {
        // A wake-up after this point belongs to a request that has not been taken yet.
        self.host.clear_wake_ups();
        let mut orders = Vec::new();
        loop {
            let is_ahead = self.is_ahead();
            if !orders.is_empty() && self.is_idle() && !is_ahead {
                return (orders, None);
            }
            let due = pace.wakes_at(!orders.is_empty());
            let due = if is_ahead { due.max(Instant::now() + LOOK_AGAIN) } else { due };
            let wait = due.saturating_duration_since(Instant::now()).min(HEALTH_PERIOD);
            let request = if self.is_under_way() {
                self.attend_until(Instant::now() + wait)
            } else if orders.is_empty() {
                self.wait_for_request()
            } else {
                return (orders, None);
            };
            match request {
                // The key thread and the screen both order a hold; the second order has nothing left to stop.
                Ok(Request::Order(Order::Hold, _)) if orders.is_empty() && self.is_held_for_good() => {
                    self.flight.brake().iter().for_each(Brake::release);
                }
                // An order that stops the robot does not wait for the next due tick: it triggers a tick immediately.
                Ok(Request::Order(order @ (Order::Hold | Order::Abort), at)) => {
                    if self.flight.phase().may_move() {
                        self.stop_asked.get_or_insert(at);
                    }
                    orders.push(order);
                    return (orders, None);
                }
                Ok(Request::Order(order, _)) => orders.push(order),
                Ok(Request::Speed(_)) if self.flight.is_live() => {}
                Ok(Request::Speed(speed)) => self.speed = speed,
                Ok(Request::Ask(query)) => self.query(query),
                Ok(Request::Fork(answer)) => {
                    let _ = answer.send(self.flight.forked());
                }
                Ok(Request::Answer(answer)) => {
                    // The requester may have stopped waiting.
                    let _ = answer.send(());
                }
                // Orders before this request are carried out first.
                Ok(Request::Settle(answer)) if !orders.is_empty() => {
                    self.settling = Some(answer);
                    return (orders, None);
                }
                Ok(Request::Settle(answer)) => self.settle(answer),
                Ok(Request::Close { hurry }) => return (orders, Some(hurry)),
                // The process of a planner has ended.
                Err(RecvTimeoutError::Timeout) if !self.is_under_way() => return (orders, None),
                // If the time between ticks is longer than the time between health reports, send a report between
                // ticks.
                Err(RecvTimeoutError::Timeout) if is_ahead || Instant::now() < due => self.send_health(),
                Err(RecvTimeoutError::Timeout) => return (orders, None),
                Err(RecvTimeoutError::Disconnected) => return (orders, Some(false)),
            }
        }
    }

    /// Waits for a request. Meanwhile attends to the planners that owe an answer; the next tick uses their answers.
    fn attend_until(&mut self, until: Instant) -> Result<Request, RecvTimeoutError> {
        while self.host.is_asked() {
            match self.asked.try_recv() {
                Ok(request) => return Ok(request),
                Err(TryRecvError::Disconnected) => return Err(RecvTimeoutError::Disconnected),
                Err(TryRecvError::Empty) => {}
            }
            let now = Instant::now();
            if now >= until {
                return Err(RecvTimeoutError::Timeout);
            }
            self.host.attend(until.min(now + LOOK_AFTER));
        }
        self.asked.recv_timeout(until.saturating_duration_since(Instant::now()))
    }

    /// Waits for a request while no ticks pass, or until the process of a planner ends. Meanwhile checks workers that are
    /// ending.
    fn wait_for_request(&mut self) -> Result<Request, RecvTimeoutError> {
        while *self.flight.phase() == Phase::Waiting || self.host.look_after_leaving() {
            let is_leaving = self.host.look_after_leaving();
            match self.asked.recv_timeout(if is_leaving { LOOK_AFTER } else { LOOK_FOR_PLANNERS }) {
                Err(RecvTimeoutError::Timeout) if !self.has_lost_planner() => {}
                request => return request,
            }
        }
        self.asked.recv().map_err(|_| RecvTimeoutError::Disconnected)
    }

    /// Whether the screen or the recorder is so far behind that the simulation must wait.
    fn is_ahead(&self) -> bool {
        self.screen.backlog() > MOST_BACKLOG || self.log.as_ref().is_some_and(RunLog::is_behind)
    }
}
