//! One flight: the vehicle and the mission, tick by tick.

use crate::{
    answers::Answers,
    live::{LiveWatch, before_end},
    simulated::Simulated,
};
use geometry::Drive;
use mission::{
    Event, EventKind, Fork, Injection, Input, Mission, MissionConfig, Order, Phase, RangeFault, RunOpened,
    Sensor, event::JOURNAL_VERSION,
};
use scenario::Scenario;
use sim::{AeConfig, Disturbances, PhysicalCable, RobotConfig, SimConfig, Simulator};
use std::time::Duration;
use vehicle::port::{Brake, Command, Live, Sensed, StationFault, Vehicle, VehicleInfo};
use world::Readings;

/// A scenario in flight.
pub struct Flight {
    vehicle: Box<dyn Vehicle>,
    /// The state of a real vehicle; `None` in a simulation.
    watch: Option<LiveWatch>,
    mission: Mission,
    tick: u64,
    tick_s: f64,
    opened: RunOpened,
    readings: Readings,
}

/// A copy of a mission in its current state, from which forecasts begin.
#[derive(Clone)]
pub struct Forked {
    fork: Fork,
    opened: RunOpened,
    tick_s: f64,
}

impl Forked {
    /// Creates a forecast of how the flight would continue. Its tank contains only what the mission knows, and no faults
    /// are injected. The first order to the forecast must choose a planner.
    pub fn flight(&self, scenario: &Scenario) -> Flight {
        let Fork { mission, world, pose, cable, clocks_m } = self.fork.clone();
        let ae = scenario.sim.ae.clone().map(|ae| {
            let disturbances = Disturbances { faults: Vec::new(), ..ae.disturbances };
            AeConfig { outages_s: Vec::new(), disturbances, ..ae }
        });
        let robot = RobotConfig { scanner: None, ..scenario.sim.robot.clone() };
        let physical =
            scenario.sim.physical.map(|cable| PhysicalCable { fails_at_s: None, breaks_at_s: None, ..cable });
        let config = SimConfig {
            world,
            robot,
            ae,
            movers: Vec::new(),
            physical,
            channel_faults: Vec::new(),
            ..scenario.sim.clone()
        };
        Flight {
            vehicle: Box::new(Simulated::new(Simulator::resumed(
                config,
                scenario.seed,
                pose,
                cable,
                &clocks_m,
            ))),
            watch: None,
            mission,
            tick: 0,
            tick_s: self.tick_s,
            opened: self.opened.clone(),
            readings: Readings::default(),
        }
    }
}

/// The part of a vehicle's stop time that braking with the scenario's deceleration does not explain, seconds.
fn reaction_s(opened: &RunOpened, info: &VehicleInfo) -> f64 {
    let braking_s = info.speed_max_m_per_s / opened.mission.limits.acceleration_m_per_s2;
    (info.stop_s - braking_s).max(0.0)
}

impl Flight {
    /// Creates a flight that waits for its start; `attended` states whether an operator is present.
    pub fn prepare(scenario: &Scenario, attended: bool) -> Self {
        Self::of(scenario, MissionConfig { attended, ..scenario.mission.clone() }, None)
    }

    /// Creates a flight for the operator at a console, who sees the plan before the start.
    pub fn for_operator(scenario: &Scenario) -> Self {
        let mission = scenario.mission.clone();
        Self::of(scenario, MissionConfig { attended: true, start_names_plan: true, ..mission }, None)
    }

    /// The same flight, before its first tick, with a real vehicle in place of the simulator.
    #[must_use]
    pub fn with_vehicle(self, scenario: &Scenario, vehicle: Box<dyn Vehicle>, info: VehicleInfo) -> Self {
        let has_scan = info.has.iter().any(|part| part == "scan");
        let guard_reaction_s = has_scan.then(|| reaction_s(&self.opened, &info));
        let sensor = has_scan.then(|| self.opened.mission.sensor.unwrap_or(Sensor::UNKNOWN));
        let config = MissionConfig { live: true, guard_reaction_s, sensor, ..self.opened.mission };
        Self::of(scenario, config, Some((vehicle, info)))
    }

