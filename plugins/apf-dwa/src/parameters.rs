//! The parameters and their conversion to settings.

use crate::{
    guide::{Field, GuideBy},
    hybrid::HybridSettings,
    window::{Weights, Window},
};
use field::{params as p, virtual_goals::SquareLaw};
use planner_api::{Config, ParamSpec, Site, choice, float, int};
use world::{Amphibious, Pace};

const FIELD: &str = "Field";
const ROBOT: &str = "Robot";
const WINDOW: &str = "Window";

const GUIDE: ParamSpec = choice("guide", "Virtual goals", &["square", "corners"], 1)
    .help(
        "square: in a local minimum, one of four on a square around the goal, as published. corners: the \
         corners of the shortest path over the known map, whenever the straight path is blocked.",
    )
    .group(FIELD);
const K_ATT: ParamSpec = float("k_att", "Attraction gain", "N/m", 0.001, 1000.0, 15.0)
    .help("Pull towards the goal per metre of distance; Table 2 of the paper has 15.")
    .group(FIELD);
const K_REP: ParamSpec = float("k_rep", "Repulsion gain", "N m3", 0.0, 1000.0, 5.0)
    .help("Gain of the push from obstacles; Table 2 of the paper has 5.")
    .group(FIELD);
const RHO_0: ParamSpec = float("rho_0_m", "Obstacle range", "m", 0.05, 50.0, 1.0)
    .help("Distance from the hull at which obstacles begin to push.")
    .group(FIELD);
const D_0: ParamSpec = float("d_0_m", "Goal range", "m", 0.0, 100.0, 3.0)
    .help("Closer to the goal than this, the pull is constant and no virtual goal on the square is used.")
    .group(FIELD);
const SQUARE: ParamSpec = float("square_m", "Virtual goal distance", "m", 0.1, 100.0, 4.0)
    .help("Distance of the four virtual goals from the goal; the paper gives no value.")
    .group(FIELD);
const HOLD: ParamSpec = int("hold_steps", "Virtual goal duration", "", 1, 100_000, 300)
    .help("Largest number of steps for which a virtual goal is kept; the paper gives no value.")
    .group(FIELD);
const LAND_SPEED: ParamSpec = float("land_speed_max_m_per_s", "Speed on land", "m/s", 0.0, 10.0, 0.0)
    .help("Maximum speed on dry floor; 0: the robot's own limit. Table 1 of the paper has 0.13.")
    .group(ROBOT);
const LAND_TURN: ParamSpec = float("land_turn_rad_per_s", "Turn rate on land", "rad/s", 0.0, 10.0, 0.0)
    .help("Maximum turn rate on dry floor; 0: the robot's own limit. Table 1 of the paper has 0.12.")
    .group(ROBOT);
const WATER_SPEED: ParamSpec =
    float("underwater_speed_max_m_per_s", "Speed under water", "m/s", 0.0, 10.0, 0.0)
        .help("Maximum speed in flooded zones; 0: the robot's own limit. Table 1 of the paper has 0.23.")
        .group(ROBOT);
const WATER_TURN: ParamSpec =
    float("underwater_turn_rad_per_s", "Turn rate under water", "rad/s", 0.0, 10.0, 0.0)
        .help("Maximum turn rate in flooded zones; 0: the robot's own limit. Table 1 of the paper has 0.31.")
        .group(ROBOT);
const TRANSITION: ParamSpec = int("transition_steps", "Transition steps", "", -1, 10_000, -1)
    .help(
        "Number of steps over which the limits change between land and water; 0: immediately; -1: the \
         robot's own value.",
    )
    .group(ROBOT);
const ACCELERATION: ParamSpec = float("acceleration_m_per_s2", "Acceleration", "m/s2", 0.0, 100.0, 0.0)
    .help("Maximum acceleration and braking; 0: the robot's own limit. The paper gives no value.")
    .group(ROBOT);
const TURN_ACCELERATION: ParamSpec =
    float("turn_acceleration_rad_per_s2", "Turn acceleration", "rad/s2", 0.0, 100.0, 0.0)
        .help(
            "Maximum change of turn rate; 0: enough to reach the turn rate on land in 0.3 s. The paper \
             gives no value.",
        )
        .group(ROBOT);
const HEADING: ParamSpec = float("weight_heading", "Heading weight", "", 0.0, 100.0, 0.2)
    .help("Weight of pointing along the force at the end of an arc; Table 2 of the paper has 0.2.")
    .group(WINDOW);
const DISTANCE: ParamSpec = float("weight_distance", "Distance weight", "", 0.0, 100.0, 0.1)
    .help("Weight of the clearance along an arc; Table 2 of the paper has 0.1.")
    .group(WINDOW);
