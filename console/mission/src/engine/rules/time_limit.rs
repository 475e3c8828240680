//! The mission ends unfinished when its time is up.

use super::seen::{Seen, Verdict};
use crate::phase::Outcome;

/// Counts the time that an operator has let the mission wait: before its start, and while somebody looks after a mission that
/// is held, its time does not run out.
#[derive(Clone, Debug, Default)]
pub(in crate::engine) struct TimeLimitRule {
    waited_s: f64,
}

impl TimeLimitRule {
    /// The mission begins.
    pub(crate) fn start(&mut self, now_s: f64) {
        self.waited_s = now_s;
    }

    /// One tick of a mission under way.
    pub(crate) fn update(&mut self, seen: &Seen<'_>, is_held: bool) -> Option<Verdict> {
        if seen.config.attended && is_held {
            self.waited_s += seen.config.tick_s;
        }
        let limit_s = seen.config.time_limit_s;
        (seen.now_s - self.waited_s >= limit_s)
            .then(|| Verdict::End(Outcome::TimeLimit, format!("time limit of {limit_s:.0} s reached")))
    }
}
