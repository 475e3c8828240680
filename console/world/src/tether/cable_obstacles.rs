//! Defines what a cable can bear on: every obstacle and every inward corner of the wall, divided into round posts.
//!
//! A taut line touches a solid only along its convex hull. The convex hull of a disc, a polygon or a pipe is that of a
//! few discs: the disc itself, the corners (discs of radius 0), or the ends and bends of the pipe. A line derived from
//! a path outside the obstacles never passes between two posts of one solid, so posts alone give the exact taut line.
//! Obstacles that touch or overlap need no special case: no path leads between them, so the cable bridges the notch
//! from one to the other, and each contact names the obstacle that the cable bears on there. A cable cannot bear on a
//! post inside another post, so such posts are dropped.

use super::{homotopy::Rays, rounded_polygon::RoundedPolygon, sidestep::Sidestep};
use crate::obstacles::Boxes;
use geometry::{Boundary, Point, Shape, Vector, polyline::edges, shape::reflex_corners};
use serde::{Deserialize, Serialize};

/// The largest angle to an edge, given as its sine, at which a line does not count as entering the solid.
const ALONG_EDGE: f64 = 1e-6;
/// Distance from a corner at which anything solid counts as directly adjacent, metres.
const BESIDE_M: f64 = 1e-6;

/// The object that a cable bears on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Bearing {
    /// The obstacle with this index in the list that the [`CableObstacles`] were made from.
    Obstacle(usize),
    /// An inward corner of the wall.
    Wall,
}

/// A disc that a cable can bear on; radius 0 is a corner.
#[derive(Debug, Clone, Copy)]
pub(super) struct Post {
    pub center: Point,
    pub radius_m: f64,
    pub of: Bearing,
    /// Unit vectors along the edges that meet at a corner; zero if there are none.
    edges: [Vector; 2],
}

impl Post {
    /// Whether a line in this direction may bear on the post, with the post's solid to the left (`side` 1) or right
    /// (-1) of the line.
    ///
    /// A round post lies on the side on which the line touches it; at a corner, only the edges decide.
    pub(super) fn lies_on(&self, side: f64, line: Vector) -> bool {
        let most = -ALONG_EDGE * line.norm();
        self.radius_m > 0.0 || self.edges.iter().all(|edge| side * line.perp(edge) >= most)
    }

    /// Returns the south-west and north-east corners of the bounding box.
    fn bounds(&self) -> (Point, Point) {
        let far = Vector::new(self.radius_m, self.radius_m);
        (self.center - far, self.center + far)
    }

    /// Whether a line can bend here despite adjacent solids: at a corner, the extensions of both edges must lead into
    /// free floor. Floors from maps consist of many convex pieces, and most of their corners adjoin other pieces.
    fn can_bear(&self, is_solid: impl Fn(Point) -> bool) -> bool {
        self.radius_m > 0.0 || !self.edges.iter().any(|edge| is_solid(self.center - edge * BESIDE_M))
    }
}

/// Returns the point where a line with a given bearing touches a disc; the disc is to the left of the line if `side` is
/// 1, to the right if it is -1.
pub(super) fn tangent_point(center: Point, radius_m: f64, side: f64, bearing_rad: f64) -> Point {
    let left = Vector::new(-bearing_rad.sin(), bearing_rad.cos());
    center - left * (side * radius_m)
}

/// Obstacles and wall as they affect a cable; made once and shared between cables.
#[derive(Debug, Clone)]
pub struct CableObstacles {
    pub(super) posts: Vec<Post>,
    boxes: Boxes,
    pub(super) sidestep: Sidestep,
    /// A ray from each obstacle, for the homotopy signature.
    pub(super) rays: Rays,
    /// Edges of a wall with inward corners; the edges of a convex wall are never crossed.
    walls: Vec<(Point, Point)>,
}

impl CableObstacles {
    /// Creates obstacles within a wall, tank frame; contacts name obstacles by their index in `shapes`.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use world::{Boundary, Point, Shape, tether::{Cable, CableObstacles}};
    /// let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// let obstacles = Arc::new(CableObstacles::new(&Boundary::Circle { radius_m: 10.0 }, &[column]));
    /// assert!(Cable::on(Point::new(3.6, 0.0), obstacles).is_err());
    /// ```
    pub fn new(boundary: &Boundary, shapes: &[Shape]) -> Self {
        Self::grown(boundary, shapes, 0.0)
    }

