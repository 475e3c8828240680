//! Creates the scenario of a coverage mission on a floor that a survey has mapped.

use crate::rescan::pair;
use exploration::{Column, SurveyMap};
use mission::RunOpened;
use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, TomlError, Value, value};
use world::{Point, Shape};

/// Width of a scanned pass and overlap of the passes, metres, for a survey whose scenario states none; and the speed,
/// metres per second, from which the time limit is estimated.
const SWATH_M: f64 = 0.6;
const OVERLAP_M: f64 = 0.1;
const PACE_M_PER_S: f64 = 0.1;

/// Changes the scenario of a survey into a mission that scans the mapped floor with a planner. The columns on the map
/// are the drawing; comments state their standard deviations. `run` is the name of the survey's run.
///
/// # Errors
/// The scenario of the run cannot be parsed because its journal was changed.
pub fn cover_of_map(
    opened: &RunOpened,
    run: &str,
    map: &SurveyMap,
    planner: &str,
) -> Result<String, TomlError> {
    // Journals written by other programs may contain names that are not allowed in a scenario.
    let mut document: DocumentMut = foreign::plain_lines(&opened.scenario_toml).parse()?;
    document["name"] = value(format!("{}-map", opened.scenario));
    document["about"] = value(foreign::plain(&format!("The floor that {run} mapped")).into_owned());
    for key in ["expect", "obstacles", "random_obstacles"] {
        document.remove(key);
    }
    let mut obstacles = ArrayOfTables::new();
    for (n, column) in map.columns.iter().enumerate() {
        obstacles.push(of_column(n + 1, column));
    }
    for (n, shape) in map.others.iter().enumerate() {
        obstacles.extend(of_shape(n + 1, shape));
    }
    if !obstacles.is_empty() {
        document["obstacles"] = Item::ArrayOfTables(obstacles);
    }
    let mission = &mut document["mission"];
    mission["kind"] = value("cover");
    if mission.get("swath_m").is_none() {
        mission["swath_m"] = value(SWATH_M);
        mission["overlap_m"] = value(OVERLAP_M);
    }
    let seconds = (opened.world.boundary.area_m2() / (SWATH_M * PACE_M_PER_S)).ceil();
    mission["time_limit_s"] = value(opened.mission.time_limit_s.max(seconds));
    let mut planners = Table::new();
    planners["id"] = value(planner);
    document["planner"] = Item::Table(planners);
    Ok(document.to_string())
}

fn of_column(number: usize, column: &Column) -> Table {
    let mut table = Table::new();
    let (center_m, radius_m) = (rounded(column.center_sigma_m), rounded(column.radius_sigma_m));
    table
        .decor_mut()
        .set_prefix(format!("\n# Standard deviations: centre +- {center_m} m, radius +- {radius_m} m.\n"));
    table["name"] = value(format!("column {number}"));
    table["kind"] = value("circle");
    table["center_m"] = pair(rounded(column.center.x), rounded(column.center.y));
    table["radius_m"] = value(rounded(column.radius_m));
    table
}

fn of_shape(number: usize, shape: &Shape) -> Option<Table> {
    let mut table = Table::new();
    table.decor_mut().set_prefix("\n");
    table["name"] = value(format!("object {number}"));
    match shape {
        Shape::Disc { center, radius_m } => {
            table["kind"] = value("circle");
            table["center_m"] = pair(rounded(center.x), rounded(center.y));
            table["radius_m"] = value(rounded(*radius_m));
        }
        Shape::Polygon { vertices } => {
            let corner = |at: &Point| Value::Array([rounded(at.x), rounded(at.y)].into_iter().collect());
            table["kind"] = value("polygon");
            table["vertices_m"] = value(vertices.iter().map(corner).collect::<Array>());
        }
        // A survey finds no lines.
        Shape::Polyline { .. } => return None,
    }
    Some(table)
}

/// Rounded to millimetres.
fn rounded(number: f64) -> f64 {
    (number * 1000.0).round() / 1000.0 + 0.0
}
