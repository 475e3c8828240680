//! The parameters that the operator sets for a tether-safe plan.

use crate::{tether::Demands, tour::Effort};
use planner_api::{Config, ParamSpec, Site, TetherLimits, TetherPull, choice, float, int};
use std::f64::consts::TAU;
use steering::params as p;
use world::tether::{Drag, Limits, PullLimits, Strain};

/// Maximum price of a whole turn, metres.
const MOST_TURN_M: f64 = 20.0;
const UNLIMITED: Limits =
    Limits { reel_length_m: f64::INFINITY, wrap_max_rad: f64::INFINITY, wrap_total_max_rad: f64::INFINITY };

const CHOOSE: ParamSpec = choice("choose", "Candidate", &["shortest", "fewest-turns", "shortest-cable"], 0)
    .help(
        "Which of the candidates within the limits is chosen; shortest takes length and turns into \
         account. The log lists the candidates that no other beats in length, turns and cable. Candidates \
         with a worse first tour are not finished; the log gives their number.",
    )
    .group("Plan");
const PATTERN: ParamSpec = choice("pattern", "Lanes", &["all", "contours", "straight"], 0)
    .help("Lanes along the wall, straight lanes inside a lap along the wall, or whichever is better.")
    .group("Plan");
const DIRECTIONS: ParamSpec = int("directions", "Directions tried", "", 1, 24, 12)
    .help(
        "Number of directions tried for straight lanes; fewer are tried in large tanks. In a round tank, \
         they are the directions in which cuts and obstacles break the fewest lanes. Between straight \
         walls, two are tried.",
    )
    .group("Plan");
const ALPHA: ParamSpec = float("alpha_deg", "Cut angle", "deg", 0.0, 80.0, 50.0)
    .help(
        "Largest angle between a cut and the ray from the anchor. 0 gives the shortest cable; larger \
           angles give shorter paths. Between straight walls, the planner also tries larger angles, up to \
           80 deg.",
    )
    .group("Tether");
const CABLE: ParamSpec = float("cable_share", "Cable over minimum", "", 1.0, 10.0, 1.1)
    .help(
        "Longest cable, as a multiple of the minimum that reaches all floor. A preference: used if any \
           candidate meets it. The reel always limits the cable.",
    )
    .group("Tether");
const WRAP: ParamSpec = float("wrap_deg", "Wrap on one obstacle", "deg", 10.0, 720.0, 80.0)
    .help(
        "Largest wrap on one obstacle. A preference: used if any candidate meets it. The mission's limit \
           always applies.",
    )
    .group("Tether");
const SUM_WRAP: ParamSpec = float("wrap_total_deg", "Total wrap", "deg", 10.0, 3600.0, 100.0)
    .help(
        "Largest total wrap over all obstacles. A preference: used if any candidate meets it. The \
           mission's limit always applies.",
    )
    .group("Tether");
const TURN: ParamSpec = float("turn_m", "Turn cost in search", "m", 0.0, 20.0, 1.3)
    .help(
        "Extra path length accepted for each whole turn saved while the planner searches for a path; a \
           larger value leaves more floor to touch-ups.",
    )
    .group("Plan");
const CHOICE_TURN: ParamSpec = float("choice_turn_m", "Turn cost in selection", "m", 0.0, 20.0, 0.0)
    .help(
        "Extra path length accepted for each whole turn saved when choosing among candidates. 0: the \
           distance the robot drives in the time of one turn, so that the quickest candidate is chosen.",
    )
    .group("Plan");
const ENOUGH: ParamSpec = float("coverage_pct", "Coverage target", "%", 50.0, 100.0, 99.58)
    .help(
        "Touch-ups are added until this share of the reachable floor is scanned, counted in cells other \
         than those to which the path was fitted.",
    )
    .group("Plan");
const CELL: ParamSpec = float("cell_m", "Cell", "m", 0.01, 0.5, 0.025)
    .help(
        "Edge length of the cells in which floor is counted; larger in large tanks, to stay below four \
         million cells.",
    )
    .group("Plan");
const KICKS: ParamSpec = float("kicks", "Search", "", 0.0, 200.0, 4.0)
    .help(
        "Number of changes tried per lane when searching for the order of lanes. More changes take \
           longer and shorten the path.",
    )
    .group("Plan");
/// Distance that the robot keeps from obstacles when it leaves its path.
const GUARD: ParamSpec = float("guard_m", "Guard distance", "m", 0.0, 1.0, 0.1)
    .help(
        "No motion towards an obstacle is allowed if the hull is closer to it than this distance, which \
         never exceeds three quarters of the mission's clearance.",
    )
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

/// The criterion for choosing a candidate.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Choice {
    /// By length and turns; candidates that look worse are not finished.
    Shortest,
    FewestTurns,
    ShortestCable,
}

