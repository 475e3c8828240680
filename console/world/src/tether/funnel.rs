//! A cross-check of the taut cable: a triangulation, a stack of the edges that the path has crossed, and a funnel
//! through those edges.
//!
//! Columns become polygons with many corners; for polygons, the answer is exact. Test code only: it costs more than
//! the cable and needs a triangulation.

use geometry::Point;
use spade::{
    ConstrainedDelaunayTriangulation, Intersection, LineIntersectionIterator, Point2, Triangulation,
    handles::FixedUndirectedEdgeHandle,
};

/// A triangulated floor, and the edges that a path has crossed without crossing back.
pub(super) struct Funnel {
    floor: ConstrainedDelaunayTriangulation<Point2<f64>>,
    crossed: Vec<Portal>,
    anchor: Point,
    tip: Point,
}

struct Portal {
    edge: FixedUndirectedEdgeHandle,
    left: Point,
    right: Point,
}

fn theirs(p: Point) -> Point2<f64> {
    Point2::new(p.x, p.y)
}

impl Funnel {
    /// Creates a floor with polygonal holes, within 100 m.
    pub(super) fn new(anchor: Point, rings: &[Vec<Point>]) -> Self {
        let mut floor = ConstrainedDelaunayTriangulation::new();
        for (x, y) in [(-100., -100.), (101., -103.), (102., 104.), (-105., 106.)] {
            floor.insert(Point2::new(x, y)).unwrap();
        }
        for ring in rings {
            let corners: Vec<_> = ring.iter().map(|p| floor.insert(theirs(*p)).unwrap()).collect();
            for k in 0..corners.len() {
                floor.add_constraint(corners[k], corners[(k + 1) % corners.len()]);
            }
        }
        Self { floor, crossed: Vec::new(), anchor, tip: anchor }
    }

    pub(super) fn drag_to(&mut self, to: Point) {
        let from = self.tip;
        let mut met: Vec<Portal> = Vec::new();
        for crossing in LineIntersectionIterator::new(&self.floor, theirs(from), theirs(to)) {
            if let Intersection::EdgeIntersection(edge) = crossing {
                let [p, q] = edge.positions().map(|p| Point::new(p.x, p.y));
                let p_is_left = (to - from).perp(&(p - from)) > 0.0;
                let (left, right) = if p_is_left { (p, q) } else { (q, p) };
                met.push(Portal { edge: edge.as_undirected().fix(), left, right });
            }
        }
        for portal in met {
            self.cross(portal);
        }
        self.tip = to;
    }

    fn cross(&mut self, portal: Portal) {
        if self.crossed.last().is_some_and(|last| last.edge == portal.edge) {
            self.crossed.pop();
        } else {
            self.crossed.push(portal);
        }
    }

    /// Returns the length of the taut cable, metres.
    pub(super) fn length_m(&self) -> f64 {
        geometry::polyline::length_m(&self.line())
    }

    /// Returns the taut cable (the funnel algorithm of Lee and Preparata, in its simple form).
    pub(super) fn line(&self) -> Vec<Point> {
        let mut gates: Vec<(Point, Point)> = self.crossed.iter().map(|p| (p.left, p.right)).collect();
        gates.push((self.tip, self.tip));
        let mut line = vec![self.anchor];
        let (mut apex, mut next) = (self.anchor, 0);
        'from_apex: while next < gates.len() {
            let (mut left, mut right) = gates[next];
            let (mut left_at, mut right_at) = (next, next);
            let first = next;
            for k in first..gates.len() {
                let (l, r) = gates[k];
                if (right - apex).perp(&(r - apex)) >= 0.0 {
                    if right == apex || (left - apex).perp(&(r - apex)) <= 0.0 {
                        (right, right_at) = (r, k);
                    } else {
                        apex = left;
                        next = skip(&gates, left_at + 1, apex);
                        line.push(apex);
                        continue 'from_apex;
                    }
                }
                if (left - apex).perp(&(l - apex)) <= 0.0 {
                    if left == apex || (right - apex).perp(&(l - apex)) >= 0.0 {
                        (left, left_at) = (l, k);
                    } else {
                        apex = right;
                        next = skip(&gates, right_at + 1, apex);
                        line.push(apex);
                        continue 'from_apex;
                    }
                }
            }
            break;
        }
        line.push(self.tip);
        line
    }
}

/// Gates that end at the apex do not constrain the cable.
fn skip(gates: &[(Point, Point)], from: usize, apex: Point) -> usize {
    (from..gates.len()).find(|k| gates[*k].0 != apex && gates[*k].1 != apex).unwrap_or(gates.len())
}
