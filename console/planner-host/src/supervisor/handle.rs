//! A running worker.

use super::child::Supervised;
use super::{Failure, GRACE, WorkerCommand, soft};
use crate::OnProgress;
use crate::wire::body::{Body, Malformed, Read, Writer};
use crate::wire::frame::{Incoming, Received};
use crate::wire::kind;
use std::io::Write;
use std::net::Shutdown;
use std::os::unix::net::UnixStream;
use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};
use std::time::{Duration, Instant};

/// A worker that does not read for this long is stuck.
const WRITE_WITHIN: Duration = Duration::from_millis(500);
/// How often somebody who may want a plan no more is looked at.
const LOOK_EVERY: Duration = Duration::from_millis(50);
/// Progress of a plan is passed on this often, per second, with so much over at first; the rest of a flood is left out. A
/// worker that is well tells 20 a second.
const MOST_PER_S: f64 = 40.0;
const MOST_AT_FIRST: f64 = 20.0;

/// A worker process, its socket and its output.
pub(crate) struct Worker {
    child: Supervised,
    socket: UnixStream,
    incoming: Incoming,
    writer: Writer,
    sequence: u32,
    is_gone: bool,
    /// Set when no plan is wanted any more.
    stop: Option<Arc<AtomicBool>>,
    /// Who is told how far a plan is.
    on_progress: Option<OnProgress>,
    /// When the request at hand was asked, and how often its progress was passed on.
    passed_on: (Instant, u32),
}

impl Worker {
    /// Starts a worker; nothing is loaded yet.
    pub(crate) fn spawn(command: &WorkerCommand) -> Result<Self, Failure> {
        let start = || {
            let (socket, theirs) = UnixStream::pair()?;
            socket.set_write_timeout(Some(WRITE_WITHIN))?;
            Ok((Supervised::spawn(command, theirs)?, socket))
        };
        let (child, socket) = start().map_err(|error: std::io::Error| {
            Failure::Console(format!("cannot be run, no worker process could be started: {error}"))
        })?;
        let (incoming, writer) = (Incoming::default(), Writer::default());
        Ok(Self {
            child,
            socket,
            incoming,
            writer,
            sequence: 0,
            is_gone: false,
            stop: None,
            on_progress: None,
            passed_on: (Instant::now(), 0),
        })
    }

    /// From now on a plan is given up when this is set.
    pub(crate) fn stop_on(&mut self, stop: Arc<AtomicBool>) {
        self.stop = Some(stop);
    }

    /// From now on somebody is told how far a plan is.
    pub(crate) fn tell_progress(&mut self, on_progress: OnProgress) {
        self.on_progress = Some(on_progress);
    }

    /// Whether a plan is wanted no more.
    fn is_stopped(&self, kind: u8) -> bool {
        kind == kind::PLAN && self.stop.as_ref().is_some_and(|stop| stop.load(Ordering::Relaxed))
    }

    /// Whether the process has ended or was killed.
    pub(crate) fn is_gone(&self) -> bool {
        self.is_gone
    }

