//! Checks whether scans can come from the scanner in the tank as drawn.

use crate::{
    Shown, Trouble,
    pairs::{Pairs, Way},
    rays::Rays,
    uncertain::Uncertain,
};
use geometry::{Boundary, Vector};
use nalgebra::UnitComplex;
use std::f64::consts::PI;
use world::{ObstacleMap, scan::LONGEST_M};

/// The ways in which a scan is taken: as it is, mirrored, and rotated by half a turn.
const WAYS: usize = 3;
/// Number of rays that are compared with the drawing.
const RAYS: usize = 36;
/// Every scan is compared until this number of comparisons has been made; after that, every `LATER`th scan is compared.
const AT_ONCE: u32 = 5;
const LATER: u32 = 5;
/// Number of comparisons before the first verdict.
const LEAST: u32 = 4;
/// Minimum number of rays that must meet something on the drawing for a comparison to count.
const LEAST_RAYS: usize = 9;
/// Weight of a new comparison in the running mean.
const SMOOTHING: f64 = 0.3;
/// Distance, metres, by which a ray may miss the drawing in addition to the errors of pose and distance.
const ROOM_M: f64 = 0.1;
/// Standard deviation of the position, metres, above which a comparison shows nothing.
const LOST_M: f64 = 0.3;
/// Limits of the share of the rays that fit the drawing: below `WRONG`, the scan does not fit; above `RIGHT`, it fits;
/// below `NOTHING`, hardly any ray fits.
const WRONG: f64 = 0.5;
const RIGHT: f64 = 0.75;
const NOTHING: f64 = 0.2;
/// A mirrored or rotated scan must fit this many times as many rays as the scan as it is.
const MUCH_BETTER: f64 = 1.5;
/// A scan of which less than this share of the usual number of rays fits the drawing puts the next ones in doubt.
const SUDDEN: f64 = 0.5;

/// A running mean of the shares of rays in the comparisons so far.
#[derive(Debug, Clone, Copy, Default)]
struct Share {
    mean: f64,
    compared: u32,
}

impl Share {
    /// Adds a comparison in which `of` rays count, unless they are too few.
    fn add(&mut self, rays: usize, of: usize) {
        if of < LEAST_RAYS {
            return;
        }
        let weight = if self.compared == 0 { 1.0 } else { SMOOTHING };
        self.compared = self.compared.saturating_add(1);
        self.mean += weight * (rays as f64 / of as f64 - self.mean);
    }

    /// The mean, once enough comparisons have been made.
    fn known(&self) -> Option<f64> {
        (self.compared >= LEAST).then_some(self.mean)
    }
}

/// The agreement of the scans with the drawing so far.
#[derive(Debug, Clone, Default)]
pub(crate) struct Agreement {
    scans: u32,
    /// Whether the last comparison was much worse than those before it.
    is_doubtful: bool,
    /// Of the rays that must hit something, the share that have an echo.
    echoes: Share,
    /// For a scan that is taken as it is, mirrored, or rotated by half a turn: of the rays with an echo that must hit
    /// something, the share that fit.
    fits: [Share; WAYS],
    /// For the same, of all rays that must hit something, the share that fit.
    scores: [Share; WAYS],
    /// The agreement with earlier scans.
    pairs: Pairs,
}

/// The counts of one comparison.
#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    must: [usize; WAYS],
    echo: [usize; WAYS],
    fit: [usize; WAYS],
}

impl Agreement {
    /// Compares a scan with the drawing if a comparison is due. `range_m` is the maximum distance that can be measured,
    /// if it is known; otherwise rays without an echo show nothing.
    pub(crate) fn compare(
        &mut self,
        rays: &Rays,
        (boundary, map): (&Boundary, &ObstacleMap),
        pose: &Uncertain,
        range_m: Option<f64>,
    ) {
        self.scans = self.scans.wrapping_add(1);
        let is_due = self.echoes.compared < AT_ONCE || self.is_doubtful || self.scans.is_multiple_of(LATER);
        if pose.point_m2(0.0).sqrt() > LOST_M {
            return;
        }
        self.pairs.compare(rays, pose, range_m);
        if !is_due {
            return;
        }
        let count = |least: usize| counts(rays, (boundary, map), pose, range_m, (rays.len() / least).max(1));
        let mut counts = count(RAYS);
        // In an open place few rays hit something; all of them decide until the scans are known to be right.
        let is_sure = self.echoes.known().is_some() && self.trouble().is_none();
        if counts.must[0] < LEAST_RAYS && !is_sure {
            counts = count(rays.len());
        }
        let now = counts.fit[0] as f64 / counts.must[0].max(1) as f64;
        let usual = self.scores[0].known().filter(|_| counts.must[0] >= LEAST_RAYS);
        self.is_doubtful = usual.is_some_and(|usual| now < SUDDEN * usual);
        self.echoes.add(counts.echo[0], counts.must[0]);
        for way in 0..WAYS {
            self.fits[way].add(counts.fit[way], counts.echo[way]);
            self.scores[way].add(counts.fit[way], counts.must[way]);
        }
    }

