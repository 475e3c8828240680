//! The parameters that planners share, and their settings.

use planner_api::{Config, ParamSpec, flag, float};

const PLAN: &str = "Plan";
const FLIGHT: &str = "Flight";

/// Guard distance.
pub const GUARD: ParamSpec = float("guard_m", "Guard distance", "m", 0.0, 1.0, 0.1)
    .help(
        "No motion towards an obstacle is allowed if the hull is closer to it than this distance, which \
         always slightly exceeds the mission's clearance.",
    )
    .group(FLIGHT)
    .live();
/// Widening of the guard distance.
pub const GUARD_SIGMAS: ParamSpec = float("guard_sigmas", "Guard widening", "", 0.0, 5.0, 1.0)
    .help(
        "Widens the guard distance by this many standard deviations of the estimated position, up to \
           0.15 m.",
    )
    .group(FLIGHT)
    .live();
/// Distance at which the robot slows down.
pub const SLOW: ParamSpec = float("slow_m", "Slow zone", "m", 0.01, 5.0, 0.5)
    .help("The robot slows down when an obstacle is closer than this.")
    .group(FLIGHT)
    .live();
/// Minimum speed near obstacles.
pub const MIN_SHARE: ParamSpec = float("min_share", "Minimum speed", "", 0.05, 1.0, 0.3)
    .help("Share of the maximum speed below which the robot does not slow down near obstacles.")
    .group(FLIGHT)
    .live();
/// Time after which the robot is stuck.
pub const STUCK: ParamSpec = float("stuck_s", "Stuck after", "s", 1.0, 600.0, 30.0)
    .help("Time without progress after which the robot reports that it is stuck.")
    .group(FLIGHT)
    .live();
/// Whether moving obstacles are evaded.
pub const EVADE: ParamSpec = flag("evade", "Evade moving obstacles", true)
    .help(
        "The robot avoids the positions that moving obstacles will have over the next five seconds. If \
         this is off, it treats them as stationary where it sees them, as in the papers.",
    )
    .group(FLIGHT)
    .live();
/// Clearance required of a plan.
pub const CLEARANCE: ParamSpec = float("clearance_m", "Minimum clearance", "m", 0.0, 5.0, 0.0)
    .help("Distance that a plan keeps between hull and obstacles; never less than the mission's clearance.")
    .group(PLAN)
    .live();

/// Settings for flying a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flight {
    /// Distance between the hull and any solid below which no motion towards the solid is allowed, metres; a little
    /// more than the mission's clearance if that is larger.
    pub guard_m: f64,
    /// Number of standard deviations of the estimated position by which the guard distance is widened.
    pub guard_sigmas: f64,
    /// Distance between the hull and an obstacle below which the robot slows down, metres.
    pub slow_m: f64,
    /// Share of the maximum speed below which the robot does not slow down near obstacles.
    pub min_share: f64,
    /// Time without progress after which the robot reports that it is stuck, seconds.
    pub stuck_s: f64,
}

/// Reads the flight settings from a configuration.
pub fn flight(config: &Config<'_>) -> Flight {
    Flight {
        guard_m: config.float("guard_m"),
        guard_sigmas: config.float("guard_sigmas"),
        slow_m: config.float("slow_m"),
        min_share: config.float("min_share"),
        stuck_s: config.float("stuck_s"),
    }
}
