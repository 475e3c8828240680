//! Counts, cell by cell, what a path scans.

mod bar;
mod raster;
mod reachable;
#[cfg(test)]
mod tests;

pub(crate) use bar::Run;
pub(crate) use raster::Grain;
use raster::Raster;
pub(crate) use reachable::ReachableFloor;
use world::Point;

/// Initial count of a cell that the tool cannot reach: so high that the count never falls to 1 or 0, and no extra check
/// is needed.
const OUT_OF_REACH: u16 = 1 << 15;

/// Reachable floor with the number of times that each cell was swept.
#[derive(Clone)]
pub(crate) struct SweptFloor {
    pub floor: ReachableFloor,
    /// Number of times each cell was swept; [`OUT_OF_REACH`] or more for cells that the tool cannot reach.
    swept: Vec<u16>,
    /// Number of reachable cells that were swept.
    n_swept: usize,
    /// For each cell, the number of the last quick check that touched it; and the number of checks so far.
    stamps: Vec<u32>,
    n_looks: u32,
    /// Number of exchanges so far.
    pub n_exchanges: u32,
}

impl SweptFloor {
    /// Creates a floor on which nothing has been swept.
    pub(crate) fn new(floor: ReachableFloor) -> Self {
        let n = floor.cells.len();
        let begin = |is_reachable: &bool| if *is_reachable { 0 } else { OUT_OF_REACH };
        let swept = floor.cells.iter().map(begin).collect();
        Self { floor, swept, n_swept: 0, stamps: vec![0; n], n_looks: 0, n_exchanges: 0 }
    }

    /// Sweeps the floor along a path.
    pub(crate) fn sweep(&mut self, path: &[Point]) {
        let swept = &mut self.swept;
        self.floor.raster.along(path, |cells| swept[cells].iter_mut().for_each(|n| *n = n.saturating_add(1)));
        self.n_swept = swept.iter().filter(|n| (1..OUT_OF_REACH).contains(*n)).count();
    }

    pub(crate) fn coverage(&self) -> f64 {
        self.n_swept as f64 / self.floor.n.max(1) as f64
    }

    /// The number of swept cells that may be lost before the swept share falls below this value.
    pub(crate) fn spare(&self, share: f64) -> i64 {
        (self.n_swept as f64 - share * self.floor.n as f64).floor().max(0.0) as i64
    }

    /// The swept share of a part of the floor.
    pub(crate) fn coverage_of(&self, part: &ReachableFloor) -> f64 {
        let swept =
            self.swept.iter().zip(part.cells.iter()).filter(|(n, is_meant)| **n > 0 && **is_meant).count();
        swept as f64 / part.n.max(1) as f64
    }

    /// The number of swept reachable cells outside a part of the floor.
    pub(crate) fn n_swept_beside(&self, part: &ReachableFloor) -> usize {
        let is_swept = |n: u16| (1..OUT_OF_REACH).contains(&n);
        self.swept
            .iter()
            .zip(part.cells.iter())
            .filter(|(n, is_in_part)| is_swept(**n) && !**is_in_part)
            .count()
    }

    /// Groups of neighbouring cells that are reachable but not swept, largest first.
    pub(crate) fn missed(&self) -> Vec<Vec<usize>> {
        self.raster().groups(|cell| self.is_missed(cell))
    }

    /// Whether a cell is reachable but not swept.
    pub(crate) fn is_missed(&self, cell: usize) -> bool {
        self.swept[cell] == 0
    }

    /// The raster of the cells.
    pub(crate) fn raster(&self) -> &Raster {
        &self.floor.raster
    }

    /// Whether a position is reachable floor that was swept exactly once.
    pub(crate) fn is_swept_once(&self, at: Point) -> bool {
        let cell = self.raster().cell_at(at);
        cell.is_some_and(|cell| self.swept[cell] == 1)
    }

