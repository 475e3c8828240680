//! The session calibration of a mission, and what it changes.

use crate::event::EventKind;
use positioning::{
    Estimate, Exclusion, Fix, News, OnBias, PositionerConfig, SessionCalibration, SessionConfig, SolverKind,
};
use world::{Odometry, RangeSet};

/// The calibration, with the handling of a wrong station.
#[derive(Clone)]
pub(super) struct Session {
    calibration: SessionCalibration,
    on_bias: OnBias,
}

impl Session {
    /// Creates the calibration for the positioner with this configuration.
    pub(super) fn new(config: SessionConfig, positioner: &PositionerConfig) -> Self {
        let PositionerConfig { stations, aggregation, noise, timing, odometry, solver, .. } = positioner;
        let ways = (*aggregation, *noise, *timing);
        let plain = SessionCalibration::new(config, stations, ways, *odometry);
        let is_free = *solver == SolverKind::Differences;
        let calibration = if is_free { plain.with_free_emission() } else { plain };
        Self { calibration, on_bias: config.on_bias }
    }

    /// Adds the motion of a tick, which begins with this heading, radians.
    pub(super) fn predict(&mut self, odometry: &Odometry, heading_rad: f64) {
        self.calibration.predict(odometry, heading_rad);
    }

    /// Adds an unmeasured motion of at most this length, metres.
    pub(super) fn wander(&mut self, most_m: f64) {
        self.calibration.wander(most_m);
    }

    /// Adds the ranges of a cycle at a time, seconds; returns the resulting events.
    pub(super) fn take(&mut self, sets: &[RangeSet], estimate: &Estimate, t_s: f64) -> Vec<EventKind> {
        let news = self.calibration.take(sets, estimate.into(), t_s);
        let is_corrected = self.on_bias == OnBias::Correct;
        let event = |news| match news {
            News::Biased { station, bias_m, since_s } => {
                EventKind::StationBiased { station, bias_m, since_s, is_corrected }
            }
            News::Sound { station } => EventKind::StationUnbiased { station },
            News::NotSeparable { correlation, stations } => EventKind::NotSeparable { correlation, stations },
            News::Separable => EventKind::Separable,
        };
        let scale = self.calibration.scale();
        let slip_correlation = self.calibration.slip_correlation();
        let calibrated = EventKind::SessionCalibrated { scale, slip_correlation };
        [calibrated].into_iter().chain(news.into_iter().map(event)).collect()
    }

    /// The estimates of the calibration.
    pub(super) fn calibration(&self) -> &SessionCalibration {
        &self.calibration
    }

    /// Names the bias as the reason for which a fix does not use a station.
    pub(super) fn explain(&self, fix: &mut Fix) {
        for (station, bias_m) in self.calibration.biases_m() {
            let left_out =
                fix.excluded.iter_mut().filter(|(id, why)| *id == station && *why == Exclusion::Silent);
            left_out.for_each(|(_, why)| *why = Exclusion::Biased { bias_m: bias_m.value });
        }
    }
}
