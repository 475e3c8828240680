//! The scanning tool, and the floor that it passes over.

use super::span::Capsule;
use geometry::{Point, Pose, Vector, polyline::nearest_on_segment, shape::bounds_of, wrap_angle_rad};
use serde::{Deserialize, Serialize};

/// The largest turn of the tool between two poses that are close together, radians.
const TURN_STEP_RAD: f64 = 0.1;

/// The shape of the scanning tool.
///
/// ```
/// assert_eq!(world::Tool::Bar { swath_m: 0.6 }.swath_m(), 0.6);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tool {
    /// A bar across the heading, through the robot's centre, as on inspection robots.
    Bar {
        /// The length of the bar, metres.
        swath_m: f64,
    },
    /// A disc about the robot's centre, for robots without a heading.
    Disc {
        /// The diameter of the disc, metres.
        swath_m: f64,
    },
}

impl Tool {
    /// Returns the width of the strip that is scanned in one pass, metres.
    ///
    /// ```
    /// assert_eq!(world::Tool::Disc { swath_m: 0.6 }.swath_m(), 0.6);
    /// ```
    pub fn swath_m(self) -> f64 {
        match self {
            Self::Bar { swath_m } | Self::Disc { swath_m } => swath_m,
        }
    }

    /// Returns the tool narrowed by `by_m` metres on each side; `None` if nothing is left.
    ///
    /// ```
    /// use world::Tool;
    /// assert_eq!(Tool::Bar { swath_m: 0.5 }.narrowed(0.125), Some(Tool::Bar { swath_m: 0.25 }));
    /// assert_eq!(Tool::Disc { swath_m: 0.5 }.narrowed(0.25), None);
    /// ```
    #[must_use]
    pub fn narrowed(self, by_m: f64) -> Option<Self> {
        let swath_m = self.swath_m() - 2.0 * by_m;
        (swath_m > 0.0).then_some(match self {
            Self::Bar { .. } => Self::Bar { swath_m },
            Self::Disc { .. } => Self::Disc { swath_m },
        })
    }

    /// Splits a path into pairs of poses that are close together, and calls `pass` with each pair. The robot drives
    /// forward and turns on the spot at corners.
    ///
    /// ```
    /// use world::{Point, Tool};
    /// let path = [Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(1.0, 1.0)];
    /// let mut headings = Vec::new();
    /// Tool::along(&path, |from, _| headings.push(from.heading_rad));
    /// assert!(headings.len() > 10 && headings[0] == 0.0);
    /// assert!((headings[headings.len() - 1] - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    /// ```
    pub fn along(path: &[Point], mut pass: impl FnMut(Pose, Pose)) {
        let mut before: Option<f64> = None;
        for pair in path.windows(2).filter(|pair| (pair[1] - pair[0]).norm() > 1e-9) {
            let way = pair[1] - pair[0];
            let heading_rad = way.y.atan2(way.x);
            let at = |position: Point, heading_rad: f64| Pose { position, heading_rad };
            let from_rad = before.replace(heading_rad).unwrap_or(heading_rad);
            let turn = wrap_angle_rad(heading_rad - from_rad);
            let n = (turn.abs() / TURN_STEP_RAD).ceil();
            for k in 0..n as usize {
                let turned = |k: f64| at(pair[0], from_rad + turn * k / n);
                pass(turned(k as f64), turned(k as f64 + 1.0));
            }
            pass(at(pair[0], heading_rad), at(pair[1], heading_rad));
        }
    }

    /// Returns the area that the tool sweeps between two poses that are close together.
    pub(super) fn passage(self, from: Pose, to: Pose) -> Passage {
        match self {
            Self::Bar { swath_m } => Passage::Bar(Swept::new(swath_m, from, to)),
            Self::Disc { swath_m } => {
                let (from, to, reach_m) = (from.position, to.position, swath_m / 2.0);
                let around = Capsule::new([from, to], reach_m + BESIDE_M);
                Passage::Disc { from, to, reach_m, most_m2: most_squared(reach_m), around }
            }
        }
    }
}

/// The area that a tool sweeps.
#[expect(clippy::large_enum_variant, reason = "created and dropped within a tick, never stored")]
pub(super) enum Passage {
    Bar(Swept),
    Disc {
        from: Point,
        to: Point,
        reach_m: f64,
        /// The largest squared distance that counts as within reach. Comparing squares gives exactly the same result as
        /// comparing distances.
        most_m2: f64,
        /// A capsule slightly larger than the area.
        around: Capsule,
    },
}

impl Passage {
    /// Returns the south-west and north-east corners of the bounding box.
    pub(super) fn bounds(&self) -> (Point, Point) {
        match self {
            Self::Bar(swept) => (swept.low, swept.high),
            Self::Disc { from, to, reach_m, .. } => {
                let reach = Vector::new(*reach_m, *reach_m);
                (from.inf(to) - reach, from.sup(to) + reach)
            }
        }
    }

