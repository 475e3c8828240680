//! The floor for the hull centre in triangles: a constrained Delaunay triangulation of the grown outlines and of the
//! cuts, and the walk through them from home.

use crate::arrangement::{Border, border};
use crate::buckets::Buckets;
use crate::inflation::{outline, wall_rings};
use geometry::convex::Part;
use spade::handles::{FaceHandle, FixedVertexHandle, InnerTag};
use spade::{CdtEdge, ConstrainedDelaunayTriangulation, Point2 as Vertex, Triangulation as _};
use std::collections::BTreeMap;
use world::{Boundary, Point, polyline::edges, shape::bounds_of};

/// Grid spacing to which corners are snapped, metres, so that corners of touching outlines coincide instead of lying
/// slightly apart.
pub(crate) const SNAP_M: f64 = 1.0 / 65536.0;
/// Maximum displacement caused by snapping or by splitting lines, metres.
pub(crate) const SNAPPED_M: f64 = 8.0 * SNAP_M;

/// Edge length of the buckets in which outlines are looked up, metres.
const BUCKET_M: f64 = 1.0;
/// Tolerance by which a point may be outside a triangle and still count as inside, as signed area, square metres.
pub(crate) const NEARLY: f64 = 1e-9;
/// The index used where there is no triangle.
pub(crate) const NONE: u32 = u32::MAX;

type Cdt = ConstrainedDelaunayTriangulation<Vertex<f64>>;
type Face<'a> = FaceHandle<'a, InnerTag, Vertex<f64>, (), CdtEdge<()>, ()>;

/// Wall and obstacles in triangles before cuts are added: the same for all cuts tried.
pub(crate) struct Triangulation {
    cdt: Cdt,
    wall: Boundary,
    keep_m: f64,
    /// Obstacles grown by the distance to keep.
    outlines: Vec<Vec<Point>>,
    /// The obstacles by position.
    buckets: Buckets,
}

impl Triangulation {
    pub(crate) fn new(wall: &Boundary, parts: &[Part], keep_m: f64) -> Self {
        let mut cdt = Cdt::new();
        let outlines: Vec<Vec<Point>> = parts.iter().map(|part| outline(part, keep_m)).collect();
        let walls = wall_rings(wall, keep_m);
        let snapped = |ring: &Vec<Point>| ring.iter().map(|p| p.map(snapped)).collect();
        let (inward, solid): (Vec<_>, Vec<_>) = match wall {
            Boundary::Circle { .. } => (walls, outlines.iter().map(snapped).collect()),
            Boundary::Polygon { .. } => (Vec::new(), walls.iter().chain(&outlines).map(snapped).collect()),
        };
        for ring in &inward {
            constrain(&mut cdt, ring, true);
        }
        for Border { line, is_closed } in border(&solid, 1e-9) {
            constrain(&mut cdt, &line, is_closed);
        }
        let boxes: Vec<(Point, Point)> = outlines.iter().map(|ring| bounds_of(ring)).collect();
        Self { cdt, wall: wall.clone(), keep_m, outlines, buckets: Buckets::new(BUCKET_M, 0.0, &boxes) }
    }

    /// The floor that can be reached from home without crossing a cut; `None` if the hull does not fit at home.
    pub(crate) fn walk(&self, cuts: &[Vec<Point>], home: Point) -> Option<Walk> {
        let mut cdt = self.cdt.clone();
        for cut in cuts {
            constrain(&mut cdt, cut, false);
        }
        let points: Vec<Point> = cdt.vertices().map(|v| Point::new(v.position().x, v.position().y)).collect();
        let faces = Faces::new(&cdt, |at| self.is_free(at));
        let holds_home = |face: &usize| {
            let corners = faces.corners(*face).map(|k| points[k as usize]);
            faces.free[*face] && least_side(corners, home) >= -NEARLY
        };
        let root = (0..faces.all.len()).find(holds_home)?;
        Some(faces.walk(root, points))
    }

    fn is_free(&self, at: Point) -> bool {
        let is_inside = |ring: &Vec<Point>| edges(ring).all(|(a, b)| (b - a).perp(&(at - a)) > 0.0);
        let mut near = self.buckets.at(at).iter().map(|k| &self.outlines[*k as usize]);
        self.wall.wall_distance_m(at) >= self.keep_m && !near.any(is_inside)
    }
}

fn snapped(m: f64) -> f64 {
    (m / SNAP_M).round() * SNAP_M
}

fn constrain(cdt: &mut Cdt, line: &[Point], is_closed: bool) {
    let corners: Vec<FixedVertexHandle> =
        line.iter().filter_map(|p| cdt.insert(Vertex::new(snapped(p.x), snapped(p.y))).ok()).collect();
    let ends = corners.iter().zip(corners.iter().cycle().skip(1));
    let n = if is_closed { corners.len() } else { corners.len().saturating_sub(1) };
    for (a, b) in ends.take(n).filter(|(a, b)| a != b) {
        cdt.add_constraint_and_split(*a, *b, |vertex| vertex);
    }
}

/// The smallest signed area between a point and the sides of a triangle; not negative if the point is inside.
pub(crate) fn least_side([a, b, c]: [Point; 3], at: Point) -> f64 {
    let side = |p: Point, q: Point| (q - p).perp(&(at - p));
    side(a, b).min(side(b, c)).min(side(c, a))
}

