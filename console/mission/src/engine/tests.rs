//! Missions in a small, perfect world: the ranges are exact, and the robot is a point that follows its commands.

mod arrivals;
mod better_plan;
mod braking;
mod caught;
mod covering;
mod finishing;
mod guarding;
mod lying;
mod returning;
mod shadow;
mod start;
mod stopping;
mod tethered;
mod under_way;
mod vehicle;
mod zones;

use super::*;
use crate::{
    ask::{Answer, Ask, Given, PlanAsk, Said, StepAsk, TaskLeft, What},
    chart::Chart,
    config::{BetterPlan, ScanConfig, TaskConfig},
    event::{JOURNAL_VERSION, RunOpened},
    phase::{Gait, Hold, HoldReason, Outcome},
    planner::{
        Cause, During, Fault, ParamInfo, ParamKind, ParamValue, Parameters, PlannerChoice, PlannerInfo,
    },
};
use planner_api::{self as api, Command, Limits, Motion, Plan, Status};
use std::sync::Arc;
use world::tether::Cable;
use world::{
    Amphibious, Boundary, Medium, Obstacle, ObstacleId, Odometry, Point, Pose, PressureSensor, RangeSet,
    Shape, Sighting, Station, StationId, Vector,
};

/// A planner that drives straight to its target, and otherwise behaves as the test requires.
#[derive(Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a way to misbehave")]
struct Straight {
    fail_at_tick: Option<u64>,
    fail_at_ticks: Vec<u64>,
    /// The tick in which the planner's second worker fails.
    second_fails_at_tick: Option<u64>,
    /// Whether the plans lead to the goal instead of to an arbitrary point.
    plans_to_goal: bool,
    /// Whether every answer comes with log messages and figures.
    says_much: bool,
    /// Whether the planner saves its state.
    snapshots: bool,
    refuse: Vec<&'static str>,
    /// The tick from which the planner reports that it cannot continue.
    stuck_from_tick: Option<u64>,
    chosen: Vec<String>,
    plans: usize,
    /// Area of the regions of every request to cover, square metres.
    regions_m2: Vec<f64>,
    /// The tank as known at each request.
    sites: Vec<Arc<crate::ask::Site>>,
    /// The plan to keep to in each request.
    kept: Vec<Option<Plan>>,
    /// The cut in the plans of coverage missions.
    cut: Option<Vec<Point>>,
    /// Distance from the middle of the tank at which the plans end, metres.
    plans_to_m: Option<f64>,
    /// Whether coverage plans consist of a single point.
    leads_nowhere: bool,
    /// Number of plans, counted from the first, that drive along each lane three times.
    wasteful_plans: usize,
    /// Number of the first plan that leaves out the last lane.
    scans_less_from_plan: Option<usize>,
    /// Whether the planner's process ended while it had nothing to do.
    has_died: bool,
    /// The worker whose process ended while it had nothing to do.
    dead_worker: Option<u16>,
    /// Whether the planner has a live parameter `gain` that it refuses to change during the mission.
    has_stiff_gain: bool,
    /// Whether coverage plans end with a lap along the wall.
    drives_a_lap: bool,
    /// Whether the planner proves that no path leads to the goal.
    sees_no_way: bool,
}

impl Straight {
    fn fault(&self, during: During, cause: Cause) -> Fault {
        let planner = self.chosen.last().cloned().unwrap_or_default();
        Fault {
            message: format!("planner {planner} failed during {during}"),
            planner,
            during,
            cause,
            partial: vec![],
            plugin_sha256: None,
        }
    }
}

impl Straight {
    /// Answers an ask; `None` for asks that have no answer.
    fn answer(&mut self, Ask { id, what }: Ask) -> Option<Answer> {
        let result = match what {
            What::Open { choice, .. } => self.open(&choice.id).map(|info| Given::Opened(Box::new(info))),
            What::Reconfigure(_) => self.reconfigure().map(|()| Given::Reconfigured),
            What::Plan(_) if self.sees_no_way => {
                Err(self.fault(During::Plan, Cause::Planner(api::Code::NoPath)))
            }
            What::Plan(request) => Ok(Given::Plan(self.plan(&request))),
            What::Step(sensed) if id.worker.0 == 2 && self.second_fails_at_tick == Some(sensed.tick) => {
                Err(self.fault(During::Step, Cause::Died))
            }
            What::Step(sensed) => self.step(&sensed).map(Given::Command),
            What::Snapshot if self.has_died || self.dead_worker == Some(id.worker.0) => {
                Err(self.fault(During::Step, Cause::Died))
            }
            What::Snapshot => Ok(Given::State { bytes: 1 }),
            What::Close => return None,
        };
        let mut said = Said::default();
        if self.says_much {
            said.logs = (0..id.n % 3).map(|n| (api::LogLevel::Info, format!("{id}, {n}"))).collect();
            said.scalars = vec![("n".into(), f64::from(id.n), String::new())];
        }
        Some(Answer { ask: id, result, said })
    }

