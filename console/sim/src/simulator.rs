//! The simulator: sense and act.

use crate::{
    chance::{Chance, normal},
    config::{SimConfig, TetherTruth, Truth},
    motion::{Arc, Tracks, bounded},
    movers::Movers,
    ranging::Sounder,
    sight::sightings,
    sweep::sweep,
};
use geometry::Drive;
use world::{Medium, Mode, ObstacleMap, Odometry, Point, Pose, Readings, tether::Cable};

/// A hull that touched something keeps touching it until the gap is wider than this, metres.
const CONTACT_GAP_M: f64 = 1e-3;

/// One robot in one tank; time is the number of ticks.
///
/// Every tick: [`Simulator::sense`] once, then [`Simulator::act`] once.
#[derive(Clone)]
pub struct Simulator {
    config: SimConfig,
    map: ObstacleMap,
    movers: Movers,
    chance: Chance,
    tracks: Tracks,
    sounder: Option<Sounder>,
    mode: Mode,
    pose: Pose,
    cable: Option<Cable>,
    odometry: Odometry,
    in_contact: bool,
    collided: bool,
    tick: u64,
}

impl Simulator {
    /// A robot at rest at its start; `seed` is the start of all chance.
    pub fn new(config: SimConfig, seed: u64) -> Self {
        let map = ObstacleMap::new(&config.world.boundary, &config.world.obstacles);
        let mut simulator = Self {
            map,
            movers: Movers::new(&config.movers, &config.world.obstacles),
            chance: Chance::new(seed),
            tracks: Tracks::new(&config.robot, config.tick_s),
            sounder: config.ae.clone().map(|ae| Sounder::new(ae, &config.world, seed)),
            mode: Mode::of(Medium::at(&config.world.zones, config.robot.start.position)),
            pose: config.robot.start,
            cable: cable(&config),
            odometry: Odometry::default(),
            in_contact: false,
            collided: false,
            tick: 0,
            config,
        };
        simulator.in_contact = simulator.clearance_m() < 0.0;
        simulator.collided = simulator.in_contact;
        simulator
    }

    /// What the robot senses at the top of this tick; to be called once per tick, because it draws chance.
    pub fn sense(&mut self) -> Readings {
        let world = &self.config.world;
        let t_s = self.tick as f64 * self.config.tick_s.max(0.0);
        let at = self.pose.position;
        let ranges = self.sounder.as_mut().and_then(|sounder| sounder.due_cycle(t_s, at));
        let robot = &self.config.robot;
        let reach_m = bounded(robot.radius_m.max(0.0) + robot.sensing_range_m.max(0.0));
        Readings {
            ranging_cycle: ranges.is_some(),
            ranges: ranges.unwrap_or_default(),
            odometry: self.odometry,
            sightings: sightings(&self.map, &world.boundary, &world.obstacles, &self.pose, reach_m),
            contact: self.in_contact,
            paid_out_m: self.cable.as_ref().map(Cable::length_m),
        }
    }

    /// Moves the truth by one tick.
    pub fn act(&mut self, drive: Drive) {
        self.adapt();
        let by_tracks = self.tracks.drive(drive, &self.pose);
        let driven = Arc { way_m: by_tracks.way_m * (1.0 - self.draw_slip()), ..by_tracks };
        let reached = sweep(&self.map, self.radius_m(), &self.pose, &driven);
        let cable = self.cable.as_ref().map(|cable| dragged(cable, reached.pose.position));
        let is_at_its_end = self.is_at_its_end(cable.as_ref());
        self.pose = if is_at_its_end {
            Pose { heading_rad: reached.pose.heading_rad, ..self.pose }
        } else {
            self.cable = cable;
            reached.pose
        };
        self.odometry = self.measured(&by_tracks);
        let touched_before = self.in_contact;
        let is_run_into = self.move_obstacles();
        self.in_contact =
            reached.is_blocked || is_run_into || (touched_before && self.clearance_m() < CONTACT_GAP_M);
        self.collided = self.in_contact && !touched_before;
        if reached.is_blocked || is_at_its_end {
            self.tracks.stop();
        }
        self.tick += 1;
    }

    /// The truth at the top of this tick.
    pub fn truth(&self) -> Truth {
        Truth {
            pose: self.pose,
            clearance_m: self.clearance_m(),
            collided: self.collided,
            tether: self.cable.as_ref().map(|cable| TetherTruth {
                length_m: cable.length_m(),
                wrap_max_rad: cable.wrap_max_rad(),
                wrap_total_rad: cable.wrap_total_rad(),
                detour_m: cable.length_m() - (cable.tip() - cable.anchor()).norm(),
            }),
        }
    }

    /// Number of ticks that have passed.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// Changes a little from walking to swimming or back, as the floor under the robot asks for.
    fn adapt(&mut self) {
        let Some(amphibious) = self.config.robot.amphibious else { return };
        let medium = Medium::at(&self.config.world.zones, self.pose.position);
        self.mode = self.mode.toward(medium, amphibious.transition_steps);
        self.tracks.limit(amphibious.pace(self.mode));
    }

    /// Moves what moves; whether something runs into the hull.
    fn move_obstacles(&mut self) -> bool {
        if self.movers.is_empty() {
            return false;
        }
        let world = &mut self.config.world;
        self.movers.advance(&mut world.obstacles, &world.boundary, self.config.tick_s.max(0.0));
        self.map = ObstacleMap::new(&world.boundary, &world.obstacles);
        self.clearance_m() < 0.0
    }

    /// Whether the reel does not hold the cable that a move asks for. The robot can always come back.
    fn is_at_its_end(&self, moved: Option<&Cable>) -> bool {
        let (Some(reel_length_m), Some(before), Some(after)) =
            (self.config.reel_length_m, &self.cable, moved)
        else {
            return false;
        };
        after.length_m() > reel_length_m && after.length_m() > before.length_m()
    }

    fn radius_m(&self) -> f64 {
        self.config.robot.radius_m.max(0.0)
    }

    fn clearance_m(&self) -> f64 {
        self.map.clearance_m(self.pose.position) - self.radius_m()
    }

    /// Share of the way that is lost in this tick; never less than nothing, never more than all.
    fn draw_slip(&mut self) -> f64 {
        let robot = &self.config.robot;
        (robot.slip_mean + robot.slip_sigma * normal(&mut self.chance.slip)).clamp(0.0, 1.0)
    }

    /// The odometry of a motion: tracks sense neither slip nor that the robot was stopped; the gyro measures the turn
    /// but drifts.
    fn measured(&mut self, by_tracks: &Arc) -> Odometry {
        let robot = &self.config.robot;
        let mut erring = || bounded(1.0 + robot.odometry_sigma_ratio * normal(&mut self.chance.odometry));
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

/// The cable from its anchor straight to the robot; none if the anchor cannot be.
fn cable(config: &SimConfig) -> Option<Cable> {
    let shapes: Vec<_> = config.world.obstacles.iter().map(|o| o.shape.clone()).collect();
    let mut cable = Cable::new(config.tether_anchor?, &config.world.boundary, &shapes).ok()?;
    cable.drag_to(config.robot.start.position);
    Some(cable)
}

#[cfg(test)]
mod tests;
