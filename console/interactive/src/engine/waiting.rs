//! What the engine's thread waits for between two ticks.

use super::{EngineThread, keeping::HEALTH_PERIOD};
use crate::{line::Request, pace::Pace};
use mission::Order;
use runs::RunLog;
use std::{
    sync::mpsc::RecvTimeoutError,
    time::{Duration, Instant},
};

/// With this many messages waiting for the screen, the simulation waits for it.
const MOST_BACKLOG: usize = 64;
/// How long it waits then before it looks again, unless an order comes.
const LOOK_AGAIN: Duration = Duration::from_millis(1);
/// How often workers that are being ended are looked after while no ticks pass.
const LOOK_AFTER: Duration = Duration::from_millis(20);

impl EngineThread {
    /// Waits for the next tick, or, while no ticks pass, for a request; gives the orders that came and whether to
    /// close, and then whether in a hurry.
    pub(super) fn wait_for(&mut self, pace: &Pace) -> (Vec<Order>, Option<bool>) {
        // A wake-up from here on belongs to a request that has not been taken yet.
        self.host.clear_wake_ups();
        let mut orders = Vec::new();
        loop {
            let is_ahead = self.is_ahead();
            let due = pace.wakes_at(!orders.is_empty());
            let due = if is_ahead { due.max(Instant::now() + LOOK_AGAIN) } else { due };
            let wait = due.saturating_duration_since(Instant::now()).min(HEALTH_PERIOD);
            let request = if self.is_under_way() {
                self.asked.recv_timeout(wait)
            } else if orders.is_empty() {
                self.wait_for_request()
            } else {
                return (orders, None);
            };
            match request {
                // Key and screen both order a hold; the second one has nothing left to stop.
                Ok(Request::Order(Order::Hold, _)) if orders.is_empty() && self.is_held_for_good() => {}
                // What stops the robot does not wait for the tick that is due: the tick comes now.
                Ok(Request::Order(order @ (Order::Hold | Order::Abort), at)) => {
                    if self.flight.phase().may_move() {
                        self.stop_asked.get_or_insert(at);
                    }
                    orders.push(order);
                    return (orders, None);
                }
                Ok(Request::Order(order, _)) => orders.push(order),
                Ok(Request::Speed(speed)) => self.speed = speed,
                Ok(Request::Fork(answer)) => {
                    let _ = answer.send(self.flight.forked(&self.scenario));
                }
                Ok(Request::Answer(answer)) => {
                    // Whoever asked may have given up.
                    let _ = answer.send(());
                }
                Ok(Request::Close { hurry }) => return (orders, Some(hurry)),
                // A slow mission has ticks further apart than the screen hears of its recording.
                Err(RecvTimeoutError::Timeout) if is_ahead || Instant::now() < due => self.send_health(),
                Err(RecvTimeoutError::Timeout) => return (orders, None),
                Err(RecvTimeoutError::Disconnected) => return (orders, Some(false)),
            }
        }
    }

    /// Waits while no ticks pass; looks after workers that are being ended meanwhile.
    fn wait_for_request(&mut self) -> Result<Request, RecvTimeoutError> {
        while self.host.look_after_leaving() {
            match self.asked.recv_timeout(LOOK_AFTER) {
                Err(RecvTimeoutError::Timeout) => {}
                request => return request,
            }
        }
        self.asked.recv().map_err(|_| RecvTimeoutError::Disconnected)
    }

    /// Whether screen or recorder is so far behind that the simulation waits for it.
    fn is_ahead(&self) -> bool {
        self.screen.backlog() > MOST_BACKLOG || self.log.as_ref().is_some_and(RunLog::is_behind)
    }
}
