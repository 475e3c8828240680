//! Collects measurements into readings, one message per period.

use crate::{
    clock::is_newer,
    message::{Pose, Readings, Scan},
    trail::{Trail, seen_from},
};

/// Readings under construction.
#[derive(Debug, Clone, Default)]
pub struct Assembly {
    /// The measurements since the last readings, in addition to the pose and the scan.
    pub parts: Readings,
    period_s: f64,
    last_s: Option<f64>,
    trail: Trail,
    /// The newest scan that was not sent yet, and its stamp; without a stamp, the scan counts as taken at the next pose.
    scan: Option<(Scan, Option<f64>)>,
    /// Stamp of the newest scan.
    scan_s: Option<f64>,
}

/// The time of a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// Stamp of the sender, seconds of its clock.
    pub stamp_s: f64,
    /// The same time, seconds of the adapter's clock.
    pub at_s: f64,
}

/// Share of a period by which a pose may come before the next readings are due and still be used for them.
const EARLY: f64 = 0.25;
/// Oldest scan, compared with the newest pose, that is sent, seconds.
const SCAN_MAX_AGE_S: f64 = 0.5;
/// Difference in time between a scan and the newest pose, seconds, above which the scanner has a clock of its own.
const OTHER_CLOCK_S: f64 = 5.0;

impl Assembly {
    /// Creates readings for one message every `period_s`.
    pub fn new(period_s: f64) -> Self {
        Self { period_s, ..Self::default() }
    }

    /// Takes a scan with the stamp of its sender; a scan without a stamp, or by a clock that differs from that of the
    /// poses by more than 5 s, counts as taken at the newest pose. A scan that a later one has overtaken, and a
    /// duplicate, are dropped.
    ///
    /// # Errors
    ///
    /// The scan is more than 0.5 s older than the newest pose.
    pub fn scan(&mut self, scan: Scan, stamp_s: Option<f64>) -> Result<(), String> {
        let newest_s = self.trail.newest_s();
        let is_comparable =
            |stamp_s: &f64| newest_s.is_none_or(|at_s| (at_s - stamp_s).abs() <= OTHER_CLOCK_S);
        let Some(stamp_s) = stamp_s.filter(is_comparable) else {
            self.scan = Some((scan, newest_s));
            return Ok(());
        };
        if !is_newer(stamp_s, self.scan_s) {
            return Ok(());
        }
        self.scan_s = Some(stamp_s);
        if let Some(age_s) = newest_s.map(|at_s| at_s - stamp_s).filter(|age_s| *age_s > SCAN_MAX_AGE_S) {
            return Err(format!("the scan is {age_s:.1} s older than the newest pose; compare their clocks"));
        }
        self.scan = Some((scan, Some(stamp_s)));
        Ok(())
    }

    /// Completes the readings with a pose. `None` if the next readings are not due yet; the motion is not lost, because
    /// poses add up. A scan is stated as seen from this pose; a scan later than the pose waits for the next one.
    pub fn pose(&mut self, pose: Pose, time: Measured) -> Option<Readings> {
        self.trail.add(pose, time.stamp_s);
        let is_due = self.last_s.is_none_or(|last_s| time.at_s - last_s >= (1.0 - EARLY) * self.period_s);
        if !is_due {
            return None;
        }
        self.last_s = Some(time.at_s);
        let seq = self.parts.seq + 1;
        let parts = std::mem::replace(&mut self.parts, Readings { seq, ..Readings::default() });
        let scan = self.scan_at(&pose, time.stamp_s);
        Some(Readings { seq, stamp_s: time.at_s, pose: Some(pose), scan, ..parts })
    }

