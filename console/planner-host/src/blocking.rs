//! A host for callers that wait: studies, previews, benches and tests.

use crate::discovery::PluginDirs;
use crate::host::{Host, HostConfig, Wanted};
use crate::progress::OnProgress;
use crate::stats::HostStats;
use mission::planner::{Cause, During, Fault, Parameters, PlannerInfo};
use mission::{Answer, AskId, Given, Said, WorkerId};
use planner_api::{Command, Drawing, LogLevel, Plan, PlanRequest, Sensed, Site};

/// Private state is saved this often, seconds of mission time.
const SAVE_EVERY_S: f64 = 1.0;

/// An answer with everything the planner drew and said on the way.
#[derive(Debug, Clone, PartialEq)]
pub struct Reply<T> {
    /// The answer.
    pub value: T,
    /// What it drew.
    pub drawings: Vec<Drawing>,
    /// Named figures of this tick: name, value, unit.
    pub scalars: Vec<(String, f64, String)>,
    /// What it said.
    pub logs: Vec<(LogLevel, String)>,
}

/// Runs one planner at a time, and waits for each of its answers.
///
/// A planner that is chosen in place of one that died continues from the private state that was saved last.
pub struct BlockingHost {
    host: Host,
    active: Option<Active>,
    saved: Option<Saved>,
    n_asks: u32,
    /// What planners said during calls that have no reply to carry it.
    unheard: Vec<(LogLevel, String)>,
    /// Calls without a planner.
    n_unanswered: u64,
}

/// The active planner.
struct Active {
    worker: WorkerId,
    info: PlannerInfo,
    /// Mission time of the last save, seconds; from the first step on.
    saved_at_s: Option<f64>,
}

/// Where the host keeps a private state, and whose it is.
struct Saved {
    ask: AskId,
    planner: String,
    sha256: String,
}

impl Saved {
    fn is_of(&self, info: &PlannerInfo) -> bool {
        self.planner == info.id && self.sha256 == info.sha256
    }
}

impl BlockingHost {
    /// A host that searches these folders when a planner is first chosen.
    pub fn new(dirs: &PluginDirs, config: HostConfig) -> Self {
        Self {
            host: Host::new(dirs, config),
            active: None,
            saved: None,
            n_asks: 0,
            unheard: Vec::new(),
            n_unanswered: 0,
        }
    }

    /// Sets the callback that receives the progress of plans while they are being computed.
    pub fn set_on_progress(&mut self, on_progress: OnProgress) {
        self.host.set_on_progress(on_progress);
    }

    /// Calls, wall times and faults so far.
    pub fn stats(&self) -> HostStats {
        let stats = self.host.stats();
        HostStats { faults: stats.faults + self.n_unanswered, ..stats }
    }

    /// Opens a planner; it is active from the next call on, and the previous one is closed. On a fault the previous one
    /// stays active.
    ///
    /// # Errors
    /// Not found, refused, or failed while loading or configuring.
    pub fn choose(
        &mut self,
        id: &str,
        parameters: &Parameters,
        site: &Site<'_>,
    ) -> Result<PlannerInfo, Fault> {
        self.save_state_of(id);
        let worker = WorkerId(self.active.as_ref().map_or(0, |active| active.worker.0.wrapping_add(1)));
        let restore = self.saved.as_ref().map(|saved| saved.ask);
        let opened = self.ask(worker, &Wanted::Open { planner: id, parameters, site, restore });
        let (Given::Opened(info), said) = opened.inspect_err(|_| self.host.close(worker))? else {
            unreachable!("what is opened is answered so")
        };
        self.unheard.extend(said.logs);
        // The saved state of another planner is of no use to a later one.
        self.saved = self.saved.take().filter(|saved| saved.is_of(&info));
        let active = Active { worker, info: (*info).clone(), saved_at_s: None };
        if let Some(before) = self.active.replace(active) {
            self.host.close(before.worker);
        }
        Ok(*info)
    }

