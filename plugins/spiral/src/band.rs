//! An elastic band: pulls a path as close to its course as the clearance, the wall and the turn limit allow.
//!
//! The alternating direction method of multipliers (Boyd et al. 2011) minimises the sum of squared distances between
//! points of the path and of the course with the same index. In each round it solves a banded linear system and
//! projects the solution onto every limit. The limits are those of the final path: the distances of its segments from
//! solids, and the angle between chords of [`SPAN_M`] at any position along the path.

mod banded;
mod rows;

use banded::Banded;
use geometry::convex::Part;
use rows::{Limit, Row, Solid, solids_of};
use std::f64::consts::PI;
use steering::Room;
use world::{Boundary, Point, Vector, polyline};

/// Length of path over which a change of heading is measured, metres.
pub(crate) const SPAN_M: f64 = 0.2;
/// Share of the turn limit for which the band aims once a path has been found.
const TURN_SHARE: f64 = 0.985;
/// Extra margin added to clearances, metres.
const SPARE_M: f64 = 2e-4;
/// Weights of the first and second differences of the offsets; they keep the points in order.
const ORDER_WEIGHT: f64 = 0.02;
const BEND_WEIGHT: f64 = 0.1;
/// Weight of a fixed point.
const FIXED_WEIGHT: f64 = 1e6;
/// Distance from the wall within which points have a row for the wall, metres.
const WALL_REACH_M: f64 = 0.25;
/// Over-relaxation of the multiplier updates.
const OVER: f64 = 1.6;
/// The number of rounds of solving and projecting with one set of rows.
const ROUNDS: usize = 10;
/// The largest factor by which penalties grow.
const MOST_GROWN: f64 = 100.0;
/// Minimum reduction of the cost by a new set of rows, as a share; the search ends when a set reduces the cost by less.
const GAIN: f64 = 0.002;
/// Number of times that points may slide along the path at the end. The first time, they slide by the share
/// `SLIDE_SHARE` of their deviation.
const SLIDES: usize = 12;
const SLIDE_SHARE: f64 = 0.5;

/// A point of the course and the conditions there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Knot {
    /// The point of the course.
    pub at: Point,
    /// The number of preset points that it represents.
    pub weight: f64,
    /// Largest change of heading per metre of path, radians; infinite if there is no limit.
    pub turn_per_m: f64,
    /// Whether the path must pass through this point.
    pub fixed: bool,
}

/// The effort of one attempt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Patience {
    /// The maximum number of sets of rows.
    pub sets: usize,
    /// Factor by which the penalties grow from one set to the next while a limit is violated.
    pub growth: f64,
    /// The share of the turn limit to aim for.
    pub turn_share: f64,
}

/// A band along a course.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Band<'a> {
    /// The knots of the band.
    pub knots: &'a [Knot],
    /// The space that is available.
    pub room: &'a Room,
}

