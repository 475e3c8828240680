//! Records the requests to a planner during a mission, so that they can be sent to a different instance.

use flight::answers::{Answers, InOrder};
use mission::{Answer, Ask, AskId, Fault, Given, Mission, What, WorkerId};
use planner_host::{Host, Memory};

/// The maximum number of requests kept.
const MOST: usize = 60;

/// Forwards the answers of a host and records the first requests.
pub(crate) struct Taping {
    answers: InOrder,
    /// The worker that received the first request.
    worker: Option<WorkerId>,
    tape: Vec<What>,
}

impl Taping {
    pub(crate) fn new(host: Host) -> Self {
        Self { answers: InOrder::new(host), worker: None, tape: Vec::new() }
    }

    pub(crate) fn host(&mut self) -> &mut Host {
        self.answers.host()
    }

    /// Returns the memory of the first planner's process.
    pub(crate) fn memory(&mut self) -> Option<Memory> {
        self.answers.host().memory(self.worker?)
    }

    pub(crate) fn into_tape(self) -> Vec<What> {
        self.tape
    }
}

impl Answers for Taping {
    fn submit(&mut self, ask: Ask) {
        // A tape is useful only if it contains the requests to a single planner from the beginning.
        let first = *self.worker.get_or_insert(ask.id.worker);
        if self.tape.len() < MOST && ask.id.worker == first && ask.what != What::Close {
            self.tape.push(ask.what.clone());
        }
        self.answers.submit(ask);
    }

    fn next(&mut self, mission: &Mission) -> Option<Answer> {
        self.answers.next(mission)
    }
}

/// Sends recorded requests to planners, one at a time.
pub(crate) struct Player {
    host: Host,
    n: u32,
}

impl Player {
    pub(crate) fn new(host: Host) -> Self {
        Self { host, n: 0 }
    }

    /// Returns the current memory of a worker's process, bytes.
    pub(crate) fn memory_bytes(&self, worker: u16) -> Option<u64> {
        self.host.memory(WorkerId(worker)).map(|memory| memory.now_bytes)
    }

    /// Sends a request to a worker; returns the id of the request and the answer.
    pub(crate) fn ask(&mut self, worker: u16, what: What) -> (AskId, Result<Given, Fault>) {
        self.n += 1;
        let id = AskId { worker: WorkerId(worker), n: self.n };
        self.host.submit(Ask { id, what });
        let answer = self.host.next(None).expect("every ask is answered exactly once");
        (id, answer.result)
    }
}
