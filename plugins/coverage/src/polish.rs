//! Making a path shorter and straighter without losing floor: what other parts of the path sweep as well need not be
//! swept here, and what was missed is worth a detour only if it is large enough.

use crate::{
    cuts::Cut,
    floor::{FloorGrid, Run},
    ground::Ground,
    lanes::Lane,
    side_by_side::Stop,
    slit::Slit,
    touch::touch_up,
    tour::angle_rad,
};
use planner_api::Result;
use std::ops::Range;
use world::{Point, Vector};

mod bend;
mod places;
use places::Places;

/// Longest side of a path under polish, metres.
const SIDE_M: f64 = 0.3;
/// Shortcuts that save less than this are not looked at, metres.
const LEAST_SAVING_M: f64 = 0.04;
/// Length of path that a shortcut may replace, metres: anywhere, and where the path turns back on itself.
const SHORT_M: f64 = 2.7;
const LONG_M: f64 = 9.0;
/// Sides beyond which not every end of a shortcut is tried.
const FINE: usize = 8;
/// Turning beyond which longer shortcuts are tried, radians.
const MUCH_TURN_RAD: f64 = 3.0;
/// A touch-up that scans less than this by the time it is tied in is left, square metres.
const LEAST_GAIN_M2: f64 = 0.01;
/// Touch-ups are tied in at path points within this distance, metres.
const TIE_M: f64 = 2.0;

/// Places across a side at which a quick look is taken, as shares of half the bar.
const ACROSS: [f64; 4] = [-0.75, -0.25, 0.25, 0.75];

/// What things are worth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prices {
    /// Metres of path that turning by a radian is worth.
    pub turn_m_per_rad: f64,
    /// Metres of path that a square metre of floor is worth.
    pub floor_m_per_m2: f64,
}

/// A path with what it sweeps.
#[derive(Clone)]
pub struct Track<'a> {
    slit: &'a Slit,
    /// Its points.
    pub points: Vec<Point>,
    /// For every point but the last the side to the next one.
    pub sides: Vec<Side>,
    /// What every side sweeps: asked for again and again while the path around it changes.
    bars: Vec<Bar>,
    /// The floor it sweeps.
    pub grid: FloorGrid,
}

/// The straight way from a point of a track to the next one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Side {
    /// Whether it is part of a lane.
    pub on_lane: bool,
    ahead: Vector,
    length_m: f64,
    /// Turning at its first point, radians.
    turn_rad: f64,
    /// Cells that only this side sweeps, about; no more than it really sweeps alone where it is new.
    alone: u32,
    /// Whether it was put in since shortcuts were last looked for.
    is_new: bool,
    /// Whether shortcuts from its first point have to be looked for.
    is_open: bool,
}

/// Cells under the bar along a side.
#[derive(Debug, Clone)]
struct Bar {
    /// While it turns into the side.
    turn: Vec<Run>,
    /// On the side itself.
    side: Vec<Run>,
    samples: Samples,
}

/// Which of the samples across a side are swept by nothing else, and after how many changes of the floor that was so.
#[derive(Debug, Clone, Copy, Default)]
struct Samples {
    alone: [bool; ACROSS.len()],
    changes: Option<u32>,
}

impl<'a> Track<'a> {
    /// A track of sides, each of them on a lane or on a way between lanes.
    pub fn new(slit: &'a Slit, pieces: &[crate::scan::Piece], grid: FloorGrid) -> Self {
        let mut track = Self { slit, points: Vec::new(), sides: Vec::new(), bars: Vec::new(), grid };
        for piece in pieces {
            let from = track.points.is_empty().then(|| piece.points.first().copied()).flatten();
            track.points.extend(from);
            let Some(mut at) = track.points.last().copied() else { continue };
            for point in piece.points.iter().skip(1) {
                if (point - at).norm() >= 1e-6 {
                    divide(at, *point, piece.is_lane, &mut track.points, &mut track.sides);
                    at = *point;
                }
            }
        }
        track.turn(0, track.sides.len());
        track.grid.clear();
        track.grid.sweep(&track.points);
        track.bars = (0..track.sides.len()).map(|side| track.bar(side)).collect();
        for (side, bar) in track.sides.iter_mut().zip(&track.bars) {
            side.alone = track.grid.alone(&bar.side);
        }
        track
    }

