//! One flight: simulator, mission and planner host, tick by tick.

use crate::{plan::patient, scenario::Scenario};
use mission::{
    Event, EventKind, Fault, Input, Mission, MissionConfig, Order, Parameters, Phase, PlannerInfo, RunOpened,
    event::JOURNAL_VERSION,
    planner::{PlannerLink, Reply},
};
use planner_api::{Command, Drive, Plan, PlanRequest, Sensed, Site};
use planner_host::{Host, HostConfig, PluginDirs, Progress};
use report::PlannerCalls;
use sim::Simulator;
use std::{
    sync::{Arc, atomic::AtomicBool},
    time::Duration,
};
use world::Floor;

/// How patient the host is with a planner's step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pace {
    /// A tick is a tick: a planner has 60 % of it, but at least 100 ms so that a busy laptop is no fault.
    Live,
    /// As fast as it goes, with nobody waiting for the next tick: only a planner that hangs is late.
    Batch,
}

impl Pace {
    fn step_deadline(self, tick_s: f64) -> Duration {
        match self {
            Self::Live => Duration::from_secs_f64((0.6 * tick_s).max(0.1)),
            Self::Batch => Duration::from_secs(2),
        }
    }
}

/// A scenario being flown.
pub struct Flight {
    simulator: Simulator,
    mission: Mission,
    host: Host,
    tick: u64,
    tick_s: f64,
    opened: RunOpened,
    plan_within: Duration,
    on_plan: Option<OnPlan>,
}

/// A plan that is being made.
#[derive(Debug, Clone, PartialEq)]
pub struct Planning {
    /// Who makes it, as words: `tether-safe plans`.
    pub work: String,
    /// How long it may take.
    pub within: Duration,
}

/// News of a plan that is being made. All of it depends on the clock on the wall: it is shown, and never written down.
#[derive(Debug, Clone, PartialEq)]
pub enum PlanNews {
    /// It is begun.
    Begun(Planning),
    /// It is so far.
    Progress(Progress),
    /// It is done, or given up.
    Done,
}

/// Who is told of plans that are being made. The flight waits meanwhile.
pub type OnPlan = Arc<dyn Fn(PlanNews) + Send + Sync>;

/// The host, with somebody who is told of plans.
struct Told<'a> {
    host: &'a mut Host,
    within: Duration,
    on_plan: Option<&'a OnPlan>,
}

impl PlannerLink for Told<'_> {
    fn choose(&mut self, id: &str, parameters: &Parameters, site: &Site<'_>) -> Result<PlannerInfo, Fault> {
        self.host.choose(id, parameters, site)
    }

    fn reconfigure(&mut self, parameters: &Parameters) -> Result<(), Fault> {
        self.host.reconfigure(parameters)
    }

    fn plan(&mut self, request: &PlanRequest<'_>) -> Result<Reply<Plan>, Fault> {
        if let Some(tell) = self.on_plan {
            let work = format!("{} plans", self.host.planner_id().unwrap_or("the planner"));
            tell(PlanNews::Begun(Planning { work, within: self.within }));
        }
        let answer = self.host.plan(request);
        if let Some(tell) = self.on_plan {
            tell(PlanNews::Done);
        }
        answer
    }

    fn step(&mut self, sensed: &Sensed<'_>) -> Result<Reply<Command>, Fault> {
        self.host.step(sensed)
    }
}

impl Flight {
    /// A flight that waits for its start; `attended` says whether an operator is there.
    pub fn prepare(scenario: &Scenario, attended: bool, plugins: &PluginDirs, pace: Pace) -> Self {
        let config = MissionConfig { attended, ..scenario.mission.clone() };
        let drawing = scenario.sim.world.as_drawn();
        let floor =
            Floor::new(&drawing, config.cell_m, config.room_m(), config.swath_m, config.start.position);
        let opened = RunOpened {
            journal_version: JOURNAL_VERSION,
            tankops_version: env!("CARGO_PKG_VERSION").into(),
            scenario: scenario.name.clone(),
            scenario_toml: scenario.text.clone(),
            seed: scenario.seed,
            world: scenario.sim.world.clone(),
            mission: config.clone(),
            floor: floor.clone(),
            plates: scenario.plates,
        };
        let host_config = patient(HostConfig::new(pace.step_deadline(config.tick_s)), &config);
        let plan_within = host_config.plan_deadline;
        Self {
            simulator: Simulator::new(scenario.sim.clone(), scenario.seed),
            host: Host::new(plugins, host_config),
            tick: 0,
            tick_s: config.tick_s,
            mission: Mission::new(config, drawing, floor, scenario.seed),
            opened,
            plan_within,
            on_plan: None,
        }
    }

    /// Somebody is told when a plan is begun, how far it is, and when it is done.
    pub fn tell_plans(&mut self, on_plan: OnPlan) {
        let tell = Arc::clone(&on_plan);
        self.host.tell_progress(Arc::new(move |progress| tell(PlanNews::Progress(progress.clone()))));
        self.on_plan = Some(on_plan);
    }

    /// From now on a plan is given up when this is set, and no other is begun.
    pub fn stop_planning_on(&mut self, stop: Arc<AtomicBool>) {
        self.host.stop_planning_on(stop);
    }

    /// The first event of the run.
    pub fn opened(&self) -> Event {
        Event { tick: 0, t_s: 0.0, kind: EventKind::RunOpened(Box::new(self.opened.clone())) }
    }

    /// What the mission is doing.
    pub fn phase(&self) -> &Phase {
        self.mission.phase()
    }

    /// Length of a tick, mission time.
    pub fn tick_length(&self) -> Duration {
        Duration::from_secs_f64(self.tick_s)
    }

    /// Figures about the planner's calls, by the wall clock.
    pub fn planner_calls(&self) -> PlannerCalls {
        let stats = self.host.stats();
        PlannerCalls {
            plan: stats.plan.calls,
            step: stats.step.calls,
            p50_us: stats.step.p50_us,
            p99_us: stats.step.p99_us,
            faults: stats.faults,
        }
    }

    /// Flies one tick: sense, decide, act. The truth goes into the events first, and nowhere else.
    pub fn tick(&mut self, orders: &[Order]) -> Vec<Event> {
        let readings = self.simulator.sense();
        let truth = self.simulator.truth();
        let mut link =
            Told { host: &mut self.host, within: self.plan_within, on_plan: self.on_plan.as_ref() };
        let step = self.mission.step(&Input { readings: &readings, orders }, &mut link);
        self.simulator.act(match step.drive {
            Drive::Twist { v_m_per_s, w_rad_per_s } => sim::Drive::Twist { v_m_per_s, w_rad_per_s },
            Drive::Velocity(velocity) => sim::Drive::Velocity(velocity),
        });
        let mut events = Vec::with_capacity(step.events.len() + 2);
        events.push(Event {
            tick: self.tick,
            t_s: self.tick as f64 * self.tick_s,
            kind: EventKind::Truth {
                pose: truth.pose,
                clearance_m: truth.clearance_m,
                collided: truth.collided,
            },
        });
        events.extend(truth.tether.map(|tether| Event {
            tick: self.tick,
            t_s: self.tick as f64 * self.tick_s,
            kind: EventKind::TetherTruth {
                length_m: tether.length_m,
                max_wrap_rad: tether.max_wrap_rad,
                sum_wrap_rad: tether.sum_wrap_rad,
                detour_m: tether.detour_m,
            },
        }));
        events.extend(step.events);
        self.tick += 1;
        events
    }
}
