//! The report as a drawing: DXF R12 in ASCII, metres, with the layers SHELL, PLATES, OBSTACLES, MISSED, TRACK and INDICATIONS.

use super::Document;
use crate::{
    drawing::trace::thinned,
    dxf::Drawing,
    joined::{PastRun, found_name},
};
use world::{Point, Shape};

/// The layers and their colours by the numbers of the format.
const LAYERS: [(&str, u8); 6] =
    [("SHELL", 7), ("PLATES", 8), ("OBSTACLES", 5), ("MISSED", 1), ("TRACK", 4), ("INDICATIONS", 6)];
/// Points of the track nearer to the rest of it than this are left out, metres.
const TRACK_M: f64 = 0.01;
/// The drawing.
pub fn dxf(document: &Document, past: &[PastRun]) -> String {
    let mut drawing = Drawing::new(&LAYERS);
    if let Some(run) = past.last().and_then(|past| past.fold.run.as_ref()) {
        drawing.boundary("SHELL", &run.world.boundary);
        for seam in run.plates.iter().flat_map(|layout| layout.seams(&run.world.boundary)) {
            drawing.polyline("PLATES", &seam, false);
        }
        for obstacle in run.world.obstacles.iter().filter(|obstacle| obstacle.known) {
            drawing.shape("OBSTACLES", &obstacle.shape);
        }
        for (index, of_run) in past.iter().enumerate() {
            for solid in of_run.fold.found() {
                drawing.shape("OBSTACLES", &solid.shape);
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
