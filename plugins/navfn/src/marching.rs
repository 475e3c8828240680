//! The distance to a goal over free cells, computed by fast marching and repaired when cells change.
//!
//! The field solves the eikonal equation |grad T| = 1 with the first-order upwind scheme of Sethian 1996. Cells are
//! processed in buckets whose width is the smallest increase of the scheme, the cell edge divided by the square root of
//! two, so no heap is needed (Tsitsiklis 1995; Yatziv et al. 2006).
//!
//! When cells are blocked, every cell whose value no longer follows from its neighbours is cleared, spreading outward.
//! The cleared area is then marched again from its rim. When cells are freed, the march starts from them. Nothing else
//! is touched. Marching stops when the robot's cell is settled; the remaining cells are left for the next call.

/// Error up to which a value is considered supported by its neighbours, as a share of a cell.
const ROUNDING: f32 = 1e-4;

/// Distances to the goal.
#[derive(Debug, Clone)]
pub struct Field {
    columns: usize,
    cell_m: f32,
    /// Number of buckets per metre.
    buckets_per_m: f32,
    blocked: Vec<bool>,
    /// Distance from the goal, metres; infinite for cells that are blocked or not yet reached.
    distance_m: Vec<f32>,
    is_source: Vec<bool>,
    /// The cells that may lower the values of their neighbours, in buckets by distance, each with its distance at the
    /// time it was added.
    buckets: Vec<Vec<(u32, f32)>>,
    /// Emptied buckets for reuse, so that only the front of the march takes memory.
    spare: Vec<Vec<(u32, f32)>>,
    /// The first bucket that may contain anything.
    first: usize,
    n_settled: usize,
}

impl Field {
    /// Creates a field over cells in rows of `columns` cells, before any march. The outermost cells are blocked; the
    /// march starts from sources at known distances.
    pub fn new(columns: usize, cell_m: f64, blocked: Vec<bool>, sources: &[(usize, f64)]) -> Self {
        let n = blocked.len();
        let mut field = Self {
            columns,
            cell_m: cell_m as f32,
            buckets_per_m: std::f32::consts::SQRT_2 / cell_m as f32,
            blocked,
            distance_m: vec![f32::INFINITY; n],
            is_source: vec![false; n],
            buckets: Vec::new(),
            spare: Vec::new(),
            first: 0,
            n_settled: 0,
        };
        for &(cell, distance_m) in sources {
            field.is_source[cell] = true;
            field.lower(cell, distance_m as f32);
        }
        field
    }

    /// Returns the distance from a cell to the goal, metres. It is infinite if there is no path or the march has not
    /// reached the cell.
    pub fn distance_m(&self, cell: usize) -> f32 {
        self.distance_m[cell]
    }

    /// Whether the distance of a cell was given as a source.
    pub fn is_source(&self, cell: usize) -> bool {
        self.is_source[cell]
    }

    /// The number of cells settled since the field was created.
    pub fn n_settled(&self) -> usize {
        self.n_settled
    }

    /// Blocks cells: clears every value that they supported, and prepares the march to recompute it.
    pub fn block(&mut self, cells: &[usize]) {
        let mut emptied: Vec<usize> = Vec::new();
        for &cell in cells {
            self.blocked[cell] = true;
            if self.distance_m[cell].is_finite() {
                self.distance_m[cell] = f32::INFINITY;
                emptied.push(cell);
            }
        }
        let mut next = 0;
        while let Some(&cell) = emptied.get(next) {
            next += 1;
            for neighbour in self.neighbours(cell) {
                let held_m = self.distance_m[neighbour];
                if held_m.is_finite()
                    && !self.is_source[neighbour]
                    && self.supported_m(neighbour) > held_m + ROUNDING * self.cell_m
                {
                    self.distance_m[neighbour] = f32::INFINITY;
                    emptied.push(neighbour);
                }
            }
        }
        self.refill(&emptied);
    }

    /// Frees cells, and prepares the march to cover them.
    pub fn free(&mut self, cells: &[usize]) {
        for &cell in cells {
            self.blocked[cell] = false;
        }
        self.refill(cells);
    }

    /// Marches until a cell is settled or nothing is left to march over. Calls `keep_going` occasionally and stops when
    /// it returns false.
    pub fn march(&mut self, until: usize, keep_going: &mut dyn FnMut() -> bool) {
        while self.first < self.buckets.len() && !self.is_settled(until) && keep_going() {
            let mut bucket = std::mem::take(&mut self.buckets[self.first]);
            // Rounding can make a settled cell add cells to the same bucket again.
            while let Some((cell, distance_m)) = bucket.pop() {
                // An entry is out of date if its cell has been lowered or cleared since the entry was added.
                if self.distance_m[cell as usize].to_bits() == distance_m.to_bits() {
                    self.settle(cell as usize);
                }
            }
            if self.buckets[self.first].is_empty() {
                self.spare.push(bucket);
                self.first += 1;
            }
        }
    }

    /// Whether the distance of a cell is final unless cells are blocked or freed.
    fn is_settled(&self, cell: usize) -> bool {
        self.bucket_of(self.distance_m[cell]).is_some_and(|bucket| bucket < self.first)
    }

