//! Distances, rays and neighbours among many obstacles.
//!
//! parry2d does the geometry (and speaks glam); this module is the one border where nalgebra's points become glam's.
//! Cost: every query descends a bounding volume hierarchy, so it grows with the logarithm of the obstacle count
//! plus the number of obstacles actually near.

mod boxes;

pub(crate) use boxes::Boxes;

use crate::{
    Boundary,
    geometry::{Point, Vector},
    polyline::nearest_on_segment,
    shape::Shape,
    tank::{Obstacle, ObstacleId},
};
use glam::DVec2;
use parry2d_f64::{
    bounding_volume::Aabb,
    math::Pose as ParryPose,
    partitioning::{Bvh, BvhBuildStrategy},
    query::{self, PointQuery, Ray},
    shape::{Segment, SharedShape},
};

/// One convex part of an obstacle.
#[derive(Clone)]
struct Piece {
    /// Index into the obstacles.
    owner: usize,
    geometry: Geometry,
}

#[derive(Clone)]
enum Geometry {
    // The papers' obstacles may be points: a ball of radius zero has no direction in parry, a disc here has.
    Disc { center: Point, radius_m: f64 },
    Solid { shape: SharedShape },
}

/// An obstacle near a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Near {
    /// Index into the obstacles that the map was made of.
    pub index: usize,
    /// Its id.
    pub id: ObstacleId,
    /// Distance from the point to its outline, metres; negative inside.
    pub distance_m: f64,
    /// Nearest point of its outline.
    pub closest: Point,
}

/// Obstacles and wall, ready for queries.
#[derive(Clone)]
pub struct ObstacleMap {
    boundary: Boundary,
    ids: Vec<ObstacleId>,
    pieces: Vec<Piece>,
    tree: Bvh,
}

impl ObstacleMap {
    /// A map of these obstacles within this wall; costs `n log n` once.
    pub fn new(boundary: &Boundary, obstacles: &[Obstacle]) -> Self {
        let pieces: Vec<Piece> = obstacles
            .iter()
            .enumerate()
            .flat_map(|(owner, o)| {
                geometries(&o.shape).into_iter().map(move |geometry| Piece { owner, geometry })
            })
            .collect();
        let boxes: Vec<Aabb> = pieces.iter().map(|piece| piece.geometry.bounds()).collect();
        Self {
            boundary: boundary.clone(),
            ids: obstacles.iter().map(|o| o.id).collect(),
            pieces,
            tree: Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes),
        }
    }

    /// Distance to the nearest obstacle or the wall, metres; negative inside an obstacle or outside the tank.
    pub fn clearance_m(&self, point: Point) -> f64 {
        self.boundary.wall_distance_m(point).min(self.obstacle_distance_m(point))
    }

    /// Distance to the nearest obstacle, metres; negative inside one, infinite without any.
    pub fn obstacle_distance_m(&self, point: Point) -> f64 {
        self.nearest(point).map_or(f64::INFINITY, |near| near.distance_m)
    }

    /// The wall around them.
    pub fn boundary(&self) -> &Boundary {
        &self.boundary
    }

    /// The nearest obstacle.
    pub fn nearest(&self, point: Point) -> Option<Near> {
        let at: DVec2 = point.into();
        let (leaf, _) = self.tree.find_best(
            f64::MAX,
            |node, _| node.aabb().distance_to_local_point(at, true),
            |leaf, _| Some(self.pieces[leaf as usize].geometry.project(point).0),
        )?;
        Some(self.near(leaf, point))
    }

    /// The obstacles within a range of a point, each once, in order of their index.
    pub fn within(&self, point: Point, range_m: f64) -> Vec<Near> {
        let around = Aabb::from_half_extents(point.into(), DVec2::splat(range_m));
        let mut found: Vec<Near> = self
            .tree
            .intersect_aabb(&around)
            .map(|leaf| self.near(leaf, point))
            .filter(|near| near.distance_m <= range_m)
            .collect();
        found.sort_by(|a, b| a.index.cmp(&b.index).then(a.distance_m.total_cmp(&b.distance_m)));
        found.dedup_by_key(|near| near.index);
        found
    }

    /// Distance along a ray to the first obstacle, metres; `None` if there is none within `max_m`.
    ///
    /// `direction` is a unit vector; a ray that starts inside an obstacle hits at 0.
    pub fn ray_m(&self, from: Point, direction: Vector, max_m: f64) -> Option<f64> {
        let ray = Ray::new(from.into(), direction.into());
        let hit = self.tree.cast_ray(&ray, max_m, |leaf, best| {
            self.pieces[leaf as usize].geometry.ray_m(&ray, from, direction, best.min(max_m))
        });
        hit.map(|(_, distance)| distance).filter(|distance| *distance <= max_m)
    }

    /// Smallest distance from any point of a segment to an obstacle or the wall, metres; not above zero if it touches.
    pub fn segment_clearance_m(&self, a: Point, b: Point) -> f64 {
        self.obstacle_clearance_m(a, b).min(wall_clearance_m(&self.boundary, a, b))
    }

    /// The same to obstacles alone; infinite without any.
    pub fn obstacle_clearance_m(&self, a: Point, b: Point) -> f64 {
        let around = segment_box(a, b);
        let nearest = self.tree.find_best(
            f64::MAX,
            |node, _| box_gap(&node.aabb(), &around),
            |leaf, _| Some(self.pieces[leaf as usize].geometry.segment_distance_m(a, b)),
        );
        nearest.map_or(f64::INFINITY, |(_, distance)| distance)
    }

    fn near(&self, leaf: u32, point: Point) -> Near {
        let piece = &self.pieces[leaf as usize];
        let (distance_m, closest) = piece.geometry.project(point);
        Near { index: piece.owner, id: self.ids[piece.owner], distance_m, closest }
    }
}

