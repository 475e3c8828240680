//! The loop of Yang et al. 2021, Fig. 6: medium, limits, forces, virtual goal, window.

use crate::{
    guide::{Field, Guide, Trip, shortest_way},
    near::NearThings,
    surroundings::{Changed, Surroundings},
    window::{Twist, Window, moved},
};
use steering::{Forces, KnownMap};
use world::{Amphibious, Medium, Mode, Pace, Point, Pose, Zone, polyline};

/// Distance from the goal within which the robot is slowed down so that it can turn towards the goal, metres.
const TURNING_M: f64 = 1.2;
/// Angle between the robot's heading and its target above which the robot turns first, radians.
const ASIDE_RAD: f64 = 0.35;
/// Lowest speed limit near the goal while the robot faces the goal, metres per second; it keeps the window from being
/// empty.
const SLOWEST_M_PER_S: f64 = 0.02;

/// Spacing of the points of a path over a large map, metres.
const ROUTE_M: f64 = 0.25;

/// All settings of the loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HybridSettings {
    /// The robot's limits on land and under water.
    pub robot: Amphibious,
    /// The window.
    pub window: Window,
    /// The field.
    pub field: Field,
    /// Maximum number of steps in a plan; 0 means a maximum that depends on the length of the trip.
    pub steps_max: usize,
}

impl HybridSettings {
    /// Changes the distance that the robot's centre keeps from solids, metres, and the push from the wall.
    pub fn keep(&mut self, keep_m: f64, wall_gain: f64) {
        (self.window.keep_m, self.field.keep_m) = (keep_m, keep_m);
        self.field.push.wall_gain = wall_gain;
    }
}

/// The robot's position and motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// The robot's pose.
    pub pose: Pose,
    /// Its speed and turn rate.
    pub twist: Twist,
}

/// The decision in one step.
#[derive(Debug, Clone, PartialEq)]
pub struct Decision {
    /// Motion until the next step.
    pub twist: Twist,
    /// The forces behind the decision.
    pub forces: Forces,
    /// The limits that apply now.
    pub pace: Pace,
}

/// The loop and its state.
#[derive(Debug, Clone)]
pub struct Hybrid {
    settings: HybridSettings,
    zones: Vec<Zone>,
    mode: Option<Mode>,
    guide: Guide,
}

/// Number of distances reported: as many as the paper plots.
const N_DISTANCES: usize = 10;

impl Hybrid {
    /// Creates a loop that has not yet started.
    pub fn new(settings: HybridSettings, zones: Vec<Zone>, hull_m: f64) -> Self {
        Self { guide: Guide::new(&settings.field, hull_m), settings, zones, mode: None }
    }

    /// The settings of the loop.
    pub fn settings(&self) -> &HybridSettings {
        &self.settings
    }

    /// Sets the time for which a command takes effect, seconds.
    pub fn set_tick(&mut self, tick_s: f64) {
        self.settings.window.dt_s = tick_s;
    }

    /// Changes the distance that the robot's centre keeps from solids, metres, and the push from the wall; everything
    /// else stays as it is.
    pub fn keep(&mut self, keep_m: f64, wall_gain: f64) {
        self.settings.keep(keep_m, wall_gain);
    }

    /// The guide and its virtual goals.
    pub fn guide(&self) -> &Guide {
        &self.guide
    }

    /// How far the robot has changed from walking (0) to swimming (1); `None` before the first step.
    pub fn mode(&self) -> Option<f64> {
        self.mode.map(Mode::weight)
    }

    /// Notes a change to the map.
    pub fn take_change(&mut self, changed: Changed) {
        self.guide.take_change(changed);
    }

    /// The distance within which obstacles can affect the next step, metres.
    pub fn reach_m(&self) -> f64 {
        let Amphibious { land, underwater, .. } = self.settings.robot;
        let reach_m = |pace| self.settings.window.reach_m(pace);
        reach_m(land).max(reach_m(underwater)).max(self.settings.field.push.rho_m)
    }

    /// Decides how to move in the next tick. `ahead` is the next part of the plan, if there is a plan.
    pub fn decide(&mut self, state: &State, goal: Point, ahead: &[Point], around: &Surroundings) -> Decision {
        let pace = self.adapt(state.pose.position);
        let window = &self.settings.window;
        let (at, step_m) = (state.pose.position, pace.v_max_m_per_s * window.dt_s);
        let aim = if around.is_everything() { goal } else { ahead.last().copied().unwrap_or(goal) };
        let forces = self.guide.forces(&self.settings.field, around, &Trip { at, goal, aim }, step_m);
        let reference = forces.resultant().try_normalize(1e-9).unwrap_or(goal - at);
        let near = NearThings::of(around.map(), at, window.reach_m(pace));
        let drivable = Pace { v_max_m_per_s: drivable(state, goal, pace), ..pace };
        let twist = window.choose(&state.pose, state.twist, drivable, reference, &near);
        Decision { twist, forces, pace }
    }

