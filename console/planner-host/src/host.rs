//! The port that the mission asks: finds, starts, asks and replaces planners.

mod driving;
mod fault;
mod find;

use crate::OnProgress;
use crate::discovery::PluginDirs;
use crate::parameters;
use crate::quarantine::{MOST_FAULTS, Quarantine, WINDOW_S};
use crate::stats::{Durations, HostStats};
use crate::supervisor::WorkerCommand;
use crate::survey::{LOAD_WITHIN, MEMORY_LIMIT};
use driving::{Driving, Saved, must_cover};
use fault::Phase;
use find::Catalog;
use mission::planner::{Cause, During, Fault, Parameters, PlannerInfo, PlannerLink, Reply};
use planner_api::{Command, LogLevel, Plan, PlanRequest, Sensed, Site};
use std::sync::{Arc, atomic::AtomicBool};
use std::time::{Duration, Instant};

/// Deadlines and limits of planners.
#[derive(Debug, Clone, PartialEq)]
pub struct HostConfig {
    /// How workers are started.
    pub worker_command: WorkerCommand,
    /// For loading a library.
    pub load_deadline: Duration,
    /// For making a planner, or giving it new values.
    pub configure_deadline: Duration,
    /// For a plan.
    pub plan_deadline: Duration,
    /// For a command.
    pub step_deadline: Duration,
    /// For saving or restoring a planner's private state.
    pub state_deadline: Duration,
    /// Address space of a worker, bytes.
    pub memory_limit_bytes: u64,
    /// Whether anyone looks at drawings.
    pub wants_drawing: bool,
    /// Whether the mission covers floor, so that planners that cannot are refused when they are chosen.
    pub must_cover: bool,
}

impl HostConfig {
    /// The usual deadlines, with this one for a command: well below the length of a tick.
    pub fn new(step_deadline: Duration) -> Self {
        Self {
            worker_command: WorkerCommand::default(),
            load_deadline: LOAD_WITHIN,
            configure_deadline: Duration::from_secs(1),
            plan_deadline: Duration::from_secs(5),
            step_deadline,
            state_deadline: Duration::from_millis(100),
            memory_limit_bytes: MEMORY_LIMIT,
            wants_drawing: true,
            must_cover: false,
        }
    }
}

impl Default for HostConfig {
    /// With a tenth of a second for a command.
    fn default() -> Self {
        Self::new(Duration::from_millis(100))
    }
}

/// Runs planners for one mission, each in a worker process.
///
/// A plugin that fails three times within a minute of mission time is quarantined by the hash of its file and cannot
/// be chosen again.
pub struct Host {
    config: HostConfig,
    catalog: Catalog,
    driving: Option<Driving>,
    saved: Option<Saved>,
    quarantine: Quarantine,
    /// What planners said during calls that have no reply to carry it.
    unheard: Vec<(LogLevel, String)>,
    t_s: f64,
    plan_times: Durations,
    step_times: Durations,
    n_faults: u64,
    stop: Option<Arc<AtomicBool>>,
    on_progress: Option<OnProgress>,
}

impl Host {
    /// A host that searches these folders when a planner is first chosen.
    pub fn new(dirs: &PluginDirs, config: HostConfig) -> Self {
        Self {
            config,
            catalog: Catalog::new(dirs.clone()),
            driving: None,
            saved: None,
            quarantine: Quarantine::default(),
            unheard: Vec::new(),
            t_s: 0.0,
            plan_times: Durations::default(),
            step_times: Durations::default(),
            n_faults: 0,
            stop: None,
            on_progress: None,
        }
    }

    /// From now on a plan is given up when this is set, and no other is begun.
    pub fn stop_planning_on(&mut self, stop: Arc<AtomicBool>) {
        self.stop = Some(stop);
    }

    /// From now on somebody is told how far a plan is while it is being made.
    pub fn tell_progress(&mut self, on_progress: OnProgress) {
        self.on_progress = Some(on_progress);
    }

    /// The planner that drives.
    pub fn planner_id(&self) -> Option<&str> {
        self.driving.as_ref().map(|driving| driving.info.id.as_str())
    }

    /// Calls, wall times and faults so far.
    pub fn stats(&self) -> HostStats {
        HostStats { plan: self.plan_times.stats(), step: self.step_times.stats(), faults: self.n_faults }
    }

    /// Counts a fault, and quarantines its plugin when there were too many.
    fn note(&mut self, fault: Fault, sha256: &str) -> Fault {
        self.n_faults += 1;
        if !matches!(fault.cause, Cause::Planner(_) | Cause::Refused | Cause::Quarantined) {
            self.quarantine.note(sha256, self.t_s);
        }
        fault
    }

    fn refuse_quarantined(&self, id: &str, sha256: &str) -> Result<(), Fault> {
        if !self.quarantine.holds(sha256) {
            return Ok(());
        }
        let message = format!(
            "planner {id} failed {MOST_FAULTS} times within {WINDOW_S} s and may not drive again in this mission"
        );
        Err(fault::new(id, During::Load, Cause::Quarantined, message))
    }

