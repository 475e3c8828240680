//! The simulator behind the wire protocol: it receives and sends messages. It has no clock; its caller passes the time.

use geometry::{Drive, Vector};
use mission::MissionConfig;
use planner_api::Motion;
use scenario::Scenario;
use sim::{RobotConfig, SimConfig, Simulator};
use vehicle::wire::{
    PROTOCOL,
    message::{
        self, Ae, Commander, FromVehicle, Has, Hello, Limits, Mode, MotionKind, Odometry, Outline, Pong,
        PulseLengths, State, StationRanges, Tether, ToVehicle,
    },
};
use world::{Point, Readings, Scan, Scanner, Shape, Sighting, Station};

/// The longest range that the protocol allows, metres. Noise can make a simulated range impossible.
const RANGE_MAX_M: f64 = 1000.0;

/// A simulated vehicle that speaks the protocol. Its time passes with [`Behind::step`].
pub struct Behind {
    simulator: Simulator,
    stations: Vec<Station>,
    hello: Hello,
    /// The last commanded motion, and the time at which its lease lapses, seconds of the caller's clock.
    driven: Option<(message::Drive, f64)>,
    /// Number of the last command.
    last_seq: Option<u64>,
    /// Minimum time from the stamp of a command to its arrival: the offset of the console's clock plus the shortest
    /// delay.
    least_s: f64,
    /// Number of the last readings.
    seq: u64,
    /// The dead-reckoned pose in the vehicle's own frame; `None` for a vehicle that sends odometry alone.
    reckoned: Option<message::Pose>,
    tick_s: f64,
    /// The scanner, which reports obstacles instead of their outlines.
    scanner: Option<Scanner>,
}

/// Increase of the least delay per command, seconds, so that it follows clocks that drift.
const DRIFT_S: f64 = 1e-4;

impl Behind {
    /// Creates a vehicle at rest at the start of a scenario. It sends odometry alone: a mission that loses no message
    /// then makes the same decisions as with the simulator inside the console.
    pub fn new(scenario: &Scenario) -> Self {
        let world = &scenario.sim.world;
        Self {
            simulator: Simulator::new(scenario.sim.clone(), scenario.seed),
            stations: world.stations.clone(),
            hello: hello(scenario),
            driven: None,
            last_seq: None,
            least_s: f64::INFINITY,
            seq: 0,
            reckoned: None,
            tick_s: scenario.mission.tick_s,
            scanner: scenario.sim.robot.scanner,
        }
    }

    /// A vehicle with a scanner instead of outlines of obstacles: an object that is not on the drawing then appears only
    /// in the scan. The scanner is that of the scenario or, without one, an exact scanner of 360 rays.
    pub fn with_scanner(scenario: &Scenario) -> Self {
        let scanner = scenario.sim.robot.scanner.unwrap_or(Scanner::default().exact());
        let robot = RobotConfig { scanner: Some(scanner), ..scenario.sim.robot.clone() };
        Self::new(&Scenario { sim: SimConfig { robot, ..scenario.sim.clone() }, ..scenario.clone() })
    }

    /// The true state of the simulated robot.
    pub fn truth(&self) -> world::Truth {
        self.simulator.truth()
    }

    /// The same vehicle, which also sends its dead-reckoned pose, so that a lost message does not lose motion.
    #[must_use]
    pub fn with_pose(mut self) -> Self {
        self.hello.has.pose = true;
        self.reckoned = Some(message::Pose { x_m: 0.0, y_m: 0.0, heading_rad: 0.0 });
        self
    }

    /// The same vehicle; its introduction distinguishes this start from other starts.
    #[must_use]
    pub fn with_session(mut self, session: u64) -> Self {
        self.hello.session = Some(session);
        self
    }

    /// The introduction of the vehicle.
    pub fn hello(&self) -> FromVehicle {
        FromVehicle::Hello(Box::new(self.hello.clone()))
    }

    /// The state of the vehicle, for its commander or for another console.
    pub fn state(&self, now_s: f64, commander: Commander) -> FromVehicle {
        FromVehicle::State(State { stamp_s: now_s, mode: Mode::Ready, text: None, battery: None, commander })
    }

