//! Findings as text for a terminal.

use crate::{
    findings::{Arm, Findings},
    statistics::{Mean, Share},
};
use comfy_table::{
    CellAlignment::{Left, Right},
    Table, presets,
};
use std::fmt;
use world::coverage::percent_text;

/// Maximum number of arms shown; the HTML page shows all of them.
const MOST_ARMS: usize = 20;
/// Maximum length of an arm's name; longer names are shortened in the middle.
const NAME: usize = 40;
/// Number of characters kept from the beginning of a shortened name; the end of the name contains the values of the grid.
const BEGINNING: usize = 10;

/// A share in per cent, with its interval.
pub(crate) fn share(share: &Share) -> String {
    match share.share() {
        Some(p) => {
            let [p, low, high] = [p, share.low, share.high].map(|share| percent_text(share, 1));
            format!("{p} % ({low} to {high})")
        }
        None => "-".into(),
    }
}

/// A mean with its interval, to four digits.
pub(crate) fn interval(mean: Option<&Mean>) -> String {
    let digits = |mean: &Mean| {
        let size = mean.mean.abs().max(mean.half.unwrap_or(0.0)).max(1e-9).log10().floor() as i32;
        (3 - size).clamp(0, 6) as usize
    };
    match mean {
        None => "-".into(),
        Some(m @ Mean { mean, half: Some(half), .. }) => format!("{mean:.0$} ± {half:.0$}", digits(m)),
        Some(m) => format!("{:.1$}", m.mean, digits(m)),
    }
}

/// A difference of shares, in percentage points.
pub(crate) fn points(mean: Option<&Mean>) -> String {
    mean.map_or_else(
        || "-".into(),
        |m| match m.half {
            Some(half) => format!("{:+.1} ± {:.1} points", 100.0 * m.mean, 100.0 * half),
            None => format!("{:+.1} points", 100.0 * m.mean),
        },
    )
}

/// Aligns rows of cells in columns: text in the first column to the left, text in the other columns to the right.
pub(crate) fn columns(rows: &[Vec<String>]) -> String {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING).add_rows(rows);
    for column in table.column_iter_mut() {
        let is_first = column.index == 0;
        column.set_padding((2, 0)).set_cell_alignment(if is_first { Left } else { Right });
    }
    table.trim_fmt() + "\n"
}

fn short(name: &str) -> String {
    let count = name.chars().count();
    if count <= NAME {
        return name.to_owned();
    }
    let end = name.chars().skip(count - (NAME - 1 - BEGINNING));
    name.chars().take(BEGINNING).chain(['…']).chain(end).collect()
}

impl fmt::Display for Findings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shown = &self.arms[..self.arms.len().min(MOST_ARMS)];
        let table = |head: &[String], cells: &dyn Fn(&Arm) -> Vec<String>, arms: &[Arm]| {
            let head = std::iter::once(String::new()).chain(head.iter().cloned()).collect::<Vec<_>>();
            let row = |arm: &Arm| std::iter::once(short(&arm.name)).chain(cells(arm)).collect();
            let head = (head.len() > 1).then_some(head);
            columns(&head.into_iter().chain(arms.iter().map(row)).collect::<Vec<_>>())
        };
        writeln!(f, "{}: {} of {} missions", self.name, self.rows, self.planned)?;
        for (n, what) in
            [(self.refused, "refused"), (self.failed, "failed"), (self.with_faults, "with planner faults")]
        {
            if n > 0 {
                writeln!(f, "  {n} {what}")?;
            }
        }
        for faults in self.faults.iter().take(MOST_ARMS) {
            writeln!(
                f,
                "    {}: planner faults: {}, in missions: {}",
                short(&faults.arm),
                faults.count,
                faults.missions
            )?;
        }
        writeln!(f, "\nSuccess (complete, every bound met; 95 % interval)")?;
        let cells =
            |arm: &Arm| vec![share(&arm.success), format!("{} of {}", arm.success.hits, arm.success.n)];
        f.write_str(&table(&[], &cells, shown))?;
        writeln!(f, "\nMeans over complete missions (± half of the 95 % interval)")?;
        let intervals =
            |means: &[Option<Mean>]| means.iter().map(|mean| interval(mean.as_ref())).collect::<Vec<_>>();
        let cells = |of: Share, means: &[Option<Mean>]| {
            std::iter::once(format!("{} of {}", of.hits, of.n))
                .chain(intervals(means))
                .collect::<Vec<String>>()
        };
        let head =
            |first: &str| std::iter::once(first.to_owned()).chain(self.metrics.clone()).collect::<Vec<_>>();
        let means = |arm: &Arm| cells(arm.complete, &arm.means);
        f.write_str(&table(&head("complete"), &means, shown))?;
        let gave_up: Vec<Arm> =
            shown.iter().filter(|arm| arm.complete.hits < arm.complete.n).cloned().collect();
        if !gave_up.is_empty() {
            writeln!(f, "\nMeans over incomplete missions (not comparable)")?;
            let means = |arm: &Arm| {
                let Share { hits, n, .. } = arm.complete;
                cells(Share::of(n - hits, n), &arm.means_of_incomplete)
            };
            f.write_str(&table(&head("incomplete"), &means, &gave_up))?;
        }
        if self.arms.len() > 1 {
            writeln!(
                f,
                "\nDifferences from {}, in pairs with the same scenario and seed; success over missions run by both, \
                 other metrics over missions completed by both (± half of the 95 % interval)",
                short(&self.arms[0].name)
            )?;
            let differences = |arm: &Arm| {
                let others = arm.differences[1..].iter().map(|mean| interval(mean.as_ref()));
                std::iter::once(points(arm.differences[0].as_ref())).chain(others).collect()
            };
            let head: Vec<String> =
                std::iter::once("success".to_owned()).chain(self.metrics.clone()).collect();
            f.write_str(&table(&head, &differences, &shown[1..]))?;
        }
        if self.arms.len() > MOST_ARMS {
            writeln!(f, "  ({} more in summary.html and summary.json)", self.arms.len() - MOST_ARMS)?;
        }
        writeln!(f, "\nInspect these first")?;
        if self.worst.is_empty() {
            writeln!(f, "  nothing: every mission succeeded, without planner faults")?;
        }
        for worst in self.worst.iter().take(5) {
            writeln!(f, "  {}\n    {}", worst.what, worst.command)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::tests::example;

    #[test]
    fn findings_are_read_on_a_terminal() {
        insta::assert_snapshot!(example().to_string());
    }

    #[test]
    fn long_names_keep_the_values_in_which_they_differ() {
        let names = [0.25, 0.3].map(|speed| format!("planner of the scenario speed_max_m_per_s={speed}"));
        let [slow, fast] = names.map(|name| short(&name));
        assert_eq!(slow, "planner of…enario speed_max_m_per_s=0.25");
        assert!(fast.ends_with("speed_max_m_per_s=0.3") && fast.chars().count() <= NAME, "{fast}");
    }
}
