//! The simulator, with its calls `sense` and `act`.

use crate::{
    config::{RobotConfig, SimConfig, StationFault},
    laid::Laid,
    motion::{Arc, Tracks, bounded},
    movers::Movers,
    random::{RandomStreams, normal},
    ranging::Sounder,
    scanner::scan,
    sight::sightings,
    sweep::sweep,
};
use geometry::Drive;
use world::{
    Medium, Mode, ObstacleMap, Odometry, Point, Pose, Readings, StationId, TetherTruth, Truth, tether::Cable,
};

/// Width of the gap, metres, at which a contact of the hull ends.
const CONTACT_GAP_M: f64 = 1e-3;

/// One robot in one tank; time is the number of ticks.
///
/// In every tick, call [`Simulator::sense`] once and then [`Simulator::act`] once.
#[derive(Clone)]
pub struct Simulator {
    config: SimConfig,
    map: ObstacleMap,
    movers: Movers,
    streams: RandomStreams,
    tracks: Tracks,
    sounder: Option<Sounder>,
    mode: Mode,
    pose: Pose,
    /// The taut cable.
    cable: Option<Cable>,
    /// The cable as it lies, if it has weight.
    laid: Option<Laid>,
    odometry: Odometry,
    in_contact: bool,
    collided: bool,
    /// Whether the robot did not move in the last tick.
    is_at_rest: bool,
    tick: u64,
}

impl Simulator {
    /// Creates a robot at rest at its start; `seed` determines all randomness.
    pub fn new(config: SimConfig, seed: u64) -> Self {
        let map = ObstacleMap::new(&config.world.boundary, &config.world.obstacles);
        let cable = initial_cable(&config);
        let mut simulator = Self {
            map,
            movers: Movers::new(&config.movers, &config.world.obstacles),
            streams: RandomStreams::new(seed),
            tracks: Tracks::new(&config.robot, config.tick_s),
            sounder: config.ae.clone().map(|ae| Sounder::new(ae, &config.world, seed)),
            mode: Mode::of(Medium::at(&config.world.zones, config.robot.start.position)),
            pose: config.robot.start,
            laid: Laid::along(cable.as_ref(), &config),
            cable,
            odometry: Odometry::default(),
            in_contact: false,
            collided: false,
            is_at_rest: true,
            tick: 0,
            config,
        };
        simulator.in_contact = simulator.clearance_m() < 0.0;
        simulator.collided = simulator.in_contact;
        simulator
    }

    /// Creates a robot at rest at any place, with its cable in a given position, as at the start of a forecast.
    /// `clocks_m` gives the offset of the clock of each station and its change in an hour, metres; other clocks are drawn at
    /// random.
    pub fn resumed(
        config: SimConfig,
        seed: u64,
        pose: Pose,
        cable: Option<Cable>,
        clocks_m: &[(StationId, f64, f64)],
    ) -> Self {
        let robot = RobotConfig { start: pose, ..config.robot.clone() };
        let mut simulator = Self::new(SimConfig { robot, ..config }, seed);
        simulator.laid = Laid::along(cable.as_ref(), &simulator.config);
        simulator.cable = cable;
        simulator.sounder.iter_mut().for_each(|sounder| sounder.set_clocks(clocks_m));
        simulator
    }

