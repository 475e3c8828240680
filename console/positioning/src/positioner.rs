//! Maintains the position estimate of a mission: odometry every tick, ranges every cycle.

mod config;

pub use config::PositionerConfig;

use crate::{
    calibration::{Calibration, MOST_SCALE, Unknowns},
    differences::common_excess_m,
    ekf::Ekf,
    fix::{Exclusion, Fix, FixError, Integrity, Prior, Ranging, ellipse_95},
    possible::{Impossible, Possible},
    protection,
    pulses::PulseTest,
    session::{CommonError, shift_by},
    session_calibration::Estimated,
    sides::{Sides, both, is_behind},
    solver_kind::SolverKind,
    station_clocks::StationClocks,
};
use nalgebra::{Matrix2, Matrix3};
use world::{Odometry, Point, Pose, RangeSet, Station, StationId};

/// The number of consecutive fixes, each consistent in itself, that must contradict the filter to prove it wrong.
const PATIENCE: u32 = 3;
/// Standard deviation of the prior that chooses between a position and its mirror image, metres.
const MIRROR_SIGMA_M: f64 = 0.01;
/// The largest magnitude shown for an impossible range, metres.
const MOST_SHOWN_M: f64 = 1e9;

/// Returns a range for display: always a finite number within bounds.
fn shown_m(range_m: f64) -> f64 {
    if range_m.is_nan() { -MOST_SHOWN_M } else { range_m.clamp(-MOST_SHOWN_M, MOST_SHOWN_M) }
}
/// Standard deviation that is added to the heading after the filter has been proved wrong, radians.
const RESTART_HEADING_SIGMA_RAD: f64 = 0.3;

/// Reasons to trust ranges less than their noise suggests: fixes become suspect and less certain.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Doubt {
    /// A suspected error of all ranges, as a share of the distance.
    pub ratio: f64,
    /// Likely errors of all ranges, as standard deviations. They make fixes less certain, but not suspect.
    pub likely_errors: [CommonError; 2],
    /// Likely error of a position in any direction, metres, as a standard deviation. It makes fixes less certain, but
    /// not suspect.
    pub likely_m: f64,
    /// A suspected error of all ranges, metres.
    pub sigma_m: f64,
    /// Whether fixes are suspect even if the size of the error is unknown.
    pub is_suspect: bool,
}

impl Doubt {
    fn is_any(&self) -> bool {
        self.is_suspect || self.ratio > 0.0 || self.sigma_m > 0.0
    }

    /// Returns both doubts together; they are independent of each other.
    #[must_use]
    pub fn beside(self, other: Self) -> Self {
        let likely = |doubt: Self| {
            let sizes = doubt.likely_errors.map(|error| match error {
                CommonError::Share(share) => [share, 0.0],
                CommonError::Length(length_m) => [0.0, length_m],
            });
            [sizes[0][0].hypot(sizes[1][0]), sizes[0][1].hypot(sizes[1][1])]
        };
        let ([share, length_m], [other_share, other_length_m]) = (likely(self), likely(other));
        Self {
            ratio: self.ratio.hypot(other.ratio),
            likely_errors: [
                CommonError::Share(share.hypot(other_share)),
                CommonError::Length(length_m.hypot(other_length_m)),
            ],
            likely_m: self.likely_m.hypot(other.likely_m),
            sigma_m: self.sigma_m.hypot(other.sigma_m),
            is_suspect: self.is_suspect || other.is_suspect,
        }
    }
}

/// The estimated pose of the robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Most likely pose.
    pub pose: Pose,
    /// Covariance of x, y (square metres) and heading (square radians).
    pub covariance: Matrix3<f64>,
}

/// How well fixes and measured motion agree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Agreement {
    /// The number of fixes that passed the test of their own ranges.
    pub sound: u64,
    /// The number of those fixes that contradict the motion since the previous fixes.
    pub contradicting: u64,
}

/// The results of a ranging cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleResult {
    /// One range per station heard; empty if any range was invalid.
    pub rangings: Vec<Ranging>,
    /// The fix of this cycle alone.
    pub fix: Result<Fix, FixError>,
    /// Whether the estimate accepted the fix, or the single ranges if there is no fix.
    pub accepted: bool,
    /// The impossible ranges, which were left out.
    pub impossible: Vec<Impossible>,
    /// The criterion that decides between the fix and its mirror image.
    pub sides: Sides,
}

/// Turns ranges and odometry into a pose with covariance.
#[derive(Debug, Clone)]
pub struct Positioner {
    config: PositionerConfig,
    /// The bounds of possible ranges in the tank, if its wall is known.
    possible: Option<Possible>,
    filter: Ekf,
    sound: Calibration,
    /// The clocks of the stations; `None` if they share one clock.
    clocks: Option<StationClocks>,
    doubt: Doubt,
    /// Whether some motion was not measured, so that the heading may be lost.
    has_wandered: bool,
    /// Whether any fix has confirmed the start.
    is_confirmed: bool,
    /// Whether it is known on which side of stations on a line the estimate lies.
    knows_side: bool,
    refused_in_a_row: u32,
    /// The first fix in an unbroken series of refused fixes, and the filter's pose at that time.
    first_refused: Option<(Fix, Pose)>,
    agreement: Agreement,
    /// Covariance of the error that all fixes share, square metres; averaging over fixes does not reduce it.
    common: Matrix2<f64>,
}