const VELOCITY: ParamSpec = float("weight_velocity", "Speed weight", "", 0.0, 100.0, 0.1)
    .help("Weight of the speed on an arc; Table 2 of the paper has 0.1.")
    .group(WINDOW);
const STEP_S: ParamSpec = float("step_s", "Step", "s", 0.01, 1.0, 0.1)
    .help("Length of a step when planning; Table 2 of the paper has 0.1 s.")
    .group("Plan");
const STEPS: ParamSpec = int("steps_max", "Maximum steps", "", 0, 20_000, 0)
    .help("Largest number of steps in a plan; 0: derived from the length of the trip.")
    .group("Plan");

/// All parameters of the planner.
pub(crate) const PARAMS: &[ParamSpec] = &[
    GUIDE,
    K_ATT,
    K_REP,
    RHO_0,
    D_0,
    SQUARE,
    HOLD,
    p::WALL_GAIN,
    LAND_SPEED,
    LAND_TURN,
    WATER_SPEED,
    WATER_TURN,
    TRANSITION,
    ACCELERATION,
    TURN_ACCELERATION,
    HEADING,
    DISTANCE,
    VELOCITY,
    p::GUARD,
    STEP_S,
    STEPS,
    p::STUCK,
    p::EVADE,
];

/// Default turn acceleration. The robot of Table 1 turns at 0.12 rad/s on land; 0.4 rad/s2 reproduces the paper's
/// figures.
const TURNING_S: f64 = 0.12 / 0.4;
/// Distance that the window keeps in addition to the required clearance, because arcs are checked only at points,
/// metres.
const SPARE_M: f64 = 0.02;

/// Reads the settings for a site.
pub(crate) fn settings(config: &Config<'_>, site: &Site<'_>) -> HybridSettings {
    let keep_m = keep_m(config, site.limits.radius_m, site.clearance_m);
    let square = SquareLaw {
        k_att: config.float("k_att"),
        d_0_m: config.float("d_0_m"),
        square_m: config.float("square_m"),
        improved: true,
        hold_steps: config.int("hold_steps") as usize,
    };
    let push = square.push(config.float("k_rep"), config.float("rho_0_m"), config.float("wall_gain"));
    let by = if config.choice("guide") == "square" { GuideBy::Square } else { GuideBy::Corners };
    let robot = robot(config, site);
    let turn_acceleration_rad_per_s2 = match config.float("turn_acceleration_rad_per_s2") {
        0.0 => robot.land.w_max_rad_per_s / TURNING_S,
        set => set,
    };
    let window = Window {
        acceleration_m_per_s2: or_own(
            config.float("acceleration_m_per_s2"),
            site.limits.acceleration_m_per_s2,
        ),
        turn_acceleration_rad_per_s2,
        weights: Weights {
            heading: config.float("weight_heading"),
            distance: config.float("weight_distance"),
            velocity: config.float("weight_velocity"),
        },
        keep_m,
        dt_s: config.float("step_s"),
    };
    HybridSettings {
        robot,
        window,
        field: Field { square, push, by, keep_m },
        steps_max: config.int("steps_max") as usize,
    }
}

/// Distance that the robot's centre keeps from solids, metres, for its hull and the mission's clearance.
pub(crate) fn keep_m(config: &Config<'_>, hull_m: f64, clearance_m: f64) -> f64 {
    hull_m + config.float("guard_m").max(clearance_m) + SPARE_M
}

/// The configured limits on land and under water, none of them above the robot's own.
fn robot(config: &Config<'_>, site: &Site<'_>) -> Amphibious {
    let own = Pace { v_max_m_per_s: site.limits.v_max_m_per_s, w_max_rad_per_s: site.limits.w_max_rad_per_s };
    let own =
        site.limits.amphibious.unwrap_or(Amphibious { land: own, underwater: own, transition_steps: 0 });
    let pace = |own: Pace, speed: &str, turn: &str| Pace {
        v_max_m_per_s: or_own(config.float(speed), own.v_max_m_per_s),
        w_max_rad_per_s: or_own(config.float(turn), own.w_max_rad_per_s),
    };
    let steps = u32::try_from(config.int("transition_steps"));
    Amphibious {
        land: pace(own.land, "land_speed_max_m_per_s", "land_turn_rad_per_s"),
        underwater: pace(own.underwater, "underwater_speed_max_m_per_s", "underwater_turn_rad_per_s"),
        transition_steps: steps.unwrap_or(own.transition_steps),
    }
}

/// Returns the configured limit, capped at the robot's own, or the robot's own limit if none is configured.
fn or_own(set: f64, own: f64) -> f64 {
    if set > 0.0 { set.min(own) } else { own }
}
