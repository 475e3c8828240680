//! The floor that a re-scan and the runs before it have scanned together.

use super::Raster;
use account::{Account, Regained, Shares};
use mission::{MissionConfig, TaskConfig};
use serde::{Deserialize, Serialize};
use world::{Cell, CellRun, Counts, KindRun, Point, coverage::regions::cells_within};

/// The runs that a re-scan continues.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Continued {
    /// The names of the runs, oldest first.
    pub runs: Vec<String>,
    /// The last estimated position of the robot in the last of them, metres, tank frame; `None` if it is not known.
    pub left_at: Option<Point>,
}

/// The combined scan of several runs, as it is read from their journals.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Combination {
    /// The names of the runs before the re-scan, oldest first.
    pub earlier: Vec<String>,
    /// The account of the floor over all runs.
    pub floor: Account,
    /// The kinds of the cells of this floor: obstacles found and zones drawn in any of the runs are applied.
    #[serde(default)]
    pub kinds: Vec<KindRun>,
    /// The floor whose guarantee was taken back in any of the runs; `None` if no floor lost its guarantee.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub taken_back: Option<Regained>,
    /// The cells that any of the runs scanned.
    pub scanned: Vec<CellRun>,
    /// The cells that none of the runs had to scan.
    #[serde(default)]
    pub not_requested: Vec<CellRun>,
}

/// The combined scan of several runs, ready for drawing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Together {
    /// The names of the runs before the re-scan, oldest first.
    pub earlier: Vec<String>,
    /// The account of the floor over all runs.
    pub floor: Account,
    /// The floor whose guarantee was taken back in any of the runs; `None` if no floor lost its guarantee.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub taken_back: Option<Regained>,
    /// The floor that any of the runs scanned; `None` if the re-scan scans no floor.
    pub raster: Option<Raster>,
    /// The cells that none of the runs had to scan.
    #[serde(default)]
    not_requested: Vec<CellRun>,
}

impl Together {
    /// Adds what the earlier runs found and scanned to the floor of the re-scan.
    pub fn new(combination: Combination, own: Option<&Raster>) -> Self {
        let Combination { earlier, floor, kinds, taken_back, scanned, not_requested } = combination;
        let raster = own.map(|own| joined(own, &kinds, &scanned));
        Self { earlier, floor, taken_back, raster, not_requested }
    }

    /// For each cell of the floor, whether none of the runs had to scan it. Empty if the whole floor was requested.
    pub fn not_requested(&self) -> Vec<bool> {
        let cells = self.raster.as_ref().filter(|_| !self.not_requested.is_empty());
        let mut marked = vec![false; cells.map_or(0, |raster| raster.floor().len())];
        mark(&self.not_requested, &mut marked);
        marked
    }

    /// The runs before the re-scan, in words: `the run before it`.
    pub fn before(&self) -> String {
        match self.earlier.len() {
            1 => "the run before it".to_owned(),
            n => format!("the {n} runs before it"),
        }
    }
}

/// Marks the cells in runs of cells; cells beyond the end are ignored.
pub(crate) fn mark(runs: &[CellRun], marked: &mut [bool]) {
    for CellRun(first, count) in runs {
        let end = (*first as usize).saturating_add(*count as usize).min(marked.len());
        let first = (*first as usize).min(end);
        marked[first..end].fill(true);
    }
}

/// The floor that the runs before a re-scan have scanned, beside the floor that the re-scan scans now.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Earlier {
    /// The names of the runs, oldest first.
    pub runs: Vec<String>,
    /// The floor that they have scanned.
    pub raster: Raster,
    /// The cells that the re-scan is to scan; `None` if it is to scan all of the floor.
    asked: Option<Vec<bool>>,
    /// The cells that none of the runs had to scan; empty if the whole floor was requested.
    #[serde(default)]
    not_requested: Vec<CellRun>,
}

impl Earlier {
    /// The floor that the runs before a re-scan have scanned; `own` is the floor of the re-scan.
    pub fn new(combination: &Combination, own: &Raster, mission: &MissionConfig) -> Self {
        let raster = joined(&Raster::new(own.floor().clone()), &combination.kinds, &combination.scanned);
        let asked = match &mission.task {
            TaskConfig::Cover { regions, .. } => cells_within(own.floor(), regions),
            TaskConfig::Goto { .. } | TaskConfig::Follow { .. } | TaskConfig::Survey { .. } => None,
        };
        let not_requested = combination.not_requested.clone();
        Self { runs: combination.earlier.clone(), raster, asked, not_requested }
    }

