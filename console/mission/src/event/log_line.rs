//! Events as lines of text. The log on the screen, the recording and the command line use the same words.

use super::{
    Event, EventKind, OfferStage, PlanDropped, PlanMade, PlanTaken, SurveyWay, TetherAlarm, bias_text,
    pulse_failure_text, pulse_text,
    severity::{self, Severity},
};
use crate::engine::side;
use crate::{
    clock,
    order::{Check, CheckOutcome, Injection, Note, Noted, Order, RangeFault},
    outline,
    phase::{Outcome, StepTo},
};
use planner_api::LogLevel;
use positioning::{Exclusion, Integrity};
use vehicle::port::{LinkSeen, Notice};
use world::{Station, StationId, beside_limit, coverage::percent_text, tether::Certificate};

/// A line of the event log: its severity, its source and its text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogLine {
    /// Severity.
    pub severity: Severity,
    /// Source: `cmd`, `ae`, `plan`, `map`, `robot`, `tether` or `mission`.
    pub source: &'static str,
    /// One sentence.
    pub text: String,
}

impl Event {
    /// The event as a line of text for the log on the screen, the recording and the command line; `None` for events that
    /// occur in every tick. Stations are given the names that they have in the run's first event.
    #[allow(clippy::too_many_lines, reason = "one line for each kind of event")]
    pub fn log_line(&self, stations: &[Station]) -> Option<LogLine> {
        Some(match &self.kind {
            EventKind::RunOpened(run) => line(
                Severity::Info,
                "mission",
                format!("run opened: scenario {}, seed {}", run.scenario, run.seed),
            ),
            EventKind::Ordered { order } => line(Severity::Info, "cmd", order_text(order, stations)),
            EventKind::OrderRefused { order, why } => {
                line(Severity::Warn, "cmd", format!("{} refused: {why}", order_text(order, stations)))
            }
            EventKind::FixFailed { error, repeated: false } => {
                line(Severity::Watch, "ae", format!("no fix: {error}"))
            }
            EventKind::StationRejected { station, reason } => line(
                Severity::Watch,
                "ae",
                format!("{} rejected: {}", station_text(*station, stations), exclusion_text(reason)),
            ),
            EventKind::StationRestored { station } => {
                line(Severity::Info, "ae", format!("{} no longer rejected", station_text(*station, stations)))
            }
            EventKind::PositionLost { error_m, limit_m } => {
                let [error, limit] = beside_limit(*error_m, *limit_m, 2);
                line(Severity::Crit, "ae", format!("position lost: 95 % error {error} m, limit {limit} m"))
            }
            EventKind::PositionRegained { error_m } => {
                line(Severity::Info, "ae", format!("position recovered: 95 % error {error_m:.2} m"))
            }
            EventKind::ProtectionLost { why } => {
                line(Severity::Warn, "ae", format!("position not protected: {why}"))
            }
            EventKind::ProtectionRegained { level_m } => {
                line(Severity::Info, "ae", format!("position protected again: level {level_m:.2} m"))
            }
            EventKind::StationBiased { station, bias_m, since_s, is_corrected } => {
                let name = station_text(*station, stations);
                let deed = if *is_corrected { "corrected" } else { "not used" };
                let text = format!(
                    "{name} {deed}: ranges wrong by {}; floor in doubt since T+{}",
                    bias_text(bias_m),
                    clock(*since_s)
                );
                line(Severity::Warn, "ae", text)
            }
            EventKind::StationUnbiased { station } => {
                let name = station_text(*station, stations);
                line(Severity::Info, "ae", format!("{name} without bias again"))
            }
            EventKind::PulsesTested { phase, test } => {
                let is_wrong = test.integrity == Integrity::Alarm;
                let severity = if is_wrong { Severity::Warn } else { Severity::Info };
                line(severity, "ae", pulse_text(*phase, test, stations))
            }
            EventKind::PulsesFailed { phase, why } => {
                line(Severity::Warn, "ae", pulse_failure_text(*phase, *why, stations))
            }
            EventKind::NotSeparable { stations: Some([one, other]), .. } => {
                let [one, other] = [*one, *other].map(|station| station_text(station, stations));
                let text =
                    format!("the ranges of {one} or {other} are wrong; the last fixes do not show which");
                line(Severity::Warn, "ae", text)
            }
            EventKind::NotSeparable { correlation, stations: None } => {
                let text = format!(
                    "station bias and wrong speed of sound not separable (correlation {correlation:.2})"
                );
                line(Severity::Warn, "ae", text)
            }
            EventKind::Separable => line(
                Severity::Info,
                "ae",
                "wrong stations and a wrong speed of sound are separable again".into(),
            ),
            EventKind::RangesInconsistent { chi2, degrees_of_freedom } => line(
                Severity::Crit,
                "ae",
                format!(
                    "ranges contradict each other: chi-squared {chi2:.0}, {degrees_of_freedom} degrees of freedom"
                ),
            ),
            EventKind::RangesConsistent => line(Severity::Info, "ae", "ranges agree again".into()),
            EventKind::ObstacleFound { obstacle } => {
                let at = obstacle.shape.center();
                line(
                    Severity::Watch,
                    "map",
                    format!("new obstacle at {:.2}, {:.2} m, not on the drawing", at.x, at.y),
                )
            }
            EventKind::ZoneDrawn { zone } => {
                let outline = outline::of(&zone.shape);
                line(Severity::Watch, "map", format!("{} drawn by the operator: {outline}", zone.name))
            }
            EventKind::ZoneBreached { zone, depth_m } => {
                line(Severity::Crit, "robot", format!("hull {depth_m:.2} m inside zone {zone}"))
            }
            EventKind::ZoneLeft { zone } => {
                line(Severity::Info, "robot", format!("hull outside zone {zone} again"))
            }
            EventKind::ReturnBegan { way } => line(Severity::Info, "mission", way.to_string()),
            EventKind::SurveyWay(SurveyWay { to, length_m, beyond_tether, .. }) => {
                let left_out = match beyond_tether {
                    0 => String::new(),
                    n => format!(", {n} left out beyond the tether"),
                };
                let text = format!("survey: {length_m:.1} m to {}{left_out}", to.words());
                line(Severity::Info, "mission", text)
            }
            EventKind::Mapped { map } => {
                let share = percent_text(map.explored, 1);
                let text = format!("map made: {share} % of the floor seen, {} columns", map.columns.len());
                line(Severity::Info, "map", text)
            }
            EventKind::PlannerChosen { .. }
            | EventKind::PlannerPrepared { .. }
            | EventKind::PlannerRejected { .. }
            | EventKind::ParametersChanged { .. }
            | EventKind::Planned { .. }
            | EventKind::PlannerLogged { .. }
            | EventKind::PlannerLate { .. }
            | EventKind::PlannerFailed { .. } => of_planner(&self.kind)?,
            EventKind::BetterPlanned(_) | EventKind::BetterPlanTaken(_) | EventKind::BetterPlanDropped(_) => {
                of_better_plan(&self.kind)?
            }
            EventKind::ShadowBegan { .. }
            | EventKind::Shadowed { .. }
            | EventKind::ShadowMissed { .. }
            | EventKind::PromotionRefused { .. }
            | EventKind::Promoted { .. }
            | EventKind::ShadowEnded { .. } => of_shadow(&self.kind)?,
            EventKind::Truth { collided: true, pose, .. } => line(
                Severity::Crit,
                "robot",
                format!("collision at {:.2}, {:.2} m", pose.position.x, pose.position.y),
            ),
            EventKind::Held { by, .. } => line(severity::of_hold(by), "mission", by.to_string()),
            EventKind::SpeedLimited { asked_m_per_s, sent_m_per_s, needs_m } => line(
                Severity::Info,
                "robot",
                format!(
                    "speed limited to {sent_m_per_s:.2} m/s: from {asked_m_per_s:.2} m/s the robot needs {needs_m:.2} m to stop"
                ),
            ),
            EventKind::MediumAwaited => line(
                Severity::Info,
                "robot",
                "waiting for the pressure sensor to show whether the floor is flooded".into(),
            ),
            EventKind::MediumKnown { medium, pressure_pa } => line(
                Severity::Info,
                "robot",
                format!("floor {}: pressure {:.0} Pa", medium.word(), pressure_pa),
            ),
            EventKind::PositionAwaited { limit_m, ends_t_s } => {
                line(Severity::Warn, "mission", awaited_text(*limit_m, *ends_t_s, !stations.is_empty()))
            }
            EventKind::Link(link) => of_link(link),
            EventKind::Noticed(notice) => of_notice(notice),
            EventKind::Stood { confirmed: true, after_s, .. } => line(
                Severity::Info,
                "vehicle",
                format!("stopped, confirmed by odometry after {after_s:.2} s"),
            ),
            EventKind::Stood { confirmed: false, moved: true, .. } => {
                line(Severity::Crit, "vehicle", "vehicle is moving without an order".into())
            }
            EventKind::Stood { confirmed: false, after_s, .. } => line(
                Severity::Crit,
                "vehicle",
                format!("STOP NOT CONFIRMED: odometry does not show a stop {after_s:.2} s after the command"),
            ),
            EventKind::Guarded { sent_m_per_s, gap_m, direction_rad, .. } => line(
                Severity::Watch,
                "vehicle",
                format!(
                    "guard: speed limited to {sent_m_per_s:.2} m/s, the scan shows something {:.2} m from the hull, {}",
                    gap_m.max(0.0),
                    side(*direction_rad)
                ),
            ),
            EventKind::NotThere { name, scans, .. } => line(
                Severity::Warn,
                "map",
                format!(
                    "{name} not found where charted: {scans} scans went through its place; check the drawing"
                ),
            ),
            EventKind::ScannerJudged { trouble: Some(why) } => {
                line(Severity::Warn, "scanner", format!("scans not usable: {why}"))
            }
            EventKind::ScanAided { trouble: Some(why) } => {
                line(Severity::Watch, "scanner", format!("scans do not correct the position: {why}"))
            }
            EventKind::ScanAided { trouble: None } => {
                line(Severity::Info, "scanner", "scans correct the position".into())
            }
            EventKind::ScannerJudged { trouble: None } => {
                line(Severity::Info, "scanner", "scans usable again".into())
            }
            EventKind::ChannelsJudged(judged) => {
                let severity = if judged.dead.is_empty() { Severity::Info } else { Severity::Warn };
                line(severity, "tool", judged.to_string())
            }
            EventKind::Resumed => line(Severity::Info, "mission", "resumed".into()),
            EventKind::Ended { outcome, reason } => {
                let severity = if *outcome == Outcome::Complete { Severity::Info } else { Severity::Warn };
                line(severity, "mission", format!("ended ({}): {reason}", outcome.word()))
            }
            EventKind::TetherAlarmRaised { .. }
            | EventKind::TetherAlarmCleared { .. }
            | EventKind::Certified { .. } => of_tether(&self.kind)?,
            EventKind::Truth { .. }
            | EventKind::TetherTruth { .. }
            | EventKind::Tethered { .. }
            | EventKind::Ranged { .. }
            | EventKind::Fixed { .. }
            | EventKind::FixFailed { .. }
            | EventKind::Estimated { .. }
            | EventKind::Protected { .. }
            | EventKind::SessionCalibrated { .. }
            | EventKind::ClocksEstimated { .. }
            | EventKind::ObstacleMoved { .. }
            | EventKind::Commanded { .. }
            | EventKind::Snapshotted { .. }
            | EventKind::Discarded { .. }
            | EventKind::Drawn { .. }
            | EventKind::Scalars { .. }
            | EventKind::Explored(_)
            | EventKind::Covered { .. }
            | EventKind::Uncounted { .. }
            | EventKind::FloorChanged { .. }
            | EventKind::Sensed { .. }
            | EventKind::Scanned { .. }
            | EventKind::Sent { .. }
            | EventKind::Progressed { .. } => return None,
        })
    }
}

