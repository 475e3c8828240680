//! A planner in its worker: its open ask and its answers.

use super::opening::{Loaded, Opening, Stage};
use super::said_limit::SaidLimit;
use super::{HostConfig, fault, fault::Phase};
use crate::supervisor::{Failure, Worker};
use crate::wire::answer::{Answered, GivenPlan, Said};
use crate::wire::body::{Body, Read, Writer, whole};
use crate::wire::kind;
use crate::wire::request::Call;
use crate::{checks, parameters};
use mission::planner::{Cause, During, Fault, Parameters};
use mission::{AskId, Given, WorkerId};
use planner_api::{Command, Limits, PlanRequest, Sensed, Task};
use std::time::{Duration, Instant};

/// A planner and the worker id that the mission gave it.
pub(super) struct Planner {
    pub(super) id: WorkerId,
    /// `None` if the process has ended.
    pub(super) worker: Option<Worker>,
    pub(super) asked: Option<Asked>,
    /// `None` while the planner is being opened, or if that failed.
    pub(super) ready: Option<Ready>,
}

/// An ask to an opened planner, borrowed.
pub(crate) enum Wanted<'a> {
    Reconfigure(&'a Parameters),
    Plan(&'a PlanRequest<'a>),
    Step(&'a Sensed<'a>),
    Snapshot,
}

impl Wanted<'_> {
    pub(super) fn phase(&self) -> Phase {
        match self {
            Self::Reconfigure(_) => Phase::Reconfigure,
            Self::Plan(_) => Phase::Plan,
            Self::Step(sensed) => Phase::Step(sensed.tick),
            Self::Snapshot => Phase::State,
        }
    }
}

/// An open ask.
pub(super) struct Asked {
    pub(super) id: AskId,
    pub(super) at: Instant,
    pub(super) doing: Doing,
}

/// The content of an open ask.
pub(super) enum Doing {
    Open(Box<Opening>, Box<Stage>),
    /// All parameter values, as they will be once the planner has accepted the new ones.
    Reconfigure(Parameters),
    /// The robot's limits for the commands that follow the plan.
    Plan(Limits),
    /// The number of the tick.
    Step(u64),
    Snapshot,
}

impl Doing {
    pub(super) fn phase(&self) -> Phase {
        match self {
            Self::Open(_, stage) => stage.phase(),
            Self::Reconfigure(_) => Phase::Reconfigure,
            Self::Snapshot => Phase::State,
            Self::Plan(_) => Phase::Plan,
            Self::Step(tick) => Phase::Step(*tick),
        }
    }
}

/// A planner that has been opened.
pub(super) struct Ready {
    pub(super) loaded: Loaded,
    parameters: Parameters,
    limits: Limits,
    said_limit: SaidLimit,
}

/// The outcome of an ask: the planner's answer with its log lines, or its fault.
pub(super) type Outcome = Result<(Given, Said), Fault>;

impl Ready {
    pub(super) fn new(loaded: Loaded, parameters: Parameters, limits: Limits) -> Self {
        Self { loaded, parameters, limits, said_limit: SaidLimit::default() }
    }

    /// Merges new parameter values with the current ones; refuses parameters that are unknown or not live.
    ///
    /// The mission always sends all values that were set by the user, so most of them are unchanged.
    fn merged(&self, changed: &Parameters) -> Result<Parameters, Fault> {
        let info = &self.loaded.info;
        let refuse = |message| fault::of_parameters(&info.id, Phase::Reconfigure, message);
        let new = changed.iter().filter(|(key, value)| self.parameters.get(*key) != Some(*value));
        for (key, _) in new {
            let param = parameters::find(info, key).map_err(refuse)?;
            if !param.live {
                return Err(refuse(format!(
                    "parameter `{key}` of planner {} cannot change during a mission",
                    info.id
                )));
            }
        }
        let mut merged = self.parameters.clone();
        merged.extend(changed.clone());
        Ok(merged)
    }
}

