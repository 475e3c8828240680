//! Planning by offsets from the course: on it wherever it is free, beside it at the least cost where it is not.

use crate::{
    course::Course,
    polish::Polish,
    strip::{End, Found, Station, Strip},
};
use field::Room;
use planner_api::{Ctx, Result};
use std::{collections::BTreeMap, ops::RangeInclusive};
use world::{Point, Vector};

/// Distance between the stations of the first search, metres.
const COARSE_M: f64 = 0.2;
/// Distance between its offsets, metres.
const CELL_M: f64 = 0.05;
/// Preset points nearer to each other than this are moved together, metres.
const FINE_M: f64 = 0.1;
/// Room before and behind what blocks the course, metres: enough to leave it and to come back.
const RAMPS_M: [f64; 2] = [1.4, 4.0];
/// Cells and their number on either side when a way is moved to the points of the course; the first that suffices.
const REFINEMENTS: [(f64, usize); 2] = [(0.025, 2), (0.025, 4)];
/// The last point counts more than any other, so that the path arrives.
const END_WEIGHT: f64 = 20.0;
/// A last point inside an obstacle is missed by no more than this beside what it must be, metres.
const NEARLY_M: f64 = 0.1;
/// Cells of the passes that polish a way, metres.
const POLISH_M: [f64; 7] = [0.03, 0.03, 0.02, 0.02, 0.01, 0.01, 0.005];
/// The course itself may turn faster than the limit; the path may do so a little faster than the course.
const OWN_TURN: f64 = 1.15;

/// What the plan is to keep to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Furthest offset from the course, metres.
    pub offset_m: f64,
    /// Largest change of heading per metre of path, radians; infinite for none.
    pub turn_per_m: f64,
}

/// A path beside the course.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// One point for every point of the course.
    pub points: Vec<Point>,
    /// Indices of the course between which the limit of the heading could not be kept.
    pub sharp: Vec<RangeInclusive<usize>>,
}

/// Why there is no path.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocked {
    /// Index of the point of the course that cannot be passed.
    pub station: usize,
    /// The path up to where it leaves the course for the last time.
    pub partial: Vec<Point>,
}

/// What was found within one window: a point for every point of the course there.
enum Beside {
    /// A way within the limit of the heading.
    Smooth(Vec<Point>),
    /// A way that turns faster.
    Sharp(Vec<Point>),
    /// None.
    Blocked { station: usize },
}

/// One search for a path.
struct Search<'a> {
    course: &'a Course,
    room: &'a Room,
    limits: Limits,
}

