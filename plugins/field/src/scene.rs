//! The known map for evaluating a law: contacts near a position, found through the world's bounding volume hierarchy.

use crate::law::Law;
use geometry::{Boundary, Point, convex::away_from};
use planner_api::Site;
use steering::{Body, Contact, Source, solids, wall_contacts};
use world::{Obstacle, ObstacleId, ObstacleMap};

/// Obstacles, no-go zones and wall of a site, ready for queries.
#[derive(Clone)]
pub struct Scene {
    map: ObstacleMap,
    wall: Boundary,
    centers: Vec<Point>,
    bodies: Vec<Option<Body>>,
    hull_m: f64,
}

impl Scene {
    /// Creates the map of a site; costs `n log n` once.
    pub fn new(site: &Site<'_>) -> Self {
        let wall = site.boundary.to_owned();
        let obstacles: Vec<Obstacle> = solids(site)
            .map(|(id, outline)| Obstacle {
                id: ObstacleId(id),
                name: String::new(),
                shape: outline.to_owned(),
                known: true,
            })
            .collect();
        let centers = obstacles.iter().map(|o| o.shape.center()).collect();
        let bodies = solids(site).map(|(id, outline)| Body::new(id, &outline)).collect();
        let map = ObstacleMap::new(&wall, &obstacles);
        Self { map, wall, centers, bodies, hull_m: site.limits.radius_m }
    }

    /// The obstacles within a range of a position, as if the robot sensed them from there.
    pub fn bodies_within(&self, at: Point, range_m: f64) -> Vec<Body> {
        let near = self.map.within(at, range_m);
        near.iter().filter_map(|n| self.bodies[n.index].clone()).collect()
    }

    /// The contacts that act on a robot at a position according to this law. The cost depends on the number of nearby
    /// obstacles and hardly on the total number.
    pub fn contacts(&self, at: Point, law: &Law) -> Vec<Contact> {
        let near = self.map.within(at, law.rho_0_m + self.hull_m);
        let mut contacts: Vec<Contact> = near
            .iter()
            .map(|n| Contact {
                source: Source::Obstacle(n.id.0),
                distance_m: n.distance_m - self.hull_m,
                away: away_from(at, n.distance_m, n.closest, self.centers[n.index]),
            })
            .collect();
        if law.wall_gain > 0.0 {
            contacts.extend(wall_contacts(&self.wall, at, self.hull_m, law.reach_m(Source::Wall)));
        }
        contacts
    }

    /// The distance from a hull at a position to the nearest obstacle, metres.
    pub fn hull_clearance_m(&self, at: Point) -> f64 {
        self.map.obstacle_distance_m(at) - self.hull_m
    }

    /// The distance from a hull at a position to the wall, metres.
    pub fn wall_clearance_m(&self, at: Point) -> f64 {
        self.wall.wall_distance_m(at) - self.hull_m
    }

    /// The smallest distance between the hull and any solid along a path, metres.
    pub fn path_clearance_m(&self, path: &[Point]) -> f64 {
        let along = path.windows(2).map(|w| self.map.segment_clearance_m(w[0], w[1]));
        let at_start = path.first().map(|p| self.map.clearance_m(*p));
        along.chain(at_start).fold(f64::INFINITY, f64::min) - self.hull_m
    }
}
