//! The mission ends unfinished when its time limit is reached.

use super::seen::{Seen, Verdict};
use crate::phase::Outcome;

/// Measures the time that does not count: the time before the start, and attended holds.
#[derive(Clone, Debug, Default)]
pub(in crate::engine) struct TimeLimitRule {
    waited_s: f64,
}

impl TimeLimitRule {
    /// Records the start of the mission.
    pub(crate) fn start(&mut self, now_s: f64) {
        self.waited_s = now_s;
    }

    /// Processes one tick of a mission in progress.
    pub(crate) fn update(&mut self, seen: &Seen<'_>, is_held: bool) -> Option<Verdict> {
        if seen.config.attended && is_held {
            self.waited_s += seen.config.tick_s;
        }
        let limit_s = seen.config.time_limit_s;
        (seen.now_s - self.waited_s >= limit_s)
            .then(|| Verdict::End(Outcome::TimeLimit, format!("time limit of {limit_s:.0} s reached")))
    }
}
