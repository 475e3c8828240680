//! The findings from a campaign's table: how often the missions succeed, what they cost, and how the planners compare.

use crate::{
    frozen::Campaign,
    statistics::{Mean, Share, mean, quantile},
    table::{Table, more_is_better},
};
use serde::Serialize;
use std::collections::BTreeMap;

/// Maximum number of missions listed as the worst ones.
const WORST: usize = 10;
/// The word for the outcome of a complete mission in the table.
pub(crate) const COMPLETE: &str = "complete";

/// The findings from a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Findings {
    /// Name of the campaign.
    pub name: String,
    /// Number of missions in the plan.
    pub planned: u64,
    /// Number of missions in the table.
    pub rows: u64,
    /// Number of missions in the table that were refused by their scenario or planner.
    pub refused: u64,
    /// Number of missions in the table that did not run because the program failed.
    pub failed: u64,
    /// Number of missions in the table that ran with planner faults.
    pub with_faults: u64,
    /// The planners with faults.
    pub faults: Vec<Faults>,
    /// Columns that the findings cover.
    pub metrics: Vec<String>,
    /// The arms of the comparison, in the order in which the plan lists them.
    pub arms: Vec<Arm>,
    /// The missions to inspect first.
    pub worst: Vec<Worst>,
}

/// A planner at one point of the grid.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Arm {
    /// Planner and values.
    pub name: String,
    /// Share of the missions that are complete and met every bound.
    pub success: Share,
    /// Share of the missions run that are complete, whether or not they met the bounds.
    pub complete: Share,
    /// The metrics over the complete missions; absent if none of these missions has the figure. The cost of an incomplete
    /// mission says nothing about the cost of the task.
    pub means: Vec<Option<Mean>>,
    /// The metrics over the missions that ran but are incomplete.
    pub means_of_incomplete: Vec<Option<Mean>>,
    /// Differences from the first arm over missions with the same scenario and seed: first success, over the missions
    /// that both arms ran; then the metrics, over the missions that both completed. Absent for the first arm.
    pub differences: Vec<Option<Mean>>,
    /// Success for each scenario, if there is more than one.
    pub scenarios: Vec<(String, Share)>,
    /// Quantiles of the first metric over the complete missions, at 0, 1/40, ... 1.
    pub quantiles: Vec<f64>,
}

impl Arm {
    /// Whether this arm completes clearly fewer missions than another one: its interval ends below the other's.
    fn is_clearly_below(&self, other: &Self) -> bool {
        other.complete.share().is_some_and(|share| self.complete.high < share)
    }
}

/// The faults of a planner at one point of the grid.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Faults {
    /// Planner and values.
    pub arm: String,
    /// Number of missions with faults.
    pub missions: u64,
    /// Number of faults in these missions.
    pub count: u64,
    /// The command that repeats the first of these missions.
    pub command: String,
}

/// A mission to inspect.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Worst {
    /// How the mission ended, the first metric, and the reason, as text.
    pub what: String,
    /// The command that repeats the mission.
    pub command: String,
}

/// The columns needed for the findings.
struct Columns {
    cases: Vec<u64>,
    status: Vec<Option<String>>,
    success: Vec<bool>,
    is_complete: Vec<bool>,
    faults: Vec<Option<f64>>,
    metrics: Vec<Vec<Option<f64>>>,
}

impl Findings {
    /// Whether each arm may be ranked by its metrics. An arm that completes clearly fewer missions than another arm is
    /// not ranked: a planner that gives up early would look fast, because only the few missions that it completes
    /// count.
    pub fn ranked(&self) -> Vec<bool> {
        let is_ranked =
            |arm: &Arm| arm.complete.hits > 0 && !self.arms.iter().any(|other| arm.is_clearly_below(other));
        self.arms.iter().map(is_ranked).collect()
    }
}

impl Columns {
    fn of(table: &Table, metrics: &[String]) -> Self {
        Self {
            cases: table.numbers("case").iter().map(|case| case.unwrap_or(0.0) as u64).collect(),
            status: table.words("status"),
            success: table.flags("success"),
            is_complete: table
                .words("outcome")
                .iter()
                .map(|word| word.as_deref() == Some(COMPLETE))
                .collect(),
            faults: table.numbers("planner_faults"),
            metrics: metrics.iter().map(|metric| table.numbers(metric)).collect(),
        }
    }

    fn faults(&self, row: usize) -> u64 {
        self.faults.get(row).copied().flatten().unwrap_or(0.0) as u64
    }

    fn is_flown(&self, row: usize) -> bool {
        self.status[row].as_deref() == Some("flown")
    }

    /// A figure of a mission that ran; index 0 is success, the metrics follow.
    fn value(&self, metric: usize, row: usize) -> Option<f64> {
        match metric.checked_sub(1) {
            None => Some(f64::from(u8::from(self.success[row]))),
            Some(metric) => self.metrics[metric].get(row).copied().flatten(),
        }
    }
}

