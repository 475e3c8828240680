//! Shortcuts: a straighter path between two points of the track, wherever it saves more than the lost floor is worth.

use crate::plane::Course;
use crate::polish::shell::shell_m;
use crate::polish::track::{SIDE_M, Terms, Track};
use crate::scan::Piece;
use crate::tuning::shortcuts::{
    FINE, LEAST_SAVING_M, LONG_M, MUCH_TURN_RAD, QUICK_MARGIN, SAMPLES, SHELL, SHORT_M,
};
use planner_api::Result;
use std::ops::Range;
use world::{Point, polyline};

/// A stretch of the path that a shortcut may replace.
struct Stretch {
    from: usize,
    to: usize,
    course: Course,
}

impl Track<'_> {
    /// Shortens and straightens the path wherever it pays. Only parts added since the last call, and the stretches
    /// leading up to them, are examined.
    pub(super) fn shorten(&mut self, terms: &Terms<'_>) -> Result<()> {
        let mut since_m = f64::INFINITY;
        for side in self.sides.iter_mut().rev() {
            since_m = if side.is_new { 0.0 } else { since_m + side.length_m };
            side.is_open = since_m <= SHORT_M;
            side.is_new = false;
        }
        let mut from = 0;
        let mut n_looked_at = 0_u32;
        while from + 1 < self.sides.len() {
            if !std::mem::replace(&mut self.sides[from].is_open, false) {
                from += 1;
                continue;
            }
            n_looked_at += 1;
            if n_looked_at.is_multiple_of(64) {
                terms.job.check()?;
                terms.job.reached(from as f64 / (self.sides.len() + 1) as f64);
            }
            // Take the longest shortcut that pays.
            let stretches = self.stretches(from, terms);
            if stretches.iter().rev().any(|stretch| self.takes_shortcut(stretch, terms)) {
                let first = from.saturating_sub(3);
                let before = &mut self.sides[first..];
                before.iter_mut().take(from + 1 - first).for_each(|side| side.is_open = true);
                from = first;
            } else {
                from += 1;
            }
        }
        self.sides.iter_mut().for_each(|side| side.is_new = false);
        Ok(())
    }

    /// The stretches that begin at a point and may be replaced by a shortcut, shortest first.
    fn stretches(&self, from: usize, terms: &Terms<'_>) -> Vec<Stretch> {
        let (mut length_m, mut turn_rad, mut alone) = (0.0, 0.0, 0_u32);
        let mut stretches = Vec::new();
        for (to, side) in (from + 1..).zip(&self.sides[from..]) {
            length_m += side.length_m;
            alone += side.alone;
            turn_rad += side.turn_rad;
            if length_m > LONG_M || (length_m > SHORT_M && turn_rad < MUCH_TURN_RAD) {
                break;
            }
            // Distant ends are tried less densely.
            if to < from + 2 || !(to - from).is_multiple_of(1 + (to - from) / FINE) {
                continue;
            }
            let leaving_rad = self.sides.get(to).map_or(0.0, |next| next.turn_rad);
            let course = Course { length_m, turn_rad: turn_rad + leaving_rad };
            let straight = self.straight(from, to);
            // The bar cannot sweep more floor than its length times the distance, plus what it sweeps while turning.
            let least_lost_m2 = f64::from(alone) * self.swept.raster().cell_m2()
                - self.swept.raster().bar_m * (straight.length_m + self.swept.raster().bar_m);
            let most_m = course.excess_m(straight, terms.turn_m_per_rad)
                - terms.floor_m_per_m2 * least_lost_m2.max(0.0);
            if most_m > LEAST_SAVING_M {
                stretches.push(Stretch { from, to, course });
            }
        }
        stretches
    }

    /// The straight path between two points, whether it is open or not.
    fn straight(&self, from: usize, to: usize) -> Course {
        Course { length_m: (self.point(to) - self.point(from)).norm(), turn_rad: 0.0 }
    }

    /// Replaces a stretch with the shortest path if that pays. Returns whether the stretch was replaced. Cheap checks
    /// come first.
    fn takes_shortcut(&mut self, stretch: &Stretch, terms: &Terms<'_>) -> bool {
        let Stretch { from, to, course } = *stretch;
        let (a, b) = (self.point(from), self.point(to));
        // The straight path, open or not, is a quick measure of the possible gain and loss.
        let most_m = course.excess_m(self.straight(from, to), terms.turn_m_per_rad);
        if self.seems_to_lose_more(from..to, &[a, b], QUICK_MARGIN * most_m / terms.floor_m_per_m2) {
            return false;
        }
        let Some(way) = self.domain.path(a, b) else { return false };
        let saving_m = course.excess_m(self.course(from, to, &way), terms.turn_m_per_rad)
            - SHELL * self.shell_lost_m(from..to, &way);
        if saving_m < LEAST_SAVING_M
            || self.seems_to_lose_more(from..to, &way, QUICK_MARGIN * saving_m / terms.floor_m_per_m2)
        {
            return false;
        }
        let (sides, new) = (self.around(from, to), self.swept_with(from, to, &way));
        let cell_m2 = self.swept.raster().cell_m2();
        let most_lost = ((saving_m - LEAST_SAVING_M) / (terms.floor_m_per_m2 * cell_m2)).floor() as i64;
        let most_lost = most_lost.min(self.swept.spare(terms.keep));
        let old = from_the_middle(sides.clone()).map(|side| &self.sides[side].along[..]);
        if self.swept.loses_more(old, &new, most_lost) {
            return false;
        }
        let old = self.swept_by(sides);
        let lost_m2 = self.swept.exchange(&old, &new) as f64 * cell_m2;
        if saving_m - terms.floor_m_per_m2 * lost_m2 < LEAST_SAVING_M
            || (lost_m2 > 0.0 && self.coverage() < terms.keep)
        {
            self.swept.exchange(&new, &old);
            return false;
        }
        self.splice(from, to, &[Piece { points: way, is_lane: false }]);
        true
    }

    /// The length of path along the shell that is lost if a path replaces some sides, metres.
    fn shell_lost_m(&self, sides: Range<usize>, way: &[Point]) -> f64 {
        let old_m: f64 = self.sides[sides].iter().map(|side| side.shell_m).sum();
        if old_m <= 0.0 {
            return 0.0;
        }
        let fine = polyline::resampled(way, SIDE_M);
        let new_m = |pair: &[Point]| shell_m(self.domain.workspace, pair[0], pair[1]);
        (old_m - fine.windows(2).map(new_m).sum::<f64>()).max(0.0)
    }

    /// Whether replacing some sides with another path would lose more floor than this, judged by a few samples across
    /// every side.
    fn seems_to_lose_more(&mut self, sides: Range<usize>, way: &[Point], most_m2: f64) -> bool {
        let half_m = self.swept.raster().bar_m / 2.0;
        let far_m = half_m + self.swept.raster().cell_m;
        let mut lost_m2 = 0.0;
        for side in from_the_middle(sides) {
            let length_m = self.sides[side].length_m;
            for (share, is_alone) in SAMPLES.into_iter().zip(self.samples_alone(side)) {
                if is_alone && !is_near(way, self.sample(side, share), far_m) {
                    lost_m2 += length_m * half_m * 2.0 / SAMPLES.len() as f64;
                }
            }
            if lost_m2 > most_m2 {
                return true;
            }
        }
        false
    }
}

/// The indices in a range, from its middle outward: in the middle, two paths between the same ends differ most.
fn from_the_middle(range: Range<usize>) -> impl Iterator<Item = usize> {
    let n = range.len();
    let at =
        move |k: usize| range.start + if k.is_multiple_of(2) { n / 2 + k / 2 } else { n / 2 - k.div_ceil(2) };
    (0..n).map(at)
}

/// Whether a position is within a distance of a line.
fn is_near(line: &[Point], at: Point, far_m: f64) -> bool {
    let is_near = |pair: &[Point]| {
        let (way, offset) = (pair[1] - pair[0], at - pair[0]);
        let share = (offset.dot(&way) / way.norm_squared().max(1e-18)).clamp(0.0, 1.0);
        (offset - way * share).norm_squared() <= far_m * far_m
    };
    line.windows(2).any(is_near)
}
