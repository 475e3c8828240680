//! What the operator sets of a tether-safe plan.

use crate::tour::Effort;
use planner_api::{Config, ParamSpec, Site, TetherLimits, choice, float, int};
use std::f64::consts::TAU;
use steering::params as p;
use world::tether::{Limits, Strain};

/// The most that a whole turn counts, metres.
const MOST_TURN_M: f64 = 20.0;
const UNLIMITED: Limits =
    Limits { reel_length_m: f64::INFINITY, wrap_max_rad: f64::INFINITY, wrap_total_max_rad: f64::INFINITY };

const CHOOSE: ParamSpec = choice("choose", "Candidate", &["shortest", "fewest-turns", "shortest-cable"], 0)
    .help("Which of the candidates within the limits is flown, shortest by length and turns. The log lists those that no other \
           beats in length, turns and cable; those that look worse by their first tours are not finished, and their number is logged.")
    .group("Plan");
const PATTERN: ParamSpec = choice("pattern", "Lanes", &["all", "contours", "straight"], 0)
    .help("Lanes along the wall, straight lanes within a lap along the wall, or whichever is better.")
    .group("Plan");
const DIRECTIONS: ParamSpec = int("directions", "Directions tried", "", 1, 24, 12)
    .help("Straight lanes are tried in this many directions, fewer in large tanks: in a round tank those in which cuts and obstacles \
           break the fewest lanes, between straight walls two.")
    .group("Plan");
const ALPHA: ParamSpec = float("alpha_deg", "Angle of cuts", "deg", 0.0, 80.0, 50.0)
    .help("Largest angle between a cut and the ray from the anchor: 0 gives the shortest cable, more a shorter path. Between straight \
           walls larger ones, up to 80 deg, are tried as well.")
    .group("Tether");
const CABLE: ParamSpec = float("cable_share", "Cable over least", "", 1.0, 10.0, 1.1)
    .help("Longest cable, as a multiple of the least that can do, if any candidate keeps it; the reel always limits it.")
    .group("Tether");
const WRAP: ParamSpec = float("wrap_deg", "Wrap on one obstacle", "deg", 10.0, 720.0, 80.0)
    .help("Largest angle of the cable about one obstacle, if any candidate keeps it; the mission's limit always holds.")
    .group("Tether");
const SUM_WRAP: ParamSpec = float("wrap_total_deg", "Wrap in sum", "deg", 10.0, 3600.0, 100.0)
    .help("Largest sum of the angles about all obstacles, if any candidate keeps it; the mission's limit always holds.")
    .group("Tether");
const TURN: ParamSpec = float("turn_m", "Turn in the search", "m", 0.0, 20.0, 1.3)
    .help("While a path is sought it may get this much longer for every whole turn saved; more leaves more floor to touch-ups.")
    .group("Plan");
const CHOICE_TURN: ParamSpec = float("choice_turn_m", "Turn in the choice", "m", 0.0, 20.0, 0.0)
    .help("Among candidates one may be this much longer for every whole turn that it saves; 0: what the robot drives in the time \
           of a turn, so that the quickest is chosen.")
    .group("Plan");
const ENOUGH: ParamSpec = float("coverage_pct", "Coverage asked", "%", 50.0, 100.0, 99.58)
    .help("Touch-ups are added until this share of the floor in reach is scanned, by cells that no path is fitted to.")
    .group("Plan");
const CELL: ParamSpec = float("cell_m", "Cell", "m", 0.01, 0.5, 0.025)
    .help("Edge of the cells in which floor is counted; in large tanks as much larger as keeps them below four million.")
    .group("Plan");
const KICKS: ParamSpec = float("kicks", "Search", "", 0.0, 200.0, 4.0)
    .help("Changes tried per lane in the search for the order of lanes; more takes longer and shortens the path.")
    .group("Plan");
/// How near the robot goes when it comes off its path.
const GUARD: ParamSpec = float("guard_m", "Guard distance", "m", 0.0, 1.0, 0.1)
    .help("Hull distance below which no motion toward an obstacle is allowed; never more than three quarters of the mission's clearance.")
    .group("Flight")
    .live();

/// All parameters, in the order in which they are shown.
pub(super) const ALL: &[ParamSpec] = &[
    CHOOSE,
    PATTERN,
    DIRECTIONS,
    ALPHA,
    CABLE,
    WRAP,
    SUM_WRAP,
    TURN,
    CHOICE_TURN,
    ENOUGH,
    CELL,
    KICKS,
    GUARD,
    p::GUARD_SIGMAS,
    p::SLOW,
    p::MIN_SHARE,
    p::STUCK,
];

