//! Tells a slack cable from a caught one: both have more cable out than the map explains, but a slack cable does not pull.

use super::driven::KEPT_M;
use crate::event::{MeasuredPull, SLACK_M, TetherAlarm};
use world::{Point, tether::Reel};

/// Share of the reel's pull up to which a cable counts as slack.
const LITTLE: f64 = 0.05;
/// Length of cable, besides the slack, whose friction on the floor the robot may feel although the cable is slack, metres:
/// the loop that it drags behind itself.
const LOOP_M: f64 = 0.5;
/// Number of points of the path before the place where the cable last pulled that the way back includes, so that the cable
/// pulls at its end.
const KEPT: usize = 2;
/// Share of the largest slack above which a new plan begins with a path that takes it in.
const TAKEN_IN: f64 = 0.5;
/// Pull up to which a cable counts as slack if its weight and the pull of the reel are not known, newtons.
const LITTLE_N: f64 = 0.2;

/// Cable that a stopped reel may leave out although the cable pulls, metres: the noise of position and encoder.
const TAUT_M: f64 = 0.05;

/// What is known of the reel.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ReelState<'a> {
    /// The reel; `None` if the scenario does not describe it.
    pub reel: Option<&'a Reel>,
    /// Whether it has stopped.
    pub has_stopped: bool,
}

/// The slack of the cable, from the encoder of the reel and the pull on the cable.
#[derive(Clone, Debug, Default)]
pub(super) struct Slack {
    /// Cable out beyond the expected length when the cable last pulled, metres; `None` while it has not pulled yet.
    taut_excess_m: Option<f64>,
    /// Cable that has become slack since then, metres.
    loose_m: f64,
    /// Measured pull, newtons; `None` without a sensor.
    pull_n: Option<f64>,
    /// The path driven since shortly before the cable last pulled, its points [`KEPT_M`] apart.
    way: Vec<Point>,
}

impl Slack {
    /// Records the robot's position.
    pub(super) fn keep(&mut self, here: Point) {
        if self.way.last().is_none_or(|last| (here - last).norm() >= KEPT_M) {
            self.way.push(here);
        }
    }

    /// The path back to shortly beyond the place where the cable last pulled; `None` unless the cable is slack. Going back takes the slack
    /// in, and does not lead over the cable, because the robot has just driven there.
    pub(super) fn way_back(&self) -> Option<Vec<Point>> {
        (self.loose_m > TAKEN_IN * SLACK_M).then(|| self.way.iter().rev().copied().collect())
    }

    /// Processes the cable out beyond the expected length, metres, and the pull, newtons. Returns whether the cable pulls,
    /// or its pull is not measured: only then can it be caught.
    pub(super) fn take(&mut self, excess_m: Option<f64>, pull_n: Option<f64>, at: ReelState<'_>) -> bool {
        let ReelState { reel, has_stopped } = at;
        let little_n = little_n(reel, LOOP_M + self.loose_m);
        let Some(pull_n) = pull_n.filter(|pull_n| pull_n.is_finite()) else {
            *self = Self::default();
            return true;
        };
        self.pull_n = Some(pull_n);
        if pull_n > little_n && !(has_stopped && self.is_left_out(excess_m)) {
            // A reel that has stopped takes nothing up: what was out beyond the taut line when it stopped is the measure.
            let taut_m = if has_stopped { self.taut_excess_m.or(excess_m) } else { excess_m };
            (self.taut_excess_m, self.loose_m) = (taut_m.or(self.taut_excess_m), 0.0);
            self.way.drain(..self.way.len().saturating_sub(KEPT));
            return !has_stopped;
        }
        if let Some(excess_m) = excess_m {
            let taut_m = *self.taut_excess_m.get_or_insert(excess_m);
            self.loose_m = (excess_m - taut_m).max(0.0);
        }
        false
    }

    /// Whether cable is out that a stopped reel has left: a pull is then the friction of the loop that the robot drags.
    fn is_left_out(&self, excess_m: Option<f64>) -> bool {
        let taut_m = self.taut_excess_m.unwrap_or(0.0);
        excess_m.map_or(self.loose_m > TAUT_M, |excess_m| excess_m - taut_m > TAUT_M)
    }

    /// The cable that the map does not explain is slack, not caught: none of it counts as taut.
    pub(super) fn distrust(&mut self) {
        self.taut_excess_m = Some(0.0);
    }

