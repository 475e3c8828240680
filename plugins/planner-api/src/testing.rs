//! An in-memory version of the console's services, for the unit tests of a planner.
//!
//! ```
//! use planner_api::testing::Bench;
//! use planner_api::{Layer, Point2, Vector2};
//!
//! let bench = Bench::new();
//! bench.ctx().arrow(Layer::Attraction, Point2::origin(), Vector2::new(1.0, 0.0));
//! assert_eq!(bench.drawings().len(), 1);
//! ```

use crate::{Config, Ctx, Drawing, LogLevel, Planner, Result, Services, Site, StopReason, Value};
use std::cell::{Cell, RefCell};
use std::time::Duration;

/// Collects what a planner draws, reports and logs. Unless a test changes this, the deadline is an hour away and
/// drawings are shown.
#[derive(Debug)]
pub struct Bench {
    stop: Cell<Option<StopReason>>,
    watched: Cell<bool>,
    drawings: RefCell<Vec<Drawing>>,
    scalars: RefCell<Vec<(String, f64, String)>>,
    progress: RefCell<Vec<(f64, String)>>,
    logs: RefCell<Vec<(LogLevel, String)>>,
}

impl Default for Bench {
    fn default() -> Self {
        Self {
            stop: Cell::new(None),
            watched: Cell::new(true),
            drawings: RefCell::default(),
            scalars: RefCell::default(),
            progress: RefCell::default(),
            logs: RefCell::default(),
        }
    }
}

impl Bench {
    /// Creates an empty bench.
    ///
    /// ```
    /// let bench = planner_api::testing::Bench::new();
    /// assert!(bench.drawings().is_empty() && bench.logs().is_empty());
    /// ```
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns the services as a planner sees them.
    ///
    /// ```
    /// let bench = planner_api::testing::Bench::new();
    /// assert!(bench.ctx().wants_drawing() && bench.ctx().check().is_ok());
    /// ```
    pub fn ctx(&self) -> Ctx<'_> {
        Ctx::new(self)
    }

    /// Creates a planner with these parameter values (0 or 1 for a flag, the index of the word for a choice); all other
    /// parameters take their defaults.
    ///
    /// ```
    /// # use planner_api::*;
    /// # struct Cruise { speed_m_per_s: f64 }
    /// # impl Planner for Cruise {
    /// #     const ID: &'static str = "cruise";
    /// #     const NAME: &'static str = "Cruise";
    /// #     const CAPS: Caps = Caps::LOCAL;
    /// #     const PARAMS: &'static [ParamSpec] = &[float("speed", "Speed", "m/s", 0.0, 1.0, 0.2)];
    /// #     fn configure(config: &Config<'_>, _: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
    /// #         Ok(Self { speed_m_per_s: config.float("speed") })
    /// #     }
    /// #     fn plan(&mut self, _: &PlanRequest<'_>, _: &Ctx<'_>) -> Result<Plan> { Ok(Plan::default()) }
    /// #     fn step(&mut self, _: &Sensed<'_>, _: &Ctx<'_>) -> Result<Command> { Ok(Command::twist(0.0, 0.0)) }
    /// # }
    /// # let (v_max_m_per_s, w_max_rad_per_s, radius_m, sensing_range_m) = (0.4, 1.0, 0.25, 3.0);
    /// # let (motion, acceleration_m_per_s2, tick_s, amphibious) = (Motion::Point, 0.5, 0.1, None);
    /// # let limits = Limits {
    /// #     motion, v_max_m_per_s, w_max_rad_per_s, radius_m, sensing_range_m, acceleration_m_per_s2, tick_s,
    /// #     amphibious,
    /// # };
    /// # let (boundary, obstacles, zones) = (Boundary::Circle { radius_m: 5.0 }, &[], &[]);
    /// # let site = Site { revision: 1, boundary, obstacles, zones, limits, swath_m: 0.5, clearance_m: 0.1, seed: 1 };
    /// let bench = testing::Bench::new();
    /// let cruise: Cruise = bench.configure(&[("speed", 0.3)], &site)?;
    /// assert_eq!(cruise.speed_m_per_s, 0.3);
    /// # Ok::<(), PlannerError>(())
    /// ```
    ///
    /// # Errors
    /// The planner's `configure` refused the values or the site.
    pub fn configure<P: Planner>(&self, values: &[(&str, f64)], site: &Site<'_>) -> Result<P> {
        let values: Vec<Value<'_>> = values.iter().map(|&(key, number)| Value { key, number }).collect();
        P::configure(&Config::new(P::PARAMS, &values), site, &self.ctx())
    }

    /// Makes [`Ctx::check`] fail for this reason from now on; `None` lets the planner work again.
    ///
    /// ```
    /// use planner_api::{StopReason, testing::Bench};
    ///
    /// let bench = Bench::new();
    /// bench.stop_with(StopReason::Timeout);
    /// assert!(bench.ctx().check().is_err());
    /// bench.stop_with(None);
    /// assert!(bench.ctx().check().is_ok());
    /// ```
    pub fn stop_with(&self, reason: impl Into<Option<StopReason>>) {
        self.stop.set(reason.into());
    }

    /// From now on, reports that drawings are not shown; drawings are still collected.
    ///
    /// ```
    /// let bench = planner_api::testing::Bench::new();
    /// bench.look_away();
    /// assert!(!bench.ctx().wants_drawing());
    /// ```
    pub fn look_away(&self) {
        self.watched.set(false);
    }

    /// Returns what was drawn since the last [`Bench::clear`].
    pub fn drawings(&self) -> Vec<Drawing> {
        self.drawings.borrow().clone()
    }

    /// Returns the named figures since the last [`Bench::clear`]: name, value, unit.
    pub fn scalars(&self) -> Vec<(String, f64, String)> {
        self.scalars.borrow().clone()
    }

    /// Returns the newest value of a named figure.
    ///
    /// ```
    /// let bench = planner_api::testing::Bench::new();
    /// bench.ctx().scalar("clearance", 0.4, "m");
    /// bench.ctx().scalar("clearance", 0.3, "m");
    /// assert_eq!((bench.scalar("clearance"), bench.scalar("speed")), (Some(0.3), None));
    /// ```
    pub fn scalar(&self, name: &str) -> Option<f64> {
        self.scalars.borrow().iter().rev().find(|(known, ..)| known == name).map(|(_, value, _)| *value)
    }

    /// Returns the progress reported since the last [`Bench::clear`]: the share done, and the activity.
    pub fn progress(&self) -> Vec<(f64, String)> {
        self.progress.borrow().clone()
    }

    /// Returns the log messages since the last [`Bench::clear`].
    pub fn logs(&self) -> Vec<(LogLevel, String)> {
        self.logs.borrow().clone()
    }

    /// Clears everything that was drawn, reported and logged.
    ///
    /// ```
    /// use planner_api::{LogLevel, testing::Bench};
    ///
    /// let bench = Bench::new();
    /// bench.ctx().log(LogLevel::Info, "three candidates");
    /// bench.clear();
    /// assert!(bench.logs().is_empty());
    /// ```
    pub fn clear(&self) {
        self.drawings.borrow_mut().clear();
        self.scalars.borrow_mut().clear();
        self.progress.borrow_mut().clear();
        self.logs.borrow_mut().clear();
    }
}

