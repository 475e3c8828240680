//! A spiral mission in a tank with columns, as scripted events without an engine.

use mission::event::{JOURNAL_VERSION, RunOpened, TetherAlarm, TetherContact};
use mission::planner::{Cause, During, Fault};
use mission::{
    AskId, Event, EventKind, HoldReason, MissionConfig, Order, Outcome, ParamInfo, ParamKind, Parameters,
    PlannerChoice, PlannerInfo, Resumes, Sandbox, ScanConfig, TaskConfig, TetherConfig,
};
use nalgebra::{Matrix2, Matrix3};
use planner_api::{Command, Drawing, Layer, Limits, Motion, PoseEstimate, Reason};
use positioning::{Exclusion, Fix, Integrity, Ranging, Residual};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::OnceLock;
use tui::{
    Caps, Colours, Glyphs, Health, Model, Msg, Recording, RunId, RunMsg, Source, Speed, Times, update,
};
use world::spiral::Spiral;
use world::tether::{Bearing, Cable, Certificate, Contact, capstan_factor};
use world::{
    Boundary, CoverageGrid, Floor, Obstacle, ObstacleId, Point, Pose, Shape, Station, StationId, Vector,
    World,
};

/// Length of a tick, seconds.
pub(crate) const TICK_S: f64 = 0.5;
/// Distance driven in a tick, metres.
const STEP_M: f64 = 0.1;

/// The tank.
pub(crate) fn world() -> World {
    let columns = [(5.0, 0.0), (-4.0, 3.0), (0.0, -6.0), (3.5, 4.5), (-5.5, -3.5)];
    let mut obstacles: Vec<Obstacle> = columns
        .iter()
        .enumerate()
        .map(|(index, (x, y))| Obstacle {
            id: ObstacleId(index as u32),
            name: format!("C{}", index + 1),
            shape: Shape::Disc { center: Point::new(*x, *y), radius_m: 0.4 },
            known: true,
        })
        .collect();
    obstacles.push(found());
    let stations = [(10.0, 45.0_f64), (10.0, 135.0), (10.0, 225.0), (10.0, 315.0)];
    let stations = stations
        .iter()
        .enumerate()
        .map(|(index, (radius_m, bearing))| Station {
            id: StationId(index as u32 + 1),
            name: format!("S{}", index + 1),
            position: Point::new(
                radius_m * bearing.to_radians().cos(),
                radius_m * bearing.to_radians().sin(),
            ),
        })
        .collect();
    World { boundary: Boundary::Circle { radius_m: 10.0 }, obstacles, stations, zones: Vec::new() }
}

/// The obstacle that is not on the drawing.
pub(crate) fn found() -> Obstacle {
    let shape = Shape::Disc { center: Point::new(-1.0, 8.2), radius_m: 0.3 };
    Obstacle { id: ObstacleId(40), name: "debris".into(), shape, known: false }
}

/// The preset path.
pub(crate) fn spiral() -> Vec<Point> {
    Spiral { outer_radius_m: 9.4, inner_radius_m: 0.1, pitch_m: 0.6, step_rad: 0.05 }.points()
}

/// The mission.
pub(crate) fn config() -> MissionConfig {
    MissionConfig {
        task: TaskConfig::Follow { path: spiral(), tolerance_m: 0.2 },
        start: Pose::new(9.4, 0.0, FRAC_PI_2),
        start_sigma_m: 0.05,
        start_heading_sigma_rad: 0.02,
        tick_s: TICK_S,
        time_limit_s: 3600.0,
        limits: Limits {
            motion: Motion::Unicycle,
            v_max_m_per_s: 0.3,
            w_max_rad_per_s: 0.5,
            radius_m: 0.3,
            sensing_range_m: 2.0,
            acceleration_m_per_s2: 0.5,
            tick_s: 0.1,
            amphibious: None,
        },
        swath_m: 0.6,
        scan: ScanConfig::default(),
        clearance_m: 0.1,
        cell_m: 0.1,
        position_limit_m: 0.15,
        position_lost_hold_s: 2.0,
        stuck_s: 60.0,
        odometry_sigma_per_m: 0.05,
        odometry_turn_sigma_per_rad: 0.05,
        gyro_sigma_rad_per_s: 0.001,
        range_sigma_ratio: 0.01,
        locating: mission::Locating::default(),
        planner: choice("rpf"),
        pressure: None,
        tether: None,
        fallback: None,
        attended: true,
        start_names_plan: true,
        live: false,
        guard_reaction_s: None,
        sensor: None,
        better_plan: mission::BetterPlan::Offer,
        instrument: None,
    }
}

