//! The human-readable summary at the end of a run.

pub(crate) mod floor;
mod short;
pub(crate) mod text;
pub(crate) mod vehicle;

pub use short::short;

use crate::guarantee::{Rule, protection_text};
use account::{
    Account, Accuracy, Calibration, Coverage, Extreme, Figure, Limit, MissReason, PlannerCalls, Positioning,
    ReadingsSummary, Stops, Summary, Tether, Tracking, not_as_surveyed,
};
use mission::{Check, CheckOutcome, Outcome, Sandbox};
use text::{Text, counted, percent};
use world::coverage::percent_text;

/// The summary as text: warnings first, then one labelled line for each figure, with units; every percentage states
/// what it refers to.
pub fn human(run: &Summary) -> String {
    let mut text = Text::new(&title(run));
    let warnings = warnings(run);
    for warning in &warnings {
        text.line("WARNING", warning);
    }
    if !warnings.is_empty() {
        text.0.push('\n');
    }
    text.line("outcome", outcome(run));
    text.some("pre-flight", pre_flight(&run.checks));
    text.some("mission time", mission_time(run));
    text.some("path", path(run));
    text.lines(run.vehicle.iter().flat_map(vehicle::lines));
    text.lines(run.coverage.iter().flat_map(coverage).map(|line| ("coverage", line)));
    let rule = Rule::of([run.accuracy.as_ref()]);
    text.lines(run.floor.iter().flat_map(|floor| floor::lines(floor, rule)));
    text.lines(run.tracking.iter().flat_map(tracking).map(|line| ("tracking", line)));
    text.lines(run.accuracy.iter().flat_map(accuracy).map(|line| ("position", line)));
    text.lines(run.positioning.iter().flat_map(positioning).map(|line| ("true position", line)));
    text.lines(run.extremes.iter().filter_map(extreme).map(|line| ("extremes", line)));
    text.some("readings", run.readings.as_ref().map(readings));
    text.some("tether", run.tether.as_ref().map(tether));
    text.some("sandbox", run.sandbox.as_ref());
    text.lines(ranging(run));
    text.lines(run.taken_back.iter().map(|floor| ("in doubt", floor.to_string())));
    text.lines(run.zones_drawn.iter().map(|zone| ("zones drawn", zone.to_string())));
    text.lines(run.faults.iter().map(|fault| ("faults", fault.clone())));
    text.some("planner calls", run.planner_calls.as_ref().map(calls));
    text.some("stops", run.stops.as_ref().map(stops));
    text.some("during the run", during(run));
    text.some("events sha256", run.events_sha256.as_ref());
    text.some("rrd sha256", run.recording_sha256.as_ref());
    text.some("parquet sha256", run.readings_sha256.as_ref());
    text.some("journal", run.logs.as_ref().and_then(|logs| logs.journal.as_ref()));
    text.some("recording", run.logs.as_ref().and_then(|logs| logs.recording.as_ref()));
    text.0
}

/// The number of readings and indications, and the deepest indication.
fn readings(readings: &ReadingsSummary) -> String {
    let ReadingsSummary { count, untestable, indications, deepest, .. } = readings;
    let deepest = deepest.as_ref().map_or_else(String::new, |loss| {
        format!(
            ", the deepest {:.1} ± {:.1} mm at {:.2}, {:.2} m",
            loss.depth_mm, loss.depth_error_mm, loss.at.x, loss.at.y
        )
    });
    let found = counted(*indications, "indication");
    format!("{}, {untestable} of them beside welds; {found}{deepest}", counted(*count, "reading"))
}

/// The checks before the start: the number passed, every warning, and every item that the operator ticked.
pub(crate) fn pre_flight(checks: &[Check]) -> Option<String> {
    let of = |outcome| checks.iter().filter(move |check| check.outcome == outcome);
    let passed = of(CheckOutcome::Passed).count();
    let warnings =
        of(CheckOutcome::Warning).map(|check| format!("; WARNING {}: {}", check.what, check.found));
    let ticked = of(CheckOutcome::Ticked).map(|check| {
        let who = if check.found.is_empty() { String::new() } else { format!(" ({})", check.found) };
        format!("; by hand: {}{who}", check.what)
    });
    let rest: String = warnings.chain(ticked).collect();
    let automatic = checks.len() - of(CheckOutcome::Ticked).count();
    (!checks.is_empty()).then(|| format!("{passed} of {automatic} automatic checks passed{rest}"))
}