    /// Returns the west and east ends of the area at a given `y`, or points slightly beyond them.
    #[inline]
    pub(super) fn ends_at(&self, y: f64) -> (f64, f64) {
        match self {
            Self::Bar(swept) => swept.ends_at(y),
            Self::Disc { around, .. } => around.span(y).unwrap_or((f64::INFINITY, f64::NEG_INFINITY)),
        }
    }

    /// Whether the area is a single span at every `y`.
    #[inline]
    pub(super) fn is_convex(&self) -> bool {
        match self {
            Self::Bar(swept) => swept.is_convex,
            Self::Disc { .. } => true,
        }
    }

    #[inline]
    pub(super) fn contains(&self, point: Point) -> bool {
        match self {
            Self::Bar(swept) => swept.contains(point),
            Self::Disc { from, to, most_m2, .. } => {
                (point - nearest_on_segment(*from, *to, point)).norm_squared() <= *most_m2
            }
        }
    }
}

/// Returns the largest number whose square root, as rounded by the processor, does not exceed `root`. Comparing
/// squares with it gives the same result as comparing roots with `root`, in half the time.
fn most_squared(root: f64) -> f64 {
    if root.is_nan() || root < 0.0 {
        return f64::NEG_INFINITY;
    }
    let mut square = root * root;
    while square.is_finite() && square.next_up().sqrt() <= root {
        square = square.next_up();
    }
    while square.sqrt() > root {
        square = square.next_down();
    }
    square
}

/// Distance outside a triangle at which a point still counts as inside, metres, so that adjacent triangles leave no
/// gap.
const SEAM_M: f64 = 1e-9;
/// The margin added to the band on each side of the area, and to the capsule around the area, metres.
const BESIDE_M: f64 = 1e-3;

/// The area that a bar sweeps between two poses that are close together: two triangles for each half.
pub(super) struct Swept {
    low: Point,
    high: Point,
    triangles: [Triangle; 4],
    /// The direction perpendicular to the bar, and the band in this direction that contains the area.
    ahead: Vector,
    band: (f64, f64),
    is_convex: bool,
}

impl Swept {
    fn new(swath_m: f64, from: Pose, to: Pose) -> Self {
        let half =
            |pose: Pose| Vector::new(-pose.heading_rad.sin(), pose.heading_rad.cos()) * (swath_m / 2.0);
        let (a, b) = (from.position, to.position);
        let (from, to) = (half(from), half(to));
        let (a_left, a_right, b_left, b_right) = (a + from, a - from, b + to, b - to);
        let (low, high) = bounds_of(&[a, b, a_left, a_right, b_left, b_right]);
        let ahead = Vector::new(from.y, -from.x) * 2.0 / swath_m;
        let along = [a_left, a_right, b_left, b_right].map(|corner| ahead.dot(&corner.coords));
        let band = (
            along.into_iter().fold(f64::INFINITY, f64::min) - BESIDE_M,
            along.into_iter().fold(f64::NEG_INFINITY, f64::max) + BESIDE_M,
        );
        let corners = [[a, a_left, b_left], [a, b_left, b], [a, a_right, b_right], [a, b_right, b]];
        let is_convex = is_convex([a_left, b_left, b_right, a_right]);
        Self { low, high, triangles: corners.map(Triangle::new), ahead, band, is_convex }
    }

    /// Returns where the band begins and ends at a given `y`.
    #[inline]
    fn ends_at(&self, y: f64) -> (f64, f64) {
        let at = |along: f64| (along - self.ahead.y * y) / self.ahead.x;
        let (one, other) = (at(self.band.0), at(self.band.1));
        if one.is_finite() && other.is_finite() {
            (one.min(other), one.max(other))
        } else {
            (f64::NEG_INFINITY, f64::INFINITY)
        }
    }

    #[inline]
    fn contains(&self, point: Point) -> bool {
        self.triangles.iter().any(|triangle| triangle.contains(point))
    }
}

/// Whether an outline bends in the same direction at each of its four corners, and is straight at none.
fn is_convex(corners: [Point; 4]) -> bool {
    let bend = |k: usize| {
        let [a, b, c] = [0, 1, 2].map(|next| corners[(k + next) % 4]);
        (b - a).perp(&(c - b))
    };
    let bends = [0, 1, 2, 3].map(bend);
    bends.iter().all(|bend| *bend > SEAM_M) || bends.iter().all(|bend| *bend < -SEAM_M)
}

/// A triangle as its corners, counter-clockwise, each with the edge that starts there; `None` if it has no area.
struct Triangle(Option<[(Point, Vector); 3]>);

impl Triangle {
    fn new([a, b, c]: [Point; 3]) -> Self {
        let area = (b - a).perp(&(c - a));
        let turned = area.signum();
        Self((area != 0.0).then(|| [(a, b), (b, c), (c, a)].map(|(from, to)| (from, (to - from) * turned))))
    }