impl Positioner {
    /// Creates a positioner at the surveyed start.
    pub fn new(config: PositionerConfig) -> Self {
        let filter = Ekf::new(config.start, config.start_sigma_m, config.heading_sigma_rad, config.odometry);
        let sound = Calibration::new(&config.stations, Unknowns::default());
        let clocks = config.clocks.map(|clocks| {
            StationClocks::new(clocks, &config.stations, config.start.position, config.start_sigma_m)
        });
        let too_long_ratio = if config.calibrate_sound_speed { MOST_SCALE } else { 0.0 };
        let noise = (&config.noise, config.timing);
        let possible =
            config.boundary.as_ref().map(|wall| Possible::new(wall, &config.stations, noise, too_long_ratio));
        Self {
            config,
            possible,
            filter,
            sound,
            clocks,
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
        let before = self.filter.pose().position;
        if self.has_wandered {
            self.filter.predict_unsure(odometry);
        } else {
            self.filter.predict(odometry);
        }
        if let Some(clocks) = &mut self.clocks {
            let moved = self.filter.pose().position - before;
            let heading_sigma_rad = self.filter.covariance()[(2, 2)].max(0.0).sqrt();
            let share = self.config.odometry.sigma_per_m.hypot(heading_sigma_rad);
            clocks.predict(moved, odometry.forward_m.hypot(odometry.sideways_m) * share);
        }
    }

    /// Widens the pose for an unmeasured motion; see [`Ekf::wander`].
    pub fn wander(&mut self, most_m: f64, most_rad: f64) {
        self.filter.wander(most_m, most_rad);
        self.clocks.iter_mut().for_each(|clocks| clocks.wander(most_m));
        self.has_wandered = true;
    }

    /// Corrects the estimate with a pose that another sensor has measured, and its covariance (square metres and square
    /// radians); returns whether the pose agrees with the estimate. A pose that does not is not used.
    pub fn take_pose(&mut self, pose: &Pose, covariance: &Matrix3<f64>) -> bool {
        self.filter.update_pose(pose, covariance).accepted
    }

    /// Takes the clocks of the stations from a pulse test; changes nothing if the stations share one clock.
    pub fn take_pulses(&mut self, test: &PulseTest) {
        self.clocks.iter_mut().for_each(|clocks| clocks.take_pulses(test));
    }

    /// Processes a ranging cycle: computes a fix from the ranges, and updates the estimate with it unless its
    /// residuals raise an alarm.
    ///
    /// One or two stations give no unambiguous fix by themselves: with two, the estimate chooses between the mirror
    /// images; with one, the range itself updates the estimate.
    pub fn cycle(&mut self, sets: &[RangeSet]) -> CycleResult {
        let (sets, impossible) = match &self.possible {
            Some(possible) if self.are_distances() => possible.ranges(sets),
            Some(possible) => possible.differences(sets, &self.clocks_m()),
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
            // A cycle without a position contributes nothing; the fix states the reason.
            let _ = self.sound.take(&rangings, Some(prior));
            rangings = self.sound.corrected(&rangings);
        }
        if let Some(clocks) = &mut self.clocks {
            clocks.take(&rangings);
            rangings = clocks.corrected(&rangings);
        }
        self.widen(&mut rangings);
        result.fix = self.solve(&rangings, &result.impossible);
        if let Ok(fix) = &mut result.fix {
            self.common = self.in_common(fix);
            self.allow_for_likely(fix);
            if let Some(clocks) = &self.clocks {
                let by_clocks = clocks.spread(fix);
                self.common += by_clocks;
                fix.covariance += by_clocks;
            }
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
        if let (Some(risk), Ok(fix)) = (&self.config.risk, &mut result.fix) {
            // A wrong station may have spoilt the clocks of the others, which one fix alone does not show: then only
            // the pose has a level (see `Guard`).
            fix.protection_level_m = if self.clocks.is_some() {
                None
            } else {
                protection::level_m(fix, &self.config.stations, risk, !self.are_distances())
            };
        }
        CycleResult { rangings, ..result }
    }

    /// The estimated offsets of the stations' clocks at present, metres; empty if the stations share one clock.
    fn clocks_m(&self) -> Vec<(StationId, Estimated)> {
        self.clocks.as_ref().map(StationClocks::present_offsets_m).unwrap_or_default()
    }

    /// Returns the mean length by which ranges exceed the distances from the estimated position, metres; 0 if the
    /// ranges themselves are distances.
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

    /// Widens ranges by their possible common errors.
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

    /// Returns the part of a fix's error that later fixes share, as a covariance, square metres: errors of the scale,
    /// and errors of all ranges.
    fn in_common(&self, fix: &Fix) -> Matrix2<f64> {
        let Doubt { ratio, likely_errors, likely_m, sigma_m, .. } = self.doubt;
        let share = CommonError::Share(self.config.scale_sigma_ratio.hypot(ratio));
        let everywhere = Matrix2::identity() * (likely_m.powi(2) + sigma_m.powi(2));
        everywhere + self.spread_by(&[share], fix) + self.spread_by(&likely_errors, fix)
    }

    /// Returns the contribution of common range errors, given as standard deviations, to the covariance of a fix,
    /// square metres.
    fn spread_by(&self, errors: &[CommonError], fix: &Fix) -> Matrix2<f64> {
        let is_emission_free = self.config.solver == SolverKind::Differences;
        let present = errors.iter().filter(|error| error.size() > 0.0);
        let shifts =
            present.filter_map(|error| shift_by(*error, fix, &self.config.stations, is_emission_free));
        shifts.map(|shift| shift * shift.transpose()).sum()
    }

    /// Widens a fix by the likely errors: along the directions in which common range errors would move it, and
    /// equally in every direction.
    fn allow_for_likely(&self, fix: &mut Fix) {
        let Doubt { likely_errors, likely_m, .. } = self.doubt;
        fix.covariance += self.spread_by(&likely_errors, fix);
        fix.covariance += Matrix2::identity() * likely_m.powi(2);
    }

    /// The clocks of the stations; `None` if they share one clock.
    pub fn clocks(&self) -> Option<&StationClocks> {
        self.clocks.as_ref()
    }

    /// Returns how well fixes and measured motion have agreed so far; only fixes without other doubts count.
    pub fn agreement(&self) -> Agreement {
        self.agreement
    }

    /// Reduces the trust in the ranges of the following cycles.
    pub fn doubt(&mut self, doubt: Doubt) {
        self.doubt = doubt;
    }

    /// Returns the estimated pose of the robot.
    pub fn estimate(&self) -> Estimate {
        let mut covariance = self.filter.covariance();
        let mut position = covariance.fixed_view_mut::<2, 2>(0, 0);
        position += self.common;
        Estimate { pose: self.filter.pose(), covariance }
    }

    /// Longer semi-axis of the 95 % ellipse of the position, metres.
    pub fn error_95_m(&self) -> f64 {
        ellipse_95(&self.position_covariance()).0
    }

    /// Returns the covariance of the position, including the errors that all fixes share, square metres.
    pub(crate) fn position_covariance(&self) -> Matrix2<f64> {
        self.filter.position_covariance() + self.common
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

    /// Returns the criterion that decides between a fix and its mirror image. If nothing decides, the fix becomes
    /// suspect.
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

    /// Whether single ranges are distances; if not, only their differences contain information.
    fn are_distances(&self) -> bool {
        self.config.solver != SolverKind::Differences
    }

    /// Passes a fix to the filter; a fix that contradicts the filter becomes suspect.
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
        // Only a fix that passed the test of its own ranges counts as evidence against the filter.
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

    /// Processes a fix on an unknown side of the stations. If the estimate keeps contradicting both sides, or is less
    /// accurate than an estimate that covers both sides, it is replaced with such an estimate.
    ///
    /// Nothing is merged, because two such fixes together do not determine the side any better than one.
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

    /// Returns the heading error while fixes were refused, with its standard deviation, radians: the angle between
    /// the line from fix to fix and the line that odometry gives. `None` if their lengths differ, because the robot
    /// slipped or was carried, or if they are too short.
    fn turned(&self, (first, then): &(Fix, Pose), last: &Fix) -> Option<(f64, f64)> {
        let by_fixes = last.position - first.position;
        let by_odometry = self.filter.pose().position - then.position;
        let sigma_m = (first.covariance + last.covariance).trace().sqrt();
        let (way_m, off_m) = (by_odometry.norm(), (by_fixes.norm() - by_odometry.norm()).abs());
        let sigma_rad = sigma_m / way_m;
        let is_known = sigma_rad < RESTART_HEADING_SIGMA_RAD && off_m < 3.0 * sigma_m;
        is_known.then(|| (by_odometry.perp(&by_fixes).atan2(by_odometry.dot(&by_fixes)), sigma_rad))
    }

    /// Corrects the filter with the fix or with its ranges, whichever suits the geometry.
    ///
    /// Close to a station, the error of a fix is curved like the range circle and does not form an ellipse. A filter
    /// that is more accurate than the fix therefore takes the ranges instead, linearised at its own position.
    fn filter_accepts(&mut self, fix: &Fix, rangings: &[Ranging]) -> bool {
        if self.are_distances() && self.filter.error_95_m() < fix.ellipse_95().0 {
            let used: Vec<Ranging> =
                rangings.iter().filter(|r| fix.used.contains(&r.station)).copied().collect();
            self.take_ranges(&used)
        } else {
            self.filter.update_position(fix.position, &fix.covariance).accepted
        }
    }

    /// Corrects the filter with all single ranges or with none; returns whether it accepted them.
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

/// Subtracts the excess length that the solver found for all ranges.
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
