//! A planner that was configured and drives, or is about to.

use super::find::Found;
use super::{Fault, HostConfig, fault, fault::Phase, numbers};
use crate::OnProgress;
use crate::supervisor::{Failure, Worker};
use crate::wire::answer::{BAD_OUTPUT, Said, said_of};
use crate::wire::body::{Body, Writer};
use crate::wire::kind;
use crate::{checks, parameters};
use mission::planner::{Cause, During, Parameters, PlannerInfo};
use planner_api::{Caps, Code, Command, Limits, Plan, PlanRequest, Sensed, Site, Task};
use std::sync::{Arc, atomic::AtomicBool};

/// Private state is saved this often, seconds of mission time.
const SAVE_EVERY_S: f64 = 1.0;

/// A planner in its worker.
pub(super) struct Driving {
    worker: Worker,
    pub(super) info: PlannerInfo,
    parameters: Parameters,
    limits: Limits,
    saves_state: bool,
    state_version: u32,
    saved_at_s: Option<f64>,
}

/// Private state of a planner.
pub(super) struct Saved {
    id: String,
    sha256: String,
    version: u32,
    state: Vec<u8>,
}

impl Saved {
    /// Whether a new instance understands this state.
    pub(super) fn fits(&self, driving: &Driving) -> bool {
        self.id == driving.info.id
            && self.sha256 == driving.info.sha256
            && self.version == driving.state_version
    }
}

impl Driving {
    /// Makes the planner in a worker that has loaded it.
    pub(super) fn configure(
        found: Found,
        parameters: &Parameters,
        site: &Site<'_>,
        config: &HostConfig,
    ) -> Result<(Self, Said), Fault> {
        let values = numbers(&found.info, parameters)?;
        let mut driving = Self {
            worker: found.worker,
            info: found.info,
            parameters: parameters.clone(),
            limits: site.limits,
            saves_state: Caps(found.caps).has(Caps::SNAPSHOT),
            state_version: found.state_version,
            saved_at_s: None,
        };
        let write = |w: &mut Writer| {
            w.values(&values).site(site);
        };
        let answer = driving.worker.ask(kind::CONFIGURE, config.configure_deadline, write, said_of);
        let said = driving.judged(answer, Phase::Configure)?;
        Ok((driving, said))
    }

    /// From now on a plan is given up when this is set.
    pub(super) fn stop_on(&mut self, stop: Arc<AtomicBool>) {
        self.worker.stop_on(stop);
    }

    /// From now on somebody is told how far a plan is.
    pub(super) fn tell_progress(&mut self, on_progress: OnProgress) {
        self.worker.tell_progress(on_progress);
    }

    /// Whether this is the same planner of the same file.
    pub(super) fn is(&self, other: &PlannerInfo) -> bool {
        self.info.id == other.id && self.info.sha256 == other.sha256
    }

    /// Refuses values that are unknown, out of range or not live.
    pub(super) fn check_live(&self, changed: &Parameters) -> Result<(), Fault> {
        let refuse = |message| fault::new(&self.info.id, During::Configure, Cause::Refused, message);
        for key in changed.keys() {
            let param = parameters::find(&self.info, key).map_err(refuse)?;
            if !param.live {
                let id = &self.info.id;
                return Err(refuse(format!("parameter `{key}` of planner {id} cannot change under way")));
            }
        }
        numbers(&self.info, changed).map(|_| ())
    }

    /// Gives new values; those that are not given stay.
    pub(super) fn reconfigure(&mut self, changed: &Parameters, config: &HostConfig) -> Result<Said, Fault> {
        let mut merged = self.parameters.clone();
        merged.extend(changed.clone());
        let values = numbers(&self.info, &merged)?;
        let write = |w: &mut Writer| {
            w.values(&values);
        };
        let answer = self.worker.ask(kind::RECONFIGURE, config.configure_deadline, write, said_of);
        let said = self.judged(answer, Phase::Configure)?;
        self.parameters = merged;
        Ok(said)
    }

