//! What the console sends to a planner, each message defined once.
//!
//! `P` and the other parameters say how a message holds its arrays. By default it owns them, so that it can be kept and sent to
//! another process. Planners are lent them: [`crate::Site`], [`crate::PlanRequest`] and [`crate::Sensed`] are these types with
//! slices, and `lend` makes the one of the other.
//!
//! With the feature `serde` both forms are written alike, field by field: a message that is lent is read as one that is owned.

use crate::{Plan, PoseEstimate, Reason, TetherLimits, ZoneKind};
use geometry::{Boundary, Limits, Shape};
use nalgebra::{Point2, Vector2};
use std::sync::Arc;

type Point = Point2<f64>;

/// Something the robot must not touch.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Obstacle<P = Vec<Point>> {
    /// Stable within a mission.
    pub id: u32,
    /// Its outline in the tank frame.
    pub outline: Shape<P>,
    /// Whether it was discovered on the way (so its place carries the position error) or stands on the drawing.
    pub discovered: bool,
    /// How fast it moves, metres per second, tank frame; zero for what stands still. An estimate, and only what is sensed
    /// now is known to move.
    pub velocity_m_per_s: Vector2<f64>,
}

/// A part of the floor with a meaning of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Zone<P = Vec<Point>> {
    /// What is special about it.
    pub kind: ZoneKind,
    /// Its outline.
    pub outline: Shape<P>,
}

/// The drawing of the tank, the robot and the margins that the mission demands.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Site<P = Vec<Point>, O = Vec<Obstacle>, Z = Vec<Zone>> {
    /// Grows whenever anything here changes.
    pub revision: u32,
    /// The wall.
    pub boundary: Boundary<P>,
    /// Known and discovered obstacles.
    pub obstacles: O,
    /// Zones, later ones on top.
    pub zones: Z,
    /// What the robot can do.
    #[cfg_attr(feature = "serde", serde(serialize_with = "whole"))]
    pub limits: Limits,
    /// Width of the floor that the tool scans in one pass, metres.
    pub swath_m: f64,
    /// Distance to keep between the robot's hull and anything solid, metres.
    pub clearance_m: f64,
    /// Start of every random choice, so that a plan can be repeated.
    pub seed: u64,
}

/// What the mission is to achieve from here on.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Task<P = Vec<Point>, R = Vec<Vec<Point>>> {
    /// Reach the goal.
    Goto {
        /// The goal.
        goal: Point,
        /// Distance at which it counts as reached, metres.
        tolerance_m: f64,
    },
    /// Follow preset points in order, as closely as the obstacles allow.
    Follow {
        /// The points that remain, the next one first.
        targets: P,
        /// Distance at which the last one counts as reached, metres.
        tolerance_m: f64,
    },
    /// Scan the floor with the swath, and come back to the anchor.
    Cover {
        /// Where the path ends, and where the tether is made fast if there is one.
        anchor: Point,
        /// What is still to scan: closed polygons, counter-clockwise, that do not overlap. Empty: all floor that can
        /// be reached. They may be ragged (built of square cells) and need not respect obstacles or clearances.
        regions: R,
        /// The tether's limits; `None` without a tether.
        tether: Option<TetherLimits>,
        /// Distance from the anchor at which the robot counts as back, metres.
        tolerance_m: f64,
    },
}

/// A request for a plan; `W`, `S` and `Y` hold the reason, the site and the plan under way.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PlanRequest<P = Vec<Point>, R = Vec<Vec<Point>>, W = Reason, S = Arc<Site>, Y = Plan> {
    /// Why.
    pub reason: W,
    /// From where.
    pub start: PoseEstimate,
    /// To what end.
    pub task: Task<P, R>,
    /// Where.
    pub site: S,
    /// The path flown so far, oldest first, and a return path before the plan; empty at the start.
    pub previous: P,
    /// On coverage missions: the plan to be kept to as far as it can be, which is what is left of the one that the robot flies,
    /// from the place that it is led to, or one that this planner made a moment ago; without its cost. It may lead through
    /// what was found since. `None`: plan anew.
    pub under_way: Option<Y>,
}

/// What is known in one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sensed<P = Vec<Point>, O = Vec<Obstacle>> {
    /// Number of the tick, from 0.
    pub tick: u64,
    /// Mission time, seconds.
    pub t_s: f64,
    /// Length of a tick, seconds.
    pub dt_s: f64,
    /// Where the robot believes it is.
    pub pose: PoseEstimate,
    /// Speed ahead as commanded last, metres per second.
    pub v_m_per_s: f64,
    /// Turn rate as commanded last, radians per second.
    pub w_rad_per_s: f64,
    /// Where to go next: the goal, or the preset point that is due.
    pub target: Point,
    /// The preset points from the target on, a few metres of them.
    pub targets_ahead: P,
    /// The plan from here on, a few metres of it.
    pub path_ahead: P,
    /// Known and discovered obstacles within the robot's sensing range: as they are seen now, so that their distance from
    /// `pose` is right even where the position is not, and as the chart has them while they are out of sight.
    pub obstacles: O,
}

impl Obstacle {
    /// Lends the obstacle.
    pub fn lend(&self) -> crate::Obstacle<'_> {
        let Self { id, discovered, velocity_m_per_s, .. } = *self;
        Obstacle { id, outline: self.outline.as_ref(), discovered, velocity_m_per_s }
    }
}

impl Zone {
    /// Lends the zone.
    pub fn lend(&self) -> crate::Zone<'_> {
        Zone { kind: self.kind, outline: self.outline.as_ref() }
    }
}

impl Site {
    /// Lends the site for a call.
    pub fn lend<T>(&self, call: impl FnOnce(&crate::Site<'_>) -> T) -> T {
        let obstacles: Vec<_> = self.obstacles.iter().map(Obstacle::lend).collect();
        let zones: Vec<_> = self.zones.iter().map(Zone::lend).collect();
        let Self { revision, limits, swath_m, clearance_m, seed, .. } = *self;
        let (boundary, obstacles, zones) = (self.boundary.as_ref(), &*obstacles, &*zones);
        call(&Site { revision, boundary, obstacles, zones, limits, swath_m, clearance_m, seed })
    }
}

impl PlanRequest {
    /// Lends the request for a call.
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
    /// What a robot knows that stands still at a pose and is to go to a target, with nothing around it; a tick takes `dt_s`
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
    /// Lends what is known for a call.
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

/// Writes the limits with their last field even when it is `None`. In a journal it is left out then, and a format without names
/// could not be read.
#[cfg(feature = "serde")]
fn whole<S: serde::Serializer>(limits: &Limits, to: S) -> Result<S::Ok, S::Error> {
    serde::Serialize::serialize(&(Limits { amphibious: None, ..*limits }, limits.amphibious), to)
}
