//! The studies.

use super::{
    figures::{Success, join, rows, with_path},
    group::Group,
    method::{self, Entry, Pairing},
    plans::{Measured, Run, plan_all},
    printed,
};
use crate::study::{Block, Job, Result, Row, Sample};
use trials::precision_recall;
use world::spiral::Spiral;

/// Table 1.
pub(super) fn table1(job: &Job<'_>) -> Result<Vec<Row>> {
    let runs = asked(job, method::of_table1())?;
    let plans = plan_all(job.runner, &job.seeds(), &runs)?;
    let mut all = Vec::new();
    for (run, plans) in runs.iter().zip(&plans) {
        let rows = rows(&run.block(job), run, plans, Success::Walk);
        all.extend(rows.into_iter().map(|row| with_printed_time(row, &run.method.id)));
    }
    all.extend(claims(job, &runs, &plans));
    Ok(all)
}

fn with_printed_time(row: Row, method: &str) -> Row {
    let paper = printed::PLAN_TIME_MS.iter().find(|(id, _)| *id == method);
    match paper.filter(|_| row.metric == "plan_time_ms") {
        Some((_, ms)) => {
            let note = join(&row.note, "printed: MATLAB on an i7-9750H");
            row.printed(*ms).note(note)
        }
        None => row,
    }
}

/// What the paper claims over all three distributions.
fn claims(job: &Job<'_>, runs: &[Run], plans: &[Vec<Measured>]) -> Vec<Row> {
    let mut rows = Vec::new();
    for sampling in ["disk", "square"] {
        for (ours, theirs, paper, note) in [
            (
                "rpf/gated",
                "iapf",
                0.0949,
                "the printed errors give 0.0865: 0.0949 divides the difference by the new value",
            ),
            ("rpf/gated+ir", "iapf+ir", 0.0351, "follows from the printed errors"),
        ] {
            let reduction = |without: Option<usize>| {
                let error = |id: &str| mean_error(runs, plans, sampling, id, without);
                Some(1.0 - error(ours)? / error(theirs)?)
            };
            let Some(reduced) = reduction(None) else { continue };
            let (case, method) = (format!("mean/{sampling}"), format!("{ours} against {theirs}"));
            let block = job.block(&case, &method, note);
            let n = plans[0].len();
            let row = block.row("rmse_reduction", reduced, "", n).printed(paper);
            rows.push(row.claimed(jackknife_95(reduced, n, reduction)));
        }
    }
    rows
}

/// 95 % interval of a figure by what it is without each of the layouts.
fn jackknife_95(figure: f64, n: usize, without: impl Fn(Option<usize>) -> Option<f64>) -> Option<[f64; 2]> {
    let others: Vec<f64> = (0..n).filter_map(|index| without(Some(index))).collect();
    let mean = others.iter().copied().collect::<Sample>().mean().filter(|_| n > 1 && others.len() == n)?;
    let squares: f64 = others.iter().map(|other| (other - mean).powi(2)).sum();
    let half = 1.96 * (squares * (n - 1) as f64 / n as f64).sqrt();
    Some([figure - half, figure + half])
}

/// Mean over the three distributions of a method's mean error, perhaps without one of the layouts; none unless all three were
/// run.
fn mean_error(
    runs: &[Run],
    plans: &[Vec<Measured>],
    sampling: &str,
    method: &str,
    without: Option<usize>,
) -> Option<f64> {
    let kept = |plans: &Vec<Measured>| {
        let kept = plans.iter().enumerate().filter(|(index, _)| Some(*index) != without);
        kept.map(|(_, plan)| plan)
            .filter(|plan| plan.has_path())
            .map(|plan| plan.score.rmse_m)
            .collect::<Sample>()
    };
    let is_meant = |run: &Run| run.method.id == method && run.case.ends_with(sampling);
    let means: Vec<f64> = runs
        .iter()
        .zip(plans)
        .filter(|(run, _)| is_meant(run))
        .filter_map(|(_, plans)| kept(plans).mean())
        .collect();
    (means.len() == 3).then(|| means.iter().sum::<f64>() / 3.0)
}

fn mean(plans: &[Measured], figure: fn(&Measured) -> f64) -> Option<f64> {
    with_path(plans).map(figure).collect::<Sample>().mean()
}

/// Fig. 8.
pub(super) fn fig8(job: &Job<'_>) -> Result<Vec<Row>> {
    let runs = asked(job, method::of_table1())?;
    let plans = plan_all(job.runner, &job.seeds(), &runs)?;
    let preset = Spiral::WANG_2023.points();
    let mut rows = Vec::new();
    for (run, plans) in runs.iter().zip(&plans) {
        for t0_m in printed::FIG8_T0_M {
            let case = format!("{}/t0-{t0_m}", run.case);
            let block = Block { case: &case, ..run.block(job) };
            let (precisions, recalls): (Vec<f64>, Vec<f64>) = with_path(plans)
                .map(|plan| precision_recall(plan.planned.path(), &preset, t0_m.max(1e-9)))
                .unzip();
            let mut precision = block.mean_and_median("precision", &precisions.into_iter().collect(), "");
            let implied = printed::FIG8_IMPLIED.iter().find(|(id, _)| *id == run.method.id);
            if let Some((_, value)) = implied.filter(|_| t0_m == 0.0 && run.group.column() == 0) {
                precision = precision.map(|row| row.printed(*value));
                precision[0].note = join(run.method.note, "printed: implied by the text's differences");
            }
            rows.extend(precision);
            rows.extend(block.mean_and_median("recall", &recalls.into_iter().collect(), ""));
        }
    }
    Ok(rows)
}