    /// Cable that has become slack since it last pulled, metres.
    pub(super) fn loose_m(&self) -> f64 {
        self.loose_m
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

/// Pull up to which a cable counts as slack, newtons, if `dragged_m` metres of it may rub on the floor.
pub(super) fn little_n(reel: Option<&Reel>, dragged_m: f64) -> f64 {
    reel.map_or(LITTLE_N, |reel| (LITTLE * reel.pull_n).max(dragged_m * reel.drag(0.0).floor_n_per_m))
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

    fn working() -> ReelState<'static> {
        ReelState { reel: Some(&REEL), ..ReelState::default() }
    }

    #[test]
    fn the_pull_of_a_dragged_loop_does_not_make_a_cable_taut_that_a_stopped_reel_has_left_out() {
        let stopped = ReelState { has_stopped: true, ..working() };
        let mut slack = Slack::default();
        assert!(slack.take(Some(0.02), Some(3.0), working()));
        assert!(!slack.take(Some(0.04), Some(2.6), stopped), "it cannot be caught");
        assert!(!slack.take(Some(0.3), Some(2.6), stopped) && slack.alarm().1 > 1.0, "dragged aside");
        assert!(!slack.take(None, Some(2.6), stopped) && slack.alarm().1 > 1.0, "the position is lost");
        assert!(!slack.take(Some(0.05), Some(2.6), stopped) && slack.alarm().1 == 0.0, "taut again");
        assert!(slack.take(Some(0.3), Some(2.6), working()), "the reel works again");
        slack.distrust();
        assert!(!slack.take(Some(0.5), Some(2.6), stopped) && slack.alarm().1 > 2.0);
    }

    #[test]
    fn the_way_back_leads_to_where_the_cable_last_pulled() {
        let mut slack = Slack::default();
        for (cm, pull_n) in [(0, 3.0), (10, 3.0), (12, 3.0), (20, 0.0), (30, 0.0), (40, 0.0)] {
            slack.keep(Point::new(0.01 * f64::from(cm), 0.0));
            slack.take(Some(0.01 * f64::from(cm)), Some(pull_n), working());
        }
        let way_cm =
            |slack: &Slack| slack.way_back().map(|way| way.iter().map(|at| (at.x * 100.0).round()).collect());
        assert_eq!(way_cm(&slack), Some(vec![40.0, 30.0, 20.0, 10.0, 0.0]));
        slack.take(Some(0.2), Some(0.0), working());
        assert_eq!(way_cm(&slack), None, "the slack is small");
        slack.take(Some(0.5), Some(0.0), working());
        assert!(way_cm(&slack).is_some());
        slack.take(Some(0.5), Some(3.0), working());
        assert_eq!(way_cm(&slack), None, "taut");
    }

    #[test]
    fn cable_without_pull_is_slack_and_cable_with_pull_may_be_caught() {
        let mut slack = Slack::default();
        let share = |slack: &Slack| slack.alarm().1;
        assert!(slack.take(Some(0.1), Some(3.0), working()));
        assert!(slack.take(Some(0.9), Some(3.0), working()) && share(&slack) == 0.0, "caught, not slack");
        assert!(!slack.take(Some(1.05), Some(0.1), working()) && (0.7..0.8).contains(&share(&slack)));
        assert!(!slack.take(None, Some(0.1), working()) && share(&slack) > 0.7, "the position is lost");
        assert!(!slack.take(Some(1.11), Some(0.0), working()) && share(&slack) > 1.0);
        assert!(slack.take(Some(1.0), Some(2.0), working()) && share(&slack) == 0.0);
        let weak = Reel { pull_n: 0.5, mass_kg_per_m: 0.3, ..REEL };
        let mut dragged = Slack::default();
        assert!(dragged.take(Some(0.0), Some(0.5), ReelState { reel: Some(&weak), ..ReelState::default() }));
        assert!(
            !dragged.take(Some(0.3), Some(0.1), ReelState { reel: Some(&weak), ..ReelState::default() })
                && share(&dragged) > 1.0,
            "only its loop"
        );
        assert!(
            !dragged.take(Some(1.0), Some(0.6), ReelState { reel: Some(&weak), ..ReelState::default() }),
            "its loop has become longer"
        );
        assert!(
            !dragged.take(Some(0.0), Some(0.0), ReelState { reel: Some(&weak), ..ReelState::default() })
                && share(&dragged) == 0.0
        );
        assert!(
            dragged.take(Some(0.0), Some(0.5), ReelState { reel: Some(&weak), ..ReelState::default() }),
            "taut again"
        );
        assert!(slack.take(Some(9.0), None, working()) && share(&slack) == 0.0, "not measured");
    }
}
