//! A worker process as a state machine: it is asked, looked at when something has happened, and never waited for.

mod state;

use super::ending::{how_it_ended, last_line};
use super::load::load_of;
use super::poller::{Ready, Source, Watched, wait_for_one};
use super::process::Process;
use super::{Failure, SHUT_DOWN_WITHIN, WorkerCommand, soft};
use crate::Progress;
use crate::wire::body::{Body, Malformed, Read, Writer};
use crate::wire::frame::{Filled, Incoming};
use crate::wire::kind;
use rustix::event::PollFlags;
use rustix::process::Signal;
use state::{Budgeted, DIE_WITHIN, Dying, Request, State};
use std::io::{ErrorKind, Write};
use std::net::Shutdown;
use std::os::fd::AsFd;
use std::os::unix::net::UnixStream;
use std::os::unix::process::ExitStatusExt;
use std::time::{Duration, Instant};

/// A worker that did not answer within its budget is asked to stop and given this long before it is killed.
const GRACE: Duration = Duration::from_millis(100);
/// Polling period where the system does not report the exit of a process.
const LOOK_EVERY: Duration = Duration::from_millis(1);

/// A worker process, its socket and its output.
pub(crate) struct Worker {
    process: Process,
    socket: UnixStream,
    incoming: Incoming,
    /// The frame that is being sent, or was sent last.
    writer: Writer,
    /// Bytes of it that were written.
    n_sent: usize,
    sequence: u32,
    state: State,
}

/// What has arrived from a worker.
enum Arrived {
    Nothing,
    Answer,
    Closed,
    Broken,
}

impl Worker {
    /// Starts a worker; nothing is loaded yet.
    pub(crate) fn spawn(command: &WorkerCommand) -> Result<Self, Failure> {
        let start = || {
            let (socket, theirs) = UnixStream::pair()?;
            socket.set_nonblocking(true)?;
            Ok((Process::spawn(command, theirs)?, socket))
        };
        let (process, socket) = start().map_err(|error: std::io::Error| {
            Failure::Console(format!("cannot be run, no worker process could be started: {error}"))
        })?;
        let (incoming, writer) = (Incoming::default(), Writer::default());
        Ok(Self { process, socket, incoming, writer, n_sent: 0, sequence: 0, state: State::Idle })
    }

    /// Whether the process has ended and was reaped.
    pub(crate) fn is_gone(&self) -> bool {
        matches!(self.state, State::Gone)
    }

    /// Whether it can be asked.
    pub(crate) fn is_idle(&self) -> bool {
        matches!(self.state, State::Idle)
    }

    /// Asks; the outcome comes from [`Self::advance`].
    ///
    /// # Errors
    /// There is no process any more, or the request is too long.
    pub(crate) fn ask(
        &mut self,
        kind: u8,
        budget: Duration,
        write: impl FnOnce(&mut Writer),
    ) -> Result<(), Failure> {
        if !self.is_idle() {
            return Err(Failure::Gone);
        }
        if self.incoming.has_more() {
            // It said something after its last answer, when nobody had asked.
            self.kill();
            return Err(Failure::Protocol);
        }
        let now = Instant::now();
        self.sequence = self.sequence.wrapping_add(1);
        let microseconds = u32::try_from(soft(budget).as_micros()).unwrap_or(u32::MAX).max(1);
        write(self.writer.begin(kind, self.sequence, microseconds));
        self.writer.finish().map_err(|length| {
            Failure::Console(format!("cannot be asked: the request has {length} bytes, 16 MiB is the most"))
        })?;
        self.n_sent = 0;
        self.state = State::Busy(Request::new(kind, budget, now));
        self.send(now);
        Ok(())
    }

    /// Writes as much as there is room for.
    fn send(&mut self, now: Instant) {
        loop {
            let rest = &self.writer.frame()[self.n_sent..];
            if rest.is_empty() {
                return;
            }
            match self.socket.write(rest) {
                Ok(n) => self.n_sent += n,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => return,
                Err(_) => return self.lose(now),
            }
        }
    }

    fn has_sent(&self) -> bool {
        self.n_sent == self.writer.frame().len()
    }

    /// Asks the planner to stop; one that does not even read the request is not asked.
    fn send_cancel(&mut self, now: Instant) {
        if self.has_sent() && self.writer.begin(kind::CANCEL, self.sequence, 0).finish().is_ok() {
            self.n_sent = 0;
            self.send(now);
        }
    }

