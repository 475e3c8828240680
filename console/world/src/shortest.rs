//! Computes the exact shortest path of a disc among discs, polygons and polylines.
//!
//! All solids are grown by the distance that the centre of the robot keeps from them, so that the robot becomes a
//! point: discs stay discs, corners become arcs. The shortest path then consists of common tangents of these circles
//! and of arcs between them (the visibility graph of round obstacles). Tangents are constructed only where A*
//! arrives, and tested only when they come first in its queue. Nothing is rasterised, so a search that finds nothing
//! proves that no path exists.
//!
//! Frame: the tank frame, metres, radians. Outlines may overlap. The robot may pass beside two outlines that touch,
//! but not between them. Cost: about `n` tangents for every arc in the search, where `n` is the number of discs and
//! corners.

mod bar;
mod corner;
mod grown_floor;
mod search;
mod tangent;
mod way;

pub use grown_floor::GrownFloor;
pub use way::{NoWay, Piece, Way};

use bar::TOUCH_M;
use corner::Corner;
use geometry::{Point, polyline::nearest_on_segment};
use search::Search;

/// The length limit of the first search is this multiple of the straight distance, plus `FIRST_M` metres.
const FIRST_SHARE: f64 = 1.2;
const FIRST_M: f64 = 1.0;
/// A restricted search is tried only if it uses fewer than one in `FEW` corners.
const FEW: usize = 8;
/// A difference in path length that exceeds any rounding error, metres.
const SURE_M: f64 = 1e-6;

impl GrownFloor {
    /// Finds the shortest path from a start to a goal. The search stops if `keep_going`, which it calls from time to
    /// time, returns false.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, shortest::GrownFloor};
    /// let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// let floor = GrownFloor::new(&Boundary::Circle { radius_m: 10.0 }, 0.5, [(&column, 0.5)]);
    /// let path = floor.shortest(Point::origin(), Point::new(8.0, 0.0), &mut || true).unwrap();
    /// assert!((path.length_m - 8.2513).abs() < 1e-4, "two tangents and an arc of radius 1 m");
    /// ```
    ///
    /// # Errors
    /// [`NoWay`]: the robot does not fit at one end, no path exists, or the caller stopped the search.
    pub fn shortest(
        &self,
        start: Point,
        goal: Point,
        keep_going: &mut dyn FnMut() -> bool,
    ) -> Result<Way, NoWay> {
        self.check_ends(start, goal)?;
        // If there are many corners, those far from both ends are left out at first. If the path found is shorter than
        // any path by way of an omitted corner could be, it is the shortest of all.
        let mut within_m = FIRST_SHARE * (goal - start).norm() + FIRST_M;
        loop {
            let near = self.corners_within(within_m, start, goal);
            if near.len() * FEW >= self.corners.len() {
                break;
            }
            match self.search(start, goal, &near, keep_going) {
                Ok(way) if way.length_m + SURE_M < within_m => return Ok(way),
                Err(NoWay::Stopped) => return Err(NoWay::Stopped),
                _ => within_m *= 2.0,
            }
        }
        let all: Vec<usize> = (0..self.corners.len()).collect();
        self.search(start, goal, &all, keep_going)
    }

    /// Returns the corners that a path of this length, metres, can turn about.
    fn corners_within(&self, within_m: f64, start: Point, goal: Point) -> Vec<usize> {
        let least_m = |Corner { center, radius_m, .. }: &Corner| {
            (center - start).norm() + (goal - center).norm() - 2.0 * radius_m
        };
        (0..self.corners.len()).filter(|index| least_m(&self.corners[*index]) <= within_m).collect()
    }

    /// Pulls a path taut: returns the shortest path that turns only about discs and corners within `reach_m` of the
    /// given path.
    ///
    /// The given path may pass through anything; only its ends and its neighbourhood matter.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, shortest::GrownFloor};
    /// let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// let floor = GrownFloor::new(&Boundary::Circle { radius_m: 10.0 }, 0.5, [(&column, 0.5)]);
    /// let bent = [Point::origin(), Point::new(4.0, 1.5), Point::new(8.0, 0.0)];
    /// assert!((floor.pulled_taut(&bent, 1.0, &mut || true).unwrap().length_m - 8.2513).abs() < 1e-4);
    /// ```
    ///
    /// # Errors
    /// As for [`GrownFloor::shortest`], but [`NoWay::Unreachable`] only means that the neighbourhood was too small.
    pub fn pulled_taut(
        &self,
        path: &[Point],
        reach_m: f64,
        keep_going: &mut dyn FnMut() -> bool,
    ) -> Result<Way, NoWay> {
        let [start, .., goal] = path else { return Err(NoWay::Unreachable { n_tangents: 0 }) };
        self.check_ends(*start, *goal)?;
        let is_near = |corner: &Corner| {
            let near_m = corner.radius_m + reach_m;
            path.windows(2).any(|pair| {
                (corner.center - nearest_on_segment(pair[0], pair[1], corner.center)).norm_squared()
                    < near_m * near_m
            })
        };
        let near: Vec<usize> =
            (0..self.corners.len()).filter(|index| is_near(&self.corners[*index])).collect();
        self.search(*start, *goal, &near, keep_going)
    }

    fn check_ends(&self, start: Point, goal: Point) -> Result<(), NoWay> {
        // A point with a NaN coordinate fits nowhere.
        let short_m = |at: Point| Some(-self.spare_m(at)).filter(|by_m| *by_m > TOUCH_M || by_m.is_nan());
        if let Some(by_m) = short_m(start) {
            return Err(NoWay::StartBlocked { at: start, by_m });
        }
        short_m(goal).map_or(Ok(()), |by_m| Err(NoWay::GoalBlocked { at: goal, by_m }))
    }

    fn search(
        &self,
        start: Point,
        goal: Point,
        corners: &[usize],
        keep_going: &mut dyn FnMut() -> bool,
    ) -> Result<Way, NoWay> {
        if (goal - start).norm() < TOUCH_M {
            return Ok(Way { pieces: vec![Piece::Straight { from: start, to: goal }], length_m: 0.0 });
        }
        Search::new(self, start, goal, corners).run(keep_going)
    }
}

#[cfg(test)]
mod tests;
