//! Rows of one method on one group of layouts.

use super::{CLEARANCE_M, method::Pairing, plans::Measured, printed::Printed};
use crate::{row::Row, sample::Sample};

/// Rounding of clearances, metres.
const ROUNDING_M: f64 = 1e-6;

/// Where rows belong.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place<'a> {
    /// Name of the study.
    pub table: &'a str,
    /// Id of the case.
    pub case: &'a str,
    /// Id of the method.
    pub method: &'a str,
    /// What a reader must know of the method.
    pub note: &'a str,
}

/// What counts as success.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Success {
    /// The paper's: arrives, not trapped, lag of a coil at most; collisions do not count.
    Walk,
    /// Ours: arrives, keeps the clearance and the wall.
    Safe,
}

impl Success {
    fn is_ok(self, plan: &Measured) -> bool {
        match self {
            Self::Walk => plan.has_path() && plan.verdict.is_ok(),
            Self::Safe => plan.has_path() && plan.says_complete && plan.safety.is_ok(CLEARANCE_M),
        }
    }
}

impl Place<'_> {
    /// A row of so many layouts.
    pub(super) fn row(&self, metric: &str, ours: Option<f64>, unit: &str, n: usize) -> Row {
        Row::new(self.table, self.case, self.method, metric, ours, unit).of(n).note(self.note)
    }

    /// All rows of some plans.
    pub(super) fn rows(
        &self,
        plans: &[Measured],
        success: Success,
        printed: Option<Printed>,
        pairing: Pairing,
    ) -> Vec<Row> {
        let mut rows = self.outcome(plans, success);
        rows.extend(self.tracking(plans, printed, pairing));
        rows.extend(self.safety(plans));
        let times: Sample = plans.iter().map(|plan| plan.plan_time_ms).collect();
        rows.extend(self.mean_and_median("plan_time_ms", &times, "ms", None));
        rows
    }

    /// How many arrive, and what happens to the others.
    fn outcome(&self, plans: &[Measured], success: Success) -> Vec<Row> {
        let n = plans.len();
        let count = |is: &dyn Fn(&Measured) -> bool| plans.iter().filter(|plan| is(plan)).count() as f64;
        let n_without = n - count(&Measured::has_path) as usize;
        let refused = plans.iter().filter(|plan| !plan.says_complete && is_blocked(plan)).count() as f64;
        let proved = count(&|plan| is_blocked(plan) && is_proved(plan));
        let note = match n_without {
            0 => self.note.to_owned(),
            _ => {
                join(self.note, &format!("{n_without} of {n} layouts give no path, as the start is blocked"))
            }
        };
        let proved_rate = (refused > 0.0).then(|| proved / refused);
        vec![
            self.row("ok_rate", Some(count(&|plan| success.is_ok(plan)) / n as f64), "", n).note(note),
            self.row("blocked_proved_rate", proved_rate, "", refused as usize),
            self.row(
                "collisions",
                Some(count(&|p| p.has_path() && p.safety.clearance_m < CLEARANCE_M - ROUNDING_M)),
                "layouts",
                n,
            )
            .note(join(
                self.note,
                "layouts that come nearer than 0.3 m to an obstacle point; the paper counts none",
            )),
            self.row(
                "wall_exits",
                Some(count(&|p| p.has_path() && p.safety.wall_m < -ROUNDING_M)),
                "layouts",
                n,
            ),
        ]
    }

    fn tracking(&self, plans: &[Measured], printed: Option<Printed>, pairing: Pairing) -> Vec<Row> {
        let of = |figure: fn(&Measured) -> f64| with_path(plans).map(figure).collect::<Sample>();
        let mut rows = Vec::new();
        let mut add =
            |metric, figure, unit, paper| rows.extend(self.mean_and_median(metric, &of(figure), unit, paper));
        match pairing {
            Pairing::Index => {
                add("precision", |p| p.score.precision, "", printed.map(|p| p.precision));
                add("recall", |p| p.score.recall, "", printed.map(|p| p.recall));
                add("rmse", |p| p.score.rmse_m, "m", printed.map(|p| p.rmse_m));
            }
            Pairing::Forward => {
                add("precision", |p| p.score.cross_track_precision, "", None);
                add("recall", |p| p.score.covered, "", None);
                add("rmse", |p| p.score.cross_track_rmse_m, "m", None);
            }
        }
        add("cross_track_precision", |p| p.score.cross_track_precision, "", printed.map(|p| p.precision));
        add("cross_track_rmse", |p| p.score.cross_track_rmse_m, "m", printed.map(|p| p.rmse_m));
        add("coverage", |p| p.score.covered, "", None);
        add("floor_rmse", |p| p.floor_m, "m", None);
        rows
    }

    fn safety(&self, plans: &[Measured]) -> Vec<Row> {
        let clearances: Sample = with_path(plans).map(|plan| plan.safety.clearance_m).collect();
        let turns: Sample = with_path(plans).map(|plan| plan.safety.heading_step_rad.to_degrees()).collect();
        let n = clearances.len();
        vec![
            self.row("min_clearance", clearances.mean(), "m", n),
            self.row("min_clearance_least", clearances.min(), "m", n),
            self.row("max_heading_step_deg", turns.mean(), "deg", turns.len()),
            self.row("max_heading_step_deg_worst", turns.max(), "deg", turns.len()),
        ]
    }

    /// The mean, with the printed value beside it, and the median.
    pub(super) fn mean_and_median(
        &self,
        metric: &str,
        sample: &Sample,
        unit: &str,
        printed: Option<f64>,
    ) -> [Row; 2] {
        let n = sample.len();
        [
            self.row(metric, sample.mean(), unit, n).printed(printed),
            self.row(&format!("{metric}_median"), sample.median(), unit, n).printed(printed),
        ]
    }
}

/// The plans that have a path.
pub(super) fn with_path(plans: &[Measured]) -> impl Iterator<Item = &Measured> {
    plans.iter().filter(|plan| plan.has_path())
}

/// Two notes as one.
pub(super) fn join(a: &str, b: &str) -> String {
    if a.is_empty() || b.is_empty() { format!("{a}{b}") } else { format!("{a}; {b}") }
}

fn is_blocked(plan: &Measured) -> bool {
    plan.reason.as_ref().is_some_and(|reason| reason.contains("blocked"))
}

fn is_proved(plan: &Measured) -> bool {
    plan.reason.as_ref().is_some_and(|reason| reason.contains("proved:"))
}
