//! The slit domain: the floor for the middle of the hull, less the cuts, in triangles.
//!
//! With a cut from every obstacle to the wall the domain is simply connected, so the triangles form a tree and the
//! shortest path between two places is a funnel through the one sleeve that joins them (Lee and Preparata 1984):
//! exact, and no search. Any two paths between the same ends are the same to the tether.

use crate::ground::Ground;
use spade::{ConstrainedDelaunayTriangulation, Point2 as Vertex, Triangulation, handles::FixedVertexHandle};
use std::collections::{BTreeMap, VecDeque};
use world::Point;

/// Edge of a bucket of triangles, metres.
const BUCKET_M: f64 = 0.5;
/// A point this far outside a triangle still counts as inside, square metres of signed area.
const NEARLY: f64 = 1e-9;
/// Corners are moved to multiples of this, so that those of outlines that touch fall together instead of lying a hair
/// apart, metres.
const SNAP_M: f64 = 1.0 / 65536.0;
/// What was snapped lies at most this far from where it was, and so do the pieces of lines that were split, metres.
pub const SNAPPED_M: f64 = 8.0 * SNAP_M;
/// Sleeves longer than this are rare, triangles.
const LONG_SLEEVE: u32 = 120;
const NONE: u32 = u32::MAX;

/// Triangles of the domain that can be reached from home.
#[derive(Debug, Clone)]
pub struct Slit {
    points: Vec<Point>,
    corners: Vec<[u32; 3]>,
    next: Vec<[u32; 3]>,
    parent: Vec<u32>,
    depth: Vec<u32>,
    low: Point,
    columns: usize,
    buckets: Vec<Vec<u32>>,
    /// Whether the domain is simply connected: every way between two places is the same to the tether.
    pub is_simple: bool,
    /// Floor for the middle of the hull that nothing but cuts keeps out, square metres.
    pub sealed_m2: f64,
    /// Middles of the sides of triangles at which cuts keep it out.
    pub sealed_rim: Vec<Point>,
}

type Cdt = ConstrainedDelaunayTriangulation<Vertex<f64>>;

impl Slit {
    /// The domain that can be reached from `home`; `None` when there is no room there.
    pub fn new(ground: &Ground, cuts: &[Vec<Point>], home: Point) -> Option<Self> {
        let mut cdt = Cdt::new();
        for ring in ground.wall_rings() {
            constrain(&mut cdt, &ring, true);
        }
        let outlines: Vec<Vec<Point>> = ground.parts.iter().map(|part| ground.inflated(part)).collect();
        for outline in &outlines {
            constrain(&mut cdt, outline, true);
        }
        for cut in cuts {
            constrain(&mut cdt, cut, false);
        }
        let is_free = |at: Point| {
            ground.wall.wall_distance_m(at) >= ground.keep_m
                && !outlines.iter().any(|ring| is_inside(ring, at))
        };
        Self::reached(&cdt, &is_free, home)
    }

