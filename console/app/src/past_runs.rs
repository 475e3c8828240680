//! `tankops runs` and `tankops export`.

use crate::{
    cli::LogsArg,
    failure::{COMPLETE, bad_input},
    output::say_line,
    run_folder::{self, Standing},
};
use anyhow::Context;
use recording::{JOURNAL_FILE, read_journal};
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
    /// `complete`, `stuck`, …, `RUNNING`, `CRASHED` or `UNREADABLE`.
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
pub fn list(logs: &LogsArg, json: bool) -> anyhow::Result<ExitCode> {
    let listed: Vec<Listed> =
        run_folder::past_runs(&logs.logs)?.iter().map(|folder| look_at(folder)).collect();
    if json {
        say_line(&serde_json::to_string_pretty(&listed).context("writing the list as JSON")?)?;
    } else if listed.is_empty() {
        say_line(&format!("no runs in {}", logs.logs.display()))?;
    } else {
        say_line(&format!("{:<12} {:>8} {:>22}  run", "end", "T+ s", "% of reachable floor"))?;
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
        "{:<12} {:>8} {:>22}  {}{note}",
        run.end,
        number(run.mission_time_s, 1.0),
        number(run.coverage_reachable, 100.0),
        run.name.replace(char::is_control, "?")
    )
}

fn look_at(folder: &Path) -> Listed {
    let from = |end: String, summary: Option<Summary>, note: Option<String>| Listed {
        name: folder.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default(),
        end,
        scenario: summary.as_ref().and_then(|s| s.scenario.clone()),
        planner: summary.as_ref().and_then(|s| s.planner.clone()),
        seed: summary.as_ref().and_then(|s| s.seed),
        mission_time_s: summary.as_ref().and_then(|s| s.mission_time_s),
        coverage_reachable: summary.as_ref().and_then(|s| s.coverage.as_ref().map(|c| c.reachable)),
        folder: folder.to_path_buf(),
        note,
    };
    match run_folder::standing(folder) {
        Standing::Ended(summary) => {
            let end = summary.outcome.map_or("unknown", mission::Outcome::word).to_owned();
            let sha256 = run_folder::sha256(&folder.join(JOURNAL_FILE)).ok();
            let doubt = run_folder::journal_doubt(folder, sha256.as_deref());
            let note = doubt.or_else(|| summary.logs.as_ref().and_then(|logs| logs.error.clone()));
            from(end, Some(*summary), note)
        }
        Standing::Running => from("RUNNING".into(), None, None),
        Standing::Unreadable(why) => from("UNREADABLE".into(), None, Some(why)),
        Standing::Crashed => {
            let (summary, note) = rebuild(folder);
            match summary.as_ref().and_then(|summary| summary.outcome) {
                // Whatever became of the report: the journal has the run to its end.
                Some(outcome) => from(outcome.word().to_owned(), summary, Some("without a report".into())),
                None => from("CRASHED".into(), summary, Some(note)),
            }
        }
    }
}

/// What the journal of a crashed run still tells.
fn rebuild(folder: &Path) -> (Option<Summary>, String) {
    match read_journal(&folder.join(JOURNAL_FILE)) {
        Ok(journal) => {
            let mut fold = Fold::new();
            for event in &journal.events {
                fold.apply(event);
            }
            let until_s = journal.events.last().map_or(0.0, |event| event.t_s);
            (Some(fold.summary()), format!("killed; the journal holds everything up to T+{until_s:.1} s"))
        }
        Err(error) => (None, error.to_string()),
    }
}

/// `tankops export`.
pub fn export(run: &Path, rrd: &Path, logs: &LogsArg) -> anyhow::Result<ExitCode> {
    let folder = run_folder::find(run, &logs.logs)?;
    if rrd.exists() {
        return Err(bad_input(format!("{} exists already; recordings are never overwritten", rrd.display())));
    }
    let path = folder.join(JOURNAL_FILE);
    let journal = read_journal(&path).map_err(|error| bad_input(error.to_string()))?;
    crate::verify::opened(&journal.events)?;
    let made = recording::export(&path, rrd);
    if made.is_err() {
        // What was begun must not stand in the way of the next try.
        let _ = std::fs::remove_file(rrd);
    }
    let sha256 = run_folder::sha256(&path).ok();
    if let Some(doubt) = run_folder::journal_doubt(&folder, sha256.as_deref()) {
        say_line(&format!("note: {doubt}; the recording holds what it holds"))?;
    }
    if let Some(damage) = made.context("making the recording anew")? {
        say_line(&format!("note: the journal stops early ({damage}); the recording holds what it holds"))?;
    }
    say_line(&format!("{} made anew from {}", rrd.display(), path.display()))?;
    Ok(ExitCode::from(COMPLETE))
}
