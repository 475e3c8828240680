//! A map in millimetres on paper: north up, one scale, and a pattern for each class of floor.

use super::trace::outlines;
use std::fmt::{Display, Write};
use world::{Boundary, Floor, Point, Shape};

/// The colours of all report drawings: muted for good results, strong for results that need a decision.
pub(crate) mod colour {
    pub(crate) const INK: &str = "#1C2731";
    pub(crate) const SOFT: &str = "#53616C";
    pub(crate) const RULE: &str = "#B9C3CA";
    pub(crate) const HAIR: &str = "#DDE3E7";
    pub(crate) const ONCE: &str = "#E1EAEE";
    pub(crate) const TWICE: &str = "#BFD0D9";
    pub(crate) const THIN: &str = "#E9C98A";
    pub(crate) const THIN_LINE: &str = "#A9741A";
    pub(crate) const MISSED: &str = "#C23B1E";
    pub(crate) const MISSED_LINE: &str = "#6E1C0A";
    pub(crate) const OUT: &str = "#8C9196";
    pub(crate) const OUT_GROUND: &str = "#ECEDED";
    pub(crate) const UNTESTABLE: &str = "#B39DDB";
    pub(crate) const MARGIN: &str = "#8A6A16";
    pub(crate) const MARGIN_GROUND: &str = "#F1E2B4";
    pub(crate) const SOLID: &str = "#39444E";
    pub(crate) const TRACK: &str = "#2C5F7C";
    pub(crate) const TETHER: &str = "#7A3E8C";
    pub(crate) const WARNING: &str = "#B26A00";
    pub(crate) const LOSS: [&str; 5] = ["#E1EAEE", "#F6E3A1", "#EDB35A", "#D9703A", "#A3281E"];
    pub(crate) const ERROR: [&str; 5] = ["#EAF1F4", "#C5D9E2", "#93B7C8", "#5A8DA6", "#2B5F7B"];
}

/// A picture of a tank that is being drawn.
pub(crate) struct Sheet {
    /// Width, millimetres.
    pub(crate) width_mm: f64,
    /// Height, millimetres.
    pub(crate) height_mm: f64,
    /// Millimetres on paper per metre of tank.
    pub(crate) scale: f64,
    /// Height of the space below the tank, millimetres.
    pub(crate) foot_mm: f64,
    rim_mm: f64,
    low: Point,
    high: Point,
    /// Prefix that keeps this picture's pattern ids apart from the ids of other pictures on the page.
    id: &'static str,
    body: String,
}

impl Sheet {
    /// An empty picture of a tank with the given width in millimetres and a margin on all sides.
    pub(crate) fn new(boundary: &Boundary, id: &'static str, width_mm: f64, rim_mm: f64) -> Self {
        let (low, high) = boundary.bounds();
        // A round tank leaves the corners free for the scale bar and the north arrow.
        let foot_mm = if matches!(boundary, Boundary::Circle { .. }) { 1.0 } else { 9.0 };
        let scale = (width_mm - 2.0 * rim_mm) / (high.x - low.x);
        let height_mm = (high.y - low.y) * scale + 2.0 * rim_mm + foot_mm;
        Self { width_mm, height_mm, scale, foot_mm, rim_mm, low, high, id, body: String::new() }
    }

    /// Converts a position in the tank to paper coordinates, millimetres from the top left corner.
    pub(crate) fn at(&self, place: Point) -> Point {
        Point::new(
            (place.x - self.low.x) * self.scale + self.rim_mm,
            (self.high.y - place.y) * self.scale + self.rim_mm,
        )
    }

    /// Centre of the bounding box of the tank, metres.
    pub(crate) fn middle(&self) -> Point {
        nalgebra::center(&self.low, &self.high)
    }

    /// Adds finished SVG.
    pub(crate) fn draw(&mut self, svg: impl Display) {
        // Writing to a String cannot fail.
        let _ = write!(self.body, "{svg}");
    }

