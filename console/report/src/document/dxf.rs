//! The report as a drawing: DXF R12 in ASCII, metres, with the layers SHELL, PLATES, OBSTACLES, PIPES, MISSED, TRACK and INDICATIONS.
//!
//! `tankops import` reads the floor back: seams end at each other and at the shell, each plate has its name on their layer, and
//! pipes have their width.

use super::Document;
use crate::{
    account::plate_map,
    drawing::{plates::PlateLines, trace::thinned},
    dxf::Drawing,
    joined::{PastRun, found_name},
};
use mission::RunOpened;
use world::{PlateLayout, Point, Shape};

/// The layers and their colours by the numbers of the format.
const LAYERS: [(&str, u8); 7] = [
    ("SHELL", 7),
    ("PLATES", 8),
    ("OBSTACLES", 5),
    ("PIPES", 5),
    ("MISSED", 1),
    ("TRACK", 4),
    ("INDICATIONS", 6),
];
/// Points of the track nearer to the rest of it than this are left out, metres.
const TRACK_M: f64 = 0.01;
/// The drawing.
pub fn dxf(document: &Document, past: &[PastRun]) -> String {
    let mut drawing = Drawing::new(&LAYERS);
    if let Some(run) = past.last().and_then(|past| past.fold.run.as_ref()) {
        drawing.boundary("SHELL", &run.world.boundary);
        plates(&mut drawing, run);
        for obstacle in run.world.obstacles.iter().filter(|obstacle| obstacle.known) {
            solid(&mut drawing, &obstacle.shape);
        }
        for (index, of_run) in past.iter().enumerate() {
            for solid in of_run.fold.found() {
                self::solid(&mut drawing, &solid.shape);
                drawing.text("OBSTACLES", solid.shape.center(), &found_name(&solid.name, index, past.len()));
            }
        }
    }
    for (number, area) in (1..).zip(&document.floor.missed) {
        let number: usize = number;
        drawing.polyline("MISSED", &world::shape::rectangle(area.low, area.high), true);
        drawing.text("MISSED", area.high, &number.to_string());
    }
    for past in past {
        let places: Vec<Point> =
            past.record.track.iter().map(super::super::record::TrackPoint::position).collect();
        drawing.polyline("TRACK", &thinned(&places, TRACK_M), false);
    }
    for found in &document.indications {
        drawing.shape("INDICATIONS", &Shape::Disc { center: found.at, radius_m: found.error_m });
        let run = past.iter().position(|past| past.name == found.run).unwrap_or(0);
        let name = format!("I{} {}", found.number, found.kind);
        drawing.text("INDICATIONS", found.at, &found_name(&name, run, past.len()));
    }
    drawing.finish()
}

/// What stands on the floor, on the layer of its kind.
fn solid(drawing: &mut Drawing, shape: &Shape) {
    match shape {
        Shape::Polyline { points, half_width_m } => drawing.wide("PIPES", points, 2.0 * half_width_m),
        _ => drawing.shape("OBSTACLES", shape),
    }
}

/// The plates with their names.
fn plates(drawing: &mut Drawing, run: &RunOpened) {
    let Some((layout, map)) = run.plates.as_ref().zip(plate_map(run, &run.floor)) else { return };
    match layout {
        PlateLayout::Drawn { plates } => {
            plates.iter().for_each(|plate| drawing.polyline("PLATES", &plate.vertices_m, true));
        }
        PlateLayout::Regular(_) => {
            let seams = layout.seams(&run.world.boundary);
            seams.iter().for_each(|seam| drawing.polyline("PLATES", seam, false));
        }
    }
    for (name, at) in PlateLines::new(layout, &run.world.boundary, &run.floor, &map).names() {
        drawing.text("PLATES", at, name);
    }
}
