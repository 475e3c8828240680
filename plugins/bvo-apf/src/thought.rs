//! Walking in thought: a machine over the known map, and the shorter side of a detour.

use crate::machine::{Machine, Next, Phase};
use steering::Side;
use world::Point;

/// Rollouts take steps of at least this length, metres.
pub(crate) const COARSE_M: f64 = 0.1;
/// A rollout is given up after this many times the way round the group and to the goal.
const PATIENCE: f64 = 4.0;
/// A walk may be this many times as long as the straight way, and some more for short ways.
const DETOUR: f64 = 15.0;
const SPARE_M: f64 = 60.0;

/// A walk as it came out.
#[derive(Debug, Clone, PartialEq)]
pub struct Walked {
    /// Every place, the start first.
    pub path: Vec<Point>,
    /// Whether the goal was reached.
    pub arrived: bool,
}

/// Walks a machine from a place until it comes within a tolerance of the goal or gives up; `check` ends it early.
///
/// # Errors
/// What `check` says.
pub fn walk<E>(
    machine: &mut Machine,
    start: Point,
    goal: Point,
    tolerance_m: f64,
    mut check: impl FnMut() -> Result<(), E>,
) -> Result<Walked, E> {
    let round_m = machine.going_round().map_or(0.0, |(_, round_m)| round_m);
    let patience_m = DETOUR * (goal - start).norm() + SPARE_M + PATIENCE * round_m;
    let steps = (patience_m / machine.settings.step_m) as usize;
    let mut at = start;
    let mut path = Vec::with_capacity(steps.min(20_000));
    path.push(start);
    for step in 0..steps {
        if (goal - at).norm() <= tolerance_m {
            return Ok(Walked { path, arrived: true });
        }
        if step % 64 == 0 {
            check()?;
        }
        match machine.next(at, goal) {
            Next::By(way) => at += way,
            Next::Back(place) => at = place,
            Next::Nowhere => break,
        }
        path.push(at);
    }
    Ok(Walked { path, arrived: false })
}

/// The side on which the detour that begins now is shorter: until it is over, and straight on from there.
pub fn shorter_side(machine: &Machine, at: Point, goal: Point) -> Side {
    let cost_m = |side: Side| detour_m(machine, at, goal, side);
    let (left_m, right_m) = (cost_m(Side::Left), cost_m(Side::Right));
    if right_m < left_m { Side::Right } else { Side::Left }
}

/// Length of a detour on one side, metres; infinite if it leads nowhere.
fn detour_m(machine: &Machine, start: Point, goal: Point, side: Side) -> f64 {
    let step_m = machine.settings.step_m.max(COARSE_M);
    let mut thought = machine.thought(step_m);
    thought.take_side(side);
    let round_m = thought.going_round().map_or(0.0, |(_, round_m)| round_m);
    let steps = (PATIENCE * (round_m + 2.0) / step_m) as usize;
    let mut at = start;
    for step in 0..steps {
        let follows = matches!(thought.phase(), Phase::Follow(_));
        if follows && (goal - at).norm() <= step_m {
            return step as f64 * step_m;
        }
        if thought.going_round().is_none_or(|(going, _)| going != side) {
            let is_over = matches!(thought.phase(), Phase::Approach);
            return if is_over { step as f64 * step_m + (goal - at).norm() } else { f64::INFINITY };
        }
        match thought.next(at, goal) {
            Next::By(way) => at += way,
            Next::Back(_) | Next::Nowhere => return f64::INFINITY,
        }
    }
    f64::INFINITY
}
