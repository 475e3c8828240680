//! The services of the console that a planner may use during a call: deadline, progress, drawings, figures, log.

use crate::{Code, Drawing, Layer, PlannerError, Result};
use nalgebra::{Point2, Vector2};
use std::{fmt, time::Duration};

/// The reason why a planner must stop working.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StopReason {
    /// The console no longer needs the answer.
    Cancelled,
    /// The deadline has passed.
    Timeout,
}

/// The severity of a log message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(test, derive(strum::EnumCount))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[repr(u32)]
pub enum LogLevel {
    /// Of interest only to the planner's author.
    Debug = 0,
    /// For the operator's information.
    Info = 1,
    /// Needs the operator's attention.
    Warn = 2,
}

impl fmt::Display for LogLevel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Debug => "debug",
            Self::Info => "info",
            Self::Warn => "warning",
        })
    }
}

/// What the host offers during a call. The glue implements this trait with the functions of the C ABI; tests implement
/// it in memory.
pub trait Services {
    /// The reason to stop, if there is one.
    fn stop(&self) -> Option<StopReason>;
    /// Time until the deadline.
    fn time_left(&self) -> Duration;
    /// Whether drawings are shown.
    fn wants_drawing(&self) -> bool;
    /// Accepts drawings.
    fn draw(&self, drawings: &[Drawing]);
    /// Accepts a named figure for this tick.
    fn scalar(&self, name: &str, value: f64, unit: &str);
    /// Accepts the progress of a plan: the share done, and the current activity.
    fn progress(&self, share: f64, what: &str);
    /// Accepts a log message.
    fn log(&self, level: LogLevel, message: &str);
}

/// The host's services during one call.
#[derive(Clone, Copy)]
pub struct Ctx<'a> {
    services: &'a dyn Services,
}

impl<'a> Ctx<'a> {
    /// Wraps services for the duration of a call.
    ///
    /// ```
    /// use planner_api::{Ctx, testing::Bench};
    ///
    /// let bench = Bench::new();
    /// Ctx::new(&bench).scalar("clearance", 0.35, "m");
    /// assert_eq!(bench.scalar("clearance"), Some(0.35));
    /// ```
    pub fn new(services: &'a dyn Services) -> Self {
        Self { services }
    }

    /// Returns an error if the planner must stop. Call this in every loop: it costs only one clock read.
    ///
    /// ```
    /// use planner_api::{Code, StopReason, testing::Bench};
    ///
    /// let bench = Bench::new();
    /// assert!(bench.ctx().check().is_ok());
    /// bench.stop_with(StopReason::Cancelled);
    /// assert_eq!(bench.ctx().check().unwrap_err().code, Code::Cancelled);
    /// ```
    ///
    /// # Errors
    /// [`Code::Cancelled`] or [`Code::Timeout`]; pass the error on with `?`.
    pub fn check(&self) -> Result<()> {
        match self.services.stop() {
            None => Ok(()),
            Some(StopReason::Cancelled) => {
                Err(PlannerError::new(Code::Cancelled, "cancelled by the console"))
            }
            Some(StopReason::Timeout) => Err(PlannerError::new(Code::Timeout, "the deadline has passed")),
        }
    }

    /// Returns the time until the deadline.
    ///
    /// ```
    /// use planner_api::{StopReason, testing::Bench};
    ///
    /// let bench = Bench::new();
    /// assert_eq!(bench.ctx().time_left().as_secs(), 3600);
    /// bench.stop_with(StopReason::Timeout);
    /// assert!(bench.ctx().time_left().is_zero());
    /// ```
    pub fn time_left(&self) -> Duration {
        self.services.time_left()
    }

    /// Whether drawings are shown. If they are not, skip drawings that are costly to make.
    ///
    /// ```
    /// use planner_api::{Layer, Point2, testing::Bench};
    ///
    /// let bench = Bench::new();
    /// bench.look_away();
    /// if bench.ctx().wants_drawing() {
    ///     bench.ctx().circle(Layer::Other, Point2::origin(), 1.0);
    /// }
    /// assert!(bench.drawings().is_empty());
    /// ```
    pub fn wants_drawing(&self) -> bool {
        self.services.wants_drawing()
    }

