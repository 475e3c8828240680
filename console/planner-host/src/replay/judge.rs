//! Judges answers as the console would, with the same checks and the same sentences as during a mission.

use crate::checks;
use crate::host::fault::{self, Phase};
use crate::supervisor::{Failure, Worker, wait_for_one};
use crate::wire::answer::{Answered, GivenPlan};
use crate::wire::body::{Read, whole};
use crate::wire::frame::Incoming;
use crate::wire::request::{Call, Load, Values};
use crate::wire::{answer::BAD_OUTPUT, answer::Refusal, kind};
use mission::ask::{PlanAsk, Site, StepAsk};
use mission::{Fault, check_extent};
use planner_api::{Command, Drive, Limits, Status};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The context from earlier requests that is needed to judge an answer.
#[derive(Default)]
pub(super) struct Judge {
    planner: String,
    kind: u8,
    tick: u64,
    /// The robot's limits for the commands that follow.
    limits: Option<Limits>,
    /// The robot's limits in the pending plan request; they apply once there is a plan.
    next_limits: Option<Limits>,
    /// The tank in the latest plan request.
    site: Option<Arc<Site>>,
}

impl Judge {
    /// Keeps the parts of a request that are needed to judge later answers.
    pub(super) fn hear(&mut self, request: &Incoming) -> Read<()> {
        let body = request.body();
        self.kind = request.kind();
        match self.kind {
            kind::LOAD => self.planner = Load::read(body)?.map(|load| load.id).unwrap_or_default(),
            kind::CONFIGURE => {
                let (_, site): (Values, Site) = whole(body)?;
                self.limits = Some(site.limits);
            }
            kind::PLAN => {
                let site = whole::<Call<PlanAsk>>(body)?.asked.site;
                self.next_limits = Some(site.limits);
                self.site = Some(site);
            }
            kind::STEP => self.tick = whole::<Call<StepAsk>>(body)?.asked.tick,
            _ => {}
        }
        Ok(())
    }

    /// Returns the name of the latest request; the name of a step includes the number of its tick.
    pub(super) fn name(&self) -> String {
        match self.kind {
            kind::LOAD => "load".to_owned(),
            kind::CONFIGURE => "configure".to_owned(),
            kind::RECONFIGURE => "reconfigure".to_owned(),
            kind::RESTORE => "restore".to_owned(),
            kind::PLAN => "plan".to_owned(),
            kind::STEP => format!("step {}", self.tick),
            _ => "?".to_owned(),
        }
    }

    fn phase(&self) -> Phase {
        match self.kind {
            kind::LOAD => Phase::Load,
            kind::PLAN => Phase::Plan,
            kind::STEP => Phase::Step(self.tick),
            kind::RESTORE => Phase::State,
            kind::RECONFIGURE => Phase::Reconfigure,
            _ => Phase::Configure,
        }
    }

    /// Waits for the answer, checks it, and describes it in a few words.
    pub(super) fn answer(&mut self, worker: &mut Worker) -> Result<String, Failure> {
        let outcome = loop {
            let ready = wait_for_one(worker, None);
            if let Some(outcome) = worker.advance(ready, Instant::now(), &mut |_| {}) {
                break outcome;
            }
        };
        outcome?;
        match self.kind {
            kind::LOAD => worker.take_planners().map(|(sealed, _)| format!("sha256 {}", sealed.sha256)),
            kind::PLAN => {
                let Answered { given: GivenPlan(plan), .. } = worker.take_answer(whole)?;
                checks::plan(&plan).map_err(bad_output)?;
                if let Some(site) = &self.site {
                    check_extent(&plan, &site.boundary, site.swath_m).map_err(bad_output)?;
                }
                self.limits = self.next_limits;
                Ok(format!("{} points, complete: {}", plan.path.len(), plan.complete))
            }
            kind::STEP => {
                let Answered::<Command> { given: command, .. } = worker.take_answer(whole)?;
                let checked = self.limits.map_or(Ok(()), |limits| checks::command(&command, &limits));
                checked.map_err(bad_output)?;
                Ok(format!("{}, {}", driven(&command.drive), named(command.status)))
            }
            kind::RESTORE => worker.take_answer(whole::<()>).map(|()| "done".to_owned()),
            _ => worker.take_answer(whole::<Answered<()>>).map(|_| "done".to_owned()),
        }
    }

    /// Describes a failure by the fault that the console would report. After a timeout, the text also contains the
    /// budget; unlike the fault of a mission, it is not written to a journal, so it may contain times.
    pub(super) fn fault(&self, failure: Failure, budget: Duration) -> Fault {
        let is_of_time = matches!(failure, Failure::Hung | Failure::Late | Failure::Starved);
        let mut fault = fault::of(failure, &self.planner, self.phase());
        if is_of_time {
            let within = format!(" (its budget is {:.1} s)", budget.as_secs_f64());
            fault.message.push_str(&within);
        }
        fault
    }
}

/// Reports an invalid answer in the same way as the worker does.
fn bad_output(message: String) -> Failure {
    Failure::Planner(Refusal { code: BAD_OUTPUT, message, partial: Vec::new() })
}

fn driven(drive: &Drive) -> String {
    match drive {
        Drive::Twist { v_m_per_s, w_rad_per_s } => format!("{v_m_per_s:.4} m/s, {w_rad_per_s:.4} rad/s"),
        Drive::Velocity(velocity) => format!("velocity ({:.4}, {:.4}) m/s", velocity.x, velocity.y),
    }
}

fn named(status: Status) -> &'static str {
    match status {
        Status::Moving => "moving",
        Status::Arrived => "arrived",
        Status::Stuck => "stuck",
        Status::Waiting => "waiting",
    }
}
