//! The result of several runs on one floor: a scan and the re-scans of what it missed.

use crate::{
    account::{Account, account},
    fold::Fold,
    human::floor_lines,
    summary::{Coverage, Logs, Summary},
};
use serde::Serialize;
use std::fmt::Write;

/// What several runs scanned together. Every run keeps its own recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Merged {
    /// The runs, in the order given.
    pub runs: Vec<MergedRun>,
    /// What was scanned by all of them.
    pub coverage: Coverage,
    /// The account of the floor over all of them.
    pub floor: Account,
}

/// One of several runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MergedRun {
    /// Name of its folder.
    pub run: String,
    /// Its own figures, without the account of the floor.
    pub summary: Summary,
}

/// Takes several runs together: their names, their files and what is known of each.
///
/// # Errors
/// No run, a mission that scans no floor, or floors with other cells.
pub fn merged(runs: &[(String, Logs, Fold)]) -> Result<Merged, String> {
    let scans = |name: &str, fold: &Fold| {
        let parts = fold.scanned.clone().zip(fold.evidence.clone());
        parts.ok_or_else(|| format!("run {name} did not scan a floor: its mission leads to a point"))
    };
    let ((_, _, last), before) = runs.split_last().ok_or("there is no run to report")?;
    let opened = last.run.as_ref();
    let (mut scanned, mut evidence) = scans(&runs[runs.len() - 1].0, last)?;
    for (name, _, fold) in before {
        let (other, others) = scans(name, fold)?;
        if !scanned.believed().floor().is_aligned_with(other.believed().floor()) {
            return Err(format!(
                "run {name} and run {} have no floor in common: tank and cell_m must be the same",
                runs[runs.len() - 1].0
            ));
        }
        scanned.join(&other);
        evidence.join(&others);
    }
    let opened = opened.ok_or("the journal does not begin with the opening of a run")?;
    let told = runs.iter().map(|(name, logs, fold)| MergedRun {
        run: name.clone(),
        summary: Summary { floor: None, logs: Some(logs.clone()), ..fold.summary() },
    });
    Ok(Merged {
        runs: told.collect(),
        coverage: scanned.coverage(),
        floor: account(opened, scanned.believed(), &evidence),
    })
}

impl Merged {
    /// The result as text for people.
    pub fn human(&self) -> String {
        let mut text = String::from("result of several runs on one floor\n\n");
        let mut line = |label: &str, what: String| {
            writeln!(text, "{label:<15}{what}").expect("writing to a string");
        };
        for run in &self.runs {
            let word = run.summary.outcome.map_or("cut off", mission::Outcome::word);
            let share = run.summary.coverage.as_ref().map_or(0.0, |coverage| 100.0 * coverage.reachable);
            line("run", format!("{}: {word}, {share:.1} % of the reachable floor by itself", run.run));
            let recording = run.summary.logs.as_ref().and_then(|logs| logs.recording.clone());
            line("", format!("recording {}", recording.unwrap_or_else(|| "none".into())));
        }
        if let Some(truth) = self.coverage.by_truth {
            let (reachable, whole) = (100.0 * truth.reachable, 100.0 * truth.whole);
            line(
                "by true position",
                format!(" {reachable:.1} % of the reachable floor, {whole:.1} % of the whole floor"),
            );
        }
        let mut before = "";
        for (label, what) in floor_lines(&self.floor) {
            line(if label == before { "" } else { label }, what);
            before = label;
        }
        text
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use crate::fold::tests::round_tank;
    use mission::{Event, EventKind};
    use world::CellRun;

    fn run(name: &str, cell_m: f64, first: u32, count: u32) -> (String, Logs, Fold) {
        let mut fold = Fold::new();
        let kinds = [
            EventKind::RunOpened(Box::new(round_tank(cell_m))),
            EventKind::Covered { runs: vec![CellRun(first, count)] },
        ];
        for kind in kinds {
            fold.apply(&Event { tick: 0, t_s: 0.0, kind });
        }
        let recording = Some(format!("logs/{name}/recording.rrd"));
        (name.into(), Logs { journal: None, recording, error: None }, fold)
    }

    #[test]
    fn two_halves_make_a_whole_and_both_recordings_are_kept() {
        let half = 100 * 50;
        let (south, north) = (run("a", 0.1, 0, half), run("b", 0.1, half, half));
        let alone = merged(std::slice::from_ref(&south)).unwrap();
        let both = merged(&[south, north]).unwrap();
        assert!((alone.floor.reachable.scanned - 0.5).abs() < 0.01, "{:?}", alone.floor.reachable);
        assert!((both.floor.reachable.scanned - 1.0).abs() < 1e-12 && both.floor.missed.is_empty());
        let text = both.human();
        assert!(text.contains("logs/a/recording.rrd") && text.contains("logs/b/recording.rrd"), "{text}");
    }

    #[test]
    fn runs_of_different_floors_are_not_taken_together() {
        let refused = merged(&[run("a", 0.1, 0, 1), run("b", 0.2, 0, 1)]).unwrap_err();
        assert!(refused.contains("run a and run b have no floor in common"), "{refused}");
    }

    #[test]
    fn what_was_missed_comes_back_as_boxes() {
        let (_, _, fold) = run("a", 0.1, 0, 100 * 50);
        let boxes = fold.missed_boxes(1000).unwrap();
        let area_m2: f64 = boxes.iter().map(|[low, high]| (high.x - low.x) * (high.y - low.y)).sum();
        let floor = fold.summary().floor.unwrap();
        assert!((area_m2 - floor.reachable.missed * floor.reachable.area_m2).abs() < 1.0, "{area_m2}");
        assert!(fold.missed_boxes(20).unwrap().len() <= 20);
    }
}
