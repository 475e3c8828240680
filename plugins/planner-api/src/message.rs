//! The messages from the console to a planner, each defined once.
//!
//! The type parameters (`P` and others) determine how a message stores its arrays. By default, it owns them, so that it
//! can be stored or sent to another process. Planners receive borrowed messages: [`crate::Site`],
//! [`crate::PlanRequest`] and [`crate::Sensed`] are the same types with slices, and `lend` turns an owned message into
//! a borrowed one.
//!
//! With the feature `serde`, both forms are serialised identically, field by field: a borrowed message can be written
//! and read back as an owned one.

use crate::{Plan, PoseEstimate, Reason, TetherLimits, ZoneKind};
use geometry::{Boundary, Limits, Shape};
use nalgebra::{Point2, Vector2};
use std::sync::Arc;

type Point = Point2<f64>;

/// An object that the robot must not touch.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Obstacle<P = Vec<Point>> {
    /// Identifies the obstacle; does not change during a mission.
    pub id: u32,
    /// Outline in the tank frame.
    pub outline: Shape<P>,
    /// Whether the obstacle was found during the mission rather than being on the drawing. The position of a found
    /// obstacle includes the position error of the robot.
    pub discovered: bool,
    /// Estimated velocity in the tank frame, metres per second. It is zero for obstacles that stand still or are not
    /// currently sensed.
    pub velocity_m_per_s: Vector2<f64>,
}

/// A special part of the floor.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Zone<P = Vec<Point>> {
    /// What is special about this part of the floor.
    pub kind: ZoneKind,
    /// The outline.
    pub outline: Shape<P>,
}

/// The tank, the robot, and the margins that the mission requires.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Site<P = Vec<Point>, O = Vec<Obstacle>, Z = Vec<Zone>> {
    /// Increases whenever anything in this struct changes.
    pub revision: u32,
    /// The wall of the tank.
    pub boundary: Boundary<P>,
    /// The known obstacles: those on the drawing, and those found during the mission.
    pub obstacles: O,
    /// The zones; where zones overlap, the later one applies.
    pub zones: Z,
    /// The capabilities of the robot.
    #[cfg_attr(feature = "serde", serde(serialize_with = "whole"))]
    pub limits: Limits,
    /// Lane spacing, metres: the width that the tool scans in one pass, less the overlap that the mission requires.
    pub swath_m: f64,
    /// Distance to keep between the robot's hull and anything solid, metres.
    pub clearance_m: f64,
    /// The seed for all random choices, so that a plan can be reproduced.
    pub seed: u64,
}

/// What the mission requires from now on.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Task<P = Vec<Point>, R = Vec<Vec<Point>>> {
    /// Reach the goal.
    Goto {
        /// The goal.
        goal: Point,
        /// The goal has been reached when the robot is within this distance of it, metres.
        tolerance_m: f64,
    },
    /// Follow preset points in order, as closely as the obstacles allow.
    Follow {
        /// The remaining points, the next one first.
        targets: P,
        /// The last point has been reached when the robot is within this distance of it, metres.
        tolerance_m: f64,
    },
    /// Scan the floor and return to the anchor.
    Cover {
        /// The end of the path, where the tether, if there is one, enters the tank.
        anchor: Point,
        /// The floor still to be scanned: closed, counter-clockwise polygons that do not overlap. An empty list means
        /// all reachable floor. The polygons may be ragged (built from square cells), and may contain obstacles or
        /// floor that is too close to obstacles.
        regions: R,
        /// The limits of the tether; `None` if there is no tether.
        tether: Option<TetherLimits>,
        /// The robot is back when it is within this distance of the anchor, metres.
        tolerance_m: f64,
    },
}

/// A request for a plan. The type parameters `W`, `S` and `Y` are the types of the reason, the site and the plan to
/// keep to.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PlanRequest<P = Vec<Point>, R = Vec<Vec<Point>>, W = Reason, S = Arc<Site>, Y = Plan> {
    /// The reason why the plan is requested.
    pub reason: W,
    /// The pose from which the robot starts.
    pub start: PoseEstimate,
    /// The task to plan for.
    pub task: Task<P, R>,
    /// The tank, its obstacles and the robot.
    pub site: S,
    /// The path driven so far, oldest point first, followed by the return path that the robot will take before it
    /// starts the plan; empty at the start of a mission.
    pub previous: P,
    /// On coverage missions, the plan to keep to as far as possible, or `None` to plan from scratch. It is either the
    /// rest of the robot's current plan, beginning at the point to which the robot is being led, or the plan that this
    /// planner has just made. Its cost is not set. It may pass through obstacles that were found after it was made.
    pub under_way: Option<Y>,
}