    /// The number of reachable cells in some runs that were swept exactly this often. A cell in several runs is counted
    /// several times.
    pub(crate) fn count(&self, often: u16, runs: &[Run]) -> u32 {
        let count = |cells: std::ops::Range<usize>| {
            self.swept[cells].iter().map(|n| u16::from(*n == often)).sum::<u16>()
        };
        runs.iter().map(|run| u32::from(count(run.cells()))).sum()
    }

    /// The number of reachable cells that a path would sweep for the first time.
    pub(crate) fn would_gain(&self, path: &[Point]) -> usize {
        let mut seen = std::collections::BTreeSet::new();
        self.raster().along(path, |cells| seen.extend(cells.filter(|cell| self.is_missed(*cell))));
        seen.len()
    }
}

/// The effect on the floor of exchanging sweeps.
struct Exchanged {
    /// Net number of reachable cells lost.
    lost: i64,
    /// Whether every reachable cell had at least as many sweeps as were removed from it.
    is_sound: bool,
}

impl SweptFloor {
    /// Removes one sweep and adds another. Returns the net number of reachable cells lost.
    pub(crate) fn exchange(&mut self, old: &[Run], new: &[Run]) -> i64 {
        self.exchanged(old, new).lost
    }

    /// Returns the result of [`Self::exchange`] and undoes the exchange.
    pub(crate) fn lost_by(&mut self, old: &[Run], new: &[Run]) -> i64 {
        let before = self.n_swept;
        let Exchanged { lost, is_sound } = self.exchanged(old, new);
        if !is_sound {
            // Some cells had fewer sweeps than were removed from them, so cells must be counted while undoing, too.
            self.exchanged(new, old);
            return lost;
        }
        for run in old {
            self.swept[run.cells()].iter_mut().for_each(|n| *n = n.saturating_add(1));
        }
        for run in new {
            self.swept[run.cells()].iter_mut().for_each(|n| *n = n.saturating_sub(1));
        }
        self.n_swept = before;
        lost
    }

    fn exchanged(&mut self, old: &[Run], new: &[Run]) -> Exchanged {
        self.n_exchanges += 1;
        let (mut won, mut left, mut unswept) = (0_usize, 0_usize, 0_usize);
        // The number of cells in a run fits into 16 bits; narrower counters let more additions run in parallel.
        for cells in new.iter().map(|run| run.cells()) {
            let mut fresh = 0_u16;
            for n in &mut self.swept[cells] {
                fresh += u16::from(*n == 0);
                *n = n.saturating_add(1);
            }
            won += usize::from(fresh);
        }
        for cells in old.iter().map(|run| run.cells()) {
            let (mut empty, mut was_empty) = (0_u16, 0_u16);
            for n in &mut self.swept[cells] {
                was_empty += u16::from(*n == 0);
                *n = n.saturating_sub(1);
                empty += u16::from(*n == 0);
            }
            left += usize::from(empty);
            unswept += usize::from(empty - was_empty);
        }
        self.n_swept = self.n_swept + won - unswept;
        Exchanged { lost: left as i64 - won as i64, is_sound: left == unswept }
    }

    /// A quick check whether replacing one sweep with another certainly loses more than `most` reachable cells, net. It
    /// stops as soon as this is certain. The old sweep is given as the runs of each side of the path.
    pub(crate) fn loses_more<'a>(
        &mut self,
        old: impl IntoIterator<Item = &'a [Run]>,
        new: &[Run],
        most: i64,
    ) -> bool {
        self.n_looks += 1;
        let look = self.n_looks;
        let mut lost = 0_i64;
        for run in new {
            for cell in run.cells() {
                lost -= i64::from(self.stamps[cell] != look && self.is_missed(cell));
                self.stamps[cell] = look;
            }
        }
        old.into_iter().any(|side| {
            for run in side {
                for cell in run.cells() {
                    lost += i64::from(self.swept[cell] == 1 && self.stamps[cell] != look);
                }
            }
            lost > most
        }) || lost > most
    }
}