    /// Asks and waits for the answer: to the deadline, then asks it to stop, then kills it.
    pub(crate) fn ask<T>(
        &mut self,
        kind: u8,
        deadline: Duration,
        write: impl FnOnce(&mut Writer),
        read: impl FnOnce(&mut Body<'_>) -> Read<T>,
    ) -> Result<T, Failure> {
        if self.is_gone {
            return Err(Failure::Gone);
        }
        if self.is_stopped(kind) {
            return Err(Failure::Stopped);
        }
        let asked = Instant::now();
        let until = asked + deadline;
        self.passed_on = (asked, 0);
        self.send(kind, soft(deadline), write)?;
        let in_time = match self.receive(kind, until) {
            Received::Late => {
                self.send_cancel();
                let received = self.await_answer(kind, Instant::now() + GRACE);
                let arrived = self.expect_frame(&received);
                if self.is_stopped(kind) {
                    return Err(Failure::Stopped);
                }
                arrived.map(|()| false)?
            }
            other => self.expect_frame(&other).map(|()| true)?,
        };
        let answer = self.answer(read);
        if in_time { answer } else { Err(Failure::Late) }
    }

    /// Waits for the answer to a deadline, or until a plan is wanted no more.
    fn receive(&mut self, kind: u8, until: Instant) -> Received {
        loop {
            let next = if self.stop.is_some() { until.min(Instant::now() + LOOK_EVERY) } else { until };
            match self.await_answer(kind, next) {
                Received::Late if next < until && !self.is_stopped(kind) => {}
                other => return other,
            }
        }
    }

    /// Waits for the answer to a moment; what a planner tells before of its progress is passed on and gains it no time.
    fn await_answer(&mut self, kind: u8, until: Instant) -> Received {
        loop {
            let received = self.incoming.receive(&mut self.socket, Some(until));
            if received != Received::Frame || self.incoming.kind() != kind::PROGRESS {
                return received;
            }
            if self.pass_on(kind) == Err(Malformed) {
                return Received::Broken;
            }
            if Instant::now() >= until {
                return Received::Late;
            }
        }
    }

    /// Tells how far the plan is, unless it was told too often.
    fn pass_on(&mut self, kind: u8) -> Read<()> {
        if kind != kind::PLAN || self.incoming.sequence() != self.sequence {
            return Err(Malformed);
        }
        let mut body = self.incoming.body();
        let progress = body.progress()?;
        body.end()?;
        let (asked, times) = &mut self.passed_on;
        let most = MOST_AT_FIRST + MOST_PER_S * asked.elapsed().as_secs_f64();
        if let Some(tell) = self.on_progress.as_ref().filter(|_| f64::from(*times) < most) {
            *times += 1;
            tell(&progress);
        }
        Ok(())
    }

    fn send(&mut self, kind: u8, soft: Duration, write: impl FnOnce(&mut Writer)) -> Result<(), Failure> {
        self.sequence = self.sequence.wrapping_add(1);
        let microseconds = u32::try_from(soft.as_micros()).unwrap_or(u32::MAX).max(1);
        write(self.writer.begin(kind, self.sequence, microseconds));
        let frame = self.writer.finish().map_err(|length| {
            Failure::Console(format!("cannot be asked: the request has {length} bytes, 16 MiB is the most"))
        })?;
        if self.socket.write_all(frame).is_ok() { Ok(()) } else { Err(self.died()) }
    }

    fn send_cancel(&mut self) {
        if let Ok(frame) = self.writer.begin(kind::CANCEL, self.sequence, 0).finish() {
            // If it cannot be written, waiting for the answer tells why.
            let _ = self.socket.write_all(frame);
        }
    }

    fn expect_frame(&mut self, received: &Received) -> Result<(), Failure> {
        match received {
            Received::Frame => Ok(()),
            Received::Closed => Err(self.died()),
            Received::Late => {
                self.kill();
                Err(Failure::Hung)
            }
            Received::Broken => {
                self.kill();
                Err(Failure::Protocol)
            }
        }
    }

    fn answer<T>(&mut self, read: impl FnOnce(&mut Body<'_>) -> Read<T>) -> Result<T, Failure> {
        let answer = if self.incoming.sequence() == self.sequence {
            interpret(self.incoming.kind(), self.incoming.body(), read)
        } else {
            Err(Malformed)
        };
        answer.unwrap_or_else(|Malformed| {
            self.kill();
            Err(Failure::Protocol)
        })
    }

    fn died(&mut self) -> Failure {
        self.is_gone = true;
        let (how, last_output) = self.child.obituary();
        Failure::Died { how, last_output }
    }

    /// Kills the process.
    pub(crate) fn kill(&mut self) {
        self.is_gone = true;
        self.child.kill();
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
    /// A worker that is well ends by itself when it reads that nothing more comes, so that the planner is dropped in
    /// good order; nobody waits for it here.
    fn drop(&mut self) {
        if !self.is_gone && self.socket.shutdown(Shutdown::Write).is_ok() {
            // The socket stays open until the worker has ended: it takes a full hang-up for the console's death.
            if let Ok(socket) = self.socket.try_clone() {
                self.child.see_off(socket);
            }
        }
    }
}

#[cfg(test)]
mod tests;
