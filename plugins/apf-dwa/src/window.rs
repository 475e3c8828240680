//! The dynamic window (Fox et al. 1997, as in Yang et al. 2021, eq. 20-23).

use crate::near::NearThings;
use geometry::Braking;
use world::{Pace, Point, Pose, Vector};

/// Number of speeds tried.
const N_SPEEDS: usize = 7;
/// Number of turn rates tried.
const N_TURNS: usize = 21;
/// Time for which an arc is followed, seconds.
const HORIZON_S: f64 = 3.0;
/// Time between the points checked on an arc, seconds.
const STEP_S: f64 = 0.2;
/// Number of points checked on an arc.
const N_PLACES: usize = 15;
/// The clearance in excess of the distance to keep counts only up to this value, metres.
const CAP_M: f64 = 1.0;
/// Turn rate when no arc is allowed, as a share of the maximum.
const TURN_SHARE: f64 = 0.3;

/// The motion of a unicycle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Twist {
    /// Forward speed, metres per second.
    pub v_m_per_s: f64,
    /// Turn rate, radians per second.
    pub w_rad_per_s: f64,
}

/// Weights of the terms in the score of an arc; each term is divided by its sum over all allowed arcs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights {
    /// Pointing along the reference at the end of the arc.
    pub heading: f64,
    /// Clearance beside the arc.
    pub distance: f64,
    /// Speed.
    pub velocity: f64,
}

/// Settings for choosing the next twist.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Maximum change of speed, metres per second squared; the paper gives no value.
    pub acceleration_m_per_s2: f64,
    /// Maximum change of turn rate, radians per second squared; the paper gives no value.
    pub turn_acceleration_rad_per_s2: f64,
    /// Weights of the terms.
    pub weights: Weights,
    /// Distance that the robot's centre keeps from outlines, metres.
    pub keep_m: f64,
    /// Length of a tick, seconds.
    pub dt_s: f64,
}

struct Candidate {
    twist: Twist,
    heading: f64,
    distance: f64,
}

impl Window {
    /// The distance within which objects can matter, metres.
    pub fn reach_m(&self, pace: Pace) -> f64 {
        pace.v_max_m_per_s * HORIZON_S + CAP_M + self.keep_m
    }

    /// Returns the best twist for the next tick: within the limits and the reach of the drives, and such that the robot
    /// can stop before it touches anything. If no arc is allowed, the robot brakes and turns slowly towards the
    /// reference.
    pub fn choose(&self, pose: &Pose, now: Twist, pace: Pace, reference: Vector, near: &NearThings) -> Twist {
        let (speeds, turns) = (self.speeds(now, pace), self.turns(now, pace));
        let here_m = self.spare_m(near, &[pose.position]);
        let mut candidates: Vec<Candidate> = Vec::with_capacity(N_SPEEDS * N_TURNS);
        for w_rad_per_s in spread::<N_TURNS>(turns) {
            let places = arc_per_speed(pose, w_rad_per_s);
            let end_rad = pose.heading_rad + w_rad_per_s * HORIZON_S;
            let off_rad = Vector::new(end_rad.cos(), end_rad.sin()).angle(&reference);
            for v_m_per_s in spread::<N_SPEEDS>(speeds) {
                let points = places.map(|offset| pose.position + offset * v_m_per_s);
                let distance_m = self.spare_m(near, &points);
                let twist = Twist { v_m_per_s, w_rad_per_s };
                if self.is_allowed(v_m_per_s, distance_m, here_m) {
                    let heading = std::f64::consts::PI - off_rad;
                    candidates.push(Candidate { twist, heading, distance: distance_m.max(0.0) });
                }
            }
        }
        self.best(&candidates).unwrap_or_else(|| turned_on_the_spot(pose, speeds, turns, pace, reference))
    }

    /// The clearance of some points in excess of the distance to keep, metres, capped at `CAP_M`.
    fn spare_m(&self, near: &NearThings, points: &[Point]) -> f64 {
        near.distance_m(points, CAP_M + self.keep_m) - self.keep_m
    }

