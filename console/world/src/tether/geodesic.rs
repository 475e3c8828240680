//! Shortest ways from the anchor to anywhere, with no regard to how the robot got there: the least cable that would do.

use super::{
    cable::tangent_point,
    ground::{Ground, Post},
    sweep::direction,
};
use geometry::{Point, wrap_angle_rad};
use std::{
    cmp::{Ordering, Reverse},
    collections::BinaryHeap,
    f64::consts::{PI, TAU},
    sync::Arc,
};

/// Differences of length that do not matter, metres.
const SAME_M: f64 = 1e-9;

/// The tangent graph of the posts, searched once from the anchor.
#[derive(Debug, Clone)]
pub struct Geodesic {
    ground: Arc<Ground>,
    anchor: Point,
    arrivals: Vec<Arrival>,
    /// Those at each post, by twice its index, plus one for the left-hand side.
    at_post: Vec<Vec<Arrival>>,
}

/// A shortest way that has come to touch a post.
#[derive(Debug, Clone, Copy)]
struct Arrival {
    /// Where its last straight piece begins, and where it ends.
    piece: (Point, Point),
    /// Index of the arrival that it goes on from.
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

/// Ways to posts that wait for their turn, the shortest first.
#[derive(Default)]
struct Waiting {
    ways: Vec<Arrival>,
    queue: BinaryHeap<Reverse<Turn>>,
}

/// The length of a waiting way, what breaks ties, and its index.
struct Turn(f64, (usize, bool), usize);

impl PartialEq for Turn {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Turn {}
impl PartialOrd for Turn {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Turn {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0).then_with(|| (self.1, self.2).cmp(&(other.1, other.2)))
    }
}

impl Waiting {
    fn add(&mut self, way: Arrival) {
        self.queue.push(Reverse(Turn(way.length_m, (way.post, way.side > 0.0), self.ways.len())));
        self.ways.push(way);
    }

    fn shortest(&mut self) -> Option<Arrival> {
        self.queue.pop().map(|Reverse(Turn(_, _, index))| self.ways[index])
    }
}

impl Geodesic {
    /// All shortest ways from an anchor; costs about `posts^2` tangents and as many lines of sight.
    pub fn new(anchor: Point, ground: Arc<Ground>) -> Self {
        let at_post = vec![Vec::new(); 2 * ground.posts.len()];
        let mut found = Self { ground, anchor, arrivals: Vec::new(), at_post };
        found.search();
        found
    }

    /// Dijkstra's search; whether a tangent is free is looked at only when its turn comes.
    fn search(&mut self) {
        let in_sight: Vec<bool> = self.ground.posts.iter().map(|post| self.is_in_plain_sight(post)).collect();
        let mut waiting = Waiting::default();
        self.onward(None, |_| true).for_each(|way| waiting.add(way));
        while let Some(next) = waiting.shortest() {
            if self.is_beaten(&next) || !self.is_free(&next) {
                continue;
            }
            let index = self.arrivals.len();
            self.arrivals.push(next);
            self.at_post[next.slot()].push(next);
            for way in self.onward(Some(index), |post| !in_sight[post]).filter(|way| !self.is_beaten(way)) {
                waiting.add(way);
            }
        }
    }

    /// Whether nothing stands between the anchor and a round post, nor touches it: then the shortest way to any point of
    /// its outline is straight, or straight to a tangent and along the outline, and no way leads there round another post.
    fn is_in_plain_sight(&self, post: &Post) -> bool {
        let way = post.center - self.anchor;
        let far = way.norm();
        if post.radius_m <= 0.0
            || far <= post.radius_m
            || !self.ground.sidestep.is_alone(post.center, post.radius_m)
        {
            return false;
        }
        let target = |side: f64| (post.center, post.radius_m, side);
        let rays = [1.0, -1.0].map(|side| tangent((self.anchor, 0.0, 0.0), target(side)));
        let [Some(right), Some(left)] = rays else { return false };
        let is_open = |side: f64, bearing_rad: f64| {
            self.sees(self.anchor, tangent_point(post.center, post.radius_m, side, bearing_rad))
        };
        let (low, high) = (direction(right), direction(left));
        let is_between = |other: &Post| {
            let at = other.center - self.anchor;
            low.perp(&at) >= 0.0 && high.perp(&at) <= 0.0 && at.norm() < far
        };
        is_open(1.0, right) && is_open(-1.0, left) && !self.ground.posts.iter().any(is_between)
    }

