//! The state of a mission, apart from its planners.

use super::{
    back::{Back, DeadEnds},
    finishing::Finishing,
    floor::ScannedFloor,
    governing::{guarding::ScanGuard, state::Governor},
    surveying::Surveying,
};
use crate::{
    channels::Channels,
    chart::Chart,
    config::MissionConfig,
    locate::Locator,
    phase::Phase,
    standing::PositionTrust,
    task::Task,
    tether::{Tether, ends_at_anchor},
};
use geometry::PathFollower;
use perception::Perception;
use planner_api::Drive;
use world::{Floor, Point, World};

/// Turn rate, radians per second, from which a robot can turn round within the time limit for reaching a corner.
const BRISK_RAD_PER_S: f64 = 0.75;

/// The mission's knowledge of the robot, the tank and the task, and its progress.
#[derive(Clone)]
pub(super) struct Known {
    pub config: MissionConfig,
    pub tick: u64,
    pub phase: Phase,
    pub locator: Locator,
    pub chart: Chart,
    pub task: Task,
    pub floor: ScannedFloor,
    /// The channels of the instrument.
    pub channels: Channels,
    /// `None` without a tether, or if the anchor is at an impossible place.
    pub tether: Option<Tether>,
    /// The path driven, with one point per decimetre.
    pub trail: Vec<Point>,
    /// State of the rule that limits commands.
    pub governor: Governor,
    /// State of the guard by the raw scan.
    pub scan_guard: ScanGuard,
    /// The obstacles found in scans; `None` without a scanner, and if its scans serve the guard alone.
    pub perception: Option<Perception>,
    /// The map that the mission makes; `None` unless the task is a survey.
    pub survey: Option<Surveying>,
    /// The wait for the last pulses, after the task is done or the robot is back.
    pub finishing: Option<Finishing>,
    /// The command at the end of the last tick.
    pub last_drive: Drive,
    /// The drive back that was ordered, until the mission is resumed.
    pub back: Option<Back>,
    /// Where the robot got stuck on its way back beside the tether, until the mission is resumed.
    pub dead_ends: DeadEnds,
    /// The tether of a held robot when its finding last changed: the question and the order to drive back take the same way.
    pub resting: Option<Tether>,
    /// The no-go zones that the hull is in.
    pub breached: Vec<String>,
    /// Why the vehicle must not be driven in this tick, as a clause.
    pub trouble: Option<String>,
}

impl Known {
    /// The state before the start; the arguments are those of [`Mission::new`](super::Mission::new).
    pub(super) fn new(config: MissionConfig, drawing: World, floor: Floor, seed: u64) -> Self {
        let (start, radius_m) = (config.start.position, config.limits.radius_m);
        let tether = config.tether.as_ref();
        Self {
            tick: 0,
            phase: Phase::Waiting,
            tether: tether
                .and_then(|tether| Tether::new(tether, radius_m, &drawing, start).ok())
                .map(|tether| tether.live(config.live)),
            locator: Locator::new(&config, &drawing),
            governor: Governor::new(&config, &drawing.zones),
            scan_guard: ScanGuard::default(),
            perception: config.sensor.map(Perception::new),
            survey: Surveying::new(&config, &drawing),
            finishing: None,
            chart: Chart::new(drawing, &config, seed),
            task: Task::new(&config.task, start),
            floor: ScannedFloor::new(floor),
            channels: Channels::new(&config),
            trail: vec![start],
            last_drive: Drive::STILL,
            back: None,
            dead_ends: DeadEnds::default(),
            resting: None,
            breached: Vec::new(),
            trouble: None,
            config,
        }
    }

    /// Mission time at the top of the tick, seconds.
    pub(super) fn now_s(&self) -> f64 {
        self.tick as f64 * self.config.tick_s
    }

    pub(super) fn is_running(&self) -> bool {
        matches!(self.phase, Phase::Running(_))
    }

    /// Whether the robot moves as its planner commands.
    pub(super) fn follows_planner(&self) -> bool {
        self.is_running()
            && self.finishing.is_none()
            && !self.phase.is_return()
            && !self.config.task.is_survey()
    }

    /// Remaining length of the planner's path or of the way of a survey, metres.
    pub(super) fn way_left_m(&self, plan: Option<&PathFollower>) -> Option<f64> {
        let here = self.position();
        self.survey.as_ref().map_or_else(|| plan.map(|plan| plan.left_m(here)), |survey| survey.left_m(here))
    }

    pub(super) fn is_waiting(&self) -> bool {
        self.phase == Phase::Waiting
    }

    pub(super) fn is_coverage(&self) -> bool {
        self.task.cover().is_some()
    }

    /// Estimated position of the robot.
    pub(super) fn position(&self) -> Point {
        self.locator.position()
    }

    pub(super) fn position_trust(&self) -> PositionTrust {
        if self.locator.is_lost() {
            PositionTrust::Lost { limit_m: self.config.position_limit_m }
        } else if self.locator.is_alarmed() {
            PositionTrust::Alarmed
        } else {
            PositionTrust::Good
        }
    }

    /// The rate at which the time limit for reaching a corner runs: a robot that turns slowly is given more time to turn.
    pub(super) fn briskness(&self) -> f64 {
        (self.config.limits.w_max_rad_per_s / BRISK_RAD_PER_S).min(1.0)
    }

    pub(super) fn task_ends_at_anchor(&self) -> bool {
        self.config.tether.as_ref().is_some_and(|tether| ends_at_anchor(tether, &self.config))
    }

    /// Whether the mission may begin a plan with a return path along the cable.
    pub(super) fn plans_ways_home(&self) -> bool {
        self.is_coverage() && self.task_ends_at_anchor()
    }
}
