//! Creates the scenario of a re-scan.

use mission::RunOpened;
use std::collections::BTreeSet;
use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, TableLike, TomlError, Value, value};
use world::{ObstacleId, Point, Shape, Zone};

/// A run that a re-scan continues.
#[derive(Debug, Clone, Copy)]
pub struct Continued<'a> {
    /// The name of its folder.
    pub name: &'a str,
    /// The SHA-256 of the run's journal, in hexadecimal. A report uses it to verify that both runs are of the same
    /// floor.
    pub journal_sha256: &'a str,
    /// Mission time at its end, seconds.
    pub ended_s: f64,
}

/// Faults of the simulated tether that happened in one run, and are not planned for its re-scan.
const FAULTS: [&str; 3] = ["reel_fails_at_s", "breaks_at_s", "breaks_at_n"];

/// The keys of the scenario of a past run that its re-scan leaves out because they describe faults of that run, with their
/// section: `tether.breaks_at_s`.
pub fn left_out_of_rescan(scenario_toml: &str) -> Vec<String> {
    let Ok(document) = foreign::plain_lines(scenario_toml).parse::<DocumentMut>() else { return Vec::new() };
    let tether = document.get("tether").and_then(Item::as_table_like);
    let given = |key: &&&str| tether.is_some_and(|tether| tether.contains_key(key));
    FAULTS.iter().filter(given).map(|key| format!("tether.{key}")).collect()
}

