//! `tankops runs`, `report`, `verify` and `export`: what past runs hold.

use crate::{
    cli::{LogsArg, ReportArgs},
    output::pretty_json,
    report_file,
};
use anyhow::Context;
use flight::failure::{COMPLETE, ENDED_OTHERWISE, bad_input};
use planner_host::PluginDirs;
use recording::{JOURNAL_FILE, RecordingError, Ticks, sha256};
use report::{
    PastRun, human, merged,
    print::{say, say_line},
};
use runs::{Past, find, journal_doubt};
use std::{path::Path, process::ExitCode};

/// `tankops runs`.
pub(crate) fn list(logs: &LogsArg, json: bool) -> anyhow::Result<ExitCode> {
    let listed = runs::list(&logs.folder())?;
    say(&if json {
        pretty_json("the list", &listed)?
    } else if listed.is_empty() {
        format!("no runs in {}\n", logs.folder().display())
    } else {
        runs::table(&listed)
    })?;
    Ok(ExitCode::from(COMPLETE))
}

/// `tankops report RUN...`.
pub(crate) fn report(args: &ReportArgs) -> anyhow::Result<ExitCode> {
    if let Some(output) = &args.output {
        return report_file::write(args, output);
    }
    let past = review::read_all(&args.runs, &args.logs.folder())?;
    let text = if let [only] = &past[..] {
        one(only, args.json)?
    } else {
        let past: Vec<PastRun> = past.into_iter().map(|past| past.run).collect();
        let merged = merged(&past).map_err(bad_input)?;
        if args.json { pretty_json("the report", &merged)? } else { merged.human() }
    };
    say(&text)?;
    Ok(ExitCode::from(COMPLETE))
}

fn one(past: &Past, json: bool) -> anyhow::Result<String> {
    let summary = review::summary(past)?;
    if json { pretty_json("the report", &summary) } else { Ok(human(&summary)) }
}

/// `tankops verify`.
pub(crate) fn verify(
    run: &Path,
    logs: &LogsArg,
    plugins: &PluginDirs,
    from_journal: bool,
) -> anyhow::Result<ExitCode> {
    let verified = review::verify(&find(run, &logs.folder())?, plugins, from_journal)?;
    for line in &verified.lines {
        say_line(line)?;
    }
    Ok(ExitCode::from(if verified.is_equal { COMPLETE } else { ENDED_OTHERWISE }))
}

/// `tankops export`.
pub(crate) fn export(run: &Path, rrd: &Path, logs: &LogsArg) -> anyhow::Result<ExitCode> {
    let folder = find(run, &logs.folder())?;
    if rrd.exists() {
        return Err(bad_input(format!("{} already exists; recordings are never overwritten", rrd.display())));
    }
    let path = folder.join(JOURNAL_FILE);
    Ticks::open(&path)?.opened()?;
    let made = recording::export(&path, rrd);
    if made.is_err() {
        // What was begun must not stand in the way of the next try.
        let _ = std::fs::remove_file(rrd);
    }
    if let Err(RecordingError::Journal(error)) = made {
        return Err(error.into());
    }
    let sha256 = sha256(&path).ok();
    if let Some(doubt) = journal_doubt(&folder, sha256.as_deref()) {
        say_line(&format!("note: {doubt}; the recording holds what it holds"))?;
    }
    if let Some(damage) = made.context("regenerating the recording")? {
        say_line(&format!("note: the journal stops early ({damage}); the recording holds what it holds"))?;
    }
    say_line(&format!("{} regenerated from {}", rrd.display(), path.display()))?;
    Ok(ExitCode::from(COMPLETE))
}