    fn bar(&self, side: usize) -> Bar {
        let before = side.checked_sub(1).map(|k| self.points[k]);
        let (turn, side) = self.grid.turn_and_side(before, self.points[side], self.points[side + 1]);
        Bar { turn, side, samples: Samples::default() }
    }

    /// Where a sample across a side lies.
    fn sample(&self, side: usize, share: f64) -> Point {
        let Side { ahead, length_m, .. } = self.sides[side];
        let across = Vector::new(-ahead.y, ahead.x) * (self.grid.bar_m() / 2.0);
        let middle = self.points[side] + ahead * (length_m / 2.0);
        middle + across * share
    }

    /// Which samples across a side nothing else sweeps. Many ways are tried between two changes of the floor.
    fn alone(&mut self, side: usize) -> [bool; ACROSS.len()] {
        let known = self.bars[side].samples;
        if known.changes == Some(self.grid.changes) {
            return known.alone;
        }
        let alone = ACROSS.map(|share| self.grid.is_alone(self.sample(side, share)));
        self.bars[side].samples = Samples { alone, changes: Some(self.grid.changes) };
        alone
    }

    /// What the path sweeps on some sides, without the turn into the first one.
    fn swept_by(&self, sides: Range<usize>) -> Vec<Run> {
        let bars = &self.bars[sides];
        let mut runs = Vec::with_capacity(bars.iter().map(|bar| bar.turn.len() + bar.side.len()).sum());
        for (k, bar) in bars.iter().enumerate() {
            if k > 0 {
                runs.extend(&bar.turn);
            }
            runs.extend(&bar.side);
        }
        runs
    }

    /// Sides between two points with one before and one behind, as far as there are such.
    fn around(&self, from: usize, to: usize) -> Range<usize> {
        from.saturating_sub(1)..(to + 1).min(self.sides.len())
    }

    /// What the path would sweep on the same sides with another way from one point to another.
    fn swept_with(&self, from: usize, to: usize, way: &[Point]) -> Vec<Run> {
        let (sides, mut runs) = (self.around(from, to), Vec::with_capacity(128));
        let mut path = Vec::with_capacity(way.len() + 2);
        path.extend((sides.start < from).then(|| self.points[sides.start]));
        path.extend(way);
        path.extend((sides.end > to).then(|| self.points[sides.end]));
        let mut fresh = 0..path.len() - 1;
        // Sides that stay are known.
        if sides.start < from && way[0] == self.points[from] {
            fresh.start += 1;
            runs.extend(&self.bars[sides.start].side);
        }
        if sides.end > to && way[way.len() - 1] == self.points[to] {
            fresh.end -= 1;
            runs.extend(&self.bars[to].side);
        }
        self.grid.along_some(&path, fresh, |cells| runs.push(cells.into()));
        runs
    }

    /// Works out the turning at the first points of some sides.
    fn turn(&mut self, from: usize, to: usize) {
        for k in from.max(1)..to.min(self.sides.len()) {
            self.sides[k].turn_rad = angle_rad(self.sides[k - 1].ahead, self.sides[k].ahead);
        }
    }

    /// Shortens and straightens wherever it pays; returns what was saved, metres. Only what was put in since the last
    /// time is looked at, and what leads up to it.
    ///
    /// # Errors
    /// When the console wants an end.
    pub fn shorten(&mut self, prices: &Prices, stop: &Stop) -> Result<f64> {
        let mut since_m = f64::INFINITY;
        for side in self.sides.iter_mut().rev() {
            since_m = if side.is_new { 0.0 } else { since_m + side.length_m };
            side.is_open = since_m <= SHORT_M;
            side.is_new = false;
        }
        let mut saved_m = 0.0;
        let mut from = 0;
        let mut looked_at = 0_u32;
        while from + 2 < self.points.len() {
            if !std::mem::replace(&mut self.sides[from].is_open, false) {
                from += 1;
                continue;
            }
            looked_at += 1;
            if looked_at.is_multiple_of(64) {
                stop.check()?;
                stop.reached(from as f64 / self.points.len() as f64);
            }
            if let Some(gain_m) = self.best_shortcut(from, prices) {
                saved_m += gain_m;
                let first = from.saturating_sub(3);
                let sides = &mut self.sides[first..];
                sides.iter_mut().take(from + 1 - first).for_each(|side| side.is_open = true);
                from = first;
            } else {
                from += 1;
            }
        }
        self.sides.iter_mut().for_each(|side| side.is_new = false);
        Ok(saved_m)
    }