    fn open(&mut self, id: &str) -> Result<PlannerInfo, Fault> {
        if self.refuse.contains(&id) {
            let message = format!("there is no planner {id}");
            let (during, cause) = (During::Load, Cause::Refused);
            let partial = vec![];
            return Err(Fault { planner: id.into(), during, cause, message, partial, plugin_sha256: None });
        }
        self.chosen.push(id.into());
        let text = String::new;
        Ok(PlannerInfo {
            id: id.into(),
            name: text(),
            version: "1.0".into(),
            about: text(),
            plugin: text(),
            sha256: format!("sha of {id}"),
            abi: text(),
            covers: true,
            snapshots: self.snapshots,
            sandbox: None,
            parameters: if self.has_stiff_gain { vec![gain(true)] } else { vec![] },
        })
    }

    fn reconfigure(&self) -> Result<(), Fault> {
        let cause = Cause::Planner(api::Code::Unsupported);
        if self.has_stiff_gain { Err(self.fault(During::Reconfigure, cause)) } else { Ok(()) }
    }

    fn plan(&mut self, request: &PlanAsk) -> Plan {
        self.plans += 1;
        self.kept.push(request.under_way.clone());
        self.sites.push(Arc::clone(&request.site));
        if let TaskLeft::Cover { anchor, regions, .. } = &request.task {
            self.regions_m2.push(regions.iter().map(|r| world::shape::ring_area_m2(r)).sum());
            let cuts = self.cut.iter().cloned().collect();
            if self.leads_nowhere {
                return Plan { path: vec![*anchor], ..Plan::default() };
            }
            let lanes = covering::lanes(request, *anchor, self.drives_a_lap);
            let lanes = if self.plans <= self.wasteful_plans { covering::wasteful(&lanes) } else { lanes };
            let scans_less = self.scans_less_from_plan.is_some_and(|first| self.plans >= first);
            let lanes = if scans_less { covering::without_last_lane(lanes) } else { lanes };
            return Plan { cuts, ..lanes };
        }
        let mut path = vec![request.start.position];
        path.extend(self.plans_to_m.map(|x_m| Point::new(x_m, 0.0)));
        if let TaskLeft::Goto { goal, .. } = request.task
            && self.plans_to_goal
        {
            path.push(goal);
        }
        Plan { path, complete: true, ..Plan::default() }
    }

    fn step(&mut self, sensed: &StepAsk) -> Result<Command, Fault> {
        if self.fail_at_tick == Some(sensed.tick) || self.fail_at_ticks.contains(&sensed.tick) {
            return Err(self.fault(During::Step, Cause::Panic));
        }
        if self.stuck_from_tick.is_some_and(|tick| sensed.tick >= tick) {
            return Ok(Command::still(Status::Stuck));
        }
        let way = sensed.target - sensed.pose.position;
        Ok(if way.norm() > 0.0 {
            Command::velocity(way.normalize() * 0.4)
        } else {
            Command::still(Status::Waiting)
        })
    }
}

/// The parameter `gain`, which can be changed during the mission if it is live.
fn gain(live: bool) -> ParamInfo {
    ParamInfo {
        key: "gain".into(),
        label: String::new(),
        unit: String::new(),
        help: String::new(),
        group: String::new(),
        kind: ParamKind::Float { min: 0.0, max: 9.0, default: 1.0 },
        live,
    }
}

fn drawing() -> World {
    let at = [(4.0, 0.0), (-4.0, 0.0), (0.0, 4.0), (0.0, -4.0)];
    let station = |(i, (x, y)): (usize, &(f64, f64))| Station {
        id: StationId(i as u32),
        name: format!("S{i}"),
        position: Point::new(*x, *y),
    };
    World {
        boundary: Boundary::Circle { radius_m: 5.0 },
        obstacles: vec![],
        stations: at.iter().enumerate().map(station).collect(),
        zones: vec![],
    }
}

