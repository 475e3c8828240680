//! The contents of an event, field by field.

use crate::model::Run;
use crate::model::log::{Entry, Occurrence, Robot, What};
use crate::view::fields::Field;
use crate::view::text;
use mission::{
    EventKind, PlannerChoice, PlannerInfo, Resumes,
    event::{Effort, PlanDropped, PlanMade, PlanTaken, PulsePhase, TetherAlarm, pulse_error_text},
};
use planner_api::Reason;
use positioning::{Exclusion, FixError, PulseTest, Ranging};
use vehicle::port::LinkSeen;
use world::{Obstacle, Shape, StationId, tether::Certificate};

/// The kind of an event.
pub(super) fn title(what: &What) -> &'static str {
    let What::Event(event) = what else {
        return if matches!(what, What::Opened) { "run opened" } else { "console message" };
    };
    match &event.kind {
        EventKind::Ordered { .. } => "order",
        EventKind::OrderRefused { .. } => "order refused",
        EventKind::FixFailed { .. } => "no position fix",
        EventKind::StationRejected { .. } => "station rejected",
        EventKind::StationRestored { .. } => "station no longer rejected",
        EventKind::PositionLost { .. } => "position lost",
        EventKind::PositionRegained { .. } => "position recovered",
        EventKind::ProtectionLost { .. } => "position not protected",
        EventKind::ProtectionRegained { .. } => "position protected again",
        EventKind::StationBiased { .. } => "station biased",
        EventKind::StationUnbiased { .. } => "station without bias",
        EventKind::NotSeparable { .. } => "bias not separable",
        EventKind::PulsesTested { .. } => "pulse test",
        EventKind::PulsesFailed { .. } => "pulse test failed",
        EventKind::ClocksChanged { .. } => "clocks changed",
        EventKind::Separable => "bias separable again",
        EventKind::RangesInconsistent { .. } => "ranges contradict each other",
        EventKind::RangesConsistent => "ranges agree again",
        EventKind::ObstacleFound { .. } => "obstacle found",
        EventKind::PlannerChosen { .. } => "planner active",
        EventKind::PlannerPrepared { .. } => "planner prepared",
        EventKind::PlannerRejected { .. } => "planner rejected",
        EventKind::ParametersChanged { .. } => "parameters changed",
        EventKind::Planned { .. } => "plan",
        EventKind::BetterPlanned(_) => "better plan",
        EventKind::BetterPlanTaken(_) => "better plan taken",
        EventKind::BetterPlanDropped(_) => "no better plan",
        EventKind::ReturnBegan { .. } => "drive back",
        EventKind::SurveyWay(_) => "way of the survey",
        EventKind::Mapped { .. } => "map made",
        EventKind::ZoneBreached { .. } => "hull in no-go zone",
        EventKind::ZoneLeft { .. } => "hull outside no-go zone",
        EventKind::ShadowBegan { .. } | EventKind::Shadowed { .. } => "planner in shadow",
        EventKind::ShadowMissed { .. } => "shadow planner late",
        EventKind::PromotionRefused { .. } => "promotion refused",
        EventKind::Promoted { .. } => "planner promoted",
        EventKind::ShadowEnded { .. } => "shadow ended",
        EventKind::PlannerLogged { .. } => "planner message",
        EventKind::PlannerLate { .. } => "planner late",
        EventKind::PlannerFailed { .. } => "planner failed",
        EventKind::SpeedLimited { .. } => "speed limited",
        EventKind::NotThere { .. } => "obstacle not found",
        EventKind::Guarded { .. } => "guard by the scan",
        EventKind::ScanAided { trouble: Some(_) } => "scans do not correct the position",
        EventKind::ScanAided { .. } => "scans correct the position",
        EventKind::ScannerJudged { trouble: Some(_) } => "scans not usable",
        EventKind::ScannerJudged { .. } => "scans usable again",
        EventKind::ChannelsJudged(judged) if judged.dead.is_empty() => "channels work again",
        EventKind::ChannelsJudged(_) => "channel dead",
        EventKind::PulsesAwaited { .. } => "waiting for the last pulses",
        EventKind::MediumAwaited => "waiting for the pressure sensor",
        EventKind::MediumKnown { .. } => "floor medium detected",
        EventKind::Held { .. } => "mission held",
        EventKind::Resumed => "mission resumed",
        EventKind::Ended { .. } => "mission ended",
        EventKind::TetherAlarmRaised { .. } => "tether alarm",
        EventKind::TetherAlarmCleared { .. } => "tether back within limit",
        EventKind::Certified { .. } => "certificate",
        EventKind::PositionAwaited { .. } => "waiting for the position",
        EventKind::Link(_) => "link to the vehicle",
        EventKind::Noticed(_) => "about the vehicle",
        EventKind::Stood { confirmed: true, .. } => "vehicle stopped",
        EventKind::Stood { moved: true, .. } => "unordered motion",
        EventKind::Stood { .. } => "stop not confirmed",
        _ => "event",
    }
}

