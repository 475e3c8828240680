//! The time that a plan for the rest of the task must save, and the place where it begins.

use super::super::{known::Known, requests::AskedPlan};
use crate::{
    ask::PlanAsk,
    event::{Effort, PlanScan, PlanScans},
    task::Joint,
};
use planner_api::{Plan, PoseEstimate, Reason};
use world::{CoverageGrid, Point, Tool};

/// Minimum time until the robot reaches the start of the better plan, seconds of driving. The planner needs this time
/// to plan, and an operator to decide.
const LEAD_S: f64 = 60.0;
/// The minimum time until the robot reaches the start of the better plan, as a share of the time left in the current
/// plan, because planning and deciding take longer in a large tank.
const LEAD_SHARE: f64 = 0.05;
/// Remaining driving time, seconds, below which no better plan is sought: given the two thresholds below, such a plan
/// would have to save more than 12 % of that time.
const WORTH_S: f64 = 300.0;
/// Time, seconds, that a change must save in addition to [`CHANGE_SHARE`] of the remaining time. An operator needs this
/// time to check the plan.
const CHANGE_S: f64 = 30.0;
/// Share of the remaining time that a change must save in addition to [`CHANGE_S`]. Because of unforeseen obstacles,
/// the path driven is typically longer than the path planned by about this share.
const CHANGE_SHARE: f64 = 0.02;
/// Two plans count as scanning the same floor if the amounts that they leave unscanned differ by at most this share of
/// the floor left to scan. Cells count by their centres, so plans with different lanes differ by single cells.
const SAME_FLOOR_SHARE: f64 = 0.0005;

impl Known {
    /// The place where a better plan would begin; `None` if too little of the current plan is left after that place.
    pub(super) fn joint(&self) -> Option<Joint> {
        let (cover, lanes) = (self.task.cover()?, self.task.lanes()?);
        let v_m_per_s = self.config.limits.v_max_m_per_s;
        let left_m = lanes.length_m() - lanes.along_m();
        let joint = cover.joint((LEAD_S * v_m_per_s).max(LEAD_SHARE * left_m))?;
        (lanes.length_m() - joint.station_m >= WORTH_S * v_m_per_s).then_some(joint)
    }

    /// The place where a better plan would begin, and the inputs of that plan: it covers the part of the task that will
    /// be left when the robot reaches the place; `None` if too little is left.
    pub(in crate::engine) fn better_plan_ask(&self) -> Option<(Joint, (AskedPlan, PlanAsk))> {
        let joint = self.joint()?;
        let way = self.task.cover()?.way_to(&joint);
        let coverage = self.coverage_after(&way);
        let heading_rad = way.windows(2).next_back().map(|pair| pair[1] - pair[0]).map(|w| w.y.atan2(w.x));
        let here = self.locator.pose_estimate();
        let start =
            PoseEstimate { position: joint.at, heading_rad: heading_rad.unwrap_or(here.heading_rad), ..here };
        let previous = self.trail.iter().chain(&way).copied().collect();
        let ask = self.plan_from(start, previous, &coverage, (Reason::MapChanged, None));
        Some((joint, (AskedPlan::from_here(Reason::MapChanged, here.position), ask)))
    }

    /// The floor that will have been scanned once a path has been driven.
    fn coverage_after(&self, way: &[Point]) -> CoverageGrid {
        let mut coverage = self.floor.coverage.clone();
        Tool::along(way, |from, to| coverage.mark(self.config.tool(), from, to));
        coverage
    }

    /// Compares a plan with the rest of the current path. Returns the floor that each of them scans and, if the plan is
    /// not offered, the reason: it saves too little, scans less floor, or is not safe for the tether.
    pub(super) fn judge_better(
        &self,
        way: &[Point],
        rest: &[Point],
        (flown, better): (Effort, Effort),
        plan: &Plan,
    ) -> (Option<PlanScans>, Option<String>) {
        if let Some(why) = saves_too_little(&flown, &better) {
            return (None, Some(why));
        }
        let coverage = self.coverage_after(way);
        let cell_m2 = coverage.floor().cell_m2();
        let same_m2 = SAME_FLOOR_SHARE * self.task.floor_left(&coverage).len() as f64 * cell_m2;
        let scan = |path: &[Point]| {
            let mut coverage = coverage.clone();
            Tool::along(path, |from, to| coverage.mark(self.config.tool(), from, to));
            let left_m2 = self.task.floor_left(&coverage).len() as f64 * cell_m2;
            PlanScan { left_m2, covered_reachable: coverage.fraction_reachable() }
        };
        let scans = PlanScans { flown: scan(rest), better: scan(&plan.path) };
        let less_m2 = scans.better.left_m2 - scans.flown.left_m2;
        let objection = if less_m2 > same_m2 {
            Some(format!("{}, but it scans {less_m2:.2} m² less", better.saving(&flown)))
        } else {
            self.objection_for_tether(way, plan)
        };
        (Some(scans), objection)
    }

    fn objection_for_tether(&self, way: &[Point], plan: &Plan) -> Option<String> {
        let tether = self.tether.as_ref()?;
        let certificate = tether.certify_after(way, plan, self.chart.world(), self.task_ends_at_anchor());
        let why = || format!("not safe for the tether: {}", certificate.reasons.join("; "));
        (!certificate.certified).then(why)
    }
}

/// The reason why a plan saves too little time to justify a change, as a sentence.
fn saves_too_little(flown: &Effort, better: &Effort) -> Option<String> {
    let (saves_s, worth_s) = (flown.time_s - better.time_s, CHANGE_S + CHANGE_SHARE * flown.time_s);
    let [flown_min, better_min, saves_min, worth_min] =
        [flown.time_s, better.time_s, saves_s, worth_s].map(|s| s / 60.0);
    if saves_s <= 0.0 {
        return Some(format!("{better_min:.1} min, slower than the current plan ({flown_min:.1} min)"));
    }
    let why = || {
        format!(
            "{better_min:.1} min, {saves_min:.1} min shorter than the current plan; a change must save \
             {worth_min:.1} min"
        )
    };
    (saves_s <= worth_s).then(why)
}
