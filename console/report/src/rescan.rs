//! Selects the floor that is worth a re-scan after one or more runs.

mod text;

use crate::{
    joined::{Joined, joined, require_scans},
    past_run::PastRun,
};
use account::{Area, MissReason, area_of, areas as areas_of, plate_map, updated_floor};
use std::collections::{BTreeSet, VecDeque};
use world::{Floor, ObstacleId, Point, Zone, coverage::regions};

/// Distance, as a share of the swath, below which missed areas are merged.
const TOGETHER_SWATHS: f64 = 0.5;
/// Width of the floor around a missed area that is re-scanned with it, as a share of the swath: a robot cannot steer
/// more precisely than this.
const AROUND_SWATHS: f64 = 0.25;
/// Width of the blocks that make up the boxes, as a share of the swath.
const BLOCK_SWATHS: f64 = 0.2;

/// The floor to re-scan, and the floor that is not worth it.
#[derive(Debug, Clone, PartialEq)]
pub struct Rescan {
    /// Boxes to scan: south-west and north-east corners, metres.
    pub boxes: Vec<[Point; 2]>,
    /// The missed areas in the boxes, the largest first.
    pub areas: Vec<Area<MissReason>>,
    /// Missed areas that are too small to scan, the largest first.
    pub left: Vec<Area<MissReason>>,
    /// Missed areas that no lane reaches, the largest first: another scan would miss them again, whatever the
    /// original reason.
    pub out_of_reach: Vec<Area<MissReason>>,
    /// Missed floor that none of the runs had to scan, square metres.
    pub not_asked_m2: f64,
    /// Obstacles that the runs found.
    pub found: BTreeSet<ObstacleId>,
    /// All zones of the last run.
    pub zones: Vec<Zone>,
}

/// Finds the floor to re-scan.
///
/// Missed floor that no lane reaches is listed separately. In the remaining missed floor, neighbouring areas are
/// merged, and merged areas smaller than `min_area_m2` are omitted. The areas that are kept are enlarged by a margin,
/// because a robot cannot steer more precisely than that. There are at most `most` boxes; the smaller that number, the
/// coarser the boxes.
///
/// # Errors
/// See [`crate::merged()`].
pub fn rescan(runs: &[PastRun], min_area_m2: f64, most: usize) -> Result<Rescan, String> {
    require_scans(runs)?;
    let Joined { run, scanned, evidence } = joined(runs)?;
    let grid = scanned.believed();
    let floor = grid.floor();
    let is_in_doubt = |index: usize| grid.is_covered(index) && scanned.passes().is_in_doubt(index);
    let is_missed =
        |index: usize| floor.is_reachable(index) && (!grid.is_covered(index) || is_in_doubt(index));
    let lanes = updated_floor(run, floor, &evidence, run.mission.lane_m()).into_floor();
    let (swath_m, reasons) = (run.mission.swath_m, evidence.reasons(run));
    let is_asked = |index: usize| is_missed(index) && evidence.is_asked(index);
    let why_missed = |index: usize| {
        let missed = || reasons.why_missed(floor.center(index), index);
        if is_in_doubt(index) { MissReason::InDoubt } else { missed() }
    };
    let no_lane = |index: usize| {
        let is_narrow = || !lanes.is_reachable(index) || reasons.beyond_lanes_m(floor.center(index)) > 0.0;
        match why_missed(index) {
            MissReason::BeyondReel => Some(MissReason::BeyondReel),
            MissReason::InDoubt => None,
            _ => is_narrow().then_some(MissReason::Narrow),
        }
    };
    let no_lane: Vec<Option<MissReason>> =
        (0..floor.len()).map(|index| is_asked(index).then(|| no_lane(index)).flatten()).collect();
    let is_wanted = |index: usize| is_asked(index) && no_lane[index].is_none();
    let not_asked = (0..floor.len()).filter(|index| is_missed(*index) && !evidence.is_asked(*index)).count();
    let plates = plate_map(run, floor);
    let measure = |why, cells: &[usize]| reasons.measure(grid, why, cells);
    let (out_of_reach, _) = areas_of(floor, plates.as_ref(), |index| no_lane[index], measure);
    let (mut taken, mut areas, mut left) = (vec![false; floor.len()], Vec::new(), Vec::new());
    for cells in clusters(floor, TOGETHER_SWATHS * swath_m, is_wanted) {
        let area = area_of(floor, plates.as_ref(), &cells, why_missed, measure);
        if area.area_m2 < min_area_m2 {
            left.push(area);
        } else {
            areas.push(area);
            for index in cells {
                taken[index] = true;
            }
        }
    }
    for list in [&mut areas, &mut left] {
        list.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2));
    }
    let around = around(floor, &taken, AROUND_SWATHS * swath_m);
    let is_in = |index: usize| around[index] && floor.is_reachable(index);
    let finest = ((BLOCK_SWATHS * swath_m / floor.cell_m).round() as usize).max(1);
    let boxes = (0..8).map(|fold| regions::boxes(floor, finest << fold, is_in));
    let boxes = boxes.into_iter().find(|boxes| boxes.len() <= most).unwrap_or_default();
    Ok(Rescan {
        boxes: boxes.iter().map(|corners| [corners[0], corners[2]]).collect(),
        areas,
        left,
        out_of_reach,
        not_asked_m2: not_asked as f64 * floor.cell_m2(),
        found: evidence.found().map(|(id, _)| id).collect(),
        zones: run.world.zones.clone(),
    })
}

