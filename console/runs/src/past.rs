//! Reads past runs from their journals.

use crate::{
    error::RunError,
    imported::imported,
    report_file::{Now, Reported},
    standing::is_locked,
};
use account::{Fold, Logs, Summary};
use mission::{Event, EventKind, RunOpened};
use recording::{
    JournalError, JournalReader, READINGS_FILE, RECORDING_FILE, ahead, events_sha256_while, journal_of,
    sha256_of, sha256_while,
};
use report::{PastRun, Record, document::Files};
use std::{
    fs, iter,
    path::Path,
    sync::atomic::{AtomicBool, Ordering},
    thread,
};
use world::{CellRun, Floor};

/// Maximum number of events to read ahead at a time, and the size of their lines, in bytes, at which reading ahead stops.
const BATCH: usize = 512;
const BATCH_BYTES: u64 = 1 << 18;
/// Events that were read ahead, and the size of their lines, bytes.
const AHEAD_BYTES: u64 = 1 << 20;

/// A past run.
#[derive(Debug)]
pub struct Past {
    /// The first event of the run.
    pub opened: Box<RunOpened>,
    /// The state derived from the events of the run, and the files of the run.
    pub run: PastRun,
    /// Tick of the first event that names cells outside the floor. No run does that, so the journal was changed.
    pub beyond_floor: Option<u64>,
}

impl Past {
    /// Reads the run in a folder. Problems with the journal are stored as an error in the logs of the run's state.
    ///
    /// # Errors
    /// The journal cannot be read.
    pub fn read(folder: &Path) -> Result<Self, RunError> {
        let journal = journal_of(folder);
        let mut reader = JournalReader::open(&journal)?;
        let (mut fold, mut record) = (Fold::new(), Record::new());
        let (mut opened, mut beyond_floor): (Option<Box<RunOpened>>, Option<u64>) = (None, None);
        let digests = each_event(&mut reader, folder, |event| {
            fold.apply(&event);
            record.apply(&event);
            match (event.kind, &opened) {
                (EventKind::RunOpened(run), None) => opened = Some(run),
                (EventKind::Covered { runs } | EventKind::Uncounted { runs }, Some(opened))
                    if names_cells_beyond(&opened.floor, &runs) =>
                {
                    beyond_floor.get_or_insert(event.tick);
                }
                _ => {}
            }
        })?;
        let opened = opened.ok_or_else(|| reader.not_opened())?;
        let shown = |path: &Path| path.exists().then(|| path.display().to_string());
        let mut summary = fold.summary();
        let mut files = files(folder, &opened, digests, &summary);
        let imported = imported(folder, &mut fold).unwrap_or_else(|why| {
            files.doubts.push(why);
            None
        });
        if let Some((import, _)) = &imported
            && files.readings_sha256.as_ref() != Some(&import.readings_sha256)
        {
            files.doubts.push(format!(
                "{READINGS_FILE} is not the file that was imported: the SHA-256 digests differ; import the readings again"
            ));
        }
        if let Some(((_, imported), scanned)) = imported.as_ref().zip(fold.scanned()) {
            let silenced = fold.summary();
            (summary.floor, summary.coverage) = (silenced.floor, silenced.coverage);
            summary.readings = Some(imported.summary(scanned.believed().floor()));
        }
        let doubts = files.doubts.first().cloned();
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let run = PastRun {
            // Renaming the folder does not change when the run began.
            began: began(files.closed_as.as_deref().unwrap_or(&name)),
            name,
            logs: Logs {
                journal: shown(&journal),
                recording: shown(&folder.join(RECORDING_FILE)),
                error: doubts.or_else(|| reader.truncated().map(str::to_owned)),
                is_open: summary.outcome.is_none() && is_locked(folder),
            },
            files,
            fold,
            summary,
            record,
            imported: imported.map(Box::new),
        };
        Ok(Self { opened, run, beyond_floor })
    }
}

