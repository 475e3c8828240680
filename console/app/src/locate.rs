//! `tankops locate`: turns readings of a real system into fixes, a track, a recording and a report.

mod words;

use crate::{
    cli::{FindArg, LocateArgs},
    input,
    output::{check_free, fill_file},
};
use ::locate::{Doubts, Fixes, Pulsed, Refused, Survey, Tally, Task};
use account::{Calibration, Expect, PlannerCalls, Ranging};
use command::json::say_json;
use flight::{
    failure::{COMPLETE, ENDED_OTHERWISE, bad_input, exit_code},
    scenarios,
};
use mission::{Event, event::PulsePhase};
use positioning::{Estimated, Wrong};
use report::print::{say, say_line, warn_line};
use runs::{CLOSE_TIMEOUT, Kept, RunLog};
use scenario::Scenario;
use serde::Serialize;
use std::{
    collections::BTreeMap,
    fs::File,
    io::BufWriter,
    path::{Path, PathBuf},
    process::ExitCode,
};
use world::StationId;

/// The results for `--json`.
#[derive(Serialize)]
struct Figures<'a> {
    rows: u64,
    bad_rows: u64,
    ignored_columns: &'a [String],
    kind: &'a str,
    /// The speed of sound in metres per second, and its standard deviation.
    sound_speed_m_per_s: Option<[f64; 2]>,
    /// The relative amount by which ranges were too long, and its standard deviation.
    range_scale: Option<[f64; 2]>,
    /// The length in metres by which ranges were too long because of the clock offset, and its standard deviation.
    clock_offset_m: Option<[f64; 2]>,
    /// The speed of sound and the wrong stations that the session calibration has found; absent without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    calibration: Option<Calibration>,
    /// The systematic errors that the residuals of the whole session reveal, once the estimated errors are removed.
    session: Session<'a>,
    /// Emissions with several readings of the same station.
    repeated_readings: Option<RepeatedReadings<'a>>,
    /// The pulse tests of the stations; absent without pulses.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pulse_tests: Vec<PulseFigures<'a>>,
    sides: Sides,
    /// If the measured motion is not used because fixes contradict it: the number of fixes that contradict it, and the
    /// number of fixes tested.
    motion_contradicted: Option<[u64; 2]>,
    /// Readings that fit no position in the tank.
    impossible: Vec<Impossible<'a>>,
    /// The first time in the file, in UTC, if the times there have dates.
    first_time: Option<&'a str>,
    #[serde(flatten)]
    tally: &'a Tally,
}

#[derive(Serialize)]
struct Session<'a> {
    /// The relative amount by which all ranges are too long.
    scale: Option<TooLong>,
    /// The length in metres by which all ranges are too long; absent without emission times.
    offset_m: Option<TooLong>,
    /// The length in metres by which the ranges of each station are too long.
    stations_m: BTreeMap<&'a str, TooLong>,
}

#[derive(Serialize)]
struct TooLong {
    value: f64,
    sigma: f64,
    /// Whether the error exceeds both chance and the stated uncertainties.
    proven: bool,
}

#[derive(Serialize)]
struct RepeatedReadings<'a> {
    emissions: u64,
    scatter_over_noise: f64,
    suspect: bool,
    widest_station: &'a str,
    widest_m: f64,
    /// The mission time in seconds.
    widest_t_s: f64,
}

#[derive(Serialize)]
struct PulseFigures<'a> {
    phase: PulsePhase,
    /// The mission time in seconds.
    t_s: f64,
    pulses: usize,
    /// The share by which ranges were too long, and its standard deviation.
    range_scale: [f64; 2],
    /// The offset of each clock from their mean, as a length that sound travels in metres, and its standard deviation.
    clock_offsets_m: BTreeMap<&'a str, [f64; 2]>,
    /// `ok`, `suspect` or `alarm`; `untestable` if the pulses do not suffice.
    survey: positioning::Integrity,
    /// The station that contradicts the others.
    suspect: Option<&'a str>,
}

/// The numbers of fixes with a mirror image, by how the right side was determined.
#[derive(Serialize)]
struct Sides {
    by_walls: u64,
    by_start_and_track: u64,
    undecided: u64,
}