/// The first event of a run.
fn opened(config: &MissionConfig) -> EventKind {
    let world = drawing();
    let floor = Floor::new(&world, config.cell_m, config.room_m(), config.swath_m, config.start.position);
    EventKind::RunOpened(Box::new(RunOpened {
        journal_version: JOURNAL_VERSION,
        tankops_version: String::new(),
        scenario: String::new(),
        scenario_toml: String::new(),
        seed: 1,
        world,
        mission: config.clone(),
        floor,
        plates: None,
        wear: None,
        checklist: vec![],
        measured: None,
        vehicle: None,
    }))
}

fn config() -> MissionConfig {
    MissionConfig {
        task: TaskConfig::Goto { goal: Point::new(3.0, 0.0), tolerance_m: 0.2 },
        start: Pose::new(-3.0, 0.0, 0.0),
        start_sigma_m: 0.05,
        start_heading_sigma_rad: 0.02,
        tick_s: 0.1,
        time_limit_s: 60.0,
        limits: Limits {
            motion: Motion::Point,
            v_max_m_per_s: 0.4,
            w_max_rad_per_s: 1.0,
            radius_m: 0.25,
            sensing_range_m: 2.0,
            acceleration_m_per_s2: 0.5,
            tick_s: 0.1,
            amphibious: None,
        },
        swath_m: 0.5,
        clearance_m: 0.05,
        cell_m: 0.1,
        position_limit_m: 0.3,
        position_lost_hold_s: 1.0,
        stuck_s: 10.0,
        odometry_sigma_per_m: 0.05,
        odometry_turn_sigma_per_rad: 0.05,
        gyro_sigma_rad_per_s: 0.001,
        range_sigma_ratio: 0.01,
        locating: crate::Locating::default(),
        scan: ScanConfig::default(),
        planner: PlannerChoice { id: "straight".into(), parameters: Parameters::new() },
        pressure: None,
        tether: None,
        fallback: None,
        attended: true,
        start_names_plan: false,
        live: false,
        guard_reaction_s: None,
        sensor: None,
        better_plan: BetterPlan::Offer,
        instrument: None,
    }
}

/// Number of ticks for which an ask that is issued in a tick stays unanswered.
type Delay = Box<dyn Fn(&Ask, u64) -> u64>;

/// The mission, its planner, and a robot that moves exactly as commanded.
struct Flight {
    mission: Mission,
    planner: Straight,
    pose: Pose,
    moved: Odometry,
    /// Velocity of the robot, metres per second.
    velocity: Vector,
    /// Maximum change of the velocity, metres per second squared; infinite for a robot that stops instantly.
    braking_m_per_s2: f64,
    silent: bool,
    /// Excess of the ranges of the first stations, metres.
    excess_range_m: Vec<f64>,
    /// Reading of the pressure sensor, pascals.
    pressure_pa: Option<f64>,
    /// The true cable, among obstacles that the mission has not seen; `None` without an encoder.
    reel: Option<Cable>,
    /// Additional length that the reel has paid out, metres.
    caught_m: f64,
    /// Pull of the cable at the robot, and at the reel, newtons.
    pull_n: Option<f64>,
    reel_pull_n: Option<f64>,
    sightings: Vec<Sighting>,
    events: Vec<Event>,
    /// Number of ticks for which an ask of this tick stays unanswered.
    delay: Delay,
    /// Asks without an answer, each with the tick in which it will be answered.
    open: Vec<(u64, Ask)>,
    closed: Vec<WorkerId>,
    /// Whether the stations exchange pulses in the next tick.
    pulse: bool,
    /// Why the vehicle must not be driven.
    trouble: Option<&'static str>,
    /// Age of the readings, seconds.
    age_s: f64,
    /// Discs that only a scanner sees, and whether the scanner works; `None` without a scanner.
    scanner: Option<(Vec<(Point, f64)>, bool)>,
    /// The inputs of each tick.
    inputs: Vec<(Readings, Vec<Order>)>,
}

