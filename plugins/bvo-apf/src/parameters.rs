//! The parameters, and how they become settings.

use crate::settings::{MachineSettings, Mode};
use field::{GoalLaw, NearLaw, Pull, TangentUse, open_points as o, params as p};
use planner_api::{Config, ParamSpec, Site, choice, float, int};

const TRAP: &str = "Trap";
const FIELD: &str = "Field";

const MODES: [&str; 4] = [Mode::Literal.name(), Mode::Hull.name(), Mode::Rollout.name(), Mode::Pre.name()];
const MODE: ParamSpec = choice("mode", "Mode", &MODES, 3)
    .help(
        "literal: round a circle about the trap, on the left, as published. hull: along the hull of the trap. rollout: \
         on the side that is shorter when walked in thought. pre: the detour begins before the trap is entered.",
    )
    .group(TRAP);
const M: ParamSpec = float("m", "Pull", "N", 0.001, 1000.0, 10.0)
    .help("Pull of the goal at the start; the paper's m. Only its ratio to the repulsion gain matters.")
    .group(FIELD);
const RHO_1: ParamSpec = float("rho_1_m", "Range of the near law", "m", 0.01, 100.0, 1.0)
    .help("Distance from the goal at which the near law of the pull takes over.")
    .group(FIELD);
const NEAR_LAW: ParamSpec = choice("near_law", "Near law", &["corrected", "printed"], 0)
    .help("corrected: the pull grows at the goal, as the paper says. printed: it vanishes there, as its formula has it.")
    .group(FIELD);
const K: ParamSpec = float("k", "Base of the logarithm", "", 0.0, 1e6, 0.0)
    .help("The paper's k of eq. 4. Up to 1: the distance from start to goal and one, so that the pull falls from m.")
    .group(FIELD);
const N: ParamSpec = float("n", "Pull near the goal", "N", 0.0, 1e6, 0.0)
    .help("Gain of the near law; the paper's n of eq. 4, which it calls adaptive. 0: as large as makes the two laws meet.")
    .group(FIELD);
const K_REP: ParamSpec = float("k_rep", "Repulsion gain", "N m3", 0.0, 1000.0, 10.0)
    .help("Push and tangent force of obstacles; the papers' mu.")
    .group(FIELD);
const RHO_0: ParamSpec = float("rho_0_m", "Range of obstacles", "m", 0.05, 50.0, 2.0)
    .help("Distance between hull and obstacle at which obstacles begin to act.")
    .group(FIELD);
const TANGENT_WEIGHT: ParamSpec = float("tangent_weight", "Weight of the tangent force", "", 0.0, 100.0, 1.0)
    .help("Tangent force round what blocks the way to the goal, as a multiple of the repulsion gain; 0 turns it off.")
    .group(FIELD);
const STEP: ParamSpec = float("goto_step_m", "Step", "m", 0.001, 1.0, 0.05)
    .help("Length of a move when planning; the paper prints none; its step count fits 0.0071.")
    .group("Plan");
const MARGIN: ParamSpec = float("margin_m", "Margin of a detour", "m", 0.02, 5.0, 0.14)
    .help("Distance kept from what is gone round. Gaps that leave less on both sides of the hull count as closed.")
    .group(TRAP);
const TAUT_MARGIN: ParamSpec = float("taut_margin_m", "Margin of a taut path", "m", 0.0, 5.0, 0.05)
    .help("Mode pre: distance between the hull and what the path is pulled around; at least a little more than the clearance.")
    .group(TRAP);
const WINDOW: ParamSpec = float("window_m", "Window of oscillation", "m", 0.1, 50.0, 2.0)
    .help("The robot counts as trapped when its last moves of this length lead hardly anywhere.")
    .group(TRAP);
const ESCAPES: ParamSpec = int("escapes_max", "Escapes at most", "", 1, 1000, 12)
    .help("After so many escapes the planner gives up.")
    .group(TRAP);

/// Every parameter of the planner.
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

/// No step goes nearer to anything than the clearance that is demanded and this, metres.
const SPARE_M: f64 = 0.02;

/// Settings for a site and a trip of some length from start to goal, metres.
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
