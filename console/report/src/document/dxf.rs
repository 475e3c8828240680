//! The report as a drawing: DXF R12 in ASCII, metres, with the layers SHELL, PLATES, OBSTACLES, MISSED, TRACK and INDICATIONS.

use super::Document;
use crate::{drawing::trace::thinned, joined::PastRun};
use std::fmt::Write;
use world::{Point, Shape};

/// The layers and their colours by the numbers of the format.
const LAYERS: [(&str, u8); 6] =
    [("SHELL", 7), ("PLATES", 8), ("OBSTACLES", 5), ("MISSED", 1), ("TRACK", 4), ("INDICATIONS", 6)];
/// Points of the track nearer to the rest of it than this are left out, metres.
const TRACK_M: f64 = 0.01;
/// Height of letters, metres.
const LETTERS_M: f64 = 0.15;

/// A drawing that is being written: pairs of a group code and a value, one a line.
struct Drawing(String);

/// The drawing.
pub fn dxf(document: &Document, past: &[PastRun]) -> String {
    let mut drawing = Drawing(String::new());
    drawing.begin();
    if let Some(run) = past.last().and_then(|past| past.fold.run.as_ref()) {
        drawing.shape("SHELL", &as_shape(&run.world.boundary));
        for seam in run.plates.iter().flat_map(|layout| layout.seams(&run.world.boundary)) {
            drawing.polyline("PLATES", &seam, false);
        }
        for obstacle in run.world.obstacles.iter().filter(|obstacle| obstacle.known) {
            drawing.shape("OBSTACLES", &obstacle.shape);
        }
        for solid in past.iter().flat_map(|past| past.fold.found()) {
            drawing.shape("OBSTACLES", &solid.shape);
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
        drawing.text("INDICATIONS", found.at, &format!("{} {}", found.number, found.kind));
    }
    drawing.pair(0, "ENDSEC");
    drawing.pair(0, "EOF");
    drawing.0
}

fn as_shape(boundary: &world::Boundary) -> Shape {
    match boundary {
        world::Boundary::Circle { radius_m } => Shape::Disc { center: Point::origin(), radius_m: *radius_m },
        world::Boundary::Polygon { vertices } => Shape::Polygon { vertices: vertices.clone() },
    }
}

impl Drawing {
    fn pair(&mut self, code: u16, value: impl std::fmt::Display) {
        // Writing to a String cannot fail.
        let _ = writeln!(self.0, "{code}\n{value}");
    }

    /// Header, table of layers, and the beginning of what is drawn.
    fn begin(&mut self) {
        let pairs: [(u16, &str); 12] = [
            (0, "SECTION"),
            (2, "HEADER"),
            (9, "$ACADVER"),
            (1, "AC1009"),
            (9, "$INSUNITS"),
            (70, "6"),
            (0, "ENDSEC"),
            (0, "SECTION"),
            (2, "TABLES"),
            (0, "TABLE"),
            (2, "LAYER"),
            (70, "6"),
        ];
        for (code, value) in pairs {
            self.pair(code, value);
        }
        for (name, colour) in LAYERS {
            self.pair(0, "LAYER");
            self.pair(2, name);
            self.pair(70, 0);
            self.pair(62, colour);
            self.pair(6, "CONTINUOUS");
        }
        for value in ["ENDTAB", "ENDSEC", "SECTION"] {
            self.pair(0, value);
        }
        self.pair(2, "ENTITIES");
    }

    fn entity(&mut self, kind: &str, layer: &str) {
        self.pair(0, kind);
        self.pair(8, layer);
    }

    fn place(&mut self, at: Point) {
        self.pair(10, format_args!("{:.4}", at.x));
        self.pair(20, format_args!("{:.4}", at.y));
        self.pair(30, "0.0");
    }

    fn shape(&mut self, layer: &str, shape: &Shape) {
        match shape {
            Shape::Disc { center, radius_m } => {
                self.entity("CIRCLE", layer);
                self.place(*center);
                self.pair(40, format_args!("{radius_m:.4}"));
            }
            Shape::Polygon { vertices } => self.polyline(layer, vertices, true),
            Shape::Polyline { points, .. } => self.polyline(layer, points, false),
        }
    }

    fn polyline(&mut self, layer: &str, points: &[Point], is_closed: bool) {
        self.entity("POLYLINE", layer);
        self.pair(66, 1);
        self.place(Point::origin());
        self.pair(70, u8::from(is_closed));
        for point in points {
            self.entity("VERTEX", layer);
            self.place(*point);
        }
        self.entity("SEQEND", layer);
    }

    fn text(&mut self, layer: &str, at: Point, text: &str) {
        self.entity("TEXT", layer);
        self.place(at);
        self.pair(40, LETTERS_M);
        self.pair(1, text.replace(char::is_control, " "));
    }
}
