//! `tankops locate`: readings of a real system to fixes, track, recording and report.

use crate::{
    cli::{FindArg, LocateArgs},
    output::say_json,
};
use ::locate::{Fixes, Survey, Tally, Task};
use flight::{
    failure::{COMPLETE, bad_input, exit_code},
    scenarios,
};
use mission::Event;
use report::{
    Expect, PlannerCalls,
    print::{say, say_line, warn_line},
};
use runs::{CLOSE_TIMEOUT, Kept, RunLog};
use scenario::Scenario;
use serde::Serialize;
use std::{
    fmt::Write as _,
    fs::File,
    io::{self, BufWriter},
    path::Path,
    process::ExitCode,
};

/// A speed of sound that is less known than this, as a share, does not serve to correct ranges.
const DOUBTFUL_SCALE: f64 = 0.005;

/// The figures as JSON.
#[derive(Serialize)]
struct Figures<'a> {
    rows: u64,
    bad_rows: u64,
    ignored_columns: &'a [String],
    kind: &'a str,
    /// Metres per second and its standard deviation.
    sound_speed_m_per_s: Option<[f64; 2]>,
    /// By how much ranges were too long as a share, and its standard deviation.
    range_scale: Option<[f64; 2]>,
    /// By how much ranges were too long because clocks differ, metres, and its standard deviation.
    clock_offset_m: Option<[f64; 2]>,
    #[serde(flatten)]
    tally: &'a Tally,
}

/// `tankops locate READINGS --scenario FILE`.
pub(crate) fn locate(args: &LocateArgs) -> anyhow::Result<ExitCode> {
    let scenario = scenarios::read(&args.scenario, &(&args.changes).into())?;
    if scenario.sim.world.stations.is_empty() {
        return Err(bad_input(format!(
            "{}: ae.stations: missing, there is nothing to locate by",
            scenario.shown_name
        )));
    }
    let task = Task {
        file: &args.readings,
        scenario: &scenario,
        sound_speed_m_s: args.sound_speed,
        finds_sound_speed: args.find.contains(&FindArg::SoundSpeed),
        finds_clock_offset: args.find.contains(&FindArg::ClockOffset),
        skips_bad_rows: args.skip_bad_rows,
        tool_on: args.tool_on.as_deref(),
    };
    if let Some(file) = args.output.as_ref().filter(|file| file.exists()) {
        return Err(bad_input(format!("{} already exists; choose another name", file.display())));
    }
    let survey = task.survey()?;
    let (tally, kept) = located(args, &task, &survey)?;
    if args.json {
        say_json("the figures", &figures(args, &survey, &tally))?;
    } else {
        say(&human(args, &scenario, &survey, &tally))?;
    }
    match &kept {
        Some(kept) if kept.problem().is_some() => warn_line(&kept.text()),
        Some(kept) if !args.json => say_line(&kept.text())?,
        _ => {}
    }
    Ok(ExitCode::from(exit_code(COMPLETE, kept.as_ref())))
}

fn located(args: &LocateArgs, task: &Task, survey: &Survey) -> anyhow::Result<(Tally, Option<Kept>)> {
    let scenario = task.scenario;
    let mut table = args.output.as_deref().map(|file| table(file, scenario)).transpose()?;
    let mut log = if args.no_record {
        None
    } else {
        Some(RunLog::create(&args.logs.folder(), &scenario.name, "located", scenario.seed)?)
    };
    let (mut tally, mut refused) = (Tally::default(), None);
    task.locate(survey, |events: &[Event]| {
        tally.take(events);
        if let Some(log) = &mut log {
            log.keep(events);
        }
        if let Some(Err(error)) = table.as_mut().map(|table| table.take(events)) {
            refused = Some(error);
        }
    })?;
    if let (Some(table), Some(file)) = (table, &args.output) {
        let finished = refused.map_or_else(|| table.finish(), Err);
        finished.map_err(|error| not_written(file, &error))?;
    }
    let calls = PlannerCalls { plan: 0, step: 0, p50_us: None, p99_us: None, faults: 0 };
    let kept = log.and_then(|log| log.close(CLOSE_TIMEOUT, calls, None, &Expect::default()).kept);
    Ok((tally, kept))
}

fn table(file: &Path, scenario: &Scenario) -> anyhow::Result<Fixes<BufWriter<File>>> {
    let made =
        File::create(file).and_then(|out| Fixes::new(BufWriter::new(out), &scenario.sim.world.stations));
    made.map_err(|error| not_written(file, &error))
}

fn not_written(file: &Path, error: &io::Error) -> anyhow::Error {
    bad_input(format!("the fixes cannot be written: {error}: {}", file.display()))
}

