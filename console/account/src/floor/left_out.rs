//! Requested floor that a plan does not scan, with the reasons, before anything moves.

use super::{Area, Evidence, MissReason, Slivers, areas, plate_map};
use crate::estimate::scanned_along;
use mission::{TaskConfig, event::RunOpened};
use serde::{Deserialize, Serialize};
use world::Point;

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
}

impl LeftOut {
    /// The floor of a run that a plan leaves out; `None` if the task is not to scan the floor. `cuts` are the lines
    /// that the tethered robot does not cross; `is_whole` states whether the plan claims to achieve the whole task.
    ///
    /// Visits every cell along the path and every cell of the floor.
    pub fn of(run: &RunOpened, path: &[Point], cuts: &[Vec<Point>], is_whole: bool) -> Option<Self> {
        let TaskConfig::Cover { .. } = run.mission.task else { return None };
        let mut evidence = Evidence::new(run);
        let grid = scanned_along(run.floor.clone(), path, run.mission.swath_m);
        evidence.plan(path, cuts, is_whole);
        let floor = &run.floor;
        let is_requested = |cell: usize| floor.is_reachable(cell) && evidence.is_asked(cell);
        let reasons = evidence.reasons(run);
        let why = |cell: usize| {
            let is_left_out = is_requested(cell) && !grid.is_covered(cell);
            is_left_out.then(|| reasons.why_missed(floor.center(cell), cell))
        };
        let plates = plate_map(run, floor);
        let (areas, slivers) =
            areas(floor, plates.as_ref(), why, |why, cells| reasons.measure(&grid, why, cells));
        let requested = (0..floor.len()).filter(|cell| is_requested(*cell)).count();
        Some(Self {
            requested_m2: requested as f64 * floor.cell_m2(),
            is_part: !evidence.asks_for_everything(),
            areas,
            slivers,
        })
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
    fn only_a_mission_that_scans_leaves_floor_out() {
        let mut run = round_tank(0.1);
        run.mission.task = TaskConfig::Follow { path: lane(0.0), tolerance_m: 0.2 };
        assert_eq!(LeftOut::of(&run, &lane(0.0), &[], true), None);
    }
}