/// A planner's view of one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sensed<P = Vec<Point>, O = Vec<Obstacle>> {
    /// Number of the tick; the first is 0.
    pub tick: u64,
    /// Mission time, seconds.
    pub t_s: f64,
    /// Length of a tick, seconds.
    pub dt_s: f64,
    /// The estimated pose of the robot.
    pub pose: PoseEstimate,
    /// Forward speed that was last commanded, metres per second.
    pub v_m_per_s: f64,
    /// Turn rate that was last commanded, radians per second.
    pub w_rad_per_s: f64,
    /// The point to go to next: the goal, or the next preset point.
    pub target: Point,
    /// The preset points of the next few metres, starting with the target.
    pub targets_ahead: P,
    /// The next few metres of the plan.
    pub path_ahead: P,
    /// Known obstacles within the robot's sensing range. An obstacle in sight is given where the robot sees it now, so
    /// its distance from `pose` is right even if `pose` is wrong. An obstacle out of sight is given where the chart
    /// shows it.
    pub obstacles: O,
}

impl Obstacle {
    /// Borrows the obstacle.
    pub fn lend(&self) -> crate::Obstacle<'_> {
        let Self { id, discovered, velocity_m_per_s, .. } = *self;
        Obstacle { id, outline: self.outline.as_ref(), discovered, velocity_m_per_s }
    }
}

impl Zone {
    /// Borrows the zone.
    pub fn lend(&self) -> crate::Zone<'_> {
        Zone { kind: self.kind, outline: self.outline.as_ref() }
    }
}

impl Site {
    /// Borrows the site for the duration of `call`.
    pub fn lend<T>(&self, call: impl FnOnce(&crate::Site<'_>) -> T) -> T {
        let obstacles: Vec<_> = self.obstacles.iter().map(Obstacle::lend).collect();
        let zones: Vec<_> = self.zones.iter().map(Zone::lend).collect();
        let Self { revision, limits, swath_m, clearance_m, seed, .. } = *self;
        let (boundary, obstacles, zones) = (self.boundary.as_ref(), &*obstacles, &*zones);
        call(&Site { revision, boundary, obstacles, zones, limits, swath_m, clearance_m, seed })
    }
}

impl PlanRequest {
    /// Borrows the request for the duration of `call`.
    pub fn lend<T>(&self, call: impl FnOnce(&crate::PlanRequest<'_>) -> T) -> T {
        let regions: Vec<&[Point]> = match &self.task {
            Task::Cover { regions, .. } => regions.iter().map(Vec::as_slice).collect(),
            Task::Goto { .. } | Task::Follow { .. } => Vec::new(),
        };
        let task = match self.task {
            Task::Goto { goal, tolerance_m } => Task::Goto { goal, tolerance_m },
            Task::Follow { ref targets, tolerance_m } => Task::Follow { targets: &**targets, tolerance_m },
            Task::Cover { anchor, tether, tolerance_m, .. } => {
                Task::Cover { anchor, regions: &*regions, tether, tolerance_m }
            }
        };
        let Self { reason, start, previous, under_way, .. } = self;
        let (start, under_way) = (*start, under_way.as_ref());
        self.site.lend(|site| call(&PlanRequest { reason, start, task, site, previous, under_way }))
    }
}

impl crate::Sensed<'_> {
    /// The view of a robot that stands still at a pose, with a target and nothing around it; a tick lasts `dt_s`
    /// seconds.
    pub fn new(tick: u64, dt_s: f64, pose: PoseEstimate, target: Point) -> Self {
        Self {
            tick,
            t_s: tick as f64 * dt_s,
            dt_s,
            pose,
            v_m_per_s: 0.0,
            w_rad_per_s: 0.0,
            target,
            targets_ahead: &[],
            path_ahead: &[],
            obstacles: &[],
        }
    }
}

impl Sensed {
    /// Borrows the view for the duration of `call`.
    pub fn lend<T>(&self, call: impl FnOnce(&crate::Sensed<'_>) -> T) -> T {
        let obstacles: Vec<_> = self.obstacles.iter().map(Obstacle::lend).collect();
        let Self { tick, t_s, dt_s, pose, v_m_per_s, w_rad_per_s, target, .. } = *self;
        call(&Sensed {
            tick,
            t_s,
            dt_s,
            pose,
            v_m_per_s,
            w_rad_per_s,
            target,
            targets_ahead: &self.targets_ahead,
            path_ahead: &self.path_ahead,
            obstacles: &obstacles,
        })
    }
}

/// Serialises the limits including their last field, even if it is `None`. Journals omit it in that case, but a format
/// without field names could not be read back if it were missing.
#[cfg(feature = "serde")]
fn whole<S: serde::Serializer>(limits: &Limits, to: S) -> Result<S::Ok, S::Error> {
    serde::Serialize::serialize(&(Limits { amphibious: None, ..*limits }, limits.amphibious), to)
}
