//! Collects measurements into readings, one message per period.

use crate::message::{Pose, Readings};

/// Readings under construction.
#[derive(Debug, Clone, Default)]
pub struct Assembly {
    /// The measurements since the last readings, in addition to the pose.
    pub parts: Readings,
    period_s: f64,
    last_s: Option<f64>,
}

/// Share of a period by which a pose may come before the next readings are due and still be used for them.
const EARLY: f64 = 0.25;

impl Assembly {
    /// Creates readings for one message every `period_s`.
    pub fn new(period_s: f64) -> Self {
        Self { period_s, ..Self::default() }
    }

    /// Completes the readings with a pose that was measured at `stamp_s`. `None` if the next readings are not due yet;
    /// the motion is not lost, because poses add up.
    pub fn pose(&mut self, pose: Pose, stamp_s: f64) -> Option<Readings> {
        let is_due = self.last_s.is_none_or(|last_s| stamp_s - last_s >= (1.0 - EARLY) * self.period_s);
        if !is_due {
            return None;
        }
        self.last_s = Some(stamp_s);
        let seq = self.parts.seq + 1;
        let parts = std::mem::replace(&mut self.parts, Readings { seq, ..Readings::default() });
        Some(Readings { seq, stamp_s, pose: Some(pose), ..parts })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::message::Tether;

    const POSE: Pose = Pose { x_m: 1.0, y_m: 2.0, heading_rad: 3.0 };

    #[test]
    fn readings_are_numbered_and_carry_each_part_once() {
        let mut assembly = Assembly::new(0.1);
        assembly.parts.tether = Some(Tether { paid_out_m: 2.0 });
        let first = assembly.pose(POSE, 1.0).unwrap();
        assert_eq!((first.seq, first.stamp_s, first.tether.map(|t| t.paid_out_m)), (1, 1.0, Some(2.0)));
        let second = assembly.pose(POSE, 1.1).unwrap();
        assert_eq!((second.seq, second.tether), (2, None));
    }

    #[test]
    fn a_fast_source_is_thinned() {
        let mut assembly = Assembly::new(0.1);
        let stamps = (0..100).map(|n| f64::from(n) * 0.01);
        assert_eq!(stamps.filter(|stamp_s| assembly.pose(POSE, *stamp_s).is_some()).count(), 13);
    }
}