    /// Whether the robot can stop in time. A robot that is already too close may make any move that does not bring it
    /// closer.
    fn is_allowed(&self, v_m_per_s: f64, distance_m: f64, here_m: f64) -> bool {
        if here_m < 0.0 {
            return distance_m >= here_m - 1e-9;
        }
        let braking = Braking { acceleration_m_per_s2: self.acceleration_m_per_s2, tick_s: 0.0 };
        distance_m >= 0.0 && braking.way_m(v_m_per_s) <= distance_m
    }

    fn best(&self, candidates: &[Candidate]) -> Option<Twist> {
        let sum = |term: fn(&Candidate) -> f64| candidates.iter().map(term).sum::<f64>().max(1e-9);
        let (headings, distances, speeds) =
            (sum(|c| c.heading), sum(|c| c.distance), sum(|c| c.twist.v_m_per_s));
        let weights = &self.weights;
        let score = |c: &Candidate| {
            weights.heading * c.heading / headings
                + weights.distance * c.distance / distances
                + weights.velocity * c.twist.v_m_per_s / speeds
        };
        candidates.iter().max_by(|a, b| score(a).total_cmp(&score(b))).map(|c| c.twist)
    }

    /// The range of speeds that the drives can reach within a tick. A robot above its limit brakes as hard as it can.
    fn speeds(&self, now: Twist, pace: Pace) -> (f64, f64) {
        let change = self.acceleration_m_per_s2 * self.dt_s;
        let low = (now.v_m_per_s - change).max(0.0);
        // Above this speed, the robot could not stop within the checked distance.
        let most = pace.v_max_m_per_s.min(self.acceleration_m_per_s2 * HORIZON_S);
        (low, (now.v_m_per_s + change).min(most).max(low))
    }

    fn turns(&self, now: Twist, pace: Pace) -> (f64, f64) {
        let change = self.turn_acceleration_rad_per_s2 * self.dt_s;
        let most = pace.w_max_rad_per_s;
        let low = (now.w_rad_per_s - change).max(-most).min(now.w_rad_per_s + change);
        (low, (now.w_rad_per_s + change).min(most).max(low))
    }
}

/// Brakes, and turns slowly towards the reference.
fn turned_on_the_spot(
    pose: &Pose,
    speeds: (f64, f64),
    turns: (f64, f64),
    pace: Pace,
    reference: Vector,
) -> Twist {
    let side = pose.direction().perp(&reference);
    let wanted = TURN_SHARE * pace.w_max_rad_per_s * if side >= 0.0 { 1.0 } else { -1.0 };
    Twist { v_m_per_s: speeds.0, w_rad_per_s: wanted.clamp(turns.0, turns.1) }
}

/// Evenly spaced numbers from the first to the last.
fn spread<const N: usize>((low, high): (f64, f64)) -> [f64; N] {
    std::array::from_fn(|k| low + (high - low) * k as f64 / (N - 1) as f64)
}

/// Offsets of the points on an arc per metre per second of speed.
fn arc_per_speed(pose: &Pose, w_rad_per_s: f64) -> [Vector; N_PLACES] {
    let mut offset = Vector::zeros();
    std::array::from_fn(|k| {
        let middle_rad = pose.heading_rad + w_rad_per_s * STEP_S * (k as f64 + 0.5);
        offset += Vector::new(middle_rad.cos(), middle_rad.sin()) * STEP_S;
        offset
    })
}

/// The pose of a robot after one tick of a twist.
pub fn moved(pose: &Pose, twist: Twist, dt_s: f64) -> Pose {
    pose.moved(twist.v_m_per_s * dt_s, 0.0, twist.w_rad_per_s * dt_s)
}

