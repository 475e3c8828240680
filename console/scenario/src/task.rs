//! Reads the task and the planner: `[mission]` and `[planner]`.

use super::{problem::Complaint, section::Section};
use mission::{PlannerChoice, TaskConfig};
use world::{Boundary, Point, shape, spiral::Spiral};

/// The largest number of points of a path.
const MOST_POINTS: u64 = 200_000;

/// Slack for rounded numbers in files, in metres.
const ROUNDING_M: f64 = 1e-6;

/// The keys of `[mission]` that say nothing about a survey: where to drive, and how to scan.
const NOT_IN_A_SURVEY: [&str; 8] = [
    "spiral",
    "path_m",
    "goal_m",
    "boxes_m",
    "overlap_m",
    "scan_position_limit_m",
    "guarantee",
    "better_plan",
];

/// The name that stands in place of a planner's in a survey, in which the mission itself drives.
const SURVEY: &str = "survey";

/// Reads the task of `[mission]`. A preset path must leave room for the hull at the wall; a coverage mission ends at
/// `start`.
pub(crate) fn task(
    section: &Section<'_>,
    boundary: Option<&Boundary>,
    radius_m: Option<f64>,
    start: Option<Point>,
) -> Option<TaskConfig> {
    let kind = section.word("kind")?;
    let tolerance_m = section.number("tolerance_m");
    let beside = format!("kind = \"{kind}\"");
    if kind == "goto" {
        section.refuse(&["spiral", "path_m", "boxes_m"], &beside);
        section.require("goal_m", "add goal_m = [x, y], the point to drive to");
        return Some(TaskConfig::Goto { goal: section.point("goal_m")?, tolerance_m: tolerance_m? });
    }
    if kind == "cover" {
        section.refuse(&["spiral", "path_m", "goal_m"], &beside);
        let boxes = if section.has("boxes_m") { section.boxes("boxes_m")? } else { Vec::new() };
        complain_of_boxes_outside(section, boundary, &boxes);
        let regions = boxes.iter().map(|[low, high]| shape::rectangle(*low, *high)).collect();
        return Some(TaskConfig::Cover { anchor: start?, regions, tolerance_m: tolerance_m? });
    }
    if kind == "survey" {
        section.refuse(&NOT_IN_A_SURVEY, &beside);
        return Some(TaskConfig::Survey { anchor: start?, tolerance_m: tolerance_m? });
    }
    section.refuse(&["goal_m", "boxes_m"], &beside);
    let path = preset_path(section, boundary, radius_m)?;
    Some(TaskConfig::Follow { path, tolerance_m: tolerance_m? })
}

/// A box that contains no floor must be a typing error.
fn complain_of_boxes_outside(section: &Section<'_>, boundary: Option<&Boundary>, boxes: &[[Point; 2]]) {
    let outside = |[low, high]: &[Point; 2]| boundary.is_some_and(|wall| !wall.meets_box(*low, *high));
    if let Some(index) = boxes.iter().position(outside) {
        let must_be = format!("boxes that contain some of the floor; box {} is outside the tank", index + 1);
        section.complain("boxes_m", Complaint::OutOfRange(must_be));
    }
}

fn preset_path(
    section: &Section<'_>,
    boundary: Option<&Boundary>,
    radius_m: Option<f64>,
) -> Option<Vec<Point>> {
    let walls = boundary.zip(radius_m);
    if section.has("spiral") {
        section.refuse(&["path_m"], "spiral");
        return spiral(&section.table("spiral")?, walls);
    }
    let remedy = "add spiral = { outer_radius_m = ..., pitch_m = ... }, or path_m = [[x, y], ...]";
    if !section.has("path_m") {
        section.require("spiral or path_m", remedy);
        return None;
    }
    let path = section.points("path_m")?;
    if path.len() as u64 > MOST_POINTS {
        let points = path.len() as u64;
        section.complain("path_m", Complaint::TooManyPoints { points, limit: MOST_POINTS });
        return None;
    }
    complain_of_wall(section, "path_m", &path, walls);
    Some(path)
}

fn spiral(section: &Section<'_>, walls: Option<(&Boundary, f64)>) -> Option<Vec<Point>> {
    let (outer, inner) = (section.number("outer_radius_m"), section.number("inner_radius_m"));
    let (pitch, step_deg) = (section.number("pitch_m"), section.number("step_deg"));
    let (outer_radius_m, inner_radius_m, pitch_m, step_deg) = (outer?, inner?, pitch?, step_deg?);
    if inner_radius_m >= outer_radius_m {
        let must_be = format!("less than outer_radius_m, {outer_radius_m} m");
        section.complain("inner_radius_m", Complaint::OutOfRange(must_be));
        return None;
    }
    let points = ((outer_radius_m - inner_radius_m) / pitch_m * 360.0 / step_deg) as u64;
    if !(2..=MOST_POINTS).contains(&points) {
        let what = match points {
            0 | 1 => Complaint::OutOfRange(format!("less than {outer_radius_m} m, for at least one turn")),
            _ => Complaint::TooManyPoints { points, limit: MOST_POINTS },
        };
        section.complain("pitch_m", what);
        return None;
    }
    let path = Spiral { outer_radius_m, inner_radius_m, pitch_m, step_rad: step_deg.to_radians() }.points();
    if let Some((boundary, radius_m)) = walls {
        let fits_m = boundary.wall_distance_m(Point::origin()) - radius_m;
        let is_out = |point: &Point| boundary.wall_distance_m(*point) < radius_m - ROUNDING_M;
        if path.iter().any(is_out) {
            // Round down to millimetres, so that the suggested radius fits.
            let fits_m = ((fits_m * 1000.0 + 1e-6).floor() / 1000.0).max(0.0);
            section.complain("outer_radius_m", Complaint::SpiralTooLarge { fits_m });
        }
    }
    Some(path)
}

fn complain_of_wall(section: &Section<'_>, name: &str, path: &[Point], walls: Option<(&Boundary, f64)>) {
    let Some((boundary, radius_m)) = walls else { return };
    let lack_m = |point: &Point| radius_m - boundary.wall_distance_m(*point);
    if let Some((i, point)) = path.iter().enumerate().find(|(_, point)| lack_m(point) > ROUNDING_M) {
        let what = Complaint::PathInWall { number: i + 1, at: (point.x, point.y), by_m: lack_m(point) };
        section.complain(name, what);
    }
}

/// The planner of a mission, and the one that takes over after a fault. A survey has none.
pub(crate) fn planners(
    root: &Section<'_>,
    is_survey: bool,
) -> Option<(Option<PlannerChoice>, Option<PlannerChoice>)> {
    if is_survey {
        root.refuse(&["planner"], "mission.kind = \"survey\", because the mission itself drives");
        return Some((Some(PlannerChoice { id: SURVEY.into(), ..PlannerChoice::default() }), None));
    }
    root.table("planner").map(|section| (planner(&section), fallback(&section)))
}

/// Reads a planner's id and parameters, from `[planner]` or its fallback.
fn planner(section: &Section<'_>) -> Option<PlannerChoice> {
    let (id, parameters) = (section.slug("id"), section.parameters("parameters"));
    Some(PlannerChoice { id: id?, parameters: parameters? })
}

/// Reads the planner that takes over after a fault; `None` if there is none, or if it is invalid.
fn fallback(section: &Section<'_>) -> Option<PlannerChoice> {
    planner(&section.table("fallback")?)
}
