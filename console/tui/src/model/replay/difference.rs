//! The floor that only one of two runs has scanned.

use crate::model::Raster;
use world::{FloorClass, Point};

/// Which of two runs scanned a piece of floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scans {
    /// Neither run.
    None,
    /// Only the run being replayed.
    OnlyA,
    /// Only the run with which it is compared.
    OnlyB,
    /// Both runs.
    Both,
}

impl Scans {
    fn of(a: bool, b: bool) -> Self {
        match (a, b) {
            (false, false) => Self::None,
            (true, false) => Self::OnlyA,
            (false, true) => Self::OnlyB,
            (true, true) => Self::Both,
        }
    }

    /// Which of two runs scanned the floor in a square around a point; `None` where the first run has no floor.
    pub fn in_square(a: &Raster, b: &Raster, center: Point, edge_m: f64) -> Option<Self> {
        let first = a.class_in(center, edge_m, false)?;
        let second = b.class_in(center, edge_m, false).is_some_and(FloorClass::is_scanned);
        Some(Self::of(first.is_scanned(), second))
    }
}

/// The shares of the first run's reachable floor, 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Shares {
    /// Scanned by the first run only.
    pub only_a: f64,
    /// Scanned by the second run only.
    pub only_b: f64,
    /// Scanned by both.
    pub both: f64,
}

impl Shares {
    /// Computes the shares by counting every cell.
    pub fn of(a: &Raster, b: &Raster) -> Self {
        let (floor, is_same) = (a.floor(), a.floor().is_aligned_with(b.floor()));
        let in_b = |index: usize| if is_same { Some(index) } else { b.floor().cell_at(floor.center(index)) };
        let (mut n, mut count) = (0_usize, [0_usize; 4]);
        for index in (0..floor.len()).filter(|index| floor.is_reachable(*index)) {
            n += 1;
            let second = in_b(index).is_some_and(|index| b.is_scanned(index));
            count[Scans::of(a.is_scanned(index), second) as usize] += 1;
        }
        let share = |scans: Scans| count[scans as usize] as f64 / n.max(1) as f64;
        Self { only_a: share(Scans::OnlyA), only_b: share(Scans::OnlyB), both: share(Scans::Both) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::{Boundary, CellRun, Floor, World};

    #[test]
    fn the_floor_divides_by_who_scanned_it() {
        let corners = [(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)];
        let vertices = corners.map(|(x, y)| Point::new(x, y)).to_vec();
        let boundary = Boundary::Polygon { vertices };
        let world = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
        let blank = Raster::new(Floor::new(&world, 0.5, 0.2, 0.4, Point::new(4.0, 4.0)));
        let (mut a, mut b) = (blank.clone(), blank);
        a.apply(&[CellRun(0, 128)]);
        b.apply(&[CellRun(64, 128)]);
        let rows = [1.0, 3.0, 5.0, 7.0].map(|y| Scans::in_square(&a, &b, Point::new(4.0, y), 0.4));
        assert_eq!(rows, [Scans::OnlyA, Scans::Both, Scans::OnlyB, Scans::None].map(Some));
        let Shares { only_a, only_b, both } = Shares::of(&a, &b);
        assert!(
            [only_a, only_b, both].iter().all(|share| (share - 0.25).abs() < 0.03),
            "{only_a} {only_b} {both}"
        );
    }
}
