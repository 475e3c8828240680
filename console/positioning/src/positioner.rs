//! The estimate that a mission keeps: odometry every tick, ranges every cycle.

mod config;

pub use config::PositionerConfig;

use crate::{
    calibration::{Calibration, MOST_SCALE, Unknowns},
    differences::common_excess_m,
    ekf::Ekf,
    fix::{Exclusion, Fix, FixError, Integrity, Prior, Ranging, ellipse_95},
    possible::{Impossible, Possible},
    session::{CommonError, shift_by},
    sides::{Sides, both, is_behind},
    solver_kind::SolverKind,
};
use nalgebra::{Matrix2, Matrix3};
use world::{Odometry, Point, Pose, RangeSet, Station, StationId};

/// So many sound fixes in a row that contradict the filter prove the filter wrong.
const PATIENCE: u32 = 3;
/// Standard deviation of a position that is to be preferred to its mirror image, metres.
const MIRROR_SIGMA_M: f64 = 0.01;
/// A range that cannot be is shown up to this length, metres.
const MOST_SHOWN_M: f64 = 1e9;

/// A range as it is shown: always a number within bounds.
fn shown_m(range_m: f64) -> f64 {
    if range_m.is_nan() { -MOST_SHOWN_M } else { range_m.clamp(-MOST_SHOWN_M, MOST_SHOWN_M) }
}
/// Doubt about the heading after the filter was proved wrong, radians.
const RESTART_HEADING_SIGMA_RAD: f64 = 0.3;

/// Why ranges are trusted less than their noise says: fixes of them are suspect, and wider.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Doubt {
    /// What may be wrong with all ranges, as a share of the distance.
    pub ratio: f64,
    /// What all ranges are likely to be wrong by, as a standard deviation: fixes are wider, but not suspect.
    pub likely_errors: [CommonError; 2],
    /// By how much a position is likely to be off in any direction, metres, as a standard deviation: fixes are wider, but not suspect.
    pub likely_m: f64,
    /// What may be wrong with all ranges, metres.
    pub sigma_m: f64,
    /// Whether fixes are suspect even if nothing is known about how wrong they are.
    pub is_suspect: bool,
}

impl Doubt {
    fn is_any(&self) -> bool {
        self.is_suspect || self.ratio > 0.0 || self.sigma_m > 0.0
    }
}

/// Where the robot is believed to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Most likely pose.
    pub pose: Pose,
    /// Covariance of x, y (square metres) and heading (square radians).
    pub covariance: Matrix3<f64>,
}

/// How far fixes and measured motion agree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Agreement {
    /// Fixes that can be tested and passed.
    pub sound: u64,
    /// Those among them that contradict where motion has brought the robot since the ones before.
    pub contradicting: u64,
}

/// What a ranging cycle brought.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleResult {
    /// One range per station heard; empty if one of the ranges was not valid.
    pub rangings: Vec<Ranging>,
    /// The fix of this cycle alone.
    pub fix: Result<Fix, FixError>,
    /// Whether the fix, or what single ranges there were, went into the estimate.
    pub accepted: bool,
    /// Ranges that cannot be, which were left out.
    pub impossible: Vec<Impossible>,
    /// What decides between the fix and its mirror image.
    pub sides: Sides,
}

/// Ranges and odometry in, pose with covariance out.
#[derive(Debug, Clone)]
pub struct Positioner {
    config: PositionerConfig,
    /// What ranges can be in the tank, if its wall is known.
    possible: Option<Possible>,
    filter: Ekf,
    sound: Calibration,
    doubt: Doubt,
    /// Whether some motion was not measured, so that the heading may be lost.
    has_wandered: bool,
    /// Whether any fix has confirmed where the robot was put down,
    is_confirmed: bool,
    /// and whether the estimate knows the side of stations on a line.
    knows_side: bool,
    refused_in_a_row: u32,
    /// The first of the refused fixes in a row, and where the filter was then.
    first_refused: Option<(Fix, Pose)>,
    agreement: Agreement,
    /// Covariance of the error that all fixes share, square metres; averaging over fixes does not reduce it.
    common: Matrix2<f64>,
}

impl Positioner {
    /// A positioner at the surveyed start.
    pub fn new(config: PositionerConfig) -> Self {
        let filter = Ekf::new(config.start, config.start_sigma_m, config.heading_sigma_rad, config.odometry);
        let sound = Calibration::new(&config.stations, Unknowns::default());
        let too_long_ratio = if config.calibrate_sound_speed { MOST_SCALE } else { 0.0 };
        let noise = (&config.noise, config.timing);
        let possible =
            config.boundary.as_ref().map(|wall| Possible::new(wall, &config.stations, noise, too_long_ratio));
        Self {
            config,
            possible,
            filter,
            sound,
            doubt: Doubt::default(),
            has_wandered: false,
            is_confirmed: false,
            knows_side: true,
            refused_in_a_row: 0,
            first_refused: None,
            agreement: Agreement::default(),
            common: Matrix2::zeros(),
        }
    }

