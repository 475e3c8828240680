//! A picture of the forecast: light where a fix is accurate, dark near the limit, hatched where there is no fix.

use super::{
    frame::Fixtures,
    sheet::{Sheet, colour},
};
use positioning::AccuracyMap;
use world::{Point, World};

/// Width of the picture, millimetres.
const WIDTH_MM: f64 = 180.0;
/// Classes of the error, each with colour and label: as shares of the limit, above the limit, and without a fix.
const CLASSES: [(&str, &str); 6] = [
    (colour::ERROR[0], "up to 1/4 of the limit"),
    (colour::ERROR[1], "up to 1/2"),
    (colour::ERROR[2], "up to 3/4"),
    (colour::ERROR[3], "up to the limit"),
    (colour::MISSED, "above the limit"),
    (colour::OUT, "no fix"),
];

/// The picture as an SVG document; rings mark the advised stations.
pub(crate) fn svg(world: &World, map: &AccuracyMap, limit_m: f64, advised: &[Point]) -> String {
    let mut sheet = Sheet::new(&world.boundary, "f", WIDTH_MM, 8.0);
    sheet.wall(&world.boundary, r##"fill="#fff""##);
    let edge_mm = map.cell_m * sheet.scale;
    for (center, cell) in map.floor() {
        let class = match cell.error_95_m {
            None => 5,
            Some(error_m) if error_m > limit_m => 4,
            Some(error_m) => ((4.0 * error_m / limit_m) as usize).min(3),
        };
        let at = sheet.at(center);
        sheet.draw(format_args!(
            r#"<rect x="{:.2}" y="{:.2}" width="{edge_mm:.2}" height="{edge_mm:.2}" fill="{}"/>"#,
            at.x - edge_mm / 2.0,
            at.y - edge_mm / 2.0,
            CLASSES[class].0
        ));
    }
    let fixtures = Fixtures::of(world, None);
    sheet.obstacles(&fixtures);
    for place in advised {
        let style = format!(r#"class="advised" fill="none" stroke="{}" stroke-width=".6""#, colour::TETHER);
        sheet.circle(*place, 1.8, &style);
    }
    sheet.frame(&fixtures, 2.4);
    let mut key = CLASSES.to_vec();
    if !advised.is_empty() {
        key.push((colour::TETHER, "advised station"));
    }
    sheet.key(&key);
    sheet.into_document("Forecast of the accuracy")
}
