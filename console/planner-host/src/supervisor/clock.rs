//! A fair measure of how long a worker has been busy: a planner is not charged for time that a busy machine takes from
//! it.

use std::time::Duration;

/// A worker that is starved of CPU time is killed after this many times its budget in wall time, but not before
/// [`LEAST_CAP`].
const MOST_BUDGETS: u32 = 10;
/// The minimum wall time before a starved worker is killed.
const LEAST_CAP: Duration = Duration::from_mins(1);

/// The state of a busy process at one check.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Load {
    /// Processor time of all threads since the process started.
    pub(super) cpu: Duration,
    /// Whether any thread is computing, is ready to compute, or is waiting for a disk.
    pub(super) is_running: bool,
}

/// The time charged against the budget of a request.
///
/// Time is charged from one check to the next. A process that needs the processor is charged the processor time that it
/// got, but never more than the wall time. A process that sleeps, is stopped or is deadlocked is charged the wall time.
/// A process with many threads is charged no more than one with a single thread.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct FairClock {
    charged: Duration,
    wall: Duration,
    cpu: Option<Duration>,
}

impl FairClock {
    /// Charges the time since the last check. `wall` is the time from the request to this check. Without a `load`, wall
    /// time is charged.
    ///
    /// The processor time that a running process used before the first check is unknown, and is not charged.
    pub(super) fn advance(&mut self, wall: Duration, load: Option<Load>) {
        let slice = wall.saturating_sub(self.wall);
        self.charged += match load {
            Some(load) if load.is_running => {
                self.cpu.map_or(Duration::ZERO, |before| load.cpu.saturating_sub(before)).min(slice)
            }
            _ => slice,
        };
        self.wall = wall;
        self.cpu = load.map(|load| load.cpu).or(self.cpu);
    }

    /// Returns the part of a budget that is left.
    pub(super) fn evaluate(&self, budget: Duration) -> Verdict {
        match budget.saturating_sub(self.charged) {
            Duration::ZERO => Verdict::Exhausted,
            _ if self.wall >= (budget * MOST_BUDGETS).max(LEAST_CAP) => Verdict::Starved,
            left => Verdict::Left(left),
        }
    }
}

/// The part of a budget that is left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    /// This much time is left.
    Left(Duration),
    /// Nothing is left.
    Exhausted,
    /// Time is left, but the process has been starved of processor time for too long to keep waiting.
    Starved,
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const MS: Duration = Duration::from_millis(1);

    /// The clock after checks every 50 ms, from 100 ms to the end, of a process that got this share of the processor.
    fn after(end_ms: u32, share: f64, is_running: bool) -> FairClock {
        let mut clock = FairClock::default();
        for wall in (100..=end_ms).step_by(50).map(|ms| MS * ms) {
            clock.advance(wall, Some(Load { cpu: wall.mul_f64(share), is_running }));
        }
        clock
    }

    fn near(clock: FairClock, ms: u32) -> bool {
        clock.charged.abs_diff(MS * ms) <= 2 * MS
    }

    #[test]
    fn a_loop_runs_out_in_wall_time_less_the_first_look() {
        assert!(near(after(3000, 1.0, true), 2900));
    }

    #[test]
    fn who_sleeps_or_is_stopped_is_charged_wall_time() {
        assert!(near(after(3000, 0.0, false), 3000));
    }

    #[test]
    fn who_is_starved_is_charged_what_it_got() {
        assert!(near(after(3000, 0.15, true), 435));
    }

    #[test]
    fn several_threads_cost_no_more_than_one() {
        assert!(near(after(3000, 4.0, true), 2900));
    }

    #[test]
    fn without_looks_wall_time_counts() {
        let mut clock = FairClock::default();
        for ms in [100, 150, 2000] {
            clock.advance(MS * ms, None);
        }
        assert_eq!(clock.evaluate(2000 * MS), Verdict::Exhausted);
        assert_eq!(clock.evaluate(2001 * MS), Verdict::Left(MS));
    }

    #[test]
    fn a_starved_process_is_killed_after_ten_budgets_and_not_before_a_minute() {
        let short = |end_ms| after(end_ms, 0.001, true).evaluate(2000 * MS);
        assert!(matches!(short(59_950), Verdict::Left(_)));
        assert_eq!(short(60_000), Verdict::Starved);
        let long = |end_ms| after(end_ms, 0.001, true).evaluate(10_000 * MS);
        assert!(matches!(long(99_950), Verdict::Left(_)));
        assert_eq!(long(100_000), Verdict::Starved);
    }

    proptest! {
        #[test]
        fn never_more_is_charged_than_passed_and_never_less_than_before(
            looks in prop::collection::vec((0_u32..200, 0_u32..400, any::<bool>()), 0..50),
        ) {
            let (mut clock, mut wall, mut cpu) = (FairClock::default(), Duration::ZERO, Duration::ZERO);
            for (slice, used, is_running) in looks {
                let before = clock.charged;
                (wall, cpu) = (wall + MS * slice, cpu + MS * used);
                clock.advance(wall, Some(Load { cpu, is_running }));
                prop_assert!(before <= clock.charged && clock.charged <= wall);
            }
        }
    }
}
