//! The final check of every velocity: the hull never moves towards anything that is already as close as allowed.

use crate::contact::Contact;
use geometry::{Braking, Vector};

/// Shortest time in which the hull may use up its distance to a solid, seconds: several ticks, so that it stops before
/// contact. A robot that needs longer to stop is driven more slowly.
const BRAKING_S: f64 = 0.5;
/// Maximum speed at which the guard moves the robot away from something too close, as a share of the robot's maximum
/// speed.
const RETREAT_SHARE: f64 = 0.4;

/// The velocities `v` with `away . v >= least`.
#[derive(Debug, Clone, Copy)]
struct HalfPlane {
    away: Vector,
    least: f64,
}

/// The maximum speed towards a solid with this much distance left, metres per second; negative if the distance is
/// already too small.
fn fastest_toward(room_m: f64, braking: &Braking) -> f64 {
    let used_up = room_m / BRAKING_S;
    if room_m > 0.0 { used_up.min(braking.speed_within(room_m)) } else { used_up }
}

/// Returns the velocity closest to `wanted` that keeps a distance `keep_m` from every contact.
///
/// Towards a contact at distance `d`, the speed is limited to `(d - keep_m) / 0.5 s` and to the speed from which the
/// robot can stop within `d - keep_m`. The robot therefore slides along an obstacle instead of running into it. If it
/// is closer than `keep_m`, it is driven away. Where that is impossible, as in a gap too narrow for the distance on
/// both sides, it may move along the gap but not across.
pub fn slide(wanted: Vector, contacts: &[Contact], keep_m: f64, v_max: f64, braking: &Braking) -> Vector {
    let planes: Vec<HalfPlane> = contacts
        .iter()
        .map(|c| HalfPlane {
            away: c.away,
            least: (-fastest_toward(c.distance_m - keep_m, braking)).min(RETREAT_SHARE * v_max),
        })
        .filter(|plane| plane.least > -v_max)
        .collect();
    let relaxed: Vec<HalfPlane> =
        planes.iter().map(|plane| HalfPlane { least: plane.least.min(0.0), ..*plane }).collect();
    let safe = nearest_within(wanted, &planes).or_else(|| nearest_within(wanted, &relaxed));
    safe.unwrap_or_else(Vector::zeros).cap_magnitude(v_max)
}

/// Returns the velocity, slowed down so that a robot that must first turn into this direction stays clear while it
/// turns.
pub fn braked(
    velocity: Vector,
    heading: Vector,
    contacts: &[Contact],
    keep_m: f64,
    braking: &Braking,
) -> Vector {
    let speed = velocity.norm();
    let allowed = contacts.iter().fold(speed, |allowed, contact| {
        let closing = -contact.away.dot(&heading);
        let room_m = (contact.distance_m - keep_m).max(0.0);
        if closing > 0.05 { allowed.min(fastest_toward(room_m, braking) / closing) } else { allowed }
    });
    // The robot is never fully stopped, because it must turn into the direction of the command.
    let share = if speed > 0.0 { (allowed / speed).max(0.02) } else { 0.0 };
    velocity * share
}

/// The point in an intersection of half planes that is closest to `wanted`, if the intersection is not empty.
fn nearest_within(wanted: Vector, planes: &[HalfPlane]) -> Option<Vector> {
    let is_allowed = |v: &Vector| planes.iter().all(|p| p.away.dot(v) >= p.least - 1e-9);
    if is_allowed(&wanted) {
        return Some(wanted);
    }
    let onto_edges = planes.iter().map(|p| wanted + p.away * (p.least - p.away.dot(&wanted)));
    let corners = planes.iter().enumerate().flat_map(|(i, p)| {
        planes[i + 1..].iter().filter_map(move |q| {
            let turn = p.away.perp(&q.away);
            let corner =
                Vector::new(p.least * q.away.y - q.least * p.away.y, q.least * p.away.x - p.least * q.away.x);
            (turn.abs() > 1e-9).then(|| corner / turn)
        })
    });
    onto_edges
        .chain(corners)
        .filter(is_allowed)
        .min_by(|a, b| (a - wanted).norm_squared().total_cmp(&(b - wanted).norm_squared()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Source;
    use proptest::prelude::*;

    /// The limits of a robot that stops almost at once.
    const QUICK: Braking = Braking { acceleration_m_per_s2: 1e3, tick_s: 0.1 };

    fn contact(bearing_rad: f64, distance_m: f64) -> Contact {
        let away = -Vector::new(bearing_rad.cos(), bearing_rad.sin());
        Contact { source: Source::Wall, distance_m, away }
    }

    #[test]
    fn it_slides_along_what_is_ahead() {
        let safe = slide(Vector::new(0.3, 0.1), &[contact(0.0, 0.1)], 0.1, 0.4, &QUICK);
        assert!((safe - Vector::new(0.0, 0.1)).norm() < 1e-9);
    }

    #[test]
    fn it_backs_out_of_what_is_too_near() {
        let safe = slide(Vector::new(0.3, 0.0), &[contact(0.0, 0.05)], 0.1, 0.4, &QUICK);
        assert!(safe.x < -0.05);
    }

    #[test]
    fn in_a_narrow_gap_it_moves_along_but_not_across() {
        let sides = [contact(0.0, 0.05), contact(std::f64::consts::PI, 0.05)];
        let safe = slide(Vector::new(0.3, 0.2), &sides, 0.1, 0.4, &QUICK);
        assert!((safe - Vector::new(0.0, 0.2)).norm() < 1e-9);
    }

    #[test]
    fn a_robot_that_heads_into_a_column_creeps_until_it_has_turned() {
        let velocity = Vector::new(0.0, 0.4);
        let toward = braked(velocity, Vector::x(), &[contact(0.0, 0.1)], 0.1, &QUICK);
        let along = braked(velocity, Vector::y(), &[contact(0.0, 0.1)], 0.1, &QUICK);
        assert!(toward.norm() < 0.01 && toward.norm() > 0.0);
        assert!((along - velocity).norm() < 1e-12);
    }

    #[test]
    fn a_robot_that_stops_slowly_approaches_slowly() {
        let lazy = Braking { acceleration_m_per_s2: 0.1, tick_s: 0.1 };
        let safe = slide(Vector::new(0.4, 0.0), &[contact(0.0, 0.3)], 0.1, 0.4, &lazy);
        assert!((safe.x - lazy.speed_within(0.2)).abs() < 1e-9 && safe.x < 0.2);
    }

    proptest! {
        #[test]
        fn no_allowed_velocity_approaches_what_is_too_near(
            wanted in (-0.5..0.5_f64, -0.5..0.5_f64),
            around in prop::collection::vec((0.0..6.3_f64, -0.2..0.5_f64), 0..7),
        ) {
            let contacts: Vec<Contact> = around.iter().map(|(b, d)| contact(*b, *d)).collect();
            let safe = slide(Vector::new(wanted.0, wanted.1), &contacts, 0.1, 0.4, &QUICK);
            prop_assert!(safe.norm() <= 0.4 + 1e-9);
            for c in &contacts {
                let allowed = ((c.distance_m - 0.1) / BRAKING_S).max(0.0);
                prop_assert!(-c.away.dot(&safe) <= allowed + 1e-6);
            }
        }
    }
}
