//! What a cable can bear on: every obstacle and every inward corner of the wall, taken apart into round posts.
//!
//! A taut line touches a solid only along its convex outline, and the convex outline of a disc, a polygon or a pipe
//! is that of a few discs: the disc itself, the corners (discs of radius 0), the pipe's ends and bends. A line that
//! comes from a way outside the obstacles never passes between two posts of one solid, so posts alone give the
//! exact taut line. Obstacles that touch or overlap need no treatment of their own: the way never leads between them,
//! so the cable bridges the notch from one to the other and each contact is named for the one that bears it.
//! A post inside another one can bear nothing and is left out.

use super::{cable::Bearing, sidestep::Sidestep, solid::Solid, word::Rays};
use crate::{
    Boundary,
    geometry::{Point, Vector},
    obstacles::Boxes,
    polyline::edges,
    shape::{Shape, ring_area_m2},
};

/// Sine of the angle up to which a line along an edge does not enter the solid.
const ALONG_EDGE: f64 = 1e-6;

/// A disc that a cable can bear on; radius 0 is a corner.
#[derive(Debug, Clone, Copy)]
pub struct Post {
    pub(super) center: Point,
    pub(super) radius_m: f64,
    pub(super) of: Bearing,
    /// Unit vectors along the edges that meet at a corner; zero where there are none.
    edges: [Vector; 2],
}

impl Post {
    /// Whether a line of this direction may bear on the post with the post's solid on its left (`side` 1) or right (-1).
    ///
    /// A round post lies on the side that the line touches it from; for a corner only its edges decide.
    pub(super) fn lies_on(&self, side: f64, line: Vector) -> bool {
        self.radius_m > 0.0 || self.edges.iter().all(|edge| side * line.perp(edge) >= -ALONG_EDGE)
    }
}

/// Obstacles and wall as a cable meets them; made once, shared by cables.
#[derive(Debug, Clone)]
pub struct Ground {
    pub(super) posts: Vec<Post>,
    boxes: Boxes,
    pub(super) sidestep: Sidestep,
    /// A ray from each obstacle, for the crossing word.
    pub(super) rays: Rays,
    /// Edges of a wall with inward corners; other walls are in nobody's way.
    walls: Vec<(Point, Point)>,
}

impl Ground {
    /// The ground within a wall, among obstacles; contacts name obstacles by their index in `shapes`.
    pub fn new(boundary: &Boundary, shapes: &[Shape]) -> Self {
        Self::grown(boundary, shapes, 0.0)
    }

    /// The same with every obstacle and inward corner grown by a margin, metres, as the middle of a robot's hull meets it.
    ///
    /// The rest of the wall is not grown: no taut line bears on it.
    pub fn grown(boundary: &Boundary, shapes: &[Shape], margin_m: f64) -> Self {
        let mut posts: Vec<Post> = shapes
            .iter()
            .enumerate()
            .flat_map(|(index, shape)| posts_of(shape, margin_m, Bearing::Obstacle(index)))
            .collect();
        let corners = wall_posts(boundary, margin_m);
        let mut solids: Vec<Solid> = shapes.iter().flat_map(|shape| solids_of(shape, margin_m)).collect();
        if margin_m > 0.0 {
            solids.extend(corners.iter().map(|corner| Solid::new(vec![corner.center], margin_m)));
        }
        posts.extend(corners);
        let posts = without_hidden(&posts);
        let around = |post: &Post| {
            let far = Vector::new(post.radius_m, post.radius_m);
            (post.center - far, post.center + far)
        };
        Self {
            boxes: Boxes::new(posts.iter().map(around)),
            posts,
            sidestep: Sidestep::new(solids, margin_m > 0.0),
            rays: Rays::new(&shapes.iter().map(heart_of).collect::<Vec<_>>()),
            walls: walls_in_the_way(boundary),
        }
    }

    /// Posts that come within `room_m` of a segment, perhaps some more, in no order.
    pub(super) fn near(&self, a: Point, b: Point, room_m: f64) -> impl Iterator<Item = usize> + '_ {
        self.boxes.near(a, b, room_m)
    }

    /// The nearest place that lies in no obstacle, as far as a few steps find one.
    pub(super) fn outside(&self, point: Point) -> Point {
        self.sidestep.outside(point)
    }

    /// A straight move, with stops wherever it leads through an obstacle: its end last, its beginning left out.
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

    /// The bends of a straight move that goes round every obstacle in its way.
    #[cfg(test)]
    pub(super) fn go_round(&self, from: Point, to: Point, way: &mut Vec<Point>) {
        self.sidestep.along(from, to, |next| way.push(next));
    }

    /// Whether a straight line enters no obstacle and does not leave the floor.
    pub fn is_open(&self, from: Point, to: Point) -> bool {
        let crosses = |(p, q): &(Point, Point)| {
            let (u, v) = (to - from, q - p);
            let apart = |d: Vector, s: f64, t: f64| s * t < 0.0 && s.abs().min(t.abs()) > 1e-9 * d.norm();
            apart(u, u.perp(&(p - from)), u.perp(&(q - from)))
                && apart(v, v.perp(&(from - p)), v.perp(&(to - p)))
        };
        self.sidestep.is_open(from, to) && !self.walls.iter().any(crosses)
    }
}

