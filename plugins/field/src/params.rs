//! The parameters that the potential-field planners share, and how they become settings.

use crate::{
    escape::Escape,
    law::{Law, Repulsion, RotationForm},
    settings::{Flight, Planning, Settings, Steering, Walking},
    turning::{Reading, SenseRule},
};
use planner_api::{Config, ParamSpec, choice, flag, float};

const FIELD: &str = "Field";
const PLAN: &str = "Plan";
const FLIGHT: &str = "Flight";

/// Gain of the pull.
pub const K_ATT: ParamSpec = float("k_att", "Attraction gain", "N/m", 0.001, 1000.0, 1.0)
    .help("Pull toward the target per metre of distance. Only the ratios of the gains matter.")
    .group(FIELD)
    .live();
/// Gain of the push.
pub const K_REP: ParamSpec = float("k_rep", "Repulsion gain", "N m3", 0.0, 1000.0, 0.02)
    .help("Push of obstacles. More of it keeps further away and closes narrow passages.")
    .group(FIELD)
    .live();
/// Range of the push.
pub const RHO_0: ParamSpec = float("rho_0_m", "Range of obstacles", "m", 0.05, 10.0, 0.6)
    .help("Distance between hull and obstacle at which obstacles begin to act.")
    .group(FIELD)
    .live();
/// Which repulsion, Khatib's by default.
pub const REPULSION_CLASSIC: ParamSpec =
    choice("repulsion", "Repulsion", &["classic", "improved"], 0).help(REPULSION_HELP).group(FIELD).live();
/// Which repulsion, the improved one by default.
pub const REPULSION_IMPROVED: ParamSpec =
    choice("repulsion", "Repulsion", &["classic", "improved"], 1).help(REPULSION_HELP).group(FIELD).live();
const REPULSION_HELP: &str = "Improved repulsion fades near the target, so that a target beside an obstacle can be \
     reached; it passes obstacles more closely.";
/// Power of the goal's distance.
pub const EXPONENT: ParamSpec = float("exponent", "Exponent of improved repulsion", "", 1.0, 4.0, 2.0)
    .help("Power of the distance to the target by which improved repulsion fades.")
    .group(FIELD)
    .live();
/// Push of the wall.
pub const WALL_GAIN: ParamSpec = float("wall_gain", "Wall repulsion", "", 0.0, 10.0, 0.1)
    .help("Push of the wall as a share of the repulsion gain, within half its range. The papers have no wall: 0.")
    .group(FIELD)
    .live();

/// Gain of the rotating force.
pub const K_ROT: ParamSpec = float("k_rot", "Rotation gain", "N", 0.0, 1000.0, 1.0)
    .help("Rotating force about obstacles; the paper sets it equal to the attraction gain.")
    .group(FIELD)
    .live();
/// Form of the rotating force.
pub const ROTATION: ParamSpec = choice("rotation", "Rotating force", &["literal", "smooth"], 0)
    .help(
        "Literal is the paper's eq. 3, which jumps at the range of obstacles; smooth begins there at zero. \
           Steering by gaps is always smooth.",
    )
    .group(FIELD)
    .live();
/// When the rotating force acts.
pub const READING: ParamSpec = choice("reading", "Reading of the paper", &["literal", "gated"], 1)
    .help("Literal: the rotating force always acts. Gated: only in a trap and ten moves on, which fits the paper's \
           figures.")
    .group(FIELD)
    .live();
/// Which way round.
pub const SENSE: ParamSpec = choice("sense", "Sense of rotation", &["counter-clockwise", "side-aware"], 0)
    .help(
        "The paper turns counter-clockwise always; side-aware turns toward the target and keeps to the side.",
    )
    .group(FIELD)
    .live();

/// How a plan is made.
pub const PLANNING: ParamSpec = choice("planning", "Planning", &["by-hull", "lock-step", "flight"], 0)
    .help("Lock-step: the paper's moves, one per preset point. Flight: the known map flown in thought. By hull: \
           lock-step for a robot without extent, as the paper's, flight for one with a hull.")
    .group(PLAN)
    .live();
/// Move toward a preset point.
pub const STEP: ParamSpec = float("step_m", "Step on a preset path", "m", 0.01, 1.0, 0.2)
    .help("Longest move per preset point; the paper's step.")
    .group(PLAN)
    .live();
/// Move toward a goal.
pub const GOTO_STEP: ParamSpec = float("goto_step_m", "Step toward a goal", "m", 0.005, 1.0, 0.05)
    .help("Length of a move when planning toward a goal.")
    .group(PLAN)
    .live();
