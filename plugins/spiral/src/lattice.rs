//! Plans a path by its offsets from the course. Where the course is free, the path stays on it; elsewhere, it passes
//! beside the course at the lowest cost.

use crate::{
    band::{Band, Knot, Patience, SPAN_M},
    course::Course,
    strip::{Bar, Station, Strip, Way},
};
use planner_api::{Ctx, Result};
use std::{collections::BTreeMap, ops::RangeInclusive};
use steering::Room;
use world::{Point, Vector};

/// Smallest distance between stations in the first search, metres.
const COARSE_M: f64 = 0.15;
/// Distance between neighbouring offsets in the first search, metres.
const CELL_M: f64 = 0.05;
/// Distance within which neighbouring preset points are moved together, metres.
const FINE_M: f64 = 0.1;
/// The same distance for the last search, used when no other finds a smooth path, metres.
const FINEST_M: f64 = 0.05;
/// Length of course included before and after a blockage, metres: enough to leave the course and return to it.
const RAMPS_M: [f64; 2] = [1.0, 3.0];
/// Length of course on either side of a window over which the heading must be smooth, metres.
const BESIDE_M: f64 = SPAN_M * 1.3;
/// Distance in excess of the clearance up to which a path touches an obstacle, metres. For such an obstacle, a path on
/// its other side may be tried.
const TOUCH_M: f64 = 0.1;
/// The alternatives tried at first: only a few. If none of them is smooth, many are tried.
const FEW: Others = Others { cost: 2.0, number: 2 };
const MANY: Others = Others { cost: 6.0, number: 8 };
/// The effort for a first attempt to tighten a path, which is enough for most paths. The remaining paths get a longer
/// attempt.
const HASTE: Patience = Patience { sets: 40, growth: 1.1, turn_share: 0.95 };
const PATIENCE: Patience = Patience { sets: 80, growth: 1.2, turn_share: 0.92 };
/// Weight of the last point. It is higher than that of all others, so that the path reaches the end.
const END_WEIGHT: f64 = 20.0;
/// If the last point is inside an obstacle: the distance by which the path may end further from the obstacle than the
/// clearance requires, metres.
const NEARLY_M: f64 = 0.1;
/// Factor by which the path may turn more sharply than the course where the course itself exceeds the turn limit.
const OWN_TURN: f64 = 1.15;

/// The limits that the plan must meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Limits {
    /// Largest offset from the course, metres.
    pub offset_m: f64,
    /// Largest change of heading per metre of path, radians; infinite if there is no limit.
    pub turn_per_m: f64,
}

/// A path beside the course.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Path {
    /// One point for every point of the course.
    pub points: Vec<Point>,
    /// Index ranges of the course in which the turn limit could not be met.
    pub sharp: Vec<RangeInclusive<usize>>,
}

/// The reason why no path was found.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Blocked {
    /// Index of the point of the course that cannot be passed.
    pub station: usize,
    /// The path up to where it last leaves the course.
    pub partial: Vec<Point>,
}

/// The result in one window; a path has one point for every point of the course there.
enum Beside {
    /// A path within the turn limit.
    Smooth(Vec<Point>),
    /// A path that turns more sharply.
    Sharp(Vec<Point>),
    /// No path.
    Blocked { station: usize },
}

/// The range of alternatives to the cheapest path that are tried.
#[derive(Debug, Clone, Copy)]
struct Others {
    /// Largest cost, as a multiple of the cheapest path's.
    cost: f64,
    /// Largest number of alternatives.
    number: usize,
}

/// The settings of one search for a way round.
#[derive(Debug, Clone, Copy)]
struct Attempt {
    /// Largest offset, metres.
    offset_m: f64,
    /// Factor by which turns may exceed the limit.
    sharper: f64,
    /// Whether the path in the first window begins on the course.
    begins_on: bool,
    patience: Patience,
    others: Others,
    /// Distance within which neighbouring points of the course are moved together, metres.
    fine_m: f64,
}

/// One search for a path.
struct Search<'a> {
    course: &'a Course,
    room: &'a Room,
    limits: Limits,
}

