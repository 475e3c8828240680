//! Moves the points of a way a little, in both directions, as long as that brings them nearer to their course.

use crate::strip::{Edge, End, Station, edge, turns_slowly};
use field::Room;
use world::{Point, Vector};

/// Every point may stay or go one cell across, along or both.
const MOVES: [(f64, f64); 9] = [
    (0.0, 0.0),
    (1.0, 0.0),
    (-1.0, 0.0),
    (0.0, 1.0),
    (0.0, -1.0),
    (1.0, 1.0),
    (1.0, -1.0),
    (-1.0, 1.0),
    (-1.0, -1.0),
];
const N: usize = MOVES.len();
/// Points of the course this near to one that left it may leave it, too.
const BESIDE: usize = 3;
/// The first move is to stay.
const STAY: usize = 0;

/// A way to polish.
#[derive(Debug, Clone, Copy)]
pub struct Polish<'a> {
    /// The stations that the points belong to.
    pub stations: &'a [Station],
    /// Whether the limit of the heading holds.
    pub limits_heading: bool,
    /// How the way begins.
    pub enter: End,
    /// How it ends.
    pub leave: End,
}

impl Polish<'_> {
    /// The best of all ways whose points are at most one cell off; `None` if not even the given one keeps the limits.
    ///
    /// The beginning stays where it is, and so does the end unless the way may end anywhere.
    pub fn pass(&self, room: &Room, way: &[Point], cell_m: f64) -> Option<Vec<Point>> {
        let last = way.len() - 1;
        let is_loose = self.loose(way);
        let n_choices = |index: usize| if is_loose[index] { N } else { 1 };
        let mut from = self.choices(way, 0, cell_m);
        let entry = Edge { direction: self.entry(), length_m: (way[1] - way[0]).norm(), free: true };
        let mut cost = [[f64::INFINITY; N]; N];
        let mut came = [[entry; N]; N];
        cost[STAY][STAY] = 0.0;
        let mut back: Vec<[[u8; N]; N]> = Vec::with_capacity(last);
        for index in 1..=last {
            let to = self.choices(way, index, cell_m);
            let free_turn = !self.limits_heading || (index == 1 && !matches!(self.enter, End::Along(_)));
            let turn_per_m = self.stations[index - 1].turn_per_m;
            let mut next_cost = [[f64::INFINITY; N]; N];
            let mut next_came = [[entry; N]; N];
            let mut came_from = [[0; N]; N];
            for a in 0..n_choices(index - 1) {
                if cost[a].iter().all(|cost| cost.is_infinite()) {
                    continue;
                }
                let spare_m = room.spare_m(from[a]);
                for b in 0..n_choices(index) {
                    let edge = edge(room, from[a], spare_m, to[b]);
                    if !edge.free {
                        continue;
                    }
                    let (mut best, mut best_before) = (f64::INFINITY, 0);
                    for before in 0..n_choices(index.saturating_sub(2)) {
                        let fits = || free_turn || turns_slowly(&came[a][before], &edge, turn_per_m);
                        if cost[a][before] < best && fits() {
                            (best, best_before) = (cost[a][before], before as u8);
                        }
                    }
                    let station = &self.stations[index];
                    next_cost[b][a] = best + station.weight * (to[b] - station.at).norm_squared();
                    next_came[b][a] = edge;
                    came_from[b][a] = best_before;
                }
            }
            back.push(came_from);
            (cost, came, from) = (next_cost, next_came, to);
        }
        let (at, before) = self.best_end(&cost, &came)?;
        Some(self.traced(way, cell_m, (at, before), &back))
    }

    /// The points that may move: those off the course and their neighbours.
    fn loose(&self, way: &[Point]) -> Vec<bool> {
        let is_off: Vec<bool> =
            way.iter().zip(self.stations).map(|(p, s)| (p - s.at).norm_squared() > 1e-12).collect();
        let last = way.len() - 1;
        let near = |index: usize| {
            is_off[index.saturating_sub(BESIDE)..(index + BESIDE + 1).min(way.len())].contains(&true)
        };
        let ends_anywhere = self.leave == End::Anywhere;
        (0..way.len()).map(|index| index > 0 && (index < last || ends_anywhere) && near(index)).collect()
    }

    fn entry(&self) -> Vector {
        if let End::Along(direction) = self.enter { direction } else { Vector::zeros() }
    }

    fn choices(&self, way: &[Point], index: usize, cell_m: f64) -> [Point; N] {
        let left = self.stations[index].left;
        let along = Vector::new(left.y, -left.x);
        MOVES.map(|(n, t)| way[index] + left * (n * cell_m) + along * (t * cell_m))
    }

    fn best_end(&self, cost: &[[f64; N]; N], came: &[[Edge; N]; N]) -> Option<(usize, usize)> {
        let turn_per_m = self.stations[self.stations.len() - 1].turn_per_m;
        let fits = |&(at, before): &(usize, usize)| match self.leave {
            End::Along(direction) if self.limits_heading => {
                let came = &came[at][before];
                turns_slowly(came, &Edge { direction, ..*came }, turn_per_m)
            }
            _ => true,
        };
        let states = (0..N).flat_map(|at| (0..N).map(move |before| (at, before)));
        let reached = states.filter(|&(at, before)| cost[at][before].is_finite()).filter(fits);
        reached.min_by(|a, b| cost[a.0][a.1].total_cmp(&cost[b.0][b.1]))
    }

    fn traced(&self, way: &[Point], cell_m: f64, end: (usize, usize), back: &[[[u8; N]; N]]) -> Vec<Point> {
        let mut polished = way.to_vec();
        let (mut at, mut before) = end;
        for (index, came_from) in back.iter().enumerate().rev() {
            polished[index + 1] = self.choices(way, index + 1, cell_m)[at];
            (at, before) = (before, came_from[at][before] as usize);
        }
        polished
    }
}
