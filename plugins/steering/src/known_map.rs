//! The known map in a flat form, for planners that query it in thousands of small steps.

use crate::{
    body::{Body, solid_parts},
    evade,
    solid::Solid,
};
use geometry::{Boundary, Point, convex::Part, polyline::edges};
use planner_api::Site;

/// Distance moved after which the nearby solids are looked up again, metres.
const SLACK_M: f64 = 1.0;

/// All solids, and the wall.
#[derive(Debug, Clone)]
pub struct KnownMap {
    /// Convex parts of obstacles and no-go zones.
    pub solids: Vec<Solid>,
    /// The wall.
    pub wall: Boundary,
    /// Radius of the robot, metres.
    pub hull_m: f64,
}

impl KnownMap {
    /// Creates the map of a site.
    pub fn new(site: &Site<'_>) -> Self {
        Self {
            solids: solid_parts(site).map(|(id, part)| Solid::new(id, part)).collect(),
            wall: site.boundary.to_owned(),
            hull_m: site.limits.radius_m,
        }
    }

    /// Creates the map of a site without moving obstacles: they will be elsewhere when the robot arrives.
    pub fn standing(site: &Site<'_>) -> Self {
        let movers: Vec<u32> = site.obstacles.iter().filter(|o| evade::moves(o)).map(|o| o.id).collect();
        let mut map = Self::new(site);
        map.forget(&movers);
        map
    }

    /// Removes obstacles from the map. Returns true if any of them were on it.
    pub fn forget(&mut self, ids: &[u32]) -> bool {
        let n_before = self.solids.len();
        self.solids.retain(|solid| !ids.contains(&solid.id));
        self.solids.len() < n_before
    }

    /// Replaces known obstacles with their sensed versions. Returns true if that changed the map.
    pub fn learn(&mut self, bodies: &[Body]) -> bool {
        let mut changed = false;
        for body in bodies {
            let known = self.solids.iter().filter(|s| s.id == body.id).map(|s| &s.part);
            if known.eq(body.parts.iter()) {
                continue;
            }
            changed = true;
            self.solids.retain(|s| s.id != body.id);
            self.solids.extend(body.parts.iter().map(|part| Solid::new(body.id, part.clone())));
        }
        changed
    }

    /// The distance from a hull at a position to the nearest solid, wall included, metres.
    pub fn clearance_m(&self, at: Point) -> f64 {
        let solids = self.solids.iter().map(|s| s.distance(at).0);
        solids.fold(self.wall.wall_distance_m(at), f64::min) - self.hull_m
    }

    /// Whether the hull keeps a margin along a straight path.
    pub fn is_free(&self, a: Point, b: Point, margin_m: f64) -> bool {
        let keep_m = self.hull_m + margin_m;
        self.solids.iter().all(|s| s.segment_distance_m(a, b, keep_m) >= keep_m)
            && self.wall_distance_m(a, b, keep_m) >= keep_m
    }

    /// The smallest distance between the hull and any solid along a path, metres; exact only up to `enough_m`.
    pub fn path_clearance_m(&self, path: &[Point], enough_m: f64) -> f64 {
        let reach_m = enough_m + self.hull_m;
        let mut nearby = Nearby::new(reach_m);
        let mut least_m = path.first().map_or(reach_m, |start| self.clearance_m(*start) + self.hull_m);
        for pair in path.windows(2) {
            let long_m = (pair[1] - pair[0]).norm();
            if long_m > SLACK_M {
                // Solids near the middle of a segment may be out of reach at its start.
                nearby.forget();
                let free = self.solids.iter().map(|s| s.segment_distance_m(pair[0], pair[1], least_m));
                least_m = free.fold(least_m, f64::min);
            }
            for &index in nearby.update(self, pair[0]) {
                let solid = &self.solids[index];
                if !solid.is_beyond(pair[0], least_m + long_m) {
                    least_m = least_m.min(solid.segment_distance_m(pair[0], pair[1], least_m));
                }
            }
            if nearby.sees_wall() || long_m > SLACK_M {
                least_m = least_m.min(self.wall_distance_m(pair[0], pair[1], least_m));
            }
        }
        least_m - self.hull_m
    }

    /// The distance from the wall to a segment, metres; negative outside, and exact only below `enough_m`.
    pub fn wall_distance_m(&self, a: Point, b: Point, enough_m: f64) -> f64 {
        let ends_m = self.wall.wall_distance_m(a).min(self.wall.wall_distance_m(b));
        let Boundary::Polygon { vertices } = &self.wall else { return ends_m };
        // A lower bound for every point in between.
        if ends_m - (b - a).norm() / 2.0 >= enough_m {
            return ends_m;
        }
        edges(vertices).map(|(c, d)| Part::segment(c, d).segment_distance_m(a, b)).fold(ends_m, f64::min)
    }
}