/// Finds the path with the smallest sum of squared offsets from a course, among the paths that keep their distance from
/// everything.
///
/// # Errors
/// The console asked to stop.
pub(crate) fn plan(
    course: &Course,
    room: &Room,
    limits: Limits,
    ctx: &Ctx<'_>,
) -> Result<std::result::Result<Path, Blocked>> {
    let search = Search { course, room, limits };
    let blocked = search.blocked();
    let mut ramps_m = vec![RAMPS_M[0]; blocked.len()];
    let mut known: BTreeMap<(usize, usize), Beside> = BTreeMap::new();
    let mut wider = false;
    loop {
        let windows = search.windows(&blocked, &ramps_m);
        for window in &windows {
            ctx.check()?;
            let found = known.entry(ends(window)).or_insert_with(|| search.beside(window, wider));
            if !matches!(found, Beside::Smooth(_)) {
                let inside = blocked.iter().zip(&mut ramps_m).filter(|(index, _)| window.contains(index));
                inside.for_each(|(_, ramp)| *ramp = RAMPS_M[1]);
            }
        }
        if wider || windows.iter().all(|window| matches!(known[&ends(window)], Beside::Smooth(_))) {
            return Ok(joined(course, &windows, &known));
        }
        wider = true;
    }
}

impl Search<'_> {
    /// Returns the points of the course where the robot cannot be, or from which it cannot reach the next point.
    fn blocked(&self) -> Vec<usize> {
        let points = &self.course.points;
        let is_blocked = |index: &usize| {
            let spare_m = self.room.spare_m(points[*index]);
            let Some(next) = points.get(index + 1) else { return spare_m < 0.0 };
            spare_m < 0.0
                || (spare_m < (next - points[*index]).norm() && !self.room.is_free(points[*index], *next))
        };
        (0..points.len()).filter(is_blocked).collect()
    }

    /// Returns the sections of the course that contain a blockage, with space for a way round; overlapping ones are
    /// merged.
    fn windows(&self, blocked: &[usize], ramps_m: &[f64]) -> Vec<RangeInclusive<usize>> {
        let stations_m = &self.course.stations_m;
        let mut windows: Vec<RangeInclusive<usize>> = Vec::new();
        for (index, ramp_m) in blocked.iter().zip(ramps_m) {
            let first = stations_m.partition_point(|s| *s < stations_m[*index] - ramp_m);
            let last = stations_m.partition_point(|s| *s <= stations_m[*index] + ramp_m) - 1;
            let (mut start, mut end) = (first, last);
            while let Some(window) =
                windows.pop_if(|window| stations_m[*window.end()] + 2.0 * SPAN_M >= stations_m[start])
            {
                (start, end) = (start.min(*window.start()), end.max(*window.end()));
            }
            windows.push(start..=end);
        }
        windows
    }

    /// Finds a way round within a window, within the turn limit if possible.
    fn beside(&self, window: &RangeInclusive<usize>, is_wide: bool) -> Beside {
        let far_m = self.limits.offset_m;
        let mut furthest = *window.start();
        let mut short_of_end = None;
        let begins_on = *window.start() > 0 || self.room.spare_m(self.course.points[0]) >= 0.0;
        let near = Attempt {
            offset_m: far_m * 0.6,
            sharper: 1.0,
            begins_on,
            patience: HASTE,
            others: FEW,
            fine_m: FINE_M,
        };
        let far = Attempt { offset_m: far_m, patience: PATIENCE, ..near };
        let mut attempts = vec![near, far, Attempt { offset_m: far_m * 2.0, ..far }];
        if is_wide {
            attempts.push(Attempt { others: MANY, ..near });
            attempts.push(Attempt { others: MANY, fine_m: FINEST_M, ..far });
        }
        attempts.extend([
            Attempt { sharper: 2.0, ..far },
            Attempt { sharper: f64::INFINITY, ..near },
            Attempt { sharper: f64::INFINITY, offset_m: far_m * 2.0, ..near },
        ]);
        if begins_on && *window.start() == 0 {
            // If no path continues from the start itself, the path begins beside it.
            attempts.push(Attempt { sharper: f64::INFINITY, begins_on: false, ..far });
        }
        for attempt in attempts {
            match self.within(window, &attempt) {
                Ok(points) if !self.arrives(window, &points) => short_of_end = Some(points),
                Ok(points) if attempt.sharper <= 1.0 => return Beside::Smooth(points),
                Ok(points) => return Beside::Sharp(points),
                Err(station) => furthest = furthest.max(station),
            }
        }
        short_of_end.map_or(Beside::Blocked { station: furthest }, Beside::Sharp)
    }

    /// Whether a path in the last window reaches the end of the course, or comes as close as obstacles allow.
    fn arrives(&self, window: &RangeInclusive<usize>, points: &[Point]) -> bool {
        let end = self.course.points[self.course.last()];
        let allowed_m = self.course.tolerance_m.max(NEARLY_M - self.room.spare_m(end));
        *window.end() < self.course.last() || (points[points.len() - 1] - end).norm() <= allowed_m
    }

    /// Finds the best way round within a window, with one point for every point of the course. The error is the index
    /// of the point that cannot be passed.
    fn within(
        &self,
        window: &RangeInclusive<usize>,
        attempt: &Attempt,
    ) -> std::result::Result<Vec<Point>, usize> {
        let indices = self.knots(window, COARSE_M);
        let mut stations: Vec<Station> =
            indices.windows(2).map(|pair| self.station(pair[0], (pair[1] - pair[0]) as f64)).collect();
        stations.push(self.station(*window.end(), END_WEIGHT));
        let strip = Strip {
            stations: &stations,
            cell_m: CELL_M,
            half: (attempt.offset_m / CELL_M).round() as usize,
            most_change: 8,
            on_course: [attempt.begins_on, *window.end() < self.course.last()],
            bars: &[],
        };
        let first = strip.cheapest(self.room).map_err(|station| indices[station])?;
        let mut best: Option<(f64, Vec<Point>)> = None;
        let ways = std::iter::once(first.clone()).chain(self.others(&strip, &first, attempt.others));
        for way in ways {
            let places: Vec<Point> =
                stations.iter().zip(&way.offsets_m).map(|(s, n)| s.at + s.left * *n).collect();
            let rough = filled(&indices, &places);
            let Some((cost, points)) = self.drawn(window, attempt, &rough) else { continue };
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, points));
            }
        }
        best.map(|(_, points)| points).ok_or(*window.start())
    }

    /// Finds alternatives to a path that pass one obstacle on the other side.
    fn others(&self, strip: &Strip<'_>, way: &Way, most: Others) -> Vec<Way> {
        let mut others: Vec<Way> = Vec::new();
        for bar in self.bars(strip.stations, way) {
            let other = Strip { bars: &[bar], ..*strip }.cheapest(self.room);
            others.extend(
                other.ok().filter(|other| other.cost < way.cost * most.cost && !others.contains(other)),
            );
        }
        others.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        others.truncate(most.number);
        others
    }

    /// Returns a bar for each obstacle that a path touches; the bar closes the side on which the path passes.
    fn bars(&self, stations: &[Station], way: &Way) -> Vec<Bar> {
        let mut seen: Vec<Point> = Vec::new();
        let mut bars = Vec::new();
        for (station, offset_m) in stations.iter().zip(&way.offsets_m) {
            let place = station.at + station.left * *offset_m;
            for (part, keep_m) in self.room.parts_near(place) {
                let middle = part.middle();
                if part.distance(place).0 > keep_m + TOUCH_M || seen.contains(&middle) {
                    continue;
                }
                seen.push(middle);
                let from_m = |k: &usize| (stations[*k].at - middle).norm_squared();
                let Some(nearest) = (0..stations.len()).min_by(|a, b| from_m(a).total_cmp(&from_m(b))) else {
                    continue;
                };
                let middle_m = stations[nearest].left.dot(&(middle - stations[nearest].at));
                let (from_m, to_m) = if way.offsets_m[nearest] > middle_m {
                    (middle_m, f64::INFINITY)
                } else {
                    (f64::NEG_INFINITY, middle_m)
                };
                bars.push(Bar { station: nearest, from_m, to_m });
            }
        }
        bars
    }

    /// Moves a rough path off its grid; returns its cost and its points.
    fn drawn(
        &self,
        window: &RangeInclusive<usize>,
        attempt: &Attempt,
        rough: &[Point],
    ) -> Option<(f64, Vec<Point>)> {
        let around = self.around(window);
        let indices = self.knots(&around, attempt.fine_m);
        let last = self.course.last();
        let is_fixed = |index: usize| {
            (index <= *window.start() && attempt.begins_on)
                || (index >= *window.end() && *window.end() < last)
        };
        let knot = |(k, index): (usize, &usize)| {
            let own = self.course.turn_per_m(*index);
            let own = if own > self.limits.turn_per_m { own * OWN_TURN } else { 0.0 };
            Knot {
                at: self.course.points[*index],
                weight: indices.get(k + 1).map_or(END_WEIGHT, |next| (next - index) as f64),
                turn_per_m: (self.limits.turn_per_m * attempt.sharper).max(own),
                fixed: is_fixed(*index),
            }
        };
        let knots: Vec<Knot> = indices.iter().enumerate().map(knot).collect();
        let place = |index: &usize| {
            if window.contains(index) { rough[index - window.start()] } else { self.course.points[*index] }
        };
        let way: Vec<Point> = indices.iter().map(place).collect();
        let band = Band { knots: &knots, room: self.room };
        let (cost, places) = match band.drawn(&way, attempt.patience) {
            Some(places) => (band.cost(&places), places),
            None if attempt.sharper.is_finite() && self.limits.turn_per_m.is_finite() => return None,
            None => return Some((f64::MAX, rough.to_vec())),
        };
        let points = filled(&indices, &places);
        Some((cost, points[window.start() - around.start()..=window.end() - around.start()].to_vec()))
    }

    /// Extends a window by the sections of the course on both sides over which the heading must be smooth.
    fn around(&self, window: &RangeInclusive<usize>) -> RangeInclusive<usize> {
        let stations_m = &self.course.stations_m;
        let first = stations_m.partition_point(|s| *s < stations_m[*window.start()] - BESIDE_M);
        let last = stations_m.partition_point(|s| *s <= stations_m[*window.end()] + BESIDE_M) - 1;
        first..=last
    }

    /// Selects points of the course at this spacing. The search moves these points, and those in between follow.
    fn knots(&self, window: &RangeInclusive<usize>, apart_m: f64) -> Vec<usize> {
        let stations_m = &self.course.stations_m;
        let mut knots = vec![*window.start()];
        for index in window.clone() {
            if stations_m[index] - stations_m[knots[knots.len() - 1]] >= apart_m {
                knots.push(index);
            }
        }
        if knots[knots.len() - 1] != *window.end() {
            knots.push(*window.end());
        }
        knots
    }

    fn station(&self, index: usize, weight: f64) -> Station {
        let direction = self.course.direction(index);
        Station { at: self.course.points[index], left: Vector::new(-direction.y, direction.x), weight }
    }
}