fn line(severity: Severity, source: &'static str, text: String) -> LogLine {
    LogLine { severity, source, text }
}

fn awaited_text(limit_m: f64, ends_t_s: f64, has_stations: bool) -> String {
    if has_stations {
        format!(
            "waiting for ranges: the robot resumes when the 95 % position error is at most {limit_m:.2} m; otherwise, the \
             time limit ends the mission at T+{}",
            clock(ends_t_s)
        )
    } else {
        format!(
            "the scenario has no stations, so the position error cannot fall to {limit_m:.2} m: the time limit ends the \
             mission at T+{}; Ctrl-C ends it now",
            clock(ends_t_s)
        )
    }
}

fn of_link(link: &LinkSeen) -> LogLine {
    let LinkSeen { heard, missed, faulty, unmeasured_s, .. } = link;
    let unmeasured =
        if *unmeasured_s > 0.0 { format!(", motion unknown for {unmeasured_s:.2} s") } else { String::new() };
    let readings = if *heard == 1 { "reading" } else { "readings" };
    let figures = format!("{heard} {readings} arrived, {missed} missing, {faulty} faulty{unmeasured}");
    match (link.trouble(), link.state.is_heard()) {
        (None, _) => line(Severity::Info, "vehicle", format!("link up: {figures}")),
        (Some(why), true) => line(Severity::Warn, "vehicle", format!("{why} ({figures})")),
        (Some(why), false) => line(Severity::Crit, "vehicle", format!("{why} ({figures})")),
    }
}

