//! The studies.

use super::{
    Group,
    figures::{Place, Success, join, with_path},
    method::{self, Method, Pairing},
    plans::{Measured, Run, plan_all},
    printed,
};
use crate::{
    bench::Bench,
    row::Row,
    sample::Sample,
    study::{Options, Problem, Study},
};
use trials::precision_recall;

/// Table 1.
pub(super) fn table1(study: &Study, bench: &Bench<'_>, options: &Options) -> Result<Vec<Row>, Problem> {
    let methods = method::of_table1();
    let runs = asked(study, options, &methods)?;
    let plans = plan_all(bench, options, &runs, study.layouts)?;
    let mut rows = Vec::new();
    for (run, plans) in runs.iter().zip(&plans) {
        let (case, column) = (run.group.id(), run.group.column());
        let place = Place { table: study.name, case: &case, method: &run.method.id, note: run.method.note };
        let of_run = place.rows(plans, Success::Walk, run.method.printed[column], run.method.pairing);
        rows.extend(of_run.into_iter().map(|row| with_printed_time(row, &run.method.id)));
    }
    rows.extend(claims(study, &runs, &plans));
    Ok(rows)
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
fn claims(study: &Study, runs: &[Run], plans: &[Vec<Measured>]) -> Vec<Row> {
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
            let error = |id: &str| mean_error(runs, plans, sampling, id);
            let (Some(new), Some(old)) = (error(ours), error(theirs)) else { continue };
            let (case, method) = (format!("mean/{sampling}"), format!("{ours} against {theirs}"));
            let place = Place { table: study.name, case: &case, method: &method, note };
            rows.push(place.row("rmse_reduction", Some(1.0 - new / old), "", plans[0].len()).printed(paper));
        }
    }
    rows
}

/// Mean over the three distributions of a method's mean error; none unless all three were run.
fn mean_error(runs: &[Run], plans: &[Vec<Measured>], sampling: &str, method: &str) -> Option<f64> {
    let is_meant = |run: &Run| run.method.id == method && run.group.id().ends_with(sampling);
    let means: Vec<f64> = runs
        .iter()
        .zip(plans)
        .filter(|(run, _)| is_meant(run))
        .filter_map(|(_, plans)| with_path(plans).map(|plan| plan.score.rmse_m).collect::<Sample>().mean())
        .collect();
    (means.len() == 3).then(|| means.iter().sum::<f64>() / 3.0)
}

/// Fig. 8.
pub(super) fn fig8(study: &Study, bench: &Bench<'_>, options: &Options) -> Result<Vec<Row>, Problem> {
    let methods = method::of_table1();
    let runs = asked(study, options, &methods)?;
    let plans = plan_all(bench, options, &runs, study.layouts)?;
    let preset = world::spiral::Spiral::WANG_2023.points();
    let mut rows = Vec::new();
    for (run, plans) in runs.iter().zip(&plans) {
        for t0_m in printed::FIG8_T0_M {
            let case = format!("{}/t0-{t0_m}", run.group.id());
            let place =
                Place { table: study.name, case: &case, method: &run.method.id, note: run.method.note };
            let pairs: Vec<(f64, f64)> =
                with_path(plans).map(|plan| precision_recall(&plan.path, &preset, t0_m.max(1e-9))).collect();
            let implied = printed::FIG8_IMPLIED.iter().find(|(id, _)| *id == run.method.id);
            let implied = implied.filter(|_| t0_m == 0.0 && run.group.column() == 0);
            let mut precision: Vec<Row> =
                place.mean_and_median("precision", &pairs.iter().map(|p| p.0).collect(), "", None).into();
            if let Some((_, value)) = implied {
                precision = precision.into_iter().map(|row| row.printed(*value)).collect();
                precision[0].note = join(run.method.note, "printed: implied by the text's differences");
            }
            rows.extend(precision);
            rows.extend(place.mean_and_median("recall", &pairs.iter().map(|p| p.1).collect(), "", None));
        }
    }
    Ok(rows)
}

