//! The text that `tankops locate` prints.

use super::{figures, name_of};
use crate::cli::LocateArgs;
use ::locate::{Doubts, Kind, Pulsed, Survey, Tally};
use account::Ranging;
use mission::{
    clock,
    event::{change_text, pulse_text},
};
use positioning::{Agreement, SessionConfig, Wrong};
use report::forecast::line_of_stations;
use scenario::Scenario;
use std::fmt::Write as _;

/// Relative uncertainty of the speed of sound above which it cannot correct ranges reliably.
const DOUBTFUL_SCALE: f64 = 0.005;

/// Number of standard deviations above which an error in the speed of sound is reported.
const SURE_SIGMAS: f64 = 4.0;

/// Lines that each begin with a label.
#[derive(Default)]
struct Lines(String);

impl Lines {
    fn line(&mut self, label: &str, value: impl AsRef<str>) {
        // Writing to a String cannot fail.
        let _ = writeln!(self.0, "{label:<16} {}", value.as_ref());
    }

    /// Appends several lines under one label.
    fn lines(&mut self, label: &str, values: impl IntoIterator<Item = String>) {
        let mut label = label;
        for value in values {
            self.line(std::mem::take(&mut label), value);
        }
    }
}

/// The results as text for people.
pub(super) fn human(
    args: &LocateArgs,
    scenario: &Scenario,
    survey: &Survey,
    (tally, doubts, ranging): (&Tally, &Doubts, &Ranging),
    shown: &str,
) -> String {
    let mut text = Lines::default();
    of_file(&mut text, survey, shown);
    text.line("tool", tool(survey));
    text.lines("pulses", pulses(scenario, survey));
    of_sound(&mut text, args, scenario, survey, (tally, doubts, ranging));
    text.lines("calibration", calibration(scenario, survey, ranging));
    text.lines("residuals", residuals(args, scenario, survey));
    text.lines("repetitions", repetitions(scenario, survey));
    text.lines("left out", impossible(scenario, doubts));
    let fixes: u64 = tally.fixes.values().sum();
    let by_word: Vec<String> = tally.fixes.iter().map(|(word, count)| format!("{count} {word}")).collect();
    let by_word = if by_word.is_empty() { String::new() } else { format!(" ({})", by_word.join(", ")) };
    text.line("fixes", format!("{fixes} of {} emissions{by_word}", tally.emissions));
    text.lines("sides", sides(scenario, doubts));
    if let Some(off_m) = start_off_m(scenario, tally) {
        let note = "the track is wrong until three consecutive fixes agree; correct the start";
        text.line(
            "start",
            format!("the first fix is {off_m:.2} m from robot.start_m of the scenario: {note}"),
        );
    }
    for (why, count) in &tally.failed {
        let times = if *count == 1 { "once".to_owned() } else { format!("{count} times") };
        text.line("no fix", format!("{times}: {why}"));
    }
    for (id, count) in &tally.left_out {
        let name = name_of(scenario, *id);
        let fixes = if *count == 1 { "fix" } else { "fixes" };
        text.line("left out", format!("station {name} from {count} {fixes}: residual exceeded the gate"));
    }
    let metres = |[mean_m, most_m]: [f64; 2]| format!("{mean_m:.3} m mean, {most_m:.3} m maximum");
    let figures = [
        ("track", "95 % error from covariance", tally.error_95_m),
        ("true error", "of fixes", tally.fix_error_m),
        ("", "of the track", tally.track_error_m),
    ];
    for (label, what, figures) in figures {
        if let Some(figures) = figures {
            text.line(label, format!("{what} {}", metres(figures)));
        }
    }
    text.0
}

/// The pulse tests of the stations, one line each, each followed by its consequence if it has one.
fn pulses(scenario: &Scenario, survey: &Survey) -> Vec<String> {
    let (mut lines, mut before) = (Vec::new(), None);
    let took_part =
        |id| survey.pulses.iter().any(|p| p.test.offsets_m.iter().any(|(station, _)| *station == id));
    let absent = scenario.sim.world.stations.iter().filter(|station| !took_part(station.id));
    let absent: Vec<&str> = absent.map(|station| station.name.as_str()).collect();
    for Pulsed { phase, test, .. } in &survey.pulses {
        let text = pulse_text(*phase, test, &scenario.sim.world.stations);
        lines.push(text.strip_prefix("pulse test ").unwrap_or(&text).to_owned());
        if !test.is_usable() {
            lines.push(format!("the test {} corrects no range", phase.words()));
            continue;
        }
        lines.extend(before.replace(test).and_then(|before| change_text(before, test)));
    }
    if !survey.pulses.is_empty() && !absent.is_empty() {
        lines.push(format!(
            "took part in no test: {}; left out, because its clock is unknown",
            absent.join(", ")
        ));
    }
    if let [_] = survey.pulses.as_slice() {
        lines.push(
            "one test only: clocks that drift stay unnoticed; let the stations send pulses before and after the run"
                .into(),
        );
    }
    lines
}

