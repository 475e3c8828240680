//! Estimates errors of clocks, sound and stations from a whole session.

use super::Task;
use crate::{
    columns::{Columns, Kind},
    found::Found,
    moments::Moment,
    repeats::Repeats,
};
use flight::failure::bad_input;
use positioning::{Calibration, Integrity, Possible, PulseSeries, Ranging, Session, SolverKind, Unknowns};

/// Maximum number of passes over the session to estimate clock and sound errors.
const ROUNDS: usize = 10;
/// Change of the estimate of clock and sound errors, as a share of its standard deviation, below which the passes end.
const SETTLED: f64 = 0.1;
/// Standard deviation that is assumed for clock offsets before the search, metres.
const OFFSET_SIGMA_M: f64 = 20.0;
/// Standard deviation that is assumed for the error of the speed of sound before the search, as a share.
const SOUND_SIGMA_RATIO: f64 = 0.05;
/// Standard deviation of the speed of sound, as a share, above which the speed counts as not found.
const UNSEEN_SIGMA_RATIO: f64 = 0.05;
/// The share by which ranges may be too long while the speed of sound is being estimated.
pub(super) const MOST_TOO_LONG: f64 = 0.3;

/// What is known about the whole file: its columns, its repetitions, and its pulse tests.
pub(super) type Known<'a> = (&'a Columns, &'a Repeats, &'a PulseSeries);

