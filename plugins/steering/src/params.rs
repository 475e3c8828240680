//! The parameters that planners share, and what they stand for.

use planner_api::{Config, ParamSpec, flag, float};

const PLAN: &str = "Plan";
const FLIGHT: &str = "Flight";

/// The guard's distance.
pub const GUARD: ParamSpec = float("guard_m", "Guard distance", "m", 0.0, 1.0, 0.1)
    .help("Hull distance below which no motion toward an obstacle is allowed; always a little more than the mission's clearance.")
    .group(FLIGHT)
    .live();
/// How the guard widens.
pub const GUARD_SIGMAS: ParamSpec = float("guard_sigmas", "Guard per position error", "", 0.0, 5.0, 1.0)
    .help("Widens the guard by this many standard deviations of the estimated position, up to 0.15 m.")
    .group(FLIGHT)
    .live();
/// Where the robot slows down.
pub const SLOW: ParamSpec = float("slow_m", "Slow zone", "m", 0.01, 5.0, 0.5)
    .help("The robot slows down toward obstacles nearer than this.")
    .group(FLIGHT)
    .live();
/// How far it slows down.
pub const MIN_SHARE: ParamSpec = float("min_share", "Least speed", "", 0.05, 1.0, 0.3)
    .help("Share of the largest speed below which the robot does not slow down by itself.")
    .group(FLIGHT)
    .live();
/// When the robot is stuck.
pub const STUCK: ParamSpec = float("stuck_s", "Stuck after", "s", 1.0, 600.0, 30.0)
    .help("Time without getting on after which the robot reports that it is stuck.")
    .group(FLIGHT)
    .live();
/// Whether what moves is evaded.
pub const EVADE: ParamSpec = flag("evade", "Evades what moves", true)
    .help(
        "What moves is met where it will be in the next five seconds. Without it, it counts as standing where it is seen, as \
         in the papers.",
    )
    .group(FLIGHT)
    .live();
/// Clearance asked of a plan.
pub const CLEARANCE: ParamSpec = float("clearance_m", "Clearance at least", "m", 0.0, 5.0, 0.0)
    .help("Distance between hull and obstacles that a plan keeps; never less than the mission's clearance.")
    .group(PLAN)
    .live();

/// How a robot is flown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flight {
    /// Distance between hull and anything solid below which no motion toward it is allowed, metres; a little more
    /// than the clearance that the mission demands, if that is larger.
    pub guard_m: f64,
    /// Widens the guard by this many standard deviations of the estimated position.
    pub guard_sigmas: f64,
    /// Distance between hull and obstacle below which the robot goes slower, metres.
    pub slow_m: f64,
    /// The smallest share of the largest speed it slows down to by itself.
    pub min_share: f64,
    /// Time without getting on after which the robot reports that it is stuck, seconds.
    pub stuck_s: f64,
}

/// How a configuration has the robot flown.
pub fn flight(config: &Config<'_>) -> Flight {
    Flight {
        guard_m: config.float("guard_m"),
        guard_sigmas: config.float("guard_sigmas"),
        slow_m: config.float("slow_m"),
        min_share: config.float("min_share"),
        stuck_s: config.float("stuck_s"),
    }
}
