//! The estimate that a mission keeps: odometry every tick, ranges every cycle.

use crate::{
    aggregate::Aggregation,
    bounded::Bounded,
    calibration::{Calibration, Unknowns},
    consensus::Consensus,
    differences::{Differences, common_excess_m},
    ekf::{Ekf, MotionNoise},
    fix::{Exclusion, Fix, FixError, Integrity, PositionSolver, Prior, Ranging},
    linear::LinearLs,
    noise::RangeNoise,
    nonlinear::Nls,
    screened::Screened,
    weighted::WeightedLinear,
};
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use world::{Boundary, Odometry, Pose, RangeSet, Station, StationId};

/// So many sound fixes in a row that contradict the filter prove the filter wrong.
const PATIENCE: u32 = 3;
/// Doubt about the heading after the filter was proved wrong, radians.
const RESTART_HEADING_SIGMA_RAD: f64 = 0.3;

/// Which solver turns ranges into fixes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SolverKind {
    /// [`LinearLs`].
    Linear,
    /// [`WeightedLinear`].
    WeightedLinear,
    /// [`Nls`].
    #[default]
    Nls,
    /// [`Bounded`] by the bound of the noise; [`Nls`] where the noise has none, and, with the fix suspect, where no
    /// position is left.
    Bounded,
    /// [`Consensus`] among late ranges.
    Consensus,
    /// [`Differences`]: all ranges of a cycle are too long by one unknown length.
    Differences,
}

impl SolverKind {
    /// Turns ranges into a fix; a single station that contradicts all others is left out.
    ///
    /// # Errors
    /// See [`FixError`].
    pub fn solve(
        self,
        ranges: &[Ranging],
        stations: &[Station],
        noise: &RangeNoise,
        prior: Option<Prior>,
    ) -> Result<Fix, FixError> {
        match (self, noise.bound_ratio()) {
            (Self::Linear, _) => Screened(LinearLs).solve(ranges, stations, prior),
            (Self::WeightedLinear, _) => Screened(WeightedLinear).solve(ranges, stations, prior),
            (Self::Consensus, _) => Consensus::default().solve(ranges, stations, prior),
            (Self::Differences, _) => Screened(Differences).solve(ranges, stations, prior),
            (Self::Bounded, Some(ratio)) => {
                Bounded { ratio }.solve(ranges, stations, prior).or_else(|error| match error {
                    FixError::EmptySet { .. } => doubted(Screened(Nls).solve(ranges, stations, prior)),
                    other => Err(other),
                })
            }
            (Self::Nls | Self::Bounded, _) => Screened(Nls).solve(ranges, stations, prior),
        }
    }
}

fn doubted(fix: Result<Fix, FixError>) -> Result<Fix, FixError> {
    fix.map(|fix| Fix { integrity: fix.integrity.min_trust(Integrity::Suspect), ..fix })
}

/// What the positioner has to know beforehand.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PositionerConfig {
    /// The surveyed stations.
    pub stations: Vec<Station>,
    /// Where the robot stands at the start.
    pub start: Pose,
    /// Standard deviation of the start's position, metres.
    pub start_sigma_m: f64,
    /// Standard deviation of the start's heading, radians.
    pub heading_sigma_rad: f64,
    /// How single ranges scatter.
    pub noise: RangeNoise,
    /// How odometry errs.
    pub odometry: MotionNoise,
    /// How repetitions become one range.
    pub aggregation: Aggregation,
    /// How ranges become a fix.
    pub solver: SolverKind,
    /// The wall of the tank: a fix clearly behind it is none.
    pub boundary: Option<Boundary>,
    /// Whether the speed of sound is found out under way; needs four stations.
    pub calibrate_sound_speed: bool,
}

impl PositionerConfig {
    /// Usual errors: start surveyed to 5 cm and 0.05 rad, ranges to 3 %, odometry as [`MotionNoise::default`].
    pub fn new(stations: Vec<Station>, start: Pose) -> Self {
        Self {
            stations,
            start,
            start_sigma_m: 0.05,
            heading_sigma_rad: 0.05,
            noise: RangeNoise::Gaussian { sigma_ratio: 0.03 },
            odometry: MotionNoise::default(),
            aggregation: Aggregation::default(),
            solver: SolverKind::default(),
            boundary: None,
            calibrate_sound_speed: false,
        }
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

/// What a ranging cycle brought.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleResult {
    /// One range per station heard; empty if one of the ranges was no range.
    pub rangings: Vec<Ranging>,
    /// The fix of this cycle alone.
    pub fix: Result<Fix, FixError>,
    /// Whether the fix, or what single ranges there were, went into the estimate.
    pub accepted: bool,
}

/// Ranges and odometry in, pose with covariance out.
#[derive(Debug, Clone)]
pub struct Positioner {
    config: PositionerConfig,
    filter: Ekf,
    sound: Calibration,
    refused_in_a_row: u32,
    /// The first of the refused fixes in a row, and where the filter was then.
    first_refused: Option<(Fix, Pose)>,
}

impl Positioner {
    /// A positioner at the surveyed start.
    pub fn new(config: PositionerConfig) -> Self {
        let filter = Ekf::new(config.start, config.start_sigma_m, config.heading_sigma_rad, config.odometry);
        let sound = Calibration::new(&config.stations, Unknowns::default());
        Self { config, filter, sound, refused_in_a_row: 0, first_refused: None }
    }

