//! The trait that a planner implements.

use crate::{
    Command, Config, Ctx, ParamSpec, Plan, PlanRequest, PlannerError, Result, Sensed, Site, Stopping,
};

/// The abilities of a planner, as a set of bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Caps(pub u32);

impl Caps {
    /// Plans over the entire known map.
    pub const GLOBAL: Self = Self(1);
    /// Reacts to what the robot senses, step by step.
    pub const LOCAL: Self = Self(2);
    /// Covers the floor.
    pub const COVERAGE: Self = Self(4);
    /// Can save and restore its private state.
    pub const SNAPSHOT: Self = Self(8);
    /// Accepts new values of live parameters during a mission.
    pub const LIVE_PARAMS: Self = Self(16);

    /// Returns the union of both sets.
    ///
    /// ```
    /// use planner_api::Caps;
    ///
    /// const CAPS: Caps = Caps::GLOBAL.and(Caps::COVERAGE);
    /// assert!(CAPS.has(Caps::COVERAGE) && !CAPS.has(Caps::LOCAL));
    /// ```
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether this set includes all of `other`.
    ///
    /// ```
    /// use planner_api::Caps;
    ///
    /// let caps = Caps::LOCAL.and(Caps::LIVE_PARAMS);
    /// assert!(caps.has(Caps::LOCAL) && !caps.has(Caps::LOCAL.and(Caps::SNAPSHOT)));
    /// ```
    pub const fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}

/// A planner. It is asked for a plan when the mission needs one, and for a command on every tick.
///
/// An instance is called from one thread, one call at a time. The console keeps everything that another planner would
/// need in order to take over (the path driven, the remaining targets, the coverage), so a planner only has to keep its
/// own private state.
///
/// ```
/// use planner_api::*;
///
/// struct Wait;
///
/// impl Planner for Wait {
///     const ID: &'static str = "wait";
///     const NAME: &'static str = "Stands still";
///     const CAPS: Caps = Caps::LOCAL;
///     const PARAMS: &'static [ParamSpec] = &[];
///
///     fn configure(_: &Config<'_>, _: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
///         Ok(Self)
///     }
///
///     fn plan(&mut self, _: &PlanRequest<'_>, _: &Ctx<'_>) -> Result<Plan> {
///         Ok(Plan::default())
///     }
///
///     fn step(&mut self, _: &Sensed<'_>, _: &Ctx<'_>) -> Result<Command> {
///         Ok(Command::still(Status::Waiting))
///     }
/// }
///
/// export_planners!(Wait);
/// assert!(Wait.snapshot().is_err(), "it keeps no state of its own");
/// ```
pub trait Planner: Sized + 'static {
    /// Stable id in recordings and scenarios: `[a-z0-9_-]{1,32}`.
    const ID: &'static str;
    /// The name on screen.
    const NAME: &'static str;
    /// One sentence: what the planner does, and the source of its method.
    const ABOUT: &'static str = "";
    /// The planner's abilities.
    const CAPS: Caps;
    /// Version of the format of the data from [`Planner::snapshot`]; raise it when the format changes.
    const STATE_VERSION: u32 = 1;
    /// The planner's parameters.
    const PARAMS: &'static [ParamSpec];

    /// Creates a planner for a site. The new instance must be ready for use.
    ///
    /// # Errors
    /// [`crate::Code::Config`] when the parameters contradict each other or do not fit the site.
    fn configure(config: &Config<'_>, site: &Site<'_>, ctx: &Ctx<'_>) -> Result<Self>;

    /// Accepts new values of live parameters.
    ///
    /// # Errors
    /// After [`crate::Code::Unsupported`] the console configures a new instance instead.
    fn reconfigure(&mut self, _config: &Config<'_>, _ctx: &Ctx<'_>) -> Result<()> {
        Err(PlannerError::unsupported())
    }

    /// Plans a path for the task, based on what is known now.
    ///
    /// # Errors
    /// The reason why there is no path; use [`PlannerError::no_path_but`] to return the part that was found.
    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan>;

    /// Decides how the robot moves until the next tick.
    ///
    /// # Errors
    /// The reason why there is no command; the console then holds the robot.
    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command>;

    /// Tells the planner that the console is about to stop it.
    fn stopping(&mut self, _ctx: &Ctx<'_>) -> Stopping {
        Stopping::Done
    }

    /// Returns the planner's private state, for a restart of the same planner.
    ///
    /// # Errors
    /// [`crate::Code::Unsupported`] when the planner keeps no state.
    fn snapshot(&self) -> Result<Vec<u8>> {
        Err(PlannerError::unsupported())
    }

    /// Restores the state of an earlier instance.
    ///
    /// # Errors
    /// [`crate::Code::State`] when the state does not fit.
    fn restore(&mut self, _version: u32, _state: &[u8]) -> Result<()> {
        Err(PlannerError::unsupported())
    }
}
