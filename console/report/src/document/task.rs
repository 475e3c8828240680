//! A task other than scanning the floor.

use super::{
    run_part::RunPart,
    survey::{Instead, MapPart},
};
use crate::past_run::PastRun;
use account::Tracking;
use mission::TaskConfig;
use serde::Serialize;
use world::{Point, coverage::percent, polyline};

/// A task other than scanning the floor, with its figures.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum TaskPart {
    /// Reach a point.
    Goto {
        /// The goal, metres.
        goal: Point,
        /// Distance from the goal within which the goal counts as reached, metres.
        tolerance_m: f64,
        /// Straight-line distance from the start to the goal, metres.
        straight_m: f64,
        /// Distance to the goal at the end according to the estimated position, metres; absent if the end is not
        /// known.
        left_m: Option<f64>,
        /// Distance to the goal at the end according to the true position, metres; absent outside simulation.
        left_true_m: Option<f64>,
    },
    /// Follow preset points.
    Follow {
        /// Length of the preset path, metres.
        preset_m: f64,
        /// Number of preset points.
        points: usize,
        /// How closely the true path followed the preset path; absent outside simulation.
        tracking: Option<Tracking>,
    },
    /// Make a map of the floor.
    Survey {
        /// The map; absent if the run ended before it had made one.
        map: Option<MapPart>,
    },
}

impl TaskPart {
    /// Returns the task of a run; `None` if the task was to scan the floor.
    pub(super) fn of(past: &PastRun) -> Option<Self> {
        let run = past.fold.run().filter(|_| !past.fold.has_floor_to_scan())?;
        match &run.mission.task {
            TaskConfig::Cover { .. } => None,
            TaskConfig::Survey { .. } => Some(Self::Survey { map: MapPart::of(past) }),
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

    /// The figures of the task and of the run by name; unknown figures are omitted.
    pub(super) fn figures(&self, run: Option<&RunPart>) -> Vec<(&'static str, f64)> {
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
            Self::Survey { map: None } => Vec::new(),
            Self::Survey { map: Some(map) } => vec![
                ("explored_percent", Some(percent(map.explored))),
                ("columns", Some(map.columns.len() as f64)),
                ("columns_not_drawn", Some(map.not_drawn() as f64)),
                ("objects_not_drawn", Some(map.objects_not_drawn.len() as f64)),
                ("drawn_not_found", Some(map.with_instead(Instead::FreeFloor) as f64)),
                ("column_moved_max_m", map.moved_max_m()),
                ("places_beyond_tether", Some(map.beyond_tether as f64)),
            ],
        };
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
                format!("follow a preset path of {points} points ({preset_m:.1} m)")
            }
            Self::Survey { .. } => "make a map of the floor".into(),
        }
    }
}
