//! A path during polishing, divided into sides, with the cells that each side sweeps.

use crate::buckets::Buckets;
use crate::floor::{ReachableFloor, Run, SweptFloor};
use crate::jobs::Job;
use crate::plane::{Course, angle_rad, left_of};
use crate::polish::shell::shell_m;
use crate::scan::Piece;
use crate::scope::Scope;
use crate::slit_domain::SlitDomain;
use crate::tour::Effort;
use crate::tuning::polish::{BENT_FLOOR, FLOOR};
use crate::tuning::shortcuts::SAMPLES;
use std::ops::Range;
use world::{Point, Vector};

/// Longest side, metres.
pub(super) const SIDE_M: f64 = 0.3;

/// The required coverage and the prices of polishing.
#[derive(Clone, Copy)]
pub(crate) struct Terms<'a> {
    /// Metres of path that are worth a radian of turning.
    pub turn_m_per_rad: f64,
    /// Metres of path that are worth a square metre of floor.
    pub floor_m_per_m2: f64,
    /// Metres of path and turning that a bend may cost per square metre of floor.
    pub bend_m_per_m2: f64,
    pub enough: f64,
    /// Coverage that must remain after shortcuts.
    pub keep: f64,
    /// The positions where the robot may go.
    pub is_wanted: &'a dyn Fn(Point) -> bool,
    pub job: &'a Job,
}

/// A path with the floor that it sweeps.
#[derive(Clone)]
pub(crate) struct Track<'a> {
    pub(super) domain: &'a SlitDomain<'a>,
    start: Point,
    pub(super) sides: Vec<Side>,
    pub(super) swept: SweptFloor,
}

/// The straight segment from one point of a track to the next. Side `k` begins at point `k` of the track.
#[derive(Clone)]
pub(super) struct Side {
    to: Point,
    pub on_lane: bool,
    pub ahead: Vector,
    pub length_m: f64,
    /// Turn at the start of the side, radians.
    pub turn_rad: f64,
    /// Length along the shell, metres.
    pub shell_m: f64,
    /// The cells that the bar sweeps while it turns into the side, and those that it sweeps along the side. They are
    /// needed repeatedly while the path around them changes.
    turn: Vec<Run>,
    pub along: Vec<Run>,
    /// Approximate number of cells that only this side sweeps; for a new side never more than the true number.
    pub alone: u32,
    samples: Samples,
    /// Whether the side was added since shortcuts were last searched for.
    pub is_new: bool,
    /// Whether shortcuts from the start of the side must be searched for.
    pub is_open: bool,
}

/// The samples across a side that no other part of the path sweeps, and the number of exchanges on the floor when they
/// were determined.
#[derive(Clone, Copy, Default)]
struct Samples {
    alone: [bool; SAMPLES.len()],
    n_exchanges: Option<u32>,
}

impl<'a> Terms<'a> {
    /// The terms for a scope, with the usual prices of polishing.
    pub(crate) fn of(
        scope: &Scope<'_>,
        effort: Effort,
        swath_m: f64,
        is_wanted: &'a dyn Fn(Point) -> bool,
        job: &'a Job,
    ) -> Self {
        Self {
            turn_m_per_rad: effort.turn_m_per_rad,
            floor_m_per_m2: FLOOR / swath_m,
            bend_m_per_m2: BENT_FLOOR / swath_m,
            enough: scope.enough,
            keep: 0.0,
            is_wanted,
            job,
        }
    }
}

impl<'a> Track<'a> {
    /// Creates a track along some pieces, each a lane or a connector. Only new pieces, and the stretches leading up to
    /// them, will be shortened.
    pub(crate) fn new(
        domain: &'a SlitDomain<'a>,
        pieces: &[Piece],
        is_new: impl Fn(usize) -> bool,
        floor: ReachableFloor,
    ) -> Self {
        let start =
            pieces.iter().flat_map(|piece| &piece.points).next().copied().unwrap_or_else(Point::origin);
        let mut sides: Vec<Side> = Vec::new();
        for (k, piece) in pieces.iter().enumerate() {
            let (mut at, n_before) = (sides.last().map_or(start, |side| side.to), sides.len());
            for point in piece.points.iter().skip(1) {
                if (point - at).norm() >= 1e-6 {
                    divide(at, *point, piece.is_lane, &mut sides);
                    at = *point;
                }
            }
            sides[n_before..].iter_mut().for_each(|side| side.is_new = is_new(k));
        }
        let n = sides.len();
        let mut track = Self { domain, start, sides, swept: SweptFloor::new(floor) };
        track.swept.sweep(&track.points(0..n));
        track.update(0..n);
        for side in &mut track.sides {
            side.alone = track.swept.count(1, &side.along);
        }
        track
    }

