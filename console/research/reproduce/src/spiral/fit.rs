//! How far the figures of each reading (interpretation of the text) are from the printed Table 1, and what they mean
//! for the paper's claim.

use super::{
    figures::{join, with_path},
    method::Set,
    plans::{Measured, Run},
    printed::{self, Printed},
};
use crate::study::{Job, Row, Sample, jackknife_95};

/// One figure of a plan.
type Figure = fn(&Measured) -> f64;

/// Difference, as a share of the printed figure, up to which a figure agrees with the printed one.
const NEAR: f64 = 0.05;

const DISTANCE: &str = "mean of |ln(ours / printed)| over the 36 printed cells of IAPF and RPF, without and \
                        with improved repulsion; 0.05 is about 5 % in every cell";
const WITH_VT: &str = "the same over 54 cells, including those of VT, whose source is not available, like \
                       that of IAPF";
const CLAIM: &str =
    "the sign depends on the side of IAPF's push and on the gate, neither of which the paper states";

/// The two methods that the claim compares, in one reading of the text.
#[derive(Debug, Clone)]
pub(super) struct Pair {
    /// Name of the reading.
    pub name: String,
    /// Ids without improved repulsion: VT, IAPF, RPF.
    pub ids: [String; 3],
    /// A note for the reader.
    pub note: String,
}

/// The runs of a study and their plans.
#[derive(Clone, Copy)]
pub(super) struct Planned<'a> {
    /// The runs.
    pub runs: &'a [Run],
    /// The plans of each run.
    pub plans: &'a [Vec<Measured>],
}

/// The rows of a pair: its distance to the table, and the claims. `sampling` names the region in which the obstacles
/// are drawn.
pub(super) fn rows(job: &Job<'_>, planned: Planned<'_>, pair: &Pair, sampling: &str) -> Vec<Row> {
    let case = format!("mean/{sampling}");
    let n = planned.plans.first().map_or(0, Vec::len);
    let mut rows = Vec::new();
    for (metric, ids, note) in
        [("distance_to_table1", &pair.ids[1..], DISTANCE), ("distance_with_vt", &pair.ids[..], WITH_VT)]
    {
        let distance = |without| planned.distance(ids, sampling, without);
        let Some(figure) = distance(None) else { continue };
        let block = job.block(&case, &pair.name, &pair.note);
        let row = block.row(metric, figure, "", n).within(jackknife_95(figure, n, distance));
        rows.push(row.note(join(note, &pair.note)));
    }
    rows
}

/// The claim that RPF reduces the error of IAPF, without and with improved repulsion.
pub(super) fn claims(job: &Job<'_>, planned: Planned<'_>, pair: &Pair, sampling: &str) -> Vec<Row> {
    let mut rows = Vec::new();
    for (suffix, paper, note) in [
        ("", 0.0949, "the printed errors give 0.0865; 0.0949 is the difference divided by the new value"),
        ("+ir", 0.0351, "computed from the printed errors"),
    ] {
        let [_, theirs, ours] = pair.ids.each_ref().map(|id| format!("{id}{suffix}"));
        let reduction = |without: Option<usize>| {
            let error = |id: &str| planned.mean_error(sampling, id, without);
            Some(1.0 - error(&ours)? / error(&theirs)?)
        };
        let Some(reduced) = reduction(None) else { continue };
        let (case, method) = (format!("mean/{sampling}"), format!("{ours} against {theirs}"));
        let note = join(&join(note, CLAIM), &pair.note);
        let block = job.block(&case, &method, &note);
        let n = planned.plans[0].len();
        let row = block.row("rmse_reduction", reduced, "", n).printed(paper);
        let row = row.claimed(jackknife_95(reduced, n, reduction));
        rows.push(if planned.is_selected() { row.fitted() } else { row });
    }
    rows
}

/// The share of single layouts with all three printed figures within 5 %.
pub(super) fn share_of_layouts(plans: &[Measured], printed: Printed) -> Option<f64> {
    let is_near = |ours: f64, printed: f64| (ours - printed).abs() <= NEAR * printed;
    let agrees = |plan: &&Measured| {
        is_near(plan.score.precision, printed.precision)
            && is_near(plan.score.recall, printed.recall)
            && is_near(plan.score.rmse_m, printed.rmse_m)
    };
    let n = with_path(plans).count();
    (n > 0).then(|| with_path(plans).filter(agrees).count() as f64 / n as f64)
}

impl Planned<'_> {
    /// Whether the readings were selected to fit the printed table.
    fn is_selected(&self) -> bool {
        self.runs.iter().any(|run| run.set != Set::Text)
    }

    fn of<'b>(&'b self, sampling: &str, id: &str) -> impl Iterator<Item = (&'b Run, &'b Vec<Measured>)> {
        let is_meant = move |run: &Run| run.method.id == id && run.case.ends_with(sampling);
        let meant: Vec<_> = self.runs.iter().zip(self.plans).filter(|(run, _)| is_meant(run)).collect();
        meant.into_iter()
    }

    /// Mean over the three distributions of a method's mean error, optionally without one layout; `None` unless all
    /// three were run.
    fn mean_error(&self, sampling: &str, id: &str, without: Option<usize>) -> Option<f64> {
        let means: Vec<f64> = self
            .of(sampling, id)
            .filter_map(|(_, plans)| mean(plans, |plan| plan.score.rmse_m, without))
            .collect();
        (means.len() == 3).then(|| means.iter().sum::<f64>() / 3.0)
    }

    /// Mean of `|ln(ours / printed)|` over the cells of the table; `None` unless every cell was run.
    fn distance(&self, ids: &[String], sampling: &str, without: Option<usize>) -> Option<f64> {
        let mut logarithms = Vec::new();
        for (id, suffix) in ids.iter().flat_map(|id| ["", "+ir"].map(|suffix| (id, suffix))) {
            let id = format!("{id}{suffix}");
            let of_method: Vec<_> = self.of(sampling, &id).collect();
            if of_method.len() != 3 {
                return None;
            }
            for (run, plans) in of_method {
                let printed = printed::table1(&id, run.group.column())?;
                let figures: [(Figure, f64); 3] = [
                    (|plan| plan.score.precision, printed.precision),
                    (|plan| plan.score.recall, printed.recall),
                    (|plan| plan.score.rmse_m, printed.rmse_m),
                ];
                for (figure, printed) in figures {
                    logarithms.push((mean(plans, figure, without)? / printed).ln().abs());
                }
            }
        }
        Some(logarithms.iter().sum::<f64>() / logarithms.len() as f64)
    }
}

/// Mean of a figure over the layouts that have a path, optionally without one layout.
fn mean(plans: &[Measured], figure: fn(&Measured) -> f64, without: Option<usize>) -> Option<f64> {
    let kept = plans.iter().enumerate().filter(|(index, plan)| Some(*index) != without && plan.has_path());
    kept.map(|(_, plan)| figure(plan)).collect::<Sample>().mean()
}
