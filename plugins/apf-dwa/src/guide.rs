//! Where the field is to pull: the paper's virtual goals, or the next corner of the shortest way.

use field::{
    GoalLaw, Sides,
    virtual_goals::{SquareLaw, VirtualGoals},
};
use std::collections::VecDeque;
use steering::{Forces, KnownMap, Nearby};
use world::{Point, Shape, Vector, shortest::GrownFloor};

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
/// A way counts as free with this much less room than the window keeps, metres.
const SLACK_M: f64 = 0.03;

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
    /// Floors of the map as it is, one for each attempt to find a way.
    floors: Vec<GrownFloor>,
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
            floors: Vec::new(),
        }
    }

    /// The map has changed.
    pub fn forget_map(&mut self) {
        self.nearby.forget();
        self.age = usize::MAX;
        self.floors.clear();
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

    /// The forces at a place.
    pub fn forces(&mut self, field: &Field, map: &KnownMap, at: Point, goal: Point, step_m: f64) -> Forces {
        let forces = field.push.forces(at, goal, map, &mut self.nearby, &mut Sides::default());
        let pull = match field.by {
            GuideBy::Square => self.toward_square(field, map, at, goal, forces.repulsion, step_m),
            GuideBy::Corners => self.toward_corner(field, map, at, goal),
        };
        Forces { attraction: pull, ..forces }
    }

    fn toward_square(
        &mut self,
        field: &Field,
        map: &KnownMap,
        at: Point,
        goal: Point,
        push: Vector,
        step_m: f64,
    ) -> Vector {
        let law = &field.square;
        let without = law.attraction(at, goal, None) + push;
        let stalled = self.stalled(at);
        let force = if stalled { Vector::zeros() } else { without };
        if self.goals.needs_one(law, at, goal, force, step_m) {
            self.goals.take_best(law, at, goal, push, map);
        }
        law.attraction(at, goal, self.goals.current())
    }

    /// Toward the first corner of the shortest way that is not passed yet, as strongly as toward a goal.
    fn toward_corner(&mut self, field: &Field, map: &KnownMap, at: Point, goal: Point) -> Vector {
        let leads_elsewhere = self.way.last().is_none_or(|end| (end - goal).norm() > 1e-6);
        if self.age == usize::MAX || leads_elsewhere {
            self.find_way(field, map, at, goal);
        }
        self.age += 1;
        if self.age.is_multiple_of(LOOK_STEPS) {
            let margin_m = field.keep_m - map.hull_m - SLACK_M;
            while self.way.len() > 1 && map.is_free(at, self.way[1], margin_m + SLACK_M + ROOM_M / 2.0) {
                self.way.remove(0);
            }
            let corner = self.way.first().copied().unwrap_or(goal);
            if self.age >= FRESH_STEPS || !map.is_free(at, corner, margin_m) {
                self.find_way(field, map, at, goal);
            }
        }
        while self.way.len() > 1 && (self.way[0] - at).norm() < PASSED_M {
            self.way.remove(0);
        }
        let corner = self.way.first().copied().unwrap_or(goal);
        let pull = field.square.attraction(at, goal, None).norm().max(field.square.k_att);
        (corner - at).try_normalize(1e-9).unwrap_or_else(Vector::zeros) * pull
    }

    fn find_way(&mut self, field: &Field, map: &KnownMap, at: Point, goal: Point) {
        self.way = shortest_way(map, at, goal, field.keep_m, &mut self.floors);
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

/// The corners of the shortest way from a place, the goal last; only the goal if no way is found. `floors` are those made
/// so far for this map and this distance.
pub fn shortest_way(
    map: &KnownMap,
    at: Point,
    goal: Point,
    keep_m: f64,
    floors: &mut Vec<GrownFloor>,
) -> Vec<Point> {
    for attempt in 0..ATTEMPTS {
        let room_m = if attempt + 1 == ATTEMPTS { 0.0 } else { ROOM_M / f64::from(1 << attempt) };
        // A robot that stands, or is to stand, nearer than that finds a way with less room.
        let wished_m = keep_m + room_m;
        if floors.len() <= attempt as usize {
            floors.push(grown(map, wished_m));
        }
        if let Ok(way) = floors[attempt as usize].shortest(at, goal, &mut || true) {
            return way.points().into_iter().skip(1).collect();
        }
    }
    vec![goal]
}

fn grown(map: &KnownMap, keep_m: f64) -> GrownFloor {
    let shapes: Vec<Shape> = map.solids.iter().map(|solid| solid.part.to_shape()).collect();
    GrownFloor::new(&map.wall, keep_m, shapes.iter().map(|shape| (shape, keep_m)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use steering::Solid;
    use world::Boundary;

    fn map(discs: &[(f64, f64, f64)]) -> KnownMap {
        let disc =
            |(id, (x, y, r)): (usize, &(f64, f64, f64))| Solid::disc(id as u32, Point::new(*x, *y), *r);
        KnownMap {
            solids: discs.iter().enumerate().map(disc).collect(),
            wall: Boundary::Circle { radius_m: 20.0 },
            hull_m: 0.2,
        }
    }

    #[test]
    fn a_free_way_has_no_corner_and_a_blocked_one_leads_past() {
        let goal = Point::new(6.0, 0.0);
        assert_eq!(shortest_way(&map(&[]), Point::origin(), goal, 0.3, &mut Vec::new()), [goal]);
        let way = shortest_way(&map(&[(3.0, 0.1, 0.5)]), Point::origin(), goal, 0.3, &mut Vec::new());
        assert!(way.len() > 1 && way[0].y < -0.2 && way[way.len() - 1] == goal);
    }

    #[test]
    fn near_something_the_way_is_found_with_less_room() {
        let way = shortest_way(
            &map(&[(1.0, 0.0, 0.5)]),
            Point::new(0.18, 0.0),
            Point::new(6.0, 0.0),
            0.3,
            &mut Vec::new(),
        );
        assert!(way.len() > 1);
    }
}
