//! Tracks which planner is being opened or is planning, for display. The tracked state depends on wall-clock time, so it
//! is written to neither the journal nor the recording.

use crate::answers::Answers;
use mission::{Answer, Ask, AskId, Mission, What, WorkerId};
use std::{collections::BTreeMap, time::Duration};

/// Callback for the planners' work: called with the work when it begins, and with `None` when it ends.
pub type OnWork = Box<dyn FnMut(Option<&Work>) + Send>;

/// Work of a planner that may take a while.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Work {
    /// The ask that the work will answer.
    pub ask: AskId,
    /// Description for the screen, such as `Planning (tether-safe)`.
    pub what: String,
    /// Time limit; `None` for short work.
    pub limit: Option<Duration>,
}

/// Tracks the work of planners.
pub struct PlanWatch {
    plan_limit: Duration,
    names: BTreeMap<WorkerId, String>,
    open: BTreeMap<AskId, Work>,
    on_work: Option<OnWork>,
}

impl PlanWatch {
    /// Creates a watch with the time limit for a plan and a callback for every change.
    pub fn new(plan_limit: Duration, on_work: Option<OnWork>) -> Self {
        Self { plan_limit, names: BTreeMap::new(), open: BTreeMap::new(), on_work }
    }

    /// The current work; the work of the active planner takes precedence over that of a planner being prepared.
    pub fn current(&self) -> Option<&Work> {
        self.open.values().next()
    }

    fn submitted(&mut self, ask: &Ask) {
        let (what, limit) = match &ask.what {
            What::Open { choice, .. } => {
                self.names.insert(ask.id.worker, choice.id.clone());
                (format!("Starting planner {}", choice.id), None)
            }
            What::Plan(_) => {
                let name = self.names.get(&ask.id.worker).map_or("", String::as_str);
                (format!("Planning ({name})"), Some(self.plan_limit))
            }
            What::Close => {
                self.names.remove(&ask.id.worker);
                self.open.retain(|open, _| open.worker != ask.id.worker);
                return self.notify();
            }
            What::Reconfigure(_) | What::Step(_) | What::Snapshot => return,
        };
        self.open.insert(ask.id, Work { ask: ask.id, what, limit });
        self.notify();
    }

    fn answered(&mut self, ask: AskId) {
        if self.open.remove(&ask).is_some() {
            self.notify();
        }
    }

    fn notify(&mut self) {
        if let Some(on_work) = &mut self.on_work {
            on_work(self.open.values().next());
        }
    }
}

/// A source of answers that also reports when planners are working.
pub struct Watched<'a, A> {
    answers: &'a mut A,
    watch: &'a mut PlanWatch,
}

impl<'a, A: Answers> Watched<'a, A> {
    /// Wraps this source of answers.
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

#[cfg(test)]
mod tests {
    use super::*;
    use mission::{PlannerChoice, preview};
    use std::sync::{Arc, Mutex};

    const LIMIT: Duration = Duration::from_mins(1);

    fn id(worker: u16, n: u32) -> AskId {
        AskId { worker: WorkerId(worker), n }
    }

    /// The asks that open a planner and have it plan.
    fn open_and_plan(worker: u16, name: &str) -> [Ask; 2] {
        let scenario = crate::scenarios::demo(&scenario::Settings::default()).unwrap();
        let plan = preview(&scenario.mission, &scenario.sim.world.as_drawn(), scenario.seed);
        let choice = PlannerChoice { id: name.into(), ..scenario.mission.planner.clone() };
        let open = What::Open { choice, site: Arc::clone(&plan.site), restore: None };
        [Ask { id: id(worker, 1), what: open }, Ask { id: id(worker, 2), what: What::Plan(Box::new(plan)) }]
    }

    fn shown(watch: &PlanWatch) -> Option<(&str, Option<Duration>)> {
        watch.current().map(|work| (work.what.as_str(), work.limit))
    }

    #[test]
    fn opening_has_no_limit_and_a_plan_has_its_own() {
        let mut watch = PlanWatch::new(LIMIT, None);
        let [open, plan] = open_and_plan(1, "rpf");
        watch.submitted(&open);
        assert_eq!(shown(&watch), Some(("Starting planner rpf", None)));
        watch.answered(open.id);
        watch.submitted(&plan);
        assert_eq!(shown(&watch), Some(("Planning (rpf)", Some(LIMIT))));
        watch.answered(plan.id);
        assert_eq!(shown(&watch), None);
    }

    #[test]
    fn the_work_of_a_successor_is_shown_when_the_planner_that_drives_has_none() {
        let mut watch = PlanWatch::new(LIMIT, None);
        let ([_, first], [open, second]) = (open_and_plan(1, "rpf"), open_and_plan(2, "apf"));
        for ask in [&open, &second, &first] {
            watch.submitted(ask);
        }
        watch.answered(open.id);
        assert_eq!(watch.current().map(|work| work.ask), Some(first.id));
        watch.answered(first.id);
        assert_eq!(shown(&watch), Some(("Planning (apf)", Some(LIMIT))));
        watch.submitted(&Ask { id: id(2, 3), what: What::Close });
        assert_eq!(shown(&watch), None);
    }

    #[test]
    fn every_change_is_called_back() {
        let calls: Arc<Mutex<Vec<Option<AskId>>>> = Arc::default();
        let seen = Arc::clone(&calls);
        let on_work: OnWork = Box::new(move |work| seen.lock().unwrap().push(work.map(|work| work.ask)));
        let mut watch = PlanWatch::new(LIMIT, Some(on_work));
        let [open, _] = open_and_plan(1, "rpf");
        watch.submitted(&open);
        watch.submitted(&Ask { id: id(1, 9), what: What::Snapshot });
        watch.answered(id(1, 9));
        watch.answered(open.id);
        assert_eq!(*calls.lock().unwrap(), [Some(open.id), None]);
    }
}