/// For every point of the course, interpolates a point between those that were moved.
fn filled(knots: &[usize], places: &[Point]) -> Vec<Point> {
    let mut points = vec![places[0]];
    for (pair, ends) in knots.windows(2).zip(places.windows(2)) {
        let n_pieces = (pair[1] - pair[0]) as f64;
        let straight = (1..=pair[1] - pair[0]).map(|k| ends[0] + (ends[1] - ends[0]) * (k as f64 / n_pieces));
        points.extend(straight);
    }
    points
}

/// Replaces the blocked windows of the course by the ways round them.
fn joined(
    course: &Course,
    windows: &[RangeInclusive<usize>],
    known: &BTreeMap<(usize, usize), Beside>,
) -> std::result::Result<Path, Blocked> {
    let mut points = course.points.clone();
    let mut sharp = Vec::new();
    for window in windows {
        match &known[&ends(window)] {
            Beside::Smooth(way) => points[window.clone()].copy_from_slice(way),
            Beside::Sharp(way) => {
                points[window.clone()].copy_from_slice(way);
                sharp.push(window.clone());
            }
            Beside::Blocked { station } => {
                points.truncate(*window.start() + 1);
                return Err(Blocked { station: *station, partial: points });
            }
        }
    }
    Ok(Path { points, sharp })
}

fn ends(window: &RangeInclusive<usize>) -> (usize, usize) {
    (*window.start(), *window.end())
}