/// A triangle that can be reached.
pub(crate) struct Triangle {
    /// The vertices, counter-clockwise.
    pub corners: [u32; 3],
    /// The triangle across each side, or [`NONE`]; side `k` starts at corner `k`.
    pub next: [u32; 3],
    /// The triangle from which the walk entered, or [`NONE`] at home.
    pub parent: u32,
    /// Number of triangles between this triangle and home.
    pub depth: u32,
}

/// Floor that only cuts prevent the hull centre from reaching.
#[derive(Default)]
pub(crate) struct SealedRegion {
    pub area_m2: f64,
    /// Midpoints of the triangle sides at which cuts keep the hull out.
    pub rim: Vec<Point>,
}

/// All triangles that can be reached without crossing a cut, breadth first.
pub(crate) struct Walk {
    /// The vertices of all triangles.
    pub points: Vec<Point>,
    /// The triangles in the order in which they were reached.
    pub triangles: Vec<Triangle>,
    /// Indices of the vertices at which cuts end or bend; some may appear several times.
    pub hinges: Vec<u32>,
    /// Whether there is exactly one path to each triangle.
    pub is_simple: bool,
    pub sealed: SealedRegion,
}

/// The triangles of the triangulation with cuts, by index, and which of them the hull centre may use.
struct Faces<'a> {
    all: Vec<Face<'a>>,
    numbers: BTreeMap<usize, usize>,
    free: Vec<bool>,
}

/// A free triangle adjacent to another triangle.
struct Beside {
    face: usize,
    /// The common side: from this corner of the other triangle to the next.
    side: usize,
    /// Midpoint of that side.
    middle: Point,
    is_cut: bool,
}

impl<'a> Faces<'a> {
    fn new(cdt: &'a Cdt, is_free: impl Fn(Point) -> bool) -> Self {
        let all: Vec<Face<'_>> = cdt.inner_faces().collect();
        let numbers = all.iter().enumerate().map(|(number, face)| (face.fix().index(), number)).collect();
        let is_free = |face: &Face<'_>| {
            let [a, b, c] = face.positions();
            is_free(Point::new((a.x + b.x + c.x) / 3.0, (a.y + b.y + c.y) / 3.0))
        };
        let free = all.iter().map(is_free).collect();
        Self { all, numbers, free }
    }

    /// The vertices of a triangle, counter-clockwise: side `k` runs from corner `k` to the next.
    fn corners(&self, face: usize) -> [u32; 3] {
        self.all[face].adjacent_edges().map(|edge| edge.from().index() as u32)
    }

    fn beside(&self, face: usize) -> impl Iterator<Item = Beside> + '_ {
        self.all[face].adjacent_edges().into_iter().enumerate().filter_map(|(side, edge)| {
            let face = self.numbers[&edge.rev().face().as_inner()?.fix().index()];
            let [a, b] = edge.positions();
            let middle = Point::new(f64::midpoint(a.x, b.x), f64::midpoint(a.y, b.y));
            self.free[face].then_some(Beside { face, side, middle, is_cut: edge.is_constraint_edge() })
        })
    }

    fn walk(&self, root: usize, points: Vec<Point>) -> Walk {
        let triangle = |face: usize, parent: u32, depth: u32| {
            let corners = self.corners(face);
            Triangle { corners, next: [NONE; 3], parent, depth }
        };
        let mut numbers = vec![NONE; self.all.len()];
        numbers[root] = 0;
        let (mut reached, mut triangles) = (vec![root], vec![triangle(root, NONE, 0)]);
        let (mut own, mut n_links, mut hinges) = (0, 0, Vec::new());
        while let Some(&face) = reached.get(own) {
            for other in self.beside(face) {
                if other.is_cut {
                    let corners = self.corners(face);
                    hinges.extend([corners[other.side], corners[(other.side + 1) % 3]]);
                    continue;
                }
                n_links += 1;
                if numbers[other.face] == NONE {
                    numbers[other.face] = reached.len() as u32;
                    reached.push(other.face);
                    triangles.push(triangle(other.face, own as u32, triangles[own].depth + 1));
                }
                triangles[own].next[other.side] = numbers[other.face];
            }
            own += 1;
        }
        // Every link was counted from both ends, and a tree has one link fewer than triangles.
        let is_simple = n_links / 2 + 1 == triangles.len();
        let sealed = self.sealed(|face| numbers[face] != NONE);
        Walk { points, triangles, hinges, is_simple, sealed }
    }

    fn sealed(&self, is_reached: impl Fn(usize) -> bool) -> SealedRegion {
        let mut seen: Vec<bool> = (0..self.all.len()).map(&is_reached).collect();
        let mut todo: Vec<usize> = (0..self.all.len()).filter(|face| seen[*face]).collect();
        let mut sealed = SealedRegion::default();
        while let Some(face) = todo.pop() {
            for other in self.beside(face).filter(|other| !is_reached(other.face)) {
                sealed.rim.extend(other.is_cut.then_some(other.middle));
                if !std::mem::replace(&mut seen[other.face], true) {
                    sealed.area_m2 += self.all[other.face].area();
                    todo.push(other.face);
                }
            }
        }
        sealed
    }
}
