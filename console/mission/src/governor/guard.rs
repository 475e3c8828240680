//! Braking by the raw scan, whatever the chart says: the robot must be able to stop before it touches any scanned
//! point.
//!
//! Until the robot stands still, its centre stays within a sector of its present surroundings: it travels at most the
//! stopping distance, in directions between its heading now and its heading at the standstill. The hull could touch a
//! scanned point that is closer to this sector than the hull's radius. Between two scans, the points are moved by the
//! robot's odometry.

use super::{HALVINGS, Here, Momentum, ROOM_SHARE, TOUCH_M};
use geometry::{Drive, Motion, Point};
use std::f64::consts::{FRAC_PI_2, PI};

/// Clearance to keep from scanned points, metres: more than the noise of usual scanners.
const SCAN_ROOM_M: f64 = 0.03;

/// A scanned point in the robot frame.
#[derive(Debug, Clone, Copy)]
struct Echo {
    distance_m: f64,
    direction_rad: f64,
}

impl Echo {
    /// Whether the point is at the robot's centre: a range of 0 is nearer than the sensor can measure, so the place of
    /// the point is unknown and every motion could lead to it.
    fn is_unresolved(&self) -> bool {
        self.distance_m <= TOUCH_M
    }
}

/// The places that the centre of the robot can reach until it stands still: within a distance of its present position,
/// and in directions within `spread_rad` on both sides of a middle direction; robot frame.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sector {
    way_m: f64,
    middle_rad: f64,
    spread_rad: f64,
}

impl Sector {
    /// The smallest sector that contains the direction `from_rad` and the directions at these angles from it.
    fn around(way_m: f64, from_rad: f64, angles: &[f64]) -> Self {
        let low = angles.iter().copied().fold(0.0, f64::min);
        let high = angles.iter().copied().fold(0.0, f64::max);
        let spread_rad = 0.5 * (high - low);
        // Motions in directions that span half a turn or more can add up to a motion in any direction.
        let spread_rad = if spread_rad < FRAC_PI_2 { spread_rad } else { PI };
        Self { way_m, middle_rad: from_rad + 0.5 * (low + high), spread_rad }
    }

    /// Distance of a point from the sector, metres.
    fn distance_m(&self, echo: &Echo) -> f64 {
        let aside = (echo.direction_rad - self.middle_rad + PI).rem_euclid(2.0 * PI) - PI;
        let beyond = aside.abs() - self.spread_rad;
        if beyond <= 0.0 {
            return (echo.distance_m - self.way_m).max(0.0);
        }
        if beyond >= FRAC_PI_2 {
            return echo.distance_m;
        }
        let (sin, cos) = beyond.sin_cos();
        let (along, across) = (echo.distance_m * cos, echo.distance_m * sin);
        if along <= self.way_m { across } else { across.hypot(along - self.way_m) }
    }
}

/// A command after the guard has checked it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Guarded {
    /// The command that is safe.
    pub drive: Drive,
    /// The nearest point that the command could have touched: its distance from the hull, metres, and its direction in
    /// the robot frame, radians; `None` if the command is unchanged.
    pub before: Option<(f64, f64)>,
    /// Whether the hull can touch a point although the robot brakes.
    pub is_late: bool,
}

/// A tick of motion that was sent and that the vehicle may still have to carry out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sent {
    momentum: Momentum,
    turn_rad: f64,
}

impl Sent {
    /// The motion of a robot that is sent a drive.
    pub(crate) fn of(momentum: &Momentum, drive: Drive, here: &Here) -> Self {
        let motions = momentum.motions(drive, here);
        Self { momentum: motions.after, turn_rad: motions.turn_rad }
    }
}

/// The scanned points near a robot, and how it brakes.
pub(crate) struct Guard<'a> {
    echoes: Vec<Echo>,
    /// The points of the scans before the last one. They count only on the course of the robot: the noise of a single scan
    /// must not release a robot that stands close to something.
    earlier: Vec<Echo>,
    here: &'a Here,
    /// The motion before a command that is sent now takes effect, oldest first.
    sent: &'a [Sent],
}

impl<'a> Guard<'a> {
    /// Creates the guard for one tick. `sent` is the motion of earlier ticks that the vehicle may still have to carry
    /// out.
    pub(crate) fn new(points: &[Point], here: &'a Here, sent: &'a [Sent]) -> Self {
        Self { echoes: echoes(points), earlier: Vec::new(), here, sent }
    }

