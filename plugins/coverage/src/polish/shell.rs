//! The pass along the shell. Between a straight side of the path and a round wall, a part of the critical zone that is
//! smaller than a cell stays unscanned. A shortcut that loses no cell may therefore still lose part of the zone. So the
//! zone is treated last: the path is moved back to the minimum distance from the shell, and lanes are added where the
//! zone is still open.

use crate::inflation::SLACK_M;
use crate::lanes::{Lane, thinned};
use crate::plane::inward;
use crate::polish::track::{Terms, Track};
use crate::scan::Piece;
use crate::slit_domain::SlitDomain;
use crate::tuning::shell as tuning;
use crate::workspace::Workspace;
use planner_api::Result;
use std::ops::Range;
use world::{Point, ShellStretch, ShellZone, Tool, polyline};

impl Track<'_> {
    /// Moves the path as close to the shell as hull and clearance allow.
    pub(super) fn pass_along_shell(&mut self, terms: &Terms<'_>) -> Result<()> {
        self.press_to_shell(terms)?;
        for lane in open_lanes(self.domain, &self.points(0..self.sides.len())) {
            terms.job.check()?;
            let is_wanted = |at: &Point| (terms.is_wanted)(*at) && self.swept.floor.is_near(*at);
            if lane.iter().all(is_wanted)
                && let Some(tie) = self.best_tie(&lane, terms, 0..self.sides.len())
            {
                self.tie(tie);
            }
        }
        Ok(())
    }

    /// Moves stretches that are almost at the minimum distance from the shell to exactly that distance.
    fn press_to_shell(&mut self, terms: &Terms<'_>) -> Result<()> {
        let mut at = 0;
        while at < self.sides.len() {
            terms.job.check()?;
            let Range { start, end } = self.run_along_shell(at);
            at = end.max(at) + 1;
            if start < end
                && let Some(way) = pressed(self.domain, &self.points(start..end))
            {
                let n_before = self.sides.len();
                let (old, new) = (self.swept_by(self.around(start, end)), self.swept_with(start, end, &way));
                let is_lane = self.sides[start].on_lane;
                let lost_m2 = self.swept.exchange(&old, &new) as f64 * self.swept.raster().cell_m2();
                if lost_m2 > tuning::MOST_LOST_M * polyline::length_m(&way) {
                    self.swept.exchange(&new, &old);
                } else {
                    self.splice(start, end, &[Piece { points: way, is_lane }]);
                    at = (at + self.sides.len()) - n_before;
                }
            }
        }
        Ok(())
    }

    /// The next run of points, from a given point on, that lies close to the shell.
    fn run_along_shell(&self, from: usize) -> Range<usize> {
        let n = self.sides.len();
        let is_close = |k: &usize| over_m(self.domain.workspace, self.point(*k)) < tuning::PRESSED_M;
        let Some(start) = (from..=n).find(is_close) else { return n..n };
        let end = (start..=n).take_while(is_close).last().unwrap_or(start);
        start..end
    }
}

/// The distance of a position from the wall in excess of the minimum for the hull, metres.
fn over_m(workspace: &Workspace, at: Point) -> f64 {
    workspace.wall.wall_distance_m(at) - workspace.keep_m - SLACK_M
}

/// The length of a straight segment if it runs as close to the shell as possible, otherwise 0, metres.
pub(super) fn shell_m(workspace: &Workspace, a: Point, b: Point) -> f64 {
    let is_close = |at: Point| over_m(workspace, at) < tuning::NEAR_M;
    if is_close(a) && is_close(b) && is_close(a + (b - a) / 2.0) { (b - a).norm() } else { 0.0 }
}

/// The position of the hull centre that is closest to a point on the wall.
pub(crate) fn before_shell(workspace: &Workspace, on_wall: Point) -> Point {
    on_wall + inward(&workspace.wall, on_wall) * (workspace.keep_m + SLACK_M)
}

/// A position, moved to the minimum distance from the wall.
fn at_shell(workspace: &Workspace, at: Point) -> Point {
    at - inward(&workspace.wall, at) * over_m(workspace, at)
}

/// A line near the shell, moved as close to it as possible; its ends stay in place. `None` if the moved line is
/// blocked.
fn pressed(domain: &SlitDomain<'_>, line: &[Point]) -> Option<Vec<Point>> {
    let (first, last) = (line[0], line[line.len() - 1]);
    let beside = polyline::resampled(line, tuning::STEP_M);
    let mut way = vec![first];
    way.extend(beside.iter().map(|at| at_shell(domain.workspace, *at)));
    way.push(last);
    way.dedup_by(|a, b| (*a - *b).norm() < 1e-3);
    let is_open = |pair: &[Point]| domain.sees(pair[0], pair[1]) && !domain.crosses_cut(pair[0], pair[1]);
    (way.len() > 1 && way.windows(2).all(is_open)).then(|| thinned(&way))
}

/// Lanes along the shell where a path leaves the zone open even though a lane would fit.
pub(crate) fn open_lanes(domain: &SlitDomain<'_>, path: &[Point]) -> Vec<Lane> {
    let workspace = domain.workspace;
    let mut lanes: Vec<Lane> = Vec::new();
    let mut before: Option<(Point, f64)> = None;
    for stretch in open_stretches(workspace, path) {
        let at = before_shell(workspace, stretch.at);
        let has_room = workspace.room.spare_m(at) >= SLACK_M / 2.0 && domain.contains(at);
        let is_next = before.is_some_and(|(last, end_m)| {
            stretch.along_m - end_m < tuning::STEP_M && domain.sees(last, at) && !domain.crosses_cut(last, at)
        });
        before = has_room.then_some((at, stretch.along_m + stretch.length_m));
        match lanes.last_mut() {
            _ if !has_room => {}
            Some(lane) if is_next => lane.push(at),
            _ => lanes.push(vec![at]),
        }
    }
    lanes.retain(|lane| polyline::length_m(lane) >= tuning::LEAST_M);
    lanes.iter().map(|lane| thinned(lane)).collect()
}

/// The stretches of the shell that this path leaves open but a path right along the shell would scan.
pub(crate) fn open_stretches(workspace: &Workspace, path: &[Point]) -> Vec<ShellStretch> {
    let mut zone = ShellZone::new(&workspace.wall, tuning::ZONE_M);
    // A bar just long enough to reach the wall when the hull is as close to it as possible.
    let tool = Tool::Bar { swath_m: workspace.swath_m.max(2.0 * (workspace.keep_m + SLACK_M)) };
    Tool::along(path, |from, to| zone.pass(tool, from, to));
    let is_solid = |at: Point| workspace.room.is_solid(at);
    let mut stretches = zone.profile(is_solid);
    stretches.retain(|stretch| stretch.gap_m.is_some_and(|gap_m| gap_m > tuning::NEAR_M));
    stretches
}
