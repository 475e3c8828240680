//! The lines about the tether.

use super::{LogLine, line};
use crate::event::{
    EventKind, TetherAlarm,
    severity::{self, Severity},
};
use world::tether::Certificate;

pub(super) fn of_tether(kind: &EventKind) -> Option<LogLine> {
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
