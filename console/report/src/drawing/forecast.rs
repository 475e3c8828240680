//! The forecast as a picture: green where a fix is good, red towards the limit, dark where there is none.

use super::{circle, document, outline, wall};
use positioning::AccuracyMap;
use std::fmt::Write;
use world::{Point, World};

const STYLE: &str = concat!(
    ".blind{fill:#444;stroke:none}.beyond{fill:#d7301f;stroke:none}.advised{stroke:#1f5fbf;stroke-width:0.06}",
    ".good0{fill:#1a9850;stroke:none}.good1{fill:#91cf60;stroke:none}",
    ".good2{fill:#fee08b;stroke:none}.good3{fill:#fc8d59;stroke:none}",
);

/// The picture as an SVG document; advised places are rings.
pub(crate) fn svg(world: &World, map: &AccuracyMap, limit_m: f64, advised: &[Point]) -> String {
    let mut body = String::new();
    for (center, cell) in map.floor() {
        let class = match cell.error_95_m {
            None => "blind",
            Some(error_m) if error_m > limit_m => "beyond",
            Some(error_m) => {
                ["good0", "good1", "good2", "good3"][((4.0 * error_m / limit_m) as usize).min(3)]
            }
        };
        let edge = map.cell_m;
        // Writing to a String cannot fail.
        let _ = write!(
            body,
            r#"<rect class="{class}" x="{:.4}" y="{:.4}" width="{edge:.4}" height="{edge:.4}"/>"#,
            center.x - edge / 2.0,
            -center.y - edge / 2.0,
        );
    }
    wall(&mut body, &world.boundary);
    for obstacle in &world.obstacles {
        outline(&mut body, &obstacle.shape, 0.0);
    }
    for station in &world.stations {
        circle(&mut body, station.position, 0.15, "station");
    }
    for place in advised {
        circle(&mut body, *place, 0.25, "advised");
    }
    document(&world.boundary, STYLE, &body)
}
