//! The exact shortest path of a disc among discs, polygons and polylines.
//!
//! Everything solid is grown by the distance that the centre of the robot keeps from it, so that the robot is a point:
//! discs stay discs, corners become arcs. The shortest path then consists of common tangents of those circles and of arcs
//! between them (the visibility graph of round obstacles). Tangents are constructed only where A* arrives, and tested
//! only when they come first in its queue. Nothing is rasterised, so a search that finds nothing proves that there is no
//! path.
//!
//! Frame: the tank frame, metres, radians. Outlines may overlap. The robot may pass along two that touch, not between them.
//! Cost: about `n` tangents for every arc that the search turns about, `n` the number of discs and corners.

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

/// The first length within which a shortest path is looked for: this share of the straight way, and so many metres more.
const FIRST_SHARE: f64 = 1.2;
const FIRST_M: f64 = 1.0;
/// A search among less than this fraction of all corners is worth a try.
const FEW: usize = 8;
/// More than rounding may do to the length of a path, metres.
const SURE_M: f64 = 1e-6;

impl GrownFloor {
    /// The shortest path from a start to a goal; `keep_going` is asked now and then whether the answer is still wanted.
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
    /// [`NoWay`]: the robot does not fit at an end, there is no path, or the caller stopped the search.
    pub fn shortest(
        &self,
        start: Point,
        goal: Point,
        keep_going: &mut dyn FnMut() -> bool,
    ) -> Result<Way, NoWay> {
        self.check_ends(start, goal)?;
        // Among many corners those far from both ends are left out first: a way that is shorter than any way to them is the
        // shortest of all.
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

    /// The corners about which a way of this length can turn, metres.
    fn corners_within(&self, within_m: f64, start: Point, goal: Point) -> Vec<usize> {
        let least_m = |Corner { center, radius_m, .. }: &Corner| {
            (center - start).norm() + (goal - center).norm() - 2.0 * radius_m
        };
        (0..self.corners.len()).filter(|index| least_m(&self.corners[*index]) <= within_m).collect()
    }

    /// A path pulled taut: the shortest one that turns only about discs and corners within `reach_m` of it.
    ///
    /// The path itself may touch anything; only its ends and its neighbourhood matter.
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
    /// As [`GrownFloor::shortest`], but [`NoWay::Unreachable`] means only that the neighbourhood was too small.
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
        // A point that is not a number fits nowhere.
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