    /// Draws an arrow from the point `at`.
    ///
    /// ```
    /// use planner_api::{Drawing, Layer, Point2, Vector2, testing::Bench};
    ///
    /// let (bench, at, vector) = (Bench::new(), Point2::new(1.0, 2.0), Vector2::new(0.5, 0.0));
    /// bench.ctx().arrow(Layer::Repulsion, at, vector);
    /// assert_eq!(bench.drawings(), [Drawing::Arrow { layer: Layer::Repulsion, at, vector }]);
    /// ```
    pub fn arrow(&self, layer: Layer, at: Point2<f64>, vector: Vector2<f64>) {
        self.services.draw(&[Drawing::Arrow { layer, at, vector }]);
    }

    /// Draws a circle.
    ///
    /// ```
    /// use planner_api::{Drawing, Layer, Point2, testing::Bench};
    ///
    /// let (bench, center) = (Bench::new(), Point2::new(1.0, 2.0));
    /// bench.ctx().circle(Layer::Virtual, center, 0.5);
    /// assert_eq!(bench.drawings(), [Drawing::Circle { layer: Layer::Virtual, center, radius_m: 0.5 }]);
    /// ```
    pub fn circle(&self, layer: Layer, center: Point2<f64>, radius_m: f64) {
        self.services.draw(&[Drawing::Circle { layer, center, radius_m }]);
    }

    /// Draws a line through points.
    ///
    /// ```
    /// use planner_api::{Layer, Point2, testing::Bench};
    ///
    /// let bench = Bench::new();
    /// let corners = [Point2::new(0.0, 0.0), Point2::new(1.0, 0.0), Point2::new(1.0, 1.0)];
    /// bench.ctx().polyline(Layer::Path, &corners);
    /// assert_eq!(bench.drawings().len(), 2, "one line from each corner to the next");
    /// ```
    pub fn polyline(&self, layer: Layer, points: &[Point2<f64>]) {
        let pieces: Vec<Drawing> =
            points.windows(2).map(|w| Drawing::Line { layer, from: w[0], to: w[1] }).collect();
        self.services.draw(&pieces);
    }

    /// Reports a named figure for this tick; the console plots it.
    ///
    /// ```
    /// use planner_api::testing::Bench;
    ///
    /// let bench = Bench::new();
    /// bench.ctx().scalar("potential", 1.5, "J");
    /// assert_eq!(bench.scalars(), [("potential".to_owned(), 1.5, "J".to_owned())]);
    /// ```
    pub fn scalar(&self, name: &str, value: f64, unit: &str) {
        self.services.scalar(name, value, unit);
    }

    /// Reports the progress of a plan while it is being computed: the share done, from 0 to 1 and roughly proportional
    /// to time, and the current activity in a few plain words (`candidate 3 of 8`). The console shows the progress
    /// while it waits for the plan, and does not store it; progress reported outside `plan` is ignored. Call this as
    /// often as you like: updates that come faster than people can read are dropped.
    ///
    /// ```
    /// use planner_api::testing::Bench;
    ///
    /// let bench = Bench::new();
    /// for done in 1..=4 {
    ///     bench.ctx().progress(f64::from(done) / 4.0, &format!("candidate {done} of 4"));
    /// }
    /// assert_eq!(bench.progress()[1], (0.5, "candidate 2 of 4".to_owned()));
    /// ```
    pub fn progress(&self, share: f64, what: &str) {
        self.services.progress(share, what);
    }

    /// Writes a message to the operator's event log.
    ///
    /// ```
    /// use planner_api::{LogLevel, testing::Bench};
    ///
    /// let bench = Bench::new();
    /// bench.ctx().log(LogLevel::Warn, "0.4 m² of the floor is left out");
    /// assert_eq!(bench.logs()[0].0, LogLevel::Warn);
    /// ```
    pub fn log(&self, level: LogLevel, message: &str) {
        self.services.log(level, message);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use strum::EnumCount;

    #[test]
    fn every_level_has_a_word_of_its_own() {
        let all: [LogLevel; LogLevel::COUNT] = [LogLevel::Debug, LogLevel::Info, LogLevel::Warn];
        let words: BTreeSet<String> = all.iter().map(ToString::to_string).collect();
        assert_eq!(words.len(), all.len(), "{words:?}");
        assert!(words.iter().all(|word| !word.is_empty() && !word.contains('_')), "{words:?}");
    }
}
