//! Planners, called across the plugin boundary as the console calls them.

use super::{
    error::{Result, StudyError},
    method::Method,
};
use flight::{answers::InOrder, hosts};
use mission::{Cause, Fault};
use nalgebra::Matrix3;
use planner_api::{Code, Plan, PlanRequest, PoseEstimate, Reason, Site, Task};
use planner_host::{BlockingHost, HostConfig, PluginDirs};
use scenario::Scenario;
use serde::{Deserialize, Serialize};
use std::time::{Duration, Instant};
use world::{Point, Pose};

/// Time for which a study waits for a plan.
const PLAN_WITHIN: Duration = Duration::from_mins(5);

/// Memory limit of a planner in a study, the same as in a mission over a whole floor.
const MEMORY_BYTES: u64 = 1 << 30;

/// A planner's answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Planned {
    /// The plan, or the part that was found.
    pub plan: Plan,
    /// The reason why the plan is not complete.
    pub reason: Option<String>,
    /// Time between request and answer, milliseconds.
    pub plan_time_ms: f64,
}

impl Planned {
    /// Points of the path.
    pub(crate) fn path(&self) -> &[Point] {
        &self.plan.path
    }

    /// Whether the answer contains a path.
    pub(crate) fn has_path(&self) -> bool {
        self.path().len() > 1
    }

    /// Number of moves between its points.
    pub(crate) fn n_steps(&self) -> f64 {
        self.path().len().saturating_sub(1) as f64
    }

    /// The end of the path; `start` if it has no points.
    pub(crate) fn end(&self, start: Point) -> Point {
        self.path().last().copied().unwrap_or(start)
    }

    fn refused(fault: Fault, plan_time_ms: f64) -> Self {
        let plan = Plan { path: fault.partial, ..Plan::default() };
        Self { plan, reason: Some(fault.message), plan_time_ms }
    }
}

/// The planners of one thread, each in its own worker process.
pub(crate) struct Planners {
    dirs: PluginDirs,
}

impl Planners {
    /// Uses the planners from these folders.
    pub(crate) fn new(dirs: &PluginDirs) -> Self {
        Self { dirs: dirs.clone() }
    }

    /// The answers of these planners to a whole mission.
    pub(crate) fn answers(&self, scenario: &Scenario) -> InOrder {
        InOrder::new(hosts::host(scenario, &self.dirs))
    }

    /// Creates a planner for the site, without any state from earlier requests.
    pub(crate) fn prepare(&self, method: &Method, site: &Site<'_>) -> Result<BlockingHost, Fault> {
        let config = HostConfig {
            plan_deadline: PLAN_WITHIN,
            memory_limit_bytes: MEMORY_BYTES,
            wants_drawing: false,
            ..HostConfig::new(Duration::from_secs(1))
        };
        let mut host = BlockingHost::new(&self.dirs, config);
        host.choose(&method.planner, &method.parameters, site)?;
        Ok(host)
    }

    /// Asks a planner for a plan from an exactly known start; if it finds none, the answer contains the reason.
    ///
    /// # Errors
    /// The planner is missing, refuses the parameters or failed.
    pub(crate) fn plan(
        &self,
        method: &Method,
        start: Pose,
        task: Task<'_>,
        site: &Site<'_>,
    ) -> Result<Planned> {
        let Pose { position, heading_rad } = start;
        let start = PoseEstimate { position, heading_rad, covariance: Matrix3::zeros() };
        let request = PlanRequest::new(&Reason::Start, start, task, site);
        let failed = |fault| StudyError::planner(&method.planner, fault);
        let mut host = match self.prepare(method, site) {
            Err(fault) if is_refusal(&fault) => return Ok(Planned::refused(fault, 0.0)),
            prepared => prepared.map_err(failed)?,
        };
        let asked = Instant::now();
        let answer = host.plan(&request);
        let plan_time_ms = asked.elapsed().as_secs_f64() * 1e3;
        match answer {
            Ok(reply) => {
                let said = reply.logs.into_iter().map(|(_, message)| message).next_back();
                let reason = said.filter(|_| !reply.value.complete);
                Ok(Planned { plan: reply.value, reason, plan_time_ms })
            }
            Err(fault) if is_refusal(&fault) => Ok(Planned::refused(fault, plan_time_ms)),
            Err(fault) => Err(failed(fault)),
        }
    }
}

/// Whether a planner's refusal counts as a result; refused parameters are an error of the study.
fn is_refusal(fault: &Fault) -> bool {
    matches!(fault.cause, Cause::Planner(code) if code != Code::Config)
}
