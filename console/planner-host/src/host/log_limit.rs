//! How much a planner may log over time: what it says in one step is limited in its worker.

use planner_api::LogLevel;

/// So many messages at once; every step adds one, up to this.
const MOST: usize = 64;

/// What a planner may still log. It counts steps and no time, so that equal runs have equal logs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct LogLimit {
    left: usize,
    /// It has logged too much: nothing more until there is room for as much again.
    is_muted: bool,
}

impl Default for LogLimit {
    fn default() -> Self {
        Self { left: MOST, is_muted: false }
    }
}

impl LogLimit {
    /// Takes the messages of a step, and drops those beyond the limit; the first time of a row it says so.
    pub(super) fn take(&mut self, logs: &mut Vec<(LogLevel, String)>) {
        self.left = (self.left + 1).min(MOST);
        self.is_muted &= self.left < MOST;
        if self.is_muted {
            logs.clear();
        } else if logs.len() > self.left {
            logs.truncate(self.left);
            let text = format!("logs too much: its messages of the next {MOST} steps are dropped");
            logs.push((LogLevel::Warn, text));
            *self = Self { left: 0, is_muted: true };
        } else {
            self.left -= logs.len();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn logged(steps: usize, each: usize) -> usize {
        let mut limit = LogLimit::default();
        let messages = vec![(LogLevel::Info, String::new()); each];
        let taken = (0..steps).map(|_| {
            let mut logs = messages.clone();
            limit.take(&mut logs);
            logs.len()
        });
        taken.sum()
    }

    #[test]
    fn a_line_a_step_passes_and_a_flood_is_cut_to_about_that() {
        assert_eq!(logged(1000, 1), 1000);
        let flood = logged(6400, 64);
        assert!((6000..=6700).contains(&flood), "{flood} of 409600");
    }

    #[test]
    fn a_planner_that_logs_too_much_is_warned_once_and_heard_again() {
        let mut limit = LogLimit::default();
        let mut logs = vec![(LogLevel::Info, String::new()); 66];
        limit.take(&mut logs);
        assert_eq!((logs.len(), logs[64].0), (65, LogLevel::Warn));
        for step in 0..65 {
            let mut logs = vec![(LogLevel::Info, String::new())];
            limit.take(&mut logs);
            assert_eq!(logs.len(), usize::from(step >= 63), "step {step}");
        }
    }
}