/// What an event contains in addition to its log line, and the robot's position at that time.
pub(super) fn facts(run: &Run, entry: &Entry) -> Vec<Field> {
    match &entry.what {
        What::Console => vec![("source", "the console, not the mission".into())],
        What::Opened => opened(run),
        What::Event(event) => {
            let mut facts = of_event(run, event);
            facts.extend(event.robot.map(robot));
            facts
        }
    }
}

fn of_event(run: &Run, event: &Occurrence) -> Vec<Field> {
    match &event.kind {
        EventKind::StationRejected { station, reason } => {
            rejected(run, *station, reason, event.range.as_ref())
        }
        EventKind::StationRestored { station } => {
            let range = event.range.iter().map(|range| ("range", measured(range)));
            vec![("station", station_text(run, *station))].into_iter().chain(range).collect()
        }
        EventKind::FixFailed { error, .. } => fix_failed(run, error),
        EventKind::PositionLost { error_m, limit_m } => {
            vec![("error", metres(*error_m) + " (95 %)"), ("limit", metres(*limit_m))]
        }
        EventKind::SpeedLimited { asked_m_per_s, sent_m_per_s, needs_m } => vec![
            ("requested", format!("{} m/s", text::number(*asked_m_per_s, 2))),
            ("sent", format!("{} m/s", text::number(*sent_m_per_s, 2))),
            ("to stop", format!("{} at the requested speed", metres(*needs_m))),
        ],
        EventKind::Guarded { asked_m_per_s, sent_m_per_s, gap_m, direction_rad } => vec![
            ("requested", format!("{} m/s", text::number(*asked_m_per_s, 2))),
            ("sent", format!("{} m/s", text::number(*sent_m_per_s, 2))),
            ("gap", format!("{} between hull and scanned point", metres(*gap_m))),
            ("direction", format!("{}° to the left", text::number(direction_rad.to_degrees(), 0))),
        ],
        EventKind::MediumKnown { medium, pressure_pa } => {
            vec![
                ("floor", medium.word().to_owned()),
                ("pressure", format!("{} Pa", text::number(*pressure_pa, 0))),
            ]
        }
        EventKind::PositionRegained { error_m } => vec![("error", metres(*error_m) + " (95 %)")],
        EventKind::ProtectionLost { why } => vec![("reason", why.to_string())],
        EventKind::ProtectionRegained { level_m } => vec![("level", metres(*level_m))],
        EventKind::StationBiased { station, bias_m, since_s, is_corrected } => vec![
            ("station", station_text(run, *station)),
            ("bias", format!("{:+.2} m, σ {:.2} m", bias_m.value, bias_m.sigma)),
            ("in doubt", format!("floor scanned since T+{}", text::clock(*since_s))),
            ("ranges", if *is_corrected { "corrected" } else { "not used" }.to_owned()),
        ],
        EventKind::StationUnbiased { station } => vec![("station", station_text(run, *station))],
        EventKind::PulsesTested { phase, test } => pulse_facts(run, *phase, test),
        EventKind::PulsesFailed { phase, why } => {
            vec![("when", phase.words().to_owned()), ("reason", pulse_error_text(*why, run.stations()))]
        }
        EventKind::NotSeparable { correlation, stations } => {
            let wrong = stations.map(|[one, other]| {
                ("wrong", format!("{} or {}", station_text(run, one), station_text(run, other)))
            });
            wrong.into_iter().chain([("correlation", text::number(*correlation, 2))]).collect()
        }
        EventKind::RangesInconsistent { chi2, degrees_of_freedom } => {
            let limit = positioning::alarm_limit((*degrees_of_freedom).max(1));
            let text =
                format!("{chi2:.1}, limit {limit:.1} (99.9 %), {degrees_of_freedom} degrees of freedom");
            vec![("chi-squared", text)]
        }
        EventKind::ObstacleFound { obstacle } => obstacle_facts(obstacle),
        EventKind::NotThere { name, scans, .. } => {
            vec![("obstacle", name.clone()), ("seen through", format!("in {scans} scans"))]
        }
        EventKind::ScannerJudged { trouble } | EventKind::ScanAided { trouble } => {
            trouble.iter().map(|why| ("reason", why.clone())).collect()
        }
        EventKind::Ordered { .. } | EventKind::RangesConsistent | EventKind::Resumed => Vec::new(),
        EventKind::OrderRefused { why, .. } => vec![("reason", why.clone())],
        EventKind::Held { by, resumes } => vec![("reason", by.to_string()), ("resumes", resumed(*resumes))],
        EventKind::Ended { outcome, reason } => {
            vec![("outcome", outcome.word().into()), ("reason", reason.clone())]
        }
        EventKind::PositionAwaited { limit_m, ends_t_s } => vec![
            ("limit", metres(*limit_m) + " (95 %)"),
            ("ends at", format!("T+{}", text::clock(*ends_t_s))),
        ],
        EventKind::Link(link) => linked(link),
        EventKind::Stood { after_s, .. } => vec![("after", format!("{} s", text::number(*after_s, 2)))],
        EventKind::TetherAlarmRaised { alarm, reached } => tether(alarm, Some(*reached)),
        EventKind::TetherAlarmCleared { alarm } => tether(alarm, None),
        EventKind::Certified { planner, refused, certificate } => certified(planner, *refused, certificate),
        other => of_planner(other),
    }
}