/// The path along a course that keeps its distance from everything, with the least sum of squared offsets.
///
/// # Errors
/// When the console wants it to stop.
pub fn plan(
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
            let found = known.entry(ends(window)).or_insert_with(|| search.beside(window));
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
    /// The points of the course that the robot cannot stand on, or not go on from.
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

    /// Pieces of the course with room to go round what blocks it; overlapping ones are one.
    fn windows(&self, blocked: &[usize], ramps_m: &[f64]) -> Vec<RangeInclusive<usize>> {
        let stations_m = &self.course.stations_m;
        let mut windows: Vec<RangeInclusive<usize>> = Vec::new();
        for (index, ramp_m) in blocked.iter().zip(ramps_m) {
            let first = stations_m.partition_point(|s| *s < stations_m[*index] - ramp_m);
            let last = stations_m.partition_point(|s| *s <= stations_m[*index] + ramp_m) - 1;
            let (mut start, mut end) = (first, last);
            while let Some(window) = windows.pop_if(|window| *window.end() >= start) {
                (start, end) = (start.min(*window.start()), end.max(*window.end()));
            }
            windows.push(start..=end);
        }
        windows
    }

    /// A way round within a window: as smooth as demanded if there is one, else any.
    fn beside(&self, window: &RangeInclusive<usize>) -> Beside {
        let far_m = self.limits.offset_m;
        let mut furthest = *window.start();
        let mut short_of_end = None;
        let begin = self.enter(*window.start());
        let mut attempts = vec![
            (true, far_m * 0.6, begin),
            (true, far_m, begin),
            (false, far_m, begin),
            (false, far_m * 2.0, begin),
        ];
        if begin == End::On {
            // Where nothing leads on from the start itself the path begins beside it.
            attempts.push((false, far_m, End::Anywhere));
        }
        for (limits_heading, offset_m, enter) in attempts {
            match self.within(window, limits_heading, offset_m, enter) {
                Ok(points) if !self.arrives(window, &points) => short_of_end = Some(points),
                Ok(points) if limits_heading => return Beside::Smooth(points),
                Ok(points) => return Beside::Sharp(points),
                Err(station) => furthest = furthest.max(station),
            }
        }
        short_of_end.map_or(Beside::Blocked { station: furthest }, Beside::Sharp)
    }

    /// Whether the last window ends at the end of the course, or as near to it as obstacles allow.
    fn arrives(&self, window: &RangeInclusive<usize>, points: &[Point]) -> bool {
        let end = self.course.points[self.course.last()];
        let allowed_m = self.course.tolerance_m.max(NEARLY_M - self.room.spare_m(end));
        *window.end() < self.course.last() || (points[points.len() - 1] - end).norm() <= allowed_m
    }

    /// A way round within a window, one point for every point of the course; or the point that cannot be passed.
    fn within(
        &self,
        window: &RangeInclusive<usize>,
        limits_heading: bool,
        offset_m: f64,
        enter: End,
    ) -> std::result::Result<Vec<Point>, usize> {
        let coarse_m = self.coarse_stations(window);
        let mut stations: Vec<Station> = coarse_m.iter().map(|s| self.station(*s, 1.0)).collect();
        if let Some(last) = stations.last_mut() {
            last.weight = END_WEIGHT;
        }
        let half = (offset_m / CELL_M).round() as usize;
        let most_change = if limits_heading { 6 } else { 12 };
        let strip = Strip {
            stations: &stations,
            middle_m: &vec![0.0; stations.len()],
            cell_m: CELL_M,
            half,
            most_change,
            limits_heading,
            enter,
            leave: self.leave(*window.end()),
        };
        match strip.cheapest(self.room) {
            Found::Blocked { station } => {
                let index = self.course.stations_m.partition_point(|s| *s < coarse_m[station]);
                Err(index.min(*window.end()))
            }
            Found::Way(offsets_m) => {
                self.refined(window, (limits_heading, enter), &coarse_m, &offsets_m).ok_or(*window.start())
            }
        }
    }

    /// The way moved to the points of the course and off the grid of offsets.
    fn refined(
        &self,
        window: &RangeInclusive<usize>,
        (limits_heading, enter): (bool, End),
        coarse_m: &[f64],
        offsets_m: &[f64],
    ) -> Option<Vec<Point>> {
        let knots = self.knots(window);
        let stations: Vec<Station> = knots
            .windows(2)
            .map(|pair| self.native(pair[0], (pair[1] - pair[0]) as f64))
            .chain(knots.last().map(|last| self.native(*last, END_WEIGHT)))
            .collect();
        let at_m = |index: &usize| interpolated(coarse_m, offsets_m, self.course.stations_m[*index]);
        let mut middle_m: Vec<f64> = knots.iter().map(at_m).collect();
        let mut is_way = false;
        for (cell_m, half) in REFINEMENTS {
            let strip = Strip {
                stations: &stations,
                middle_m: &middle_m,
                cell_m,
                half,
                most_change: 2 * half,
                limits_heading,
                enter,
                leave: self.leave(*window.end()),
            };
            if let Found::Way(offsets_m) = strip.cheapest(self.room) {
                middle_m = offsets_m;
                is_way = true;
                break;
            }
        }
        if !is_way {
            return None;
        }
        let mut places: Vec<Point> =
            stations.iter().zip(&middle_m).map(|(s, n)| s.at + s.left * *n).collect();
        let polish = Polish { stations: &stations, limits_heading, enter, leave: self.leave(*window.end()) };
        for cell_m in POLISH_M {
            places = polish.pass(self.room, &places, cell_m).unwrap_or(places);
        }
        Some(filled(&knots, &places))
    }

    /// Ways along the course to the stations of the first search, metres.
    fn coarse_stations(&self, window: &RangeInclusive<usize>) -> Vec<f64> {
        let (from_m, to_m) = (self.course.stations_m[*window.start()], self.course.stations_m[*window.end()]);
        let n_pieces = ((to_m - from_m) / COARSE_M).round().max(1.0) as usize;
        (0..=n_pieces).map(|k| from_m + (to_m - from_m) * (k as f64 / n_pieces as f64)).collect()
    }

    /// Points of the course that are moved; those between follow.
    fn knots(&self, window: &RangeInclusive<usize>) -> Vec<usize> {
        let stations_m = &self.course.stations_m;
        let mut knots = vec![*window.start()];
        for index in window.clone() {
            if stations_m[index] - stations_m[knots[knots.len() - 1]] >= FINE_M {
                knots.push(index);
            }
        }
        if knots[knots.len() - 1] != *window.end() {
            knots.push(*window.end());
        }
        knots
    }

    fn native(&self, index: usize, weight: f64) -> Station {
        Station { at: self.course.points[index], ..self.station(self.course.stations_m[index], weight) }
    }

    fn station(&self, station_m: f64, weight: f64) -> Station {
        let (at, direction) = self.course.at_m(station_m);
        let index = self.course.stations_m.partition_point(|s| *s < station_m).min(self.course.last());
        let own = self.course.turn_per_m(index) * OWN_TURN;
        Station {
            at,
            left: Vector::new(-direction.y, direction.x),
            weight,
            turn_per_m: self.limits.turn_per_m.max(own),
        }
    }

    fn enter(&self, index: usize) -> End {
        match index {
            0 if self.room.spare_m(self.course.points[0]) >= 0.0 => End::On,
            0 => End::Anywhere,
            _ => End::Along(self.course.leg(index - 1)),
        }
    }

    fn leave(&self, index: usize) -> End {
        if index == self.course.last() { End::Anywhere } else { End::Along(self.course.leg(index)) }
    }
}

fn interpolated(stations_m: &[f64], offsets_m: &[f64], station_m: f64) -> f64 {
    let next = stations_m.partition_point(|s| *s <= station_m).clamp(1, stations_m.len() - 1);
    let (from_m, to_m) = (stations_m[next - 1], stations_m[next]);
    let share = ((station_m - from_m) / (to_m - from_m)).clamp(0.0, 1.0);
    offsets_m[next - 1] + (offsets_m[next] - offsets_m[next - 1]) * share
}

/// A point for every point of the course: on the straight way between those that were moved.
fn filled(knots: &[usize], places: &[Point]) -> Vec<Point> {
    let mut points = vec![places[0]];
    for (pair, ends) in knots.windows(2).zip(places.windows(2)) {
        let n_pieces = (pair[1] - pair[0]) as f64;
        let straight = (1..=pair[1] - pair[0]).map(|k| ends[0] + (ends[1] - ends[0]) * (k as f64 / n_pieces));
        points.extend(straight);
    }
    points
}

/// The course with the ways round in their places.
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
