//! The time that a path takes: at full speed where the robot can brake in time, more slowly near solid objects and
//! before turns, with stops to turn at corners.

use mission::MissionConfig;
use world::{ObstacleMap, Point, Vector, geometry::Braking, polyline};

/// Distance between the places at which the speed is computed, metres.
const STEP_M: f64 = 0.1;
/// Corner angle, radians, above which the robot stops to turn; below it, the robot turns while driving.
pub(super) const CORNER_RAD: f64 = 0.5;
/// Clearance that a robot keeps when braking straight ahead: this share of the space beside its hull, at most
/// `ROOM_MOST_M` metres.
const ROOM_SHARE: f64 = 0.5;
const ROOM_MOST_M: f64 = 0.1;
/// Minimum step for checking the path straight ahead, metres.
const LOOK_M: f64 = 0.02;

/// Time to drive a path in a tank as drawn, from standstill to standstill, seconds.
pub fn time_s(mission: &MissionConfig, map: &ObstacleMap, path: &[Point]) -> f64 {
    let limits = &mission.limits;
    let mut time_s = 0.0;
    for (stretch, turn_rad) in stretches(path) {
        time_s += straight_s(mission, map, &stretch);
        // The turn begins with the tick after the robot has stopped.
        time_s += turn_rad.map_or(0.0, |rad| rad / limits.w_max_rad_per_s + limits.tick_s);
    }
    time_s
}

/// The stretches of a path between its corners, each with the turn at its end, radians, if the end is a corner.
fn stretches(path: &[Point]) -> Vec<(Vec<Point>, Option<f64>)> {
    let mut all = Vec::new();
    let mut stretch: Vec<Point> = Vec::new();
    let mut before: Option<Vector> = None;
    for point in path {
        let Some(last) = stretch.last().copied() else {
            stretch.push(*point);
            continue;
        };
        let way = point - last;
        if way.norm() <= 1e-9 {
            continue;
        }
        let turn_rad = before.map_or(0.0, |before| before.angle(&way));
        if turn_rad > CORNER_RAD {
            all.push((std::mem::replace(&mut stretch, vec![last]), Some(turn_rad)));
        }
        stretch.push(*point);
        before = Some(way);
    }
    all.push((stretch, None));
    all
}

/// Time to drive a stretch without corners from standstill to standstill, seconds.
fn straight_s(mission: &MissionConfig, map: &ObstacleMap, stretch: &[Point]) -> f64 {
    let places = polyline::resampled(stretch, STEP_M);
    let ways: Vec<Vector> =
        places.windows(2).map(|pair| pair[1] - pair[0]).filter(|way| way.norm() > 1e-9).collect();
    if ways.is_empty() {
        return 0.0;
    }
    let squares = squared_speeds(mission, map, &places, &ways);
    let pairs = squares.windows(2).map(|pair| f64::midpoint(pair[0].sqrt(), pair[1].sqrt()));
    let slowest = (mission.limits.acceleration_m_per_s2 * STEP_M).sqrt() / 2.0;
    ways.iter()
        .zip(pairs)
        .map(|(way, speed)| way.norm() / speed.max(slowest.min(mission.limits.v_max_m_per_s)))
        .sum()
}

/// The squared speeds along a stretch: within the limit at each place, and within the robot's acceleration and
/// braking.
fn squared_speeds(mission: &MissionConfig, map: &ObstacleMap, places: &[Point], ways: &[Vector]) -> Vec<f64> {
    let limits = &mission.limits;
    let n = ways.len();
    let mut squares = vec![0.0; n + 1];
    for k in 1..n {
        let turn_rad = ways[k - 1].angle(&ways[k]);
        let bend = limits.w_max_rad_per_s * ways[k].norm() / turn_rad.max(1e-9);
        let speed = bend.min(free_speed(mission, map, places[k], ways[k].normalize()));
        squares[k] = speed * speed;
    }
    let gain = |way: &Vector| 2.0 * limits.acceleration_m_per_s2 * way.norm();
    for k in 1..=n {
        squares[k] = squares[k].min(squares[k - 1] + gain(&ways[k - 1]));
    }
    for k in (0..n).rev() {
        squares[k] = squares[k].min(squares[k + 1] + gain(&ways[k]));
    }
    squares
}

/// The highest speed at a place, metres per second, from which the robot can stop straight ahead within its sensing
/// range and before it touches a drawn object.
fn free_speed(mission: &MissionConfig, map: &ObstacleMap, at: Point, ahead: Vector) -> f64 {
    let limits = &mission.limits;
    let braking = Braking::of(limits);
    let fastest = limits.v_max_m_per_s.min(braking.speed_within(limits.sensing_range_m));
    let needed_m = braking.distance_m(fastest);
    let room_m = map.clearance_m(at) - limits.radius_m;
    let keep_m = limits.radius_m + (ROOM_SHARE * room_m).clamp(0.0, ROOM_MOST_M);
    let mut free_m = 0.0;
    while free_m < needed_m {
        let spare_m = map.clearance_m(at + ahead * free_m) - keep_m;
        if spare_m < 0.0 {
            return braking.speed_within(free_m).min(fastest);
        }
        free_m += spare_m.max(LOOK_M);
    }
    fastest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::tests::{drawing, mission};

    fn time_of(mission: &MissionConfig, path: &[(f64, f64)]) -> f64 {
        let drawing = drawing();
        let map = ObstacleMap::new(&drawing.boundary, &drawing.obstacles);
        let path: Vec<Point> = path.iter().map(|(x, y)| Point::new(*x, *y)).collect();
        time_s(mission, &map, &path)
    }

    fn with_acceleration(acceleration_m_per_s2: f64) -> MissionConfig {
        let mut mission = mission();
        mission.limits.acceleration_m_per_s2 = acceleration_m_per_s2;
        mission
    }

    #[test]
    fn a_straight_way_takes_as_long_as_gaining_and_losing_speed() {
        // To 0.5 m/s and back to rest: 5 m at full speed and 1 s more; 0.4 m without reaching it.
        assert!((time_of(&with_acceleration(0.5), &[(-5.0, 0.0), (0.0, 0.0)]) - 11.0).abs() < 0.05);
        let short_s = 2.0 * (0.2_f64 / 0.25).sqrt();
        assert!((time_of(&with_acceleration(0.5), &[(-5.0, 0.0), (-4.6, 0.0)]) - short_s).abs() < 0.05);
    }

    #[test]
    fn a_robot_that_brakes_slowly_takes_longer() {
        let path = [(-5.0, 0.0), (2.5, 0.0), (2.5, 5.0), (-2.0, 5.0)];
        let (quick, lazy) =
            (time_of(&with_acceleration(1.0), &path), time_of(&with_acceleration(0.1), &path));
        assert!(lazy > quick + 10.0, "{quick} {lazy}");
    }

    #[test]
    fn beside_a_wall_it_is_as_fast_as_it_can_stop_straight_on() {
        let ring = |radius_m: f64| -> Vec<(f64, f64)> {
            (0..=200)
                .map(|k| (f64::from(k) * 0.0314).sin_cos())
                .map(|(s, c)| (radius_m * c, radius_m * s))
                .collect()
        };
        let mission = with_acceleration(0.05);
        let length_m = |radius_m: f64| std::f64::consts::TAU * radius_m;
        let wide = time_of(&mission, &ring(9.6)) / length_m(9.6);
        let inner = time_of(&mission, &ring(7.0)) / length_m(7.0);
        assert!(wide > 1.2 * inner, "{wide} {inner} s/m");
    }
}
