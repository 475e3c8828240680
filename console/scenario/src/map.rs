//! `tank.map`: an occupancy map put into the text of a scenario as wall and obstacles.
//!
//! As with settings from the command line, the changed text alone gives the same scenario again: a journal needs no map
//! file. The wall is the rectangle around the free cells; what is solid within it becomes rectangles.

use super::{
    occupancy::OccupancyMap,
    problem::{Complaint, Problem, ScenarioErrors},
};
use std::{fmt::Write, ops::Range, path::Path};
use toml::de::DeTable;
use world::Point;

/// Cells from a first to one before a last, along x and y.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Rectangle {
    x: Range<usize>,
    y: Range<usize>,
}

/// The text with its map, if it names one, as wall and obstacles; `folder` is where the scenario lies.
///
/// # Errors
/// The map cannot be read, shows no free floor, or gives more obstacles than a scenario may have.
pub(crate) fn put_in(text: &str, shown_name: &str, folder: &Path) -> Result<String, ScenarioErrors> {
    let Ok(table) = DeTable::parse(text) else { return Ok(text.to_owned()) };
    let tank = table.get_ref().get("tank").and_then(|tank| tank.get_ref().as_table());
    let Some((key, value)) = tank.and_then(|tank| tank.get_key_value("map")) else {
        return Ok(text.to_owned());
    };
    // What is no text is left to the reader of the schema.
    let Some(file) = value.get_ref().as_str() else { return Ok(text.to_owned()) };
    let wrong = |what: String| ScenarioErrors {
        shown_name: shown_name.to_owned(),
        text: text.to_owned(),
        problems: vec![Problem {
            key: "tank.map".into(),
            value: Some(format!("\"{file}\"")),
            at: Some(value.span()),
            what: Complaint::Map(what),
        }],
    };
    let map = OccupancyMap::read(&folder.join(file)).map_err(|error| wrong(error.to_string()))?;
    let (wall, solid) = rectangles(&map).ok_or_else(|| wrong("shows no free floor".into()))?;
    if solid.len() > MOST_OBSTACLES {
        let what = format!(
            "{} rectangles of solid cells; at most {MOST_OBSTACLES} obstacles: smooth the map or make its cells coarser",
            solid.len()
        );
        return Err(wrong(what));
    }
    let (before, after) = (&text[..key.span().start], &text[value.span().end..]);
    let mut changed = format!("{before}vertices_m = {}{after}\n", corners(&map, &wall));
    for (index, rectangle) in solid.iter().enumerate() {
        let corners = corners(&map, rectangle);
        // Writing to a String cannot fail.
        let _ = writeln!(
            changed,
            "\n[[obstacles]]\nname = \"map {}\"\nkind = \"polygon\"\nvertices_m = {corners}",
            index + 1
        );
    }
    Ok(changed)
}

/// As many obstacles as a scenario may have.
const MOST_OBSTACLES: usize = 1000;

/// The rectangle around the free cells, and rectangles that cover what is solid within it.
fn rectangles(map: &OccupancyMap) -> Option<(Rectangle, Vec<Rectangle>)> {
    let free = || (0..map.is_solid.len()).filter(|cell| !map.is_solid[*cell]);
    let (x, y) = (|cell: usize| cell % map.columns, |cell: usize| cell / map.columns);
    let wall = Rectangle {
        x: free().map(x).min()?..free().map(x).max()? + 1,
        y: free().map(y).min()?..free().map(y).max()? + 1,
    };
    let mut done: Vec<Rectangle> = Vec::new();
    let mut open: Vec<Rectangle> = Vec::new();
    for row in wall.y.clone() {
        let runs = runs(map, &wall.x, row);
        // A run as wide as the one below it goes on with it.
        let (going_on, ended): (Vec<Rectangle>, Vec<Rectangle>) =
            open.into_iter().partition(|rectangle| runs.contains(&rectangle.x));
        done.extend(ended);
        let fresh = runs.iter().filter(|run| going_on.iter().all(|rectangle| rectangle.x != **run));
        let fresh: Vec<Rectangle> = fresh.map(|run| Rectangle { x: run.clone(), y: row..row + 1 }).collect();
        let longer = going_on.into_iter().map(|r| Rectangle { y: r.y.start..row + 1, ..r });
        open = longer.chain(fresh).collect();
    }
    done.extend(open);
    Some((wall, done))
}

/// Runs of solid cells in a row.
fn runs(map: &OccupancyMap, x: &Range<usize>, row: usize) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for column in x.clone().filter(|column| map.is_solid[row * map.columns + column]) {
        match runs.last_mut() {
            Some(run) if run.end == column => run.end += 1,
            _ => runs.push(column..column + 1),
        }
    }
    runs
}

/// Corners of a rectangle as TOML, counter-clockwise, to the tenth of a millimetre.
fn corners(map: &OccupancyMap, rectangle: &Rectangle) -> String {
    let corner = |column: usize, row: usize| {
        let at: Point = map.origin + world::Vector::new(column as f64, row as f64) * map.cell_m;
        format!("[{:.4}, {:.4}]", at.x, at.y)
    };
    let Rectangle { x, y } = rectangle;
    let corners =
        [(x.start, y.start), (x.end, y.start), (x.end, y.end), (x.start, y.end)].map(|(x, y)| corner(x, y));
    format!("[{}]", corners.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(rows: &[&str]) -> OccupancyMap {
        let is_solid = rows.iter().rev().flat_map(|row| row.chars().map(|c| c == '#')).collect();
        OccupancyMap { columns: rows[0].len(), is_solid, cell_m: 0.5, origin: Point::new(-1.0, 0.0) }
    }

    #[test]
    fn runs_of_the_same_width_become_one_rectangle() {
        let map = drawn(&["######", "#....#", "#.##.#", "#.##.#", "#....#", "######"]);
        let (wall, solid) = rectangles(&map).unwrap();
        assert_eq!(wall, Rectangle { x: 1..5, y: 1..5 });
        assert_eq!(solid, [Rectangle { x: 2..4, y: 2..4 }]);
        assert_eq!(
            corners(&map, &solid[0]),
            "[[0.0000, 1.0000], [1.0000, 1.0000], [1.0000, 2.0000], [0.0000, 2.0000]]"
        );
    }

    #[test]
    fn every_solid_cell_is_covered_once_and_no_free_one() {
        let rows = ["..#...", ".###..", ".#.#.#", "##...#", "......"];
        let map = drawn(&rows);
        let (_, solid) = rectangles(&map).unwrap();
        for cell in 0..map.is_solid.len() {
            let (x, y) = (cell % 6, cell / 6);
            let n = solid.iter().filter(|r| r.x.contains(&x) && r.y.contains(&y)).count();
            assert_eq!(n, usize::from(map.is_solid[cell]), "{x} {y}");
        }
        assert!(rectangles(&drawn(&["##", "##"])).is_none());
    }

    #[test]
    fn a_map_that_cannot_be_read_is_reported_at_its_key() {
        let text = "name = \"x\"\n[tank]\nmap = \"no-such.yaml\"\n";
        let errors = put_in(text, "s.toml", Path::new("/nowhere")).unwrap_err();
        let message = errors.problems[0].to_string();
        assert!(
            message.starts_with("tank.map = \"no-such.yaml\": /nowhere/no-such.yaml: cannot be read"),
            "{message}"
        );
        assert_eq!(errors.problems[0].at, Some(24..38));
    }
}
