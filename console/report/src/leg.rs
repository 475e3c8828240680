//! The legs of a plan.

use planner_api::Plan;
use serde::Serialize;

/// A stretch of the path with one purpose.
#[derive(Debug, Serialize)]
pub struct Leg {
    /// The purpose of the stretch.
    pub tag: &'static str,
    /// Index of the first point of the stretch.
    pub first: usize,
    /// Index of the last point of the stretch.
    pub last: usize,
}

/// The legs as reported by the planner; a plan without legs becomes a single leg.
pub fn legs(plan: &Plan) -> Vec<Leg> {
    let reported = plan.legs.iter().map(|leg| Leg { tag: leg.tag.word(), first: leg.first, last: leg.last });
    match plan.path.len() {
        0 => vec![],
        n if plan.legs.is_empty() => vec![Leg { tag: "path", first: 0, last: n - 1 }],
        _ => reported.collect(),
    }
}
