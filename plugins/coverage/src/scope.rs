//! What is to be scanned.

use crate::slit_domain::SlitDomain;
use planner_api::{Code, PlanRequest, PlannerError, Result, Task, TetherLimits};
use world::Point;

/// What is to be scanned, from where, how far the robot may go, and how much is enough.
#[derive(Clone, Copy)]
pub(crate) struct Scope<'a> {
    /// Where the robot is.
    pub start: Point,
    /// Where the tether comes in, and its limits.
    pub anchor: Point,
    pub tether: Option<TetherLimits>,
    /// Longest way from home, metres.
    pub reel_length_m: f64,
    /// Distance at which the robot is back, metres.
    pub tolerance_m: f64,
    /// Polygons still to scan; all floor if empty.
    pub regions: &'a [&'a [Point]],
    /// Coverage that is enough, as a share of the reachable floor.
    pub enough: f64,
    /// Edge of a cell of the floor, metres.
    pub cell_m: f64,
}

impl<'a> Scope<'a> {
    /// All that a request asks for, as if there were no tether, if it is to cover floor; `id` is the planner that is asked.
    ///
    /// # Errors
    /// Another task, or a start that is no number.
    pub(crate) fn of(request: &PlanRequest<'a>, id: &str, cell_m: f64) -> Result<Self> {
        let start = request.start.position;
        if !(start.x.is_finite() && start.y.is_finite()) {
            return Err(PlannerError::new(Code::Invalid, "the start is not a number"));
        }
        let Task::Cover { anchor, regions, tether, tolerance_m } = request.task else {
            return Err(PlannerError::new(
                Code::Unsupported,
                format!("{id} covers floors; for this mission choose a planner for goals or preset paths"),
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
            cell_m,
        })
    }

    /// Whether the reel lets the robot be at a place of a domain.
    pub(crate) fn is_in_reach(&self, domain: &SlitDomain<'_>, at: Point) -> bool {
        let way_m = || domain.way_home_m(at);
        self.reel_length_m.is_infinite() || way_m().is_some_and(|way_m| way_m <= self.reel_length_m)
    }
}