/// Computes the findings from the table of a campaign.
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
        with_faults: (0..table.len()).filter(|row| columns.faults(*row) > 0).count() as u64,
        faults: faults(campaign, &columns, &of_arm),
        metrics: campaign.design.metrics.clone(),
        arms: (0..campaign.arms()).map(arm).collect(),
        worst: worst(campaign, table, &columns),
    }
}

/// The arms whose planners had faults, those with the most affected missions first.
fn faults(campaign: &Campaign, columns: &Columns, of_arm: &[Vec<usize>]) -> Vec<Faults> {
    let of = |(at, rows): (usize, &Vec<usize>)| {
        let faulty: Vec<usize> = rows.iter().copied().filter(|row| columns.faults(*row) > 0).collect();
        Some(Faults {
            arm: campaign.arm_name(at),
            missions: faulty.len() as u64,
            count: faulty.iter().map(|row| columns.faults(*row)).sum(),
            command: campaign.command(&campaign.case(columns.cases[*faulty.first()?])),
        })
    };
    let mut all: Vec<Faults> = of_arm.iter().enumerate().filter_map(of).collect();
    all.sort_by_key(|faults| std::cmp::Reverse(faults.missions));
    all
}

/// The rows of an arm, by scenario and seed.
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
            let counts =
                |row: usize| if metric == 0 { columns.is_flown(row) } else { columns.is_complete[row] };
            let both = counts(*row) && counts(other);
            both.then(|| Some(columns.value(metric, *row)? - columns.value(metric, other)?)).flatten()
        });
        mean(off)
    };
    let metrics = 1..=campaign.design.metrics.len();
    let (complete, incomplete): (Vec<usize>, Vec<usize>) =
        flown.iter().copied().partition(|row| columns.is_complete[*row]);
    let means = |rows: &[usize]| {
        let of = |metric| mean(rows.iter().filter_map(|row| columns.value(metric, *row)));
        metrics.clone().map(of).collect()
    };
    let mut sorted: Vec<f64> = complete.iter().filter_map(|row| columns.value(1, *row)).collect();
    sorted.sort_by(f64::total_cmp);
    Arm {
        name: campaign.arm_name(at),
        success: share(columns, &flown),
        complete: Share::of(complete.len() as u64, flown.len() as u64),
        means: means(&complete),
        means_of_incomplete: means(&incomplete),
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

/// The worst missions, in this order: missions that failed, ran without success, were refused, or succeeded despite
/// planner faults. Each of these groups is sorted by the first metric. If several missions of one arm ended in the same
/// way, only one of them is listed.
fn worst(campaign: &Campaign, table: &Table, columns: &Columns) -> Vec<Worst> {
    let Some(metric) = campaign.design.metrics.first() else { return Vec::new() };
    let sign = if more_is_better(metric) { 1.0 } else { -1.0 };
    let rank = |row: usize| match columns.status[row].as_deref() {
        Some("failed") => Some(0),
        Some("flown") if !columns.success[row] => Some(1),
        Some("refused") => Some(2),
        _ => (columns.faults(row) > 0).then_some(3),
    };
    let figure = |row: usize| columns.value(1, row).map_or(f64::INFINITY, |value| sign * value);
    let mut rows: Vec<(i32, usize)> = (0..table.len()).filter_map(|row| Some((rank(row)?, row))).collect();
    rows.sort_by(|a, b| a.0.cmp(&b.0).then(figure(a.1).total_cmp(&figure(b.1))));
    let texts = Texts::of(table);
    let mut alike: Vec<(usize, String, usize, u64)> = Vec::new();
    for (_, row) in rows {
        let (arm, (head, why)) = (campaign.arm(columns.cases[row]), texts.of_row(row, columns));
        let how = format!("{head}: {}", kind(&why));
        match alike.iter_mut().find(|(other, known, ..)| *other == arm && *known == how) {
            Some((.., n)) => *n += 1,
            None => alike.push((arm, how, row, 1)),
        }
    }
    let named = |(_, _, row, n): (usize, String, usize, u64)| {
        let (head, why) = texts.of_row(row, columns);
        let figure = columns.value(1, row).map(|value| format!(", {metric} {value:.2}")).unwrap_or_default();
        let why = if why.is_empty() { why } else { format!(": {why}") };
        let more = if n > 1 { format!(" ({} more like it)", n - 1) } else { String::new() };
        Worst {
            what: format!("{head}{figure}{why}{more}"),
            command: campaign.command(&campaign.case(columns.cases[row])),
        }
    };
    alike.into_iter().take(WORST).map(named).collect()
}

/// A reason with its numbers removed: they differ even between missions that ended in the same way.
fn kind(why: &str) -> String {
    why.chars().filter(|letter| !letter.is_ascii_digit() && *letter != '.' && *letter != '-').collect()
}

/// The columns that tell how missions ended.
struct Texts {
    error: Vec<Option<String>>,
    reason: Vec<Option<String>>,
    violations: Vec<Option<String>>,
    outcome: Vec<Option<String>>,
}

impl Texts {
    fn of(table: &Table) -> Self {
        let [error, reason, violations, outcome] =
            ["error", "reason", "violations", "outcome"].map(|name| table.words(name));
        Self { error, reason, violations, outcome }
    }

    /// How a mission ended, and why.
    fn of_row(&self, row: usize, columns: &Columns) -> (String, String) {
        let text =
            |column: &[Option<String>]| column.get(row).cloned().flatten().filter(|text| !text.is_empty());
        let head = text(&self.outcome).or_else(|| columns.status[row].clone()).unwrap_or_default();
        let faults = columns.faults(row);
        let faulty = || {
            (columns.success[row] && faults > 0).then(|| match faults {
                1 => "1 planner fault".to_owned(),
                _ => format!("{faults} planner faults"),
            })
        };
        let why = text(&self.error).or_else(|| text(&self.violations)).or_else(faulty);
        (head, why.or_else(|| text(&self.reason)).unwrap_or_default())
    }
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
    use account::Summary;
    use mission::Outcome;

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
        let complete: Vec<u64> = of_first.iter().copied().filter(|n| n * 7919 % 101 >= 20).collect();
        assert_eq!(findings.arms.len(), 4);
        assert_eq!(findings.arms[0].name, "p k=0.5");
        assert_eq!(findings.arms[0].success.n, of_first.len() as u64);
        let mean =
            complete.iter().map(|n| 100.0 + (n * 7919 % 101) as f64).sum::<f64>() / complete.len() as f64;
        assert_eq!(
            (findings.arms[0].complete.hits, findings.arms[0].complete.n),
            (complete.len() as u64, of_first.len() as u64)
        );
        let ours = findings.arms[0].means[0].expect("a mean").mean;
        assert!((ours - mean).abs() < 1e-9);
        assert_eq!(findings.arms[0].scenarios.len(), 2);
        assert!(findings.arms[0].differences.is_empty() && findings.arms[1].differences.len() == 3);
        assert!(findings.worst[0].what.starts_with("stuck, mission_time_s 1"), "{:?}", findings.worst[0]);
        assert!(findings.worst[0].command.starts_with("tankops run "));
    }

    /// A campaign in which the second planner gives up at once in all missions except one, and the third planner has
    /// faults.
    fn with_one_that_aborts() -> Findings {
        let campaign = campaign(
            "scenarios = [\"a.toml\"]\nplanners = [\"p\", \"q\", \"r\"]\n\
             metrics = [\"mission_time_s\", \"path_length_m\"]\nseeds = { first = 1, count = 20 }\n",
        );
        let row = |case: u64| {
            let (planner, seed) = (case % 3, case / 3);
            let is_complete = planner != 1 || seed == 0;
            let summary = Summary {
                outcome: Some(if is_complete { Outcome::Complete } else { Outcome::Aborted }),
                reason: (!is_complete).then(|| format!("no plan after {seed}.5 s")),
                mission_time_s: Some(if planner == 1 { 0.1 } else { 100.0 + seed as f64 }),
                path_length_m: Some(if planner == 1 { 0.0 } else { 30.0 }),
                planner_faults: u64::from(planner == 2 && seed < 2),
                ..Summary::default()
            };
            Row::flown(case, summary)
        };
        let rows: Vec<Row> = (0..campaign.cases()).map(row).collect();
        let bytes = part::write(&campaign, 0, &rows).expect("written");
        let table = part::read(&campaign, 0, file(&bytes)).expect("read");
        findings(&campaign, &table)
    }

    #[test]
    fn a_planner_that_gives_up_is_not_the_fastest() {
        let findings = with_one_that_aborts();
        let [first, quick, faulty] = &findings.arms[..] else { panic!("{findings:?}") };
        assert_eq!(findings.ranked(), [true, false, true]);
        assert_eq!((quick.complete.hits, quick.complete.n), (1, 20));
        assert_eq!(quick.means[0].expect("one is complete").n, 1);
        assert_eq!(quick.means_of_incomplete[0].expect("the others").n, 19);
        assert_eq!(first.means_of_incomplete, [None, None]);
        assert_eq!(quick.differences[1].expect("one pair").n, 1, "over what both completed");
        assert!((quick.differences[0].expect("all pairs").mean + 0.95).abs() < 1e-9);
        assert_eq!(faulty.complete.hits, 20);
    }

    #[test]
    fn faults_name_their_planner_and_what_is_right_is_not_looked_at() {
        let findings = with_one_that_aborts();
        assert_eq!(findings.with_faults, 2);
        let [faults] = &findings.faults[..] else { panic!("{:?}", findings.faults) };
        assert_eq!((&*faults.arm, faults.missions, faults.count), ("r", 2, 2));
        assert!(faults.command.contains("--planner r"), "{}", faults.command);
        let worst: Vec<&str> = findings.worst.iter().map(|worst| worst.what.as_str()).collect();
        assert_eq!(worst.len(), 2, "{worst:?}");
        assert!(worst[0].starts_with("aborted, mission_time_s 0.10: no plan after"), "{worst:?}");
        assert!(worst[0].ends_with(" (18 more like it)"), "{worst:?}");
        assert!(
            worst[1].starts_with("complete, mission_time_s") && worst[1].contains("1 planner fault"),
            "{worst:?}"
        );
    }
}
