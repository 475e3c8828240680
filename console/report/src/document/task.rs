//! What a run did that was not there to scan the floor.

use super::Document;
use crate::joined::PastRun;
use account::Tracking;
use mission::TaskConfig;
use serde::Serialize;
use world::{Point, coverage::percent, polyline};

/// The task of a run that was not there to scan the floor, and the figures of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum TaskPart {
    /// Reach a point.
    Goto {
        /// The point, metres.
        goal: Point,
        /// Distance at which it counts as reached, metres.
        tolerance_m: f64,
        /// Straight from the start to it, metres.
        straight_m: f64,
        /// Distance to it at the end by the estimated position, metres; absent if nothing is known of the end.
        left_m: Option<f64>,
        /// The same by the true position; absent outside simulation.
        left_true_m: Option<f64>,
    },
    /// Follow preset points.
    Follow {
        /// Length of the preset path, metres.
        preset_m: f64,
        /// Number of its points.
        points: usize,
        /// How closely the true path kept to it; absent outside simulation.
        tracking: Option<Tracking>,
    },
}

impl TaskPart {
    /// The task of a run; `None` if it was there to scan.
    pub(super) fn of(past: &PastRun) -> Option<Self> {
        let run = past.fold.run().filter(|_| !past.fold.has_floor_to_scan())?;
        match &run.mission.task {
            TaskConfig::Cover { .. } => None,
            TaskConfig::Follow { path, .. } => Some(Self::Follow {
                preset_m: polyline::length_m(path),
                points: path.len(),
                tracking: past.summary.tracking,
            }),
            TaskConfig::Goto { goal, tolerance_m } => {
                let last = past.record.track.last();
                Some(Self::Goto {
                    goal: *goal,
                    tolerance_m: *tolerance_m,
                    straight_m: (goal - run.mission.start.position).norm(),
                    left_m: last.map(|point| (point.position() - goal).norm()),
                    left_true_m: past.fold.true_place().map(|place| (place - goal).norm()),
                })
            }
        }
    }

    /// Its figures by name, with those of the run; what is not known is left out.
    pub(super) fn figures(&self, document: &Document) -> Vec<(&'static str, f64)> {
        let own = match self {
            Self::Goto { goal, straight_m, left_m, left_true_m, .. } => vec![
                ("goal_x_m", Some(goal.x)),
                ("goal_y_m", Some(goal.y)),
                ("straight_to_goal_m", Some(*straight_m)),
                ("distance_to_goal_m", *left_m),
                ("distance_to_goal_true_m", *left_true_m),
            ],
            Self::Follow { preset_m, tracking, .. } => {
                let of = |figure: fn(&Tracking) -> f64| tracking.as_ref().map(figure);
                vec![
                    ("preset_path_m", Some(*preset_m)),
                    ("precision_percent", of(|tracking| percent(tracking.precision))),
                    ("recall_percent", of(|tracking| percent(tracking.recall))),
                    ("cross_track_rmse_m", of(|tracking| tracking.cross_track_rmse_m)),
                    ("rmse_m", tracking.as_ref().and_then(|tracking| tracking.rmse_m)),
                ]
            }
        };
        let run = document.runs.last();
        let of_run = [
            ("path_m", run.and_then(|run| run.path_length_m)),
            ("mission_time_s", run.map(|run| run.mission_time_s)),
            ("clearance_min_m", run.and_then(|run| run.clearance_min_m)),
            ("collisions", run.and_then(|run| run.collisions).map(|n| n as f64)),
        ];
        own.into_iter().chain(of_run).filter_map(|(name, value)| Some((name, value?))).collect()
    }

    /// The task in a few words.
    pub(super) fn words(&self) -> String {
        match self {
            Self::Goto { goal, .. } => format!("drive to the goal at {:.2}, {:.2} m", goal.x, goal.y),
            Self::Follow { preset_m, points, .. } => {
                format!("follow a preset path of {points} points, {preset_m:.1} m")
            }
        }
    }
}