/// A tether from the eastern shell.
pub(crate) fn tether() -> TetherConfig {
    let limits = world::tether::Limits { reel_length_m: 30.0, wrap_max_rad: PI, wrap_total_max_rad: TAU };
    TetherConfig { anchor: Point::new(9.4, 0.0), limits, friction: 0.3, reel: None, allow_uncertified: false }
}

/// A planner with nothing set by hand.
pub(crate) fn choice(id: &str) -> PlannerChoice {
    PlannerChoice { id: id.into(), parameters: Parameters::new() }
}

fn parameter(key: &str, label: &str, unit: &str, help: &str, kind: ParamKind, live: bool) -> ParamInfo {
    let [key, label, unit, help, group] = [key, label, unit, help, "forces"].map(str::to_owned);
    ParamInfo { key, label, unit, help, group, kind, live }
}

/// A planner as the host describes it.
pub(crate) fn planner(id: &str, version: &str, about: &str) -> PlannerInfo {
    let float = |min, max, default| ParamKind::Float { min, max, default };
    let gain =
        "Strength of the rotating field near a column. Higher keeps a wider berth and makes a longer path.";
    PlannerInfo {
        id: id.into(),
        name: id.to_uppercase(),
        version: version.into(),
        about: about.into(),
        plugin: "spiral.so".into(),
        sha256: "1c9e".into(),
        abi: "1.0".into(),
        covers: false,
        snapshots: false,
        sandbox: Some(Sandbox::Full),
        parameters: vec![
            parameter("rpf_gain", "Rotating gain", "m3/s", gain, float(0.2, 4.0, 1.2), true),
            parameter(
                "rpf_radius_m",
                "Rotating radius",
                "m",
                "How far the field reaches.",
                float(0.3, 2.0, 1.1),
                true,
            ),
            parameter(
                "order",
                "Order of repulsion",
                "",
                "Exponent.",
                ParamKind::Int { min: 1, max: 4, default: 2 },
                true,
            ),
            parameter(
                "mode",
                "Mode",
                "",
                "As published, or gated near the path.",
                ParamKind::Choice {
                    options: vec!["literal".into(), "gated".into()],
                    default: "gated".into(),
                },
                false,
            ),
            parameter(
                "improved",
                "Improved repulsion",
                "",
                "No trap.",
                ParamKind::Flag { default: true },
                true,
            ),
        ],
    }
}

/// The planners that were found.
pub(crate) fn planners() -> Vec<PlannerInfo> {
    vec![
        planner("apf", "1.2", "Artificial potential field for goals and preset paths"),
        planner("rpf", "1.2", "Rotating potential field along the preset spiral"),
        planner("spiral-tangent", "1.0", "Tangent bug about columns on the spiral"),
    ]
}

/// The first event.
pub(crate) fn opened() -> EventKind {
    let (world, mission) = (world(), config());
    let floor = Floor::new(
        &world.as_drawn(),
        mission.cell_m,
        mission.limits.radius_m,
        mission.swath_m,
        mission.start.position,
    );
    EventKind::RunOpened(Box::new(RunOpened {
        journal_version: JOURNAL_VERSION,
        tankops_version: "0.1.0".into(),
        scenario: "tank-07".into(),
        scenario_toml: String::new(),
        seed: 42,
        world,
        mission,
        floor,
        plates: None,
        wear: None,
        checklist: Vec::new(),
        measured: None,
        vehicle: None,
    }))
}

