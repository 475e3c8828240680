//! How near the hull comes to its own taut cable on the way in.
//!
//! The cable leads straight away from the robot up to its last bend. A hull that reaches a part beyond that bend stands on its
//! own cable. If the reel then fails to take the cable up, the robot drives onto it.

use super::{
    cable::{Cable, TetherError},
    case::Case,
    ground::Ground,
};
use geometry::{Point, polyline};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Distance between the places on a path at which the gap is measured, metres.
const STEP_M: f64 = 0.1;
/// Length of cable next to the robot that does not count, in radii of the hull: it leads away from the robot. The simulated
/// cable counts in the same way (`cable::Chain::is_under`).
const LEADS_AWAY: f64 = 3.0;
/// Change of the length below which the cable counts as neither paid out nor taken up, metres.
const SAME_M: f64 = 1e-6;

/// The least distance between a hull and its own taut cable while the cable is taken up.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct OwnGap {
    /// Least distance from the edge of the hull to the cable beyond its last bend before the robot, metres; negative if the
    /// path leads over the cable.
    pub gap_m: f64,
    /// Where the robot is then, tank frame.
    pub at: Point,
}

impl OwnGap {
    /// Returns the figure as text: `0.12 m at -2.5, 5.1 m`.
    ///
    /// ```
    /// use world::{Point, tether::OwnGap};
    /// let gap = OwnGap { gap_m: 0.123, at: Point::new(-2.54, 5.1) };
    /// assert_eq!(gap.text(), "0.12 m at -2.5, 5.1 m");
    /// ```
    pub fn text(&self) -> String {
        format!("{:.2} m at {:.1}, {:.1} m", self.gap_m, self.at.x, self.at.y)
    }

    /// Measures a path at places [`STEP_M`] apart; `None` if the cable bends nowhere while it is taken up.
    ///
    /// # Errors
    /// As for `certify`.
    pub(super) fn on(case: &Case<'_>, ground: &Ground) -> Result<Option<Self>, TetherError> {
        let cable = match case.cable {
            Some(cable) => cable.clone(),
            None => Cable::on(case.anchor, Arc::clone(&ground.obstacles))?,
        };
        Ok(Self::along(cable, case.path, case.room_m))
    }

    /// Measures a path of a hull with a given radius, metres, at places 0.1 m apart; `None` if the cable bends nowhere while it
    /// is taken up.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::{Cable, OwnGap}};
    /// let column = Shape::Disc { center: Point::new(3.0, 0.0), radius_m: 0.3 };
    /// let cable = Cable::new(Point::origin(), &Boundary::Circle { radius_m: 10.0 }, &[column]).unwrap();
    /// let path = [(0.0, 1.0), (5.0, 1.0), (5.0, -1.0), (2.0, -0.8)].map(|(x, y)| Point::new(x, y));
    /// let gap = OwnGap::along(cable.clone(), &path, 0.2).unwrap();
    /// assert!(gap.gap_m > 0.0 && gap.gap_m < 1.0);
    /// assert_eq!(OwnGap::along(cable, &path[..2], 0.2), None);
    /// ```
    pub fn along(mut cable: Cable, path: &[Point], hull_m: f64) -> Option<Self> {
        let mut least: Option<Self> = None;
        let mut before_m = f64::NEG_INFINITY;
        for at in polyline::resampled(path, STEP_M) {
            cable.drag_to(at);
            let length_m = cable.length_m();
            let is_taken_up = length_m < before_m - SAME_M;
            before_m = length_m;
            let from_centre_m = if is_taken_up { beyond_last_bend_m(&cable, hull_m) } else { None };
            let Some(gap_m) = from_centre_m.map(|m| m - hull_m) else { continue };
            if least.is_none_or(|least| gap_m < least.gap_m) {
                least = Some(Self { gap_m, at });
            }
        }
        least
    }
}

