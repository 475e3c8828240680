//! Xu et al. 2022.

use super::layout::{GotoLayout, wall_of_discs};
use crate::study::{Job, Method, Result, Row};
use std::f64::consts::FRAC_PI_4;
use world::Point;

/// Radius of the robot in the traps; the paper's is a point, ours cannot pass between touching discs, metres.
const HULL_M: f64 = 0.3;
/// Radius and spacing of the discs that a trap is made of, metres; the paper shows pictures only.
const DISC_M: f64 = 0.7;
const SPACING_M: f64 = 1.2;
/// The goal counts as reached at twice the step of the paper, metres.
const TOLERANCE_M: f64 = 0.02;

const APF: &str = "attraction k rho, repulsion from the outline; ends when the last steps make no progress, the paper's \
                   were stopped by hand";
const ALWAYS: &str = "left tangent force always on at a weight of 0.02: the only reading that gives the printed stop \
                      (fitted to it)";
const BLOCKING: &str =
    "tangent force only round what blocks the path: the other reading; the paper does not decide";
const LITERAL: &str = "with our corrections where the paper's formulas cannot be applied: eq. 14 (cotangent of a cosine) and eq. 17 \
                       (never true) read as an angle at the mouth with room for the seal, eq. 4 near the goal as \
                       log2(1/rho + 1), eq. 10 as vectors, our oscillation rule";
const PRINTED: &str = "eq. 4 near the goal as printed, n |log2(1/(rho + 1))|: the pull vanishes at the goal and the \
                       robot misses it; the paper's text and table fit only log2(1/rho + 1)";
const OURS: &str = "ours: not in the paper";

/// Gains of a table.
#[derive(Debug, Clone, Copy)]
struct Gains {
    k_rep: f64,
    rho_0_m: f64,
    step_m: f64,
}

/// One repulsion gain is fitted to the printed stop of the classical field; the radius of the obstacle is not printed.
const TABLE1: Gains = Gains { k_rep: 39.5, rho_0_m: 5.0, step_m: 0.01 };
const TRAPS: Gains = Gains { k_rep: 10.0, rho_0_m: 2.0, step_m: 0.01 };
/// The step that gives the printed number of steps.
const TABLE2: Gains = Gains { step_m: 0.0071, ..TRAPS };

fn methods(gains: Gains) -> Vec<Method> {
    let with = |method: Method| {
        method
            .number("k_rep", gains.k_rep)
            .number("rho_0_m", gains.rho_0_m)
            .number("goto_step_m", gains.step_m)
            .number("wall_gain", 0.0)
    };
    let bvo = |id: &str, mode: &str, note| with(Method::new(id, "bvo-apf", note)).word("mode", mode);
    vec![
        with(Method::new("apf", "apf", APF)),
        with(Method::new("tapf", "tapf", ALWAYS)).word("tangent", "always").number("tangent_weight", 0.02),
        with(Method::new("tapf/blocking", "tapf", BLOCKING)).word("tangent", "blocking"),
        bvo("bvo-apf/literal", "literal", LITERAL),
        bvo("bvo-apf/printed", "literal", PRINTED).word("near_law", "printed").int("escapes_max", 1),
        bvo("bvo-apf/hull", "hull", OURS),
        bvo("bvo-apf/rollout", "rollout", OURS),
        bvo("bvo-apf/pre", "pre", OURS),
    ]
}

/// A printed line: stop, success, steps.
#[derive(Debug, Clone, Copy)]
struct Printed {
    method: &'static str,
    stop: (f64, f64),
    success: f64,
    steps: Option<f64>,
}

const PRINTED_TABLE1: [Printed; 3] = [
    Printed { method: "apf", stop: (44.3, 55.4), success: 0.0, steps: None },
    Printed { method: "tapf", stop: (44.3, 55.3), success: 0.0, steps: None },
    Printed { method: "bvo-apf/literal", stop: (44.0, 55.0), success: 1.0, steps: None },
];

const PRINTED_TABLE2: [Printed; 3] = [
    Printed { method: "apf", stop: (33.2, 38.5), success: 0.0, steps: Some(61_934.0) },
    Printed { method: "tapf", stop: (33.5, 38.2), success: 0.0, steps: Some(33_119.0) },
    Printed { method: "bvo-apf/literal", stop: (50.0, 55.0), success: 1.0, steps: Some(15_104.0) },
];

/// Time printed in Table 2, milliseconds.
const PRINTED_TIME_MS: f64 = 1170.0;

fn layout(id: &'static str, start: (f64, f64), goal: (f64, f64), discs: Vec<(Point, f64)>) -> GotoLayout {
    let point = |(x, y): (f64, f64)| Point::new(x, y);
    let (start, goal) = (point(start), point(goal));
    GotoLayout { id, start, goal, discs, hull_m: HULL_M, tolerance_m: TOLERANCE_M }
}