impl Planner {
    /// Creates a planner without a worker or an ask.
    pub(super) fn new(id: WorkerId) -> Self {
        Self { id, worker: None, asked: None, ready: None }
    }

    /// Sends a request to the worker and leaves the ask open.
    ///
    /// # Errors
    /// The worker cannot be asked.
    fn ask(
        &mut self,
        id: AskId,
        doing: Doing,
        kind: u8,
        budget: Duration,
        write: impl FnOnce(&mut Writer),
    ) -> Result<(), Fault> {
        // The clock is read first, because a worker on this processor may answer before this thread runs again.
        let at = Instant::now();
        let asked = match &mut self.worker {
            Some(worker) => worker.ask(kind, budget, write),
            None => Err(Failure::Gone),
        };
        let phase = doing.phase();
        asked.map_err(|failure| self.fault(failure, phase))?;
        self.asked = Some(Asked { id, at, doing });
        Ok(())
    }

    /// Passes new parameter values to the planner; parameters that are not mentioned keep their values.
    pub(super) fn reconfigure(
        &mut self,
        id: AskId,
        changed: &Parameters,
        config: &HostConfig,
    ) -> Result<(), Fault> {
        let Some(ready) = &self.ready else { return Err(self.fault(Failure::Gone, Phase::Reconfigure)) };
        let merged = ready.merged(changed).map_err(|fault| self.blamed(fault))?;
        let info = &ready.loaded.info;
        let values = parameters::numbers(info, &merged)
            .map_err(|message| self.blamed(fault::of_parameters(&info.id, Phase::Reconfigure, message)))?;
        let write = |w: &mut Writer| {
            w.put(&values);
        };
        self.ask(id, Doing::Reconfigure(merged), kind::RECONFIGURE, config.configure_deadline, write)
    }

    /// Requests a plan.
    pub(super) fn plan(
        &mut self,
        id: AskId,
        request: &PlanRequest<'_>,
        config: &HostConfig,
    ) -> Result<(), Fault> {
        if let (Some(ready), Task::Cover { .. }) = (&self.ready, &request.task)
            && let Some(why) = ready.loaded.info.why_no_coverage()
        {
            let message = format!("planner {} {why}: choose one that does", self.name());
            return Err(self.blamed(fault::new(self.name(), During::Plan, Cause::Refused, message)));
        }
        let write = |w: &mut Writer| {
            w.put(&Call { watched: config.wants_drawing, asked: request });
        };
        self.ask(id, Doing::Plan(request.site.limits), kind::PLAN, config.plan_deadline, write)
    }

    /// Requests a command.
    pub(super) fn step(&mut self, id: AskId, sensed: &Sensed<'_>, config: &HostConfig) -> Result<(), Fault> {
        let write = |w: &mut Writer| {
            w.put(&Call { watched: config.wants_drawing, asked: sensed });
        };
        self.ask(id, Doing::Step(sensed.tick), kind::STEP, config.step_deadline, write)
    }

    /// Whether the process has ended although the planner was asked for nothing.
    pub(super) fn has_ended_idle(&mut self) -> bool {
        self.worker.as_mut().is_some_and(Worker::has_ended_idle)
    }

    /// Checks that the process has not ended since the last request.
    pub(super) fn check_alive(&mut self) -> Result<(), Fault> {
        let end = self.worker.as_mut().and_then(Worker::take_idle_end);
        end.map_or(Ok(()), |failure| Err(self.fault(failure, Phase::Idle)))
    }

    /// Whether the planner can save its state.
    pub(super) fn saves_state(&self) -> bool {
        self.ready.as_ref().is_some_and(|ready| ready.loaded.info.snapshots)
    }

    /// Requests the private state.
    pub(super) fn snapshot(&mut self, id: AskId, config: &HostConfig) -> Result<(), Fault> {
        self.ask(id, Doing::Snapshot, kind::SNAPSHOT, config.state_deadline, |_| {})
    }

