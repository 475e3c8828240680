//! What the gate asks of readings that were located.

use super::{
    super::{
        Document,
        decisions::{Decision, MISSED, SCOPE},
    },
    Located,
};
use crate::human::text::counted;

/// An answer and what it lacks.
type Answered = (String, Vec<String>);

/// What was located.
pub(in crate::document) fn scope(located: &Located) -> String {
    format!("positions located from the readings of {}; no mission was flown", located.files())
}

/// The program and the readings.
pub(in crate::document) fn equipment(document: &Document, located: &Located) -> String {
    let version = document.runs.first().map_or("", |run| run.tankops_version.as_str());
    let readings = located.readings.iter().map(|of| format!("{} (SHA-256 {})", of.file, of.sha256));
    format!("tankops {version}, readings {}", readings.collect::<Vec<_>>().join(", "))
}

/// Plates are stated if the tool was known to be on.
pub(in crate::document) fn plates(document: &Document) -> Answered {
    let count = counted(document.floor.plates.len() as u64, "plate");
    (
        format!("{count}; no coverage is stated, because the readings do not say when the tool was on"),
        Vec::new(),
    )
}

/// No floor was to be scanned.
pub(in crate::document) fn missed(located: &Located) -> Answered {
    let what = match located.tool_on_s {
        Some(on_s) => format!("no floor was to be scanned by a mission; the tool was on for {on_s:.1} s"),
        None => "no floor was to be scanned by a mission, and when the tool was on is not known".into(),
    };
    (what, Vec::new())
}

/// Nothing was reached or not.
pub(in crate::document) fn unreachable() -> Answered {
    ("not stated: whatever moved the instrument is not known to this program".into(), Vec::new())
}

/// Readings have no tether.
pub(in crate::document) fn tether() -> Answered {
    ("not recorded in readings".into(), Vec::new())
}

/// How the true error of readings came about.
pub(in crate::document) fn accuracy_how(inside: &str) -> String {
    format!(
        "by the true places that stand in the readings (a total station, or a simulator); within the 95 % ellipse in {inside} % of \
         the moments"
    )
}

/// What must be decided before readings are signed.
pub(in crate::document) fn decisions(document: &Document, located: &Located) -> Vec<Decision> {
    let facts = &document.inspection;
    if located.tool_on_s.is_none() {
        return vec![Decision {
            what: "The readings do not say when the tool was on, so no coverage is stated: accept that, or locate them again with a \
                   column tool_on or with --tool-on."
                .into(),
            section: 3,
            key: "coverage_waiver",
            item: SCOPE,
            answer: facts.coverage_waiver.clone(),
        }];
    }
    let whole = &document.floor.whole;
    let left_m2 = (1.0 - whole.scanned) * whole.area_m2;
    let decision = Decision {
        what: format!(
            "{left_m2:.1} of {:.1} m² of floor did not come under the tool with a known position: accept, scan, or inspect by hand.",
            whole.area_m2
        ),
        section: 3,
        key: "missed_accepted",
        item: MISSED,
        answer: facts.missed_accepted.clone(),
    };
    if left_m2 > 0.0 { vec![decision] } else { Vec::new() }
}
