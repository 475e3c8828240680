//! The parameters that the potential-field planners share, including those for flight, and their conversion to
//! settings.

use crate::{
    escape::Escape,
    law::{Beside, Law, Repulsion, RotationForm},
    laws::PushForm,
    settings::{FieldSettings, MoveLength, Planning, RotationUse, Targets, Walking},
    trap::Gate,
    turning::{Reading, SenseRule},
};
use planner_api::{Config, ParamSpec, choice, flag, float};

pub use steering::params::{EVADE, GUARD, GUARD_SIGMAS, MIN_SHARE, SLOW, STUCK, flight};

const FIELD: &str = "Field";
const PLAN: &str = "Plan";
const FLIGHT: &str = "Flight";

/// Gain of the pull.
pub const K_ATT: ParamSpec = float("k_att", "Attraction gain", "N/m", 0.001, 1000.0, 1.0)
    .help("Pull towards the target per metre of distance. Only the ratios of the gains matter.")
    .group(FIELD)
    .live();
/// Gain of the push.
pub const K_REP: ParamSpec = float("k_rep", "Repulsion gain", "N m3", 0.0, 1000.0, 0.02)
    .help(
        "Gain of the push from obstacles. A larger gain keeps the robot farther away and closes narrow \
           passages.",
    )
    .group(FIELD)
    .live();
/// Range of the push.
pub const RHO_0: ParamSpec = float("rho_0_m", "Obstacle range", "m", 0.05, 10.0, 0.6)
    .help("Distance from the hull at which obstacles begin to act.")
    .group(FIELD)
    .live();
/// The form of repulsion, by default Khatib's.
pub const REPULSION_CLASSIC: ParamSpec =
    choice("repulsion", "Repulsion", REPULSIONS, 0).help(REPULSION_HELP).group(FIELD).live();
/// The form of repulsion, by default the improved one.
pub const REPULSION_IMPROVED: ParamSpec =
    choice("repulsion", "Repulsion", REPULSIONS, 1).help(REPULSION_HELP).group(FIELD).live();
const REPULSIONS: &[&str] = &["classic", "improved", "scaled"];
const REPULSION_HELP: &str = "Improved repulsion fades near the target, so that a target beside an \
                              obstacle can be reached, but it passes obstacles more closely. Scaled \
                              repulsion fades, too, but lacks the improved form's component towards the \
                              target.";
/// Power of the distance to the goal.
pub const EXPONENT: ParamSpec = float("exponent", "Improved repulsion exponent", "", 0.0, 4.0, 2.0)
    .help("Improved or scaled repulsion fades with this power of the distance to the target.")
    .group(FIELD)
    .live();
/// Push of the wall.
pub const WALL_GAIN: ParamSpec = float("wall_gain", "Wall repulsion", "", 0.0, 10.0, 0.1)
    .help(
        "Push from the wall within half the obstacle range, as a share of the repulsion gain. 0: none, as \
         in the papers, which have no wall.",
    )
    .group(FIELD)
    .live();

/// Gain of the rotating force.
pub const K_ROT: ParamSpec = float("k_rot", "Rotation gain", "N", 0.0, 1000.0, 1.0)
    .help("Gain of the rotating force around obstacles; the paper sets it equal to the attraction gain.")
    .group(FIELD)
    .live();
/// Form of the rotating force.
pub const ROTATION: ParamSpec = choice("rotation", "Rotating force", &["literal", "smooth"], 0)
    .help(
        "Literal: eq. 3 of the paper, which jumps at the obstacle range. Smooth: starts at zero there. If \
         rotation in flight is set to gaps, the force is always smooth.",
    )
    .group(FIELD)
    .live();
/// When the rotating force acts.
pub const READING: ParamSpec = choice("reading", "Interpretation of the paper", &["literal", "gated"], 1)
    .help(
        "Literal: the rotating force always acts. Gated: it acts only while the gate is open, by default \
         from a trap until ten moves later.",
    )
    .group(FIELD)
    .live();
/// Direction of the rotating force.
pub const SENSE: ParamSpec = choice("sense", "Rotation direction", &["counter-clockwise", "side-aware"], 0)
    .help(
        "The paper always turns counter-clockwise. Side-aware turns to the side of the target and keeps to \
         it.",
    )
    .group(FIELD)
    .live();

