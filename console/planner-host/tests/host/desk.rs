//! Takes the place of a mission: sends asks to workers, and numbers the asks.

use crate::stand::{GOAL, pose, sensed, with_site, words};
use crate::state::counted;
use mission::ask::{PlanAsk, Site, StepAsk, TaskLeft};
use mission::planner::Parameters;
use mission::{Answer, Ask, AskId, Fault, Given, PlannerChoice, What, WorkerId};
use nalgebra::Point2;
use planner_api::Reason;
use planner_host::{Host, HostConfig, PluginDirs};
use std::sync::Arc;
use std::time::{Duration, Instant};

pub(crate) const ONE: WorkerId = WorkerId(1);
pub(crate) const TWO: WorkerId = WorkerId(2);
/// Far longer than anything here takes, even on a busy machine.
pub(crate) const LONG: Duration = Duration::from_mins(1);

/// A host, and the mission's count of asks.
pub(crate) struct Desk {
    pub host: Host,
    n: u32,
}

impl Desk {
    pub(crate) fn new(dirs: &PluginDirs, config: HostConfig) -> Self {
        Self { host: Host::new(dirs, config), n: 0 }
    }

    pub(crate) fn submit(&mut self, worker: WorkerId, what: What) -> AskId {
        self.n += 1;
        let id = AskId { worker, n: self.n };
        self.host.submit(Ask { id, what });
        id
    }

    pub(crate) fn next(&mut self) -> Answer {
        self.host.next(None).expect("an answer")
    }

    /// Asks, and waits for the answer, which is the next one.
    pub(crate) fn ask(&mut self, worker: WorkerId, what: What) -> Result<Given, Fault> {
        let id = self.submit(worker, what);
        let answer = self.next();
        assert_eq!(answer.ask, id);
        answer.result
    }

    pub(crate) fn open(&mut self, worker: WorkerId, fault: &str) {
        let opened = self.ask(worker, opening("faulty", &words(&[("fault", fault)]), None));
        assert!(matches!(opened, Ok(Given::Opened(info)) if info.id == "faulty"));
    }

    /// Saves the private state of a worker's planner, and returns the ask that identifies the saved state.
    pub(crate) fn save(&mut self, worker: WorkerId) -> AskId {
        let id = self.submit(worker, What::Snapshot);
        let answer = self.next();
        assert_eq!((answer.ask, answer.result), (id, Ok(Given::State { bytes: 4 })));
        id
    }

    /// The count of a counter after a step.
    pub(crate) fn count(&mut self, worker: WorkerId, tick: u64) -> u32 {
        match self.ask(worker, step(tick)).unwrap() {
            Given::Command(command) => counted(&command),
            other => panic!("{other:?}"),
        }
    }
}

fn site() -> Arc<Site> {
    Arc::new(with_site(|site| Site {
        revision: site.revision,
        boundary: world::Boundary::Circle { radius_m: 10.0 },
        obstacles: Vec::new(),
        zones: Vec::new(),
        limits: site.limits,
        swath_m: site.swath_m,
        clearance_m: site.clearance_m,
        seed: site.seed,
    }))
}

pub(crate) fn opening(planner: &str, parameters: &Parameters, restore: Option<AskId>) -> What {
    let choice = PlannerChoice { id: planner.to_owned(), parameters: parameters.clone() };
    What::Open { choice, site: site(), restore }
}

pub(crate) fn plan() -> What {
    let task = TaskLeft::Goto { goal: GOAL, tolerance_m: 0.1 };
    let (reason, start) = (Reason::Start, pose(Point2::origin()));
    What::Plan(Box::new(PlanAsk { reason, start, task, site: site(), previous: Vec::new(), under_way: None }))
}

pub(crate) fn step(tick: u64) -> What {
    What::Step(Box::new(sensed(tick, |sensed| StepAsk {
        tick,
        t_s: sensed.t_s,
        dt_s: sensed.dt_s,
        pose: sensed.pose,
        v_m_per_s: 0.0,
        w_rad_per_s: 0.0,
        target: sensed.target,
        targets_ahead: vec![sensed.target],
        path_ahead: Vec::new(),
        obstacles: Vec::new(),
    })))
}

/// A time limit so short that a caller in a loop checks often.
pub(crate) fn soon() -> Instant {
    Instant::now() + Duration::from_millis(20)
}
