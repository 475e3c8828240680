//! Recorded answers, and the planners asked the same again.

use flight::answers::Answers;
use mission::{Answer, Ask, AskId, Mission, What, ask::Comparison, event::RecordedAnswers};
use planner_host::Host;
use recording::RecordedTick;
use std::collections::BTreeMap;

/// Answers asks from the journal, and has planners answer them, too.
pub(crate) struct Replayed {
    recorded: RecordedAnswers,
    /// `None` when planners are not asked, or no longer, since one answered otherwise.
    host: Option<Host>,
    /// Answers that came before they were looked for.
    early: Vec<Answer>,
    asked: Option<Asked>,
    tick: u64,
}

/// What came of asking the planners again.
#[derive(Debug, Default)]
pub(crate) struct Asked {
    /// Answers that were compared and are the same.
    pub same: usize,
    /// Answers that cannot be compared: the mission refused them, or made no use of them.
    pub not_comparable: usize,
    /// Faults from outside or by the clock, by planner.
    pub external: BTreeMap<String, usize>,
    /// The first answer that is another one.
    pub difference: Option<String>,
}

impl Replayed {
    /// With a host, planners are asked, too.
    pub(crate) fn new(host: Option<Host>) -> Self {
        let asked = host.is_some().then(Asked::default);
        Self { recorded: RecordedAnswers::default(), host, early: Vec::new(), asked, tick: 0 }
    }

    /// Takes the recorded events of the tick that begins.
    pub(crate) fn begin_tick(&mut self, recorded: &RecordedTick) {
        self.tick = recorded.tick;
        self.recorded.begin_tick(recorded.events());
    }

    /// What the planners did.
    pub(super) fn into_asked(self) -> Option<Asked> {
        self.asked
    }

    /// The planner's own answer to an ask.
    fn own_answer(&mut self, ask: AskId) -> Option<Answer> {
        loop {
            if let Some(at) = self.early.iter().position(|answer| answer.ask == ask) {
                return Some(self.early.swap_remove(at));
            }
            let answer = self.host.as_mut()?.next(None)?;
            self.early.push(answer);
        }
    }

    fn compare(&mut self, recorded: &Answer, mission: &Mission, is_used: bool) {
        if self.host.is_none() {
            return;
        }
        if let Err(fault) = &recorded.result
            && fault.cause.is_external()
        {
            // The mission closes the worker; nobody waits for it to fail in the same way.
            let counts = self.asked.get_or_insert_default();
            *counts.external.entry(fault.planner.clone()).or_default() += 1;
            return;
        }
        let own = self.own_answer(recorded.ask);
        let Some(asked) = &mut self.asked else { return };
        let comparison = match own {
            None => Comparison::Different("gave no answer".to_owned()),
            Some(_) if !is_used => Comparison::NotComparable,
            Some(own) => Comparison::of(&own, recorded, |command| mission.as_sent(command)),
        };
        match comparison {
            Comparison::Same => asked.same += 1,
            Comparison::NotComparable => asked.not_comparable += 1,
            Comparison::Different(why) => {
                let (ask, tick) = (recorded.ask, self.tick);
                asked.difference =
                    Some(format!("a planner answers ask {ask} in tick {tick} otherwise: it {why}"));
                // From here on it knows other things than it did then.
                self.host = None;
            }
        }
    }
}

impl Answers for Replayed {
    fn submit(&mut self, ask: Ask) {
        if ask.what == What::Close {
            self.early.retain(|early| early.ask.worker != ask.id.worker);
        }
        self.recorded.submit(&ask);
        if let Some(host) = &mut self.host {
            host.submit(ask);
        }
    }

    fn next(&mut self, mission: &Mission) -> Option<Answer> {
        let (answer, is_used) = self.recorded.next_answer()?;
        self.compare(&answer, mission, is_used);
        Some(answer)
    }
}
