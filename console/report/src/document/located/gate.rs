//! The gate items of a report on located readings.

use super::super::{
    decision::{Decision, MISSED, SCOPE},
    model::Document,
    readings::Located,
};
use crate::human::text::counted;

/// The answer to an item, and the facts or actions that are still missing.
type Answered = (String, Vec<String>);

/// The answer about the scope: the readings that were located.
pub(in crate::document) fn scope(located: &Located) -> String {
    format!("positions located from the readings in {}; no mission was run", located.files())
}

/// The answer about the equipment: the program and the readings.
pub(in crate::document) fn equipment(document: &Document, located: &Located) -> String {
    let version = document.runs.first().map_or("", |run| run.tankops_version.as_str());
    let readings = located.readings.iter().map(|of| format!("{} (SHA-256 {})", of.file, of.sha256));
    format!("tankops {version}, readings {}", readings.collect::<Vec<_>>().join(", "))
}

/// The answer about the plates if it is not known when the tool was on.
pub(in crate::document) fn plates(document: &Document) -> Answered {
    let count = counted(document.floor.plates.len() as u64, "plate");
    (
        format!("{count}; no coverage is stated because the readings do not show when the tool was on"),
        Vec::new(),
    )
}

/// The answer about missed floor: no floor had to be scanned.
pub(in crate::document) fn missed(located: &Located) -> Answered {
    let what = match located.tool_on_s {
        Some(on_s) => format!("no scan of the floor was planned; the tool was on for {on_s:.1} s"),
        None => "no scan of the floor was planned, and it is not known when the tool was on".into(),
    };
    (what, Vec::new())
}

/// The answer about unreachable floor, which is not defined for readings.
pub(in crate::document) fn unreachable() -> Answered {
    ("not stated: this program has no data on the vehicle that carried the instrument".into(), Vec::new())
}

/// The answer about the tether, which is not part of readings.
pub(in crate::document) fn tether() -> Answered {
    ("not part of the readings".into(), Vec::new())
}

/// How the true error of located positions was determined.
pub(in crate::document) fn accuracy_how(inside: &str) -> String {
    format!(
        "from the true positions in the readings (measured by a total station, or simulated); true position \
         within the 95 % ellipse for {inside} % of the estimates"
    )
}

/// The decisions that located readings require before signing.
pub(in crate::document) fn decisions(document: &Document, located: &Located) -> Vec<Decision> {
    let facts = &document.inspection;
    if located.tool_on_s.is_none() {
        return vec![Decision {
            what: "No coverage is stated because the readings do not show when the tool was on: accept \
                   that, or locate the readings again with a column tool_on or with --tool-on."
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
            "The tool did not pass over {left_m2:.1} of {:.1} m² of floor while it was on and the position \
             was known: accept, scan, or inspect by hand.",
            whole.area_m2
        ),
        section: 3,
        key: "missed_accepted",
        item: MISSED,
        answer: facts.missed_accepted.clone(),
    };
    if left_m2 > 0.0 { vec![decision] } else { Vec::new() }
}
