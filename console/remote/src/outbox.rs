//! The newest command that has not been written yet. If the adapter reads nothing, one command waits here, not a queue.

use std::{
    sync::{Condvar, Mutex, PoisonError},
    time::Duration,
};
use vehicle::{
    port::LEASE_S,
    wire::message::{Bye, Drive, Ping, Stop, ToVehicle},
};

/// Time between two pings.
const PING_EVERY: Duration = Duration::from_millis(200);

/// The messages to write next.
#[derive(Debug, Default)]
pub(crate) struct Outbox {
    waiting: Mutex<Waiting>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct Waiting {
    /// The newest command, and when it was given, seconds.
    motion: Option<(Motion, f64)>,
    /// Number of orders that have stopped the vehicle between two ticks and that no tick has carried out yet; until then,
    /// no motion is sent.
    brakes: u32,
    is_closed: bool,
    /// Number of commands so far.
    seq: u64,
}

/// A motion in the robot frame: metres per second ahead and to the left, radians per second. `None`: stand still.
type Motion = Option<[f64; 3]>;

impl Outbox {
    /// Replaces the command that waits. `carried_out`: number of braking orders that the mission has carried out. `now_s`:
    /// seconds on the clock of [`Self::next`].
    pub(crate) fn command(&self, motion: Motion, carried_out: u32, now_s: f64) {
        let mut waiting = self.lock();
        waiting.brakes = waiting.brakes.saturating_sub(carried_out);
        let motion = motion.filter(|_| waiting.brakes == 0);
        waiting.motion = Some((motion, now_s));
        self.changed.notify_all();
    }

    /// Stops the vehicle between two ticks.
    pub(crate) fn brake(&self) {
        let mut waiting = self.lock();
        waiting.brakes += 1;
        // A stop does not become too old.
        waiting.motion = Some((None, f64::INFINITY));
        self.changed.notify_all();
    }

    /// Releases the brake of an order that was dropped.
    pub(crate) fn release(&self) {
        let mut waiting = self.lock();
        waiting.brakes = waiting.brakes.saturating_sub(1);
    }

    pub(crate) fn close(&self) {
        self.lock().is_closed = true;
        self.changed.notify_all();
    }

    /// Waits for the next message: the newest command, a ping after some time without commands, or `Bye` after the outbox
    /// was closed. A motion that has waited for longer than its lease, because the process was stopped, is dropped.
    pub(crate) fn next(&self, now_s: impl Fn() -> f64, last_ping_s: &mut f64) -> ToVehicle {
        let mut waiting = self.lock();
        loop {
            let now_s = now_s();
            let motion = waiting.motion.take();
            let fresh = motion.filter(|(motion, given_s)| motion.is_none() || now_s - given_s <= LEASE_S);
            if let Some((motion, _)) = fresh {
                waiting.seq += 1;
                return message(motion, waiting.seq, now_s);
            }
            if waiting.is_closed {
                return ToVehicle::Bye(Bye::default());
            }
            let due_s = *last_ping_s + PING_EVERY.as_secs_f64() - now_s;
            let Ok(due) = Duration::try_from_secs_f64(due_s) else {
                *last_ping_s = now_s;
                return ToVehicle::Ping(Ping { stamp_s: now_s });
            };
            let waited = self.changed.wait_timeout(waiting, due);
            waiting = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn message(motion: Motion, seq: u64, stamp_s: f64) -> ToVehicle {
    match motion {
        Some([forward_m_per_s, sideways_m_per_s, turn_rad_per_s]) => ToVehicle::Drive(Drive {
            seq,
            stamp_s,
            lease_s: LEASE_S,
            forward_m_per_s,
            sideways_m_per_s,
            turn_rad_per_s,
        }),
        None => ToVehicle::Stop(Stop { seq, stamp_s }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn next(outbox: &Outbox) -> ToVehicle {
        outbox.next(|| 0.0, &mut 0.0)
    }

    #[test]
    fn only_the_newest_command_waits() {
        let outbox = Outbox::default();
        for speed in [0.1, 0.2, 0.3] {
            outbox.command(Some([speed, 0.0, 0.0]), 0, 0.0);
        }
        assert!(
            matches!(next(&outbox), ToVehicle::Drive(Drive { seq: 1, forward_m_per_s, .. }) if forward_m_per_s.to_bits() == 0.3_f64.to_bits())
        );
        outbox.close();
        assert!(matches!(next(&outbox), ToVehicle::Bye(_)));
    }

    #[test]
    fn a_motion_older_than_its_lease_is_not_sent_but_a_stop_is() {
        let outbox = Outbox::default();
        let drive = Some([0.3, 0.0, 0.0]);
        let at = |now_s: f64| {
            let mut last_ping_s = f64::NEG_INFINITY;
            outbox.next(|| now_s, &mut last_ping_s)
        };
        outbox.command(drive, 0, 1.0);
        assert!(matches!(at(1.0 + LEASE_S), ToVehicle::Drive(Drive { seq: 1, .. })));
        // The process is stopped before the motion is written, and continues later.
        outbox.command(drive, 0, 2.0);
        assert!(matches!(at(2.01 + LEASE_S), ToVehicle::Ping(_)), "dropped");
        assert!(matches!(at(2.02 + LEASE_S), ToVehicle::Ping(_)), "not kept for later");
        outbox.command(None, 0, 3.0);
        assert!(matches!(at(9.0), ToVehicle::Stop(Stop { seq: 2, .. })));
        outbox.command(drive, 0, 9.0);
        outbox.brake();
        assert!(matches!(at(20.0), ToVehicle::Stop(Stop { seq: 3, .. })));
    }

    #[test]
    fn after_the_brake_no_motion_is_sent_until_the_mission_has_held() {
        let outbox = Outbox::default();
        let drive = Some([0.3, 0.0, 0.0]);
        outbox.command(drive, 0, 0.0);
        outbox.brake();
        assert!(matches!(next(&outbox), ToVehicle::Stop(Stop { seq: 1, .. })));
        outbox.command(drive, 0, 0.0);
        assert!(matches!(next(&outbox), ToVehicle::Stop(_)), "a tick that had begun before the brake");
        outbox.command(None, 1, 0.0);
        assert!(matches!(next(&outbox), ToVehicle::Stop(_)));
        outbox.command(drive, 0, 0.0);
        assert!(matches!(next(&outbox), ToVehicle::Drive(Drive { seq: 4, .. })));
    }

    #[test]
    fn a_brake_is_released_only_by_its_own_order() {
        let outbox = Outbox::default();
        let drive = Some([0.3, 0.0, 0.0]);
        // HOLD, resume, HOLD within a tick: the tick carries out the first two.
        outbox.brake();
        outbox.brake();
        outbox.command(drive, 1, 0.0);
        assert!(matches!(next(&outbox), ToVehicle::Stop(_)));
        // A tick of a held mission does not carry out the third order, either.
        outbox.command(None, 0, 0.0);
        outbox.command(drive, 0, 0.0);
        assert!(matches!(next(&outbox), ToVehicle::Stop(_)));
        outbox.release();
        outbox.command(drive, 0, 0.0);
        assert!(matches!(next(&outbox), ToVehicle::Drive(_)));
    }
}
