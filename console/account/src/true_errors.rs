//! The true position error on each cell of the floor.

use crate::passes::nearest_mm;
use world::CellRun;

/// The error of a cell that the tool never passed.
const NEVER: u16 = u16::MAX;

/// The largest true position error with which the tool passed each cell.
#[derive(Debug, Clone)]
pub(crate) struct TrueErrors {
    /// Millimetres.
    largest_mm: Vec<u16>,
    /// The cells of the latest true movement.
    latest: Vec<CellRun>,
}

impl TrueErrors {
    /// A floor of this many cells on which the tool has passed none.
    pub(crate) fn new(cells: usize) -> Self {
        Self { largest_mm: vec![NEVER; cells], latest: Vec::new() }
    }

    /// Adds a true movement over these cells; its error follows.
    pub(crate) fn pass(&mut self, cells: Vec<CellRun>) {
        self.latest = cells;
    }

    /// Adds the error on the latest true movement, metres.
    pub(crate) fn note(&mut self, error_m: f64) {
        let error_mm = nearest_mm(error_m).min(NEVER - 1);
        for run in std::mem::take(&mut self.latest) {
            for mm in &mut self.largest_mm[run.range()] {
                *mm = if *mm == NEVER { error_mm } else { error_mm.max(*mm) };
            }
        }
    }

    /// Adds the errors of another run on the same floor.
    pub(crate) fn join(&mut self, other: &Self) {
        for (own, other) in self.largest_mm.iter_mut().zip(&other.largest_mm) {
            *own = match (*own, *other) {
                (NEVER, only) | (only, NEVER) => only,
                (one, other) => one.max(other),
            };
        }
    }

    /// The largest error on a cell, millimetres; `None` if the tool never passed it.
    pub(crate) fn mm(&self, cell: usize) -> Option<u16> {
        Some(self.largest_mm[cell]).filter(|mm| *mm != NEVER)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(start: usize, n: usize) -> Vec<CellRun> {
        serde_json::from_value(serde_json::json!([[start, n]])).unwrap_or_default()
    }

    #[test]
    fn each_cell_keeps_its_largest_error_in_any_order_and_in_any_run() {
        let mut errors = TrueErrors::new(6);
        errors.pass(cells(0, 3));
        errors.note(0.1204);
        errors.pass(cells(2, 2));
        errors.note(0.05);
        errors.note(9.0);
        let found = |errors: &TrueErrors| (0..6).map(|cell| errors.mm(cell)).collect::<Vec<_>>();
        assert_eq!(found(&errors), [Some(120), Some(120), Some(120), Some(50), None, None]);
        let mut other = TrueErrors::new(6);
        other.pass(cells(3, 2));
        other.note(0.08);
        errors.join(&other);
        assert_eq!(found(&errors), [Some(120), Some(120), Some(120), Some(80), Some(80), None]);
    }
}
