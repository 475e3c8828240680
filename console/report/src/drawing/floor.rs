//! A picture of a floor without a mission: wall, plates, obstacles, zones and stations.

use super::{frame::Fixtures, plates::PlateLines, sheet::Sheet};
use world::{DrawnPlate, World};

/// Width of the picture, millimetres.
const WIDTH_MM: f64 = 180.0;

/// The picture as an SVG document; north is up.
pub fn floor(world: &World, plates: &[DrawnPlate]) -> String {
    let mut sheet = Sheet::new(&world.boundary, "f", WIDTH_MM, 8.0);
    sheet.wall(&world.boundary, r##"fill="#fff""##);
    let plates = PlateLines::of_outlines(plates);
    sheet.plates(Some(&plates));
    sheet.plate_names(Some(&plates), 2.1);
    let fixtures = Fixtures::of(world, None);
    sheet.obstacles(&fixtures);
    sheet.frame(&fixtures, 2.4);
    sheet.into_document("Floor")
}
