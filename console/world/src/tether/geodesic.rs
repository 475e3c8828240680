//! Shortest paths from the anchor to any point, whatever path the robot took: the shortest cable that would suffice.

use super::{
    cable::Cable,
    cable_obstacles::{CableObstacles, Post, tangent_point},
};
use crate::total::Total;
use geometry::{Point, unit_vector, wrap_angle_rad};
use std::{
    cmp::Reverse,
    collections::{BTreeMap, BinaryHeap},
    f64::consts::{PI, TAU},
    sync::Arc,
};

/// Difference below which two lengths count as equal, metres.
const SAME_M: f64 = 1e-9;

/// The tangent graph of the posts, searched once from the anchor by Dijkstra's algorithm.
///
/// ```
/// use std::sync::Arc;
/// use world::{Boundary, Point, Shape, tether::{CableObstacles, Geodesic}};
/// let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
/// let obstacles = Arc::new(CableObstacles::new(&Boundary::Circle { radius_m: 10.0 }, &[column]));
/// let paths = Geodesic::new(Point::origin(), obstacles);
/// assert!((paths.distance_m(Point::new(8.0, 0.0)) - 8.0626).abs() < 1e-4);
/// ```
#[derive(Debug, Clone)]
pub struct Geodesic {
    obstacles: Arc<CableObstacles>,
    anchor: Point,
    arrivals: Vec<Arrival>,
    /// The arrivals by post and side: at twice the index of the post, plus one for the left-hand side.
    at_post: Vec<Vec<Arrival>>,
    /// The length up to which paths to each post are searched for, metres.
    most_m: Vec<f64>,
}

/// A shortest path that has reached a post.
#[derive(Debug, Clone, Copy)]
struct Arrival {
    /// The last segment of the path.
    segment: (Point, Point),
    /// Index of the arrival that this one continues.
    from: Option<usize>,
    post: usize,
    side: f64,
    bearing_rad: f64,
    length_m: f64,
}

impl Arrival {
    fn slot(&self) -> usize {
        2 * self.post + usize::from(self.side > 0.0)
    }
}

/// Paths to posts that are waiting for their turn, shortest first.
#[derive(Default)]
struct Waiting {
    paths: Vec<Arrival>,
    /// For each path: its length, two tie-breakers, and its index.
    queue: BinaryHeap<Reverse<(Total, usize, bool, usize)>>,
}

impl Waiting {
    fn add(&mut self, path: Arrival) {
        self.queue.push(Reverse((Total(path.length_m), path.post, path.side > 0.0, self.paths.len())));
        self.paths.push(path);
    }

    fn shortest(&mut self) -> Option<Arrival> {
        self.queue.pop().map(|Reverse((_, _, _, index))| self.paths[index])
    }
}

impl Geodesic {
    /// Computes all shortest paths from an anchor, tank frame; costs about `posts^2` tangents and as many lines of
    /// sight.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use world::{Boundary, Point, tether::{CableObstacles, Geodesic}};
    /// let empty = Arc::new(CableObstacles::new(&Boundary::Circle { radius_m: 10.0 }, &[]));
    /// assert_eq!(Geodesic::new(Point::origin(), empty).distance_m(Point::new(3.0, 4.0)), 5.0);
    /// ```
    pub fn new(anchor: Point, obstacles: Arc<CableObstacles>) -> Self {
        let most_m = vec![f64::INFINITY; obstacles.posts.len()];
        Self::searched(anchor, obstacles, most_m)
    }

    /// Computes only the paths that may be needed to reach the given places. Each place comes with an upper bound for
    /// the length of the path to it, metres.
    fn toward(anchor: Point, obstacles: Arc<CableObstacles>, places: &[(Point, f64)]) -> Self {
        let squares = longest_by_square(places);
        let most_m = |post: &Post| {
            let spare_m = squares.iter().map(|(middle, enough_m)| enough_m - (middle - post.center).norm());
            spare_m.fold(f64::NEG_INFINITY, f64::max) + post.radius_m + SQUARE_M
        };
        let most_m = obstacles.posts.iter().map(most_m).collect();
        Self::searched(anchor, obstacles, most_m)
    }

