//! Requested floor that a plan does not scan, with the reasons, before anything moves.

use super::{Area, Evidence, MissReason, Slivers, areas, plate_map};
use mission::{TaskConfig, event::RunOpened};
use serde::{Deserialize, Serialize};
use world::{CoverageGrid, Point, Pose, polyline};

/// Where a plan that continues earlier runs begins to scan, and what it scans a second time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Resumption {
    /// The point of the path from which on requested floor is scanned, metres, tank frame.
    pub at: Point,
    /// Length of the path up to that point, metres.
    pub after_m: f64,
    /// Reachable floor that was not requested, but that the plan scans, square metres.
    pub again_m2: f64,
}

/// The reachable floor that was requested but that a plan leaves out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    /// Reachable floor that was requested, square metres.
    pub requested_m2: f64,
    /// Whether only a part of the floor was requested.
    pub is_part: bool,
    /// The areas that the plan leaves out, the largest first.
    pub areas: Vec<Area<MissReason>>,
    /// Areas that are too small to be listed.
    pub slivers: Slivers<MissReason>,
    /// Where the scan resumes; `None` if all of the floor was requested, or if the plan scans none of it.
    #[serde(default)]
    pub resumption: Option<Resumption>,
}

impl LeftOut {
    /// The floor of a run that a plan leaves out; `None` if the task is not to scan the floor. `cuts` are the lines
    /// that the tethered robot does not cross; `is_whole` states whether the plan claims to achieve the whole task.
    ///
    /// Visits every cell along the path and every cell of the floor.
    pub fn of(run: &RunOpened, path: &[Point], cuts: &[Vec<Point>], is_whole: bool) -> Option<Self> {
        Self::after(run, &CoverageGrid::new(run.floor.clone()), path, cuts, is_whole)
    }

    /// The same for a plan that is made on the way: floor that the run has `scanned` so far is not left out. The floor of
    /// `scanned` is that of the moment, with the zones drawn since the start.
    pub fn after(
        run: &RunOpened,
        scanned: &CoverageGrid,
        path: &[Point],
        cuts: &[Vec<Point>],
        is_whole: bool,
    ) -> Option<Self> {
        let TaskConfig::Cover { .. } = run.mission.task else { return None };
        let mut evidence = Evidence::new(run);
        let mut grid = scanned.clone();
        for pair in path.windows(2) {
            grid.mark_swath(pair[0], pair[1], run.mission.swath_m);
        }
        evidence.plan(path, cuts, is_whole);
        let floor = scanned.floor();
        let is_requested = |cell: usize| floor.is_reachable(cell) && evidence.is_asked(cell);
        let reasons = evidence.reasons(run);
        let why = |cell: usize| {
            let is_left_out = is_requested(cell) && !grid.is_covered(cell);
            is_left_out.then(|| reasons.why_missed(floor.center(cell), cell))
        };
        let plates = plate_map(run, floor);
        let (areas, slivers) =
            areas(floor, plates.as_ref(), why, |why, cells| reasons.measure(&grid, why, cells));
        let is_part = !evidence.asks_for_everything();
        let resumption = resumes(run, path, &is_requested).filter(|_| is_part).map(|(at, after_m)| {
            let is_again = |cell: &usize| floor.is_reachable(*cell) && !evidence.is_asked(*cell);
            let again = (0..floor.len()).filter(is_again).filter(|cell| grid.is_covered(*cell)).count();
            Resumption { at, after_m, again_m2: again as f64 * floor.cell_m2() }
        });
        let requested = (0..floor.len()).filter(|cell| is_requested(*cell)).count();
        Some(Self { requested_m2: requested as f64 * floor.cell_m2(), is_part, areas, slivers, resumption })
    }

    /// The floor that the plan leaves out, square metres.
    pub fn area_m2(&self) -> f64 {
        self.areas.iter().map(|area| area.area_m2).sum::<f64>() + self.slivers.area_m2
    }

    /// The share of the requested floor that the plan scans, 0 to 1; 1 if nothing was requested.
    pub fn scanned(&self) -> f64 {
        if self.requested_m2 > 0.0 { 1.0 - self.area_m2() / self.requested_m2 } else { 1.0 }
    }
}