    /// Reads the worker's answer, or returns the reason why there is none.
    pub(super) fn read<T>(
        &mut self,
        outcome: Result<(), Failure>,
        read: impl FnOnce(Body<'_>) -> Read<T>,
    ) -> Result<T, Failure> {
        outcome?;
        self.worker.as_mut().map_or(Err(Failure::Gone), |worker| worker.take_answer(read))
    }

    /// Processes the answer to new parameter values.
    pub(super) fn reconfigured(&mut self, outcome: Result<(), Failure>, values: Parameters) -> Outcome {
        let answer = self.read(outcome, whole::<Answered<()>>);
        let Answered { said, .. } = answer.map_err(|failure| self.fault(failure, Phase::Reconfigure))?;
        if let Some(ready) = &mut self.ready {
            ready.parameters = values;
        }
        Ok((Given::Reconfigured, said))
    }

    /// Processes the answer to a plan request.
    pub(super) fn planned(&mut self, outcome: Result<(), Failure>, limits: Limits) -> Outcome {
        let answer = self.read(outcome, whole::<Answered<GivenPlan>>);
        let Answered { given: GivenPlan(plan), said } =
            answer.map_err(|failure| self.fault(failure, Phase::Plan))?;
        checks::plan(&plan).map_err(|what| self.bad_output(Phase::Plan, &what))?;
        if let Some(ready) = &mut self.ready {
            ready.limits = limits;
        }
        Ok((Given::Plan(plan), said))
    }

    /// Processes the answer to a step.
    pub(super) fn stepped(&mut self, outcome: Result<(), Failure>, tick: u64) -> Outcome {
        let phase = Phase::Step(tick);
        let answer = self.read(outcome, whole::<Answered<Command>>);
        let Answered { given: command, mut said } = answer.map_err(|failure| self.fault(failure, phase))?;
        let checked = self.ready.as_ref().map_or(Ok(()), |ready| checks::command(&command, &ready.limits));
        checked.map_err(|what| self.bad_output(phase, &what))?;
        if let Some(ready) = &mut self.ready {
            ready.said_limit.take(&mut said);
        }
        Ok((Given::Command(command), said))
    }

    /// Reads the private state; `None` if the planner cannot provide it now.
    pub(super) fn snapshotted(&mut self, outcome: Result<(), Failure>) -> Result<Option<Vec<u8>>, Fault> {
        let answer = self.read(outcome, |body| Ok(body.0.to_vec()));
        unless_refused(answer.map_err(|failure| self.fault(failure, Phase::State)))
    }

    /// Creates the fault for a request to a planner that has not answered the previous one.
    pub(super) fn busy(&self, phase: Phase) -> Fault {
        let message = format!(
            "planner {} is not available for {phase}: it has not answered the previous request",
            self.name()
        );
        self.blamed(fault::new(self.name(), phase.during(), Cause::Refused, message))
    }

    /// Converts a failure of this planner into a fault.
    fn fault(&self, failure: Failure, phase: Phase) -> Fault {
        self.blamed(fault::of(failure, self.name(), phase))
    }

    fn bad_output(&self, phase: Phase, what: &str) -> Fault {
        self.blamed(fault::bad_output(self.name(), phase, what))
    }

    pub(super) fn name(&self) -> &str {
        self.ready.as_ref().map_or("", |ready| &ready.loaded.info.id)
    }

    /// Adds the SHA-256 of the plugin to a fault.
    fn blamed(&self, fault: Fault) -> Fault {
        Fault { plugin_sha256: self.ready.as_ref().map(|ready| ready.loaded.info.sha256.clone()), ..fault }
    }
}

/// Turns a refusal into `None`. Saving state is optional: a planner may refuse to save or restore it, but must not fail
/// while doing so.
pub(super) fn unless_refused<T>(answer: Result<T, Fault>) -> Result<Option<T>, Fault> {
    match answer {
        Ok(answer) => Ok(Some(answer)),
        Err(Fault { cause: Cause::Planner(_), .. }) => Ok(None),
        Err(fault) => Err(fault),
    }
}
