//! Limits for figures that the console itself monitors. A deadband and delays keep a figure near its limit from
//! raising and clearing an alarm repeatedly.

use serde::{Deserialize, Serialize};

/// A limit with its deadband and delays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// The value at which the alarm is raised.
    pub alarm: f64,
    /// The value at which the alarm clears. If it is greater than `alarm`, the alarm is raised when the figure falls
    /// to `alarm`.
    pub clear: f64,
    /// How long the value must be beyond the limit before the alarm is raised, seconds.
    pub on_delay_s: f64,
    /// How long the figure must stay at or beyond the clearing value before the alarm clears, seconds.
    pub off_delay_s: f64,
}

impl Limit {
    /// Whether a value has reached the alarm value, and whether it is back at the clearing value.
    fn sides(&self, value: f64) -> (bool, bool) {
        if self.clear > self.alarm {
            (value <= self.alarm, value >= self.clear)
        } else {
            (value >= self.alarm, value <= self.clear)
        }
    }
}

/// A figure that is repeatedly compared with its limit.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Watch {
    is_on: bool,
    /// When the figure first called for the pending change, seconds.
    since_s: Option<f64>,
}

/// The result of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edge {
    /// The alarm is raised.
    Raised,
    /// The alarm clears.
    Cleared,
}

impl Watch {
    /// Compares a value with the limit at the given time, seconds. Both delays start at the first value that calls
    /// for the change.
    pub fn take(&mut self, limit: &Limit, value: f64, now_s: f64) -> Option<Edge> {
        let (beyond, back) = limit.sides(value);
        let (asks, delay_s) = if self.is_on { (back, limit.off_delay_s) } else { (beyond, limit.on_delay_s) };
        if !asks {
            self.since_s = None;
            return None;
        }
        let since_s = *self.since_s.get_or_insert(now_s);
        if now_s - since_s < delay_s {
            return None;
        }
        (self.is_on, self.since_s) = (!self.is_on, None);
        Some(if self.is_on { Edge::Raised } else { Edge::Cleared })
    }

    /// Whether the alarm is raised.
    pub fn is_on(&self) -> bool {
        self.is_on
    }

    /// Whether the alarm is raised or about to be raised; the figure must then be checked again even if nothing
    /// happens.
    pub fn is_pending(&self) -> bool {
        self.is_on || self.since_s.is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HIGH: Limit = Limit { alarm: 33.0, clear: 25.0, on_delay_s: 2.0, off_delay_s: 3.0 };
    const LOW: Limit = Limit { alarm: 200.0, clear: 300.0, on_delay_s: 0.0, off_delay_s: 0.0 };

    /// The results of comparing values with a limit, one value a second.
    fn edges(limit: &Limit, values: &[f64]) -> Vec<(usize, Edge)> {
        let mut watch = Watch::default();
        let take = |(second, value): (usize, &f64)| Some((second, watch.take(limit, *value, second as f64)?));
        values.iter().enumerate().filter_map(take).collect()
    }

    #[test]
    fn an_alarm_comes_after_its_delay_and_goes_below_the_deadband() {
        let values = [34.0, 34.0, 34.0, 30.0, 24.0, 24.0, 24.0, 24.0];
        assert_eq!(edges(&HIGH, &values), [(2, Edge::Raised), (7, Edge::Cleared)]);
    }

    #[test]
    fn what_goes_to_and_fro_at_the_limit_changes_nothing() {
        assert_eq!(edges(&HIGH, &[34.0, 32.0, 34.0, 32.0, 34.0, 32.0]), []);
        let inside = [34.0, 34.0, 34.0, 26.0, 32.0, 24.0, 24.0, 26.0, f64::NAN];
        assert_eq!(edges(&HIGH, &inside), [(2, Edge::Raised)]);
    }

    #[test]
    fn a_figure_that_falls_alarms_below_its_limit() {
        let values = [500.0, 199.0, 250.0, 299.0, 300.0, 250.0];
        assert_eq!(edges(&LOW, &values), [(1, Edge::Raised), (4, Edge::Cleared)]);
    }
}