impl Flight {
    fn new(config: MissionConfig) -> Self {
        let world = drawing();
        let floor =
            Floor::new(&world, config.cell_m, config.limits.radius_m, config.swath_m, config.start.position);
        let pose = config.start;
        Self {
            mission: Mission::new(config, world, floor, 1),
            planner: Straight::default(),
            pose,
            moved: Odometry::default(),
            velocity: Vector::zeros(),
            braking_m_per_s2: f64::INFINITY,
            silent: false,
            excess_range_m: vec![],
            pressure_pa: None,
            reel: None,
            caught_m: 0.0,
            pull_n: None,
            reel_pull_n: None,
            sightings: vec![],
            events: vec![],
            delay: Box::new(|_, _| 0),
            open: vec![],
            closed: vec![],
            pulse: false,
            trouble: None,
            age_s: 0.0,
            scanner: None,
            inputs: vec![],
        }
    }

    fn tick(&mut self, orders: &[Order]) -> Vec<EventKind> {
        let heard = |station: &Station| RangeSet {
            station: station.id,
            ranges_m: vec![(station.position - self.pose.position).norm()],
        };
        let mut ranges: Vec<RangeSet> =
            if self.silent { vec![] } else { drawing().stations.iter().map(heard).collect() };
        for (set, excess_range_m) in ranges.iter_mut().zip(&self.excess_range_m) {
            set.ranges_m.iter_mut().for_each(|range_m| *range_m += excess_range_m);
        }
        let readings = Readings {
            ranges,
            ranging_cycle: true,
            odometry: self.moved,
            unmeasured_s: 0.0,
            sightings: std::mem::take(&mut self.sightings),
            contact: false,
            paid_out_m: self.reel.as_ref().map(|cable| cable.length_m() + self.caught_m),
            robot_pull_n: self.pull_n,
            reel_pull_n: self.reel_pull_n,
            pressure_pa: self.pressure_pa,
            scan: self.scan(),
            pulses: if std::mem::take(&mut self.pulse) { exchange() } else { Vec::new() },
            ..Readings::default()
        };
        self.mission.sense(&Input { readings: &readings, age_s: self.age_s, orders, trouble: self.trouble });
        self.inputs.push((readings, orders.to_vec()));
        self.serve();
        let step = self.mission.act();
        let wanted = if let Drive::Velocity(velocity) = step.drive { velocity } else { Vector::zeros() };
        let (change, most_m_per_s) = (wanted - self.velocity, 0.1 * self.braking_m_per_s2);
        self.velocity = if change.norm() > most_m_per_s {
            self.velocity + change.normalize() * most_m_per_s
        } else {
            wanted
        };
        let velocity = self.velocity;
        // The heading does not change, because the odometry of a point robot has two components.
        self.pose.position += velocity * 0.1;
        if let Some(cable) = &mut self.reel {
            cable.drag_to(self.pose.position);
        }
        self.moved = Odometry { forward_m: velocity.x * 0.1, sideways_m: velocity.y * 0.1, turn_rad: 0.0 };
        self.events.extend(step.events.clone());
        step.events.into_iter().map(|event| event.kind).collect()
    }

    /// The scan from the robot's position.
    fn scan(&self) -> Option<world::Scan> {
        let (discs, _) = self.scanner.as_ref().filter(|(_, works)| *works)?;
        let step_rad = std::f64::consts::TAU / 360.0;
        let ray = |n: u32| {
            let (sin, cos) = (self.pose.heading_rad + f64::from(n) * step_rad).sin_cos();
            let hit = |(center, radius_m): &(Point, f64)| {
                let to = center - self.pose.position;
                let along = to.dot(&Vector::new(cos, sin));
                let rest = radius_m * radius_m - (to.norm_squared() - along * along);
                (rest >= 0.0 && along > 0.0).then(|| along - rest.sqrt())
            };
            let known = &self.mission.known;
            let wall_m = known.chart.world().boundary.ray_m(self.pose.position, Vector::new(cos, sin));
            // Only missions that look for obstacles in scans need the wall.
            let wall_m = known.perception.is_some().then_some(wall_m);
            world::Scan::stored(discs.iter().filter_map(hit).chain(wall_m).min_by(f64::total_cmp))
        };
        Some(world::Scan {
            step_rad,
            ranges_mm: world::scan::RangesMm((0..360).map(ray).collect()),
            ..world::Scan::default()
        })
    }

