//! The solid objects that the cable bears on.

use geometry::{
    Boundary, Point, Shape, Vector,
    convex::{Part, away_from, parts_of},
    polyline,
};
use world::{Obstacle, ObstacleMap};

/// Half the thickness of the cable, metres.
const CABLE_M: f64 = 0.01;

/// The wall and the obstacles.
#[derive(Clone)]
pub struct Surfaces {
    map: ObstacleMap,
    boundary: Boundary,
    /// For each obstacle, its convex parts and the distance from them at which a node of the cable touches them, metres.
    solids: Vec<(Vec<Part>, f64)>,
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
    /// Creates the surfaces of a tank for a cable whose links have a given length, metres. Obstacles thinner than a link
    /// count as slightly thicker, so that a link cannot pass through one.
    pub fn new(boundary: &Boundary, obstacles: &[Obstacle], link_m: f64) -> Self {
        let solids = obstacles.iter().map(|obstacle| {
            let keep_m = (0.6 * link_m - inner_m(&obstacle.shape)).max(CABLE_M);
            (parts_of(&obstacle.shape), keep_m)
        });
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
            let (parts, keep_m) = &self.solids[near.index];
            let nearest = parts.iter().map(|part| part.distance(node)).min_by(|a, b| a.0.total_cmp(&b.0));
            nearest.map(|(distance_m, away)| Touch { at: node, gap_m: distance_m - keep_m, away })
        });
        solids.chain(wall).filter(|touch| touch.gap_m < reach_m).min_by(|a, b| a.gap_m.total_cmp(&b.gap_m))
    }

    fn thickest_m(&self) -> f64 {
        self.solids.iter().map(|(_, keep_m)| *keep_m).fold(CABLE_M, f64::max)
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

/// About half of the smallest thickness of a shape, metres.
fn inner_m(shape: &Shape) -> f64 {
    match shape {
        Shape::Disc { radius_m, .. } => *radius_m,
        Shape::Polyline { half_width_m, .. } => *half_width_m,
        Shape::Polygon { vertices } => {
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
    }
}