fn title(run: &Summary) -> String {
    let or_unknown = |text: &Option<String>| text.clone().unwrap_or_else(|| "unknown".into());
    if let Some(file) = &run.located {
        return format!("{}, located from the readings in {file}", or_unknown(&run.scenario));
    }
    if let Some(vehicle) = &run.vehicle {
        let (scenario, planner) = (or_unknown(&run.scenario), or_unknown(&run.planner));
        return format!("LIVE: {}, {scenario}, planner {planner}", vehicle.name);
    }
    let seed = run.seed.map_or_else(|| "unknown".to_owned(), |seed| seed.to_string());
    let version = run.planner_version.as_ref().map(|version| format!(" {version}")).unwrap_or_default();
    format!("{}, planner {}{version}, seed {seed}", or_unknown(&run.scenario), or_unknown(&run.planner))
}

/// The warnings that a reader must see first.
fn warnings(run: &Summary) -> Vec<String> {
    let mut found = Vec::new();
    match run.outcome {
        None if is_open(run) => found.push(
            "run in progress: the figures cover the journal as far as it has been read, and are not \
             checked against [expect]"
                .to_owned(),
        ),
        None => found.push(
            "run cut off: the figures cover the journal up to its end, and are not checked against [expect]"
                .to_owned(),
        ),
        Some(Outcome::Complete) => {}
        Some(other) => found.push(format!("mission not complete: {}", other.word())),
    }
    found.extend(run.floor.as_ref().and_then(beyond_reel));
    found.extend(not_as_surveyed(&run.pulse_tests));
    let failed = run.pulse_tests.iter().filter(|test| !test.agrees);
    found.extend(failed.map(|test| test.found.clone()));
    if let Some(n @ 1..) = run.collisions {
        found.push(counted(n, "collision"));
    }
    if let Some(n @ 1..) = run.vehicle.as_ref().map(|vehicle| vehicle.stops_not_confirmed) {
        found.push(format!("STOP NOT CONFIRMED {}", counted(n, "time")));
    }
    if let n @ 1.. = run.planner_faults {
        found.push(counted(n, "planner fault"));
    }
    found.extend(
        run.sandbox
            .as_ref()
            .filter(|sandbox| **sandbox != Sandbox::Full)
            .map(|sandbox| format!("planners were not fully sandboxed: sandbox {sandbox}")),
    );
    if let Some(position_lost_s) =
        run.positioning.map(|p| p.position_lost_s).filter(|position_lost_s| *position_lost_s > 0.0)
    {
        found.push(format!("position lost for {position_lost_s:.1} s"));
    }
    if let Some(p) = run.positioning.filter(|p| p.in_95_ellipse < 0.85) {
        let share = percent(p.in_95_ellipse);
        found.push(format!(
            "position error underestimated: true position inside the 95 % ellipse in only {share} of ticks"
        ));
    }
    let to_scan = run.coverage.filter(|coverage| coverage.missed_area_m2.is_some());
    if let Some((coverage, truth)) = to_scan.and_then(|c| Some((c, c.by_truth?)))
        && coverage.reachable - truth.reachable > 0.02
    {
        let (by_truth, estimated) = (percent(truth.reachable), percent(coverage.reachable));
        found.push(format!(
            "coverage overestimated: {by_truth} of reachable floor by true position, but {estimated} by \
             estimate"
        ));
    }
    found.extend(run.logs.as_ref().and_then(|logs| logs.error.clone()));
    found.extend(run.violations.iter().flatten().map(|miss| format!("not met: {miss}")));
    found
}

/// The warning that floor was not planned because it is beyond the reach of the tether.
fn beyond_reel(floor: &Account) -> Option<String> {
    let is_beyond = floor.missed.iter().any(|area| area.reason == MissReason::BeyondReel);
    let (scanned, area_m2) = (floor.reachable.percent.scanned, floor.reachable.area_m2);
    is_beyond.then(|| {
        format!(
            "only {scanned:.1} % of {area_m2:.1} m² of reachable floor scanned: some of the floor is beyond \
            the reach of the tether"
        )
    })
}

