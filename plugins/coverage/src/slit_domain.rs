//! The slit domain: the floor for the hull centre, less the cuts, in triangles.
//!
//! With a cut from every obstacle to the wall, the domain is simply connected, so the triangles form a tree. The
//! shortest path between two points then follows from a funnel through the one sleeve that joins them: exactly, and
//! without a search. For the tether, any two paths between the same ends are equivalent.

mod funnel;
#[cfg(test)]
mod tests;

use crate::buckets::Buckets;
use crate::plane::meets;
use crate::triangulation::{NEARLY, NONE, SNAP_M, SealedRegion, Triangle, Walk, least_side};
use crate::workspace::{Workspace, places_around};
use funnel::funnel;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};
use world::{Point, polyline};

/// Distance at which a path passes the end of a cut, metres: less than the distance between any two corners. A path
/// through the end itself would be on both sides of the cut, and could continue on the wrong side.
const ASIDE_M: f64 = SNAP_M / 4.0;

/// The triangles of the floor that can be reached from home without crossing a cut.
pub(crate) struct SlitDomain<'a> {
    pub workspace: &'a Workspace,
    /// The cuts: lines that the robot does not cross, each from the centre of an obstacle to the wall or to another
    /// obstacle.
    pub cuts: Vec<Vec<Point>>,
    points: Vec<Point>,
    triangles: Vec<Triangle>,
    buckets: Buckets,
    /// Corners at which cuts end or bend; the domain lies on both sides of each. Stored as bits for lookup.
    hinges: BTreeSet<[u64; 2]>,
    /// Whether the domain is simply connected, so that all paths between two points are equivalent for the tether.
    pub is_simple: bool,
    /// Floor that the hull centre could reach if there were no cuts.
    pub sealed: SealedRegion,
}

/// A point of the domain and the triangle that contains it.
#[derive(Clone, Copy)]
pub(crate) struct Spot {
    pub at: Point,
    triangle: usize,
}

impl<'a> SlitDomain<'a> {
    /// Creates the domain between some cuts; `None` if the hull does not fit at home.
    pub(crate) fn new(workspace: &'a Workspace, cuts: Vec<Vec<Point>>) -> Option<Self> {
        let walk = workspace.triangulation().walk(&cuts, workspace.home)?;
        let Walk { points, triangles, hinges, is_simple, sealed } = walk;
        let hinges = hinges.into_iter().map(|corner| bits(points[corner as usize])).collect();
        let boxes = triangles.iter().map(|Triangle { corners, .. }| {
            let [a, b, c] = corners.map(|k| points[k as usize]);
            (a.inf(&b).inf(&c), a.sup(&b).sup(&c))
        });
        let buckets = Buckets::new(0.5, 1e-6, &boxes.collect::<Vec<_>>());
        Some(Self { workspace, cuts, points, triangles, buckets, hinges, is_simple, sealed })
    }

    /// Adds cuts across the remaining routes around obstacles, each where the paths from home around the two sides
    /// meet. No floor is lost, and the domain becomes simply connected.
    pub(crate) fn close_up(&mut self) {
        if self.is_simple {
            return;
        }
        self.reach_nearest_first();
        for own in 0..self.triangles.len() {
            for side in 0..3 {
                let other = self.triangles[own].next[side];
                let is_branch = other == NONE
                    || self.triangles[own].parent == other
                    || self.triangles[other as usize].parent == own as u32;
                if is_branch {
                    continue;
                }
                let (right, left) = (self.corner(own, side), self.corner(own, side + 1));
                self.cuts.push(vec![right, left]);
                self.hinges.extend([bits(right), bits(left)]);
                self.triangles[own].next[side] = NONE;
                let mut back = self.triangles[other as usize].next.iter_mut();
                if let Some(next) = back.find(|next| **next == own as u32) {
                    *next = NONE;
                }
            }
        }
        self.is_simple = true;
    }

