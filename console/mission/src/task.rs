//! The task in progress: the next target, the progress, and whether it is done.

mod corner;
mod cover;
mod rest;
mod survey;

pub(crate) use corner::CornerPatience;
use cover::Cover;
pub(crate) use cover::Joint;
pub(crate) use geometry::PathFollower;
pub(crate) use rest::rest_of;
pub(crate) use survey::Survey;

use crate::{ask::TaskLeft, config::TaskConfig};
use planner_api as api;
use world::{CoverageGrid, ObstacleMap, Point, Shape};

/// Distance that counts as progress, metres.
const PROGRESS_M: f64 = 0.1;

/// A task in progress.
#[derive(Clone)]
pub(crate) enum Task {
    /// Reach a point.
    Goto(Goto),
    /// Follow preset points.
    Follow {
        /// Progress along these points.
        follower: PathFollower,
        /// Distance at which the last point counts as reached, metres.
        tolerance_m: f64,
    },
    /// Scan the floor.
    Cover(Cover),
    /// Make a map of the floor.
    Survey(Survey),
}

/// Progress towards a single goal.
#[derive(Clone)]
pub(crate) struct Goto {
    goal: Point,
    tolerance_m: f64,
    start_m: f64,
    position: Point,
}

impl Task {
    /// The task at its start.
    pub(crate) fn new(config: &TaskConfig, start: Point) -> Self {
        match config {
            TaskConfig::Goto { goal, tolerance_m } => {
                let start_m = (goal - start).norm().max(f64::EPSILON);
                Self::Goto(Goto { goal: *goal, tolerance_m: *tolerance_m, start_m, position: start })
            }
            TaskConfig::Follow { path, tolerance_m } => {
                Self::Follow { follower: PathFollower::new(path.clone()), tolerance_m: *tolerance_m }
            }
            TaskConfig::Cover { anchor, regions, tolerance_m } => {
                Self::Cover(Cover::new(*anchor, regions.clone(), *tolerance_m, start))
            }
            TaskConfig::Survey { anchor, tolerance_m } => Self::Survey(Survey::new(*anchor, *tolerance_m)),
        }
    }

    /// The floor to scan; `None` unless the task is to cover floor.
    pub(crate) fn cover(&self) -> Option<&Cover> {
        match self {
            Self::Cover(cover) => Some(cover),
            Self::Goto(_) | Self::Follow { .. } | Self::Survey(_) => None,
        }
    }

    /// The survey; `None` for other tasks.
    pub(crate) fn survey(&mut self) -> Option<&mut Survey> {
        match self {
            Self::Survey(survey) => Some(survey),
            _ => None,
        }
    }

    /// Updates the robot's position. `has_room` tells whether the robot can be at a point: points of a preset path
    /// without room for the robot are skipped.
    pub(crate) fn advance(&mut self, position: Point, map: &ObstacleMap, has_room: impl Fn(Point) -> bool) {
        match self {
            Self::Goto(goto) => goto.position = position,
            Self::Follow { follower, .. } => follower.advance(position, has_room),
            Self::Cover(cover) => cover.advance(position, map),
            Self::Survey(_) => {}
        }
    }

    /// The next target.
    pub(crate) fn target(&self) -> Point {
        match self {
            Self::Goto(goto) => goto.goal,
            Self::Follow { follower, .. } => follower.target(),
            Self::Cover(cover) => cover.target(),
            Self::Survey(survey) => survey.target,
        }
    }

    /// The next targets, up to this distance along the path.
    pub(crate) fn targets_ahead(&self, length_m: f64) -> &[Point] {
        match self {
            Self::Goto(goto) => std::slice::from_ref(&goto.goal),
            Self::Follow { follower, .. } => follower.ahead(length_m),
            Self::Cover(cover) => cover.ahead(length_m),
            Self::Survey(survey) => std::slice::from_ref(&survey.target),
        }
    }

    /// Counts time during which the robot was free to move.
    pub(crate) fn wait(&mut self, passed_s: f64) {
        if let Self::Cover(cover) = self {
            cover.wait(passed_s);
        }
    }

    /// Takes a plan for the remaining task.
    pub(crate) fn take_plan(&mut self, plan: &api::Plan) {
        if let Self::Cover(cover) = self {
            cover.take_plan(plan);
        }
    }

    /// The rest of the plan, from its current target on; `None` unless the task is to cover floor.
    pub(crate) fn under_way(&self) -> Option<api::Plan> {
        self.cover()?.under_way()
    }

    /// Whether a plan is mostly the same as the current one.
    pub(crate) fn keeps_to(&self, plan: &api::Plan) -> bool {
        self.cover().is_some_and(|cover| cover.keeps_to(plan))
    }

    /// Reachable cells left to scan; empty unless the task is to cover floor.
    pub(crate) fn floor_left(&self, coverage: &CoverageGrid) -> Vec<usize> {
        self.cover().map_or_else(Vec::new, |cover| cover.floor_left(coverage))
    }

