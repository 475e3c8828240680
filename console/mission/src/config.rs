//! What a mission is to do, and within which limits.

use crate::planner::PlannerChoice;
use geometry::motion::{TURN_FIRST_IN_LANES_RAD, TURN_FIRST_RAD};
use planner_api::{Limits, Motion, TetherLimits};
use positioning::{Aggregation, Forecast, RangeNoise, SolverKind, Timing};
use serde::{Deserialize, Serialize};
use world::{Point, Pose, PressureSensor, coverage::Tool, tether};

/// What is to be achieved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TaskConfig {
    /// Reach a point.
    Goto {
        /// The point, metres.
        goal: Point,
        /// Distance at which it counts as reached, metres.
        tolerance_m: f64,
    },
    /// Follow preset points in order.
    Follow {
        /// The points, the first one first.
        path: Vec<Point>,
        /// Distance at which the last one counts as reached, metres.
        tolerance_m: f64,
    },
    /// Scan the floor and come back to the anchor.
    Cover {
        /// Where the path ends, and where the tether is made fast if there is one, metres.
        anchor: Point,
        /// What is to be scanned, as closed polygons; empty for all floor that can be reached.
        #[serde(default)]
        regions: Vec<Vec<Point>>,
        /// Distance from the anchor at which the robot counts as back, metres.
        tolerance_m: f64,
    },
}

impl TaskConfig {
    /// The last place of the task; `None` for an empty path.
    pub fn end(&self) -> Option<Point> {
        match self {
            Self::Goto { goal, .. } => Some(*goal),
            Self::Follow { path, .. } => path.last().copied(),
            Self::Cover { anchor, .. } => Some(*anchor),
        }
    }

    /// Heading error above which a unicycle turns on the spot before it drives, radians.
    pub fn turn_first_rad(&self) -> f64 {
        match self {
            Self::Cover { .. } => TURN_FIRST_IN_LANES_RAD,
            Self::Goto { .. } | Self::Follow { .. } => TURN_FIRST_RAD,
        }
    }
}

/// What it takes for floor to count as scanned.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct ScanConfig {
    /// Width by which neighbouring lanes shall overlap, metres: planners get a swath narrower by this, so that
    /// the position error leaves no gaps between lanes.
    pub overlap_m: f64,
    /// Half width of the 95 % position error above which nothing counts as scanned, metres; `None` for the limit
    /// above which the position counts as lost.
    pub position_limit_m: Option<f64>,
}

/// How ranges become a position.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Locating {
    /// How single ranges scatter; none: normally, by [`MissionConfig::range_sigma_ratio`].
    pub noise: Option<RangeNoise>,
    /// How repetitions become one range.
    pub aggregation: Aggregation,
    /// How ranges become a fix.
    pub solver: SolverKind,
    /// How the times behind single ranges err besides.
    #[serde(skip_serializing_if = "Timing::is_none")]
    pub timing: Timing,
    /// Standard deviation of what all ranges may be too long by as a share, whatever the repetitions.
    #[serde(skip_serializing_if = "is_zero")]
    pub scale_sigma_ratio: f64,
    /// Whether the speed of sound is found out under way.
    pub calibrate_sound_speed: bool,
    /// Ranges per station and cycle, as far as forecasts of the accuracy go.
    pub repetitions: u32,
    /// Whether a station is of no use where an obstacle hides it.
    pub needs_line_of_sight: bool,
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
fn is_zero(number: &f64) -> bool {
    *number <= 0.0
}

impl Default for Locating {
    fn default() -> Self {
        Self {
            noise: None,
            timing: Timing::default(),
            scale_sigma_ratio: 0.0,
            aggregation: Aggregation::default(),
            solver: SolverKind::default(),
            calibrate_sound_speed: false,
            repetitions: 20,
            needs_line_of_sight: false,
        }
    }
}

/// A tether as scenarios describe it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TetherConfig {
    /// Where the cable comes out: the start, a manhole, the place below a roof hatch; metres.
    pub anchor: Point,
    /// What the cable may do.
    pub limits: tether::Limits,
    /// Friction of cable on steel, for the pull; the shape of the cable does not depend on it.
    pub friction: f64,
    /// Whether plans fly that cannot be certified.
    #[serde(default)]
    pub allow_uncertified: bool,
}

impl TetherConfig {
    /// The limits as planners read them.
    pub fn as_request(&self) -> TetherLimits {
        let tether::Limits { reel_length_m, wrap_max_rad, wrap_total_max_rad } = self.limits;
        TetherLimits { reel_length_m, wrap_max_rad, wrap_total_max_rad }
    }
}

/// After a repair the planner is asked for a plan for all that is left, while the robot flies on: what becomes of one that is
/// better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BetterPlan {
    /// None is made.
    #[default]
    Off,
    /// It is offered to the operator. Where nobody is there to take it, none is made.
    Offer,
    /// It is flown.
    Take,
}

impl BetterPlan {
    /// Whether none is made. Serde gives a reference.
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
    fn is_off(&self) -> bool {
        *self == Self::Off
    }
}

