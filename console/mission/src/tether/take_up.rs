//! Whether the reel pulls at all.
//!
//! A reel that works keeps its pull on the cable, whether it takes the cable up, pays it out or rests; one that is too weak for
//! the cable keeps it, too. A reel that has stopped does not. So a sensor at the reel tells a stopped reel from a caught cable.
//! Without one, a caught cable shows at the robot: it was drawn off the reel against the reel's pull.

use world::{Readings, tether::Reel};

/// Share of the reel's pull below which the reel counts as stopped.
const IDLE: f64 = 0.5;
/// How long the pull must contradict what is known of the reel, seconds.
const CONTRADICTED_S: f64 = 1.0;
/// Length off the reel, metres, up to which nothing is concluded: a cable that is reeled in does not pull.
const LEAST_OUT_M: f64 = 0.5;
/// Length that the reel takes up between two readings, metres, above which it counts as working, whatever it pulls: it draws in
/// cable that lies loose.
const TAKEN_UP_M: f64 = 0.005;

/// Whether the reel has stopped. A stopped reel counts as stopped until its pull, or the cable that it takes up, says otherwise.
#[derive(Clone, Debug, Default)]
pub(super) struct TakeUp {
    has_stopped: bool,
    /// How long the readings have contradicted this, seconds.
    contradicted_s: f64,
    /// Whether the reel was last seen to pull, by a sensor of its own.
    is_seen_to_pull: bool,
    /// Largest pull at the robot since the length off the reel was last as expected, newtons.
    most_n: f64,
    out_m: Option<f64>,
}

impl TakeUp {
    /// Processes the readings after some time has passed.
    pub(super) fn take(&mut self, readings: &Readings, reel: Option<&Reel>, passed_s: f64) {
        let out_m = readings.paid_out_m.filter(|out_m| out_m.is_finite());
        let before_m = std::mem::replace(&mut self.out_m, out_m);
        let (Some(reel), Some(out_m)) = (reel, out_m) else { return };
        let robot_n = readings.robot_pull_n.filter(|pull_n| pull_n.is_finite());
        self.most_n = self.most_n.max(robot_n.unwrap_or(0.0));
        let takes_up = before_m.is_some_and(|before_m| before_m - out_m > TAKEN_UP_M);
        let at_reel = readings.reel_pull_n.filter(|pull_n| pull_n.is_finite());
        self.is_seen_to_pull = at_reel.is_some_and(|pull_n| pull_n >= IDLE * reel.pull_n);
        let works = match (at_reel, robot_n) {
            _ if takes_up => Some(true),
            _ if out_m < LEAST_OUT_M => None,
            (Some(_), _) => Some(self.is_seen_to_pull),
            // The robot draws the cable out against the pull of the reel.
            (None, Some(robot_n)) if robot_n >= reel.pull_n => Some(true),
            (None, _) => None,
        };
        let is_contradicted = works.is_some_and(|works| works == self.has_stopped);
        self.contradicted_s = if is_contradicted { self.contradicted_s + passed_s } else { 0.0 };
        if self.contradicted_s > CONTRADICTED_S {
            (self.has_stopped, self.contradicted_s) = (!self.has_stopped, 0.0);
        }
    }

    /// The length off the reel is as expected.
    pub(super) fn expect(&mut self) {
        self.most_n = 0.0;
    }

    /// Whether a cable of which more is out than expected can be caught: it was drawn off the reel against its pull. If the
    /// pull at the robot contradicts this, the reel has stopped. A reel that is too weak for the cable leaves it lying, too:
    /// its pull does not reach a robot that feels little of it.
    pub(super) fn can_be_caught(
        &mut self,
        readings: &Readings,
        reel: Option<&Reel>,
        is_too_weak: bool,
    ) -> bool {
        let Some((reel, robot_n)) = reel.zip(readings.robot_pull_n) else { return !self.has_stopped };
        if readings.reel_pull_n.is_none() && self.most_n < IDLE * reel.pull_n {
            self.has_stopped = true;
        }
        let is_left_lying = is_too_weak && robot_n < IDLE * reel.pull_n;
        !(self.has_stopped || is_left_lying)
    }

    /// Whether the reel has stopped, as far as it is known.
    pub(super) fn has_stopped(&self) -> bool {
        self.has_stopped
    }