/// Table 2.
pub(super) fn table2(job: &Job<'_>) -> Result<Vec<Row>> {
    let runs = job.cases(cells_of_table2(), |run| run.case.clone())?;
    let plans = plan_all(job.runner, &job.seeds(), &runs)?;
    let of_run = |(run, plans): (&Run, &Vec<Measured>)| rows(&run.block(job), run, plans, Success::Walk);
    Ok(runs.iter().zip(&plans).flat_map(of_run).collect())
}

fn cells_of_table2() -> Vec<Run> {
    let mut runs = Vec::new();
    for group in Group::all().filter(|group| group.column() == 0) {
        for (i, rho_0_m) in printed::TABLE2_RHO_0_M.into_iter().enumerate() {
            for (j, k_att) in printed::TABLE2_K_ATT.into_iter().enumerate() {
                let case = format!("{}/rho0-{rho_0_m}/katt-{k_att}", group.id());
                let printed = printed::TABLE2[i][j];
                let method = method::of_table2(k_att, rho_0_m, note_of_table2(printed.is_some()));
                runs.push(Run { case, method, group, printed, pairing: Pairing::Index });
            }
        }
    }
    runs
}

fn note_of_table2(is_printed: bool) -> &'static str {
    if is_printed {
        "the caption says RPF, the counts of points say RPF with improved repulsion"
    } else {
        "planning failed in the paper; equal gains of 200 succeed in its Table 1, impossible where only the direction of \
         the force counts"
    }
}

/// Our own planners.
pub(super) fn followers(job: &Job<'_>) -> Result<Vec<Row>> {
    let runs = asked(job, method::followers())?;
    let plans = plan_all(job.runner, &job.seeds(), &runs)?;
    let of_turn_free = |run: &Run| {
        let id = format!("{}/turn-free", run.method.id);
        let at = runs.iter().position(|other| other.group == run.group && other.method.id == id)?;
        Some(&plans[at])
    };
    let mut all = Vec::new();
    for (run, plans) in runs.iter().zip(&plans) {
        let block = run.block(job);
        all.extend(rows(&block, run, plans, Success::Safe));
        all.push(over_floor(&block, plans, run.pairing));
        all.extend(of_turn_free(run).map(|free| cost_of_the_limit(&block, plans, free)));
    }
    Ok(all)
}

/// How much larger the mean error is than the least that any path with the clearance can have.
fn over_floor(block: &Block<'_>, plans: &[Measured], pairing: Pairing) -> Row {
    let error: fn(&Measured) -> f64 = match pairing {
        Pairing::Index => |plan| plan.score.rmse_m,
        Pairing::Forward => |plan| plan.score.cross_track_rmse_m,
    };
    let ratio = mean(plans, error).zip(mean(plans, |p| p.floor_m)).map(|(ours, floor)| ours / floor);
    block.row("rmse_over_floor", ratio, "", with_path(plans).count())
}

/// What the turn limit costs, as a share of the error without it, on the layouts where both find a path.
fn cost_of_the_limit(block: &Block<'_>, limited: &[Measured], free: &[Measured]) -> Row {
    let pairs: Vec<(f64, f64)> = limited
        .iter()
        .zip(free)
        .filter(|(a, b)| a.has_path() && b.has_path())
        .map(|(a, b)| (a.score.rmse_m, b.score.rmse_m))
        .collect();
    let sum = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>();
    let cost = (!pairs.is_empty()).then(|| sum(|p| p.0) / sum(|p| p.1) - 1.0);
    block.row("turn_limit_rmse_cost", cost, "", pairs.len())
}

/// Every method on every group that is asked for.
fn asked(job: &Job<'_>, entries: Vec<Entry>) -> Result<Vec<Run>> {
    let groups = job.cases(Group::all(), |group| group.id())?;
    let entries = job.methods(entries, |entry| entry.method.id.clone())?;
    Ok(entries.iter().flat_map(|entry| groups.iter().map(|group| Run::new(entry, *group))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_a_mean_without_each_value_is_that_of_the_mean() {
        let values = [1.0, 2.0, 4.0, 9.0];
        let mean = |without: Option<usize>| {
            let kept = values.iter().enumerate().filter(|(index, _)| Some(*index) != without);
            kept.map(|(_, value)| *value).collect::<Sample>().mean()
        };
        let margin = values.into_iter().collect::<Sample>().mean_margin_95().expect("four values");
        let [low, high] = jackknife_95(4.0, 4, mean).expect("four values");
        assert!((low - 4.0 + margin).abs() < 1e-9 && (high - 4.0 - margin).abs() < 1e-9, "{low} {high}");
        assert_eq!(jackknife_95(4.0, 1, |_| Some(4.0)), None);
    }
}