/// Table 2.
pub(super) fn table2(study: &Study, bench: &Bench<'_>, options: &Options) -> Result<Vec<Row>, Problem> {
    let mut runs = Vec::new();
    let mut cells = Vec::new();
    for group in Group::all().filter(|group| group.column() == 0) {
        for (i, rho_0_m) in printed::TABLE2_RHO_0_M.into_iter().enumerate() {
            for (j, k_att) in printed::TABLE2_K_ATT.into_iter().enumerate() {
                let case = format!("{}/rho0-{rho_0_m}/katt-{k_att}", group.id());
                if options.has_case(&case) {
                    runs.push(Run { rho_0_m: Some(rho_0_m), ..Run::new(&method::of_table2(k_att), group) });
                    cells.push((case, printed::TABLE2[i][j]));
                }
            }
        }
    }
    some(&runs, study)?;
    let plans = plan_all(bench, options, &runs, study.layouts)?;
    let mut rows = Vec::new();
    for ((run, plans), (case, cell)) in runs.iter().zip(&plans).zip(&cells) {
        let note = match cell {
            None => {
                "planning failed in the paper; equal gains of 200 succeed in its Table 1, impossible where only \
                     the direction of the force counts"
            }
            Some(_) => "the caption says RPF, the counts of points say RPF with improved repulsion",
        };
        let place = Place { table: study.name, case, method: &run.method.id, note };
        rows.extend(place.rows(plans, Success::Walk, *cell, run.method.pairing));
    }
    Ok(rows)
}

/// Our own planners.
pub(super) fn followers(study: &Study, bench: &Bench<'_>, options: &Options) -> Result<Vec<Row>, Problem> {
    let methods = method::followers();
    let runs: Vec<Run> = asked(study, options, &methods)?;
    let plans = plan_all(bench, options, &runs, study.layouts)?;
    let of_turn_free = |run: &Run| {
        let id = format!("{}/turn-free", run.method.id);
        let at = runs.iter().position(|other| other.group == run.group && other.method.id == id)?;
        Some(&plans[at])
    };
    let mut rows = Vec::new();
    for (run, plans) in runs.iter().zip(&plans) {
        let case = run.group.id();
        let place = Place { table: study.name, case: &case, method: &run.method.id, note: run.method.note };
        rows.extend(place.rows(plans, Success::Safe, None, run.method.pairing));
        rows.push(over_floor(&place, plans, run.method.pairing));
        rows.extend(of_turn_free(run).map(|free| cost_of_the_limit(&place, plans, free)));
    }
    Ok(rows)
}

/// How much larger the mean error is than the least that any path with the clearance can have.
fn over_floor(place: &Place<'_>, plans: &[Measured], pairing: Pairing) -> Row {
    let error: fn(&Measured) -> f64 = match pairing {
        Pairing::Index => |plan| plan.score.rmse_m,
        Pairing::Forward => |plan| plan.score.cross_track_rmse_m,
    };
    let mean = |figure: fn(&Measured) -> f64| with_path(plans).map(figure).collect::<Sample>().mean();
    let ratio = mean(error).zip(mean(|p| p.floor_m)).map(|(ours, floor)| ours / floor);
    place.row("rmse_over_floor", ratio, "", with_path(plans).count())
}

/// What the turn limit costs, as a share of the error without it, on the layouts where both find a path.
fn cost_of_the_limit(place: &Place<'_>, limited: &[Measured], free: &[Measured]) -> Row {
    let pairs: Vec<(f64, f64)> = limited
        .iter()
        .zip(free)
        .filter(|(a, b)| a.has_path() && b.has_path())
        .map(|(a, b)| (a.score.rmse_m, b.score.rmse_m))
        .collect();
    let sum = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>();
    let cost = (!pairs.is_empty()).then(|| sum(|p| p.0) / sum(|p| p.1) - 1.0);
    place.row("turn_limit_rmse_cost", cost, "", pairs.len())
}

/// Every method on every group that is asked for.
fn asked(study: &Study, options: &Options, methods: &[Method]) -> Result<Vec<Run>, Problem> {
    let groups: Vec<Group> = Group::all().filter(|group| options.has_case(&group.id())).collect();
    let methods = methods.iter().filter(|method| options.has_method(&method.id));
    let runs: Vec<Run> =
        methods.flat_map(|method| groups.iter().map(|group| Run::new(method, *group))).collect();
    some(&runs, study)?;
    Ok(runs)
}

fn some(runs: &[Run], study: &Study) -> Result<(), Problem> {
    if runs.is_empty() {
        return Err(Problem::Nothing(format!(
            "{}: no case and method begin with the given --case and --method; without these options all are run",
            study.name
        )));
    }
    Ok(())
}