    /// Rebuilds the tree of triangles according to the lengths of the shortest paths from home (Dijkstra 1959).
    fn reach_nearest_first(&mut self) {
        let Some(home) = self.spot(self.workspace.home) else { return };
        let mut is_reached = vec![false; self.triangles.len()];
        let mut waiting = BinaryHeap::from([Reverse((0, home.triangle as u32, NONE))]);
        while let Some(Reverse((_, own, parent))) = waiting.pop() {
            if std::mem::replace(&mut is_reached[own as usize], true) {
                continue;
            }
            let depth = if parent == NONE { 0 } else { self.triangles[parent as usize].depth + 1 };
            (self.triangles[own as usize].parent, self.triangles[own as usize].depth) = (parent, depth);
            for side in 0..3 {
                let next = self.triangles[own as usize].next[side];
                if next != NONE && !is_reached[next as usize] {
                    let (right, left) =
                        (self.corner(own as usize, side), self.corner(own as usize, side + 1));
                    let middle = right + (left - right) / 2.0;
                    let way = self.path_between(home, Spot { at: middle, triangle: own as usize });
                    waiting.push(Reverse(((polyline::length_m(&way) * 1e6) as u64, next, own)));
                }
            }
        }
    }

    fn corner(&self, triangle: usize, k: usize) -> Point {
        self.points[self.triangles[triangle].corners[k % 3] as usize]
    }

    fn corners(&self, triangle: usize) -> [Point; 3] {
        self.triangles[triangle].corners.map(|k| self.points[k as usize])
    }

