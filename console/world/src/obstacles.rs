//! Distance, ray and neighbour queries among many obstacles.
//!
//! parry2d computes the geometry with the types of glam; only this file and `boxes` convert between nalgebra and glam.
//! Cost: every query descends a bounding volume hierarchy, so its cost grows with the logarithm of the number of
//! obstacles, plus the number of obstacles nearby.

mod boxes;

pub(crate) use boxes::Boxes;

use crate::tank::{Obstacle, ObstacleId};
use geometry::{
    Boundary, Point, Shape, Vector,
    polyline::{edges, nearest_on_segment},
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
struct ObstaclePart {
    /// Index of the obstacle.
    owner: usize,
    outline: Outline,
}

#[derive(Clone)]
enum Outline {
    // Obstacles in the papers may be points, but parry gives no outward direction for a ball of radius zero.
    Disc { center: Point, radius_m: f64 },
    Parry(SharedShape),
}

/// An obstacle near a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Near {
    /// Index in the list of obstacles from which the map was made.
    pub index: usize,
    /// The id of the obstacle.
    pub id: ObstacleId,
    /// Distance from the point to the outline, metres; negative inside.
    pub distance_m: f64,
    /// Nearest point on the outline, tank frame.
    pub closest: Point,
}

/// Obstacles and wall, ready for queries; all points in the tank frame.
///
/// ```
/// use world::{Boundary, Obstacle, ObstacleId, ObstacleMap, Point, Shape};
/// # let shape = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
/// # let column = Obstacle { id: ObstacleId(7), name: "C7".into(), shape, known: true };
/// // A column of radius 0.5 m at (4, 0).
/// let map = ObstacleMap::new(&Boundary::Circle { radius_m: 10.0 }, &[column]);
/// assert_eq!(map.clearance_m(Point::origin()), 3.5);
/// ```
#[derive(Clone)]
pub struct ObstacleMap {
    boundary: Boundary,
    ids: Vec<ObstacleId>,
    parts: Vec<ObstaclePart>,
    tree: Bvh,
}

