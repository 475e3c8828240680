//! Chooses the target of the field's pull: the paper's virtual goals, or the next corner of the shortest path.

use crate::surroundings::{Changed, Surroundings};
use field::{
    GoalLaw, Sides,
    virtual_goals::{SquareLaw, VirtualGoals},
};
use std::collections::VecDeque;
use steering::{Forces, Nearby};
use world::{Point, Vector};

/// Number of steps over which the robot must make progress (the paper's loop uses 60).
const STALL_STEPS: usize = 60;
/// Minimum movement over these steps that counts as progress, metres.
const STALL_M: f64 = 0.12;
/// Distance within which a corner counts as passed, metres.
const PASSED_M: f64 = 0.35;
/// Initial clearance beside the path, in addition to the distance that the window keeps, metres; halved until a path is
/// found.
const ROOM_M: f64 = 0.25;
/// Number of attempts, each with less clearance than the previous one.
const ATTEMPTS: u32 = 6;
/// Interval between checks whether the path is still free, steps. The path is replanned if it is not free, and whenever
/// the map changes.
const LOOK_STEPS: usize = 20;
/// Number of steps after which the path is replanned in any case, because the robot has moved sideways.
const FRESH_STEPS: usize = 40;
/// The path is replanned if its end is more than this distance from the point to aim for, metres.
const AIM_MOVED_M: f64 = 1.0;
/// Interval between checks whether a moving obstacle blocks the path, steps.
const MOVING_STEPS: usize = 5;
/// A path counts as free even if its clearance is smaller, by at most this distance, than what the window keeps,
/// metres.
const SLACK_M: f64 = 0.03;
/// On a map of many parts, the push is limited to these shares of the pull: against the direction of the pull, and
/// across it.
const BACK_SHARE: f64 = 0.5;
const ACROSS_SHARE: f64 = 1.0;

/// The source of virtual goals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GuideBy {
    /// Four goals on a square around the goal, used in a local minimum (Yang et al. 2021).
    Square,
    /// The corners of the shortest path over the known map, whenever the straight path is blocked; our addition.
    Corners,
}

/// The field to follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Field {
    /// The pull.
    pub square: SquareLaw,
    /// The push.
    pub push: GoalLaw,
    /// The source of virtual goals.
    pub by: GuideBy,
    /// Distance that the robot's centre keeps from outlines, metres.
    pub keep_m: f64,
}

/// The virtual goals, and their state from step to step.
#[derive(Debug, Clone)]
pub struct Guide {
    goals: VirtualGoals,
    nearby: Nearby,
    places: VecDeque<Point>,
    way: Vec<Point>,
    age: usize,
}

/// The positions of a robot and of its destination.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trip {
    /// The robot's position.
    pub at: Point,
    /// The end of the trip.
    pub goal: Point,
    /// The next destination: the goal, or a point of the plan inside the part of the map that is kept.
    pub aim: Point,
}

impl Guide {
    /// Creates a guide for a field.
    pub fn new(field: &Field, hull_m: f64) -> Self {
        Self {
            goals: VirtualGoals::default(),
            nearby: Nearby::new(field.push.rho_m + hull_m),
            places: VecDeque::new(),
            way: Vec::new(),
            age: usize::MAX,
        }
    }

    /// Notes a change to the map.
    pub fn take_change(&mut self, changed: Changed) {
        if changed.parts {
            self.nearby.forget();
        }
        if changed.ways {
            self.age = usize::MAX;
        }
    }

    /// The virtual goal in use.
    pub fn virtual_goal(&self) -> Option<Point> {
        self.goals.current()
    }

    /// The rest of the shortest path, ending with the goal.
    pub fn way(&self) -> &[Point] {
        &self.way
    }

    /// The number of virtual goals on the square used so far.
    pub fn used(&self) -> u32 {
        self.goals.used
    }

