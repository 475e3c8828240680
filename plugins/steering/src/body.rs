//! The bodies that the robot must not touch: the obstacles and no-go zones of a site, and those currently sensed.

use crate::contact::{Contact, Source};
use geometry::{
    Point, Vector,
    convex::{Gap, Part, parts_of},
};
use planner_api::{Outline, Sensed, Site, ZoneKind};

/// Ids of no-go zones count down from here, so that they never collide with ids of obstacles.
const LAST_ID: u32 = u32::MAX;

/// All outlines of a site that the robot must not touch, no-go zones included, with their ids.
pub fn solids<'a>(site: &Site<'a>) -> impl Iterator<Item = (u32, Outline<'a>)> {
    let obstacles = site.obstacles.iter().map(|o| (o.id, o.outline));
    obstacles.chain(no_go_zones(site))
}

/// The convex parts of all solids, each with the id of the solid that it belongs to.
pub fn solid_parts(site: &Site<'_>) -> impl Iterator<Item = (u32, Part)> {
    solids(site).flat_map(|(id, outline)| parts_of(&outline).into_iter().map(move |part| (id, part)))
}

/// The no-go zones of a site, with ids of their own.
fn no_go_zones<'a>(site: &Site<'a>) -> impl Iterator<Item = (u32, Outline<'a>)> {
    let zones = site.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo);
    zones.enumerate().map(|(index, zone)| (LAST_ID - index as u32, zone.outline))
}

/// An obstacle, divided into convex parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// The id of the obstacle.
    pub id: u32,
    /// The convex parts; at least one.
    pub parts: Vec<Part>,
}

impl Body {
    /// Divides an obstacle into parts. Returns `None` for an outline without extent, such as a polyline of one point.
    pub fn new(id: u32, outline: &Outline<'_>) -> Option<Self> {
        let parts = parts_of(outline);
        (!parts.is_empty()).then_some(Self { id, parts })
    }

    /// The no-go zones of a site as bodies.
    pub fn no_go(site: &Site<'_>) -> Vec<Self> {
        no_go_zones(site).filter_map(|(id, outline)| Self::new(id, &outline)).collect()
    }

    /// The sensed obstacles and the no-go zones.
    pub fn sensed(sensed: &Sensed<'_>, no_go: &[Self]) -> Vec<Self> {
        let near = sensed.obstacles.iter().filter_map(|o| Self::new(o.id, &o.outline));
        near.chain(no_go.iter().cloned()).collect()
    }

    /// A point that represents the whole body: the mean of the centres of its parts.
    pub fn center(&self) -> Point {
        let corners: Vec<Point> = self.parts.iter().flat_map(Part::corners).map(|(at, _)| at).collect();
        let sum: Vector = corners.iter().map(|at| at.coords).sum();
        Point::from(sum / corners.len().max(1) as f64)
    }

    /// The distance from a hull at a position to the outline, metres.
    pub fn hull_distance_m(&self, at: Point, hull_m: f64) -> f64 {
        self.parts.iter().map(|part| part.distance(at).0).fold(f64::INFINITY, f64::min) - hull_m
    }

    /// Every part as a contact of a hull at a position.
    pub fn contacts(&self, at: Point, hull_m: f64) -> impl Iterator<Item = Contact> + '_ {
        self.parts.iter().map(move |part| {
            let (distance_m, away) = part.distance(at);
            Contact { source: Source::Obstacle(self.id), distance_m: distance_m - hull_m, away }
        })
    }

    /// The nearest contact of the body.
    pub fn nearest_contact(&self, at: Point, hull_m: f64) -> Option<Contact> {
        self.contacts(at, hull_m).min_by(|a, b| a.distance_m.total_cmp(&b.distance_m))
    }

    /// The distance from a segment to the outline, metres; zero or negative when they touch.
    pub fn segment_distance_m(&self, a: Point, b: Point) -> f64 {
        self.parts.iter().map(|part| part.segment_distance_m(a, b)).fold(f64::INFINITY, f64::min)
    }

    /// The shortest gap to another body.
    pub fn gap(&self, other: &Self) -> Option<Gap> {
        let gaps = self.parts.iter().flat_map(|a| other.parts.iter().map(move |b| a.gap(b)));
        gaps.min_by(|a, b| a.width_m.total_cmp(&b.width_m))
    }
}