    /// Moves the estimate by one tick of odometry.
    pub fn predict(&mut self, odometry: &Odometry) {
        if self.has_wandered {
            self.filter.predict_unsure(odometry);
        } else {
            self.filter.predict(odometry);
        }
    }

    /// Makes the pose less known by a motion that nothing measured; see [`Ekf::wander`].
    pub fn wander(&mut self, most_m: f64, most_rad: f64) {
        self.filter.wander(most_m, most_rad);
        self.has_wandered = true;
    }

    /// Takes in a ranging cycle: ranges to a fix, the fix into the estimate unless its residuals raise an alarm.
    ///
    /// With one or two stations there is no fix to be had without help: with two the estimate chooses the mirror, with
    /// one the range itself goes into the estimate.
    pub fn cycle(&mut self, sets: &[RangeSet]) -> CycleResult {
        let (sets, impossible) = match &self.possible {
            Some(possible) if self.are_distances() => possible.ranges(sets),
            Some(possible) => possible.differences(sets),
            None => (sets.into(), Vec::new()),
        };
        let mut result = CycleResult {
            rangings: Vec::new(),
            fix: Err(FixError::TooFewStations { have: 0, need: 2 }),
            accepted: false,
            impossible,
            sides: Sides::One,
        };
        let mut rangings = match self.config.aggregation.aggregate(&sets, &self.config.noise) {
            Ok(rangings) => rangings,
            Err(error) => return CycleResult { fix: Err(error), ..result },
        };
        let excess_m = self.excess_m(&rangings);
        self.config.timing.apply(&mut rangings, &self.config.noise, excess_m);
        if self.config.calibrate_sound_speed {
            let prior = (self.filter.pose().position, self.filter.position_covariance());
            // A cycle without a position contributes nothing; the fix states why there is none.
            let _ = self.sound.take(&rangings, Some(prior));
            rangings = self.sound.corrected(&rangings);
        }
        self.widen(&mut rangings);
        result.fix = self.solve(&rangings, &result.impossible);
        if let Ok(fix) = &mut result.fix {
            self.common = self.in_common(fix);
            self.allow_for_likely(fix);
        }
        if let (SolverKind::Differences, Ok(fix)) = (self.config.solver, &result.fix) {
            take_excess_out(fix, &mut rangings, &self.config.stations);
        }
        result.accepted = match &mut result.fix {
            Ok(fix) => {
                result.sides = self.sides(fix);
                self.take_fix(fix, &rangings, result.sides)
            }
            Err(FixError::TooFewStations { .. }) if self.are_distances() => self.take_ranges(&rangings),
            Err(_) => false,
        };
        if let (true, Ok(fix)) = (self.doubt.is_any(), &mut result.fix) {
            fix.integrity = fix.integrity.min_trust(Integrity::Suspect);
        }
        CycleResult { rangings, ..result }
    }

    /// By how much ranges are longer than the distances from where the robot is believed to be, on average; 0 where they are
    /// distances.
    fn excess_m(&self, rangings: &[Ranging]) -> f64 {
        if self.config.solver != SolverKind::Differences || rangings.is_empty() {
            return 0.0;
        }
        let here = self.filter.pose().position;
        let distance_m = |id| {
            let station = self.config.stations.iter().find(|station| station.id == id);
            station.map_or(0.0, |station| (here - station.position).norm())
        };
        let too_long = rangings.iter().map(|r| r.range_m - distance_m(r.station)).sum::<f64>();
        too_long / rangings.len() as f64
    }

    /// Widens ranges by what they may all be wrong by.
    fn widen(&self, rangings: &mut [Ranging]) {
        let Doubt { ratio, sigma_m, .. } = self.doubt;
        let share = self.config.scale_sigma_ratio.hypot(ratio);
        if share > 0.0 || sigma_m > 0.0 {
            for ranging in rangings {
                ranging.sigma_m = ranging.sigma_m.hypot(share * ranging.range_m).hypot(sigma_m);
                ranging.timing_sigma_m = ranging.timing_sigma_m.hypot(sigma_m);
            }
        }
    }

    /// The part of the error of a fix that it has in common with the fixes after it, as a covariance, square metres: what is wrong
    /// with the scale of all ranges, and with all of them.
    fn in_common(&self, fix: &Fix) -> Matrix2<f64> {
        let Doubt { ratio, likely_errors, likely_m, sigma_m, .. } = self.doubt;
        let share = CommonError::Share(self.config.scale_sigma_ratio.hypot(ratio));
        let everywhere = Matrix2::identity() * (likely_m.powi(2) + sigma_m.powi(2));
        everywhere + self.spread_by(&[share], fix) + self.spread_by(&likely_errors, fix)
    }