    /// Length of a tick, seconds.
    pub fn tick_s(&self) -> f64 {
        self.tick_s
    }

    /// Forgets the commander; the vehicle stands still.
    pub fn leave(&mut self) {
        (self.driven, self.last_seq, self.least_s) = (None, None, f64::INFINITY);
    }

    /// Stands still until the next command.
    pub fn halt(&mut self) {
        self.driven = None;
    }

    /// Processes a message; returns the answer to it, if there is one.
    pub fn take(&mut self, message: &ToVehicle, now_s: f64) -> Option<FromVehicle> {
        match message {
            ToVehicle::Drive(drive) if self.is_new(drive.seq) => {
                let age_s = self.age_s(drive.stamp_s, now_s);
                // Rule 2 of the protocol: a command that waited while this process was stopped is ignored.
                if age_s > drive.lease_s {
                    return None;
                }
                self.driven = Some((*drive, now_s + drive.lease_s.min(self.hello.lease_max_s)));
            }
            ToVehicle::Stop(stop) if self.is_new(stop.seq) => {
                self.age_s(stop.stamp_s, now_s);
                self.driven = None;
            }
            ToVehicle::Drive(_) | ToVehicle::Stop(_) => {}
            ToVehicle::Ping(ping) => {
                return Some(FromVehicle::Pong(Pong { echo_s: ping.stamp_s, stamp_s: now_s }));
            }
            ToVehicle::Bye(_) => self.leave(),
        }
        None
    }

    /// Time since a command was sent, beyond the shortest delay, seconds.
    fn age_s(&mut self, stamp_s: f64, now_s: f64) -> f64 {
        let late_s = now_s - stamp_s;
        self.least_s = late_s.min(self.least_s + DRIFT_S);
        late_s - self.least_s
    }

    fn is_new(&mut self, seq: u64) -> bool {
        let is_new = self.last_seq.is_none_or(|last| seq > last);
        if is_new {
            self.last_seq = Some(seq);
        }
        is_new
    }

    /// The first readings, before any motion.
    pub fn first(&mut self, now_s: f64) -> FromVehicle {
        self.readings(now_s)
    }

    /// Moves for one tick, unless the lease has lapsed, and returns the readings after it.
    pub fn step(&mut self, now_s: f64) -> FromVehicle {
        let driven = self.driven.filter(|(_, until_s)| now_s <= *until_s).map(|(drive, _)| drive);
        self.simulator.act(driven.map_or(Drive::STILL, |drive| self.drive(&drive)));
        self.readings(now_s)
    }

    /// Converts a motion in the robot frame to a drive of the simulator.
    fn drive(&self, drive: &message::Drive) -> Drive {
        match self.hello.motion {
            MotionKind::Unicycle => {
                Drive::Twist { v_m_per_s: drive.forward_m_per_s, w_rad_per_s: drive.turn_rad_per_s }
            }
            MotionKind::Omni => {
                let heading_rad = self.simulator.truth().pose.heading_rad;
                let in_robot = Vector::new(drive.forward_m_per_s, drive.sideways_m_per_s);
                Drive::Velocity(nalgebra::Rotation2::new(heading_rad) * in_robot)
            }
        }
    }

    fn readings(&mut self, now_s: f64) -> FromVehicle {
        let readings = self.simulator.sense();
        self.seq += 1;
        if let Some(pose) = &mut self.reckoned {
            *pose = reckoned(*pose, readings.odometry);
        }
        let told = message::Readings {
            seq: self.seq,
            stamp_s: now_s,
            pose: self.reckoned,
            scan: self.scanner.zip(readings.scan.as_ref()).map(|(scanner, scan)| scanned(&scanner, scan)),
            ..told(&readings, &self.stations, self.tick_s)
        };
        FromVehicle::Readings(Box::new(told))
    }
}

