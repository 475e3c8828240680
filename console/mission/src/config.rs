//! The task of a mission and its limits.

use crate::{instrument::InstrumentConfig, planner::PlannerChoice};
use geometry::motion::{TURN_FIRST_IN_LANES_RAD, TURN_FIRST_RAD};
use perception::Sensor;
use planner_api::{Limits, Motion, TetherLimits, TetherPull};
use positioning::{Aggregation, ClockConfig, Forecast, RangeNoise, Risk, SessionConfig, SolverKind, Timing};
use serde::{Deserialize, Serialize};
use world::{Floor, FloorMaker, Point, Pose, PressureSensor, World, coverage::Tool, tether};

/// The task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TaskConfig {
    /// Reach a point.
    Goto {
        /// The point, metres.
        goal: Point,
        /// Distance at which the point counts as reached, metres.
        tolerance_m: f64,
    },
    /// Follow preset points in order.
    Follow {
        /// The points in order, metres.
        path: Vec<Point>,
        /// Distance at which the last point counts as reached, metres.
        tolerance_m: f64,
    },
    /// Scan the floor and return to the anchor.
    Cover {
        /// Where the path ends and where the tether, if the robot has one, is attached; metres.
        anchor: Point,
        /// The areas to scan, as closed polygons; empty for all reachable floor.
        #[serde(default)]
        regions: Vec<Vec<Point>>,
        /// Distance from the anchor at which the robot counts as back, metres.
        tolerance_m: f64,
    },
    /// Make a map of the floor from scans, and return. The mission itself drives, without a planner.
    Survey {
        /// Where the path ends and where the tether, if the robot has one, is attached; metres.
        anchor: Point,
        /// Distance from the anchor at which the robot counts as back, metres.
        tolerance_m: f64,
    },
}

impl TaskConfig {
    /// The last point of the task; `None` for an empty path.
    pub fn end(&self) -> Option<Point> {
        match self {
            Self::Goto { goal, .. } => Some(*goal),
            Self::Follow { path, .. } => path.last().copied(),
            Self::Cover { anchor, .. } | Self::Survey { anchor, .. } => Some(*anchor),
        }
    }

    /// Whether the task is to make a map of the floor.
    pub fn is_survey(&self) -> bool {
        matches!(self, Self::Survey { .. })
    }

    /// Heading error above which a unicycle turns on the spot before it drives, radians.
    pub fn turn_first_rad(&self) -> f64 {
        match self {
            Self::Cover { .. } | Self::Survey { .. } => TURN_FIRST_IN_LANES_RAD,
            Self::Goto { .. } | Self::Follow { .. } => TURN_FIRST_RAD,
        }
    }
}

/// The conditions under which floor counts as scanned.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct ScanConfig {
    /// Overlap of neighbouring lanes, metres. Planners receive a swath that is narrower by this much, so that position
    /// errors leave no gaps between lanes.
    pub overlap_m: f64,
    /// Limit of the 95 % position error (half width), metres; above it, no floor counts as scanned. `None` to use the
    /// limit above which the position counts as lost.
    pub position_limit_m: Option<f64>,
    /// The rule by which scanned floor counts as guaranteed.
    #[serde(skip_serializing_if = "Guarantee::is_by_ellipse")]
    pub guarantee: Guarantee,
}

/// The rule by which scanned floor counts as guaranteed: the tool must have passed over it for every position within
/// this distance of the estimate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Guarantee {
    /// The 95 % ellipse.
    #[default]
    Ellipse,
    /// The protection level: it also covers one wrong station.
    Protection,
}

impl Guarantee {
    /// Whether the 95 % ellipse decides. Takes a reference because serde requires that signature.
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
    fn is_by_ellipse(&self) -> bool {
        *self == Self::Ellipse
    }
}

/// The clocks of stations that share no common clock, as known before the mission.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct OwnClocks {
    /// Standard deviation of the offset of a station's clock, as a length that sound travels, metres.
    pub offset_sigma_m: f64,
    /// Standard deviation of the drift of a station's clock, metres per hour.
    pub drift_sigma_m_per_h: f64,
}

impl OwnClocks {
    /// The settings of the estimator, for ticks of this length, seconds.
    pub fn config(&self, tick_s: f64) -> ClockConfig {
        ClockConfig {
            offset_sigma_m: self.offset_sigma_m,
            drift_sigma_m_per_tick: self.drift_sigma_m_per_h * tick_s / 3600.0,
        }
    }
}

