//! The scope of a plan: the floor to scan and its limits.

use crate::floor::{ReachableFloor, SweptFloor};
use crate::slit_domain::SlitDomain;
use crate::tuning::polish::KEPT;
use crate::workspace::Workspace;
use planner_api::{Code, PlanRequest, PlannerError, Result, Task, TetherLimits};
use world::Point;

/// The floor to scan, the start, how far the robot may go, and the required coverage.
#[derive(Clone, Copy)]
pub(crate) struct Scope<'a> {
    /// Position of the robot.
    pub start: Point,
    /// Where the tether enters the tank, and its limits.
    pub anchor: Point,
    pub tether: Option<TetherLimits>,
    /// Longest path from home, metres.
    pub reel_length_m: f64,
    /// Distance from home within which the robot counts as being back, metres.
    pub tolerance_m: f64,
    /// Polygons still to scan; all floor if empty.
    pub regions: &'a [&'a [Point]],
    /// Required coverage, as a share of the remaining reachable floor.
    pub enough: f64,
    /// All floor to be scanned, including floor already scanned, as a multiple of the remaining floor.
    pub whole: f64,
    /// Edge length of a cell of the floor, metres.
    pub cell_m: f64,
}

impl<'a> Scope<'a> {
    /// The scope of a request for coverage, as if there were no tether. `id` is the planner's, for messages.
    ///
    /// # Errors
    /// The task is not coverage, or the coordinates of the start are not finite.
    pub(crate) fn of(request: &PlanRequest<'a>, id: &str, cell_m: f64) -> Result<Self> {
        let start = request.start.position;
        if !(start.x.is_finite() && start.y.is_finite()) {
            return Err(PlannerError::new(Code::Invalid, "start coordinates must be finite numbers"));
        }
        let Task::Cover { anchor, regions, tether, tolerance_m } = request.task else {
            return Err(PlannerError::new(
                Code::Unsupported,
                format!(
                    "{id} only covers floors; for this mission, choose a planner for goals or preset paths"
                ),
            ));
        };
        Ok(Self {
            start,
            anchor,
            tether,
            reel_length_m: f64::INFINITY,
            tolerance_m,
            regions,
            enough: 1.0,
            whole: 1.0,
            cell_m,
        })
    }

    /// The scope for a robot that has already driven a path: the floor that the path scanned counts towards the whole.
    pub(crate) fn after(self, flown: &[Point], workspace: &Workspace) -> Self {
        if self.regions.is_empty() || flown.is_empty() {
            return self;
        }
        let Some(domain) = SlitDomain::new(workspace, Vec::new()) else { return self };
        let all = ReachableFloor::new(&domain, self.cell_m);
        let left = all.clone().within(self.regions);
        let mut scanned = SweptFloor::new(all);
        scanned.sweep(flown);
        let n_whole = left.n + scanned.n_swept_beside(&left);
        Self { whole: n_whole as f64 / left.n.max(1) as f64, ..self }
    }

    /// Converts a required share of the whole floor to a share of the remaining floor. Late in a mission, when little
    /// is left, a larger share of the rest may be missed.
    pub(crate) fn of_rest(&self, enough_of_whole: f64) -> f64 {
        (1.0 - self.whole * (1.0 - enough_of_whole)).max(KEPT.min(enough_of_whole))
    }

    /// Whether the reel is long enough for the robot to reach a position of a domain.
    pub(crate) fn is_in_reach(&self, domain: &SlitDomain<'_>, at: Point) -> bool {
        let way_m = || domain.way_home_m(at);
        self.reel_length_m.is_infinite() || way_m().is_some_and(|way_m| way_m <= self.reel_length_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_enough_of_the_rest_is_what_is_enough_of_the_whole_and_most_of_it_at_least() {
        let scope = |whole| Scope {
            start: Point::origin(),
            anchor: Point::origin(),
            tether: None,
            reel_length_m: f64::INFINITY,
            tolerance_m: 0.3,
            regions: &[],
            enough: 1.0,
            whole,
            cell_m: 0.05,
        };
        assert!((scope(1.0).of_rest(0.995) - 0.995).abs() < 1e-12);
        assert!((scope(10.0).of_rest(0.995) - 0.95).abs() < 1e-12);
        assert!((scope(100.0).of_rest(0.995) - KEPT).abs() < 1e-12);
        assert!((scope(100.0).of_rest(0.6) - 0.6).abs() < 1e-12);
    }
}
