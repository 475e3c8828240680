//! The times at which ticks are due, and how long each tick waits for answers.

use flight::answers::Window;
use std::time::{Duration, Instant};
use tui::Speed;

/// If a tick is later than this, the lost time is not made up.
const MOST_LATE: Duration = Duration::from_millis(50);

/// The number of ticks that run together while the mission rests, because waking three threads costs more than a tick.
/// Events in this phase, such as a station that falls silent, are shown at most this many ticks late.
const TOGETHER: u32 = 4;

/// The schedule of ticks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pace {
    /// When the next tick is due.
    due: Instant,
    /// The time between ticks; `None` if the next tick is due immediately.
    period: Option<Duration>,
    /// Whether ticks may run late, several at a time.
    rests: bool,
}

impl Pace {
    /// Creates a schedule whose first tick is due now.
    pub(super) fn from(now: Instant) -> Self {
        Self { due: now, period: None, rests: false }
    }

    /// Sets when the following tick is due. The mission does not run faster to make up lost time.
    ///
    /// While the mission waits for a planner or an order (`waits`), the mission runs no faster than real time.
    pub(super) fn tick_flown(&mut self, now: Instant, tick: Duration, speed: Speed, waits: bool) {
        self.period = match speed {
            Speed::Times(factor) if waits => Some(tick.div_f64(factor.min(1.0))),
            Speed::Times(factor) => Some(tick.div_f64(factor)),
            Speed::Max if waits => Some(tick),
            Speed::Max => None,
        };
        let is_late = now.saturating_duration_since(self.due) >= MOST_LATE;
        self.due = self.period.map_or(now, |period| if is_late { now } else { self.due } + period);
    }

    /// Sets whether ticks may run late, because only an order can change anything.
    pub(super) fn rest(&mut self, rests: bool) {
        self.rests = rests;
    }

    /// When the engine must wake: with orders, when the next tick is due; otherwise possibly some ticks later.
    pub(super) fn wakes_at(&self, has_orders: bool) -> Instant {
        match self.period {
            Some(period) if self.rests && !has_orders => self.due + period * (TOGETHER - 1),
            _ => self.due,
        }
    }

    /// Whether a tick that was postponed while the mission rested is still due. If so, the call counts that tick as
    /// run.
    pub(super) fn makes_up(&mut self, now: Instant) -> bool {
        let next = self.period.filter(|_| self.rests).map(|period| self.due + period);
        let is_due = next.is_some_and(|next| next <= now);
        if let Some(next) = next.filter(|_| is_due) {
            self.due = next;
        }
        is_due
    }
}

/// How long a tick waits for answers.
pub(super) fn window(tick: Duration, speed: Speed) -> Window {
    match speed {
        Speed::Times(factor) if factor <= 1.0 => Window::real_time(tick),
        Speed::Times(_) => Window::faster(tick),
        Speed::Max => Window::unbounded(tick),
    }
}

/// The speed that the mission reached over a period.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reached {
    since: Instant,
    n_ticks: u32,
}

impl Reached {
    /// Starts measuring now.
    pub(super) fn since(since: Instant) -> Self {
        Self { since, n_ticks: 0 }
    }

    /// Counts a tick.
    pub(super) fn count(&mut self) {
        self.n_ticks = self.n_ticks.saturating_add(1);
    }

    /// The mission time per wall time in this period; begins a new period.
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

    fn next_due(due: Instant, late: Duration, speed: Speed, waits: bool) -> Duration {
        let mut pace = Pace::from(due);
        pace.tick_flown(due + late, TICK, speed, waits);
        pace.wakes_at(false) - due
    }

    #[test]
    fn ticks_follow_the_pace_and_lost_time_is_not_made_up_for() {
        let due = Instant::now();
        let at = |late, speed| next_due(due, late, speed, false);
        assert_eq!(at(ms(0), Speed::Times(4.0)), ms(25));
        assert_eq!(at(ms(49), Speed::Times(4.0)), ms(25));
        assert_eq!(at(ms(50), Speed::Times(4.0)), ms(75));
        assert_eq!(at(ms(7), Speed::Max), ms(7));
        assert_eq!(at(ms(0), Speed::Times(0.5)), ms(200));
    }

    #[test]
    fn a_mission_that_waits_goes_no_faster_than_the_clock() {
        let due = Instant::now();
        let at = |speed| next_due(due, ms(0), speed, true);
        assert_eq!((at(Speed::Times(4.0)), at(Speed::Max)), (TICK, TICK));
        assert_eq!(at(Speed::Times(0.5)), ms(200));
    }

    #[test]
    fn a_mission_that_rests_flies_its_ticks_together_and_misses_none() {
        let began = Instant::now();
        let mut pace = Pace::from(began);
        pace.tick_flown(began, TICK, Speed::Times(1.0), true);
        pace.rest(true);
        assert_eq!(pace.wakes_at(false) - began, TICK * 4);
        assert_eq!(pace.wakes_at(true) - began, TICK, "an order does not wait for the others");
        let now = began + TICK * 4 + ms(3);
        let made_up = std::iter::from_fn(|| pace.makes_up(now).then_some(())).count();
        assert_eq!(made_up, 3);
        pace.tick_flown(now, TICK, Speed::Times(1.0), true);
        assert_eq!(pace.wakes_at(true) - began, TICK * 5);
    }

    #[test]
    fn a_mission_that_does_not_rest_makes_nothing_up() {
        let began = Instant::now();
        let mut pace = Pace::from(began);
        pace.tick_flown(began, TICK, Speed::Times(1.0), false);
        assert!(!pace.makes_up(began + TICK * 9));
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