    fn searched(anchor: Point, obstacles: Arc<CableObstacles>, most_m: Vec<f64>) -> Self {
        let at_post = vec![Vec::new(); 2 * obstacles.posts.len()];
        let mut found = Self { obstacles, anchor, arrivals: Vec::new(), at_post, most_m };
        found.search();
        found
    }

    /// Runs Dijkstra's algorithm; a tangent is tested only when its turn comes.
    fn search(&mut self) {
        let in_sight: Vec<bool> =
            self.obstacles.posts.iter().map(|post| self.is_in_plain_sight(post)).collect();
        let mut waiting = Waiting::default();
        self.onward(None, |_| true).for_each(|path| waiting.add(path));
        while let Some(next) = waiting.shortest() {
            if self.is_beaten(&next) || !self.is_free(&next) {
                continue;
            }
            let index = self.arrivals.len();
            self.arrivals.push(next);
            self.at_post[next.slot()].push(next);
            for path in self.onward(Some(index), |post| !in_sight[post]).filter(|path| !self.is_beaten(path))
            {
                waiting.add(path);
            }
        }
    }

    /// Whether nothing stands between the anchor and a round post, and nothing touches the post. If so, the shortest
    /// path to any point on its outline is either straight, or a tangent and then a part of the outline; it never leads
    /// around another post.
    fn is_in_plain_sight(&self, post: &Post) -> bool {
        let way = post.center - self.anchor;
        let far = way.norm();
        if post.radius_m <= 0.0
            || far <= post.radius_m
            || !self.obstacles.sidestep.is_alone(post.center, post.radius_m)
        {
            return false;
        }
        let target = |side: f64| (post.center, post.radius_m, side);
        let rays = [1.0, -1.0].map(|side| tangent((self.anchor, 0.0, 0.0), target(side)));
        let [Some(right), Some(left)] = rays else { return false };
        let is_open = |side: f64, bearing_rad: f64| {
            self.sees(self.anchor, tangent_point(post.center, post.radius_m, side, bearing_rad))
        };
        let (low, high) = (unit_vector(right), unit_vector(left));
        let is_between = |other: &Post| {
            let at = other.center - self.anchor;
            low.perp(&at) >= 0.0 && high.perp(&at) <= 0.0 && at.norm() < far
        };
        is_open(1.0, right) && is_open(-1.0, left) && !self.obstacles.posts.iter().any(is_between)
    }

    /// Returns the tangents to some of the posts that continue an arrival, or leave the anchor.
    fn onward(&self, from: Option<usize>, is_meant: impl Fn(usize) -> bool) -> impl Iterator<Item = Arrival> {
        let base = from.map(|index| (self.arrivals[index], self.obstacles.posts[self.arrivals[index].post]));
        let start = base.map_or((self.anchor, 0.0, 0.0), |(a, post)| (post.center, post.radius_m, a.side));
        let is_near = move |post: usize| {
            let target = self.obstacles.posts[post];
            let gap_m = (target.center - start.0).norm() - start.1 - target.radius_m;
            base.map_or(0.0, |(a, _)| a.length_m) + gap_m.max(0.0) <= self.most_m[post]
        };
        (0..self.obstacles.posts.len())
            .filter(move |post| {
                is_near(*post) && base.is_none_or(|(a, _)| a.post != *post) && is_meant(*post)
            })
            .flat_map(|post| [(post, 1.0), (post, -1.0)])
            .filter_map(move |(post, side)| {
                let target = self.obstacles.posts[post];
                let way = target.center - start.0;
                // A taut line enters neither of the two corners that it joins.
                let enters = |post: &Post, side: f64| !post.lies_on(side, way);
                let is_straight = start.1 + target.radius_m == 0.0;
                if is_straight
                    && (enters(&target, side) || base.is_some_and(|(a, post)| enters(&post, a.side)))
                {
                    return None;
                }
                let bearing_rad = tangent(start, (target.center, target.radius_m, side))?;
                let at = tangent_point(target.center, target.radius_m, side, bearing_rad);
                let leaves = tangent_point(start.0, start.1, start.2, bearing_rad);
                let before_m = match base {
                    None => 0.0,
                    Some((a, here)) => a.length_m + here.radius_m * wrap_of(&a, bearing_rad)?,
                };
                let length_m = before_m + (at - leaves).norm();
                (length_m <= self.most_m[post]).then_some(Arrival {
                    segment: (leaves, at),
                    from,
                    post,
                    side,
                    bearing_rad,
                    length_m,
                })
            })
    }