/// A mission as the engine needs it; made and checked by whoever reads the scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MissionConfig {
    /// What is to be achieved.
    pub task: TaskConfig,
    /// Where the robot stands at the start, as surveyed at the manway.
    pub start: Pose,
    /// Standard deviation of the surveyed start, metres.
    pub start_sigma_m: f64,
    /// Length of a tick, seconds.
    pub tick_s: f64,
    /// The mission ends unfinished after this time, seconds; while it is held and attended, no time counts.
    pub time_limit_s: f64,
    /// What the robot can do.
    pub limits: Limits,
    /// Width of floor scanned in one pass, metres.
    pub swath_m: f64,
    /// Distance to keep between hull and anything solid, metres.
    pub clearance_m: f64,
    /// Edge of a coverage cell, metres.
    pub cell_m: f64,
    /// Half width of the 95 % position error above which the position counts as lost, metres.
    pub position_limit_m: f64,
    /// The robot holds when the position is lost for this long, seconds.
    pub position_lost_hold_s: f64,
    /// The mission ends as stuck after this time without progress, seconds.
    pub stuck_s: f64,
    /// Standard deviation of the surveyed heading at the start, radians.
    pub start_heading_sigma_rad: f64,
    /// Standard deviation of odometry as a share of the way travelled.
    pub odometry_sigma_per_m: f64,
    /// Standard deviation of odometry as a share of the angle turned.
    pub odometry_turn_sigma_per_rad: f64,
    /// Standard deviation of the heading's drift, radians per second.
    pub gyro_sigma_rad_per_s: f64,
    /// Standard deviation of a range as a share of the range.
    pub range_sigma_ratio: f64,
    /// How ranges become a position.
    #[serde(default)]
    pub locating: Locating,
    /// What it takes for floor to count as scanned.
    #[serde(default)]
    pub scan: ScanConfig,
    /// The sensor by which an amphibious robot knows its medium; without it the zone at its estimated place counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure: Option<PressureSensor>,
    /// The tether; `None` for a robot without one.
    #[serde(default)]
    pub tether: Option<TetherConfig>,
    /// The planner that drives first.
    pub planner: PlannerChoice,
    /// The planner that takes over by itself after a fault, if any.
    pub fallback: Option<PlannerChoice>,
    /// Whether an operator is there; without one a hold that only an operator could end ends the mission.
    #[serde(default)]
    pub attended: bool,
    /// Whether an order to start names the plan that the operator saw, and no other plan begins the mission.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub start_names_plan: bool,
    /// What becomes of a plan for all that is left that is better than a repaired one.
    #[serde(default, skip_serializing_if = "BetterPlan::is_off")]
    pub better_plan: BetterPlan,
}

impl MissionConfig {
    /// Distance to keep between the robot's centre and anything solid, metres.
    pub fn room_m(&self) -> f64 {
        self.limits.radius_m + self.clearance_m
    }

    /// Width of floor that planners may count on in one pass, metres.
    pub fn lane_m(&self) -> f64 {
        self.swath_m - self.scan.overlap_m
    }

    /// Whether plans that are better than repaired ones are made at all.
    pub fn wants_better_plans(&self) -> bool {
        match self.better_plan {
            BetterPlan::Off => false,
            BetterPlan::Offer => self.attended,
            BetterPlan::Take => true,
        }
    }

    /// The tool: a bar across the heading of a robot that has one, a disc under a point robot.
    pub fn tool(&self) -> Tool {
        match self.limits.motion {
            Motion::Point => Tool::Disc { swath_m: self.swath_m },
            Motion::Unicycle => Tool::Bar { swath_m: self.swath_m },
        }
    }

    /// Half width of the 95 % position error above which nothing counts as scanned, metres.
    pub fn scan_limit_m(&self) -> f64 {
        self.scan.position_limit_m.unwrap_or(self.position_limit_m)
    }

    /// Length of the shortest way from the anchor up to which planners lay lanes, and the anchor; `None` without a tether.
    /// Floor further off lies beyond the reel: the outermost lane runs up to a swath before the end of the cable.
    pub fn cable_reach(&self) -> Option<(Point, f64)> {
        self.tether.as_ref().map(|tether| (tether.anchor, tether.limits.reel_length_m - self.swath_m))
    }

    /// What the tether bears, for planners; `None` without one.
    pub fn tether_limits(&self) -> Option<TetherLimits> {
        self.tether.as_ref().map(TetherConfig::as_request)
    }

    /// What a forecast of the accuracy has to know, for cells of this edge.
    pub fn forecast(&self, cell_m: f64) -> Forecast {
        let normal = RangeNoise::Gaussian { sigma_ratio: self.range_sigma_ratio };
        Forecast {
            noise: self.locating.noise.unwrap_or(normal),
            timing: self.locating.timing,
            repetitions: self.locating.repetitions,
            needs_line_of_sight: self.locating.needs_line_of_sight,
            cell_m,
        }
    }
}
