//! A worker process as a state machine: it receives requests and is polled when something has happened, but nothing
//! ever waits for it.

mod end;
mod exchange;
mod guard;
mod scale;
mod state;

use super::ending::{how_it_ended, last_line};
use super::load::memory_of;
use super::process::Process;
use super::ready::{Ready, Source, Watched};
use super::tape::Tape;
use super::{Failure, WorkerCommand, no_worker, soft};
use crate::Progress;
use crate::stats::Memory;
use crate::wire::answer::{Described, Planners, Sealed};
use crate::wire::body::{Writer, whole};
use crate::wire::frame::Incoming;
use guard::Guard;
use rustix::event::PollFlags;
use scale::Scale;
use state::{Request, State};
use std::io::{ErrorKind, Write};
use std::os::fd::AsFd;
use std::os::unix::net::UnixStream;
use std::time::{Duration, Instant};

/// Polling period where the system does not report the exit of a process.
const EXIT_POLL_PERIOD: Duration = Duration::from_millis(1);

/// A worker process, its socket and its output.
pub(crate) struct Worker {
    process: Process,
    socket: UnixStream,
    incoming: Incoming,
    guard: Guard,
    /// The frame that is being sent, or the last frame that was sent.
    writer: Writer,
    /// The number of bytes of that frame that have already been sent.
    n_sent: usize,
    sequence: u32,
    state: State,
    scale: Scale,
    tape: Tape,
    /// Whether the worker was idle when it was asked to exit.
    leaves_idle: bool,
    /// How the worker ended, if it was asked to exit but did not exit cleanly; completes a sentence that begins with
    /// the planner's name.
    bad_end: Option<String>,
}

impl Worker {
    /// Starts a worker for a planner with this memory limit, bytes, without loading anything.
    pub(crate) fn spawn(command: &WorkerCommand, memory_limit_bytes: u64) -> Result<Self, Failure> {
        let start = || {
            let (socket, theirs) = UnixStream::pair()?;
            socket.set_nonblocking(true)?;
            Ok((Process::spawn(command, theirs)?, socket))
        };
        let (process, socket) = start()
            .map_err(|error: std::io::Error| Failure::Console(no_worker("cannot be started", &error)))?;
        let (incoming, writer) = (Incoming::default(), Writer::default());
        let (guard, scale) = (Guard::new(memory_limit_bytes), Scale::new(memory_limit_bytes));
        let (state, tape) = (State::Idle, Tape::default());
        Ok(Self {
            process,
            socket,
            incoming,
            guard,
            writer,
            n_sent: 0,
            sequence: 0,
            state,
            scale,
            tape,
            leaves_idle: false,
            bad_end: None,
        })
    }

    /// Whether the process has ended and has been reaped.
    pub(crate) fn is_gone(&self) -> bool {
        matches!(self.state, State::Gone)
    }

    /// Reads the planners of the plugin that was loaded, and the worker's earlier report on its sandbox.
    pub(crate) fn take_planners(&mut self) -> Result<(Sealed, Vec<Described>), Failure> {
        let Planners(planners) = self.take_answer(whole)?;
        // A worker that answers without that report has not entered its sandbox.
        let sealed = self.guard.sealed().cloned();
        sealed.map(|sealed| (sealed, planners)).ok_or_else(|| self.end(Failure::Protocol))
    }

    /// Binds the worker's first thread, which answers requests, to these processors, and with it every thread that it
    /// starts from now on. If the system refuses, nothing changes.
    #[cfg(target_os = "linux")]
    pub(crate) fn stay_on(&self, processors: &rustix::thread::CpuSet) {
        if !self.process.is_reaped() {
            let _ = rustix::thread::sched_setaffinity(Some(self.process.pid()), processors);
        }
    }

    /// Takes the lines printed since the last call.
    pub(crate) fn take_printed(&mut self) -> Vec<String> {
        self.process.take_lines()
    }

    /// Takes the description of how the worker exited on request, if it did not exit cleanly. The text completes a
    /// sentence that begins with the planner's name.
    pub(crate) fn take_bad_end(&mut self) -> Option<String> {
        self.bad_end.take()
    }

    /// Takes the last lines printed, once the process has ended.
    pub(crate) fn take_last_printed(&mut self) -> Vec<String> {
        self.process.read_output();
        self.process.take_lines()
    }

    /// Returns the last requests as they were sent, and the end of the output.
    pub(crate) fn remains(&mut self) -> (Vec<u8>, String) {
        self.process.read_output();
        (self.tape.bytes(), String::from_utf8_lossy(self.process.tail()).into_owned())
    }

