//! A plan as a picture for people: tank, obstacles with the margin that the robot's centre keeps, preset and planned
//! path, lanes in the colour of what they are for, the lines that a tethered robot never crosses, and the cable when it
//! is longest.

use super::{circle, document, line, outline, polyline, wall};
use crate::leg::Leg;
use world::{Point, World};

/// What there is to draw.
#[derive(Debug, Clone, Copy)]
pub struct Drawn<'a> {
    /// Tank, obstacles and stations.
    pub world: &'a World,
    /// Room that the middle of the hull needs, metres.
    pub room_m: f64,
    /// Width of the floor scanned in one pass, metres.
    pub swath_m: f64,
    /// The path that was given to follow, if one was.
    pub preset: Option<&'a [Point]>,
    /// Where the tether comes in, if there is one.
    pub anchor: Option<Point>,
    /// The planned path.
    pub path: &'a [Point],
    /// What its stretches are for.
    pub legs: &'a [Leg],
    /// Lines that the robot never crosses.
    pub cuts: &'a [Vec<Point>],
    /// The cable when it is longest.
    pub cable: &'a [Point],
}

/// The picture as an SVG document; north is up.
pub fn svg(drawn: &Drawn<'_>) -> String {
    let Drawn { world, path, legs, swath_m, .. } = drawn;
    let mut body = String::new();
    wall(&mut body, &world.boundary);
    for obstacle in &world.obstacles {
        outline(&mut body, &obstacle.shape, drawn.room_m);
    }
    if let Some(path) = drawn.preset {
        polyline(&mut body, path, "preset");
    }
    // The tool also scans on the way from lane to lane.
    for leg in legs.iter().filter(|leg| leg.tag != "path") {
        let style = format!(r#"class="band" style="stroke-width:{swath_m}""#);
        line(&mut body, &path[leg.first..=leg.last], &style);
    }
    for leg in *legs {
        polyline(&mut body, &path[leg.first..=leg.last], if leg.tag == "path" { "planned" } else { leg.tag });
    }
    for cut in drawn.cuts {
        polyline(&mut body, cut, "cut");
    }
    if drawn.cable.len() > 1 {
        polyline(&mut body, drawn.cable, "cable");
    }
    if let Some(anchor) = drawn.anchor {
        circle(&mut body, anchor, 0.15, "anchor");
    }
    for station in &world.stations {
        circle(&mut body, station.position, 0.1, "station");
    }
    document(&world.boundary, STYLE, &body)
}

const STYLE: &str = concat!(
    ".preset{stroke:#999}.planned,.swath{stroke:#1f5fbf;stroke-width:0.05}",
    ".band{stroke:#1f5fbf;stroke-opacity:0.12;stroke-linejoin:round}.connector{stroke:#e07b00}",
    ".retract{stroke:#8a3ab9}.travel{stroke:#2a9d4a}.anchor{fill:#2a9d4a}",
    ".cut{stroke:#d00;stroke-width:0.05;stroke-dasharray:0.2 0.12}",
    ".cable{stroke:#111;stroke-width:0.09;stroke-linecap:round}",
);
