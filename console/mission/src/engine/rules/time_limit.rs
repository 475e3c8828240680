//! The mission ends unfinished when its time limit is reached.

use super::seen::{Seen, Verdict};
use crate::{
    MissionConfig,
    phase::{Hold, Outcome, Phase},
};

/// Measures the time that does not count: the time before the start, and attended holds.
#[derive(Clone, Debug, Default)]
pub(in crate::engine) struct TimeLimitRule {
    waited_s: f64,
    /// Mission time since which the robot has been held, seconds.
    held_since_s: Option<f64>,
}

impl TimeLimitRule {
    /// Records the start of the mission.
    pub(crate) fn start(&mut self, now_s: f64) {
        self.waited_s = now_s;
    }

    /// Records that the robot is held; it may be held already.
    pub(crate) fn hold(&mut self, now_s: f64) {
        self.held_since_s.get_or_insert(now_s);
    }

    /// Mission time at which the mission ends if no further time is left out, seconds.
    pub(crate) fn ends_s(&self, config: &MissionConfig) -> f64 {
        self.waited_s + config.time_limit_s
    }

    /// Processes one tick of a mission in progress.
    pub(crate) fn update(&mut self, seen: &Seen<'_>, phase: &Phase) -> Option<Verdict> {
        let hold = if let Phase::Held(hold) = phase { Some(hold) } else { None };
        self.held_since_s = self.held_since_s.filter(|_| hold.is_some());
        // Like a hold, a drive back is the operator's decision, so its time does not count.
        if seen.config.attended && (hold.is_some() || phase.is_return()) {
            self.waited_s += seen.config.tick_s;
        }
        (seen.now_s >= self.ends_s(seen.config))
            .then(|| Verdict::End(Outcome::TimeLimit, self.reason(seen.config, hold)))
    }

    fn reason(&self, config: &MissionConfig, hold: Option<&Hold>) -> String {
        let limit = format!("time limit of {:.0} s reached", config.time_limit_s);
        match (self.held_since_s, hold) {
            (Some(since_s), Some(Hold { by, .. })) if config.live => {
                format!("{limit}; since T+{since_s:.1} s {by}")
            }
            _ => limit,
        }
    }
}
