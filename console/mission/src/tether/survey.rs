//! What a survey asks before it takes a way.

use super::{LEFT_M, Tether, certifying::certified};
use crate::config::TetherConfig;
use world::{Point, World, tether};

/// Length of cable kept in reserve, metres, and share of the wraps: the map and the position have errors.
const RESERVE_M: f64 = 0.3;
const RESERVE_SHARE: f64 = 0.1;

impl Tether {
    /// Whether a way can be driven within the limits of the tether, with a reserve, as far as the tank is known now.
    pub(crate) fn bears_with_reserve(&self, way: &[Point], world: &World) -> bool {
        let tether::Limits { reel_length_m, wrap_max_rad, wrap_total_max_rad } = self.config.limits;
        let less = |limit_rad: f64| limit_rad * (1.0 - RESERVE_SHARE);
        let limits = tether::Limits {
            reel_length_m: Self::usable_m(reel_length_m),
            wrap_max_rad: less(wrap_max_rad),
            wrap_total_max_rad: less(wrap_total_max_rad),
        };
        let config = TetherConfig { limits, ..self.config.clone() };
        certified(&config, 0.0, Some(&self.cable), way, &[], world, false).certified
    }

    /// Whether the tether is long enough for a place if nothing is in the way.
    pub(crate) fn can_reach_straight(&self, place: Point) -> bool {
        (place - self.config.anchor).norm() <= Self::usable_m(self.config.limits.reel_length_m)
    }

    /// Whether the cable is reeled in at the end of a way back to the anchor, within the limits all along.
    pub(crate) fn is_reeled_in_along(&self, way: &[Point], world: &World) -> bool {
        let mut cable = self.cable.clone();
        cable.drag_along(way);
        cable.drag_to(self.config.anchor);
        cable.length_m() <= LEFT_M
            && certified(&self.config, 0.0, Some(&self.cable), way, &[], world, false).certified
    }

    fn usable_m(reel_length_m: f64) -> f64 {
        reel_length_m - RESERVE_M.min(0.5 * reel_length_m)
    }
}