    /// The newest scan as seen from a pose, if it was not taken after it.
    fn scan_at(&mut self, pose: &Pose, stamp_s: f64) -> Option<Scan> {
        let waits = |scan_s: f64| scan_s > stamp_s && scan_s - stamp_s <= OTHER_CLOCK_S;
        let (scan, scan_s) = self.scan.take_if(|(_, scan_s)| !scan_s.is_some_and(waits))?;
        match scan_s.filter(|scan_s| (stamp_s - scan_s).abs() <= OTHER_CLOCK_S) {
            None => Some(scan),
            Some(scan_s) if stamp_s - scan_s > SCAN_MAX_AGE_S => None,
            Some(scan_s) => Some(seen_from(scan, &self.trail.at(scan_s)?, pose)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::message::Tether;

    const POSE: Pose = Pose { x_m: 1.0, y_m: 2.0, heading_rad: 3.0 };

    fn now(at_s: f64) -> Measured {
        Measured { stamp_s: 1000.0 + at_s, at_s }
    }

    fn scan(range_m: f64) -> Scan {
        Scan {
            first_rad: 0.0,
            step_rad: 0.1,
            range_max_m: 8.0,
            sensor_m: [0.0, 0.0],
            ranges_m: vec![Some(range_m)],
        }
    }

    #[test]
    fn readings_are_numbered_and_carry_each_part_once() {
        let mut assembly = Assembly::new(0.1);
        assembly.parts.tether = Some(Tether { paid_out_m: 2.0 });
        let first = assembly.pose(POSE, now(1.0)).unwrap();
        assert_eq!((first.seq, first.stamp_s, first.tether.map(|t| t.paid_out_m)), (1, 1.0, Some(2.0)));
        let second = assembly.pose(POSE, now(1.1)).unwrap();
        assert_eq!((second.seq, second.tether), (2, None));
    }

    #[test]
    fn a_fast_source_is_thinned() {
        let mut assembly = Assembly::new(0.1);
        let stamps = (0..100).map(|n| f64::from(n) * 0.01);
        assert_eq!(stamps.filter(|stamp_s| assembly.pose(POSE, now(*stamp_s)).is_some()).count(), 13);
    }

    #[test]
    fn a_late_scan_is_stated_as_seen_from_the_pose_of_the_readings() {
        let mut assembly = Assembly::new(0.05);
        for n in 0..=4 {
            let pose = Pose { x_m: 0.1 * f64::from(n), y_m: 0.0, heading_rad: 0.0 };
            assembly.pose(pose, now(0.1 * f64::from(n)));
        }
        assembly.scan(scan(2.0), Some(1000.25)).unwrap();
        let ahead = Pose { x_m: 0.5, y_m: 0.0, heading_rad: 0.2 };
        let seen = assembly.pose(ahead, now(0.5)).unwrap().scan.unwrap();
        assert!((seen.first_rad + 0.2).abs() < 1e-9, "{seen:?}");
        assert!((seen.sensor_m[0] + 0.25 * 0.2_f64.cos()).abs() < 1e-9, "0.25 m behind: {seen:?}");
        assert_eq!(seen.ranges_m, [Some(2.0)]);
    }

    #[test]
    fn overtaken_and_doubled_scans_are_dropped_and_later_ones_wait() {
        let mut assembly = Assembly::new(0.05);
        assembly.pose(POSE, now(0.0));
        assembly.pose(POSE, now(0.1));
        assembly.scan(scan(2.0), Some(1000.15)).unwrap();
        assembly.scan(scan(3.0), Some(1000.1)).unwrap();
        assert_eq!(assembly.pose(POSE, now(0.12)), None);
        assert_eq!(assembly.pose(POSE, now(0.14)).unwrap().scan, None, "taken later");
        let sent = assembly.pose(POSE, now(0.2)).unwrap().scan.unwrap();
        assert_eq!(sent.ranges_m, [Some(2.0)]);
        assembly.scan(scan(2.0), Some(1000.15)).unwrap();
        assert_eq!(assembly.pose(POSE, now(0.3)).unwrap().scan, None, "a duplicate");
    }

    #[test]
    fn a_scan_that_is_too_old_is_named_and_one_by_another_clock_is_not() {
        let mut assembly = Assembly::new(0.05);
        assembly.pose(POSE, now(0.0));
        assembly.pose(POSE, now(1.0));
        let why = assembly.scan(scan(2.0), Some(1000.2)).unwrap_err();
        assert_eq!(why, "the scan is 0.8 s older than the newest pose; compare their clocks");
        assert_eq!(assembly.pose(POSE, now(1.1)).unwrap().scan, None);
        for stamp_s in [Some(7.0), None] {
            assembly.scan(scan(2.0), stamp_s).unwrap();
            let next = assembly.pose(POSE, now(1.2)).or_else(|| assembly.pose(POSE, now(1.3)));
            assert!(next.unwrap().scan.is_some(), "{stamp_s:?}");
        }
    }

    #[test]
    fn the_first_scan_may_come_before_the_first_pose() {
        for stamp_s in [None, Some(3.0), Some(1000.0)] {
            let mut assembly = Assembly::new(0.05);
            assembly.scan(scan(2.0), stamp_s).unwrap();
            assert!(assembly.pose(POSE, now(0.0)).unwrap().scan.is_some(), "{stamp_s:?}");
        }
    }
}
