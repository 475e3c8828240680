//! Making a path shorter and straighter without losing floor: what other parts of the path sweep as well need not be
//! swept here, and what was missed is worth a detour only if it is large enough.

use crate::{
    cuts::Cut, floor::FloorGrid, ground::Ground, lanes::Lane, slit::Slit, touch::touch_up, tour::angle_rad,
};
use planner_api::{Ctx, Result};
use world::{Point, Vector};

/// Longest side of a path under polish, metres.
const SIDE_M: f64 = 0.3;
/// Shortcuts that save less than this are not looked at, metres.
const LEAST_SAVING_M: f64 = 0.04;
/// Length of path that a shortcut may replace, metres: anywhere, and where the path turns back on itself.
const SHORT_M: f64 = 2.7;
const LONG_M: f64 = 9.0;
/// Turning beyond which longer shortcuts are tried, radians.
const MUCH_TURN_RAD: f64 = 3.0;
/// Touch-ups are tied in at path points within this distance, metres.
const TIE_M: f64 = 2.0;

/// What things are worth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prices {
    /// Metres of path that turning by a radian is worth.
    pub turn_m_per_rad: f64,
    /// Metres of path that a square metre of floor is worth.
    pub floor_m_per_m2: f64,
}

/// A path with what it sweeps.
pub struct Track<'a> {
    slit: &'a Slit,
    /// Its points.
    pub points: Vec<Point>,
    /// For every point but the last whether the side to the next one is part of a lane.
    pub on_lane: Vec<bool>,
    /// The floor it sweeps.
    pub grid: FloorGrid,
    /// Cells that only the side from a point to the next one sweeps, about.
    alone: Vec<u32>,
}

impl<'a> Track<'a> {
    /// A track of sides, each of them on a lane or on a way between lanes.
    pub fn new(slit: &'a Slit, pieces: &[crate::scan::Piece], grid: FloorGrid) -> Self {
        let mut track = Self { slit, points: Vec::new(), on_lane: Vec::new(), grid, alone: Vec::new() };
        for piece in pieces {
            for pair in piece.points.windows(2) {
                track.push(pair[0], pair[1], piece.is_lane);
            }
        }
        track.grid.swept.fill(0);
        track.grid.sweep(&track.points);
        track
    }

    fn push(&mut self, a: Point, b: Point, is_lane: bool) {
        if self.points.is_empty() {
            self.points.push(a);
        }
        let from = self.points[self.points.len() - 1];
        let way = b - from;
        let length_m = way.norm();
        if length_m < 1e-6 {
            return;
        }
        let n = (length_m / SIDE_M).ceil().max(1.0) as usize;
        for k in 1..=n {
            self.points.push(from + way * (k as f64 / n as f64));
            self.on_lane.push(is_lane);
        }
    }

    /// Shortens and straightens wherever it pays; returns what was saved, metres.
    ///
    /// # Errors
    /// When the console wants an end.
    pub fn shorten(&mut self, prices: &Prices, ctx: &Ctx<'_>) -> Result<f64> {
        let mut saved_m = 0.0;
        let mut from = 0;
        self.alone = self.points.windows(2).map(|side| self.grid.alone(side)).collect();
        while from + 2 < self.points.len() {
            if from % 64 == 0 {
                ctx.check()?;
            }
            match self.best_shortcut(from, prices) {
                Some(gain_m) => {
                    saved_m += gain_m;
                    from = from.saturating_sub(3);
                }
                None => from += 1,
            }
        }
        Ok(saved_m)
    }

    fn heading(&self, from: usize) -> Option<Vector> {
        let (a, b) = (self.points.get(from)?, self.points.get(from + 1)?);
        (b - a).try_normalize(1e-9)
    }

