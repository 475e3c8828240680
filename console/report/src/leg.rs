//! The stretches of a plan.

use planner_api::Plan;
use serde::Serialize;

/// Some points of the path that serve one purpose: index of the first and of the last.
#[derive(Debug, Serialize)]
pub struct Leg {
    /// What the stretch is for.
    pub tag: &'static str,
    /// Index of its first point.
    pub first: usize,
    /// Index of its last point.
    pub last: usize,
}

/// The legs as reported by the planner; a plan without legs has a single one.
pub fn legs(plan: &Plan) -> Vec<Leg> {
    let reported = plan.legs.iter().map(|leg| Leg { tag: leg.tag.word(), first: leg.first, last: leg.last });
    match plan.path.len() {
        0 => vec![],
        n if plan.legs.is_empty() => vec![Leg { tag: "path", first: 0, last: n - 1 }],
        _ => reported.collect(),
    }
}
