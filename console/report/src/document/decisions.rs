//! The decisions that the inspector must make before signing. Each is a key under `[inspection]`, with the reason as
//! its value.

use super::{
    decision::{Decision, MISSED, SCOPE, TANK},
    found, located,
    model::Document,
};
use crate::human::text::counted;
use account::Account;
use mission::Outcome;

/// The smallest area of missed floor that needs a decision, square metres; smaller areas are not listed.
const LEAST_M2: f64 = 0.01;

/// Returns the decisions that a document requires.
pub(super) fn decisions(document: &Document) -> Vec<Decision> {
    let (floor, zone, facts) = (&document.floor, &document.floor.critical_zone, &document.inspection);
    let mut decisions = Vec::new();
    if let Some(contradiction) = &document.contradiction {
        decisions.push(Decision {
            what: format!(
                "The facts under [inspection] contradict the scenario of the run: {contradiction}."
            ),
            section: 1,
            key: "identity_corrected",
            item: TANK,
            answer: facts.identity_corrected.clone(),
        });
    }
    decisions.extend(found::decisions(document));
    if let Some(located) = &document.located {
        decisions.extend(located::decisions(document, located));
        return decisions;
    }
    if !is_complete(document) {
        decisions.push(Decision {
            what: "Mission incomplete: accept what was scanned, or add a re-scan to this report (tankops \
                rescan)."
                .into(),
            section: 7,
            key: "partial_scope_accepted",
            item: SCOPE,
            answer: facts.partial_scope_accepted.clone(),
        });
    }
    if document.is_to_scan && !zone.done {
        let (left_m, of_m, width_mm) = (zone.length_m - zone.done_m, zone.length_m, 1000.0 * zone.width_m);
        decisions.push(Decision {
            what: format!(
                "Critical zone: along {left_m:.1} of {of_m:.1} m of shell, the full width of {width_mm:.0} \
                mm was not scanned."
            ),
            section: 4,
            key: "critical_zone_accepted",
            item: SCOPE,
            answer: facts.critical_zone_accepted.clone(),
        });
    }
    if let Some(what) = missed(floor) {
        decisions.push(Decision {
            what,
            section: 3,
            key: "missed_accepted",
            item: MISSED,
            answer: facts.missed_accepted.clone(),
        });
    }
    decisions
}

/// The floor that was missed although the mission had to scan it, with what to do; `None` if it is less than 0.01 m².
fn missed(floor: &Account) -> Option<String> {
    let largest = floor.missed.first()?;
    let what = if let Some(requested) = &floor.requested {
        let missed_m2 = requested.missed * requested.area_m2;
        (missed_m2 >= LEAST_M2).then(|| format!("{missed_m2:.2} m² of the requested floor was missed"))?
    } else {
        let count = counted(floor.missed.len() as u64, "missed area");
        format!("{count} of at least {LEAST_M2} m², the largest {:.2} m²", largest.area_m2)
    };
    Some(format!("{what}: accept, re-scan, or inspect by hand."))
}

/// Whether the last run completed its task.
pub(super) fn is_complete(document: &Document) -> bool {
    document.runs.last().is_some_and(|run| run.outcome == Some(Outcome::Complete))
}