    /// The same guard, with the points of earlier scans in the robot frame now.
    pub(crate) fn remembering<'p>(self, scans: impl Iterator<Item = &'p [Point]>) -> Self {
        Self { earlier: scans.flat_map(echoes).collect(), ..self }
    }

    /// Limits a command so that the robot can stop in time.
    pub(crate) fn guarded(&self, momentum: &Momentum, drive: Drive) -> Guarded {
        let Some(before) = self.in_the_way(momentum, drive) else {
            return Guarded { drive, before: None, is_late: false };
        };
        let is_safe = |drive| self.in_the_way(momentum, drive).is_none();
        let slower = |share| momentum.slower(drive, share, self.here);
        if !is_safe(slower(0.0)) {
            let is_late = self.touches(momentum);
            return Guarded { drive: Drive::STILL, before: Some(before), is_late };
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if is_safe(slower(middle)) {
                low = middle;
            } else {
                high = middle;
            }
        }
        Guarded { drive: slower(low), before: Some(before), is_late: false }
    }

    /// The nearest point that a robot could come too close to if it follows a command for one tick and then brakes.
    fn in_the_way(&self, momentum: &Momentum, drive: Drive) -> Option<(f64, f64)> {
        let hull_m = self.here.limits.radius_m;
        // A hull that passes beside a point is allowed to come closer to it than one that drives towards it: a robot
        // along a wall must not be stopped by the wall.
        let kept_m = |room_m: f64, is_on_course: bool| match room_m {
            _ if is_on_course && room_m > 0.0 => SCAN_ROOM_M,
            _ if room_m > 0.0 => SCAN_ROOM_M.min(ROOM_SHARE * room_m),
            _ => room_m - TOUCH_M,
        };
        let is_on_course =
            |echo: &Echo, sector: &Sector| Sector { way_m: f64::MAX, ..*sector }.distance_m(echo) < hull_m;
        let needed_m = |echo: &Echo, sector: &Sector| {
            if echo.is_unresolved() {
                return hull_m;
            }
            hull_m + kept_m(echo.distance_m - hull_m, is_on_course(echo, sector))
        };
        let remembered_m = |echo: &Echo, sector: &Sector| {
            let counts = !echo.is_unresolved() && is_on_course(echo, sector);
            if counts { needed_m(echo, sector) } else { 0.0 }
        };
        let now = self.nearest(&self.echoes, momentum, drive, needed_m);
        let before = self.nearest(&self.earlier, momentum, drive, remembered_m);
        now.into_iter().chain(before).min_by(|one, other| one.0.total_cmp(&other.0))
    }

    /// Whether the hull could touch a point although the robot brakes as hard as it can.
    pub(crate) fn touches(&self, momentum: &Momentum) -> bool {
        let hull_m = self.here.limits.radius_m;
        let needed_m = |echo: &Echo| {
            if echo.is_unresolved() { hull_m } else { hull_m.min(echo.distance_m - TOUCH_M) }
        };
        self.nearest(&self.echoes, momentum, Drive::STILL, |echo, _| needed_m(echo)).is_some()
    }

    fn nearest(
        &self,
        echoes: &[Echo],
        momentum: &Momentum,
        drive: Drive,
        needed_m: impl Fn(&Echo, &Sector) -> f64,
    ) -> Option<(f64, f64)> {
        let sectors = self.sectors(momentum, drive);
        let is_in_the_way = |echo: &&Echo| {
            sectors.iter().flatten().any(|sector| sector.distance_m(echo) < needed_m(echo, sector))
        };
        let found = echoes.iter().filter(is_in_the_way);
        let nearest = found.min_by(|one, other| one.distance_m.total_cmp(&other.distance_m))?;
        Some((nearest.distance_m - self.here.limits.radius_m, nearest.direction_rad))
    }

    /// The places that the robot can reach, ahead and backward.
    fn sectors(&self, momentum: &Momentum, drive: Drive) -> [Option<Sector>; 2] {
        let limits = &self.here.limits;
        let motions = momentum.motions(drive, self.here);
        let after = motions.after.ahead_m_per_s;
        let sent_m: f64 =
            self.sent.iter().map(|sent| sent.momentum.ahead_m_per_s.abs() * limits.tick_s).sum();
        let way_m = sent_m + geometry::Braking::of(limits).distance_m(after);
        let all = || self.sent.iter().map(|sent| sent.momentum).chain([motions.after]);
        if limits.motion == Motion::Point {
            let to_robot = nalgebra::Rotation2::new(-self.here.pose.heading_rad);
            let moves = all().map(|momentum| momentum.velocity).filter(|velocity| velocity.norm() > 1e-12);
            let mut directions = moves.map(|velocity| to_robot * velocity).map(|to| to.y.atan2(to.x));
            let Some(from_rad) = directions.next() else { return [None, None] };
            let turns: Vec<f64> =
                directions.map(|rad| (rad - from_rad + PI).rem_euclid(2.0 * PI) - PI).collect();
            return [Some(Sector::around(way_m, from_rad, &turns)), None];
        }
        let mut turned = 0.0;
        let mut turns = Vec::with_capacity(self.sent.len() + 1);
        for sent in self.sent {
            turned += sent.turn_rad;
            turns.push(turned);
        }
        // While the robot brakes, it may keep its turn rate or give it up.
        let braking_s = if after == 0.0 { 0.0 } else { after.abs() / limits.acceleration_m_per_s2 };
        turns.push(turned + motions.turn_rad * (1.0 + braking_s / limits.tick_s));
        let sector = |from_rad| Sector::around(way_m, from_rad, &turns);
        let (forward, backward) =
            (all().any(|now| now.ahead_m_per_s > 0.0), all().any(|now| now.ahead_m_per_s < 0.0));
        // The order of motions ahead and backward is not known.
        if forward && backward {
            return [Some(Sector { way_m, middle_rad: 0.0, spread_rad: PI }), None];
        }
        [forward.then(|| sector(0.0)), backward.then(|| sector(PI))]
    }
}