/// The speed of sound and the wrong stations that the session calibration has found.
fn calibration(scenario: &Scenario, survey: &Survey, ranging: &Ranging) -> Vec<String> {
    if scenario.mission.locating.session.is_some() && survey.session.is_none() {
        let least = SessionConfig::least_stations(survey.kind == Kind::Differences);
        let why = if survey.verdict.is_length_alone() {
            "it does not estimate a length common to all ranges (see residuals)".into()
        } else {
            format!("{} need at least {least} stations for it", survey.kind.word())
        };
        return vec![format!("ae.session_calibration not used: {why}")];
    }
    let mut lines = ranging.calibration().map(|found| found.sentences()).unwrap_or_default();
    if let Some(since_s) = ranging.not_separable_since_s() {
        lines.push(format!(
            "since T+{}, a wrong station and a wrong speed of sound cannot be told apart: the robot must pass both close \
             to stations and far from them",
            clock(since_s)
        ));
    }
    lines
}

fn of_file(text: &mut Lines, survey: &Survey, shown: &str) {
    text.line("readings", format!("{shown}, {} rows of {}", survey.rows, survey.kind.word()));
    if let Some([first, last]) = &survey.dates {
        text.line("time", format!("{first} to {last} (UTC); mission time counts from the first reading"));
    }
    if survey.bad > 0 {
        text.line("left out", format!("bad rows: {}", survey.bad));
        survey.problems.iter().for_each(|problem| text.line("", problem.to_string()));
    }
    if !survey.ignored.is_empty() {
        text.line("ignored columns", survey.ignored.join(", "));
    }
    if let Some(Agreement { sound, contradicting }) = survey.contradicted {
        text.line(
            "motion",
            format!(
                "not used: {contradicting} of {sound} fixes contradict it; check the sign and unit of \
                 forward_m, sideways_m and turn_rad, the robot's start heading, and the stations"
            ),
        );
    } else if !survey.has_motion {
        text.line(
            "motion",
            "not measured; the robot is assumed to move in any direction at up to its maximum speed",
        );
    }
}

fn of_sound(
    text: &mut Lines,
    args: &LocateArgs,
    scenario: &Scenario,
    survey: &Survey,
    told: (&Tally, &Doubts, &Ranging),
) {
    let found = figures(args, scenario, survey, told);
    if let Some([scale, sigma]) = found.range_scale {
        let speed = found.sound_speed_m_per_s.map(|[speed, sigma]| format!(", {speed:.2} ± {sigma:.2} m/s"));
        let (percent, sigma) = (scale * 100.0, sigma * 100.0);
        text.line(
            "speed of sound",
            format!("ranges too long by {percent:.3} ± {sigma:.3} %{}", speed.unwrap_or_default()),
        );
    }
    if let Some([offset_m, sigma_m]) = found.clock_offset_m {
        let time = args.sound_speed.map(|speed| format!(", {:.1} µs", offset_m / speed * 1e6));
        text.line(
            "clock offset",
            format!("ranges too long by {offset_m:.4} ± {sigma_m:.4} m{}", time.unwrap_or_default()),
        );
    }
    let wrong = survey.verdict.stations.iter().filter(|(_, wrong)| wrong.is_proven);
    let wrong: Vec<&str> = wrong.map(|(id, _)| name_of(scenario, id.0)).collect();
    if survey.calibration.is_some() && !wrong.is_empty() {
        let wrong = wrong.join(", ");
        text.line(
            "",
            format!(
                "not reliable: wrong ranges ({wrong}) have spoilt the estimate; correct or remove them first"
            ),
        );
    }
    if found.range_scale.is_some_and(|[_, sigma]| sigma > DOUBTFUL_SCALE) {
        text.line("", "poorly determined: the robot must pass both close to stations and far from them");
    }
}

