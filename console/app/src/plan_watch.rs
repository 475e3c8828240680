//! Which planner is being opened or is planning, for display. This depends on wall-clock time, so it enters neither
//! journal nor recording.

use crate::answers::Answers;
use mission::{Answer, Ask, AskId, Mission, What, WorkerId};
use std::collections::BTreeMap;

/// Callback for the planners' work: a description when it begins, `None` when it ends.
pub type OnWork = Box<dyn FnMut(Option<&str>) + Send>;

/// Work that planners are doing and that takes its time.
#[derive(Default)]
pub struct PlanWatch {
    names: BTreeMap<WorkerId, String>,
    open: BTreeMap<AskId, String>,
    on_work: Option<OnWork>,
}

impl PlanWatch {
    /// Calls back on every change.
    pub fn with_callback(on_work: OnWork) -> Self {
        Self { on_work: Some(on_work), ..Self::default() }
    }

    /// The current work, as shown: `Planning (tether-safe)`.
    pub fn current(&self) -> Option<&str> {
        self.open.values().next().map(String::as_str)
    }

    fn submitted(&mut self, ask: &Ask) {
        match &ask.what {
            What::Open { choice, .. } => {
                self.names.insert(ask.id.worker, choice.id.clone());
                self.open.insert(ask.id, format!("Starting planner {}", choice.id));
            }
            What::Plan(_) => {
                let name = self.names.get(&ask.id.worker).map_or("", String::as_str);
                self.open.insert(ask.id, format!("Planning ({name})"));
            }
            What::Close => {
                self.names.remove(&ask.id.worker);
                self.open.retain(|open, _| open.worker != ask.id.worker);
            }
            What::Reconfigure(_) | What::Step(_) | What::Snapshot => return,
        }
        self.notify();
    }

    fn answered(&mut self, ask: AskId) {
        if self.open.remove(&ask).is_some() {
            self.notify();
        }
    }

    fn notify(&mut self) {
        if let Some(on_work) = &mut self.on_work {
            on_work(self.open.values().next().map(String::as_str));
        }
    }
}

/// Answers with somebody who watches plans being made.
pub struct Watched<'a, A> {
    answers: &'a mut A,
    watch: &'a mut PlanWatch,
}

impl<'a, A: Answers> Watched<'a, A> {
    /// These answers, watched.
    pub fn new(answers: &'a mut A, watch: &'a mut PlanWatch) -> Self {
        Self { answers, watch }
    }
}

impl<A: Answers> Answers for Watched<'_, A> {
    fn submit(&mut self, ask: Ask) {
        self.watch.submitted(&ask);
        self.answers.submit(ask);
    }

    fn next(&mut self, mission: &Mission) -> Option<Answer> {
        let answer = self.answers.next(mission);
        if let Some(answer) = &answer {
            self.watch.answered(answer.ask);
        }
        answer
    }
}
