//! Every method on every kind of trap.

use super::{
    flight,
    measured::{Attempt, Measured, TOLERANCE_M},
    rows::rows,
};
use crate::study::{Job, Method, Planners, Result, Row, Runner, StudyError};
use mission::During;
use planner_api::{Plan, Task};
use trials::{
    discs,
    traps::{HULL_M, Kind, SIDE_M, Trap},
};
use world::{Boundary, Pose};

/// Range within which the discs of an unknown map are discovered, metres.
const RANGE_M: f64 = 6.0;

const UNKNOWN: &str = "unknown map: discs within 6 m are discovered, even those behind others; the robot follows \
                       the planner's commands at 1 m/s";

/// A planner, and whether it knows the map.
struct Entry {
    method: Method,
    is_map_known: bool,
}

fn entries() -> impl Iterator<Item = Entry> {
    let known = |planner: &str| Method::new(planner, planner, "");
    let unknown = |planner: &str| Method::new(format!("{planner}/unknown"), planner, UNKNOWN);
    let mode = |mode: &str| Method::new(format!("bvo-apf/{mode}"), "bvo-apf", "").word("mode", mode);
    let mut on_known = vec![known("shortest"), known("navfn").int("cells", 240)];
    on_known.extend(["apf", "tapf", "apf-virtual-goals", "apf-dwa"].map(known));
    on_known.extend(["literal", "hull", "rollout", "pre"].map(mode));
    let on_unknown = [unknown("shortest"), unknown("navfn").int("cells", 200)];
    let on_known = on_known.into_iter().map(|method| Entry { method, is_map_known: true });
    on_known.chain(on_unknown.map(|method| Entry { method, is_map_known: false }))
}

/// Every kind of trap, and all kinds together.
fn cases() -> impl Iterator<Item = (&'static str, Vec<Kind>)> {
    Kind::ALL.map(|kind| (kind.id(), vec![kind])).into_iter().chain([("all", Kind::ALL.to_vec())])
}

/// The rows of the suite.
pub(super) fn run(job: &Job<'_>) -> Result<Vec<Row>> {
    let entries = job.methods(entries(), |entry| entry.method.id.clone())?;
    let cases = job.cases(cases(), |case| case.0.into())?;
    let is_needed = |kind: &Kind| cases.iter().any(|(_, kinds)| kinds.contains(kind));
    let kinds: Vec<Kind> = Kind::ALL.into_iter().filter(is_needed).collect();
    let runs: Vec<(&Entry, Kind)> =
        entries.iter().flat_map(|entry| kinds.iter().map(move |kind| (entry, *kind))).collect();
    let measured = job.runner.grid(&runs, &job.seeds(), |planners, (entry, kind), seed| {
        let method = &entry.method;
        measure(job.runner, planners, entry, (*kind, *seed))
            .map_err(|error| error.in_case(format!("{} seed {seed}, {}", kind.id(), method.id)))
    })?;
    let mut all = Vec::new();
    for Entry { method, .. } in &entries {
        for (case, kinds) in &cases {
            let is_meant =
                |(entry, kind): &(&Entry, Kind)| entry.method.id == method.id && kinds.contains(kind);
            let of_case = runs.iter().zip(&measured).filter(|(run, _)| is_meant(run));
            let of_case: Vec<&Option<Measured>> = of_case.flat_map(|(_, measured)| measured).collect();
            let block = job.block(case, &method.id, method.note);
            all.extend(rows(&block, &of_case));
        }
    }
    Ok(all)
}

/// Asks a method to leave a trap; `None` if the planner is not installed.
fn measure(
    runner: &Runner<'_>,
    planners: &Planners,
    entry: &Entry,
    (kind, seed): (Kind, u64),
) -> Result<Option<Measured>> {
    let trap = Trap::random(kind, seed);
    let attempt = if entry.is_map_known {
        plan(planners, &entry.method, &trap)
    } else {
        flight::fly(planners, &entry.method, &trap, RANGE_M)
    };
    match attempt {
        Err(StudyError::Planner { fault, .. }) if fault.during == During::Load => Ok(None),
        attempt => {
            let attempt = attempt?;
            if let Some(gallery) = runner.gallery() {
                let world = discs::world(Boundary::Polygon { vertices: Trap::corners() }, &trap.discs);
                let plan = Plan { path: attempt.path.clone(), ..Plan::default() };
                gallery.add_path((kind.id(), seed, &entry.method.id), &world, HULL_M, None, &plan);
            }
            attempt.measured(&trap, seed).map(Some)
        }
    }
}

fn plan(planners: &Planners, method: &Method, trap: &Trap) -> Result<Attempt> {
    let (corners, obstacles) = (Trap::corners(), trap.obstacles(false));
    let site = Trap::site(&corners, &obstacles, SIDE_M);
    let start = Pose { position: trap.start, heading_rad: 0.0 };
    let task = Task::Goto { goal: trap.goal, tolerance_m: TOLERANCE_M };
    let planned = planners.plan(method, start, task, &site)?;
    Ok(Attempt { plan_times_ms: vec![planned.plan_time_ms], path: planned.plan.path })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_planner_has_a_method_of_its_own() {
        let ids: Vec<String> = entries().map(|entry| entry.method.id).collect();
        let known = "shortest navfn apf tapf apf-virtual-goals apf-dwa bvo-apf/literal bvo-apf/hull \
                     bvo-apf/rollout \
                     bvo-apf/pre shortest/unknown navfn/unknown";
        assert_eq!(ids.join(" "), known);
    }
}