fn linked(link: &LinkSeen) -> Vec<Field> {
    let seconds = |s: f64| format!("{} s", text::number(s, 3));
    let known = [("age", link.age_s), ("p99 age", link.age_p99_s), ("clock offset", link.offset_s)];
    let known = known.into_iter().filter_map(|(what, s)| Some((what, seconds(s?))));
    let counts = format!(
        "{} arrived, {} missing, {} faulty, motion unknown for {} s",
        link.heard,
        link.missed,
        link.faulty,
        text::number(link.unmeasured_s, 2)
    );
    [("state", link.state.word().to_owned()), ("readings", counts)].into_iter().chain(known).collect()
}

fn effort(effort: &Effort) -> String {
    let turns = text::number(effort.rotation_rad / std::f64::consts::TAU, 1);
    let (metres, minutes) = (text::number(effort.length_m, 0), text::number(effort.time_s / 60.0, 1));
    format!("{metres} m, {turns} turns, {minutes} min")
}

fn of_planner(kind: &EventKind) -> Vec<Field> {
    match kind {
        EventKind::PlannerChosen { choice, info, from, .. } => {
            let from = from.iter().map(|from| ("before", from.clone()));
            planner(choice, info).into_iter().chain(from).collect()
        }
        EventKind::PlannerPrepared { choice, info, .. } | EventKind::ShadowBegan { choice, info, .. } => {
            planner(choice, info)
        }
        EventKind::Shadowed { of } => of_planner(of),
        EventKind::Promoted { planner, tally } => vec![
            ("planner", planner.clone()),
            ("answered", format!("{} steps", tally.answered)),
            ("missed", format!("{} ticks", tally.missed)),
        ],
        EventKind::ParametersChanged { choice, .. } => {
            vec![("planner", choice.id.clone()), ("parameters", parameters(choice))]
        }
        EventKind::BetterPlanned(PlanMade { planner, flown, better, .. })
        | EventKind::BetterPlanTaken(PlanTaken { planner, flown, better }) => {
            vec![("planner", planner.clone()), ("current", effort(flown)), ("better", effort(better))]
        }
        EventKind::PlannerRejected { planner, why }
        | EventKind::BetterPlanDropped(PlanDropped { planner, why, .. })
        | EventKind::ShadowEnded { planner, why }
        | EventKind::PromotionRefused { planner, why } => {
            vec![("planner", planner.clone()), ("reason", why.clone())]
        }
        EventKind::Planned { planner, reason, path, length_m, complete, return_path, .. } => {
            let ends: Vec<String> = path.iter().map(|point| text::place(*point)).collect();
            let part = if *complete { "the whole task" } else { "part of the task" };
            let mut facts = vec![
                ("planner", planner.clone()),
                ("reason", planned_for(reason)),
                ("length", format!("{} m, {part}", text::number(*length_m, 1))),
                ("from, to", ends.join(" to ")),
            ];
            if *return_path > 0 {
                facts.push(("return path", format!("the first {return_path} points, along the tether")));
            }
            facts
        }
        EventKind::PlannerLogged { planner, level, message } => {
            vec![("planner", planner.clone()), ("level", level.to_string()), ("message", message.clone())]
        }
        EventKind::PlannerLate { planner, ticks } => {
            vec![("planner", planner.clone()), ("late by", format!("{ticks} ticks; the robot stood still"))]
        }
        EventKind::PlannerFailed { fault, .. } => vec![
            ("planner", fault.planner.clone()),
            ("during", fault.during.to_string()),
            ("fault", fault.cause.to_string()),
            ("plugin", fault.plugin_sha256.clone().unwrap_or_else(|| "hash unknown".into())),
        ],
        _ => Vec::new(),
    }
}

