//! Recorded answers, and the planners asked the same again.

use super::journal::RecordedTick;
use crate::answers::Answers;
use mission::{Answer, Ask, AskId, Cause, Fault, Given, Mission, What, event::RecordedAnswers};
use planner_host::Host;
use std::collections::BTreeMap;

/// Answers asks from the journal, and has planners answer them, too.
pub(super) struct Replayed {
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
pub(super) struct Asked {
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
    pub(super) fn new(host: Option<Host>) -> Self {
        let asked = host.is_some().then(Asked::default);
        Self { recorded: RecordedAnswers::default(), host, early: Vec::new(), asked, tick: 0 }
    }

    /// Takes the recorded events of the tick that begins.
    pub(super) fn begin_tick(&mut self, recorded: &RecordedTick) {
        self.tick = recorded.tick;
        self.recorded.begin_tick(recorded.lines.iter().map(|(_, event)| &event.kind));
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
        let verdict = match own {
            None => Verdict::Different("gave no answer".to_owned()),
            Some(_) if !is_used => Verdict::NotComparable,
            Some(own) => verdict(&own, recorded, mission),
        };
        match verdict {
            Verdict::Same => asked.same += 1,
            Verdict::NotComparable => asked.not_comparable += 1,
            Verdict::Different(why) => {
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

/// What comes of comparing a planner's own answer with the recorded one.
enum Verdict {
    Same,
    /// The recorded answer is not the planner's.
    NotComparable,
    /// The sentence reads on after "it".
    Different(String),
}

fn verdict(own: &Answer, recorded: &Answer, mission: &Mission) -> Verdict {
    let why = match (&own.result, &recorded.result) {
        (Ok(Given::Opened(_)), Err(Fault { cause: Cause::Quarantined | Cause::Refused, .. })) => {
            return Verdict::NotComparable;
        }
        (Ok(own_given), Ok(given)) => differs(own_given, given, mission)
            .or_else(|| (own.said != recorded.said).then(|| "logs or draws something else".to_owned())),
        (Err(own), Err(fault)) => {
            (own != fault).then(|| format!("fails with \"{}\" instead of \"{}\"", own.message, fault.message))
        }
        (Ok(_), Err(fault)) => Some(format!("does not fail (\"{}\" then)", fault.message)),
        (Err(own), Ok(_)) => Some(format!("fails: {}", own.message)),
    };
    why.map_or(Verdict::Same, Verdict::Different)
}

fn differs(own: &Given, recorded: &Given, mission: &Mission) -> Option<String> {
    let what = match (own, recorded) {
        (Given::Opened(own), Given::Opened(then)) => {
            (own != then).then_some("is another build or offers something else")
        }
        (Given::Command(own), Given::Command(then)) => {
            (mission.as_sent(*own) != *then).then_some("commands something else")
        }
        (Given::Plan(own), Given::Plan(then)) => {
            let is_same = own.path == then.path
                && own.complete == then.complete
                && own.legs == then.legs
                && own.cuts == then.cuts;
            (!is_same).then_some("plans another path")
        }
        (own, then) => (own != then).then_some("gives something else"),
    };
    what.map(str::to_owned)
}