    /// Updates the cells and turns of some sides, and the turn into the side after them.
    fn update(&mut self, sides: Range<usize>) {
        for k in sides.start..(sides.end + 1).min(self.sides.len()) {
            let before = k.checked_sub(1);
            if let Some(before) = before {
                self.sides[k].turn_rad = angle_rad(self.sides[before].ahead, self.sides[k].ahead);
            }
            let before = before.map(|before| self.point(before));
            let (turn, along) = self.swept.raster().turn_and_side(before, self.point(k), self.point(k + 1));
            self.sides[k].turn = turn;
            if k < sides.end {
                self.sides[k].along = along;
                self.sides[k].shell_m = shell_m(self.domain.workspace, self.point(k), self.point(k + 1));
            }
        }
    }

    /// Allows a new search for shortcuts along the whole path.
    pub(super) fn reopen(&mut self) {
        self.sides.iter_mut().for_each(|side| side.is_new = true);
    }

    pub(super) fn coverage(&self) -> f64 {
        self.swept.coverage()
    }

    /// The coverage needed in the cells to which the path was fitted so that coverage in other cells reaches `enough`.
    /// A fitted path appears to sweep more than it does.
    pub(super) fn enough_here(&self, enough: f64, other: &ReachableFloor) -> f64 {
        let mut swept = SweptFloor::new(other.clone());
        swept.sweep(&self.points(0..self.sides.len()));
        enough + (self.coverage() - swept.coverage()).max(0.0)
    }

    /// A point of the path, from 0 to the number of sides.
    pub(super) fn point(&self, k: usize) -> Point {
        k.checked_sub(1).map_or(self.start, |side| self.sides[side].to)
    }

    /// The points at the ends of some sides.
    pub(super) fn points(&self, sides: Range<usize>) -> Vec<Point> {
        (sides.start..=sides.end).map(|k| self.point(k)).collect()
    }

    /// All points, indexed by position.
    pub(super) fn places(&self) -> Buckets {
        let points: Vec<(Point, Point)> =
            self.points(0..self.sides.len()).into_iter().map(|p| (p, p)).collect();
        Buckets::new(1.0, 0.0, &points)
    }

    /// The position of a sample across a side.
    pub(super) fn sample(&self, side: usize, share: f64) -> Point {
        let Side { ahead, length_m, .. } = self.sides[side];
        let across = left_of(ahead) * (self.swept.raster().bar_m / 2.0);
        self.point(side) + ahead * (length_m / 2.0) + across * share
    }

    /// The samples across a side that nothing else sweeps. The result is kept until the next exchange on the floor,
    /// because many paths are tried in between.
    pub(super) fn samples_alone(&mut self, side: usize) -> [bool; SAMPLES.len()] {
        let n_exchanges = Some(self.swept.n_exchanges);
        if self.sides[side].samples.n_exchanges != n_exchanges {
            let alone = SAMPLES.map(|share| self.swept.is_swept_once(self.sample(side, share)));
            self.sides[side].samples = Samples { alone, n_exchanges };
        }
        self.sides[side].samples.alone
    }

    /// The sides between two points, with one side before and one after them where these exist.
    pub(super) fn around(&self, from: usize, to: usize) -> Range<usize> {
        from.saturating_sub(1)..(to + 1).min(self.sides.len())
    }

