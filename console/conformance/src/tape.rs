//! What a planner was asked on a flight, to ask another instance the same.

use flight::answers::{Answers, InOrder};
use mission::{Answer, Ask, AskId, Fault, Given, Mission, What, WorkerId};
use planner_host::{Host, Memory};

/// So many asks are kept.
const MOST: usize = 60;

/// Answers of a host, and the first asks.
pub(crate) struct Taping {
    answers: InOrder,
    /// The worker that was asked first.
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

    /// Memory of the first planner's process.
    pub(crate) fn memory(&mut self) -> Option<Memory> {
        self.answers.host().memory(self.worker?)
    }

    pub(crate) fn into_tape(self) -> Vec<What> {
        self.tape
    }
}

impl Answers for Taping {
    fn submit(&mut self, ask: Ask) {
        // The rest of a tape makes sense only as long as it is of one planner from its beginning.
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

/// Asks planners what is on tapes, one ask after the other.
pub(crate) struct Player {
    host: Host,
    n: u32,
}

impl Player {
    pub(crate) fn new(host: Host) -> Self {
        Self { host, n: 0 }
    }

    /// Memory of a worker's process now, bytes.
    pub(crate) fn memory_bytes(&self, worker: u16) -> Option<u64> {
        self.host.memory(WorkerId(worker)).map(|memory| memory.now_bytes)
    }

    /// Asks a worker; the name of the ask with its answer.
    pub(crate) fn ask(&mut self, worker: u16, what: What) -> (AskId, Result<Given, Fault>) {
        self.n += 1;
        let id = AskId { worker: WorkerId(worker), n: self.n };
        self.host.submit(Ask { id, what });
        let answer = self.host.next(None).expect("what is asked is answered once");
        (id, answer.result)
    }
}