    /// Creates obstacles and inward corners that are grown by a margin, metres, to form the limits for the centre of a
    /// hull.
    ///
    /// The rest of the wall is not grown: no taut line bears on it.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use world::{Boundary, Point, Shape, tether::{Cable, CableObstacles}};
    /// let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// let grown = Arc::new(CableObstacles::grown(&Boundary::Circle { radius_m: 10.0 }, &[column], 0.25));
    /// let mut center = Cable::on(Point::origin(), grown).unwrap();
    /// center.drag_along(&[Point::new(4.0, 2.0), Point::new(8.0, 0.0)]);
    /// assert!((center.length_m() - 8.141).abs() < 1e-3);
    /// ```
    pub fn grown(boundary: &Boundary, shapes: &[Shape], margin_m: f64) -> Self {
        let of_obstacles = shapes
            .iter()
            .enumerate()
            .flat_map(|(index, shape)| posts_of(shape, margin_m, Bearing::Obstacle(index)));
        let of_wall = wall_posts(boundary, margin_m);
        let mut solids: Vec<RoundedPolygon> =
            shapes.iter().flat_map(|shape| RoundedPolygon::parts_of(shape, margin_m)).collect();
        if margin_m > 0.0 {
            solids.extend(wall_corners(boundary, margin_m));
        }
        let walls = match boundary {
            Boundary::Polygon { vertices } if !of_wall.is_empty() => edges(vertices).collect(),
            Boundary::Polygon { .. } | Boundary::Circle { .. } => Vec::new(),
        };
        let sidestep = Sidestep::new(solids, margin_m > 0.0);
        let is_solid = |at: Point| sidestep.holds(at) || boundary.wall_distance_m(at) < -BESIDE_M / 1e3;
        let mut posts = without_hidden(&of_obstacles.chain(of_wall).collect::<Vec<_>>());
        posts.retain(|post| post.can_bear(is_solid));
        Self {
            boxes: Boxes::new(posts.iter().map(Post::bounds)),
            posts,
            sidestep,
            rays: Rays::new(&shapes.iter().map(ray_origin).collect::<Vec<_>>()),
            walls,
        }
    }

    /// Returns the posts that come within `room_m` of a segment, in no particular order; a few other posts may be
    /// included.
    pub(super) fn near(&self, a: Point, b: Point, room_m: f64) -> impl Iterator<Item = usize> + '_ {
        self.boxes.near(a, b, room_m)
    }

    /// Returns the nearest point that lies outside all obstacles, if a few steps can find one.
    pub(super) fn outside(&self, point: Point) -> Point {
        self.sidestep.outside(point)
    }

    /// Splits a straight move: wherever it leads through an obstacle, adds stops that are at most `apart_m` apart.
    /// Returns the stops and the end of the move, but not its start.
    pub(super) fn with_stops_inside(&self, from: Point, to: Point, apart_m: f64) -> Vec<Point> {
        let length_m = (to - from).norm();
        let mut shares: Vec<f64> = vec![1.0];
        for (first, last) in self.sidestep.inside(from, to) {
            let steps = ((last - first) * length_m / apart_m).ceil().max(1.0);
            shares.extend((0..=steps as usize).map(|k| first + (last - first) * k as f64 / steps));
        }
        shares.sort_by(f64::total_cmp);
        shares.dedup();
        shares.into_iter().map(|share| from + (to - from) * share).collect()
    }

    /// Adds the bends that take a straight move around every obstacle in its way.
    #[cfg(test)]
    pub(super) fn go_round(&self, from: Point, to: Point, way: &mut Vec<Point>) {
        self.sidestep.along(from, to, |next| way.push(next));
    }

    /// Whether a segment stays on the floor and outside all obstacles.
    pub(super) fn is_open(&self, from: Point, to: Point) -> bool {
        self.sidestep.is_open(from, to) && !self.leads_through_wall(from, to)
    }

    /// Whether a segment crosses a wall with inward corners.
    pub(super) fn leads_through_wall(&self, from: Point, to: Point) -> bool {
        let crosses = |(p, q): &(Point, Point)| {
            let (u, v) = (to - from, q - p);
            let apart = |d: Vector, s: f64, t: f64| s * t < 0.0 && s.abs().min(t.abs()) > 1e-9 * d.norm();
            apart(u, u.perp(&(p - from)), u.perp(&(q - from)))
                && apart(v, v.perp(&(from - p)), v.perp(&(to - p)))
        };
        self.walls.iter().any(crosses)
    }
}

fn posts_of(shape: &Shape, margin_m: f64, of: Bearing) -> Vec<Post> {
    let round = |center: &Point, radius_m: f64| Post {
        center: *center,
        radius_m: radius_m + margin_m,
        of,
        edges: [Vector::zeros(); 2],
    };
    match shape {
        Shape::Disc { center, radius_m } => vec![round(center, *radius_m)],
        Shape::Polygon { vertices } => {
            (0..vertices.len()).map(|k| corner_post(vertices, k, margin_m, of)).collect()
        }
        Shape::Polyline { points, half_width_m } => points.iter().map(|p| round(p, *half_width_m)).collect(),
    }
}

/// Returns the corners at which a wall turns away from the floor.
fn wall_posts(boundary: &Boundary, margin_m: f64) -> Vec<Post> {
    let Boundary::Polygon { vertices } = boundary else { return Vec::new() };
    reflex_corners(vertices).map(|k| corner_post(vertices, k, margin_m, Bearing::Wall)).collect()
}