    fn of(scenario: &Scenario, config: MissionConfig, real: Option<(Box<dyn Vehicle>, VehicleInfo)>) -> Self {
        let drawing = scenario.sim.world.as_drawn();
        let floor = config.floor(&drawing);
        let (vehicle, info) = real.unzip();
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
            wear: scenario.wear.clone().filter(|_| info.is_none()),
            checklist: scenario.checklist.clone(),
            measured: None,
            vehicle: info.clone().map(Box::new),
        };
        let simulated = || -> Box<dyn Vehicle> {
            Box::new(Simulated::new(Simulator::new(scenario.sim.clone(), scenario.seed)))
        };
        Self {
            vehicle: vehicle.unwrap_or_else(simulated),
            watch: info.map(|_| LiveWatch::default()),
            tick: 0,
            tick_s: config.tick_s,
            mission: Mission::new(config, drawing, floor, scenario.seed),
            opened,
            readings: Readings::default(),
        }
    }

    /// Copies the mission in its current state, for forecasts.
    pub fn forked(&self) -> Forked {
        // A forecast is a simulation, even of a real vehicle's run.
        let mission = MissionConfig { live: false, ..self.opened.mission.clone() };
        let opened = RunOpened { vehicle: None, mission, ..self.opened.clone() };
        Forked { fork: self.mission.fork(), opened, tick_s: self.tick_s }
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

    /// Whether the robot is a real vehicle.
    pub fn is_live(&self) -> bool {
        self.watch.is_some()
    }

    /// Whether a commanded stop of a real vehicle is still open: odometry has neither confirmed nor disproved it yet.
    pub fn awaits_stop(&self) -> bool {
        self.watch.as_ref().is_some_and(LiveWatch::awaits_stop)
    }

    /// Whether a start order can be decided: readings have shown whether the vehicle stands still, or a problem with the
    /// vehicle is known, and a start is refused with that reason.
    pub fn can_decide_start(&self) -> bool {
        self.vehicle.is_standstill_known() || self.trouble().is_some()
    }

    fn trouble(&self) -> Option<String> {
        self.watch.as_ref()?.trouble(matches!(self.mission.phase(), Phase::Waiting))
    }

    /// A handle that stops a real vehicle at once; `None` in a simulation.
    pub fn brake(&self) -> Option<Brake> {
        self.vehicle.brake()
    }

    /// Runs one tick: sense, ask planners and process their answers, act. The true state is written to the events first,
    /// and is used nowhere else.
    pub fn tick(&mut self, orders: &[Order], answers: &mut impl Answers) -> Vec<Event> {
        let Sensed { readings, live } = self.vehicle.sense();
        self.readings = readings;
        let mut first = self.truth();
        first.extend(self.scanned());
        let live = live.unwrap_or_default();
        first.extend(self.watched(&live));
        let age_s =
            self.watch.as_mut().map(|watch| watch.age_s(live.stamps, self.tick_s)).unwrap_or_default();
        let trouble = self.trouble();
        self.mission.sense(&Input { readings: &self.readings, age_s, orders, trouble: trouble.as_deref() });
        loop {
            while let Some(ask) = self.mission.poll_ask() {
                answers.submit(ask);
            }
            let Some(answer) = answers.next(&self.mission) else { break };
            self.mission.answer(answer);
        }
        let mut step = self.mission.act();
        self.act(step.drive, orders, &mut step.events);
        self.settle(&mut step.events);
        self.inject_faults(&step.events);
        self.tick += 1;
        first.into_iter().chain(step.events).map(Event::rounded).collect()
    }

    /// Sends the command of this tick to the vehicle. A robot that must not move gets a command to stand still, not a
    /// drive at speed 0: a real vehicle then stands still without further commands.
    fn act(&mut self, drive: Drive, orders: &[Order], events: &mut Vec<Event>) {
        let may_drive = matches!(self.mission.phase(), Phase::Running(_)) || drive != Drive::STILL;
        let drive = may_drive.then_some(drive);
        if let Some(sent) = self.watch.as_mut().and_then(|watch| watch.sent(drive)) {
            before_end(events, self.event(sent));
        }
        let braking_orders = orders.iter().filter(|order| order.brakes()).count() as u32;
        self.vehicle.act(Command { drive, heading_rad: self.mission.heading_rad(), braking_orders });
    }

    /// At the end of a mission, adds the last state of the link. Without an operator, it waits for the stop.
    fn settle(&mut self, events: &mut Vec<Event>) {
        let Some(watch) = self.watch.as_mut().filter(|_| matches!(self.mission.phase(), Phase::Ended(_)))
        else {
            return;
        };
        let Some(live) = self.vehicle.settle(!self.opened.mission.attended) else { return };
        for kind in watch.sensed(&Readings::default(), &live) {
            before_end(events, self.event(kind));
        }
    }

    fn event(&self, kind: EventKind) -> Event {
        Event { tick: self.tick, t_s: self.tick as f64 * self.tick_s, kind }
    }

    /// The scan of a simulated scanner; that of a real vehicle is part of its readings.
    fn scanned(&self) -> Option<Event> {
        let scan = self.readings.scan.as_ref().filter(|_| self.watch.is_none())?;
        Some(self.event(EventKind::Scanned { scan: Box::new(scan.clone()) }))
    }

    /// The events of this tick about a real vehicle.
    fn watched(&mut self, live: &Live) -> Vec<Event> {
        let kinds = self.watch.as_mut().map(|watch| watch.sensed(&self.readings, live)).unwrap_or_default();
        kinds.into_iter().map(|kind| self.event(kind)).collect()
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
                // The mission accepts this order only in a simulation.
                let _ =
                    self.vehicle.inject(StationFault { station: *station, for_s: *for_s, excess_range_m });
            }
        }
    }

    /// Events of this tick that only the simulator can report.
    fn truth(&self) -> Vec<Event> {
        let Some(truth) = self.vehicle.truth() else { return Vec::new() };
        let (pose, clearance_m, collided) = (truth.pose, truth.clearance_m, truth.collided);
        let of_tether = truth.tether.map(|tether| EventKind::TetherTruth {
            length_m: tether.length_m,
            wrap_max_rad: tether.wrap_max_rad,
            wrap_total_rad: tether.wrap_total_rad,
            detour_m: tether.detour_m,
            lies: tether.lies.map(Box::new),
        });
        let kinds = std::iter::once(EventKind::Truth { pose, clearance_m, collided }).chain(of_tether);
        kinds.map(|kind| self.event(kind)).collect()
    }
}
