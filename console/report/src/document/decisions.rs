//! What the inspector must decide before signing: each decision is a key of `[inspection]` with the reason.

use super::{Document, located};
use crate::human::text::counted;
use mission::Outcome;

/// Item of the gate on the tank.
pub(super) const TANK: usize = 1;
/// Item of the gate on the scope.
pub(super) const SCOPE: usize = 2;
/// Item of the gate on missed areas.
pub(super) const MISSED: usize = 6;

/// Something to be decided.
pub(super) struct Decision {
    /// What.
    pub(super) what: String,
    /// The section that shows it.
    pub(super) section: usize,
    /// Its key under `[inspection]`.
    pub(super) key: &'static str,
    /// The item of the gate that stays open without it.
    pub(super) item: usize,
    /// The reason given.
    pub(super) answer: Option<String>,
}

/// The decisions that a document asks for.
pub(super) fn decisions(document: &Document) -> Vec<Decision> {
    let (floor, zone, facts) = (&document.floor, &document.floor.critical_zone, &document.inspection);
    let mut decisions = Vec::new();
    if let Some(contradiction) = &document.contradiction {
        decisions.push(Decision {
            what: format!("The facts contradict the scenario that was flown: {contradiction}."),
            section: 1,
            key: "identity_corrected",
            item: TANK,
            answer: facts.identity_corrected.clone(),
        });
    }
    if let Some(located) = &document.located {
        decisions.extend(located::decisions(document, located));
        return decisions;
    }
    if !is_complete(document) {
        decisions.push(Decision {
            what: "Mission incomplete: accept what was scanned, or let another run join this report (tankops rescan).".into(),
            section: 7,
            key: "partial_scope_accepted",
            item: SCOPE,
            answer: facts.partial_scope_accepted.clone(),
        });
    }
    if document.is_to_scan && !zone.done {
        let (left_m, of_m, width_mm) = (zone.length_m - zone.done_m, zone.length_m, 1000.0 * zone.width_m);
        decisions.push(Decision {
            what: format!("Critical zone: {left_m:.1} of {of_m:.1} m of shell not scanned over the whole {width_mm:.0} mm."),
            section: 4,
            key: "critical_zone_accepted",
            item: SCOPE,
            answer: facts.critical_zone_accepted.clone(),
        });
    }
    if let Some(largest) = floor.missed.first() {
        let (count, area_m2) = (counted(floor.missed.len() as u64, "missed area"), largest.area_m2);
        decisions.push(Decision {
            what: format!(
                "{count} of 0.01 m² and more, the largest {area_m2:.2} m²: accept, scan again, or inspect by hand."
            ),
            section: 3,
            key: "missed_accepted",
            item: MISSED,
            answer: facts.missed_accepted.clone(),
        });
    }
    decisions
}

/// Whether the last of the runs did all that it was to do.
pub(super) fn is_complete(document: &Document) -> bool {
    document.runs.last().is_some_and(|run| run.outcome == Some(Outcome::Complete))
}
