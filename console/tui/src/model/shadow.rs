//! The planner in shadow as shown on the screen: its plan, and the ghost of the robot under its command.

use super::{Lane, Run};
use mission::{Phase, PlannerChoice, PlannerInfo, event::ShadowTally};
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

/// How far ahead the ghost is drawn, seconds.
pub const GHOST_S: f64 = 3.0;

/// A planner in shadow and its latest output.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Shadow {
    /// The planner, with the parameters set by hand.
    pub choice: PlannerChoice,
    /// The description of the planner; `None` until it is open.
    pub info: Option<PlannerInfo>,
    /// How many steps the planner has answered and missed.
    pub tally: ShadowTally,
    /// The points of the path of the planner's plan, thinned for drawing.
    pub path: Vec<Point>,
    /// The lanes of the path.
    #[serde(default)]
    pub lanes: Vec<Lane>,
    /// The length of the whole path, metres.
    #[serde(default)]
    pub length_m: f64,
    /// Whether the plan achieves the rest of the task.
    #[serde(default)]
    pub complete: bool,
    /// The planner's last command, with the mission time, seconds.
    pub command: Option<(f64, Command)>,
    /// Whether the planner was ordered to take over.
    pub is_promoted: bool,
}

impl Shadow {
    /// Creates the entry for a planner that is about to run in shadow.
    pub(super) fn new(choice: PlannerChoice) -> Self {
        Self { choice, ..Self::default() }
    }
}

/// The differences between the command of the planner in shadow and the command that drives the robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Differences {
    /// How much faster the planner in shadow would drive, metres per second.
    pub speed_m_per_s: f64,
    /// How much faster the planner in shadow would turn to the left, radians per second.
    pub turn_rad_per_s: f64,
    /// The minimum distance along the ghost from the hull to any known obstacle, metres.
    pub clearance_m: f64,
    /// The distance from the hull to any known obstacle at the robot's position, metres.
    pub here_m: f64,
}

impl Run {
    /// The planner in shadow whose plan the map shows: while the robot runs or is held.
    pub fn shown_shadow(&self) -> Option<&Shadow> {
        let is_under_way = matches!(self.phase(), Phase::Running(_) | Phase::Held(_));
        self.shadow.as_ref().filter(|_| is_under_way)
    }

    /// Where the command of the planner in shadow would take the robot; `None` if the command is not recent.
    pub fn ghost(&self) -> Option<Vec<Point>> {
        let (pose, command) = self.shadow_command()?;
        let mission = &self.about.as_ref()?.mission;
        let way = rollout(command.drive, pose, &mission.limits, mission.task.turn_first_rad(), GHOST_S);
        Some(way.into_iter().map(|pose| pose.position).collect())
    }

    /// The differences between the command of the planner in shadow and the command that drives the robot.
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

/// The speed and turn rate of a drive command.
fn motion(drive: Drive) -> (f64, f64) {
    match drive {
        Drive::Twist { v_m_per_s, w_rad_per_s } => (v_m_per_s, w_rad_per_s),
        Drive::Velocity(velocity) => (velocity.norm(), 0.0),
    }
}