fn of_notice(notice: &Notice) -> LogLine {
    let (severity, text) = match notice {
        Notice::OtherVehicle { vehicle, differs } => (
            Severity::Warn,
            format!(
                "another vehicle, {}, answers on the same connection: {}",
                vehicle.name,
                differs.join(", ")
            ),
        ),
        Notice::FaultyMessages { count: 1, first, .. } => {
            (Severity::Warn, format!("1 faulty message from the vehicle was ignored: {first}"))
        }
        Notice::FaultyMessages { count, first, last } => (
            Severity::Warn,
            format!(
                "{count} faulty messages from the vehicle were ignored; the first: {first}; the last: {last}"
            ),
        ),
        Notice::ClockRate { field, rate, is_off: true } => (
            Severity::Warn,
            format!(
                "the vehicle's clock advances {rate:.3} s in each second of the console's clock (`{field}`); correct it"
            ),
        ),
        Notice::ClockRate { field, rate, is_off: false } => (
            Severity::Info,
            format!(
                "the vehicle's clock advances {rate:.3} s in each second of the console's clock again (`{field}`)"
            ),
        ),
    };
    line(severity, "vehicle", text)
}

fn of_planner(kind: &EventKind) -> Option<LogLine> {
    Some(match kind {
        EventKind::PlannerChosen { choice, info, from, .. } => {
            let before = match from {
                Some(id) if *id == choice.id => ", restarted".to_owned(),
                Some(id) => format!(", took over from {id}"),
                None => String::new(),
            };
            line(Severity::Info, "plan", format!("planner {} {} active{before}", choice.id, info.version))
        }
        EventKind::ParametersChanged { choice, .. } => {
            line(Severity::Info, "plan", format!("parameters of {} changed", choice.id))
        }
        EventKind::Planned { planner, length_m, complete, .. } => {
            let part = if *complete { "" } else { " (partial)" };
            line(Severity::Info, "plan", format!("{planner} planned {length_m:.1} m{part}"))
        }
        EventKind::PlannerLogged { planner, level, message } => match level {
            LogLevel::Debug => line(Severity::Debug, "plan", format!("{planner}: {message}")),
            LogLevel::Info => line(Severity::Info, "plan", format!("{planner}: {message}")),
            LogLevel::Warn => line(Severity::Watch, "plan", format!("{planner}: {message}")),
        },
        EventKind::PlannerPrepared { choice, info, .. } => {
            line(Severity::Info, "plan", format!("preparing planner {} {}", choice.id, info.version))
        }
        EventKind::PlannerRejected { planner, why } => {
            line(Severity::Warn, "plan", format!("planner {planner} will not take over: {why}"))
        }
        EventKind::PlannerLate { planner, ticks } => {
            line(Severity::Watch, "plan", format!("{}; the robot stood still", late_text(planner, *ticks)))
        }
        EventKind::PlannerFailed { fault, .. } => line(fault.severity(), "plan", fault.message.clone()),
        _ => return None,
    })
}

