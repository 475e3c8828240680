//! Events as lines of text. The log on the screen, the recording and the command line use the same words.

mod live;
mod orders;
mod planners;
mod tether;

pub use planners::late_text;

use super::{
    Event, EventKind, SurveyWay, bias_text, clocks_changed_text, pulse_failure_text, pulse_text,
    severity::{self, Severity},
};
use crate::engine::side;
use crate::{clock, outline, phase::Outcome};
use live::{of_link, of_notice};
use orders::order_text;
use planners::{of_better_plan, of_planner, of_shadow};
use positioning::{Exclusion, Integrity};
use tether::of_tether;
use world::{Station, StationId, beside_limit, coverage::percent_text};

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
            EventKind::ClocksChanged { changes } => {
                line(Severity::Warn, "ae", clocks_changed_text(changes, stations))
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
                line(Severity::Watch, "ae", text)
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
                    format!("obstacle at {:.2}, {:.2} m, not on the drawing", at.x, at.y),
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
            EventKind::PulsesAwaited { until_s } => line(
                Severity::Info,
                "ae",
                format!(
                    "the robot stands still for the pulse test after the run, until T+{} at most",
                    clock(*until_s)
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
        assert_eq!(text(1), "planner rpf was late; the robot waited 1 tick");
        assert_eq!(text(2), "planner rpf was late; the robot waited 2 ticks");
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
