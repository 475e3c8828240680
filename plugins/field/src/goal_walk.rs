//! Walks towards one goal, step by step; a callback chooses each step.

use crate::{
    oscillation::Oscillation,
    outcome::{Shortfall, Walk},
};
use geometry::{Point, Vector};

/// The start, the goal and the limits of a walk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trip {
    /// The start.
    pub start: Point,
    /// The goal.
    pub goal: Point,
    /// The goal is reached when the robot is within this distance of it, metres.
    pub tolerance_m: f64,
    /// Maximum number of steps.
    pub steps_max: usize,
}

/// Walks until the goal is reached or `next` returns no more steps. `check` can end the walk early.
///
/// The walk ends as soon as it is within `tolerance_m` of the goal; the mission covers the remaining distance.
///
/// # Errors
/// The error that `check` returns.
pub fn walk<E>(
    trip: &Trip,
    mut next: impl FnMut(Point) -> Option<Vector>,
    mut check: impl FnMut() -> Result<(), E>,
) -> Result<Walk, E> {
    let mut at = trip.start;
    let mut path = vec![at];
    for step in 0..trip.steps_max {
        if (trip.goal - at).norm() <= trip.tolerance_m {
            return Ok(Walk { path, shortfall: None });
        }
        if step % 64 == 0 {
            check()?;
        }
        let Some(way) = next(at) else {
            return Ok(Walk { path, shortfall: Some(Shortfall::Trapped { at }) });
        };
        at += way;
        path.push(at);
    }
    let missing_m = (trip.goal - at).norm();
    let shortfall = (missing_m > trip.tolerance_m).then_some(Shortfall::Short { missing_m, at });
    Ok(Walk { path, shortfall })
}

/// Returns a function that takes steps of equal length along a force, until the steps make almost no headway.
pub fn descent<'a>(
    trip: &Trip,
    step_m: f64,
    window_m: f64,
    mut force: impl FnMut(Point) -> Vector + 'a,
) -> impl FnMut(Point) -> Option<Vector> + 'a {
    let goal = trip.goal;
    let mut oscillation = Oscillation::new(window_m, step_m);
    move |at| {
        let missing_m = (goal - at).norm();
        if oscillation.record(at, missing_m) {
            return None;
        }
        Some(force(at).try_normalize(1e-12)? * step_m.min(missing_m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIP: Trip =
        Trip { start: Point::new(0.0, 0.0), goal: Point::new(1.0, 0.0), tolerance_m: 0.01, steps_max: 100 };

    fn walked(force: impl FnMut(Point) -> Vector) -> Walk {
        walk::<()>(&TRIP, descent(&TRIP, 0.1, 0.5, force), || Ok(())).expect("no stop is requested")
    }

    #[test]
    fn a_pull_leads_to_the_goal() {
        let walk = walked(|at| TRIP.goal - at);
        assert!(walk.shortfall.is_none());
        assert_eq!(walk.path.len(), 11);
    }

    #[test]
    fn a_minimum_on_the_way_is_a_trap() {
        let walk = walked(|at| Point::new(0.55, 0.0) - at);
        assert!(matches!(walk.shortfall, Some(Shortfall::Trapped { at }) if (at.x - 0.55).abs() < 0.1));
    }

    #[test]
    fn a_way_that_never_ends_is_cut_off() {
        let walk = walked(|_| -Vector::x());
        assert!(matches!(walk.shortfall, Some(Shortfall::Short { .. })));
    }
}