    /// Reports every descriptor that may change the state.
    pub(super) fn watched<'a>(&'a self, mut watch: impl FnMut(Watched<'a>)) {
        match &self.state {
            State::Idle | State::Gone => return,
            State::Busy(_) | State::Cancelling(..) => {
                let out = if self.has_sent() { PollFlags::empty() } else { PollFlags::OUT };
                watch((Source::Socket, self.socket.as_fd(), PollFlags::IN | out));
            }
            State::Dying(_) | State::Leaving(_) => {}
        }
        if let Some(pidfd) = self.process.pidfd().filter(|_| !self.process.is_reaped()) {
            watch((Source::Exit, pidfd, PollFlags::IN));
        }
        if let Some(output) = self.process.output().filter(|_| !matches!(self.state, State::Leaving(_))) {
            watch((Source::Output, output, PollFlags::IN));
        }
    }

    /// When it has to be looked at although nothing has happened.
    pub(super) fn wake_at(&self) -> Option<Instant> {
        let at = match &self.state {
            State::Idle | State::Gone => return None,
            State::Busy(request) => return Some(request.look_at),
            State::Cancelling(_, until) => return Some(*until),
            State::Dying(dying) => Some(dying.until),
            State::Leaving(until) => *until,
        };
        let is_blind = self.process.pidfd().is_none() && !self.process.is_reaped();
        let look = is_blind.then(|| Instant::now() + LOOK_EVERY);
        at.into_iter().chain(look).min()
    }

    /// Does what is due; the outcome of the request, once there is one. After `Ok` its answer can be taken.
    pub(crate) fn advance(
        &mut self,
        ready: Ready,
        now: Instant,
        on_progress: &mut dyn FnMut(&Progress),
    ) -> Option<Result<(), Failure>> {
        if ready.printed {
            self.process.read_output();
        }
        match &self.state {
            State::Idle | State::Gone => None,
            State::Busy(_) | State::Cancelling(..) => {
                self.exchange(ready, now, on_progress).or_else(|| self.keep_deadline(now).map(Err))
            }
            State::Dying(_) => self.advance_dying(ready, now).map(Err),
            State::Leaving(until) => {
                self.advance_leaving(*until, now);
                None
            }
        }
    }

    fn exchange(
        &mut self,
        ready: Ready,
        now: Instant,
        on_progress: &mut dyn FnMut(&Progress),
    ) -> Option<Result<(), Failure>> {
        if ready.writable() {
            self.send(now);
        }
        let arrived = if ready.readable() { self.receive(now, on_progress) } else { Arrived::Nothing };
        match arrived {
            Arrived::Answer if matches!(self.state, State::Busy(_)) => {
                self.state = State::Idle;
                return Some(Ok(()));
            }
            Arrived::Answer => return Some(Err(self.end(Failure::Late))),
            Arrived::Broken => return Some(Err(self.end(Failure::Protocol))),
            Arrived::Closed => self.lose(now),
            // Only when there is nothing more to read the end of the process is the end of the request.
            Arrived::Nothing if ready.exited && !ready.readable() => self.lose(now),
            Arrived::Nothing => {}
        }
        None
    }

    /// Reads once, and forwards progress messages.
    fn receive(&mut self, now: Instant, on_progress: &mut dyn FnMut(&Progress)) -> Arrived {
        let mut has_read = false;
        loop {
            match self.incoming.next_frame() {
                None if has_read => return Arrived::Nothing,
                None => match self.incoming.fill(&mut self.socket) {
                    Filled::Some => has_read = true,
                    Filled::Nothing => return Arrived::Nothing,
                    Filled::Closed => return Arrived::Closed,
                    Filled::Broken => return Arrived::Broken,
                },
                Some(Ok(())) if self.incoming.sequence() != self.sequence => return Arrived::Broken,
                Some(Ok(())) if self.incoming.kind() != kind::PROGRESS => return Arrived::Answer,
                Some(Ok(())) if self.forward_progress(now, on_progress).is_ok() => {}
                Some(_) => return Arrived::Broken,
            }
        }
    }

    /// Forwards a progress message, unless the rate limit is reached.
    fn forward_progress(&mut self, now: Instant, on_progress: &mut dyn FnMut(&Progress)) -> Read<()> {
        let (State::Busy(request) | State::Cancelling(request, _)) = &mut self.state else {
            return Err(Malformed);
        };
        if request.kind != kind::PLAN {
            return Err(Malformed);
        }
        let mut body = self.incoming.body();
        let progress = body.progress()?;
        body.end()?;
        if request.may_forward(now) {
            on_progress(&progress);
        }
        Ok(())
    }

