//! Numbered badges on a map: inside an area that is wide enough, otherwise beside it at the end of a leader that
//! crosses as little as possible.

use super::{
    frame::Fixtures,
    sheet::{Sheet, colour},
    trace::deepest,
};
use std::f64::consts::TAU;
use world::{
    Floor, Point, Shape,
    geometry::unit_vector,
    polyline::{nearest_on_segment, segments_cross},
};

/// Radius of a badge, and height of its digits, millimetres.
const RADIUS_MM: f64 = 2.05;
const LETTERS_MM: f64 = 2.35;
/// Distances from the area at which a position for the badge is tried, in addition to its radius, millimetres.
const DISTANCES_MM: [f64; 7] = [1.6, 2.8, 4.5, 7.0, 10.0, 14.0, 19.0];
/// The number of directions in which a badge is tried.
const DIRECTIONS: usize = 24;
/// A position with a higher cost is not used.
const MOST_COST: f64 = 400.0;

/// An area that gets a number.
pub(crate) struct Numbered<'a> {
    /// Number of the area.
    pub(crate) number: usize,
    /// A position in the area, metres.
    pub(crate) at: Point,
    /// Cells of the area.
    pub(crate) cells: &'a [usize],
}

/// A circle on paper, millimetres.
type Spot = (Point, f64);

/// The marks and names that badges must not cover.
struct Crowd {
    badges: Vec<Spot>,
    leaders: Vec<[Point; 2]>,
    solids: Vec<Spot>,
    stations: Vec<Point>,
    areas: Vec<Point>,
    /// South-west and north-east corners of names, millimetres.
    names: Vec<[Point; 2]>,
}

/// Draws badges for areas and returns the numbers of those that fit. `names` are the boxes around names, which badges
/// must not cover.
pub(crate) fn draw(
    sheet: &mut Sheet,
    (floor, fixtures): (&Floor, &Fixtures<'_>),
    areas: &[Numbered<'_>],
    names: &[[Point; 2]],
) -> Vec<usize> {
    let radius_mm = RADIUS_MM;
    let mut crowd = Crowd {
        badges: Vec::new(),
        leaders: Vec::new(),
        solids: fixtures.drawn.iter().chain(&fixtures.found).flat_map(|shape| spots(sheet, shape)).collect(),
        stations: fixtures.stations.iter().map(|station| sheet.at(station.position)).collect(),
        areas: areas.iter().map(|area| sheet.at(area.at)).collect(),
        names: names.to_vec(),
    };
    let mut placed: Vec<(usize, Point)> = Vec::new();
    for area in areas {
        let (cell, depth) = deepest(floor, area.cells);
        let is_deep = depth as f64 * floor.cell_m * sheet.scale > 1.15 * radius_mm;
        let at = sheet.at(area.at);
        let place =
            if is_deep { Some(sheet.at(floor.center(cell))) } else { beside(sheet, &crowd, at, radius_mm) };
        let Some(place) = place else { continue };
        crowd.badges.push((place, radius_mm));
        if !is_deep {
            crowd.leaders.push([at, place]);
        }
        placed.push((area.number, place));
    }
    let leader = |[from, to]: &[Point; 2]| {
        let end = to - (to - from).normalize() * radius_mm;
        format!("M{:.2} {:.2}L{:.2} {:.2}", from.x, from.y, end.x, end.y)
    };
    let leaders: String = crowd.leaders.iter().map(leader).collect();
    let (line, missed, ink) = (colour::MISSED_LINE, colour::MISSED, colour::INK);
    sheet.draw(format_args!(
        r##"<g><path d="{leaders}" fill="none" stroke="#fff" stroke-width=".7"/><path d="{leaders}" fill="none" stroke="{line}" stroke-width=".25"/><g font-size="{LETTERS_MM}" font-weight="700" text-anchor="middle" fill="{ink}">"##
    ));
    for (number, at) in &placed {
        sheet.draw(format_args!(
            r##"<a href="#m{number}"><circle cx="{x:.2}" cy="{y:.2}" r="{radius_mm}" fill="#fff" stroke="{missed}" stroke-width=".35"/><text x="{x:.2}" y="{y:.2}" dy=".35em">{number}</text></a>"##,
            x = at.x,
            y = at.y
        ));
    }
    sheet.draw("</g></g>");
    placed.into_iter().map(|(number, _)| number).collect()
}

/// The cheapest position for a badge around a point on the paper.
fn beside(sheet: &Sheet, crowd: &Crowd, at: Point, radius_mm: f64) -> Option<Point> {
    let mut best: Option<(f64, Point)> = None;
    for distance in DISTANCES_MM.map(|beyond| radius_mm + beyond) {
        for direction in 0..DIRECTIONS {
            let place = at + unit_vector(TAU * direction as f64 / DIRECTIONS as f64) * distance;
            let room = radius_mm + 0.3;
            let low = sheet.height_mm - sheet.foot_mm - radius_mm + 2.0;
            if place.x < room || place.x > sheet.width_mm - room || place.y < room || place.y > low {
                continue;
            }
            let cost = distance + crowd.cost(at, place, radius_mm);
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, place));
            }
        }
        if best.is_some_and(|(cost, _)| cost < distance + 2.0) {
            break;
        }
    }
    best.filter(|(cost, _)| *cost < MOST_COST).map(|(_, place)| place)
}

impl Crowd {
    /// The cost of a badge position: everything that the badge covers and that its leader crosses.
    fn cost(&self, from: Point, place: Point, radius_mm: f64) -> f64 {
        let off = |spot: Point| (place - spot).norm();
        let leader_off = |spot: Point| (spot - nearest_on_segment(from, place, spot)).norm();
        let mut cost = 0.0;
        for (spot, radius) in &self.badges {
            cost += if off(*spot) < radius_mm + radius + 0.5 { MOST_COST } else { 0.0 };
            cost += if leader_off(*spot) < radius + 0.2 { 150.0 } else { 0.0 };
        }
        for [a, b] in &self.leaders {
            cost += if segments_cross(from, place, *a, *b) { 200.0 } else { 0.0 };
        }
        for station in &self.stations {
            cost += if off(*station) < radius_mm + 4.2 { 30.0 } else { 0.0 };
        }
        for area in self.areas.iter().filter(|area| **area != from) {
            cost += if off(*area) < radius_mm + 0.6 { 25.0 } else { 0.0 };
        }
        for (spot, radius) in &self.solids {
            cost += if off(*spot) < radius_mm + radius + 0.2 { 14.0 } else { 0.0 };
            cost += if leader_off(*spot) < *radius { 6.0 } else { 0.0 };
        }
        for [low, high] in &self.names {
            let covers = place.x > low.x - radius_mm
                && place.x < high.x + radius_mm
                && place.y > low.y - radius_mm
                && place.y < high.y + radius_mm;
            cost += if covers { 7.0 } else { 0.0 };
        }
        cost
    }
}

/// A shape approximated by circles on paper.
fn spots(sheet: &Sheet, shape: &Shape) -> Vec<Spot> {
    let along = |points: &[Point]| -> Vec<Spot> {
        let thirds = |edge: &[Point]| [0.0, 0.33, 0.66].map(|share| edge[0] + (edge[1] - edge[0]) * share);
        points.windows(2).flat_map(thirds).map(|p| (sheet.at(p), 0.8)).collect()
    };
    match shape {
        Shape::Disc { center, radius_m } => vec![(sheet.at(*center), radius_m * sheet.scale)],
        Shape::Polygon { vertices } => along(vertices),
        Shape::Polyline { points, .. } => along(points),
    }
}
