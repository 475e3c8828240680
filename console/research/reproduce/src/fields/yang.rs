//! Yang et al. 2021, Tables 3 and 4: the field with virtual goals.

use super::layout::{GotoLayout, Measured};
use crate::study::{Block, Job, Method, Result, Row};
use world::Point;

/// Distance within which the last step of a walk ends on the goal, metres.
const TOLERANCE_M: f64 = 1e-6;
/// Number of iterations in the paper.
const STEPS: i64 = 200;

const TRADITIONAL_ID: &str = "apf-virtual-goals/traditional";
const IMPROVED_ID: &str = "apf-virtual-goals";

const TRADITIONAL: &str = "linear pull, no virtual goals; steps proportional to the force up to 0.1 m: the \
                           printed lengths of failed runs fit neither this nor fixed steps, which always \
                           give 20 m";
const IMPROVED: &str = "gains and ranges of the paper's Table 2. Interpreted as follows: eq. 15 repels (as \
                        printed, it attracts), eq. 17c with the constant pull k d_0 (its potential has no \
                        slope), eq. 18 with the second vector reversed (as printed, the blocked direction \
                        scores best), \"F = 0\" as a force below k_att / 2 or six steps without progress";
const TUNED: &str = "layout not printed: start, goal and obstacles tuned to the printed length";
const DERIVED: &str = "layout not printed: any free path from (0, 0) to (10, 10) gives this length";

/// A case and its printed values.
struct Case {
    layout: GotoLayout,
    note: &'static str,
    /// Distance of the virtual goals from the goal, metres: not printed.
    square_m: f64,
    /// Length (metres) and time (seconds) of the traditional and of the improved field; whether the traditional field
    /// arrives.
    traditional: (f64, f64, bool),
    improved: (f64, f64),
}

fn layout(id: &'static str, goal: (f64, f64), points: &[(f64, f64)]) -> GotoLayout {
    GotoLayout {
        id,
        start: Point::origin(),
        goal: Point::new(goal.0, goal.1),
        discs: points.iter().map(|(x, y)| (Point::new(*x, *y), 0.0)).collect(),
        hull_m: 0.0,
        tolerance_m: TOLERANCE_M,
    }
}

fn cases_of_table3() -> Vec<Case> {
    vec![
        Case {
            layout: layout("case1", (10.0, 10.0), &[(3.0, 5.0), (6.0, 3.0), (8.0, 6.0)]),
            note: DERIVED,
            square_m: 2.0,
            traditional: (14.1421, 0.8230, true),
            improved: (14.1421, 0.7910),
        },
        Case {
            layout: layout("case2", (6.904, 6.904), &[(7.3, 7.3), (3.0, 4.5)]),
            note: TUNED,
            square_m: 2.0,
            traditional: (11.0143, 0.7760, false),
            improved: (9.7637, 0.6930),
        },
        Case {
            layout: layout("case3", (6.2973, 6.2973), &[(6.69, 6.69)]),
            note: TUNED,
            square_m: 2.0,
            traditional: (17.8513, 0.7990, false),
            improved: (8.9057, 0.5430),
        },
    ]
}

fn cases_of_table4() -> Vec<Case> {
    vec![
        Case {
            layout: layout("case4", (3.55, 0.0), &[(0.9, 0.0)]),
            note: TUNED,
            square_m: 2.0,
            traditional: (2.6717, 0.7830, false),
            improved: (4.1231, 0.8030),
        },
        Case {
            layout: layout("case5", (3.6, 0.0), &[(0.8, 0.22), (0.8, -0.2)]),
            note: TUNED,
            square_m: 1.0,
            traditional: (1.3853, 0.7770, false),
            improved: (4.4283, 0.7940),
        },
    ]
}

/// The methods, set up for a case.
fn methods(case: &Case) -> [Method; 2] {
    let with = |id: &str, note| {
        Method::new(id, IMPROVED_ID, note)
            .number("square_m", case.square_m)
            .number("wall_gain", 0.0)
            .int("steps_max", STEPS)
    };
    [with(TRADITIONAL_ID, TRADITIONAL).flag("improved", false), with(IMPROVED_ID, IMPROVED)]
}

/// Table 3.
pub(super) fn table3(job: &Job<'_>) -> Result<Vec<Row>> {
    rows(job, cases_of_table3())
}

/// Table 4.
pub(super) fn table4(job: &Job<'_>) -> Result<Vec<Row>> {
    rows(job, cases_of_table4())
}

fn rows(job: &Job<'_>, cases: Vec<Case>) -> Result<Vec<Row>> {
    let cases = job.cases(cases, |case| case.layout.id.into())?;
    let mut runs: Vec<(&Case, Method)> = Vec::new();
    for case in &cases {
        let methods = job.methods(methods(case), |method| method.id.clone())?;
        runs.extend(methods.into_iter().map(|method| (case, method)));
    }
    let measured = job.runner.map(&runs, |planners, (case, method)| {
        let measured = case.layout.measure(planners, method)?;
        case.layout.draw(job.runner, method, &measured);
        Ok(measured)
    })?;
    let of_run = |((case, method), measured): (&(&Case, Method), &Measured)| {
        case.rows(&job.block(case.layout.id, &method.id, method.note), measured)
    };
    Ok(runs.iter().zip(&measured).flat_map(of_run).collect())
}

impl Case {
    fn rows(&self, block: &Block<'_>, measured: &Measured) -> Vec<Row> {
        let (length_m, time_s, arrives) = match block.method {
            IMPROVED_ID => (self.improved.0, self.improved.1, true),
            _ => self.traditional,
        };
        let with_printed = |row: Row| match row.metric.as_str() {
            "length_m" => {
                let row = row.printed(length_m).note(format!("{}. {}", self.note, block.note));
                if self.note == TUNED { row.fitted() } else { row }
            }
            "success_rate" => row.printed(f64::from(u8::from(arrives))),
            "plan_time_ms" => row.printed(1e3 * time_s),
            _ => row,
        };
        let mut rows: Vec<Row> = measured.rows(block).into_iter().map(with_printed).collect();
        let displacement_m = measured.planned.path().last().map(|stop| (stop - self.layout.start).norm());
        rows.push(block.row("displacement_m", displacement_m, "m", 1).note(
            "distance from start to end: 4.1231 and 14.1421 are the square roots of 17 and 200, so the \
             paper may have meant this",
        ));
        rows
    }
}