/// Which of the candidates is flown.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Choice {
    /// By length and turns; candidates that look worse are not finished for it.
    Shortest,
    FewestTurns,
    ShortestCable,
}

/// What the operator prefers, as the parameters explain, and what the mission demands.
#[derive(Clone, Copy)]
pub(super) struct Preferences {
    pub alpha_rad: f64,
    pub cable_share: f64,
    /// Reel and wraps that are wanted.
    pub limits: Limits,
    /// Reel and wraps that the mission demands.
    pub demanded: Limits,
    pub choice: Choice,
    /// Price of a whole turn in the choice, metres.
    pub choice_turn_m: f64,
    pub enough: f64,
    pub cell_m: f64,
    /// Directions of straight lanes that are tried; none if 0.
    pub directions: usize,
    pub contours: bool,
    pub effort: Effort,
}

impl Preferences {
    /// The preferences that parameters express, for a mission without a tether.
    pub(super) fn of(config: &Config<'_>, site: &Site<'_>) -> Self {
        let pattern = config.choice("pattern");
        Self {
            alpha_rad: config.float("alpha_deg").to_radians(),
            cable_share: config.float("cable_share"),
            limits: Limits {
                wrap_max_rad: config.float("wrap_deg").to_radians(),
                wrap_total_max_rad: config.float("wrap_total_deg").to_radians(),
                ..UNLIMITED
            },
            demanded: UNLIMITED,
            choice: match config.choice("choose") {
                "fewest-turns" => Choice::FewestTurns,
                "shortest-cable" => Choice::ShortestCable,
                _ => Choice::Shortest,
            },
            choice_turn_m: Some(config.float("choice_turn_m"))
                .filter(|turn_m| *turn_m > 0.0)
                .unwrap_or_else(|| driven_in_a_turn_m(site)),
            enough: config.float("coverage_pct") / 100.0,
            cell_m: config.float("cell_m"),
            directions: if pattern == "contours" { 0 } else { config.int("directions") as usize },
            contours: pattern != "straight",
            effort: Effort {
                turn_m_per_rad: config.float("turn_m") / TAU,
                kicks_per_lane: config.float("kicks"),
                seed: site.seed,
            },
        }
    }

    /// The same preferences under what the mission demands: nothing of a robot without a tether.
    pub(super) fn under(self, tether: Option<TetherLimits>) -> Self {
        let Some(TetherLimits { reel_length_m, wrap_max_rad, wrap_total_max_rad }) = tether else {
            return self;
        };
        let limits = Limits {
            reel_length_m: self.limits.reel_length_m.min(reel_length_m),
            wrap_max_rad: self.limits.wrap_max_rad.min(wrap_max_rad),
            wrap_total_max_rad: self.limits.wrap_total_max_rad.min(wrap_total_max_rad),
        };
        Self { limits, demanded: Limits { reel_length_m, wrap_max_rad, wrap_total_max_rad }, ..self }
    }

    /// The same between inner walls, which bend the cable whatever the cuts are: only what is demanded counts.
    pub(super) fn between_walls(self) -> Self {
        let Limits { wrap_max_rad, wrap_total_max_rad, .. } = self.demanded;
        let limits = Limits { wrap_max_rad, wrap_total_max_rad, ..self.limits };
        Self { alpha_rad: 0.0, cable_share: f64::INFINITY, limits, ..self }
    }

    /// Whether the tether is as short and straight as is preferred.
    pub(super) fn allow(&self, strain: &Strain) -> bool {
        strain.cable_share() <= self.cable_share + 1e-6
            && strain.wrap_max_rad <= self.limits.wrap_max_rad
            && strain.wrap_total_max_rad <= self.limits.wrap_total_max_rad
    }

    /// The same with so many times the length and the wraps of the tether.
    pub(super) fn with_leeway(&self, length: f64, wrap: f64) -> Self {
        let limits = Limits {
            wrap_max_rad: self.limits.wrap_max_rad * wrap,
            wrap_total_max_rad: self.limits.wrap_total_max_rad * wrap,
            ..self.limits
        };
        Self { cable_share: self.cable_share * length, limits, ..*self }
    }
}

/// What the robot drives at full speed in the time of a whole turn, metres; a robot that need not turn pays nothing.
fn driven_in_a_turn_m(site: &Site<'_>) -> f64 {
    let turn_m = site.limits.v_max_m_per_s * TAU / site.limits.w_max_rad_per_s;
    if turn_m.is_finite() { turn_m.clamp(0.0, MOST_TURN_M) } else { 0.0 }
}