    /// Moves the estimate by one tick of odometry.
    pub fn predict(&mut self, odometry: &Odometry) {
        self.filter.predict(odometry);
    }

    /// Makes the position less known by a motion that nothing measured, of this standard deviation in x and in y, metres.
    pub fn wander(&mut self, sigma_m: f64) {
        self.filter.doubt_motion(&Odometry { forward_m: sigma_m, ..Odometry::default() });
    }

    /// Takes in a ranging cycle: ranges to a fix, the fix into the estimate unless its residuals raise an alarm.
    ///
    /// With one or two stations there is no fix to be had without help: with two the estimate chooses the mirror, with
    /// one the range itself goes into the estimate.
    pub fn cycle(&mut self, sets: &[RangeSet]) -> CycleResult {
        let mut rangings = match self.config.aggregation.aggregate(sets, &self.config.noise) {
            Ok(rangings) => rangings,
            Err(error) => return CycleResult { rangings: Vec::new(), fix: Err(error), accepted: false },
        };
        if self.config.calibrate_sound_speed {
            let prior = (self.filter.pose().position, self.filter.position_covariance());
            // A cycle without a position contributes nothing; the fix states why there is none.
            let _ = self.sound.take(&rangings, Some(prior));
            rangings = self.sound.corrected(&rangings);
        }
        let mut fix = self.solve(&rangings);
        if let (SolverKind::Differences, Ok(fix)) = (self.config.solver, &fix) {
            take_excess_out(fix, &mut rangings, &self.config.stations);
        }
        let accepted = match &mut fix {
            Ok(fix) => self.take_fix(fix, &rangings),
            Err(FixError::TooFewStations { .. }) if self.are_distances() => self.take_ranges(&rangings),
            Err(_) => false,
        };
        CycleResult { rangings, fix, accepted }
    }

    /// Where the robot is believed to be.
    pub fn estimate(&self) -> Estimate {
        Estimate { pose: self.filter.pose(), covariance: self.filter.covariance() }
    }

    /// Longer half axis of the 95 % ellipse of the position, metres.
    pub fn error_95_m(&self) -> f64 {
        self.filter.error_95_m()
    }

    fn solve(&self, rangings: &[Ranging]) -> Result<Fix, FixError> {
        let prior = (self.filter.pose().position, self.filter.position_covariance());
        let config = &self.config;
        let mut fix = config.solver.solve(rangings, &config.stations, &config.noise, Some(prior))?;
        if let Some(boundary) = &config.boundary {
            fix.check_inside(boundary)?;
        }
        let silent = config.stations.iter().map(|s| s.id).filter(|id| !is_heard(*id, rangings));
        fix.excluded.extend(silent.map(|id| (id, Exclusion::Silent)));
        fix.excluded.sort_by_key(|(id, _)| *id);
        Ok(fix)
    }

    /// Whether single ranges are distances; otherwise only all of them together say anything.
    fn are_distances(&self) -> bool {
        self.config.solver != SolverKind::Differences
    }

    /// Hands a fix to the filter; a fix that contradicts the filter is suspect.
    fn take_fix(&mut self, fix: &mut Fix, rangings: &[Ranging]) -> bool {
        if fix.integrity == Integrity::Alarm {
            return false;
        }
        if self.filter_accepts(fix, rangings) {
            (self.refused_in_a_row, self.first_refused) = (0, None);
            return true;
        }
        // A fix that can be tested and passed speaks against the filter; others do not.
        let is_sound = fix.integrity == Integrity::Ok;
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
    /// surer than the fix takes the ranges instead, as seen from where it believes to be.
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
                let sigma_m = ranging.sigma_m * expected_m / ranging.range_m;
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
        ranging.sigma_m *= range_m / ranging.range_m;
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