/// A wall keeps its distance between the ends of a segment only if it is round: the distance to a circle from
/// inside is concave along a line, so its least value is at an end.
pub(crate) fn wall_clearance_m(boundary: &Boundary, a: Point, b: Point) -> f64 {
    let ends = boundary.wall_distance_m(a).min(boundary.wall_distance_m(b));
    let Boundary::Polygon { vertices } = boundary else { return ends };
    let pieces = Geometry::of_ring(vertices);
    pieces.iter().map(|piece| piece.segment_distance_m(a, b)).fold(ends, f64::min)
}

fn geometries(shape: &Shape) -> Vec<Geometry> {
    match shape {
        Shape::Disc { center, radius_m } => vec![Geometry::Disc { center: *center, radius_m: *radius_m }],
        Shape::Polygon { vertices } => {
            let corners: Vec<DVec2> = vertices.iter().map(|p| (*p).into()).collect();
            let solid = SharedShape::convex_polyline(corners);
            solid.map_or_else(|| Geometry::of_ring(vertices), |shape| vec![Geometry::Solid { shape }])
        }
        Shape::Polyline { points, half_width_m } => points
            .windows(2)
            .map(|w| Geometry::Solid { shape: SharedShape::capsule(w[0].into(), w[1].into(), *half_width_m) })
            .collect(),
    }
}

impl Geometry {
    fn of_ring(vertices: &[Point]) -> Vec<Self> {
        geometry::polyline::edges(vertices)
            .map(|(a, b)| Self::Solid { shape: SharedShape::segment(a.into(), b.into()) })
            .collect()
    }

    fn bounds(&self) -> Aabb {
        match self {
            Self::Disc { center, radius_m } => {
                Aabb::from_half_extents((*center).into(), DVec2::splat(*radius_m))
            }
            Self::Solid { shape } => shape.compute_aabb(&ParryPose::IDENTITY),
        }
    }

    /// Signed distance to the outline and the nearest point of it.
    fn project(&self, point: Point) -> (f64, Point) {
        match self {
            Self::Disc { center, radius_m } => {
                let from_center = point - center;
                let distance = from_center.norm();
                let outward = if distance > 0.0 { from_center / distance } else { Vector::x() };
                (distance - radius_m, center + outward * *radius_m)
            }
            Self::Solid { shape } => {
                let projection = shape.project_local_point(point.into(), false);
                let closest: Point = projection.point.into();
                let distance = (point - closest).norm();
                (if projection.is_inside { -distance } else { distance }, closest)
            }
        }
    }

    fn ray_m(&self, ray: &Ray, from: Point, direction: Vector, max_m: f64) -> Option<f64> {
        match self {
            Self::Disc { center, radius_m } => {
                let to_center = center - from;
                let ahead = to_center.dot(&direction);
                let inside = to_center.norm() <= *radius_m;
                let half_chord = radius_m * radius_m - (to_center.norm_squared() - ahead * ahead);
                let hit = if inside { 0.0 } else { ahead - half_chord.max(0.0).sqrt() };
                (inside || (half_chord >= 0.0 && ahead >= 0.0)).then_some(hit).filter(|m| *m <= max_m)
            }
            Self::Solid { shape } => shape.cast_local_ray(ray, max_m, true),
        }
    }

    fn segment_distance_m(&self, a: Point, b: Point) -> f64 {
        match self {
            Self::Disc { center, radius_m } => (center - nearest_on_segment(a, b, *center)).norm() - radius_m,
            _ if a == b => self.project(a).0,
            Self::Solid { shape } => {
                let (here, segment) = (ParryPose::IDENTITY, Segment::new(a.into(), b.into()));
                query::distance(&here, &segment, &here, &**shape)
                    .map_or_else(|_| self.project(a).0.min(self.project(b).0), |found| found.distance)
            }
        }
    }
}

