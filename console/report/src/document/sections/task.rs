//! The report on a run whose task was not to scan: the task and how well it was carried out.

use super::{
    super::{
        model::Document,
        page::{Block, Section, Share, Table, Value, Verdict, per_cent, picture, section},
        task::TaskPart,
        words::number,
    },
    closing, floor, runs, survey,
};
use account::{Tracking, clock};
use mission::Outcome;

/// The sections in order; [`super::super::words::number_of`] gives their numbers.
pub(super) fn sections(document: &Document, task: &TaskPart) -> Vec<Section> {
    vec![
        section("Scope", scope(document, task)),
        Section { is_new_sheet: true, ..section("Task", figures(document, task)) },
        section("Position accuracy", floor::accuracy(document)),
        section("Track, tether and record", runs::runs(document)),
        section("Equipment and calibration", closing::equipment(document)),
        section("Limitations", closing::limitations(document)),
        section("Gate before signing", closing::gate(document)),
        section("Signatures and revisions", closing::signatures(document)),
        section("Provenance", closing::provenance(document)),
    ]
}

/// The verdict.
pub(super) fn verdict(document: &Document, task: &TaskPart) -> Verdict {
    let run = document.runs.last();
    let outcome = run.and_then(|run| run.outcome);
    let what = task.words();
    let lead = match outcome {
        Some(Outcome::Complete) => format!("The task is complete: {what}."),
        Some(other) => {
            format!("Not complete: {what}. The mission ended ({}).", other.word().replace('_', " "))
        }
        None => format!("Not complete: {what}. The journal stops before the end of the mission."),
    };
    let is_complete = outcome == Some(Outcome::Complete);
    let reason = run.and_then(|run| run.reason.clone()).filter(|_| !is_complete);
    Verdict {
        class: if is_complete { "" } else { "bad" },
        lead: lead + " Scanning the floor was not part of this mission, so no floor counts as missed.",
        cause: reason.map(|reason| format!("Cause: {reason}.")).unwrap_or_default(),
    }
}

/// The large figures of the first sheet.
pub(super) fn shares(document: &Document, task: &TaskPart) -> Vec<Share> {
    let figure =
        |value: String, unit: &'static str, of: &'static str, about: String| Share { value, unit, of, about };
    match task {
        TaskPart::Follow { tracking: Some(tracking), .. } => {
            let near_m = Tracking::NEAR_M;
            vec![
                figure(
                    per_cent(tracking.precision),
                    "%",
                    "precision",
                    format!("of the driven path within {near_m} m of the preset path"),
                ),
                figure(
                    per_cent(tracking.recall),
                    "%",
                    "recall",
                    format!("of the preset points within {near_m} m of the driven path"),
                ),
                figure(
                    number(tracking.cross_track_rmse_m, 3),
                    "m",
                    "RMS error",
                    "cross-track: from the preset path to the driven path".into(),
                ),
            ]
        }
        TaskPart::Follow { .. } | TaskPart::Survey { map: None } => Vec::new(),
        TaskPart::Survey { map: Some(map) } => survey::shares(map),
        TaskPart::Goto { left_m, left_true_m, tolerance_m, .. } => {
            let run = document.runs.last();
            let by = if left_true_m.is_some() {
                "according to the true position"
            } else {
                "according to the estimated \
                position"
            };
            let left = left_true_m.or(*left_m).map(|m| {
                figure(
                    number(m, 2),
                    "m",
                    "to the goal at the end",
                    format!("{by}; counts as reached within {tolerance_m} m"),
                )
            });
            let path = run
                .and_then(|run| run.path_length_m)
                .map(|m| figure(number(m, 1), "m", "path", "driven, according to the true position".into()));
            let time = run.map(|run| {
                figure(number(run.mission_time_s, 1), "s", "mission time", clock(run.mission_time_s))
            });
            left.into_iter().chain(path).chain(time).collect()
        }
    }
}

/// The scope of the mission and the terms of the report.
fn scope(document: &Document, task: &TaskPart) -> Vec<Block> {
    let run = document.runs.first().map_or("", |run| run.run.as_str());
    vec![Block::Text(format!(
        "Scenario {}: {}. Based on 1 run: {run}. Scanning the floor was not part of the mission, so no \
         floor counts as missed, and no coverage is claimed.",
        document.scenario,
        task.words()
    ))]
}

