//! The check of the stations by pulses before the start.

use super::{Model, check};
use mission::{Check, CheckOutcome, event::pulse_text};
use positioning::Integrity;

const NAME: &str = "pulse test";

impl Model {
    /// Whether the pulses that the stations exchanged agree with their survey; `None` if they exchange none.
    pub(super) fn pulse_check(&self) -> Option<Check> {
        let run = &self.live.run;
        let about = run.about.as_ref()?;
        let doubtful = |why: &str| check(NAME, CheckOutcome::Warning, why.to_owned());
        match &run.position.pulses {
            None if about.mission.locating.pulse_rest_s.is_some() => {
                Some(doubtful("no pulse has come yet; check again"))
            }
            None => None,
            Some(Err(why)) => Some(doubtful(why)),
            Some(Ok((phase, test))) => {
                let found = pulse_text(*phase, test, &about.world.stations);
                let is_wrong = test.integrity == Integrity::Alarm;
                let outcome = if is_wrong { CheckOutcome::Failed } else { CheckOutcome::Passed };
                let found = found.split_once(": ").map_or(found.as_str(), |(_, found)| found);
                Some(check(NAME, outcome, found.to_owned()))
            }
        }
    }
}
