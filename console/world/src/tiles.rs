//! One value for every cell of a grid, in square tiles. A copy shares with its original all tiles that neither has
//! changed since.

use serde::{Deserialize, Serialize};
use std::{ops::Range, sync::Arc};

/// The number of cells along the edge of a tile, as a power of two.
const SHIFT: usize = 5;
/// The number of cells along the edge of a tile.
const EDGE: usize = 1 << SHIFT;
/// The number of cells in a tile.
const AREA: usize = EDGE * EDGE;

/// One value for every cell of a grid, row by row. In a short time a robot passes over few tiles, whatever its
/// direction. Many copies of a grid that gradually fills up therefore cost little more than one.
///
/// ```
/// use world::Tiles;
/// let mut early = Tiles::new(100, 5000, 0_u8);
/// *early.at_mut(4242) = 7;
/// let mut late = early.clone();
/// *late.at_mut(4242) += 1;
/// assert_eq!((early.at(4242), late.at(4242), late.at(4243)), (7, 8, 0));
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "Flat<T>", into = "Flat<T>")]
#[serde(bound(serialize = "T: Copy + Serialize", deserialize = "T: Copy + Default + Deserialize<'de>"))]
pub struct Tiles<T> {
    width: usize,
    len: usize,
    squares: Vec<Arc<[T; AREA]>>,
}

/// The values row by row, as they are serialised.
#[derive(Serialize, Deserialize)]
struct Flat<T> {
    width: usize,
    cells: Vec<T>,
}

impl<T: Copy> Tiles<T> {
    /// Creates `len` cells with the same value, `width` in a row.
    pub fn new(width: usize, len: usize, value: T) -> Self {
        let width = width.max(1);
        let tiles = width.div_ceil(EDGE) * len.div_ceil(width).div_ceil(EDGE);
        // All tiles are the same until they change.
        Self { width, len, squares: std::iter::repeat_n(Arc::new([value; AREA]), tiles).collect() }
    }

    /// Returns the tile of a cell, and the position in it.
    #[inline]
    fn place(&self, index: usize) -> (usize, usize) {
        assert!(index < self.len, "cell {index} of {}", self.len);
        let (row, column) = (index / self.width, index % self.width);
        let tile = (row >> SHIFT) * self.width.div_ceil(EDGE) + (column >> SHIFT);
        (tile, ((row % EDGE) << SHIFT) + column % EDGE)
    }

    /// Returns the value of a cell. Panics beyond the last cell, as a slice does.
    #[inline]
    pub fn at(&self, index: usize) -> T {
        let (tile, cell) = self.place(index);
        self.squares[tile][cell]
    }

    /// Returns a mutable reference to the value of a cell. Panics beyond the last cell, as a slice does.
    #[inline]
    pub fn at_mut(&mut self, index: usize) -> &mut T {
        let (tile, cell) = self.place(index);
        &mut Arc::make_mut(&mut self.squares[tile])[cell]
    }

    /// Iterates over the values of some cells, piece by piece; each piece comes with the index of its first cell.
    /// Panics beyond the last cell, as a slice does.
    #[inline]
    pub fn slices(&self, cells: Range<usize>) -> impl Iterator<Item = (usize, &[T])> {
        self.pieces(cells).map(|(first, tile, cells)| (first, &self.squares[tile][cells]))
    }

    /// Calls `change` on the values of some cells, piece by piece; each piece comes with the index of its first cell.
    /// Panics beyond the last cell, as a slice does.
    #[inline]
    pub fn change(&mut self, cells: Range<usize>, mut change: impl FnMut(usize, &mut [T])) {
        for (first, tile, cells) in self.pieces(cells) {
            change(first, &mut Arc::make_mut(&mut self.squares[tile])[cells]);
        }
    }