/// The points of an arc, for drawing.
pub fn arc(pose: &Pose, twist: Twist) -> Vec<Point> {
    let offsets = arc_per_speed(pose, twist.w_rad_per_s);
    std::iter::once(pose.position).chain(offsets.map(|o| pose.position + o * twist.v_m_per_s)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::near::Disc;
    use proptest::prelude::*;

    const WINDOW: Window = Window {
        acceleration_m_per_s2: 0.1,
        turn_acceleration_rad_per_s2: 0.4,
        weights: Weights { heading: 0.2, distance: 0.1, velocity: 0.1 },
        keep_m: 0.3,
        dt_s: 0.1,
    };
    const WATER: Pace = Pace { v_max_m_per_s: 0.23, w_max_rad_per_s: 0.31 };

    fn discs(discs: &[(f64, f64, f64)]) -> NearThings {
        let disc = |&(x, y, radius_m): &(f64, f64, f64)| Disc { center: Point::new(x, y), radius_m };
        NearThings { discs: discs.iter().map(disc).collect(), ..NearThings::default() }
    }

    fn run(near: &NearThings, reference: Vector, ticks: usize) -> Vec<(Pose, Twist)> {
        let (mut pose, mut twist) = (Pose::new(0.0, 0.0, 0.0), Twist::default());
        (0..ticks)
            .map(|_| {
                twist = WINDOW.choose(&pose, twist, WATER, reference, near);
                pose = moved(&pose, twist, 0.1);
                (pose, twist)
            })
            .collect()
    }

    #[test]
    fn on_a_free_floor_it_turns_into_the_reference_at_full_speed() {
        let (pose, twist) = run(&discs(&[]), Vector::new(1.0, 1.0), 150)[149];
        assert!((pose.heading_rad - std::f64::consts::FRAC_PI_4).abs() < 0.05);
        assert!((twist.v_m_per_s - 0.23).abs() < 1e-9);
    }

    #[test]
    fn it_never_comes_nearer_than_it_keeps() {
        let near = discs(&[(1.5, 0.05, 0.4), (2.5, 0.9, 0.4)]);
        for (pose, _) in run(&near, Vector::x(), 400) {
            assert!(near.distance_m(&[pose.position], 9.0) >= 0.3 - 1e-6);
        }
    }

    proptest! {
        #[test]
        fn whatever_the_hull_and_the_clearance_it_keeps_them(
            radius_m in 0.2..2.0_f64, clearance_m in 0.0..1.5_f64, x in 0.3..2.0_f64, y in -1.0..1.0_f64,
        ) {
            let window = Window { keep_m: radius_m + clearance_m, ..WINDOW };
            let near = discs(&[(radius_m + clearance_m + 0.4 + x, y, 0.4)]);
            let (mut pose, mut twist) = (Pose::new(0.0, 0.0, 0.0), Twist::default());
            for _ in 0..300 {
                twist = window.choose(&pose, twist, WATER, Vector::x(), &near);
                pose = moved(&pose, twist, 0.1);
                let least_m = near.distance_m(&[pose.position], 99.0);
                prop_assert!(least_m >= radius_m + clearance_m - 1e-3, "{least_m}");
            }
        }
    }

    #[test]
    fn above_a_limit_that_fell_it_brakes_as_hard_as_it_can() {
        let land = Pace { v_max_m_per_s: 0.13, w_max_rad_per_s: 0.12 };
        let now = Twist { v_m_per_s: 0.23, w_rad_per_s: 0.0 };
        let twist = WINDOW.choose(&Pose::new(0.0, 0.0, 0.0), now, land, Vector::x(), &discs(&[]));
        assert!((twist.v_m_per_s - 0.22).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn a_twist_is_within_reach_of_the_last_and_within_the_limits(
            v in 0.0..0.23_f64, w in -0.31..0.31_f64, toward in 0.0..6.3_f64,
            things in prop::collection::vec((-2.0..2.0_f64, -2.0..2.0_f64, 0.0..0.6_f64), 0..6),
        ) {
            let now = Twist { v_m_per_s: v, w_rad_per_s: w };
            let reference = Vector::new(toward.cos(), toward.sin());
            let next = WINDOW.choose(&Pose::new(0.0, 0.0, 0.0), now, WATER, reference, &discs(&things));
            prop_assert!((next.v_m_per_s - v).abs() <= 0.01 + 1e-9 && (next.w_rad_per_s - w).abs() <= 0.04 + 1e-9);
            prop_assert!((0.0..=0.23 + 1e-9).contains(&next.v_m_per_s) && next.w_rad_per_s.abs() <= 0.31 + 1e-9);
        }
    }
}
