//! The report as a drawing: DXF R12 in ASCII, metres, with the layers SHELL, PLATES, OBSTACLES, PIPES, MISSED, TRACK,
//! INDICATIONS, `NO_GO_ZONES`, ZONES, STATIONS and `FOLLOW_UP` (places that need a test with another method, numbered in
//! order of travel).
//!
//! `tankops import` can read the floor from this drawing: seams end at each other or at the shell, the name of each
//! plate is on the layer of the seams, and pipes keep their width.

use super::{model::Document, shapes::zones, survey::on_map};
use crate::{
    drawing::{plates::PlateLines, polygons::Polygon, trace::thinned},
    dxf::Drawing,
    joined::found_name,
    past_run::PastRun,
};
use account::plate_map;
use mission::RunOpened;
use world::{PlateLayout, Point, Shape, ZoneKind};

/// The layers and their DXF colour numbers.
const LAYERS: [(&str, u8); 11] = [
    ("SHELL", 7),
    ("PLATES", 8),
    ("OBSTACLES", 5),
    ("PIPES", 5),
    ("MISSED", 1),
    ("TRACK", 4),
    ("INDICATIONS", 6),
    ("NO_GO_ZONES", 30),
    ("ZONES", 9),
    ("STATIONS", 3),
    ("FOLLOW_UP", 2),
];
/// Simplification tolerance of the track, metres.
const TRACK_M: f64 = 0.01;
/// Writes the report as a drawing.
pub fn dxf(document: &Document, past: &[PastRun]) -> String {
    let mut drawing = Drawing::new(&LAYERS);
    if let Some(run) = past.last().and_then(|past| past.fold.run()) {
        drawing.boundary("SHELL", &run.world.boundary);
        plates(&mut drawing, run);
        obstacles(&mut drawing, run, past);
    }
    if let Some(run) = past.last().and_then(|past| past.fold.run()) {
        zones_and_stations(&mut drawing, run, past);
    }
    for (number, (area, polygons)) in (1..).zip(document.floor.missed.iter().zip(&document.shapes.missed)) {
        let number: usize = number;
        for ring in polygons.iter().flat_map(Polygon::rings) {
            drawing.polyline("MISSED", ring, true);
        }
        drawing.text("MISSED", area.at, &number.to_string());
    }
    for past in past {
        let places: Vec<Point> =
            past.record.track.iter().map(super::super::record::TrackPoint::position).collect();
        drawing.polyline("TRACK", &thinned(&places, TRACK_M), false);
    }
    for found in &document.indications {
        match found.error_m {
            Some(radius_m) => drawing.shape("INDICATIONS", &Shape::Disc { center: found.at, radius_m }),
            None => drawing.point("INDICATIONS", found.at),
        }
        let run = past.iter().position(|past| Some(&past.name) == found.run.as_ref());
        let name = format!("I{} {}", found.number, found.kind);
        let name = run.map_or_else(|| name.clone(), |run| found_name(&name, run, past.len()));
        drawing.text("INDICATIONS", found.at, &name);
    }
    for place in &document.follow_ups {
        drawing.point("FOLLOW_UP", place.at);
        drawing.text("FOLLOW_UP", place.at, &place.number.to_string());
    }
    drawing.finish()
}

/// Draws the obstacles: those on the map of a survey with the 95 % error of their centre, otherwise those on the drawing
/// and those that were found. The map of a survey shows the drawn ones, too.
fn obstacles(drawing: &mut Drawing, run: &RunOpened, past: &[PastRun]) {
    if let Some(objects) = on_map(past) {
        for object in objects {
            solid(drawing, &object.shape);
            let error = object.errors_95_m.map(|[m, _]| format!(" ±{m:.3} m")).unwrap_or_default();
            drawing.text("OBSTACLES", object.shape.center(), &format!("{}{error}", object.name));
        }
        return;
    }
    for obstacle in run.world.obstacles.iter().filter(|obstacle| obstacle.known) {
        solid(drawing, &obstacle.shape);
    }
    for (index, of_run) in past.iter().enumerate() {
        for found in of_run.fold.found() {
            solid(drawing, &found.shape);
            drawing.text("OBSTACLES", found.shape.center(), &found_name(&found.name, index, past.len()));
        }
    }
}

/// Draws zones and stations.
fn zones_and_stations(drawing: &mut Drawing, run: &RunOpened, past: &[PastRun]) {
    for zone in zones(past) {
        let layer = if zone.kind == ZoneKind::NoGo { "NO_GO_ZONES" } else { "ZONES" };
        drawing.shape(layer, &zone.shape);
        drawing.text(layer, zone.shape.center(), &zone.name);
    }
    for station in &run.world.stations {
        drawing.point("STATIONS", station.position);
        drawing.text("STATIONS", station.position, &station.name);
    }
}

/// Draws a solid object on the layer of its kind.
fn solid(drawing: &mut Drawing, shape: &Shape) {
    match shape {
        Shape::Polyline { points, half_width_m } => drawing.wide("PIPES", points, 2.0 * half_width_m),
        _ => drawing.shape("OBSTACLES", shape),
    }
}

/// Draws the plates with their names.
fn plates(drawing: &mut Drawing, run: &RunOpened) {
    let Some((layout, map)) = run.plates.as_ref().zip(plate_map(run, &run.floor)) else { return };
    match layout {
        PlateLayout::Drawn { plates } => {
            plates.iter().for_each(|plate| drawing.polyline("PLATES", &plate.vertices_m, true));
        }
        PlateLayout::Regular(_) => {
            let seams = layout.seams(&run.world.boundary);
            for seam in &seams {
                drawing.polyline("PLATES", seam, false);
            }
        }
    }
    for (name, at) in PlateLines::new(layout, &run.world.boundary, &run.floor, &map).names() {
        drawing.text("PLATES", at, name);
    }
}