    /// Asks for a plan and checks it.
    pub(super) fn plan(
        &mut self,
        request: &PlanRequest<'_>,
        config: &HostConfig,
    ) -> Result<(Plan, Said), Fault> {
        if matches!(request.task, Task::Cover { .. }) {
            must_cover(&self.info, During::Plan)?;
        }
        let write = |w: &mut Writer| {
            w.flag(config.wants_drawing).request(request);
        };
        let read = |body: &mut Body<'_>| Ok((body.plan()?, said_of(body)?));
        let answer = self.worker.ask(kind::PLAN, config.plan_deadline, write, read);
        let (plan, said) = self.judged(answer, Phase::Plan)?;
        checks::plan(&plan).map_err(|what| fault::bad_output(&self.info.id, Phase::Plan, &what))?;
        self.limits = request.site.limits;
        Ok((plan, said))
    }

    /// Asks for a command and checks it.
    pub(super) fn step(
        &mut self,
        sensed: &Sensed<'_>,
        config: &HostConfig,
    ) -> Result<(Command, Said), Fault> {
        let phase = Phase::Step(sensed.tick);
        let write = |w: &mut Writer| {
            w.flag(config.wants_drawing).sensed(sensed);
        };
        let read = |body: &mut Body<'_>| Ok((body.command()?, said_of(body)?));
        let answer = self.worker.ask(kind::STEP, config.step_deadline, write, read);
        let (command, said) = self.judged(answer, phase)?;
        checks::command(&command, &self.limits)
            .map_err(|what| fault::bad_output(&self.info.id, phase, &what))?;
        self.saved_at_s.get_or_insert(sensed.t_s);
        Ok((command, said))
    }

    /// Whether it is time to save the private state again, after the first step.
    pub(super) fn is_save_due(&mut self, t_s: f64) -> bool {
        let is_due = self.saves_state && self.saved_at_s.is_some_and(|last_s| t_s - last_s >= SAVE_EVERY_S);
        if is_due {
            self.saved_at_s = Some(t_s);
        }
        is_due
    }

    /// Asks for the private state; none when the planner keeps none or cannot tell it now.
    pub(super) fn snapshot(&mut self, config: &HostConfig) -> Result<Option<Saved>, Fault> {
        if !self.saves_state || self.worker.is_gone() {
            return Ok(None);
        }
        let read = |body: &mut Body<'_>| Ok(body.bytes()?.to_vec());
        let answer = self.worker.ask(kind::SNAPSHOT, config.state_deadline, |_| {}, read);
        let (id, sha256, version) = (self.info.id.clone(), self.info.sha256.clone(), self.state_version);
        let saved = answer.map(|state| Saved { id, sha256, version, state });
        self.unless_refused(saved)
    }

    /// Gives the private state of an earlier instance; one that refuses it starts without.
    pub(super) fn restore(&mut self, saved: &Saved, config: &HostConfig) -> Result<(), Fault> {
        let write = |w: &mut Writer| {
            w.u32(saved.version).bytes(&saved.state);
        };
        let answer = self.worker.ask(kind::RESTORE, config.state_deadline, write, |_| Ok(()));
        self.unless_refused(answer).map(|_| ())
    }

    /// State is a convenience: a planner may refuse to save or restore it, but not fail over it.
    fn unless_refused<T>(&mut self, answer: Result<T, Failure>) -> Result<Option<T>, Fault> {
        match self.judged(answer, Phase::State) {
            Ok(answer) => Ok(Some(answer)),
            Err(Fault { cause: Cause::Planner(_), .. }) => Ok(None),
            Err(fault) => Err(fault),
        }
    }

    /// A failure as a fault; after a panic the process is ended, too.
    fn judged<T>(&mut self, answer: Result<T, Failure>, phase: Phase) -> Result<T, Fault> {
        answer.map_err(|failure| {
            if is_unusable_after(&failure) {
                self.worker.kill();
            }
            fault::of(failure, &self.info.id, phase)
        })
    }
}

/// Refuses a planner that covers no floor.
pub(super) fn must_cover(info: &PlannerInfo, during: During) -> Result<(), Fault> {
    let refused = || {
        let message = format!("planner {} covers no floor: choose one that offers coverage", info.id);
        fault::new(&info.id, during, Cause::Refused, message)
    };
    if info.covers { Ok(()) } else { Err(refused()) }
}

fn is_unusable_after(failure: &Failure) -> bool {
    let Failure::Planner(refusal) = failure else { return false };
    match Code::from_number(refusal.code) {
        Some(code) => matches!(code, Code::Panic | Code::Poisoned),
        None => refusal.code != BAD_OUTPUT,
    }
}