#[derive(Serialize)]
struct Impossible<'a> {
    station: &'a str,
    count: u64,
    /// The first such range in metres; absent if it is not a number.
    first_m: Option<f64>,
    most_m: f64,
    /// The mission time in seconds.
    first_t_s: f64,
}

/// Runs `tankops locate READINGS --scenario FILE`.
pub(crate) fn locate(args: &LocateArgs) -> anyhow::Result<ExitCode> {
    let scenario = scenarios::read(&args.scenario, &(&args.changes).into())?;
    if scenario.sim.world.stations.is_empty() {
        return Err(bad_input(format!(
            "{}: ae.stations: missing; locating needs stations",
            scenario.shown_name
        )));
    }
    if scenario.mission.locating.clocks.is_some() {
        return Err(bad_input(format!(
            "{}: ae.clock_offset_sigma_m or ae.clock_drift_sigma_m_per_h: `locate` cannot estimate clocks of the stations; \
             subtract their offsets from the arrivals, and remove these keys",
            scenario.shown_name
        )));
    }
    let readings = input::file(&args.readings)?;
    let task = Task {
        file: readings.path(),
        shown: readings.shown(),
        scenario: &scenario,
        sound_speed_m_s: args.sound_speed,
        finds_sound_speed: args.find.contains(&FindArg::SoundSpeed),
        finds_clock_offset: args.find.contains(&FindArg::ClockOffset),
        skips_bad_rows: args.skip_bad_rows,
        tool_on: args.tool_on.as_deref(),
    };
    let inputs: Vec<&Path> =
        [&args.readings, &args.scenario].into_iter().chain(&args.tool_on).map(PathBuf::as_path).collect();
    args.output.as_ref().map_or(Ok(()), |file| check_free(file, Some(args.force), &inputs))?;
    let survey = task.survey()?;
    let mut ranging =
        Ranging::new(&scenario.sim.world.stations, survey.session.unwrap_or_default().sound_speed);
    let (tally, doubts, kept) = match &args.output {
        Some(file) => {
            fill_file("the fixes", file, |out| located((args, &task, &survey), &mut ranging, Some(out)))?
        }
        None => located((args, &task, &survey), &mut ranging, None)?,
    };
    if args.json {
        say_json("the results", &figures(args, &scenario, &survey, (&tally, &doubts, &ranging)))?;
    } else {
        say(&words::human(args, &scenario, &survey, (&tally, &doubts, &ranging), readings.shown()))?;
    }
    match &kept {
        Some(kept) if kept.problem().is_some() => warn_line(&kept.text()),
        Some(kept) if !args.json => say_line(&kept.text())?,
        _ => {}
    }
    let result = if tally.has_fix() { COMPLETE } else { ENDED_OTHERWISE };
    Ok(ExitCode::from(exit_code(result, kept.as_ref())))
}

/// Locates the robot, and writes the fixes to a file if one is wanted.
fn located(
    (args, task, survey): (&LocateArgs, &Task, &Survey),
    ranging: &mut Ranging,
    out: Option<&mut File>,
) -> anyhow::Result<(Tally, Doubts, Option<Kept>)> {
    let scenario = task.scenario;
    let begin = |out| Fixes::new(BufWriter::new(out), &scenario.sim.world.stations);
    let mut table = out.map(begin).transpose()?;
    let mut log = if args.no_record {
        None
    } else {
        Some(RunLog::create(&args.logs.folder(), &scenario.name, "located", scenario.seed)?)
    };
    let (mut tally, mut refused) = (Tally::default(), None);
    let doubts = task.locate(survey, |events: &[Event]| {
        tally.take(events);
        for event in events {
            ranging.apply(event.t_s, &event.kind);
        }
        if let Some(log) = &mut log {
            log.keep(events);
        }
        if let Some(Err(error)) = table.as_mut().map(|table| table.take(events)) {
            refused = Some(error);
        }
    })?;
    if let Some(table) = table {
        refused.map_or_else(|| table.finish(), Err)?;
    }
    let calls = PlannerCalls { plan: 0, step: 0, p50_us: None, p99_us: None, faults: 0 };
    let kept = log.and_then(|log| log.close(CLOSE_TIMEOUT, calls, None, &Expect::default()).kept);
    Ok((tally, doubts, kept))
}

