//! What a table says: how often the missions succeed, what they cost, and how the planners compare.

use crate::{
    frozen::Campaign,
    statistics::{Mean, Share, mean, quantile},
    table::{Table, more_is_better},
};
use serde::Serialize;
use std::collections::BTreeMap;

/// Missions named as the worst.
const WORST: usize = 10;

/// What a table says.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Findings {
    /// What the campaign is called.
    pub name: String,
    /// Missions of the plan.
    pub planned: u64,
    /// Missions in the table.
    pub rows: u64,
    /// Of these, refused by their scenario or planner.
    pub refused: u64,
    /// Of these, not flown because the program failed.
    pub failed: u64,
    /// Of these, flown with faults of planners.
    pub with_faults: u64,
    /// Columns that the findings are about.
    pub metrics: Vec<String>,
    /// What is compared, in the order of the plan.
    pub arms: Vec<Arm>,
    /// Missions to be looked at first.
    pub worst: Vec<Worst>,
}

/// A planner at a point of the grid.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Arm {
    /// Planner and values.
    pub name: String,
    /// How often a mission is complete and keeps every bound.
    pub success: Share,
    /// The metrics over the missions that were flown; absent where none has the figure.
    pub means: Vec<Option<Mean>>,
    /// Success and the metrics less those of the first arm, over missions of equal scenario and seed; absent for the first.
    pub differences: Vec<Option<Mean>>,
    /// Success for each scenario, where there are several.
    pub scenarios: Vec<(String, Share)>,
    /// Quantiles of the first metric: at 0, 1/40, ... 1.
    pub quantiles: Vec<f64>,
}

/// A mission to be looked at.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Worst {
    /// What came of it.
    pub what: String,
    /// The command that flies it again.
    pub command: String,
}

/// The columns that findings need.
struct Columns {
    cases: Vec<u64>,
    status: Vec<Option<String>>,
    success: Vec<bool>,
    metrics: Vec<Vec<Option<f64>>>,
}

impl Columns {
    fn of(table: &Table, metrics: &[String]) -> Self {
        Self {
            cases: table.numbers("case").iter().map(|case| case.unwrap_or(0.0) as u64).collect(),
            status: table.words("status"),
            success: table.flags("success"),
            metrics: metrics.iter().map(|metric| table.numbers(metric)).collect(),
        }
    }

    fn is_flown(&self, row: usize) -> bool {
        self.status[row].as_deref() == Some("flown")
    }

    /// A metric of a mission that was flown; the one before the first is success.
    fn value(&self, metric: usize, row: usize) -> Option<f64> {
        match metric.checked_sub(1) {
            None => Some(f64::from(u8::from(self.success[row]))),
            Some(metric) => self.metrics[metric].get(row).copied().flatten(),
        }
    }
}

/// What the table of a campaign says.
pub fn findings(campaign: &Campaign, table: &Table) -> Findings {
    let columns = Columns::of(table, &campaign.design.metrics);
    let mut of_arm: Vec<Vec<usize>> = vec![Vec::new(); campaign.arms()];
    (0..table.len()).for_each(|row| of_arm[campaign.arm(columns.cases[row])].push(row));
    let first = pairs(campaign, &columns, &of_arm[0]);
    let arm = |at: usize| arm(campaign, &columns, at, &of_arm[at], &first);
    let count =
        |word: &str| columns.status.iter().filter(|status| status.as_deref() == Some(word)).count() as u64;
    Findings {
        name: campaign.design.name.clone(),
        planned: campaign.cases(),
        rows: table.len() as u64,
        refused: count("refused"),
        failed: count("failed"),
        with_faults: table.numbers("planner_faults").iter().filter(|n| n.is_some_and(|n| n > 0.0)).count()
            as u64,
        metrics: campaign.design.metrics.clone(),
        arms: (0..campaign.arms()).map(arm).collect(),
        worst: worst(campaign, table, &columns),
    }
}

/// The rows of an arm by scenario and seed.
fn pairs(campaign: &Campaign, columns: &Columns, rows: &[usize]) -> BTreeMap<u64, usize> {
    rows.iter().map(|row| (columns.cases[*row] / campaign.arms() as u64, *row)).collect()
}

