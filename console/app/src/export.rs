//! `tankops export`: exports a past run to a file of another format.

use crate::{cli::ExportArgs, output::check_free};
use ::locate::MeasuredWriter;
use anyhow::Context;
use flight::failure::{COMPLETE, bad_input, not_written};
use recording::{RecordingError, Ticks, events_sha256, journal_of};
use report::print::say_line;
use runs::{find, journal_doubt};
use std::{
    fs::File,
    io::{BufWriter, Write},
    path::{Path, PathBuf},
    process::ExitCode,
};

/// Runs `tankops export RUN`.
pub(crate) fn export(args: &ExportArgs) -> anyhow::Result<ExitCode> {
    let folder = find(&args.run, &args.logs.folder())?;
    let to = &args.to;
    for file in [&to.rrd, &to.mcap, &to.ranges, &to.readings].into_iter().flatten() {
        check_free(file, None, &[])?;
    }
    let whole = |file: &PathBuf, write: fn(&Path, &Path) -> anyhow::Result<()>| {
        let written = write(&folder, file);
        if written.is_err() {
            // A partial file must not block the next attempt.
            let _ = std::fs::remove_file(file);
        }
        written
    };
    to.rrd.as_ref().map_or(Ok(()), |file| whole(file, recording))?;
    to.mcap.as_ref().map_or(Ok(()), |file| whole(file, messages))?;
    to.ranges.as_ref().map_or(Ok(()), |file| whole(file, ranges))?;
    to.readings.as_ref().map_or(Ok(()), |file| whole(file, readings))?;
    Ok(ExitCode::from(COMPLETE))
}

fn recording(folder: &Path, rrd: &Path) -> anyhow::Result<()> {
    of_journal(folder, rrd, recording::export, "regenerated")
}

fn messages(folder: &Path, mcap: &Path) -> anyhow::Result<()> {
    of_journal(folder, mcap, recording::export_mcap, "written")
}

/// Writes a file that depends on the journal alone; reports any doubt about the journal, and whether it ends early.
fn of_journal(
    folder: &Path,
    file: &Path,
    make: fn(&Path, &Path) -> Result<Option<String>, RecordingError>,
    done: &str,
) -> anyhow::Result<()> {
    let path = journal_of(folder);
    Ticks::open(&path)?.opened()?;
    let truncated = match make(&path, file) {
        Err(RecordingError::Journal(error)) => return Err(error.into()),
        Err(error @ RecordingError::NoReadings) => {
            return Err(bad_input(format!("{error}: {}", path.display())));
        }
        made => made.with_context(|| format!("writing {}", file.display()))?,
    };
    let sha256 = events_sha256(&path).ok();
    if let Some(doubt) = journal_doubt(folder, sha256.as_deref()) {
        say_line(&format!("note: {doubt}; the file contains only what is in the journal"))?;
    }
    if let Some(damage) = truncated {
        say_line(&format!(
            "note: the journal ends early ({damage}); the file contains only what is in the journal"
        ))?;
    }
    Ok(say_line(&format!("{} {done} from {}", file.display(), path.display()))?)
}

fn readings(folder: &Path, parquet: &Path) -> anyhow::Result<()> {
    of_journal(folder, parquet, recording::export_readings, "written")
}

fn ranges(folder: &Path, csv: &Path) -> anyhow::Result<()> {
    let path = journal_of(folder);
    let opened = Ticks::open(&path)?.opened()?.clone();
    if opened.mission.locating.clocks.is_some() {
        let why = "its stations have clocks of their own, so they measure no ranges; the journal contains the arrivals";
        return Err(bad_input(format!("{}: {why}", folder.display())));
    }
    let stations = opened.world.stations;
    let refused = |error: &std::io::Error| not_written("the readings", error, csv);
    let file = BufWriter::new(File::create_new(csv).map_err(|error| refused(&error))?);
    let mut writer = MeasuredWriter::new(file, &stations).map_err(|error| refused(&error))?;
    review::readings(folder, |t_s, readings, truth| writer.write(t_s, readings, truth))?;
    writer.into_inner().flush().map_err(|error| refused(&error))?;
    Ok(say_line(&format!("{} computed from {}", csv.display(), path.display()))?)
}
