//! The one rule that limits every command, whatever its source. After this tick, the robot must still be able to brake to
//! a standstill, straight ahead, without touching anything on the chart and without leaving the range of its sensors.
//!
//! If this condition is met in one tick, there is always a command for the next tick that meets the condition again. A
//! command that would violate the condition is executed more slowly or, as a last resort, not at all: the robot brakes.
//! The path is computed for one tick with the robot's own acceleration and turn rate, from its current speed.

pub(crate) mod guard;

use geometry::{Braking, Drive, Limits, Motion, motion::at_most};
use world::{Point, Pose, Vector};

/// Clearance to keep from obstacles in sight, metres; small, because their position relative to the robot is known.
const SEEN_ROOM_M: f64 = 0.01;
/// Maximum clearance, metres, to keep from obstacles that are only on the chart. The clearance allows for the position
/// error, but is limited, because a robot that is lost must still be able to move.
const CHART_ROOM_MOST_M: f64 = 0.15;
/// The clearance to keep is at most this share of the space between the hull and an obstacle, because a robot that
/// brakes straight ahead along a curved wall gets closer to the wall.
const ROOM_SHARE: f64 = 0.5;
/// Distance, metres, by which a hull in contact with an obstacle may move into it, to allow for rounding.
const TOUCH_M: f64 = 1e-4;
/// Minimum step for checking the robot's path, metres.
const LOOK_M: f64 = 0.01;
/// Maximum turn in one piece of an arc when the arc is checked, radians.
const ARC_PIECE_RAD: f64 = 0.2;
/// Number of bisection steps in the search for the highest safe speed.
const HALVINGS: u32 = 6;

/// Something that the hull must not touch.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Solid<'a> {
    /// Outline of the object.
    pub outline: Outline<'a>,
    /// Whether the object is in sight now; if not, its position relative to the estimated pose is taken from the chart.
    pub is_seen: bool,
}

/// An outline on the chart.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Outline<'a> {
    /// Something solid, or a zone.
    Shape(&'a world::Shape),
    /// The wall.
    Wall(&'a world::Boundary),
}

impl Outline<'_> {
    fn distance_m(&self, at: Point) -> f64 {
        match self {
            Self::Shape(shape) => shape.distance_m(at),
            Self::Wall(wall) => wall.wall_distance_m(at),
        }
    }
}

/// The inputs of the rule in one tick.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Here {
    /// The robot's estimated pose.
    pub pose: Pose,
    /// Half width of the 95 % position error, metres.
    pub error_m: f64,
    /// The robot's limits here.
    pub limits: Limits,
}

/// The robot's speed, computed from the commands sent to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Momentum {
    /// Speed along the heading, metres per second; negative backward. For a robot without a heading, simply its speed.
    ahead_m_per_s: f64,
    /// Velocity of a robot without a heading, metres per second, tank frame.
    velocity: Vector,
}

/// The effect of a command in one tick, and the speed after it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Motions {
    /// The pose at the end of the tick.
    end: Pose,
    /// Turn during the tick, radians.
    turn_rad: f64,
    after: Momentum,
    /// Direction of travel while the robot brakes, a unit vector.
    onward: Vector,
}

impl Momentum {
    /// Standstill.
    pub(crate) const NONE: Self = Self { ahead_m_per_s: 0.0, velocity: Vector::new(0.0, 0.0) };

    /// The speed along the heading, metres per second; negative backward.
    pub(crate) fn speed_m_per_s(&self) -> f64 {
        self.ahead_m_per_s
    }

    /// The direction of travel of a robot at a pose, a unit vector; zero at standstill.
    pub(crate) fn direction(&self, pose: Pose) -> Vector {
        let velocity = if self.velocity == Vector::zeros() {
            pose.direction() * self.ahead_m_per_s
        } else {
            self.velocity
        };
        velocity.try_normalize(1e-12).unwrap_or_else(Vector::zeros)
    }

    /// The robot's speed after following a drive for one tick.
    pub(crate) fn after(&self, drive: Drive, here: &Here) -> Self {
        self.motions(drive, here).after
    }

    fn motions(&self, drive: Drive, here: &Here) -> Motions {
        let Limits { acceleration_m_per_s2, tick_s, v_max_m_per_s, w_max_rad_per_s, .. } = here.limits;
        let change = acceleration_m_per_s2 * tick_s;
        if here.limits.motion == Motion::Point {
            let wanted = match drive {
                Drive::Velocity(velocity) => at_most(velocity, v_max_m_per_s),
                Drive::Twist { v_m_per_s, .. } => here.pose.direction() * v_m_per_s,
            };
            let velocity = self.velocity + at_most(wanted - self.velocity, change);
            let end = Pose { position: here.pose.position + velocity * tick_s, ..here.pose };
            let after = Self { ahead_m_per_s: velocity.norm(), velocity };
            let onward = velocity.try_normalize(1e-12).unwrap_or_else(Vector::zeros);
            return Motions { end, turn_rad: 0.0, after, onward };
        }
        let (v, w) = match drive {
            Drive::Twist { v_m_per_s, w_rad_per_s } => (v_m_per_s, w_rad_per_s),
            // A robot with a heading receives only twists.
            Drive::Velocity(_) => (0.0, 0.0),
        };
        let wanted = v.clamp(-v_max_m_per_s, v_max_m_per_s);
        let ahead_m_per_s = self.ahead_m_per_s + (wanted - self.ahead_m_per_s).clamp(-change, change);
        let turn_rad = w.clamp(-w_max_rad_per_s, w_max_rad_per_s) * tick_s;
        let end = here.pose.moved(ahead_m_per_s * tick_s, 0.0, turn_rad);
        let after = Self { ahead_m_per_s, velocity: Vector::zeros() };
        Motions { end, turn_rad, after, onward: end.direction() * ahead_m_per_s.signum() }
    }

