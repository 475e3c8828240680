//! Compares the figures of a report with those derived from its journal.

use account::{Account, Cause, Explained, Figure, FigureId, Limit, MissReason, Summary};
use report::first_difference;
use serde_json::Value;

/// The first figure that differs between the report and the journal, with both values. Data that is not in the events
/// is not compared, and neither is the wording of a cause: another version of the console may have worded it.
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
    let mut computed = serde_json::to_value(serde_json::from_str::<Summary>(&text).ok()?).ok()?;
    let reported = serde_json::to_value(reported).ok()?;
    reword(&mut computed, &reported);
    let found = first_difference(&reported, &computed)?;
    Some(format!("{} is {}; the journal gives {}", found.key, found.one, found.other))
}

/// Leaves out the figures that older reports do not have, and the limit that they state differently: the true clearance
/// was compared with 0.
fn leave_out_new(computed: &mut Summary, reported: &Summary) {
    let older = Some(Limit::Least(0.0));
    let is_older = |figure: &Figure| figure.id == FigureId::TrueClearance && figure.limit == older;
    if reported.extremes.iter().any(is_older) {
        let figures = computed.extremes.iter_mut().filter(|figure| figure.id == FigureId::TrueClearance);
        figures.for_each(|figure| figure.limit = older);
    }
    if reported.extremes.is_empty() {
        computed.extremes.clear();
    }
    if let (Some(computed), Some(Account { requested: None, .. })) = (&mut computed.floor, &reported.floor) {
        computed.requested = None;
    }
    let knows_beside = |account: &Account| {
        let areas = account.missed.iter().flat_map(|area| &area.causes);
        areas.chain(&account.slivers.causes).any(|cause| cause.reason == MissReason::NoLaneBeside)
    };
    if !reported.floor.as_ref().is_some_and(knows_beside) {
        computed.floor.iter_mut().for_each(merge_beside);
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

/// Older reports give too little room as the reason for all floor beside solid objects, even where a lane has room.
fn merge_beside(account: &mut Account) {
    let slivers = &mut account.slivers.causes;
    account.missed.iter_mut().map(|area| &mut area.causes).chain([slivers]).for_each(merge_causes);
    for area in &mut account.missed {
        area.reason = area.causes.first().map_or(area.reason, |cause| cause.reason);
    }
}

fn merge_causes(causes: &mut Vec<Cause<MissReason>>) {
    let is_beside = |cause: &Cause<MissReason>| cause.reason == MissReason::NoLaneBeside;
    let Some(index) = causes.iter().position(is_beside) else { return };
    let beside = causes.remove(index);
    if let Some(cause) = causes.iter_mut().find(|cause| cause.reason == MissReason::Clearance) {
        cause.area_m2 += beside.area_m2;
        if let (Some(own), Some(other)) = (&mut cause.measure, beside.measure) {
            let most_m = own.to_m.into_iter().chain(other.to_m).reduce(f64::max);
            if other.value_m < own.value_m {
                *own = other;
            }
            own.to_m = most_m;
        }
        cause.text = cause.reason.sentence(cause.measure.as_ref());
    } else {
        let text = MissReason::Clearance.sentence(beside.measure.as_ref());
        causes.push(Cause { reason: MissReason::Clearance, text, ..beside });
    }
    causes.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2).then(a.reason.cmp(&b.reason)));
}

/// Words the computed causes like the reported ones, where both state the same figures. Reason and measure of a cause say
/// the same as its text and are compared. A cause without a measure comes from a version that did not know it.
fn reword(computed: &mut Value, reported: &Value) {
    match (computed, reported) {
        (Value::Object(computed), Value::Object(reported)) => {
            if let (Some(Value::String(ours)), Some(Value::String(theirs))) =
                (computed.get("text"), reported.get("text"))
            {
                let is_older = reported.get("measure").is_some_and(Value::is_null);
                if is_older || numbers(ours).eq(numbers(theirs)) {
                    let theirs = Value::from(theirs.as_str());
                    computed.insert("text".to_owned(), theirs);
                }
                if is_older {
                    computed.insert("measure".to_owned(), Value::Null);
                }
            }
            for (key, value) in computed {
                reported.get(key).into_iter().for_each(|other| reword(value, other));
            }
        }
        (Value::Array(computed), Value::Array(reported)) => {
            computed.iter_mut().zip(reported).for_each(|(value, other)| reword(value, other));
        }
        _ => {}
    }
}

/// The numbers in a sentence, in order.
fn numbers(sentence: &str) -> impl Iterator<Item = &str> {
    let runs = sentence.split(|letter: char| !letter.is_ascii_digit() && letter != '.');
    runs.map(|run| run.trim_matches('.')).filter(|run| !run.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// The cause of a missed area, with a text and its measure.
    fn cause(text: &str, value_m: Option<f64>) -> Value {
        let measure = value_m.map(|value_m| json!({ "value_m": value_m }));
        json!({ "causes": [{ "reason": "not_reached", "area_m2": 1.5, "measure": measure, "text": text }] })
    }

    /// The first difference between a reported cause and the computed one.
    fn found(reported: &Value, mut computed: Value) -> Option<String> {
        reword(&mut computed, reported);
        first_difference(reported, &computed).map(|found| found.key)
    }

    #[test]
    fn an_older_report_has_one_reason_for_all_floor_beside_solid_objects() {
        let cause = |reason, area_m2, value_m: f64, to_m: f64| {
            let measure = json!({ "value_m": value_m, "to_m": to_m, "limit_m": 0.45, "near": "the shell" });
            let measure = Some(serde_json::from_value(measure).expect("a measure"));
            Cause { reason, area_m2, measure, text: String::new() }
        };
        let mut causes = vec![
            cause(MissReason::NoLaneBeside, 2.0, 0.2, 0.4),
            cause(MissReason::NotPlanned, 1.5, 0.3, 0.3),
            cause(MissReason::Clearance, 1.0, 0.1, 0.3),
        ];
        merge_causes(&mut causes);
        let reasons: Vec<MissReason> = causes.iter().map(|cause| cause.reason).collect();
        assert_eq!(reasons, [MissReason::Clearance, MissReason::NotPlanned]);
        assert!((causes[0].area_m2 - 3.0).abs() < 1e-12);
        let text = "not planned: 0.10 to 0.40 m from the shell, but hull and clearance require 0.45 m";
        assert_eq!(causes[0].text, text);
        let mut alone = vec![cause(MissReason::NoLaneBeside, 2.0, 0.2, 0.4)];
        merge_causes(&mut alone);
        assert_eq!(alone[0].reason, MissReason::Clearance);
    }

    #[test]
    fn other_words_for_the_same_figures_are_not_a_difference() {
        let now = || cause("the hull stayed 0.25 m away", Some(0.25));
        assert_eq!(found(&cause("hull 0.25 m off.", Some(0.25)), now()), None);
        assert_eq!(
            found(&cause("the hull stayed away", None), now()),
            None,
            "an older report has no measure"
        );
        let at = |name: &str| Some(format!("causes.0.{name}"));
        assert_eq!(found(&cause("hull 0.26 m off.", Some(0.25)), now()), at("text"));
        assert_eq!(found(&cause("hull 0.26 m off.", Some(0.26)), now()), at("measure.value_m"));
    }
}
