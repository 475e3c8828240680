//! Coverage planners and the tether: tanks of the make of the study behind them, and random ones.
//!
//! Pan 2025 prints no figures of its own; nothing is beside ours. Figures are those of `trials::tanks`: a flat bar
//! across the heading, cells of 0.05 m, swath 0.6 m, hull and clearance 0.3 m together, the return included.

use crate::{
    bench::Bench,
    planners::Planners,
    row::Row,
    sample::Sample,
    study::{Options, Problem, Study},
};
use mission::{ParamValue, Parameters};
use nalgebra::Matrix3;
use planner_api::{PlanRequest, PoseEstimate, Reason, Task};
use trials::tanks::{CELL_M, Known, Scan, Tank};

/// Cells of large tanks are coarser, so that the count takes no longer than the plan, metres.
const COARSE_CELL_M: f64 = 0.1;
/// Radius from which a tank counts as large, metres.
const LARGE_M: f64 = 20.0;
/// Distance from the anchor at which the robot is back, metres.
const TOLERANCE_M: f64 = 0.3;

/// The studies.
pub const STUDIES: &[Study] = &[
    Study {
        name: "pan-maps",
        about: "after Pan 2025: round tanks with 14 and 28 columns and a square with 18, every coverage planner",
        layouts: 10,
        run: pan_maps,
    },
    Study {
        name: "coverage-suite",
        about: "random tanks of radius 5 to 50 m with 0 to 120 columns, every coverage planner and its tether",
        layouts: 20,
        run: suite,
    },
];

/// A planner with its parameters, and the metric ids' method.
struct Method {
    id: &'static str,
    planner: &'static str,
    parameters: &'static [(&'static str, Setting)],
}

