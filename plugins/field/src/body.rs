//! A sensed obstacle as the pilot sees it.

use crate::contact::{Contact, Source};
use geometry::convex::{Gap, Part, parts_of};
use planner_api::Outline;
use world::Point;

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

    /// A point that stands for the whole: the mean of what its parts are made about.
    pub fn center(&self) -> Point {
        let corners: Vec<Point> = self.parts.iter().flat_map(Part::corners).map(|(at, _)| at).collect();
        let sum: world::Vector = corners.iter().map(|at| at.coords).sum();
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
