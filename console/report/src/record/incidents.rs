//! The incidents of a run, for people; alarms and holds have a start and an end.

use mission::{Event, EventKind, LogLine, Order, Severity};
use positioning::{Exclusion, Integrity};
use serde::Serialize;
use std::collections::BTreeMap;
use vehicle::port::{LinkState, Notice};
use world::Station;

/// Maximum number of incidents stored; a final one states how many are left out.
const MOST: usize = 50_000;

/// An incident.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Incident {
    /// Mission time, seconds.
    pub t_s: f64,
    /// End, seconds; absent for an incident without a duration, and for an incident that lasted to the end.
    pub until_s: Option<f64>,
    /// Kind: `alarm`, `hold`, `fault`, `shadow` (a fault of a planner in shadow), `obstacle`, `zone` (a no-go zone
    /// that was drawn), `plan`, `order`, `station` or `end`.
    pub kind: &'static str,
    /// Severity for the operator.
    pub severity: Severity,
    /// Description, as a sentence.
    pub text: String,
}

impl Incident {
    /// Whether a person must review it.
    pub fn needs_review(&self) -> bool {
        matches!(self.kind, "alarm" | "hold" | "fault")
            || self.kind == "end" && self.severity > Severity::Watch
    }
}

/// The incidents so far.
#[derive(Debug, Default)]
pub(super) struct Incidents {
    stations: Vec<Station>,
    all: Vec<Incident>,
    /// Time of the last event, seconds.
    last_s: f64,
    /// Open incidents: the key of the event that ends them, and their indices.
    open: BTreeMap<String, Vec<usize>>,
    /// The last state of the link to the vehicle; its figures are reported often, its state seldom changes.
    link: LinkState,
    /// Number of incidents that were not stored.
    n_dropped: u64,
}

impl Incidents {
    /// All incidents; if the end of the run is missing, the last incident states this.
    pub(super) fn all(&self) -> Vec<Incident> {
        let mut all = self.all.clone();
        let has_end = all.last().is_some_and(|last| last.kind == "end");
        if self.n_dropped > 0 {
            let text = format!(
                "further incidents: {}; they are not listed here, but the journal contains them",
                self.n_dropped
            );
            let (t_s, severity) = (self.last_s, Severity::Crit);
            let at = all.len() - usize::from(has_end);
            all.insert(at, Incident { t_s, until_s: None, kind: "alarm", severity, text });
        }
        if !has_end {
            let text = "cut off: the recording stops before the end of the mission".to_owned();
            all.push(Incident {
                t_s: self.last_s,
                until_s: None,
                kind: "end",
                severity: Severity::Crit,
                text,
            });
        }
        all
    }

    pub(super) fn apply(&mut self, event: &Event) {
        self.last_s = event.t_s;
        if let EventKind::RunOpened(run) = &event.kind {
            self.stations.clone_from(&run.world.stations);
            return;
        }
        if let EventKind::Link(link) = &event.kind
            && std::mem::replace(&mut self.link, link.state) == link.state
        {
            return;
        }
        let Some((kind, begins, ends)) = sort(&event.kind) else { return };
        if let Some(key) = ends {
            self.end(&key, event.t_s);
        }
        let Some(line) = event.log_line(&self.stations).filter(|_| !kind.is_empty()) else { return };
        let LogLine { severity, text, .. } = line;
        // The end of the run is always stored.
        if self.all.len() >= MOST && kind != "end" {
            self.n_dropped += 1;
            return;
        }
        if let Some(key) = begins {
            self.open.entry(key).or_default().push(self.all.len());
        }
        self.all.push(Incident { t_s: event.t_s, until_s: None, kind, severity, text });
    }

    fn end(&mut self, key: &str, t_s: f64) {
        for index in self.open.remove(key).into_iter().flatten() {
            self.all[index].until_s = Some(t_s);
        }
    }
}