impl ObstacleMap {
    /// Creates a map of obstacles within a wall, at a one-time cost of `n log n`.
    ///
    /// ```
    /// use world::{Boundary, Obstacle, ObstacleId, ObstacleMap, Point, Shape};
    /// # let shape = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let column = Obstacle { id: ObstacleId(7), name: "C7".into(), shape, known: true };
    /// // A column of radius 0.5 m at (4, 0).
    /// let map = ObstacleMap::new(&Boundary::Circle { radius_m: 10.0 }, &[column]);
    /// assert_eq!(map.within(Point::origin(), 4.0).len(), 1);
    /// ```
    pub fn new(boundary: &Boundary, obstacles: &[Obstacle]) -> Self {
        let parts: Vec<ObstaclePart> = obstacles
            .iter()
            .enumerate()
            .flat_map(|(owner, o)| {
                outlines(&o.shape).into_iter().map(move |outline| ObstaclePart { owner, outline })
            })
            .collect();
        let boxes: Vec<Aabb> = parts.iter().map(|part| part.outline.bounds()).collect();
        Self {
            boundary: boundary.clone(),
            ids: obstacles.iter().map(|o| o.id).collect(),
            parts,
            tree: Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes),
        }
    }

    /// Returns the distance to the nearest obstacle or the wall, metres; negative inside an obstacle or outside the
    /// tank.
    ///
    /// ```
    /// use world::{Boundary, Obstacle, ObstacleId, ObstacleMap, Point, Shape};
    /// # let shape = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let column = Obstacle { id: ObstacleId(7), name: "C7".into(), shape, known: true };
    /// // A column of radius 0.5 m at (4, 0).
    /// let map = ObstacleMap::new(&Boundary::Circle { radius_m: 10.0 }, &[column]);
    /// assert_eq!(map.clearance_m(Point::new(8.0, 0.0)), 2.0);
    /// ```
    pub fn clearance_m(&self, point: Point) -> f64 {
        self.boundary.wall_distance_m(point).min(self.obstacle_distance_m(point))
    }

    /// Returns the distance to the nearest obstacle, metres; negative inside an obstacle, infinite without obstacles.
    ///
    /// ```
    /// use world::{Boundary, Obstacle, ObstacleId, ObstacleMap, Point, Shape};
    /// # let shape = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let column = Obstacle { id: ObstacleId(7), name: "C7".into(), shape, known: true };
    /// // A column of radius 0.5 m at (4, 0).
    /// let map = ObstacleMap::new(&Boundary::Circle { radius_m: 10.0 }, &[column]);
    /// assert_eq!(map.obstacle_distance_m(Point::new(8.0, 0.0)), 3.5);
    /// ```
    pub fn obstacle_distance_m(&self, point: Point) -> f64 {
        let at: DVec2 = point.into();
        let nearest = self.tree.find_best(
            f64::MAX,
            |node, _| node.aabb().distance_to_local_point(at, true),
            |leaf, _| Some(self.parts[leaf as usize].outline.project(point).0),
        );
        nearest.map_or(f64::INFINITY, |(_, distance_m)| distance_m)
    }

    /// The wall around the obstacles.
    pub(crate) fn boundary(&self) -> &Boundary {
        &self.boundary
    }

    /// Returns the obstacles within a given range of a point, metres. Each is listed once, in order of index.
    ///
    /// ```
    /// use world::{Boundary, Obstacle, ObstacleId, ObstacleMap, Point, Shape};
    /// # let shape = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let column = Obstacle { id: ObstacleId(7), name: "C7".into(), shape, known: true };
    /// // A column of radius 0.5 m at (4, 0).
    /// let map = ObstacleMap::new(&Boundary::Circle { radius_m: 10.0 }, &[column]);
    /// assert_eq!(map.within(Point::origin(), 3.4), []);
    /// assert_eq!(map.within(Point::origin(), 3.6)[0].distance_m, 3.5);
    /// ```
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

    /// Returns the distance along a ray to the first obstacle, metres; `None` if there is no obstacle within `max_m`.
    ///
    /// `direction` is a unit vector; a ray that starts inside an obstacle hits at 0.
    ///
    /// ```
    /// use world::{Boundary, Obstacle, ObstacleId, ObstacleMap, Point, Shape, Vector};
    /// # let shape = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let column = Obstacle { id: ObstacleId(7), name: "C7".into(), shape, known: true };
    /// // A column of radius 0.5 m at (4, 0).
    /// let map = ObstacleMap::new(&Boundary::Circle { radius_m: 10.0 }, &[column]);
    /// assert_eq!(map.ray_m(Point::origin(), Vector::x(), 12.0), Some(3.5));
    /// assert_eq!(map.ray_m(Point::origin(), Vector::y(), 12.0), None);
    /// ```
    pub fn ray_m(&self, from: Point, direction: Vector, max_m: f64) -> Option<f64> {
        let ray = Ray::new(from.into(), direction.into());
        let hit = self.tree.cast_ray(&ray, max_m, |leaf, best| {
            self.parts[leaf as usize].outline.ray_m(&ray, from, direction, best.min(max_m))
        });
        hit.map(|(_, distance)| distance).filter(|distance| *distance <= max_m)
    }

    /// Returns the smallest distance from a segment to any obstacle or the wall, metres; zero or negative if it
    /// touches one.
    ///
    /// ```
    /// use world::{Boundary, Obstacle, ObstacleId, ObstacleMap, Point, Shape};
    /// # let shape = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// # let column = Obstacle { id: ObstacleId(7), name: "C7".into(), shape, known: true };
    /// // A column of radius 0.5 m at (4, 0).
    /// let map = ObstacleMap::new(&Boundary::Circle { radius_m: 10.0 }, &[column]);
    /// let (a, b) = (Point::new(0.0, 2.0), Point::new(6.0, 2.0));
    /// assert_eq!(map.segment_clearance_m(a, b), 1.5);
    /// ```
    pub fn segment_clearance_m(&self, a: Point, b: Point) -> f64 {
        self.obstacle_clearance_m(a, b).min(wall_clearance_m(&self.boundary, a, b))
    }

    /// Returns the smallest distance from a segment to any obstacle, metres; infinite without obstacles.
    pub(crate) fn obstacle_clearance_m(&self, a: Point, b: Point) -> f64 {
        let around = segment_box(a, b);
        let nearest = self.tree.find_best(
            f64::MAX,
            |node, _| box_gap(&node.aabb(), &around),
            |leaf, _| Some(self.parts[leaf as usize].outline.segment_distance_m(a, b)),
        );
        nearest.map_or(f64::INFINITY, |(_, distance)| distance)
    }

    fn near(&self, leaf: u32, point: Point) -> Near {
        let part = &self.parts[leaf as usize];
        let (distance_m, closest) = part.outline.project(point);
        Near { index: part.owner, id: self.ids[part.owner], distance_m, closest }
    }
}