    fn start(
        &mut self,
        id: &str,
        parameters: &Parameters,
        site: &Site<'_>,
    ) -> Result<Driving, (Fault, String)> {
        let found = self.catalog.find(id, &self.config)?;
        let sha256 = found.info.sha256.clone();
        let made = self
            .refuse_quarantined(id, &sha256)
            .and_then(|()| {
                if self.config.must_cover { must_cover(&found.info, During::Configure) } else { Ok(()) }
            })
            .and_then(|()| Driving::configure(found, parameters, site, &self.config));
        let (mut driving, said) = made.map_err(|fault| (fault, sha256.clone()))?;
        if let Some(stop) = &self.stop {
            driving.stop_on(Arc::clone(stop));
        }
        if let Some(tell) = &self.on_progress {
            driving.tell_progress(Arc::clone(tell));
        }
        self.unheard.extend(said.logs);
        self.save_state_of_the_same(&driving.info);
        if let Some(saved) = self.saved.as_ref().filter(|saved| saved.fits(&driving)) {
            driving.restore(saved, &self.config).map_err(|fault| (fault, sha256))?;
        }
        Ok(driving)
    }

    /// When the planner that drives is made anew, what it knows now is better than what was saved last.
    fn save_state_of_the_same(&mut self, next: &PlannerInfo) {
        let same = self.driving.as_mut().filter(|driving| driving.is(next));
        if let Some(Ok(Some(saved))) = same.map(|driving| driving.snapshot(&self.config)) {
            self.saved = Some(saved);
        }
    }

    /// Saves the planner's private state now and then, so that a new instance can go on from it.
    fn save_state_if_due(&mut self, driving: &mut Driving) -> Result<(), Fault> {
        if driving.is_save_due(self.t_s)
            && let Some(saved) = driving.snapshot(&self.config)?
        {
            self.saved = Some(saved);
        }
        Ok(())
    }

    /// Runs a call on the planner that drives.
    fn with_driving<T>(
        &mut self,
        phase: Phase,
        call: impl FnOnce(&mut Self, &mut Driving) -> Result<T, Fault>,
    ) -> Result<T, Fault> {
        let Some(mut driving) = self.driving.take() else {
            self.n_faults += 1;
            return Err(fault::new(
                "",
                phase.during(),
                Cause::Refused,
                "no planner was chosen yet".to_owned(),
            ));
        };
        let result = call(self, &mut driving);
        let sha256 = driving.info.sha256.clone();
        self.driving = Some(driving);
        result.map_err(|fault| self.note(fault, &sha256))
    }
}

impl PlannerLink for Host {
    fn choose(&mut self, id: &str, parameters: &Parameters, site: &Site<'_>) -> Result<PlannerInfo, Fault> {
        match self.start(id, parameters, site) {
            Ok(driving) => {
                let info = driving.info.clone();
                // What another planner knew is of no use to anyone who takes over later.
                self.saved = self.saved.take().filter(|saved| saved.fits(&driving));
                self.driving = Some(driving);
                Ok(info)
            }
            Err((fault, sha256)) => Err(self.note(fault, &sha256)),
        }
    }

    fn reconfigure(&mut self, parameters: &Parameters) -> Result<(), Fault> {
        self.with_driving(Phase::Configure, |host, driving| {
            driving.check_live(parameters)?;
            let said = driving.reconfigure(parameters, &host.config)?;
            host.unheard.extend(said.logs);
            Ok(())
        })
    }

    fn plan(&mut self, request: &PlanRequest<'_>) -> Result<Reply<Plan>, Fault> {
        self.with_driving(Phase::Plan, |host, driving| {
            let asked = Instant::now();
            let answer = driving.plan(request, &host.config);
            host.plan_times.note(asked.elapsed());
            answer.map(|(plan, said)| host.reply(plan, said))
        })
    }

    fn step(&mut self, sensed: &Sensed<'_>) -> Result<Reply<Command>, Fault> {
        self.t_s = sensed.t_s;
        self.with_driving(Phase::Step(sensed.tick), |host, driving| {
            host.save_state_if_due(driving)?;
            let asked = Instant::now();
            let answer = driving.step(sensed, &host.config);
            host.step_times.note(asked.elapsed());
            answer.map(|(command, said)| host.reply(command, said))
        })
    }
}

impl Host {
    fn reply<T>(&mut self, value: T, said: crate::wire::answer::Said) -> Reply<T> {
        let mut logs = std::mem::take(&mut self.unheard);
        logs.extend(said.logs);
        Reply { value, drawings: said.drawings, scalars: said.scalars, logs }
    }
}

/// Whether the values set by hand are right for a planner, as a fault.
fn numbers(info: &PlannerInfo, parameters: &Parameters) -> Result<Vec<(String, f64)>, Fault> {
    parameters::numbers(info, parameters)
        .map_err(|message| fault::new(&info.id, During::Configure, Cause::Refused, message))
}