fn figures<'a>(args: &LocateArgs, survey: &'a Survey, tally: &'a Tally) -> Figures<'a> {
    let pair = |(value, sigma): (f64, f64)| [value, sigma];
    let found = |what| survey.calibration.as_ref().filter(|_| args.find.contains(&what));
    let scale = found(FindArg::SoundSpeed).map(|calibration| pair(calibration.scale()));
    Figures {
        rows: survey.rows,
        bad_rows: survey.bad,
        ignored_columns: &survey.ignored,
        kind: survey.kind.word(),
        // Ranges too long by a share were computed with a sound that is too fast by it.
        sound_speed_m_per_s: scale
            .zip(args.sound_speed)
            .map(|([scale, sigma], speed)| [speed / (1.0 + scale), speed * sigma]),
        range_scale: scale,
        clock_offset_m: found(FindArg::ClockOffset).map(|calibration| pair(calibration.offset_m())),
        tally,
    }
}

fn human(args: &LocateArgs, scenario: &Scenario, survey: &Survey, tally: &Tally) -> String {
    let mut text = String::new();
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "{label:<16} {value}");
    };
    line("readings", format!("{}, {} rows of {}", args.readings.display(), survey.rows, survey.kind.word()));
    if survey.bad > 0 {
        line("left out", format!("{} bad rows", survey.bad));
        survey.problems.iter().for_each(|problem| line("", problem.to_string()));
    }
    if !survey.ignored.is_empty() {
        line("ignored columns", survey.ignored.join(", "));
    }
    if !survey.has_motion {
        line("motion", "not measured; up to the robot's maximum speed in any direction".into());
    }
    line("tool", tool(survey));
    let found = figures(args, survey, tally);
    if let Some([scale, sigma]) = found.range_scale {
        let speed = found.sound_speed_m_per_s.map(|[speed, sigma]| format!(", {speed:.2} ± {sigma:.2} m/s"));
        let (percent, sigma) = (scale * 100.0, sigma * 100.0);
        line(
            "speed of sound",
            format!("ranges too long by {percent:.3} ± {sigma:.3} %{}", speed.unwrap_or_default()),
        );
    }
    if let Some([offset_m, sigma_m]) = found.clock_offset_m {
        let time = args.sound_speed.map(|speed| format!(", {:.1} µs", offset_m / speed * 1e6));
        line(
            "clock offset",
            format!("ranges too long by {offset_m:.4} ± {sigma_m:.4} m{}", time.unwrap_or_default()),
        );
    }
    if found.range_scale.is_some_and(|[_, sigma]| sigma > DOUBTFUL_SCALE) {
        line("", "poorly known: the robot has to come near stations and go far from them".into());
    }
    let fixes: u64 = tally.fixes.values().sum();
    let by_word: Vec<String> = tally.fixes.iter().map(|(word, count)| format!("{count} {word}")).collect();
    line("fixes", format!("{fixes} of {} emissions ({})", tally.emissions, by_word.join(", ")));
    if let Some(off_m) = start_off_m(scenario, tally) {
        let note = "the track is wrong until three fixes in a row agree; correct the start";
        line("start", format!("the first fix lies {off_m:.2} m from robot.start_m of the scenario: {note}"));
    }
    tally.failed.iter().for_each(|(why, count)| line("no fix", format!("{count} times: {why}")));
    for (id, count) in &tally.left_out {
        let station = scenario.sim.world.stations.iter().find(|station| station.id.0 == *id);
        let name = station.map_or("?", |station| station.name.as_str());
        line("left out", format!("station {name} from {count} fixes: its residual exceeded the gate"));
    }
    let metres = |[mean_m, most_m]: [f64; 2]| format!("{mean_m:.3} m mean, {most_m:.3} m maximum");
    let mut figure = |label: &str, what: &str, figures: Option<[f64; 2]>| {
        if let Some(figures) = figures {
            line(label, format!("{what} {}", metres(figures)));
        }
    };
    figure("track", "95 % error by covariance", tally.error_95_m);
    figure("true error", "of fixes", tally.fix_error_m);
    figure("", "of the track", tally.track_error_m);
    text
}

/// When the tool was on.
fn tool(survey: &Survey) -> String {
    let Some(stretches) = &survey.tool_on_s else {
        return "not known when it was on, so that no coverage is stated (column tool_on, or --tool-on FILE)"
            .into();
    };
    let on_s: f64 = stretches.iter().map(|[from_s, to_s]| to_s - from_s).sum();
    let heading = if survey.has_motion {
        ""
    } else {
        "; without measured motion the heading is not known, so that no floor counts"
    };
    format!("on for {on_s:.1} s in {} stretches{heading}", stretches.len())
}

/// How far the first fix is from the start that the scenario states, metres, if that is more than both can be wrong.
fn start_off_m(scenario: &Scenario, tally: &Tally) -> Option<f64> {
    let (first, error_95_m) = tally.first_fix_m.zip(tally.first_fix_error_95_m)?;
    let off_m = (first - scenario.mission.start.position).norm();
    (off_m > 2.0 * error_95_m + 3.0 * scenario.mission.start_sigma_m).then_some(off_m)
}