    /// The tangents that go on from an arrival, or from the anchor, to some of the posts.
    fn onward(&self, from: Option<usize>, is_meant: impl Fn(usize) -> bool) -> impl Iterator<Item = Arrival> {
        let base = from.map(|index| (self.arrivals[index], self.ground.posts[self.arrivals[index].post]));
        let start = base.map_or((self.anchor, 0.0, 0.0), |(a, post)| (post.center, post.radius_m, a.side));
        (0..self.ground.posts.len())
            .filter(move |post| base.is_none_or(|(a, _)| a.post != *post) && is_meant(*post))
            .flat_map(|post| [(post, 1.0), (post, -1.0)])
            .filter_map(move |(post, side)| {
                let target = self.ground.posts[post];
                let bearing_rad = tangent(start, (target.center, target.radius_m, side))?;
                let at = tangent_point(target.center, target.radius_m, side, bearing_rad);
                let leaves = tangent_point(start.0, start.1, start.2, bearing_rad);
                let before_m = match base {
                    None => 0.0,
                    Some((a, here)) => a.length_m + here.radius_m * wrap_of(&a, bearing_rad)?,
                };
                let length_m = before_m + (at - leaves).norm();
                Some(Arrival { piece: (leaves, at), from, post, side, bearing_rad, length_m })
            })
    }

    fn is_free(&self, arrival: &Arrival) -> bool {
        let (leaves, at) = arrival.piece;
        self.sees(leaves, at)
            && arrival.from.is_none_or(|index| {
                let from = &self.arrivals[index];
                self.arc_is_clear(&self.ground.posts[from.post], from, arrival.bearing_rad)
            })
    }

    /// Whether a way that came to the same post before is as short all the way from there.
    fn is_beaten(&self, by: &Arrival) -> bool {
        let radius_m = self.ground.posts[by.post].radius_m;
        self.at_post[by.slot()].iter().any(|a| {
            wrap_of(a, by.bearing_rad)
                .is_some_and(|wrap_rad| a.length_m + radius_m * wrap_rad <= by.length_m + SAME_M)
        })
    }

    /// Length of the way that leaves a post at some bearing and ends at a point; `None` if it would not be taut.
    fn leave(&self, from: &Arrival, bearing_rad: f64, to: Point) -> Option<f64> {
        let post = &self.ground.posts[from.post];
        let wrap_rad = wrap_of(from, bearing_rad)?;
        let leaves = tangent_point(post.center, post.radius_m, from.side, bearing_rad);
        Some(from.length_m + post.radius_m * wrap_rad + (to - leaves).norm())
    }

    fn is_clear(&self, from: &Arrival, bearing_rad: f64, to: Point) -> bool {
        let post = &self.ground.posts[from.post];
        self.sees(tangent_point(post.center, post.radius_m, from.side, bearing_rad), to)
            && self.arc_is_clear(post, from, bearing_rad)
    }

    /// Overlapping obstacles can block the way along an outline.
    fn arc_is_clear(&self, post: &Post, from: &Arrival, bearing_rad: f64) -> bool {
        let wrap_rad = wrap_of(from, bearing_rad).unwrap_or(0.0);
        let steps = if post.radius_m > 0.0 { (wrap_rad / 0.5).ceil() as u32 } else { 0 };
        (0..steps).all(|k| {
            let bearing_rad =
                from.bearing_rad + from.side * wrap_rad * (f64::from(k) + 0.5) / f64::from(steps);
            !self.ground.sidestep.holds(tangent_point(post.center, post.radius_m, from.side, bearing_rad))
        })
    }

    fn sees(&self, a: Point, b: Point) -> bool {
        self.ground.is_open(a, b)
    }

    /// Length of the shortest way from the anchor to a point, metres; infinite if there is none.
    pub fn distance_m(&self, point: Point) -> f64 {
        if self.sees(self.anchor, point) {
            return (point - self.anchor).norm();
        }
        let mut least_m = f64::INFINITY;
        for from in &self.arrivals {
            let post = &self.ground.posts[from.post];
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

    /// The largest distance from the anchor to any of some points, each with a length that surely reaches it, metres.
    pub fn farthest_m(&self, points: impl IntoIterator<Item = (Point, f64)>) -> f64 {
        let mut points: Vec<(Point, f64)> = points.into_iter().collect();
        points.sort_by(|a, b| b.1.total_cmp(&a.1));
        points.iter().fold(0.0, |most_m, (point, enough_m)| {
            if *enough_m <= most_m { most_m } else { most_m.max(self.distance_m(*point).min(*enough_m)) }
        })
    }
}

/// Bearing of the common tangent that leaves one disc and comes to another, each on its side.
fn tangent(from: (Point, f64, f64), to: (Point, f64, f64)) -> Option<f64> {
    let way = to.0 - from.0;
    let (far, offset) = (way.norm(), to.2 * to.1 - from.2 * from.1);
    (far > 1e-12 && offset.abs() <= far + SAME_M)
        .then(|| way.y.atan2(way.x) - (offset / far).clamp(-1.0, 1.0).asin())
}

/// Angle by which a way bends round its post until it leaves at a bearing; shortest ways bend less than half a turn.
fn wrap_of(from: &Arrival, bearing_rad: f64) -> Option<f64> {
    let turn = wrap_angle_rad(from.side * (bearing_rad - from.bearing_rad)).rem_euclid(TAU);
    let turn = if TAU - turn < 1e-9 { 0.0 } else { turn };
    (turn <= PI + 1e-9).then_some(turn)
}
