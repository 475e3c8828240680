//! Exchanges a request and its answer, and enforces the deadline.

use super::Worker;
use super::state::{Budgeted, State};
use crate::Progress;
use crate::checks::limits::Text;
use crate::supervisor::Failure;
use crate::supervisor::ending::last_line;
use crate::supervisor::load::load_of;
use crate::supervisor::ready::Ready;
use crate::wire::body::{Body, Malformed, Read, whole};
use crate::wire::frame::Filled;
use crate::wire::kind;
use std::time::{Duration, Instant};

/// Time between the request to stop and the kill. A worker that does not answer within its budget is asked to stop, and
/// is killed if it has still not answered after this time.
const GRACE: Duration = Duration::from_millis(100);

/// What has arrived from a worker.
enum Arrived {
    Nothing,
    Answer,
    Closed,
    Broken,
}

impl Worker {
    pub(super) fn exchange(
        &mut self,
        ready: Ready,
        now: Instant,
        on_progress: &mut dyn FnMut(&Progress),
    ) -> Option<Result<(), Failure>> {
        if ready.called
            && let Some(call) = self.guard.decide()
        {
            self.process.read_output();
            let last_output = last_line(self.process.tail());
            return Some(Err(self.end(Failure::Forbidden { call, last_output })));
        }
        if ready.writable() {
            self.send(now);
        }
        let arrived = if ready.readable() { self.receive(now, on_progress) } else { Arrived::Nothing };
        match arrived {
            Arrived::Answer if matches!(self.state, State::Busy(_)) => {
                self.guard.end_loading();
                self.state = State::Idle;
                return Some(Ok(()));
            }
            Arrived::Answer => return Some(Err(self.end(Failure::Late))),
            Arrived::Broken => return Some(Err(self.end(Failure::Protocol))),
            Arrived::Closed => self.lose(now),
            // The end of the process ends the request only after everything that the process sent has been read.
            Arrived::Nothing if ready.exited && !ready.readable() => self.lose(now),
            Arrived::Nothing => {}
        }
        None
    }

    /// Reads from the socket once, and forwards progress messages.
    fn receive(&mut self, now: Instant, on_progress: &mut dyn FnMut(&Progress)) -> Arrived {
        let mut has_read = false;
        loop {
            match self.incoming.next_frame() {
                None if has_read => return Arrived::Nothing,
                None => match self.incoming.fill(&mut self.guard.read(&self.socket)) {
                    Filled::Some => has_read = true,
                    Filled::Nothing => return Arrived::Nothing,
                    Filled::Closed => return Arrived::Closed,
                    Filled::Broken => return Arrived::Broken,
                },
                Some(Ok(())) if self.incoming.sequence() != self.sequence => return Arrived::Broken,
                Some(Ok(())) if self.incoming.kind() == kind::SEALED => {
                    if self.take_sealed().is_err() {
                        return Arrived::Broken;
                    }
                }
                Some(Ok(())) if self.incoming.kind() != kind::PROGRESS => return Arrived::Answer,
                Some(Ok(())) if self.forward_progress(now, on_progress).is_ok() => {}
                Some(_) => return Arrived::Broken,
            }
        }
    }

    /// Accepts the worker's report on its sandbox and the file; a worker may send only one.
    fn take_sealed(&mut self) -> Read<()> {
        let sealed = whole(self.incoming.body())?;
        if self.guard.begin(sealed) { Ok(()) } else { Err(Malformed) }
    }

    /// Forwards a progress message, unless the rate limit is reached.
    fn forward_progress(&mut self, now: Instant, on_progress: &mut dyn FnMut(&Progress)) -> Read<()> {
        let (State::Busy(request) | State::Cancelling(request, _)) = &mut self.state else {
            return Err(Malformed);
        };
        if request.kind != kind::PLAN {
            return Err(Malformed);
        }
        let progress = whole(self.incoming.body())?;
        if request.may_forward(now) {
            on_progress(&progress);
        }
        Ok(())
    }

    /// Checks the worker when a check is due, and cancels a request that has used up its budget.
    pub(super) fn keep_deadline(&mut self, now: Instant) -> Option<Failure> {
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

    /// Asks the planner to stop, unless the request has not been sent completely.
    pub(super) fn send_cancel(&mut self, now: Instant) {
        if self.has_sent() && self.writer.begin(kind::CANCEL, self.sequence, 0).finish().is_ok() {
            self.n_sent = 0;
            self.send(now);
        }
    }

    /// Reads the answer that has just arrived. If the answer is malformed, or states that the planner cannot continue,
    /// the process is killed.
    pub(crate) fn take_answer<T>(&mut self, read: impl FnOnce(Body<'_>) -> Read<T>) -> Result<T, Failure> {
        match interpret(self.incoming.kind(), self.incoming.body(), read) {
            Ok(Err(failure)) if failure.ends_the_process() => Err(self.end(failure)),
            Ok(answer) => answer,
            Err(Malformed) => Err(self.end(Failure::Protocol)),
        }
    }
}

fn interpret<T>(
    kind: u8,
    body: Body<'_>,
    read: impl FnOnce(Body<'_>) -> Read<T>,
) -> Read<Result<T, Failure>> {
    Ok(match kind {
        kind::DONE => Ok(read(body)?),
        kind::FAILED => Err(Failure::Planner(whole(body)?)),
        kind::REFUSED => Err(Failure::Refused(whole::<Text>(body)?.0)),
        kind::UNABLE => Err(Failure::Console(whole::<Text>(body)?.0)),
        _ => return Err(Malformed),
    })
}
