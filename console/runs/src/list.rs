//! Lists past runs.

use crate::{
    budget::Budget,
    error::RunError,
    folder::past_runs,
    glance::Glance,
    notes::read_notes,
    register::Register,
    report_file::{Now, Reported},
    signed::signatures,
    standing::{Standing, held, standing_within},
    verified::verified,
};
use account::{Notes, Summary};
use comfy_table::{
    CellAlignment::{Left, Right},
    Table, presets,
};
use mission::EventKind;
use recording::{JournalReader, journal_of};
use report::document::Recovered;
use serde::{Serialize, Serializer};
use std::path::{Path, PathBuf};

/// A past run in a list.
#[derive(Debug, Serialize)]
pub struct Listed {
    /// Name of the run's folder.
    pub name: String,
    /// `complete`, `stuck`, …, `RUNNING`, `CRASHED`, `RECOVERED`, `RECORDING FAILED` or `UNREADABLE`.
    pub end: String,
    /// Name of the run's scenario.
    pub scenario: Option<String>,
    /// Id of the planner that was active first.
    pub planner: Option<String>,
    /// Seed for all random choices.
    pub seed: Option<u64>,
    /// Mission time that passed, seconds.
    pub mission_time_s: Option<f64>,
    /// Scanned share of the reachable floor.
    pub coverage_reachable: Option<f64>,
    /// Folder of the run.
    #[serde(serialize_with = "shown")]
    pub folder: PathBuf,
    /// Time of the last verification, UTC, such as `2026-11-22 04:01`; absent if it was not, or if its journal has
    /// changed since.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub verified: Option<String>,
    /// The problem with the run; absent if there is none.
    pub note: Option<String>,
    /// The remark that people wrote about the run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remark: Option<String>,
    /// Number of bookmarks that people set in the run.
    pub bookmarks: usize,
}

/// Lists the past runs in a folder, oldest first, including those without a journal. If a journal is long and has no
/// report, only its beginning and end are read. Problems with signed reports are stated in the note on the run.
///
/// # Errors
/// The folder cannot be read.
pub fn list(logs: &Path, register: &Register) -> Result<Vec<Listed>, RunError> {
    let budget = Budget::of_a_list();
    let look = |folder: &PathBuf| {
        let listed = look_at(folder, &budget);
        let notes = listed.note.into_iter().chain(signatures(folder, register).doubts);
        let note = notes.reduce(|one, other| format!("{one}; {other}"));
        Listed { note, verified: verified(folder, &budget), ..listed }
    };
    // The budget is spent on the newest runs first, because people usually look for those.
    let mut listed: Vec<Listed> = past_runs(logs)?.iter().rev().map(look).collect();
    listed.reverse();
    Ok(listed)
}

/// Past runs as a text table.
pub fn table(runs: &[Listed]) -> String {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING).add_row(["end", "T+ s", "% of reachable floor", "run"]);
    table.add_rows(runs.iter().map(cells));
    for column in table.column_iter_mut() {
        let is_number = matches!(column.index, 1 | 2);
        column.set_padding((0, 2)).set_cell_alignment(if is_number { Right } else { Left });
    }
    table.trim_fmt() + "\n"
}

/// A path as text; bytes that are not UTF-8 become `\u{fffd}`, so that one folder does not make the list unreadable.
fn shown<S: Serializer>(path: &Path, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(&path.to_string_lossy())
}

fn cells(run: &Listed) -> [String; 4] {
    let number =
        |value: Option<f64>, scale: f64| value.map_or_else(|| "-".into(), |v| format!("{:.1}", v * scale));
    let note = run.note.as_ref().map(|note| format!("  ({note})")).unwrap_or_default();
    let people = people(run).map(|words| format!("  {words}")).unwrap_or_default();
    [
        run.end.clone(),
        number(run.mission_time_s, 1.0),
        number(run.coverage_reachable.map(world::coverage::percent), 1.0),
        format!("{}{note}{people}", run.name.replace(char::is_control, "?")),
    ]
}

/// The remark and the bookmarks of a run.
fn people(run: &Listed) -> Option<String> {
    let bookmarks = match run.bookmarks {
        0 => None,
        1 => Some("1 bookmark".to_owned()),
        n => Some(format!("{n} bookmarks")),
    };
    let words: Vec<String> = run.remark.clone().into_iter().chain(bookmarks).collect();
    (!words.is_empty()).then(|| format!("[{}]", words.join("; ")))
}