fn of_better_plan(kind: &EventKind) -> Option<LogLine> {
    Some(match kind {
        EventKind::BetterPlanned(PlanMade { planner, flown, better, objection: None, .. }) => {
            let text = format!("better plan of {planner}: {}", better.saving(flown));
            line(Severity::Watch, "plan", text)
        }
        EventKind::BetterPlanned(PlanMade { planner, objection: Some(why), .. }) => {
            line(Severity::Info, "plan", format!("{planner} replanned: {why}; the current plan is kept"))
        }
        EventKind::BetterPlanTaken(PlanTaken { planner, flown, better }) => {
            let text = format!("better plan of {planner} taken: {}", better.saving(flown));
            line(Severity::Info, "plan", text)
        }
        EventKind::BetterPlanDropped(PlanDropped { planner, why, stage, .. }) => match stage {
            None => line(Severity::Info, "plan", format!("better plan of {planner} dropped: {why}")),
            Some(OfferStage::Offered) => line(Severity::Info, "plan", format!("offer ended: {why}")),
            Some(OfferStage::Accepted) => {
                line(Severity::Watch, "plan", format!("accepted better plan dropped: {why}"))
            }
        },
        _ => return None,
    })
}

fn of_shadow(kind: &EventKind) -> Option<LogLine> {
    Some(match kind {
        EventKind::ShadowBegan { choice, info, .. } => {
            line(Severity::Info, "plan", format!("planner {} {} runs in shadow", choice.id, info.version))
        }
        // Faults in shadow require no action by the operator, because a different planner is active.
        EventKind::Shadowed { of } => {
            let LogLine { severity, source, text } = match &**of {
                EventKind::Certified { .. } => of_tether(of)?,
                other => of_planner(other)?,
            };
            line(severity.min(Severity::Watch), source, format!("shadow: {text}"))
        }
        EventKind::ShadowMissed { ticks, .. } => {
            line(Severity::Info, "plan", format!("shadow: {} missed", ticks_text(*ticks)))
        }
        EventKind::PromotionRefused { planner, why } => {
            line(Severity::Warn, "plan", format!("planner {planner} stays in shadow: {why}"))
        }
        EventKind::Promoted { planner, tally } => {
            let (answered, missed) = (tally.answered, ticks_text(tally.missed));
            let text =
                format!("planner {planner} promoted from shadow: {answered} steps answered, {missed} missed");
            line(Severity::Info, "plan", text)
        }
        EventKind::ShadowEnded { planner, why } => {
            line(Severity::Watch, "plan", format!("planner {planner} no longer runs in shadow: {why}"))
        }
        _ => return None,
    })
}