    #[inline]
    fn contains(&self, point: Point) -> bool {
        let is_left = |(from, edge): &(Point, Vector)| edge.perp(&(point - from)) >= -SEAM_M;
        self.0.as_ref().is_some_and(|edges| edges.iter().all(is_left))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Boundary, CoverageGrid, Floor, World};

    fn grid(cell_m: f64) -> CoverageGrid {
        let boundary = Boundary::Circle { radius_m: 5.0 };
        let world = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
        CoverageGrid::new(Floor::new(&world, cell_m, 0.25, 0.6, Point::origin()))
    }

    fn area_m2(grid: &CoverageGrid) -> f64 {
        grid.counts().covered as f64 * grid.floor().cell_m2()
    }

    const BAR: Tool = Tool::Bar { swath_m: 0.6 };

    #[test]
    fn a_bar_scans_length_times_swath_and_nothing_before_or_behind() {
        let mut grid = grid(0.05);
        for step in 0..100 {
            let at = |k: i32| Pose::new(-2.0 + 0.04 * f64::from(k), 0.01, 0.0);
            grid.mark(BAR, at(step), at(step + 1));
        }
        assert!((area_m2(&grid) - 4.0 * 0.6).abs() < 0.02, "{}", area_m2(&grid));
    }

    #[test]
    fn a_bar_that_turns_on_the_spot_scans_a_disc() {
        let mut grid = grid(0.05);
        for step in 0..32 {
            let at = |k: i32| Pose::new(0.013, 0.007, 0.1 * f64::from(k));
            grid.mark(BAR, at(step), at(step + 1));
        }
        let disc_m2 = std::f64::consts::PI * 0.09;
        assert!((area_m2(&grid) - disc_m2).abs() < 0.02, "{} of {disc_m2}", area_m2(&grid));
    }

    #[test]
    fn lanes_one_swath_apart_leave_no_seam() {
        let mut grid = grid(0.05);
        for lane in -2..=2 {
            for step in 0..100 {
                let at = |k: i32| Pose::new(-2.0 + 0.04 * f64::from(k), 0.6 * f64::from(lane), 0.0);
                grid.mark(BAR, at(step), at(step + 1));
            }
        }
        assert!((area_m2(&grid) - 4.0 * 3.0).abs() < 1e-9, "{}", area_m2(&grid));
    }

    #[test]
    fn no_cell_is_overlooked_whatever_the_heading() {
        let grid = grid(0.05);
        let floor = grid.floor();
        let headings = (0..48).map(|k| (0.131 * f64::from(k), 0.05 * f64::from(k % 5)));
        // The cases range from a robot that stands still, through steps of the usual length, to a bar whose ends cross.
        for (heading, turn) in headings {
            for (tool, step_m, turn) in [
                (BAR, 0.0, turn),
                (BAR, 0.04, turn),
                (BAR, 0.3, -turn),
                (BAR, 0.01, 8.0 * turn),
                (Tool::Disc { swath_m: 0.6 }, 0.0, 0.0),
                (Tool::Disc { swath_m: 0.6 }, 0.04, turn),
                (Tool::Disc { swath_m: 0.6 }, 1.3, turn),
            ] {
                let from = Pose::new(0.3, -1.2, heading);
                let to = from.moved(step_m, 0.0, turn);
                let passage = tool.passage(from, to);
                let all: Vec<usize> =
                    (0..floor.len()).filter(|cell| passage.contains(floor.center(*cell))).collect();
                let is_driven = step_m >= 0.04;
                assert!(all.len() > 3 || !is_driven, "{tool:?} {heading} {step_m} {turn}");
                assert_eq!(floor.cells_under(tool, from, to), all, "{tool:?} {heading} {step_m} {turn}");
            }
        }
    }

    #[test]
    fn squares_are_compared_as_their_roots_to_the_last_bit() {
        for k in 0..1000 {
            let root = 0.013 * f64::from(k) + 0.1 / 3.0;
            let most = most_squared(root);
            assert!(most.sqrt() <= root && most.next_up().sqrt() > root, "{root}");
        }
    }

    #[test]
    fn a_scanned_area_converges_as_the_cells_get_smaller() {
        let scanned_m2 = |cell_m: f64| {
            let mut grid = grid(cell_m);
            for step in 0..200 {
                let at = |k: i32| {
                    let angle = 0.02 * f64::from(k);
                    Pose::new(3.0 * angle.cos(), 3.0 * angle.sin(), angle + std::f64::consts::FRAC_PI_2)
                };
                grid.mark(BAR, at(step), at(step + 1));
            }
            area_m2(&grid)
        };
        let exact_m2 = 4.0 / 2.0 * (3.3_f64.powi(2) - 2.7_f64.powi(2));
        let errors = [0.2, 0.1, 0.05, 0.02].map(|cell_m| (scanned_m2(cell_m) - exact_m2).abs() / exact_m2);
        assert!(errors[3] < 0.002 && errors[2] < 0.01 && errors[1] < 0.02 && errors[0] < 0.04, "{errors:?}");
    }
}
