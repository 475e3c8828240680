//! The rays of one scan, found by direction.

use geometry::{Point, Pose, Vector};
use nalgebra::Isometry2;
use std::f64::consts::TAU;
use world::{NO_ECHO, Scan, scan::is_round};

/// Number of rays on each side of a ray without an echo that have none either if the ray shows free floor. Of rays lost
/// one by one, five in a row are so rare that they leave no trace in a map.
const SILENT: isize = 2;

/// The rays of a scan, tank frame.
pub(crate) struct Beams {
    /// Place of the sensor when it made the scan.
    pub eye: Point,
    /// Direction of the first ray, radians.
    first_rad: f64,
    step_rad: f64,
    is_round: bool,
    /// The distance up to which each ray shows free floor, metres.
    clear_m: Vec<f64>,
    /// The echoes.
    pub hits: Vec<Point>,
}

impl Beams {
    /// The rays of a scan that is part of readings at whose end the robot was at `pose`; `range_m` is the maximum
    /// distance that the scanner measures, if it is known. Echoes from inside the hull, a disc of `hull_m` metres, and those
    /// farther away than `within_m` metres are left out.
    pub(crate) fn new(
        scan: &Scan,
        pose: &Pose,
        range_m: Option<f64>,
        (hull_m, within_m): (f64, f64),
    ) -> Self {
        let since = &scan.since;
        let moved = Isometry2::new(Vector::new(since.forward_m, since.sideways_m), since.turn_rad);
        let tank_from_robot = pose.tank_from_robot() * moved.inverse();
        let eye = tank_from_robot * Point::from(scan.sensor_m);
        let first_rad = tank_from_robot.rotation.angle() + scan.first_rad;
        let is_round = is_round(scan.ranges_mm.0.len(), scan.step_rad);
        let mut beams =
            Self { eye, first_rad, step_rad: scan.step_rad, is_round, clear_m: Vec::new(), hits: Vec::new() };
        let sensor = Vector::from(scan.sensor_m);
        let measured = |(ray, mm): (usize, &u16)| {
            let towards = geometry::unit_vector(scan.first_rad + ray as f64 * scan.step_rad);
            let is_own = *mm != NO_ECHO && (sensor + towards * (f64::from(*mm) / 1000.0)).norm() < hull_m;
            if is_own { 0 } else { *mm }
        };
        let ranges: Vec<u16> = scan.ranges_mm.0.iter().enumerate().map(measured).collect();
        beams.clear_m = (0..ranges.len()).map(|ray| beams.clear_m_of(&ranges, ray, range_m)).collect();
        let hit = |(ray, mm): (usize, &u16)| {
            let far_m = f64::from(*mm) / 1000.0;
            let is_echo = !matches!(*mm, 0 | NO_ECHO) && far_m <= within_m;
            is_echo.then(|| eye + geometry::unit_vector(first_rad + ray as f64 * scan.step_rad) * far_m)
        };
        beams.hits = ranges.iter().enumerate().filter_map(hit).collect();
        beams
    }

    /// The distance up to which a ray shows free floor. A ray without an echo may have been lost; it shows free floor
    /// only if [`SILENT`] rays on each side have no echo either.
    fn clear_m_of(&self, ranges: &[u16], ray: usize, range_m: Option<f64>) -> f64 {
        match ranges[ray] {
            NO_ECHO => {
                let n = ranges.len() as isize;
                let is_silent = |offset: isize| {
                    let beside = ray as isize + offset;
                    if self.is_round {
                        ranges[beside.rem_euclid(n) as usize] == NO_ECHO
                    } else {
                        !(0..n).contains(&beside) || ranges[beside as usize] == NO_ECHO
                    }
                };
                if (-SILENT..=SILENT).all(is_silent) { range_m.unwrap_or(0.0) } else { f64::INFINITY }
            }
            mm => f64::from(mm) / 1000.0,
        }
    }

    /// The distance up to which the rays beside a direction show free floor: the shorter of the two. `None` outside the
    /// field of view, and where no ray says anything.
    pub(crate) fn clear_towards_m(&self, direction: Vector) -> Option<f64> {
        let n = self.clear_m.len();
        let turn_rad = direction.y.atan2(direction.x) - self.first_rad;
        let turn_rad =
            if self.step_rad > 0.0 { turn_rad.rem_euclid(TAU) } else { -(-turn_rad).rem_euclid(TAU) };
        let at = turn_rad / self.step_rad;
        let before = at as usize;
        let after = if before + 1 == n && self.is_round { 0 } else { before + 1 };
        let clear_m = self.clear_m.get(before)?.min(*self.clear_m.get(after)?);
        clear_m.is_finite().then_some(clear_m)
    }
}
