//! Evading moving obstacles.
//!
//! In every tick, a set of velocities is simulated, including the turn that the robot needs to follow each one. Moving
//! obstacles are assumed to keep their observed velocities. Of the velocities that stay clear, the one closest to the
//! desired velocity is taken. A little more distance is preferred, because moving obstacles may turn. The method
//! follows the velocity obstacles of Fiorini and Shiller 1998 and the dynamic window of Fox et al. 1997.

use crate::body::Body;
use geometry::{
    Boundary, Drive, Limits, Point, Vector,
    motion::{TURN_FIRST_RAD, drive_for, heading_error_rad},
};
use planner_api::{Ctx, Layer, Obstacle, PoseEstimate, Sensed, Site};

/// Speed below which an obstacle is treated as stationary, metres per second.
const STILL_M_PER_S: f64 = 0.02;
/// Time for which the motion of obstacles is predicted, seconds, in steps of [`STEP_S`].
const HORIZON_S: f64 = 5.0;
const STEP_S: f64 = 0.2;
/// Time for which stationary obstacles are checked, seconds. Beyond that, the desired velocity avoids them.
const STANDING_S: f64 = 1.6;
/// Number of headings tried, and the speeds tried as shares of the maximum.
const HEADINGS: u32 = 24;
const SHARES: [f64; 3] = [1.0, 0.6, 0.3];
/// Distances from a moving obstacle in addition to the clearance, metres: one that is kept if possible, and a larger
/// one that is preferred.
const ROOM_M: f64 = 0.1;
const LIKED_M: f64 = 0.8;
/// Growth rate of the uncertainty of a moving obstacle's predicted position, metres per second.
const DOUBT_M_PER_S: f64 = 0.04;
/// Cost of each metre by which the preferred distance is missed, expressed as deviation from the desired velocity,
/// metres per second.
const WORTH_PER_S: f64 = 0.25;

/// Whether an obstacle moves.
pub fn moves(obstacle: &Obstacle<'_>) -> bool {
    obstacle.velocity_m_per_s.norm() > STILL_M_PER_S
}

/// The stationary obstacles of a site. Moving ones will be elsewhere when the robot arrives.
pub fn standing<'a>(site: &Site<'a>) -> Vec<Obstacle<'a>> {
    site.obstacles.iter().filter(|o| !moves(o)).copied().collect()
}

/// A moving obstacle.
#[derive(Debug, Clone)]
pub struct Mover {
    /// The obstacle at its current position.
    pub body: Body,
    /// Its velocity, metres per second.
    pub velocity: Vector,
}

impl Mover {
    /// Draws the predicted motion of the obstacle.
    pub fn show(&self, ctx: &Ctx<'_>) {
        ctx.arrow(Layer::Virtual, self.body.center(), self.velocity);
    }
}

/// Splits bodies into those to evade and those to treat as stationary. Without evasion, all are treated as stationary.
pub fn sorted_if(evades: bool, sensed: &Sensed<'_>, bodies: Vec<Body>) -> (Vec<Mover>, Vec<Body>) {
    if evades { sorted(sensed, bodies) } else { (Vec::new(), bodies) }
}

/// Splits the sensed obstacles into moving and stationary ones. `bodies` contains the sensed bodies and other
/// stationary ones.
pub fn sorted(sensed: &Sensed<'_>, bodies: Vec<Body>) -> (Vec<Mover>, Vec<Body>) {
    let mut movers = Vec::new();
    let mut standing = Vec::new();
    for body in bodies {
        match sensed.obstacles.iter().find(|o| o.id == body.id && moves(o)) {
            Some(obstacle) => movers.push(Mover { body, velocity: obstacle.velocity_m_per_s }),
            None => standing.push(body),
        }
    }
    (movers, standing)
}

/// Everything that a robot must keep clear of.
#[derive(Debug, Clone, Copy)]
pub struct Around<'a> {
    /// The moving obstacles.
    pub movers: &'a [Mover],
    /// The stationary bodies.
    pub standing: &'a [Body],
    /// The wall.
    pub wall: &'a Boundary,
    /// Motion limits of the robot.
    pub limits: &'a Limits,
    /// Distance to keep between the hull and anything else, metres.
    pub clearance_m: f64,
}