/// Longer moves when behind.
pub const FLEXIBLE: ParamSpec = flag("flexible_step", "Flexible step", false)
    .help("Moves may be twice as long while the robot lags behind its preset point.")
    .group(PLAN)
    .live();
/// Limit of the change of heading.
pub const TURN_LIMIT: ParamSpec = float("turn_limit_deg", "Turn limit per step", "deg", 0.0, 180.0, 0.0)
    .help("Largest change of heading from one move to the next; 0 is no limit.")
    .group(PLAN)
    .live();
/// When a plan skips floor.
pub const MAX_LAG: ParamSpec = float("max_lag_m", "Lag allowed", "m", 0.05, 20.0, 1.25)
    .help("A plan that falls further behind its preset point skips floor and is not complete.")
    .group(PLAN)
    .live();

/// Whether the flight follows the paper.
pub const STEERING: ParamSpec = choice("steering", "Rotation in flight", &["paper", "gaps"], 1)
    .help("Paper: as in the plan. Gaps: about what blocks the way, on the side of the smaller detour, with narrow gaps \
           closed.")
    .group(FLIGHT)
    .live();
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

/// Clearance asked of a plan.
pub const CLEARANCE: ParamSpec = float("clearance_m", "Clearance at least", "m", 0.0, 5.0, 0.0)
    .help("Distance between hull and obstacles that a plan keeps; never less than the mission's clearance.")
    .group(PLAN)
    .live();
/// Limit of the change of heading along a plan.
pub const TURN_PER_STEP: ParamSpec = float("turn_deg", "Turn limit per 0.2 m", "deg", 0.0, 180.0, 30.0)
    .help("Largest change of heading along 0.2 m of path, where the preset path itself turns no faster; 0 is no limit.")
    .group(PLAN)
    .live();
/// How far a plan may leave its preset path.
pub const MAX_OFFSET: ParamSpec = float("max_offset_m", "Furthest offset", "m", 0.1, 5.0, 1.25)
    .help("How far beside the preset path a way round is looked for first; twice as far if there is none.")
    .group(PLAN)
    .live();

/// Settings of a law without a rotating force.
pub fn settings(config: &Config<'_>) -> Settings {
    let repulsion = match config.choice("repulsion") {
        "improved" => Repulsion::Improved { exponent: config.float("exponent") },
        _ => Repulsion::Classic,
    };
    Settings {
        law: Law {
            k_att: config.float("k_att"),
            k_rep: config.float("k_rep"),
            k_rot: 0.0,
            rho_0_m: config.float("rho_0_m"),
            wall_gain: config.float("wall_gain"),
            repulsion,
            rotation: RotationForm::Smooth,
        },
        reading: Reading::Off,
        rule: SenseRule::CounterClockwise,
        escape: Escape::None,
        planning: Planning::Walked,
        walking: walking(config),
        flight: flight(config),
    }
}

/// Settings of a law with the rotating force of Wang et al. 2023.
pub fn rotating_settings(config: &Config<'_>) -> Settings {
    let mut settings = settings(config);
    settings.law.k_rot = config.float("k_rot");
    settings.law.rotation =
        if config.choice("rotation") == "literal" { RotationForm::Literal } else { RotationForm::Smooth };
    settings.reading = if config.choice("reading") == "literal" { Reading::Literal } else { Reading::Gated };
    settings.rule = if config.choice("sense") == "side-aware" {
        SenseRule::SideAware
    } else {
        SenseRule::CounterClockwise
    };
    settings.planning = match config.choice("planning") {
        "lock-step" => Planning::Walked,
        "flight" => Planning::Flown,
        _ => Planning::ByHull,
    };
    settings.flight.steering =
        if config.choice("steering") == "gaps" { Steering::Gaps } else { Steering::Paper };
    settings
}

fn walking(config: &Config<'_>) -> Walking {
    let turn_limit_deg = config.float("turn_limit_deg");
    Walking {
        step_m: config.float("step_m"),
        goto_step_m: config.float("goto_step_m"),
        flexible: config.flag("flexible_step"),
        turn_limit_rad: (turn_limit_deg > 0.0).then(|| turn_limit_deg.to_radians()),
        max_lag_m: config.float("max_lag_m"),
    }
}

/// How a robot is steered along a plan or a law.
pub fn flight(config: &Config<'_>) -> Flight {
    Flight {
        steering: Steering::Paper,
        guard_m: config.float("guard_m"),
        guard_sigmas: config.float("guard_sigmas"),
        slow_m: config.float("slow_m"),
        min_share: config.float("min_share"),
        stuck_s: config.float("stuck_s"),
    }
}
