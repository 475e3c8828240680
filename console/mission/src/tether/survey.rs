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

/// The state of a cable, as far as it is limited: length in metres, largest and total wrap in radians, pull of the reel
/// and of the robot in newtons.
#[derive(Clone, Copy)]
struct Load([f64; 5]);

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
        let [reel_n, robot_n] = self.config.reel.map_or([0.0; 2], |reel| {
            let drag = reel.drag(self.config.friction);
            [cable.pull_at_anchor_n(drag), cable.pull_at_robot_n(drag, reel.paying_out_n())]
        });
        Load([cable.length_m(), cable.wrap_max_rad(), cable.wrap_total_rad(), reel_n, robot_n])
    }

    fn usable(&self) -> Load {
        let Limits { reel_length_m, wrap_max_rad, wrap_total_max_rad } = self.config.limits;
        let reel_n = self.config.reel.map_or(f64::INFINITY, |reel| reel.pull_n);
        let robot_n = self.config.reel.and_then(|reel| reel.robot_pull_n).unwrap_or(f64::INFINITY);
        let [wrap_rad, total_rad, reel_n, robot_n] =
            [wrap_max_rad, wrap_total_max_rad, reel_n, robot_n].map(|limit| limit * (1.0 - RESERVE_SHARE));
        Load([usable_m(reel_length_m), wrap_rad, total_rad, reel_n, robot_n])
    }
}

fn usable_m(reel_length_m: f64) -> f64 {
    reel_length_m - RESERVE_M.min(0.5 * reel_length_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::TetherConfig;
    use world::{Boundary, World, tether::Reel};

    /// A tether with a friction of 0.98 N for each metre on the floor.
    fn tether(reel_n: f64, robot_n: Option<f64>) -> Tether {
        let reel = Reel {
            mass_kg_per_m: 0.2,
            floor_friction: 0.5,
            pull_n: reel_n,
            pay_out_n: 0.5,
            robot_pull_n: robot_n,
            pull_ratio_max: 0.8,
        };
        let limits = Limits { reel_length_m: 20.0, wrap_max_rad: 3.0, wrap_total_max_rad: 6.0 };
        let anchor = Point::new(0.0, 0.0);
        let config =
            TetherConfig { anchor, limits, friction: 0.3, reel: Some(reel), allow_uncertified: false };
        let boundary = Boundary::Circle { radius_m: 10.0 };
        let world = World { boundary, obstacles: Vec::new(), stations: Vec::new(), zones: Vec::new() };
        Tether::new(&config, 0.2, &world, anchor).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn a_way_on_which_the_reel_or_the_robot_would_have_to_pull_too_much_is_refused() {
        // At 6 m, taking up needs 5.9 N, and paying out 5.9 N more than the pull that the reel keeps; a tenth of each limit is
        // kept in reserve.
        let way = [Point::new(0.0, 0.0), Point::new(6.0, 0.0)];
        for (reel_n, robot_n, is_borne) in
            [(8.0, None, true), (8.0, Some(16.0), true), (8.0, Some(15.0), false), (6.0, Some(20.0), false)]
        {
            let tether = tether(reel_n, robot_n);
            assert_eq!(tether.bears_with_reserve(&way), is_borne, "{reel_n} N, {robot_n:?} N");
        }
    }
}
