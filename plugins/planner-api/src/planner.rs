//! The trait that a planner implements.

use crate::{
    Command, Config, Ctx, ParamSpec, Plan, PlanRequest, PlannerError, Result, Sensed, Site, Stopping,
};

/// What a planner offers, as a set of bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Caps(pub u32);

impl Caps {
    /// Plans on the whole known map.
    pub const GLOBAL: Self = Self(1);
    /// Reacts to what it senses, step by step.
    pub const LOCAL: Self = Self(2);
    /// Covers the floor.
    pub const COVERAGE: Self = Self(4);
    /// Can save and restore its private state.
    pub const SNAPSHOT: Self = Self(8);
    /// Takes new values of live parameters under way.
    pub const LIVE_PARAMS: Self = Self(16);

    /// Both sets together.
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

    /// Whether everything in `other` is offered.
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

/// A planner: asked once for a plan, then every tick for a command.
///
/// One instance is called from one thread, one call at a time. What another planner needs to take over (path flown,
/// targets left, coverage) is kept by the console, so a planner need only keep what is its own.
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
    /// Stable name in recordings and scenarios: `[a-z0-9_-]{1,32}`.
    const ID: &'static str;
    /// Name on screen.
    const NAME: &'static str;
    /// One sentence: what it does, and from where.
    const ABOUT: &'static str = "";
    /// What it offers.
    const CAPS: Caps;
    /// Format of [`Planner::snapshot`]; raise it when the format changes.
    const STATE_VERSION: u32 = 1;
    /// Its parameters.
    const PARAMS: &'static [ParamSpec];

    /// Makes a planner for a site; there is no half-configured one.
    ///
    /// # Errors
    /// [`crate::Code::Config`] when the parameters do not fit together or the site.
    fn configure(config: &Config<'_>, site: &Site<'_>, ctx: &Ctx<'_>) -> Result<Self>;

    /// Takes new values of live parameters.
    ///
    /// # Errors
    /// [`crate::Code::Unsupported`] makes the console configure a new instance instead.
    fn reconfigure(&mut self, _config: &Config<'_>, _ctx: &Ctx<'_>) -> Result<()> {
        Err(PlannerError::unsupported())
    }

    /// Plans a path for the task on what is known now.
    ///
    /// # Errors
    /// Why there is none; [`PlannerError::no_path_but`] may carry the part that was found.
    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan>;

    /// Decides how to move until the next tick.
    ///
    /// # Errors
    /// Why it cannot; the console then holds the robot.
    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command>;

    /// The console is about to stop this planner.
    fn stopping(&mut self, _ctx: &Ctx<'_>) -> Stopping {
        Stopping::Done
    }

    /// The planner's private state, for a restart of the same planner.
    ///
    /// # Errors
    /// [`crate::Code::Unsupported`] when it keeps none.
    fn snapshot(&self) -> Result<Vec<u8>> {
        Err(PlannerError::unsupported())
    }

    /// Takes over the state of an earlier instance.
    ///
    /// # Errors
    /// [`crate::Code::State`] when the state does not fit.
    fn restore(&mut self, _version: u32, _state: &[u8]) -> Result<()> {
        Err(PlannerError::unsupported())
    }
}