/// A scripted mission that yields its events tick by tick.
#[derive(Clone)]
pub(crate) struct ScriptedMission {
    path: Vec<Point>,
    grid: CoverageGrid,
    tick: u64,
    at: usize,
    length_m: f64,
    /// Standard deviation of the position, metres.
    pub sigma_m: f64,
}

impl ScriptedMission {
    /// Creates the mission before its first tick.
    pub(crate) fn new() -> Self {
        let EventKind::RunOpened(run) = opened() else { unreachable!("the run opens first") };
        let path = world::polyline::resampled(&spiral(), STEP_M);
        let length_m = world::polyline::length_m(&path);
        Self { path, grid: CoverageGrid::new(run.floor), tick: 0, at: 0, length_m, sigma_m: 0.02 }
    }

    /// Before the first tick, with a path to drive.
    pub(crate) fn along(path: Vec<Point>) -> Self {
        let length_m = world::polyline::length_m(&path);
        Self { path, length_m, ..Self::new() }
    }

    /// An event at the current time.
    pub(crate) fn now(&self, kind: EventKind) -> Event {
        Event { tick: self.tick, t_s: self.tick as f64 * TICK_S, kind }
    }

    /// The events before anything moves.
    pub(crate) fn opening(&self) -> Vec<Event> {
        vec![self.now(opened()), self.now(self.estimated())]
    }

    /// The events in which the plan that the operator sees before the start is made.
    pub(crate) fn planned_ahead(&self) -> Vec<Event> {
        let info = Box::new(planners().remove(1));
        [
            EventKind::Ordered { order: Order::Plan },
            EventKind::PlannerChosen { ask: None, choice: choice("rpf"), info, from: None },
            self.planned(None),
        ]
        .map(|kind| self.now(kind))
        .into()
    }

    /// The events of the start.
    pub(crate) fn start(&self) -> Vec<Event> {
        let info = Box::new(planners().remove(1));
        [
            EventKind::Ordered { order: Order::Start },
            EventKind::PlannerChosen { ask: None, choice: choice("rpf"), info, from: None },
            self.planned(None),
        ]
        .map(|kind| self.now(kind))
        .into()
    }

    /// The plan, in answer to an ask.
    pub(crate) fn planned(&self, ask: Option<AskId>) -> EventKind {
        EventKind::Planned {
            ask,
            return_path: 0,
            planner: "rpf".into(),
            reason: Reason::Start,
            path: self.path.clone(),
            length_m: self.length_m,
            complete: true,
            legs: vec![],
            cuts: vec![],
        }
    }

    /// The events of some ticks under way.
    pub(crate) fn drive(&mut self, ticks: usize) -> Vec<Event> {
        (0..ticks).flat_map(|_| self.tick()).collect()
    }

    /// The events of some ticks standing still.
    pub(crate) fn wait(&mut self, ticks: usize) -> Vec<Event> {
        (0..ticks)
            .map(|_| {
                self.tick += 1;
                self.now(self.estimated())
            })
            .collect()
    }