    /// Sends the answers that are due in this tick, and takes new asks.
    fn serve(&mut self) {
        let tick = self.mission.known.tick;
        loop {
            while let Some(ask) = self.mission.poll_ask() {
                if ask.what == What::Close {
                    self.open.retain(|(_, open)| open.id.worker != ask.id.worker);
                    self.closed.push(ask.id.worker);
                } else {
                    let due = tick + (self.delay)(&ask, tick);
                    self.open.push((due, ask));
                }
            }
            let Some(at) = self.open.iter().position(|(due, _)| *due <= tick) else { return };
            let (_, ask) = self.open.remove(at);
            if let Some(answer) = self.planner.answer(ask) {
                self.mission.answer(answer);
            }
        }
    }

    fn fly(&mut self, ticks: usize) {
        for _ in 0..ticks {
            self.tick(&[]);
        }
    }

    fn held_by(&self) -> Option<&HoldReason> {
        match self.mission.phase() {
            Phase::Held(hold) => Some(&hold.by),
            _ => None,
        }
    }

    fn ended(&self) -> Option<Outcome> {
        match self.mission.phase() {
            Phase::Ended(outcome) => Some(*outcome),
            _ => None,
        }
    }
}

/// The pulses of all stations, heard by all others.
fn exchange() -> Vec<world::PulseSet> {
    let stations = drawing().stations;
    let pairs = stations.iter().flat_map(|from| stations.iter().map(move |to| (from, to)));
    let apart = pairs.filter(|(from, to)| from.id != to.id);
    apart
        .map(|(from, to)| world::PulseSet {
            sender: from.id,
            receiver: to.id,
            lengths_m: vec![(from.position - to.position).norm()],
        })
        .collect()
}

fn swap_to(id: &str) -> Order {
    Order::ChoosePlanner(PlannerChoice { id: id.into(), parameters: Parameters::new() })
}

fn refusal(events: &[EventKind]) -> Option<&str> {
    events.iter().find_map(|kind| match kind {
        EventKind::OrderRefused { why, .. } => Some(why.as_str()),
        _ => None,
    })
}

#[test]
fn nothing_moves_before_the_start_is_ordered() {
    let mut flight = Flight::new(config());
    flight.fly(20);
    assert_eq!(flight.pose, config().start);
    assert!(refusal(&flight.tick(&[Order::Resume])).is_some_and(|why| why.contains("not been started")));
}

#[test]
fn a_goto_mission_ends_complete_at_its_goal() {
    let mut flight = Flight::new(config());
    flight.tick(&[Order::Start]);
    flight.fly(200);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
    assert!((flight.pose.position - Point::new(3.0, 0.0)).norm() < 0.3);
    let covered = flight.events.iter().rev().find_map(|event| match event.kind {
        EventKind::Progressed { covered_reachable, .. } => Some(covered_reachable),
        _ => None,
    });
    let swept = (5.8 * 0.5) / (std::f64::consts::PI * 25.0);
    assert!(covered.is_some_and(|share| (share - swept).abs() < 0.02), "{covered:?} of {swept}");
}

#[test]
fn a_robot_with_a_pressure_sensor_waits_until_its_medium_is_known() {
    let sensor = PressureSensor { depth_m: 0.3, sigma_pa: 2_000.0 };
    let limits = Limits { amphibious: Some(Amphibious::YANG_2021), ..config().limits };
    let mut flight = Flight::new(MissionConfig { limits, pressure: Some(sensor), ..config() });
    flight.tick(&[Order::Start]);
    // Halfway between the two expected pressures: such readings decide nothing.
    flight.pressure_pa = Some(0.5 * sensor.expected_pa(Medium::Underwater));
    flight.fly(30);
    assert_eq!(flight.pose, config().start);
    let awaited = flight.events.iter().filter(|event| event.kind == EventKind::MediumAwaited).count();
    assert_eq!(awaited, 1);
    flight.pressure_pa = Some(sensor.expected_pa(Medium::Underwater));
    flight.fly(40);
    let known: Vec<Medium> = flight.events.iter().filter_map(medium_of).collect();
    assert_eq!(known, [Medium::Underwater]);
    assert!(flight.pose.position.x > config().start.position.x + 0.1, "{:?}", flight.pose);
    // Readings of dry floor must first outweigh the earlier readings.
    flight.pressure_pa = Some(0.0);
    flight.fly(60);
    let known: Vec<Medium> = flight.events.iter().filter_map(medium_of).collect();
    assert_eq!(known, [Medium::Underwater, Medium::Land]);
}