    fn is_free(&self, arrival: &Arrival) -> bool {
        let (leaves, at) = arrival.segment;
        self.sees(leaves, at)
            && arrival.from.is_none_or(|index| {
                let from = &self.arrivals[index];
                self.arc_is_clear(&self.obstacles.posts[from.post], from, arrival.bearing_rad)
            })
    }

    /// Whether an earlier path to the same post is at least as short.
    fn is_beaten(&self, by: &Arrival) -> bool {
        let radius_m = self.obstacles.posts[by.post].radius_m;
        self.at_post[by.slot()].iter().any(|a| {
            wrap_of(a, by.bearing_rad)
                .is_some_and(|wrap_rad| a.length_m + radius_m * wrap_rad <= by.length_m + SAME_M)
        })
    }

    /// Returns the length of the path that leaves a post at a bearing and ends at a point; `None` if the path would
    /// not be taut.
    fn leave(&self, from: &Arrival, bearing_rad: f64, to: Point) -> Option<f64> {
        let post = &self.obstacles.posts[from.post];
        let wrap_rad = wrap_of(from, bearing_rad)?;
        let leaves = tangent_point(post.center, post.radius_m, from.side, bearing_rad);
        Some(from.length_m + post.radius_m * wrap_rad + (to - leaves).norm())
    }

    fn is_clear(&self, from: &Arrival, bearing_rad: f64, to: Point) -> bool {
        let post = &self.obstacles.posts[from.post];
        self.sees(tangent_point(post.center, post.radius_m, from.side, bearing_rad), to)
            && self.arc_is_clear(post, from, bearing_rad)
    }

    /// Whether the arc along an outline is clear; overlapping obstacles can block it.
    fn arc_is_clear(&self, post: &Post, from: &Arrival, bearing_rad: f64) -> bool {
        let wrap_rad = wrap_of(from, bearing_rad).unwrap_or(0.0);
        let steps = if post.radius_m > 0.0 { (wrap_rad / 0.5).ceil() as u32 } else { 0 };
        (0..steps).all(|k| {
            let bearing_rad =
                from.bearing_rad + from.side * wrap_rad * (f64::from(k) + 0.5) / f64::from(steps);
            !self.obstacles.sidestep.holds(tangent_point(post.center, post.radius_m, from.side, bearing_rad))
        })
    }

    fn sees(&self, a: Point, b: Point) -> bool {
        self.obstacles.is_open(a, b)
    }

    /// Returns the length of the shortest path from the anchor to a point, metres; infinite if there is no path.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use world::{Boundary, Point, Shape, tether::{CableObstacles, Geodesic}};
    /// let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// let obstacles = Arc::new(CableObstacles::new(&Boundary::Circle { radius_m: 10.0 }, &[column]));
    /// let paths = Geodesic::new(Point::origin(), obstacles);
    /// assert!(paths.distance_m(Point::new(4.0, 0.0)).is_infinite(), "inside the column");
    /// ```
    pub fn distance_m(&self, point: Point) -> f64 {
        if self.sees(self.anchor, point) {
            return (point - self.anchor).norm();
        }
        let mut least_m = f64::INFINITY;
        for from in &self.arrivals {
            let post = &self.obstacles.posts[from.post];
            let way = point - post.center;
            let far = way.norm();
            if far + from.length_m - post.radius_m >= least_m || far < post.radius_m {
                continue;
            }
            let bearing_rad = way.y.atan2(way.x)
                + (from.side * post.radius_m / far.max(f64::MIN_POSITIVE)).clamp(-1.0, 1.0).asin();
            let shorter = self.leave(from, bearing_rad, point).filter(|length_m| *length_m < least_m);
            if let Some(length_m) = shorter
                && self.is_clear(from, bearing_rad, point)
            {
                least_m = length_m;
            }
        }
        least_m
    }