/// The figures of the task, and the map.
fn figures(document: &Document, task: &TaskPart) -> Vec<Block> {
    let rows = rows(document, task).into_iter().map(|(name, value, note)| [name.to_owned(), value, note]);
    let rows: Vec<[String; 3]> = rows.collect();
    if let TaskPart::Survey { map } = task {
        return survey::blocks(document, map.as_ref(), rows);
    }
    vec![Block::Table(figures_table(rows)), Block::Wide(picture(&document.pictures.coverage))]
}

/// The table of figures: name, value and note.
pub(super) fn figures_table(rows: Vec<[String; 3]>) -> Table {
    let mut table =
        Table::new("Figures of the task", &[("Figure", "", ""), ("Value", "", "r nw"), ("", "", "full")]);
    for row in rows {
        table.row(row.map(Value::from).into());
    }
    table
}

fn rows(document: &Document, task: &TaskPart) -> Vec<(&'static str, String, String)> {
    let metres = |m: f64, decimals: usize| format!("{} m", number(m, decimals));
    let none = String::new;
    let mut rows = match task {
        TaskPart::Goto { goal, tolerance_m, straight_m, left_m, left_true_m } => vec![
            (
                "Goal",
                format!("{}, {} m", number(goal.x, 2), number(goal.y, 2)),
                format!("counts as reached within {tolerance_m} m"),
            ),
            ("Straight line from start to goal", metres(*straight_m, 2), none()),
            (
                "Distance to the goal at the end",
                left_m.map_or_else(none, |m| metres(m, 3)),
                "according to the estimated position".into(),
            ),
            (
                "Distance to the goal at the end",
                left_true_m.map_or_else(none, |m| metres(m, 3)),
                "according to the true position; simulation only".into(),
            ),
        ],
        TaskPart::Follow { preset_m, points, tracking } => {
            let mut rows = vec![("Preset path", metres(*preset_m, 2), format!("{points} points"))];
            if let Some(tracking) = tracking {
                let near_m = Tracking::NEAR_M;
                rows.push((
                    "Precision",
                    format!("{} %", per_cent(tracking.precision)),
                    format!("of the driven path within {near_m} m of the preset path"),
                ));
                rows.push((
                    "Recall",
                    format!("{} %", per_cent(tracking.recall)),
                    format!("of the preset points within {near_m} m of the driven path"),
                ));
                rows.push((
                    "RMS error, cross-track",
                    metres(tracking.cross_track_rmse_m, 3),
                    "from the preset path".into(),
                ));
                rows.extend(tracking.rmse_m.map(|m| {
                    ("RMS error", metres(m, 3), "from the preset points, in their order".to_owned())
                }));
            }
            rows
        }
        TaskPart::Survey { map: None } => Vec::new(),
        TaskPart::Survey { map: Some(map) } => {
            let seen = format!("{} %", per_cent(map.explored));
            let mut rows = vec![
                (
                    "Floor explored",
                    seen,
                    "of the floor within the wall; the inside of a column is never seen".into(),
                ),
                ("Columns on the map", map.columns.len().to_string(), none()),
                (
                    "Other objects on the map",
                    map.objects.to_string(),
                    "outlines; a long object has several".into(),
                ),
            ];
            if map.beyond_tether > 0 {
                let n = map.beyond_tether.to_string();
                rows.push(("Places not seen", n, "the tether does not reach them".into()));
            }
            rows
        }
    };
    if let Some(run) = document.runs.last() {
        rows.extend(
            run.path_length_m.map(|m| {
                ("Path", metres(m, 2), "according to the true position; simulation only".to_owned())
            }),
        );
        rows.push((
            "Mission time",
            format!("{} s", number(run.mission_time_s, 1)),
            clock(run.mission_time_s),
        ));
        rows.extend(
            run.clearance_min_m
                .map(|m| ("Minimum clearance", metres(m, 3), format!("required: {} m", run.clearance_m))),
        );
        rows.extend(run.collisions.map(|n| ("Collisions", n.to_string(), none())));
    }
    rows.retain(|(_, value, _)| !value.is_empty());
    rows
}