fn medium_of(event: &Event) -> Option<Medium> {
    match event.kind {
        EventKind::MediumKnown { medium, .. } => Some(medium),
        _ => None,
    }
}

#[test]
fn the_end_is_the_last_event_also_by_order() {
    let mut flight = Flight::new(config());
    flight.tick(&[Order::Start]);
    flight.fly(20);
    let events = flight.tick(&[Order::Abort]);
    assert!(matches!(events.last(), Some(EventKind::Ended { outcome: Outcome::Aborted, .. })), "{events:?}");
}

#[test]
fn a_held_robot_stands_still_and_goes_on_only_by_order() {
    let mut flight = Flight::new(config());
    flight.tick(&[Order::Start]);
    flight.fly(20);
    flight.tick(&[Order::Hold]);
    let held_at = flight.pose;
    flight.fly(30);
    assert_eq!(flight.pose, held_at);
    assert_eq!(flight.held_by(), Some(&HoldReason::Operator));
    flight.tick(&[Order::Step]);
    assert!((flight.pose.position - held_at.position).norm() > 0.03);
    assert_eq!(flight.held_by(), Some(&HoldReason::Stepped));
    flight.tick(&[Order::Resume]);
    flight.fly(200);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
}

#[test]
fn a_planner_that_fails_holds_the_robot_in_the_same_tick() {
    let mut flight = Flight::new(config());
    flight.planner.fail_at_tick = Some(30);
    flight.tick(&[Order::Start]);
    flight.fly(29);
    let before = flight.pose;
    let events = flight.tick(&[]);
    assert_eq!(flight.pose, before);
    assert!(events.iter().any(|kind| matches!(kind, EventKind::PlannerFailed { .. })));
    assert!(
        events.iter().any(|kind| matches!(kind, EventKind::Held { by: HoldReason::PlannerFault { .. }, .. }))
    );
    flight.tick(&[swap_to("other")]);
    flight.tick(&[Order::Resume]);
    flight.fly(200);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
    assert_eq!(flight.planner.chosen, ["straight", "other"]);
}

#[test]
fn the_fallback_takes_over_by_itself() {
    let fallback = PlannerChoice { id: "fallback".into(), parameters: Parameters::new() };
    let mut flight = Flight::new(MissionConfig { fallback: Some(fallback), ..config() });
    flight.planner.fail_at_tick = Some(30);
    flight.tick(&[Order::Start]);
    flight.fly(250);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
    assert_eq!(flight.planner.chosen, ["straight", "fallback"]);
}

#[test]
fn without_operator_and_fallback_a_planner_fault_ends_the_mission() {
    let mut flight = Flight::new(MissionConfig { attended: false, ..config() });
    flight.planner.fail_at_tick = Some(30);
    flight.tick(&[Order::Start]);
    flight.fly(40);
    assert_eq!(flight.ended(), Some(Outcome::Aborted));
}

#[test]
fn a_planner_that_is_not_there_holds_at_the_start_and_another_may_fly() {
    let mut flight = Flight::new(config());
    flight.planner.refuse = vec!["straight"];
    flight.tick(&[Order::Start]);
    assert!(matches!(flight.held_by(), Some(HoldReason::PlannerFault { .. })));
    let again = flight.tick(&[Order::Resume]);
    assert!(again.iter().any(|kind| matches!(kind, EventKind::PlannerFailed { fault, .. } if fault.message.contains("no planner straight"))));
    assert!(matches!(flight.held_by(), Some(HoldReason::PlannerFault { .. })));
    flight.tick(&[swap_to("other")]);
    assert_eq!(
        flight.held_by(),
        Some(&HoldReason::PlannerReplaced),
        "the reason for the hold is gone together with the planner"
    );
    flight.tick(&[Order::Resume]);
    flight.fly(200);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
}

#[test]
fn a_planner_is_not_swapped_while_the_robot_moves() {
    let mut flight = Flight::new(config());
    flight.tick(&[Order::Start]);
    assert!(refusal(&flight.tick(&[swap_to("other")])).is_some_and(|why| why.contains("HOLD first")));
}

