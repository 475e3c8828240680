//! Updates the map with the obstacles seen, and the coverage with the floor scanned, in one tick.

use super::{
    Mission,
    back::Back,
    happened::Happened,
    known::Known,
    role::{Preparing, Role},
};
use crate::{chart::Seen, event::EventKind, passage::Passage, task::Task};
use perception::View;
use planner_api::Reason;
use world::{Cell, Pose, Readings, Shape, World, coverage::percent_text, tether::Reach};

/// Area, square metres, above which an omitted or unreachable area is mentioned at the end.
const WORTH_TELLING_M2: f64 = 0.05;
/// Maximum number of unreachable areas named at the end.
const MOST_NAMED: usize = 4;

impl Mission {
    /// Puts the obstacles seen on the chart; returns whether the chart has changed.
    pub(super) fn look_around(&mut self, readings: &Readings) -> bool {
        let (now_s, pose) = (self.known.now_s(), self.known.locator.pose());
        let missing = self.known.look_at_scan(readings);
        self.happened.extend(missing);
        let scanned: Vec<_> = self.known.perception.iter().flat_map(|found| found.seen(&pose)).collect();
        let told = readings.sightings.iter().map(|told| (told.id, &told.shape_in_robot));
        let seen = told.chain(scanned.iter().map(|seen| (seen.id, &seen.shape_in_robot)));
        self.known.chart.sight(seen, &pose);
        // Found obstacles are placed using the estimated pose, so nothing is charted while the position is lost.
        if self.known.locator.is_lost() {
            return false;
        }
        let Seen { events, changes_plans } =
            self.known.chart.see(now_s, &readings.sightings, &scanned, &pose);
        if events.is_empty() && !changes_plans {
            return false;
        }
        // Moving obstacles do not change the floor.
        let still = events.iter().filter(|event| !self.known.chart.moves(event));
        let shapes: Vec<Shape> = still.filter_map(shape_of).collect();
        let is_due = |task: &Task| {
            changes_plans
                && (events.is_empty() || events.iter().any(|event| self.known.is_in_the_way(task, event)))
        };
        let shadow_is_due = self.shadow.as_ref().is_some_and(|shadow| is_due(&shadow.task));
        if is_due(&self.known.task) {
            self.driving.course.want_plan(Reason::MapChanged);
        }
        if changes_plans && !shapes.is_empty() {
            self.postpone_better_plan();
            self.driving.course.found_since.extend_from_slice(&shapes);
            if let Some(Preparing { role: Role::Candidate(candidate), .. }) = &mut self.preparing {
                candidate.found_since.extend_from_slice(&shapes);
            }
        }
        if let Some(shadow) = &mut self.shadow {
            shadow.map_changed(if changes_plans { &shapes } else { &[] }, shadow_is_due);
        }
        self.happened.extend(events);
        let changes = self.known.floor.survey(&self.known.config, &self.known.chart, &shapes);
        if !changes.is_empty() {
            self.happened.push(EventKind::FloorChanged { changes });
        }
        true
    }
}

impl Known {
    /// Looks for obstacles in the scan of this tick, if there is one; returns the events about drawn obstacles.
    fn look_at_scan(&mut self, readings: &Readings) -> Vec<EventKind> {
        let (now_s, estimate, pose) = (self.now_s(), self.locator.pose_estimate(), self.locator.pose());
        let (Some(perception), Some(scan)) = (&mut self.perception, &readings.scan) else {
            return Vec::new();
        };
        let World { boundary, obstacles, .. } = self.chart.world();
        let (charted, map, covariance) = (&obstacles[..], self.chart.drawn_map(), estimate.covariance);
        let hull_m = self.config.limits.radius_m;
        let reach_m = hull_m + self.config.limits.sensing_range_m;
        let looked =
            perception.look(&View { now_s, scan, pose, covariance, boundary, charted, map, hull_m, reach_m });
        if self.config.sensor.is_some_and(|sensor| sensor.locates) {
            self.locator.keep_match(perception.matched());
        }
        let name = |id| obstacles.iter().find(|obstacle| obstacle.id == id).map(|found| found.name.clone());
        let not_there = |(id, scans)| Some(EventKind::NotThere { id, name: name(id)?, scans });
        looked.not_there.into_iter().filter_map(not_there).collect()
    }

    /// A newly found obstacle blocks a path if the path comes closer than the required clearance. If the plan already
    /// took an obstacle into account and its position has merely been corrected, the obstacle blocks a path only within
    /// half that clearance.
    fn is_in_the_way(&self, task: &Task, event: &EventKind) -> bool {
        let (radius_m, clearance_m) = (self.config.limits.radius_m, self.config.clearance_m);
        match event {
            EventKind::ObstacleMoved { obstacle, .. } => {
                task.is_in_the_way(&obstacle.shape, radius_m + 0.5 * clearance_m)
            }
            EventKind::ObstacleFound { obstacle } => {
                task.is_in_the_way(&obstacle.shape, radius_m + clearance_m)
            }
            _ => false,
        }
    }