/// The kind of an incident in the report (empty if the event only ends an earlier incident), the incident that it
/// starts, and the incident that it ends.
type Sorted = (&'static str, Option<String>, Option<String>);

/// Classifies an event about a pulse test: a test that agrees with the survey ends the alarm of an earlier one.
fn of_pulses(kind: &EventKind) -> Sorted {
    let key = || Some("pulses".to_owned());
    match kind {
        EventKind::PulsesTested { test, .. } if test.integrity != Integrity::Alarm => ("", None, key()),
        _ => ("alarm", key(), key()),
    }
}

/// Classifies an event; `None` if it is not an incident. The list is complete, so that each new event is considered.
fn sort(kind: &EventKind) -> Option<Sorted> {
    let key = |text: &str| Some(text.to_owned());
    Some(match kind {
        EventKind::Held { .. } => ("hold", key("hold"), key("hold")),
        EventKind::Resumed => ("", None, key("hold")),
        EventKind::PositionLost { .. } => ("alarm", key("position"), None),
        EventKind::PositionRegained { .. } => ("", None, key("position")),
        EventKind::ProtectionLost { .. } => ("alarm", key("protection"), None),
        EventKind::ProtectionRegained { .. } => ("", None, key("protection")),
        EventKind::StationBiased { station, .. } => {
            let bias = format!("bias {}", station.0);
            ("alarm", key(&bias), key(&bias))
        }
        EventKind::StationUnbiased { station } => ("", None, key(&format!("bias {}", station.0))),
        EventKind::NotSeparable { .. } => ("alarm", key("separable"), None),
        EventKind::Separable => ("", None, key("separable")),
        EventKind::RangesInconsistent { .. } => ("alarm", key("ranges"), None),
        EventKind::RangesConsistent => ("", None, key("ranges")),
        EventKind::TetherAlarmRaised { alarm, .. } => ("alarm", key(alarm.word()), None),
        EventKind::TetherAlarmCleared { alarm } => ("", None, key(alarm.word())),
        EventKind::ZoneBreached { zone, .. } => ("alarm", key(&format!("zone {zone}")), None),
        EventKind::ZoneLeft { zone } => ("", None, key(&format!("zone {zone}"))),
        EventKind::Truth { collided: true, .. } | EventKind::NotThere { .. } => ("alarm", None, None),
        EventKind::ScannerJudged { trouble: Some(_) } => ("alarm", key("scanner"), key("scanner")),
        EventKind::ScannerJudged { trouble: None } => ("", None, key("scanner")),
        EventKind::ChannelsJudged(judged) if judged.dead.is_empty() => ("", None, key("channels")),
        EventKind::ChannelsJudged(_) => ("alarm", key("channels"), key("channels")),
        EventKind::PulsesTested { .. } | EventKind::PulsesFailed { .. } | EventKind::ClocksChanged { .. } => {
            of_pulses(kind)
        }
        EventKind::Link(_) | EventKind::Noticed(_) | EventKind::Stood { .. } => return of_vehicle(kind),
        EventKind::PlannerFailed { fault, .. } if fault.is_no_way() => ("plan", None, None),
        EventKind::PlannerFailed { .. } => ("fault", None, None),
        EventKind::Shadowed { of } if matches!(**of, EventKind::PlannerFailed { .. }) => {
            ("shadow", None, None)
        }
        EventKind::ObstacleFound { .. } => ("obstacle", None, None),
        EventKind::ZoneDrawn { .. } => ("zone", None, None),
        EventKind::Planned { .. } | EventKind::Certified { .. } | EventKind::ReturnBegan { .. } => {
            ("plan", None, None)
        }
        // Of a bias, its own incident tells.
        EventKind::StationRejected { station, reason } if !matches!(reason, Exclusion::Biased { .. }) => {
            ("station", key(&format!("station {}", station.0)), None)
        }
        EventKind::StationRestored { station } => ("", None, key(&format!("station {}", station.0))),
        EventKind::Ordered { order } => return is_listed(order).then_some(("order", None, None)),
        EventKind::Ended { .. } => ("end", None, None),
        EventKind::RunOpened(_)
        | EventKind::StationRejected { .. }
        | EventKind::OrderRefused { .. }
        | EventKind::TetherTruth { .. }
        | EventKind::Tethered { .. }
        | EventKind::Scanned { .. }
        | EventKind::Truth { .. }
        | EventKind::Ranged { .. }
        | EventKind::Fixed { .. }
        | EventKind::FixFailed { .. }
        | EventKind::Estimated { .. }
        | EventKind::Protected { .. }
        | EventKind::SessionCalibrated { .. }
        | EventKind::ClocksEstimated { .. }
        | EventKind::ObstacleMoved { .. }
        | EventKind::PlannerPrepared { .. }
        | EventKind::PlannerRejected { .. }
        | EventKind::PlannerChosen { .. }
        | EventKind::ParametersChanged { .. }
        | EventKind::Commanded { .. }
        | EventKind::SpeedLimited { .. }
        | EventKind::PulsesAwaited { .. }
        | EventKind::MediumAwaited
        | EventKind::MediumKnown { .. }
        | EventKind::Drawn { .. }
        | EventKind::Scalars { .. }
        | EventKind::PlannerLogged { .. }
        | EventKind::Snapshotted { .. }
        | EventKind::Discarded { .. }
        | EventKind::PlannerLate { .. }
        | EventKind::ShadowBegan { .. }
        | EventKind::Shadowed { .. }
        | EventKind::ShadowMissed { .. }
        | EventKind::PromotionRefused { .. }
        | EventKind::Promoted { .. }
        | EventKind::ShadowEnded { .. }
        | EventKind::BetterPlanned(_)
        | EventKind::BetterPlanTaken(_)
        | EventKind::BetterPlanDropped(_)
        | EventKind::SurveyWay(_)
        | EventKind::Explored(_)
        | EventKind::Mapped { .. }
        | EventKind::Covered { .. }
        | EventKind::Uncounted { .. }
        | EventKind::FloorChanged { .. }
        | EventKind::Progressed { .. }
        | EventKind::Sensed { .. }
        | EventKind::Sent { .. }
        | EventKind::Guarded { .. }
        | EventKind::ScanAided { .. }
        | EventKind::PositionAwaited { .. } => return None,
    })
}

/// Classifies an event about a real vehicle.
fn of_vehicle(kind: &EventKind) -> Option<Sorted> {
    let (key, is_over) = match kind {
        EventKind::Link(link) => ("link", link.state == LinkState::Up),
        EventKind::Stood { confirmed, .. } => ("stop", *confirmed),
        EventKind::Noticed(Notice::ClockRate { is_off, .. }) => ("clock rate", !is_off),
        EventKind::Noticed(Notice::FaultyMessages { .. } | Notice::OtherVehicle { .. }) => {
            return Some(("alarm", None, None));
        }
        _ => return None,
    };
    let key = || Some(key.to_owned());
    Some(if is_over { ("", None, key()) } else { ("alarm", key(), key()) })
}

/// Whether an order is listed: the checks and forecasts of the console are not.
fn is_listed(order: &Order) -> bool {
    !matches!(order, Order::NoteChecks(_) | Order::NoteOutlooks(_))
}

#[cfg(test)]
mod tests {
    use super::*;
    use mission::{HoldReason, Outcome, Resumes, event::ChannelsJudged};
    use vehicle::port::LinkSeen;

    #[test]
    fn what_is_not_listed_is_counted_and_the_end_is_kept() {
        let mut incidents = Incidents::default();
        let mut at = |tick: u64, kind| incidents.apply(&Event { tick, t_s: tick as f64, kind });
        for tick in 0..MOST as u64 + 3 {
            at(tick, EventKind::Held { by: HoldReason::Operator, resumes: Resumes::default() });
        }
        at(60_000, EventKind::Ended { outcome: Outcome::Aborted, reason: "ended".into() });
        let all = incidents.all();
        assert_eq!((all.len(), all[0].until_s, all[MOST - 1].until_s), (MOST + 2, Some(1.0), Some(50_000.0)));
        assert!(all[MOST].text.starts_with("further incidents: 3;") && all[MOST].needs_review());
        assert_eq!(all[MOST + 1].kind, "end");
    }

    #[test]
    fn alarms_of_instrument_and_vehicle_are_listed_once_with_their_ends() {
        let link = |state| EventKind::Link(LinkSeen { state, ..LinkSeen::default() });
        let channels = |dead| EventKind::ChannelsJudged(ChannelsJudged { dead, count: 20 });
        let stood = |confirmed| EventKind::Stood { confirmed, moved: false, after_s: 1.0 };
        let mut incidents = Incidents::default();
        let events = [
            channels(vec![7]),
            link(LinkState::Up),
            link(LinkState::Lost),
            link(LinkState::Lost),
            stood(false),
            link(LinkState::Up),
            stood(true),
            channels(vec![]),
        ];
        for (tick, kind) in events.into_iter().enumerate() {
            incidents.apply(&Event { tick: tick as u64, t_s: tick as f64, kind });
        }
        let all = incidents.all();
        let spans: Vec<_> =
            all.iter().filter(|one| one.needs_review()).map(|one| (one.t_s, one.until_s)).collect();
        // The last one is the missing end.
        assert_eq!(spans, [(0.0, Some(7.0)), (2.0, Some(5.0)), (4.0, Some(6.0)), (7.0, None)], "{all:?}");
    }
}