    /// When the active planner is opened again, its current state is better than the one saved last.
    fn save_state_of(&mut self, id: &str) {
        if self.active.as_ref().is_some_and(|active| active.info.id == id) {
            // A planner that fails over it is replaced anyway.
            let _ = self.save_state();
        }
    }

    fn save_state(&mut self) -> Result<(), Fault> {
        let Some(Active { worker, info, .. }) = &self.active else { return Ok(()) };
        let (worker, planner, sha256) = (*worker, info.id.clone(), info.sha256.clone());
        if let (Given::State { bytes: 1.. }, _) = self.ask(worker, &Wanted::Snapshot)? {
            let ask = AskId { worker, n: self.n_asks };
            self.saved = Some(Saved { ask, planner, sha256 });
        }
        Ok(())
    }

    /// Gives the planner new values of live parameters.
    ///
    /// # Errors
    /// Out of range, unknown, not live, or the planner failed.
    pub fn reconfigure(&mut self, parameters: &Parameters) -> Result<(), Fault> {
        let worker = self.active(During::Configure)?;
        let (_, said) = self.ask(worker, &Wanted::Reconfigure(parameters))?;
        self.unheard.extend(said.logs);
        Ok(())
    }

    /// Asks for a plan.
    ///
    /// # Errors
    /// The planner found none or failed.
    pub fn plan(&mut self, request: &PlanRequest<'_>) -> Result<Reply<Plan>, Fault> {
        let worker = self.active(During::Plan)?;
        match self.ask(worker, &Wanted::Plan(request))? {
            (Given::Plan(plan), said) => Ok(self.reply(plan, said)),
            _ => unreachable!("a plan is answered so"),
        }
    }

    /// Asks for a command; now and then it asks for the private state first.
    ///
    /// # Errors
    /// The planner failed.
    pub fn step(&mut self, sensed: &Sensed<'_>) -> Result<Reply<Command>, Fault> {
        let worker = self.active(During::Step)?;
        if self.is_save_due(sensed.t_s) {
            self.save_state()?;
        }
        let (Given::Command(command), said) = self.ask(worker, &Wanted::Step(sensed))? else {
            unreachable!("a step is answered so")
        };
        if let Some(active) = &mut self.active {
            active.saved_at_s.get_or_insert(sensed.t_s);
        }
        Ok(self.reply(command, said))
    }

    /// Whether it is time to save the private state again, after the first step.
    fn is_save_due(&mut self, t_s: f64) -> bool {
        let saving = self.active.as_mut().filter(|active| active.info.snapshots);
        let last_s = saving.and_then(|active| active.saved_at_s.as_mut());
        let due = last_s.filter(|last_s| t_s - **last_s >= SAVE_EVERY_S);
        due.is_some_and(|last_s| {
            *last_s = t_s;
            true
        })
    }

    fn active(&mut self, during: During) -> Result<WorkerId, Fault> {
        if let Some(active) = &self.active {
            return Ok(active.worker);
        }
        self.n_unanswered += 1;
        Err(Fault {
            planner: String::new(),
            during,
            cause: Cause::Refused,
            message: "no planner was chosen yet".to_owned(),
            partial: Vec::new(),
            plugin_sha256: None,
        })
    }

    /// Asks, and waits for the answer.
    fn ask(&mut self, worker: WorkerId, wanted: &Wanted<'_>) -> Result<(Given, Said), Fault> {
        self.n_asks = self.n_asks.wrapping_add(1);
        self.host.begin(AskId { worker, n: self.n_asks }, wanted);
        let Answer { result, said, .. } = self.host.next(None).expect("what is asked is answered once");
        Ok((result?, said))
    }

    fn reply<T>(&mut self, value: T, said: Said) -> Reply<T> {
        let mut logs = std::mem::take(&mut self.unheard);
        logs.extend(said.logs);
        Reply { value, drawings: said.drawings, scalars: said.scalars, logs }
    }
}
