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
    pub fn new(services: &'a dyn Services) -> Self {
        Self { services }
    }

    /// Call it in every loop: costs one clock read.
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
    pub fn time_left(&self) -> Duration {
        self.services.time_left()
    }

    /// Whether anyone looks at drawings; skip costly ones if not.
    pub fn wants_drawing(&self) -> bool {
        self.services.wants_drawing()
    }

    /// Draws an arrow.
    pub fn arrow(&self, layer: Layer, at: Point2<f64>, vector: Vector2<f64>) {
        self.services.draw(&[Drawing::Arrow { layer, at, vector }]);
    }

    /// Draws a circle.
    pub fn circle(&self, layer: Layer, center: Point2<f64>, radius_m: f64) {
        self.services.draw(&[Drawing::Circle { layer, center, radius_m }]);
    }

    /// Draws a line through points.
    pub fn polyline(&self, layer: Layer, points: &[Point2<f64>]) {
        let pieces: Vec<Drawing> =
            points.windows(2).map(|w| Drawing::Line { layer, from: w[0], to: w[1] }).collect();
        self.services.draw(&pieces);
    }

    /// Reports a named figure of this tick; the console plots it.
    pub fn scalar(&self, name: &str, value: f64, unit: &str) {
        self.services.scalar(name, value, unit);
    }

    /// Reports the progress of a plan while it is being made: the share done, 0 to 1, about in proportion to time, and what is
    /// being done in a few plain words (`candidate 3 of 8`). The console shows it while it waits and keeps none of it;
    /// outside of `plan` it goes nowhere. Call it as often as you like: what comes faster than it can be read is left out.
    pub fn progress(&self, share: f64, what: &str) {
        self.services.progress(share, what);
    }

    /// Says something to the operator's event log.
    pub fn log(&self, level: LogLevel, message: &str) {
        self.services.log(level, message);
    }
}
