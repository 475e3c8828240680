//! How a worker ends: on its own, on request, or by being killed. It is polled and never waited for, except when it is
//! dropped.

use super::Worker;
use super::state::{DIE_WITHIN, Dying, State};
use crate::supervisor::Failure;
use crate::supervisor::ending::{how_it_ended, last_line};
use crate::supervisor::poller::wait_for_one;
use crate::supervisor::ready::Ready;
use crate::wire::SHUT_DOWN_WITHIN;
use rustix::process::Signal;
use std::net::Shutdown;
use std::os::unix::process::ExitStatusExt;
use std::time::Instant;

/// The description of a worker that did not exit on request and was killed.
const LATE: &str = "took more than 0.1 s to shut down";

impl Worker {
    /// Kills the process for this failure.
    pub(super) fn end(&mut self, failure: Failure) -> Failure {
        self.kill();
        failure
    }

    /// Handles a lost channel: the way in which the process ends becomes the outcome.
    pub(super) fn lose(&mut self, now: Instant) {
        self.state = State::Dying(Dying::new(now));
    }

    /// Waits until the process has ended and its last output has arrived. Returns how it ended, once that is known.
    pub(super) fn advance_dying(&mut self, ready: Ready, now: Instant) -> Option<Failure> {
        let State::Dying(dying) = &mut self.state else { return None };
        let may_have_ended = ready.exited || self.process.pidfd().is_none() || now >= dying.until;
        if !self.process.is_reaped() && may_have_ended && self.process.reap().is_some() {
            dying.wait_for_output(now);
        }
        let is_known = self.process.is_reaped() && self.process.output().is_none();
        if !is_known && now < dying.until {
            return None;
        }
        if !self.process.is_reaped() && !dying.is_killed {
            // A process that ends slowly keeps its own reason for ending; the signal kills only a process that is still
            // alive.
            self.process.kill();
            dying.wait_for_kill(now);
            return None;
        }
        let by_us = Some(Signal::KILL.as_raw()).filter(|_| dying.is_killed);
        let status = self.process.reap();
        self.state = if status.is_some() { State::Gone } else { State::Leaving(None) };
        let status = status.filter(|status| by_us.is_none() || status.signal() != by_us);
        Some(Failure::Died { how: how_it_ended(status), last_output: last_line(self.process.tail()) })
    }

    /// Lets the process exit within a grace period, so that the planner is destroyed cleanly. An open request then has
    /// no outcome.
    pub(crate) fn shut_down(&mut self) {
        let now = Instant::now();
        self.process.read_output();
        match self.state {
            State::Gone | State::Leaving(_) => return,
            State::Dying(_) => return self.kill(),
            State::Busy(_) | State::Cancelling(..) => self.send_cancel(now),
            State::Idle => self.leaves_idle = true,
        }
        match self.socket.shutdown(Shutdown::Write) {
            // The socket stays open until the worker has ended, because the worker would take a full hang-up to mean
            // that the console has died.
            Ok(()) => self.state = State::Leaving(Some(now + SHUT_DOWN_WITHIN)),
            Err(_) => self.kill(),
        }
    }

    /// Kills the process. An open request then has no outcome.
    pub(crate) fn kill(&mut self) {
        if !self.is_gone() {
            self.process.kill();
            self.state = if self.process.reap().is_some() { State::Gone } else { State::Leaving(None) };
        }
    }

    pub(super) fn advance_leaving(&mut self, ready: Ready, until: Option<Instant>, now: Instant) {
        let call = until.filter(|_| ready.called).and_then(|_| self.guard.decide());
        if let Some(call) = call {
            self.end_badly(format!("tried a forbidden system call ({call})"));
            self.kill();
        } else if let Some(status) = self.process.reap() {
            self.state = State::Gone;
            if until.is_some() && !status.success() {
                // The worker's own watchdog kills it when the grace period is over.
                let is_late = status.signal() == Some(Signal::KILL.as_raw());
                self.end_badly(if is_late { LATE.to_owned() } else { how_it_ended(Some(status)) });
            }
        } else if until.is_some_and(|until| now >= until) {
            self.end_badly(LATE.to_owned());
            self.kill();
        }
    }

    /// Notes a bad end, unless the worker was interrupted during a request: only an idle worker can exit cleanly.
    fn end_badly(&mut self, how: String) {
        if self.leaves_idle {
            self.bad_end.get_or_insert(how);
        }
    }
}

impl Drop for Worker {
    /// Nothing polls the worker any more, so it is killed and, unless the system is stuck, reaped.
    fn drop(&mut self) {
        self.kill();
        let until = Instant::now() + DIE_WITHIN;
        while !self.is_gone() && Instant::now() < until {
            let ready = wait_for_one(self, Some(until));
            self.advance(ready, Instant::now(), &mut |_| {});
        }
    }
}