/// The worst value of a figure, with time, place and limit.
fn extreme(Figure { id, limit, worst, .. }: &Figure) -> Option<String> {
    let Extreme { value, t_s, at } = (*worst)?;
    let (decimals, unit) = (id.decimals(), id.unit());
    let space = if unit == "°" { "" } else { " " };
    let amount = |value: f64| format!("{value:.decimals$}{space}{unit}");
    let limit = limit.map(|limit| match limit {
        Limit::Most(most) => format!(", limit {}", amount(most)),
        Limit::Least(least) => format!(", at least {} required", amount(least)),
    });
    let (value, x, y) = (amount(value), at.x + 0.0, at.y + 0.0);
    Some(format!("{}: {value} at {t_s:.1} s, {x:.2}, {y:.2} m{}", id.name(), limit.unwrap_or_default()))
}

/// Whether the run is still being written.
fn is_open(run: &Summary) -> bool {
    run.logs.as_ref().is_some_and(|logs| logs.is_open)
}

fn outcome(run: &Summary) -> String {
    let without_end = if is_open(run) { "in progress" } else { "cut off" };
    let word = run.outcome.map_or(without_end, Outcome::word);
    run.reason.as_ref().map_or_else(|| word.to_owned(), |reason| format!("{word}: {reason}"))
}

fn mission_time(run: &Summary) -> Option<String> {
    let (time_s, ticks) = (run.mission_time_s?, run.ticks?);
    let computed = run.wall_time_s.map(|wall_s| format!(", computed in {wall_s:.2} s")).unwrap_or_default();
    Some(format!("{time_s:.1} s in {}{computed}", counted(ticks, "tick")))
}

fn path(run: &Summary) -> Option<String> {
    let mut parts = vec![format!("{:.2} m", run.path_length_m?)];
    parts.extend(run.clearance_min_m.map(|least_m| format!("minimum clearance {least_m:.3} m")));
    parts.extend(run.turns.map(|turns| counted(turns, "turn")));
    parts.extend(run.rotation_turns.map(|turns| format!("{turns:.1} rotations in total")));
    parts.extend(run.collisions.map(|n| counted(n, "collision")));
    Some(parts.join(", "))
}

fn coverage(coverage: &Coverage) -> Vec<String> {
    let shares = |reachable: f64, whole: f64, by: &str| {
        let (reachable, whole) = (percent(reachable), percent(whole));
        format!("{reachable} of reachable floor, {whole} of whole floor ({by} position)")
    };
    let mut lines = vec![shares(coverage.reachable, coverage.whole, "estimated")];
    lines.extend(coverage.by_truth.map(|truth| shares(truth.reachable, truth.whole, "true")));
    lines.extend(
        coverage.missed_area_m2.map(|missed_m2| format!("{missed_m2:.2} m² of reachable floor missed")),
    );
    let claims = coverage.by_truth.and_then(|truth| Some((truth.scanned_truly?, truth.guaranteed_truly)));
    lines.extend(claims.map(|(scanned, guaranteed)| {
        let guaranteed = guaranteed
            .map(|share| format!(" and {} % of the floor claimed as guaranteed", percent_text(share, 2)));
        let (scanned, guaranteed) = (percent(scanned), guaranteed.unwrap_or_default());
        format!("truly scanned: {scanned} of the floor claimed as scanned{guaranteed}")
    }));
    lines.extend(coverage.overlap.map(|share| format!("overlap {}", text::overlap(share))));
    lines
}

fn tracking(tracking: &Tracking) -> Vec<String> {
    let near_m = Tracking::NEAR_M;
    let (precision, recall) = (percent(tracking.precision), percent(tracking.recall));
    let points = tracking.rmse_m.map(|rmse_m| format!(", {rmse_m:.3} m from the preset points"));
    vec![
        format!("{precision} of the driven path within {near_m} m of the preset path (precision)"),
        format!("{recall} of the preset points within {near_m} m of the driven path (recall)"),
        format!("RMS error {:.3} m cross-track{}", tracking.cross_track_rmse_m, points.unwrap_or_default()),
    ]
}

