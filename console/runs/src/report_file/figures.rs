//! Compares the figures of a report with those derived from its journal.

use account::Summary;
use report::first_difference;

/// The first figure that differs between the report and the journal, with both values. Data that is not in the events
/// is not compared.
pub(super) fn difference(reported: Summary, computed: &Summary) -> Option<String> {
    let mut computed = Summary {
        wall_time_s: reported.wall_time_s,
        violations: reported.violations.clone(),
        planner_calls: reported.planner_calls,
        stops: reported.stops,
        events_sha256: reported.events_sha256.clone(),
        recording_sha256: reported.recording_sha256.clone(),
        readings_sha256: reported.readings_sha256.clone(),
        logs: reported.logs.clone(),
        ..computed.clone()
    };
    leave_out_new(&mut computed, &reported);
    // The figures are converted to text and back, like those in the report.
    let text = serde_json::to_string(&computed).ok()?;
    let computed = serde_json::to_value(serde_json::from_str::<Summary>(&text).ok()?).ok()?;
    let found = first_difference(&serde_json::to_value(reported).ok()?, &computed)?;
    Some(format!("{} is {}; the journal gives {}", found.key, found.one, found.other))
}

/// Leaves out the figures that older reports do not have.
fn leave_out_new(computed: &mut Summary, reported: &Summary) {
    if reported.extremes.is_empty() {
        computed.extremes.clear();
    }
    let mut plates = reported.floor.iter().flat_map(|floor| &floor.plates);
    let is_older = plates.all(|plate| plate.error_max_m.is_none());
    for plate in computed.floor.iter_mut().flat_map(|floor| &mut floor.plates).filter(|_| is_older) {
        plate.error_max_m = None;
    }
    let mut plates = reported.floor.iter().flat_map(|floor| &floor.plates);
    let has_no_truth = plates.all(|plate| plate.true_error_max_m.is_none());
    for plate in computed.floor.iter_mut().flat_map(|floor| &mut floor.plates).filter(|_| has_no_truth) {
        (plate.true_error_p95_m, plate.true_error_max_m) = (None, None);
    }
}
