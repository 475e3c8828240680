//! The planner as shown on the screen.

use super::{History, Progress, Trail};
use mission::event::{Effort, PlanScans};
use mission::{AskId, MissionConfig, PlannerChoice, PlannerInfo, WorkerId, planner::Fault};
use planner_api::{Command, Drawing, Leg, LegTag};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, VecDeque};
use world::{Point, coverage::percent_text, polyline};

/// How far the heading may turn within a lane that the planner did not state, radians.
const STRAIGHT_RAD: f64 = 0.03;

/// Maximum distance between neighbouring points of a path, metres, so that every place on the path is close to a point.
/// On paths longer than [`LONG_M`], the points are farther apart.
const SPACING_M: f64 = 0.5;
/// Length of a path above which its points are farther apart, metres.
const LONG_M: f64 = 1000.0;

/// The maximum number of a run's planner messages that are compared with new ones.
const MAX_SAID: usize = 256;
/// The maximum length of such a message, bytes; longer ones count as new.
const MAX_SAID_BYTES: usize = 1000;

/// A lane of a plan: the first and the last index of its points in [`PlanShown::path`].
pub type Lane = (usize, usize);

/// The stretch that the robot drives before the first lane of a plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lead {
    /// Back along the tether, to the place from which the new plan leads on.
    Back,
    /// To the first lane.
    ToLane,
}

/// A plan, thinned for drawing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanShown {
    /// The ask that the plan answers.
    #[serde(default)]
    pub ask: Option<AskId>,
    /// The points of the path.
    pub path: Vec<Point>,
    /// The lanes in driving order: those that the planner states, otherwise the long straight stretches of the path.
    #[serde(default)]
    pub lanes: Vec<Lane>,
    /// The length of the whole path, metres.
    pub length_m: f64,
    /// Whether the plan achieves the whole task.
    pub complete: bool,
    /// Mission time at which the plan was made, seconds.
    pub t_s: f64,
    /// The distance driven along earlier plans when this one was made, metres.
    #[serde(default)]
    pub driven_m: f64,
    /// The length of the way back along the tether with which the plan begins, metres.
    #[serde(default)]
    pub retract_m: f64,
    /// The length of the part of the plan before its first lane, metres: the way back along the tether, and the way
    /// from there to the lane.
    #[serde(default)]
    pub lead_m: f64,
}

impl PlanShown {
    /// The length from which a straight stretch of a path is a lane if the planner states none, metres: three passes of
    /// the tool.
    pub fn least_lane_m(mission: &MissionConfig) -> f64 {
        3.0 * mission.swath_m
    }

    /// The lanes of a path; `thin` contains evenly picked points of it. Stretches shorter than `least_m`, metres, are
    /// not lanes.
    pub fn lanes_of(path: &[Point], thin: &[Point], legs: &[Leg], least_m: f64) -> Vec<Lane> {
        let step = Trail::step(path.len());
        let last = thin.len().saturating_sub(1);
        let index = |at: usize| (at / step).min(last);
        let swaths = legs.iter().filter(|leg| leg.tag == LegTag::Swath);
        let stated: Vec<Lane> = swaths.map(|leg| (index(leg.first), index(leg.last))).collect();
        if !legs.is_empty() {
            return stated.into_iter().filter(|(first, last)| first < last).collect();
        }
        let long = |lane: &Lane| polyline::length_m(&thin[lane.0..=lane.1]) >= least_m;
        straights(thin).into_iter().filter(long).collect()
    }

    /// The length of the part of a plan that consists of legs of the given kinds before all others, metres; `path` is the
    /// whole path.
    pub fn begins_m(path: &[Point], legs: &[Leg], with: &[LegTag]) -> f64 {
        let part = legs.iter().take_while(|leg| with.contains(&leg.tag)).last();
        part.and_then(|leg| path.get(..=leg.last)).map_or(0.0, polyline::length_m)
    }

    /// The stretch that the robot drives before the first lane, and its remaining length, metres; `None` once the robot
    /// has reached the lane.
    pub fn lead_left_m(&self, progress: &Progress) -> Option<(Lead, f64)> {
        let along_m = self.along_m(progress.done).max(0.0);
        let ways = [(Lead::Back, self.retract_m), (Lead::ToLane, self.lead_m)];
        ways.into_iter().map(|(lead, end_m)| (lead, end_m - along_m)).find(|(_, left_m)| *left_m > 0.0)
    }

