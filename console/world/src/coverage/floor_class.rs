//! The classes of floor that screen, reports and files distinguish.

use super::Cell;

/// The class of a cell. Characters and colours are defined where cells are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FloorClass {
    /// Not floor.
    Outside,
    /// Reachable but not scanned yet, during the mission.
    ToDo,
    /// Reachable but not scanned, after the mission.
    Missed,
    /// Scanned.
    Scanned,
    /// Scanned more than once.
    Again,
    /// Partly scanned; never used for a single cell.
    Partial,
    /// Unreachable because it is along the shell.
    Margin,
    /// Unreachable for any other reason.
    Unreachable,
    /// Not testable by the tool, because of a weld.
    Untestable,
}

impl FloorClass {
    /// Returns the class, during the mission, of a cell of a given kind that has been scanned a given number of times.
    ///
    /// ```
    /// use world::{Cell, FloorClass};
    /// assert_eq!(FloorClass::of(Cell::Reachable, 0).when_over(), FloorClass::Missed);
    /// assert_eq!(FloorClass::of(Cell::NoGo, 2), FloorClass::Again);
    /// ```
    pub fn of(kind: Cell, times: u32) -> Self {
        match (kind, times) {
            (Cell::Outside, _) => Self::Outside,
            (Cell::Untestable, _) => Self::Untestable,
            (_, 1) => Self::Scanned,
            (_, 2..) => Self::Again,
            (Cell::Reachable, 0) => Self::ToDo,
            (Cell::Margin, 0) => Self::Margin,
            (Cell::Unreachable | Cell::Beside | Cell::NoGo, 0) => Self::Unreachable,
        }
    }

    /// Returns the class that this one becomes when the mission is over.
    #[must_use]
    pub fn when_over(self) -> Self {
        if self == Self::ToDo { Self::Missed } else { self }
    }

    /// Whether any floor of this class has been scanned.
    pub fn is_scanned(self) -> bool {
        matches!(self, Self::Scanned | Self::Again | Self::Partial)
    }
}