    /// Whether scans have been compared, but not often enough for a verdict.
    pub(crate) fn is_open(&self) -> bool {
        self.echoes.compared > 0 && self.echoes.known().is_none()
    }

    /// Whether the scans have just become much worse, so that the next comparisons decide whether they can be right.
    pub(crate) fn is_doubtful(&self) -> bool {
        self.is_doubtful
    }

    /// The reason why the scans cannot be right; `None` if they can.
    pub(crate) fn trouble(&self) -> Option<Trouble> {
        let [straight, mirrored, turned] = self.fits.map(|share| share.known());
        let scores = self.scores.map(|share| share.known());
        // A wrong scan may have few echoes where they must be, and those may fit by chance.
        let is_better = |(other, as_it_is): (f64, f64)| as_it_is < WRONG && other > MUCH_BETTER * as_it_is;
        let fits = |way: usize, fit| fit > Some(RIGHT) && scores[way].zip(scores[0]).is_some_and(is_better);
        // Where most of the wall is hidden by objects that are not drawn, a wrong way may fit by chance.
        let is_possible = |way: Way| !self.pairs.rule_out(way);
        if fits(1, mirrored) && mirrored >= turned && is_possible(Way::Mirrored) {
            return Some(Trouble::Mirrored { by: Shown::Drawing });
        }
        if fits(2, turned) && is_possible(Way::Backwards) {
            return Some(Trouble::Backwards { by: Shown::Drawing });
        }
        match self.pairs.wrong() {
            Some(Way::Mirrored) => return Some(Trouble::Mirrored { by: Shown::Motion }),
            Some(Way::Backwards) => return Some(Trouble::Backwards { by: Shown::Motion }),
            Some(Way::AsItIs) | None => {}
        }
        if let Some(share) = self.echoes.known().filter(|share| *share < NOTHING) {
            return Some(Trouble::NoEcho { share });
        }
        straight.filter(|share| *share < NOTHING).map(|share| Trouble::Misfit { share })
    }
}

/// Compares every `step`th ray with the drawing.
fn counts(
    rays: &Rays,
    (boundary, map): (&Boundary, &ObstacleMap),
    pose: &Uncertain,
    range_m: Option<f64>,
    step: usize,
) -> Counts {
    let ahead = rays.frame().rotation;
    let expected_m = |direction: Vector| {
        let most_m = range_m.unwrap_or(LONGEST_M);
        let wall_m = boundary.ray_m(rays.eye(), direction);
        let hit_m = map.ray_m(rays.eye(), direction, most_m).unwrap_or(f64::INFINITY).min(wall_m);
        Some(hit_m).filter(|hit_m| *hit_m < 0.9 * most_m)
    };
    let mut counts = Counts::default();
    for ray in (0..rays.len()).step_by(step) {
        let (measured_m, direction) = (rays.range_m[ray], rays.direction(ray));
        // An echo from too near is an echo, too, but does not fit.
        let has_echo = measured_m < f64::INFINITY;
        if !has_echo && range_m.is_none() {
            continue;
        }
        let in_robot = ahead.inverse() * direction;
        let mirrored = ahead * Vector::new(in_robot.x, -in_robot.y);
        for (way, direction) in
            [direction, mirrored, UnitComplex::new(PI) * direction].into_iter().enumerate()
        {
            let Some(expected_m) = expected_m(direction) else { continue };
            counts.must[way] += 1;
            if has_echo {
                let room_m = ROOM_M + pose.gate_m(expected_m) + 0.05 * expected_m;
                counts.echo[way] += 1;
                counts.fit[way] += usize::from((measured_m - expected_m).abs() <= room_m);
            }
        }
    }
    counts
}
