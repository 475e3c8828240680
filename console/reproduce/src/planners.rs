//! Planners, asked over the plugin boundary as the console asks them.

use crate::study::Problem;
use mission::{Cause, Fault, Parameters};
use planner_api::{Code, Plan, PlanRequest, Site};
use planner_host::{BlockingHost, HostConfig, PluginDirs};
use std::time::{Duration, Instant};
use world::Point;

/// A study waits this long for a plan.
const PLAN_WITHIN: Duration = Duration::from_mins(5);

/// And lets a planner use so much memory, as much as a mission over a whole floor does.
const MEMORY_BYTES: u64 = 1 << 30;

/// A planner's answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Planned {
    /// The plan; of one who found none as much as it gave.
    pub plan: Plan,
    /// Why the plan is not complete.
    pub reason: Option<String>,
    /// Time between question and answer, milliseconds.
    pub plan_time_ms: f64,
}

impl Planned {
    /// Points of the path.
    pub fn path(&self) -> &[Point] {
        &self.plan.path
    }
}

/// Planners of one thread, each in a worker process of its own.
pub struct Planners {
    dirs: PluginDirs,
}

impl Planners {
    /// Planners from these folders.
    pub fn new(dirs: &PluginDirs) -> Self {
        Self { dirs: dirs.clone() }
    }

    /// A planner that is seated at the site and knows nothing of what others asked before.
    ///
    /// # Errors
    /// It is missing, refuses the parameters or broke down.
    pub fn seat(&self, id: &str, parameters: &Parameters, site: &Site<'_>) -> Result<BlockingHost, Problem> {
        let config = HostConfig {
            plan_deadline: PLAN_WITHIN,
            memory_limit_bytes: MEMORY_BYTES,
            wants_drawing: false,
            ..HostConfig::new(Duration::from_secs(1))
        };
        let mut host = BlockingHost::new(&self.dirs, config);
        host.choose(id, parameters, site).map_err(|fault| problem(id, fault))?;
        Ok(host)
    }

    /// Asks a planner for a plan; one who finds none gives the reason.
    ///
    /// # Errors
    /// It is missing, refuses the parameters or broke down.
    pub fn plan(
        &self,
        id: &str,
        parameters: &Parameters,
        request: &PlanRequest<'_>,
    ) -> Result<Planned, Problem> {
        let mut host = match self.seat(id, parameters, request.site) {
            Err(Problem::Planner { fault, .. }) if is_no(&fault) => return Ok(no_plan(*fault, 0.0)),
            seated => seated?,
        };
        let asked = Instant::now();
        let answer = host.plan(request);
        let plan_time_ms = asked.elapsed().as_secs_f64() * 1e3;
        match answer {
            Ok(reply) => {
                let said = reply.logs.into_iter().map(|(_, message)| message).next_back();
                let reason = said.filter(|_| !reply.value.complete);
                Ok(Planned { plan: reply.value, reason, plan_time_ms })
            }
            Err(fault) if is_no(&fault) => Ok(no_plan(fault, plan_time_ms)),
            Err(fault) => Err(problem(id, fault)),
        }
    }
}

/// Whether a planner refuses for a valid reason; bad parameters are a fault of the study.
fn is_no(fault: &Fault) -> bool {
    matches!(fault.cause, Cause::Planner(code) if code != Code::Config)
}

fn no_plan(fault: Fault, plan_time_ms: f64) -> Planned {
    let plan = Plan { path: fault.partial, ..Plan::default() };
    Planned { plan, reason: Some(fault.message), plan_time_ms }
}

fn problem(id: &str, fault: Fault) -> Problem {
    Problem::Planner { case: id.to_owned(), fault: Box::new(fault) }
}
