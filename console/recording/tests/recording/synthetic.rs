//! A made-up run with all kinds of events, for the tests, the benchmark and the picture.
//!
//! The robot follows a spiral in a round tank, with a wandering estimate, ranges, a fix every second, forces of a
//! potential field, an obstacle to discover, a station that falls silent, a hold, a second planner and an end.

use mission::{
    AskId, Cause, During, Event, EventKind, Fault, HoldReason, MissionConfig, Order, Outcome, ParamInfo,
    ParamKind, ParamValue, Parameters, PlannerChoice, PlannerInfo, Resumes, ScanConfig, TaskConfig, WorkerId,
    event::{JOURNAL_VERSION, RunOpened},
};
use nalgebra::{Matrix2, Matrix3};
use planner_api::{Command, Drawing, Layer, Limits, LogLevel, Motion, PoseEstimate, Reason};
use positioning::{Exclusion, Fix, Integrity, Ranging, Residual};
use std::f64::consts::TAU;
use world::{
    Boundary, CoverageGrid, Floor, Obstacle, ObstacleId, Point, Pose, Shape, Station, StationId, Vector,
    World, Zone, ZoneKind,
};

const RADIUS_M: f64 = 8.0;
const TICK_S: f64 = 0.1;
const SPEED_M_PER_S: f64 = 0.4;
const PITCH_M: f64 = 0.9;

/// A run with this number of ticks, one batch for each tick: `RunOpened` is in the first batch, `Ended` in the last.
pub(crate) fn run(ticks: u64) -> Vec<Vec<Event>> {
    let mut robot = Robot::new();
    (0..ticks).map(|tick| robot.tick(tick, ticks)).collect()
}

struct Robot {
    opened: RunOpened,
    grid: CoverageGrid,
    chance: u64,
    drift: Vector,
    before: Point,
}

impl Robot {
    fn new() -> Self {
        let opened = opened();
        let before = opened.mission.start.position;
        Self {
            grid: CoverageGrid::new(opened.floor.clone()),
            chance: 0x2545_F491_4F6C_DD1D,
            drift: Vector::zeros(),
            before,
            opened,
        }
    }