    fn settle(&mut self, cell: usize) {
        self.n_settled += 1;
        let here_m = self.distance_m[cell];
        for neighbour in self.neighbours(cell) {
            if self.distance_m[neighbour] > here_m && !self.blocked[neighbour] {
                let through_m = self.supported_m(neighbour);
                if through_m < self.distance_m[neighbour] {
                    self.lower(neighbour, through_m);
                }
            }
        }
    }

    fn refill(&mut self, cells: &[usize]) {
        for &cell in cells {
            if !self.blocked[cell] {
                let supported_m = self.supported_m(cell);
                if supported_m < self.distance_m[cell] {
                    self.lower(cell, supported_m);
                }
            }
        }
    }

    fn lower(&mut self, cell: usize, distance_m: f32) {
        self.distance_m[cell] = distance_m;
        if let Some(bucket) = self.bucket_of(distance_m) {
            if bucket >= self.buckets.len() {
                self.buckets.resize_with(bucket + 1, Vec::new);
            }
            if self.buckets[bucket].capacity() == 0 {
                self.buckets[bucket] = self.spare.pop().unwrap_or_default();
            }
            self.buckets[bucket].push((cell as u32, distance_m));
            self.first = self.first.min(bucket);
        }
    }

    fn bucket_of(&self, distance_m: f32) -> Option<usize> {
        distance_m.is_finite().then_some((distance_m * self.buckets_per_m) as usize)
    }

    fn neighbours(&self, cell: usize) -> [usize; 4] {
        // Only cells inside the frame are evaluated.
        [cell - 1, cell + 1, cell - self.columns, cell + self.columns]
    }

    /// The distance of a cell that follows from its neighbours.
    fn supported_m(&self, cell: usize) -> f32 {
        let [west, east, south, north] = self.neighbours(cell).map(|neighbour| self.distance_m[neighbour]);
        let (a, b, edge_m) = (west.min(east), south.min(north), self.cell_m);
        let apart_m = (a - b).abs();
        // The difference of two infinities is undefined.
        if apart_m < edge_m {
            0.5 * (a + b + (2.0 * edge_m * edge_m - apart_m * apart_m).sqrt())
        } else {
            a.min(b) + edge_m
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const COLUMNS: usize = 30;

    fn framed(blocked: &[usize]) -> Vec<bool> {
        let is_frame = |cell: usize| {
            let (x, y) = (cell % COLUMNS, cell / COLUMNS);
            x == 0 || y == 0 || x == COLUMNS - 1 || y == COLUMNS - 1
        };
        (0..COLUMNS * COLUMNS).map(|cell| is_frame(cell) || blocked.contains(&cell)).collect()
    }

    fn marched(blocked: &[usize], source: usize) -> Field {
        let mut field = Field::new(COLUMNS, 0.5, framed(blocked), &[(source, 0.0)]);
        field.march(0, &mut || true);
        field
    }

    #[test]
    fn on_an_empty_floor_distances_are_nearly_straight() {
        let field = marched(&[], 15 * COLUMNS + 15);
        assert!((field.distance_m(15 * COLUMNS + 25) - 5.0).abs() < 1e-5);
        let diagonal_m = field.distance_m(25 * COLUMNS + 25);
        assert!((diagonal_m - 50.0_f32.sqrt()).abs() < 0.6, "{diagonal_m}");
    }

    #[test]
    fn behind_a_closed_wall_there_is_no_way() {
        let wall: Vec<usize> = (0..COLUMNS).map(|row| row * COLUMNS + 12).collect();
        let field = marched(&wall, 15 * COLUMNS + 5);
        assert!(field.distance_m(15 * COLUMNS + 20).is_infinite());
    }

    proptest! {
        #[test]
        fn a_repaired_field_equals_the_field_recomputed(
            changes in prop::collection::vec(prop::collection::vec(0..COLUMNS * COLUMNS, 1..60), 1..8),
            until in 0..COLUMNS * COLUMNS,
        ) {
            let source = 15 * COLUMNS + 15;
            let mut repaired = marched(&[], source);
            let mut blocked: Vec<usize> = Vec::new();
            for change in changes {
                // Blocked cells are freed and free cells are blocked; the source and the frame stay as they are.
                let frame = framed(&[]);
                let mut change: Vec<usize> = change.into_iter().filter(|c| *c != source && !frame[*c]).collect();
                change.sort_unstable();
                change.dedup();
                let (freed, closed): (Vec<usize>, Vec<usize>) = change.iter().partition(|c| blocked.contains(c));
                blocked.retain(|cell| !freed.contains(cell));
                blocked.extend(&closed);
                repaired.block(&closed);
                repaired.free(&freed);
                repaired.march(until, &mut || true);
            }
            repaired.march(0, &mut || true);
            let recomputed = marched(&blocked, source);
            for cell in 0..COLUMNS * COLUMNS {
                let (ours, theirs) = (repaired.distance_m(cell), recomputed.distance_m(cell));
                let same = (ours - theirs).abs() < 1e-3 || (ours.is_infinite() && theirs.is_infinite());
                prop_assert!(same, "cell {cell}: {ours} {theirs}");
            }
        }
    }
}
