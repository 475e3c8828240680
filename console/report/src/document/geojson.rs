//! The report as `GeoJSON`: track, missed areas, plates, obstacles, zones, stations, shell, indications,
//! and places that need a test with another method.

use super::{
    follow_up::FollowUp, indications::Indication, located, model::Document, shapes::zones, survey::on_map,
};
use crate::{
    drawing::trace::thinned,
    geojson::{Datum, feature, outline, rounded},
    joined::found_name,
    past_run::PastRun,
};
use account::Solid;
use mission::RunOpened;
use serde_json::{Value, json};
use world::{Point, ZoneKind};

/// Simplification tolerance of the track, metres.
const TRACK_M: f64 = 0.01;

/// The report as one feature collection. With a datum in `[inspection]`, coordinates are metres east and north in the
/// system of the datum, and the collection names that system. Without a datum, coordinates are in the tank frame,
/// which is declared as a local system so that no program reads them as degrees.
pub fn geojson(document: &Document, past: &[PastRun]) -> String {
    let datum = Datum::of(&document.inspection);
    let mut features = tracks(&datum, past);
    if let Some(run) = past.last().and_then(|past| past.fold.run()) {
        features.extend(tank(&datum, run, past));
    }
    if document.located.is_some() {
        features.extend(located::positions(past).map(|(place, properties)| {
            feature(json!({ "type": "Point", "coordinates": datum.at(place) }), properties)
        }));
    }
    features.extend(plates(&datum, document));
    features.extend(missed(&datum, document));
    features.extend(indications(&datum, document));
    features.extend(follow_ups(&datum, document));
    let mut properties = json!({
        "document": document.number, "revision": document.revision, "scenario": document.scenario,
        "coordinates": datum.words(),
    });
    // Readings define no reachable or missed floor, and unknown is not zero.
    if let Some(located) = &document.located {
        let percent = document.floor.whole.percent;
        let passed = json!({ "scanned": percent.scanned, "guaranteed": percent.guaranteed });
        properties["whole_floor"] = if located.tool_on_s.is_some() { passed } else { json!(null) };
        properties["reachable_floor"] = json!(null);
        properties["located_from"] = json!(located);
    } else if document.is_to_scan {
        properties["whole_floor"] = json!(document.floor.whole.percent);
        properties["reachable_floor"] = json!(document.floor.reachable.percent);
    }
    if let Some(task) = &document.task {
        properties["task"] = task
            .figures(document.runs.last())
            .into_iter()
            .map(|(name, m)| (name.to_owned(), json!(rounded(m))))
            .collect();
    }
    let collection = json!({
        "type": "FeatureCollection",
        "crs": datum.crs(),
        "properties": properties,
        "features": features,
    });
    collection.to_string() + "\n"
}

fn tracks(datum: &Datum<'_>, past: &[PastRun]) -> Vec<Value> {
    let track = |past: &PastRun| {
        let places: Vec<Point> = past.record.track.iter().map(crate::record::TrackPoint::position).collect();
        feature(datum.line(&thinned(&places, TRACK_M)), json!({ "layer": "track", "run": past.name }))
    };
    past.iter().map(track).collect()
}

/// Shell, obstacles, zones and stations.
fn tank(datum: &Datum<'_>, run: &RunOpened, past: &[PastRun]) -> Vec<Value> {
    let mut features =
        vec![feature(datum.polygon(&outline(&run.world.boundary)), json!({ "layer": "shell" }))];
    let drawn = run.world.obstacles.iter().filter(|obstacle| obstacle.known);
    let drawn = drawn.map(|obstacle| (obstacle.name.clone(), obstacle.shape.clone(), "drawing"));
    let of_run = |(index, run): (usize, &'_ PastRun)| -> Vec<_> {
        let name = |solid: &Solid| found_name(&solid.name, index, past.len());
        run.fold.found().map(|solid| (name(solid), solid.shape.clone(), "found")).collect()
    };
    let map = on_map(past);
    // The map of a survey replaces what the tracker found under way.
    let found = past.iter().enumerate().filter(|_| map.is_none()).flat_map(of_run);
    features.extend(map.iter().flatten().map(|object| {
        let mut properties = json!({ "layer": "obstacles", "name": object.name, "source": "map" });
        if let Some([center_m, radius_m]) = object.errors_95_m {
            properties["center_95_m"] = json!(rounded(center_m));
            properties["radius_95_m"] = json!(rounded(radius_m));
        }
        feature(datum.shape(&object.shape), properties)
    }));
    features.extend(drawn.chain(found).map(|(name, shape, source)| {
        feature(datum.shape(&shape), json!({ "layer": "obstacles", "name": name, "source": source }))
    }));
    features.extend(zones(past).into_iter().map(|zone| {
        let layer = if zone.kind == ZoneKind::NoGo { "no_go_zones" } else { "zones" };
        feature(datum.shape(&zone.shape), json!({ "layer": layer, "name": zone.name, "kind": zone.kind }))
    }));
    features.extend(run.world.stations.iter().map(|station| {
        feature(datum.point(station.position), json!({ "layer": "stations", "name": station.name }))
    }));
    features
}

/// Every plate with its percentages.
fn plates(datum: &Datum<'_>, document: &Document) -> Vec<Value> {
    let plate = |shape: &super::shapes::PlateShape| {
        let account = document.floor.plates.iter().find(|plate| plate.name == shape.name);
        let mut properties = json!({ "layer": "plates", "name": shape.name, "kind": shape.kind });
        if let Some(plate) = account {
            properties["area_m2"] = json!(rounded(plate.shares.area_m2));
            properties["percent"] = json!(plate.shares.percent);
        }
        feature(datum.polygons(&shape.polygons), properties)
    };
    document.shapes.plates.iter().map(plate).collect()
}

fn missed(datum: &Datum<'_>, document: &Document) -> Vec<Value> {
    let areas = (1..).zip(document.floor.missed.iter().zip(&document.shapes.missed));
    let area = |(number, (area, polygons)): (usize, (&account::Area<_>, &Vec<_>))| {
        let properties = json!({
            "layer": "missed", "number": number, "area_m2": rounded(area.area_m2), "plates": area.plates,
            "reason": area.why(),
        });
        feature(datum.polygons(polygons), properties)
    };
    areas.map(area).collect()
}

fn indications(datum: &Datum<'_>, document: &Document) -> Vec<Value> {
    let indication = |found: &Indication| {
        let properties = json!({
            "layer": "indications", "number": found.number, "run": found.run, "t_s": found.t_s.map(rounded),
            "error_95_m": found.error_m.map(rounded), "kind": found.kind, "size_mm": found.size_mm.map(rounded), "depth_mm": found.depth_mm.map(rounded),
            "plate": found.plate, "note": found.note,
        });
        feature(datum.point(found.at), properties)
    };
    document.indications.iter().map(indication).collect()
}

/// The places that need a test with another method, in order of travel.
fn follow_ups(datum: &Datum<'_>, document: &Document) -> Vec<Value> {
    let place = |place: &FollowUp| {
        let properties = json!({
            "layer": "follow_up", "number": place.number, "what": place.what, "plate": place.plate,
            "area_m2": place.area_m2.map(rounded), "depth_mm": place.depth_mm.map(rounded),
        });
        feature(datum.point(place.at), properties)
    };
    document.follow_ups.iter().map(place).collect()
}
