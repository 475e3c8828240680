//! `tank.map`: writes an occupancy map into the text of a scenario, as a wall and obstacles.
//!
//! The changed text alone reproduces the scenario, as with settings from the command line: a journal needs no map file.

use super::problem::{Complaint, Problem, ScenarioErrors};
use import::{MapFloor, OccupancyMap, plan::points};
use std::{fmt::Write, ops::Range, path::Path};
use toml::de::{DeTable, DeValue};
use toml_edit::{DocumentMut, Value, value};
use world::{Boundary, Point};

/// If a text names a map, replaces it with a wall and obstacles; `folder` is the folder of the scenario.
///
/// # Errors
/// The map cannot be read, or has no free floor.
pub(crate) fn put_in(text: &str, shown_name: &str, folder: &Path) -> Result<String, ScenarioErrors> {
    let (Ok(table), Ok(mut document)) = (DeTable::parse(text), text.parse::<DocumentMut>()) else {
        return Ok(text.to_owned());
    };
    let tank = table.get_ref().get("tank").and_then(|tank| tank.get_ref().as_table());
    let Some((tank, named)) = tank.and_then(|tank| Some((tank, tank.get("map")?))) else {
        return Ok(text.to_owned());
    };
    // The schema check reports values of the wrong type.
    let Some(file) = named.get_ref().as_str() else { return Ok(text.to_owned()) };
    let tolerance = tank.get("map_tolerance_m");
    let tolerance_m = tolerance.and_then(|tolerance| number(tolerance.get_ref())).filter(|m| *m >= 0.0);
    if tolerance.is_some() && tolerance_m.is_none() {
        return Ok(text.to_owned());
    }
    let problem = |key: &str, at: Range<usize>, what: String| ScenarioErrors {
        shown_name: shown_name.to_owned(),
        text: text.to_owned(),
        problems: vec![Problem {
            key: key.into(),
            value: text.get(at.clone()).map(str::to_owned),
            at: Some(at),
            what: Complaint::Map(what),
        }],
    };
    let wrong = |what: String| problem("tank.map", named.span(), what);
    let map = OccupancyMap::read(&folder.join(file)).map_err(|error| wrong(error.to_string()))?;
    let floor = MapFloor::new(&map, start(table.get_ref()), tolerance_m);
    let floor = floor.ok_or_else(|| {
        let why = map.unseen.map(|unseen| format!("; {unseen}")).unwrap_or_default();
        wrong(format!("has no free floor{why}"))
    })?;
    let goal = table.get_ref().get("mission").and_then(|mission| mission.get_ref().get("goal_m"));
    if let Some(goal) = goal.filter(|goal| point(goal.get_ref()).is_some_and(|at| floor.is_cut_off(&map, at)))
    {
        let what =
            format!("is on free floor in {file}, but cannot be reached from the start; is a door closed?");
        return Err(problem("mission.goal_m", goal.span(), what));
    }
    let tank = document["tank"].as_table_like_mut().expect("the tank names a map");
    tank.remove("map_tolerance_m");
    tank.remove("map");
    let Boundary::Polygon { vertices } = &floor.wall else { panic!("the wall of a map is a rectangle") };
    let wall: Value = points(vertices).parse().expect("numbers in brackets are TOML");
    tank.insert("vertices_m", value(wall));
    let mut changed = document.to_string();
    if !changed.ends_with('\n') {
        changed.push('\n');
    }
    for (index, piece) in floor.pieces.iter().enumerate() {
        // Writing to a String cannot fail.
        let _ = writeln!(
            changed,
            "\n[[obstacles]]\nname = \"map {}\"\nkind = \"polygon\"\nvertices_m = {}",
            index + 1,
            points(piece)
        );
    }
    Ok(changed)
}

/// The start of the robot, if the text states it.
fn start(table: &DeTable<'_>) -> Option<Point> {
    let robot = || point(table.get("robot")?.get_ref().get("start_m")?.get_ref());
    let path = || point(table.get("mission")?.get_ref().get("path_m")?.get_ref().get(0)?.get_ref());
    robot().or_else(path)
}

fn point(value: &DeValue<'_>) -> Option<Point> {
    let [x, y] = &value.as_array()?[..] else { return None };
    Some(Point::new(number(x.get_ref())?, number(y.get_ref())?))
}

fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(written) => written.as_str().parse().ok(),
        DeValue::Integer(written) => written.as_str().parse().ok(),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_map_becomes_the_wall_and_obstacles_that_hold_the_start() {
        let dir = two_rooms();
        let text = "[robot]\nstart_m = [1.25, 0.75]\n[tank]\nmap_tolerance_m = 0\nmap = \"m.yaml\" # drawn\n";
        let changed = put_in(text, "s.toml", dir.path()).unwrap();
        assert_eq!(
            changed,
            "[robot]\nstart_m = [1.25, 0.75]\n[tank]\n\
             vertices_m = [[-0.5, 0.5], [1.5, 0.5], [1.5, 2], [-0.5, 2]]\n\n\
             [[obstacles]]\nname = \"map 1\"\nkind = \"polygon\"\nvertices_m = [[1, 1], [1, 1.5], [0, 1.5], [0, 1]]\n"
        );
        assert_eq!(put_in(&changed, "s.toml", dir.path()).unwrap(), changed);
    }

    /// A folder with a map of two rooms that nothing joins.
    fn two_rooms() -> tempfile::TempDir {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("m.yaml"), "image: m.pgm\nresolution: 0.5\norigin: [-1, 0, 0]\n").unwrap();
        let rows = "0 0 0 0 0 0 0 0\n0 9 9 9 9 0 9 0\n0 9 0 0 9 0 9 0\n0 9 9 9 9 0 0 0\n0 0 0 0 0 0 0 0\n";
        fs::write(dir.path().join("m.pgm"), format!("P2 8 5 9\n{rows}")).unwrap();
        dir
    }

    #[test]
    fn a_goal_behind_a_closed_door_is_reported_as_such() {
        let dir = two_rooms();
        let text = |goal: &str| {
            format!("[robot]\nstart_m = [1.25, 0.75]\n[mission]\ngoal_m = {goal}\n[tank]\nmap = \"m.yaml\"\n")
        };
        let errors = put_in(&text("[2.25, 1.25]"), "s.toml", dir.path()).unwrap_err();
        assert_eq!(
            errors.problems[0].to_string(),
            "mission.goal_m = [2.25, 1.25]: is on free floor in m.yaml, but cannot be reached from the start; is a door closed?"
        );
        assert!(put_in(&text("[-0.25, 0.75]"), "s.toml", dir.path()).is_ok());
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
