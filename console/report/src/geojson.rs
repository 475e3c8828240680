//! Places and shapes as `GeoJSON`.

use crate::document::Inspection;
use serde_json::{Value, json};
use world::{Boundary, Point, Shape};

/// Where the tank frame lies in a system of coordinates; without a datum it is its own.
pub(crate) struct Datum<'a> {
    east_m: f64,
    north_m: f64,
    turn_rad: f64,
    /// What the system is called.
    pub name: &'a str,
}

impl<'a> Datum<'a> {
    /// The datum that an inspection states.
    pub(crate) fn of(facts: &'a Inspection) -> Self {
        let [east_m, north_m] = facts.datum_m.unwrap_or([0.0, 0.0]);
        let name = match (&facts.datum_crs, facts.datum_m) {
            (Some(name), Some(_)) => name,
            (None, Some(_)) => "system not named (inspection.datum_crs), metres",
            (_, None) => "tank frame, metres",
        };
        Self { east_m, north_m, turn_rad: -facts.datum_north_deg.unwrap_or(0.0).to_radians(), name }
    }

    /// A place.
    pub(crate) fn at(&self, p: Point) -> Value {
        let (sin, cos) = self.turn_rad.sin_cos();
        let millimetres = |m: f64| (1000.0 * m).round() / 1000.0;
        json!([
            millimetres(self.east_m + p.x * cos - p.y * sin),
            millimetres(self.north_m + p.x * sin + p.y * cos)
        ])
    }

    /// A polygon; its ring is closed here.
    pub(crate) fn polygon(&self, points: &[Point]) -> Value {
        let ring: Value = points.iter().chain(points.first()).map(|p| self.at(*p)).collect();
        json!({ "type": "Polygon", "coordinates": [ring] })
    }

    /// A line.
    pub(crate) fn line(&self, points: &[Point]) -> Value {
        let places: Value = points.iter().map(|p| self.at(*p)).collect();
        json!({ "type": "LineString", "coordinates": places })
    }
}

/// A feature.
pub(crate) fn feature(geometry: Value, properties: Value) -> Value {
    let members = [("type", "Feature".into()), ("geometry", geometry), ("properties", properties)];
    Value::Object(members.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
}

/// The wall as a ring.
pub(crate) fn outline(boundary: &Boundary) -> Vec<Point> {
    match boundary {
        Boundary::Circle { radius_m } => circle(Point::origin(), *radius_m),
        Boundary::Polygon { vertices } => vertices.clone(),
    }
}

/// The outline of a shape.
pub(crate) fn corners(shape: &Shape) -> Vec<Point> {
    match shape {
        Shape::Disc { center, radius_m } => circle(*center, *radius_m),
        Shape::Polygon { vertices } => vertices.clone(),
        Shape::Polyline { points, .. } => points.clone(),
    }
}

fn circle(center: Point, radius_m: f64) -> Vec<Point> {
    let at = |k: u32| center + world::geometry::unit_vector(f64::from(k).to_radians() * 5.0) * radius_m;
    (0..72).map(at).collect()
}