fn echoes(points: &[Point]) -> Vec<Echo> {
    let echo =
        |point: &Point| Echo { distance_m: point.coords.norm(), direction_rad: point.y.atan2(point.x) };
    points.iter().map(echo).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use geometry::{Limits, Pose, Vector};
    use proptest::prelude::*;
    use world::{Odometry, scan::carried};

    fn limits(motion: Motion, acceleration_m_per_s2: f64) -> Limits {
        Limits {
            motion,
            v_max_m_per_s: 0.8,
            w_max_rad_per_s: 1.5,
            radius_m: 0.2,
            sensing_range_m: 100.0,
            acceleration_m_per_s2,
            tick_s: 0.1,
            amphibious: None,
        }
    }

    /// A robot whose commands take effect after a number of ticks.
    struct Robot {
        here: Here,
        /// The speed that follows from the commands sent, which is all that the mission knows, and the true speed.
        known: Momentum,
        real: Momentum,
        waiting: Vec<(Drive, Sent)>,
    }

    impl Robot {
        fn new(limits: Limits, delay: usize) -> Self {
            let here = Here { pose: Pose::new(0.0, 0.0, 0.0), error_m: 0.0, limits };
            let still = Sent { momentum: Momentum::NONE, turn_rad: 0.0 };
            let waiting = vec![(Drive::STILL, still); delay];
            Self { here, known: Momentum::NONE, real: Momentum::NONE, waiting }
        }

        fn guard(&self, points: &[Point], wanted: Drive) -> Guarded {
            let sent: Vec<Sent> = self.waiting.iter().map(|(_, sent)| *sent).collect();
            Guard::new(&self.seen(points), &self.here, &sent).guarded(&self.known, wanted)
        }

        fn seen(&self, points: &[Point]) -> Vec<Point> {
            let heading = nalgebra::Rotation2::new(-self.here.pose.heading_rad);
            points.iter().map(|point| Point::from(heading * (point - self.here.pose.position))).collect()
        }

        fn follow(&mut self, drive: Drive) {
            let sent = Sent::of(&self.known, drive, &self.here);
            self.known = sent.momentum;
            self.waiting.push((drive, sent));
            let (now, _) = self.waiting.remove(0);
            let motions = self.real.motions(now, &self.here);
            (self.here.pose, self.real) = (motions.end, motions.after);
        }
    }

    /// A robot before a point that its last scan shows farther away than the scan before: it does not creep on.
    #[test]
    fn what_an_earlier_scan_showed_on_the_course_stops_the_robot_too() {
        let robot = Robot::new(limits(Motion::Unicycle, 0.5), 0);
        let guard = |earlier: &[Point]| {
            let scans = std::iter::once(earlier);
            let far = [Point::new(0.4, 0.0)];
            let drive = Drive::Twist { v_m_per_s: 0.2, w_rad_per_s: 0.0 };
            Guard::new(&far, &robot.here, &[]).remembering(scans).guarded(&robot.known, drive)
        };
        let speed = |guarded: Guarded| match guarded.drive {
            Drive::Twist { v_m_per_s, .. } => v_m_per_s,
            Drive::Velocity(velocity) => velocity.norm(),
        };
        assert!(speed(guard(&[])) > 0.1);
        assert!(speed(guard(&[Point::new(0.21, 0.0)])) < 1e-9, "on the course");
        assert!(speed(guard(&[Point::new(0.0, 0.205)])) > 0.1, "beside the course");
    }

    #[test]
    fn a_point_nearer_than_the_sensor_can_measure_stops_the_robot() {
        let robot = Robot::new(limits(Motion::Unicycle, 0.5), 0);
        for (v_m_per_s, w_rad_per_s) in [(0.4, 0.0), (-0.1, 0.0), (0.1, 1.0)] {
            let guarded = robot.guard(&[Point::origin()], Drive::Twist { v_m_per_s, w_rad_per_s });
            let Drive::Twist { v_m_per_s: ahead, .. } = guarded.drive else { panic!("{guarded:?}") };
            assert!(ahead.abs() < 1e-9 && guarded.before.is_some(), "{guarded:?}");
        }
    }

    fn any_drive(motion: Motion) -> impl Strategy<Value = Drive> {
        (-1.0..1.0_f64, -2.0..2.0_f64).prop_map(move |(a, b)| match motion {
            Motion::Point => Drive::Velocity(Vector::new(a, b)),
            Motion::Unicycle => Drive::Twist { v_m_per_s: a, w_rad_per_s: b },
        })
    }

    proptest! {
        #[test]
        fn a_guarded_robot_touches_no_scanned_point(
            (motion, drives) in prop_oneof![Just(Motion::Point), Just(Motion::Unicycle)].prop_flat_map(|motion| {
                (Just(motion), prop::collection::vec((any_drive(motion), 1..15_usize), 5..30))
            }),
            delay in 0..4_usize, acceleration in 0.1..2.0_f64,
            points in prop::collection::vec((0.21..2.0_f64, -PI..PI), 1..60),
        ) {
            let points: Vec<Point> = points.into_iter().map(|(r, a)| Point::new(r * a.cos(), r * a.sin())).collect();
            let mut robot = Robot::new(limits(motion, acceleration), delay);
            let drives = drives.into_iter().chain([(Drive::STILL, 200)]);
            for (drive, ticks) in drives {
                for _ in 0..ticks {
                    let guarded = robot.guard(&points, drive);
                    prop_assert!(!guarded.is_late);
                    robot.follow(guarded.drive);
                    let gap = points.iter().map(|point| (point - robot.here.pose.position).norm()).fold(9.0, f64::min);
                    prop_assert!(gap > 0.2, "{gap} at {}", robot.here.pose.position);
                }
            }
            prop_assert!(robot.real.speed_m_per_s().abs() < 1e-9, "STILL is never refused");
        }
    }

    proptest! {
        /// The vehicle follows commands sooner than assumed, and readings arrive late, one tick more and one tick less.
        #[test]
        fn late_readings_of_a_quick_robot_never_seem_to_come_too_late(
            drives in prop::collection::vec((any_drive(Motion::Unicycle), 1..15_usize), 5..30),
            reaction in 1..8_usize, quicker in 0..8_usize, acceleration in 0.1..2.0_f64,
            ages in prop::collection::vec(0..3_usize, 20),
            points in prop::collection::vec((0.21..2.0_f64, -PI..PI), 1..60),
        ) {
            let points: Vec<Point> = points.into_iter().map(|(r, a)| Point::new(r * a.cos(), r * a.sin())).collect();
            let mut robot = Robot::new(limits(Motion::Unicycle, acceleration), reaction.saturating_sub(quicker));
            let still = Sent { momentum: Momentum::NONE, turn_rad: 0.0 };
            let (mut sent, mut poses) = (vec![still; reaction + 3], vec![robot.here.pose; 3]);
            for (tick, drive) in drives.iter().flat_map(|(drive, ticks)| vec![*drive; *ticks]).enumerate() {
                let (age, now) = (ages[tick % ages.len()], robot.here.pose);
                robot.here.pose = poses[poses.len() - 1 - age];
                let seen = robot.seen(&points);
                let within = |ticks: usize| Guard::new(&seen, &robot.here, &sent[sent.len() - ticks..]);
                let guarded = within(reaction + age).guarded(&robot.known, drive);
                prop_assert!(!within(age).touches(&robot.known), "tick {tick}");
                robot.here.pose = now;
                sent.push(Sent::of(&robot.known, guarded.drive, &robot.here));
                robot.follow(guarded.drive);
                poses.push(robot.here.pose);
                let gap = points.iter().map(|point| (point - robot.here.pose.position).norm()).fold(9.0, f64::min);
                prop_assert!(gap > 0.2, "{gap} at {}", robot.here.pose.position);
            }
        }
    }

    fn ahead(v_m_per_s: f64) -> Drive {
        Drive::Twist { v_m_per_s, w_rad_per_s: 0.0 }
    }

    #[test]
    fn a_robot_passes_along_a_wall_and_leaves_what_it_touches() {
        let robot = Robot::new(limits(Motion::Unicycle, 0.5), 1);
        let wall: Vec<Point> = (-50..50).map(|k| Point::new(f64::from(k) * 0.05, 0.24)).collect();
        assert_eq!(robot.guard(&wall, ahead(0.4)).drive, ahead(0.4));
        let touched = [Point::new(0.19, 0.0)];
        assert_eq!(robot.guard(&touched, ahead(-0.4)).drive, ahead(-0.4));
        let Guarded { drive, before: Some((gap_m, direction_rad)), .. } = robot.guard(&touched, ahead(0.4))
        else {
            panic!("there must be a point in the way")
        };
        let turn = Drive::Twist { v_m_per_s: 0.0, w_rad_per_s: 1.0 };
        assert_eq!(robot.guard(&touched, turn).drive, turn, "a disc may turn in place");
        assert!((gap_m + 0.01).abs() < 1e-12 && direction_rad == 0.0);
        let Drive::Twist { v_m_per_s, .. } = drive else { panic!("{drive:?}") };
        assert!(v_m_per_s < 0.01, "{v_m_per_s}");
    }

    #[test]
    fn a_robot_stops_short_of_what_is_ahead_and_does_not_creep_on() {
        let mut robot = Robot::new(limits(Motion::Unicycle, 0.5), 2);
        let column: Vec<Point> = (-20..20).map(|k| Point::new(1.5, f64::from(k) * 0.01)).collect();
        for _ in 0..600 {
            let drive = robot.guard(&column, ahead(0.4)).drive;
            robot.follow(drive);
        }
        let gap_m = 1.5 - robot.here.pose.position.x - 0.2;
        assert!((SCAN_ROOM_M..2.0 * SCAN_ROOM_M).contains(&gap_m), "{gap_m}");
    }

    #[test]
    fn what_appears_within_the_stopping_distance_is_late() {
        let mut robot = Robot::new(limits(Motion::Unicycle, 0.5), 1);
        for _ in 0..20 {
            robot.follow(ahead(0.8));
        }
        let at = |far_m: f64| [robot.here.pose.position + Vector::new(far_m, 0.0)];
        // The robot travels 0.16 m until the command to stop takes effect, and 0.64 m while it brakes; the hull has a
        // radius of 0.2 m.
        let late = robot.guard(&at(0.7), ahead(0.8));
        assert!(late.is_late && late.drive == Drive::STILL, "{late:?}");
        let in_time = robot.guard(&at(1.02), ahead(0.8));
        assert!(!in_time.is_late && in_time.before.is_some(), "{in_time:?}");
    }

    #[test]
    fn points_move_with_the_robot() {
        let moved = Odometry { forward_m: 0.3, sideways_m: 0.0, turn_rad: FRAC_PI_2 };
        assert!((carried(Point::new(1.0, 0.0), &moved) - Point::new(0.0, -0.7)).norm() < 1e-12);
    }
}
