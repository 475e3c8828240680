//! The planner in shadow as the screen knows it: its plan, and where its command would lead the robot.

use super::{Run, Trail};
use mission::{PlannerChoice, PlannerInfo, event::ShadowTally};
use nalgebra::Point2;
use planner_api::Command;
use serde::{Deserialize, Serialize};
use world::{
    Point, Pose,
    geometry::{
        Drive,
        motion::{drive_for, rollout},
    },
};

/// How far the ghost goes ahead, seconds.
pub const GHOST_S: f64 = 3.0;

/// A planner in shadow and what it last did.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Shadow {
    /// Which, with the parameters set by hand.
    pub choice: PlannerChoice,
    /// Who it is; `None` until it is open.
    pub info: Option<PlannerInfo>,
    /// How it does.
    pub tally: ShadowTally,
    /// Points of the path of its plan, thinned out for drawing.
    pub path: Vec<Point>,
    /// Its last command, with the mission time of it, seconds.
    pub command: Option<(f64, Command)>,
    /// Whether it was ordered to take over.
    pub is_promoted: bool,
}

impl Shadow {
    /// A planner that is to fly in shadow.
    pub(super) fn new(choice: PlannerChoice) -> Self {
        Self { choice, ..Self::default() }
    }

    pub(super) fn take_path(&mut self, path: &[Point]) {
        self.path = Trail::thinned(path);
    }
}

/// How the command of the planner in shadow differs from the one that the robot is sent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Differences {
    /// How much faster it would drive, metres per second.
    pub speed_m_per_s: f64,
    /// How much more to the left it would turn, radians per second.
    pub turn_rad_per_s: f64,
    /// Least distance from the hull to what is known along the ghost, metres.
    pub clearance_m: f64,
    /// The same from where the robot is, metres.
    pub here_m: f64,
}

impl Run {
    /// Where the command of the planner in shadow would lead the robot, if that is recent.
    pub fn ghost(&self) -> Option<Vec<Point>> {
        let (pose, command) = self.shadow_command()?;
        let mission = &self.about.as_ref()?.mission;
        let way = rollout(command.drive, pose, &mission.limits, mission.task.turn_first_rad(), GHOST_S);
        Some(way.into_iter().map(|pose| pose.position).collect())
    }

    /// How that command differs from the one that the robot is sent.
    pub fn shadow_differences(&self) -> Option<Differences> {
        let (pose, command) = self.shadow_command()?;
        let (_, driving) = self.planning.command.as_ref()?;
        let ghost = self.ghost()?;
        let about = self.about.as_ref()?;
        let (limits, turn_first_rad) = (&about.mission.limits, about.mission.task.turn_first_rad());
        let motion = |drive| motion(drive_for(drive, pose.heading_rad, limits, turn_first_rad));
        let ((speed, turn), (other_speed, other_turn)) = (motion(command.drive), motion(driving.drive));
        let clearance_m = |at: &Point| {
            let outlines = about.world.obstacles.iter().map(|obstacle| obstacle.shape.distance_m(*at));
            outlines.fold(about.world.boundary.wall_distance_m(*at), f64::min) - limits.radius_m
        };
        Some(Differences {
            speed_m_per_s: speed - other_speed,
            turn_rad_per_s: turn - other_turn,
            clearance_m: ghost.iter().map(clearance_m).fold(f64::INFINITY, f64::min),
            here_m: clearance_m(&pose.position),
        })
    }

    fn shadow_command(&self) -> Option<(Pose, Command)> {
        let (t_s, command) = self.shadow.as_ref()?.command?;
        let pose = self.position.pose.as_ref()?;
        let pose = Pose { position: Point2::from(pose.position.coords), heading_rad: pose.heading_rad };
        (self.is_running() && !self.is_overdue(t_s)).then_some((pose, command))
    }
}

/// Speed and turn rate of a drive as it is sent.
fn motion(drive: Drive) -> (f64, f64) {
    match drive {
        Drive::Twist { v_m_per_s, w_rad_per_s } => (v_m_per_s, w_rad_per_s),
        Drive::Velocity(velocity) => (velocity.norm(), 0.0),
    }
}