/// Groups the selected cells: a cell is in one group with all selected cells within a given distance. The groups are
/// in order of their first cells.
fn clusters(floor: &Floor, within_m: f64, is_wanted: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
    let mut open: Vec<bool> = (0..floor.len()).map(is_wanted).collect();
    let mut found = Vec::new();
    for first in 0..floor.len() {
        if !open[first] {
            continue;
        }
        open[first] = false;
        let (mut cells, mut queue) = (Vec::new(), VecDeque::from([first]));
        while let Some(index) = queue.pop_front() {
            cells.push(index);
            let center = floor.center(index);
            for near in floor.cells_near(center, center, within_m) {
                if std::mem::take(&mut open[near]) {
                    queue.push_back(near);
                }
            }
        }
        cells.sort_unstable();
        found.push(cells);
    }
    found
}

/// The cells within a given distance of selected cells.
fn around(floor: &Floor, taken: &[bool], within_m: f64) -> Vec<bool> {
    let mut around = taken.to_vec();
    let width = floor.width;
    let is_inner = |index: usize| {
        let (column, row) = (index % width, index / width);
        let inside = column > 0 && column + 1 < width && row > 0 && row + 1 < floor.height;
        inside && [index - 1, index + 1, index - width, index + width].iter().all(|next| taken[*next])
    };
    for index in (0..floor.len()).filter(|index| taken[*index] && !is_inner(*index)) {
        let center = floor.center(index);
        floor.cells_near(center, center, within_m).into_iter().for_each(|near| around[near] = true);
    }
    around
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use crate::{document::Files, record::Record, samples::round_tank};
    use account::{Fold, Logs};
    use mission::{Event, EventKind};
    use world::{CellRun, coverage::runs_of};

    /// A run that scanned all floor except some discs, each given by its centre and radius.
    fn all_but(missed: &[(f64, f64, f64)]) -> PastRun {
        let run = round_tank(0.05);
        let is_scanned = |index: &usize| {
            let center = run.floor.center(*index);
            missed.iter().all(|(x, y, radius_m)| (center - Point::new(*x, *y)).norm() > *radius_m)
        };
        let runs = runs_of((0..run.floor.len()).filter(is_scanned));
        with(run, runs)
    }

    fn with(run: mission::RunOpened, runs: Vec<CellRun>) -> PastRun {
        let mut fold = Fold::new();
        for kind in [EventKind::RunOpened(Box::new(run)), EventKind::Covered { runs }] {
            fold.apply(&Event { tick: 0, t_s: 0.0, kind });
        }
        let logs = Logs { journal: None, recording: None, error: None, is_open: false };
        let (files, record, summary) = (Files::default(), Record::new(), fold.summary());
        PastRun { name: "a".into(), logs, began: None, files, fold, summary, record, imported: None }
    }

    fn holds(rescan: &Rescan, x: f64, y: f64) -> bool {
        let inside = |[low, high]: &[Point; 2]| low.x <= x && x <= high.x && low.y <= y && y <= high.y;
        rescan.boxes.iter().any(inside)
    }

    #[test]
    fn a_gap_is_grown_to_what_a_robot_can_aim_at() {
        let rescan = rescan(&[all_but(&[(1.0, -1.0, 0.3)])], 0.05, 1000).unwrap();
        assert!(rescan.areas.len() == 1 && rescan.left.is_empty(), "{rescan:?}");
        assert!(holds(&rescan, 1.0, -1.0) && holds(&rescan, 1.35, -1.0) && !holds(&rescan, 1.7, -1.0));
        assert_eq!(rescan.areas[0].plate.as_deref().map(|name| &name[..1]), Some("R"));
    }

    #[test]
    fn slivers_beside_each_other_are_one_area_and_a_lone_speck_is_left_with_its_reason() {
        let slivers: Vec<_> = (0..8).map(|k| (-1.0 + 0.2 * f64::from(k), -1.0, 0.06)).collect();
        let speck = [(2.0, 1.0, 0.06)];
        let rescan = rescan(&[all_but(&[&slivers[..], &speck[..]].concat())], 0.05, 1000).unwrap();
        assert!(rescan.areas.len() == 1 && rescan.left.len() == 1, "{rescan:?}");
        assert!((rescan.left[0].at - Point::new(2.0, 1.0)).norm() < 0.06 && !holds(&rescan, 2.0, 1.0));
        assert!(rescan.areas[0].area_m2 > 0.05 && holds(&rescan, -0.1, -1.0), "{rescan:?}");
    }

    #[test]
    fn nothing_is_to_be_done_where_nothing_was_missed_and_boxes_are_never_too_many() {
        let none = rescan(&[all_but(&[])], 0.05, 1000).unwrap();
        assert!(none.boxes.is_empty() && none.areas.is_empty() && none.left.is_empty());
        let half = rescan(&[with(round_tank(0.05), vec![CellRun(0, 200 * 100)])], 0.05, 20).unwrap();
        assert!((1..=20).contains(&half.boxes.len()), "{}", half.boxes.len());
    }

    #[test]
    fn specks_that_lanes_less_the_overlap_do_not_reach_are_reported_and_not_offered() {
        let mut run = round_tank(0.05);
        run.mission.scan.overlap_m = 0.2;
        // The hull keeps 0.45 m from the shell. A bar of 0.4 m therefore ends 0.25 m from the shell, and a bar of 0.6 m
        // ends 0.15 m from it.
        let is_missed = |index: &usize| {
            let center = run.floor.center(*index);
            let beside_shell = center.x > 4.6 && center.y.abs() < 1.0 && center.coords.norm() > 4.78;
            beside_shell || (center - Point::new(1.0, -1.0)).norm() < 0.2
        };
        let runs = runs_of((0..run.floor.len()).filter(|index| !is_missed(index)));
        let rescan = rescan(&[with(run, runs)], 0.05, 1000).unwrap();
        assert!(
            rescan.areas.len() == 1 && holds(&rescan, 1.0, -1.0) && !holds(&rescan, 4.8, 0.0),
            "{rescan:?}"
        );
        let reasons: Vec<MissReason> = rescan.out_of_reach.iter().map(|area| area.reason).collect();
        assert!(!reasons.is_empty() && reasons.iter().all(|why| *why == MissReason::Narrow), "{rescan:?}");
        assert!(rescan.out_of_reach[0].at.x > 4.6, "{rescan:?}");
    }

    #[test]
    fn what_nobody_asked_for_is_not_scanned_again() {
        let mut run = round_tank(0.05);
        run.mission.task = mission::TaskConfig::Cover {
            anchor: Point::origin(),
            regions: vec![regions::square(Point::new(0.0, -2.0), 1.0)],
            tolerance_m: 0.2,
        };
        let rescan = rescan(&[with(run, vec![])], 0.05, 1000).unwrap();
        assert!(holds(&rescan, 0.0, -2.0) && !holds(&rescan, 0.0, 2.0));
        assert!(rescan.not_asked_m2 > 60.0 && rescan.areas.len() == 1, "{rescan:?}");
    }
}