    /// The length of the path from the point nearest to the robot to its end, metres. The next target does not tell it:
    /// for some planners, the target is the goal.
    pub fn rest_m(&self, robot: Point, done: f64) -> f64 {
        // The points that are drawn cut corners, so their distances are shares of the whole length.
        let drawn_m = polyline::length_m(&self.path);
        let rest_m = polyline::length_m(&self.path[self.nearest(robot, done)..]);
        if drawn_m > 0.0 { rest_m / drawn_m * self.length_m } else { 0.0 }
    }

    /// The index of the path point at the robot's next target; 0 if the path is empty.
    pub fn reached(&self, progress: &Progress) -> usize {
        self.nearest(progress.target, progress.done)
    }

    /// The index of the path point at a place; 0 if the path is empty. Where the path passes the place several times, the
    /// distance driven so far decides.
    fn nearest(&self, place: Point, done: f64) -> usize {
        let away_m = |point: &Point| (point - place).norm();
        let nearest_m = self.path.iter().map(away_m).fold(f64::INFINITY, f64::min);
        let along_m = self.along_m(done);
        let points = self.path.iter().zip(polyline::stations_m(&self.path)).enumerate();
        let near = points.filter(|(_, (point, _))| away_m(point) <= nearest_m + SPACING_M);
        near.map(|(index, (point, at_m))| (index, (at_m - along_m).abs() + away_m(point)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map_or(0, |(index, _)| index)
    }

    /// The distance driven along this plan, metres, given the share of the task that is done.
    pub fn along_m(&self, done: f64) -> f64 {
        done * (self.driven_m + self.length_m) - self.driven_m
    }

    /// The lane on which a point of the path lies, or the stretch between two lanes: first and last index. A path
    /// without lanes has no legs: both indices are that of the point.
    pub fn leg_at(&self, index: usize) -> Lane {
        if self.lanes.is_empty() {
            return (index, index);
        }
        let end = self.path.len().saturating_sub(1);
        let next = self.lanes.partition_point(|(_, last)| *last <= index);
        let before = next.checked_sub(1).map_or(0, |before| self.lanes[before].1);
        match self.lanes.get(next) {
            Some((first, last)) if *first <= index => (*first, *last),
            Some((first, _)) => (before, *first),
            None => (before, end),
        }
    }
}

/// A path for drawing, with its lanes: with fewer points if it has too many, and with more points where they are far
/// apart.
pub fn shown(path: &[Point], legs: &[Leg], least_lane_m: f64) -> (Vec<Point>, Vec<Lane>) {
    let thin = Trail::thinned(path);
    let lanes = PlanShown::lanes_of(path, &thin, legs, least_lane_m);
    let spacing_m = SPACING_M * (polyline::length_m(&thin) / LONG_M).max(1.0);
    let mut dense: Vec<Point> = thin.first().copied().into_iter().collect();
    let mut index = vec![0];
    for pair in thin.windows(2) {
        dense.extend(polyline::resampled(pair, spacing_m).into_iter().skip(1));
        index.push(dense.len() - 1);
    }
    (dense, lanes.into_iter().map(|(first, last)| (index[first], index[last])).collect())
}

/// The stretches of a path on which its heading stays nearly the same.
fn straights(path: &[Point]) -> Vec<Lane> {
    let mut found: Vec<(Lane, f64)> = Vec::new();
    for (index, pair) in path.windows(2).enumerate().filter(|(_, pair)| pair[0] != pair[1]) {
        let way = pair[1] - pair[0];
        let heading_rad = way.y.atan2(way.x);
        match found.last_mut() {
            Some(((_, last), began_rad))
                if *last == index && apart(heading_rad, *began_rad) < STRAIGHT_RAD =>
            {
                *last = index + 1;
            }
            _ => found.push(((index, index + 1), heading_rad)),
        }
    }
    found.into_iter().map(|(lane, _)| lane).collect()
}

/// The angle between two headings, radians.
fn apart(a_rad: f64, b_rad: f64) -> f64 {
    let turn = (a_rad - b_rad).rem_euclid(std::f64::consts::TAU);
    turn.min(std::f64::consts::TAU - turn)
}

/// A plan that is better than the rest of the current one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Offer {
    /// The effort for the rest of the current plan.
    pub flown: Effort,
    /// The effort for the better plan.
    pub better: Effort,
    /// The floor that both plans scan; `None` if that is not known.
    #[serde(default)]
    pub scans: Option<PlanScans>,
    /// The point at which the better plan begins.
    pub begins: Option<Point>,
    /// The points of its path, thinned for drawing.
    #[serde(default)]
    pub path: Vec<Point>,
    /// The lanes of the path.
    #[serde(default)]
    pub lanes: Vec<Lane>,
    /// Whether the mission will switch to the better plan at the point where that plan begins, by order of the operator
    /// or because of a setting of the scenario.
    pub is_taken: bool,
}

impl Offer {
    /// The saving of the better plan, as a sentence without a full stop.
    pub fn sentence(&self) -> String {
        format!("Better plan: {}", self.better.saving(&self.flown))
    }