    pub(super) fn scan_from(&mut self, before: Pose, happened: &mut Happened) {
        let here = self.locator.pose();
        let (chart, room_m) = (&self.chart, self.config.room_m());
        // A robot that drives back makes no progress along its task.
        let back = self.back.as_ref().filter(|_| self.phase.is_return());
        if back.is_none() {
            self.task.advance(here.position, chart.map(), |at| chart.has_room(at, room_m));
        }
        let passage = Passage::of(&self.phase, self.locator.error_95_m(), self.config.scan_limit_m());
        if passage == Passage::Idle {
            return;
        }
        // A survey drives without its tool.
        let fresh = if self.survey.is_some() {
            Vec::new()
        } else {
            let live = self.channels.live(self.floor.coverage.floor().rim_m());
            self.floor.coverage.not_covered_under_parts(&live, before, here)
        };
        if !fresh.is_empty() && passage == Passage::Counts {
            self.floor.coverage.apply(&fresh);
            happened.push(EventKind::Covered { runs: fresh });
        } else if !fresh.is_empty() {
            happened.push(EventKind::Uncounted { runs: fresh });
        }
        if self.locator.is_lost() {
            return;
        }
        happened.push(EventKind::Progressed {
            done: self.task.done(),
            along_m: self.task.along_m(),
            cross_track_m: if back.is_none() { self.task.cross_track_m(here.position) } else { None },
            target: back.map_or_else(|| self.task.target(), Back::target),
            covered_reachable: self.floor.coverage.fraction_reachable(),
            covered_whole: self.floor.coverage.fraction_whole(),
            leg: if back.is_none() { self.task.leg() } else { None },
        });
    }

    /// Why a task counts as done, as a sentence.
    pub(super) fn done_reason(&self, is_plan_whole: bool) -> String {
        match &self.task {
            Task::Goto(_) | Task::Follow { .. } => "task complete".into(),
            Task::Survey(survey) => self.mapped_reason(survey),
            Task::Cover(_) => {
                let share = percent_text(self.floor.coverage.fraction_reachable(), 1);
                let place = if self.config.tether.is_some() { "anchor" } else { "start" };
                let base_m2 =
                    self.floor.coverage.counts().reachable as f64 * self.floor.coverage.floor().cell_m2();
                let scanned = format!(
                    "back at the {place}, {share} % of the {base_m2:.1} m² of reachable floor scanned"
                );
                let asked = if self.task.is_in_part() {
                    let n_left = self.task.floor_left(&self.floor.coverage).len();
                    let left_m2 = n_left as f64 * self.floor.coverage.floor().cell_m2();
                    match format!("{left_m2:.2}").as_str() {
                        "0.00" => ", nothing of the requested floor missed".to_owned(),
                        left => format!(", {left} m² of the requested floor missed"),
                    }
                } else {
                    String::new()
                };
                let left_beyond_reel = (!is_plan_whole).then(|| self.left_beyond_reel()).flatten();
                let left_out = [self.out_of_reach(), left_beyond_reel];
                let left_out = left_out.into_iter().flatten().map(|why| format!("; {why}"));
                scanned + &asked + &left_out.collect::<String>()
            }
        }
    }

    /// Describes the requested areas that the tool cannot reach, as a sentence; in a mission over the whole floor, states
    /// how much floor cannot be reached.
    fn out_of_reach(&self) -> Option<String> {
        let named = |places: &[String]| {
            let more = places.len().saturating_sub(MOST_NAMED);
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            format!("{}{more}", places[..places.len().min(MOST_NAMED)].join(", "))
        };
        let coverage = &self.floor.coverage;
        let areas: Vec<String> = self
            .task
            .areas_out_of_reach(coverage)
            .iter()
            .map(|ring| world::shape::mean_of(ring))
            .map(|at| format!("({:.1}, {:.1})", at.x, at.y))
            .collect();
        if !areas.is_empty() {
            let what = if areas.len() == 1 { "the area" } else { "the areas" };
            return Some(format!("the tool cannot reach any floor in {what} around {}", named(&areas)));
        }
        let floor = coverage.floor();
        let closed = (0..floor.len()).filter(|cell| floor.kind(*cell) == Cell::Unreachable).count();
        let closed_m2 = closed as f64 * floor.cell_m2();
        let is_worth = closed_m2 > WORTH_TELLING_M2 && !self.task.is_in_part();
        is_worth.then(|| format!("no path leads to {closed_m2:.1} m² of floor"))
    }

    /// The floor that is not in the plan because the cable does not reach it, as a sentence.
    fn left_beyond_reel(&self) -> Option<String> {
        let (anchor, reach_m) = self.config.cable_reach()?;
        let world = self.chart.world();
        let shapes: Vec<Shape> = world.obstacles.iter().map(|o| o.shape.clone()).collect();
        let reach = Reach::new(anchor, &world.boundary, &shapes, reach_m);
        let floor = self.floor.coverage.floor();
        let left = self.task.floor_left(&self.floor.coverage);
        let beyond = left.iter().filter(|index| reach.is_beyond(floor.center(**index))).count();
        let beyond_m2 = beyond as f64 * floor.cell_m2();
        let reel_length_m = self.config.tether.as_ref()?.limits.reel_length_m;
        (beyond_m2 > WORTH_TELLING_M2).then(|| {
            format!("INCOMPLETE: {beyond_m2:.1} m² not planned, beyond the {reel_length_m} m tether")
        })
    }
}

fn shape_of(event: &EventKind) -> Option<Shape> {
    match event {
        EventKind::ObstacleFound { obstacle } | EventKind::ObstacleMoved { obstacle, .. } => {
            Some(obstacle.shape.clone())
        }
        _ => None,
    }
}
