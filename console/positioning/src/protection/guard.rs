//! The protection level of the filtered pose.

use super::{Risk, Unprotected};
use crate::{
    fix::{Exclusion, Fix, FixError, Integrity},
    positioner::{Doubt, Positioner, PositionerConfig},
    pulses::PulseTest,
    quality::largest_sigma_m,
    session_calibration::SessionCalibration,
    solver_kind::SolverKind,
};
use nalgebra::Matrix2;
use world::{Odometry, Point, RangeSet, Station, StationId, Vector};

/// The least number of stations for known times of emission: without one of them, the others must still exclude a mirror
/// image.
const NEEDED: usize = 4;
/// The number of cycles in a row without a fix after which the pose counts as not protected: the level covers wrong
/// stations, but not slip of the tracks.
const MOST_SILENT: u32 = 10;
/// Least width of the layout of the stations, as a share of its length.
const LEAST_WIDTH: f64 = 0.01;
/// The number of cycles in a row whose ranges must contradict a hypothesis to disprove it. One correct cycle in 1000
/// does, so a correct hypothesis is lost in one of 10^15 cycles.
const DISPROVED_AFTER: u32 = 5;

/// One positioner for each station, which never hears that station.
///
/// Whatever error a station has, the positioner that does not hear it is free of that error, for the whole session. So
/// the distance to its position, plus a multiple of its uncertainty, bounds the error of the pose (solution separation
/// with a bank of filters; Brenner 1996). Cost: that of one positioner times the number of stations.
#[derive(Debug, Clone)]
pub struct Guard {
    risk: Risk,
    others: Vec<Other>,
    /// The doubt about the ranges, without that of the session calibration.
    doubt: Doubt,
    /// The least number of stations of a level.
    needed: usize,
    is_on_line: bool,
    /// Whether the last ranges fit the hypothesis that at most one station is wrong.
    is_explained: bool,
    /// Whether the session calibration has found two wrong stations at once, and no pulse test has agreed with the survey
    /// since. It is uncertain which two, also after the calibration has taken one of them back.
    has_two_wrong: bool,
    /// Cycles in a row without a fix.
    silent: u32,
    /// Ticks since the last fix, and the least number of ticks between two fixes so far.
    waited: u32,
    usual_wait: Option<u32>,
}

/// The hypothesis that a station is wrong.
#[derive(Debug, Clone)]
struct Other {
    station: StationId,
    /// Hears all stations but this one.
    positioner: Positioner,
    /// Cycles in a row whose ranges contradict the hypothesis.
    contradicted: u32,
}

impl Other {
    /// Takes a cycle; returns whether it contains the station and fits the hypothesis that this station alone is wrong.
    fn explains(
        &mut self,
        sets: &[RangeSet],
        (session, doubt): (Option<&SessionCalibration>, Doubt),
    ) -> bool {
        let heard = match session {
            None => sets.iter().filter(|set| set.station != self.station).cloned().collect(),
            Some(session) => {
                self.positioner.doubt(doubt.beside(session.doubt_without(self.station)));
                session.corrected_without(self.station, sets)
            }
        };
        let fix = self.positioner.cycle(&heard).fix;
        self.contradicted = if contradicts(&fix) { self.contradicted.saturating_add(1) } else { 0 };
        let is_heard = sets.iter().any(|set| set.station == self.station);
        is_heard && self.contradicted == 0 && fix.is_ok_and(|fix| rejected(&fix) == 0)
    }
}

impl Guard {
    /// Creates a guard for the positioner with this configuration.
    pub fn new(config: &PositionerConfig, risk: Risk) -> Self {
        // Levels of fixes are not needed here.
        let plain = PositionerConfig { risk: None, ..config.clone() };
        let positioner = Positioner::new(plain);
        let other = |s: &Station| Other { station: s.id, positioner: positioner.clone(), contradicted: 0 };
        Self {
            risk,
            others: config.stations.iter().map(other).collect(),
            doubt: Doubt::default(),
            // The unknown time of emission takes one more.
            needed: NEEDED + usize::from(config.solver == SolverKind::Differences),
            is_on_line: are_on_line(&config.stations),
            is_explained: true,
            has_two_wrong: false,
            silent: 0,
            waited: 0,
            usual_wait: None,
        }
    }

    /// Moves all hypotheses by one tick of odometry.
    pub fn predict(&mut self, odometry: &Odometry) {
        self.waited = self.waited.saturating_add(1);
        self.others.iter_mut().for_each(|other| other.positioner.predict(odometry));
    }

    /// Widens all hypotheses for an unmeasured motion; see [`Positioner::wander`].
    pub fn wander(&mut self, most_m: f64, most_rad: f64) {
        self.others.iter_mut().for_each(|other| other.positioner.wander(most_m, most_rad));
    }