impl Services for Bench {
    fn stop(&self) -> Option<StopReason> {
        self.stop.get()
    }

    fn time_left(&self) -> Duration {
        if self.stop.get() == Some(StopReason::Timeout) { Duration::ZERO } else { Duration::from_hours(1) }
    }

    fn wants_drawing(&self) -> bool {
        self.watched.get()
    }

    fn draw(&self, drawings: &[Drawing]) {
        self.drawings.borrow_mut().extend_from_slice(drawings);
    }

    fn scalar(&self, name: &str, value: f64, unit: &str) {
        self.scalars.borrow_mut().push((name.to_owned(), value, unit.to_owned()));
    }

    fn progress(&self, share: f64, what: &str) {
        self.progress.borrow_mut().push((share, what.to_owned()));
    }

    fn log(&self, level: LogLevel, message: &str) {
        self.logs.borrow_mut().push((level, message.to_owned()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Code, Layer};
    use nalgebra::Point2;

    #[test]
    fn a_bench_keeps_what_a_planner_shows_and_says() {
        let bench = Bench::new();
        let ctx = bench.ctx();
        ctx.circle(Layer::Virtual, Point2::origin(), 0.5);
        ctx.scalar("u", 1.0, "J");
        ctx.scalar("u", 2.0, "J");
        ctx.log(LogLevel::Warn, "narrow");
        ctx.progress(0.5, "half way");
        assert_eq!((bench.drawings().len(), bench.scalar("u")), (1, Some(2.0)));
        assert_eq!(bench.logs(), [(LogLevel::Warn, "narrow".to_owned())]);
        assert_eq!(bench.progress(), [(0.5, "half way".to_owned())]);
        bench.clear();
        assert!(bench.drawings().is_empty() && bench.scalars().is_empty() && bench.logs().is_empty());
        assert!(bench.progress().is_empty());
    }

    #[test]
    fn a_bench_can_run_out_of_time() {
        let bench = Bench::new();
        assert_eq!(bench.ctx().check(), Ok(()));
        bench.stop_with(StopReason::Timeout);
        assert_eq!(bench.ctx().check().map_err(|error| error.code), Err(Code::Timeout));
        assert!(bench.ctx().time_left().is_zero());
    }
}