    fn reached(cdt: &Cdt, is_free: &dyn Fn(Point) -> bool, home: Point) -> Option<Self> {
        let points: Vec<Point> = cdt.vertices().map(|v| Point::new(v.position().x, v.position().y)).collect();
        let faces: Vec<_> = cdt.inner_faces().collect();
        let free: Vec<bool> = faces
            .iter()
            .map(|face| {
                let [a, b, c] = face.positions();
                is_free(Point::new((a.x + b.x + c.x) / 3.0, (a.y + b.y + c.y) / 3.0))
            })
            .collect();
        let index: BTreeMap<usize, usize> =
            faces.iter().enumerate().map(|(i, f)| (f.fix().index(), i)).collect();
        let contains = |face: usize| {
            let corner = |k: usize| points[faces[face].vertices()[k].index()];
            let (a, b, c) = (corner(0), corner(1), corner(2));
            least_side(a, b, c, home) >= -NEARLY
        };
        let root = (0..faces.len()).find(|face| free[*face] && contains(*face))?;
        let mut number = vec![NONE; faces.len()];
        let mut order = vec![root];
        number[root] = 0;
        let (mut next, mut parent, mut depth) = (Vec::new(), vec![NONE], vec![0]);
        let mut queue = VecDeque::from([root]);
        let mut links = 0;
        while let Some(face) = queue.pop_front() {
            let own = number[face];
            let mut beside = [usize::MAX; 3];
            for (k, edge) in faces[face].adjacent_edges().into_iter().enumerate() {
                let Some(other) = edge.rev().face().as_inner().map(|f| index[&f.fix().index()]) else {
                    continue;
                };
                if !free[other] || edge.is_constraint_edge() {
                    continue;
                }
                links += 1;
                beside[k] = other;
                if number[other] == NONE {
                    number[other] = order.len() as u32;
                    order.push(other);
                    parent.push(own);
                    depth.push(depth[own as usize] + 1);
                    queue.push_back(other);
                }
            }
            next.push(beside);
        }
        let next =
            next.iter().map(|b| b.map(|o: usize| if o == usize::MAX { NONE } else { number[o] })).collect();
        let corners = order
            .iter()
            // Side k of a face runs from its corner k to the next one.
            .map(|face| faces[*face].adjacent_edges().map(|edge| edge.from().index() as u32))
            .collect::<Vec<[u32; 3]>>();
        let (sealed_m2, sealed_rim) = sealed(&faces, &index, &free, &number);
        let is_simple = links / 2 + 1 == corners.len();
        let mut slit = Self {
            points,
            corners,
            next,
            parent,
            depth,
            low: Point::origin(),
            columns: 0,
            buckets: Vec::new(),
            is_simple,
            sealed_m2,
            sealed_rim,
        };
        slit.fill_buckets();
        Some(slit)
    }

    fn fill_buckets(&mut self) {
        let far = f64::INFINITY;
        let used = || self.corners.iter().flatten().map(|c| self.points[*c as usize]);
        let low = used().fold(Point::new(far, far), |low, p| low.inf(&p));
        let high = used().fold(Point::new(-far, -far), |high, p| high.sup(&p));
        let cell = |m: f64| (m / BUCKET_M).floor().max(0.0) as usize;
        let (columns, rows) = (cell(high.x - low.x) + 1, cell(high.y - low.y) + 1);
        let mut buckets = vec![Vec::new(); columns * rows];
        for (index, corners) in self.corners.iter().enumerate() {
            let [a, b, c] = corners.map(|k| self.points[k as usize]);
            let (from, to) = (a.inf(&b).inf(&c) - low, a.sup(&b).sup(&c) - low);
            for row in cell(from.y - 1e-6)..=cell(to.y + 1e-6).min(rows - 1) {
                for column in cell(from.x - 1e-6)..=cell(to.x + 1e-6).min(columns - 1) {
                    buckets[row * columns + column].push(index as u32);
                }
            }
        }
        (self.low, self.columns, self.buckets) = (low, columns, buckets);
    }

    /// Cuts the last ways round obstacles that are left, each where the ways from home on either side meet; returns these
    /// cuts. No floor is lost by it, and the domain is simply connected then.
    pub fn close_up(&mut self) -> Vec<Vec<Point>> {
        let mut cuts = Vec::new();
        for face in 0..self.corners.len() {
            for k in 0..3 {
                let other = self.next[face][k];
                let is_branch =
                    other == NONE || self.parent[face] == other || self.parent[other as usize] == face as u32;
                if is_branch {
                    continue;
                }
                let at = |k: usize| self.points[self.corners[face][k % 3] as usize];
                cuts.push(vec![at(k), at(k + 1)]);
                self.next[face][k] = NONE;
                let mut back = self.next[other as usize].iter_mut();
                if let Some(next) = back.find(|next| **next == face as u32) {
                    *next = NONE;
                }
            }
        }
        self.is_simple = true;
        cuts
    }

