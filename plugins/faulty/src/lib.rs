//! A planner for tests that fails in a chosen way.
//!
//! The planner drives straight to the target, as a correct one would, until its step number `at_step`. At that step, it
//! commits the fault named by the parameter `fault`. Faults whose names begin with `configure_` or `plan_` occur in
//! those calls; those that begin with `replan_` occur in every plan after the first.

mod faults;

use faults::{FAULTS, commit, happens_once};
use nalgebra::Vector2;
use planner_api::{
    Caps, Command, Config, Ctx, ParamSpec, Plan, PlanRequest, Planner, Reason, Result, Sensed, Site, Status,
    Task, choice, export_planners, int,
};

/// Drives to the target until the step of the fault.
struct Faulty {
    fault: &'static str,
    at_step: i64,
    n_steps: i64,
    v_max_m_per_s: f64,
}

impl Planner for Faulty {
    const ID: &'static str = "faulty";
    const NAME: &'static str = "Fault injector";
    const ABOUT: &'static str = "Drives straight to the target and then fails in a chosen way; for tests.";
    const CAPS: Caps = Caps::LOCAL;
    const PARAMS: &'static [ParamSpec] = &[
        choice("fault", "Fault", FAULTS, 0).help("The fault to commit."),
        int("at_step", "Step of the fault", "", 0, 1_000_000, 5)
            .help("The number of correct steps before the fault."),
    ];

    fn configure(config: &Config<'_>, site: &Site<'_>, ctx: &Ctx<'_>) -> Result<Self> {
        let fault = config.choice("fault");
        if let Some(kind) = fault.strip_prefix("configure_") {
            commit(kind, ctx)?;
        }
        let v_max_m_per_s = site.limits.v_max_m_per_s;
        Ok(Self { fault, at_step: config.int("at_step"), n_steps: 0, v_max_m_per_s })
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        if let Some(kind) = self.fault.strip_prefix("plan_") {
            commit(kind, ctx)?;
        }
        if let Some(kind) = self.fault.strip_prefix("replan_").filter(|_| *request.reason != Reason::Start) {
            commit(kind, ctx)?;
        }
        let mut path = vec![request.start.position];
        match request.task {
            Task::Goto { goal, .. } | Task::Cover { anchor: goal, .. } => path.push(goal),
            Task::Follow { targets, .. } => path.extend_from_slice(targets),
        }
        let cost = path.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum();
        Ok(Plan { path, cost, complete: true, ..Plan::default() })
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        let since = self.n_steps - self.at_step;
        let due = since == 0 || (since > 0 && !happens_once(self.fault));
        self.n_steps += 1;
        if due {
            match self.fault {
                "nan" => return Ok(Command::velocity(Vector2::new(f64::NAN, 0.0))),
                "huge" => return Ok(Command::twist(1e308, 0.0)),
                kind => commit(kind, ctx)?,
            }
        }
        let way = sensed.target - sensed.pose.position;
        let speed = self.v_max_m_per_s.min(way.norm() / sensed.dt_s);
        Ok(way
            .try_normalize(1e-9)
            .map_or(Command::still(Status::Arrived), |ahead| Command::velocity(ahead * speed)))
    }
}

impl Drop for Faulty {
    fn drop(&mut self) {
        assert!(self.fault != "drop_panic", "a panic while the planner is dropped");
    }
}

export_planners!(Faulty);