    /// Takes a look when it is time, and ends what used up its budget.
    fn keep_deadline(&mut self, now: Instant) -> Option<Failure> {
        match &mut self.state {
            State::Busy(request) if now >= request.look_at => {
                match request.look(now, load_of(self.process.pid())) {
                    Budgeted::Left => None,
                    Budgeted::Exhausted => {
                        self.cancel(now);
                        None
                    }
                    Budgeted::Starved => Some(self.end(Failure::Starved)),
                }
            }
            State::Cancelling(_, until) if now >= *until => Some(self.end(Failure::Hung)),
            _ => None,
        }
    }

    fn cancel(&mut self, now: Instant) {
        if let State::Busy(request) = std::mem::replace(&mut self.state, State::Gone) {
            self.state = State::Cancelling(request, now + GRACE);
            self.send_cancel(now);
        }
    }

    /// Reads the answer that has just arrived. If it is malformed, or says that the planner cannot continue, the process is
    /// killed.
    pub(crate) fn take_answer<T>(
        &mut self,
        read: impl FnOnce(&mut Body<'_>) -> Read<T>,
    ) -> Result<T, Failure> {
        match interpret(self.incoming.kind(), self.incoming.body(), read) {
            Ok(Err(failure)) if failure.ends_the_process() => Err(self.end(failure)),
            Ok(answer) => answer,
            Err(Malformed) => Err(self.end(Failure::Protocol)),
        }
    }

    /// Kills the process for this failure.
    fn end(&mut self, failure: Failure) -> Failure {
        self.kill();
        failure
    }

    /// The channel is lost: how the process ended is the outcome.
    fn lose(&mut self, now: Instant) {
        self.state = State::Dying(Dying::new(now));
    }

    /// Waits for the end of the process and for its last output; how it ended, once that is known.
    fn advance_dying(&mut self, ready: Ready, now: Instant) -> Option<Failure> {
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
            // A process that was slow to end keeps its own reason; only one that lives on is ended by our signal.
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

    /// Lets the process exit by itself within a grace period, so that the planner is dropped cleanly; an open request has
    /// no outcome any more.
    pub(crate) fn shut_down(&mut self) {
        let now = Instant::now();
        match self.state {
            State::Gone | State::Leaving(_) => return,
            State::Dying(_) => return self.kill(),
            State::Busy(_) | State::Cancelling(..) => self.send_cancel(now),
            State::Idle => {}
        }
        match self.socket.shutdown(Shutdown::Write) {
            // The socket stays open until the worker has ended: it takes a full hang-up for the console's death.
            Ok(()) => self.state = State::Leaving(Some(now + SHUT_DOWN_WITHIN)),
            Err(_) => self.kill(),
        }
    }

    /// Kills the process; an open request has no outcome any more.
    pub(crate) fn kill(&mut self) {
        if !self.is_gone() {
            self.process.kill();
            self.state = if self.process.reap().is_some() { State::Gone } else { State::Leaving(None) };
        }
    }

    fn advance_leaving(&mut self, until: Option<Instant>, now: Instant) {
        if self.process.reap().is_some() {
            self.state = State::Gone;
        } else if until.is_some_and(|until| now >= until) {
            self.kill();
        }
    }
}

fn interpret<T>(
    kind: u8,
    mut body: Body<'_>,
    read: impl FnOnce(&mut Body<'_>) -> Read<T>,
) -> Read<Result<T, Failure>> {
    let answer = match kind {
        kind::DONE => Ok(read(&mut body)?),
        kind::FAILED => Err(Failure::Planner(body.refusal()?)),
        kind::REFUSED => Err(Failure::Refused(body.text()?)),
        _ => return Err(Malformed),
    };
    body.end()?;
    Ok(answer)
}

impl Drop for Worker {
    /// Nobody looks at it any more: it is killed, and reaped unless the system is stuck.
    fn drop(&mut self) {
        self.kill();
        let until = Instant::now() + DIE_WITHIN;
        while !self.is_gone() && Instant::now() < until {
            let ready = wait_for_one(self, Some(until));
            self.advance(ready, Instant::now(), &mut |_| {});
        }
    }
}

#[cfg(test)]
mod tests;