    /// The triangles, for filling a grid.
    pub fn triangles(&self) -> impl Iterator<Item = [Point; 3]> + '_ {
        self.corners.iter().map(|corners| corners.map(|k| self.points[k as usize]))
    }

    /// The triangle at a place.
    pub fn locate(&self, at: Point) -> Option<usize> {
        let (x, y) = ((at.x - self.low.x) / BUCKET_M, (at.y - self.low.y) / BUCKET_M);
        if !(x >= 0.0 && y >= 0.0 && x < self.columns as f64) {
            return None;
        }
        let bucket = self.buckets.get(y as usize * self.columns + x as usize)?;
        let side = |triangle: &u32| {
            let [a, b, c] = self.corners[*triangle as usize].map(|k| self.points[k as usize]);
            least_side(a, b, c, at)
        };
        let best = bucket.iter().map(|t| (side(t), *t)).max_by(|a, b| a.0.total_cmp(&b.0))?;
        (best.0 >= -NEARLY).then_some(best.1 as usize)
    }

    /// Whether a place belongs to the domain.
    pub fn contains(&self, at: Point) -> bool {
        self.locate(at).is_some()
    }

    /// The shortest path between two places of the domain, both ends included.
    pub fn path(&self, a: Point, b: Point) -> Option<Vec<Point>> {
        Some(self.path_between((a, self.locate(a)?), (b, self.locate(b)?)))
    }

    /// The shortest path between two places of which the triangles are known.
    pub fn path_between(&self, (a, from): (Point, usize), (b, to): (Point, usize)) -> Vec<Point> {
        if from == to { vec![a, b] } else { funnel(a, b, &self.sleeve(from, to)) }
    }

    /// Length of the shortest path between two places of the domain, metres.
    pub fn way_m(&self, a: Point, b: Point) -> Option<f64> {
        self.path(a, b).map(|path| world::polyline::length_m(&path))
    }

    /// The longest of the shortest paths from a place to any corner of the domain, metres.
    pub fn farthest_m(&self, from: Point) -> f64 {
        let Some(start) = self.locate(from) else { return 0.0 };
        // Each side of the rim begins at another corner, and those of a cut at one for either side of it.
        let sides = self.next.iter().enumerate().flat_map(|(triangle, next)| {
            (0..3).filter(|side| next[*side] == NONE).map(move |side| (triangle, side))
        });
        let way_m = |(triangle, side): (usize, usize)| {
            let corner = self.points[self.corners[triangle][side] as usize];
            world::polyline::length_m(&self.path_between((from, start), (corner, triangle)))
        };
        sides.map(way_m).fold(0.0, f64::max)
    }

    /// Whether the straight way between two places stays in the domain.
    pub fn sees(&self, a: Point, b: Point) -> bool {
        self.path(a, b).is_some_and(|path| world::polyline::length_m(&path) <= (b - a).norm() + 1e-9)
    }

    /// Left and right ends of the sides between two triangles, in order.
    fn sleeve(&self, from: usize, to: usize) -> Vec<(Point, Point)> {
        let room = (self.depth[from] + self.depth[to]).min(LONG_SLEEVE) as usize + 2;
        let (mut up, mut down) = (Vec::with_capacity(room), Vec::with_capacity(room));
        up.push(from);
        down.push(to);
        let (mut a, mut b) = (from, to);
        while a != b {
            if self.depth[a] >= self.depth[b] {
                a = self.parent[a] as usize;
                up.push(a);
            } else {
                b = self.parent[b] as usize;
                down.push(b);
            }
        }
        down.pop();
        up.extend(down.into_iter().rev());
        up.windows(2)
            .map(|pair| {
                let side = (0..3)
                    .find(|k| self.next[pair[0]][*k] == pair[1] as u32)
                    .expect("neighbours share a side");
                let at = |k: usize| self.points[self.corners[pair[0]][k % 3] as usize];
                // The corners run counter-clockwise, so a side seen from inside runs from right to left.
                (at(side + 1), at(side))
            })
            .collect()
    }
}

type Face<'a> =
    spade::handles::FaceHandle<'a, spade::handles::InnerTag, Vertex<f64>, (), spade::CdtEdge<()>, ()>;

