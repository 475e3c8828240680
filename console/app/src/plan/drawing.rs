//! A plan as a picture for people: tank, obstacles with the margin that the robot's centre keeps, preset and planned
//! path, lanes in the colour of what they are for, and the lines that a tethered robot never crosses.

use super::Leg;
use crate::scenario::Scenario;
use mission::TaskConfig;
use std::fmt::Write;
use world::{Boundary, Point, Shape};

/// Pixels per metre.
const SCALE: f64 = 50.0;
/// Empty rim, metres.
const RIM_M: f64 = 0.5;

/// The picture as an SVG document; north is up.
pub fn svg(scenario: &Scenario, path: &[Point], legs: &[Leg], cuts: &[Vec<Point>]) -> String {
    let world = scenario.sim.world.as_drawn();
    let (low, high) = world.boundary.bounds();
    let (width, height) = (high.x - low.x + 2.0 * RIM_M, high.y - low.y + 2.0 * RIM_M);
    let mut body = String::new();
    match &world.boundary {
        Boundary::Circle { radius_m } => circle(&mut body, Point::origin(), *radius_m, "wall"),
        Boundary::Polygon { vertices } => polygon(&mut body, vertices, "wall"),
    }
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
    format!(
        concat!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="{:.0}" height="{:.0}" viewBox="{} {} {} {}">"#,
            "<style>*{{fill:none;stroke-width:0.03}}.wall{{stroke:#333;stroke-width:0.06}}",
            ".obstacle{{fill:#c0504d;stroke:#7a2e2c}}.margin{{stroke:#c0504d;stroke-dasharray:0.08}}",
            ".preset{{stroke:#999}}.planned,.swath{{stroke:#1f5fbf;stroke-width:0.05}}.station{{fill:#e0a020}}",
            ".band{{stroke:#1f5fbf;stroke-opacity:0.12;stroke-linejoin:round}}.connector{{stroke:#e07b00}}",
            ".retract{{stroke:#8a3ab9}}.travel{{stroke:#2a9d4a}}.anchor{{fill:#2a9d4a}}",
            ".cut{{stroke:#d00;stroke-width:0.05;stroke-dasharray:0.2 0.12}}</style>",
            r#"<rect x="{}" y="{}" width="{}" height="{}" style="fill:#fff"/>{}</svg>"#,
            "\n"
        ),
        width * SCALE,
        height * SCALE,
        low.x - RIM_M,
        -high.y - RIM_M,
        width,
        height,
        low.x - RIM_M,
        -high.y - RIM_M,
        width,
        height,
        body
    )
}

fn outline(body: &mut String, shape: &Shape, room_m: f64) {
    match shape {
        Shape::Disc { center, radius_m } => {
            circle(body, *center, radius_m + room_m, "margin");
            circle(body, *center, radius_m.max(0.03), "obstacle");
        }
        Shape::Polygon { vertices } => polygon(body, vertices, "obstacle"),
        Shape::Polyline { points, half_width_m } => {
            let style = format!(r#"class="obstacle" style="fill:none;stroke-width:{}""#, 2.0 * half_width_m);
            line(body, points, &style);
        }
    }
}

fn circle(body: &mut String, center: Point, radius_m: f64, class: &str) {
    // Writing to a String cannot fail.
    let _ = write!(
        body,
        r#"<circle class="{class}" cx="{:.4}" cy="{:.4}" r="{radius_m:.4}"/>"#,
        center.x, -center.y
    );
}

fn polygon(body: &mut String, vertices: &[Point], class: &str) {
    let _ = write!(body, r#"<polygon class="{class}" points="{}"/>"#, coordinates(vertices));
}

fn polyline(body: &mut String, points: &[Point], class: &str) {
    line(body, points, &format!(r#"class="{class}""#));
}

fn line(body: &mut String, points: &[Point], style: &str) {
    let _ = write!(body, r#"<polyline {style} points="{}"/>"#, coordinates(points));
}

fn coordinates(points: &[Point]) -> String {
    let pairs: Vec<String> = points.iter().map(|p| format!("{:.4},{:.4}", p.x, -p.y)).collect();
    pairs.join(" ")
}