/// The predicted outcome of a velocity.
#[derive(Debug, Clone, Copy)]
struct Outlook {
    /// Time until the robot comes too close to something, seconds; the horizon if it does not.
    until_s: f64,
    /// The smallest distance between the hull and a moving obstacle, metres.
    room_m: f64,
}

/// Returns the velocity to use instead of the desired one, in the tank frame, metres per second.
pub fn evade(wish: Vector, pose: &PoseEstimate, around: &Around<'_>) -> Vector {
    let v_max = around.limits.v_max_m_per_s;
    let headings = (0..HEADINGS).map(|k| std::f64::consts::TAU * f64::from(k) / f64::from(HEADINGS));
    let grid =
        headings.flat_map(|rad| SHARES.map(|share| Vector::new(rad.cos(), rad.sin()) * (v_max * share)));
    let slower = [1.0, 0.5].map(|share| wish * share);
    let all = slower.into_iter().chain([Vector::zeros()]).chain(grid);
    let outlooks: Vec<(Vector, Outlook)> =
        all.map(|velocity| (velocity, outlook(velocity, pose, around))).collect();
    let cost = |(velocity, outlook): &(Vector, Outlook)| {
        let missing_m = (LIKED_M - outlook.room_m).max(0.0);
        (velocity - wish).norm() + WORTH_PER_S * missing_m * v_max.max(0.1) / 0.4
    };
    let clear = outlooks.iter().filter(|(_, outlook)| outlook.until_s >= HORIZON_S);
    let best = clear.min_by(|a, b| cost(a).total_cmp(&cost(b)));
    let last = || {
        let later =
            |a: &Outlook, b: &Outlook| a.until_s.total_cmp(&b.until_s).then(a.room_m.total_cmp(&b.room_m));
        outlooks.iter().max_by(|a, b| later(&a.1, &b.1))
    };
    best.or_else(last).map_or(wish, |(velocity, _)| *velocity)
}

/// Simulates a velocity.
fn outlook(velocity: Vector, pose: &PoseEstimate, around: &Around<'_>) -> Outlook {
    let hull_m = around.limits.radius_m;
    let (mut at, mut heading_rad) = (pose.position, pose.heading_rad);
    let standing_m = |at: Point| {
        let bodies = around.standing.iter().map(|body| body.hull_distance_m(at, hull_m));
        bodies.fold(around.wall.wall_distance_m(at) - hull_m, f64::min)
    };
    // If the robot is already too close to a stationary obstacle, it must at least not move closer.
    let keep_m = around.clearance_m.min(standing_m(at) - 1e-6);
    let mut room_m = f64::INFINITY;
    let n_steps = (HORIZON_S / STEP_S).round() as u32;
    for step in 1..=n_steps {
        let t_s = f64::from(step) * STEP_S;
        (at, heading_rad) = moved(at, heading_rad, velocity, around.limits);
        let to_mover = |mover: &Mover| {
            mover.body.hull_distance_m(at - mover.velocity * t_s, hull_m) - DOUBT_M_PER_S * t_s
        };
        room_m = around.movers.iter().map(to_mover).fold(room_m, f64::min);
        if room_m < around.clearance_m + ROOM_M || (t_s <= STANDING_S && standing_m(at) < keep_m) {
            return Outlook { until_s: t_s, room_m };
        }
    }
    Outlook { until_s: HORIZON_S, room_m }
}

