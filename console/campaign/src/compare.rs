//! Compares two tables mission by mission, or the planners of one table.

use crate::{
    findings::COMPLETE,
    statistics::{Mean, mean},
    table::{Table, more_is_better},
    text,
};
use serde::Serialize;
use std::{collections::BTreeMap, fmt};

/// A comparison of one metric in two tables, paired by mission.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// The column, or `success`.
    pub metric: String,
    /// One entry for each group.
    pub groups: Vec<Group>,
    /// Number of missions that count in only one of the tables. For success, missions that ran count; for other metrics,
    /// complete ones.
    pub unpaired: u64,
}

/// Paired missions of one group.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Group {
    /// The common value of the group; `all` without groups.
    pub name: String,
    /// Mean in the first table.
    pub first: Mean,
    /// Mean in the second table.
    pub second: Mean,
    /// Second table minus first table.
    pub difference: Mean,
    /// The verdict on the difference.
    pub verdict: Verdict,
}

/// The verdict on a difference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The whole interval of the difference is on the good side of zero.
    Better,
    /// The whole interval is on the bad side of zero.
    Worse,
    /// All differences are zero.
    Equal,
    /// The interval contains zero, or there are too few missions.
    Undecided,
}

impl Verdict {
    fn of(difference: &Mean, more_is_better: bool) -> Self {
        let Some(half) = difference.half else { return Self::Undecided };
        let sign = if more_is_better { 1.0 } else { -1.0 };
        if difference.mean == 0.0 && half == 0.0 {
            Self::Equal
        } else if difference.mean.abs() <= half {
            Self::Undecided
        } else if sign * difference.mean > 0.0 {
            Self::Better
        } else {
            Self::Worse
        }
    }

    fn word(self) -> &'static str {
        match self {
            Self::Better => "better",
            Self::Worse => "worse",
            Self::Equal => "equal",
            Self::Undecided => "undecided",
        }
    }
}

/// Compares a metric in two tables. Success is compared over the missions that ran in both tables, other metrics over
/// those that were completed in both. `by` is the column that defines the groups.
///
/// # Errors
/// At least one of the tables has no such column.
pub fn compare(first: &Table, second: &Table, metric: &str, by: Option<&str>) -> Result<Comparison, String> {
    let is_missing = |name: &&str| !(first.has(name) && second.has(name));
    if let Some(name) = [Some(metric), by].into_iter().flatten().find(is_missing) {
        let known = crate::table::metrics().collect::<Vec<_>>().join(", ");
        return Err(format!(
            "at least one of the tables has no column `{name}`; known metrics: success, {known}"
        ));
    }
    let of = |table: &Table| missions(table, metric, by);
    let (one, mut other) = (of(first), of(second));
    let mut pairs: BTreeMap<String, Vec<(f64, f64)>> = BTreeMap::new();
    let mut unpaired = 0;
    for (key, (group, value)) in one {
        match other.remove(&key) {
            Some((_, with)) => pairs.entry(group).or_default().push((value, with)),
            None => unpaired += 1,
        }
    }
    let more = metric == "success" || more_is_better(metric);
    let group = |(name, pairs): (String, Vec<(f64, f64)>)| {
        let difference = mean(pairs.iter().map(|(a, b)| b - a))?;
        let (first, second) =
            (mean(pairs.iter().map(|pair| pair.0))?, mean(pairs.iter().map(|pair| pair.1))?);
        Some(Group { name, first, second, difference, verdict: Verdict::of(&difference, more) })
    };
    let groups = pairs.into_iter().filter_map(group).collect();
    Ok(Comparison { metric: metric.to_owned(), groups, unpaired: unpaired + other.len() as u64 })
}

/// The missions that count, each with its group and value. Their key is the columns in which two compared missions agree.
fn missions(table: &Table, metric: &str, by: Option<&str>) -> BTreeMap<Vec<String>, (String, f64)> {
    let names = ["scenario", "planner", "seed"].map(str::to_owned).into_iter().chain(table.keys());
    let keys: Vec<_> = names.map(|name| table.words(&name)).collect();
    let groups = by.map(|by| table.words(by));
    let (status, success) = (table.words("status"), table.flags("success"));
    let numbers = if metric == "success" {
        success.into_iter().map(|success| Some(f64::from(u8::from(success)))).collect()
    } else {
        table.numbers(metric)
    };
    let outcome = table.words("outcome");
    // The cost of an incomplete mission says nothing about the cost of the task.
    let counts = |row: &usize| match metric {
        "success" => status[*row].as_deref() == Some("flown"),
        _ => outcome.get(*row).is_some_and(|word| word.as_deref() == Some(COMPLETE)),
    };
    (0..table.len())
        .filter(counts)
        .filter_map(|row| {
            let word = |column: &Vec<Option<String>>| column[row].clone().unwrap_or_default();
            let group = groups.as_ref().map_or_else(|| "all".to_owned(), word);
            Some((keys.iter().map(word).collect(), (group, numbers[row]?)))
        })
        .collect()
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let head = ["", "pairs", "first", "second", "difference", ""].map(str::to_owned).to_vec();
        let row = |group: &Group| {
            vec![
                group.name.clone(),
                group.difference.n.to_string(),
                text::interval(Some(&group.first)),
                text::interval(Some(&group.second)),
                text::interval(Some(&group.difference)),
                group.verdict.word().to_owned(),
            ]
        };
        writeln!(
            f,
            "{}, second minus first, in pairs with the same scenario, planner, values and seed (± half of the \
             95 % interval)",
            self.metric
        )?;
        f.write_str(&text::columns(
            &std::iter::once(head).chain(self.groups.iter().map(row)).collect::<Vec<_>>(),
        ))?;
        if self.unpaired > 0 {
            let what = if self.metric == "success" { "ran" } else { "are complete" };
            writeln!(f, "  missions that {what} in only one of the tables: {}", self.unpaired)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        frozen::tests::campaign,
        part,
        row::Row,
        table::tests::{PLAN, file, row},
    };

    fn table(plan: &str) -> Table {
        let campaign = campaign(&format!("block = 160\n{plan}"));
        let rows: Vec<Row> = (0..campaign.cases()).map(row).collect();
        part::read(&campaign, 0, file(&part::write(&campaign, 0, &rows).expect("written"))).expect("read")
    }

    #[test]
    fn a_table_is_equal_to_itself_and_pairs_by_mission_not_by_place() {
        let (all, fewer) = (table(PLAN), table(&PLAN.replace("count = 20", "count = 15")));
        let same = compare(&all, &all, "mission_time_s", Some("planner")).expect("a column");
        assert!(same.groups.iter().all(|group| group.verdict == Verdict::Equal) && same.groups.len() == 2);
        let part = compare(&all, &fewer, "success", None).expect("a column");
        assert_eq!(part.groups[0].verdict, Verdict::Equal);
        assert!(part.unpaired > 30, "{part:?}");
        assert!(compare(&all, &all, "nope", None).expect_err("no column").contains("mission_time_s"));
    }

    #[test]
    fn a_verdict_needs_an_interval_without_zero() {
        let of = |mean, half| Verdict::of(&Mean { n: 9, mean, half }, false);
        assert_eq!(of(-2.0, Some(1.0)), Verdict::Better);
        assert_eq!(of(2.0, Some(1.0)), Verdict::Worse);
        assert_eq!(of(2.0, Some(3.0)), Verdict::Undecided);
        assert_eq!(of(2.0, None), Verdict::Undecided);
    }
}