fn segment_box(a: Point, b: Point) -> Aabb {
    Aabb::new(a.inf(&b).into(), a.sup(&b).into())
}

/// Distance between two boxes, metres; 0 when they overlap.
fn box_gap(a: &Aabb, b: &Aabb) -> f64 {
    (a.mins - b.maxs).max(b.mins - a.maxs).max(DVec2::ZERO).length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn round_tank() -> Boundary {
        Boundary::Circle { radius_m: 10.0 }
    }

    fn obstacle(index: u32, shape: Shape) -> Obstacle {
        Obstacle { id: ObstacleId(index), name: format!("C{index}"), shape, known: true }
    }

    fn square(x: f64, y: f64, half: f64) -> Shape {
        let corner = |dx: f64, dy: f64| Point::new(x + dx * half, y + dy * half);
        Shape::Polygon {
            vertices: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        }
    }

    fn any_shape() -> impl Strategy<Value = Shape> {
        let at = (-8.0..8.0_f64, -8.0..8.0_f64);
        prop_oneof![
            (at.clone(), 0.0..1.0_f64)
                .prop_map(|((x, y), r)| Shape::Disc { center: Point::new(x, y), radius_m: r }),
            (at.clone(), 0.05..1.0_f64).prop_map(|((x, y), half)| square(x, y, half)),
            (at.clone(), at, 0.01..0.3_f64).prop_map(|((x, y), (u, v), half_width_m)| Shape::Polyline {
                points: vec![Point::new(x, y), Point::new(u, v), Point::new(u, -v)],
                half_width_m,
            }),
        ]
    }

    proptest! {
        #[test]
        fn the_tree_finds_what_a_search_of_all_finds(
            shapes in prop::collection::vec(any_shape(), 1..12),
            x in -9.0..9.0_f64,
            y in -9.0..9.0_f64,
        ) {
            let point = Point::new(x, y);
            let obstacles: Vec<Obstacle> =
                shapes.iter().enumerate().map(|(i, s)| obstacle(i as u32, s.clone())).collect();
            let map = ObstacleMap::new(&round_tank(), &obstacles);
            let nearest = shapes.iter().map(|s| s.distance_m(point)).fold(f64::INFINITY, f64::min);
            // Inside overlapping obstacles the depth is that of one of them.
            if nearest > 0.0 {
                prop_assert!((map.obstacle_distance_m(point) - nearest).abs() < 1e-9);
            } else {
                prop_assert!(map.obstacle_distance_m(point) <= 1e-9);
            }
            let within = map.within(point, 2.0).len();
            prop_assert_eq!(within, shapes.iter().filter(|s| s.distance_m(point) <= 2.0).count());
        }

        #[test]
        fn a_segment_is_as_clear_as_its_worst_point(
            shapes in prop::collection::vec(any_shape(), 1..8),
            ends in (-6.0..6.0_f64, -6.0..6.0_f64, -6.0..6.0_f64, -6.0..6.0_f64),
        ) {
            let (a, b) = (Point::new(ends.0, ends.1), Point::new(ends.2, ends.3));
            let obstacles: Vec<Obstacle> =
                shapes.iter().enumerate().map(|(i, s)| obstacle(i as u32, s.clone())).collect();
            let map = ObstacleMap::new(&round_tank(), &obstacles);
            let clear = map.segment_clearance_m(a, b);
            let sampled = (0..=400)
                .map(|k| map.clearance_m(a + (b - a) * (f64::from(k) / 400.0)))
                .fold(f64::INFINITY, f64::min);
            prop_assert!(clear <= sampled.max(0.0) + 1e-6);
            prop_assert!(sampled <= 0.05 || clear >= sampled - 0.05);
        }

        #[test]
        fn a_ray_ends_on_an_outline(shapes in prop::collection::vec(any_shape(), 1..8), bearing in 0.0..std::f64::consts::TAU) {
            let obstacles: Vec<Obstacle> =
                shapes.iter().enumerate().map(|(i, s)| obstacle(i as u32, s.clone())).collect();
            let map = ObstacleMap::new(&round_tank(), &obstacles);
            let (from, direction) = (Point::origin(), Vector::new(bearing.cos(), bearing.sin()));
            if let Some(distance) = map.ray_m(from, direction, 12.0) {
                prop_assert!(map.obstacle_distance_m(from + direction * distance) < 1e-6);
            }
        }
    }

    #[test]
    fn the_wall_counts_as_an_obstacle() {
        let map = ObstacleMap::new(&round_tank(), &[]);
        assert!((map.clearance_m(Point::new(9.0, 0.0)) - 1.0).abs() < 1e-12);
        assert!(map.clearance_m(Point::new(10.5, 0.0)) < 0.0);
        assert!(map.obstacle_distance_m(Point::origin()).is_infinite());
    }
}
