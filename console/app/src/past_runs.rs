//! `tankops runs`, `report` and `verify`: what past runs hold.

use crate::{
    cli::{LogsArg, ReportArgs},
    output::pretty_json,
    report_file,
};
use flight::failure::{COMPLETE, ENDED_OTHERWISE, bad_input};
use planner_host::PluginDirs;
use report::{
    PastRun, human, merged,
    print::{say, say_line},
};
use runs::{Past, find};
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
pub(crate) fn report(args: &ReportArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    if let Some(output) = &args.output {
        return report_file::write(args, output, plugins);
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