/// Converts the readings of a simulator to a message, without its number and stamp.
fn told(readings: &Readings, stations: &[Station], tick_s: f64) -> message::Readings {
    let name = |id| stations.iter().find(|station| station.id == id).map(|station| station.name.clone());
    let ranges = readings.ranges.iter().filter_map(|set| {
        let possible =
            set.ranges_m.iter().copied().filter(|range_m| *range_m > 0.0 && *range_m <= RANGE_MAX_M);
        Some(StationRanges { station: name(set.station)?, ranges_m: possible.collect() })
    });
    let pulses = readings.pulses.iter().filter_map(|set| {
        let lengths_m = set.lengths_m.iter().copied().filter(|length_m| length_m.abs() <= RANGE_MAX_M);
        let (sender, receiver) = (name(set.sender)?, name(set.receiver)?);
        Some(PulseLengths { sender, receiver, lengths_m: lengths_m.collect() })
    });
    let world::Odometry { forward_m, sideways_m, turn_rad } = readings.odometry;
    message::Readings {
        pulses: pulses.collect(),
        odometry: Some(Odometry { over_s: tick_s, forward_m, sideways_m, turn_rad }),
        ae: readings.ranging_cycle.then(|| Ae { ranges: ranges.collect(), ..Ae::default() }),
        contact: Some(readings.contact),
        tether: readings.paid_out_m.map(|paid_out_m| Tether { paid_out_m, pull_n: readings.reel_pull_n }),
        pressure_pa: readings.pressure_pa,
        dead_channels: readings.dead_channels.clone(),
        outlines: readings.sightings.iter().map(outline).collect(),
        ..message::Readings::default()
    }
}

fn scanned(scanner: &Scanner, scan: &Scan) -> message::Scan {
    message::Scan {
        first_rad: scan.first_rad,
        step_rad: scan.step_rad,
        range_max_m: scanner.range_m,
        sensor_m: scan.sensor_m,
        ranges_m: Scanner::ranges_m(scan).collect(),
    }
}

/// The pose after a motion.
fn reckoned(pose: message::Pose, moved: world::Odometry) -> message::Pose {
    let (sin, cos) = pose.heading_rad.sin_cos();
    message::Pose {
        x_m: pose.x_m + moved.forward_m * cos - moved.sideways_m * sin,
        y_m: pose.y_m + moved.forward_m * sin + moved.sideways_m * cos,
        heading_rad: pose.heading_rad + moved.turn_rad,
    }
}

fn outline(sighting: &Sighting) -> Outline {
    let id = sighting.id.0;
    let points = |points: &[Point]| points.iter().map(|point| [point.x, point.y]).collect();
    match &sighting.shape_in_robot {
        Shape::Disc { center, radius_m } => {
            Outline { id, points_m: points(&[*center]), radius_m: *radius_m, closed: false }
        }
        Shape::Polygon { vertices } => {
            Outline { id, points_m: points(vertices), radius_m: 0.0, closed: true }
        }
        Shape::Polyline { points: line, half_width_m } => {
            Outline { id, points_m: points(line), radius_m: *half_width_m, closed: false }
        }
    }
}

fn hello(scenario: &Scenario) -> Hello {
    let MissionConfig { limits, tick_s, .. } = &scenario.mission;
    let motion = match limits.motion {
        Motion::Unicycle => MotionKind::Unicycle,
        Motion::Point => MotionKind::Omni,
    };
    let acceleration_m_per_s2 = limits.acceleration_m_per_s2.clamp(f64::MIN_POSITIVE, 50.0);
    Hello {
        protocol: PROTOCOL,
        name: format!("simulator of {}", scenario.name),
        motion,
        limits: Limits {
            speed_m_per_s: limits.v_max_m_per_s,
            turn_rad_per_s: limits.w_max_rad_per_s,
            acceleration_m_per_s2,
            radius_m: limits.radius_m,
        },
        has: Has {
            odometry: true,
            contact: true,
            tether: scenario.mission.tether.is_some(),
            ae: scenario.sim.ae.is_some(),
            pressure: scenario.mission.pressure.is_some(),
            scan: scenario.sim.robot.scanner.is_some(),
            drawn_ids: true,
            ..Has::default()
        },
        period_s: *tick_s,
        stop_time_s: (limits.v_max_m_per_s / acceleration_m_per_s2).min(60.0) + tick_s,
        lease_max_s: 1.0,
        session: None,
    }
}