/// The operator's preferences, as described by the parameters, and the mission's limits.
#[derive(Clone, Copy)]
pub(super) struct Preferences {
    pub alpha_rad: f64,
    pub cable_share: f64,
    /// Preferred reel length and wraps.
    pub limits: Limits,
    /// Reel length and wraps that the mission requires.
    pub demanded: Limits,
    /// The pull that the mission allows; `None` if the pull is not limited.
    pub pull: Option<PullLimits>,
    pub choice: Choice,
    /// Price of a whole turn when choosing among candidates, metres.
    pub choice_turn_m: f64,
    pub enough: f64,
    pub cell_m: f64,
    /// Number of directions of straight lanes to try; 0 for no straight lanes.
    pub directions: usize,
    pub contours: bool,
    pub effort: Effort,
}

impl Preferences {
    /// Reads the preferences from the parameters, for a mission without a tether.
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
            pull: None,
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

    /// The same preferences under the mission's limits; unchanged for a robot without a tether.
    pub(super) fn under(self, tether: Option<TetherLimits>) -> Self {
        let Some(TetherLimits { reel_length_m, wrap_max_rad, wrap_total_max_rad, pull }) = tether else {
            return self;
        };
        let limits = Limits {
            reel_length_m: self.limits.reel_length_m.min(reel_length_m),
            wrap_max_rad: self.limits.wrap_max_rad.min(wrap_max_rad),
            wrap_total_max_rad: self.limits.wrap_total_max_rad.min(wrap_total_max_rad),
        };
        let pull = pull.map(|TetherPull { floor_n_per_m, friction, reel_n, preferred_n }| PullLimits {
            drag: Drag { floor_n_per_m, friction },
            reel_n,
            preferred_n,
            pay_out_n: 0.0,
            robot_n: None,
        });
        Self { limits, demanded: Limits { reel_length_m, wrap_max_rad, wrap_total_max_rad }, pull, ..self }
    }

    /// The same preferences for a floor between inner walls, which bend the cable wherever the cuts are. Only the
    /// mission's limits apply there.
    pub(super) fn between_walls(self) -> Self {
        let Limits { wrap_max_rad, wrap_total_max_rad, .. } = self.demanded;
        let limits = Limits { wrap_max_rad, wrap_total_max_rad, ..self.limits };
        Self { alpha_rad: 0.0, cable_share: f64::INFINITY, limits, ..self }
    }

    /// What the mission requires of the tether.
    pub(super) fn demands(&self) -> Demands {
        (self.demanded, self.pull)
    }

    /// The preferred length of the cable, metres: a multiple of the minimum that reaches all floor, and no more than the
    /// preferred pull can drag over the floor, but at least that minimum.
    pub(super) fn preferred_cable_m(&self, least_m: f64) -> f64 {
        let dragged_m = self.pull.map_or(f64::INFINITY, |pull| pull.preferred_n / pull.drag.floor_n_per_m);
        (least_m * self.cable_share).min(dragged_m.max(least_m))
    }

    /// The pull that taking up the cable needs, as a share of the preferred one; 0 if the pull is not limited.
    pub(super) fn pull_share(&self, strain: &Strain) -> f64 {
        self.pull.map_or(0.0, |pull| strain.pull_max_n / pull.preferred_n)
    }

    /// Whether the tether meets the preferences for length, wrap and pull.
    pub(super) fn allow(&self, strain: &Strain) -> bool {
        strain.cable_share() <= self.cable_share + 1e-6
            && strain.wrap_max_rad <= self.limits.wrap_max_rad
            && strain.wrap_total_max_rad <= self.limits.wrap_total_max_rad
            && self.pull_share(strain) <= 1.0
    }

    /// The same preferences, with the length multiplied by one factor and the wraps by another.
    pub(super) fn with_leeway(&self, length: f64, wrap: f64) -> Self {
        let limits = Limits {
            wrap_max_rad: self.limits.wrap_max_rad * wrap,
            wrap_total_max_rad: self.limits.wrap_total_max_rad * wrap,
            ..self.limits
        };
        let pull = self.pull.map(|pull| PullLimits { preferred_n: pull.preferred_n * length * wrap, ..pull });
        Self { cable_share: self.cable_share * length, limits, pull, ..*self }
    }
}

/// The distance that the robot drives at full speed in the time of a whole turn, metres; 0 for a robot that need not
/// turn.
fn driven_in_a_turn_m(site: &Site<'_>) -> f64 {
    let turn_m = site.limits.v_max_m_per_s * TAU / site.limits.w_max_rad_per_s;
    if turn_m.is_finite() { turn_m.clamp(0.0, MOST_TURN_M) } else { 0.0 }
}
