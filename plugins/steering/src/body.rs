//! What must not be touched: the obstacles and no-go zones of a site, and what of them is sensed.

use crate::contact::{Contact, Source};
use geometry::{
    Point, Vector,
    convex::{Gap, Part, parts_of},
};
use planner_api::{Outline, Sensed, Site, ZoneKind};

/// Ids of no-go zones are counted down from here, so that they never meet those of obstacles.
const LAST_ID: u32 = u32::MAX;

/// Everything of a site that the robot must not touch, no-go zones included, with ids.
pub fn solids<'a>(site: &Site<'a>) -> impl Iterator<Item = (u32, Outline<'a>)> {
    let obstacles = site.obstacles.iter().map(|o| (o.id, o.outline));
    obstacles.chain(no_go_zones(site))
}

/// The convex parts of everything solid, with the ids of what they are parts of.
pub fn solid_parts(site: &Site<'_>) -> impl Iterator<Item = (u32, Part)> {
    solids(site).flat_map(|(id, outline)| parts_of(&outline).into_iter().map(move |part| (id, part)))
}

/// The no-go zones of a site, with ids of their own.
fn no_go_zones<'a>(site: &Site<'a>) -> impl Iterator<Item = (u32, Outline<'a>)> {
    let zones = site.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo);
    zones.enumerate().map(|(index, zone)| (LAST_ID - index as u32, zone.outline))
}

/// An obstacle in parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Its id.
    pub id: u32,
    /// Its convex parts, at least one.
    pub parts: Vec<Part>,
}

impl Body {
    /// An obstacle in parts; `None` for an outline without extent, such as a line of one point.
    pub fn new(id: u32, outline: &Outline<'_>) -> Option<Self> {
        let parts = parts_of(outline);
        (!parts.is_empty()).then_some(Self { id, parts })
    }

    /// The no-go zones of a site.
    pub fn no_go(site: &Site<'_>) -> Vec<Self> {
        no_go_zones(site).filter_map(|(id, outline)| Self::new(id, &outline)).collect()
    }

    /// What is sensed, and the no-go zones besides.
    pub fn sensed(sensed: &Sensed<'_>, no_go: &[Self]) -> Vec<Self> {
        let near = sensed.obstacles.iter().filter_map(|o| Self::new(o.id, &o.outline));
        near.chain(no_go.iter().cloned()).collect()
    }

    /// A point that stands for the whole: the mean of what its parts are made about.
    pub fn center(&self) -> Point {
        let corners: Vec<Point> = self.parts.iter().flat_map(Part::corners).map(|(at, _)| at).collect();
        let sum: Vector = corners.iter().map(|at| at.coords).sum();
        Point::from(sum / corners.len().max(1) as f64)
    }

    /// Distance from a hull at a place to the outline, metres.
    pub fn hull_distance_m(&self, at: Point, hull_m: f64) -> f64 {
        self.parts.iter().map(|part| part.distance(at).0).fold(f64::INFINITY, f64::min) - hull_m
    }

    /// Every part as a contact of a hull at a place.
    pub fn contacts(&self, at: Point, hull_m: f64) -> impl Iterator<Item = Contact> + '_ {
        self.parts.iter().map(move |part| {
            let (distance_m, away) = part.distance(at);
            Contact { source: Source::Obstacle(self.id), distance_m: distance_m - hull_m, away }
        })
    }

    /// The nearest of its contacts.
    pub fn nearest_contact(&self, at: Point, hull_m: f64) -> Option<Contact> {
        self.contacts(at, hull_m).min_by(|a, b| a.distance_m.total_cmp(&b.distance_m))
    }

    /// Distance from a segment to the outline, metres; not above zero when they touch.
    pub fn segment_distance_m(&self, a: Point, b: Point) -> f64 {
        self.parts.iter().map(|part| part.segment_distance_m(a, b)).fold(f64::INFINITY, f64::min)
    }

    /// The shortest way to another body.
    pub fn gap(&self, other: &Self) -> Option<Gap> {
        let gaps = self.parts.iter().flat_map(|a| other.parts.iter().map(move |b| a.gap(b)));
        gaps.min_by(|a, b| a.width_m.total_cmp(&b.width_m))
    }
}
