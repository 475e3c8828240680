//! The session calibration of a file, which estimates errors from the moment on at which they begin.

use super::{Survey, Task};
use crate::columns::Kind;
use mission::EventKind;
use positioning::{Integrity, Session, SessionConfig, Verdict};

impl Task<'_> {
    /// The session calibration that the scenario asks for, if the stations suffice for readings of this kind, and unless
    /// the file as a whole shows a length common to all ranges: the calibration would take it for wrong stations.
    pub(super) fn session(&self, kind: Kind, whole: &Verdict) -> Option<SessionConfig> {
        let least = SessionConfig::least_stations(kind == Kind::Differences);
        let is_enough = self.scenario.sim.world.stations.len() >= least;
        self.scenario.mission.locating.session.filter(|_| is_enough && !whole.is_length_alone())
    }

    /// Replaces the verdict about a file with a session calibration by that about its corrected fixes.
    ///
    /// # Errors
    /// The file can no longer be read.
    pub(super) fn judge_calibrated(&self, survey: &mut Survey) -> anyhow::Result<()> {
        if survey.session.is_none() {
            return Ok(());
        }
        let mut residuals = Session::new(&self.scenario.sim.world.stations, survey.kind == Kind::Differences);
        self.track(survey, None, |events| {
            let fixes = events.iter().filter_map(|event| match &event.kind {
                EventKind::Fixed { fix } => Some(fix),
                _ => None,
            });
            fixes.filter(|fix| fix.integrity != Integrity::Alarm).for_each(|fix| residuals.take(fix));
        })?;
        survey.verdict = residuals.verdict().beside_calibration();
        Ok(())
    }
}