    /// What errors of all ranges, as standard deviations, add to the covariance of a fix, square metres.
    fn spread_by(&self, errors: &[CommonError], fix: &Fix) -> Matrix2<f64> {
        let is_emission_free = self.config.solver == SolverKind::Differences;
        let present = errors.iter().filter(|error| error.size() > 0.0);
        let shifts =
            present.filter_map(|error| shift_by(*error, fix, &self.config.stations, is_emission_free));
        shifts.map(|shift| shift * shift.transpose()).sum()
    }

    /// Widens a fix by what is likely: along the lines on which it moves with the likely errors of all ranges, and in every direction.
    fn allow_for_likely(&self, fix: &mut Fix) {
        let Doubt { likely_errors, likely_m, .. } = self.doubt;
        fix.covariance += self.spread_by(&likely_errors, fix);
        fix.covariance += Matrix2::identity() * likely_m.powi(2);
    }

    /// How far fixes and measured motion agreed so far; of fixes that are not in doubt for another reason.
    pub fn agreement(&self) -> Agreement {
        self.agreement
    }

    /// Trusts the ranges of the next cycles less.
    pub fn doubt(&mut self, doubt: Doubt) {
        self.doubt = doubt;
    }

    /// Where the robot is believed to be.
    pub fn estimate(&self) -> Estimate {
        let mut covariance = self.filter.covariance();
        let mut position = covariance.fixed_view_mut::<2, 2>(0, 0);
        position += self.common;
        Estimate { pose: self.filter.pose(), covariance }
    }

    /// Longer half axis of the 95 % ellipse of the position, metres.
    pub fn error_95_m(&self) -> f64 {
        ellipse_95(&(self.filter.position_covariance() + self.common)).0
    }

    fn prior(&self) -> Prior {
        (self.filter.pose().position, self.filter.position_covariance())
    }

    fn solve(&self, rangings: &[Ranging], impossible: &[Impossible]) -> Result<Fix, FixError> {
        let config = &self.config;
        let solved = |prior| config.solver.solve(rangings, &config.stations, &config.noise, Some(prior));
        let mut fix = solved(self.prior())?;
        if let Some(boundary) = &config.boundary {
            if let Some(other) = fix.mirror.filter(|_| is_behind(boundary, fix.position, &fix.covariance)) {
                fix = solved((other, Matrix2::identity() * MIRROR_SIGMA_M.powi(2)))?;
            }
            fix.check_inside(boundary)?;
        }
        let silent = config.stations.iter().map(|s| s.id).filter(|id| !is_heard(*id, rangings));
        let why = |id| {
            let found = impossible.iter().find(|range| range.station == id);
            found.map_or(Exclusion::Silent, |range| Exclusion::Impossible {
                range_m: shown_m(range.range_m),
                most_m: range.most_m,
            })
        };
        fix.excluded.extend(silent.map(|id| (id, why(id))));
        fix.excluded.sort_by_key(|(id, _)| *id);
        Ok(fix)
    }

    /// What decides between a fix and its mirror image; a fix of which that is open is suspect.
    fn sides(&self, fix: &mut Fix) -> Sides {
        if !matches!(fix.integrity, Integrity::Ok | Integrity::Untestable) {
            return Sides::One;
        }
        let prior = self.knows_side.then(|| self.prior());
        let sides = Sides::of(fix, self.config.boundary.as_ref(), prior);
        if let Sides::Open { .. } = sides {
            fix.integrity = Integrity::Suspect;
        }
        sides
    }

    /// Whether single ranges are distances; otherwise only all of them together say anything.
    fn are_distances(&self) -> bool {
        self.config.solver != SolverKind::Differences
    }

    /// Hands a fix to the filter; a fix that contradicts the filter is suspect.
    fn take_fix(&mut self, fix: &mut Fix, rangings: &[Ranging], sides: Sides) -> bool {
        if fix.integrity == Integrity::Alarm {
            return false;
        }
        if let Sides::Open { other, contradicts } = sides {
            return self.take_both(fix, other, contradicts);
        }
        let is_sound = fix.integrity == Integrity::Ok;
        let counts = u64::from(is_sound && !self.doubt.is_any());
        self.agreement.sound += counts;
        if self.filter_accepts(fix, rangings) {
            (self.refused_in_a_row, self.first_refused) = (0, None);
            (self.is_confirmed, self.knows_side) = (true, true);
            return true;
        }
        // A fix that can be tested and passed speaks against the filter; others do not.
        self.agreement.contradicting += counts;
        fix.integrity = Integrity::Suspect;
        if !is_sound {
            return false;
        }
        self.refused_in_a_row += 1;
        if self.refused_in_a_row < PATIENCE {
            self.first_refused.get_or_insert_with(|| (fix.clone(), self.filter.pose()));
            return false;
        }
        self.refused_in_a_row = 0;
        let turned = self.first_refused.take().and_then(|first| self.turned(&first, fix));
        let (turn_rad, sigma_rad) = turned.unwrap_or((0.0, RESTART_HEADING_SIGMA_RAD));
        self.filter.restart_at(fix.position, &fix.covariance, turn_rad, sigma_rad);
        true
    }