/// How late a planner answered, as a phrase without a full stop.
pub fn late_text(planner: &str, ticks: u64) -> String {
    format!("planner {planner} answered {} late", ticks_text(ticks))
}

fn ticks_text(ticks: u64) -> String {
    if ticks == 1 { "1 tick".into() } else { format!("{ticks} ticks") }
}

fn of_tether(kind: &EventKind) -> Option<LogLine> {
    Some(match kind {
        EventKind::TetherAlarmRaised { alarm, reached } => {
            let severity = if *reached { Severity::Crit } else { Severity::Warn };
            let near = if *reached || *alarm == TetherAlarm::Strayed { "" } else { "near limit: " };
            line(severity, "tether", format!("{near}{alarm}"))
        }
        EventKind::TetherAlarmCleared { alarm } => {
            line(Severity::Info, "tether", format!("{} back within limit", alarm.word()))
        }
        EventKind::Certified { planner, refused, certificate } => line(
            severity::of_certificate(certificate),
            "tether",
            certificate_text(planner, *refused, certificate),
        ),
        _ => return None,
    })
}

fn order_text(order: &Order, stations: &[Station]) -> String {
    match order {
        Order::Plan => "plan".into(),
        Order::StepTo(StepTo::LaneEnd) => "step to the end of the lane".into(),
        Order::StepTo(StepTo::Event) => "step to the next event".into(),
        Order::Start => "start".into(),
        Order::StartPlan(plan) => format!("start of plan {}", plan.short()),
        Order::NoteOutlooks(outlooks) => {
            let planners: Vec<&str> = outlooks.iter().map(|outlook| outlook.choice.id.as_str()).collect();
            format!("forecasts compared: {}", planners.join(", "))
        }
        Order::NoteChecks(checks) => checks_text(checks),
        Order::Hold => "hold".into(),
        Order::Resume => "resume".into(),
        Order::Step => "single step".into(),
        Order::FlyUncertified => "run uncertified plan".into(),
        Order::DriveBack => "drive back".into(),
        Order::Abort => "end mission".into(),
        Order::Terminate => "end mission, by a signal to the process".into(),
        Order::CheckPlanner => {
            "check the planners, ordered by the console: the process of one planner has ended".into()
        }
        Order::ChoosePlanner(choice) => format!("change planner to {}", choice.id),
        Order::Shadow(choice) => format!("run planner {} in shadow", choice.id),
        Order::Promote => "promote the planner in shadow".into(),
        Order::DropShadow => "end the shadow".into(),
        Order::TakePlan => "take the better plan".into(),
        Order::SetParameter { key, value } => format!("set {key} = {value}"),
        Order::DrawZone(_) => "draw no-go zone".into(),
        Order::Inject(injection) => injection_text(injection, stations),
        Order::UseStation { station, used, by } => {
            let word = if *used { "include" } else { "exclude" };
            format!("{word} {}{}", station_text(*station, stations), by_text(by.as_ref()))
        }
        Order::Note(note) => note_text(note),
    }
}

