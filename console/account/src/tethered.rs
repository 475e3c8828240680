//! The true state of the tether.

use crate::summary::Tether;
use mission::{Outcome, TetherConfig};
use std::f64::consts::TAU;
use world::Point;

/// Distance from the anchor within which the robot counts as back, metres.
const BACK_M: f64 = 0.5;
/// Length of cable, beyond the straight line to the robot, that counts as left out, metres.
const LEFT_M: f64 = 0.3;

/// The cable of a run so far.
#[derive(Debug)]
pub(crate) struct Tethered {
    anchor: Point,
    known: Option<Tether>,
    detour_m: f64,
    snags: u64,
    snagged: bool,
    over_own: Option<u64>,
    is_over_own: bool,
    broken_at_s: Option<f64>,
    is_torn: bool,
}

impl Tethered {
    /// Creates the record of a run with this tether.
    pub(crate) fn new(config: &TetherConfig) -> Self {
        Self {
            anchor: config.anchor,
            known: None,
            detour_m: 0.0,
            snags: 0,
            snagged: false,
            over_own: None,
            is_over_own: false,
            broken_at_s: None,
            is_torn: false,
        }
    }

    /// Adds the state of the cable in one tick.
    pub(crate) fn lie(&mut self, length_m: f64, wrap_max_rad: f64, wrap_total_rad: f64, detour_m: f64) {
        let before = self
            .known
            .map_or((0.0, 0.0, 0.0), |t| (t.tether_length_max_m, t.wrap_max_rad, t.wrap_total_max_rad));
        self.detour_m = detour_m;
        self.known = Some(Tether {
            tether_length_max_m: length_m.max(before.0),
            wrap_max_rad: wrap_max_rad.max(before.1),
            wrap_total_max_rad: wrap_total_rad.max(before.2),
            loops: (wrap_max_rad / TAU) as u64,
            end_length_m: length_m,
            entangled: false,
            snags: 0,
            snagged: false,
            over_own: None,
            broken_at_s: None,
            torn_at_end: false,
        });
    }

    /// Records whether a cable that can be slack is truly torn, and whether the hull is over it.
    pub(crate) fn cross(&mut self, is_torn: bool, is_over_own: bool) {
        self.is_torn = is_torn;
        let times = self.over_own.get_or_insert(0);
        *times += u64::from(is_over_own && !self.is_over_own);
        self.is_over_own = is_over_own;
    }

    /// Records that the mission found the cable snagged on an unmapped object, or free again.
    pub(crate) fn snag(&mut self, snagged: bool) {
        self.snags += u64::from(snagged);
        self.snagged = snagged;
    }

    /// Records that the mission found the cable broken, at a mission time, seconds.
    pub(crate) fn tear(&mut self, t_s: f64) {
        self.broken_at_s.get_or_insert(t_s);
    }

    /// The figures. The cable is entangled if it holds up the mission, or remains out although the robot is back.
    pub(crate) fn tether(&self, robot: Option<Point>, outcome: Option<Outcome>) -> Option<Tether> {
        let is_back = robot.is_some_and(|robot| (robot - self.anchor).norm() <= BACK_M);
        let entangled = outcome == Some(Outcome::Entangled) || (is_back && self.detour_m > LEFT_M);
        let &Self { snags, snagged, over_own, broken_at_s, is_torn: torn_at_end, .. } = self;
        self.known.map(|known| Tether {
            entangled,
            snags,
            snagged,
            over_own,
            broken_at_s,
            torn_at_end,
            ..known
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::tether::Limits;

    #[test]
    fn cable_that_stays_out_at_the_anchor_is_entangled_and_elsewhere_it_is_not() {
        let limits = Limits { reel_length_m: 9.0, wrap_max_rad: 9.0, wrap_total_max_rad: 9.0 };
        let config = TetherConfig {
            anchor: Point::origin(),
            limits,
            friction: 0.3,
            reel: None,
            allow_uncertified: false,
        };
        let mut tethered = Tethered::new(&config);
        assert_eq!(tethered.tether(None, None), None);
        tethered.lie(7.0, 6.5, 7.5, 6.9);
        tethered.lie(5.0, 6.4, 6.4, 5.0);
        let at = |x| tethered.tether(Some(Point::new(x, 0.0)), Some(Outcome::Complete)).unwrap();
        assert_eq!((at(0.1).tether_length_max_m, at(0.1).end_length_m, at(0.1).loops), (7.0, 5.0, 1));
        assert!(at(0.1).entangled && !at(3.0).entangled);
        assert!(tethered.tether(None, Some(Outcome::Entangled)).unwrap().entangled);
        let snags = |tethered: &Tethered| tethered.tether(None, None).map(|t| (t.snags, t.snagged));
        for snagged in [true, false, true] {
            tethered.snag(snagged);
        }
        assert_eq!(snags(&tethered), Some((2, true)));
        assert_eq!(tethered.tether(None, None).unwrap().over_own, None);
        for is_over_own in [false, true, true, false, true] {
            tethered.cross(false, is_over_own);
        }
        assert_eq!(tethered.tether(None, None).unwrap().over_own, Some(2));
        assert!(!tethered.tether(None, None).unwrap().torn_at_end);
        tethered.cross(true, false);
        assert!(tethered.tether(None, None).unwrap().torn_at_end, "whether or not the mission knows it");
        for t_s in [7.0, 9.0] {
            tethered.tear(t_s);
        }
        assert_eq!(tethered.tether(None, None).unwrap().broken_at_s, Some(7.0));
    }
}