    fn tick(&mut self) -> Vec<Event> {
        let before = self.path[self.at];
        self.tick += 1;
        self.at = (self.at + 1).min(self.path.len() - 2);
        let (here, next) = (self.path[self.at], self.path[self.at + 1]);
        let way = next - here;
        let mut kinds = vec![self.estimated()];
        if self.tick.is_multiple_of(2) {
            kinds.extend([EventKind::Ranged { ranges: self.ranges() }, EventKind::Fixed { fix: self.fix() }]);
        }
        kinds.push(EventKind::Covered { runs: self.grid.mark_swath(before, here, 0.6) });
        kinds.push(EventKind::Progressed {
            done: self.at as f64 / self.path.len() as f64,
            along_m: Some(self.at as f64 * STEP_M),
            cross_track_m: Some(0.03),
            target: self.path[(self.at + 6).min(self.path.len() - 1)],
            covered_reachable: self.grid.fraction_reachable(),
            covered_whole: self.grid.fraction_whole(),
            leg: None,
        });
        let arrow = |layer, vector| Drawing::Arrow { layer, at: here, vector };
        let side = Vector::new(-way.y, way.x);
        kinds.push(EventKind::Drawn {
            drawings: vec![
                arrow(Layer::Attraction, way * 15.0),
                arrow(Layer::Repulsion, side * 10.0),
                arrow(Layer::Resultant, (way * 15.0) + (side * 10.0)),
            ],
        });
        kinds.push(EventKind::Scalars { scalars: vec![("field".into(), 1.25, "m/s".into())] });
        kinds.push(EventKind::Commanded { ask: None, command: Command::twist(0.2, 0.021), asked: None });
        kinds.into_iter().map(|kind| self.now(kind)).collect()
    }

    fn estimated(&self) -> EventKind {
        let (here, next) = (self.path[self.at], self.path[self.at + 1]);
        let way = next - here;
        // The error rises and falls, so that its history has a shape.
        let breath = 1.0 + 0.4 * (self.tick as f64 * 0.09).sin();
        let sigma_m = self.sigma_m * breath;
        let covariance =
            Matrix3::from_diagonal(&nalgebra::Vector3::new(sigma_m * sigma_m, sigma_m * sigma_m, 1e-4));
        EventKind::Estimated {
            pose: PoseEstimate { position: here, heading_rad: way.y.atan2(way.x), covariance },
        }
    }

    fn ranges(&self) -> Vec<Ranging> {
        let here = self.path[self.at];
        let ranging = |station: &Station| Ranging {
            station: station.id,
            range_m: (station.position - here).norm(),
            sigma_m: 0.05,
            repetitions: 5,
            least_m: (station.position - here).norm(),
            most_m: (station.position - here).norm(),
            timing_sigma_m: 0.0,
        };
        world().stations.iter().map(ranging).collect()
    }

    fn fix(&self) -> Fix {
        let used: Vec<StationId> = (1..4).map(StationId).collect();
        let residuals_m = [0.012, -0.031, 0.024];
        let residuals = used.iter().zip(residuals_m);
        Fix {
            position: self.path[self.at],
            covariance: Matrix2::from_diagonal_element(4e-4),
            residuals: residuals
                .map(|(station, residual_m)| Residual { station: *station, residual_m, sigma_m: 0.05 })
                .collect(),
            used,
            excluded: vec![(StationId(4), Exclusion::Residual { residual_m: 0.42, gate_m: 0.15 })],
            chi2: 0.9,
            degrees_of_freedom: 1,
            gdop: 1.1,
            conditioning: 2.0,
            mirror: None,
            protection_level_m: None,
            integrity: Integrity::Ok,
        }
    }

    /// Station 4 is rejected.
    pub(crate) fn excluded(&self) -> Event {
        let reason = Exclusion::Residual { residual_m: 0.42, gate_m: 0.15 };
        self.now(EventKind::StationRejected { station: StationId(4), reason })
    }

    /// A hold that only an order ends.
    pub(crate) fn held(&self, by: HoldReason) -> Event {
        self.held_until(by, Resumes::Never)
    }

    /// A hold.
    pub(crate) fn held_until(&self, by: HoldReason, resumes: Resumes) -> Event {
        self.now(EventKind::Held { by, resumes })
    }

    /// The operator's order, and what follows from it.
    pub(crate) fn obeyed(&self, order: Order) -> Vec<Event> {
        let after = match order {
            Order::Hold => Some(EventKind::Held { by: HoldReason::Operator, resumes: Resumes::Never }),
            Order::Resume | Order::Step | Order::StepTo(_) | Order::DriveBack | Order::FlyUncertified => {
                Some(EventKind::Resumed)
            }
            _ => None,
        };
        std::iter::once(EventKind::Ordered { order }).chain(after).map(|kind| self.now(kind)).collect()
    }

