//! Checks that the vehicle stands still after a stop: only measured motion can confirm this.

use crate::wire::message::{Hello, Odometry};

/// A vehicle that moves no faster than this counts as standing still, metres and radians per second.
const STILL_M_PER_S: f64 = 0.005;
const STILL_RAD_PER_S: f64 = 0.02;
/// Number of readings in a row without motion that confirm a standstill.
const STILL_READINGS: u32 = 3;
/// Time that a vehicle may take to stop, as a multiple of the stop time that it states.
const STOP_TIMES: f64 = 2.0;
/// Minimum time that a vehicle is given to stop, seconds, because its readings may arrive late.
const STOP_LEAST_S: f64 = 0.5;

/// The effect of a stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Hold {
    /// The vehicle may drive.
    NotAsked,
    /// The vehicle has been commanded to stand still, and the time that it may take has not run out.
    Stopping,
    /// The vehicle stands still, as its readings show.
    Held {
        /// Time from the stop to the first of the readings without motion, seconds.
        after_s: f64,
    },
    /// The vehicle still moves, or its motion is unknown.
    NotConfirmed,
    /// The vehicle moved again after a standstill.
    MovedAgain,
}

/// Watches a stop.
#[derive(Debug, Clone, Default)]
pub struct Stopping {
    /// Times at which the stop was commanded and sent; a stream that takes no bytes delays the sending.
    asked_s: Option<f64>,
    sent_s: Option<f64>,
    /// Readings in a row without motion, and the time of the first.
    still: u32,
    still_since_s: f64,
    /// The time of the standstill after the stop.
    held_after_s: Option<f64>,
}

impl Stopping {
    /// A stop was commanded; only the first one begins.
    pub fn ask(&mut self, now_s: f64) {
        if self.asked_s.is_none() {
            *self = Self { asked_s: Some(now_s), ..Self::default() };
        }
    }

    /// The commanded stop was sent. Only readings that were taken after this can show its effect.
    pub fn sent(&mut self, now_s: f64) {
        self.sent_s.get_or_insert(now_s);
    }

    /// Time at which the stop was commanded, seconds.
    pub fn asked_s(&self) -> Option<f64> {
        self.asked_s
    }

    /// A drive was sent.
    pub fn release(&mut self) {
        *self = Self::default();
    }

    /// Takes a measured motion, at a time of the console's clock.
    pub fn moved(&mut self, motion: &Odometry, taken_s: f64) {
        let Some(asked_s) = self.asked_s.filter(|_| self.sent_s.is_some_and(|sent_s| taken_s >= sent_s))
        else {
            return;
        };
        if !stands(motion) {
            self.still = 0;
            return;
        }
        if self.still == 0 {
            self.still_since_s = taken_s;
        }
        self.still = self.still.saturating_add(1);
        if self.still == STILL_READINGS {
            self.held_after_s = Some(self.still_since_s - asked_s);
        }
    }

    /// The effect of the stop; `limit_s` is the time that the vehicle may take to stop, seconds.
    pub fn state(&self, now_s: f64, limit_s: f64) -> Hold {
        let Some(asked_s) = self.asked_s else { return Hold::NotAsked };
        match self.held_after_s {
            Some(after_s) if self.still >= STILL_READINGS => Hold::Held { after_s },
            Some(_) => Hold::MovedAgain,
            None if now_s - asked_s > limit_s => Hold::NotConfirmed,
            None => Hold::Stopping,
        }
    }

    /// The time that a vehicle may take to stop, seconds: twice its measured stop time, but at least the time that its
    /// readings need to show a standstill over a link with this round trip.
    pub fn limit_s(hello: &Hello, trip_s: f64) -> f64 {
        let told_s = f64::from(STILL_READINGS + 1) * hello.period_s + trip_s;
        (STOP_TIMES * hello.stop_time_s).max(told_s).max(STOP_LEAST_S)
    }
}

fn stands(motion: &Odometry) -> bool {
    motion.forward_m.hypot(motion.sideways_m) <= STILL_M_PER_S * motion.over_s
        && motion.turn_rad.abs() <= STILL_RAD_PER_S * motion.over_s
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion(m_per_s: f64, rad_per_s: f64) -> Odometry {
        Odometry { over_s: 0.1, forward_m: 0.1 * m_per_s, sideways_m: 0.0, turn_rad: 0.1 * rad_per_s }
    }

    #[test]
    fn three_readings_without_motion_confirm_a_stop() {
        let mut stopping = Stopping::default();
        assert_eq!(stopping.state(0.0, 1.0), Hold::NotAsked);
        stopping.moved(&motion(0.0, 0.0), 0.9);
        stopping.ask(1.0);
        stopping.ask(1.1);
        // It waits in the console for 0.05 s; readings from before that may be from a vehicle that has not begun to move.
        (0..3).for_each(|_| stopping.moved(&motion(0.0, 0.0), 1.04));
        stopping.sent(1.05);
        (0..3).for_each(|_| stopping.moved(&motion(0.0, 0.0), 1.04));
        for (taken_s, m_per_s) in [(1.1, 0.3), (1.2, 0.0), (1.3, 0.006), (1.4, 0.0), (1.5, 0.004)] {
            stopping.moved(&motion(m_per_s, 0.0), taken_s);
        }
        assert_eq!(stopping.state(1.9, 1.0), Hold::Stopping);
        assert_eq!(stopping.state(2.1, 1.0), Hold::NotConfirmed);
        stopping.moved(&motion(0.0, 0.019), 1.6);
        let Hold::Held { after_s } = stopping.state(9.0, 1.0) else { panic!("it stands") };
        assert!((after_s - 0.4).abs() < 1e-12);
        stopping.release();
        assert_eq!(stopping.state(9.0, 1.0), Hold::NotAsked);
    }

    #[test]
    fn turning_on_the_spot_is_not_standing_and_moving_after_a_stop_is_named() {
        let mut stopping = Stopping::default();
        stopping.ask(0.0);
        stopping.sent(0.0);
        (1..=9).for_each(|n| stopping.moved(&motion(0.0, 0.2), 0.1 * f64::from(n)));
        assert_eq!(stopping.state(1.1, 1.0), Hold::NotConfirmed);
        (1..=3).for_each(|n| stopping.moved(&motion(0.0, 0.0), 1.0 + 0.1 * f64::from(n)));
        assert!(matches!(stopping.state(1.3, 1.0), Hold::Held { .. }));
        stopping.moved(&motion(0.1, 0.0), 1.4);
        assert_eq!(stopping.state(1.4, 1.0), Hold::MovedAgain);
        for n in 5..=7 {
            assert_eq!(stopping.state(1.4, 1.0), Hold::MovedAgain, "{n}");
            stopping.moved(&motion(0.0, 0.0), 1.0 + 0.1 * f64::from(n));
        }
        let Hold::Held { after_s } = stopping.state(1.7, 1.0) else { panic!("it stands again") };
        assert!((after_s - 1.5).abs() < 1e-12);
    }
}
