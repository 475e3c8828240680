//! Styles of the viewer: colours by meaning, on a dark floor.

use crate::rr;

/// An opaque colour.
pub(crate) const fn rgb(red: u8, green: u8, blue: u8) -> [u8; 4] {
    [red, green, blue, 255]
}

/// Background of the map.
pub(crate) const FLOOR: [u8; 4] = rgb(18, 22, 28);
/// The wall of the tank.
pub(crate) const WALL: [u8; 4] = rgb(200, 205, 215);
/// Obstacles on the drawing.
pub(crate) const OBSTACLE: [u8; 4] = rgb(235, 100, 90);
/// Obstacles still to be found, at their true positions.
pub(crate) const HIDDEN: [u8; 4] = rgb(140, 80, 80);
/// Obstacles that were found, as estimated.
pub(crate) const FOUND: [u8; 4] = rgb(255, 170, 60);
/// Stations and their ranges.
pub(crate) const STATION: [u8; 4] = rgb(250, 200, 70);
/// Ranges that were used for a fix.
pub(crate) const RANGE: [u8; 4] = [250, 200, 70, 110];
/// Ranges that were left out of a fix.
pub(crate) const RANGE_EXCLUDED: [u8; 4] = rgb(255, 70, 60);
/// The true position.
pub(crate) const TRUE: [u8; 4] = rgb(90, 220, 130);
/// The estimated position.
pub(crate) const ESTIMATE: [u8; 4] = rgb(255, 120, 220);
/// The preset path.
pub(crate) const PRESET: [u8; 4] = [140, 150, 170, 150];
/// The planned path and the target.
pub(crate) const PLAN: [u8; 4] = rgb(90, 170, 255);
/// A figure that is neither true nor estimated.
pub(crate) const FIGURE: [u8; 4] = rgb(120, 200, 255);
/// A figure that is a warning.
pub(crate) const WARNING: [u8; 4] = rgb(255, 160, 60);

/// Floor by class: scanned, to do, missed, unreachable.
pub(crate) const SCANNED: [u8; 4] = rgb(38, 60, 76);
pub(crate) const TO_DO: [u8; 4] = rgb(26, 30, 36);
pub(crate) const MISSED: [u8; 4] = rgb(176, 118, 48);
pub(crate) const OUT_OF_REACH: [u8; 4] = rgb(58, 52, 50);
pub(crate) const UNTESTABLE: [u8; 4] = rgb(104, 84, 140);
/// The box around a missed area.
pub(crate) const MISSED_EDGE: [u8; 4] = rgb(240, 180, 90);
/// The scanning tool.
pub(crate) const SWATH: [u8; 4] = rgb(235, 235, 215);
/// Seams of plates.
pub(crate) const PLATE: [u8; 4] = [150, 165, 180, 90];

/// The tether.
pub(crate) const TETHER: [u8; 4] = rgb(250, 250, 235);

/// Colours for items that first appear during the run, such as planners.
pub(crate) const SERIES: [[u8; 4]; 6] = [
    rgb(70, 130, 200),
    rgb(150, 110, 200),
    rgb(60, 160, 150),
    rgb(190, 140, 70),
    rgb(190, 90, 130),
    rgb(120, 150, 80),
];

/// Converts a colour to the SDK's type.
pub(crate) fn color([red, green, blue, alpha]: [u8; 4]) -> rr::Color {
    rr::Color::from_unmultiplied_rgba(red, green, blue, alpha)
}

/// A width on screen, independent of the zoom.
pub(crate) fn on_screen(points: f32) -> rr::Radius {
    rr::Radius::new_ui_points(points)
}

/// A width on the floor, metres.
pub(crate) fn on_floor(metres: f64) -> rr::Radius {
    rr::Radius::new_scene_units(metres as f32)
}

/// Loss of metal by class; the lowest one is not drawn.
pub(crate) const LOSS: [[u8; 4]; 5] =
    [[0, 0, 0, 0], rgb(246, 227, 161), rgb(237, 179, 90), rgb(217, 112, 58), rgb(200, 40, 30)];