    /// The planner fails and the robot is held.
    pub(crate) fn planner_fails(&self) -> Vec<Event> {
        self.fails(During::Step, Cause::Panic, "planner rpf panicked during step")
    }

    /// The planner refuses new values of its live parameters and drives on.
    pub(crate) fn change_refused(&self) -> Event {
        let message = "planner rpf refused the changed parameters: too late; its old values stay in effect";
        self.fails(During::Reconfigure, Cause::Planner(planner_api::Code::Unsupported), message).remove(0)
    }

    /// The planner finds no plan and the robot is held.
    pub(crate) fn planning_fails(&self) -> Vec<Event> {
        let cause = Cause::Planner(planner_api::Code::NoPath);
        self.fails(During::Plan, cause, "planner rpf has no plan: no way")
    }

    /// A no-go zone is drawn.
    pub(crate) fn zone_drawn(&self) -> Event {
        let vertices = [(1.0, 1.0), (2.0, 1.0), (2.0, 2.0)].map(|(x, y)| Point::new(x, y)).to_vec();
        let shape = Shape::Polygon { vertices };
        let zone = world::Zone { name: "no-go 1".into(), kind: world::ZoneKind::NoGo, shape };
        self.now(EventKind::ZoneDrawn { zone })
    }

    fn fails(&self, during: During, cause: Cause, message: &str) -> Vec<Event> {
        let message = message.to_owned();
        let fault = Fault {
            planner: "rpf".into(),
            during,
            cause,
            message: message.clone(),
            partial: Vec::new(),
            plugin_sha256: None,
        };
        vec![
            self.now(EventKind::PlannerFailed { ask: None, fault }),
            self.held(HoldReason::PlannerFault { message }),
        ]
    }

    /// How the cable lies between an anchor at the eastern shell and the robot.
    pub(crate) fn cable(&self) -> Event {
        let (world, config) = (world().as_drawn(), tether());
        let shapes: Vec<Shape> = world.obstacles.iter().map(|o| o.shape.clone()).collect();
        let mut cable = Cable::new(config.anchor, &world.boundary, &shapes).expect("an anchor on the floor");
        cable.drag_along(&[Point::new(4.0, 6.0), Point::new(-4.0, 6.0), self.path[self.at]]);
        let name = |on| match on {
            Bearing::Obstacle(index) => world.obstacles[index].name.clone(),
            Bearing::Wall => "wall".into(),
        };
        let contacts = cable.contacts();
        let contact = |c: &Contact| TetherContact { on: name(c.on), wrap_rad: c.wrap_rad, at: c.last };
        self.now(EventKind::Tethered {
            length_m: cable.length_m(),
            paid_out_m: None,
            free_m: config.limits.reel_length_m - cable.length_m(),
            contacts: contacts.iter().map(contact).collect(),
            wrap_max_rad: cable.wrap_max_rad(),
            wrap_total_rad: cable.wrap_total_rad(),
            pull_factor: capstan_factor(config.friction, cable.wrap_total_rad()),
            pull_n: config.reel.map(|reel| cable.pull_at_anchor_n(reel.drag(config.friction))),
            measured: None,
            return_length_m: Some(cable.length_m() + 0.4),
            bends: cable.taut_line().split_last().map_or(vec![], |(_, line)| line[1..].to_vec()),
        })
    }

    /// The reel has paid out more than the map explains, and the robot is held.
    pub(crate) fn caught(&mut self) -> Vec<Event> {
        let alarm = TetherAlarm::Snag { paid_out_m: 14.2, explained_m: 12.6, or_slack: false };
        let message = alarm.to_string();
        let mut cable = self.cable();
        if let EventKind::Tethered { paid_out_m, free_m, .. } = &mut cable.kind {
            (*paid_out_m, *free_m) = (Some(14.2), tether().limits.reel_length_m - 14.2);
        }
        let alarmed = self.now(EventKind::TetherAlarmRaised { alarm, reached: true });
        vec![cable, alarmed, self.held(HoldReason::Tether { message })]
    }