fn figures<'a>(
    args: &LocateArgs,
    scenario: &'a Scenario,
    survey: &'a Survey,
    (tally, doubts, ranging): (&'a Tally, &'a Doubts, &Ranging),
) -> Figures<'a> {
    let pair = |(value, sigma): (f64, f64)| [value, sigma];
    let found = |what| survey.calibration.as_ref().filter(|_| args.find.contains(&what));
    let scale = found(FindArg::SoundSpeed).map(|calibration| pair(calibration.scale()));
    Figures {
        rows: survey.rows,
        bad_rows: survey.bad,
        ignored_columns: &survey.ignored,
        kind: survey.kind.word(),
        // Ranges that are too long by a fraction were computed with a speed of sound too high by the same fraction.
        sound_speed_m_per_s: scale
            .zip(args.sound_speed)
            .map(|([scale, sigma], speed)| [speed / (1.0 + scale), speed * sigma]),
        range_scale: scale,
        clock_offset_m: found(FindArg::ClockOffset).map(|calibration| pair(calibration.offset_m())),
        calibration: ranging.calibration(),
        session: session(scenario, survey),
        repeated_readings: repeated(scenario, survey),
        pulse_tests: survey.pulses.iter().map(|pulsed| pulsed_figures(scenario, survey, pulsed)).collect(),
        sides: Sides {
            by_walls: doubts.sides_by_walls,
            by_start_and_track: doubts.sides_by_track,
            undecided: doubts.sides_open,
        },
        motion_contradicted: survey.contradicted.map(|found| [found.contradicting, found.sound]),
        impossible: impossible(scenario, doubts),
        first_time: survey.dates.as_ref().map(|[first, _]| first.as_str()),
        tally,
    }
}

fn name_of(scenario: &Scenario, id: u32) -> &str {
    let station = scenario.sim.world.stations.iter().find(|station| station.id.0 == id);
    station.map_or("?", |station| station.name.as_str())
}

fn session<'a>(scenario: &'a Scenario, survey: &Survey) -> Session<'a> {
    let verdict = &survey.verdict;
    let of = |wrong: &Wrong| TooLong { value: wrong.value, sigma: wrong.sigma, proven: wrong.is_proven };
    let station = |(id, wrong): &(StationId, Wrong)| (name_of(scenario, id.0), of(wrong));
    Session {
        scale: verdict.scale.as_ref().map(of),
        offset_m: verdict.offset_m.as_ref().map(of),
        stations_m: verdict.stations.iter().map(station).collect(),
    }
}

fn pulsed_figures<'a>(scenario: &'a Scenario, survey: &Survey, pulsed: &Pulsed) -> PulseFigures<'a> {
    let test = &pulsed.test;
    let offset =
        |(id, offset): &(StationId, Estimated)| (name_of(scenario, id.0), [offset.value, offset.sigma]);
    PulseFigures {
        phase: pulsed.phase,
        t_s: pulsed.t_s - survey.first_s,
        pulses: test.pulses,
        range_scale: [test.scale.value, test.scale.sigma],
        clock_offsets_m: test.offsets_m.iter().map(offset).collect(),
        survey: test.integrity,
        suspect: test.suspect.map(|id| name_of(scenario, id.0)),
    }
}

fn repeated<'a>(scenario: &'a Scenario, survey: &Survey) -> Option<RepeatedReadings<'a>> {
    let worst = survey.repeats.worst?;
    Some(RepeatedReadings {
        emissions: survey.repeats.emissions,
        scatter_over_noise: survey.repeats.factor(),
        suspect: survey.repeats.are_wide() || survey.repeats.wide > 0,
        widest_station: name_of(scenario, worst.station.0),
        widest_m: worst.apart_m,
        widest_t_s: worst.t_s - survey.first_s,
    })
}

fn impossible<'a>(scenario: &'a Scenario, doubts: &Doubts) -> Vec<Impossible<'a>> {
    let of = |(id, refused): (&u32, &Refused)| Impossible {
        station: name_of(scenario, *id),
        count: refused.count,
        first_m: refused.range_m.is_finite().then_some(refused.range_m),
        most_m: refused.most_m,
        first_t_s: refused.t_s,
    };
    doubts.impossible.iter().map(of).collect()
}