fn arm(
    campaign: &Campaign,
    columns: &Columns,
    at: usize,
    rows: &[usize],
    first: &BTreeMap<u64, usize>,
) -> Arm {
    let flown: Vec<usize> = rows.iter().copied().filter(|row| columns.is_flown(*row)).collect();
    let own = pairs(campaign, columns, rows);
    let difference = |metric: usize| {
        let off = own.iter().filter_map(|(pair, row)| {
            let other = *first.get(pair)?;
            let both = columns.is_flown(*row) && columns.is_flown(other);
            both.then(|| Some(columns.value(metric, *row)? - columns.value(metric, other)?)).flatten()
        });
        mean(off)
    };
    let metrics = 1..=campaign.design.metrics.len();
    let mut sorted: Vec<f64> = flown.iter().filter_map(|row| columns.value(1, *row)).collect();
    sorted.sort_by(f64::total_cmp);
    Arm {
        name: campaign.arm_name(at),
        success: share(columns, &flown),
        means: metrics
            .map(|metric| mean(flown.iter().filter_map(|row| columns.value(metric, *row))))
            .collect(),
        differences: if at == 0 {
            Vec::new()
        } else {
            (0..=campaign.design.metrics.len()).map(difference).collect()
        },
        scenarios: by_scenario(campaign, columns, &flown),
        quantiles: (0..=40).filter_map(|k| quantile(&sorted, f64::from(k) / 40.0)).collect(),
    }
}

fn share(columns: &Columns, rows: &[usize]) -> Share {
    Share::of(rows.iter().filter(|row| columns.success[**row]).count() as u64, rows.len() as u64)
}

fn by_scenario(campaign: &Campaign, columns: &Columns, rows: &[usize]) -> Vec<(String, Share)> {
    if campaign.scenarios.len() < 2 {
        return Vec::new();
    }
    let of = |name: &String| {
        let is_of = |row: &&usize| campaign.case(columns.cases[**row]).scenario.name == *name;
        rows.iter().filter(is_of).copied().collect::<Vec<_>>()
    };
    campaign.scenarios.iter().map(|s| (s.name.clone(), share(columns, &of(&s.name)))).collect()
}

/// Missions that failed first, then those that did not succeed, each by the first metric.
fn worst(campaign: &Campaign, table: &Table, columns: &Columns) -> Vec<Worst> {
    let Some(metric) = campaign.design.metrics.first() else { return Vec::new() };
    let sign = if more_is_better(metric) { 1.0 } else { -1.0 };
    let rank = |row: usize| match columns.status[row].as_deref() {
        Some("failed") => 0,
        Some("flown") if !columns.success[row] => 1,
        Some("refused") => 2,
        _ => 3,
    };
    let mut rows: Vec<usize> = (0..table.len()).collect();
    let key = |row: usize| (rank(row), columns.value(1, row).map_or(f64::INFINITY, |value| sign * value));
    rows.sort_by(|a, b| {
        let (a, b) = (key(*a), key(*b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    rows.truncate(WORST);
    let texts = ["error", "reason", "violations", "outcome"].map(|name| table.words(name));
    let what = |row: usize| {
        let [error, reason, violations, outcome] =
            [0, 1, 2, 3].map(|at| texts[at][row].clone().unwrap_or_default());
        let kept = violations.is_empty();
        let why = if !error.is_empty() {
            error
        } else if kept {
            reason
        } else {
            violations
        };
        let figure = columns.value(1, row).map(|value| format!(", {metric} {value:.2}")).unwrap_or_default();
        let head = if outcome.is_empty() { columns.status[row].clone().unwrap_or_default() } else { outcome };
        let why = if why.is_empty() { why } else { format!(": {why}") };
        format!("{head}{figure}{why}")
    };
    let named =
        |row: usize| Worst { what: what(row), command: campaign.command(&campaign.case(columns.cases[row])) };
    rows.into_iter().map(named).collect()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::{
        frozen::tests::campaign,
        part,
        row::Row,
        table::tests::{PLAN, file, row},
    };

    pub(crate) fn example() -> Findings {
        let campaign = campaign(&format!("block = 160\n{PLAN}"));
        let rows: Vec<Row> = (0..campaign.cases()).map(row).collect();
        let table = part::read(&campaign, 0, file(&part::write(&campaign, 0, &rows).expect("written")))
            .expect("read");
        findings(&campaign, &table)
    }

    #[test]
    fn findings_are_those_of_the_rows() {
        let findings = example();
        let flown = |n: &u64| n * 7919 % 101 >= 4;
        let of_first: Vec<u64> = (0..160).filter(|n| n % 4 == 0).filter(flown).collect();
        assert_eq!(findings.arms.len(), 4);
        assert_eq!(findings.arms[0].name, "p k=0.5");
        assert_eq!(findings.arms[0].success.n, of_first.len() as u64);
        let mean =
            of_first.iter().map(|n| 100.0 + (n * 7919 % 101) as f64).sum::<f64>() / of_first.len() as f64;
        let ours = findings.arms[0].means[0].expect("a mean").mean;
        assert!((ours - mean).abs() < 1e-9);
        assert_eq!(findings.arms[0].scenarios.len(), 2);
        assert!(findings.arms[0].differences.is_empty() && findings.arms[1].differences.len() == 3);
        assert!(findings.worst[0].what.starts_with("stuck, mission_time_s 1"), "{:?}", findings.worst[0]);
        assert!(findings.worst[0].command.starts_with("tankops run "));
    }
}