    /// The cells that the path sweeps on some sides, without the turn into the first side.
    pub(super) fn swept_by(&self, sides: Range<usize>) -> Vec<Run> {
        let sides = &self.sides[sides];
        let mut runs = Vec::with_capacity(sides.iter().map(|side| side.turn.len() + side.along.len()).sum());
        for (k, side) in sides.iter().enumerate() {
            if k > 0 {
                runs.extend(&side.turn);
            }
            runs.extend(&side.along);
        }
        runs
    }

    /// The cells that the path would sweep on the same sides, with a different path between two points.
    pub(super) fn swept_with(&self, from: usize, to: usize, way: &[Point]) -> Vec<Run> {
        let (sides, mut runs) = (self.around(from, to), Vec::with_capacity(128));
        let mut path = Vec::with_capacity(way.len() + 2);
        path.extend((sides.start < from).then(|| self.point(sides.start)));
        path.extend(way);
        path.extend((sides.end > to).then(|| self.point(sides.end)));
        let mut fresh = 0..path.len() - 1;
        // The sweeps of unchanged sides are known.
        if sides.start < from && way[0] == self.point(from) {
            fresh.start += 1;
            runs.extend(&self.sides[sides.start].along);
        }
        if sides.end > to && way[way.len() - 1] == self.point(to) {
            fresh.end -= 1;
            runs.extend(&self.sides[to].along);
        }
        self.swept.raster().along_some(&path, fresh, |cells| runs.push(cells.into()));
        runs
    }

    /// Length and turning of a path between two points of the track.
    pub(super) fn course(&self, from: usize, to: usize, way: &[Point]) -> Course {
        let entered = from.checked_sub(1).map(|side| self.sides[side].ahead);
        Course::of(entered, way, self.sides.get(to).map(|side| side.ahead))
    }

    /// Replaces the sides between two points with other lines.
    pub(super) fn splice(&mut self, from: usize, to: usize, lines: &[Piece]) {
        let mut sides = Vec::new();
        for Piece { points, is_lane } in lines {
            for pair in points.windows(2).filter(|pair| (pair[1] - pair[0]).norm() > 1e-9) {
                divide(pair[0], pair[1], *is_lane, &mut sides);
            }
        }
        let past = from + sides.len();
        self.sides.splice(from..to, sides);
        self.update(from..past);
    }

    /// The path in pieces, each either lane or connector, without intermediate points on straight lines; and the floor
    /// that the path swept.
    pub(crate) fn into_pieces(self) -> (Vec<Piece>, SweptFloor) {
        let mut pieces: Vec<Piece> = Vec::new();
        for (k, side) in self.sides.iter().enumerate() {
            match pieces.last_mut() {
                Some(piece) if piece.is_lane == side.on_lane => piece.points.push(side.to),
                _ => pieces.push(Piece { points: vec![self.point(k), side.to], is_lane: side.on_lane }),
            }
        }
        for piece in &mut pieces {
            piece.points = straightened(&piece.points);
        }
        (pieces, self.swept)
    }
}

/// Divides a straight path into sides that are short enough, and appends them to `sides`.
fn divide(from: Point, to: Point, on_lane: bool, sides: &mut Vec<Side>) {
    let way = to - from;
    let length_m = way.norm();
    let n = (length_m / SIDE_M).ceil().max(1.0);
    sides.extend((1..=n as usize).map(|k| Side {
        to: from + way * (k as f64 / n),
        on_lane,
        ahead: way / length_m,
        length_m: length_m / n,
        turn_rad: 0.0,
        shell_m: 0.0,
        turn: Vec::new(),
        along: Vec::new(),
        alone: 0,
        samples: Samples::default(),
        is_new: true,
        is_open: true,
    }));
}

/// A line without the points that lie on the straight line between their neighbours.
fn straightened(points: &[Point]) -> Vec<Point> {
    let mut kept = vec![points[0]];
    for k in 1..points.len() - 1 {
        let (before, after) = (points[k] - kept[kept.len() - 1], points[k + 1] - points[k]);
        let is_corner = before.perp(&after).abs() > 1e-9 * (1.0 + before.norm()) || before.dot(&after) < 0.0;
        if is_corner {
            kept.push(points[k]);
        }
    }
    kept.push(points[points.len() - 1]);
    kept
}