    /// The certificate of a plan.
    pub(crate) fn certified(&self, reasons: &[&str]) -> Event {
        let certificate = Certificate {
            certified: reasons.is_empty(),
            reasons: reasons.iter().map(|reason| (*reason).to_owned()).collect(),
            ..Certificate::refused(String::new())
        };
        self.now(EventKind::Certified { planner: "rpf".into(), refused: !reasons.is_empty(), certificate })
    }

    /// A plan cannot be certified and the robot is held.
    pub(crate) fn plan_refused(&self) -> Vec<Event> {
        let reason = "31.4 m of tether still out on return, hooked around C3";
        let message = format!("plan of rpf is not safe for the tether: {reason}");
        vec![self.certified(&[reason]), self.held(HoldReason::PlanRefused { message })]
    }

    /// The end.
    pub(crate) fn ended(&self, outcome: Outcome, reason: &str) -> Event {
        self.now(EventKind::Ended { outcome, reason: reason.into() })
    }
}

/// A screen that shows a scripted mission.
#[derive(Clone)]
pub(crate) struct Screen {
    /// The model of the screen.
    pub model: Model,
    /// The mission that it shows.
    pub mission: ScriptedMission,
    mono_s: f64,
}

impl Screen {
    /// A run that is open and waits, with its plan.
    pub(crate) fn idle() -> Self {
        static MADE: OnceLock<Screen> = OnceLock::new();
        MADE.get_or_init(Self::make_idle).clone()
    }

    fn make_idle() -> Self {
        let mut screen = Self::opened();
        let events = screen.mission.planned_ahead();
        screen.hear(RunMsg::Events(events));
        screen
    }

    /// A run that is open and has no plan yet.
    pub(crate) fn opened() -> Self {
        let mut model = Model::opened(RunId(1), Source::Demo, Speed::default());
        model.ui.go(tui::model::Screen::Mission);
        let mut screen = Self { model, mission: ScriptedMission::new(), mono_s: 0.0 };
        screen.send(Msg::Time(Times { mono_s: 0.0, wall_unix_s: 1_795_264_000.0 }));
        screen.hear(RunMsg::Health(Health {
            recording: Recording::On,
            reached_speed: None,
            ..Health::default()
        }));
        let refused = mission::RefusedPlugin {
            plugin: "my_plugin.so".into(),
            reason: "built for planner ABI 3, this console uses ABI 1; rebuild it".into(),
        };
        screen.send(Msg::Planners { found: planners(), refused: vec![refused] });
        let events = screen.mission.opening();
        screen.hear(RunMsg::Events(events));
        screen
    }

    /// A run two thirds done.
    pub(crate) fn running() -> Self {
        static MADE: OnceLock<Screen> = OnceLock::new();
        MADE.get_or_init(Self::make_running).clone()
    }

    fn make_running() -> Self {
        let mut screen = Self::idle();
        let mut events = screen.mission.start();
        events.extend(screen.mission.drive(1200));
        let found = EventKind::ObstacleFound { obstacle: found() };
        events.push(screen.mission.now(found));
        events.extend(screen.mission.drive(700));
        events.push(screen.mission.excluded());
        events.extend(screen.mission.drive(35));
        screen.hear(RunMsg::Events(events));
        screen
    }

    /// The same on a tether.
    pub(crate) fn tethered() -> Self {
        let mut screen = Self::running();
        if let Some(run) = &mut screen.model.live.run.about {
            run.mission.tether = Some(tether());
        }
        let events = vec![screen.mission.certified(&[]), screen.mission.cable()];
        screen.hear(RunMsg::Events(events));
        screen
    }