#[test]
fn a_planner_that_is_refused_does_not_take_over() {
    let mut flight = Flight::new(config());
    flight.planner.refuse = vec!["other"];
    flight.tick(&[Order::Start]);
    flight.fly(10);
    flight.tick(&[Order::Hold]);
    let events = flight.tick(&[swap_to("other")]);
    assert!(events.iter().any(|kind| matches!(kind, EventKind::PlannerRejected { why, .. } if why.contains("there is no planner other"))), "{events:?}");
    assert_eq!(flight.held_by(), Some(&HoldReason::Operator));
    flight.tick(&[Order::Resume]);
    flight.fly(200);
    assert_eq!(flight.ended(), Some(Outcome::Complete), "the previous planner continues");
}

#[test]
fn the_time_of_a_mission_that_an_operator_holds_does_not_run_out() {
    for (attended, ended) in [(true, Outcome::Complete), (false, Outcome::TimeLimit)] {
        let mut flight = Flight::new(MissionConfig { attended, ..config() });
        flight.tick(&[Order::Start]);
        flight.fly(10);
        flight.tick(&[Order::Hold]);
        flight.fly(1000);
        flight.tick(&[Order::Resume]);
        flight.fly(200);
        assert_eq!(flight.ended(), Some(ended), "attended: {attended}");
    }
}

#[test]
fn a_lost_position_holds_the_robot_and_a_regained_one_lets_it_go_on() {
    let mut flight = Flight::new(MissionConfig { odometry_sigma_per_m: 0.5, ..config() });
    flight.tick(&[Order::Start]);
    flight.fly(10);
    flight.silent = true;
    flight.fly(60);
    assert_eq!(flight.held_by(), Some(&HoldReason::PositionLost));
    assert!(refusal(&flight.tick(&[Order::Resume])).is_some_and(|why| why.contains("limit 0.30 m")));
    flight.silent = false;
    flight.fly(200);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
}

fn count(flight: &Flight, is: impl Fn(&EventKind) -> bool) -> usize {
    flight.events.iter().filter(|event| is(&event.kind)).count()
}

#[test]
fn contradicting_ranges_hold_the_robot_in_time_and_it_goes_on_when_they_agree() {
    let mut flight = Flight::new(MissionConfig { position_lost_hold_s: 2.0, ..config() });
    flight.tick(&[Order::Start]);
    flight.fly(10);
    // With four stations, it is impossible to identify the wrong one.
    flight.excess_range_m = vec![1.5];
    flight.fly(20);
    assert_eq!(flight.held_by(), Some(&HoldReason::RangesInconsistent), "within 2 s");
    assert!(refusal(&flight.tick(&[Order::Resume])).is_some_and(|why| why.contains("contradict")));
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::RangesInconsistent { .. })), 1);
    flight.excess_range_m.clear();
    flight.fly(200);
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::RangesConsistent)), 1);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
}

#[test]
fn a_single_contradicting_cycle_holds_nobody() {
    let mut flight = Flight::new(config());
    flight.tick(&[Order::Start]);
    flight.fly(10);
    flight.excess_range_m = vec![1.5];
    flight.fly(1);
    flight.excess_range_m.clear();
    flight.fly(200);
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::Held { .. })), 0);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
}

#[test]
fn every_exclusion_is_reported_with_its_reason() {
    let consensus =
        crate::Locating { solver: positioning::SolverKind::Consensus, ..crate::Locating::default() };
    let mut flight = Flight::new(MissionConfig { locating: consensus, ..config() });
    flight.tick(&[Order::Start]);
    flight.fly(10);
    flight.excess_range_m = vec![1.5];
    flight.fly(5);
    flight.excess_range_m.clear();
    flight.fly(5);
    let late = |kind: &EventKind| matches!(kind, EventKind::StationRejected { station: StationId(0), reason: positioning::Exclusion::Residual { residual_m, .. } } if *residual_m > 1.0);
    assert_eq!(count(&flight, late), 1);
    assert_eq!(count(&flight, |kind| matches!(kind, EventKind::StationRestored { .. })), 1);
}

#[test]
fn a_planner_that_sees_no_way_has_not_failed() {
    for attended in [true, false] {
        let mut flight = Flight::new(MissionConfig { attended, ..config() });
        flight.planner.sees_no_way = true;
        flight.tick(&[Order::Start]);
        flight.fly(10);
        if attended {
            assert!(matches!(flight.held_by(), Some(HoldReason::Stuck { .. })));
        } else {
            assert_eq!(
                flight.ended(),
                Some(Outcome::Stuck),
                "{:?}",
                (flight.mission.phase(), flight.mission.driving.prepare)
            );
        }
    }
}

