//! The scenarios of a tank.

use std::{f64::consts::TAU, fmt::Write};
use trials::tanks::{SWATH_M, Tank};
use world::Boundary;

/// Number of acoustic-emission sensors on the wall, and their distance from it, metres.
const STATIONS: usize = 5;
const OFF_WALL_M: f64 = 1e-3;
/// Radius of the hull and clearance, metres: together the 0.3 m of `pan-maps`. The guard needs more than the clearance of that
/// study, because the points of the scanner scatter by 2 cm.
const HULL_M: f64 = 0.2;
const CLEARANCE_M: f64 = 0.1;
/// Overlap of two passes, metres.
const OVERLAP_M: f64 = 0.1;
/// Length on the reel, as a multiple of half the diagonal of the box around the tank.
const REEL_RATIO: f64 = 1.6;

/// The survey of a tank whose drawing shows only the wall.
pub(super) fn survey(tank: &Tank, seed: u64) -> String {
    let mut text = head(tank, seed, "kind = \"survey\"");
    columns(&mut text, tank, "column", false);
    text
}

/// The coverage of a tank by its true drawing.
pub(super) fn cover(tank: &Tank, seed: u64, planner: &str) -> String {
    let mut text = head(tank, seed, "kind = \"cover\"");
    columns(&mut text, tank, "column", true);
    // Writing to a String cannot fail.
    let _ = write!(text, "\n[planner]\nid = {planner:?}\n");
    text
}

/// The coverage of a tank by the map of its survey: the true columns are also there, but not on the drawing.
pub(super) fn with_truth(of_map: &str, tank: &Tank) -> String {
    let mut text = format!("{of_map}\n");
    columns(&mut text, tank, "true column", false);
    text
}

/// Everything but the obstacles and the planner. The robot, the scanner and the ranges are those of the shipped surveys.
fn head(tank: &Tank, seed: u64, kind: &str) -> String {
    let [x, y] = [tank.anchor.x, tank.anchor.y];
    let (low, high) = tank.boundary.bounds();
    let reel_m = REEL_RATIO * 0.5 * (high - low).norm();
    format!(
        "name = \"own-map\"\nseed = {seed}\n\n[tank]\n{wall}\n\n[robot]\nmotion = \"unicycle\"\nstart_m = [{x}, {y}]\n\
         start_heading_deg = 90.0\nradius_m = {HULL_M}\nspeed_max_m_per_s = 0.4\nturn_rate_max_deg_per_s = 60.0\n\
         acceleration_m_per_s2 = 0.5\nsensing_range_m = 2.0\nslip_mean = 0.02\nslip_sigma = 0.01\n\
         odometry_sigma_ratio = 0.02\ngyro_bias_deg_per_s = 0.02\n\n[robot.scanner]\nrays = 360\nrange_m = 8.0\n\
         rate_hz = 5.0\nsigma_m = 0.02\nlost_share = 0.02\n\n[ae]\nperiod_s = 1.0\nrepetitions = 20\n\
         noise = {{ model = \"uniform\", ratio = 0.05 }}\nstations = [{stations}]\n\n[tether]\n\
         reel_length_m = {reel_m:.2}\nwrap_max_deg = 150.0\nwrap_total_max_deg = 270.0\n\n[mission]\n{kind}\n\
         clearance_m = {CLEARANCE_M}\ntime_limit_s = 14400.0\nposition_limit_m = 0.3\n{swath}\n",
        wall = wall(&tank.boundary),
        stations = stations(&tank.boundary),
        swath = if kind.contains("cover") {
            format!("swath_m = {SWATH_M}\noverlap_m = {OVERLAP_M}\n")
        } else {
            String::new()
        },
    )
}

fn wall(boundary: &Boundary) -> String {
    match boundary {
        Boundary::Circle { radius_m } => format!("radius_m = {radius_m}"),
        Boundary::Polygon { vertices } => {
            let corners: Vec<String> = vertices.iter().map(|at| format!("[{}, {}]", at.x, at.y)).collect();
            format!("vertices_m = [{}]", corners.join(", "))
        }
    }
}

fn stations(boundary: &Boundary) -> String {
    let station = |k: usize| {
        let (sin, cos) = (TAU * k as f64 / STATIONS as f64).sin_cos();
        let from_center_m = match boundary {
            Boundary::Circle { radius_m } => *radius_m,
            Boundary::Polygon { .. } => boundary.bounds().1.x / sin.abs().max(cos.abs()),
        } - OFF_WALL_M;
        format!("{{ name = \"S{k}\", at_m = [{:.4}, {:.4}] }}", from_center_m * cos, from_center_m * sin)
    };
    (0..STATIONS).map(station).collect::<Vec<_>>().join(", ")
}

fn columns(text: &mut String, tank: &Tank, name: &str, known: bool) {
    for (n, (center, radius_m)) in tank.columns.iter().enumerate() {
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "\n[[obstacles]]\nname = \"{name} {}\"\nkind = \"circle\"\ncenter_m = [{}, {}]\nradius_m = {radius_m}\n\
             known = {known}\n",
            n + 1,
            center.x,
            center.y
        );
    }
}