/// Errors in the speed of sound, the clocks and the stations, as proven by the residuals.
fn residuals(args: &LocateArgs, scenario: &Scenario, survey: &Survey) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(scale) = survey.verdict.scale.filter(|scale| scale.is_proven) {
        let (percent, sigma) = (scale.value.abs() * 100.0, scale.sigma * 100.0);
        let long = if scale.value > 0.0 { "too long" } else { "too short" };
        let speed = args.sound_speed.map(|speed| speed / (1.0 + scale.value));
        let fits =
            speed.map_or_else(String::new, |speed| format!("; a speed of sound of {speed:.1} m/s fits"));
        let remedy = if survey.calibration.is_some() {
            "the estimate of --find does not explain them; look for a wrong station or a wrong survey"
        } else {
            "correct the speed of sound, or estimate it with --find sound-speed"
        };
        lines.push(format!(
            "all ranges are {long} by {percent:.2} ± {sigma:.2} %{fits}: none of the fixes is ok; {remedy}"
        ));
    }
    if let Some(offset) = survey.verdict.offset_m.filter(|offset| offset.is_proven) {
        let long = if offset.value > 0.0 { "too long" } else { "too short" };
        lines.push(format!(
            "all ranges are {long} by {:.3} ± {:.3} m: none of the fixes is ok; correct the clocks or the height of the \
             sensors, or estimate the offset with --find clock-offset",
            offset.value.abs(),
            offset.sigma
        ));
    }
    let harmless = |scale: &Wrong| !scale.is_proven && scale.value.abs() > SURE_SIGMAS * scale.sigma;
    if let Some(scale) = survey.verdict.scale.filter(harmless).filter(|_| !survey.verdict.is_wrong()) {
        lines.push(format!(
            "all ranges differ by {:+.3} ± {:.3} % from those that the scenario implies; this moves fixes by \
             less than their stated errors",
            scale.value * 100.0,
            scale.sigma * 100.0
        ));
    }
    for (id, wrong) in survey.verdict.stations.iter().filter(|(_, wrong)| wrong.is_proven) {
        let long = if wrong.value > 0.0 { "too long" } else { "too short" };
        lines.push(format!(
            "the ranges of station {} are {long} by {:.3} ± {:.3} m: none of the fixes is ok; correct its position in the \
             scenario, its clock or its threshold, or leave out its rows",
            name_of(scenario, id.0),
            wrong.value.abs(),
            wrong.sigma
        ));
    }
    lines
}

/// Stations whose readings of one emission scatter too widely to be repetitions.
fn repetitions(scenario: &Scenario, survey: &Survey) -> Vec<String> {
    let repeats = &survey.repeats;
    if repeats.are_narrow() {
        return vec![format!(
            "readings of one station in one emission scatter {:.2} times as widely as the noise in the \
             scenario: they count as one reading",
            repeats.factor()
        )];
    }
    let Some(worst) = repeats.worst.filter(|_| repeats.are_wide() || repeats.wide > 0) else {
        return Vec::new();
    };
    let mut lines = vec![format!(
        "{} has {} readings at {:.3} s, {:.0} mm apart: repetitions, or separate emissions?",
        name_of(scenario, worst.station.0),
        worst.count,
        worst.t_s - survey.first_s,
        worst.apart_m * 1e3
    )];
    let emissions = repeats.emissions;
    lines.push(if repeats.are_wide() {
        format!(
            "in {emissions} emissions, readings of one station scatter {:.1} times as widely as the noise in \
             the scenario: none of their fixes is ok; give each emission its own time, or its own name in a \
             column `emission`",
            repeats.factor()
        )
    } else {
        format!(
            "in {} of {emissions} emissions with several readings from one station, these readings scatter too \
             widely: their fixes are not ok",
            repeats.wide
        )
    });
    lines
}

/// Readings that fit no position in the tank.
fn impossible(scenario: &Scenario, doubts: &Doubts) -> Vec<String> {
    let all: u64 = doubts.impossible.values().map(|refused| refused.count).sum();
    if all == 0 {
        return Vec::new();
    }
    let readings = if all == 1 { "reading that is" } else { "readings that are" };
    let mut lines = vec![format!("{all} {readings} impossible in this tank")];
    lines.extend(doubts.impossible.iter().map(|(id, refused)| {
        let (name, count) = (name_of(scenario, *id), refused.count);
        let times = if count > 1 { format!(" and {} more", count - 1) } else { String::new() };
        let range = if refused.range_m.abs() > 1e9 {
            format!("{:e} m", refused.range_m)
        } else if refused.range_m.is_finite() {
            format!("{:.3} m", refused.range_m)
        } else {
            "not a number".into()
        };
        format!("station {name}: {range} at {:.3} s{times}; at most {:.2} m", refused.t_s, refused.most_m)
    }));
    lines
}

/// How the choice between fixes and their mirror images was made.
fn sides(scenario: &Scenario, doubts: &Doubts) -> Vec<String> {
    let &Doubts { sides_by_walls, sides_by_track, sides_open, .. } = doubts;
    let all = sides_by_walls + sides_by_track + sides_open;
    if all == 0 {
        return Vec::new();
    }
    let stations =
        scenario.sim.world.stations.iter().filter(|station| doubts.mirrored_by.contains(&station.id.0));
    let line = line_of_stations(&stations.cloned().collect::<Vec<_>>());
    let mut lines =
        vec![format!("fixes with an equally good mirror image on the other side of {line}: {all}")];
    if sides_by_walls > 0 {
        lines.push(format!("{sides_by_walls} decided by the wall: the other position is outside it"));
    }
    if sides_by_track > 0 {
        lines.push(format!("{sides_by_track} decided by robot.start_m and the track from there"));
    }
    if sides_open > 0 {
        let start = if doubts.contradicts_start { "robot.start_m contradicts both positions; " } else { "" };
        lines.push(format!(
            "{sides_open} cannot be decided and are not ok: {start}correct robot.start_m, or add a station off the line"
        ));
    }
    lines
}

