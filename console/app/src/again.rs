//! `tankops report` and `tankops rescan`: what a run scanned, and a mission for what it missed.

use crate::{
    cli::{LogsArg, RescanArgs},
    failure::{COMPLETE, bad_input},
    output::{say, say_line},
    planners, run_folder,
    verify::opened,
};
use anyhow::Context;
use mission::{Event, EventKind, PlannerInfo};
use planner_host::PluginDirs;
use recording::{JOURNAL_FILE, RECORDING_FILE, read_journal};
use report::{Fold, Logs, Summary, account::Area, human, merged, merged::PastRun};
use scenario::{Scenario, with_todays_keys};
use std::{
    collections::BTreeSet,
    fmt::Display,
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};
use toml_edit::{Array, DocumentMut, Item, Table, TableLike, Value, value};

/// Boxes in a scenario for a re-scan; more are joined into coarser ones.
const MOST_BOXES: usize = 4000;
/// Areas that are listed one by one.
const MOST_LISTED: usize = 10;

/// A past run, read again.
struct Past {
    run: PastRun,
    events: Vec<Event>,
}

impl Past {
    fn read(run: &Path, logs: &LogsArg) -> anyhow::Result<Self> {
        let folder = run_folder::find(run, &logs.logs)?;
        let path = folder.join(JOURNAL_FILE);
        let journal = read_journal(&path).map_err(|error| bad_input(error.to_string()))?;
        opened(&journal.events)?;
        let mut fold = Fold::new();
        journal.events.iter().for_each(|event| fold.apply(event));
        let recording = folder.join(RECORDING_FILE);
        let shown = |path: &Path| path.exists().then(|| path.display().to_string());
        let digest = |path: &Path| run_folder::sha256(path).ok();
        let journal_sha256 = digest(&path);
        let error = run_folder::journal_doubt(&folder, journal_sha256.as_deref()).or(journal.truncated);
        let run = PastRun {
            name: folder.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            logs: Logs { journal: shown(&path), recording: shown(&recording), error },
            recording_sha256: digest(&recording),
            journal_sha256,
            fold,
        };
        Ok(Self { run, events: journal.events })
    }

    fn read_all(runs: &[PathBuf], logs: &LogsArg) -> anyhow::Result<(Vec<PastRun>, Vec<Vec<Event>>)> {
        let past = runs.iter().map(|run| Self::read(run, logs)).collect::<anyhow::Result<Vec<_>>>()?;
        Ok(past.into_iter().map(|past| (past.run, past.events)).unzip())
    }
}

