//! Limits what a planner may log, report and draw over time; what it sends in one step is limited where its answer is
//! read. The limits are measured in steps rather than in time, so that equal runs have equal journals.

use mission::Said;
use planner_api::{Drawing, LogLevel};
use std::collections::BTreeSet;

/// The maximum number of messages in one burst; every step allows one more.
const MOST: usize = 64;
/// The maximum number of distinct figures, each of which is a separate curve in the recording.
const MOST_FIGURES: usize = 128;
/// The maximum number of drawings in one burst.
const MOST_DRAWINGS: usize = 4096;
/// The number of further drawings that every step allows.
const DRAWINGS_A_STEP: usize = 512;

/// The amount that a planner may still log, report and draw.
#[derive(Debug, Clone, Default)]
pub(super) struct SaidLimit {
    logs: LogLimit,
    figures: FigureLimit,
    drawings: DrawingLimit,
}

impl SaidLimit {
    /// Drops whatever exceeds the limits from what a planner sent in a step; the first time, adds a warning.
    pub(super) fn take(&mut self, said: &mut Said) {
        self.logs.take(&mut said.logs);
        let warnings = [self.figures.take(&mut said.scalars), self.drawings.take(&mut said.drawings)];
        said.logs.extend(warnings.into_iter().flatten().map(|text| (LogLevel::Warn, text)));
    }
}

/// The names of the figures that a planner has reported.
#[derive(Debug, Clone, Default)]
struct FigureLimit {
    names: BTreeSet<String>,
    is_warned: bool,
}

impl FigureLimit {
    fn take(&mut self, figures: &mut Vec<(String, f64, String)>) -> Option<String> {
        let before = figures.len();
        figures.retain(|(name, ..)| {
            self.names.contains(name) || (self.names.len() < MOST_FIGURES && self.names.insert(name.clone()))
        });
        let is_news = figures.len() < before && !std::mem::replace(&mut self.is_warned, true);
        is_news.then(|| format!("reports more than {MOST_FIGURES} distinct figures; the rest are dropped"))
    }
}

/// The number of drawings that a planner may still make.
#[derive(Debug, Clone)]
struct DrawingLimit {
    left: usize,
    is_warned: bool,
}

impl Default for DrawingLimit {
    fn default() -> Self {
        Self { left: MOST_DRAWINGS, is_warned: false }
    }
}

impl DrawingLimit {
    fn take(&mut self, drawings: &mut Vec<Drawing>) -> Option<String> {
        self.left = (self.left + DRAWINGS_A_STEP).min(MOST_DRAWINGS);
        let is_too_much = drawings.len() > self.left;
        drawings.truncate(self.left);
        self.left -= drawings.len();
        let is_news = is_too_much && !std::mem::replace(&mut self.is_warned, true);
        is_news.then(|| format!("draws more than {DRAWINGS_A_STEP} items per step; the rest are dropped"))
    }
}

/// The number of messages that a planner may still log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct LogLimit {
    left: usize,
    /// Whether the planner has logged too much; if so, its messages are dropped until the full burst is allowed again.
    is_muted: bool,
}

impl Default for LogLimit {
    fn default() -> Self {
        Self { left: MOST, is_muted: false }
    }
}

impl LogLimit {
    /// Drops messages beyond the limit; the first time in a series it adds a warning.
    fn take(&mut self, logs: &mut Vec<(LogLevel, String)>) {
        self.left = (self.left + 1).min(MOST);
        self.is_muted &= self.left < MOST;
        if self.is_muted {
            logs.clear();
        } else if logs.len() > self.left {
            logs.truncate(self.left);
            let text = format!("logs too much; its messages in the next {MOST} steps will be dropped");
            logs.push((LogLevel::Warn, text));
            *self = Self { left: 0, is_muted: true };
        } else {
            self.left -= logs.len();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn logged(steps: usize, each: usize) -> usize {
        let mut limit = LogLimit::default();
        let messages = vec![(LogLevel::Info, String::new()); each];
        let taken = (0..steps).map(|_| {
            let mut logs = messages.clone();
            limit.take(&mut logs);
            logs.len()
        });
        taken.sum()
    }

    #[test]
    fn a_line_a_step_passes_and_a_flood_is_cut_to_about_that() {
        assert_eq!(logged(1000, 1), 1000);
        let flood = logged(6400, 64);
        assert!((6000..=6700).contains(&flood), "{flood} of 409600");
    }

    #[test]
    fn new_names_of_figures_without_end_are_dropped_and_known_ones_stay() {
        let mut limit = SaidLimit::default();
        let mut warnings = 0;
        for step in 0..100 {
            let scalars = ["known".to_owned()].into_iter().chain((0..9).map(|i| format!("{step} {i}")));
            let scalars = scalars.map(|name| (name, 1.0, String::new())).collect();
            let mut said = Said { scalars, ..Said::default() };
            limit.take(&mut said);
            assert_eq!(said.scalars[0].0, "known");
            assert_eq!(said.scalars.len() > 1, step < 15, "step {step}");
            warnings += said.logs.len();
        }
        assert_eq!(warnings, 1);
    }

    #[test]
    fn a_flood_of_drawings_is_cut_to_what_may_be_drawn_in_a_step() {
        let line = Drawing::Line {
            layer: planner_api::Layer::Other,
            from: nalgebra::Point2::origin(),
            to: nalgebra::Point2::origin(),
        };
        let mut limit = SaidLimit::default();
        let mut drawn = |n: usize| {
            let mut said = Said { drawings: vec![line; n], ..Said::default() };
            limit.take(&mut said);
            (said.drawings.len(), said.logs.len())
        };
        assert_eq!(drawn(MOST_DRAWINGS), (MOST_DRAWINGS, 0));
        assert_eq!(drawn(MOST_DRAWINGS), (DRAWINGS_A_STEP, 1));
        assert_eq!(drawn(MOST_DRAWINGS), (DRAWINGS_A_STEP, 0));
        assert_eq!(drawn(100), (100, 0));
    }

    #[test]
    fn a_planner_that_logs_too_much_is_warned_once_and_heard_again() {
        let mut limit = LogLimit::default();
        let mut logs = vec![(LogLevel::Info, String::new()); 66];
        limit.take(&mut logs);
        assert_eq!((logs.len(), logs[64].0), (65, LogLevel::Warn));
        for step in 0..65 {
            let mut logs = vec![(LogLevel::Info, String::new())];
            limit.take(&mut logs);
            assert_eq!(logs.len(), usize::from(step >= 63), "step {step}");
        }
    }
}