/// The periods in which the tool was on.
fn tool(survey: &Survey) -> String {
    let Some(stretches) = &survey.tool_on_s else {
        return "unknown when it was on, so no coverage is stated (add a column tool_on, or use --tool-on FILE)"
            .into();
    };
    if stretches.is_empty() {
        return "never on, so no floor was scanned".into();
    }
    let on_s: f64 = stretches.iter().map(|[from_s, to_s]| to_s - from_s).sum();
    let heading = if survey.has_motion {
        ""
    } else {
        "; without measured motion the heading is unknown, so no floor counts as scanned"
    };
    let stretches = match stretches.len() {
        1 => "1 period".to_owned(),
        n => format!("{n} periods"),
    };
    format!("on for {on_s:.1} s in {stretches}{heading}")
}

/// The distance in metres from the start in the scenario to the first fix, if it is larger than the errors of both and
/// the robot's motion can explain.
fn start_off_m(scenario: &Scenario, tally: &Tally) -> Option<f64> {
    let (first, error_95_m) = tally.first_fix_m.zip(tally.first_fix_error_95_m)?;
    let mission = &scenario.mission;
    let moved_m = mission.limits.v_max_m_per_s * tally.first_fix_t_s.unwrap_or_default();
    let off_m = (first - mission.start.position).norm();
    (off_m > 2.0 * error_95_m + 3.0 * mission.start_sigma_m + moved_m).then_some(off_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::locate::Refused;

    fn scenario() -> Scenario {
        let text = include_str!("../../../../scenarios/goto-single-obstacle.toml");
        Scenario::parse(text, "goto-single-obstacle.toml").expect("the scenario is valid")
    }

    #[test]
    fn an_impossible_reading_is_named_with_its_station_time_and_limit() {
        let scenario = scenario();
        let station = &scenario.sim.world.stations[1];
        let with = |count, range_m| {
            let refused = Refused { count, range_m, most_m: 20.0, t_s: 3.5 };
            let doubts = Doubts { impossible: [(station.id.0, refused)].into(), ..Doubts::default() };
            impossible(&scenario, &doubts).join("\n")
        };
        assert_eq!(impossible(&scenario, &Doubts::default()), Vec::<String>::new());
        let name = &station.name;
        let one = "1 reading that is impossible in this tank";
        assert_eq!(with(1, 25.5), format!("{one}\nstation {name}: 25.500 m at 3.500 s; at most 20.00 m"));
        let three = "3 readings that are impossible in this tank";
        assert_eq!(
            with(3, f64::NAN),
            format!("{three}\nstation {name}: not a number at 3.500 s and 2 more; at most 20.00 m")
        );
    }

    #[test]
    fn mirror_images_are_counted_by_what_decided() {
        let (scenario, all) =
            (scenario(), Doubts { sides_by_walls: 1, sides_by_track: 2, sides_open: 3, ..Doubts::default() });
        assert_eq!(sides(&scenario, &Doubts::default()), Vec::<String>::new());
        let lines = sides(&scenario, &all);
        assert!(lines[0].starts_with("fixes with an equally good") && lines[0].ends_with(": 6"), "{lines:?}");
        let counts: Vec<&str> = lines[1..].iter().map(|line| &line[..1]).collect();
        assert_eq!(counts, ["1", "2", "3"], "{lines:?}");
        let contradicted = sides(&scenario, &Doubts { contradicts_start: true, ..all });
        assert!(contradicted[3].contains("robot.start_m contradicts both positions"), "{contradicted:?}");
    }

    #[test]
    fn a_start_is_wrong_only_beyond_both_errors_and_the_way_since() {
        let scenario = scenario();
        let mission = &scenario.mission;
        let explained_m = 2.0 * 0.1 + 3.0 * mission.start_sigma_m + 2.0 * mission.limits.v_max_m_per_s;
        let off = |metres: f64| {
            let first = mission.start.position + world::Vector::new(metres, 0.0);
            let mut tally = Tally::default();
            (tally.first_fix_m, tally.first_fix_t_s) = (Some(first), Some(2.0));
            tally.first_fix_error_95_m = Some(0.1);
            start_off_m(&scenario, &tally)
        };
        assert_eq!(off(explained_m - 1e-6), None);
        assert!(off(explained_m + 0.01).is_some());
        assert_eq!(start_off_m(&scenario, &Tally::default()), None, "without a fix nothing is known");
    }
}