/// The point of a path from which on requested floor is scanned, and the length of the path up to that point, metres.
fn resumes(run: &RunOpened, path: &[Point], is_requested: &dyn Fn(usize) -> bool) -> Option<(Point, f64)> {
    let fine = polyline::resampled(path, run.mission.cell_m);
    let scans = |pair: &[Point]| {
        let way = pair[1] - pair[0];
        let at = |position| Pose { position, heading_rad: way.y.atan2(way.x) };
        run.floor.cells_under(run.mission.tool(), at(pair[0]), at(pair[1])).into_iter().any(is_requested)
    };
    let first = fine.windows(2).position(scans)?;
    Some((fine[first], polyline::length_m(&fine[..=first])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::round_tank;

    fn lane(y: f64) -> Vec<Point> {
        vec![Point::new(-3.0, y), Point::new(3.0, y)]
    }

    #[test]
    fn what_a_plan_leaves_out_has_its_place_and_its_reason() {
        let run = round_tank(0.05);
        let left_out = LeftOut::of(&run, &lane(0.0), &[], true).expect("the task is to scan");
        let lane_m2 = 6.0 * 0.6;
        assert!((left_out.requested_m2 - left_out.area_m2() - lane_m2).abs() < 0.5, "{left_out:?}");
        assert!((left_out.scanned() - lane_m2 / left_out.requested_m2).abs() < 0.02);
        assert!(!left_out.is_part);
        let largest = &left_out.areas[0];
        assert_eq!(largest.reason, MissReason::NotPlanned);
        assert!(largest.area_m2 >= left_out.areas.last().map_or(0.0, |area| area.area_m2));
    }

    #[test]
    fn a_plan_made_on_the_way_does_not_leave_out_what_was_scanned_before() {
        let run = round_tank(0.05);
        let first = LeftOut::of(&run, &lane(0.0), &[], true).expect("the task is to scan");
        let mut scanned = CoverageGrid::new(run.floor.clone());
        scanned.mark_swath(lane(0.0)[0], lane(0.0)[1], run.mission.swath_m);
        let after = LeftOut::after(&run, &scanned, &[], &[], true).expect("the task is to scan");
        assert!((after.scanned() - first.scanned()).abs() < 1e-12);
        let both = LeftOut::after(&run, &scanned, &lane(1.0), &[], true).expect("the task is to scan");
        assert!((both.scanned() - 2.0 * first.scanned()).abs() < 0.02, "{both:?}");
    }

    #[test]
    fn floor_beside_the_shell_where_a_lane_has_room_is_not_left_out_for_its_clearance() {
        let run = round_tank(0.05);
        // Lanes straight across leave out sickles along the shell, where a lane along the shell would have room.
        let lanes: Vec<Point> = (0..14).flat_map(|k| lane(-3.9 + 0.6 * f64::from(k))).collect();
        let left_out = LeftOut::of(&run, &lanes, &[], true).expect("the task is to scan");
        let causes: Vec<_> = left_out.areas.iter().flat_map(|area| &area.causes).collect();
        assert!(causes.iter().all(|cause| cause.reason != MissReason::Clearance), "{causes:?}");
        let along = causes.iter().find(|cause| cause.reason == MissReason::NoLaneBeside).expect("a sickle");
        assert!(
            along.text.ends_with(" m from the shell, and no lane of the plan runs along it here"),
            "{}",
            along.text
        );
    }

    #[test]
    fn a_plan_for_a_part_of_the_floor_says_where_the_scan_resumes_and_what_it_scans_again() {
        let mut run = round_tank(0.05);
        let TaskConfig::Cover { regions, .. } = &mut run.mission.task else { panic!("the task is to scan") };
        *regions =
            vec![[(1.0, -2.0), (3.0, -2.0), (3.0, 2.0), (1.0, 2.0)].map(|(x, y)| Point::new(x, y)).to_vec()];
        let left_out = LeftOut::of(&run, &lane(0.0), &[], true).expect("the task is to scan");
        let resumption = left_out.resumption.expect("a part was requested");
        assert!((resumption.at.x - 1.0).abs() < 0.15, "{resumption:?}");
        assert!((resumption.after_m - (resumption.at.x + 3.0)).abs() < 1e-6);
        assert!((resumption.again_m2 - 4.0 * 0.6).abs() < 0.4, "{resumption:?}");
        let whole = LeftOut::of(&round_tank(0.05), &lane(0.0), &[], true).expect("the task is to scan");
        assert_eq!(whole.resumption, None);
    }

    #[test]
    fn only_a_mission_that_scans_leaves_floor_out() {
        let mut run = round_tank(0.1);
        run.mission.task = TaskConfig::Follow { path: lane(0.0), tolerance_m: 0.2 };
        assert_eq!(LeftOut::of(&run, &lane(0.0), &[], true), None);
    }
}