/// How a plan is made.
pub const PLANNING: ParamSpec = choice("planning", "Planning", &["by-hull", "lock-step", "flight"], 0)
    .help(
        "Lock-step: the paper's moves, one per preset point. Flight: simulated flight over the known \
           map. By hull: lock-step for a robot without extent, as in the paper; flight for one with a \
           hull.",
    )
    .group(PLAN)
    .live();
/// Longest move towards a preset point.
pub const STEP: ParamSpec = float("step_m", "Step on a preset path", "m", 0.01, 1.0, 0.2)
    .help("Longest move per preset point; the step in the paper.")
    .group(PLAN)
    .live();
/// Length of a move towards a goal.
pub const GOTO_STEP: ParamSpec = float("goto_step_m", "Step towards a goal", "m", 0.005, 1.0, 0.05)
    .help("Length of a move when planning towards a goal.")
    .group(PLAN)
    .live();
/// Whether moves may be longer while the robot lags.
pub const FLEXIBLE: ParamSpec = flag("flexible_step", "Flexible step", false)
    .help("Moves may be twice as long while the robot lags behind its preset point.")
    .group(PLAN)
    .live();
/// Limit on the change of heading.
pub const TURN_LIMIT: ParamSpec = float("turn_limit_deg", "Turn limit per step", "deg", 0.0, 180.0, 0.0)
    .help("Largest change of heading from one move to the next; 0: no limit.")
    .group(PLAN)
    .live();
/// Lag above which a plan skips floor.
pub const MAX_LAG: ParamSpec = float("max_lag_m", "Lag allowed", "m", 0.05, 20.0, 1.25)
    .help("A plan that falls further behind its preset point skips floor and is not complete.")
    .group(PLAN)
    .live();

/// Whether the flight follows the paper.
pub const STEERING: ParamSpec = choice("steering", "Rotation in flight", &["paper", "gaps"], 1)
    .help(
        "Paper: as in the plan, and without evading moving obstacles. Gaps: around whatever blocks the \
         path, on the side of the smaller detour; narrow gaps are treated as closed.",
    )
    .group(FLIGHT)
    .live();

/// Reads the settings of a law without a rotating force.
pub fn settings(config: &Config<'_>) -> FieldSettings {
    let repulsion = match config.choice("repulsion") {
        "improved" => Repulsion::Improved { exponent: config.float("exponent") },
        "scaled" => Repulsion::Scaled { exponent: config.float("exponent") },
        _ => Repulsion::Classic,
    };
    FieldSettings {
        law: Law {
            k_att: config.float("k_att"),
            k_rep: config.float("k_rep"),
            k_rot: 0.0,
            rho_0_m: config.float("rho_0_m"),
            wall_gain: config.float("wall_gain"),
            repulsion,
            form: PushForm::Khatib,
            nearest_only: false,
            rotation: RotationForm::Smooth,
            beside: Beside::All,
        },
        reading: Reading::Off,
        rule: SenseRule::CounterClockwise,
        gate: Gate::Detected,
        escape: Escape::None,
        planning: Planning::Walked,
        walking: walking(config),
        rotation_use: RotationUse::Paper,
        flight: flight(config),
        evades: config.flag("evade"),
    }
}

/// Reads the settings of a law with the rotating force of Wang et al. 2023.
pub fn rotating_settings(config: &Config<'_>) -> FieldSettings {
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
    settings.rotation_use =
        if config.choice("steering") == "gaps" { RotationUse::Gaps } else { RotationUse::Paper };
    settings.evades &= settings.rotation_use == RotationUse::Gaps;
    settings
}

fn walking(config: &Config<'_>) -> Walking {
    let turn_limit_deg = config.float("turn_limit_deg");
    Walking {
        step_m: config.float("step_m"),
        targets: Targets::LockStep,
        length: MoveLength::ToTarget,
        goto_step_m: config.float("goto_step_m"),
        flexible: config.flag("flexible_step"),
        turn_limit_rad: (turn_limit_deg > 0.0).then(|| turn_limit_deg.to_radians()),
        max_lag_m: config.float("max_lag_m"),
    }
}