impl Task<'_> {
    fn finds(&self) -> bool {
        self.finds_clock_offset || self.finds_sound_speed
    }

    /// # Errors
    /// The estimate that was requested cannot be obtained from readings of this kind.
    pub(super) fn check_findable(&self, columns: &Columns) -> anyhow::Result<()> {
        if self.finds_clock_offset && columns.kind() == Kind::Differences {
            return Err(bad_input(format!(
                "{}: a clock offset cannot be found without emission times; leave out --find clock-offset, or add a \
                 column emitted_s",
                self.shown
            )));
        }
        if self.scenario.mission.locating.clocks.is_some() && columns.kind() == Kind::Differences {
            return Err(bad_input(format!(
                "{}: the stations of this scenario have clocks of their own, which only a mission estimates; subtract \
                 their offsets from the arrivals, and remove clock_offset_sigma_m and clock_drift_sigma_m_per_h from [ae]",
                self.shown
            )));
        }
        Ok(())
    }

    /// Estimates clock and sound errors from the session, if requested.
    pub(super) fn found(&self, known: Known<'_>) -> anyhow::Result<Option<Found>> {
        if !self.finds() {
            return Ok(None);
        }
        if known.0.kind() == Kind::Differences {
            return self.scale_of_differences(known).map(Some);
        }
        let unknowns = Unknowns {
            sound_sigma_ratio: if self.finds_sound_speed { SOUND_SIGMA_RATIO } else { 0.0 },
            survey_sigma_m: 0.0,
            offset_sigma_m: if self.finds_clock_offset { OFFSET_SIGMA_M } else { 0.0 },
        };
        let calibration = Calibration::new(&self.scenario.sim.world.stations, unknowns);
        self.calibrated(calibration, known).map(|calibration| Some(Found::from(&calibration)))
    }

    /// Estimates the error of the speed of sound that the locator will find on its own during the run.
    pub(super) fn found_under_way(&self, known: Known<'_>) -> anyhow::Result<Option<Found>> {
        if known.0.kind() == Kind::Differences {
            return Ok(None);
        }
        let calibration = Calibration::new(&self.scenario.sim.world.stations, Unknowns::default());
        self.calibrated(calibration, known).map(|calibration| Some(Found::from(&calibration)))
    }

    /// Repeats the estimate of clock and sound errors over the session until it no longer changes.
    fn calibrated(&self, mut calibration: Calibration, known: Known<'_>) -> anyhow::Result<Calibration> {
        let (_, repeats, pulses) = known;
        let possible = self.possible();
        for _ in 0..ROUNDS {
            let before = (calibration.scale().0, calibration.offset_m().0);
            calibration = calibration.again();
            for moment in self.moments(repeats, pulses)? {
                // A cycle without a position contributes nothing; its fix states the reason.
                let _ = calibration.take(&self.rangings(&possible, &moment, Kind::Ranges), None);
            }
            let ((scale, scale_sigma), (offset_m, offset_sigma_m)) =
                (calibration.scale(), calibration.offset_m());
            let is_settled = (scale - before.0).abs() <= SETTLED * scale_sigma
                && (offset_m - before.1).abs() <= SETTLED * offset_sigma_m;
            if is_settled {
                break;
            }
        }
        Ok(calibration)
    }

    /// Estimates, from arrival differences alone, the share by which all ranges are too long.
    fn scale_of_differences(&self, readings: Known<'_>) -> anyhow::Result<Found> {
        let (mut scale, mut sigma) = (0.0, f64::INFINITY);
        for _ in 0..ROUNDS {
            let found = Found::of_scale((scale, 0.0));
            let Some((step, step_sigma)) = self.judged(readings, Some(&found))?.scale() else { break };
            scale = ((1.0 + scale) * (1.0 + step) - 1.0).clamp(-MOST_TOO_LONG, MOST_TOO_LONG);
            sigma = step_sigma * (1.0 + scale);
            if step.abs() <= SETTLED * step_sigma {
                break;
            }
        }
        if sigma < UNSEEN_SIGMA_RATIO {
            return Ok(Found::of_scale((scale, sigma)));
        }
        let known = if sigma.is_finite() {
            format!("is known only to ± {:.0} %", sigma * 100.0)
        } else {
            "cannot be found".into()
        };
        Err(bad_input(format!(
            "{}: the speed of sound {known} from these arrival differences; to find it, \
             provide fixes in many places with five or more stations each, or the emission time (emitted_s)",
            self.shown
        )))
    }

    /// Collects the residuals of the fixes, after the ranges have been corrected for the errors found. Fixes that
    /// contradict themselves count only if most fixes do: then their errors have a common cause.
    pub(super) fn judged(
        &self,
        (columns, repeats, pulses): Known<'_>,
        found: Option<&Found>,
    ) -> anyhow::Result<Session> {
        let kind = columns.kind();
        let stations = &self.scenario.sim.world.stations;
        let mut session = Session::new(stations, kind == Kind::Differences);
        let mut whole = session.clone();
        let (mut alarms, mut fixes) = (0_u64, 0_u64);
        let locating = &self.scenario.mission.locating;
        let solver = if kind == Kind::Differences { SolverKind::Differences } else { locating.solver };
        let possible = self.possible();
        for moment in self.moments(repeats, pulses)? {
            let mut rangings = self.rangings(&possible, &moment, kind);
            if let Some(found) = found {
                found.corrected(&mut rangings);
            }
            let Ok(fix) = solver.solve(&rangings, stations, &self.noise(), None) else { continue };
            fixes += 1;
            whole.take(&fix);
            if fix.integrity == Integrity::Alarm {
                alarms += 1;
            } else {
                session.take(&fix);
            }
        }
        Ok(if 2 * alarms > fixes { whole } else { session })
    }

    /// Returns one range for each station that was heard, leaving out impossible ranges.
    fn rangings(&self, possible: &Possible, moment: &Moment, kind: Kind) -> Vec<Ranging> {
        let locating = &self.scenario.mission.locating;
        let (sets, _) = match kind {
            // With an unknown clock offset, any length is possible.
            Kind::Ranges if self.finds_clock_offset => (moment.ranges.as_slice().into(), Vec::new()),
            Kind::Ranges => possible.ranges(&moment.ranges),
            Kind::Differences => possible.differences(&moment.ranges, &[]),
        };
        let mut rangings = locating.aggregation.aggregate(&sets, &self.noise()).unwrap_or_default();
        // Differences show only which station is nearest, not how near. A distance of zero is assumed: it gives the
        // least spread of the ranges, and so the smallest independent part of the error.
        let excess_m = match kind {
            Kind::Ranges => 0.0,
            Kind::Differences => rangings.iter().map(|r| r.range_m).fold(f64::INFINITY, f64::min),
        };
        locating.timing.apply(&mut rangings, &self.noise(), excess_m);
        rangings
    }
}
