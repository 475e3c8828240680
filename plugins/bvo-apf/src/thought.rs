//! Simulates a machine over the known map, and finds the shorter side of a detour.

use crate::machine::{Machine, Next, Phase};
use steering::Side;
use world::Point;

/// Rollouts take steps of at least this length, metres.
pub(crate) const COARSE_M: f64 = 0.1;
/// Maximum length of a rollout, as a multiple of the distance around the group and to the goal; a longer rollout is
/// abandoned.
const PATIENCE: f64 = 4.0;
/// Maximum length of a walk, as a multiple of the straight path, plus a constant for short paths.
const DETOUR: f64 = 15.0;
const SPARE_M: f64 = 60.0;
/// Number of steps between two calls of `check`; each step may simulate two detours.
const CHECKED_STEPS: usize = 16;

/// The result of a walk.
#[derive(Debug, Clone, PartialEq)]
pub struct Walked {
    /// All positions, starting with the start.
    pub path: Vec<Point>,
    /// Whether the goal was reached.
    pub arrived: bool,
}

/// Walks a machine from a position until it is within a tolerance of the goal or gives up. `check` can end the walk
/// early.
///
/// # Errors
/// The error that `check` returns.
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
        if step % CHECKED_STEPS == 0 {
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

/// Finds the side on which the detour that begins now is shorter, including the straight path from its end to the goal.
/// Also returns the number of steps simulated, at most `steps_most`. If neither side ends within them, the left side is
/// returned.
pub fn shorter_side(machine: &Machine, at: Point, goal: Point, steps_most: usize) -> (Side, usize) {
    let mut sides = [Side::Left, Side::Right].map(|side| Detour::new(machine, at, side));
    let mut steps = 0;
    // The two sides take turns. When one of them ends, the other need not be simulated beyond its length.
    while steps < steps_most {
        let costs_m = sides.each_ref().map(|detour| detour.cost_m.unwrap_or(f64::INFINITY));
        let least_m = costs_m[0].min(costs_m[1]);
        let open = sides.iter_mut().filter(|detour| detour.cost_m.is_none());
        let mut open = open.filter(|detour| detour.at_least_m(goal) < least_m).peekable();
        if open.peek().is_none() {
            break;
        }
        for detour in open {
            detour.advance(goal);
            steps += 1;
        }
    }
    let [left_m, right_m] = sides.map(|detour| detour.cost_m.unwrap_or(f64::INFINITY));
    (if right_m < left_m { Side::Right } else { Side::Left }, steps)
}

/// A simulated detour on one side.
struct Detour {
    thought: Machine,
    side: Side,
    at: Point,
    step_m: f64,
    walked_m: f64,
    most_m: f64,
    /// The length of the finished detour plus the straight path from its end, metres; infinite if it leads nowhere.
    cost_m: Option<f64>,
}

impl Detour {
    fn new(machine: &Machine, at: Point, side: Side) -> Self {
        let step_m = machine.settings.step_m.max(COARSE_M);
        let mut thought = machine.thought(step_m);
        thought.take_side(side);
        let round_m = thought.going_round().map_or(0.0, |(_, round_m)| round_m);
        let most_m = PATIENCE * (round_m + 2.0);
        Self { thought, side, at, step_m, walked_m: 0.0, most_m, cost_m: None }
    }

    /// A lower bound for the length, metres.
    fn at_least_m(&self, goal: Point) -> f64 {
        self.walked_m + (goal - self.at).norm()
    }

    fn advance(&mut self, goal: Point) {
        let follows = matches!(self.thought.phase(), Phase::Follow(_));
        if follows && (goal - self.at).norm() <= self.step_m {
            self.cost_m = Some(self.walked_m);
        } else if self.thought.going_round().is_none_or(|(going, _)| going != self.side) {
            let is_over = matches!(self.thought.phase(), Phase::Approach);
            self.cost_m = Some(if is_over { self.at_least_m(goal) } else { f64::INFINITY });
        } else {
            match self.thought.next(self.at, goal) {
                Next::By(way) if self.walked_m < self.most_m => {
                    self.at += way;
                    self.walked_m += self.step_m;
                }
                Next::By(_) | Next::Back(_) | Next::Nowhere => self.cost_m = Some(f64::INFINITY),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{machine::tests::settings, settings::Mode};
    use proptest::prelude::*;
    use steering::{KnownMap, Solid};
    use world::Boundary;

    const GOAL: Point = Point::new(7.0, 1.0);

    /// A robot that follows the outlines of a floor of 8 m by 6 m, with a disc before it.
    fn following(start: Point, disc: (f64, f64, f64)) -> Machine {
        let corners = [(0.0, 0.0), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0)];
        let map = KnownMap {
            solids: vec![Solid::disc(1, Point::new(disc.0, disc.1), disc.2)],
            wall: Boundary::Polygon { vertices: corners.iter().map(|(x, y)| Point::new(*x, *y)).collect() },
            hull_m: 0.25,
        };
        let mut machine = Machine::new(settings(Mode::Rollout).for_trip((GOAL - start).norm()), map);
        machine.follow_outlines(start, GOAL);
        machine
    }

    /// Walks one side to its end on its own; returns its cost, metres, and the number of steps.
    fn walked_out(machine: &Machine, start: Point, side: Side) -> (f64, usize) {
        let mut detour = Detour::new(machine, start, side);
        let mut steps = 0;
        while detour.cost_m.is_none() {
            detour.advance(GOAL);
            steps += 1;
        }
        (detour.cost_m.unwrap_or(f64::INFINITY), steps)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn by_turns_the_same_side_is_found_as_by_walking_both_out(
            y in 0.5..5.5_f64,
            disc in (2.5..5.5_f64, -0.5..6.0_f64, 0.3..1.5_f64),
        ) {
            let start = Point::new(0.6, y);
            let machine = following(start, disc);
            let [left, right] = [Side::Left, Side::Right].map(|side| walked_out(&machine, start, side));
            let (side, steps) = shorter_side(&machine, start, GOAL, usize::MAX);
            prop_assert_eq!(side, if right.0 < left.0 { Side::Right } else { Side::Left });
            prop_assert!(steps <= left.1 + right.1);
        }
    }

    #[test]
    fn no_more_steps_are_taken_than_are_left_and_then_it_is_the_left_side() {
        // The right side is the shorter one.
        let start = Point::new(0.6, 1.0);
        let machine = following(start, (4.0, 2.6, 1.5));
        assert_eq!(shorter_side(&machine, start, GOAL, 1_000).0, Side::Right);
        let (side, steps) = shorter_side(&machine, start, GOAL, 10);
        assert!(side == Side::Left && steps <= 11, "{steps}");
    }
}
