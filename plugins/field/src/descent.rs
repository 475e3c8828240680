//! Follows a law towards one goal, in steps of constant length.

use crate::{
    outcome::{Shortfall, Walk},
    scene::Scene,
    settings::FieldSettings,
    turning::Reading,
    walk::{Move, Walker},
};
use geometry::Point;
use planner_api::{Ctx, Result};

/// Number of moves without coming closer to the goal after which a walk with a rotating force gives up.
const PATIENCE_MOVES: usize = 2000;
/// Maximum number of moves, as a multiple of the number needed for the straight path.
const DETOUR: f64 = 20.0;

/// A goal, and how to walk to it.
#[derive(Debug, Clone, Copy)]
pub struct Descent {
    /// The start.
    pub start: Point,
    /// The goal.
    pub goal: Point,
    /// Length of a move, metres.
    pub step_m: f64,
    /// The goal is reached when the robot is within this distance of it, metres.
    pub tolerance_m: f64,
}

/// Walks until the goal is reached, the law is trapped or the moves are used up.
///
/// # Errors
/// The console requests a stop.
pub fn descend(scene: &Scene, settings: &FieldSettings, trip: &Descent, ctx: &Ctx<'_>) -> Result<Walk> {
    let mut walker = Walker::new(scene, settings, trip.start);
    let moves = (DETOUR * (trip.goal - trip.start).norm() / trip.step_m) as usize + PATIENCE_MOVES;
    let mut best_m = f64::INFINITY;
    let mut without_gain = 0;
    let mut shortfall = None;
    for _ in 0..moves {
        ctx.check()?;
        let missing_m = (trip.goal - walker.at()).norm();
        if missing_m <= trip.tolerance_m {
            return Ok(Walk { path: walker.into_path(), shortfall: None });
        }
        without_gain = if missing_m < best_m - trip.step_m / 10.0 { 0 } else { without_gain + 1 };
        best_m = best_m.min(missing_m);
        let gives_up = settings.reading == Reading::Off && walker.trap().is_some();
        if gives_up || without_gain > PATIENCE_MOVES {
            shortfall = Some(Shortfall::Trapped { at: walker.at() });
            break;
        }
        let step_m = trip.step_m;
        walker.advance(&Move { target: trip.goal, step_m, cap_m: step_m, expected_m: step_m });
    }
    let at = walker.at();
    let short = Shortfall::Short { missing_m: (trip.goal - at).norm(), at };
    Ok(Walk { path: walker.into_path(), shortfall: Some(shortfall.unwrap_or(short)) })
}