fn opened(run: &Run) -> Vec<Field> {
    let Some(about) = &run.about else { return Vec::new() };
    let stations: Vec<&str> = about.world.stations.iter().map(|station| station.name.as_str()).collect();
    vec![
        ("scenario", format!("{}, seed {}", about.scenario, about.seed)),
        ("planner", about.mission.planner.id.clone()),
        ("stations", stations.join(", ")),
        ("obstacles", format!("{} on the map now", about.world.obstacles.len())),
    ]
}

fn metres(m: f64) -> String {
    format!("{} m", text::number(m, 2))
}

fn robot(robot: Robot) -> Field {
    let speed = robot
        .speed_m_per_s
        .map_or_else(String::new, |speed| format!(", speed {} m/s", text::number(speed, 2)));
    let heading = text::degrees(robot.heading_rad);
    let (at, error) = (text::place(robot.at), text::number(robot.error_m, 2));
    ("robot", format!("{at} ±{error} m, heading {heading}°{speed}"))
}

fn station_text(run: &Run, id: StationId) -> String {
    let name = run.station_name(id);
    let found = run.stations().iter().find(|station| station.id == id);
    let at = found.map_or_else(String::new, |station| format!(" at {}", text::place(station.position)));
    format!("{}{at}", name.trim_start_matches("station "))
}

fn measured(range: &Ranging) -> String {
    let Ranging { range_m, sigma_m, repetitions, .. } = range;
    format!("{range_m:.2} m measured, σ {sigma_m:.3} m, {repetitions} repetitions")
}

fn rejected(run: &Run, id: StationId, reason: &Exclusion, range: Option<&Ranging>) -> Vec<Field> {
    let mut facts = vec![("station", station_text(run, id))];
    match (reason, range) {
        (Exclusion::ByOrder, _) => facts.push(("reason", "excluded by the operator".into())),
        (Exclusion::Biased { bias_m }, _) => {
            facts.push(("reason", format!("all its ranges are wrong by {bias_m:+.2} m")));
        }
        (Exclusion::Impossible { range_m, most_m }, _) => {
            let reason = format!("{range_m:.2} m is impossible in this tank; at most {most_m:.2} m");
            facts.push(("reason", reason));
        }
        (Exclusion::Silent, _) => facts.push(("reason", "not heard in this cycle".into())),
        (Exclusion::Residual { residual_m, .. }, Some(range)) => {
            let expected_m = range.range_m - residual_m;
            facts.push(("range", format!("{}; {expected_m:.2} m expected", measured(range))));
        }
        (Exclusion::Residual { .. }, None) => {}
    }
    if let Exclusion::Residual { residual_m, gate_m } = reason {
        let over = (residual_m / gate_m).abs();
        facts
            .push(("residual", format!("{residual_m:+.3} m, gate {gate_m:.3} m ({over:.1} times the gate)")));
    }
    facts
}

fn fix_failed(run: &Run, error: &FixError) -> Vec<Field> {
    let mut facts = vec![("reason", error.to_string())];
    let heard: Vec<String> = run
        .position
        .ranges
        .iter()
        .map(|range| run.station_name(range.station).trim_start_matches("station ").to_owned())
        .collect();
    facts.push(("last heard", if heard.is_empty() { "no station".into() } else { heard.join(", ") }));
    facts
}

fn obstacle_facts(obstacle: &Obstacle) -> Vec<Field> {
    let form = match &obstacle.shape {
        Shape::Disc { radius_m, .. } => format!("disc, radius {}", metres(*radius_m)),
        _ => "outline as seen so far".into(),
    };
    vec![
        ("obstacle", obstacle.name.clone()),
        ("place", text::place(obstacle.shape.center())),
        ("form", form),
        ("drawing", "not on the drawing".into()),
    ]
}

