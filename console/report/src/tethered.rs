//! How the tether truly lay.

use crate::summary::Tether;
use mission::{Outcome, TetherConfig};
use std::f64::consts::TAU;
use world::Point;

/// Distance from the anchor at which the robot is back, metres.
const BACK_M: f64 = 0.5;
/// Cable beyond the straight line to the robot that counts as left out, metres.
const LEFT_M: f64 = 0.3;

/// The cable of a run so far.
#[derive(Debug)]
pub(crate) struct Tethered {
    anchor: Point,
    known: Option<Tether>,
    detour_m: f64,
    catches: u64,
    caught: bool,
}

impl Tethered {
    /// A run with this tether.
    pub(crate) fn new(config: &TetherConfig) -> Self {
        Self { anchor: config.anchor, known: None, detour_m: 0.0, catches: 0, caught: false }
    }

    /// Takes in how the cable lies in one tick.
    pub(crate) fn lie(&mut self, length_m: f64, max_wrap_rad: f64, sum_wrap_rad: f64, detour_m: f64) {
        let before =
            self.known.map_or((0.0, 0.0, 0.0), |t| (t.max_length_m, t.max_wrap_rad, t.max_total_wrap_rad));
        self.detour_m = detour_m;
        self.known = Some(Tether {
            max_length_m: length_m.max(before.0),
            max_wrap_rad: max_wrap_rad.max(before.1),
            max_total_wrap_rad: sum_wrap_rad.max(before.2),
            loops: (max_wrap_rad / TAU) as u64,
            end_length_m: length_m,
            entangled: false,
            catches: 0,
            caught: false,
        });
    }

    /// Takes in that the mission found the cable caught on something unseen, or free of it again.
    pub(crate) fn catch(&mut self, caught: bool) {
        self.catches += u64::from(caught);
        self.caught = caught;
    }

    /// The figures: entangled is a cable that holds the mission up, or stays out though the robot is back.
    pub(crate) fn tether(&self, robot: Option<Point>, outcome: Option<Outcome>) -> Option<Tether> {
        let is_back = robot.is_some_and(|robot| (robot - self.anchor).norm() <= BACK_M);
        let entangled = outcome == Some(Outcome::Entangled) || (is_back && self.detour_m > LEFT_M);
        let (catches, caught) = (self.catches, self.caught);
        self.known.map(|known| Tether { entangled, catches, caught, ..known })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::tether::Limits;

    #[test]
    fn cable_that_stays_out_at_the_anchor_is_entangled_and_elsewhere_it_is_not() {
        let limits = Limits { reel_m: 9.0, max_wrap_rad: 9.0, max_sum_wrap_rad: 9.0 };
        let config = TetherConfig { anchor: Point::origin(), limits, friction: 0.3, fly_uncertified: false };
        let mut tethered = Tethered::new(&config);
        assert_eq!(tethered.tether(None, None), None);
        tethered.lie(7.0, 6.5, 7.5, 6.9);
        tethered.lie(5.0, 6.4, 6.4, 5.0);
        let at = |x| tethered.tether(Some(Point::new(x, 0.0)), Some(Outcome::Complete)).unwrap();
        assert_eq!((at(0.1).max_length_m, at(0.1).end_length_m, at(0.1).loops), (7.0, 5.0, 1));
        assert!(at(0.1).entangled && !at(3.0).entangled);
        assert!(tethered.tether(None, Some(Outcome::Entangled)).unwrap().entangled);
        let catches = |tethered: &Tethered| tethered.tether(None, None).map(|t| (t.catches, t.caught));
        for caught in [true, false, true] {
            tethered.catch(caught);
        }
        assert_eq!(catches(&tethered), Some((2, true)));
    }
}
