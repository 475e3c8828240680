//! The known map as the planners see it: contacts near a place, found through the world's bounding volume hierarchy.

use crate::{
    body::Body,
    contact::{Contact, Source},
    law::Law,
};
use geometry::{Point, Vector, convex::away_from, direction_or, polyline::nearest_on_segment};
use planner_api::{Outline, Site, ZoneKind};
use world::{ObstacleId, ObstacleMap};

/// Ids of no-go zones are counted down from here, so that they never meet those of obstacles.
const LAST_ID: u32 = u32::MAX;

/// Obstacles, no-go zones and wall of a site, ready for queries.
#[derive(Clone)]
pub struct Scene {
    map: ObstacleMap,
    wall: world::Boundary,
    centers: Vec<Point>,
    bodies: Vec<Option<Body>>,
    hull_m: f64,
}

/// Everything of a site that the robot must not touch, no-go zones included, with ids.
pub fn solids<'a>(site: &Site<'a>) -> impl Iterator<Item = (u32, Outline<'a>)> {
    let obstacles = site.obstacles.iter().map(|o| (o.id, o.outline));
    obstacles.chain(no_go(site))
}

/// The no-go zones of a site, with ids of their own.
pub fn no_go<'a>(site: &Site<'a>) -> impl Iterator<Item = (u32, Outline<'a>)> {
    let zones = site.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo);
    zones.enumerate().map(|(index, zone)| (LAST_ID - index as u32, zone.outline))
}

impl Scene {
    /// The map of a site; costs `n log n` once.
    pub fn new(site: &Site<'_>) -> Self {
        let wall = site.boundary.to_owned();
        let obstacles: Vec<world::Obstacle> = solids(site)
            .map(|(id, outline)| world::Obstacle {
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

    /// The obstacles within a range of a place, as if the robot sensed them from there.
    pub fn bodies_within(&self, at: Point, range_m: f64) -> Vec<Body> {
        let near = self.map.within(at, range_m);
        near.iter().filter_map(|n| self.bodies[n.index].clone()).collect()
    }

    /// What acts on a robot at a place by this law; cost grows with what is near, hardly with what there is.
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

    /// Distance from a hull at a place to the nearest obstacle, metres.
    pub fn hull_clearance_m(&self, at: Point) -> f64 {
        self.map.obstacle_distance_m(at) - self.hull_m
    }

    /// Distance from a hull at a place to the wall, metres.
    pub fn wall_clearance_m(&self, at: Point) -> f64 {
        self.wall.wall_distance_m(at) - self.hull_m
    }

    /// The least distance between hull and anything solid along a path, metres.
    pub fn path_clearance_m(&self, path: &[Point]) -> f64 {
        let along = path.windows(2).map(|w| self.map.segment_clearance_m(w[0], w[1]));
        let at_start = path.first().map(|p| self.map.clearance_m(*p));
        along.chain(at_start).fold(f64::INFINITY, f64::min) - self.hull_m
    }
}

/// The wall as contacts of a hull: one for a round wall, one for every piece in reach of a straight one.
pub fn wall_contacts(wall: &world::Boundary, at: Point, hull_m: f64, reach_m: f64) -> Vec<Contact> {
    let contact = |distance_m: f64, away: Vector| Contact { source: Source::Wall, distance_m, away };
    let all = match wall {
        world::Boundary::Circle { radius_m } => {
            let inward = direction_or(-at.coords, Vector::x());
            vec![contact(radius_m - at.coords.norm() - hull_m, inward)]
        }
        world::Boundary::Polygon { vertices } => {
            let ends = vertices.iter().zip(vertices.iter().cycle().skip(1));
            ends.map(|(a, b)| {
                let closest = nearest_on_segment(*a, *b, at);
                let inward = Vector::new(a.y - b.y, b.x - a.x);
                contact(
                    (at - closest).norm() - hull_m,
                    direction_or(at - closest, direction_or(inward, Vector::x())),
                )
            })
            .collect()
        }
    };
    all.into_iter().filter(|c: &Contact| c.distance_m < reach_m).collect()
}