/// Distance from the robot to the part of its taut cable beyond the last bend, metres; `None` for a straight cable.
fn beyond_last_bend_m(cable: &Cable, hull_m: f64) -> Option<f64> {
    let line = cable.taut_line();
    let leads_away_m = cable.free_span_m().max(LEADS_AWAY * hull_m);
    let (mut along_m, mut least_m) = (0.0, None::<f64>);
    for (index, pair) in line.windows(2).rev().map(|pair| (pair[1], pair[0])).enumerate() {
        let length_m = (pair.1 - pair.0).norm();
        let skipped_m = (leads_away_m - along_m).max(0.0);
        along_m += length_m;
        if index == 0 || skipped_m >= length_m {
            continue;
        }
        let from = pair.0 + (pair.1 - pair.0) * (skipped_m / length_m);
        let distance_m = (polyline::nearest_on_segment(from, pair.1, cable.tip()) - cable.tip()).norm();
        least_m = Some(least_m.map_or(distance_m, |least_m| least_m.min(distance_m)));
    }
    least_m
}

#[cfg(test)]
mod tests {
    use super::super::{Limits, PullLimits, Reel, certify};
    use super::*;
    use crate::tank::{Obstacle, ObstacleId};
    use geometry::{Boundary, Shape};
    use proptest::prelude::*;

    const HULL_M: f64 = 0.2;

    fn pull() -> PullLimits {
        let reel = Reel {
            mass_kg_per_m: 0.1,
            floor_friction: 0.3,
            pull_n: 1e3,
            pay_out_n: 0.5,
            robot_pull_n: None,
            pull_ratio_max: 0.8,
        };
        reel.limits(0.3)
    }

    /// The gap on a path from the anchor at the origin, with a column of radius 0.5 m at (4, 0).
    fn gap(path: &[(f64, f64)], pull: Option<PullLimits>) -> Option<OwnGap> {
        let shape = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
        let column = Obstacle { id: ObstacleId(1), name: "C".into(), shape, known: true };
        let path: Vec<Point> = path.iter().map(|(x, y)| Point::new(*x, *y)).collect();
        let case = Case {
            path: &path,
            anchor: Point::origin(),
            cable: None,
            boundary: &Boundary::Circle { radius_m: 12.0 },
            obstacles: &[column],
            room_m: HULL_M,
            limits: Limits { reel_length_m: 99.0, wrap_max_rad: 99.0, wrap_total_max_rad: 99.0 },
            pull,
            returns: false,
            cuts: &[],
        };
        certify(&case).unwrap().own_gap
    }

    #[test]
    fn only_the_cable_beyond_its_last_bend_counts_and_only_while_it_is_taken_up() {
        let out = [(0.0, 0.0), (4.0, 2.0), (8.0, 0.0), (6.0, -2.0)];
        assert_eq!(gap(&out[..3], Some(pull())), None, "out only");
        assert_eq!(gap(&[(0.0, 0.0), (8.0, 3.0), (1.0, 0.5)], Some(pull())), None, "straight");
        assert_eq!(gap(&[out.as_slice(), &[(0.5, 0.0)]].concat(), None), None, "the reel is not described");
        // With the cable round three sides of the column, the robot drives toward it across the span from the anchor.
        let over = gap(&[out.as_slice(), &[(0.0, -5.0), (2.6, 1.0)]].concat(), Some(pull()));
        assert!(over.is_some_and(|gap| (-0.12..-0.08).contains(&gap.gap_m)), "{over:?}");
        // In again on the side where it drove out, the cable loses its bend where the robot comes onto the tangent from the
        // anchor: 2.48 m from the bend.
        let path = [out[0], out[1], out[2], (4.0, 2.0), (0.0, 0.5)];
        let beside = gap(&path, Some(pull())).unwrap();
        assert!((2.2..2.36).contains(&beside.gap_m), "{beside:?}");
    }

    proptest! {
        #[test]
        fn the_gap_is_never_less_than_the_overlap_with_the_whole_hull(
            path in prop::collection::vec((-8.0..8.0_f64, -8.0..8.0_f64), 2..8),
        ) {
            if let Some(gap) = gap(&path, Some(pull())) {
                prop_assert!(gap.gap_m.is_finite() && gap.gap_m >= -HULL_M);
                prop_assert!(gap.at.coords.norm() <= 12.0);
            }
        }
    }
}
