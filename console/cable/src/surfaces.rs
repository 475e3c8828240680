//! The solid objects that the cable bears on.

use geometry::{
    Boundary, Point, Vector,
    convex::{Part, away_from, parts_of},
    polyline,
    shape::convex_hull,
};
use world::{Obstacle, ObstacleMap};

/// Half the thickness of the cable, metres.
const CABLE_M: f64 = 0.01;
/// Distance by which the faces of a polygon are moved inward before it is grown by the radius of its corners, as a share of
/// this radius; and at most, as a share of half its thickness: the inscribed circle of a triangle has a radius of two thirds
/// of it.
const FACE_SHARE: f64 = 0.7;
const THIN_SHARE: f64 = 0.6;
/// Radius of a rounded corner, in links. A node then turns the cable by at most 50 degrees. With 0.8 links, cables stuck on
/// columns 8 cm thick.
const ROUND_LINKS: f64 = 1.2;

/// The wall and the obstacles.
#[derive(Clone)]
pub struct Surfaces {
    map: ObstacleMap,
    boundary: Boundary,
    /// For each obstacle, its convex parts.
    solids: Vec<Vec<Solid>>,
}

/// A convex part with round corners: everything within `keep_m` metres of `core` touches a node of the cable.
#[derive(Clone)]
struct Solid {
    core: Part,
    keep_m: f64,
}

/// The nearest surface to a node, as a plane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Touch {
    /// Where the node was.
    pub at: Point,
    /// Distance that the node might move toward the surface from there, metres; negative inside.
    pub gap_m: f64,
    /// Unit vector away from the surface.
    pub away: Vector,
}

impl Touch {
    /// The distance to the surface from another place, metres.
    pub(crate) fn gap_at_m(&self, place: Point) -> f64 {
        self.gap_m + self.away.dot(&(place - self.at))
    }
}

impl Surfaces {
    /// Creates the surfaces of a tank for a cable whose links have a given length, metres.
    ///
    /// Corners are rounded: a link cannot follow a bend that is tighter than itself. Its nodes would stand beside a sharp
    /// corner, and the next link would press them against the face instead of drawing them round the corner.
    pub fn new(boundary: &Boundary, obstacles: &[Obstacle], link_m: f64) -> Self {
        let solid = |obstacle: &Obstacle| {
            parts_of(&obstacle.shape).into_iter().map(|part| Solid::rounded(part, link_m)).collect()
        };
        let solids = obstacles.iter().map(solid);
        Self {
            map: ObstacleMap::new(boundary, obstacles),
            boundary: boundary.clone(),
            solids: solids.collect(),
        }
    }

    /// The nearest surface within reach of a node, metres.
    pub(crate) fn touch(&self, node: Point, reach_m: f64) -> Option<Touch> {
        let wall = self.wall(node).filter(|touch| touch.gap_m < reach_m);
        let most_m = reach_m + self.thickest_m();
        if self.map.obstacle_distance_m(node) > most_m {
            return wall;
        }
        let near = self.map.within(node, most_m);
        let solids = near.iter().filter_map(|near| {
            let touches = self.solids[near.index].iter().map(|solid| solid.touch(node));
            touches.min_by(|a, b| a.gap_m.total_cmp(&b.gap_m))
        });
        solids.chain(wall).filter(|touch| touch.gap_m < reach_m).min_by(|a, b| a.gap_m.total_cmp(&b.gap_m))
    }

    fn thickest_m(&self) -> f64 {
        self.solids.iter().flatten().map(|solid| solid.keep_m).fold(CABLE_M, f64::max)
    }

    fn wall(&self, node: Point) -> Option<Touch> {
        let inside_m = self.boundary.wall_distance_m(node);
        let away = match &self.boundary {
            Boundary::Circle { .. } => -geometry::direction_or(node.coords, Vector::x()),
            Boundary::Polygon { vertices } => {
                let nearest = polyline::edges(vertices)
                    .map(|(a, b)| polyline::nearest_on_segment(a, b, node))
                    .min_by(|a, b| (a - node).norm().total_cmp(&(b - node).norm()))?;
                away_from(node, inside_m, nearest, geometry::shape::mean_of(vertices))
            }
        };
        Some(Touch { at: node, gap_m: inside_m - CABLE_M, away })
    }
}

