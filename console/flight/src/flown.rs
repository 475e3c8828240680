//! One flight: simulator and mission, tick by tick.

use crate::answers::Answers;
use mission::{
    Event, EventKind, Fork, Injection, Input, Mission, MissionConfig, Order, Phase, RangeFault, RunOpened,
    event::JOURNAL_VERSION,
};

use scenario::Scenario;
use sim::{AeConfig, Disturbances, SimConfig, Simulator};
use std::time::Duration;
use world::{Floor, Readings};

/// A scenario in flight.
#[derive(Clone)]
pub struct Flight {
    simulator: Simulator,
    mission: Mission,
    tick: u64,
    tick_s: f64,
    opened: RunOpened,
    readings: Readings,
}

impl Flight {
    /// Creates a flight that waits for its start; `attended` tells whether an operator is present.
    pub fn prepare(scenario: &Scenario, attended: bool) -> Self {
        Self::of(scenario, MissionConfig { attended, ..scenario.mission.clone() })
    }

    /// Creates a flight for the operator at a console, who sees the plan before the start.
    pub fn for_operator(scenario: &Scenario) -> Self {
        let mission = scenario.mission.clone();
        Self::of(scenario, MissionConfig { attended: true, start_names_plan: true, ..mission })
    }

    fn of(scenario: &Scenario, config: MissionConfig) -> Self {
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
            plates: scenario.plates.clone(),
            checklist: scenario.checklist.clone(),
            measured: None,
        };
        Self {
            simulator: Simulator::new(scenario.sim.clone(), scenario.seed),
            tick: 0,
            tick_s: config.tick_s,
            mission: Mission::new(config, drawing, floor, scenario.seed),
            opened,
            readings: Readings::default(),
        }
    }

    /// Creates a forecast of how the flight would continue. Its tank contains only what the mission knows, and no faults
    /// are injected. The first order to the forecast must choose a planner.
    #[must_use]
    pub fn forked(&self, scenario: &Scenario) -> Self {
        let Fork { mission, world, pose, cable } = self.mission.fork();
        let ae = scenario.sim.ae.clone().map(|ae| {
            let disturbances = Disturbances { faults: Vec::new(), ..ae.disturbances };
            AeConfig { outages_s: Vec::new(), disturbances, ..ae }
        });
        let config = SimConfig { world, ae, movers: Vec::new(), ..scenario.sim.clone() };
        Self {
            simulator: Simulator::resumed(config, scenario.seed, pose, cable),
            mission,
            tick: 0,
            tick_s: self.tick_s,
            opened: self.opened.clone(),
            readings: Readings::default(),
        }
    }

    /// The first event of the run.
    pub fn opened(&self) -> Event {
        Event { tick: 0, t_s: 0.0, kind: EventKind::RunOpened(Box::new(self.opened.clone())) }
    }

    /// The mission.
    pub fn mission(&self) -> &Mission {
        &self.mission
    }

    /// The phase of the mission.
    pub fn phase(&self) -> &Phase {
        self.mission.phase()
    }

    /// The sensor readings of the last tick.
    pub fn readings(&self) -> &Readings {
        &self.readings
    }

    /// Length of a tick in mission time.
    pub fn tick_length(&self) -> Duration {
        Duration::from_secs_f64(self.tick_s)
    }

    /// Runs one tick: sense, ask planners and process their answers, act. The true state is written to the events first,
    /// and is used nowhere else.
    pub fn tick(&mut self, orders: &[Order], answers: &mut impl Answers) -> Vec<Event> {
        self.readings = self.simulator.sense();
        let truth = self.truth();
        self.mission.sense(&Input { readings: &self.readings, orders });
        loop {
            while let Some(ask) = self.mission.poll_ask() {
                answers.submit(ask);
            }
            let Some(answer) = answers.next(&self.mission) else { break };
            self.mission.answer(answer);
        }
        let step = self.mission.act();
        self.simulator.act(step.drive);
        self.inject_faults(&step.events);
        self.tick += 1;
        truth.chain(step.events).map(Event::rounded).collect()
    }

    /// Starts the injected station faults that the mission accepted; they take effect with the next tick.
    fn inject_faults(&mut self, events: &[Event]) {
        for event in events {
            if let EventKind::Ordered { order: Order::Inject(Injection { station, fault, for_s, .. }) } =
                &event.kind
            {
                let excess_range_m = match fault {
                    RangeFault::Dead => None,
                    RangeFault::Offset(metres) => Some(*metres),
                };
                self.simulator.inject(*station, *for_s, excess_range_m);
            }
        }
    }

    /// Events of this tick that only the simulator can report.
    fn truth(&self) -> impl Iterator<Item = Event> + use<> {
        let truth = self.simulator.truth();
        let (tick, t_s) = (self.tick, self.tick as f64 * self.tick_s);
        let (pose, clearance_m, collided) = (truth.pose, truth.clearance_m, truth.collided);
        let of_tether = truth.tether.map(|tether| EventKind::TetherTruth {
            length_m: tether.length_m,
            wrap_max_rad: tether.wrap_max_rad,
            wrap_total_rad: tether.wrap_total_rad,
            detour_m: tether.detour_m,
        });
        let kinds = std::iter::once(EventKind::Truth { pose, clearance_m, collided }).chain(of_tether);
        kinds.map(move |kind| Event { tick, t_s, kind })
    }
}
