//! Tells a slack cable from a caught one: both have more cable out than the map explains, but a slack cable does not pull.

use crate::event::{MeasuredPull, SLACK_M, TetherAlarm};
use world::tether::Reel;

/// Share of the reel's pull up to which a cable counts as slack.
const LITTLE: f64 = 0.05;
/// Length of cable, besides the slack, whose friction on the floor the robot may feel although the cable is slack, metres:
/// the loop that it drags behind itself.
const LOOP_M: f64 = 0.5;
/// Pull up to which a cable counts as slack if its weight and the pull of the reel are not known, newtons.
const LITTLE_N: f64 = 0.2;

/// The slack of the cable, from the encoder of the reel and the pull on the cable.
#[derive(Clone, Debug, Default)]
pub(super) struct Slack {
    /// Cable out beyond the expected length when the cable last pulled, metres; `None` while it has not pulled yet.
    taut_excess_m: Option<f64>,
    /// Cable that has become slack since then, metres.
    loose_m: f64,
    /// Measured pull, newtons; `None` without a sensor.
    pull_n: Option<f64>,
}

impl Slack {
    /// Processes the cable out beyond the expected length, metres, and the pull, newtons. Returns whether the cable pulls,
    /// or its pull is not measured: only then can it be caught.
    pub(super) fn take(&mut self, excess_m: Option<f64>, pull_n: Option<f64>, reel: Option<&Reel>) -> bool {
        let little_n = reel.map_or(LITTLE_N, |reel| {
            (LITTLE * reel.pull_n).max((LOOP_M + self.loose_m) * reel.drag(0.0).floor_n_per_m)
        });
        let Some(pull_n) = pull_n.filter(|pull_n| pull_n.is_finite()) else {
            *self = Self::default();
            return true;
        };
        self.pull_n = Some(pull_n);
        if pull_n > little_n {
            (self.taut_excess_m, self.loose_m) = (excess_m.or(self.taut_excess_m), 0.0);
            return true;
        }
        if let Some(excess_m) = excess_m {
            let taut_m = *self.taut_excess_m.get_or_insert(excess_m);
            self.loose_m = (excess_m - taut_m).max(0.0);
        }
        false
    }

    /// The alarm, with the slack as a share of its limit.
    pub(super) fn alarm(&self) -> (TetherAlarm, f64) {
        let pull_n = self.pull_n.unwrap_or_default();
        (TetherAlarm::Slack { slack_m: self.loose_m, pull_n }, self.loose_m / SLACK_M)
    }

    /// The last measured pull with the slack; `None` without a sensor.
    pub(super) fn measured(&self) -> Option<MeasuredPull> {
        self.pull_n.map(|pull_n| MeasuredPull { pull_n, slack_m: self.loose_m })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REEL: Reel = Reel {
        mass_kg_per_m: 0.1,
        floor_friction: 0.3,
        pull_n: 6.0,
        pay_out_n: 0.5,
        robot_pull_n: None,
        pull_ratio_max: 0.8,
    };

    #[test]
    fn cable_without_pull_is_slack_and_cable_with_pull_may_be_caught() {
        let mut slack = Slack::default();
        let share = |slack: &Slack| slack.alarm().1;
        assert!(slack.take(Some(0.1), Some(3.0), Some(&REEL)));
        assert!(slack.take(Some(0.9), Some(3.0), Some(&REEL)) && share(&slack) == 0.0, "caught, not slack");
        assert!(!slack.take(Some(1.05), Some(0.1), Some(&REEL)) && (0.7..0.8).contains(&share(&slack)));
        assert!(!slack.take(None, Some(0.1), Some(&REEL)) && share(&slack) > 0.7, "the position is lost");
        assert!(!slack.take(Some(1.11), Some(0.0), Some(&REEL)) && share(&slack) > 1.0);
        assert!(slack.take(Some(1.0), Some(2.0), Some(&REEL)) && share(&slack) == 0.0);
        let weak = Reel { pull_n: 0.5, mass_kg_per_m: 0.3, ..REEL };
        let mut dragged = Slack::default();
        assert!(dragged.take(Some(0.0), Some(0.5), Some(&weak)));
        assert!(!dragged.take(Some(0.3), Some(0.1), Some(&weak)) && share(&dragged) > 1.0, "only its loop");
        assert!(!dragged.take(Some(1.0), Some(0.6), Some(&weak)), "its loop has become longer");
        assert!(!dragged.take(Some(0.0), Some(0.0), Some(&weak)) && share(&dragged) == 0.0);
        assert!(dragged.take(Some(0.0), Some(0.5), Some(&weak)), "taut again");
        assert!(slack.take(Some(9.0), None, Some(&REEL)) && share(&slack) == 0.0, "not measured");
    }
}
