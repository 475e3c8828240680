//! A picture of the map and the obstacles that scans show, without a mission.

use super::{
    frame::Fixtures,
    sheet::{Sheet, colour},
};
use exploration::{CellState, SurveyMap};
use world::{Boundary, Point, Shape};

/// Width of the picture, millimetres.
const WIDTH_MM: f64 = 270.0;
/// Standard deviation of an outline, metres, above which it is dashed: a disc behind a wall of which only a piece was seen.
const SURE_M: f64 = 0.1;

/// The picture as an SVG document; y is up. The map's floor is `boundary`; `found` are the obstacles that the tracker found, with
/// the standard deviations of their outlines in metres, and `way` is the way of the scanner. `None` if the text of the map's cells is damaged.
pub fn scanned<'a>(
    boundary: &Boundary,
    map: &SurveyMap,
    found: impl Iterator<Item = (&'a Shape, f64)>,
    way: &[Point],
) -> Option<String> {
    let states = map.states()?;
    let mut sheet = Sheet::new(boundary, "s", WIDTH_MM, 8.0);
    sheet.wall(boundary, &format!(r#"fill="{}""#, colour::OUT_GROUND));
    let size = (map.grid.columns, map.grid.rows);
    for (state, fill) in [(CellState::Free, colour::ONCE), (CellState::Solid, colour::OUT)] {
        let is_in = |cell: usize| states[cell] == state;
        sheet.grid((map.grid.low, map.grid.cell_m), size, is_in, 0.0, &format!(r#"fill="{fill}""#));
    }
    sheet.line(way, &format!(r#"stroke="{}" stroke-width=".2""#, colour::TRACK));
    for (shape, sigma_m) in found {
        let dashes = if sigma_m > SURE_M { r#" stroke-dasharray="1 .7""# } else { "" };
        let style = format!(r#"stroke="{}" stroke-width=".35"{dashes}"#, colour::MISSED);
        match shape {
            Shape::Polyline { points, .. } => sheet.line(points, &style),
            _ => sheet.shape(shape, &format!(r#"fill="none" {style}"#)),
        }
    }
    for column in &map.columns {
        sheet.shape(&column.shape(), &format!(r#"fill="{}""#, colour::SOLID));
    }
    let fixtures = Fixtures {
        boundary,
        drawn: Vec::new(),
        found: Vec::new(),
        stations: &[],
        zones: &[],
        anchor: way.first().copied(),
    };
    sheet.frame(&fixtures, 2.4);
    sheet.key(&[
        (colour::ONCE, "free floor on the map"),
        (colour::OUT, "echoes on the map"),
        (colour::OUT_GROUND, "not seen"),
        (colour::SOLID, "column on the map"),
        (colour::MISSED, "tracked obstacle (dashed: not certain)"),
        (colour::TRACK, "way of the scanner"),
    ]);
    Some(sheet.into_document("Map of recorded scans"))
}