/// `tankops report RUN...`.
pub(crate) fn report(
    runs: &[PathBuf],
    logs: &LogsArg,
    json: bool,
    output: Option<&Path>,
) -> anyhow::Result<ExitCode> {
    let (past, events) = Past::read_all(runs, logs)?;
    let text = if let ([only], [events]) = (&past[..], &events[..]) {
        one(only, events, json)?
    } else {
        let merged = merged(&past).map_err(bad_input)?;
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

fn one(run: &PastRun, events: &[Event], json: bool) -> anyhow::Result<String> {
    let scenario = scenario_of(events)?;
    let (logs, events_sha256) = (Some(run.logs.clone()), run.journal_sha256.clone());
    let summary = scenario.expect.evaluated(Summary { logs, events_sha256, ..run.fold.summary() });
    if json { to_json(&summary) } else { Ok(human(&summary)) }
}

fn to_json(what: &impl serde::Serialize) -> anyhow::Result<String> {
    Ok(serde_json::to_string_pretty(what).context("writing the report as JSON")? + "\n")
}

fn scenario_of(events: &[Event]) -> anyhow::Result<Scenario> {
    let text = with_todays_keys(&opened(events)?.scenario_toml);
    Scenario::parse(&text, "the scenario in the journal").map_err(|errors| bad_input(errors.render()))
}

/// `tankops rescan RUN... -o SCENARIO`.
pub(crate) fn rescan(args: &RescanArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let output = &args.output;
    if output.exists() {
        return Err(bad_input(format!("{} exists already; choose another name", output.display())));
    }
    if !(args.least_m2.is_finite() && args.least_m2 >= 0.0) {
        return Err(bad_input(format!("--least-m2 {}: must be an area of 0 m² or more", args.least_m2)));
    }
    let (past, events) = Past::read_all(&args.runs, &args.logs)?;
    print_doubts(&past, &events)?;
    let again = report::rescan(&past, args.least_m2, MOST_BOXES).map_err(bad_input)?;
    if again.boxes.is_empty() {
        let left_m2: f64 = again.left.iter().map(|area| area.area_m2).sum();
        print_areas("out of reach", &again.out_of_reach)?;
        return Err(bad_input(format!(
            "nothing was missed that is worth another scan: {} smaller than {} m² left, {left_m2:.2} m² together, and {} out of reach; \
             --least-m2 sets the limit",
            counted(again.left.len(), "place", "places"),
            args.least_m2,
            counted(again.out_of_reach.len(), "place", "places"),
        )));
    }
    let names: Vec<&str> = past.iter().map(|run| run.name.as_str()).collect();
    let text = scenario_for(&events, &names, &again.boxes)?;
    let scenario = Scenario::parse(&text, &output.display().to_string());
    let scenario = scenario.map_err(|errors| bad_input(errors.render()))?;
    fs::write(output, &text).map_err(|error| {
        bad_input(format!("the scenario cannot be written: {error}: {}", output.display()))
    })?;
    print_rescan(&again, args)?;
    print_advice(args, &names, &planners_instead(&scenario, plugins))?;
    Ok(ExitCode::from(COMPLETE))
}

/// The planners that can fly the re-scan, if the one that flew the scan cannot.
fn planners_instead(scenario: &Scenario, plugins: &PluginDirs) -> Vec<String> {
    let found = planners::found(plugins);
    let cannot = |info: &PlannerInfo| info.id == scenario.mission.planner.id && !info.covers;
    if !found.iter().any(cannot) {
        return Vec::new();
    }
    found.into_iter().filter(|info| info.covers).map(|info| info.id).collect()
}

fn print_rescan(again: &report::Rescan, args: &RescanArgs) -> anyhow::Result<()> {
    let missed_m2: f64 = again.areas.iter().map(|area| area.area_m2).sum();
    let boxes_m2: f64 = again.boxes.iter().map(|[low, high]| (high.x - low.x) * (high.y - low.y)).sum();
    say_line(&format!(
        "{}: {missed_m2:.2} m² missed in {} to scan again, {boxes_m2:.2} m² with the floor around, in {}",
        args.output.display(),
        counted(again.areas.len(), "area", "areas"),
        counted(again.boxes.len(), "box", "boxes"),
    ))?;
    print_areas("again", &again.areas)?;
    print_areas(&format!("left, smaller than {} m²", args.least_m2), &again.left)?;
    print_areas("left, out of reach", &again.out_of_reach)?;
    if again.not_asked_m2 > 0.0 {
        say_line(&format!("left: {:.2} m² that no mission was to scan", again.not_asked_m2))?;
    }
    Ok(())
}

/// How the re-scan is flown.
fn print_advice(args: &RescanArgs, names: &[&str], instead: &[String]) -> anyhow::Result<()> {
    let (logs, output) = (args.logs.logs.display(), args.output.display());
    let option = if instead.is_empty() { "" } else { " --planner PLANNER" };
    if !instead.is_empty() {
        say_line(&format!(
            "the planner of the run does not support coverage missions; PLANNER is one of {}",
            instead.join(", ")
        ))?;
    }
    say_line(&format!(
        "fly it with `tankops run --logs {logs} {output}{option}`; then `tankops report --logs {logs} {} RUN` shows all of them \
         together",
        names.join(" "),
    ))
}

/// A number of things.
fn counted(number: usize, one: &str, more: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { more })
}

/// Reports each journal that was changed, and refuses one that scanned outside the floor's cells.
fn print_doubts(past: &[PastRun], events: &[Vec<Event>]) -> anyhow::Result<()> {
    for (run, events) in past.iter().zip(events) {
        let cells = opened(events)?.floor.len() as u64;
        let is_beyond = |run: &world::CellRun| u64::from(run.0) + u64::from(run.1) > cells;
        let beyond = events.iter().find(|event| match &event.kind {
            EventKind::Covered { runs } | EventKind::Uncounted { runs } => runs.iter().any(is_beyond),
            _ => false,
        });
        if let Some(event) = beyond {
            return Err(bad_input(format!(
                "run {}: its journal was changed: an event of tick {} names cells beyond the {cells} of the floor",
                run.name, event.tick
            )));
        }
        if let Some(doubt) = &run.logs.error {
            say_line(&format!("note: run {}: {doubt}", run.name))?;
        }
    }
    Ok(())
}

fn print_areas<R: Display>(label: &str, areas: &[Area<R>]) -> anyhow::Result<()> {
    for area in areas.iter().take(MOST_LISTED) {
        say_line(&format!("{label}: {area}"))?;
    }
    let rest = areas.get(MOST_LISTED..).unwrap_or_default();
    if !rest.is_empty() {
        let area_m2: f64 = rest.iter().map(|area| area.area_m2).sum();
        say_line(&format!(
            "{label}: {area_m2:.2} m² in {}",
            counted(rest.len(), "more place", "more places")
        ))?;
    }
    Ok(())
}

/// The scenario of the last run, changed into a mission for some boxes; what was found on the way is on the drawing
/// now.
fn scenario_for(
    events: &[Vec<Event>],
    names: &[&str],
    boxes: &[[world::Point; 2]],
) -> anyhow::Result<String> {
    let last = events.last().context("there is no run")?;
    let opened = opened(last)?;
    let text = with_todays_keys(&opened.scenario_toml);
    let mut document: DocumentMut = text.parse().context("reading the scenario again")?;
    let first_name = opened.scenario.strip_suffix("-rescan").unwrap_or(&opened.scenario);
    document["name"] = value(format!("{first_name}-rescan"));
    document["about"] = value(format!("What {} missed", names.join(" and ")));
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
    put_on_drawing(&mut document, events);
    Ok(document.to_string())
}

/// Obstacles that stand in the scenario and were found are known from now on.
fn put_on_drawing(document: &mut DocumentMut, events: &[Vec<Event>]) {
    let found: BTreeSet<u32> = events
        .iter()
        .flatten()
        .filter_map(|event| match &event.kind {
            EventKind::ObstacleFound { obstacle } => Some(obstacle.id.0),
            _ => None,
        })
        .collect();
    let know = |index: usize, table: &mut dyn TableLike| {
        // Obstacles are numbered from 1 in the order of the file.
        if found.contains(&(index as u32 + 1)) {
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

fn pair(x: f64, y: f64) -> Item {
    value([x, y].into_iter().collect::<Array>())
}

/// West, south, east, north, in millimetres at the finest.
fn numbers([low, high]: &[world::Point; 2]) -> Value {
    let rounded = |number: f64| (number * 1000.0).round() / 1000.0;
    Value::Array([low.x, low.y, high.x, high.y].map(rounded).into_iter().collect())
}
