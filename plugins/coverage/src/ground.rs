//! The floor as a coverage planner sees it: wall, solid parts, and where the middle of the hull may be.

use crate::slit::Bare;
use geometry::convex::{Part, parts_of};
use planner_api::{Code, PlannerError, Result, Site};
use std::{f64::consts::TAU, sync::OnceLock};
use steering::{Keep, Room, solids};
use world::{Boundary, Point, Vector};

/// Slack between what is planned and what the mission demands, metres.
pub const SLACK_M: f64 = 2e-3;
/// Largest angle between neighbouring tangents of an outline, radians.
const FACET_RAD: f64 = TAU / 18.0;
/// How far a facet of the wall may lie from the circle, metres.
const WALL_SAGITTA_M: f64 = 2e-3;

/// Wall and obstacles of a site with the distances to keep.
#[derive(Debug, Clone)]
pub struct Ground {
    /// The wall.
    pub wall: Boundary,
    /// Convex parts of everything solid, no-go zones included.
    pub parts: Vec<Part>,
    /// Distance between the middle of the hull and anything solid, metres.
    pub keep_m: f64,
    /// Width of the floor scanned in one pass, metres.
    pub swath_m: f64,
    /// Where the tether comes in and the robot starts and ends.
    pub anchor: Point,
    /// Exact distances.
    pub room: Room,
    /// Its triangles, once they were asked for.
    pub bare: OnceLock<Bare>,
}

impl Ground {
    /// The ground of a site for a robot on a tether from `anchor`.
    ///
    /// # Errors
    /// An anchor outside the floor or without room for the hull, and a swath of no width.
    pub fn new(site: &Site<'_>, anchor: Point) -> Result<Self> {
        let keep_m = site.limits.radius_m + site.clearance_m;
        let wrong = |code, message: String| Err(PlannerError::new(code, message));
        if !(site.swath_m.is_finite() && site.swath_m > 0.0) {
            return wrong(Code::Config, format!("the swath is {} m wide; it must be above 0", site.swath_m));
        }
        if !(keep_m.is_finite() && keep_m >= 0.0) {
            return wrong(Code::Config, format!("hull and clearance of {keep_m} m make no sense"));
        }
        if !(anchor.x.is_finite() && anchor.y.is_finite()) {
            return wrong(Code::Invalid, "the anchor is not a number".to_owned());
        }
        let wall = site.boundary.to_owned();
        let parts: Vec<Part> = solids(site).flat_map(|(_, outline)| parts_of(&outline)).collect();
        if wall.wall_distance_m(anchor) < 0.0 {
            let place = format!("the anchor ({:.2}, {:.2}) lies outside the floor", anchor.x, anchor.y);
            return wrong(Code::StartOutside, format!("{place}; set it at a hatch or manhole of this tank"));
        }
        if let Some(part) = parts.iter().find(|part| part.distance(anchor).0 < 0.0) {
            let at = middle(part);
            return wrong(
                Code::StartOccupied,
                format!(
                    "the anchor ({:.2}, {:.2}) lies inside the obstacle at ({:.2}, {:.2}); set it on free floor",
                    anchor.x, anchor.y, at.x, at.y
                ),
            );
        }
        let room = Room::new(site, Keep { obstacle_m: keep_m, wall_m: keep_m });
        let bare = OnceLock::new();
        Ok(Self { wall, parts, keep_m, swath_m: site.swath_m, anchor, room, bare })
    }

    /// Outline of the floor that the middle of the hull may use, obstacles left out: rings of points.
    ///
    /// A round wall gives one ring within the circle; straight walls give a ring around every edge.
    pub fn wall_rings(&self) -> Vec<Vec<Point>> {
        match &self.wall {
            Boundary::Circle { radius_m } => {
                let outer_m = (radius_m - self.keep_m).max(1e-6);
                let n = (std::f64::consts::PI / (2.0 * WALL_SAGITTA_M / outer_m).sqrt()).ceil().max(24.0);
                let at = |k: usize| Point::origin() + direction(TAU * k as f64 / n) * outer_m;
                vec![(0..n as usize).map(at).collect()]
            }
            Boundary::Polygon { vertices } => {
                let edges = vertices.iter().zip(vertices.iter().cycle().skip(1));
                edges.map(|(a, b)| around(&[*a, *b], self.keep_m + SLACK_M / 2.0)).collect()
            }
        }
    }

    /// Convex outline of a part with the distance to keep, drawn around the exact one.
    pub fn inflated(&self, part: &Part) -> Vec<Point> {
        let corners = part.corners();
        let radius_m = corners.first().map_or(0.0, |c| c.1) + self.keep_m + SLACK_M / 2.0;
        let mut points: Vec<Point> = corners.iter().map(|c| c.0).collect();
        points.dedup();
        around(&points, radius_m)
    }

    /// Whether the middle of the hull may be at a place, as far as wall and obstacles go.
    pub fn is_free(&self, at: Point) -> bool {
        self.room.spare_m(at) >= 0.0
    }

    /// Whether a place is floor: inside the wall and outside everything solid.
    pub fn is_floor(&self, at: Point) -> bool {
        self.wall.wall_distance_m(at) >= 0.0
            && self.room.parts_near(at).all(|(part, _)| part.distance(at).0 >= 0.0)
    }

    /// Where the anchor lets the robot be: the anchor itself, or the nearest place with room beside it.
    pub fn home(&self) -> Point {
        if self.room.spare_m(self.anchor) >= SLACK_M {
            return self.anchor;
        }
        let rings = (1..=80).map(|k| f64::from(k) * 0.025);
        let around = rings.flat_map(|r| (0..72).map(move |k| direction(TAU * f64::from(k) / 72.0) * r));
        let free = around.map(|offset| self.anchor + offset).find(|p| self.room.spare_m(*p) >= SLACK_M);
        free.unwrap_or(self.anchor)
    }
}

/// A point that stands for a part.
pub fn middle(part: &Part) -> Point {
    let corners = part.corners();
    let sum: Vector = corners.iter().map(|c| c.0.coords).sum();
    Point::from(sum / corners.len().max(1) as f64)
}

/// Unit vector of an angle, radians.
pub fn direction(angle_rad: f64) -> Vector {
    Vector::new(angle_rad.cos(), angle_rad.sin())
}

/// Polygon around everything within `radius_m` of a convex polygon, a segment or a point; it never cuts in.
fn around(corners: &[Point], radius_m: f64) -> Vec<Point> {
    let n = corners.len();
    if n == 1 {
        return arc(corners[0], 0.0, TAU, radius_m);
    }
    let normal = |k: usize| {
        let along = corners[(k + 1) % n] - corners[k % n];
        (-along.x).atan2(along.y)
    };
    let mut ring = Vec::new();
    for (k, corner) in corners.iter().enumerate() {
        let before = normal(k + n - 1);
        let turn = (normal(k) - before).rem_euclid(TAU);
        ring.extend(arc(*corner, before, turn, radius_m));
    }
    ring
}

/// Corners of the polygon whose sides touch an arc: tangents from its first to its last normal.
fn arc(center: Point, from_rad: f64, turn_rad: f64, radius_m: f64) -> Vec<Point> {
    let n = (turn_rad / FACET_RAD).ceil().max(1.0);
    let step = turn_rad / n;
    let reach_m = radius_m / (step / 2.0).cos();
    (0..n as usize).map(|k| center + direction(from_rad + (k as f64 + 0.5) * step) * reach_m).collect()
}
