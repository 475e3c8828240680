//! Performance of the screen: response time to keys, and skipped frames.

use std::{
    collections::VecDeque,
    time::{Duration, Instant},
};
use tui::{Measured, Msg};

/// The reporting interval.
const PERIOD: Duration = Duration::from_secs(1);
/// How long a key press counts. With fewer than a hundred key presses, the slowest is reported. A single slow answer is
/// then reported for less time than its alarm needs, so the alarm means that the screen stays slow.
const KEYS: Duration = Duration::from_secs(2);
/// How long a skipped frame counts.
const SKIPPED: Duration = Duration::from_secs(10);

/// Measures the performance of the screen.
pub(super) struct Measure {
    reported: Instant,
    /// The time at which the key press arrived that the next frame answers.
    key: Option<Instant>,
    /// For each key press, the time of the answer and the response time.
    answered: VecDeque<(Instant, Duration)>,
    /// The times at which frames were skipped, and the number of frames.
    skipped: VecDeque<(Instant, u32)>,
    /// The time at which the first message arrived that the next frame shows.
    changed: Option<Instant>,
}

impl Measure {
    /// Starts measuring now.
    pub(super) fn since(now: Instant) -> Self {
        let (answered, skipped) = (VecDeque::new(), VecDeque::new());
        Self { reported: now, key: None, answered, skipped, changed: None }
    }

    /// Records the arrival of a message.
    pub(super) fn arrived(&mut self, msg: &Msg, now: Instant) {
        // A message may have waited since before the process was stopped and continued.
        let now = now.max(self.reported);
        self.changed.get_or_insert(now);
        if matches!(msg, Msg::Key(_)) {
            self.key.get_or_insert(now);
        }
    }

    /// Records a drawn frame. `after` is the time since the previous frame; a frame is due every `interval` while
    /// the screen changes.
    pub(super) fn drew(&mut self, now: Instant, after: Duration, interval: Duration) {
        if let Some(key) = self.key.take() {
            self.answered.push_back((now, now - key));
        }
        // No frames are due while nothing changes.
        let waited = self.changed.take().map_or(Duration::ZERO, |changed| after.min(now - changed));
        let due = waited.div_duration_f64(interval) as u32;
        if due > 1 {
            self.skipped.push_back((now, due - 1));
        }
    }

    /// Returns a report once per period.
    pub(super) fn report(&mut self, now: Instant) -> Option<Measured> {
        if now.saturating_duration_since(self.reported) < PERIOD {
            return None;
        }
        self.reported = now;
        self.answered.retain(|(at, _)| now.saturating_duration_since(*at) < KEYS);
        self.skipped.retain(|(at, _)| now.saturating_duration_since(*at) < SKIPPED);
        let mut times: Vec<Duration> = self.answered.iter().map(|(_, took)| *took).collect();
        times.sort_unstable();
        let response = times.get((times.len() * 99).div_ceil(100).saturating_sub(1));
        Some(Measured::Screen {
            response_ms: response.map(|took| took.as_secs_f64() * 1e3),
            skipped: self.skipped.iter().map(|(_, count)| count).sum(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tui::{Key, RunId, RunMsg};

    const FRAME: Duration = Duration::from_millis(33);

    fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    #[test]
    fn the_slowest_of_a_hundred_keys_is_not_reported() {
        let began = Instant::now();
        let mut measure = Measure::since(began);
        for number in 0..100 {
            let at = began + ms(10 * number);
            measure.arrived(&Msg::Key(Key::Up.into()), at);
            measure.drew(at + if number == 7 { ms(80) } else { ms(5) + ms(number % 2) }, ms(8), FRAME);
        }
        assert_eq!(measure.report(began + ms(999)), None);
        let taken = |measure: &mut Measure, after| match measure.report(began + after) {
            Some(Measured::Screen { response_ms, skipped }) => (response_ms, skipped),
            _ => panic!("a report is due"),
        };
        assert_eq!(taken(&mut measure, ms(1000)), (Some(6.0), 0));
        assert_eq!(taken(&mut measure, ms(32_000)), (None, 0));
    }

    #[test]
    fn a_single_slow_answer_is_reported_for_less_time_than_the_alarm_needs() {
        let began = Instant::now();
        let mut measure = Measure::since(began);
        measure.arrived(&Msg::Key(Key::Up.into()), began + ms(900));
        measure.drew(began + ms(990), ms(90), FRAME);
        let reports = (1..6).map(|second| measure.report(began + ms(1000 * second)));
        let slow = reports.filter(|report| {
            matches!(report, Some(Measured::Screen { response_ms: Some(response_ms), .. }) if *response_ms > 33.0)
        });
        let slow_s = (slow.count() - 1) as f64;
        assert!(slow_s < tui::model::health::RESPONSE_MS.moving.on_delay_s, "{slow_s} s");
    }

    #[test]
    fn a_key_that_came_before_the_measurement_began_counts_from_then_on() {
        let stopped = Instant::now();
        let continued = stopped + ms(20_000);
        let mut measure = Measure::since(continued);
        measure.arrived(&Msg::Key(Key::Up.into()), stopped);
        measure.drew(continued + ms(5), ms(20_005), FRAME);
        let expected = Measured::Screen { response_ms: Some(5.0), skipped: 0 };
        assert_eq!(measure.report(continued + ms(1000)), Some(expected));
    }

    #[test]
    fn only_frames_that_something_waited_for_are_skipped() {
        let began = Instant::now();
        let mut measure = Measure::since(began);
        let events = Msg::Run(RunId(1), RunMsg::Events(Vec::new()));
        measure.arrived(&events, began + ms(5000));
        measure.drew(began + ms(5033), ms(5033), FRAME);
        assert_eq!(
            measure.report(began + ms(5100)),
            Some(Measured::Screen { response_ms: None, skipped: 0 })
        );
        measure.arrived(&events, began + ms(5100));
        measure.drew(began + ms(5200), ms(166), FRAME);
        assert_eq!(
            measure.report(began + ms(6200)),
            Some(Measured::Screen { response_ms: None, skipped: 2 })
        );
    }
}
