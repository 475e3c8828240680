//! Where the field is to pull: the paper's virtual goals, or the next corner of the shortest way.

use crate::surroundings::{Changed, Surroundings};
use field::{
    GoalLaw, Sides,
    virtual_goals::{SquareLaw, VirtualGoals},
};
use std::collections::VecDeque;
use steering::{Forces, Nearby};
use world::{Point, Vector};

/// Steps over which the robot must have come on (the paper's loop looks at 60).
const STALL_STEPS: usize = 60;
/// It has not when it moved less than this, metres.
const STALL_M: f64 = 0.12;
/// A corner nearer than this is passed, metres.
const PASSED_M: f64 = 0.35;
/// Room beside the way at first, besides what the window keeps, metres; halved until there is a way.
const ROOM_M: f64 = 0.25;
/// Attempts with less and less room.
const ATTEMPTS: u32 = 6;
/// Whether the way is still free is checked after so many steps; it is replanned when it is not, and whenever the map
/// changes.
const LOOK_STEPS: usize = 20;
/// It is replanned after so many steps in any case: the robot has moved aside.
const FRESH_STEPS: usize = 40;
/// A place further along the plan than the end of the way by this makes the way too short, metres.
const AIM_MOVED_M: f64 = 1.0;
/// What moves is seen to stand in the way after so many steps.
const MOVING_STEPS: usize = 5;
/// A way counts as free with this much less room than the window keeps, metres.
const SLACK_M: f64 = 0.03;
/// On a map of many parts a push is at most this share of the pull: against the way, and across it.
const BACK_SHARE: f64 = 0.5;
const ACROSS_SHARE: f64 = 1.0;

/// Where virtual goals come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GuideBy {
    /// Four on a square round the goal, used in a minimum (Yang et al. 2021).
    Square,
    /// The corners of the shortest way over the known map, whenever the straight way is blocked; ours.
    Corners,
}

/// The field that is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Field {
    /// The pull.
    pub square: SquareLaw,
    /// The push.
    pub push: GoalLaw,
    /// Where virtual goals come from.
    pub by: GuideBy,
    /// Distance that the middle of the robot keeps from outlines, metres.
    pub keep_m: f64,
}

/// What is remembered of virtual goals from step to step.
#[derive(Debug, Clone)]
pub struct Guide {
    goals: VirtualGoals,
    nearby: Nearby,
    places: VecDeque<Point>,
    way: Vec<Point>,
    age: usize,
}

/// Where a robot is and where it is to go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trip {
    /// Where it is.
    pub at: Point,
    /// The end of the way.
    pub goal: Point,
    /// Where to go first: the goal, or a place on the plan that is nearer than what is left out of the map.
    pub aim: Point,
}

impl Guide {
    /// For a field.
    pub fn new(field: &Field, hull_m: f64) -> Self {
        Self {
            goals: VirtualGoals::default(),
            nearby: Nearby::new(field.push.rho_m + hull_m),
            places: VecDeque::new(),
            way: Vec::new(),
            age: usize::MAX,
        }
    }

    /// The map has changed.
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

    /// What is left of the shortest way, the goal last.
    pub fn way(&self) -> &[Point] {
        &self.way
    }

    /// How many virtual goals of the square have been used.
    pub fn used(&self) -> u32 {
        self.goals.used
    }

    /// The forces at a place; a step is `step_m` long.
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
            // The goal may lie beyond what is kept of the map.
            let map = if around.is_everything() { around.map() } else { around.charted() };
            self.goals.take_best(law, at, goal, push, map);
        }
        law.attraction(at, goal, self.goals.current())
    }

    /// Toward the first corner of the shortest way that is not passed yet, as strongly as toward a goal.
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

/// What is left of a push beside a way that is known to be free, along which a pull points.
///
/// A wall of a map is many parts, each of which pushes: together they would close every door. So the push may bend the way and
/// not turn it back; what is too near is left to the window.
fn beside_way(push: Vector, pull: Vector) -> Vector {
    let Some(ahead) = pull.try_normalize(1e-9) else { return push };
    let along = push.dot(&ahead);
    let across = push - ahead * along;
    let most_across = ACROSS_SHARE * pull.norm();
    let across = across * (most_across / across.norm().max(most_across));
    ahead * along.max(-BACK_SHARE * pull.norm()) + across
}

/// The corners of the shortest way from a place, the goal last; none if there is none, or if `keep_going` ends the search.
pub fn shortest_way(
    around: &Surroundings,
    at: Point,
    goal: Point,
    keep_m: f64,
    keep_going: &mut dyn FnMut() -> bool,
) -> Option<Vec<Point>> {
    let map = around.map();
    let ends_m = map.clearance_m(at).min(map.clearance_m(goal)) + map.hull_m;
    // A step on a large map can afford half of the attempts.
    let first = if around.is_everything() { 0..ATTEMPTS } else { ATTEMPTS / 2..ATTEMPTS };
    for attempt in first {
        let room_m = if attempt + 1 == ATTEMPTS { 0.0 } else { ROOM_M / f64::from(1 << attempt) };
        // A robot that stands, or is to stand, nearer than that finds a way with less room.
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
