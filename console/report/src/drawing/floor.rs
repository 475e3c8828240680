//! A floor without a mission, as a picture for people: wall, obstacles, zones and stations.

use super::{frame::Fixtures, sheet::Sheet};
use world::World;

/// Width of the picture, millimetres.
const WIDTH_MM: f64 = 180.0;

/// The picture as an SVG document; north is up.
pub fn floor(world: &World) -> String {
    let mut sheet = Sheet::new(&world.boundary, "f", WIDTH_MM, 8.0);
    sheet.wall(&world.boundary, r##"fill="#fff""##);
    let fixtures = Fixtures::of(world, None);
    sheet.obstacles(&fixtures);
    sheet.frame(&fixtures, 2.4);
    sheet.into_document("Floor")
}