/// Returns the same corners as solids, grown by a margin. Each solid includes a part of the wall behind the corner. A
/// disc around the corner alone would not show on which side the floor lies, so a cable that bears on the corner might
/// be led into the wall.
fn wall_corners(boundary: &Boundary, margin_m: f64) -> Vec<RoundedPolygon> {
    let Boundary::Polygon { vertices } = boundary else { return Vec::new() };
    let n = vertices.len();
    let solid = |k: usize| {
        let corner = vertices[k];
        let behind = [vertices[(k + n - 1) % n], vertices[(k + 1) % n]].map(|beside| {
            let edge = beside - corner;
            corner + edge * (margin_m / edge.norm()).min(1.0)
        });
        RoundedPolygon::new(vec![corner, behind[0], behind[1]], margin_m)
    };
    reflex_corners(vertices).map(solid).collect()
}

fn corner_post(ring: &[Point], k: usize, radius_m: f64, of: Bearing) -> Post {
    let n = ring.len();
    let edges = [ring[(k + n - 1) % n], ring[(k + 1) % n]]
        .map(|beside| (beside - ring[k]).try_normalize(0.0).unwrap_or_else(Vector::zeros));
    Post { center: ring[k], radius_m, of, edges }
}

fn ray_origin(shape: &Shape) -> Point {
    match shape {
        Shape::Polyline { points, .. } => points[0],
        Shape::Disc { .. } | Shape::Polygon { .. } => shape.center(),
    }
}

/// Returns the posts that do not lie within another post. A post that hides another contains its centre, so few posts
/// have to be compared.
fn without_hidden(posts: &[Post]) -> Vec<Post> {
    let hides = |outer: &Post, inner: &Post, outer_first: bool| {
        let room_m = outer.radius_m - inner.radius_m - (outer.center - inner.center).norm();
        room_m > 0.0 || (room_m == 0.0 && (outer_first || outer.radius_m > inner.radius_m))
    };
    let boxes = Boxes::new(posts.iter().map(Post::bounds));
    let is_hidden = |k: usize| {
        let middle = posts[k].center;
        boxes.near(middle, middle, 0.0).any(|j| j != k && hides(&posts[j], &posts[k], j < k))
    };
    (0..posts.len()).filter(|&k| !is_hidden(k)).map(|k| posts[k]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_post_within_another_is_left_out_once() {
        let disc = |x: f64, radius_m: f64| Shape::Disc { center: Point::new(x, 0.0), radius_m };
        let n_posts =
            |shapes: &[Shape]| CableObstacles::new(&Boundary::Circle { radius_m: 9.0 }, shapes).posts.len();
        assert_eq!(n_posts(&[disc(0.0, 1.0), disc(0.2, 0.5), disc(3.0, 0.5)]), 2);
        assert_eq!(n_posts(&[disc(0.0, 1.0), disc(0.0, 1.0)]), 1);
    }

    #[test]
    fn a_corner_against_another_solid_bears_nothing() {
        let square = |x: f64, y: f64, edge: f64| {
            let corners = [(x, y), (x + edge, y), (x + edge, y + edge), (x, y + edge)];
            Shape::Polygon { vertices: corners.iter().map(|(x, y)| Point::new(*x, *y)).collect() }
        };
        let posts = |shapes: &[Shape]| {
            let wall = Boundary::Polygon {
                vertices: [(-9., -9.), (9., -9.), (9., 9.), (-9., 9.)]
                    .map(|(x, y)| Point::new(x, y))
                    .to_vec(),
            };
            let mut posts: Vec<Point> =
                CableObstacles::new(&wall, shapes).posts.iter().map(|post| post.center).collect();
            posts.sort_by(|a, b| (a.x, a.y).partial_cmp(&(b.x, b.y)).unwrap());
            posts
        };
        let three = [square(0., 0., 2.), square(2., 0.5, 1.), square(0.5, -1., 1.)];
        let corners = [(0., 0.), (0., 2.), (0.5, -1.), (1.5, -1.), (2., 0.), (2., 2.), (3., 0.5), (3., 1.5)];
        assert_eq!(posts(&three), corners.map(|(x, y)| Point::new(x, y)));
        assert_eq!(posts(&[square(-9., 0., 1.)]), [(-8., 0.), (-8., 1.)].map(|(x, y)| Point::new(x, y)));
        assert_eq!(posts(&[square(0., 0., 2.), square(0., 0., 2.)]).len(), 4, "the same square twice");
    }

    #[test]
    fn only_inward_corners_of_a_wall_bear_a_cable() {
        let corners = [(0., 0.), (4., 0.), (4., 4.), (2., 2.), (0., 4.)];
        let vertices = corners.iter().map(|(x, y)| Point::new(*x, *y)).collect();
        let obstacles = CableObstacles::new(&Boundary::Polygon { vertices }, &[]);
        assert_eq!(obstacles.posts.len(), 1);
        assert!((obstacles.posts[0].center - Point::new(2.0, 2.0)).norm() < 1e-12);
    }
}
