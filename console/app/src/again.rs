//! `tankops report` and `tankops rescan`: what a run scanned, and a mission for what it missed.

use crate::{
    cli::LogsArg,
    failure::{COMPLETE, bad_input},
    output::{say, say_line},
    run_folder,
    scenario::Scenario,
    verify::opened,
};
use anyhow::Context;
use mission::{Event, EventKind};
use recording::{JOURNAL_FILE, RECORDING_FILE, read_journal};
use report::{Fold, Logs, Summary, human, merged};
use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};
use toml_edit::{Array, DocumentMut, Item, Table, Value, value};

/// Boxes in a scenario for a re-scan; more are joined into coarser ones.
const MOST_BOXES: usize = 4000;

/// A past run, read again.
struct Past {
    name: String,
    logs: Logs,
    events: Vec<Event>,
    fold: Fold,
}

impl Past {
    fn read(run: &Path, logs: &LogsArg) -> anyhow::Result<Self> {
        let folder = run_folder::find(run, &logs.logs)?;
        let path = folder.join(JOURNAL_FILE);
        let journal =
            read_journal(&path).map_err(|error| bad_input(format!("{error}: {}", path.display())))?;
        opened(&journal.events)?;
        let mut fold = Fold::new();
        journal.events.iter().for_each(|event| fold.apply(event));
        let shown = |path: PathBuf| path.exists().then(|| path.display().to_string());
        Ok(Self {
            name: folder.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            logs: Logs { journal: shown(path), recording: shown(folder.join(RECORDING_FILE)), error: None },
            events: journal.events,
            fold,
        })
    }
}

/// `tankops report RUN...`.
pub fn report(
    runs: &[PathBuf],
    logs: &LogsArg,
    json: bool,
    output: Option<&Path>,
) -> anyhow::Result<ExitCode> {
    let mut past = runs.iter().map(|run| Past::read(run, logs)).collect::<anyhow::Result<Vec<_>>>()?;
    let text = if let [only] = &mut past[..] {
        one(only, json)?
    } else {
        let runs: Vec<_> = past.into_iter().map(|run| (run.name, run.logs, run.fold)).collect();
        let merged = merged(&runs).map_err(bad_input)?;
        if json { to_json(&merged)? } else { merged.human() }
    };
    match output {
        None => say(&text)?,
        Some(file) => fs::write(file, text).map_err(|error| {
            bad_input(format!("the report cannot be written: {error}: {}", file.display()))
        })?,
    }
    Ok(ExitCode::from(COMPLETE))
}

fn one(run: &mut Past, json: bool) -> anyhow::Result<String> {
    let scenario = scenario_of(run)?;
    let summary = Summary { logs: Some(run.logs.clone()), ..run.fold.summary() };
    let summary = scenario.expect.judged(summary);
    if json { to_json(&summary) } else { Ok(human(&summary)) }
}

fn to_json(what: &impl serde::Serialize) -> anyhow::Result<String> {
    Ok(serde_json::to_string_pretty(what).context("writing the report as JSON")? + "\n")
}

fn scenario_of(run: &Past) -> anyhow::Result<Scenario> {
    let text = &opened(&run.events)?.scenario_toml;
    Scenario::parse(text, "the scenario in the journal").map_err(|errors| bad_input(errors.render()))
}

/// `tankops rescan RUN -o SCENARIO`.
pub fn rescan(run: &Path, logs: &LogsArg, output: &Path) -> anyhow::Result<ExitCode> {
    if output.exists() {
        return Err(bad_input(format!("{} exists already; choose another name", output.display())));
    }
    let past = Past::read(run, logs)?;
    let boxes = past.fold.missed_boxes(MOST_BOXES).ok_or_else(|| {
        bad_input(
            "this run did not scan a floor: its mission leads to a point, so there is nothing to re-scan",
        )
    })?;
    if boxes.is_empty() {
        return Err(bad_input("nothing was missed that is large enough to be scanned again"));
    }
    let text = scenario_for(&past, &boxes)?;
    Scenario::parse(&text, &output.display().to_string()).map_err(|errors| bad_input(errors.render()))?;
    fs::write(output, &text).map_err(|error| {
        bad_input(format!("the scenario cannot be written: {error}: {}", output.display()))
    })?;
    let area_m2: f64 = boxes.iter().map(|[low, high]| (high.x - low.x) * (high.y - low.y)).sum();
    say_line(&format!(
        "{}: {area_m2:.2} m² in {} boxes to scan again; afterwards `tankops report {} RUN` tells both together",
        output.display(),
        boxes.len(),
        past.name
    ))?;
    Ok(ExitCode::from(COMPLETE))
}

/// The scenario of a run, changed into a mission for some boxes; what was found on the way is on the drawing now.
fn scenario_for(past: &Past, boxes: &[[world::Point; 2]]) -> anyhow::Result<String> {
    let opened = opened(&past.events)?;
    let mut document: DocumentMut = opened.scenario_toml.parse().context("reading the scenario again")?;
    document["name"] = value(format!("{}-rescan", opened.scenario));
    document["about"] = value(format!("What run {} missed", past.name));
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
    put_on_drawing(&mut document, past);
    Ok(document.to_string())
}

/// Obstacles that stand in the scenario and were found are known from now on.
fn put_on_drawing(document: &mut DocumentMut, past: &Past) {
    let found: BTreeSet<u32> = past
        .events
        .iter()
        .filter_map(|event| match &event.kind {
            EventKind::ObstacleFound { obstacle } => Some(obstacle.id.0),
            _ => None,
        })
        .collect();
    let listed = document.get_mut("obstacles").and_then(Item::as_array_of_tables_mut);
    for (index, table) in listed.into_iter().flat_map(|list| list.iter_mut()).enumerate() {
        // Obstacles are numbered from 1 in the order of the file.
        if found.contains(&(index as u32 + 1)) {
            table.remove("known");
        }
    }
}

fn pair(x: f64, y: f64) -> Item {
    value([x, y].into_iter().collect::<Array>())
}

/// West, south, east, north, in millimetres at the finest.
fn numbers([low, high]: &[world::Point; 2]) -> Value {
    let rounded = |number: f64| (number * 1000.0).round() / 1000.0;
    Value::Array([low.x, low.y, high.x, high.y].map(rounded).into_iter().collect())
}