#[test]
fn a_stuck_robot_is_held_for_the_operator_and_ends_the_mission_without_one() {
    for attended in [true, false] {
        let goal = Point::new(3.0, 0.0);
        let task = TaskConfig::Goto { goal, tolerance_m: 0.0 };
        let mut flight = Flight::new(MissionConfig { task, attended, ..config() });
        flight.tick(&[Order::Start]);
        flight.fly(400);
        if attended {
            assert!(matches!(flight.held_by(), Some(HoldReason::Stuck { .. })));
            flight.tick(&[Order::Resume]);
            assert_eq!(flight.mission.phase(), &Phase::Running(Gait::Steady));
        } else {
            assert_eq!(flight.ended(), Some(Outcome::Stuck));
        }
    }
}

#[test]
fn a_found_obstacle_is_reported_once_and_planned_for() {
    let mut flight = Flight::new(config());
    flight.tick(&[Order::Start]);
    for _ in 0..5 {
        let relative = Point::from(Point::new(0.0, 2.0) - flight.pose.position);
        let shape_in_robot = Shape::Disc { center: relative, radius_m: 0.3 };
        flight.sightings = vec![Sighting { id: ObstacleId(7), shape_in_robot }];
        flight.tick(&[]);
    }
    let found: Vec<&Obstacle> = flight
        .events
        .iter()
        .filter_map(|event| match &event.kind {
            EventKind::ObstacleFound { obstacle } => Some(obstacle),
            _ => None,
        })
        .collect();
    assert_eq!(found.len(), 1);
    assert!((found[0].shape.center() - Point::new(0.0, 2.0)).norm() < 0.1);
    assert_eq!(flight.planner.plans, 2);
}

#[test]
fn two_flights_with_the_same_orders_tell_the_same() {
    let fly = || {
        let mut flight = Flight::new(config());
        flight.tick(&[Order::Start]);
        flight.fly(30);
        flight.tick(&[Order::Hold]);
        flight.tick(&[Order::Resume]);
        flight.fly(200);
        serde_json::to_string(&flight.events).unwrap()
    };
    let journal = fly();
    assert_eq!(journal, fly());
    let back: Vec<Event> = serde_json::from_str(&journal).unwrap();
    assert_eq!(serde_json::to_string(&back).unwrap(), journal);
}

#[test]
fn a_live_parameter_that_the_planner_cannot_change_under_way_makes_a_new_instance_while_held() {
    let mut flight = Flight::new(config());
    flight.planner.has_stiff_gain = true;
    flight.tick(&[Order::Start]);
    let gain = || Order::SetParameter { key: "gain".into(), value: ParamValue::Float(2.0) };
    let events = flight.tick(&[gain()]);
    assert!(
        events.iter().any(|kind| matches!(kind, EventKind::PlannerFailed { .. })),
        "it says so: {events:?}"
    );
    assert_eq!(
        flight.mission.phase(),
        &Phase::Running(Gait::Steady),
        "the planner continues with the old value"
    );
    flight.tick(&[Order::Hold]);
    assert_eq!(refusal(&flight.tick(&[gain()])), None);
    assert_eq!((flight.planner.chosen.len(), flight.planner.plans), (2, 2));
}

#[test]
fn a_plan_that_has_nothing_to_do_with_the_tank_is_a_fault_of_its_planner() {
    let why = |x_m: f64| {
        let mut flight = Flight::new(config());
        flight.planner.plans_to_m = Some(x_m);
        let events = flight.tick(&[Order::Start]);
        let is_fault = |kind: &EventKind| match kind {
            EventKind::PlannerFailed { fault, .. } => Some(fault.message.clone()),
            _ => None,
        };
        assert!(!events.iter().any(|kind| matches!(kind, EventKind::Planned { .. })) || x_m < 15.0);
        events.iter().find_map(is_fault)
    };
    assert_eq!(why(14.0), None, "a planner may begin or end beside the tank");
    assert_eq!(
        why(1e9).as_deref(),
        Some("planner straight gave a path whose point 1, 1000000000.0, 0.0 m, is far outside the tank")
    );
}
