//! Detects when the robot has left its plan by crossing a cut. If the robot then went on with the plan, the cable would
//! be wound round something.

use world::{
    Boundary, ObstacleMap, Point, Vector,
    polyline::{self, edges, nearest_on_segment},
    shape::bounds_of,
    tether::crossings,
};

/// Distance from the end of a return path within which the plan that follows counts as begun, metres.
pub(in crate::engine) const HOME_M: f64 = 0.3;

/// A cut is extended into a solid object that is at most this far from its end. The distance is a multiple of the
/// clearance that the hull needs; the multiple allows for the outlines that planners use, which are slightly larger
/// than the exact outlines.
const ROOT_SHARE: f64 = 1.1;
/// Length of that extension inside the solid object, metres.
const ROOT_M: f64 = 0.01;
/// Distance, metres, within which a move may touch a cut.
const BESIDE_M: f64 = 1e-6;

/// The lines that the plan never crosses, and whether the robot has crossed them.
#[derive(Clone, Debug, Default)]
pub(in crate::engine) struct CutsRule {
    cuts: Vec<Cut>,
    /// The point, after a return path, from which the cuts apply; `None` once the robot has been there.
    from: Option<Point>,
    seen_at: Point,
}

impl CutsRule {
    /// Creates the cuts of a plan that begins here; they apply from the point `from` on.
    pub(crate) fn new(lines: &[Vec<Point>], from: Option<Point>, here: Point, solids: &Solids<'_>) -> Self {
        Self { cuts: lines.iter().map(|line| Cut::new(solids.rooted(line))).collect(), from, seen_at: here }
    }

    /// Processes one tick with a reliable position. Returns whether the robot has crossed a cut and is now farther from
    /// it than its hull radius; close to the cut, the estimate may scatter back and forth across the cut.
    pub(crate) fn update(&mut self, here: Point, radius_m: f64) -> bool {
        let before = std::mem::replace(&mut self.seen_at, here);
        if self.from.is_some_and(|from| (here - from).norm() > HOME_M) {
            return false;
        }
        self.from = None;
        for cut in self.cuts.iter_mut().filter(|cut| cut.is_near(before, here)) {
            cut.is_beyond ^= crossings(&[before, here], std::slice::from_ref(&cut.line)) % 2 == 1;
        }
        self.cuts.iter().any(|cut| cut.is_beyond && polyline::distance_m(&cut.line, here) > radius_m)
    }

    /// Drops the cuts because the plan is abandoned.
    pub(crate) fn clear(&mut self) {
        self.cuts.clear();
    }
}

/// A line that the plan never crosses.
#[derive(Clone, Debug)]
struct Cut {
    line: Vec<Point>,
    /// South-west and north-east corners of the box around the cut.
    bounds: (Point, Point),
    /// Whether the robot is on the far side of the cut.
    is_beyond: bool,
}

impl Cut {
    fn new(line: Vec<Point>) -> Self {
        let (low, high) = bounds_of(&line);
        let beside = Vector::new(BESIDE_M, BESIDE_M);
        Self { line, bounds: (low - beside, high + beside), is_beyond: false }
    }

    /// Whether a move may cross the cut. This test saves time: a plan for a large tank has a hundred cuts, but the robot
    /// is near only one of them.
    fn is_near(&self, from: Point, to: Point) -> bool {
        let ((low, high), (west, east)) = (self.bounds, (from.inf(&to), from.sup(&to)));
        west.x <= high.x && west.y <= high.y && east.x >= low.x && east.y >= low.y
    }
}

/// Everything solid on the floor, as far as planners know it.
#[derive(Clone, Copy)]
pub(in crate::engine) struct Solids<'a> {
    pub boundary: &'a Boundary,
    pub map: &'a ObstacleMap,
    /// Distance that the hull's centre must keep from solid objects, metres.
    pub room_m: f64,
}

impl Solids<'_> {
    /// Extends a cut so that it runs from one solid object to another. Many cuts begin at the edge of the clearance round
    /// a column or a wall. Scatter could move the robot across such a cut and back round its end, and the robot would
    /// then count as beyond the cut for good.
    fn rooted(&self, cut: &[Point]) -> Vec<Point> {
        let before = cut.first().and_then(|end| self.root(*end));
        let behind = cut.last().and_then(|end| self.root(*end));
        before.into_iter().chain(cut.iter().copied()).chain(behind).collect()
    }

    /// The point slightly inside the solid object that is next to the end of a cut.
    fn root(&self, end: Point) -> Option<Point> {
        let reach_m = ROOT_SHARE * self.room_m;
        let of_obstacles =
            self.map.within(end, reach_m).into_iter().map(|near| (near.distance_m, near.closest));
        let nearest = of_obstacles.chain(self.wall_beside(end)).min_by(|a, b| a.0.total_cmp(&b.0));
        let (distance_m, closest) = nearest.filter(|(distance_m, _)| (0.0..=reach_m).contains(distance_m))?;
        let onward: Vector = (closest - end).try_normalize(1e-9)?;
        Some(end + onward * (distance_m + ROOT_M))
    }

    /// Distance to the nearest straight wall, metres, and the nearest point on it.
    fn wall_beside(&self, at: Point) -> Option<(f64, Point)> {
        let Boundary::Polygon { vertices } = self.boundary else { return None };
        let places = edges(vertices).map(|(a, b)| nearest_on_segment(a, b, at));
        places.map(|place| ((place - at).norm(), place)).min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::{Obstacle, ObstacleId, Shape};

    /// A tank with a column of radius 0.3 m in the middle. The cut begins at the edge of the clearance around the
    /// column (0.3 m) and runs east.
    fn strays(ways: &[(f64, f64)]) -> bool {
        let shape = Shape::Disc { center: Point::origin(), radius_m: 0.3 };
        let column = Obstacle { id: ObstacleId(0), name: "C".into(), shape, known: true };
        let boundary = Boundary::Circle { radius_m: 3.0 };
        let map = ObstacleMap::new(&boundary, &[column]);
        let solids = Solids { boundary: &boundary, map: &map, room_m: 0.3 };
        let cut = vec![Point::new(0.605, 0.0), Point::new(3.0, 0.0)];
        let mut rule = CutsRule::new(&[cut], None, Point::new(0.62, -0.02), &solids);
        ways.iter().any(|(x, y)| rule.update(Point::new(*x, *y), 0.2))
    }

    #[test]
    fn a_robot_that_scatters_across_a_cut_and_comes_back_round_its_end_has_not_strayed() {
        assert!(!strays(&[(0.62, 0.01), (0.585, -0.01), (0.6, -1.0)]));
    }

    #[test]
    fn a_robot_that_stays_beyond_a_cut_has_strayed_whichever_way_it_went() {
        assert!(strays(&[(0.62, 0.01), (0.6, 1.0)]));
        assert!(
            strays(&[(0.585, -0.01), (0.585, 0.01), (0.6, 1.0)]),
            "the robot passes between the cut and the column"
        );
    }
}
