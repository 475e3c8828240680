//! When ticks are due, and how long each waits for answers.

use flight::answers::Window;
use std::time::{Duration, Instant};
use tui::Speed;

/// A tick that is later than this is not made up for.
const MOST_LATE: Duration = Duration::from_millis(50);

/// When the tick after one that was due at `due` is due; time that was lost is not made up for by rushing.
///
/// While the mission waits (`waits`: for a planner, or for an order), its time passes no faster than the clock.
pub(super) fn next_due(due: Instant, now: Instant, tick: Duration, speed: Speed, waits: bool) -> Instant {
    let pace = match speed {
        Speed::Times(factor) if waits => tick.div_f64(factor.min(1.0)),
        Speed::Times(factor) => tick.div_f64(factor),
        Speed::Max if waits => tick,
        Speed::Max => return now,
    };
    if now.saturating_duration_since(due) < MOST_LATE { due + pace } else { now + pace }
}

/// How long a tick waits for answers.
pub(super) fn window(tick: Duration, speed: Speed) -> Window {
    match speed {
        Speed::Times(factor) if factor <= 1.0 => Window::real_time(tick),
        Speed::Times(_) => Window::faster(tick),
        Speed::Max => Window::unbounded(tick),
    }
}

/// How fast the mission has gone, measured over a period.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reached {
    since: Instant,
    n_ticks: u32,
}

impl Reached {
    /// Measures from now on.
    pub(super) fn since(since: Instant) -> Self {
        Self { since, n_ticks: 0 }
    }

    /// A tick was flown.
    pub(super) fn count(&mut self) {
        self.n_ticks = self.n_ticks.saturating_add(1);
    }

    /// How many times as fast as the clock the mission went, and a new period.
    pub(super) fn take(&mut self, now: Instant, tick: Duration) -> f64 {
        let wall = now.saturating_duration_since(self.since).max(Duration::from_nanos(1));
        let factor = (tick * self.n_ticks).div_duration_f64(wall);
        *self = Self::since(now);
        factor
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICK: Duration = Duration::from_millis(100);

    fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    #[test]
    fn ticks_follow_the_pace_and_lost_time_is_not_made_up_for() {
        let due = Instant::now();
        let at = |late, speed| next_due(due, due + late, TICK, speed, false) - due;
        assert_eq!(at(ms(0), Speed::Times(4.0)), ms(25));
        assert_eq!(at(ms(49), Speed::Times(4.0)), ms(25));
        assert_eq!(at(ms(50), Speed::Times(4.0)), ms(75));
        assert_eq!(at(ms(7), Speed::Max), ms(7));
        assert_eq!(at(ms(0), Speed::Times(0.5)), ms(200));
    }

    #[test]
    fn a_mission_that_waits_goes_no_faster_than_the_clock() {
        let due = Instant::now();
        let at = |speed| next_due(due, due, TICK, speed, true) - due;
        assert_eq!((at(Speed::Times(4.0)), at(Speed::Max)), (TICK, TICK));
        assert_eq!(at(Speed::Times(0.5)), ms(200));
    }

    #[test]
    fn what_was_reached_is_mission_time_by_wall_time_of_each_period() {
        let began = Instant::now();
        let mut reached = Reached::since(began);
        (0..10).for_each(|_| reached.count());
        let taken = [ms(500), ms(1000)].map(|at| reached.take(began + at, TICK));
        assert!((taken[0] - 2.0).abs() < 1e-9 && taken[1] == 0.0, "{taken:?}");
    }
}