fn posts_of(shape: &Shape, margin_m: f64, of: Bearing) -> Vec<Post> {
    let post = |center: &Point, radius_m: f64| Post {
        center: *center,
        radius_m: radius_m + margin_m,
        of,
        edges: [Vector::zeros(); 2],
    };
    match shape {
        Shape::Disc { center, radius_m } => vec![post(center, *radius_m)],
        Shape::Polygon { vertices } => (0..vertices.len())
            .map(|k| Post { edges: edges_at(vertices, k), ..post(&vertices[k], 0.0) })
            .collect(),
        Shape::Polyline { points, half_width_m } => points.iter().map(|p| post(p, *half_width_m)).collect(),
    }
}

/// Unit vectors from a corner of a ring to the corners beside it.
fn edges_at(ring: &[Point], k: usize) -> [Vector; 2] {
    let n = ring.len();
    [ring[(k + n - 1) % n], ring[(k + 1) % n]]
        .map(|beside| (beside - ring[k]).try_normalize(0.0).unwrap_or_else(Vector::zeros))
}

/// The convex solids that make an obstacle.
pub(super) fn solids_of(shape: &Shape, margin_m: f64) -> Vec<Solid> {
    match shape {
        Shape::Disc { center, radius_m } => vec![Solid::new(vec![*center], radius_m + margin_m)],
        Shape::Polygon { vertices } => vec![Solid::new(vertices.clone(), margin_m)],
        Shape::Polyline { points, half_width_m } => {
            points.windows(2).map(|w| Solid::new(w.to_vec(), half_width_m + margin_m)).collect()
        }
    }
}

fn heart_of(shape: &Shape) -> Point {
    match shape {
        Shape::Polyline { points, .. } => points[0],
        Shape::Disc { .. } | Shape::Polygon { .. } => shape.center(),
    }
}

/// The corners at which a wall turns away from the floor.
fn wall_posts(boundary: &Boundary, margin_m: f64) -> Vec<Post> {
    let Boundary::Polygon { vertices } = boundary else { return Vec::new() };
    let n = vertices.len();
    let turning = ring_area_m2(vertices).signum();
    (0..n)
        .filter(|&k| {
            let (before, here, after) = (vertices[(k + n - 1) % n], vertices[k], vertices[(k + 1) % n]);
            turning * (here - before).perp(&(after - here)) < 0.0
        })
        .map(|k| Post {
            center: vertices[k],
            radius_m: margin_m,
            of: Bearing::Wall,
            edges: edges_at(vertices, k),
        })
        .collect()
}

fn walls_in_the_way(boundary: &Boundary) -> Vec<(Point, Point)> {
    match boundary {
        Boundary::Polygon { vertices } if !wall_posts(boundary, 0.0).is_empty() => edges(vertices).collect(),
        Boundary::Polygon { .. } | Boundary::Circle { .. } => Vec::new(),
    }
}

fn without_hidden(posts: &[Post]) -> Vec<Post> {
    let hides = |outer: &Post, inner: &Post, outer_first: bool| {
        let room_m = outer.radius_m - inner.radius_m - (outer.center - inner.center).norm();
        room_m > 0.0 || (room_m == 0.0 && (outer_first || outer.radius_m > inner.radius_m))
    };
    let is_hidden = |k: usize| (0..posts.len()).any(|j| j != k && hides(&posts[j], &posts[k], j < k));
    (0..posts.len()).filter(|&k| !is_hidden(k)).map(|k| posts[k]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_post_within_another_is_left_out_once() {
        let disc = |x: f64, radius_m: f64| Shape::Disc { center: Point::new(x, 0.0), radius_m };
        let wall = Boundary::Circle { radius_m: 9.0 };
        assert_eq!(Ground::new(&wall, &[disc(0.0, 1.0), disc(0.2, 0.5), disc(3.0, 0.5)]).posts.len(), 2);
        assert_eq!(Ground::new(&wall, &[disc(0.0, 1.0), disc(0.0, 1.0)]).posts.len(), 1);
    }

    #[test]
    fn only_inward_corners_of_a_wall_bear_a_cable() {
        let corners = [(0., 0.), (4., 0.), (4., 4.), (2., 2.), (0., 4.)];
        let vertices = corners.iter().map(|(x, y)| Point::new(*x, *y)).collect();
        let ground = Ground::new(&Boundary::Polygon { vertices }, &[]);
        assert_eq!(ground.posts.len(), 1);
        assert!((ground.posts[0].center - Point::new(2.0, 2.0)).norm() < 1e-12);
    }
}