fn accuracy(accuracy: &Accuracy) -> Vec<String> {
    let Accuracy {
        mean_m,
        p95_m,
        max_m,
        limit_m,
        over_limit,
        fixes,
        stations_mean,
        stations_min,
        protection,
    } = accuracy;
    let over = percent(*over_limit);
    let mut lines = vec![format!(
        "95 % error from covariance {mean_m:.3} m mean, {p95_m:.3} m p95, {max_m:.3} m maximum, above the \
         limit of {limit_m} m on {over} of the path"
    )];
    lines.extend(stations_mean.zip(*stations_min).map(|(mean, least)| {
        format!(
            "{} from {mean:.1} stations on average, at least {least}",
            format_args!("{fixes} {}", if *fixes == 1 { "fix" } else { "fixes" })
        )
    }));
    lines.extend(protection.iter().map(protection_text));
    lines
}

/// The speed of sound, wrong stations, clocks and pulse tests that agreed; the warnings contain the other tests.
fn ranging(run: &Summary) -> Vec<(&'static str, String)> {
    let mut lines: Vec<_> = run
        .calibration
        .iter()
        .flat_map(Calibration::sentences)
        .map(|sentence| ("calibration", sentence))
        .collect();
    let agreed = run.pulse_tests.iter().filter(|test| test.agrees);
    lines.extend(agreed.map(|test| ("calibration", test.found.clone())));
    if !run.clocks.is_empty() {
        let clocks: Vec<String> = run.clocks.iter().map(ToString::to_string).collect();
        lines.push(("calibration", format!("clocks, as lengths that sound travels: {}", clocks.join(", "))));
    }
    lines
}

fn positioning(positioning: &Positioning) -> Vec<String> {
    let Positioning { mean_error_m, p50_m, p95_m, max_m, in_95_ellipse, position_lost_s } = positioning;
    let inside = percent(*in_95_ellipse);
    vec![
        format!(
            "error {mean_error_m:.3} m mean, {p50_m:.3} m median, {p95_m:.3} m p95, {max_m:.3} m maximum"
        ),
        format!(
            "true position inside the 95 % ellipse in {inside} of ticks, position lost for \
             {position_lost_s:.1} s"
        ),
    ]
}

fn tether(tether: &Tether) -> String {
    let state = match tether {
        Tether { broken_at_s: Some(_), .. } => "BROKEN",
        Tether { entangled: true, .. } => "ENTANGLED",
        Tether { snagged: true, .. } => "SNAGGED",
        _ => "free",
    };
    let snags = match tether.snags {
        0 => String::new(),
        n => format!(", {}", counted(n, "snag")),
    };
    let over_own = match tether.over_own {
        None | Some(0) => String::new(),
        Some(n) => format!(", hull over its own tether {}", counted(n, "time")),
    };
    let torn = match tether {
        Tether { torn_at_end: true, broken_at_s: None, .. } => ", truly torn when the run ended",
        _ => "",
    };
    format!(
        "{state}{torn}, {:.1} m out at the end, {:.1} m maximum, largest wrap {:.0}°, {}{snags}{over_own}",
        tether.end_length_m,
        tether.tether_length_max_m,
        tether.wrap_max_rad.to_degrees(),
        counted(tether.loops, "loop"),
    )
}

fn calls(calls: &PlannerCalls) -> String {
    let PlannerCalls { plan, step, p50_us, p99_us, faults } = calls;
    let (plans, steps, faults) = (counted(*plan, "plan"), counted(*step, "step"), counted(*faults, "fault"));
    let time = |value: &Option<f64>| value.map_or_else(|| "-".into(), |us| format!("{us:.0} µs"));
    format!("{plans}, {steps} (p50 {}, p99 {}), {faults}", time(p50_us), time(p99_us))
}

fn stops(stops: &Stops) -> String {
    let Stops { count, p50_ms, p99_ms, max_ms } = stops;
    format!("{count}, key to command p50 {p50_ms:.1} ms, p99 {p99_ms:.1} ms, max {max_ms:.1} ms")
}

fn during(run: &Summary) -> Option<String> {
    let mut parts = Vec::new();
    if run.planners.len() > 1 {
        parts.push(format!("planners {}", run.planners.join(", ")));
    }
    // The objects of a survey are those of its map.
    parts.extend(
        (run.obstacles_found > 0 && run.explored.is_none())
            .then(|| format!("{} found", counted(run.obstacles_found, "obstacle"))),
    );
    parts.extend((run.holds > 0).then(|| counted(run.holds, "hold")));
    (!parts.is_empty()).then(|| parts.join(", "))
}

#[cfg(test)]
mod tests;
