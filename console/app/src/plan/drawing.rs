//! A plan as a picture for people: tank, obstacles with the margin that the robot's centre keeps, preset and planned
//! path, lanes in the colour of what they are for, and the lines that a tethered robot never crosses.

use super::Leg;
use crate::{
    drawing::{circle, document, line, outline, polyline, wall},
    scenario::Scenario,
};
use mission::TaskConfig;
use world::Point;

/// The picture as an SVG document; north is up.
pub fn svg(scenario: &Scenario, path: &[Point], legs: &[Leg], cuts: &[Vec<Point>]) -> String {
    let world = scenario.sim.world.as_drawn();
    let mut body = String::new();
    wall(&mut body, &world.boundary);
    let room_m = scenario.mission.limits.radius_m + scenario.mission.clearance_m;
    for obstacle in &world.obstacles {
        outline(&mut body, &obstacle.shape, room_m);
    }
    if let TaskConfig::Follow { path, .. } = &scenario.mission.task {
        polyline(&mut body, path, "preset");
    }
    let swath_m = scenario.mission.swath_m;
    for leg in legs.iter().filter(|leg| leg.tag == "swath") {
        let style = format!(r#"class="band" style="stroke-width:{swath_m}""#);
        line(&mut body, &path[leg.first..=leg.last], &style);
    }
    for leg in legs {
        polyline(&mut body, &path[leg.first..=leg.last], if leg.tag == "path" { "planned" } else { leg.tag });
    }
    for cut in cuts {
        polyline(&mut body, cut, "cut");
    }
    if let TaskConfig::Cover { anchor, .. } = &scenario.mission.task {
        circle(&mut body, *anchor, 0.15, "anchor");
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
);