    /// Takes the longest shortcut from a point that pays.
    fn best_shortcut(&mut self, from: usize, prices: &Prices) -> Option<f64> {
        let mut length_m = 0.0;
        let mut turn_rad = 0.0;
        let mut candidates = Vec::new();
        let mut alone = 0_u32;
        let cell_m2 = self.grid.cell_m * self.grid.cell_m;
        let mut to = from;
        while to < self.sides.len() {
            let side = &self.sides[to];
            length_m += side.length_m;
            alone += side.alone;
            turn_rad += side.turn_rad;
            to += 1;
            if length_m > LONG_M || (length_m > SHORT_M && turn_rad < MUCH_TURN_RAD) {
                break;
            }
            // Far ends are looked at less closely.
            if to < from + 2 || !(to - from).is_multiple_of(1 + (to - from) / FINE) {
                continue;
            }
            let leaving = self.sides.get(to).map_or(0.0, |next| next.turn_rad);
            let direct_m = (self.points[to] - self.points[from]).norm();
            // The bar cannot sweep more floor than it passes and turns over.
            let least_lost_m2 =
                f64::from(alone) * cell_m2 - self.grid.bar_m() * (direct_m + self.grid.bar_m());
            let most_m = length_m - direct_m + prices.turn_m_per_rad * (turn_rad + leaving)
                - prices.floor_m_per_m2 * least_lost_m2.max(0.0);
            if most_m > LEAST_SAVING_M {
                candidates.push((to, length_m, turn_rad + leaving));
            }
        }
        for (to, length_m, turn_rad) in candidates.into_iter().rev() {
            if let Some(gain) = self.try_shortcut(from, to, length_m, turn_rad, prices) {
                return Some(gain);
            }
        }
        None
    }

    fn try_shortcut(
        &mut self,
        from: usize,
        to: usize,
        length_m: f64,
        turn_rad: f64,
        prices: &Prices,
    ) -> Option<f64> {
        // The straight way, whether open or not, is a quick measure of what can be gained and lost.
        let straight = [self.points[from], self.points[to]];
        let most_m = length_m - (straight[1] - straight[0]).norm() + prices.turn_m_per_rad * turn_rad;
        if self.loses_more(from, to, &straight, 1.3 * most_m / prices.floor_m_per_m2) {
            return None;
        }
        let way = self.slit.path(self.points[from], self.points[to])?;
        let (new_m, new_rad) = self.measure(from, to, &way);
        let saving_m = length_m - new_m + prices.turn_m_per_rad * (turn_rad - new_rad);
        if saving_m < LEAST_SAVING_M {
            return None;
        }
        if self.loses_more(from, to, &way, 1.3 * saving_m / prices.floor_m_per_m2) {
            return None;
        }
        let (sides, new) = (self.around(from, to), self.swept_with(from, to, &way));
        let cell_m2 = self.grid.cell_m * self.grid.cell_m;
        let most_lost = ((saving_m - LEAST_SAVING_M) / (prices.floor_m_per_m2 * cell_m2)).floor() as i64;
        let old = from_the_middle(sides.clone()).map(|side| &self.bars[side].side[..]);
        if self.grid.loses_more(old, &new, most_lost) {
            return None;
        }
        let old = self.swept_by(sides);
        let lost_m2 = self.grid.exchange(&old, &new) as f64 * cell_m2;
        let gain_m = saving_m - prices.floor_m_per_m2 * lost_m2;
        if gain_m < LEAST_SAVING_M {
            self.grid.exchange(&new, &old);
            return None;
        }
        self.splice(from, to, &[(way, false)]);
        Some(gain_m)
    }

    /// Whether another way would lose more floor than this, from a few samples across every side.
    fn loses_more(&mut self, from: usize, to: usize, way: &[Point], most_m2: f64) -> bool {
        let half_m = self.grid.bar_m() / 2.0;
        let far_m = half_m + self.grid.cell_m;
        let mut lost_m2 = 0.0;
        for at in from_the_middle(from..to) {
            let length_m = self.sides[at].length_m;
            for (share, is_alone) in ACROSS.into_iter().zip(self.alone(at)) {
                if is_alone && !is_near(way, self.sample(at, share), far_m) {
                    lost_m2 += length_m * half_m * 2.0 / ACROSS.len() as f64;
                }
            }
            if lost_m2 > most_m2 {
                return true;
            }
        }
        false
    }

