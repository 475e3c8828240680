//! What floor counts as, for everybody who shows or writes it.

use super::Cell;

/// What a cell counts as. Characters and colours are with those who draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FloorClass {
    /// No floor.
    Outside,
    /// In reach and not scanned, while the mission lasts.
    ToDo,
    /// In reach and not scanned when the mission has ended.
    Missed,
    /// Scanned.
    Scanned,
    /// Scanned more than once.
    Again,
    /// Scanned in part; never a single cell.
    Partial,
    /// Out of reach along the shell.
    Margin,
    /// Out of reach elsewhere.
    Unreachable,
}

impl FloorClass {
    /// What a cell of some kind counts as that was scanned so often, while the mission lasts.
    ///
    /// ```
    /// use world::{Cell, FloorClass};
    /// assert_eq!(FloorClass::of(Cell::Reachable, 0).when_over(), FloorClass::Missed);
    /// assert_eq!(FloorClass::of(Cell::NoGo, 2), FloorClass::Again);
    /// ```
    pub fn of(kind: Cell, times: u32) -> Self {
        match (kind, times) {
            (Cell::Outside, _) => Self::Outside,
            (_, 1) => Self::Scanned,
            (_, 2..) => Self::Again,
            (Cell::Reachable, 0) => Self::ToDo,
            (Cell::Margin, 0) => Self::Margin,
            (Cell::Unreachable | Cell::Beside | Cell::NoGo, 0) => Self::Unreachable,
        }
    }

    /// The same when the mission has ended that was to scan the floor.
    #[must_use]
    pub fn when_over(self) -> Self {
        if self == Self::ToDo { Self::Missed } else { self }
    }

    /// Whether all or some of it was scanned.
    pub fn is_scanned(self) -> bool {
        matches!(self, Self::Scanned | Self::Again | Self::Partial)
    }
}