    /// The floor that the better plan scans, as a sentence; `None` if that is not known.
    pub fn scanned(&self) -> Option<String> {
        let scans = self.scans?;
        let [better, flown] = [scans.better, scans.flown].map(|scan| percent_text(scan.covered_reachable, 1));
        Some(format!("It scans {better} % (now {flown} %)."))
    }
}

/// The planner and its latest output.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Planning {
    /// The active planner, with the parameters set by hand.
    pub choice: Option<PlannerChoice>,
    /// The active planner with the parameters that were ordered last, until they take effect or are refused.
    #[serde(default)]
    pub ordered: Option<PlannerChoice>,
    /// The description of the planner.
    pub info: Option<PlannerInfo>,
    /// The current plan.
    pub plan: Option<PlanShown>,
    /// The last command, with its mission time, seconds.
    pub command: Option<(f64, Command)>,
    /// The last drawings.
    pub drawings: Vec<Drawing>,
    /// The tick of the last drawings.
    pub drawings_tick: u64,
    /// The last figures: name, value, unit.
    pub scalars: Vec<(String, f64, String)>,
    /// The history of each of these figures, by name.
    #[serde(default)]
    pub scalar_history: BTreeMap<String, History>,
    /// The last fault; cleared when the planner is active again.
    pub fault: Option<Fault>,
    /// The worker of a candidate; its plans do not run yet.
    #[serde(default)]
    pub candidate: Option<WorkerId>,
    /// Whether the candidate made the last plan; if so, the next certificate is not about the plan that is running.
    #[serde(default)]
    pub proposed: bool,
    /// The messages of planners that were shown, oldest first.
    #[serde(default)]
    pub said: VecDeque<String>,
    /// A better plan that is on offer, or that was taken and will run from the point at which it begins.
    #[serde(default)]
    pub offer: Option<Offer>,
}