    /// The forces at a position; a step is `step_m` long.
    pub fn forces(&mut self, field: &Field, around: &Surroundings, trip: &Trip, step_m: f64) -> Forces {
        let map = around.map();
        let forces = field.push.forces(trip.at, trip.goal, map, &mut self.nearby, &mut Sides::default());
        let pull = match field.by {
            GuideBy::Square => self.toward_square(field, around, trip, forces.repulsion, step_m),
            GuideBy::Corners => self.toward_corner(field, around, trip),
        };
        let is_found = field.by == GuideBy::Corners && !around.is_everything();
        let repulsion = if is_found { beside_way(forces.repulsion, pull) } else { forces.repulsion };
        Forces { attraction: pull, repulsion, ..forces }
    }

    fn toward_square(
        &mut self,
        field: &Field,
        around: &Surroundings,
        trip: &Trip,
        push: Vector,
        step_m: f64,
    ) -> Vector {
        let Trip { at, goal, .. } = *trip;
        let law = &field.square;
        let without = law.attraction(at, goal, None) + push;
        let stalled = self.stalled(at);
        let force = if stalled { Vector::zeros() } else { without };
        if self.goals.needs_one(law, at, goal, force, step_m) {
            // The goal may lie beyond the part of the map that is kept.
            let map = if around.is_everything() { around.map() } else { around.charted() };
            self.goals.take_best(law, at, goal, push, map);
        }
        law.attraction(at, goal, self.goals.current())
    }

    /// The pull towards the first corner of the shortest path not yet passed, as strong as the pull of a goal.
    fn toward_corner(&mut self, field: &Field, around: &Surroundings, trip: &Trip) -> Vector {
        let (map, at) = (around.map(), trip.at);
        if self.age == usize::MAX || self.leads_elsewhere(trip) {
            self.find_way(field, around, trip);
        }
        self.age += 1;
        let margin_m = field.keep_m - map.hull_m - SLACK_M;
        if self.age.is_multiple_of(LOOK_STEPS) {
            while self.way.len() > 1 && map.is_free(at, self.way[1], margin_m + SLACK_M + ROOM_M / 2.0) {
                self.way.remove(0);
            }
        }
        let corner = self.way.first().copied().unwrap_or(trip.aim);
        let is_due = self.age >= FRESH_STEPS && self.age.is_multiple_of(LOOK_STEPS);
        if is_due || (self.age.is_multiple_of(MOVING_STEPS) && !map.is_free(at, corner, margin_m)) {
            self.find_way(field, around, trip);
        }
        while self.way.len() > 1 && (self.way[0] - at).norm() < PASSED_M {
            self.way.remove(0);
        }
        let corner = self.way.first().copied().unwrap_or(trip.aim);
        let pull = field.square.attraction(at, trip.goal, None).norm().max(field.square.k_att);
        (corner - at).try_normalize(1e-9).unwrap_or_else(Vector::zeros) * pull
    }

    fn leads_elsewhere(&self, trip: &Trip) -> bool {
        let allowed_m = if trip.aim == trip.goal { 1e-6 } else { AIM_MOVED_M };
        self.way.last().is_none_or(|end| (end - trip.aim).norm() > allowed_m)
    }

    fn find_way(&mut self, field: &Field, around: &Surroundings, trip: &Trip) {
        let way = shortest_way(around, trip.at, trip.aim, field.keep_m, &mut || true);
        self.way = way.unwrap_or_else(|| vec![trip.aim]);
        self.age = 0;
    }

    fn stalled(&mut self, at: Point) -> bool {
        self.places.push_back(at);
        if self.places.len() <= STALL_STEPS {
            return false;
        }
        let first = self.places.pop_front().expect("it holds more than one");
        (at - first).norm() < STALL_M
    }
}

/// Limits a push beside a path that is known to be free. The pull points along the path.
///
/// A wall on a map consists of many parts, and each of them pushes; together they would block every door. The push may
/// therefore deflect the robot but not turn it back. The window takes care of anything too close.
fn beside_way(push: Vector, pull: Vector) -> Vector {
    let Some(ahead) = pull.try_normalize(1e-9) else { return push };
    let along = push.dot(&ahead);
    let across = push - ahead * along;
    let most_across = ACROSS_SHARE * pull.norm();
    let across = across * (most_across / across.norm().max(most_across));
    ahead * along.max(-BACK_SHARE * pull.norm()) + across
}