impl<'a> Band<'a> {
    /// Tightens a path that already passes everything on the desired sides. Returns `None` if no path within the limits
    /// was found.
    pub(crate) fn drawn(&self, way: &[Point], patience: Patience) -> Option<Vec<Point>> {
        let solids = self.solids(way);
        let mut places = way.to_vec();
        let mut rows: Vec<Row<'a>> = Vec::new();
        let mut best: Option<(f64, Vec<Point>)> = None;
        let (mut grown, mut allowed) = (1.0_f64, false);
        for _ in 0..patience.sets {
            let share = if best.is_some() { TURN_SHARE } else { patience.turn_share };
            rows = self.rows(&solids, &places, share, &rows);
            let before = grown;
            grown = if allowed { grown / patience.growth } else { grown * patience.growth }
                .clamp(1.0, MOST_GROWN);
            for row in &mut rows {
                row.penalty *= grown;
                row.multiplier *= before / grown;
            }
            places = self.rounds(&mut rows);
            allowed = self.is_allowed(&places);
            if !allowed {
                continue;
            }
            let cost = self.cost(&places);
            let settled = best.as_ref().is_some_and(|(least, _)| cost > least * (1.0 - GAIN));
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, places.clone()));
            }
            if settled {
                break;
            }
        }
        best.map(|(cost, places)| self.slid_home(cost, places))
    }

    /// Returns the weighted sum of squared distances to the course.
    pub(crate) fn cost(&self, way: &[Point]) -> f64 {
        way.iter().zip(self.knots).map(|(p, knot)| knot.weight * (p - knot.at).norm_squared()).sum()
    }

    /// Whether a path meets every limit.
    pub(crate) fn is_allowed(&self, way: &[Point]) -> bool {
        way.windows(2).all(|w| self.room.is_free(w[0], w[1])) && self.turns_slowly(way)
    }

    /// Whether the path turns no faster than allowed between any two adjacent chords of [`SPAN_M`].
    fn turns_slowly(&self, way: &[Point]) -> bool {
        let stations_m = polyline::stations_m(way);
        let length_m = stations_m[way.len() - 1];
        // As the chords slide along the path, the turn is largest where one end of a chord is at a point of the path.
        let marks_m = stations_m.iter().flat_map(|s_m| [s_m - SPAN_M, *s_m, s_m + SPAN_M]);
        marks_m.filter(|s_m| *s_m >= SPAN_M && s_m + SPAN_M <= length_m).all(|s_m| {
            let (index, share) = piece(&stations_m, s_m);
            let most_rad = self.knots[index].turn_per_m.max(self.knots[index + 1].turn_per_m) * SPAN_M;
            if most_rad >= PI {
                return true;
            }
            let here = way[index].lerp(&way[index + 1], share);
            let before = here - at(way, &stations_m, s_m - SPAN_M);
            let after = at(way, &stations_m, s_m + SPAN_M) - here;
            before.perp(&after).atan2(before.dot(&after)).abs() <= most_rad
        })
    }

    /// Returns the solids near a path, each once.
    fn solids(&self, way: &[Point]) -> Vec<Solid<'a>> {
        let mut parts: Vec<(&'a Part, f64)> = Vec::new();
        for place in way {
            for (part, keep_m) in self.room.parts_near(*place) {
                if !parts.iter().any(|(known, _)| std::ptr::eq(*known, part)) {
                    parts.push((part, keep_m + SPARE_M));
                }
            }
        }
        parts.into_iter().flat_map(|(part, keep_m)| solids_of(part, keep_m)).collect()
    }

    /// Builds the rows for a path; rows that existed before keep their multipliers.
    fn rows(&self, solids: &[Solid<'a>], way: &[Point], share: f64, before: &[Row<'a>]) -> Vec<Row<'a>> {
        let mut rows = Vec::with_capacity(before.len() + 8);
        self.turn_rows(way, share, &mut rows);
        for (index, solid) in solids.iter().enumerate() {
            solid.rows(index as u32 + 1, way, &mut rows);
        }
        if let Boundary::Circle { radius_m } = self.room.wall() {
            let radius_m = radius_m - self.room.keep().wall_m - 1e-7;
            let near = (0..way.len()).filter(|index| way[*index].coords.norm() > radius_m - WALL_REACH_M);
            rows.extend(
                near.map(|index| {
                    Row::new((u32::MAX, index as u32), index, vec![1.0], Limit::Within(radius_m))
                }),
            );
        }
        let mut known = before.iter().peekable();
        for row in &mut rows {
            while known.next_if(|old| old.key < row.key).is_some() {}
            if let Some(old) = known.next_if(|old| old.key == row.key) {
                (row.multiplier, row.target) = (old.multiplier, old.target);
            } else {
                let value = row.value(way);
                row.target = row.limit.nearest(value);
            }
        }
        rows
    }

    /// Builds the rows for the turn limit; they restrict the second difference over the span at every point.
    fn turn_rows(&self, way: &[Point], share: f64, rows: &mut Vec<Row<'a>>) {
        let stations_m = polyline::stations_m(way);
        let last = way.len() - 1;
        for index in 1..last {
            let turn_rad = self.knots[index].turn_per_m * SPAN_M * share;
            let (from_m, to_m) = (stations_m[index] - SPAN_M, stations_m[index] + SPAN_M);
            if turn_rad >= PI || from_m < stations_m[0] || to_m > stations_m[last] {
                continue;
            }
            let (a, b) = (piece(&stations_m, from_m), piece(&stations_m, to_m));
            let (back, on) = (at(way, &stations_m, from_m), at(way, &stations_m, to_m));
            let chord_m = (way[index] - back).norm().min((on - way[index]).norm());
            let Some(along) = (on - back).try_normalize(1e-9) else { continue };
            let left = Vector::new(-along.y, along.x);
            let mut factors = vec![0.0; b.0 + 2 - a.0];
            factors[0] += 1.0 - a.1;
            factors[1] += a.1;
            factors[index - a.0] -= 2.0;
            factors[b.0 - a.0] += 1.0 - b.1;
            factors[b.0 + 1 - a.0] += b.1;
            let most_m = 2.0 * chord_m * (turn_rad / 2.0).sin();
            rows.push(Row::new((0, index as u32), a.0, factors, Limit::Across(left, most_m)));
        }
    }

    /// Slides the points along the path towards those of the course, without violating a limit.
    fn slid_home(&self, mut cost: f64, mut way: Vec<Point>) -> Vec<Point> {
        let mut share = SLIDE_SHARE;
        for _ in 0..SLIDES {
            let slid = self.slid(&way, share);
            let slid_cost = self.cost(&slid);
            if slid_cost < cost && self.is_allowed(&slid) {
                (cost, way) = (slid_cost, slid);
            } else {
                share *= 0.6;
            }
        }
        way
    }

    fn slid(&self, way: &[Point], share: f64) -> Vec<Point> {
        let stations_m = polyline::stations_m(way);
        let mut slid = way.to_vec();
        for index in 1..way.len() - 1 {
            let along = way[index + 1] - way[index - 1];
            if self.knots[index].fixed || along.norm_squared() < 1e-12 {
                continue;
            }
            let wish_m = (self.knots[index].at - way[index]).dot(&along.normalize()) * share;
            let (back_m, on_m) =
                (stations_m[index] - stations_m[index - 1], stations_m[index + 1] - stations_m[index]);
            let by_m = wish_m.clamp(-0.4 * back_m, 0.4 * on_m);
            slid[index] = at(way, &stations_m, stations_m[index] + by_m);
        }
        slid
    }

    /// Solves and projects a number of times; returns the points of the last solution.
    fn rounds(&self, rows: &mut [Row<'a>]) -> Vec<Point> {
        let mut matrix =
            Banded::new(self.knots.len(), rows.iter().map(|row| row.factors.len()).max().unwrap_or(2).max(3));
        for (index, knot) in self.knots.iter().enumerate() {
            let weight = if knot.fixed { FIXED_WEIGHT } else { knot.weight };
            matrix.add(index, &[1.0], weight);
            if index + 1 < self.knots.len() {
                matrix.add(index, &[-1.0, 1.0], ORDER_WEIGHT * knot.weight);
                if index > 0 {
                    matrix.add(index - 1, &[1.0, -2.0, 1.0], BEND_WEIGHT * knot.weight);
                }
            }
        }
        for row in rows.iter() {
            matrix.add(row.first, &row.factors, row.penalty);
        }
        matrix.factorise();
        let mut offsets = vec![Vector::zeros(); self.knots.len()];
        let on_course: Vec<Vector> =
            rows.iter().map(|row| row.of(|index| self.knots[index].at.coords)).collect();
        for _ in 0..ROUNDS {
            offsets.fill(Vector::zeros());
            for (row, on_course) in rows.iter().zip(&on_course) {
                let pull = (row.target - row.multiplier - on_course) * row.penalty;
                for (offset, factor) in offsets[row.first..].iter_mut().zip(&row.factors) {
                    *offset += pull * *factor;
                }
            }
            matrix.solve(&mut offsets);
            for (row, on_course) in rows.iter_mut().zip(&on_course) {
                let value = row.of(|index| offsets[index]) + on_course;
                let value = value * OVER + row.target * (1.0 - OVER);
                row.target = row.limit.nearest(value + row.multiplier);
                row.multiplier += value - row.target;
            }
        }
        self.knots.iter().zip(&offsets).map(|(knot, offset)| knot.at + offset).collect()
    }
}

/// Returns the segment that contains a station, and the fraction of the segment that precedes the station.
fn piece(stations_m: &[f64], station_m: f64) -> (usize, f64) {
    let next = stations_m.partition_point(|s| *s <= station_m).clamp(1, stations_m.len() - 1);
    let (from_m, to_m) = (stations_m[next - 1], stations_m[next]);
    (next - 1, ((station_m - from_m) / (to_m - from_m).max(1e-12)).clamp(0.0, 1.0))
}

fn at(way: &[Point], stations_m: &[f64], station_m: f64) -> Point {
    let (index, share) = piece(stations_m, station_m);
    way[index] + (way[index + 1] - way[index]) * share
}
