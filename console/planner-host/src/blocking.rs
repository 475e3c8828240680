//! A host for callers that wait for every answer: studies, previews, benches and tests.

use crate::discovery::PluginDirs;
use crate::host::{Host, HostConfig, Opening, Wanted};
use crate::progress::OnProgress;
use crate::stats::HostStats;
use mission::planner::{Cause, During, Fault, Parameters, PlannerInfo};
use mission::{Answer, AskId, Given, Said, WorkerId};
use planner_api::{Command, Drawing, LogLevel, Plan, PlanRequest, Sensed, Site};

/// An answer, with everything that the planner drew and logged during the call.
#[derive(Debug, Clone, PartialEq)]
pub struct Reply<T> {
    /// The answer.
    pub value: T,
    /// The drawings.
    pub drawings: Vec<Drawing>,
    /// Named figures of this tick: name, value, unit.
    pub scalars: Vec<(String, f64, String)>,
    /// The log messages.
    pub logs: Vec<(LogLevel, String)>,
}

/// Runs one planner at a time and waits for each of its answers. It saves no private state: every planner starts from
/// scratch.
pub struct BlockingHost {
    host: Host,
    /// The worker of the active planner.
    active: Option<WorkerId>,
    n_asks: u32,
    /// Log messages from calls whose results cannot contain log messages.
    unheard: Vec<(LogLevel, String)>,
    /// The number of calls made while no planner was chosen.
    n_unanswered: u64,
}

impl BlockingHost {
    /// Creates a host that searches these folders when the first planner is chosen.
    pub fn new(dirs: &PluginDirs, config: HostConfig) -> Self {
        Self { host: Host::new(dirs, config), active: None, n_asks: 0, unheard: Vec::new(), n_unanswered: 0 }
    }

    /// Sets the callback that receives the progress of plans while they are being computed.
    pub fn set_on_progress(&mut self, on_progress: OnProgress) {
        self.host.set_on_progress(on_progress);
    }

    /// Returns the number of calls, their wall times and the number of faults so far.
    pub fn stats(&self) -> HostStats {
        let stats = self.host.stats();
        HostStats { faults: stats.faults + self.n_unanswered, ..stats }
    }

    /// Opens a planner, which becomes active from the next call on; the previous planner is closed. After a fault,
    /// the previous planner stays active.
    ///
    /// # Errors
    /// The planner was not found, was refused, or failed while it was being loaded or configured.
    pub fn choose(
        &mut self,
        id: &str,
        parameters: &Parameters,
        site: &Site<'_>,
    ) -> Result<PlannerInfo, Fault> {
        let worker = WorkerId(self.active.map_or(0, |active| active.0.wrapping_add(1)));
        let ask = self.next_ask(worker);
        self.host.open(ask, Opening::new(id, parameters, site, None));
        let (Given::Opened(info), said) = self.answer().inspect_err(|_| self.host.close(worker))? else {
            unreachable!("an open ask gets an opened answer")
        };
        self.unheard.extend(said.logs);
        if let Some(before) = self.active.replace(worker) {
            self.host.close(before);
        }
        Ok(*info)
    }

    /// Passes new values of live parameters to the planner.
    ///
    /// # Errors
    /// A value is out of range, a parameter is unknown or not live, or the planner failed.
    pub fn reconfigure(&mut self, parameters: &Parameters) -> Result<(), Fault> {
        let worker = self.active(During::Reconfigure)?;
        let (_, said) = self.ask(worker, &Wanted::Reconfigure(parameters))?;
        self.unheard.extend(said.logs);
        Ok(())
    }

    /// Requests a plan.
    ///
    /// # Errors
    /// The planner found no plan or failed.
    pub fn plan(&mut self, request: &PlanRequest<'_>) -> Result<Reply<Plan>, Fault> {
        let worker = self.active(During::Plan)?;
        match self.ask(worker, &Wanted::Plan(request))? {
            (Given::Plan(plan), said) => Ok(self.reply(plan, said)),
            _ => unreachable!("a plan ask gets a plan answer"),
        }
    }

    /// Requests a command.
    ///
    /// # Errors
    /// The planner failed.
    pub fn step(&mut self, sensed: &Sensed<'_>) -> Result<Reply<Command>, Fault> {
        let worker = self.active(During::Step)?;
        match self.ask(worker, &Wanted::Step(sensed))? {
            (Given::Command(command), said) => Ok(self.reply(command, said)),
            _ => unreachable!("a step ask gets a command answer"),
        }
    }

    fn active(&mut self, during: During) -> Result<WorkerId, Fault> {
        if let Some(worker) = self.active {
            return Ok(worker);
        }
        self.n_unanswered += 1;
        Err(Fault {
            planner: String::new(),
            during,
            cause: Cause::Refused,
            message: "no planner has been chosen".to_owned(),
            partial: Vec::new(),
            plugin_sha256: None,
        })
    }

    /// Submits an ask and waits for its answer.
    fn ask(&mut self, worker: WorkerId, wanted: &Wanted<'_>) -> Result<(Given, Said), Fault> {
        let ask = self.next_ask(worker);
        self.host.begin(ask, wanted);
        self.answer()
    }

    fn next_ask(&mut self, worker: WorkerId) -> AskId {
        self.n_asks = self.n_asks.wrapping_add(1);
        AskId { worker, n: self.n_asks }
    }

    /// Waits for the answer to the ask that was submitted.
    fn answer(&mut self) -> Result<(Given, Said), Fault> {
        let Answer { result, said, .. } = self.host.next(None).expect("every ask is answered exactly once");
        Ok((result?, said))
    }

    fn reply<T>(&mut self, value: T, said: Said) -> Reply<T> {
        let mut logs = std::mem::take(&mut self.unheard);
        logs.extend(said.logs);
        Reply { value, drawings: said.drawings, scalars: said.scalars, logs }
    }
}