/// The corners of the shortest path from a position, ending with the goal. Returns `None` if there is no path, or if
/// `keep_going` ends the search.
pub fn shortest_way(
    around: &Surroundings,
    at: Point,
    goal: Point,
    keep_m: f64,
    keep_going: &mut dyn FnMut() -> bool,
) -> Option<Vec<Point>> {
    let map = around.map();
    let ends_m = map.clearance_m(at).min(map.clearance_m(goal)) + map.hull_m;
    // A step on a large map has time for only half of the attempts.
    let first = if around.is_everything() { 0..ATTEMPTS } else { ATTEMPTS / 2..ATTEMPTS };
    for attempt in first {
        let room_m = if attempt + 1 == ATTEMPTS { 0.0 } else { ROOM_M / f64::from(1 << attempt) };
        // A robot whose start or goal is closer to an obstacle than this finds a path in an attempt with less
        // clearance.
        let wished_m = keep_m + room_m;
        if wished_m > ends_m + 1e-6 {
            continue;
        }
        if let Ok(way) = around.floor(wished_m).shortest(at, goal, keep_going) {
            return Some(way.points().into_iter().skip(1).collect());
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use steering::{KnownMap, Solid};
    use world::Boundary;

    fn around(discs: &[(f64, f64, f64)], at: Point) -> Surroundings {
        let disc =
            |(id, (x, y, r)): (usize, &(f64, f64, f64))| Solid::disc(id as u32, Point::new(*x, *y), *r);
        let mut around = Surroundings::new(KnownMap {
            solids: discs.iter().enumerate().map(disc).collect(),
            wall: Boundary::Circle { radius_m: 20.0 },
            hull_m: 0.2,
        });
        around.look(at, 1.0, &[], |_| false);
        around
    }

    fn way(discs: &[(f64, f64, f64)], at: Point, goal: Point) -> Vec<Point> {
        shortest_way(&around(discs, at), at, goal, 0.3, &mut || true).expect("there is a way")
    }

    #[test]
    fn a_free_way_has_no_corner_and_a_blocked_one_leads_past() {
        let goal = Point::new(6.0, 0.0);
        assert_eq!(way(&[], Point::origin(), goal), [goal]);
        let way = way(&[(3.0, 0.1, 0.5)], Point::origin(), goal);
        assert!(way.len() > 1 && way[0].y < -0.2 && way[way.len() - 1] == goal);
    }

    #[test]
    fn the_many_parts_of_a_wall_do_not_close_a_door() {
        // Two walls, west to east, of parts 10 cm apart, with a door of 1.1 m.
        let part = |k: u32| {
            let side = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            (side * 0.65 + side * 0.1 * f64::from(k / 2), 3.0, 0.1)
        };
        let parts: Vec<_> = (0..160).map(part).collect();
        let square = SquareLaw { k_att: 15.0, d_0_m: 3.0, square_m: 4.0, improved: true, hold_steps: 300 };
        let field = Field { square, push: square.push(5.0, 1.0, 0.0), by: GuideBy::Corners, keep_m: 0.32 };
        let goal = Point::new(0.0, 5.0);
        for y in [2.0, 2.3, 2.6, 2.9] {
            let at = Point::new(0.05, y);
            let around = around(&parts, at);
            assert!(!around.is_everything());
            let trip = Trip { at, goal, aim: goal };
            let forces = Guide::new(&field, 0.2).forces(&field, &around, &trip, 0.01);
            assert!(forces.resultant().y > 0.0, "at {y}: {forces:?}");
        }
    }

    #[test]
    fn near_something_the_way_is_found_with_less_room() {
        let way = way(&[(1.0, 0.0, 0.5)], Point::new(0.18, 0.0), Point::new(6.0, 0.0));
        assert!(way.len() > 1);
    }
}
