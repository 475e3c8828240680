//! The elements of every map: obstacles, shell, stations, anchor, north arrow, scale bar.

use super::sheet::{Sheet, colour};
use world::{Boundary, Point, Shape, Station, World, Zone};

/// The solid objects and labels of a tank.
pub(crate) struct Fixtures<'a> {
    /// The wall.
    pub(crate) boundary: &'a Boundary,
    /// Obstacles on the drawing.
    pub(crate) drawn: Vec<&'a Shape>,
    /// Obstacles that were found.
    pub(crate) found: Vec<&'a Shape>,
    /// Stations of the position system.
    pub(crate) stations: &'a [Station],
    /// Zones.
    pub(crate) zones: &'a [Zone],
    /// The anchor of the tether, or the start of the robot.
    pub(crate) anchor: Option<Point>,
}

impl<'a> Fixtures<'a> {
    /// The objects in a world, without found obstacles.
    pub(crate) fn of(world: &'a World, anchor: Option<Point>) -> Self {
        Self {
            boundary: &world.boundary,
            drawn: world.obstacles.iter().map(|obstacle| &obstacle.shape).collect(),
            found: Vec::new(),
            stations: &world.stations,
            zones: &world.zones,
            anchor,
        }
    }
}

impl Sheet {
    /// The obstacles and the zones.
    pub(crate) fn obstacles(&mut self, fixtures: &Fixtures<'_>) {
        let (solid, found) = (colour::SOLID, self.pattern("found"));
        for shape in &fixtures.drawn {
            self.shape(shape, &format!(r#"fill="{solid}""#));
        }
        for shape in &fixtures.found {
            self.shape(shape, &format!(r#"fill="{found}" stroke="{solid}" stroke-width=".3""#));
        }
        for zone in fixtures.zones {
            let style = format!(r#"fill="none" stroke="{solid}" stroke-width=".3" stroke-dasharray="1 .7""#);
            self.shape(&zone.shape, &style);
        }
    }

    /// Draws shell, stations, anchor, north arrow and scale bar, with letters of the given height in millimetres.
    pub(crate) fn frame(&mut self, fixtures: &Fixtures<'_>, letters_mm: f64) {
        let ink = colour::INK;
        // A small map has a thinner line so that marks along the shell stay visible.
        let stroke = if self.width_mm > 120.0 { 0.5 } else { 0.25 };
        self.wall(fixtures.boundary, &format!(r#"fill="none" stroke="{ink}" stroke-width="{stroke}""#));
        for station in fixtures.stations {
            self.station(station, letters_mm);
        }
        if let Some(anchor) = fixtures.anchor {
            let at = self.at(anchor);
            self.draw(format_args!(
                r##"<path class="anchor" d="M{:.2} {:.2}h2.6l-1.3 -2.3z" fill="#fff" stroke="{ink}" stroke-width=".3"/>"##,
                at.x - 1.3,
                at.y + 1.1
            ));
        }
        self.scale_bar(letters_mm);
        self.north(letters_mm);
    }

    fn station(&mut self, station: &Station, letters_mm: f64) {
        let (at, ink) = (self.at(station.position), colour::INK);
        let middle = self.at(self.middle());
        let outward = (at - middle).try_normalize(1e-9).unwrap_or_else(|| world::Vector::new(0.0, -1.0));
        let label = at + outward * 3.1;
        self.draw(format_args!(
            concat!(
                r##"<circle cx="{:.2}" cy="{:.2}" r="1" fill="#fff" stroke="{ink}" stroke-width=".3"/>"##,
                r##"<circle cx="{:.2}" cy="{:.2}" r=".35" fill="{ink}"/>"##,
                r##"<text class="st" x="{:.2}" y="{:.2}" dy=".35em" text-anchor="middle" font-size="{letters}" font-weight="600" fill="{ink}">{name}</text>"##
            ),
            at.x,
            at.y,
            at.x,
            at.y,
            label.x,
            label.y,
            ink = ink,
            letters = letters_mm,
            name = foreign::markup(&station.name)
        ));
    }

    fn scale_bar(&mut self, letters_mm: f64) {
        let fits = |length_m: &f64| length_m * self.scale <= 0.24 * self.width_mm;
        let length_m = [50.0, 20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2].into_iter().find(fits).unwrap_or(0.1);
        let (length_mm, top, ink) = (length_m * self.scale, self.height_mm - 3.2, colour::INK);
        let left = self.width_mm - 4.0 - length_mm;
        for part in 0..4 {
            let fill = if part % 2 == 0 { ink } else { "#fff" };
            let width = length_mm / 4.0;
            let x = left + f64::from(part) * width;
            self.draw(format_args!(
                r#"<rect x="{x:.2}" y="{top:.2}" width="{width:.2}" height="1.1" fill="{fill}" stroke="{ink}" stroke-width=".18"/>"#
            ));
        }
        let (y, right) = (top - 0.9, self.width_mm - 4.0);
        self.draw(format_args!(
            concat!(
                r#"<g class="fr" font-size="{letters}" fill="{ink}"><text x="{left:.2}" y="{y:.2}" text-anchor="middle">0</text>"#,
                r#"<text x="{right:.2}" y="{y:.2}" text-anchor="end">{length} m</text></g>"#
            ),
            letters = letters_mm,
            ink = ink,
            left = left,
            y = y,
            right = right,
            length = length_m
        ));
    }

    fn north(&mut self, letters_mm: f64) {
        let (y, ink) = (self.height_mm - 5.2, colour::INK);
        self.draw(format_args!(
            r#"<g transform="translate(5 {y:.2})" fill="{ink}"><path d="M0 -4.2L1.5 3L0 1.8L-1.5 3Z"/><text class="fr" x="2.6" y="2.6" font-size="{:.2}" font-weight="600">N</text></g>"#,
            letters_mm + 0.4
        ));
        if self.width_mm > 120.0 {
            let (y, soft, scale) = (self.height_mm - 2.2, colour::SOFT, 1000.0 / self.scale);
            self.draw(format_args!(
                r#"<text class="hide-phone" x="13" y="{y:.2}" font-size="{:.2}" fill="{soft}">1 : {scale:.0} on A4 at 100 %</text>"#,
                letters_mm - 0.2
            ));
        }
    }
}
