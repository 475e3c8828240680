//! The studies.

use super::{
    figures::{Success, join, rows, with_path},
    fit::{self, Planned},
    group::Group,
    method::{self, Entry, Pairing, Set},
    plans::{Measured, Run, plan_all},
    printed,
    readings::{self, Reading},
};
use crate::study::{Block, Job, Result, Row, Sample};
use trials::{Sampling, precision_recall};
use world::spiral::Spiral;

/// A search compares every reading with the table on this many layouts of each distribution, starting at this seed.
const LAYOUTS_OF_A_SEARCH: u64 = 20;
const FIRST_OF_A_SEARCH: u64 = 7_000_000;

/// Table 1: the methods as in the text, and in every reading that was selected with this table.
pub(super) fn table1(job: &Job<'_>) -> Result<Vec<Row>> {
    let readings = readings::named();
    let entries = method::of_table1().into_iter().chain(readings.iter().flat_map(Reading::entries));
    let runs = asked(job, entries.collect())?;
    let mut all = Vec::new();
    // One set after the other: holding all plans at the same time would take a gigabyte.
    for runs in runs.chunk_by(|a, b| a.set == b.set) {
        let plans = plan_all(job.runner, &job.seeds(), runs)?;
        for (run, plans) in runs.iter().zip(&plans) {
            let rows = rows(&run.block(job), run, plans, Success::Walk);
            all.extend(rows.into_iter().map(|row| with_printed_time(row, &run.method.id)));
            all.extend(agreement(&run.block(job), run, plans));
        }
        all.extend(of_set(job, Planned { runs, plans: &plans }));
    }
    Ok(all)
}

/// The share of single layouts that agree with a printed row.
fn agreement(block: &Block<'_>, run: &Run, plans: &[Measured]) -> Option<Row> {
    let share = fit::share_of_layouts(plans, run.printed?);
    let row = block.row("layouts_within_5_percent", share, "", plans.len());
    Some(row.note(
        "share of single layouts with all three figures within 5 % of the printed ones; the paper shows \
         only one layout",
    ))
}

/// Distance to the table, and the claims.
fn of_set(job: &Job<'_>, planned: Planned<'_>) -> Vec<Row> {
    let Some(run) = planned.runs.first() else { return Vec::new() };
    match &run.set {
        Set::Reading(name) => {
            let pair = readings::pair(name);
            let rows = fit::rows(job, planned, &pair, "square");
            rows.into_iter().chain(fit::claims(job, planned, &pair, "square")).collect()
        }
        Set::Text => {
            let [gated, literal] = method::pairs();
            let claims = ["disk", "square"].map(|sampling| fit::claims(job, planned, &gated, sampling));
            let fits = [gated, literal].map(|pair| fit::rows(job, planned, &pair, "square"));
            claims.into_iter().chain(fits).flatten().collect()
        }
    }
}

fn with_printed_time(row: Row, method: &str) -> Row {
    let paper = printed::PLAN_TIME_MS.iter().find(|(id, _)| *id == method);
    match paper.filter(|_| row.metric == "plan_time_ms") {
        Some((_, ms)) => {
            let note = join(&row.note, "printed value: MATLAB on an i7-9750H");
            row.printed(*ms).note(note)
        }
        None => row,
    }
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
                precision[0].note =
                    join(run.method.note, "printed value: implied by differences in the text");
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
                runs.push(Run { case, method, group, printed, pairing: Pairing::Index, set: Set::Text });
            }
        }
    }
    runs
}

fn note_of_table2(is_printed: bool) -> &'static str {
    if is_printed {
        "the caption says RPF, but the point counts are those of RPF with improved repulsion"
    } else {
        "planning failed in the paper, but equal gains of 200 succeed in its Table 1, which is impossible \
         if only the direction of the force matters"
    }
}

/// Readings generated from seeds, each compared with Table 1; a layout of this study is a reading.
pub(super) fn search(job: &Job<'_>) -> Result<Vec<Row>> {
    let groups: Vec<Group> = Group::all().filter(|group| group.sampling == Sampling::Square).collect();
    let seeds: Vec<u64> = (0..LAYOUTS_OF_A_SEARCH).map(|k| FIRST_OF_A_SEARCH + k).collect();
    let mut all = Vec::new();
    for seed in job.seeds() {
        let reading = Reading::drawn(seed);
        let entries = reading.entries();
        let runs: Vec<Run> =
            entries.iter().flat_map(|entry| groups.iter().map(|group| Run::new(entry, *group))).collect();
        let plans = plan_all(job.runner, &seeds, &runs)?;
        let pair = fit::Pair { note: reading.words(), ..readings::pair(&reading.name) };
        let planned = Planned { runs: &runs, plans: &plans };
        all.extend(fit::rows(job, planned, &pair, "square"));
        // The result of a random reading says nothing about the paper's claim.
        let reductions = fit::claims(job, planned, &pair, "square").into_iter();
        all.extend(reductions.map(|row| Row { is_claim: false, ..row }));
    }
    Ok(all)
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

/// The ratio of the mean error to the least error that any path with the clearance can have.
fn over_floor(block: &Block<'_>, plans: &[Measured], pairing: Pairing) -> Row {
    let error: fn(&Measured) -> f64 = match pairing {
        Pairing::Index | Pairing::Ahead => |plan| plan.score.rmse_m,
        Pairing::Forward => |plan| plan.score.cross_track_rmse_m,
    };
    let ratio = mean(plans, error).zip(mean(plans, |p| p.floor_m)).map(|(ours, floor)| ours / floor);
    block.row("rmse_over_floor", ratio, "", with_path(plans).count())
}

/// The cost of the turn limit, as a share of the error without it, on the layouts where both find a path.
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

/// Every requested method on every requested group.
fn asked(job: &Job<'_>, entries: Vec<Entry>) -> Result<Vec<Run>> {
    let groups = job.cases(Group::all(), |group| group.id())?;
    let entries = job.methods(entries, |entry| entry.method.id.clone())?;
    let is_meant =
        |entry: &Entry, group: &Group| entry.set == Set::Text || group.sampling == Sampling::Square;
    let of_entry = |entry: &Entry| {
        groups
            .iter()
            .filter(|group| is_meant(entry, group))
            .map(|group| Run::new(entry, *group))
            .collect::<Vec<_>>()
    };
    Ok(entries.iter().flat_map(of_entry).collect())
}