    /// Updates the limits for the floor under the robot, by one step of the transition per call.
    fn adapt(&mut self, at: Point) -> Pace {
        let robot = &self.settings.robot;
        let medium = Medium::at(&self.zones, at);
        let mode =
            self.mode.map_or_else(|| Mode::of(medium), |mode| mode.toward(medium, robot.transition_steps));
        self.mode = Some(mode);
        robot.pace(mode.weight())
    }
}

/// The maximum speed near the goal at which an arc with the maximum turn rate still reaches the goal. A faster robot
/// would circle around the goal forever.
fn drivable(state: &State, goal: Point, pace: Pace) -> f64 {
    let way = goal - state.pose.position;
    let missing_m = way.norm();
    if missing_m > TURNING_M {
        return pace.v_max_m_per_s;
    }
    let off_rad = state.pose.direction().angle(&way);
    let bend = 2.0 * off_rad.min(std::f64::consts::FRAC_PI_2).sin() / missing_m.max(1e-3);
    let turning = 0.8 * pace.w_max_rad_per_s / bend.max(1e-6);
    let speed = if off_rad > std::f64::consts::FRAC_PI_2 { 0.0 } else { turning };
    let slow = if off_rad > ASIDE_RAD { speed } else { speed.max(SLOWEST_M_PER_S) };
    slow.min(pace.v_max_m_per_s)
}

/// The distances from the hull to the nearest outlines, up to ten, nearest first, metres.
pub fn distances_m(map: &KnownMap, at: Point) -> Vec<f64> {
    let mut all: Vec<f64> = map.solids.iter().map(|s| s.distance(at).0 - map.hull_m).collect();
    if all.len() > N_DISTANCES {
        all.select_nth_unstable_by(N_DISTANCES, f64::total_cmp);
        all.truncate(N_DISTANCES);
    }
    all.sort_by(f64::total_cmp);
    all
}

/// A simulated run of the loop, in which the pose is known exactly.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// The position at every tick, starting with the start.
    pub path: Vec<Point>,
    /// Whether the goal was reached.
    pub arrived: bool,
    /// Largest excess of the robot's speed over the limit that applied, metres per second.
    pub overspeed_m_per_s: f64,
}

/// Simulates the loop over the known map. `check` can end it early.
///
/// # Errors
/// The error that `check` returns.
pub fn run<E>(
    hybrid: &mut Hybrid,
    start: Pose,
    goal: Point,
    tolerance_m: f64,
    steps_max: usize,
    map: &KnownMap,
    mut check: impl FnMut() -> Result<(), E>,
) -> Result<Run, E> {
    let mut around = Surroundings::new(map.clone());
    let mut state = State { pose: start, twist: Twist::default() };
    let mut run = Run { path: vec![start.position], arrived: false, overspeed_m_per_s: 0.0 };
    let reach_m = hybrid.reach_m();
    let dt_s = hybrid.settings.window.dt_s;
    for _ in 0..steps_max {
        let at = state.pose.position;
        if (goal - at).norm() <= tolerance_m {
            run.arrived = true;
            break;
        }
        check()?;
        hybrid.take_change(around.look(at, reach_m, &[], |_| false));
        let decision = hybrid.decide(&state, goal, &[], &around);
        state.twist = decision.twist;
        state.pose = moved(&state.pose, state.twist, dt_s);
        run.path.push(state.pose.position);
        let over = state.twist.v_m_per_s - decision.pace.v_max_m_per_s;
        run.overspeed_m_per_s = run.overspeed_m_per_s.max(over);
    }
    Ok(run)
}

/// The shortest path over a map too large to be simulated; only the start if there is no path. `check` can end the
/// search early.
///
/// # Errors
/// The error that `check` returns.
pub fn route<E>(
    map: &KnownMap,
    start: Point,
    goal: Point,
    keep_m: f64,
    mut check: impl FnMut() -> Result<(), E>,
) -> Result<Run, E> {
    let mut stopped = Ok(());
    let mut keep_going = || {
        stopped = check();
        stopped.is_ok()
    };
    let whole = Surroundings::whole(map.clone());
    let corners = shortest_way(&whole, start, goal, keep_m, &mut keep_going);
    stopped?;
    let way: Vec<Point> = std::iter::once(start).chain(corners.iter().flatten().copied()).collect();
    let path = polyline::resampled(&way, ROUTE_M);
    Ok(Run { path, arrived: corners.is_some(), overspeed_m_per_s: 0.0 })
}

#[cfg(test)]
mod tests;
