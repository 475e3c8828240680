//! The line to the terminal: how many bytes it takes, and when it is free for the next frame.
//!
//! A line that is slower than the console assumes fills the queues in front of the terminal, and then every frame, also the
//! one that shows HOLD, is seen seconds late. The console notices this because its writes wait. It then sends a frame only
//! when the line has taken the one before.

use std::sync::LazyLock;
use std::time::{Duration, Instant};
use tui::terminal::Sent;

/// The largest assumed data rate for new values, in bytes per second: on a local line, and on a line over SSH.
const LOCAL_RATE: f64 = 15_000.0;
const SSH_RATE: f64 = 9_500.0;
/// The smallest assumed rate: a slower line gets a frame from time to time.
const LEAST_RATE: f64 = 300.0;
/// A line whose measured rate is below this is slow.
const SLOW_RATE: f64 = 9_000.0;
/// The share of the measured rate that frames use, so that the queue becomes empty.
const USED: f64 = 0.8;
/// The longest time that a frame may occupy a slow line, apart from the rows that every frame contains.
const SHORT_FRAME: Duration = Duration::from_millis(200);
/// The rate is measured on at least this many bytes, and over at least and at most this time.
const MEASURED: (usize, Duration, Duration) = (1024, Duration::from_millis(200), Duration::from_mins(1));
/// A frame that takes this long had to wait until the queue in front of the terminal had room.
const WAIT: Duration = Duration::from_millis(50);
/// Bytes that may be left in the queue when a wait ends: it ends when most of the queue is free.
const LEFT: usize = 4_096;
/// The longest time that new values wait until the line is free, even after a complete redraw: on a line that is not slow,
/// and on a slow one.
const LONGEST_DEBT: Duration = Duration::from_millis(250);
const LONGEST_SLOW_DEBT: Duration = Duration::from_secs(10);

/// The time since the console began to write to the terminal.
pub(super) fn clock() -> Duration {
    static BEGAN: LazyLock<Instant> = LazyLock::new(Instant::now);
    BEGAN.elapsed()
}

/// The line to the terminal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Line {
    assumed: f64,
    /// The measured rate of a slow line, bytes per second.
    measured: Option<f64>,
    /// The bytes sent and the time passed since the end of the last wait, if that was not long ago.
    since_wait: Option<(usize, Duration)>,
    /// How long after the last frame the line is busy with it.
    busy: Duration,
}

impl Line {
    /// A line before its first frame.
    pub(super) fn new(ssh: bool) -> Self {
        let assumed = if ssh { SSH_RATE } else { LOCAL_RATE };
        Self { assumed, measured: None, since_wait: None, busy: Duration::ZERO }
    }

    /// Records a frame whose transmission ended `elapsed` after that of the frame before.
    pub(super) fn sent(&mut self, sent: Sent, elapsed: Duration) {
        let left = self.busy.saturating_sub(elapsed);
        let has_waited = sent.took >= WAIT;
        self.measure(sent.bytes, elapsed, has_waited);
        let rate = self.measured.map_or(self.assumed, |rate| (USED * rate).min(self.assumed));
        let taken = |bytes: usize| Duration::from_secs_f64(bytes as f64 / rate);
        self.busy = match self.measured {
            None => (left + taken(sent.bytes)).min(LONGEST_DEBT),
            Some(_) if has_waited => taken(LEFT).min(LONGEST_SLOW_DEBT),
            Some(_) => (left + taken(sent.bytes)).min(LONGEST_SLOW_DEBT),
        };
    }

    /// Measures the rate from the end of one wait to the end of the next: the queue is as full at both, so the line has
    /// taken what was sent in between. A single wait proves nothing: the operator may have stopped the terminal.
    fn measure(&mut self, bytes: usize, elapsed: Duration, has_waited: bool) {
        let (least_bytes, least_time, most_time) = MEASURED;
        let since = self.since_wait.map(|(sent, time)| (sent + bytes, time + elapsed));
        let since = since.filter(|(_, time)| *time <= most_time);
        let enough = since.filter(|(sent, time)| *sent >= least_bytes && *time >= least_time);
        if let Some((sent, time)) = enough.filter(|_| has_waited) {
            let rate = (sent as f64 / time.as_secs_f64()).max(LEAST_RATE);
            self.measured = Some(rate).filter(|rate| *rate < SLOW_RATE);
        }
        self.since_wait = match since {
            Some(since) if !has_waited || enough.is_none() => Some(since),
            _ if has_waited => Some((0, Duration::ZERO)),
            _ => None,
        };
    }

    /// Whether the line is too slow for the console's frames.
    pub(super) fn is_slow(&self) -> bool {
        self.measured.is_some()
    }

    /// The bytes that a slow line takes in the time of a short frame; `None` if the line is not slow.
    pub(super) fn most_bytes(&self) -> Option<usize> {
        self.measured.map(|rate| (rate * SHORT_FRAME.as_secs_f64()) as usize)
    }

    /// How long after the last frame the line is busy with it.
    pub(super) fn busy(&self) -> Duration {
        self.busy
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(bytes: usize, took_ms: u64) -> Sent {
        Sent { bytes, took: Duration::from_millis(took_ms) }
    }

    /// A line of 2 kB/s behind a queue of 20 kB, which makes room for new bytes only when it is almost empty.
    fn slow() -> Line {
        let mut line = Line::new(false);
        for _ in 0..2 {
            for _ in 0..21 {
                assert!(!line.is_slow(), "a single wait proves nothing");
                line.sent(frame(900, 0), Duration::from_millis(60));
            }
            line.sent(frame(900, 9_000), Duration::from_secs(9));
        }
        line
    }

    #[test]
    fn a_line_that_lets_the_console_wait_twice_gets_one_frame_at_a_time() {
        let mut line = slow();
        assert!(line.is_slow());
        assert!(line.measured.is_some_and(|rate| (1_900.0..2_000.0).contains(&rate)), "{line:?}");
        assert!(line.most_bytes().is_some_and(|most| (380..400).contains(&most)), "{line:?}");
        line.sent(frame(800, 0), Duration::from_secs(20));
        let one = line.busy();
        assert!(one > Duration::from_millis(500) && one < Duration::from_millis(530), "{one:?}");
        // A frame that is sent early waits for the rest of the one before.
        line.sent(frame(800, 0), Duration::from_millis(200));
        assert_eq!(line.busy() + Duration::from_millis(200), 2 * one);
    }

    #[test]
    fn a_line_that_waits_for_every_frame_is_measured_too() {
        let mut line = Line::new(false);
        for _ in 0..4 {
            line.sent(frame(600, 300), Duration::from_millis(300));
        }
        assert_eq!(line.measured, Some(2_000.0));
    }

    #[test]
    fn a_slow_line_stays_slow_while_it_takes_short_frames_at_once() {
        let mut line = slow();
        for _ in 0..100 {
            line.sent(frame(400, 0), Duration::from_secs(20));
            assert!(line.is_slow() && line.most_bytes().is_some(), "the queue may have held these frames");
        }
    }

    #[test]
    fn a_terminal_that_is_stopped_now_and_then_is_not_slow() {
        let mut line = Line::new(false);
        for _ in 0..3 {
            line.sent(frame(900, 9_000), Duration::from_secs(9));
            for _ in 0..1_000 {
                line.sent(frame(900, 0), Duration::from_millis(66));
            }
        }
        assert!(!line.is_slow(), "{line:?}");
        // A fast line that waits for large frames is not slow, either.
        for _ in 0..4 {
            line.sent(frame(20_000, 300), Duration::from_millis(400));
        }
        assert!(!line.is_slow(), "{line:?}");
    }
}
