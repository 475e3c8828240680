//! Answers the mission's asks from the journal, and puts the same asks to the planners again.
//!
//! The mission uses the recorded answers alone, so a separate thread asks the planners, and may be some ticks behind
//! the mission.

use flight::answers::Answers;
use mission::{
    Answer, Ask, AskId, Mission, Sending, What, WorkerId, ask::Comparison, event::RecordedAnswers,
};
use planner_host::Host;
use recording::RecordedTick;
use std::{
    collections::BTreeMap,
    sync::mpsc::{Receiver, SyncSender},
};

/// Length of the queue of asks and answers for the planners; when the queue is full, the mission waits.
pub(super) const BEHIND: usize = 512;

/// Answers asks from the journal, and sends asks and answers to the thread that puts the asks to the planners again.
pub(crate) struct Replayed {
    recorded: RecordedAnswers,
    /// `None` if the planners are not asked.
    again: Option<SyncSender<Update>>,
    tick: u64,
}

/// An event of the journal.
pub(super) enum Update {
    /// A planner was asked.
    Ask(Ask),
    /// An answer was recorded.
    Answered(Box<Recorded>),
}

/// A recorded answer.
pub(super) struct Recorded {
    answer: Answer,
    /// The tick in which it arrived.
    tick: u64,
    /// Whether the mission used it.
    is_used: bool,
    /// The command that was sent to the robot as a result.
    sending: Sending,
}

impl Replayed {
    /// Answers from the journal only.
    pub(crate) fn from_journal() -> Self {
        Self { recorded: RecordedAnswers::default(), again: None, tick: 0 }
    }

    /// Sends all asks and answers to [`Asking`].
    pub(super) fn sending_to(again: Option<SyncSender<Update>>) -> Self {
        Self { again, ..Self::from_journal() }
    }

    /// Reads in the recorded events of the tick that is about to begin.
    pub(crate) fn begin_tick(&mut self, recorded: &RecordedTick) {
        self.tick = recorded.tick;
        self.recorded.begin_tick(recorded.events());
    }

    fn send(&self, update: impl FnOnce() -> Update) {
        if let Some(again) = &self.again {
            // The receiver is gone only if its thread has panicked. The caller notices this when it waits for the
            // findings.
            let _ = again.send(update());
        }
    }
}

impl Answers for Replayed {
    fn submit(&mut self, ask: Ask) {
        self.recorded.submit(&ask);
        self.send(|| Update::Ask(ask));
    }

    fn next(&mut self, mission: &Mission) -> Option<Answer> {
        let (answer, is_used) = self.recorded.next_answer()?;
        self.send(|| {
            let (answer, sending) = (answer.clone(), mission.sending());
            Update::Answered(Box::new(Recorded { answer, tick: self.tick, is_used, sending }))
        });
        Some(answer)
    }
}

/// The result of asking the planners again.
#[derive(Debug, Default)]
pub(crate) struct Asked {
    /// Number of answers that were compared and are equal.
    pub same: usize,
    /// Number of answers that cannot be compared because the mission refused them or did not use them.
    pub not_comparable: usize,
    /// Number of external or timing faults, by planner.
    pub external: BTreeMap<String, usize>,
    /// Number of answers that cannot be compared because their worker failed earlier than in the journal.
    pub too_early: usize,
    /// The place and the fault, as a clause, if a worker had an external or timing fault that is not in the journal.
    pub unproven: Option<String>,
    /// The first answer that differs.
    pub difference: Option<String>,
}

impl Asked {
    /// Puts every ask that arrives to the planners of a host, until the sender is gone or a planner answers
    /// differently: from then on, the state of that planner would differ from its state in the run.
    pub(super) fn of(mut host: Host, updates: &Receiver<Update>) -> Self {
        host.share_processor();
        let mut asking = Asking { host, early: Vec::new(), failed: BTreeMap::new(), asked: Self::default() };
        let is_same = updates.iter().all(|update| {
            match update {
                Update::Ask(ask) => asking.ask(ask),
                Update::Answered(recorded) => asking.compare(&recorded),
            }
            asking.asked.difference.is_none()
        });
        if !is_same {
            updates.iter().for_each(drop);
        }
        asking.asked.unproven = asking.failed.into_values().next();
        asking.asked
    }
}

/// Asks planners.
struct Asking {
    host: Host,
    /// Answers that arrived before they were needed.
    early: Vec<Answer>,
    /// Workers with external or timing faults that are not in the journal yet; for each, the place and the fault.
    failed: BTreeMap<WorkerId, String>,
    asked: Asked,
}

impl Asking {
    fn ask(&mut self, ask: Ask) {
        if ask.what == What::Close {
            self.early.retain(|early| early.ask.worker != ask.id.worker);
        }
        self.host.submit(ask);
    }

    /// The planner's own answer to an ask.
    fn own_answer(&mut self, ask: AskId) -> Option<Answer> {
        loop {
            if let Some(at) = self.early.iter().position(|answer| answer.ask == ask) {
                return Some(self.early.swap_remove(at));
            }
            let answer = self.host.next(None)?;
            self.early.push(answer);
        }
    }

    fn compare(&mut self, recorded: &Recorded) {
        let Recorded { answer, tick, is_used, sending } = recorded;
        if let Err(fault) = &answer.result
            && fault.cause.is_external()
        {
            // The mission closes the worker, so the worker is not expected to fail as it did in the run.
            *self.asked.external.entry(fault.planner.clone()).or_default() += 1;
            self.failed.remove(&answer.ask.worker);
            return;
        }
        let own = self.own_answer(answer.ask);
        if let Some(Answer { result: Err(fault), .. }) = &own
            && fault.cause.is_external()
        {
            // The time of the fault depends on the machine: a fault that is recorded later in the journal is the
            // same fault.
            let ask = answer.ask;
            self.failed
                .entry(ask.worker)
                .or_insert_with(|| format!("ask {ask} in tick {tick} (\"{}\")", fault.message));
            self.asked.too_early += 1;
            return;
        }
        let comparison = match own {
            None => Comparison::Different("gave no answer".to_owned()),
            Some(_) if !is_used => Comparison::NotComparable,
            Some(own) => Comparison::of(&own, answer, |command| sending.as_sent(command)),
        };
        match comparison {
            Comparison::Same => self.asked.same += 1,
            Comparison::NotComparable => self.asked.not_comparable += 1,
            Comparison::Different(why) => {
                let ask = answer.ask;
                self.asked.difference =
                    Some(format!("a planner answers ask {ask} in tick {tick} differently: it {why}"));
            }
        }
    }
}