    /// The requested areas that contain no reachable floor; empty unless the task is to cover requested areas.
    pub(crate) fn areas_out_of_reach(&self, coverage: &CoverageGrid) -> Vec<Vec<Point>> {
        self.cover().map_or_else(Vec::new, |cover| cover.regions_out_of_reach(coverage).collect())
    }

    /// Whether only a part of the floor is to be scanned.
    pub(crate) fn is_in_part(&self) -> bool {
        self.cover().is_some_and(Cover::is_in_part)
    }

    /// The rest of the lanes, from the point nearest to the robot on; `None` without lanes.
    pub(crate) fn lanes_left(&self) -> Option<&[Point]> {
        self.cover()?.lanes_left()
    }

    /// Progress along the lanes; `None` without lanes.
    pub(crate) fn lanes(&self) -> Option<&PathFollower> {
        self.cover()?.lanes()
    }

    /// Purpose of the stretch of the plan that the robot is on, if the planner states it.
    pub(crate) fn leg(&self) -> Option<api::LegTag> {
        self.cover()?.leg()
    }

    /// Index of the stretch of the plan that the robot is on, if the planner lists its stretches.
    pub(crate) fn leg_index(&self) -> Option<usize> {
        self.cover()?.leg_index()
    }

    /// Whether the rest of the task takes the robot's centre closer than `room_m` to an outline. Always true for tasks in
    /// which planners find their own way round obstacles: their planners need to know of every new obstacle.
    pub(crate) fn is_in_the_way(&self, shape: &Shape, room_m: f64) -> bool {
        match self {
            Self::Cover(cover) => cover.is_in_the_way(shape, room_m),
            Self::Goto(_) | Self::Follow { .. } => true,
            // A survey finds its way on its own map.
            Self::Survey(_) => false,
        }
    }

    /// The remaining task, in the form that planners receive.
    pub(crate) fn left(
        &self,
        coverage: &CoverageGrid,
        lane_m: f64,
        tether: Option<api::TetherLimits>,
    ) -> TaskLeft {
        match self {
            Self::Goto(goto) => TaskLeft::Goto { goal: goto.goal, tolerance_m: goto.tolerance_m },
            Self::Follow { follower, tolerance_m } => {
                TaskLeft::Follow { targets: follower.remaining().to_vec(), tolerance_m: *tolerance_m }
            }
            Self::Cover(cover) => cover.left(coverage, lane_m, tether),
            Self::Survey(survey) => survey.left(),
        }
    }

    /// Share of the task that is done, 0 to 1.
    pub(crate) fn done(&self) -> f64 {
        match self {
            Self::Goto(goto) => (1.0 - goto.left_m() / goto.start_m).clamp(0.0, 1.0),
            Self::Follow { follower, .. } if follower.length_m() > 0.0 => {
                follower.along_m() / follower.length_m()
            }
            Self::Follow { .. } => 1.0,
            Self::Cover(cover) => cover.done(),
            Self::Survey(survey) => survey.explored,
        }
    }

    /// Distance along the preset path, metres; `None` without one.
    pub(crate) fn along_m(&self) -> Option<f64> {
        match self {
            Self::Goto(_) | Self::Cover(_) | Self::Survey(_) => None,
            Self::Follow { follower, .. } => Some(follower.along_m()),
        }
    }

    /// Distance from the preset path or the lanes, metres; `None` without one.
    pub(crate) fn cross_track_m(&self, position: Point) -> Option<f64> {
        match self {
            Self::Goto(_) | Self::Survey(_) => None,
            Self::Follow { follower, .. } => Some(follower.cross_track_m(position)),
            Self::Cover(cover) => cover.cross_track_m(position),
        }
    }

    /// Whether the task is done, according to the position last passed to `advance`.
    pub(crate) fn is_done(&self, position: Point) -> bool {
        match self {
            Self::Goto(goto) => goto.left_m() <= goto.tolerance_m,
            Self::Follow { follower, tolerance_m } => follower.is_done(position, *tolerance_m),
            Self::Cover(cover) => cover.is_done(position),
            Self::Survey(survey) => survey.is_done(position),
        }
    }

    /// A number that falls as the task advances, metres.
    fn left_m(&self) -> f64 {
        match self {
            Self::Goto(goto) => goto.left_m(),
            Self::Follow { follower, .. } => follower.length_m() - follower.along_m(),
            Self::Cover(cover) => cover.left_m(),
            // Each way of a survey is a task of its own; its progress is that along the way.
            Self::Survey(_) => f64::INFINITY,
        }
    }
}

impl Goto {
    fn left_m(&self) -> f64 {
        (self.goal - self.position).norm()
    }
}

/// Detects a moving robot that makes no progress.
///
/// The robot counts as stuck after twice `patience_s` without progress, or after `patience_s` on the same spot without
/// progress. Progress means that less is left of the task or of the planner's path: between rooms, a path may lead away
/// from the goal for a long time.
#[derive(Clone)]
pub(crate) struct StuckWatch {
    patience_s: f64,
    /// Minimum distances left so far, of the task and of the planner's path, metres.
    least_left_m: [f64; 2],
    since_progress_s: f64,
    spot: Option<Point>,
    on_spot_s: f64,
}