    /// Length and turning of another way from one point of the path to another.
    fn measure(&self, from: usize, to: usize, way: &[Point]) -> (f64, f64) {
        let mut before = from.checked_sub(1).map(|k| self.sides[k].ahead);
        let (mut length_m, mut turn_rad) = (0.0, 0.0);
        for leg in way.windows(2).map(|w| w[1] - w[0]) {
            length_m += leg.norm();
            let Some(heading) = leg.try_normalize(1e-6) else { continue };
            turn_rad += before.map_or(0.0, |b| angle_rad(b, heading));
            before = Some(heading);
        }
        if let (Some(before), Some(after)) = (before, self.sides.get(to)) {
            turn_rad += angle_rad(before, after.ahead);
        }
        (length_m, turn_rad)
    }

    /// Puts other lines in place of the sides between two points.
    fn splice(&mut self, from: usize, to: usize, lines: &[(Vec<Point>, bool)]) {
        let (mut points, mut sides) = (Vec::new(), Vec::new());
        for (line, is_lane) in lines {
            for pair in line.windows(2).filter(|pair| (pair[1] - pair[0]).norm() > 1e-9) {
                divide(pair[0], pair[1], *is_lane, &mut points, &mut sides);
            }
        }
        let past = from + sides.len();
        self.points.splice(from + 1..=to, points);
        self.sides.splice(from..to, sides);
        self.turn(from, past + 1);
        let bars: Vec<Bar> = (from..past).map(|side| self.bar(side)).collect();
        self.bars.splice(from..to, bars);
        if past < self.bars.len() {
            self.bars[past].turn = self.bar(past).turn;
        }
    }

    /// Ties lanes over missed floor into the path, the most worthwhile first, until the coverage is reached; groups of
    /// fewer cells than the least are left.
    ///
    /// # Errors
    /// When the console wants an end.
    pub fn touch_up(
        &mut self,
        ground: &Ground,
        cuts: &[Cut],
        is_wanted: &dyn Fn(Point) -> bool,
        prices: &Prices,
        (enough, least): (f64, usize),
        stop: &Stop,
    ) -> Result<usize> {
        let cell_m2 = self.grid.cell_m * self.grid.cell_m;
        let mut offers: Vec<(f64, usize, Lane)> = Vec::new();
        let places = Places::new(&self.points);
        let missed = self.grid.missed();
        for (k, group) in missed.iter().enumerate() {
            if group.len() < least {
                break;
            }
            stop.check()?;
            stop.reached(k as f64 / missed.len() as f64);
            for lane in touch_up(ground, self.slit, cuts, &self.grid, group) {
                if !lane.points.iter().all(|p| is_wanted(*p)) {
                    continue;
                }
                let sides = self.sides_near(&places, &lane);
                if let Some((cost_m, _, _)) = self.best_tie(&lane, prices, sides) {
                    let gained = self.grid.would_gain(&lane.points);
                    offers.push((cost_m / (gained as f64 * cell_m2).max(1e-9), gained, lane));
                }
            }
        }
        offers.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut made = 0;
        for (_, _, lane) in offers {
            if self.grid.coverage() >= enough {
                break;
            }
            let all = 0..self.sides.len();
            let Some((_, at, is_reversed)) = self.best_tie(&lane, prices, all) else { continue };
            if self.grid.would_gain(&lane.points) < self.grid.cells_in(LEAST_GAIN_M2) {
                continue;
            }
            self.tie(at, &lane, is_reversed);
            made += 1;
        }
        Ok(made)
    }

    /// Sides with an end near an end of a lane, and some more.
    fn sides_near(&self, places: &Places, lane: &Lane) -> Vec<usize> {
        let ends = [lane.points[0], lane.points[lane.points.len() - 1]];
        let points = ends.iter().flat_map(|end| places.near(*end, TIE_M));
        let mut sides: Vec<usize> = points.flat_map(|k| k.saturating_sub(1)..=k).collect();
        sides.retain(|side| *side < self.sides.len());
        sides.sort_unstable();
        sides.dedup();
        sides
    }