    /// A random number, uniform from -1 to 1.
    fn noise(&mut self) -> f64 {
        self.chance ^= self.chance << 13;
        self.chance ^= self.chance >> 7;
        self.chance ^= self.chance << 17;
        (self.chance >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn tick(&mut self, tick: u64, ticks: u64) -> Vec<Event> {
        let mut kinds = if tick == 0 { self.opening() } else { Vec::new() };
        let held = (ticks / 2..ticks / 2 + 20).contains(&tick);
        let driven = if tick < ticks / 2 { tick } else { (tick - 20).max(ticks / 2) };
        let truth = spiral_pose(driven as f64 * TICK_S * SPEED_M_PER_S);
        let clearance_m = self.clearance_m(truth.position);
        kinds.push(EventKind::Truth { pose: truth, clearance_m, collided: false });
        let estimate = self.estimate(tick, &truth, &mut kinds);
        Self::happenings(tick, ticks, &mut kinds);
        if !held {
            self.drive(tick, driven, &truth, &estimate, &mut kinds);
        }
        self.before = truth.position;
        if tick + 1 == ticks {
            let reason = "the last preset point is reached".into();
            kinds.push(EventKind::Ended { outcome: Outcome::Complete, reason });
        }
        kinds.into_iter().map(|kind| Event { tick, t_s: tick as f64 * TICK_S, kind }).collect()
    }

    fn opening(&mut self) -> Vec<EventKind> {
        vec![
            EventKind::RunOpened(Box::new(self.opened.clone())),
            chosen("rpf", None),
            EventKind::Ordered { order: Order::Start },
        ]
    }

    fn clearance_m(&self, point: Point) -> f64 {
        let world = &self.opened.world;
        let nearest = world.obstacles.iter().map(|obstacle| obstacle.shape.distance_m(point));
        nearest.fold(world.boundary.wall_distance_m(point), f64::min) - self.opened.mission.limits.radius_m
    }

    fn estimate(&mut self, tick: u64, truth: &Pose, kinds: &mut Vec<EventKind>) -> PoseEstimate {
        let step = Vector::new(self.noise(), self.noise()) * 0.008;
        self.drift += step;
        let age = (tick % 10) as f64;
        if tick.is_multiple_of(10) {
            self.drift *= 0.6;
            let (ranges, fix) = self.fix(tick, truth);
            kinds.extend([EventKind::Ranged { ranges }, EventKind::Fixed { fix }]);
        }
        let (a, b) = (0.05 + 0.004 * age, 0.025 + 0.002 * age);
        let covariance = Matrix3::new(a * a, 0.4 * a * b, 0.0, 0.4 * a * b, b * b, 0.0, 0.0, 0.0, 1e-4);
        let position = truth.position + self.drift;
        let pose =
            PoseEstimate { position, heading_rad: truth.heading_rad + 0.01 * self.noise(), covariance };
        kinds.push(EventKind::Estimated { pose });
        pose
    }

    fn fix(&mut self, tick: u64, truth: &Pose) -> (Vec<Ranging>, Fix) {
        let stations = self.opened.world.stations.clone();
        let ranging = |station: &Station, error_m| Ranging {
            station: station.id,
            range_m: (truth.position - station.position).norm() + error_m,
            sigma_m: 0.05,
            repetitions: 5,
            least_m: (truth.position - station.position).norm() + error_m,
            most_m: (truth.position - station.position).norm() + error_m,
            timing_sigma_m: 0.0,
        };
        let ranges: Vec<_> = stations.iter().map(|station| ranging(station, 0.05 * self.noise())).collect();
        let bad = (tick / 100) % 4 == 3;
        let (excluded, used): (Vec<_>, Vec<_>) =
            ranges.iter().map(|range| range.station).partition(|id| bad && id.0 == 2);
        let fix = Fix {
            position: truth.position + Vector::new(self.noise(), self.noise()) * 0.04,
            covariance: Matrix2::new(0.002, 0.0, 0.0, 0.001),
            residuals: used
                .iter()
                .map(|station| Residual { station: *station, residual_m: 0.01, sigma_m: 0.05 })
                .collect(),
            excluded: excluded
                .into_iter()
                .map(|station| (station, Exclusion::Residual { residual_m: 0.61, gate_m: 0.2 }))
                .collect(),
            degrees_of_freedom: used.len() as u32 - 2,
            used,
            chi2: 2.1,
            gdop: 1.2,
            conditioning: 1.4,
            mirror: None,
            protection_level_m: Some(0.3),
            integrity: Integrity::Ok,
        };
        (ranges, fix)
    }

    fn happenings(tick: u64, ticks: u64, kinds: &mut Vec<EventKind>) {
        let part = |share: u64| tick == ticks * share / 20;
        if part(2) {
            kinds.push(EventKind::ObstacleFound { obstacle: found(0.12) });
        }
        if part(3) {
            let id = ObstacleId(100);
            kinds.push(EventKind::ObstacleMoved { id, obstacle: found(0.03) });
        }
        if part(6) {
            let reason = Exclusion::Residual { residual_m: 0.61, gate_m: 0.2 };
            kinds.push(EventKind::StationRejected { station: StationId(2), reason });
        }
        if part(7) {
            kinds.push(EventKind::StationRestored { station: StationId(2) });
        }
        if part(8) {
            kinds.push(EventKind::PositionLost { error_m: 0.52, limit_m: 0.4 });
        }
        if part(9) {
            kinds.push(EventKind::PositionRegained { error_m: 0.21 });
        }
        if part(10) {
            kinds.push(EventKind::PlannerFailed { ask: Some(ask(tick)), fault: fault() });
            kinds.push(EventKind::Held { by: HoldReason::Operator, resumes: Resumes::Never });
        }
        if tick == ticks / 2 + 19 {
            kinds.push(chosen("apf", Some("rpf".into())));
            kinds.push(EventKind::Resumed);
        }
        if part(14) {
            let message = "target stands in an obstacle, skipped".into();
            kinds.push(EventKind::PlannerLogged { planner: "apf".into(), level: LogLevel::Warn, message });
        }
    }

    fn drive(
        &mut self,
        tick: u64,
        driven: u64,
        truth: &Pose,
        estimate: &PoseEstimate,
        kinds: &mut Vec<EventKind>,
    ) {
        let along_m = driven as f64 * TICK_S * SPEED_M_PER_S;
        let target = spiral_pose((along_m / 0.5).floor() * 0.5 + 1.0).position;
        if tick.is_multiple_of(300) {
            let path: Vec<_> = (0..60).map(|k| spiral_pose(along_m + 0.2 * f64::from(k)).position).collect();
            let length_m = world::polyline::length_m(&path);
            let planner = if driven == tick { "rpf".into() } else { "apf".into() };
            kinds.push(EventKind::Planned {
                ask: Some(ask(tick)),
                return_path: 0,
                planner,
                reason: Reason::Start,
                path,
                length_m,
                complete: true,
                legs: vec![],
                cuts: vec![],
            });
        }
        kinds.push(EventKind::Drawn { drawings: self.forces(estimate.position, target) });
        let pull = (target - estimate.position).norm();
        kinds.push(EventKind::Scalars { scalars: vec![("potential".into(), 0.5 * pull * pull, "J".into())] });
        let command = Command::velocity(truth.direction() * SPEED_M_PER_S);
        kinds.push(EventKind::Commanded { ask: Some(ask(tick)), command, asked: None });
        let runs =
            self.grid.mark_swath(self.before + self.drift, estimate.position, self.opened.mission.swath_m);
        if !runs.is_empty() {
            kinds.push(EventKind::Covered { runs });
        }
        kinds.push(EventKind::Progressed {
            done: self.grid.fraction_reachable(),
            along_m: Some(along_m),
            cross_track_m: Some(self.drift.norm()),
            target,
            covered_reachable: self.grid.fraction_reachable(),
            covered_whole: self.grid.fraction_whole(),
            leg: None,
        });
    }

    fn forces(&self, at: Point, target: Point) -> Vec<Drawing> {
        let pull = (target - at) * 0.8;
        let push: Vector = self
            .opened
            .world
            .obstacles
            .iter()
            .map(|obstacle| {
                let away = at - obstacle.shape.center();
                let distance_m = obstacle.shape.distance_m(at).max(0.05);
                if distance_m < 2.0 {
                    away.normalize() * (0.3 / (distance_m * distance_m))
                } else {
                    Vector::zeros()
                }
            })
            .sum();
        let arrow = |layer, vector| Drawing::Arrow { layer, at, vector };
        let mut drawings = vec![arrow(Layer::Attraction, pull)];
        if push.norm() > 0.0 {
            drawings.push(arrow(Layer::Repulsion, push));
            drawings.push(Drawing::Circle { layer: Layer::Virtual, center: target, radius_m: 0.3 });
            drawings.push(Drawing::Line { layer: Layer::Path, from: at, to: target });
        }
        drawings.push(arrow(Layer::Resultant, pull + push));
        drawings
    }
}

/// The pose on the way inwards along the spiral, at this distance from its start.
fn spiral_pose(along_m: f64) -> Pose {
    let outer_m = RADIUS_M - 0.7;
    // The inverse of the length of the spiral up to an angle, whose element is 2 pi r dr / pitch.
    let radius_m = (outer_m * outer_m - along_m * PITCH_M / std::f64::consts::PI).max(0.04).sqrt();
    let angle = TAU * (outer_m - radius_m) / PITCH_M;
    Pose::new(radius_m * angle.cos(), radius_m * angle.sin(), angle + TAU / 4.0)
}

fn found(error_m: f64) -> Obstacle {
    let center = Point::new(4.6 + error_m, 4.2 - error_m);
    let shape = Shape::Disc { center, radius_m: 0.3 };
    Obstacle { id: ObstacleId(100), name: "found 1".into(), shape, known: false }
}

fn fault() -> Fault {
    Fault {
        planner: "rpf".into(),
        during: During::Step,
        cause: Cause::Hung,
        message: "planner rpf did not answer in step; its process was ended".into(),
        partial: Vec::new(),
        plugin_sha256: None,
    }
}

fn chosen(id: &str, from: Option<String>) -> EventKind {
    let parameter = ParamInfo {
        key: "k_rep".into(),
        label: "Repulsion gain".into(),
        unit: "m3/s".into(),
        help: "How strongly obstacles push".into(),
        group: "Field".into(),
        kind: ParamKind::Float { min: 0.0, max: 10.0, default: 0.4 },
        live: true,
    };
    let info = PlannerInfo {
        id: id.into(),
        name: format!("{} of the test", id.to_uppercase()),
        version: "0.1.0".into(),
        about: "A planner that was made up for a test.".into(),
        plugin: "libtest.so".into(),
        sha256: "9f2c1a".repeat(10),
        abi: "1.0".into(),
        covers: false,
        snapshots: false,
        sandbox: None,
        parameters: vec![parameter],
    };
    let parameters = [("k_rep".to_owned(), ParamValue::Float(0.6))].into();
    EventKind::PlannerChosen {
        ask: Some(ask(0)),
        choice: PlannerChoice { id: id.into(), parameters },
        info: Box::new(info),
        from,
    }
}

/// The id of the ask in a tick.
fn ask(tick: u64) -> AskId {
    AskId { worker: WorkerId(1), n: tick as u32 + 1 }
}

pub(crate) fn opened() -> RunOpened {
    let world = tank();
    let preset: Vec<_> = (0..400).map(|k| spiral_pose(f64::from(k) * 0.4).position).collect();
    let start = spiral_pose(0.0);
    let limits = Limits {
        motion: Motion::Unicycle,
        v_max_m_per_s: 0.5,
        w_max_rad_per_s: 1.0,
        radius_m: 0.25,
        sensing_range_m: 2.0,
        acceleration_m_per_s2: 0.5,
        tick_s: 0.1,
        amphibious: None,
    };
    RunOpened {
        journal_version: JOURNAL_VERSION,
        tankops_version: "0.1.0".into(),
        scenario: "synthetic".into(),
        plates: None,
        wear: None,
        checklist: Vec::new(),
        measured: None,
        vehicle: None,
        scenario_toml: "[tank]\nradius_m = 8.0\n".into(),
        seed: 42,
        floor: Floor::new(&world, 0.1, limits.radius_m, 0.6, start.position),
        world,
        mission: MissionConfig {
            task: TaskConfig::Follow { path: preset, tolerance_m: 0.2 },
            start,
            start_sigma_m: 0.02,
            tick_s: TICK_S,
            time_limit_s: 3600.0,
            limits,
            swath_m: 0.6,
            scan: ScanConfig::default(),
            clearance_m: 0.1,
            cell_m: 0.1,
            position_limit_m: 0.4,
            position_lost_hold_s: 5.0,
            stuck_s: 60.0,
            start_heading_sigma_rad: 0.01,
            odometry_sigma_per_m: 0.02,
            odometry_turn_sigma_per_rad: 0.02,
            gyro_sigma_rad_per_s: 0.001,
            range_sigma_ratio: 0.01,
            locating: mission::Locating::default(),
            planner: PlannerChoice { id: "rpf".into(), parameters: Parameters::new() },
            pressure: None,
            tether: None,
            fallback: None,
            attended: false,
            start_names_plan: false,
            guard_reaction_s: None,
            sensor: None,
            live: false,
            better_plan: mission::BetterPlan::Off,
            instrument: None,
        },
    }
}

fn tank() -> World {
    let disc = |id, name: &str, x, y, radius_m, known| Obstacle {
        id: ObstacleId(id),
        name: name.into(),
        shape: Shape::Disc { center: Point::new(x, y), radius_m },
        known,
    };
    let sump = [(-4.4, 1.0), (-3.4, 1.0), (-3.4, 1.8), (-4.4, 1.8)].map(|(x, y)| Point::new(x, y)).to_vec();
    let pipe = [(1.0, -4.6), (3.0, -4.6), (3.0, -3.6)].map(|(x, y)| Point::new(x, y)).to_vec();
    let obstacle =
        |id, name: &str, shape| Obstacle { id: ObstacleId(id), name: name.into(), shape, known: true };
    World {
        boundary: Boundary::Circle { radius_m: RADIUS_M },
        obstacles: vec![
            disc(1, "column A", -1.0, 3.9, 0.35, true),
            obstacle(2, "sump", Shape::Polygon { vertices: sump }),
            obstacle(3, "pipe", Shape::Polyline { points: pipe, half_width_m: 0.1 }),
            disc(4, "debris", 4.6, 4.2, 0.3, false),
        ],
        stations: (0..4)
            .map(|k| Station {
                id: StationId(k),
                name: format!("AE{k}"),
                position: Point::from(
                    Vector::new((f64::from(k) * TAU / 4.0).cos(), (f64::from(k) * TAU / 4.0).sin())
                        * RADIUS_M,
                ),
            })
            .collect(),
        zones: vec![Zone {
            name: "wet".into(),
            kind: ZoneKind::Underwater,
            shape: Shape::Disc { center: Point::new(2.0, 0.5), radius_m: 1.5 },
        }],
    }
}