    /// The triangles, for filling a raster.
    pub(crate) fn triangles(&self) -> impl Iterator<Item = [Point; 3]> + '_ {
        (0..self.triangles.len()).map(|triangle| self.corners(triangle))
    }

    /// The boundary of the domain, ignoring cuts: closed rings with the domain on their left.
    pub(crate) fn rings(&self) -> Vec<Vec<Point>> {
        let is_cut = |a: Point, b: Point| self.cuts.iter().any(|cut| cut[..] == [a, b] || cut[..] == [b, a]);
        let mut onward: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (own, Triangle { corners, next, .. }) in self.triangles.iter().enumerate() {
            for side in (0..3).filter(|side| next[*side] == NONE) {
                if !is_cut(self.corner(own, side), self.corner(own, side + 1)) {
                    onward.entry(corners[side]).or_default().push(corners[(side + 1) % 3]);
                }
            }
        }
        let mut rings = Vec::new();
        while let Some((first, _)) = onward.first_key_value() {
            let mut ring = vec![*first];
            while let Some(next) = onward.get_mut(&ring[ring.len() - 1]).and_then(Vec::pop) {
                ring.push(next);
            }
            onward.retain(|_, next| !next.is_empty());
            rings.push(ring.into_iter().map(|corner| self.points[corner as usize]).collect());
        }
        rings
    }

    /// A point with its triangle; `None` outside the domain.
    pub(crate) fn spot(&self, at: Point) -> Option<Spot> {
        let mut best = (f64::NEG_INFINITY, usize::MAX);
        for triangle in self.buckets.at(at) {
            let side = least_side(self.corners(*triangle as usize), at);
            if side >= best.0 {
                best = (side, *triangle as usize);
            }
            // Triangles do not overlap, so the point is inside no other triangle.
            if side > NEARLY {
                break;
            }
        }
        (best.0 >= -NEARLY).then_some(Spot { at, triangle: best.1 })
    }

    pub(crate) fn contains(&self, at: Point) -> bool {
        self.spot(at).is_some()
    }

    /// The start of a path from a position: the position itself or, if it is outside the domain, the nearest point in
    /// the domain; home if no such point is near.
    pub(crate) fn start(&self, at: Point) -> Point {
        self.beside(at).unwrap_or(self.workspace.home)
    }

    /// The position itself or, if it is outside the domain, the nearest point in the domain: a robot may be slightly
    /// too close to an obstacle that it has just found.
    pub(crate) fn beside(&self, at: Point) -> Option<Point> {
        let is_open = |place: &Point| self.contains(*place) && !self.crosses_cut(at, *place);
        places_around(at, self.workspace.keep_m).find(is_open)
    }

    /// The pieces of a line between the points where it would cross a cut.
    pub(crate) fn between_cuts(&self, line: &[Point]) -> Vec<Vec<Point>> {
        let runs = line.chunk_by(|a, b| !self.crosses_cut(*a, *b));
        runs.filter(|run| run.len() > 1).map(<[Point]>::to_vec).collect()
    }

    pub(crate) fn crosses_cut(&self, a: Point, b: Point) -> bool {
        self.cuts.iter().any(|cut| meets(cut, a, b))
    }

    /// The shortest path between two points, including both; `None` if one is outside the domain.
    pub(crate) fn path(&self, a: Point, b: Point) -> Option<Vec<Point>> {
        Some(self.path_between(self.spot(a)?, self.spot(b)?))
    }

    /// The shortest path between two spots. It passes the ends of cuts at a tiny distance.
    pub(crate) fn path_between(&self, a: Spot, b: Spot) -> Vec<Point> {
        if a.triangle == b.triangle {
            return vec![a.at, b.at];
        }
        let bends = funnel(a.at, b.at, &self.sleeve(a.triangle, b.triangle));
        let mut path: Vec<Point> = bends.iter().map(|bend| bend.at).collect();
        for (at, bend) in path[1..].iter_mut().zip(bends.windows(3)) {
            if self.hinges.contains(&bits(bend[1].at)) {
                *at += bend[1].free_side(bend[0].at, bend[2].at) * ASIDE_M;
            }
        }
        path
    }

    /// The length of the shortest path home, metres.
    pub(crate) fn way_home_m(&self, from: Point) -> Option<f64> {
        self.path(self.workspace.home, from).map(|path| polyline::length_m(&path))
    }

    /// Whether every corner of the domain is within this distance of home by the shortest path, metres.
    ///
    /// A corner on a cut can be reached on either side of the cut; only the path found first is measured. This is
    /// lenient, but few finished paths along cuts ever reach the far side of the last corner, and their effect on the
    /// cable is certified anyway.
    pub(crate) fn is_all_within(&self, most_m: f64) -> bool {
        let Some(start) = self.spot(self.workspace.home) else { return most_m >= 0.0 };
        let mut seen = vec![false; self.points.len()];
        self.triangles.iter().enumerate().all(|(triangle, Triangle { corners, .. })| {
            corners.iter().all(|corner| {
                let is_known = std::mem::replace(&mut seen[*corner as usize], true);
                is_known || {
                    let way = self.path_between(start, Spot { at: self.points[*corner as usize], triangle });
                    polyline::length_m(&way) <= most_m
                }
            })
        })
    }

    /// Whether the straight line between two points stays in the domain.
    pub(crate) fn sees(&self, a: Point, b: Point) -> bool {
        matches!((self.spot(a), self.spot(b)), (Some(a), Some(b)) if self.sees_between(a, b))
    }

    /// Whether the straight line between two spots stays in the domain.
    pub(crate) fn sees_between(&self, a: Spot, b: Spot) -> bool {
        let is_straight = || {
            let path = self.path_between(a, b);
            path.len() == 2 || polyline::length_m(&path) <= (b.at - a.at).norm() + 1e-9
        };
        a.triangle == b.triangle || is_straight()
    }

    /// The left and right ends of the sides between two triangles, in order: from both triangles up the tree to where
    /// their branches meet.
    fn sleeve(&self, from: usize, to: usize) -> Vec<(Point, Point)> {
        let above = |triangle: usize| self.triangles[triangle].parent as usize;
        let depth = |triangle: usize| self.triangles[triangle].depth as usize;
        let (mut a, mut b) = (from, to);
        while a != b {
            if depth(a) >= depth(b) {
                a = above(a);
            } else {
                b = above(b);
            }
        }
        let (up, down) = (depth(from) - depth(a), depth(to) - depth(a));
        let mut sleeve = Vec::with_capacity(up + down);
        let mut at = from;
        for _ in 0..up {
            sleeve.push(self.side_between(at, above(at)));
            at = above(at);
        }
        at = to;
        for _ in 0..down {
            sleeve.push(self.side_between(above(at), at));
            at = above(at);
        }
        sleeve[up..].reverse();
        sleeve
    }

    /// The left and right end of the side between a triangle and its neighbour, as seen from the triangle.
    fn side_between(&self, triangle: usize, neighbour: usize) -> (Point, Point) {
        let is_side = |k: &usize| self.triangles[triangle].next[*k] == neighbour as u32;
        let side = (0..3).find(is_side).expect("neighbouring triangles share a side");
        // The corners run counter-clockwise, so a side seen from inside runs from right to left.
        (self.corner(triangle, side + 1), self.corner(triangle, side))
    }
}

fn bits(at: Point) -> [u64; 2] {
    [at.x.to_bits(), at.y.to_bits()]
}
