//! A* over tangents and arcs.

use super::{
    corner::{ROUNDING_RAD, turned_rad},
    grown_floor::GrownFloor,
    tangent::{Tangent, Turn, tangent},
    way::{NoWay, Piece, Way},
};
use crate::total::Total;
use geometry::{Point, Vector};
use std::{cmp::Reverse, collections::BinaryHeap};

/// The number of tangents after which `keep_going` is called again.
const ASK_EVERY: usize = 64;
/// Difference between lengths that counts as a rounding error, metres.
const ROUNDING_M: f64 = 1e-12;

fn bearing_rad(direction: Vector) -> f64 {
    direction.y.atan2(direction.x)
}

/// A path can turn about a corner in two directions: turn `2 c` is corner `c` counter-clockwise, `2 c + 1` clockwise.
type TurnId = usize;

/// The end of a tangent.
#[derive(Debug, Clone, Copy, PartialEq)]
enum End {
    Goal,
    Turn { id: TurnId, bearing_rad: f64 },
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Test {
    Due,
    Free,
    Blocked,
}

/// A tangent that leaves a turn.
struct Exit {
    tangent: Tangent,
    bearing_rad: f64,
    end: End,
    test: Test,
}

/// A path that has reached a turn.
struct Arrival {
    turn: Option<TurnId>,
    bearing_rad: f64,
    /// Angle by which the path can still follow the turn, radians.
    room_rad: f64,
    at: Point,
    way_m: f64,
    /// The previous arrival, and the exit that the path took from it.
    from: Option<(usize, usize)>,
}

/// A path that would leave an arrival by an exit. The order of the fields defines the order of the queue.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Candidate {
    /// The length so far plus the straight distance to the goal, metres: a lower bound for every path that takes this
    /// exit.
    least_m: Total,
    arrival: usize,
    exit: usize,
    way_m: Total,
}

pub(super) struct Search<'a> {
    floor: &'a GrownFloor,
    goal: Point,
    /// The turns that the search may use.
    turns: Vec<TurnId>,
    /// The exits from every turn that was reached and, last, from the start.
    exits: Vec<Option<Vec<Exit>>>,
    arrivals: Vec<Arrival>,
    /// The arrivals at every turn.
    met: Vec<Vec<usize>>,
    queue: BinaryHeap<Reverse<Candidate>>,
    n_tested: usize,
}

impl<'a> Search<'a> {
    /// Creates a search among the paths that turn about some of the floor's corners.
    pub(super) fn new(floor: &'a GrownFloor, start: Point, goal: Point, corners: &[usize]) -> Self {
        let n_turns = 2 * floor.corners.len();
        let mut search = Self {
            floor,
            goal,
            turns: corners.iter().flat_map(|corner| [2 * corner, 2 * corner + 1]).collect(),
            exits: (0..=n_turns).map(|_| None).collect(),
            arrivals: Vec::new(),
            met: vec![Vec::new(); n_turns],
            queue: BinaryHeap::new(),
            n_tested: 0,
        };
        search.arrive(Arrival {
            turn: None,
            bearing_rad: 0.0,
            room_rad: 0.0,
            at: start,
            way_m: 0.0,
            from: None,
        });
        search
    }

    pub(super) fn run(mut self, keep_going: &mut dyn FnMut() -> bool) -> Result<Way, NoWay> {
        let mut n_taken = 0_usize;
        while let Some(Reverse(candidate)) = self.queue.pop() {
            n_taken += 1;
            if n_taken.is_multiple_of(ASK_EVERY) && !keep_going() {
                return Err(NoWay::Stopped);
            }
            if !self.is_free(&candidate) {
                continue;
            }
            let exit = self.exit(candidate.arrival, candidate.exit);
            let way_m = candidate.way_m.0 + exit.tangent.length_m;
            match exit.end {
                End::Goal => return Ok(self.way(&candidate, way_m)),
                End::Turn { id, bearing_rad } => {
                    let from = Some((candidate.arrival, candidate.exit));
                    let at = exit.tangent.to;
                    let room_rad = self.room_rad(id, bearing_rad);
                    self.arrive(Arrival { turn: Some(id), bearing_rad, room_rad, at, way_m, from });
                }
            }
        }
        Err(NoWay::Unreachable { n_tangents: self.n_tested })
    }

    fn slot(&self, turn: Option<TurnId>) -> usize {
        turn.unwrap_or(self.met.len())
    }

    fn exit(&self, arrival: usize, exit: usize) -> &Exit {
        let slot = self.slot(self.arrivals[arrival].turn);
        &self.exits[slot].as_ref().expect("exits are created on arrival")[exit]
    }

    /// Whether a tangent is free; each tangent is tested once.
    fn is_free(&mut self, candidate: &Candidate) -> bool {
        let slot = self.slot(self.arrivals[candidate.arrival].turn);
        let floor = self.floor;
        let exits = self.exits[slot].as_mut().expect("exits are created on arrival");
        let exit = &mut exits[candidate.exit];
        if exit.test == Test::Due {
            self.n_tested += 1;
            let free = floor.is_free(exit.tangent.from, exit.tangent.to);
            exit.test = if free { Test::Free } else { Test::Blocked };
        }
        exit.test == Test::Free
    }