impl Solid {
    /// A part with round corners for a cable whose links have a given length, metres. Each corner is moved inward, and
    /// everything is grown by the radius again. The rounded outline contains the part, passes through corners of up to 90
    /// degrees of thick parts, and its faces are about a third of the radius outside those of the part. A thin part becomes
    /// thicker, up to the radius on each side.
    fn rounded(part: Part, link_m: f64) -> Self {
        let radius_m = ROUND_LINKS * link_m;
        let vertices = match &part {
            Part::Capsule { half_width_m, .. } => {
                return Self { keep_m: (radius_m - half_width_m).max(CABLE_M), core: part };
            }
            Part::Polygon { vertices } => vertices,
        };
        let inward_m = (FACE_SHARE * radius_m).min(THIN_SHARE * inner_m(vertices));
        let (n, middle) = (vertices.len(), part.middle());
        let corner = |k: usize| {
            let (before, at, after) = (vertices[(k + n - 1) % n], vertices[k], vertices[(k + 1) % n]);
            let [one, other] =
                [before - at, after - at].map(|side| geometry::direction_or(side, Vector::x()));
            let inward = geometry::direction_or(one + other, Vector::new(-other.y, other.x));
            // The sine of half the angle of the corner.
            let sine = inward.perp(&one).abs().max(1e-6);
            let moved = at + inward * (inward_m / sine).min(radius_m);
            // Beside a short edge, this may lead out on the other side.
            if part.distance(moved).0 <= 0.0 {
                return moved;
            }
            let to_middle = middle - at;
            at + to_middle * (radius_m / to_middle.norm()).min(1.0)
        };
        let core = convex_hull(&(0..n).map(corner).collect::<Vec<_>>());
        let core = match core[..] {
            [] => Part::disc(middle, 0.0),
            [a] => Part::disc(a, 0.0),
            [a, b] => Part::segment(a, b),
            _ => Part::Polygon { vertices: core },
        };
        Self { core, keep_m: radius_m.max(CABLE_M) }
    }

    fn touch(&self, node: Point) -> Touch {
        let (distance_m, away) = self.core.distance(node);
        Touch { at: node, gap_m: distance_m - self.keep_m, away }
    }
}

/// Half of the smallest thickness of a convex polygon, metres.
fn inner_m(vertices: &[Point]) -> f64 {
    let across = |(a, b): (Point, Point)| {
        let normal = geometry::direction_or(Vector::new(a.y - b.y, b.x - a.x), Vector::x());
        let [low, high] = vertices
            .iter()
            .map(|corner| normal.dot(&(corner - a)))
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)]);
        high - low
    };
    0.5 * polyline::edges(vertices).map(across).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_rounded_part_contains_the_part_and_is_little_larger(
            at in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 3..9),
            link_m in 0.02..0.3_f64,
        ) {
            let vertices = convex_hull(&at.iter().map(|(x, y)| Point::new(*x, *y)).collect::<Vec<_>>());
            prop_assume!(vertices.len() >= 3);
            let part = Part::Polygon { vertices: vertices.clone() };
            let solid = Solid::rounded(part.clone(), link_m);
            for (a, b) in polyline::edges(&vertices) {
                for share in [0.0, 0.3, 0.5, 0.8] {
                    prop_assert!(solid.touch(a + (b - a) * share).gap_m < 1e-9);
                }
            }
            for k in 0..40 {
                let far = Point::origin() + geometry::unit_vector(f64::from(k) * 0.157) * 2.0;
                let gap_m = part.distance(far).0 - solid.touch(far).gap_m;
                prop_assert!((-1e-9..=1.2 * link_m + 1e-9).contains(&gap_m), "{gap_m}");
            }
        }
    }
}
