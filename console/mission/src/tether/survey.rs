//! What a survey asks before it takes a way.

use super::{LEFT_M, Tether};
use world::{
    Point, polyline,
    tether::{Cable, Limits},
};

/// Length of cable kept in reserve, metres, and share of the other limits: the map and the position have errors.
const RESERVE_M: f64 = 0.3;
const RESERVE_SHARE: f64 = 0.1;
/// Distance between places on a way at which the cable is checked, metres.
const STEP_M: f64 = 0.2;

/// The state of a cable, as far as it is limited: length in metres, largest and total wrap in radians, pull in newtons.
#[derive(Clone, Copy)]
struct Load([f64; 4]);

impl Load {
    /// Whether nothing exceeds its limit, or what it was before: a cable beyond a limit may be taken in.
    fn is_within(&self, limits: &Self, before: &Self) -> bool {
        let pairs = self.0.iter().zip(&limits.0).zip(&before.0);
        pairs.into_iter().all(|((now, limit), before)| *now <= limit.max(before + 1e-6))
    }
}

impl Tether {
    /// Whether a way can be driven within the limits of the tether, with a reserve, as far as the tank is known now.
    pub(crate) fn bears_with_reserve(&self, way: &[Point]) -> bool {
        self.is_borne(&mut self.cable.clone(), way)
    }

    /// Whether the tether is long enough for a place if nothing is in the way.
    pub(crate) fn can_reach_straight(&self, place: Point) -> bool {
        (place - self.config.anchor).norm() <= usable_m(self.config.limits.reel_length_m)
    }

    /// Whether the cable is reeled in at the end of a way back to the anchor, within the limits all along.
    pub(crate) fn is_reeled_in_along(&self, way: &[Point]) -> bool {
        let mut cable = self.cable.clone();
        self.is_borne(&mut cable, way) && {
            cable.drag_to(self.config.anchor);
            cable.length_m() <= LEFT_M
        }
    }

    fn is_borne(&self, cable: &mut Cable, way: &[Point]) -> bool {
        let (before, limits) = (self.load(cable), self.usable());
        polyline::resampled(way, STEP_M).iter().all(|at| {
            cable.drag_to(*at);
            self.load(cable).is_within(&limits, &before)
        })
    }

    fn load(&self, cable: &Cable) -> Load {
        let pull_n =
            self.config.reel.map_or(0.0, |reel| cable.pull_at_anchor_n(reel.drag(self.config.friction)));
        Load([cable.length_m(), cable.wrap_max_rad(), cable.wrap_total_rad(), pull_n])
    }

    fn usable(&self) -> Load {
        let Limits { reel_length_m, wrap_max_rad, wrap_total_max_rad } = self.config.limits;
        let reel_n = self.config.reel.map_or(f64::INFINITY, |reel| reel.limits(self.config.friction).reel_n);
        let [wrap_rad, total_rad, pull_n] =
            [wrap_max_rad, wrap_total_max_rad, reel_n].map(|limit| limit * (1.0 - RESERVE_SHARE));
        Load([usable_m(reel_length_m), wrap_rad, total_rad, pull_n])
    }
}

fn usable_m(reel_length_m: f64) -> f64 {
    reel_length_m - RESERVE_M.min(0.5 * reel_length_m)
}
