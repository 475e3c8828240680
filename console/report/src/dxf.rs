//! Drawings as DXF: R12 in ASCII, metres.

use std::fmt::Write;
use world::{Boundary, Point, Shape};

/// Height of letters, metres.
const LETTERS_M: f64 = 0.15;

/// A drawing under construction: pairs of a group code and a value, each on its own line.
pub(crate) struct Drawing(String);

impl Drawing {
    fn pair(&mut self, code: u16, value: impl std::fmt::Display) {
        // Writing to a String cannot fail.
        let _ = writeln!(self.0, "{code}\n{value}");
    }

    /// A drawing with these layers, each with its DXF colour number.
    pub(crate) fn new(layers: &[(&str, u8)]) -> Self {
        let mut drawing = Self(String::new());
        let count = layers.len().to_string();
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
            (70, &count),
        ];
        for (code, value) in pairs {
            drawing.pair(code, value);
        }
        for (name, colour) in layers {
            drawing.pair(0, "LAYER");
            drawing.pair(2, name);
            drawing.pair(70, 0);
            drawing.pair(62, colour);
            drawing.pair(6, "CONTINUOUS");
        }
        for value in ["ENDTAB", "ENDSEC", "SECTION"] {
            drawing.pair(0, value);
        }
        drawing.pair(2, "ENTITIES");
        drawing
    }

    /// The complete drawing.
    pub(crate) fn finish(mut self) -> String {
        self.pair(0, "ENDSEC");
        self.pair(0, "EOF");
        self.0
    }

    /// The wall of a tank.
    pub(crate) fn boundary(&mut self, layer: &str, boundary: &Boundary) {
        let shape = match boundary {
            Boundary::Circle { radius_m } => Shape::Disc { center: Point::origin(), radius_m: *radius_m },
            Boundary::Polygon { vertices } => Shape::Polygon { vertices: vertices.clone() },
        };
        self.shape(layer, &shape);
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

    pub(crate) fn shape(&mut self, layer: &str, shape: &Shape) {
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

    pub(crate) fn polyline(&mut self, layer: &str, points: &[Point], is_closed: bool) {
        self.line(layer, points, is_closed, None);
    }

    /// A line with a width in metres.
    pub(crate) fn wide(&mut self, layer: &str, points: &[Point], width_m: f64) {
        self.line(layer, points, false, Some(width_m));
    }

    fn line(&mut self, layer: &str, points: &[Point], is_closed: bool, width_m: Option<f64>) {
        self.entity("POLYLINE", layer);
        self.pair(66, 1);
        self.place(Point::origin());
        self.pair(70, u8::from(is_closed));
        for code in [40, 41] {
            if let Some(width_m) = width_m {
                self.pair(code, format_args!("{width_m:.4}"));
            }
        }
        for point in points {
            self.entity("VERTEX", layer);
            self.place(*point);
        }
        self.entity("SEQEND", layer);
    }

    pub(crate) fn point(&mut self, layer: &str, at: Point) {
        self.entity("POINT", layer);
        self.place(at);
    }

    pub(crate) fn text(&mut self, layer: &str, at: Point, text: &str) {
        self.entity("TEXT", layer);
        self.place(at);
        self.pair(40, LETTERS_M);
        self.pair(1, foreign::plain(text));
    }
}
