//! The checks of a survey before the start: it has no planner and no plan.

use super::{LEAST_STATIONS, Model, check};
use mission::{Check, CheckOutcome};
use world::coverage::percent_text;

impl Model {
    /// The checks that take the place of those of planner, plan and certificate.
    pub(super) fn survey_checks(&self) -> Vec<Check> {
        let mission = self.live.run.about.as_ref().map(|about| &about.mission);
        let ways = check("ways", CheckOutcome::Passed, "chosen on the way; a survey needs no planner".into());
        let tether = mission
            .and_then(|mission| mission.tether.as_ref())
            .map(|_| check("tether", CheckOutcome::Passed, "its limits are checked before each way".into()));
        std::iter::once(ways).chain(tether).collect()
    }

    /// The check of the stations of a survey, whose ways are not known: the floor on which a fix is forecast to have an
    /// error beyond the limit.
    pub(super) fn stations_on_the_floor(&self, stations: usize) -> Option<Check> {
        let run = &self.live.run;
        let (map, limit_m) = (run.accuracy.as_ref()?, run.about.as_ref()?.mission.position_limit_m);
        let floor = map.cells.iter().flatten();
        let poor = floor.clone().filter(|cell| cell.error_95_m.is_none_or(|error_m| error_m > limit_m));
        let (n, n_poor) = (floor.count(), poor.count());
        if stations < LEAST_STATIONS || n == 0 {
            return None;
        }
        let (outcome, found) = if n_poor == 0 {
            (CheckOutcome::Passed, format!("{stations}; within {limit_m:.2} m on the whole floor"))
        } else {
            let share = percent_text(n_poor as f64 / n as f64, 1);
            (
                CheckOutcome::Warning,
                format!("{stations}; error above {limit_m:.2} m on {share} % of the floor"),
            )
        };
        Some(check("AE stations", outcome, found))
    }
}
