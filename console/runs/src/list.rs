//! `tankops runs` and `tankops export`.

use crate::{
    cli::LogsArg,
    failure::{COMPLETE, bad_input},
    output::say_line,
    run_folder::{self, Standing},
};
use anyhow::Context;
use recording::{JOURNAL_FILE, JournalError, JournalReader, RecordingError};
use report::{Fold, Summary};
use serde::Serialize;
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

/// A past run as it is listed.
#[derive(Debug, Serialize)]
struct Listed {
    name: String,
    /// `complete`, `stuck`, …, `RUNNING`, `CRASHED`, `RECORDING FAILED` or `UNREADABLE`.
    end: String,
    scenario: Option<String>,
    planner: Option<String>,
    seed: Option<u64>,
    mission_time_s: Option<f64>,
    coverage_reachable: Option<f64>,
    folder: PathBuf,
    /// What is wrong with it.
    note: Option<String>,
}

/// `tankops runs`.
pub(crate) fn list(logs: &LogsArg, json: bool) -> anyhow::Result<ExitCode> {
    let listed: Vec<Listed> =
        run_folder::past_runs(&logs.logs)?.iter().map(|folder| look_at(folder)).collect();
    if json {
        say_line(&serde_json::to_string_pretty(&listed).context("writing the list as JSON")?)?;
    } else if listed.is_empty() {
        say_line(&format!("no runs in {}", logs.logs.display()))?;
    } else {
        say_line(&format!("{:<16} {:>8} {:>22}  run", "end", "T+ s", "% of reachable floor"))?;
        for run in &listed {
            say_line(&row(run))?;
        }
    }
    Ok(ExitCode::from(COMPLETE))
}

fn row(run: &Listed) -> String {
    let number =
        |value: Option<f64>, scale: f64| value.map_or_else(|| "-".into(), |v| format!("{:.1}", v * scale));
    let note = run.note.as_ref().map(|note| format!("  ({note})")).unwrap_or_default();
    format!(
        "{:<16} {:>8} {:>22}  {}{note}",
        run.end,
        number(run.mission_time_s, 1.0),
        number(run.coverage_reachable, 100.0),
        run.name.replace(char::is_control, "?")
    )
}

fn look_at(folder: &Path) -> Listed {
    match run_folder::standing(folder) {
        Standing::Ended(summary) => {
            let note = summary.logs.as_ref().and_then(|logs| logs.error.clone());
            listed(folder, word(&summary), Some(&summary), note)
        }
        Standing::NotRecorded(summary, why) => {
            let note = format!("ended as {}, but not kept: {why}", word(&summary));
            listed(folder, "RECORDING FAILED", Some(&summary), Some(note))
        }
        Standing::Running => listed(folder, "RUNNING", None, None),
        Standing::JournalOnly { doubt, failure } => by_journal(folder, doubt.as_deref(), failure),
    }
}

fn listed(folder: &Path, end: &str, summary: Option<&Summary>, note: Option<String>) -> Listed {
    Listed {
        name: folder.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default(),
        end: end.to_owned(),
        scenario: summary.and_then(|summary| summary.scenario.clone()),
        planner: summary.and_then(|summary| summary.planner.clone()),
        seed: summary.and_then(|summary| summary.seed),
        mission_time_s: summary.and_then(|summary| summary.mission_time_s),
        coverage_reachable: summary.and_then(|summary| summary.coverage.as_ref()).map(|c| c.reachable),
        folder: folder.to_path_buf(),
        note,
    }
}

fn word(summary: &Summary) -> &'static str {
    summary.outcome.map_or("unknown", mission::Outcome::word)
}

/// A run of which only the journal says what happened.
fn by_journal(folder: &Path, doubt: Option<&str>, failure: Option<String>) -> Listed {
    let (summary, damage) = rebuild(&folder.join(JOURNAL_FILE));
    let with = |more: &str| Some(doubt.map_or_else(|| more.to_owned(), |doubt| format!("{doubt}; {more}")));
    // Whatever became of the report: the journal has the run to its end.
    let ended = summary.outcome.filter(|_| damage.is_none());
    match (ended, failure, damage) {
        (Some(outcome), ..) => {
            let source = doubt.map_or("without a report", |_| "shown as the journal has it");
            listed(folder, outcome.word(), Some(&summary), with(source))
        }
        (None, _, Some(damage)) => listed(folder, "UNREADABLE", Some(&summary), with(&damage)),
        (None, Some(why), None) => {
            listed(folder, "RECORDING FAILED", Some(&summary), with(&format!("{why}; {}", held(&summary))))
        }
        (None, None, None) => {
            listed(folder, "CRASHED", Some(&summary), with(&format!("killed; {}", held(&summary))))
        }
    }
}

/// Up to when a journal that stops early goes.
fn held(summary: &Summary) -> String {
    summary.mission_time_s.map_or_else(
        || "the journal holds nothing".into(),
        |until_s| format!("the journal holds everything up to T+{until_s:.1} s"),
    )
}

/// What a journal says, up to the first damage, and what the damage is.
fn rebuild(journal: &Path) -> (Summary, Option<String>) {
    let mut fold = Fold::new();
    let damage = JournalReader::open(journal).and_then(|reader| {
        reader.into_iter().try_for_each(|event| {
            fold.apply(&event?);
            Ok(())
        })
    });
    (fold.summary(), damage.err().map(|error| error.to_string()))
}

/// `tankops export`.
pub(crate) fn export(run: &Path, rrd: &Path, logs: &LogsArg) -> anyhow::Result<ExitCode> {
    let folder = run_folder::find(run, &logs.logs)?;
    if rrd.exists() {
        return Err(bad_input(format!("{} exists already; recordings are never overwritten", rrd.display())));
    }
    let path = folder.join(JOURNAL_FILE);
    let damaged = |error: JournalError| bad_input(error.to_string());
    let first =
        JournalReader::open(&path).and_then(|mut reader| reader.next().transpose()).map_err(damaged)?;
    crate::verify::opened(first.as_slice())?;
    let made = recording::export(&path, rrd);
    if made.is_err() {
        // What was begun must not stand in the way of the next try.
        let _ = std::fs::remove_file(rrd);
    }
    if let Err(RecordingError::Journal(error)) = made {
        return Err(damaged(error));
    }
    let sha256 = run_folder::sha256(&path).ok();
    if let Some(doubt) = run_folder::journal_doubt(&folder, sha256.as_deref()) {
        say_line(&format!("note: {doubt}; the recording holds what it holds"))?;
    }
    if let Some(damage) = made.context("regenerating the recording")? {
        say_line(&format!("note: the journal stops early ({damage}); the recording holds what it holds"))?;
    }
    say_line(&format!("{} regenerated from {}", rrd.display(), path.display()))?;
    Ok(ExitCode::from(COMPLETE))
}
