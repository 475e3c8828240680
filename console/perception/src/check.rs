//! Checks whether scans can come from the scanner in the tank as drawn.

use crate::{rays::Rays, uncertain::Uncertain};
use geometry::{Boundary, Vector};
use nalgebra::UnitComplex;
use std::f64::consts::PI;
use world::{ObstacleMap, scan::LONGEST_M};

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
    /// Of the rays that must hit something, the share that have an echo.
    echoes: Share,
    /// Share of the rays that fit if the scan is taken as it is, mirrored, or rotated by half a turn.
    fits: [Share; 3],
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
        let is_due = self.echoes.compared < AT_ONCE || self.scans.is_multiple_of(LATER);
        if !is_due || pose.point_m2(0.0).sqrt() > LOST_M {
            return;
        }
        let ahead = rays.frame().rotation;
        let expected_m = |direction: Vector| {
            let most_m = range_m.unwrap_or(LONGEST_M);
            let wall_m = boundary.ray_m(rays.eye(), direction);
            let hit_m = map.ray_m(rays.eye(), direction, most_m).unwrap_or(f64::INFINITY).min(wall_m);
            Some(hit_m).filter(|hit_m| *hit_m < 0.9 * most_m)
        };
        let step = (rays.len() / RAYS).max(1);
        let (mut must, mut echo, mut fits, mut of) = (0_usize, 0_usize, [0_usize; 3], [0_usize; 3]);
        for ray in (0..rays.len()).step_by(step) {
            let (measured_m, direction) = (rays.range_m[ray], rays.direction(ray));
            let in_robot = ahead.inverse() * direction;
            let mirrored = ahead * Vector::new(in_robot.x, -in_robot.y);
            let wanted = [direction, mirrored, UnitComplex::new(PI) * direction];
            // An echo from too near is an echo, too, but does not fit.
            let has_echo = measured_m < f64::INFINITY;
            // Only the scan as it is shows whether a ray without an echo must have one.
            let ways = match (has_echo, range_m) {
                (true, _) => 3,
                (false, Some(_)) => 1,
                (false, None) => 0,
            };
            for (way, direction) in wanted.into_iter().take(ways).enumerate() {
                let Some(expected_m) = expected_m(direction) else { continue };
                if way == 0 {
                    must += 1;
                    echo += usize::from(has_echo);
                }
                if has_echo {
                    of[way] += 1;
                    let room_m = ROOM_M + pose.gate_m(expected_m) + 0.05 * expected_m;
                    fits[way] += usize::from((measured_m - expected_m).abs() <= room_m);
                }
            }
        }
        self.echoes.add(echo, must);
        for (way, share) in self.fits.iter_mut().enumerate() {
            share.add(fits[way], of[way]);
        }
    }

    /// Whether scans have been compared, but not often enough for a verdict.
    pub(crate) fn is_open(&self) -> bool {
        self.echoes.compared > 0 && self.echoes.known().is_none()
    }

    /// The reason why the scans cannot be right, as a clause; `None` if they can.
    pub(crate) fn trouble(&self) -> Option<String> {
        let percent = |share: f64| (100.0 * share).round();
        if let Some(echoes) = self.echoes.known().filter(|echoes| *echoes < NOTHING) {
            let share = percent(echoes);
            return Some(format!(
                "only {share} % of the rays that must hit the wall or a column have an echo; check the scanner"
            ));
        }
        let only_if = |how: &str, check: &str| {
            Some(format!("the scan fits the drawing only if it is {how}; check {check}"))
        };
        let [straight, mirrored, turned] = self.fits.map(|share| share.known());
        let straight = straight?;
        let (is_mirrored, is_turned) = (mirrored > Some(RIGHT), turned > Some(RIGHT));
        if straight < WRONG && is_mirrored && mirrored >= turned {
            return only_if("mirrored", "the direction of its angles");
        }
        if straight < WRONG && is_turned {
            return only_if("rotated by half a turn", "how the scanner is mounted");
        }
        (straight < NOTHING).then(|| {
            let share = percent(straight);
            format!(
                "only {share} % of the scan fits the drawing; check the scanner, the position and the drawing"
            )
        })
    }
}
