//! Creates the scenario of a coverage mission on a floor that a survey has mapped.

use crate::rescan::pair;
use exploration::{Column, SurveyMap};
use mission::RunOpened;
use thiserror::Error;
use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, TomlError, Value, value};
use world::{Point, Shape, Vector, coverage::percent_text, shape::convex_hull};

/// Width of a scanned pass and overlap of the passes, metres, for a survey whose scenario states none; and the speed,
/// metres per second, from which the time limit is estimated.
const SWATH_M: f64 = 0.6;
const OVERLAP_M: f64 = 0.1;
const PACE_M_PER_S: f64 = 0.1;

/// The reason why a map gives no scenario.
#[derive(Debug, Error)]
pub enum MapError {
    /// The journal was changed.
    #[error("the scenario in the journal is damaged: {0}")]
    Damaged(#[from] TomlError),
    /// The scenario would treat floor that the survey did not see as free floor.
    #[error(
        "{all_m2:.1} m² of floor beside the way of the robot were not seen, the largest part ({part_m2:.1} m²) around \
         {}, {} m; a scenario would treat them as free floor. Write the map with the suffix .yaml, where floor \
         that was not seen is solid, or survey again",
        tenth(*x), tenth(*y)
    )]
    Unseen {
        /// Area that was not seen, square metres.
        all_m2: f64,
        /// Area of the largest part, square metres.
        part_m2: f64,
        /// The middle of the largest part, metres.
        x: f64,
        /// The same.
        y: f64,
    },
}

/// Changes the scenario of a survey into a mission that scans the mapped floor with a planner. The columns on the map
/// are the drawing, with their numbers in the log of the survey; comments state their standard deviations. `run` is the name of
/// the survey's run.
///
/// # Errors
/// The scenario of the run cannot be parsed because its journal was changed, or the robot could drive onto floor that the
/// survey has not seen.
pub fn cover_of_map(
    opened: &RunOpened,
    run: &str,
    (map, numbers): (&SurveyMap, &[usize]),
    planner: &str,
) -> Result<String, MapError> {
    let unseen = map.unseen(&opened.world.boundary, opened.mission.limits.radius_m);
    if let Some(part) = unseen.first() {
        let all_m2 = unseen.iter().map(|part| part.area_m2).sum();
        let (x, y) = (part.middle.x, part.middle.y);
        return Err(MapError::Unseen { all_m2, part_m2: part.area_m2, x, y });
    }
    // Journals written by other programs may contain names that are not allowed in a scenario.
    let mut document: DocumentMut = foreign::plain_lines(&opened.scenario_toml).parse()?;
    document["name"] = value(format!("{}-map", opened.scenario));
    document["about"] = value(foreign::plain(&format!("The floor that {run} mapped")).into_owned());
    for key in ["expect", "obstacles", "random_obstacles"] {
        document.remove(key);
    }
    if let Some((mut first, _)) = document.as_table_mut().iter_mut().next() {
        first.leaf_decor_mut().set_prefix(head(&foreign::plain(run), map));
    }
    let mut obstacles = ArrayOfTables::new();
    let mut columns: Vec<(usize, &Column)> = numbers.iter().copied().zip(&map.columns).collect();
    columns.sort_by_key(|(number, _)| *number);
    for (number, column) in columns {
        obstacles.push(of_column(number, column));
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

/// The comment at the top of the scenario.
fn head(run: &str, map: &SurveyMap) -> String {
    format!(
        "# A scan of the floor that {run} has mapped: {} % of the floor was seen. Before you use it, add no-go zones and\n\
         # plates, and check swath_m and overlap_m in [mission].\n#\n\
         # Every key is explained in console/docs/scenario-format.md.\n\n",
        percent_text(map.explored, 1)
    )
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
            // Rounding may move a corner inwards, or onto the line between its neighbours.
            let corners: Vec<Point> =
                vertices.iter().map(|at| Point::new(rounded(at.x), rounded(at.y))).collect();
            let hull = convex_hull(&corners);
            if hull.len() < 3 {
                return of_shape(number, &around(vertices));
            }
            let corner = |at: &Point| Value::Array([at.x, at.y].into_iter().collect());
            table["kind"] = value("polygon");
            table["vertices_m"] = value(hull.iter().map(corner).collect::<Array>());
        }
        // A survey finds no lines.
        Shape::Polyline { .. } => return None,
    }
    Some(table)
}

/// A disc around an object that is too small for an outline in millimetres.
fn around(vertices: &[Point]) -> Shape {
    let sum: Vector = vertices.iter().map(|at| at.coords).sum();
    let center = Point::from(sum / vertices.len().max(1) as f64);
    let radius_m = vertices.iter().map(|at| (at - center).norm()).fold(0.01, f64::max);
    Shape::Disc { center, radius_m }
}

/// A coordinate to a tenth of a metre; zero is never negative.
fn tenth(m: f64) -> String {
    format!("{:.1}", (m * 10.0).round() / 10.0 + 0.0)
}

/// Rounded to millimetres.
fn rounded(number: f64) -> f64 {
    (number * 1000.0).round() / 1000.0 + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use world::shape::reflex_corners;

    proptest! {
        /// Corners a few millimetres from a line, as scans of a straight edge give them.
        #[test]
        fn outlines_stay_convex_in_millimetres(
            offs in prop::collection::vec((0.0..1.0_f64, 0.0..0.003_f64), 3..40),
            turn_rad in 0.0..6.3_f64,
        ) {
            let turned = |(x, y): &(f64, f64)| nalgebra::Rotation2::new(turn_rad) * Point::new(*x, *y);
            let vertices = convex_hull(&offs.iter().map(turned).collect::<Vec<_>>());
            prop_assume!(vertices.len() >= 3);
            let table = of_shape(1, &Shape::Polygon { vertices }).unwrap();
            if table["kind"].as_str() == Some("polygon") {
                let corners = table["vertices_m"].as_array().unwrap().iter().map(|corner| {
                    let at = |k: usize| corner.as_array().unwrap().get(k).unwrap().as_float().unwrap();
                    Point::new(at(0), at(1))
                });
                let corners: Vec<Point> = corners.collect();
                prop_assert_eq!(reflex_corners(&corners).count(), 0);
            }
        }
    }
}