/// The only layout that is printed, but for the radius.
fn behind_an_obstacle() -> GotoLayout {
    let discs = vec![(Point::new(42.0, 52.0), 1.0)];
    GotoLayout { hull_m: 0.0, ..layout("table1", (0.0, 0.0), (44.0, 55.0), discs) }
}

fn line() -> GotoLayout {
    layout("line", (1.0, 1.0), (40.0, 40.0), vec![(Point::new(20.0, 20.0), 1.5)])
}

fn triangle() -> GotoLayout {
    let v = [(-4.0, 6.0), (4.0, 0.0), (-4.0, -6.0)];
    let discs = wall_of_discs(&v, Point::new(25.0, 25.0), FRAC_PI_4, DISC_M, SPACING_M);
    layout("triangle", (1.0, 1.0), (45.0, 45.0), discs)
}

fn u() -> GotoLayout {
    let u = [(-4.0, 5.0), (4.0, 5.0), (4.0, -5.0), (-4.0, -5.0)];
    let discs = wall_of_discs(&u, Point::new(25.0, 25.0), FRAC_PI_4, DISC_M, SPACING_M);
    layout("u", (1.0, 1.0), (45.0, 45.0), discs)
}

/// The trap is placed so that the classical field stops near the printed place.
fn holistic() -> GotoLayout {
    let u = [(-3.5, 5.5), (3.5, 5.5), (3.5, -5.5), (-3.5, -5.5)];
    let mut discs = wall_of_discs(&u, Point::new(30.0, 39.0), 0.834, DISC_M, SPACING_M);
    discs.extend([(48.0, 56.5), (52.0, 53.5), (51.5, 57.0)].map(|(x, y)| (Point::new(x, y), 1.0)));
    layout("table2", (1.0, 1.0), (50.0, 55.0), discs)
}

/// Table 1.
pub(super) fn table1(job: &Job<'_>) -> Result<Vec<Row>> {
    rows(job, &[behind_an_obstacle()], TABLE1, &PRINTED_TABLE1)
}

/// Figs 2, 11 and 12.
pub(super) fn traps(job: &Job<'_>) -> Result<Vec<Row>> {
    rows(job, &[line(), triangle(), u()], TRAPS, &[])
}

/// Table 2.
pub(super) fn table2(job: &Job<'_>) -> Result<Vec<Row>> {
    rows(job, &[holistic()], TABLE2, &PRINTED_TABLE2)
}

fn rows(job: &Job<'_>, layouts: &[GotoLayout], gains: Gains, printed: &[Printed]) -> Result<Vec<Row>> {
    let layouts = job.cases(layouts, |layout| layout.id.into())?;
    let methods = job.methods(methods(gains), |method| method.id.clone())?;
    let runs: Vec<(&GotoLayout, &Method)> =
        layouts.iter().flat_map(|layout| methods.iter().map(move |method| (*layout, method))).collect();
    let measured = job.runner.map(&runs, |planners, (layout, method)| layout.measure(planners, method))?;
    let mut rows = Vec::new();
    for ((layout, method), measured) in runs.iter().zip(&measured) {
        let line = printed.iter().find(|line| line.method == method.id);
        let block = job.block(layout.id, &method.id, method.note);
        rows.extend(measured.rows(&block).into_iter().map(|row| with_printed(row, line)));
    }
    Ok(rows)
}

fn with_printed(row: Row, line: Option<&Printed>) -> Row {
    let Some(line) = line else { return row };
    match row.metric.as_str() {
        "stop_x" => row.printed(line.stop.0),
        "stop_y" => row.printed(line.stop.1),
        "success_rate" => row.printed(line.success),
        "steps" => row.printed(line.steps),
        "plan_time_ms" if line.steps.is_some() && line.success > 0.0 => row.printed(PRINTED_TIME_MS),
        _ => row,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_traps_stand_across_the_straight_way_and_start_and_goal_are_free() {
        for layout in [behind_an_obstacle(), line(), triangle(), u(), holistic()] {
            let way = [layout.start, layout.goal];
            let clear_m = |at: Point| trials::discs::distance_m(&layout.discs, at);
            assert!(
                clear_m(layout.start) > 2.0 * HULL_M && clear_m(layout.goal) > 2.0 * HULL_M,
                "{}",
                layout.id
            );
            let blocks = |(at, r): &(Point, f64)| world::polyline::distance_m(&way, *at) < r + HULL_M;
            assert!(layout.discs.iter().any(blocks), "{}", layout.id);
        }
    }

    #[test]
    fn every_printed_line_is_of_a_method() {
        let ids: Vec<String> = methods(TABLE1).into_iter().map(|method| method.id).collect();
        assert!(
            PRINTED_TABLE1.iter().chain(&PRINTED_TABLE2).all(|line| ids.iter().any(|id| id == line.method))
        );
    }
}