impl StuckWatch {
    /// Creates a watch with this patience.
    pub(crate) fn new(patience_s: f64) -> Self {
        Self {
            patience_s,
            least_left_m: [f64::INFINITY; 2],
            since_progress_s: 0.0,
            spot: None,
            on_spot_s: 0.0,
        }
    }

    /// Forgets the progress so far, for a new attempt.
    pub(crate) fn reset(&mut self) {
        *self = Self::new(self.patience_s);
    }

    /// Processes one tick in which the robot was free to move; `plan_left_m` is the remaining length of the planner's
    /// path, if there is one. Returns whether the robot is stuck.
    pub(crate) fn update(
        &mut self,
        task: &Task,
        plan_left_m: Option<f64>,
        position: Point,
        tick_s: f64,
    ) -> bool {
        self.since_progress_s += tick_s;
        let left_m = [task.left_m(), plan_left_m.unwrap_or(f64::INFINITY)];
        for (least_m, left_m) in self.least_left_m.iter_mut().zip(left_m) {
            if left_m < *least_m - PROGRESS_M {
                (*least_m, self.since_progress_s) = (left_m, 0.0);
            }
        }
        let near = self.spot.is_some_and(|spot| (position - spot).norm() < 3.0 * PROGRESS_M);
        self.on_spot_s = if near { self.on_spot_s + tick_s } else { 0.0 };
        if !near {
            self.spot = Some(position);
        }
        self.since_progress_s > 2.0 * self.patience_s
            || (self.on_spot_s > self.patience_s && self.since_progress_s > self.patience_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn goto(goal: (f64, f64)) -> Task {
        let goal = Point::new(goal.0, goal.1);
        Task::new(&TaskConfig::Goto { goal, tolerance_m: 0.2 }, Point::origin())
    }

    #[test]
    fn a_robot_that_circles_for_long_is_stuck_but_a_detour_is_not() {
        let map = ObstacleMap::new(&world::Boundary::Circle { radius_m: 20.0 }, &[]);
        let (mut task, mut watch) = (goto((9.0, 0.0)), StuckWatch::new(10.0));
        let stuck_after = (0..1000).find(|tick| {
            let angle = f64::from(*tick) * 0.05;
            let position = Point::new(angle.cos(), angle.sin());
            task.advance(position, &map, |_| true);
            watch.update(&task, None, position, 0.1)
        });
        assert!(stuck_after.is_some_and(|tick| (180..260).contains(&tick)), "{stuck_after:?}");
        let (mut task, mut watch) = (goto((9.0, 0.0)), StuckWatch::new(10.0));
        assert!((0..150).all(|tick| {
            let position = Point::new(-f64::from(tick) * 0.04, 0.0);
            task.advance(position, &map, |_| true);
            !watch.update(&task, None, position, 0.1)
        }));
    }

    #[test]
    fn a_robot_on_a_long_way_round_is_not_stuck_until_it_stops() {
        let (task, mut watch) = (goto((0.0, 9.0)), StuckWatch::new(10.0));
        let mut plan = PathFollower::new(
            [(0.0, 0.0), (0.0, -40.0), (9.0, -40.0), (9.0, 9.0)].map(|(x, y)| Point::new(x, y)).to_vec(),
        );
        let at = |tick: u32| Point::new(0.0, -0.1 * f64::from(tick.min(350)));
        let stuck_after = (0..1000).find(|tick| {
            plan.advance(at(*tick), |_| true);
            watch.update(&task, Some(plan.left_m(at(*tick))), at(*tick), 0.1)
        });
        assert!(stuck_after.is_some_and(|tick| (450..=460).contains(&tick)), "{stuck_after:?}");
    }

    #[test]
    fn a_goal_within_tolerance_is_done() {
        let map = ObstacleMap::new(&world::Boundary::Circle { radius_m: 20.0 }, &[]);
        let mut task = goto((1.0, 0.0));
        assert!(!task.is_done(Point::origin()));
        task.advance(Point::new(0.9, 0.0), &map, |_| true);
        assert!(task.is_done(Point::new(0.9, 0.0)) && task.done() > 0.89);
    }

    #[test]
    fn points_of_a_preset_path_without_room_are_left_out() {
        let map = ObstacleMap::new(&world::Boundary::Circle { radius_m: 20.0 }, &[]);
        let path = (0..9).map(|k| Point::new(0.5 * f64::from(k), 0.0)).collect();
        let mut task = Task::new(&TaskConfig::Follow { path, tolerance_m: 0.2 }, Point::origin());
        task.advance(Point::new(0.5, 0.0), &map, |at| (at.x - 1.5).abs() > 0.8);
        assert_eq!(task.target(), Point::new(2.5, 0.0));
    }
}
