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

/// A place and the triangle that it lies in.
pub type Spot = (Point, usize);

type Cdt = ConstrainedDelaunayTriangulation<Vertex<f64>>;

/// A ground in triangles before there are cuts: the same for all the cuts that are tried on it.
#[derive(Debug, Clone)]
pub struct Bare {
    cdt: Cdt,
    /// Obstacles with the distance to keep.
    outlines: Vec<Vec<Point>>,
}

impl Bare {
    fn new(ground: &Ground) -> Self {
        let mut cdt = Cdt::new();
        let outlines: Vec<Vec<Point>> = ground.parts.iter().map(|part| ground.inflated(part)).collect();
        for ring in ground.wall_rings().iter().chain(&outlines) {
            constrain(&mut cdt, ring, true);
        }
        Self { cdt, outlines }
    }
}

impl Slit {
    /// The domain that can be reached from `home`; `None` when there is no room there.
    pub fn new(ground: &Ground, cuts: &[Vec<Point>], home: Point) -> Option<Self> {
        let Bare { cdt, outlines } = ground.bare.get_or_init(|| Bare::new(ground));
        let mut cdt = cdt.clone();
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
        let mut best = (f64::NEG_INFINITY, NONE);
        for triangle in bucket {
            let side = side(triangle);
            if side >= best.0 {
                best = (side, *triangle);
            }
            // Triangles do not overlap: it lies inside no other.
            if side > NEARLY {
                break;
            }
        }
        (best.0 >= -NEARLY).then_some(best.1 as usize)
    }

    /// A place with its triangle, for [`Self::path_between`] and [`Self::sees_between`].
    pub fn spot(&self, at: Point) -> Option<Spot> {
        self.locate(at).map(|triangle| (at, triangle))
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
    pub fn path_between(&self, (a, from): Spot, (b, to): Spot) -> Vec<Point> {
        if from == to { vec![a, b] } else { funnel(a, b, &self.sleeve(from, to)) }
    }

    /// Length of the shortest path between two places of the domain, metres.
    pub fn way_m(&self, a: Point, b: Point) -> Option<f64> {
        self.path(a, b).map(|path| world::polyline::length_m(&path))
    }

    /// Whether no corner of the domain is further from a place than this, on the shortest path, metres.
    ///
    /// A corner of a cut has a way on either side; the one met first counts. That is a mild measure: of whole paths flown
    /// along cuts, few ever go to the far side of the last corner, and what they do to the cable is certified anyway.
    pub fn is_all_within(&self, from: Point, most_m: f64) -> bool {
        let Some(start) = self.locate(from) else { return most_m >= 0.0 };
        let mut seen = vec![false; self.points.len()];
        self.corners.iter().enumerate().all(|(triangle, corners)| {
            corners.iter().all(|corner| {
                let to = self.points[*corner as usize];
                let is_known = std::mem::replace(&mut seen[*corner as usize], true);
                is_known || {
                    let way = self.path_between((from, start), (to, triangle));
                    world::polyline::length_m(&way) <= most_m
                }
            })
        })
    }

    /// Whether the straight way between two places stays in the domain.
    pub fn sees(&self, a: Point, b: Point) -> bool {
        let spots = (self.spot(a), self.spot(b));
        matches!(spots, (Some(a), Some(b)) if self.sees_between(a, b))
    }

    /// The same for places of which the triangles are known.
    pub fn sees_between(&self, a: Spot, b: Spot) -> bool {
        let is_straight = || {
            let path = self.path_between(a, b);
            path.len() == 2 || world::polyline::length_m(&path) <= (b.0 - a.0).norm() + 1e-9
        };
        a.1 == b.1 || is_straight()
    }

    /// Left and right ends of the sides between two triangles, in order.
    fn sleeve(&self, from: usize, to: usize) -> Vec<(Point, Point)> {
        let (mut a, mut b) = (from, to);
        while a != b {
            if self.depth[a] >= self.depth[b] {
                a = self.parent[a] as usize;
            } else {
                b = self.parent[b] as usize;
            }
        }
        let meeting = a;
        let up = (self.depth[from] - self.depth[meeting]) as usize;
        let down = (self.depth[to] - self.depth[meeting]) as usize;
        let mut sleeve = Vec::with_capacity(up + down);
        let mut at = from;
        while at != meeting {
            let above = self.parent[at] as usize;
            sleeve.push(self.side_to(at, above));
            at = above;
        }
        let mut at = to;
        while at != meeting {
            let above = self.parent[at] as usize;
            sleeve.push(self.side_to(above, at));
            at = above;
        }
        sleeve[up..].reverse();
        sleeve
    }

    /// Left and right end of the side between a triangle and its neighbour.
    fn side_to(&self, triangle: usize, neighbour: usize) -> (Point, Point) {
        let is_side = |k: &usize| self.next[triangle][*k] == neighbour as u32;
        let side = (0..3).find(is_side).expect("neighbours share a side");
        let at = |k: usize| self.points[self.corners[triangle][k % 3] as usize];
        // The corners run counter-clockwise, so a side seen from inside runs from right to left.
        (at(side + 1), at(side))
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
