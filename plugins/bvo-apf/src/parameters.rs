//! The parameters and their conversion to settings.

use crate::settings::{MachineSettings, Mode};
use field::{GoalLaw, NearLaw, Pull, TangentUse, open_points as o, params as p};
use planner_api::{Config, ParamSpec, Site, choice, float, int};

const TRAP: &str = "Trap";
const FIELD: &str = "Field";

const MODES: [&str; 4] = [Mode::Literal.name(), Mode::Hull.name(), Mode::Rollout.name(), Mode::Pre.name()];
const MODE: ParamSpec = choice("mode", "Mode", &MODES, 3)
    .help(
        "The detour. literal: around a circle enclosing the trap, on the left, as published. hull: along \
         the convex hull of the trap. rollout: along the hull, on the side that is shorter in simulation. \
         pre: begins before the robot enters the trap.",
    )
    .group(TRAP);
const M: ParamSpec = float("m", "Pull", "N", 0.001, 1000.0, 10.0)
    .help("Pull of the goal at the start; m in the paper. Only its ratio to the repulsion gain matters.")
    .group(FIELD);
const RHO_1: ParamSpec = float("rho_1_m", "Near-law range", "m", 0.01, 100.0, 1.0)
    .help("Distance from the goal below which the near law of the pull applies.")
    .group(FIELD);
const NEAR_LAW: ParamSpec = choice("near_law", "Near law", &["corrected", "printed"], 0)
    .help(
        "corrected: the pull grows towards the goal, as the paper's text says. printed: it vanishes \
           there, as in the paper's formula.",
    )
    .group(FIELD);
const K: ParamSpec = float("k", "Logarithm base", "", 0.0, 1e6, 0.0)
    .help(
        "k in eq. 4 of the paper. If it is 1 or less, the distance from start to goal plus one is used \
         instead, so that the pull is m at the start and then falls.",
    )
    .group(FIELD);
const N: ParamSpec = float("n", "Pull near the goal", "N", 0.0, 1e6, 0.0)
    .help(
        "Gain of the near law; n in eq. 4 of the paper, which calls it adaptive. 0: chosen so that the \
           two laws meet.",
    )
    .group(FIELD);
const K_REP: ParamSpec = float("k_rep", "Repulsion gain", "N m3", 0.0, 1000.0, 10.0)
    .help("Gain of the push and the tangent force from obstacles; mu in the papers.")
    .group(FIELD);
const RHO_0: ParamSpec = float("rho_0_m", "Obstacle range", "m", 0.05, 50.0, 2.0)
    .help("Distance from the hull at which obstacles begin to act.")
    .group(FIELD);
const TANGENT_WEIGHT: ParamSpec = float("tangent_weight", "Tangent force weight", "", 0.0, 100.0, 1.0)
    .help(
        "Tangent force around whatever blocks the path to the goal, as a multiple of the repulsion gain; \
           0 turns it off.",
    )
    .group(FIELD);
const STEP: ParamSpec = float("goto_step_m", "Step", "m", 0.001, 1.0, 0.05)
    .help("Length of a step when planning. The paper gives no value; 0.0071 m fits its number of steps.")
    .group("Plan");
const MARGIN: ParamSpec = float("margin_m", "Detour margin", "m", 0.02, 5.0, 0.14)
    .help(
        "Distance kept from the obstacles that the robot bypasses. Gaps that leave less than this on either side of \
         the hull are treated as closed.",
    )
    .group(TRAP);
const TAUT_MARGIN: ParamSpec = float("taut_margin_m", "Taut path margin", "m", 0.0, 5.0, 0.05)
    .help(
        "Mode pre: distance between the hull and whatever the path is pulled taut around; always \
           slightly more than the clearance.",
    )
    .group(TRAP);
const WINDOW: ParamSpec = float("window_m", "Oscillation window", "m", 0.1, 50.0, 2.0)
    .help(
        "The robot is considered trapped when its latest steps, which together have this length, make \
         almost no headway.",
    )
    .group(TRAP);
const ESCAPES: ParamSpec = int("escapes_max", "Maximum escapes", "", 1, 1000, 12)
    .help("Number of escapes after which the planner gives up.")
    .group(TRAP);

/// All parameters of the planner.
pub(crate) const PARAMS: &[ParamSpec] = &[
    MODE,
    M,
    K,
    RHO_1,
    NEAR_LAW,
    N,
    K_REP,
    RHO_0,
    o::GOAL_PUSH_FORM,
    TANGENT_WEIGHT,
    p::WALL_GAIN,
    STEP,
    MARGIN,
    TAUT_MARGIN,
    WINDOW,
    ESCAPES,
    p::GUARD,
    p::GUARD_SIGMAS,
    p::SLOW,
    p::MIN_SHARE,
    p::STUCK,
];

/// Distance that every step keeps in addition to the required clearance, metres.
const SPARE_M: f64 = 0.02;

/// Reads the settings for a site and a trip of some length from start to goal, metres.
pub(crate) fn settings(config: &Config<'_>, site: &Site<'_>, trip_m: f64) -> MachineSettings {
    let near = if config.choice("near_law") == "printed" { NearLaw::Printed } else { NearLaw::Corrected };
    let tangent_weight = config.float("tangent_weight");
    let keep_m = site.clearance_m + SPARE_M;
    MachineSettings {
        mode: Mode::ALL.into_iter().find(|mode| mode.name() == config.choice("mode")).unwrap_or(Mode::Pre),
        law: GoalLaw {
            pull: Pull::Logarithm {
                m: config.float("m"),
                trip_m,
                k: Some(config.float("k")).filter(|k| *k > 1.0),
                n: Some(config.float("n")).filter(|n| *n > 0.0),
                rho_1_m: config.float("rho_1_m"),
                near,
            },
            push: o::goal_push_form(config),
            k_rep: config.float("k_rep"),
            rho_m: config.float("rho_0_m"),
            tangent: if tangent_weight > 0.0 { TangentUse::Blocking } else { TangentUse::Off },
            tangent_weight,
            wall_gain: config.float("wall_gain"),
        },
        step_m: config.float("goto_step_m"),
        margin_m: config.float("margin_m").max(keep_m),
        taut_margin_m: config.float("taut_margin_m").max(keep_m),
        keep_m,
        window_m: config.float("window_m"),
        escapes_max: config.int("escapes_max") as u32,
    }
}
