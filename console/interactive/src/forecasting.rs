//! Forecasts how a mission would continue with different planners or parameters: a copy of the mission is run ahead with
//! separate workers.

use super::{inbox::RunOutbox, line::EngineHandle};
use flight::{Flight, answers::InOrder, hosts};
use mission::{Event, EventKind, Order, Outlook, Phase, PlannerChoice};
use planner_host::PluginDirs;
use scenario::Scenario;
use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::Duration,
};
use tui::{
    RunMsg,
    model::{Forecast, Trail},
};
use world::Point;

/// The longest wait for the engine to copy its flight.
const PATIENCE: Duration = Duration::from_secs(5);
/// The number of ticks between two progress reports of a forecast.
const REPORT_TICKS: u64 = 500;

/// Forecasts in progress, one after another; dropping this cancels them.
pub(super) struct Forecasting {
    given_up: Arc<AtomicBool>,
}

impl Drop for Forecasting {
    fn drop(&mut self) {
        self.given_up.store(true, Ordering::SeqCst);
    }
}

impl Forecasting {
    /// Begins to forecast.
    ///
    /// # Errors
    /// The thread cannot be started.
    pub(super) fn begin(
        scenario: Arc<Scenario>,
        choices: Vec<PlannerChoice>,
        engine: EngineHandle,
        plugins: PluginDirs,
        screen: RunOutbox,
    ) -> std::io::Result<Self> {
        let given_up: Arc<AtomicBool> = Arc::default();
        let forecasting = Self { given_up: Arc::clone(&given_up) };
        thread::Builder::new().name("forecast".into()).spawn(move || {
            let forked = engine.fork(PATIENCE);
            for choice in choices {
                let forecast = match &forked {
                    Some(forked) => {
                        fly(forked.flight(&scenario), &choice, &scenario, &plugins, (&screen, &given_up))
                    }
                    None => Err("the engine did not provide a copy of the mission".to_owned()),
                };
                if given_up.load(Ordering::SeqCst) {
                    return;
                }
                screen.send(RunMsg::Forecast(choice, forecast.map(Box::new)));
            }
        })?;
        Ok(forecasting)
    }
}

/// The interim result of a forecast.
struct Ahead {
    outlook: Outlook,
    path: Vec<Point>,
    from_s: Option<f64>,
    done: f64,
    certified: Option<bool>,
}

impl Ahead {
    fn new(choice: &PlannerChoice) -> Self {
        let outlook = Outlook {
            choice: choice.clone(),
            outcome: None,
            reason: String::new(),
            after_s: 0.0,
            length_m: 0.0,
            reachable: 0.0,
            clearance_min_m: f64::INFINITY,
            tether_length_max_m: None,
            wrap_max_rad: None,
        };
        Self { outlook, path: Vec::new(), from_s: None, done: 0.0, certified: None }
    }

    fn take(&mut self, event: &Event) {
        let outlook = &mut self.outlook;
        match &event.kind {
            EventKind::Truth { pose, clearance_m, .. } => {
                if let Some(before) = self.path.last() {
                    outlook.length_m += (pose.position - before).norm();
                }
                self.path.push(pose.position);
                outlook.clearance_min_m = outlook.clearance_min_m.min(*clearance_m);
            }
            EventKind::TetherTruth { length_m, wrap_max_rad, .. } => {
                let most = |before: Option<f64>, now: f64| Some(before.map_or(now, |before| before.max(now)));
                outlook.tether_length_max_m = most(outlook.tether_length_max_m, *length_m);
                outlook.wrap_max_rad = most(outlook.wrap_max_rad, *wrap_max_rad);
            }
            EventKind::Progressed { done, covered_reachable, .. } => {
                (self.done, outlook.reachable) = (*done, *covered_reachable);
            }
            EventKind::Ended { outcome, reason } => {
                outlook.outcome = Some(*outcome);
                outlook.reason.clone_from(reason);
            }
            EventKind::Certified { certificate, .. } => {
                self.certified = Some(self.certified.unwrap_or(true) && certificate.certified);
            }
            EventKind::Held { by, .. } => outlook.reason = by.to_string(),
            _ => {}
        }
        // Truth events carry the forecast's own time; all other events carry the time of the run.
        if !matches!(event.kind, EventKind::Truth { .. } | EventKind::TetherTruth { .. }) {
            outlook.after_s = event.t_s - *self.from_s.get_or_insert(event.t_s);
        }
    }
}

fn fly(
    mut flight: Flight,
    choice: &PlannerChoice,
    scenario: &Scenario,
    plugins: &PluginDirs,
    (screen, given_up): (&RunOutbox, &AtomicBool),
) -> Result<Forecast, String> {
    if flight.mission().has_reel_stopped() {
        return Err(
            "the reel has stopped, but a forecast assumes that it takes the tether up: repair it first"
                .to_owned(),
        );
    }
    let mut answers = InOrder::new(hosts::host(scenario, plugins));
    let mut ahead = Ahead::new(choice);
    // A running mission accepts another planner only once it is held.
    let hold = matches!(flight.phase(), Phase::Running(_)).then_some(Order::Hold);
    let mut orders: Vec<Order> =
        hold.into_iter().chain([Order::ChoosePlanner(choice.clone()), Order::Resume]).collect();
    for tick in 0.. {
        if given_up.load(Ordering::SeqCst) {
            return Err("cancelled".to_owned());
        }
        let events = flight.tick(&orders, &mut answers);
        for event in &events {
            ahead.take(event);
        }
        if let Some(why) = events.iter().find_map(refusal) {
            return Err(why);
        }
        orders.clear();
        if is_over(flight.phase()) {
            break;
        }
        if tick % REPORT_TICKS == 0 {
            screen.send(RunMsg::ForecastAt(choice.clone(), ahead.done));
        }
    }
    Ok(Forecast { path: Trail::thinned(&ahead.path), outlook: ahead.outlook, certified: ahead.certified })
}

/// The reason why the mission refuses to continue.
fn refusal(event: &Event) -> Option<String> {
    match &event.kind {
        EventKind::OrderRefused { why, .. } => Some(why.clone()),
        _ => None,
    }
}

/// Whether only an operator could make the mission continue.
fn is_over(phase: &Phase) -> bool {
    match phase {
        Phase::Ended(_) => true,
        Phase::Held(hold) => hold.resumes.is_never(),
        Phase::Waiting | Phase::Running(_) => false,
    }
}