impl Planning {
    /// Whether a message of a planner has been shown before; it counts as shown from now on.
    pub(super) fn has_said(&mut self, text: &str) -> bool {
        if self.said.iter().any(|said| said == text) {
            return true;
        }
        if text.len() > MAX_SAID_BYTES {
            return false;
        }
        if self.said.len() >= MAX_SAID {
            self.said.pop_front();
        }
        self.said.push_back(text.to_owned());
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A meander of three lanes, each of 11 points a metre apart, 1 m from each other.
    fn meander() -> Vec<Point> {
        let lane = |row: i32| {
            (0..=10)
                .map(move |x| Point::new(f64::from(if row % 2 == 0 { x } else { 10 - x }), f64::from(row)))
        };
        (0..3).flat_map(lane).collect()
    }

    fn plan(path: Vec<Point>, lanes: Vec<Lane>, length_m: f64) -> PlanShown {
        PlanShown {
            ask: None,
            path,
            lanes,
            length_m,
            complete: true,
            t_s: 0.0,
            driven_m: 0.0,
            retract_m: 0.0,
            lead_m: 0.0,
        }
    }

    fn shown(lanes: Vec<Lane>) -> PlanShown {
        plan(meander(), lanes, 32.0)
    }

    #[test]
    fn the_lanes_are_those_that_the_planner_states() {
        let leg = |tag, first, last| Leg { tag, first, last };
        let legs = [leg(LegTag::Swath, 0, 10), leg(LegTag::Connector, 10, 11), leg(LegTag::Swath, 11, 21)];
        let path = meander();
        assert_eq!(PlanShown::lanes_of(&path, &path, &legs, 2.0), [(0, 10), (11, 21)]);
        let long: Vec<Point> = (0..5000).map(|i| Point::new(f64::from(i), 0.0)).collect();
        let thin = Trail::thinned(&long);
        let legs = [leg(LegTag::Swath, 0, 2400), leg(LegTag::Swath, 2401, 4999)];
        let lanes = PlanShown::lanes_of(&long, &thin, &legs, 2.0);
        assert_eq!(thin[lanes[0].1], long[2400], "the indices are those of the thinned path");
        assert!(thin.len() - lanes[1].1 <= 2, "{lanes:?}");
    }

    #[test]
    fn without_legs_the_long_straight_stretches_are_lanes() {
        let path = meander();
        assert_eq!(PlanShown::lanes_of(&path, &path, &[], 2.0), [(0, 10), (11, 21), (22, 32)]);
    }

    #[test]
    fn the_leg_is_the_lane_or_the_way_to_the_next() {
        let plan = shown(vec![(0, 10), (11, 21), (22, 32)]);
        assert_eq!([plan.leg_at(0), plan.leg_at(9), plan.leg_at(10)], [(0, 10), (0, 10), (10, 11)]);
        assert_eq!([plan.leg_at(11), plan.leg_at(32)], [(11, 21), (32, 32)]);
        assert_eq!(shown(Vec::new()).leg_at(5), (5, 5));
    }

    fn progress(target: Point, done: f64) -> Progress {
        let (covered_reachable, covered_whole) = (done, done);
        Progress {
            t_s: 0.0,
            done,
            along_m: None,
            cross_track_m: None,
            target,
            covered_reachable,
            covered_whole,
        }
    }

    /// A plan with two points for each of its long lanes; its way back passes the first lane.
    fn long_lanes() -> PlanShown {
        let corners = [
            (0.0, 0.0),
            (20.0, 0.0),
            (20.0, 0.5),
            (0.0, 0.5),
            (0.0, 1.0),
            (10.0, 1.0),
            (10.0, 0.1),
            (0.0, 0.1),
        ];
        let path: Vec<Point> = corners.iter().map(|(x, y)| Point::new(*x, *y)).collect();
        let legs = [(0, 1), (2, 3), (4, 5)].map(|(first, last)| Leg { tag: LegTag::Swath, first, last });
        let length_m = polyline::length_m(&path);
        let (path, lanes) = super::shown(&path, &legs, 2.0);
        plan(path, lanes, length_m)
    }

    #[test]
    fn the_rest_is_counted_from_the_robot_even_if_the_target_is_the_goal() {
        let path: Vec<Point> = (0..=40).map(|n| Point::new(0.1 * f64::from(n), 0.0)).collect();
        let plan = plan(path, Vec::new(), 4.0);
        assert!((plan.rest_m(Point::new(0.52, 0.03), 0.13) - 3.5).abs() < 1e-9);
    }

    #[test]
    fn a_place_on_a_long_lane_is_found_where_the_robot_drives_it() {
        let plan = long_lanes();
        let length_m = plan.length_m;
        // The target is far from both ends of its lane, and the way back passes close to it.
        let at = plan.reached(&progress(Point::new(9.6, 0.0), 9.6 / length_m));
        assert_eq!(plan.leg_at(at), plan.lanes[0]);
        assert!((plan.rest_m(Point::new(9.6, 0.0), 9.6 / length_m) - (length_m - 9.6)).abs() < 0.3);
        let back = plan.reached(&progress(Point::new(9.6, 0.1), 1.0 - 9.6 / length_m));
        assert!(back > plan.lanes[2].1, "on the way back");
    }

    #[test]
    fn a_plan_says_how_far_it_is_to_its_start_and_to_its_first_lane() {
        let leg = |tag, first, last| Leg { tag, first, last };
        let legs = [
            leg(LegTag::Retract, 0, 2),
            leg(LegTag::Retract, 2, 4),
            leg(LegTag::Travel, 4, 6),
            leg(LegTag::Swath, 6, 32),
        ];
        let begins_m = |legs, with: &[LegTag]| PlanShown::begins_m(&meander(), legs, with);
        let (retract_m, lead_m) = (
            begins_m(&legs[..], &[LegTag::Retract]),
            begins_m(&legs[..], &[LegTag::Retract, LegTag::Travel]),
        );
        assert!((retract_m - 4.0).abs() < 1e-9 && (lead_m - 6.0).abs() < 1e-9);
        assert!(begins_m(&legs[3..], &[LegTag::Retract]).abs() < 1e-9);
        // 8 m of 40 m were driven along the plan before.
        let plan = PlanShown { driven_m: 8.0, retract_m, lead_m, ..shown(Vec::new()) };
        let left = |driven_m: f64| plan.lead_left_m(&progress(Point::origin(), driven_m / 40.0));
        let is_left = |driven_m, lead, m: f64| {
            left(driven_m).is_some_and(|(is, left_m)| is == lead && (left_m - m).abs() < 1e-9)
        };
        assert!(is_left(9.0, Lead::Back, 3.0) && is_left(13.0, Lead::ToLane, 1.0));
        assert_eq!(left(14.5), None);
    }

    #[test]
    fn the_distance_along_a_plan_counts_from_its_beginning() {
        let plan = PlanShown { driven_m: 8.0, ..shown(Vec::new()) };
        assert!((plan.along_m(0.5) - 12.0).abs() < 1e-9);
    }
}