/// Passes every event in a journal to the caller, in order. One thread reads ahead; a second one computes the digests of
/// the journal, the recording and the readings meanwhile. Returns these digests.
fn each_event(
    reader: &mut JournalReader,
    folder: &Path,
    mut take: impl FnMut(Event),
) -> Result<[Option<String>; 3], JournalError> {
    let (give, taken) = ahead::queue::<Vec<Event>>(AHEAD_BYTES);
    let is_damaged = AtomicBool::new(false);
    let is_wanted = |_| !is_damaged.load(Ordering::Relaxed);
    thread::scope(|scope| {
        let hashing = scope.spawn(|| {
            let (journal, recording) = (journal_of(folder), folder.join(RECORDING_FILE));
            let of_file = |file: &Path| sha256_while(file, is_wanted).ok();
            [
                events_sha256_while(&journal, is_wanted).ok(),
                of_file(&recording),
                of_file(&folder.join(READINGS_FILE)),
            ]
        });
        let reading = scope.spawn(move || {
            loop {
                let begin = reader.bytes();
                let next = || if reader.bytes() < begin + BATCH_BYTES { reader.next() } else { None };
                let batch = iter::from_fn(next).take(BATCH).collect::<Result<Vec<Event>, JournalError>>()?;
                if batch.is_empty() || !give.give(batch, reader.bytes() - begin) {
                    return Ok(());
                }
            }
        });
        taken.flatten().for_each(&mut take);
        let read: Result<(), JournalError> =
            reading.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        // If the file cannot be read, nothing can be proven about it.
        is_damaged.store(read.is_err(), Ordering::Relaxed);
        let digests = hashing.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        read.map(|()| digests)
    })
}

/// The digests of a run's files, and the doubts about these files.
fn files(
    folder: &Path,
    opened: &RunOpened,
    [journal_sha256, recording_sha256, readings_sha256]: [Option<String>; 3],
    summary: &Summary,
) -> Files {
    let (journal, recording) = (journal_of(folder), folder.join(RECORDING_FILE));
    let bytes = |file: &Path| fs::metadata(file).ok().map(|file| file.len());
    let (reported, damage) = Reported::read(folder).map_or_else(|why| (None, Some(why)), |read| (read, None));
    let doubts_of = |reported: &Reported| {
        [
            reported.journal_doubt(journal_sha256.as_deref()),
            reported.recording_doubt(folder, &Now::Is(recording_sha256.as_deref())),
            reported.readings_doubt(readings_sha256.as_deref()),
            reported.figures_doubt(summary),
        ]
    };
    let doubts = reported.as_ref().map(doubts_of).into_iter().flatten();
    let doubts: Vec<String> = doubts.chain([damage]).flatten().collect();
    Files {
        journal_bytes: bytes(&journal),
        recording_bytes: bytes(&recording),
        scenario_sha256: Some(sha256_of(opened.scenario_toml.as_bytes())),
        are_as_reported: reported.as_ref().is_some_and(Reported::names_digests).then_some(doubts.is_empty()),
        closed_as: reported.as_ref().and_then(Reported::closed_as).map(str::to_owned),
        recovered: reported.as_ref().and_then(Reported::recovered).cloned(),
        journal_sha256,
        recording_sha256,
        readings_sha256,
        doubts,
    }
}

/// The time at which a run began, according to its name: `20261122T040132Z-...` becomes `2026-11-22 04:01`.
fn began(name: &str) -> Option<String> {
    let stamp = name.get(..16).filter(|stamp| stamp.ends_with('Z') && stamp.as_bytes()[8] == b'T')?;
    let digits =
        |range: std::ops::Range<usize>| stamp.get(range).filter(|d| d.bytes().all(|b| b.is_ascii_digit()));
    let [year, month, day] = [digits(0..4)?, digits(4..6)?, digits(6..8)?];
    Some(format!("{year}-{month}-{day} {}:{}", digits(9..11)?, digits(11..13)?))
}

fn names_cells_beyond(floor: &Floor, runs: &[CellRun]) -> bool {
    runs.iter().any(|CellRun(first, count)| u64::from(*first) + u64::from(*count) > floor.len() as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn when_a_run_began_is_in_its_name() {
        assert_eq!(began("20261122T040132Z-demo-rpf-1").as_deref(), Some("2026-11-22 04:01"));
        assert_eq!((began("demo"), began("2026x122T040132Z-demo")), (None, None));
    }
}