    /// The command at the given `share` of its speed, on the same curve: 1 is the full command, 0 is the hardest
    /// braking.
    fn slower(&self, drive: Drive, share: f64, here: &Here) -> Drive {
        match drive {
            Drive::Velocity(velocity) => Drive::Velocity(velocity * share),
            Drive::Twist { v_m_per_s, w_rad_per_s } => {
                let change = here.limits.acceleration_m_per_s2 * here.limits.tick_s;
                let least = self.ahead_m_per_s - self.ahead_m_per_s.clamp(-change, change);
                let most = self.ahead_m_per_s + (v_m_per_s - self.ahead_m_per_s).clamp(-change, change);
                Drive::Twist { v_m_per_s: least + (most - least) * share, w_rad_per_s }
            }
        }
    }
}

/// The obstacles near a robot, and the distance that its centre must keep from each.
pub(crate) struct Surroundings<'a> {
    solids: Vec<(Outline<'a>, f64)>,
}

impl<'a> Surroundings<'a> {
    /// The obstacles near a robot at this place.
    pub(crate) fn of(solids: &[Solid<'a>], here: &Here) -> Self {
        let at = here.pose.position;
        let to = |solid: &Solid<'a>| {
            let (hull_m, distance_m) = (here.limits.radius_m, solid.outline.distance_m(at));
            let room_m = distance_m - hull_m;
            let wanted_m = if solid.is_seen { SEEN_ROOM_M } else { chart_room_m(here.error_m) };
            let kept_m = if room_m > 0.0 { wanted_m.min(ROOM_SHARE * room_m) } else { room_m - TOUCH_M };
            (solid.outline, hull_m + kept_m)
        };
        Self { solids: solids.iter().map(to).collect() }
    }

    /// How much farther a position of the hull's centre is from an obstacle than required, metres: the smallest value
    /// over all obstacles. It is negative where the centre must not be.
    fn spare_m(&self, at: Point) -> f64 {
        self.solids
            .iter()
            .map(|(outline, keep_m)| outline.distance_m(at) - keep_m)
            .fold(f64::INFINITY, f64::min)
    }

    /// Whether a straight path is clear.
    pub(crate) fn is_clear(&self, from: Point, to: Point) -> bool {
        let (way, length_m) = (to - from, (to - from).norm());
        let mut gone_m = 0.0;
        loop {
            let at = if gone_m < length_m { from + way * (gone_m / length_m) } else { to };
            let spare_m = self.spare_m(at);
            if spare_m < 0.0 {
                return false;
            }
            if gone_m >= length_m {
                return true;
            }
            gone_m += spare_m.max(LOOK_M);
        }
    }

    /// Whether a robot that moves in this way for one tick, and then brakes, touches nothing.
    fn allows(&self, motions: &Motions, here: &Here) -> bool {
        let start = &here.pose;
        let n = (motions.turn_rad.abs() / ARC_PIECE_RAD).ceil().max(1.0) as u32;
        let way_m = motions.after.ahead_m_per_s * here.limits.tick_s;
        let along = |k: u32| {
            if k == n {
                return motions.end.position;
            }
            let share = f64::from(k) / f64::from(n);
            start.moved(way_m * share, 0.0, motions.turn_rad * share).position
        };
        let braking_m = Braking::of(&here.limits).way_m(motions.after.ahead_m_per_s);
        let stand = motions.end.position + motions.onward * braking_m;
        (1..=n).all(|k| self.is_clear(along(k - 1), along(k))) && self.is_clear(motions.end.position, stand)
    }
}

/// Clearance to keep from obstacles that are only on the chart, metres.
fn chart_room_m(error_m: f64) -> f64 {
    if error_m.is_finite() { error_m.clamp(SEEN_ROOM_M, CHART_ROOM_MOST_M) } else { CHART_ROOM_MOST_M }
}

/// Distance from the hull's centre within which obstacles can affect a command, metres.
pub(crate) fn reach_m(momentum: &Momentum, drive: Drive, here: &Here) -> f64 {
    let after = momentum.after(drive, here).ahead_m_per_s.abs();
    let fastest = after.max(momentum.ahead_m_per_s.abs());
    here.limits.radius_m + chart_room_m(here.error_m) + Braking::of(&here.limits).distance_m(fastest)
}

/// Whether a robot can still stop within its sensing range after following a command for one tick.
pub(crate) fn is_within_sight(momentum: &Momentum, drive: Drive, here: &Here) -> bool {
    let after = momentum.after(drive, here).ahead_m_per_s;
    Braking::of(&here.limits).distance_m(after) <= here.limits.sensing_range_m
}

/// The drive that is sent for a command: the command itself if the robot can stop after it, or as much of it as is safe.
pub(crate) fn governed(momentum: &Momentum, drive: Drive, here: &Here, around: &Surroundings<'_>) -> Drive {
    let is_safe = |drive: Drive| {
        is_within_sight(momentum, drive, here) && around.allows(&momentum.motions(drive, here), here)
    };
    if is_safe(drive) {
        return drive;
    }
    let stop = momentum.slower(drive, 0.0, here);
    if !is_safe(stop) {
        return Drive::STILL;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if is_safe(momentum.slower(drive, middle, here)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    momentum.slower(drive, low, here)
}

#[cfg(test)]
mod tests;
