//! Tanks as pictures for people: SVG with the tank frame's x to the right and y up.

pub(crate) mod forecast;
pub mod plan;

use std::fmt::Write;
use world::{Boundary, Point, Shape, World};

/// Pixels per metre.
const SCALE: f64 = 50.0;
/// Empty rim, metres.
const RIM_M: f64 = 0.5;

/// A whole picture of a tank: `style` is CSS for the classes of what `body` draws besides tank and obstacles.
pub(crate) fn document(boundary: &Boundary, style: &str, body: &str) -> String {
    let (low, high) = boundary.bounds();
    let (width, height) = (high.x - low.x + 2.0 * RIM_M, high.y - low.y + 2.0 * RIM_M);
    format!(
        concat!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="{:.0}" height="{:.0}" viewBox="{} {} {} {}">"#,
            "<style>*{{fill:none;stroke-width:0.03}}.wall{{stroke:#333;stroke-width:0.06}}",
            ".obstacle{{fill:#c0504d;stroke:#7a2e2c}}.margin{{stroke:#c0504d;stroke-dasharray:0.08}}",
            ".station{{fill:#e0a020}}{}</style>",
            r#"<rect x="{}" y="{}" width="{}" height="{}" style="fill:#fff"/>{}</svg>"#,
            "\n"
        ),
        width * SCALE,
        height * SCALE,
        low.x - RIM_M,
        -high.y - RIM_M,
        width,
        height,
        style,
        low.x - RIM_M,
        -high.y - RIM_M,
        width,
        height,
        body
    )
}

/// A floor as an SVG document: wall, obstacles and stations.
pub fn floor(world: &World) -> String {
    let mut body = String::new();
    wall(&mut body, &world.boundary);
    for obstacle in &world.obstacles {
        outline(&mut body, &obstacle.shape, 0.0);
    }
    for station in &world.stations {
        circle(&mut body, station.position, 0.15, "station");
    }
    document(&world.boundary, "", &body)
}

/// The wall of the tank.
pub(crate) fn wall(body: &mut String, boundary: &Boundary) {
    match boundary {
        Boundary::Circle { radius_m } => circle(body, Point::origin(), *radius_m, "wall"),
        Boundary::Polygon { vertices } => polygon(body, vertices, "wall"),
    }
}

/// An obstacle, with the margin that the robot's centre keeps from a column.
pub(crate) fn outline(body: &mut String, shape: &Shape, room_m: f64) {
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

/// A circle.
pub(crate) fn circle(body: &mut String, center: Point, radius_m: f64, class: &str) {
    // Writing to a String cannot fail.
    let _ = write!(
        body,
        r#"<circle class="{class}" cx="{:.4}" cy="{:.4}" r="{radius_m:.4}"/>"#,
        center.x, -center.y
    );
}

/// A closed outline.
pub(crate) fn polygon(body: &mut String, vertices: &[Point], class: &str) {
    let _ = write!(body, r#"<polygon class="{class}" points="{}"/>"#, coordinates(vertices));
}

/// An open line.
pub(crate) fn polyline(body: &mut String, points: &[Point], class: &str) {
    line(body, points, &format!(r#"class="{class}""#));
}

/// An open line with its own style.
pub(crate) fn line(body: &mut String, points: &[Point], style: &str) {
    let _ = write!(body, r#"<polyline {style} points="{}"/>"#, coordinates(points));
}

fn coordinates(points: &[Point]) -> String {
    let pairs: Vec<String> = points.iter().map(|p| format!("{:.4},{:.4}", p.x, -p.y)).collect();
    pairs.join(" ")
}