    /// Takes the longest shortcut from a point that pays.
    fn best_shortcut(&mut self, from: usize, prices: &Prices) -> Option<f64> {
        let before = from.checked_sub(1).and_then(|k| self.heading(k));
        let mut length_m = 0.0;
        let mut turn_rad = 0.0;
        let mut last = before;
        let mut candidates = Vec::new();
        let mut alone = 0_u32;
        let cell_m2 = self.grid.cell_m * self.grid.cell_m;
        let mut to = from;
        while to + 1 < self.points.len() {
            let way = self.points[to + 1] - self.points[to];
            length_m += way.norm();
            alone += self.alone[to];
            let heading = way.try_normalize(1e-9);
            if let (Some(last), Some(heading)) = (last, heading) {
                turn_rad += angle_rad(last, heading);
            }
            last = heading.or(last);
            to += 1;
            if length_m > LONG_M || (length_m > SHORT_M && turn_rad < MUCH_TURN_RAD) {
                break;
            }
            if to < from + 2 {
                continue;
            }
            let after = self.heading(to);
            let leaving = if let (Some(a), Some(b)) = (last, after) { angle_rad(a, b) } else { 0.0 };
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
        let way = self.slit.path(self.points[from], self.points[to])?;
        let (new_m, new_rad) = self.measure(from, to, &way);
        let saving_m = length_m - new_m + prices.turn_m_per_rad * (turn_rad - new_rad);
        if saving_m < LEAST_SAVING_M {
            return None;
        }
        if prices.floor_m_per_m2 * self.sampled_loss_m2(from, to, &way) > 1.3 * saving_m {
            return None;
        }
        let (first, last) = (from.saturating_sub(1), (to + 1).min(self.points.len() - 1));
        let old: Vec<Point> = self.points[first..=last].to_vec();
        let mut new: Vec<Point> = Vec::with_capacity(way.len() + 2);
        new.extend((first < from).then(|| self.points[first]));
        new.extend(&way);
        new.extend((last > to).then(|| self.points[last]));
        let cell_m2 = self.grid.cell_m * self.grid.cell_m;
        let most_lost = ((saving_m - LEAST_SAVING_M) / (prices.floor_m_per_m2 * cell_m2)).floor() as i64;
        if self.grid.loses_more(&old, &new, most_lost) {
            return None;
        }
        let lost_m2 = self.grid.exchange(&old, &new) as f64 * cell_m2;
        let gain_m = saving_m - prices.floor_m_per_m2 * lost_m2;
        if gain_m < LEAST_SAVING_M {
            self.grid.exchange(&new, &old);
            return None;
        }
        self.splice(from, to, &[(way, false)]);
        Some(gain_m)
    }

    /// Floor that another way would lose, from a few samples across every side.
    fn sampled_loss_m2(&self, from: usize, to: usize, way: &[Point]) -> f64 {
        const ACROSS: [f64; 4] = [-0.75, -0.25, 0.25, 0.75];
        let half_m = self.grid.bar_m() / 2.0;
        let mut lost_m2 = 0.0;
        for side in self.points[from..=to].windows(2) {
            let along = side[1] - side[0];
            let length_m = along.norm();
            let across = Vector::new(-along.y, along.x) * (half_m / length_m.max(1e-9));
            let middle = side[0] + along / 2.0;
            for share in ACROSS {
                let at = middle + across * share;
                if self.grid.is_alone(at) && world::polyline::distance_m(way, at) > half_m + self.grid.cell_m
                {
                    lost_m2 += length_m * half_m * 2.0 / ACROSS.len() as f64;
                }
            }
        }
        lost_m2
    }

    /// Length and turning of another way from one point of the path to another.
    fn measure(&self, from: usize, to: usize, way: &[Point]) -> (f64, f64) {
        let mut before = from.checked_sub(1).and_then(|k| self.heading(k));
        let (mut length_m, mut turn_rad) = (0.0, 0.0);
        for leg in way.windows(2).map(|w| w[1] - w[0]) {
            length_m += leg.norm();
            let Some(heading) = leg.try_normalize(1e-6) else { continue };
            turn_rad += before.map_or(0.0, |b| angle_rad(b, heading));
            before = Some(heading);
        }
        if let (Some(before), Some(after)) = (before, self.heading(to)) {
            turn_rad += angle_rad(before, after);
        }
        (length_m, turn_rad)
    }

    /// Puts other lines in place of the sides between two points.
    fn splice(&mut self, from: usize, to: usize, lines: &[(Vec<Point>, bool)]) {
        let mut points = Vec::new();
        let mut on_lane = Vec::new();
        for (line, is_lane) in lines {
            for pair in line.windows(2) {
                let way = pair[1] - pair[0];
                let n = (way.norm() / SIDE_M).ceil() as usize;
                for k in 1..=n {
                    points.push(pair[0] + way * (k as f64 / n as f64));
                    on_lane.push(*is_lane);
                }
            }
        }
        self.alone.splice(from..to, on_lane.iter().map(|_| 0));
        self.points.splice(from + 1..=to, points);
        self.on_lane.splice(from..to, on_lane);
    }

    /// Ties lanes over missed floor into the path, the most worthwhile first, until the coverage is reached.
    ///
    /// # Errors
    /// When the console wants an end.
    pub fn touch_up(
        &mut self,
        ground: &Ground,
        cuts: &[Cut],
        is_wanted: &dyn Fn(Point) -> bool,
        prices: &Prices,
        enough: f64,
        ctx: &Ctx<'_>,
    ) -> Result<usize> {
        let cell_m2 = self.grid.cell_m * self.grid.cell_m;
        self.alone.resize(self.on_lane.len(), 0);
        let mut offers: Vec<(f64, usize, Lane)> = Vec::new();
        for group in self.grid.missed() {
            if group.len() < 8 {
                break;
            }
            ctx.check()?;
            for lane in touch_up(ground, self.slit, cuts, &self.grid, &group) {
                if !lane.points.iter().all(|p| is_wanted(*p)) {
                    continue;
                }
                if let Some((cost_m, _, _)) = self.best_tie(&lane, prices) {
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
            let Some((_, at, is_reversed)) = self.best_tie(&lane, prices) else { continue };
            if self.grid.would_gain(&lane.points) < 4 {
                continue;
            }
            self.tie(at, &lane, is_reversed);
            made += 1;
        }
        Ok(made)
    }

    /// Where a lane is best tied in: cost in metres, side of the path, and whether it runs the other way round.
    fn best_tie(&self, lane: &Lane, prices: &Prices) -> Option<(f64, usize, bool)> {
        let (a, b) = (lane.points[0], lane.points[lane.points.len() - 1]);
        let length_m = world::polyline::length_m(&lane.points);
        let near = |p: &Point| (p - a).norm().min((p - b).norm());
        let mut sides: Vec<(f64, usize)> = (0..self.points.len() - 1)
            .map(|k| (near(&self.points[k]).min(near(&self.points[k + 1])), k))
            .filter(|(d, _)| *d < TIE_M)
            .collect();
        sides.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        let mut best: Option<(f64, usize, bool)> = None;
        for (_, k) in sides.into_iter().take(10) {
            for is_reversed in [false, true] {
                let way = self.tied(k, lane, is_reversed)?;
                let (new_m, new_rad) = self.measure(k, k + 1, &way);
                let (old_m, old_rad) = self.measure(k, k + 1, &[self.points[k], self.points[k + 1]]);
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
        let (first, last) = (k.saturating_sub(1), (k + 2).min(self.points.len() - 1));
        let old: Vec<Point> = self.points[first..=last].to_vec();
        let mut new: Vec<Point> = Vec::new();
        new.extend((first < k).then(|| self.points[first]));
        new.extend(&way);
        new.extend((last > k + 1).then(|| self.points[last]));
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