/// How positions are computed from ranges.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Locating {
    /// Distribution of the errors of single ranges; `None` for a normal distribution with
    /// [`MissionConfig::range_sigma_ratio`].
    pub noise: Option<RangeNoise>,
    /// How repeated measurements are combined into one range.
    pub aggregation: Aggregation,
    /// How ranges are combined into a fix.
    pub solver: SolverKind,
    /// Additional timing errors of single ranges.
    #[serde(skip_serializing_if = "Timing::is_none")]
    pub timing: Timing,
    /// Standard deviation of the scale error common to all ranges, as a ratio; repeating measurements does not reduce it.
    #[serde(skip_serializing_if = "is_zero")]
    pub scale_sigma_ratio: f64,
    /// Whether the speed of sound is estimated during the mission.
    pub calibrate_sound_speed: bool,
    /// Number of ranges per station and cycle; used only for accuracy forecasts.
    pub repetitions: u32,
    /// Whether a station is unusable while an obstacle is between the robot and the station.
    pub needs_line_of_sight: bool,
    /// The risk for which protection levels are computed; `None` if they are not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub risk: Option<Risk>,
    /// How the speed of sound and the stations are calibrated from the last fixes; `None` if they are not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub session: Option<SessionConfig>,
    /// The clocks of the stations, which are estimated during the mission; `None` if the stations share one clock. Needs
    /// [`SolverKind::Differences`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clocks: Option<OwnClocks>,
    /// The stations exchange pulses before the start, and whenever the robot has stood still for this long, seconds; `None`
    /// if they exchange none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pulse_rest_s: Option<f64>,
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "signature required by serde")]
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
            risk: None,
            session: None,
            clocks: None,
            pulse_rest_s: None,
        }
    }
}

/// A tether as scenarios describe it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TetherConfig {
    /// The place where the cable enters the tank: the start, a manhole, or the point below a roof hatch; metres.
    pub anchor: Point,
    /// The limits of the cable.
    pub limits: tether::Limits,
    /// Friction of the cable on steel, used to compute the pull; the shape of the cable does not depend on it.
    pub friction: f64,
    /// The reel and the weight of the cable; without it, the pull is not checked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reel: Option<tether::Reel>,
    /// Whether plans that cannot be certified may be run.
    #[serde(default)]
    pub allow_uncertified: bool,
}

impl TetherConfig {
    /// The limits in the form that planners receive.
    pub fn as_request(&self) -> TetherLimits {
        let tether::Limits { reel_length_m, wrap_max_rad, wrap_total_max_rad } = self.limits;
        let pull = self.reel.map(|reel| {
            let tether::PullLimits { drag, reel_n, preferred_n, .. } = reel.limits(self.friction);
            TetherPull { floor_n_per_m: drag.floor_n_per_m, friction: drag.friction, reel_n, preferred_n }
        });
        TetherLimits { reel_length_m, wrap_max_rad, wrap_total_max_rad, pull }
    }
}

/// What to do about better plans. After a repair, the planner makes a plan for the rest of the task in the background.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BetterPlan {
    /// No better plan is computed.
    #[default]
    Off,
    /// A better plan is offered to the operator; if no operator is present, none is computed.
    Offer,
    /// A better plan is taken automatically.
    Take,
}

impl BetterPlan {
    /// Whether no better plans are computed. Takes a reference because serde requires that signature.
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
    fn is_off(&self) -> bool {
        *self == Self::Off
    }
}

