//! The summary that a person reads when a run is over.

mod floor;

pub(crate) use floor::lines as floor_lines;

use crate::{
    account::{Account, MissReason, Shares},
    summary::{Coverage, PlannerCalls, Positioning, Stops, Summary, Tether, Tracking},
};
use mission::Outcome;
use std::fmt::{Display, Write};

/// Width of the column of labels.
const LABEL: usize = 15;

/// The summary as text: warnings first, then one labelled line for each figure, with units; every percentage names
/// what it is a share of.
pub fn human(run: &Summary) -> String {
    let mut text = Text(title(run) + "\n\n");
    let warnings = warnings(run);
    for warning in &warnings {
        text.line("WARNING", warning);
    }
    if !warnings.is_empty() {
        text.0.push('\n');
    }
    text.line("outcome", outcome(run));
    text.some("mission time", mission_time(run));
    text.some("path", path(run));
    for line in run.coverage.iter().flat_map(coverage) {
        text.next("coverage", line);
    }
    for (label, line) in run.floor.iter().flat_map(floor::lines) {
        text.next(label, line);
    }
    for line in run.tracking.iter().flat_map(tracking) {
        text.next("tracking", line);
    }
    for line in run.positioning.iter().flat_map(positioning) {
        text.next("positioning", line);
    }
    text.some("tether", run.tether.as_ref().map(tether));
    text.some("planner calls", run.planner_calls.as_ref().map(calls));
    text.some("stops", run.stops.as_ref().map(stops));
    text.some("under way", under_way(run));
    text.some("events sha256", run.events_sha256.as_ref());
    text.some("journal", run.logs.as_ref().and_then(|logs| logs.journal.as_ref()));
    text.some("recording", run.logs.as_ref().and_then(|logs| logs.recording.as_ref()));
    text.0
}

/// Lines with a label each.
struct Text(String);

impl Text {
    fn line(&mut self, label: &str, what: impl Display) {
        writeln!(self.0, "{label:<LABEL$}{what}").expect("writing to a string");
    }

    fn some(&mut self, label: &str, what: Option<impl Display>) {
        if let Some(what) = what {
            self.line(label, what);
        }
    }

    /// A line whose label is left out if the line before belongs to it.
    fn next(&mut self, label: &str, what: impl Display) {
        let begun = self.0.lines().any(|line| line.starts_with(&format!("{label:<LABEL$}")));
        self.line(if begun { "" } else { label }, what);
    }
}

fn title(run: &Summary) -> String {
    let or_unknown = |text: &Option<String>| text.clone().unwrap_or_else(|| "unknown".into());
    let seed = run.seed.map_or_else(|| "unknown".to_owned(), |seed| seed.to_string());
    let version = run.planner_version.as_ref().map(|version| format!(" {version}")).unwrap_or_default();
    format!("{}, planner {}{version}, seed {seed}", or_unknown(&run.scenario), or_unknown(&run.planner))
}

/// What a person should know first.
fn warnings(run: &Summary) -> Vec<String> {
    let mut found = Vec::new();
    match run.outcome {
        None => found.push(
            "the run was cut off: the figures end where the journal does and are compared with no bounds"
                .to_owned(),
        ),
        Some(Outcome::Complete) => {}
        Some(other) => found.push(format!("the mission is not complete: {}", other.word())),
    }
    found.extend(run.floor.as_ref().and_then(beyond_reel));
    if let Some(n @ 1..) = run.collisions {
        found.push(counted(n, "collision"));
    }
    if let Some(n @ 1..) = Some(run.planner_faults) {
        found.push(counted(n, "planner fault"));
    }
    if let Some(position_lost_s) =
        run.positioning.map(|p| p.position_lost_s).filter(|position_lost_s| *position_lost_s > 0.0)
    {
        found.push(format!("the position was lost for {position_lost_s:.1} s"));
    }
    if let Some(p) = run.positioning.filter(|p| p.in_95_ellipse < 0.85) {
        let share = percent(p.in_95_ellipse);
        found.push(format!(
            "the position is less sure than it says: truth in its 95 % ellipse in {share} of the ticks"
        ));
    }
    if let Some((coverage, truth)) = run.coverage.and_then(|c| Some((c, c.by_truth?)))
        && coverage.reachable - truth.reachable > 0.02
    {
        found.push(format!(
            "less was scanned than the mission believes: {} of the reachable floor by the true position, not {}",
            percent(truth.reachable),
            percent(coverage.reachable)
        ));
    }
    found.extend(run.logs.as_ref().and_then(|logs| logs.error.clone()));
    found.extend(run.violations.iter().flatten().map(|miss| format!("not as expected: {miss}")));
    found
}

/// That floor was left out because the cable does not lead there.
fn beyond_reel(floor: &Account) -> Option<String> {
    let is_beyond = floor.missed.iter().any(|area| area.reason == MissReason::BeyondReel);
    let Shares { area_m2, percent, .. } = floor.reachable;
    is_beyond.then(|| {
        format!(
            "not all of the reachable floor is scanned, but {:.1} % of its {area_m2:.1} m²: some lies beyond the reel",
            percent.scanned
        )
    })
}

