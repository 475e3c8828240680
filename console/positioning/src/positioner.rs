//! The estimate that a mission keeps: odometry every tick, ranges every cycle.

use crate::{
    aggregate::Aggregation,
    ekf::{Ekf, MotionNoise},
    fix::{Exclusion, Fix, FixError, Integrity, PositionSolver, Ranging},
    linear::LinearLs,
    nonlinear::Nls,
    quality::residual_gate_m,
};
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use world::{Odometry, Pose, RangeSet, Station, StationId};

/// So many sound fixes in a row that contradict the filter prove the filter wrong.
const PATIENCE: u32 = 3;
/// Doubt about the heading after the filter was proved wrong, radians.
const RESTART_HEADING_SIGMA_RAD: f64 = 0.3;
/// Stations needed to find out which one is wrong.
const NEEDED_TO_EXCLUDE: usize = 5;

/// Which solver turns ranges into fixes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SolverKind {
    /// [`LinearLs`].
    Linear,
    /// [`Nls`].
    #[default]
    Nls,
}

impl SolverKind {
    fn solver(self) -> &'static dyn PositionSolver {
        match self {
            Self::Linear => &LinearLs,
            Self::Nls => &Nls,
        }
    }
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
    /// Standard deviation of a single range as a share of the range.
    pub range_sigma_ratio: f64,
    /// How odometry errs.
    pub odometry: MotionNoise,
    /// How repetitions become one range.
    pub aggregation: Aggregation,
    /// How ranges become a fix.
    pub solver: SolverKind,
}

impl PositionerConfig {
    /// Usual errors: start surveyed to 5 cm and 0.05 rad, ranges to 3 %, odometry as [`MotionNoise::default`].
    pub fn new(stations: Vec<Station>, start: Pose) -> Self {
        Self {
            stations,
            start,
            start_sigma_m: 0.05,
            heading_sigma_rad: 0.05,
            range_sigma_ratio: 0.03,
            odometry: MotionNoise::default(),
            aggregation: Aggregation::default(),
            solver: SolverKind::default(),
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
    refused_in_a_row: u32,
}

impl Positioner {
    /// A positioner at the surveyed start.
    pub fn new(config: PositionerConfig) -> Self {
        let filter = Ekf::new(config.start, config.start_sigma_m, config.heading_sigma_rad, config.odometry);
        Self { config, filter, refused_in_a_row: 0 }
    }

    /// Moves the estimate by one tick of odometry.
    pub fn predict(&mut self, odometry: &Odometry) {
        self.filter.predict(odometry);
    }

    /// Takes in a ranging cycle: ranges to a fix, the fix into the estimate unless its residuals raise an alarm.
    ///
    /// With one or two stations there is no fix to be had without help: with two the estimate chooses the mirror, with
    /// one the range itself goes into the estimate.
    pub fn cycle(&mut self, sets: &[RangeSet]) -> CycleResult {
        let rangings = match self.config.aggregation.aggregate(sets, self.config.range_sigma_ratio) {
            Ok(rangings) => rangings,
            Err(error) => return CycleResult { rangings: Vec::new(), fix: Err(error), accepted: false },
        };
        let mut fix = self.solve(&rangings);
        let accepted = match &mut fix {
            Ok(fix) => self.take_fix(fix, &rangings),
            Err(FixError::TooFewStations { .. }) => self.take_ranges(&rangings),
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
        let mut fix = self.solve_with(rangings)?;
        if fix.integrity == Integrity::Alarm && rangings.len() >= NEEDED_TO_EXCLUDE {
            fix = self.without_the_worst(rangings).unwrap_or(fix);
        }
        let silent = self.config.stations.iter().map(|s| s.id).filter(|id| !is_heard(*id, rangings));
        fix.excluded.extend(silent.map(|id| (id, Exclusion::Silent)));
        fix.excluded.sort_by_key(|(id, _)| *id);
        Ok(fix)
    }

    fn solve_with(&self, rangings: &[Ranging]) -> Result<Fix, FixError> {
        let prior = (self.filter.pose().position, self.filter.position_covariance());
        self.config.solver.solver().solve(rangings, &self.config.stations, Some(prior))
    }

    /// The fix without the one station whose absence lets the others agree, if there is such a station.
    fn without_the_worst(&self, rangings: &[Ranging]) -> Option<Fix> {
        let leave_out = |left_out: &Ranging| {
            let others: Vec<Ranging> =
                rangings.iter().filter(|r| r.station != left_out.station).copied().collect();
            Some((*left_out, self.solve_with(&others).ok()?))
        };
        let (left_out, mut fix) =
            rangings.iter().filter_map(leave_out).min_by(|a, b| a.1.chi2.total_cmp(&b.1.chi2))?;
        let station = self.config.stations.iter().find(|s| s.id == left_out.station)?;
        let distance_m = (fix.position - station.position).norm();
        let gate_m = residual_gate_m(left_out.sigma_m * distance_m / left_out.range_m);
        let residual_m = left_out.range_m - distance_m;
        fix.excluded.push((left_out.station, Exclusion::Residual { residual_m, gate_m }));
        (fix.integrity == Integrity::Ok && residual_m.abs() > gate_m).then_some(fix)
    }

    /// Hands a fix to the filter; a fix that contradicts the filter is suspect.
    fn take_fix(&mut self, fix: &mut Fix, rangings: &[Ranging]) -> bool {
        if fix.integrity == Integrity::Alarm {
            return false;
        }
        if self.filter_accepts(fix, rangings) {
            self.refused_in_a_row = 0;
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
            return false;
        }
        self.refused_in_a_row = 0;
        self.filter.restart_at(fix.position, &fix.covariance, RESTART_HEADING_SIGMA_RAD);
        true
    }

    /// Corrects the filter where the geometry is better known.
    ///
    /// Close to a station the error of a fix is bent like the range circle and no ellipse holds it; a filter that is
    /// surer than the fix takes the ranges instead, as seen from where it believes to be.
    fn filter_accepts(&mut self, fix: &Fix, rangings: &[Ranging]) -> bool {
        if self.filter.error_95_m() < fix.ellipse_95().0 {
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

fn is_heard(station: StationId, rangings: &[Ranging]) -> bool {
    rangings.iter().any(|r| r.station == station)
}

#[cfg(test)]
mod tests;