/// A mission in the form that the engine needs. The code that reads the scenario builds and validates it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MissionConfig {
    /// The task.
    pub task: TaskConfig,
    /// The robot's pose at the start, as surveyed at the manway.
    pub start: Pose,
    /// Standard deviation of the surveyed start position, metres.
    pub start_sigma_m: f64,
    /// Length of a tick, seconds.
    pub tick_s: f64,
    /// Time limit, seconds; the mission ends unfinished when it expires. Time in an attended hold does not count.
    pub time_limit_s: f64,
    /// The robot's limits.
    pub limits: Limits,
    /// Width of the floor that is scanned in one pass, metres.
    pub swath_m: f64,
    /// Minimum distance between the hull and anything solid, metres.
    pub clearance_m: f64,
    /// Edge of a coverage cell, metres.
    pub cell_m: f64,
    /// Limit of the 95 % position error (half width), metres; above it, the position counts as lost.
    pub position_limit_m: f64,
    /// The robot is held after the position has been lost for this long, seconds.
    pub position_lost_hold_s: f64,
    /// The mission ends as stuck after this long without progress, seconds.
    pub stuck_s: f64,
    /// Standard deviation of the surveyed heading at the start, radians.
    pub start_heading_sigma_rad: f64,
    /// Standard deviation of the odometry, as a share of the distance travelled.
    pub odometry_sigma_per_m: f64,
    /// Standard deviation of the odometry, as a share of the angle turned.
    pub odometry_turn_sigma_per_rad: f64,
    /// Standard deviation of the heading drift, radians per second.
    pub gyro_sigma_rad_per_s: f64,
    /// Standard deviation of a range, as a share of the range.
    pub range_sigma_ratio: f64,
    /// How positions are computed from ranges.
    #[serde(default)]
    pub locating: Locating,
    /// The conditions under which floor counts as scanned.
    #[serde(default)]
    pub scan: ScanConfig,
    /// The pressure sensor that shows whether an amphibious robot is under water. Without a sensor, the zone at the
    /// estimated position decides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure: Option<PressureSensor>,
    /// The tether; `None` for a robot without one.
    #[serde(default)]
    pub tether: Option<TetherConfig>,
    /// The planner that is active first.
    pub planner: PlannerChoice,
    /// The planner that takes over automatically after a fault; `None` if there is none.
    pub fallback: Option<PlannerChoice>,
    /// Whether an operator is present. If not, a hold ends the mission if only an operator could end that hold.
    #[serde(default)]
    pub attended: bool,
    /// Whether a start order must name the plan that the operator saw, so that the mission cannot begin with a different
    /// one.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub start_names_plan: bool,
    /// Whether the robot is a real vehicle and not the simulator: time cannot be stepped, and faults cannot be injected.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub live: bool,
    /// Time from a command until the vehicle follows it, beyond one tick, seconds. It is set for a robot that is
    /// guarded by its scan; `None` without a guard.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub guard_reaction_s: Option<f64>,
    /// The scanner in whose scans the mission finds obstacles. `None` if only the outlines that the readings name are
    /// used.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensor: Option<Sensor>,
    /// What to do about a plan that is better than a repaired one.
    #[serde(default, skip_serializing_if = "BetterPlan::is_off")]
    pub better_plan: BetterPlan,
    /// The instrument that tests the floor; `None` if nothing is known about it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instrument: Option<InstrumentConfig>,
}

impl MissionConfig {
    /// The floor of a tank for this robot and its instrument, with all data needed to update it.
    pub fn floor_maker(&self, drawing: &World) -> FloorMaker {
        let maker = FloorMaker::new(drawing, self.cell_m, self.room_m(), self.swath_m, self.start.position);
        match self.instrument.as_ref().and_then(|instrument| instrument.dead_bands.as_ref()) {
            Some(bands) => maker.with_dead_bands(bands, &drawing.boundary),
            None => maker,
        }
    }

    /// The floor of a tank for this robot and its instrument.
    pub fn floor(&self, drawing: &World) -> Floor {
        self.floor_maker(drawing).into_floor()
    }

    /// Minimum distance between the robot's centre and anything solid, metres.
    pub fn room_m(&self) -> f64 {
        self.limits.radius_m + self.clearance_m
    }

    /// Width of the swath that planners can rely on in one pass, metres.
    pub fn lane_m(&self) -> f64 {
        self.swath_m - self.scan.overlap_m
    }

    /// Whether the mission computes a better plan after a repair.
    pub fn wants_better_plans(&self) -> bool {
        match self.better_plan {
            BetterPlan::Off => false,
            BetterPlan::Offer => self.attended,
            BetterPlan::Take => true,
        }
    }

    /// The tool: a bar across the heading, or a disc if the robot has no heading.
    pub fn tool(&self) -> Tool {
        match self.limits.motion {
            Motion::Point => Tool::Disc { swath_m: self.swath_m },
            Motion::Unicycle => Tool::Bar { swath_m: self.swath_m },
        }
    }

    /// Limit of the 95 % position error (half width), metres; above it, no floor counts as scanned.
    pub fn scan_limit_m(&self) -> f64 {
        self.scan.position_limit_m.unwrap_or(self.position_limit_m)
    }

    /// The anchor, and the maximum distance from it, along the shortest path, at which planners place lanes; `None`
    /// without a tether. Floor farther away is beyond the reach of the tether: the outermost lane is up to one swath
    /// short of the end of the cable.
    pub fn cable_reach(&self) -> Option<(Point, f64)> {
        self.tether.as_ref().map(|tether| (tether.anchor, tether.limits.reel_length_m - self.swath_m))
    }

    /// The limits of the tether, for planners; `None` without one.
    pub fn tether_limits(&self) -> Option<TetherLimits> {
        self.tether.as_ref().map(TetherConfig::as_request)
    }

    /// The inputs of an accuracy forecast for cells with this edge length.
    pub fn forecast(&self, cell_m: f64) -> Forecast {
        let normal = RangeNoise::Gaussian { sigma_ratio: self.range_sigma_ratio };
        Forecast {
            noise: self.locating.noise.unwrap_or(normal),
            timing: self.locating.timing,
            repetitions: self.locating.repetitions,
            needs_line_of_sight: self.locating.needs_line_of_sight,
            is_emission_unknown: self.locating.solver == SolverKind::Differences,
            cell_m,
        }
    }
}