    /// Two shares: of the floor that the re-scan was to scan, as far as the re-scan alone has scanned it, and of the
    /// reachable floor that any run was to scan, as far as all runs together have scanned it.
    ///
    /// Cost: a look at every cell.
    pub fn shares(&self, own: &Raster) -> [Shares; 2] {
        let is_asked = |cell: usize| self.asked.as_ref().is_none_or(|asked| asked.get(cell) == Some(&true));
        let (requested, mut all) = (own.counts_of(is_asked), Counts::default());
        let mut is_left_out = vec![false; own.floor().len()];
        mark(&self.not_requested, &mut is_left_out);
        let asked_now = |cell: usize| self.asked.is_some() && is_asked(cell);
        for cell in (0..own.floor().len()).filter(|cell| !is_left_out[*cell] || asked_now(*cell)) {
            let (kind, is_scanned) = (own.floor().kind(cell), own.is_scanned(cell));
            let kind = match self.raster.floor().kind(cell) {
                Cell::Reachable => kind,
                closed => closed,
            };
            all.add(kind, is_scanned || self.raster.is_scanned(cell));
        }
        [requested, all.of_reachable()].map(|counts| Shares::of(counts, own.floor().cell_m2()))
    }
}

/// The floor of a re-scan with the kinds of the joined floor and all scanned cells.
fn joined(own: &Raster, kinds: &[KindRun], scanned: &[CellRun]) -> Raster {
    let mut raster = own.clone();
    raster.change(kinds);
    raster.apply(scanned);
    raster
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::{Boundary, Floor, World};

    #[test]
    fn floor_that_only_an_earlier_run_closed_is_closed_on_the_map() {
        let boundary = Boundary::Circle { radius_m: 3.0 };
        let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
        let own = Floor::new(&tank, 0.1, 0.3, 0.6, Point::origin());
        let closed = Floor::new(&tank, 0.1, 1.0, 0.6, Point::origin());
        assert_ne!(own, closed);
        let scanned = [CellRun(0, own.len() as u32)];
        let raster = joined(&Raster::new(own), &closed.kinds(), &scanned);
        assert_eq!(raster.floor(), &closed);
        let mut expected = Raster::new(closed);
        expected.apply(&scanned);
        assert_eq!(raster.reachable(), expected.reachable());
    }

    #[test]
    fn floor_that_no_run_had_to_scan_is_not_missed() {
        let boundary = Boundary::Circle { radius_m: 3.0 };
        let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
        let floor = Floor::new(&tank, 0.1, 0.3, 0.6, Point::origin());
        let (half, all) = ((floor.len() / 2) as u32, floor.len() as u32);
        let own = Raster::new(floor.clone());
        let mut earlier = Earlier {
            runs: vec!["first".into()],
            raster: joined(&own, &[], &[CellRun(0, half)]),
            asked: Some((0..floor.len()).map(|cell| cell < half as usize).collect()),
            not_requested: vec![CellRun(half, all - half)],
        };
        let missed = |earlier: &Earlier| earlier.shares(&own)[1].percent.missed;
        assert!(missed(&earlier).abs() < 1e-9, "{}", missed(&earlier));
        // What this re-scan is to scan counts although no run before it had to scan it.
        earlier.asked = Some((0..floor.len()).map(|cell| cell >= half as usize).collect());
        assert!((missed(&earlier) - 50.0).abs() < 2.0, "{}", missed(&earlier));
        earlier.not_requested.clear();
        assert!((missed(&earlier) - 50.0).abs() < 2.0, "{}", missed(&earlier));
    }

    #[test]
    fn a_re_scan_counts_its_own_floor_and_that_of_all_runs() {
        let boundary = Boundary::Circle { radius_m: 3.0 };
        let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
        let floor = Floor::new(&tank, 0.1, 0.3, 0.6, Point::origin());
        let half = (floor.len() / 2) as u32;
        let mut own = Raster::new(floor.clone());
        let earlier = Earlier {
            runs: vec!["first".into()],
            raster: joined(&own, &[], &[CellRun(0, half)]),
            asked: Some((0..floor.len()).map(|cell| cell >= half as usize).collect()),
            not_requested: Vec::new(),
        };
        let percent = |own: &Raster| earlier.shares(own).map(|shares| shares.percent.scanned);
        // Floor scanned on the way, which was not requested, does not count.
        let mut beside = own.clone();
        beside.apply(&[CellRun(0, half)]);
        assert!(percent(&beside)[0].abs() < 1e-9, "{:?}", percent(&beside));
        let [requested, all] = percent(&own);
        assert!(requested.abs() < 1e-9 && (all - 50.0).abs() < 2.0, "{requested} {all}");
        let quarter = half + half / 2;
        own.apply(&[CellRun(half, quarter - half)]);
        let [requested, all] = percent(&own);
        // The half that was scanned before, and the requested half.
        assert!((all - (50.0 + requested / 2.0)).abs() < 2.0 && requested > 40.0, "{requested} {all}");
        own.apply(&[CellRun(quarter, floor.len() as u32)]);
        let all = percent(&own);
        assert!(all.iter().all(|share| (share - 100.0).abs() < 1e-9), "everything has been scanned: {all:?}");
        assert!(
            (own.reachable().percent.scanned - 50.0).abs() < 2.0,
            "of the whole floor, the re-scan alone"
        );
    }
}