    /// Whether a sensor at the reel shows that it pulls.
    pub(super) fn is_seen_to_pull(&self) -> bool {
        self.is_seen_to_pull && !self.has_stopped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REEL: Reel = Reel {
        mass_kg_per_m: 0.2,
        floor_friction: 0.3,
        pull_n: 10.0,
        pay_out_n: 0.5,
        robot_pull_n: None,
        pull_ratio_max: 0.8,
    };

    fn readings(out_m: f64, reel_n: Option<f64>, robot_n: Option<f64>) -> Readings {
        Readings {
            paid_out_m: Some(out_m),
            reel_pull_n: reel_n,
            robot_pull_n: robot_n,
            ..Readings::default()
        }
    }

    fn after(take_up: &mut TakeUp, at: &Readings, seconds: f64) -> bool {
        (0..(seconds / 0.1) as usize).for_each(|_| take_up.take(at, Some(&REEL), 0.1));
        take_up.has_stopped()
    }

    #[test]
    fn a_reel_without_pull_has_stopped_until_it_pulls_again_or_takes_cable_up() {
        let mut take_up = TakeUp::default();
        assert!(
            !after(&mut take_up, &readings(5.0, Some(10.0), Some(12.0)), 5.0) && take_up.is_seen_to_pull()
        );
        assert!(!after(&mut take_up, &readings(5.0, Some(0.5), Some(2.6)), 0.9), "for a moment");
        assert!(after(&mut take_up, &readings(5.0, Some(0.5), Some(2.6)), 0.5), "the robot drags the cable");
        assert!(
            after(&mut take_up, &readings(5.0, None, Some(2.6)), 9.0),
            "not measured at the reel any more"
        );
        assert!(!after(&mut take_up, &readings(5.0, Some(9.0), Some(2.6)), 1.3), "it pulls again");
        assert!(after(&mut take_up, &readings(5.0, Some(0.1), None), 1.3));
        for k in 0..15 {
            take_up.take(&readings(5.0 - 0.08 * f64::from(k), Some(0.1), None), Some(&REEL), 0.1);
        }
        assert!(!take_up.has_stopped(), "it draws in loose cable, which does not pull");
    }

    #[test]
    fn a_cable_that_is_reeled_in_or_a_reel_that_is_not_described_says_nothing() {
        let mut take_up = TakeUp::default();
        assert!(!after(&mut take_up, &readings(0.2, Some(0.0), Some(0.0)), 9.0));
        assert!(!after(&mut take_up, &readings(f64::NAN, Some(0.0), Some(0.0)), 9.0));
        (0..50).for_each(|_| take_up.take(&readings(5.0, Some(0.0), Some(0.0)), None, 0.1));
        assert!(!take_up.has_stopped());
    }

    #[test]
    fn without_a_sensor_at_the_reel_a_cable_that_was_never_drawn_against_its_pull_is_not_caught() {
        let caught = |most_n: f64, then_n: f64| {
            let mut take_up = TakeUp::default();
            after(&mut take_up, &readings(5.0, None, Some(50.0)), 1.0);
            take_up.expect();
            after(&mut take_up, &readings(6.0, None, Some(most_n)), 1.0);
            let now = readings(6.0, None, Some(then_n));
            after(&mut take_up, &now, 1.0);
            take_up.can_be_caught(&now, Some(&REEL), false)
        };
        assert!(caught(12.0, 1.0) && !caught(2.6, 1.0));
        let unfelt = readings(6.0, None, None);
        assert!(TakeUp::default().can_be_caught(&unfelt, Some(&REEL), true), "not measured");
    }

    #[test]
    fn a_cable_that_a_weak_reel_leaves_lying_is_not_caught_unless_the_robot_feels_its_pull() {
        let caught = |reel_n: Option<f64>, robot_n: f64, is_too_weak: bool| {
            let mut take_up = TakeUp::default();
            after(&mut take_up, &readings(6.0, reel_n, Some(12.0)), 1.0);
            let now = readings(6.8, reel_n, Some(robot_n));
            after(&mut take_up, &now, 5.0);
            take_up.can_be_caught(&now, Some(&REEL), is_too_weak)
        };
        assert!(!caught(Some(10.0), 1.0, true) && !caught(None, 1.0, true));
        assert!(caught(Some(10.0), 11.0, true), "the robot draws against the pull of the reel");
        assert!(caught(Some(10.0), 1.0, false), "the reel is strong enough: something else holds the cable");
    }
}
