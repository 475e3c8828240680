//! Rows of one method on one kind of trap.

use super::measured::Measured;
use crate::study::{Block, Row, Sample};

const MISSING: &str = "no such planner is installed";

/// The rows of the measurements; a missing planner has no measurements.
pub(super) fn rows(block: &Block<'_>, measured: &[&Option<Measured>]) -> Vec<Row> {
    let n = measured.len();
    let Some(measured) = measured.iter().map(|one| one.as_ref()).collect::<Option<Vec<&Measured>>>() else {
        return vec![block.row("success_rate", None, "", 0).note(MISSING)];
    };
    let count = |is: fn(&Measured) -> bool| measured.iter().filter(|one| is(one)).count() as f64;
    let ratios: Sample = measured.iter().filter_map(|one| one.ratio).collect();
    let plans: Sample = measured.iter().filter_map(|one| one.plan_time_ms).collect();
    let replans: Sample = measured.iter().flat_map(|one| one.replan_times_ms.iter().copied()).collect();
    let mut rows = vec![
        block.row("success_rate", count(|one| one.arrives) / n as f64, "", n),
        block.row("collisions", count(|one| one.collides), "layouts", n),
        block.row("length_ratio_mean", ratios.mean(), "", ratios.len()),
        block.row("length_ratio_median", ratios.median(), "", ratios.len()),
        block.row("length_ratio_p95", ratios.quantile(0.95), "", ratios.len()),
        block.row("length_ratio_max", ratios.max(), "", ratios.len()),
    ];
    rows.extend(block.mean_and_median("plan_time_ms", &plans, "ms"));
    if !replans.is_empty() {
        rows.extend(block.mean_and_median("replan_time_ms", &replans, "ms"));
        rows.push(block.row("replan_time_ms_p95", replans.quantile(0.95), "ms", replans.len()));
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    const BLOCK: Block<'_> = Block { table: "trap-suite", case: "u", method: "apf", note: "" };

    fn measured(ratio: Option<f64>) -> Measured {
        Measured {
            arrives: ratio.is_some(),
            collides: ratio.is_none(),
            ratio,
            plan_time_ms: Some(1.0),
            replan_times_ms: vec![0.5],
        }
    }

    #[test]
    fn ratios_are_those_of_the_paths_that_arrive() {
        let all = [Some(1.0), Some(1.2), None, Some(1.1)].map(|ratio| Some(measured(ratio)));
        let rows = rows(&BLOCK, &all.iter().collect::<Vec<_>>());
        let value = |metric: &str| rows.iter().find(|row| row.metric == metric).and_then(|row| row.ours);
        assert_eq!((value("success_rate"), value("collisions")), (Some(0.75), Some(1.0)));
        assert!((value("length_ratio_mean").unwrap() - 1.1).abs() < 1e-12);
        assert_eq!(value("replan_time_ms_median"), Some(0.5));
    }

    #[test]
    fn a_missing_planner_is_reported() {
        let rows = rows(&BLOCK, &[&None]);
        assert_eq!((rows.len(), rows[0].ours, rows[0].note.as_str()), (1, None, MISSING));
    }
}
