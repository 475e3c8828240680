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
    /// The number of ticks made up since the last tick that was run on time.
    n_made_up: u32,
}

impl Pace {
    /// Creates a schedule whose first tick is due now.
    pub(super) fn from(now: Instant) -> Self {
        Self { due: now, period: None, rests: false, n_made_up: 0 }
    }

    /// Sets when the following tick is due. The mission does not run faster to make up lost time.
    ///
    /// While the mission waits for a planner or an order (`waits`), the mission runs no faster than real time.
    pub(super) fn tick_flown(&mut self, now: Instant, tick: Duration, speed: Speed, waits: bool) {
        (self.period, self.n_made_up) = (period(tick, speed, waits), 0);
        let is_late = now.saturating_duration_since(self.due) >= MOST_LATE;
        self.due = self.period.map_or(now, |period| if is_late { now } else { self.due } + period);
    }

    /// Sets whether ticks may run late, because only an order can change anything. A mission that begins to rest runs no
    /// faster than real time from then on, whatever its speed was; ticks that were due before are not made up.
    pub(super) fn rest(&mut self, now: Instant, rests: bool, tick: Duration, speed: Speed) {
        if rests && !self.rests {
            let period = period(tick, speed, true);
            (self.period, self.n_made_up) = (period, 0);
            self.due = now + period.unwrap_or(tick);
        }
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
    /// run. Only the ticks that run together are made up: on a busy machine, making up more would delay every request.
    pub(super) fn makes_up(&mut self, now: Instant) -> bool {
        let may_make_up = self.rests && self.n_made_up + 1 < TOGETHER;
        let next = self.period.filter(|_| may_make_up).map(|period| self.due + period);
        let is_due = next.is_some_and(|next| next <= now);
        if let Some(next) = next.filter(|_| is_due) {
            (self.due, self.n_made_up) = (next, self.n_made_up + 1);
        }
        is_due
    }
}

/// The time between ticks; `None` if the next tick is due immediately. A mission that waits runs no faster than real time.
fn period(tick: Duration, speed: Speed, waits: bool) -> Option<Duration> {
    match speed {
        Speed::Times(factor) if waits => Some(tick.div_f64(factor.min(1.0))),
        Speed::Times(factor) => Some(tick.div_f64(factor)),
        Speed::Max if waits => Some(tick),
        Speed::Max => None,
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
        pace.rest(began, true, TICK, Speed::Times(1.0));
        assert_eq!(pace.wakes_at(false) - began, TICK * 4);
        assert_eq!(pace.wakes_at(true) - began, TICK, "an order does not wait for the others");
        let now = began + TICK * 4 + ms(3);
        let made_up = std::iter::from_fn(|| pace.makes_up(now).then_some(())).count();
        assert_eq!(made_up, 3);
        pace.tick_flown(now, TICK, Speed::Times(1.0), true);
        assert_eq!(pace.wakes_at(true) - began, TICK * 5);
    }

    /// Flies a mission that is held at this speed on a machine that needs 5 ms for each tick; returns how many ticks the
    /// engine makes up before it looks at its requests again, at each of some wake-ups, and the mission time that has passed
    /// for the wall time.
    fn held_at(speed: Speed, n_wake_ups: u32) -> (Vec<u32>, f64) {
        let mut now = Instant::now();
        let mut pace = Pace::from(now);
        pace.tick_flown(now, TICK, speed, false);
        let (began, mut n_ticks, mut made_up) = (now, 0, Vec::new());
        for _ in 0..n_wake_ups {
            now += ms(5);
            pace.rest(now, true, TICK, speed);
            now = now.max(pace.wakes_at(false));
            let mut n = 0;
            while n < 1000 && pace.makes_up(now) {
                (n, now) = (n + 1, now + ms(5));
            }
            pace.tick_flown(now, TICK, speed, true);
            (n_ticks, now) = (n_ticks + n + 1, now + ms(5));
            made_up.push(n);
        }
        (made_up, (TICK * n_ticks).div_duration_f64(now - began))
    }

    #[test]
    fn a_hold_at_high_speed_ends_the_high_speed_even_on_a_busy_machine() {
        for speed in [Speed::Times(64.0), Speed::Times(4.0), Speed::Max, Speed::Times(1.0)] {
            let (made_up, reached) = held_at(speed, 50);
            assert!(made_up.iter().all(|n| *n < TOGETHER), "{speed:?}: {made_up:?}");
            assert!((0.9..1.1).contains(&reached), "{speed:?}: {reached} times real time");
        }
    }

    #[test]
    fn a_long_absence_while_the_mission_rests_is_not_made_up() {
        let began = Instant::now();
        let mut pace = Pace::from(began);
        pace.tick_flown(began, TICK, Speed::Times(1.0), true);
        pace.rest(began, true, TICK, Speed::Times(1.0));
        let late = began + TICK * 1000;
        let n = std::iter::from_fn(|| pace.makes_up(late).then_some(())).count();
        assert_eq!(n, 3);
        pace.tick_flown(late, TICK, Speed::Times(1.0), true);
        assert_eq!(pace.wakes_at(true) - late, TICK, "what was due before is dropped");
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