fn checks_text(checks: &[Check]) -> String {
    let count = |outcome| checks.iter().filter(|check| check.outcome == outcome).count();
    let parts = [
        (CheckOutcome::Passed, "ok"),
        (CheckOutcome::Ticked, "by hand"),
        (CheckOutcome::Warning, "with a warning"),
        (CheckOutcome::Failed, "failed"),
    ];
    let parts = parts.map(|(outcome, word)| (count(outcome), word));
    let parts = parts.iter().filter(|(n, _)| *n > 0).map(|(n, word)| format!("{n} {word}"));
    format!("pre-flight: {}", parts.collect::<Vec<_>>().join(", "))
}

/// The end of a sentence that names the person who acted: ` by NAME`, or nothing.
fn by_text(by: Option<&String>) -> String {
    by.map_or_else(String::new, |name| format!(" by {name}"))
}

fn note_text(Note { what, by }: &Note) -> String {
    let by = by_text(by.as_ref());
    match what {
        Noted::Acknowledged { text, .. } => format!("alarm acknowledged{by}: {text}"),
        Noted::Shelved { text, for_s, reason, .. } => {
            format!("alarm shelved{by} for {} min ({reason}): {text}", (for_s / 6.0).round() / 10.0)
        }
        Noted::Unshelved { text, .. } => format!("alarm unshelved{by}: {text}"),
        Noted::PresetTaken { preset, planner } => format!("preset {preset} of {planner} taken{by}"),
    }
}