    /// Where among some sides a lane is best tied in: cost in metres, side of the path, and whether it runs the other way
    /// round.
    fn best_tie(
        &self,
        lane: &Lane,
        prices: &Prices,
        among: impl IntoIterator<Item = usize>,
    ) -> Option<(f64, usize, bool)> {
        let (a, b) = (lane.points[0], lane.points[lane.points.len() - 1]);
        let length_m = world::polyline::length_m(&lane.points);
        // A look at the box around both ends leaves few points to measure.
        let reach = Vector::new(TIE_M, TIE_M) * 1.001;
        let (low, high) = (a.inf(&b) - reach, a.sup(&b) + reach);
        let near = |p: &Point| {
            let is_near = low.x < p.x && p.x < high.x && low.y < p.y && p.y < high.y;
            if is_near { (p - a).norm().min((p - b).norm()) } else { f64::INFINITY }
        };
        let mut sides: Vec<(f64, usize)> = among
            .into_iter()
            .map(|k| (near(&self.points[k]).min(near(&self.points[k + 1])), k))
            .filter(|(d, _)| *d < TIE_M)
            .collect();
        sides.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        let mut best: Option<(f64, usize, bool)> = None;
        for (_, k) in sides.into_iter().take(10) {
            let (old_m, old_rad) = self.measure(k, k + 1, &self.points[k..k + 2]);
            for is_reversed in [false, true] {
                let way = self.tied(k, lane, is_reversed)?;
                let (new_m, new_rad) = self.measure(k, k + 1, &way);
                let cost_m = new_m - old_m + prices.turn_m_per_rad * (new_rad - old_rad);
                if best.is_none_or(|b| cost_m < b.0) {
                    best = Some((cost_m, k, is_reversed));
                }
            }
        }
        best.filter(|b| b.0 < 8.0 + length_m)
    }

    fn tied(&self, k: usize, lane: &Lane, is_reversed: bool) -> Option<Vec<Point>> {
        let mut points = lane.points.clone();
        if is_reversed {
            points.reverse();
        }
        let mut way = self.slit.path(self.points[k], points[0])?;
        way.pop();
        let last = points[points.len() - 1];
        way.extend(points);
        way.extend(self.slit.path(last, self.points[k + 1])?.into_iter().skip(1));
        Some(way)
    }

    fn tie(&mut self, k: usize, lane: &Lane, is_reversed: bool) {
        let Some(way) = self.tied(k, lane, is_reversed) else { return };
        let (old, new) = (self.swept_by(self.around(k, k + 1)), self.swept_with(k, k + 1, &way));
        self.grid.exchange(&old, &new);
        let mut middle = lane.points.clone();
        if is_reversed {
            middle.reverse();
        }
        let into = self.slit.path(self.points[k], middle[0]).unwrap_or_default();
        let out = self.slit.path(middle[middle.len() - 1], self.points[k + 1]).unwrap_or_default();
        self.splice(k, k + 1, &[(into, false), (middle, true), (out, false)]);
    }
}

/// Places of a range from its middle outward: there two ways between the same ends differ most.
fn from_the_middle(range: Range<usize>) -> impl Iterator<Item = usize> {
    let n = range.len();
    let at =
        move |k: usize| range.start + if k.is_multiple_of(2) { n / 2 + k / 2 } else { n / 2 - k.div_ceil(2) };
    (0..n).map(at)
}

/// Adds a straight way in sides that are short enough, without its first point.
fn divide(from: Point, to: Point, on_lane: bool, points: &mut Vec<Point>, sides: &mut Vec<Side>) {
    let way = to - from;
    let length_m = way.norm();
    let n = (length_m / SIDE_M).ceil().max(1.0);
    for k in 1..=n as usize {
        points.push(from + way * (k as f64 / n));
        sides.push(Side {
            on_lane,
            ahead: way / length_m,
            length_m: length_m / n,
            turn_rad: 0.0,
            alone: 0,
            is_new: true,
            is_open: true,
        });
    }
}

/// Whether a place lies within a distance of a line.
fn is_near(line: &[Point], at: Point, far_m: f64) -> bool {
    let is_near = |pair: &[Point]| {
        let (way, offset) = (pair[1] - pair[0], at - pair[0]);
        let share = (offset.dot(&way) / way.norm_squared().max(1e-18)).clamp(0.0, 1.0);
        (offset - way * share).norm_squared() <= far_m * far_m
    };
    line.windows(2).any(is_near)
}
