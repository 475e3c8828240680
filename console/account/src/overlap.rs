//! Floor that the tool scanned again, computed from the estimated track, because the events name a cell only when it is
//! first scanned.

use serde::{Deserialize, Serialize};
use world::{CellRun, Tiles};

/// Distance is counted in steps of half a swath: 65,535 steps are 19 km for a swath of 0.6 m.
const STEPS_PER_SWATH: f64 = 2.0;
/// Number of steps after which a return to a cell counts as a second scan (two swaths).
const AGAIN_STEPS: u16 = 4;

/// Counts how often each cell was scanned again.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Overlap {
    /// Distance driven so far, metres.
    way_m: f64,
    /// Distance driven when each cell was last under the tool, in steps counted from 1; 0 before the first pass.
    last: Tiles<u16>,
    again: Tiles<u8>,
}

impl Overlap {
    /// An empty count for a floor with the given numbers of cells, per row and in total.
    pub fn new(width: usize, cells: usize) -> Self {
        Self { last: Tiles::new(width, cells, 0), again: Tiles::new(width, cells, 0), ..Self::default() }
    }

    /// The number of times that a cell was scanned again.
    pub fn again(&self, index: usize) -> u8 {
        self.again.at(index)
    }

    /// Adds a movement of the tool over some cells; returns the cells to which the tool came back and, for each,
    /// whether this was the first return.
    pub fn pass(
        &mut self,
        way_m: f64,
        swath_m: f64,
        cells: &[CellRun],
        is_scanned: impl Fn(usize) -> bool,
    ) -> Vec<(usize, bool)> {
        let step = |way_m: f64| (way_m * STEPS_PER_SWATH / swath_m) as u16;
        let before = step(self.way_m).saturating_add(1);
        self.way_m += way_m;
        let now = step(self.way_m).saturating_add(1);
        let mut returned = Vec::new();
        let again = &mut self.again;
        for cells in cells {
            self.last.change(cells.range(), |first, lasts| {
                for (last, cell) in lasts.iter_mut().zip(first..) {
                    let last = std::mem::replace(last, now);
                    if last > 0 && before.saturating_sub(last) > AGAIN_STEPS && is_scanned(cell) {
                        let again = again.at_mut(cell);
                        returned.push((cell, *again == 0));
                        *again = again.saturating_add(1);
                    }
                }
            });
        }
        returned
    }

    /// Adds another run on the same floor: a cell that both runs scanned counts as scanned again.
    pub fn join(&mut self, other: &Self, is_in_both: impl Fn(usize) -> bool) {
        for (cell, others) in other.again.iter().enumerate() {
            let twice = u8::from(is_in_both(cell));
            let own = self.again.at_mut(cell);
            *own = own.saturating_add(others).saturating_add(twice);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_coming_back_after_two_swaths_counts() {
        let mut overlap = Overlap::new(3, 3);
        let mut pass = |way_m, cells: &[usize]| {
            let cells: Vec<CellRun> = cells.iter().map(|cell| CellRun(*cell as u32, 1)).collect();
            overlap.pass(way_m, 0.6, &cells, |cell| cell != 2)
        };
        assert_eq!(pass(0.0, &[0, 1, 2]), []);
        assert_eq!(pass(0.3, &[0]), [], "the cell is still under the tool");
        assert_eq!(pass(3.0, &[]), []);
        assert_eq!(pass(0.1, &[0, 1, 2]), [(0, true), (1, true)], "cell 2 never counted as scanned");
        assert_eq!(pass(3.0, &[]), []);
        assert_eq!(pass(0.1, &[1]), [(1, false)]);
        assert_eq!([0, 1, 2].map(|cell| overlap.again(cell)), [1, 2, 0]);
    }
}