    /// Takes in a fix of which nobody knows the side: the estimate holds both sides from then on, if it contradicts both or is worse.
    ///
    /// Nothing is merged, because two such fixes together know the side no better than one.
    fn take_both(&mut self, fix: &Fix, other: Point, contradicts: bool) -> bool {
        self.refused_in_a_row = if contradicts { self.refused_in_a_row + 1 } else { 0 };
        let is_disproved = contradicts && (!self.is_confirmed || self.refused_in_a_row >= PATIENCE);
        let (position, covariance) = both(fix, other);
        if !is_disproved && self.filter.error_95_m() < ellipse_95(&covariance).0 {
            return false;
        }
        (self.refused_in_a_row, self.first_refused, self.knows_side) = (0, None, false);
        self.filter.restart_at(position, &covariance, 0.0, RESTART_HEADING_SIGMA_RAD);
        false
    }

    /// By how much the heading was wrong while fixes were refused, radians, with the standard deviation: the angle between the
    /// way from fix to fix and the way that odometry gives. `None` if the two are not of one length, because the robot slipped or
    /// was carried, or too short to say.
    fn turned(&self, (first, then): &(Fix, Pose), last: &Fix) -> Option<(f64, f64)> {
        let by_fixes = last.position - first.position;
        let by_odometry = self.filter.pose().position - then.position;
        let sigma_m = (first.covariance + last.covariance).trace().sqrt();
        let (way_m, off_m) = (by_odometry.norm(), (by_fixes.norm() - by_odometry.norm()).abs());
        let sigma_rad = sigma_m / way_m;
        let is_known = sigma_rad < RESTART_HEADING_SIGMA_RAD && off_m < 3.0 * sigma_m;
        is_known.then(|| (by_odometry.perp(&by_fixes).atan2(by_odometry.dot(&by_fixes)), sigma_rad))
    }

    /// Corrects the filter where the geometry is better known.
    ///
    /// Close to a station the error of a fix is bent like the range circle and no ellipse holds it; a filter that is
    /// surer than the fix takes the ranges instead, as seen from where it believes it is.
    fn filter_accepts(&mut self, fix: &Fix, rangings: &[Ranging]) -> bool {
        if self.are_distances() && self.filter.error_95_m() < fix.ellipse_95().0 {
            let used: Vec<Ranging> =
                rangings.iter().filter(|r| fix.used.contains(&r.station)).copied().collect();
            self.take_ranges(&used)
        } else {
            self.filter.update_position(fix.position, &fix.covariance).accepted
        }
    }

    /// Corrects the filter by single ranges, by all or by none; whether it took them.
    fn take_ranges(&mut self, rangings: &[Ranging]) -> bool {
        let mut filter = self.filter.clone();
        let fits = |ranging: &Ranging| {
            let station = self.config.stations.iter().find(|s| s.id == ranging.station);
            station.is_some_and(|station| {
                let expected_m = (filter.pose().position - station.position).norm();
                let sigma_m = ranging.sigma_at_m(expected_m);
                filter.update_range(station.position, ranging.range_m, sigma_m).accepted
            })
        };
        let is_taken = !rangings.is_empty() && rangings.iter().all(fits);
        if is_taken {
            self.filter = filter;
        }
        is_taken
    }
}

/// Takes out by how much all ranges are too long, as the fix says.
fn take_excess_out(fix: &Fix, rangings: &mut [Ranging], stations: &[Station]) {
    let Some(excess_m) = common_excess_m(fix, rangings, stations) else { return };
    for ranging in rangings {
        let range_m = ranging.range_m - excess_m;
        if ranging.timing_sigma_m > 0.0 {
            ranging.sigma_m = ranging.sigma_at_m(range_m);
        } else {
            ranging.sigma_m *= range_m / ranging.range_m;
        }
        ranging.least_m -= excess_m;
        ranging.most_m -= excess_m;
        ranging.range_m = range_m;
    }
}

fn is_heard(station: StationId, rangings: &[Ranging]) -> bool {
    rangings.iter().any(|r| r.station == station)
}

#[cfg(test)]
mod tests;
