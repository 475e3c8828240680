//! A range scanner on the robot: its rays, its errors and its mounting.

use crate::{
    NO_ECHO, Scan,
    scan::{RangesMm, is_round},
};
use geometry::{Point, Pose};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A scanner that measures the distances along rays in one plane.
///
/// ```
/// let scanner = world::Scanner { rays: 4, ..world::Scanner::default() };
/// assert_eq!(scanner.step_rad(), std::f64::consts::FRAC_PI_2);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Scanner {
    /// Number of rays of a scan.
    pub rays: u32,
    /// Angle between the two outermost rays, radians; a full turn for rays all around.
    pub field_of_view_rad: f64,
    /// Maximum distance that can be measured, metres.
    pub range_m: f64,
    /// Number of scans per second.
    pub rate_hz: f64,
    /// Standard deviation of a distance, metres.
    pub sigma_m: f64,
    /// Share of the rays that bring no echo although there is something to hit, 0 to 1.
    pub lost_share: f64,
    /// Place of the scanner in the robot frame, metres.
    pub offset_m: [f64; 2],
    /// Direction of the middle of the field of view in the robot frame, radians, counter-clockwise from straight ahead.
    pub heading_rad: f64,
}

impl Default for Scanner {
    /// The scanner of a scenario that gives no details.
    fn default() -> Self {
        Self {
            rays: 360,
            field_of_view_rad: TAU,
            range_m: 8.0,
            rate_hz: 10.0,
            sigma_m: 0.02,
            lost_share: 0.02,
            offset_m: [0.0, 0.0],
            heading_rad: 0.0,
        }
    }
}

impl Scanner {
    /// The same scanner without errors in its distances and without lost rays.
    #[must_use]
    pub fn exact(self) -> Self {
        Self { sigma_m: 0.0, lost_share: 0.0, ..self }
    }

    /// Angle from one ray to the next, radians.
    pub fn step_rad(&self) -> f64 {
        let all_around_rad = self.field_of_view_rad / f64::from(self.rays.max(1));
        if is_round(self.rays as usize, all_around_rad) {
            return all_around_rad;
        }
        self.field_of_view_rad / f64::from(self.rays.saturating_sub(1).max(1))
    }

    /// Direction of the first ray in the robot frame, radians.
    pub fn first_rad(&self) -> f64 {
        self.heading_rad - 0.5 * self.field_of_view_rad
    }

    /// Place and direction of the scanner in the tank, for a robot at a pose.
    pub fn pose(&self, robot: &Pose) -> Pose {
        let place = robot.tank_from_robot() * Point::from(self.offset_m);
        Pose { position: place, heading_rad: robot.heading_rad + self.heading_rad }
    }

    /// Whether a scan is due in a tick of a given length in seconds.
    ///
    /// ```
    /// let scanner = world::Scanner { rate_hz: 5.0, ..world::Scanner::default() };
    /// assert_eq!([0, 1, 2, 3].map(|tick| scanner.is_due(tick, 0.1)), [true, false, true, false]);
    /// ```
    pub fn is_due(&self, tick: u64, tick_s: f64) -> bool {
        // Because of rounding, a tick that should begin exactly with a scan could otherwise miss it.
        let scans = |tick: u64| (tick as f64 * tick_s * self.rate_hz + 1e-6).floor();
        tick == 0 || scans(tick) > scans(tick - 1)
    }

    /// A scan with these distances in metres, one per ray.
    pub fn scan(&self, ranges_m: impl Iterator<Item = Option<f64>>) -> Scan {
        let within = |range_m: Option<f64>| range_m.filter(|range_m| *range_m <= self.range_m);
        Scan {
            first_rad: self.first_rad(),
            step_rad: self.step_rad(),
            sensor_m: self.offset_m,
            ranges_mm: RangesMm(ranges_m.map(|range_m| Scan::stored(within(range_m))).collect()),
            ..Scan::default()
        }
    }

    /// Distances of a scan in metres; `None` for rays without an echo.
    pub fn ranges_m(scan: &Scan) -> impl Iterator<Item = Option<f64>> + '_ {
        scan.ranges_mm.0.iter().map(|mm| (*mm != NO_ECHO).then(|| f64::from(*mm) / 1000.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_span_the_field_of_view() {
        let scanner = Scanner { rays: 181, field_of_view_rad: std::f64::consts::PI, ..Scanner::default() };
        assert!((scanner.step_rad() - 1_f64.to_radians()).abs() < 1e-12);
        let last = scanner.first_rad() + 180.0 * scanner.step_rad();
        assert!((last - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        let round = Scanner::default();
        assert!((round.first_rad() + 360.0 * round.step_rad() - std::f64::consts::PI).abs() < 1e-12);
    }

    #[test]
    fn scans_are_due_at_the_rate_of_the_scanner_or_of_the_ticks() {
        let due = |rate_hz: f64, tick_s: f64| {
            let scanner = Scanner { rate_hz, ..Scanner::default() };
            (0..1000).filter(|tick| scanner.is_due(*tick, tick_s)).count()
        };
        assert_eq!([due(10.0, 0.1), due(50.0, 0.1), due(4.0, 0.1)], [1000, 1000, 400]);
    }

    #[test]
    fn a_distance_beyond_the_range_is_no_echo() {
        let scanner = Scanner { rays: 3, range_m: 4.0, ..Scanner::default() };
        let scan = scanner.scan([Some(3.0), Some(4.001), None].into_iter());
        assert_eq!(scan.ranges_mm.0, [3000, NO_ECHO, NO_ECHO]);
        assert_eq!(Scanner::ranges_m(&scan).collect::<Vec<_>>(), [Some(3.0), None, None]);
    }
}