    /// Adds the cells that the tool cannot test.
    pub(crate) fn untestable(&mut self, floor: &Floor, is_in: impl Fn(usize) -> bool) {
        self.cells(floor, is_in, 0.0, &format!(r#"fill="{}""#, colour::UNTESTABLE));
    }

    /// Adds cells of a floor with these attributes.
    pub(crate) fn cells(
        &mut self,
        floor: &Floor,
        is_in: impl Fn(usize) -> bool,
        tolerance: f64,
        style: &str,
    ) {
        self.grid((floor.origin, floor.cell_m), (floor.width, floor.height), is_in, tolerance, style);
    }

    /// Adds cells of a grid with these attributes; the grid is given by its south-west corner and the edge of a cell, in
    /// metres, and by its width and height in cells.
    pub(crate) fn grid(
        &mut self,
        (low, cell_m): (Point, f64),
        size: (usize, usize),
        is_in: impl Fn(usize) -> bool,
        tolerance: f64,
        style: &str,
    ) {
        let path = outlines(size, is_in, tolerance);
        if path.is_empty() {
            return;
        }
        let (edge, corner) = (cell_m * self.scale, self.at(low));
        self.draw(format_args!(
            r#"<path transform="matrix({edge:.5} 0 0 {:.5} {:.3} {:.3})" vector-effect="non-scaling-stroke" d="{path}" {style}/>"#,
            -edge, corner.x, corner.y
        ));
    }

    /// Adds the wall with these attributes.
    pub(crate) fn wall(&mut self, boundary: &Boundary, style: &str) {
        match boundary {
            Boundary::Circle { radius_m } => self.circle(Point::origin(), radius_m * self.scale, style),
            Boundary::Polygon { vertices } => self.polygon(vertices, style),
        }
    }

    /// Adds a circle around a position; its radius is in millimetres.
    pub(crate) fn circle(&mut self, center: Point, radius_mm: f64, style: &str) {
        let at = self.at(center);
        self.draw(format_args!(r#"<circle cx="{:.2}" cy="{:.2}" r="{radius_mm:.2}" {style}/>"#, at.x, at.y));
    }

    /// Adds a closed outline.
    pub(crate) fn polygon(&mut self, vertices: &[Point], style: &str) {
        let points = self.points(vertices);
        self.draw(format_args!(r#"<polygon points="{points}" {style}/>"#));
    }

    /// Adds an open line.
    pub(crate) fn line(&mut self, points: &[Point], style: &str) {
        let points = self.points(points);
        self.draw(format_args!(r#"<polyline points="{points}" fill="none" {style}/>"#));
    }

    fn points(&self, points: &[Point]) -> String {
        let pairs = points.iter().map(|p| self.at(*p)).map(|p| format!("{:.2},{:.2}", p.x, p.y));
        pairs.collect::<Vec<_>>().join(" ")
    }

    /// Adds a shape with these attributes; a line keeps its width.
    pub(crate) fn shape(&mut self, shape: &Shape, style: &str) {
        match shape {
            Shape::Disc { center, radius_m } => {
                self.circle(*center, (radius_m * self.scale).max(0.35), style);
            }
            Shape::Polygon { vertices } => self.polygon(vertices, style),
            Shape::Polyline { points, half_width_m } => {
                let width_mm = (2.0 * half_width_m * self.scale).max(0.3);
                let style = format!(
                    r#"stroke="{}" stroke-width="{width_mm:.2}" stroke-linecap="round""#,
                    colour::SOLID
                );
                self.line(points, &style);
            }
        }
    }

    /// The pattern fill of a class, scaled for cells of the floor (`""`) or for the legend (`"L"`).
    pub(crate) fn pattern(&self, name: &str) -> String {
        format!("url(#{}{name})", self.id)
    }

    /// The pattern definitions, scaled for cells with this edge length, metres, and for legends, in millimetres on
    /// paper.
    pub(crate) fn define_patterns(&mut self, cell_m: f64) {
        let (id, mut defs) = (self.id, String::new());
        for (suffix, scale) in [("", cell_m * self.scale), ("L", 1.0)] {
            let mut pattern = |name: &str, edge: f64, turn: f64, ground: &str, mark: &str| {
                let _ = write!(
                    defs,
                    concat!(
                        r#"<pattern id="{}{}{}" width="{}" height="{}" patternUnits="userSpaceOnUse" "#,
                        r#"patternTransform="scale({:.4}) rotate({})"><rect width="{}" height="{}" fill="{}"/>{}</pattern>"#
                    ),
                    id,
                    name,
                    suffix,
                    edge,
                    edge,
                    1.0 / scale,
                    turn,
                    edge,
                    edge,
                    ground,
                    mark
                );
            };
            let (out, margin) = (colour::OUT, colour::MARGIN);
            let cross = format!(r#"<path d="M0 .7H1.4M.7 0V1.4" stroke="{out}" stroke-width=".36"/>"#);
            pattern("out", 1.4, 45.0, colour::OUT_GROUND, &cross);
            let dot = format!(r#"<circle cx=".5" cy=".5" r=".26" fill="{margin}"/>"#);
            pattern("margin", 1.0, 0.0, colour::MARGIN_GROUND, &dot);
            let line = r##"<path d="M.65 0V1.3" stroke="#fff" stroke-width=".26"/>"##;
            pattern("missed", 1.3, 45.0, colour::MISSED, line);
        }
        let solid = colour::SOLID;
        let found = format!(r#"<path d="M.4 0V.8" stroke="{solid}" stroke-width=".4"/>"#);
        self.draw(format_args!(
            concat!(
                "<defs>{}",
                r##"<pattern id="{}found" width=".8" height=".8" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">"##,
                r##"<rect width=".8" height=".8" fill="#fff"/>{}</pattern></defs>"##
            ),
            defs, id, found
        ));
    }

    /// The picture with a label for screen readers and a CSS class.
    pub(crate) fn svg(&self, label: &str, class: &str) -> String {
        element(self.width_mm, self.height_mm, &self.body, label, class)
    }

    /// The picture as a document of its own.
    pub(crate) fn into_document(self, label: &str) -> String {
        let (width, height) = (self.width_mm, self.height_mm);
        format!(
            concat!(
                r##"<svg xmlns="http://www.w3.org/2000/svg" width="{:.1}mm" height="{:.1}mm" viewBox="0 0 {:.1} {:.1}" "##,
                r##"font-family="Inter,Helvetica,Arial,Liberation Sans,sans-serif"><title>{}</title>"##,
                r##"<rect width="100%" height="100%" fill="#fff"/>{}</svg>"##,
                "\n"
            ),
            width,
            height,
            width,
            height,
            foreign::markup(label),
            self.body
        )
    }

    /// Adds a legend below the tank: colours and their meanings, three in a row.
    pub(crate) fn key(&mut self, entries: &[(&str, &str)]) {
        let top = self.height_mm + 1.0;
        for (index, (colour, text)) in entries.iter().enumerate() {
            let (x, y) = (8.0 + 57.0 * (index % 3) as f64, top + 4.6 * (index / 3) as f64);
            self.draw(format_args!(
                r#"<rect x="{x}" y="{y:.2}" width="6" height="2.6" fill="{colour}"/><text x="{}" y="{:.2}" font-size="2.6" fill="{}">{text}</text>"#,
                x + 8.0,
                y + 2.2,
                colour::INK
            ));
        }
        self.height_mm += 4.6 * entries.len().div_ceil(3) as f64 + 3.0;
    }
}

/// An SVG element for an HTML page.
pub(crate) fn element(width_mm: f64, height_mm: f64, body: &str, label: &str, class: &str) -> String {
    format!(
        r#"<svg class="{class}" viewBox="0 0 {width_mm:.1} {height_mm:.1}" role="img" aria-label="{}" xmlns="http://www.w3.org/2000/svg">{body}</svg>"#,
        foreign::markup(label)
    )
}
