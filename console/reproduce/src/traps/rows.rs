//! Rows of one method on one kind of trap.

use super::{Method, measured::Measured};
use crate::{row::Row, sample::Sample};

const MISSING: &str = "no such planner here";

/// The rows of what was measured.
pub(super) fn rows(table: &str, case: &str, method: &Method, measured: &[&Measured]) -> Vec<Row> {
    let n = measured.len();
    let row = |metric: &str, ours: Option<f64>, unit: &str, n: usize| {
        Row::new(table, case, method.id, metric, ours, unit).of(n).note(method.note)
    };
    if measured.iter().any(|one| !one.is_there) {
        return vec![row("success_rate", None, "", 0).note(MISSING)];
    }
    let count = |is: fn(&Measured) -> bool| measured.iter().filter(|one| is(one)).count() as f64;
    let ratios: Sample = measured.iter().filter_map(|one| one.ratio).collect();
    let plans: Sample = measured.iter().filter_map(|one| one.plan_time_ms).collect();
    let replans: Sample = measured.iter().flat_map(|one| one.replan_times_ms.iter().copied()).collect();
    let mut rows = vec![
        row("success_rate", Some(count(|one| one.arrives) / n as f64), "", n),
        row("collisions", Some(count(|one| one.collides)), "layouts", n),
        row("length_ratio_mean", ratios.mean(), "", ratios.len()),
        row("length_ratio_median", ratios.median(), "", ratios.len()),
        row("length_ratio_p95", ratios.quantile(0.95), "", ratios.len()),
        row("length_ratio_max", ratios.max(), "", ratios.len()),
        row("plan_time_ms", plans.mean(), "ms", plans.len()),
        row("plan_time_ms_median", plans.median(), "ms", plans.len()),
    ];
    if !replans.is_empty() {
        rows.extend([
            row("replan_time_ms", replans.mean(), "ms", replans.len()),
            row("replan_time_ms_median", replans.median(), "ms", replans.len()),
            row("replan_time_ms_p95", replans.quantile(0.95), "ms", replans.len()),
        ]);
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::traps::methods;

    fn measured(ratio: Option<f64>) -> Measured {
        Measured {
            is_there: true,
            arrives: ratio.is_some(),
            collides: ratio.is_none(),
            ratio,
            plan_time_ms: Some(1.0),
            replan_times_ms: vec![0.5],
        }
    }

    #[test]
    fn ratios_are_those_of_the_ways_that_arrive() {
        let all = [measured(Some(1.0)), measured(Some(1.2)), measured(None), measured(Some(1.1))];
        let rows = rows("trap-suite", "u", &methods()[0], &all.iter().collect::<Vec<_>>());
        let value = |metric: &str| rows.iter().find(|row| row.metric == metric).and_then(|row| row.ours);
        assert_eq!((value("success_rate"), value("collisions")), (Some(0.75), Some(1.0)));
        assert!((value("length_ratio_mean").unwrap() - 1.1).abs() < 1e-12);
        assert_eq!(value("replan_time_ms_median"), Some(0.5));
    }

    #[test]
    fn a_missing_planner_is_reported() {
        let missing = Measured { is_there: false, ..measured(None) };
        let rows = rows("trap-suite", "u", &methods()[0], &[&missing]);
        assert_eq!((rows.len(), rows[0].ours, rows[0].note.as_str()), (1, None, MISSING));
    }
}