    /// Reduces the trust in the following cycles; see [`Positioner::doubt`].
    pub fn doubt(&mut self, doubt: Doubt) {
        self.doubt = doubt;
        self.others.iter_mut().for_each(|other| other.positioner.doubt(doubt));
    }

    /// Notes that two stations have proved to be wrong at once; see [`Unprotected::TwoWrong`].
    pub fn note_two_wrong(&mut self) {
        self.has_two_wrong = true;
    }

    /// Takes the clocks of the stations from a pulse test that agrees with the survey; see [`Positioner::take_pulses`].
    pub fn take_pulses(&mut self, test: &PulseTest) {
        self.has_two_wrong = false;
        self.others.iter_mut().for_each(|other| other.positioner.take_pulses(test));
    }

    /// Processes a ranging cycle. `whole` is the fix from all stations.
    ///
    /// With a session calibration, `sets` are the uncorrected ranges: each hypothesis corrects them by what the stations
    /// other than the wrong one show, because the wrong one may have spoilt the estimates from all stations.
    pub fn cycle(
        &mut self,
        sets: &[RangeSet],
        whole: &Result<Fix, FixError>,
        session: Option<&SessionCalibration>,
    ) {
        let is_alone = whole.as_ref().map_or(true, |fix| rejected(fix) <= 1);
        let mut is_explained = is_alone && !contradicts(whole);
        for other in &mut self.others {
            is_explained |= other.explains(sets, (session, self.doubt));
        }
        self.is_explained = is_explained;
        self.has_two_wrong |= session.is_some_and(|session| session.biases_m().count() > 1);
        if whole.is_ok() {
            let waited = std::mem::take(&mut self.waited);
            self.usual_wait = self.usual_wait.into_iter().chain((waited > 0).then_some(waited)).min();
            self.silent = 0;
        } else {
            self.silent = self.silent.saturating_add(1);
        }
    }

    /// Whether the last fix is too old: too many cycles without a fix, or the time of as many cycles without any.
    fn is_silent(&self) -> bool {
        let is_late = |usual: u32| self.waited >= usual.saturating_mul(MOST_SILENT);
        self.silent >= MOST_SILENT || self.usual_wait.is_some_and(is_late)
    }

    /// Returns the protection level of a position with its covariance, metres.
    ///
    /// # Errors
    /// [`Unprotected`] if no level can be stated.
    pub fn level_m(&self, whole: &Positioner) -> Result<f64, Unprotected> {
        let n = self.others.len();
        if n < self.needed {
            return Err(Unprotected::TooFewStations);
        }
        if self.is_on_line {
            return Err(Unprotected::OnOneLine);
        }
        if self.is_silent() {
            return Err(Unprotected::Silent);
        }
        if self.has_two_wrong {
            return Err(Unprotected::TwoWrong);
        }
        if !self.is_explained {
            return Err(Unprotected::Contradiction);
        }
        let multipliers = self.risk.multipliers(n, false).ok_or(Unprotected::TooRisky)?;
        let reach_m = |of: &Positioner, sigmas: f64| sigmas * largest_sigma_m(&of.position_covariance());
        let here: Point = whole.estimate().pose.position;
        let mut level_m = reach_m(whole, multipliers.fault_free);
        for other in self.others.iter().filter(|other| other.contradicted < DISPROVED_AFTER) {
            let apart_m = (other.positioner.estimate().pose.position - here).norm();
            level_m = level_m.max(apart_m + reach_m(&other.positioner, multipliers.one_fault));
        }
        if level_m.is_finite() { Ok(level_m) } else { Err(Unprotected::TooFewStations) }
    }
}

/// Whether all stations are nearly on one line, or in one place: then every place has a mirror image.
pub fn are_on_line(stations: &[Station]) -> bool {
    let mean = stations.iter().map(|s| s.position.coords).sum::<Vector>() / stations.len().max(1) as f64;
    let spread: Matrix2<f64> = stations
        .iter()
        .map(|station| station.position.coords - mean)
        .map(|away| away * away.transpose())
        .sum();
    let spreads = spread.symmetric_eigenvalues();
    // The comparison also holds for stations in one place.
    spreads.min() <= spreads.max() * LEAST_WIDTH.powi(2)
}

/// The number of stations that a fix does not use because of their residuals.
pub(super) fn rejected(fix: &Fix) -> usize {
    fix.excluded.iter().filter(|(_, why)| matches!(why, Exclusion::Residual { .. })).count()
}

fn contradicts(fix: &Result<Fix, FixError>) -> bool {
    match fix {
        Ok(fix) => fix.integrity == Integrity::Alarm,
        Err(error) => matches!(error, FixError::Inconsistent { .. }),
    }
}
