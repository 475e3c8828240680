//! Compares the figures of a report with those derived from its journal.

use account::Summary;
use report::first_difference;

/// The first figure that differs between report and journal, with both values. Data that is not in the events is not
/// compared.
pub(super) fn difference(reported: Summary, computed: &Summary) -> Option<String> {
    let computed = Summary {
        wall_time_s: reported.wall_time_s,
        violations: reported.violations.clone(),
        planner_calls: reported.planner_calls,
        stops: reported.stops,
        events_sha256: reported.events_sha256.clone(),
        recording_sha256: reported.recording_sha256.clone(),
        logs: reported.logs.clone(),
        ..computed.clone()
    };
    // The figures are converted to text and back, like those in the report.
    let text = serde_json::to_string(&computed).ok()?;
    let computed = serde_json::to_value(serde_json::from_str::<Summary>(&text).ok()?).ok()?;
    let found = first_difference(&serde_json::to_value(reported).ok()?, &computed)?;
    Some(format!("{} is {}; the journal gives {}", found.key, found.one, found.other))
}