    /// Splits some cells into pieces that each lie in one row of one tile. A piece is the index of its first cell, its
    /// tile, and its positions in the tile.
    #[inline]
    fn pieces(&self, cells: Range<usize>) -> impl Iterator<Item = (usize, usize, Range<usize>)> + use<T> {
        assert!(cells.end <= self.len, "cell {} of {}", cells.end, self.len);
        let (width, mut first) = (self.width, cells.start);
        let (mut row, mut column) = (first / width, first % width);
        std::iter::from_fn(move || {
            if first >= cells.end {
                return None;
            }
            let count = (cells.end - first).min(width - column).min(EDGE - column % EDGE);
            let tile = (row >> SHIFT) * width.div_ceil(EDGE) + (column >> SHIFT);
            let place = ((row % EDGE) << SHIFT) + column % EDGE;
            let piece = (first, tile, place..place + count);
            (first, column) = (first + count, column + count);
            if column == width {
                (row, column) = (row + 1, 0);
            }
            Some(piece)
        })
    }

    /// The number of cells.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no cells.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Iterates over the values, row by row.
    pub fn iter(&self) -> impl Iterator<Item = T> + '_ {
        (0..self.len).map(|index| self.at(index))
    }
}

impl<T: Copy + Default> Default for Tiles<T> {
    fn default() -> Self {
        Self::new(1, 0, T::default())
    }
}

impl<T: Copy> From<Tiles<T>> for Flat<T> {
    fn from(tiles: Tiles<T>) -> Self {
        Self { width: tiles.width, cells: tiles.iter().collect() }
    }
}

impl<T: Copy + Default> From<Flat<T>> for Tiles<T> {
    fn from(Flat { width, cells }: Flat<T>) -> Self {
        let mut tiles = Self::new(width, cells.len(), T::default());
        for (index, value) in cells.into_iter().enumerate() {
            *tiles.at_mut(index) = value;
        }
        tiles
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn tiles_hold_what_a_list_holds_and_copies_do_not_change_each_other(
            width in 1..90_usize,
            len in 1..5000_usize,
            changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u16>()), 0..60),
        ) {
            let mut list = vec![0_u16; len];
            let mut tiles = Tiles::new(width, len, 0_u16);
            let mut before = (tiles.clone(), list.clone());
            for (index, value) in changes {
                before = (tiles.clone(), list.clone());
                *tiles.at_mut(index.index(len)) = value;
                list[index.index(len)] = value;
            }
            prop_assert_eq!(tiles.iter().collect::<Vec<_>>(), &list[..]);
            prop_assert_eq!(before.0.iter().collect::<Vec<_>>(), &before.1[..]);
            let text = serde_json::to_string(&tiles).unwrap();
            prop_assert_eq!(serde_json::from_str::<Tiles<u16>>(&text).unwrap(), tiles);
        }
    }

    proptest! {
        #[test]
        fn pieces_are_the_cells_one_by_one(
            width in 1..90_usize,
            len in 1..5000_usize,
            ends in (any::<prop::sample::Index>(), any::<prop::sample::Index>()),
        ) {
            let (a, b) = (ends.0.index(len + 1), ends.1.index(len + 1));
            let range = a.min(b)..a.max(b);
            let mut tiles = Tiles::new(width, len, 0_u16);
            (0..len).for_each(|index| *tiles.at_mut(index) = index as u16);
            let met: Vec<u16> = tiles.slices(range.clone()).flat_map(|(_, values)| values).copied().collect();
            prop_assert!(met.iter().copied().map(usize::from).eq(range.clone()));
            let before = tiles.clone();
            tiles.change(range.clone(), |first, values| {
                values.iter_mut().zip(first..).for_each(|(value, index)| *value = index as u16 + 1);
            });
            for index in 0..len {
                prop_assert_eq!(tiles.at(index), before.at(index) + u16::from(range.contains(&index)));
            }
        }
    }

    #[test]
    fn a_lane_costs_a_copy_few_tiles_whichever_way_it_goes() {
        let blank = Tiles::new(1600, 1600 * 1600, false);
        for lane in [|i: usize| 800 * 1600 + i, |i: usize| i * 1600 + 800] {
            let mut copy = blank.clone();
            (0..1600).for_each(|i| *copy.at_mut(lane(i)) = true);
            let own = copy.squares.iter().zip(&blank.squares).filter(|(one, other)| !Arc::ptr_eq(one, other));
            assert_eq!(own.count(), 50);
        }
    }
}