/// The solids near a moving robot.
#[derive(Debug, Clone)]
pub struct Nearby {
    reach_m: f64,
    looked_from: Option<Point>,
    indices: Vec<usize>,
    wall_m: f64,
}

impl Nearby {
    /// Creates a list of the solids whose outlines are within a distance of the robot's centre.
    pub fn new(reach_m: f64) -> Self {
        Self { reach_m, looked_from: None, indices: Vec::new(), wall_m: f64::INFINITY }
    }

    /// Forces a new search on the next update because the map has changed.
    pub fn forget(&mut self) {
        self.looked_from = None;
    }

    /// Updates the list for a new position. Returns the indices of all solids within reach, and possibly of some more.
    pub fn update(&mut self, map: &KnownMap, at: Point) -> &[usize] {
        if self.looked_from.is_none_or(|from| (from - at).norm_squared() > SLACK_M * SLACK_M) {
            self.looked_from = Some(at);
            let near_m = self.reach_m + SLACK_M;
            let is_near = |s: &Solid| !s.is_beyond(at, near_m) && s.distance(at).0 < near_m;
            self.indices.clear();
            self.indices.extend((0..map.solids.len()).filter(|index| is_near(&map.solids[*index])));
            self.wall_m = map.wall.wall_distance_m(at);
        }
        &self.indices
    }

    /// The indices found by the last update.
    pub fn indices(&self) -> &[usize] {
        &self.indices
    }

    /// Whether the wall may be within reach.
    pub fn sees_wall(&self) -> bool {
        self.wall_m < self.reach_m + SLACK_M
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map() -> KnownMap {
        let corners = [(2.0, -1.0), (4.0, -1.0), (4.0, 1.0), (2.0, 1.0)];
        let square = Part::Polygon { vertices: corners.iter().map(|(x, y)| Point::new(*x, *y)).collect() };
        KnownMap {
            solids: vec![Solid::disc(1, Point::new(-3.0, 0.0), 1.0), Solid::new(2, square)],
            wall: Boundary::Circle { radius_m: 10.0 },
            hull_m: 0.5,
        }
    }

    #[test]
    fn clearances_are_those_of_the_hull() {
        let map = map();
        assert!((map.clearance_m(Point::new(-1.0, 0.0)) - 0.5).abs() < 1e-12);
        assert!((map.clearance_m(Point::new(1.0, 0.0)) - 0.5).abs() < 1e-12);
        assert!(map.is_free(Point::new(0.0, -5.0), Point::new(0.0, 5.0), 1.4));
        assert!(!map.is_free(Point::new(0.0, -5.0), Point::new(0.0, 5.0), 1.6));
        assert!(!map.is_free(Point::new(9.6, -1.0), Point::new(9.6, 1.0), 0.0));
    }

    #[test]
    fn what_is_sensed_takes_the_place_of_what_was_known() {
        let mut map = map();
        let moved = Body { id: 1, parts: vec![Solid::disc(1, Point::new(-4.0, 0.0), 1.0).part] };
        assert!(map.learn(std::slice::from_ref(&moved)));
        assert!(!map.learn(&[moved]));
        assert!((map.clearance_m(Point::new(-1.0, 0.0)) - 1.5).abs() < 1e-12);
    }

    #[test]
    fn the_clearance_of_a_path_is_that_of_its_nearest_place_however_long_its_pieces() {
        let map = map();
        let long = [Point::new(0.0, -6.0), Point::new(0.0, 6.0), Point::new(-9.0, 3.0)];
        let fine = geometry::polyline::resampled(&long, 0.01);
        let truth = fine.iter().map(|p| map.clearance_m(*p)).fold(f64::INFINITY, f64::min);
        for path in [&long[..], &fine] {
            assert!((map.path_clearance_m(path, 5.0) - truth).abs() < 1e-3, "{truth}");
        }
        assert!(map.path_clearance_m(&long[..2], 1.0) >= 1.0);
    }

    #[test]
    fn what_is_nearby_is_found_again_on_the_way() {
        let map = map();
        let mut nearby = Nearby::new(0.5);
        assert_eq!(nearby.update(&map, Point::new(-1.6, 0.0)), [0]);
        assert_eq!(nearby.update(&map, Point::new(0.9, 0.0)), [1]);
        assert!(!nearby.sees_wall());
    }
}