/// Changes the scenario of a past run into a mission that scans these boxes, each given by its south-west and
/// north-east corners in metres. Obstacles that were found and zones that were drawn during the run become part of the
/// drawing. `runs` are the runs that missed the areas in the boxes, the last one last. Faults of the simulated tether are left
/// out ([`left_out_of_rescan`]). Faults of stations go on where the last run ended: a station that was wrong then is wrong from
/// the start.
///
/// # Errors
/// The scenario of the run cannot be parsed because its journal was changed.
pub fn rescan(
    opened: &RunOpened,
    runs: &[Continued<'_>],
    boxes: &[[Point; 2]],
    found: &BTreeSet<ObstacleId>,
    drawn: &[Zone],
) -> Result<String, TomlError> {
    // Journals written by other programs may contain names that are not allowed in a scenario.
    let mut document: DocumentMut = foreign::plain_lines(&opened.scenario_toml).parse()?;
    let first_name = opened.scenario.strip_suffix("-rescan").unwrap_or(&opened.scenario);
    document["name"] = value(format!("{first_name}-rescan"));
    let names: Vec<&str> = runs.iter().map(|run| run.name).collect();
    document["about"] =
        value(foreign::plain(&format!("Areas missed by {}", names.join(" and "))).into_owned());
    document["continues_sha256"] = value(runs.iter().map(|run| run.journal_sha256).collect::<Array>());
    document.remove("expect");
    let start = opened.mission.start;
    if document.get("robot").is_none() {
        document["robot"] = Item::Table(Table::new());
    }
    document["robot"]["start_m"] = pair(start.position.x, start.position.y);
    let mission = &mut document["mission"];
    for key in ["spiral", "path_m", "goal_m"] {
        mission.as_table_like_mut().and_then(|table| table.remove(key));
    }
    mission["kind"] = value("cover");
    mission["boxes_m"] = value(boxes.iter().map(numbers).collect::<Array>());
    if let Some(tether) = document.get_mut("tether").and_then(Item::as_table_like_mut) {
        for key in FAULTS {
            tether.remove(key);
        }
    }
    continue_station_faults(&mut document, runs.last().map_or(0.0, |run| run.ended_s));
    put_on_drawing(&mut document, found);
    for zone in drawn {
        add_zone(&mut document, zone);
    }
    Ok(document.to_string())
}

/// Moves the faults of stations by the duration of the last run, seconds. Those that were over are removed.
fn continue_station_faults(document: &mut DocumentMut, ended_s: f64) {
    let lasts = |table: &mut dyn TableLike| {
        let later = |table: &dyn TableLike, key: &str| {
            let number =
                table.get(key).and_then(|item| item.as_float().or(item.as_integer().map(|n| n as f64)));
            number.map(|t_s| (t_s - ended_s).max(0.0))
        };
        let [from_s, to_s] = ["from_s", "to_s"].map(|key| later(table, key));
        for (key, t_s) in [("from_s", from_s), ("to_s", to_s)] {
            if let Some(t_s) = t_s {
                table.insert(key, value(t_s));
            }
        }
        to_s.is_none_or(|to_s| to_s > 0.0)
    };
    let ae = document.get_mut("ae").and_then(Item::as_table_like_mut);
    match ae.and_then(|ae| ae.get_mut("faults")) {
        Some(Item::ArrayOfTables(tables)) => {
            let are_over: Vec<bool> = tables.iter_mut().map(|table| !lasts(table)).collect();
            for index in (0..are_over.len()).rev().filter(|index| are_over[*index]) {
                tables.remove(index);
            }
        }
        Some(Item::Value(Value::Array(list))) => {
            let is_over = |one: &mut Value| one.as_inline_table_mut().is_some_and(|table| !lasts(table));
            let are_over: Vec<bool> = list.iter_mut().map(is_over).collect();
            for index in (0..are_over.len()).rev().filter(|index| are_over[*index]) {
                list.remove(index);
            }
        }
        _ => {}
    }
}

/// Marks as known those obstacles in the scenario that were found.
fn put_on_drawing(document: &mut DocumentMut, found: &BTreeSet<ObstacleId>) {
    let know = |index: usize, table: &mut dyn TableLike| {
        // Obstacles are numbered from 1 in the order of the file.
        if found.contains(&ObstacleId(index as u32 + 1)) {
            table.remove("known");
        }
    };
    match document.get_mut("obstacles") {
        Some(Item::ArrayOfTables(tables)) => {
            tables.iter_mut().enumerate().for_each(|(index, table)| know(index, table));
        }
        Some(Item::Value(Value::Array(list))) => {
            let tables = list.iter_mut().map(Value::as_inline_table_mut).enumerate();
            tables.for_each(|(index, table)| {
                if let Some(table) = table {
                    know(index, table);
                }
            });
        }
        _ => {}
    }
}

/// Adds a zone to the scenario's zones, in whichever syntax these are written.
fn add_zone(document: &mut DocumentMut, zone: &Zone) {
    let Shape::Polygon { vertices } = &zone.shape else { return };
    let corners: Array = vertices.iter().map(|p| Value::Array([p.x, p.y].into_iter().collect())).collect();
    let mut table = Table::new();
    table["name"] = value(&zone.name);
    table["kind"] = value("no_go");
    table["shape"] = value("polygon");
    table["vertices_m"] = value(corners);
    match document.entry("zones").or_insert(Item::ArrayOfTables(ArrayOfTables::new())) {
        Item::ArrayOfTables(tables) => tables.push(table),
        Item::Value(Value::Array(list)) => list.push(table.into_inline_table()),
        _ => {}
    }
}

pub(crate) fn pair(x: f64, y: f64) -> Item {
    value([x, y].into_iter().collect::<Array>())
}

/// West, south, east and north, rounded to millimetres.
fn numbers([low, high]: &[Point; 2]) -> Value {
    let rounded = |number: f64| (number * 1000.0).round() / 1000.0;
    Value::Array([low.x, low.y, high.x, high.y].map(rounded).into_iter().collect())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn faults_of_stations_go_on_where_the_last_run_ended() {
        let text = "[ae]\nfaults = [{ station = \"A\", from_s = 600, to_s = 7200.0 }, { station = \"B\", from_s = 1, to_s = 9 }]\n";
        for text in
            [text, "[[ae.faults]]\nfrom_s = 600.0\nto_s = 7200\n[[ae.faults]]\nfrom_s = 1\nto_s = 9\n"]
        {
            let mut document: DocumentMut = text.parse().unwrap();
            continue_station_faults(&mut document, 1000.0);
            let after = document.to_string();
            assert!(after.contains("from_s = 0.0") && after.contains("to_s = 6200.0"), "{after}");
            assert!(!after.contains("to_s = 9") && after.matches("to_s").count() == 1, "{after}");
        }
    }

    #[test]
    fn faults_of_the_tether_in_the_old_run_are_named() {
        let text = "[tether]\nmodel = \"physical\"\nbreaks_at_s = 200.0\nreel_fails_at_s = 9.0\n";
        assert_eq!(left_out_of_rescan(text), ["tether.reel_fails_at_s", "tether.breaks_at_s"]);
        assert_eq!(left_out_of_rescan("tether = { breaks_at_n = 40.0 }"), ["tether.breaks_at_n"]);
        assert!(left_out_of_rescan("[tether]\nfriction = 0.3\n").is_empty());
    }
}