/// Area of the free triangles that are reached only across cuts, and where those cuts are.
fn sealed(
    faces: &[Face<'_>],
    index: &BTreeMap<usize, usize>,
    free: &[bool],
    number: &[u32],
) -> (f64, Vec<Point>) {
    let mut seen: Vec<bool> = number.iter().map(|n| *n != NONE).collect();
    let mut todo: Vec<usize> = (0..faces.len()).filter(|face| seen[*face]).collect();
    let (mut area_m2, mut rim) = (0.0, Vec::new());
    while let Some(face) = todo.pop() {
        for edge in faces[face].adjacent_edges() {
            let Some(other) = edge.rev().face().as_inner().map(|f| index[&f.fix().index()]) else { continue };
            if !free[other] || number[other] != NONE {
                continue;
            }
            if edge.is_constraint_edge() {
                let [a, b] = edge.positions();
                rim.push(Point::new(f64::midpoint(a.x, b.x), f64::midpoint(a.y, b.y)));
            }
            if !std::mem::replace(&mut seen[other], true) {
                area_m2 += faces[other].area();
                todo.push(other);
            }
        }
    }
    (area_m2, rim)
}

fn constrain(cdt: &mut Cdt, line: &[Point], is_closed: bool) {
    let snapped = |m: f64| (m / SNAP_M).round() * SNAP_M;
    let corners: Vec<FixedVertexHandle> =
        line.iter().filter_map(|p| cdt.insert(Vertex::new(snapped(p.x), snapped(p.y))).ok()).collect();
    let ends = corners.iter().zip(corners.iter().cycle().skip(1));
    let n = if is_closed { corners.len() } else { corners.len().saturating_sub(1) };
    for (a, b) in ends.take(n).filter(|(a, b)| a != b) {
        cdt.add_constraint_and_split(*a, *b, |vertex| vertex);
    }
}

/// Whether a point lies inside a convex ring, counter-clockwise.
fn is_inside(ring: &[Point], at: Point) -> bool {
    ring.iter().zip(ring.iter().cycle().skip(1)).all(|(a, b)| (b - a).perp(&(at - a)) > 0.0)
}

/// Least signed area between a point and the sides of a triangle; not below zero inside.
fn least_side(a: Point, b: Point, c: Point, at: Point) -> f64 {
    let side = |p: Point, q: Point| (q - p).perp(&(at - p));
    side(a, b).min(side(b, c)).min(side(c, a))
}

/// The shortest path through a sleeve.
fn funnel(start: Point, goal: Point, sleeve: &[(Point, Point)]) -> Vec<Point> {
    let mut path = Vec::with_capacity(8);
    path.push(start);
    let (mut apex, mut left, mut right) = (start, start, start);
    let (mut left_at, mut right_at) = (0, 0);
    let goal_side = (goal, goal);
    let side = |k: usize| if k < sleeve.len() { sleeve[k] } else { goal_side };
    let mut k = 0;
    while k <= sleeve.len() {
        let (new_left, new_right) = side(k);
        let area = |a: Point, b: Point, c: Point| (b - a).perp(&(c - a));
        if area(apex, right, new_right) >= 0.0 {
            if apex == right || area(apex, left, new_right) < 0.0 {
                (right, right_at) = (new_right, k);
            } else {
                path.push(left);
                (apex, k) = (left, left_at);
                (right, right_at, left_at) = (apex, k, k);
                k += 1;
                continue;
            }
        }
        if area(apex, left, new_left) <= 0.0 {
            if apex == left || area(apex, right, new_left) > 0.0 {
                (left, left_at) = (new_left, k);
            } else {
                path.push(right);
                (apex, k) = (right, right_at);
                (left, left_at, right_at) = (apex, k, k);
                k += 1;
                continue;
            }
        }
        k += 1;
    }
    path.push(goal);
    path.dedup_by(|a, b| (*a - *b).norm() < 1e-12);
    if path.len() == 1 {
        path.push(goal);
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;
    use trials::tanks::{Known, Tank};

    #[test]
    fn the_farthest_corner_counts_from_either_side_of_a_cut() {
        let tank = Tank { columns: Vec::new(), ..Known::E1.tank(1) };
        let obstacles = tank.obstacles();
        let ground = Ground::new(&tank.site(&obstacles), tank.anchor).unwrap();
        // Where the cut meets the wall is near on one side; on the other the way there leads round its other end.
        let (wall, tip) = (Point::new(10.0, 0.0), Point::new(-5.0, 0.0));
        for y in [0.4, -0.4] {
            let home = Point::new(6.0, y);
            let slit = Slit::new(&ground, &[vec![tip, wall]], home).unwrap();
            let round_m = (tip - home).norm() + 15.0 - ground.keep_m;
            let farthest_m = slit.farthest_m(home);
            assert!((farthest_m - round_m).abs() < 0.01, "{farthest_m} {round_m}");
        }
    }
}