    /// Returns the memory of the process, where the system reports it.
    pub(crate) fn memory(&self) -> Option<Memory> {
        memory_of(self.process.pid()).filter(|_| !self.process.is_reaped())
    }

    /// Whether the worker can accept a request.
    pub(crate) fn is_idle(&self) -> bool {
        matches!(self.state, State::Idle)
    }

    /// Whether the process has ended although it was asked for nothing.
    pub(crate) fn has_ended_idle(&mut self) -> bool {
        self.is_idle() && self.process.reap().is_some()
    }

    /// Takes the end of a process that ended although it was asked for nothing.
    pub(crate) fn take_idle_end(&mut self) -> Option<Failure> {
        if !self.has_ended_idle() {
            return None;
        }
        self.process.read_output();
        self.state = State::Gone;
        let last_output = last_line(self.process.tail());
        Some(Failure::Died { how: how_it_ended(self.process.reap()), last_output })
    }

    /// Sends a request; [`Self::advance`] returns the outcome.
    ///
    /// # Errors
    /// The process no longer exists, or the request is too long.
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
            // After its last answer, the worker sent something without being asked.
            self.kill();
            return Err(Failure::Protocol);
        }
        let now = Instant::now();
        self.sequence = self.sequence.wrapping_add(1);
        let microseconds = u32::try_from(soft(budget).as_micros()).unwrap_or(u32::MAX).max(1);
        write(self.writer.begin(kind, self.sequence, microseconds));
        self.writer.finish().map_err(|length| {
            Failure::Console(format!("cannot be asked: the request has {length} bytes; the limit is 16 MiB"))
        })?;
        self.tape.note(kind, self.writer.frame());
        self.n_sent = 0;
        self.state = State::Busy(Request::new(kind, budget, now));
        self.scale.begin(now);
        self.send(now);
        Ok(())
    }

    /// Writes as much of the frame as the socket can accept.
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

    /// Kills a busy worker that uses too much memory.
    fn weigh(&mut self, now: Instant) -> Option<Failure> {
        let is_busy = matches!(self.state, State::Busy(_) | State::Cancelling(..));
        let limit = self.scale.weigh(self.process.pid(), now).filter(|_| is_busy)?;
        Some(self.end(Failure::Overweight(limit)))
    }

    fn has_sent(&self) -> bool {
        self.n_sent == self.writer.frame().len()
    }

    /// Reports every descriptor with events that may change the state.
    pub(super) fn watched<'a>(&'a self, mut watch: impl FnMut(Watched<'a>)) {
        match &self.state {
            State::Idle | State::Gone => return,
            State::Busy(_) | State::Cancelling(..) => {
                let out = if self.has_sent() { PollFlags::empty() } else { PollFlags::OUT };
                watch((Source::Socket, self.socket.as_fd(), PollFlags::IN | out));
                if let Some(calls) = self.guard.calls() {
                    watch((Source::Calls, calls, PollFlags::IN));
                }
            }
            State::Leaving(Some(_)) => {
                if let Some(calls) = self.guard.calls() {
                    watch((Source::Calls, calls, PollFlags::IN));
                }
            }
            State::Dying(_) | State::Leaving(None) => {}
        }
        if let Some(pidfd) = self.process.pidfd().filter(|_| !self.process.is_reaped()) {
            watch((Source::Exit, pidfd, PollFlags::IN));
        }
        if let Some(output) = self.process.output().filter(|_| !matches!(self.state, State::Leaving(_))) {
            watch((Source::Output, output, PollFlags::IN));
        }
    }

    /// Returns when the worker must be checked even if nothing has happened.
    pub(super) fn wake_at(&self) -> Option<Instant> {
        let at = match &self.state {
            State::Idle | State::Gone => return None,
            State::Busy(request) => return Some(request.look_at.min(self.scale.look_at())),
            State::Cancelling(_, until) => return Some((*until).min(self.scale.look_at())),
            State::Dying(dying) => Some(dying.until),
            State::Leaving(until) => *until,
        };
        let is_blind = self.process.pidfd().is_none() && !self.process.is_reaped();
        let look = is_blind.then(|| Instant::now() + EXIT_POLL_PERIOD);
        at.into_iter().chain(look).min()
    }

    /// Handles the events and deadlines that are due. Returns the outcome of the request once there is one; after `Ok`,
    /// its answer can be taken.
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
                let outcome = self.exchange(ready, now, on_progress);
                let outcome = outcome.or_else(|| self.weigh(now).map(Err));
                outcome.or_else(|| self.keep_deadline(now).map(Err))
            }
            State::Dying(_) => self.advance_dying(ready, now).map(Err),
            State::Leaving(until) => {
                self.advance_leaving(ready, *until, now);
                None
            }
        }
    }
}

#[cfg(test)]
mod tests;