fn look_at(folder: &Path, budget: &Budget) -> Listed {
    match standing_within(folder, budget) {
        Standing::Ended(summary) => {
            let note = summary.logs.as_ref().and_then(|logs| logs.error.clone());
            let reported = Reported::read(folder).ok().flatten();
            let recovered = reported.as_ref().and_then(Reported::recovered);
            let closed = recovered.map(|Recovered { by, at, .. }| {
                let killed = if summary.outcome.is_none() { "killed, " } else { "" };
                format!("{killed}recovered by {by}, {at} UTC; {}", held(&summary))
            });
            let doubt =
                reported.as_ref().and_then(|reported| reported.recording_doubt(folder, &Now::Within(budget)));
            let note =
                closed.or(note).into_iter().chain(doubt).reduce(|one, other| format!("{one}; {other}"));
            let is_cut = recovered.is_some() && summary.outcome.is_none();
            listed(folder, if is_cut { "RECOVERED" } else { word(&summary) }, Some(&summary), note)
        }
        Standing::NotRecorded(summary, why) => {
            let note = format!("outcome {}, but not kept: {why}", word(&summary));
            listed(folder, "RECORDING FAILED", Some(&summary), Some(note))
        }
        Standing::Running => running(folder),
        Standing::JournalOnly { doubt, failure } => by_journal(folder, doubt.as_deref(), failure, budget),
    }
}

fn listed(folder: &Path, end: &str, summary: Option<&Summary>, note: Option<String>) -> Listed {
    let (notes, doubt) = match read_notes(folder) {
        Ok(notes) => (notes, None),
        Err(why) => (Notes::default(), Some(format!("notes cannot be read: {why}"))),
    };
    let note = note.into_iter().chain(doubt).reduce(|one, other| format!("{one}; {other}"));
    Listed {
        name: folder.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default(),
        end: end.to_owned(),
        scenario: summary.and_then(|summary| summary.scenario.clone()),
        planner: summary.and_then(|summary| summary.planner.clone()),
        seed: summary.and_then(|summary| summary.seed),
        mission_time_s: summary.and_then(|summary| summary.mission_time_s),
        coverage_reachable: summary.and_then(|summary| summary.coverage.as_ref()).map(|c| c.reachable),
        folder: folder.to_path_buf(),
        verified: None,
        note,
        remark: Some(notes.remark).filter(|remark| !remark.is_empty()),
        bookmarks: notes.bookmarks.len(),
    }
}

fn word(summary: &Summary) -> &'static str {
    summary.outcome.map_or("unknown", mission::Outcome::word)
}

/// A run that another process is recording: its scenario and planner, from the first event of its journal.
fn running(folder: &Path) -> Listed {
    let first = JournalReader::open(&journal_of(folder)).ok().and_then(|mut events| events.next()?.ok());
    let opened = first.and_then(|event| match event.kind {
        EventKind::RunOpened(run) => Some(run),
        _ => None,
    });
    Listed {
        scenario: opened.as_ref().map(|run| run.scenario.clone()),
        planner: opened.as_ref().map(|run| run.mission.planner.id.clone()),
        seed: opened.as_ref().map(|run| run.seed),
        ..listed(folder, "RUNNING", None, None)
    }
}

/// A run with no report, or with one that is not trusted: its entry is built from the journal.
fn by_journal(folder: &Path, doubt: Option<&str>, failure: Option<String>, budget: &Budget) -> Listed {
    let Glance { summary, damage, is_partial } = Glance::at(&journal_of(folder), budget);
    let with = |more: &str| Some(doubt.map_or_else(|| more.to_owned(), |doubt| format!("{doubt}; {more}")));
    // Whatever happened to the report, the journal is complete.
    let ended = summary.outcome.filter(|_| damage.is_none());
    match (ended, failure, damage) {
        (Some(outcome), ..) => {
            let source = match (doubt, is_partial) {
                (None, false) => "without a report",
                (Some(_), false) => "figures from the journal",
                (_, true) => "figures from the beginning and the end of a long journal",
            };
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::{ffi::OsStr, os::unix::ffi::OsStrExt};

    #[test]
    fn a_folder_whose_name_is_not_text_is_listed_as_json() {
        let folder = Path::new(OsStr::from_bytes(b"logs/run\xff"));
        let json = serde_json::to_value(listed(folder, "CRASHED", None, None)).expect("it is listed");
        assert_eq!(json["folder"], "logs/run\u{fffd}");
    }

    #[test]
    fn a_run_without_a_readable_journal_is_still_listed_as_running() {
        let listed = running(Path::new("logs/20261122T040049Z-demo-rpf-42"));
        assert_eq!((listed.end.as_str(), listed.scenario), ("RUNNING", None));
    }
}
