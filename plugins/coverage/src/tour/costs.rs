//! The costs of the connectors computed so far.

use rustc_hash::FxHashMap;

/// Index of a lane end: `2 * lane` is its first point, `2 * lane + 1` its last. Two more ends follow the last lane:
/// home, where the tour ends, and the start.
pub(crate) type End = usize;

/// A tour: the end at which each lane is entered, home first.
pub(crate) type Tour = Vec<End>;

/// Relative error of a cost in single precision.
pub(super) const ROUNDING: f64 = 1e-6;
/// Maximum number of ends for which the costs are kept in a table.
const TABLE: usize = 1600;

/// Costs by pairs of ends, the smaller end first. The last two ends are home and start.
#[derive(Default)]
pub(crate) struct Costs {
    ends: usize,
    /// All pairs, NaN where the cost is not known; empty if there are too many ends.
    table: Vec<f32>,
    /// The known pairs if there are too many ends for the table.
    map: FxHashMap<u64, f32>,
}

impl Costs {
    /// The same costs, with space for `ends` ends, at least as many as now. New ends come before home and start.
    pub(super) fn with_ends(self, ends: usize) -> Self {
        if self.ends == ends {
            return self;
        }
        let table = if ends <= TABLE { vec![f32::NAN; ends * ends] } else { Vec::new() };
        let mut costs = Self { ends, table, map: FxHashMap::default() };
        let moved = |end: End| if end + 2 < self.ends { end } else { end + ends - self.ends };
        for (place, cost) in self.table.iter().enumerate().filter(|(_, cost)| !cost.is_nan()) {
            costs.set(moved(place / self.ends), moved(place % self.ends), *cost);
        }
        for (pair, cost) in &self.map {
            costs.set(moved((pair >> 32) as End), moved((pair & u64::from(u32::MAX)) as End), *cost);
        }
        costs
    }

    pub(super) fn get(&self, u: End, v: End) -> Option<f32> {
        if self.table.is_empty() {
            self.map.get(&pair(u, v)).copied()
        } else {
            Some(self.table[u * self.ends + v]).filter(|cost| !cost.is_nan())
        }
    }

    pub(super) fn set(&mut self, u: End, v: End, cost: f32) {
        if self.table.is_empty() {
            self.map.insert(pair(u, v), cost);
        } else {
            self.table[u * self.ends + v] = cost;
        }
    }
}

fn pair(u: End, v: End) -> u64 {
    (u as u64) << 32 | v as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn costs_stay_with_their_ends_when_lanes_are_added() {
        for (before, after) in [(6, 10), (TABLE - 2, TABLE + 4), (TABLE + 2, TABLE + 8)] {
            let mut costs = Costs::default().with_ends(before);
            let (home, start) = (before - 2, before - 1);
            costs.set(1, 3, 4.5);
            costs.set(0, home, 2.0);
            costs.set(home, start, 7.0);
            let costs = costs.with_ends(after);
            assert_eq!(costs.get(1, 3), Some(4.5));
            assert_eq!(costs.get(0, after - 2), Some(2.0));
            assert_eq!(costs.get(after - 2, after - 1), Some(7.0));
            assert_eq!(costs.get(0, home), None);
        }
    }
}
