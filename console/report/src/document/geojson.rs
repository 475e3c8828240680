//! The report as `GeoJSON`: track, missed areas, obstacles, shell, indications.

use super::Document;
use crate::{drawing::trace::thinned, joined::PastRun};
use serde_json::{Value, json};
use world::{Boundary, Point, Shape};

/// Points of the track nearer to the rest of it than this are left out, metres.
const TRACK_M: f64 = 0.01;

/// One feature collection. With a datum in `[inspection]` its coordinates are those of that system, east and north in metres,
/// and the collection names it; without one they are those of the tank frame.
pub fn geojson(document: &Document, past: &[PastRun]) -> String {
    let facts = &document.inspection;
    let turn = -facts.datum_north_deg.unwrap_or(0.0).to_radians();
    let [east, north] = facts.datum_m.unwrap_or([0.0, 0.0]);
    let at = |p: Point| {
        let (sin, cos) = turn.sin_cos();
        let millimetres = |m: f64| (1000.0 * m).round() / 1000.0;
        json!([millimetres(east + p.x * cos - p.y * sin), millimetres(north + p.x * sin + p.y * cos)])
    };
    let ring = |points: &[Point]| -> Value { points.iter().chain(points.first()).map(|p| at(*p)).collect() };
    let polygon = |points: &[Point]| json!({ "type": "Polygon", "coordinates": [ring(points)] });
    let line = |points: &[Point]| json!({ "type": "LineString", "coordinates": points.iter().map(|p| at(*p)).collect::<Value>() });
    let feature = |geometry: Value, properties: Value| json!({ "type": "Feature", "geometry": geometry, "properties": properties });
    let mut features = Vec::new();
    for past in past {
        let places: Vec<Point> =
            past.record.track.iter().map(super::super::record::TrackPoint::position).collect();
        features
            .push(feature(line(&thinned(&places, TRACK_M)), json!({ "layer": "track", "run": past.name })));
    }
    if let Some(run) = past.last().and_then(|past| past.fold.run.as_ref()) {
        features.push(feature(polygon(&outline(&run.world.boundary)), json!({ "layer": "shell" })));
        let drawn = run.world.obstacles.iter().filter(|obstacle| obstacle.known);
        let drawn = drawn.map(|obstacle| (&obstacle.name, &obstacle.shape, "drawing"));
        let found = past.iter().flat_map(|past| past.fold.found());
        let found = found.map(|solid| (&solid.name, &solid.shape, "found"));
        for (name, shape, source) in drawn.chain(found) {
            let geometry = match shape {
                Shape::Polyline { points, .. } => line(points),
                shape => polygon(&corners(shape)),
            };
            features.push(feature(geometry, json!({ "layer": "obstacles", "name": name, "source": source })));
        }
    }
    for (number, area) in (1..).zip(&document.floor.missed) {
        let number: usize = number;
        let properties = json!({
            "layer": "missed", "number": number, "area_m2": area.area_m2, "plates": area.plates, "reason": area.why(),
        });
        features.push(feature(polygon(&world::shape::rectangle(area.low, area.high)), properties));
    }
    for found in &document.indications {
        let properties = json!({
            "layer": "indications", "number": found.number, "error_95_m": found.error_m, "kind": found.kind,
            "size_mm": found.size_mm, "depth_mm": found.depth_mm, "plate": found.plate, "note": found.note,
        });
        features.push(feature(json!({ "type": "Point", "coordinates": at(found.at) }), properties));
    }
    let name = facts.datum_crs.as_deref().filter(|_| facts.datum_m.is_some()).unwrap_or("tank frame, metres");
    let collection = json!({
        "type": "FeatureCollection",
        "crs": { "type": "name", "properties": { "name": name } },
        "properties": {
            "document": document.number, "revision": document.revision, "scenario": document.scenario,
            "whole_floor": document.floor.whole.percent, "reachable_floor": document.floor.reachable.percent,
        },
        "features": features,
    });
    collection.to_string() + "\n"
}

/// The wall as a ring.
pub(super) fn outline(boundary: &Boundary) -> Vec<Point> {
    match boundary {
        Boundary::Circle { radius_m } => circle(Point::origin(), *radius_m),
        Boundary::Polygon { vertices } => vertices.clone(),
    }
}

/// The outline of a shape.
pub(super) fn corners(shape: &Shape) -> Vec<Point> {
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