/// Returns the smallest distance from a segment to the wall, metres.
///
/// Inside a round wall, the distance to the wall is concave along a segment, so it is smallest at one of the ends.
pub(crate) fn wall_clearance_m(boundary: &Boundary, a: Point, b: Point) -> f64 {
    let ends = boundary.wall_distance_m(a).min(boundary.wall_distance_m(b));
    let Boundary::Polygon { vertices } = boundary else { return ends };
    let parts = Outline::of_ring(vertices);
    parts.iter().map(|part| part.segment_distance_m(a, b)).fold(ends, f64::min)
}

fn outlines(shape: &Shape) -> Vec<Outline> {
    match shape {
        Shape::Disc { center, radius_m } => vec![Outline::Disc { center: *center, radius_m: *radius_m }],
        Shape::Polygon { vertices } => {
            let corners: Vec<DVec2> = vertices.iter().map(|p| (*p).into()).collect();
            let solid = SharedShape::convex_polyline(corners);
            solid.map_or_else(|| Outline::of_ring(vertices), |shape| vec![Outline::Parry(shape)])
        }
        Shape::Polyline { points, half_width_m } => points
            .windows(2)
            .map(|w| Outline::Parry(SharedShape::capsule(w[0].into(), w[1].into(), *half_width_m)))
            .collect(),
    }
}

impl Outline {
    fn of_ring(vertices: &[Point]) -> Vec<Self> {
        edges(vertices).map(|(a, b)| Self::Parry(SharedShape::segment(a.into(), b.into()))).collect()
    }

    fn bounds(&self) -> Aabb {
        match self {
            Self::Disc { center, radius_m } => {
                Aabb::from_half_extents((*center).into(), DVec2::splat(*radius_m))
            }
            Self::Parry(shape) => shape.compute_aabb(&ParryPose::IDENTITY),
        }
    }

    /// Returns the signed distance to the outline, and the nearest point on the outline.
    fn project(&self, point: Point) -> (f64, Point) {
        match self {
            Self::Disc { center, radius_m } => {
                let from_center = point - center;
                let distance = from_center.norm();
                let outward = if distance > 0.0 { from_center / distance } else { Vector::x() };
                (distance - radius_m, center + outward * *radius_m)
            }
            Self::Parry(shape) => {
                let projection = shape.project_local_point(point.into(), false);
                // For a point on a side, parry may report that it is deep inside, because its search ends at a
                // different side.
                let inside_of = shape.as_convex_polygon().filter(|_| projection.is_inside);
                let closest = inside_of
                    .and_then(|polygon| nearest_on_sides(polygon.points(), point))
                    .unwrap_or_else(|| projection.point.into());
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
            Self::Parry(shape) => shape.cast_local_ray(ray, max_m, true),
        }
    }

    fn segment_distance_m(&self, a: Point, b: Point) -> f64 {
        match self {
            Self::Disc { center, radius_m } => (center - nearest_on_segment(a, b, *center)).norm() - radius_m,
            _ if a == b => self.project(a).0,
            Self::Parry(shape) => {
                let (here, segment) = (ParryPose::IDENTITY, Segment::new(a.into(), b.into()));
                query::distance(&here, &segment, &here, &**shape)
                    .map_or_else(|_| self.project(a).0.min(self.project(b).0), |found| found.distance)
            }
        }
    }
}

fn nearest_on_sides(corners: &[DVec2], point: Point) -> Option<Point> {
    let corners: Vec<Point> = corners.iter().map(|corner| (*corner).into()).collect();
    let far = |at: &Point| (at - point).norm();
    edges(&corners).map(|(a, b)| nearest_on_segment(a, b, point)).min_by(|a, b| far(a).total_cmp(&far(b)))
}

fn segment_box(a: Point, b: Point) -> Aabb {
    Aabb::new(a.inf(&b).into(), a.sup(&b).into())
}

/// Returns the distance between two boxes, metres; 0 if they overlap.
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
            // Inside overlapping obstacles, the depth is the depth in one of them.
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