    /// Returns the sensor readings at the start of this tick. Call it once per tick, because it draws random numbers.
    pub fn sense(&mut self) -> Readings {
        let world = &self.config.world;
        let t_s = self.tick as f64 * self.config.tick_s.max(0.0);
        let at = self.pose.position;
        let ranges = self.sounder.as_mut().and_then(|sounder| sounder.due_cycle(t_s, at));
        let is_at_rest = self.is_at_rest;
        let pulses = self.sounder.as_mut().map(|sounder| sounder.due_pulses(t_s, is_at_rest));
        let pressure_pa = self.config.robot.pressure.map(|sensor| {
            let mean_pa = sensor.expected_pa(Medium::at(&world.zones, at));
            bounded(mean_pa + sensor.sigma_pa * normal(&mut self.streams.pressure))
        });
        let robot = &self.config.robot;
        let reach_m = bounded(robot.radius_m.max(0.0) + robot.sensing_range_m.max(0.0));
        // A robot with a scanner sees obstacles only in its scan.
        let sightings = match robot.scanner {
            Some(_) => Vec::new(),
            None => sightings(&self.map, &world.boundary, &world.obstacles, &self.pose, reach_m),
        };
        let due = robot.scanner.filter(|scanner| scanner.is_due(self.tick, self.config.tick_s.max(0.0)));
        let rng = &mut self.streams.scanner;
        let scan = due.map(|scanner| scan(&scanner, &self.map, &world.boundary, &self.pose, rng));
        Readings {
            ranging_cycle: ranges.is_some(),
            ranges: ranges.unwrap_or_default(),
            pulses: pulses.unwrap_or_default(),
            odometry: self.odometry,
            unmeasured_s: 0.0,
            sightings,
            contact: self.in_contact,
            paid_out_m: self.paid_out_m(),
            reel_pull_n: self.laid.as_ref().map(Laid::reel_pull_n),
            robot_pull_n: self.laid.as_ref().map(Laid::robot_pull_n),
            pressure_pa,
            dead_channels: self.dead_channels(t_s),
            scan,
        }
    }

    /// Advances the true state by one tick.
    pub fn act(&mut self, drive: Drive) {
        self.update_mode();
        let before = self.pose;
        let by_tracks = self.tracks.drive(drive, &self.pose);
        let driven = Arc { way_m: by_tracks.way_m * (1.0 - self.draw_slip()), ..by_tracks };
        let reached = sweep(&self.map, self.radius_m(), &self.pose, &driven);
        let cable = self.cable.as_ref().map(|cable| dragged(cable, reached.pose.position));
        let laid = self.laid.as_ref().map(|laid| laid.moved(reached.pose.position, self.tick));
        let is_reel_empty = match &laid {
            Some(laid) => laid.is_at_its_end(),
            None => self.is_reel_empty(cable.as_ref()),
        };
        self.pose = if is_reel_empty {
            Pose { heading_rad: reached.pose.heading_rad, ..self.pose }
        } else {
            (self.cable, self.laid) = (cable, laid);
            reached.pose
        };
        self.is_at_rest = self.pose == before;
        self.odometry = self.measure_odometry(&by_tracks);
        let touched_before = self.in_contact;
        let is_hit = self.move_obstacles();
        self.in_contact =
            reached.is_blocked || is_hit || (touched_before && self.clearance_m() < CONTACT_GAP_M);
        self.collided = self.in_contact && !touched_before;
        if reached.is_blocked || is_reel_empty {
            self.tracks.stop();
        }
        self.tick += 1;
    }

    /// Adds a station fault that begins with this tick: for some seconds, the ranges from the station are too long by
    /// some metres, or missing. Has no effect if there is no acoustic-emission ranging.
    pub fn inject(&mut self, station: StationId, for_s: f64, excess_range_m: Option<f64>) {
        let from_s = self.tick as f64 * self.config.tick_s.max(0.0);
        if let Some(sounder) = &mut self.sounder {
            sounder.inject(StationFault { station, from_s, to_s: from_s + for_s, excess_range_m });
        }
    }

    /// The true state at the start of this tick.
    pub fn truth(&self) -> Truth {
        Truth {
            pose: self.pose,
            clearance_m: self.clearance_m(),
            collided: self.collided,
            tether: self.cable.as_ref().map(|cable| TetherTruth {
                length_m: self.paid_out_m().unwrap_or_default(),
                wrap_max_rad: cable.wrap_max_rad(),
                wrap_total_rad: cable.wrap_total_rad(),
                detour_m: self.paid_out_m().unwrap_or_default() - (cable.tip() - cable.anchor()).norm(),
                lies: self.laid.as_ref().map(|laid| laid.lies(self.radius_m(), self.tick)),
            }),
        }
    }

