//! The parameters, and how they become settings.

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
        "square: in a minimum, one of four on a square round the goal, as published. corners: those of the shortest way \
         over the known map, whenever the straight way is blocked.",
    )
    .group(FIELD);
const K_ATT: ParamSpec = float("k_att", "Attraction gain", "N/m", 0.001, 1000.0, 15.0)
    .help("Pull toward the goal per metre of distance; Table 2 of the paper has 15.")
    .group(FIELD);
const K_REP: ParamSpec = float("k_rep", "Repulsion gain", "N m3", 0.0, 1000.0, 5.0)
    .help("Push of obstacles; Table 2 of the paper has 5.")
    .group(FIELD);
const RHO_0: ParamSpec = float("rho_0_m", "Range of obstacles", "m", 0.05, 50.0, 1.0)
    .help("Distance between hull and obstacle at which obstacles begin to push.")
    .group(FIELD);
const D_0: ParamSpec = float("d_0_m", "Range of the goal", "m", 0.0, 100.0, 3.0)
    .help("Nearer than this the pull is constant and no virtual goal of the square is used.")
    .group(FIELD);
const SQUARE: ParamSpec = float("square_m", "Distance of virtual goals", "m", 0.1, 100.0, 4.0)
    .help("How far from the goal the four virtual goals lie; the paper gives no number.")
    .group(FIELD);
const HOLD: ParamSpec = int("hold_steps", "Steps with a virtual goal", "", 1, 100_000, 300)
    .help("A virtual goal is kept for this many steps at most; the paper gives no number.")
    .group(FIELD);
const LAND_SPEED: ParamSpec = float("land_speed_max_m_per_s", "Speed on land", "m/s", 0.0, 10.0, 0.0)
    .help("Largest speed on dry floor; 0 takes the robot's own. Table 1 of the paper has 0.13.")
    .group(ROBOT);
const LAND_TURN: ParamSpec = float("land_turn_rad_per_s", "Turn rate on land", "rad/s", 0.0, 10.0, 0.0)
    .help("Largest turn rate on dry floor; 0 takes the robot's own. Table 1 of the paper has 0.12.")
    .group(ROBOT);
const WATER_SPEED: ParamSpec = float(
    "underwater_speed_max_m_per_s",
    "Speed under water",
    "m/s",
    0.0,
    10.0,
    0.0,
)
.help("Largest speed in zones that are flooded; 0 takes the robot's own. Table 1 of the paper has 0.23.")
.group(ROBOT);
const WATER_TURN: ParamSpec = float(
    "underwater_turn_rad_per_s",
    "Turn rate under water",
    "rad/s",
    0.0,
    10.0,
    0.0,
)
.help("Largest turn rate in zones that are flooded; 0 takes the robot's own. Table 1 of the paper has 0.31.")
.group(ROBOT);
const TRANSITION: ParamSpec = int("transition_steps", "Steps of transition", "", -1, 10_000, -1)
    .help("Steps in which the limits of one mode change into those of the other; 0 is at once, -1 the robot's own.")
    .group(ROBOT);
const ACCELERATION: ParamSpec = float("acceleration_m_per_s2", "Acceleration", "m/s2", 0.0, 100.0, 0.0)
    .help("Largest change of speed; 0 takes the robot's own. The paper gives none.")
    .group(ROBOT);
const TURN_ACCELERATION: ParamSpec =
    float("turn_acceleration_rad_per_s2", "Turn acceleration", "rad/s2", 0.0, 100.0, 0.0)
        .help("Largest change of turn rate; 0 reaches the turn rate on land in 0.3 s. The paper gives none.")
        .group(ROBOT);
const HEADING: ParamSpec = float("weight_heading", "Weight of the heading", "", 0.0, 100.0, 0.2)
    .help("Looking along the force at the end of an arc; Table 2 of the paper has 0.2.")
    .group(WINDOW);
const DISTANCE: ParamSpec = float("weight_distance", "Weight of the distance", "", 0.0, 100.0, 0.1)
    .help("Room beside an arc; Table 2 of the paper has 0.1.")
    .group(WINDOW);
const VELOCITY: ParamSpec = float("weight_velocity", "Weight of the speed", "", 0.0, 100.0, 0.1)
    .help("Speed on an arc; Table 2 of the paper has 0.1.")
    .group(WINDOW);
const STEP_S: ParamSpec = float("step_s", "Step", "s", 0.01, 1.0, 0.1)
    .help("Length of a step when planning; Table 2 of the paper has 0.1 s.")
    .group("Plan");
const STEPS: ParamSpec = int("steps_max", "Steps at most", "", 0, 50_000, 0)
    .help("Steps of a plan; 0 lets the length of the trip decide.")
    .group("Plan");

/// Every parameter of the planner.
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

/// The robot of Table 1 turns by 0.12 rad/s on land; with 0.4 rad/s2 the paper's figures come out.
const TURNING_S: f64 = 0.12 / 0.4;
/// The window keeps this much more than is demanded: arcs are looked at in places, metres.
const SPARE_M: f64 = 0.02;

/// Settings for a site.
pub(crate) fn settings(config: &Config<'_>, site: &Site<'_>) -> HybridSettings {
    let keep_m = site.limits.radius_m + config.float("guard_m").max(site.clearance_m) + SPARE_M;
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

/// How the robot walks and swims, never faster than the robot itself.
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

/// A limit that is set, never above the robot's own, or the robot's own.
fn or_own(set: f64, own: f64) -> f64 {
    if set > 0.0 { set.min(own) } else { own }
}