fn injection_text(Injection { station, fault, for_s, by }: &Injection, stations: &[Station]) -> String {
    let fault = match fault {
        RangeFault::Dead => "dead".to_owned(),
        RangeFault::Offset(metres) => format!("ranges {metres} m too long"),
    };
    let by = by_text(by.as_ref());
    format!("fault injected{by}: {} {fault} for {for_s} s", station_text(*station, stations))
}

fn certificate_text(planner: &str, refused: bool, certificate: &Certificate) -> String {
    let reasons = certificate.reasons.join("; ");
    match (refused, certificate.certified) {
        (true, _) => format!("plan of {planner} refused: {reasons}"),
        (false, false) => format!("plan of {planner} runs uncertified: {reasons}"),
        (false, true) => {
            let left =
                certificate.end_length_m.map_or_else(String::new, |m| format!(", {m:.1} m out after return"));
            let pull = certificate.pull.map_or_else(String::new, |pull| format!(", pull {}", pull.text()));
            let own_gap = certificate.own_gap.map_or_else(String::new, |own_gap| {
                format!(", own tether no nearer than {}", own_gap.text())
            });
            let length_m = certificate.tether_length_max_m;
            let figures = format!("at most {length_m:.1} m of tether out{left}{pull}{own_gap}");
            let whole = [figures].into_iter().chain(certificate.warnings.iter().cloned());
            format!("plan of {planner} certified: {}", whole.collect::<Vec<_>>().join("; "))
        }
    }
}

/// The name of a station, or its number if the tank gives it no name.
fn station_text(id: StationId, stations: &[Station]) -> String {
    let found = stations.iter().find(|station| station.id == id);
    found.map_or_else(|| format!("station {}", id.0), |station| format!("station {}", station.name))
}

fn exclusion_text(reason: &Exclusion) -> String {
    match reason {
        Exclusion::Silent => "not heard".into(),
        Exclusion::ByOrder => "excluded by the operator".into(),
        Exclusion::Biased { bias_m } => format!("ranges wrong by {bias_m:+.2} m"),
        Exclusion::Residual { residual_m, gate_m } => {
            let [size, gate] = beside_limit(residual_m.abs(), *gate_m, 2);
            let sign = if *residual_m < 0.0 { "-" } else { "" };
            format!("residual {sign}{size} m, gate {gate} m")
        }
        Exclusion::Impossible { range_m, most_m } => {
            let [range, most] = beside_limit(*range_m, *most_m, 2);
            format!("range {range} m, impossible in this tank (at most {most} m)")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_tick_is_not_written_as_ticks() {
        let late = |ticks| Event {
            tick: 7,
            t_s: 0.7,
            kind: EventKind::PlannerLate { planner: "rpf".into(), ticks },
        };
        let text = |ticks| late(ticks).log_line(&[]).map(|line| line.text).unwrap_or_default();
        assert_eq!(text(1), "planner rpf answered 1 tick late; the robot stood still");
        assert_eq!(text(2), "planner rpf answered 2 ticks late; the robot stood still");
    }
    #[test]
    fn a_station_is_called_by_its_name() {
        let stations = [Station { id: StationId(3), name: "C".into(), position: world::Point::origin() }];
        let restored =
            Event { tick: 7, t_s: 0.7, kind: EventKind::StationRestored { station: StationId(3) } };
        let text =
            |stations: &[Station]| restored.log_line(stations).map(|line| line.text).unwrap_or_default();
        assert_eq!(text(&stations), "station C no longer rejected");
        assert_eq!(text(&[]), "station 3 no longer rejected");
    }
}
