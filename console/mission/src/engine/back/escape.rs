//! Leads the robot away from objects that its hull is too close to.

use super::super::known::Known;
use crate::chart::Chart;
use crate::governor::Surroundings;
use world::Point;

/// Number of cells of the search on each side of the robot; the search looks at no more than `(2 N + 1)²` places.
const CELLS: i32 = 20;
/// Minimum reach of the search, metres.
const LEAST_REACH_M: f64 = 1.0;
/// Room, metres, that the place must have in addition to the required room.
const SPARE_M: f64 = 0.005;

impl Known {
    /// The nearest place with at least `room_m` metres of room for the hull's centre that the robot can reach in a
    /// straight line without coming closer to the objects on the chart that it is too close to. This is the current place,
    /// if it has enough room.
    pub(in crate::engine) fn outside(&self, chart: &Chart, room_m: f64) -> Option<Point> {
        let here = self.position();
        let is_roomy = |at: Point| chart.has_room(at, room_m + SPARE_M);
        if chart.has_room(here, room_m) {
            return Some(here);
        }
        let reach_m = (chart.depth_m(here) + room_m + SPARE_M).max(LEAST_REACH_M) + room_m;
        let governed = self.as_governed();
        let solids = chart.solids(here, reach_m + governed.limits.radius_m, &[]);
        let around = Surroundings::of(&solids, &governed);
        let step_m = reach_m / f64::from(CELLS);
        let cells = (-CELLS..=CELLS).flat_map(|x| (-CELLS..=CELLS).map(move |y| (x, y)));
        let mut places: Vec<(i32, i32)> = cells.collect();
        places.sort_unstable_by_key(|(x, y)| (x * x + y * y, *x, *y));
        let at = |(x, y): (i32, i32)| here + world::Vector::new(f64::from(x), f64::from(y)) * step_m;
        places.into_iter().map(at).find(|place| is_roomy(*place) && around.is_clear(here, *place))
    }
}