/// Position and heading one step later, according to the console's rule for turning a robot towards a velocity.
fn moved(at: Point, heading_rad: f64, velocity: Vector, limits: &Limits) -> (Point, f64) {
    match drive_for(Drive::Velocity(velocity), heading_rad, limits, TURN_FIRST_RAD) {
        Drive::Velocity(velocity) => (at + velocity * STEP_S, heading_rad),
        Drive::Twist { v_m_per_s, w_rad_per_s } => {
            // A step is long, so the turn is limited to the heading error.
            let error_rad = heading_error_rad(velocity, heading_rad);
            let turn_rad = (w_rad_per_s * STEP_S).clamp(-error_rad.abs(), error_rad.abs());
            let middle_rad = heading_rad + turn_rad / 2.0;
            let direction = Vector::new(middle_rad.cos(), middle_rad.sin());
            (at + direction * (v_m_per_s * STEP_S), heading_rad + turn_rad)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{Motion, wrap_angle_rad};
    use planner_api::Outline;

    const LIMITS: Limits = Limits {
        motion: Motion::Unicycle,
        v_max_m_per_s: 0.4,
        w_max_rad_per_s: 1.0,
        radius_m: 0.25,
        sensing_range_m: 3.0,
        acceleration_m_per_s2: 0.5,
        tick_s: 0.1,
        amphibious: None,
    };

    fn exact_pose(position: Point) -> PoseEstimate {
        PoseEstimate { position, heading_rad: 0.0, covariance: nalgebra::Matrix3::zeros() }
    }

    fn disc(at: Point, radius_m: f64) -> Body {
        Body::new(1, &Outline::Disc { center: at, radius_m }).unwrap()
    }

    /// Flies to the east among movers that start within sight; returns the smallest distance to them and the final
    /// position.
    fn flown(movers: &[(Point, Vector)], limits: Limits) -> (f64, Point) {
        let mut pose = exact_pose(Point::origin());
        let mut least_m = f64::INFINITY;
        for tick in 0..250 {
            let t_s = f64::from(tick) * 0.1;
            let now: Vec<Mover> = movers
                .iter()
                .map(|(at, velocity)| Mover { body: disc(at + velocity * t_s, 0.4), velocity: *velocity })
                .filter(|mover| mover.body.hull_distance_m(pose.position, 0.0) < 3.0)
                .collect();
            let around = Around {
                movers: &now,
                standing: &[],
                wall: &Boundary::Circle { radius_m: 20.0 },
                limits: &limits,
                clearance_m: 0.1,
            };
            let wish = Vector::new(0.4, 0.0);
            let velocity = if now.is_empty() { wish } else { evade(wish, &pose, &around) };
            let half = moved(pose.position, pose.heading_rad, velocity, &limits);
            // A tick is half a step long.
            pose.position = nalgebra::center(&pose.position, &half.0);
            pose.heading_rad += wrap_angle_rad(half.1 - pose.heading_rad) / 2.0;
            let to =
                movers.iter().map(|(at, v)| (pose.position - (at + v * (t_s + 0.1))).norm() - 0.4 - 0.25);
            least_m = to.fold(least_m, f64::min);
        }
        (least_m, pose.position)
    }

    #[test]
    fn it_lets_pass_what_comes_from_anywhere_as_fast_as_itself() {
        for limits in [LIMITS, Limits { motion: Motion::Point, ..LIMITS }] {
            for k in 0..24 {
                let bearing = std::f64::consts::TAU * f64::from(k) / 24.0;
                let towards = Vector::new(bearing.cos(), bearing.sin());
                // On its straight path, the robot would meet the mover after ten seconds.
                let meeting = Point::new(4.0, 0.0);
                let (least_m, end) = flown(&[(meeting - towards * 4.0, towards * 0.4)], limits);
                if (meeting - towards * 4.0).coords.norm() > 1.5 {
                    assert!(least_m > 0.0, "{k} {:?} {least_m}", limits.motion);
                    assert!(end.x > 4.0, "{k} {:?} ends at {end}", limits.motion);
                }
            }
        }
    }

    #[test]
    fn without_danger_the_wish_is_done() {
        let mover = Mover { body: disc(Point::new(0.0, 2.5), 0.3), velocity: Vector::new(0.0, 0.3) };
        let around = Around {
            movers: &[mover],
            standing: &[],
            wall: &Boundary::Circle { radius_m: 20.0 },
            limits: &LIMITS,
            clearance_m: 0.1,
        };
        let wish = Vector::new(0.4, 0.0);
        assert!((evade(wish, &exact_pose(Point::origin()), &around) - wish).norm() < 1e-12);
    }
}