    /// Continues from an arrival, unless an earlier arrival reaches the same exits by a path of equal or smaller
    /// length.
    fn arrive(&mut self, arrival: Arrival) {
        let slot = self.slot(arrival.turn);
        if let Some(id) = arrival.turn {
            if self.is_behind(id, &arrival) {
                return;
            }
            self.met[id].push(self.arrivals.len());
        }
        if self.exits[slot].is_none() {
            self.exits[slot] = Some(self.exits_of(arrival.turn, arrival.at));
        }
        let index = self.arrivals.len();
        let exits = self.exits[slot].as_ref().expect("created above");
        for (number, exit) in exits.iter().enumerate().filter(|(_, exit)| exit.test != Test::Blocked) {
            if let Some(arc_m) = self.arc_m(&arrival, exit.bearing_rad) {
                let way_m = arrival.way_m + arc_m;
                let least_m = Total(way_m + exit.tangent.length_m + (self.goal - exit.tangent.to).norm());
                let candidate = Candidate { least_m, arrival: index, exit: number, way_m: Total(way_m) };
                self.queue.push(Reverse(candidate));
            }
        }
        self.arrivals.push(arrival);
    }

    fn is_behind(&self, id: TurnId, arrival: &Arrival) -> bool {
        let before = self.met[id].iter().map(|index| &self.arrivals[*index]);
        before.into_iter().any(|earlier| {
            let arc_m = self.arc_m(earlier, arrival.bearing_rad);
            arc_m.is_some_and(|arc_m| earlier.way_m + arc_m <= arrival.way_m + ROUNDING_M)
        })
    }

    /// Returns the length of the arc from an arrival to a bearing, in the direction of its turn; `None` if the arc is
    /// blocked.
    fn arc_m(&self, arrival: &Arrival, bearing_rad: f64) -> Option<f64> {
        let Some(id) = arrival.turn else { return Some(0.0) };
        let turn = self.turn(id);
        let arc_rad = turned_rad(arrival.bearing_rad, bearing_rad, turn.signed_m.signum());
        (arc_rad <= arrival.room_rad + ROUNDING_RAD).then_some(arc_rad.max(0.0) * turn.signed_m.abs())
    }

    /// Returns how far a path that reaches a turn at a given bearing can follow the turn, radians.
    fn room_rad(&self, id: TurnId, bearing_rad: f64) -> f64 {
        let (ahead_rad, back_rad) = self.floor.corners[id / 2].room_rad(bearing_rad).unwrap_or_default();
        if id.is_multiple_of(2) { ahead_rad } else { back_rad }
    }

    fn turn(&self, id: TurnId) -> Turn {
        let corner = &self.floor.corners[id / 2];
        let sign = if id.is_multiple_of(2) { 1.0 } else { -1.0 };
        Turn { center: corner.center, signed_m: sign * corner.radius_m }
    }

    /// Returns all tangents that leave a turn or the start at a free bearing, and reach either the goal or another turn
    /// at a free bearing.
    fn exits_of(&self, turn: Option<TurnId>, at: Point) -> Vec<Exit> {
        let here = turn.map_or(Turn { center: at, signed_m: 0.0 }, |id| self.turn(id));
        let corner = turn.map(|id| &self.floor.corners[id / 2]);
        let leave = |tangent: &Tangent| {
            let Some(corner) = corner else { return Some(0.0) };
            corner.is_free(tangent.leave).then(|| bearing_rad(tangent.leave))
        };
        let goal = tangent(here, Turn { center: self.goal, signed_m: 0.0 });
        let to_goal = goal.and_then(|tangent| {
            Some(Exit { bearing_rad: leave(&tangent)?, tangent, end: End::Goal, test: Test::Due })
        });
        let others = self.turns.iter().copied().filter(|id| turn.is_none_or(|own| own / 2 != id / 2));
        let to_turns = others.filter_map(|id| {
            let tangent = tangent(here, self.turn(id))?;
            if !self.floor.corners[id / 2].is_free(tangent.meet) {
                return None;
            }
            let leave_rad = leave(&tangent)?;
            let end = End::Turn { id, bearing_rad: bearing_rad(tangent.meet) };
            Some(Exit { bearing_rad: leave_rad, tangent, end, test: Test::Due })
        });
        to_goal.into_iter().chain(to_turns).collect()
    }

    /// Returns the path that ends with a candidate's exit.
    fn way(&self, last: &Candidate, length_m: f64) -> Way {
        let mut pieces = Vec::new();
        let mut step = Some((last.arrival, last.exit));
        while let Some((index, number)) = step {
            let (arrival, exit) = (&self.arrivals[index], self.exit(index, number));
            pieces.push(Piece::Straight { from: exit.tangent.from, to: exit.tangent.to });
            if let Some(id) = arrival.turn {
                let Turn { center, signed_m } = self.turn(id);
                let from_rad = arrival.bearing_rad;
                let turned = turned_rad(from_rad, exit.bearing_rad, signed_m.signum()).max(0.0);
                let sweep_rad = turned * signed_m.signum();
                pieces.push(Piece::Arc { center, radius_m: signed_m.abs(), from_rad, sweep_rad });
            }
            step = arrival.from;
        }
        pieces.reverse();
        Way { pieces, length_m }
    }
}