fn outcome(run: &Summary) -> String {
    let word = run.outcome.map_or("cut off", Outcome::word);
    run.reason.as_ref().map_or_else(|| word.to_owned(), |reason| format!("{word}: {reason}"))
}

fn mission_time(run: &Summary) -> Option<String> {
    let (time_s, ticks) = (run.mission_time_s?, run.ticks?);
    let computed = run.wall_time_s.map(|wall_s| format!(", computed in {wall_s:.2} s")).unwrap_or_default();
    Some(format!("{time_s:.1} s in {}{computed}", counted(ticks, "tick")))
}

fn path(run: &Summary) -> Option<String> {
    let mut parts = vec![format!("{:.2} m", run.path_length_m?)];
    parts.extend(run.clearance_min_m.map(|least_m| format!("smallest clearance {least_m:.3} m")));
    parts.extend(
        run.turns.zip(run.rotation_turns).map(|(turns, rotation)| {
            format!("{} and {rotation:.1} rotations in all", counted(turns, "turn"))
        }),
    );
    parts.extend(run.collisions.map(|n| counted(n, "collision")));
    Some(parts.join(", "))
}

fn coverage(coverage: &Coverage) -> Vec<String> {
    let shares = |reachable: f64, whole: f64, by: &str| {
        let (reachable, whole) = (percent(reachable), percent(whole));
        format!("{reachable} of the reachable floor, {whole} of the whole floor, by the {by} position")
    };
    let mut lines = vec![shares(coverage.reachable, coverage.whole, "estimated")];
    lines.extend(coverage.by_truth.map(|truth| shares(truth.reachable, truth.whole, "true")));
    lines.push(format!("{:.2} m² of the reachable floor missed", coverage.missed_area_m2));
    lines.extend(
        coverage.overlap.map(|share| format!("{} of the scanned floor scanned again", percent(share))),
    );
    lines
}

fn tracking(tracking: &Tracking) -> Vec<String> {
    let near_m = Tracking::NEAR_M;
    let mut lines = vec![
        format!(
            "{} of the way within {near_m} m of the preset path (precision)",
            percent(tracking.precision)
        ),
        format!("{} of the preset points within {near_m} m of the way (recall)", percent(tracking.recall)),
    ];
    let across = format!("rms distance {:.3} m across the track", tracking.cross_track_rmse_m);
    let points = tracking.rmse_m.map(|rmse_m| format!(", {rmse_m:.3} m from the preset points"));
    lines.push(across + &points.unwrap_or_default());
    lines
}

fn positioning(positioning: &Positioning) -> Vec<String> {
    let Positioning { mean_error_m, p50_m, p95_m, max_m, in_95_ellipse, position_lost_s } = positioning;
    vec![
        format!(
            "error {mean_error_m:.3} m mean, {p50_m:.3} m median, {p95_m:.3} m in 95 % of the ticks, {max_m:.3} m at most"
        ),
        format!(
            "truth in the 95 % ellipse in {} of the ticks, lost for {position_lost_s:.1} s",
            percent(*in_95_ellipse)
        ),
    ]
}

fn tether(tether: &Tether) -> String {
    let state = match tether {
        Tether { entangled: true, .. } => "ENTANGLED",
        Tether { snagged: true, .. } => "SNAGGED",
        _ => "free",
    };
    let snagged = match tether.snags {
        0 => String::new(),
        1 => ", snagged once on something unseen".into(),
        n => format!(", snagged {n} times on something unseen"),
    };
    format!(
        "{state}, {:.1} m out at the end, {:.1} m at most, wrapped {:.0} deg about one obstacle at most, {}{snagged}",
        tether.end_length_m,
        tether.tether_length_max_m,
        tether.wrap_max_rad.to_degrees(),
        counted(tether.loops, "loop")
    )
}

fn calls(calls: &PlannerCalls) -> String {
    let PlannerCalls { plan, step, p50_us, p99_us, faults } = calls;
    let (plans, steps, faults) = (counted(*plan, "plan"), counted(*step, "step"), counted(*faults, "fault"));
    let time = |value: &Option<f64>| value.map_or_else(|| "-".into(), |us| format!("{us:.0} µs"));
    format!("{plans}, {steps} of {} median and {} in 99 %, {faults}", time(p50_us), time(p99_us))
}

fn stops(stops: &Stops) -> String {
    let Stops { count, p50_ms, p99_ms, max_ms } = stops;
    format!("{count}, key to command p50 {p50_ms:.1} ms, p99 {p99_ms:.1} ms, max {max_ms:.1} ms")
}

fn under_way(run: &Summary) -> Option<String> {
    let mut parts = Vec::new();
    if run.planners.len() > 1 {
        parts.push(format!("planners {}", run.planners.join(", ")));
    }
    parts.extend(
        (run.obstacles_found > 0).then(|| format!("{} found", counted(run.obstacles_found, "obstacle"))),
    );
    parts.extend((run.holds > 0).then(|| counted(run.holds, "hold")));
    (!parts.is_empty()).then(|| parts.join(", "))
}

fn counted(n: u64, what: &str) -> String {
    if n == 1 { format!("1 {what}") } else { format!("{n} {what}s") }
}

fn percent(share: f64) -> String {
    format!("{:.1} %", share * 100.0)
}
