//! Another planner's plan for the waiting mission, made in a separate worker for comparison; the robot never follows
//! this plan.

use super::inbox::RunOutbox;
use account::Estimate;
use flight::hosts;
use mission::{
    Answer, Ask, AskId, Given, PlannerChoice, What, WorkerId, preview, tether::certify_from_start,
};
use planner_host::{Host, PluginDirs, Progress, Waker};
use scenario::Scenario;
use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
};
use tui::{RunMsg, model::GhostPlan};

/// The only worker of a comparison.
const WORKER: WorkerId = WorkerId(0);

/// A comparison plan in progress; dropping this cancels it.
pub(super) struct Comparing {
    given_up: Arc<AtomicBool>,
    waker: Waker,
}

impl Drop for Comparing {
    fn drop(&mut self) {
        self.given_up.store(true, Ordering::SeqCst);
        self.waker.wake();
    }
}

impl Comparing {
    /// Starts planning.
    ///
    /// # Errors
    /// The thread cannot be started.
    pub(super) fn begin(
        scenario: Arc<Scenario>,
        choice: PlannerChoice,
        plugins: &PluginDirs,
        screen: RunOutbox,
    ) -> std::io::Result<Self> {
        let mut host = Host::new(plugins, hosts::config(&scenario.mission));
        let progress = screen.clone();
        host.set_on_progress(Arc::new(move |_, Progress { share, what }| {
            progress.send(RunMsg::CompareAt(*share, what.clone()));
        }));
        let given_up: Arc<AtomicBool> = Arc::default();
        let comparing = Self { given_up: Arc::clone(&given_up), waker: host.waker() };
        thread::Builder::new().name("compare".into()).spawn(move || {
            let made = plan(&scenario, &choice, &mut host, &given_up);
            if !given_up.load(Ordering::SeqCst) {
                screen.send(RunMsg::Compared(choice, made.map(Box::new)));
            }
        })?;
        Ok(comparing)
    }
}

fn plan(
    scenario: &Scenario,
    choice: &PlannerChoice,
    host: &mut Host,
    given_up: &AtomicBool,
) -> Result<GhostPlan, String> {
    let (mission, drawing) = (&scenario.mission, scenario.sim.world.as_drawn());
    let plan_ask = preview(mission, &drawing, scenario.seed);
    let open = What::Open { choice: choice.clone(), site: Arc::clone(&plan_ask.site), restore: None };
    answer(host, 1, open, given_up)?;
    let Given::Plan(plan) = answer(host, 2, What::Plan(Box::new(plan_ask)), given_up)? else {
        return Err(format!("planner {} returned no plan", choice.id));
    };
    let certified = mission
        .tether
        .as_ref()
        .map(|tether| certify_from_start(tether, mission, &plan.path, &plan.cuts, &drawing).certified);
    let estimate = Estimate::new(mission, &drawing, &plan.path, plan.complete);
    Ok(GhostPlan::new(mission, &plan.path, &plan.legs, estimate, certified))
}

/// Sends an ask and waits for its answer, unless the comparison is cancelled.
fn answer(host: &mut Host, n: u32, what: What, given_up: &AtomicBool) -> Result<Given, String> {
    host.submit(Ask { id: AskId { worker: WORKER, n }, what });
    loop {
        if given_up.load(Ordering::SeqCst) {
            return Err("cancelled".to_owned());
        }
        if let Some(Answer { result, .. }) = host.next(None) {
            return result.map_err(|fault| fault.message);
        }
    }
}