fn pulse_facts(run: &Run, phase: PulsePhase, test: &PulseTest) -> Vec<(&'static str, String)> {
    let scale = &test.scale;
    let share = format!("{:+.2} %, σ {:.2} %", 100.0 * scale.value, 100.0 * scale.sigma);
    let mut facts =
        vec![("when", phase.words().to_owned()), ("pulses", test.pulses.to_string()), ("ranges", share)];
    let offset = |(id, offset): &(StationId, positioning::Estimated)| {
        let name = station_text(run, *id);
        ("clock", format!("{name} {:+.2} m, σ {:.2} m", offset.value, offset.sigma))
    };
    facts.extend(test.offsets_m.iter().map(offset));
    facts.extend(test.suspect.map(|id| ("contradicts", station_text(run, id))));
    facts
}

fn resumed(resumes: Resumes) -> String {
    match resumes {
        Resumes::Never => "only by the operator's order",
        Resumes::WhenCleared => "automatically when the cause is gone",
        Resumes::ByFallback => "automatically with the fallback planner",
    }
    .into()
}

fn planned_for(reason: &Reason) -> String {
    match reason {
        Reason::Start => "the mission begins".into(),
        Reason::Blocked => "the robot could not continue along the plan".into(),
        Reason::MapChanged => "the map has changed".into(),
        Reason::Operator => "requested by the operator".into(),
        Reason::Swap { from } => format!("the planner takes over from {from}"),
        Reason::Recover => "the planner restarts after a fault".into(),
    }
}

fn planner(choice: &PlannerChoice, info: &PlannerInfo) -> Vec<Field> {
    vec![
        ("planner", format!("{} {}: {}", choice.id, info.version, info.about)),
        ("plugin", format!("{}, ABI {}, SHA-256 {}", info.plugin, info.abi, text::fit(&info.sha256, 17))),
        ("sandbox", info.sandbox.as_ref().map_or("not recorded".into(), ToString::to_string)),
        ("parameters", parameters(choice)),
    ]
}

fn parameters(choice: &PlannerChoice) -> String {
    if choice.parameters.is_empty() {
        return "all at their defaults".into();
    }
    let set = choice.parameters.iter().map(|(key, value)| format!("{key} = {value}"));
    set.collect::<Vec<_>>().join(", ")
}

fn tether(alarm: &TetherAlarm, reached: Option<bool>) -> Vec<Field> {
    let what = ("limit", alarm.word().to_owned());
    let figures = ("figures", alarm.to_string());
    match reached {
        Some(true) => vec![what, ("state", "reached".into()), figures],
        Some(false) => vec![what, ("state", "at 80 % or more".into()), figures],
        None => vec![what, ("state", "back within limit".into())],
    }
}

fn certified(planner: &str, refused: bool, certificate: &Certificate) -> Vec<Field> {
    let judgement = match (refused, certificate.certified) {
        (false, true) if !certificate.warnings.is_empty() => "certified with a warning",
        (true, _) => "refused: the plan is not run",
        (false, false) => "not certified; runs on the operator's order",
        (false, true) => "certified",
    };
    let wraps = (certificate.wrap_max_rad.to_degrees(), certificate.wrap_total_max_rad.to_degrees());
    let end = certificate.end_length_m.map_or_else(String::new, |m| format!(", {m:.1} m out after return"));
    let mut facts = vec![("planner", planner.to_owned()), ("judgement", judgement.into())];
    facts.extend(certificate.reasons.iter().map(|reason| ("reason", reason.clone())));
    facts.extend(certificate.warnings.iter().map(|warning| ("warning", warning.clone())));
    facts.push(("pull", certificate.pull_text().replacen("pull ", "", 1)));
    facts.extend(certificate.own_gap.map(|own_gap| ("own gap", own_gap.text())));
    facts.push(("tether", format!("at most {:.1} m out{end}", certificate.tether_length_max_m)));
    facts.push(("wrap", format!("at most {:.0}° on one obstacle, {:.0}° in total", wraps.0, wraps.1)));
    let (collisions, cuts) = (certificate.collisions, certificate.cut_crossings);
    let clearance = metres(certificate.clearance_min_m);
    facts.push(("path", format!("clearance {clearance}, collisions: {collisions}, cuts crossed: {cuts}")));
    facts
}