/// A value of a parameter.
#[derive(Clone, Copy)]
enum Setting {
    Number(f64),
    Word(&'static str),
}

const METHODS: &[Method] = &[
    Method { id: "boustrophedon", planner: "boustrophedon", parameters: &[] },
    Method {
        id: "hull-partition/direct",
        planner: "hull-partition",
        parameters: &[("backtracking", Setting::Word("direct"))],
    },
    Method {
        id: "hull-partition/tree",
        planner: "hull-partition",
        parameters: &[("backtracking", Setting::Word("tree"))],
    },
    Method { id: "tether-safe", planner: "tether-safe", parameters: &[] },
    Method {
        id: "tether-safe/alpha-0",
        planner: "tether-safe",
        parameters: &[("alpha_deg", Setting::Number(0.0))],
    },
    Method {
        id: "tether-safe/fewest-turns",
        planner: "tether-safe",
        parameters: &[("choose", Setting::Word("fewest-turns"))],
    },
];

fn pan_maps(study: &Study, bench: &Bench<'_>, options: &Options) -> Result<Vec<Row>, Problem> {
    let mut rows = Vec::new();
    for known in Known::ALL.into_iter().filter(|known| options.has_case(known.id())) {
        let tanks: Vec<(u64, Tank)> =
            options.seeds(study.layouts).map(|seed| (seed, known.tank(seed))).collect();
        rows.extend(measured(study, bench, options, known.id(), &tanks)?);
    }
    some(rows, study)
}

fn suite(study: &Study, bench: &Bench<'_>, options: &Options) -> Result<Vec<Row>, Problem> {
    let tanks: Vec<(u64, Tank)> =
        options.seeds(study.layouts).map(|seed| (seed, Tank::random(seed))).collect();
    let rows = if options.has_case("random") {
        measured(study, bench, options, "random", &tanks)?
    } else {
        Vec::new()
    };
    some(rows, study)
}

fn some(rows: Vec<Row>, study: &Study) -> Result<Vec<Row>, Problem> {
    if rows.is_empty() {
        let methods = METHODS.iter().map(|method| method.id).collect::<Vec<_>>().join(", ");
        return Err(Problem::Nothing(format!(
            "{}: no case or method is left; methods are {methods}",
            study.name
        )));
    }
    Ok(rows)
}

/// What one planner made of one tank.
struct Measured {
    scan: Option<Scan>,
    plan_time_ms: f64,
}

fn measured(
    study: &Study,
    bench: &Bench<'_>,
    options: &Options,
    case: &str,
    tanks: &[(u64, Tank)],
) -> Result<Vec<Row>, Problem> {
    let mut rows = Vec::new();
    for method in METHODS.iter().filter(|method| options.has_method(method.id)) {
        let of_method = bench.map(tanks, |planners, (seed, tank)| {
            plan(planners, method, tank).map_err(|problem| match problem {
                Problem::Planner { fault, .. } => {
                    Problem::Planner { case: format!("{case} seed {seed}, {}", method.id), fault }
                }
                nothing @ Problem::Nothing(_) => nothing,
            })
        })?;
        rows.extend(rows_of(study.name, case, method.id, &of_method));
    }
    Ok(rows)
}

fn plan(planners: &Planners, method: &Method, tank: &Tank) -> Result<Measured, Problem> {
    let obstacles = tank.obstacles();
    let site = tank.site(&obstacles);
    let value = |setting: Setting| match setting {
        Setting::Number(number) => ParamValue::Float(number),
        Setting::Word(word) => ParamValue::Word(word.to_owned()),
    };
    let parameters: Parameters =
        method.parameters.iter().map(|(key, setting)| ((*key).to_owned(), value(*setting))).collect();
    let start = PoseEstimate { position: tank.anchor, heading_rad: 0.0, covariance: Matrix3::zeros() };
    let task = Task::Cover { anchor: tank.anchor, regions: &[], tether: None, tolerance_m: TOLERANCE_M };
    let request = PlanRequest { reason: &Reason::Start, start, task, site: &site, previous: &[] };
    let planned = planners.plan(method.planner, &parameters, &request)?;
    let (low, high) = tank.boundary.bounds();
    let cell_m = if high.x - low.x > 2.0 * LARGE_M { COARSE_CELL_M } else { CELL_M };
    let has_path = planned.plan.path.len() > 1;
    let scan = if has_path { tank.score(&planned.plan.path, &planned.plan.cuts, cell_m).ok() } else { None };
    Ok(Measured { scan, plan_time_ms: planned.plan_time_ms })
}

fn rows_of(table: &str, case: &str, method: &str, all: &[Measured]) -> Vec<Row> {
    let n = all.len();
    let sample = |figure: &dyn Fn(&Scan) -> f64| {
        all.iter().filter_map(|m| m.scan.as_ref()).map(figure).collect::<Sample>()
    };
    let row =
        |metric: &str, ours: Option<f64>, unit: &str| Row::new(table, case, method, metric, ours, unit).of(n);
    let worst_of = |metric: &str, sample: &Sample, unit: &str| {
        row(metric, sample.mean(), unit)
            .note(sample.max().map_or_else(String::new, |worst| format!("worst {worst:.3}")))
    };
    let coverage = sample(&|s| s.coverage_reachable);
    let least = coverage.min().map_or_else(String::new, |least| format!("worst {least:.4}"));
    let cable = sample(&|s| s.certificate.max_cable_m / s.certificate.eccentricity_m.max(1e-9));
    let certified = all.iter().filter(|m| m.scan.as_ref().is_some_and(|s| s.certificate.certified)).count();
    let times: Sample = all.iter().map(|m| m.plan_time_ms).collect();
    vec![
        row("coverage_reachable", coverage.mean(), "").note(least),
        row("coverage_whole", sample(&|s| s.coverage_whole).mean(), ""),
        worst_of("length_over_lower_bound", &sample(&|s| s.length_over_lower_bound), ""),
        row("length_m", sample(&|s| s.length_m).mean(), "m"),
        row("turns", sample(&|s| s.turns as f64).mean(), ""),
        worst_of("rotation_turns", &sample(&|s| s.rotation_turns), ""),
        worst_of("max_cable_over_eccentricity", &cable, ""),
        worst_of("max_wrap_deg", &sample(&|s| s.certificate.max_wrap_rad.to_degrees()), "deg"),
        worst_of("sum_wrap_deg", &sample(&|s| s.certificate.max_sum_wrap_rad.to_degrees()), "deg"),
        worst_of("left_out_m", &sample(&|s| s.certificate.left_out_m.unwrap_or(0.0)), "m"),
        row("collisions", sample(&|s| s.certificate.collisions as f64).mean(), ""),
        row("certified_rate", Some(certified as f64 / n.max(1) as f64), ""),
        worst_of("plan_time_ms", &times, "ms"),
        row("plan_time_ms_median", times.median(), "ms"),
    ]
}
