//! `tankops runs`, `report`, `recover` and `verify`: commands for past runs.

use crate::{
    cli::{LogsArg, ReportArgs},
    report_file,
};
use ::locate::Again;
use account::Expect;
use command::json::pretty_json;
use flight::failure::{COMPLETE, ENDED_OTHERWISE, bad_input};
use mission::RunOpened;
use planner_host::PluginDirs;
use report::{
    PastRun, merged,
    print::{say, say_line},
};
use runs::{Past, find};
use scenario::Scenario;
use std::{path::Path, process::ExitCode};

/// Runs `tankops runs`.
pub(crate) fn list(logs: &LogsArg, json: bool) -> anyhow::Result<ExitCode> {
    let listed = runs::list(&logs.folder(), &review::register())?;
    say(&if json {
        pretty_json("the list", &listed)?
    } else if listed.is_empty() {
        format!("no runs in {}\n", logs.folder().display())
    } else {
        runs::table(&listed)
    })?;
    Ok(ExitCode::from(COMPLETE))
}

/// Runs `tankops report RUN...`.
pub(crate) fn report(args: &ReportArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    if args.output.is_some() || args.package.is_some() {
        return report_file::write(args, plugins);
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
    if json { pretty_json("the report", &review::summary(past)?) } else { review::text_of(past) }
}

/// Runs `tankops recover`.
pub(crate) fn recover(run: &Path, by: &str, logs: &LogsArg) -> anyhow::Result<ExitCode> {
    let folder = find(run, &logs.folder())?;
    let recovered = runs::recover(&folder, by, expectations)?;
    let missing = if recovered.missing.is_empty() { "nothing is missing" } else { "missing:" };
    say_line(&format!(
        "{}: recovered by {}, {} UTC; {missing}",
        folder.display(),
        recovered.by,
        recovered.at
    ))?;
    for missing in &recovered.missing {
        say_line(&format!("  {missing}"))?;
    }
    say_line(
        "report.json now contains the SHA-256 of the journal and the recording, so the run can be part of a \
         signed report",
    )?;
    Ok(ExitCode::from(COMPLETE))
}

/// The expectations of the scenario in a journal; `None` if the scenario cannot be read.
fn expectations(run: &RunOpened) -> Option<Expect> {
    if run.measured.is_some() {
        return Some(Expect::default());
    }
    Scenario::recorded(&run.scenario_toml, "the scenario in the journal").ok().map(|scenario| scenario.expect)
}

/// Runs `tankops verify`.
pub(crate) fn verify(
    run: &Path,
    logs: &LogsArg,
    plugins: &PluginDirs,
    from_journal: bool,
) -> anyhow::Result<ExitCode> {
    if run.is_file() && run.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("zip")) {
        return verify_package(run);
    }
    let folder = find(run, &logs.folder())?;
    let verified = review::verify(&folder, plugins, from_journal)?;
    for line in &verified.lines {
        say_line(line)?;
    }
    let is_again = !verified.is_located || is_located_again(&folder)?;
    Ok(ExitCode::from(if verified.is_equal && is_again { COMPLETE } else { ENDED_OTHERWISE }))
}

/// Verifies a package and reports the result.
fn verify_package(file: &Path) -> anyhow::Result<ExitCode> {
    let verified = review::package::verify_package(file)?;
    for line in &verified.lines {
        say_line(line)?;
    }
    Ok(ExitCode::from(if verified.is_equal { COMPLETE } else { ENDED_OTHERWISE }))
}

/// Locates the robot again from the readings of a run and reports the result; returns whether it is unchanged.
fn is_located_again(folder: &Path) -> anyhow::Result<bool> {
    let again = ::locate::again(folder)?;
    say_line(&match &again {
        Again::Equal(events) => {
            format!("equal: {events} events recomputed from the readings, byte for byte")
        }
        Again::Different { line, recorded, computed } => {
            format!("different from line {line} on\n  recorded: {recorded}\n  computed: {computed}")
        }
        Again::NoReadings(why) => {
            format!("not proven: the positions cannot be recomputed: {why}; restore the original readings")
        }
    })?;
    Ok(matches!(again, Again::Equal(_)))
}
