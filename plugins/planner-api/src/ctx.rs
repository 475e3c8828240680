//! What a planner may call while it works: deadline, progress, drawing, scalars, log.

use crate::{Code, Drawing, Layer, PlannerError, Result};
use nalgebra::{Point2, Vector2};
use std::time::Duration;

/// Why a planner has to stop working.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StopReason {
    /// The console no longer wants the answer.
    Cancelled,
    /// The deadline passed.
    Timeout,
}

/// How loud a message is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[repr(u32)]
pub enum LogLevel {
    /// For the author only.
    Debug = 0,
    /// Worth knowing.
    Info = 1,
    /// Worth looking at.
    Warn = 2,
}

/// What the host offers during a call; the glue implements it over the C table, tests over memory.
pub trait Services {
    /// Whether to stop, and why.
    fn stop(&self) -> Option<StopReason>;
    /// Time until the deadline.
    fn time_left(&self) -> Duration;
    /// Whether anyone looks at drawings.
    fn wants_drawing(&self) -> bool;
    /// Takes drawings.
    fn draw(&self, drawings: &[Drawing]);
    /// Takes a named figure of this tick.
    fn scalar(&self, name: &str, value: f64, unit: &str);
    /// Takes how far a plan is, and what is being done.
    fn progress(&self, share: f64, what: &str);
    /// Takes a message.
    fn log(&self, level: LogLevel, message: &str);
}

/// The host's services during one call.
#[derive(Clone, Copy)]
pub struct Ctx<'a> {
    services: &'a dyn Services,
}

impl<'a> Ctx<'a> {
    /// Services for the length of a call.
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

    /// Call it in every loop: costs one clock read.
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
    /// [`Code::Cancelled`] or [`Code::Timeout`]; pass it on with `?`.
    pub fn check(&self) -> Result<()> {
        match self.services.stop() {
            None => Ok(()),
            Some(StopReason::Cancelled) => {
                Err(PlannerError::new(Code::Cancelled, "cancelled by the console"))
            }
            Some(StopReason::Timeout) => Err(PlannerError::new(Code::Timeout, "the deadline passed")),
        }
    }

    /// Time until the deadline.
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

    /// Whether anyone looks at drawings; skip costly ones if not.
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

    /// Draws an arrow.
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

    /// Reports a named figure of this tick; the console plots it.
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

    /// Reports the progress of a plan while it is being made: the share done, 0 to 1, about in proportion to time, and what is
    /// being done in a few plain words (`candidate 3 of 8`). The console shows it while it waits and keeps none of it;
    /// outside of `plan` it goes nowhere. Call it as often as you like: what comes faster than it can be read is left out.
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

    /// Says something to the operator's event log.
    ///
    /// ```
    /// use planner_api::{LogLevel, testing::Bench};
    ///
    /// let bench = Bench::new();
    /// bench.ctx().log(LogLevel::Warn, "0.4 m² of the floor are left out");
    /// assert_eq!(bench.logs()[0].0, LogLevel::Warn);
    /// ```
    pub fn log(&self, level: LogLevel, message: &str) {
        self.services.log(level, message);
    }
}