    /// Number of ticks that have passed.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// Advances a transition between walking and swimming by one step, if the floor under the robot requires one.
    fn update_mode(&mut self) {
        let Some(amphibious) = self.config.robot.amphibious else { return };
        let medium = Medium::at(&self.config.world.zones, self.pose.position);
        self.mode = self.mode.toward(medium, amphibious.transition_steps);
        self.tracks.set_limits(amphibious.pace(self.mode.weight()));
    }

    /// The channels that were dead at some moment since the last tick; `None` if none ever is.
    fn dead_channels(&self, t_s: f64) -> Option<Vec<u16>> {
        let faults = &self.config.channel_faults;
        let since_s = t_s - self.config.tick_s.max(0.0);
        let dead = faults.iter().filter(|fault| fault.from_s <= t_s && since_s < fault.to_s);
        let dead: std::collections::BTreeSet<u16> = dead.map(|fault| fault.channel).collect();
        (!faults.is_empty()).then(|| dead.into_iter().collect())
    }

    /// Moves the moving obstacles; returns whether one of them hits the hull.
    fn move_obstacles(&mut self) -> bool {
        if self.movers.is_empty() {
            return false;
        }
        let world = &mut self.config.world;
        self.movers.advance(&mut world.obstacles, &world.boundary, self.config.tick_s.max(0.0));
        self.map = ObstacleMap::new(&world.boundary, &world.obstacles);
        if let Some(laid) = &mut self.laid {
            laid.see(&self.config);
        }
        self.clearance_m() < 0.0
    }

    /// Whether a move needs more tether than the reel has. A move that needs no more tether than before is always
    /// possible.
    fn is_reel_empty(&self, moved: Option<&Cable>) -> bool {
        let (Some(reel_length_m), Some(before), Some(after)) =
            (self.config.reel_length_m, &self.cable, moved)
        else {
            return false;
        };
        after.length_m() > reel_length_m && after.length_m() > before.length_m()
    }

    /// Length of cable off the reel, metres.
    fn paid_out_m(&self) -> Option<f64> {
        let taut_m = self.cable.as_ref().map(Cable::length_m);
        self.laid.as_ref().map(Laid::length_m).or(taut_m)
    }

    fn radius_m(&self) -> f64 {
        self.config.robot.radius_m.max(0.0)
    }

    fn clearance_m(&self) -> f64 {
        self.map.clearance_m(self.pose.position) - self.radius_m()
    }

    /// Share of the commanded distance that is lost in this tick, 0 to 1.
    fn draw_slip(&mut self) -> f64 {
        let robot = &self.config.robot;
        (robot.slip_mean + robot.slip_sigma * normal(&mut self.streams.slip)).clamp(0.0, 1.0)
    }

    /// The odometry of a motion. The tracks sense neither slip nor collisions; the gyro measures the turn but drifts.
    fn measure_odometry(&mut self, by_tracks: &Arc) -> Odometry {
        let robot = &self.config.robot;
        let mut erring = || bounded(1.0 + robot.odometry_sigma_ratio * normal(&mut self.streams.odometry));
        let (of_way, of_turn) = (erring(), erring());
        let (forward_m, sideways_m, turn_rad) = by_tracks.seen_from_start();
        Odometry {
            forward_m: forward_m * of_way,
            sideways_m: sideways_m * of_way,
            turn_rad: turn_rad * of_turn + bounded(robot.gyro_bias_rad_per_s * self.config.tick_s.max(0.0)),
        }
    }
}

fn dragged(cable: &Cable, to: Point) -> Cable {
    let mut cable = cable.clone();
    cable.drag_to(to);
    cable
}

/// The cable, straight from its anchor to the robot; `None` if the anchor is invalid.
fn initial_cable(config: &SimConfig) -> Option<Cable> {
    let shapes: Vec<_> = config.world.obstacles.iter().map(|o| o.shape.clone()).collect();
    let mut cable = Cable::new(config.tether_anchor?, &config.world.boundary, &shapes).ok()?;
    cable.drag_to(config.robot.start.position);
    Some(cable)
}

#[cfg(test)]
mod tests;
