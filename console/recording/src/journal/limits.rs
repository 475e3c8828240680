//! Limits on what a journal may demand of its reader: bytes per line, per tick and in total, and the order of time.
//!
//! No valid journal comes near these limits, however long its run. A journal that is damaged, or was made to exhaust
//! memory and time, exceeds them early. A journal within the limits costs a reader no more than a valid one of the
//! same length on disk.

use mission::{Event, EventKind};
use std::io;

/// Longest line, bytes: a plan of a million points, the most that a planner may return, with all digits.
pub(super) const MOST_LINE_BYTES: usize = 40 << 20;
/// Maximum number of bytes of lines per tick, for readers that compare whole ticks.
const MOST_TICK_BYTES: u64 = 64 << 20;
/// Maximum number of lines per tick: many times as many as two planners at their drawing limit need.
const MOST_TICK_LINES: u32 = 50_000;
/// Maximum number of obstacles found and zones drawn in a run: they all persist, and every figure has to take them
/// into account.
const MOST_LASTING: u32 = 20_000;
/// Largest ratio of the length of the lines to the length of the file. The lines of a mission on hold, which repeat
/// most, are 11 times as long as the file (decisions.md).
const MOST_EXPANSION: u64 = 200;
/// Number of bytes of lines that are allowed regardless of the ratio.
const FREE_BYTES: u64 = 16 << 20;

/// Checks that lines of this total length are plausible, given the size of the file.
pub(super) fn check_expansion(packed: u64, lines: u64) -> io::Result<()> {
    if lines <= FREE_BYTES + MOST_EXPANSION * packed {
        return Ok(());
    }
    let why = format!(
        "its first {packed} bytes unpack to more than {lines} bytes of lines, more than any run writes"
    );
    Err(io::Error::new(io::ErrorKind::InvalidData, why))
}

/// The error about a line without an end.
pub(super) fn too_long() -> String {
    format!("the line is longer than {} MB, longer than any event", MOST_LINE_BYTES >> 20)
}

/// Memory that a line may use when it is parsed as an untyped value, bytes.
const MOST_WEIGHT: usize = 32 << 20;

/// Whether a line can be parsed as an untyped value without using much more memory than its length.
pub(super) fn is_light(line: &[u8]) -> bool {
    // A line this short uses little memory, regardless of its content.
    line.len() <= MOST_WEIGHT / 200 || foreign::json_weight(line) <= MOST_WEIGHT
}

/// Maximum number of values and lists in a line that is read straight into its fields: the number in a plan of a
/// million points.
const MOST_VALUES: usize = 4_000_000;
const MOST_LISTS: usize = 1_500_000;

/// Whether a line can be read straight into its fields without using much more memory than its length.
pub(super) fn is_bearable(line: &[u8]) -> bool {
    let count = |wanted: [u8; 2]| line.iter().filter(|byte| wanted.contains(byte)).count();
    line.len() <= MOST_LISTS || (count(*b",:") <= MOST_VALUES && count(*b"[{") <= MOST_LISTS)
}

/// Checks the order of time in a journal.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pace {
    tick: u64,
    t_s: f64,
    lines: u32,
    bytes: u64,
    is_opened: bool,
    lasting: u32,
}

impl Pace {
    /// Checks the next event and the length of its line, bytes.
    ///
    /// # Errors
    /// The event cannot follow the earlier ones; the error is a sentence.
    pub(super) fn take(&mut self, event: &Event, bytes: usize) -> Result<(), String> {
        let Event { tick, t_s, kind } = event;
        if matches!(kind, EventKind::RunOpened(_)) && std::mem::replace(&mut self.is_opened, true) {
            return Err("the run is opened a second time".to_owned());
        }
        self.lasting +=
            u32::from(matches!(kind, EventKind::ObstacleFound { .. } | EventKind::ZoneDrawn { .. }));
        if self.lasting > MOST_LASTING {
            return Err(format!(
                "more than {MOST_LASTING} obstacles were found or zones drawn, more than any run has"
            ));
        }
        if *tick < self.tick || t_s.is_nan() || *t_s < self.t_s {
            return Err(format!(
                "time goes backwards: tick {tick} at {t_s} s comes after tick {} at {} s",
                self.tick, self.t_s
            ));
        }
        if *tick > self.tick {
            (self.lines, self.bytes) = (0, 0);
        }
        (self.tick, self.t_s) = (*tick, *t_s);
        self.lines += 1;
        self.bytes += bytes as u64;
        if self.lines > MOST_TICK_LINES || self.bytes > MOST_TICK_BYTES {
            return Err(format!(
                "tick {tick} has more than {MOST_TICK_LINES} lines or {} MB, more than any tick has",
                MOST_TICK_BYTES >> 20
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(tick: u64, t_s: f64) -> Event {
        Event { tick, t_s, kind: EventKind::Resumed }
    }

    #[test]
    fn time_goes_on_and_no_tick_lasts_for_ever() {
        let mut pace = Pace::default();
        for (tick, t_s) in [(0, 0.0), (0, 0.0), (1, 0.1), (7, 0.7)] {
            assert_eq!(pace.take(&event(tick, t_s), 60), Ok(()));
        }
        for (tick, t_s) in [(6, 0.7), (8, 0.6), (8, f64::NAN)] {
            assert!(pace.take(&event(tick, t_s), 60).is_err_and(|why| why.starts_with("time goes back")));
        }
        assert!((1..MOST_TICK_LINES).all(|_| pace.take(&event(8, 0.8), 60).is_ok()));
        let mut longer = pace;
        assert!(longer.take(&event(9, 0.9), 60).is_ok(), "the next tick is counted separately");
        assert!(pace.take(&event(8, 0.8), 60).is_ok() && pace.take(&event(8, 0.8), 60).is_err());
        assert!(Pace::default().take(&event(0, 0.0), MOST_TICK_BYTES as usize + 1).is_err());
    }

    #[test]
    fn a_line_of_many_small_lists_is_heavy_and_one_of_text_is_not() {
        assert!(is_light(&b"[],".repeat(100)) && is_light(&b"x".repeat(20 << 20)));
        assert!(!is_light(&b"[],".repeat(300_000)));
        assert!(is_light(&b"0.123456,".repeat(700_000)));
        assert!(is_bearable(&b"[1.25,2.125],".repeat(1_000_000)) && !is_bearable(&b"[],".repeat(2_000_000)));
    }

    #[test]
    fn what_was_packed_without_end_is_refused() {
        assert!(check_expansion(1, FREE_BYTES).is_ok() && check_expansion(1 << 20, 200 << 20).is_ok());
        assert!(check_expansion(1 << 20, 217 << 20).is_err());
    }
}
