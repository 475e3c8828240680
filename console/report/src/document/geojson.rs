//! The report as `GeoJSON`: track, missed areas, obstacles, shell, indications.

use super::{Document, located};
use crate::{
    account::Solid,
    drawing::trace::thinned,
    geojson::{Datum, corners, feature, outline},
    joined::{PastRun, found_name},
};
use serde_json::json;
use world::{Point, Shape};

/// Points of the track nearer to the rest of it than this are left out, metres.
const TRACK_M: f64 = 0.01;

/// One feature collection. With a datum in `[inspection]` its coordinates are those of that system, east and north in metres,
/// and the collection names it; without one they are those of the tank frame.
pub fn geojson(document: &Document, past: &[PastRun]) -> String {
    let facts = &document.inspection;
    let datum = Datum::of(facts);
    let at = |p: Point| datum.at(p);
    let polygon = |points: &[Point]| datum.polygon(points);
    let line = |points: &[Point]| datum.line(points);
    let mut features = Vec::new();
    for past in past {
        let places: Vec<Point> =
            past.record.track.iter().map(super::super::record::TrackPoint::position).collect();
        features
            .push(feature(line(&thinned(&places, TRACK_M)), json!({ "layer": "track", "run": past.name })));
    }
    if document.located.is_some() {
        features.extend(located::positions(past).map(|(place, properties)| {
            feature(json!({ "type": "Point", "coordinates": at(place) }), properties)
        }));
    }
    if let Some(run) = past.last().and_then(|past| past.fold.run.as_ref()) {
        features.push(feature(polygon(&outline(&run.world.boundary)), json!({ "layer": "shell" })));
        let drawn = run.world.obstacles.iter().filter(|obstacle| obstacle.known);
        let drawn = drawn.map(|obstacle| (obstacle.name.clone(), obstacle.shape.clone(), "drawing"));
        let of_run = |(index, run): (usize, &'_ PastRun)| -> Vec<_> {
            let name = |solid: &Solid| found_name(&solid.name, index, past.len());
            run.fold.found().map(|solid| (name(solid), solid.shape.clone(), "found")).collect()
        };
        let found = past.iter().enumerate().flat_map(of_run);
        for (name, shape, source) in drawn.chain(found) {
            let geometry = match &shape {
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
            "layer": "indications", "number": found.number, "run": found.run, "t_s": found.t_s, "error_95_m": found.error_m, "kind": found.kind,
            "size_mm": found.size_mm, "depth_mm": found.depth_mm, "plate": found.plate, "note": found.note,
        });
        features.push(feature(json!({ "type": "Point", "coordinates": at(found.at) }), properties));
    }
    // Of readings nothing is reachable or missed, and unknown is not zero.
    let [whole_floor, reachable_floor] = match &document.located {
        None => [json!(document.floor.whole.percent), json!(document.floor.reachable.percent)],
        Some(located) => {
            let percent = document.floor.whole.percent;
            let passed = json!({ "scanned": percent.scanned, "guaranteed": percent.guaranteed });
            [if located.tool_on_s.is_some() { passed } else { json!(null) }, json!(null)]
        }
    };
    let collection = json!({
        "type": "FeatureCollection",
        "crs": { "type": "name", "properties": { "name": datum.name } },
        "properties": {
            "document": document.number, "revision": document.revision, "scenario": document.scenario,
            "whole_floor": whole_floor, "reachable_floor": reachable_floor, "located_from": document.located,
        },
        "features": features,
    });
    collection.to_string() + "\n"
}