    /// Returns the largest of the distances from an anchor to some points, metres. Each point comes with an upper
    /// bound for its distance, metres. The tighter the bounds, the less is searched.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use world::{Boundary, Point, tether::{CableObstacles, Geodesic}};
    /// let empty = Arc::new(CableObstacles::new(&Boundary::Circle { radius_m: 10.0 }, &[]));
    /// let points = [(Point::new(3.0, 4.0), 6.0), (Point::new(1.0, 0.0), 4.0)];
    /// assert_eq!(Geodesic::farthest_m(Point::origin(), empty, &points), 5.0);
    /// ```
    pub fn farthest_m(anchor: Point, obstacles: Arc<CableObstacles>, points: &[(Point, f64)]) -> f64 {
        // A point with a bound below the largest straight distance cannot be the farthest.
        let straight_m = points.iter().map(|(point, _)| (point - anchor).norm()).fold(0.0, f64::max);
        let mut points = bounded(anchor, &obstacles, points);
        points.retain(|(_, enough_m)| *enough_m >= straight_m);
        let paths = Self::toward(anchor, obstacles, &points);
        points.sort_by(|a, b| b.1.total_cmp(&a.1));
        points.iter().fold(0.0, |most_m, (point, enough_m)| {
            if *enough_m <= most_m { most_m } else { most_m.max(paths.distance_m(*point).min(*enough_m)) }
        })
    }
}

/// Returns the same points with tighter bounds, for paths that wind their cable around many obstacles. At intervals
/// along the path, the bound of a point is the length of a cable that is dragged straight from the anchor to the point.
/// For the points in between, it is the bound of the last such point plus the distance from it along the path.
fn bounded(anchor: Point, obstacles: &Arc<CableObstacles>, points: &[(Point, f64)]) -> Vec<(Point, f64)> {
    let straight_m = |point: Point| {
        let mut cable = Cable::on(anchor, Arc::clone(obstacles)).ok()?;
        cable.drag_to(point);
        (!obstacles.sidestep.holds(point)).then(|| cable.length_m())
    };
    // The last point, its bound, and the distance along the path since the last bound that came from a cable.
    let mut before: Option<(Point, f64, f64)> = None;
    let bound = |(point, enough_m): &(Point, f64)| {
        let on = before.and_then(|(from, most_m, way_m)| {
            let step_m = (point - from).norm();
            let is_short = way_m + step_m <= SQUARE_M;
            (is_short && obstacles.is_open(from, *point)).then_some((most_m + step_m, way_m + step_m))
        });
        let found = on.or_else(|| Some((straight_m(*point)?, 0.0)));
        before = found.map(|(most_m, way_m)| (*point, most_m, way_m));
        (*point, found.map_or(*enough_m, |(most_m, _)| most_m.min(*enough_m)))
    };
    points.iter().map(bound).collect()
}

/// Places are grouped in squares with this edge length, metres.
const SQUARE_M: f64 = 1.0;

/// Returns the largest bound of all places in each square, by the centre of the square. No place is farther from the
/// centre of its square than the length of an edge.
fn longest_by_square(places: &[(Point, f64)]) -> Vec<(Point, f64)> {
    let mut longest: BTreeMap<(i64, i64), f64> = BTreeMap::new();
    for (place, enough_m) in places {
        let [column, row] = [place.x, place.y].map(|at| (at / SQUARE_M).floor() as i64);
        let most_m = longest.entry((column, row)).or_insert(*enough_m);
        *most_m = most_m.max(*enough_m);
    }
    let middle = |at: i64| (at as f64 + 0.5) * SQUARE_M;
    longest.into_iter().map(|((x, y), most_m)| (Point::new(middle(x), middle(y)), most_m)).collect()
}

/// Returns the bearing of the common tangent that touches one disc and then another, each on the given side.
fn tangent(from: (Point, f64, f64), to: (Point, f64, f64)) -> Option<f64> {
    let way = to.0 - from.0;
    let (far, offset) = (way.norm(), to.2 * to.1 - from.2 * from.1);
    (far > 1e-12 && offset.abs() <= far + SAME_M)
        .then(|| way.y.atan2(way.x) - (offset / far).clamp(-1.0, 1.0).asin())
}

/// Returns the angle by which a path bends around its post before it leaves at a given bearing; shortest paths bend
/// less than half a turn.
fn wrap_of(from: &Arrival, bearing_rad: f64) -> Option<f64> {
    let turn = wrap_angle_rad(from.side * (bearing_rad - from.bearing_rad)).rem_euclid(TAU);
    let turn = if TAU - turn < 1e-9 { 0.0 } else { turn };
    (turn <= PI + 1e-9).then_some(turn)
}