    /// The same with the plates of the floor known.
    pub(crate) fn plated() -> Self {
        let mut screen = Self::running();
        let sizes = world::RegularPlates { annular_m: 0.75, n_annular: 12, length_m: 4.0, width_m: 1.6 };
        let plates = world::PlateLayout::Regular(sizes);
        if let Some(run) = &mut screen.model.live.run.about {
            run.plates = Some(plates);
        }
        screen
    }

    /// The same, held by the operator.
    pub(crate) fn held() -> Self {
        let mut screen = Self::running();
        let events = screen.mission.obeyed(Order::Hold);
        screen.hear(RunMsg::Events(events));
        screen
    }

    /// Sends a message to the model. The mission records the operator's actions on alarms in the same tick.
    pub(crate) fn send(&mut self, msg: Msg) -> Vec<tui::Effect> {
        let effects = update(&mut self.model, msg);
        self.write_notes(&effects);
        effects
    }

    /// Carries out an action without its key.
    pub(crate) fn act(&mut self, id: tui::actions::ActionId) -> Vec<tui::Effect> {
        let effects = update::act(&mut self.model, id);
        self.write_notes(&effects);
        effects
    }

    fn write_notes(&mut self, effects: &[tui::Effect]) {
        for effect in effects {
            if let tui::Effect::Order(order @ Order::Note(_)) = effect {
                let written = self.mission.now(EventKind::Ordered { order: order.clone() });
                update(&mut self.model, of_run(RunMsg::Events(vec![written])));
            }
        }
    }

    /// Sends a message about the open run to the model.
    pub(crate) fn hear(&mut self, msg: RunMsg) -> Vec<tui::Effect> {
        self.send(of_run(msg))
    }

    /// Agrees to the start, with everything outside the screen in order.
    pub(crate) fn start(&mut self) -> Vec<tui::Effect> {
        self.press([tui::Key::Char('S'), tui::Key::Enter]);
        self.hear(RunMsg::Checked(Vec::new()))
    }

    /// Presses keys, one after the other.
    pub(crate) fn press(&mut self, keys: impl IntoIterator<Item = tui::Key>) -> Vec<tui::Effect> {
        keys.into_iter().flat_map(|key| self.send(Msg::Key(key.into()))).collect()
    }

    /// Types characters.
    pub(crate) fn type_text(&mut self, text: &str) -> Vec<tui::Effect> {
        self.press(text.chars().map(tui::Key::Char))
    }

    /// Lets time pass on the console's own clock.
    pub(crate) fn pass(&mut self, seconds: f64) -> Vec<tui::Effect> {
        self.mono_s += seconds;
        self.send(Msg::Time(Times { mono_s: self.mono_s, wall_unix_s: 1_795_264_000.0 + self.mono_s }))
    }
}

/// A message about the run that is open in every fixture.
pub(crate) fn of_run(msg: RunMsg) -> Msg {
    Msg::Run(RunId(1), msg)
}

/// A terminal with everything.
pub(crate) const RICH: Caps = Caps { colours: Colours::True, glyphs: Glyphs::Braille, ssh: false };
/// A terminal without colours.
pub(crate) const PLAIN: Caps = Caps { colours: Colours::None, glyphs: Glyphs::Braille, ssh: false };
/// A terminal with letters only.
pub(crate) const ASCII: Caps = Caps { colours: Colours::None, glyphs: Glyphs::Ascii, ssh: false };

/// A scenario of the home screen.
pub(crate) fn listed(name: &str, problem: Option<&str>) -> tui::model::ScenarioEntry {
    tui::model::ScenarioEntry {
        source: Source::File(format!("{name}.toml")),
        name: name.into(),
        about: String::new(),
        task: "goto".into(),
        tank: "Ø12 m".into(),
        planner: "apf".into(),
        expected: String::new(),
        problem: problem.map(str::to_owned),
        world: None,
        mission: None,
    }
}
