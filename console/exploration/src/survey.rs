//! What the scans have shown so far.

use crate::{beams::Beams, grid::Grid};
use geometry::{Boundary, Point, Pose, wrap_angle_rad};
use world::Scan;

/// Change of the log odds of a cell by an echo from it, and by a ray through it.
const HIT: f32 = 0.9;
const CLEAR: f32 = -0.4;
/// Limit of the log odds, so that a cell can still change its state.
const MOST_ODDS: f32 = 6.0;
/// Maximum distance at which scans are used, metres: farther away, an error of the heading moves an echo by more than a
/// cell, and neighbouring rays leave gaps.
const WITHIN_M: f64 = 6.0;
/// Motion after which a scan shows something new: metres, radians, seconds. A later scan from the same place shows what
/// lost rays have hidden.
const FRESH: (f64, f64, f64) = (0.1, 0.1, 0.5);
/// Width of the floor beside the wall that counts as part of the wall, metres: a column nearer to the wall than this
/// cannot be told from it.
const WALL_M: f64 = 0.12;
/// Largest number of echoes in the mean place of a cell's surface.
const MOST_HITS: f32 = 200.0;

/// The known properties of the scanner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scanning {
    /// Standard deviation of a distance, metres.
    pub sigma_m: f64,
    /// Maximum distance that can be measured, metres, if it is known.
    pub range_m: Option<f64>,
    /// Radius of the hull, metres; echoes from inside it are ignored.
    pub hull_m: f64,
}

/// The evidence about one cell.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Evidence {
    /// Log odds that the cell is solid.
    pub odds: f32,
    /// Number of echoes from the cell, and the sums of their offsets from its centre, metres.
    pub hits: f32,
    pub sum_m: [f32; 2],
}

/// What the scans have shown so far: an occupancy grid, with the mean place of the echoes in each cell.
#[derive(Debug, Clone)]
pub struct Exploration {
    pub(crate) grid: Grid,
    pub(crate) boundary: Boundary,
    pub(crate) scanning: Scanning,
    pub(crate) evidence: Vec<Evidence>,
    /// Whether the centre of a cell is on the floor and farther from the wall than [`WALL_M`].
    pub(crate) is_floor: Vec<bool>,
    n_floor: usize,
    last: Option<(Pose, f64)>,
}

impl Exploration {
    /// Creates the state before the first scan, for a floor within a wall.
    pub fn new(boundary: &Boundary, scanning: Scanning) -> Self {
        let grid = Grid::of(boundary);
        let is_floor: Vec<bool> =
            (0..grid.len()).map(|cell| boundary.wall_distance_m(grid.center(cell)) > WALL_M).collect();
        Self {
            evidence: vec![Evidence::default(); grid.len()],
            n_floor: is_floor.iter().filter(|is_floor| **is_floor).count(),
            is_floor,
            boundary: boundary.clone(),
            scanning,
            grid,
            last: None,
        }
    }

    /// The lattice of the map.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Adds a scan made at time `now_s`, seconds, by a robot that was at `pose` at the end of the readings. Scans from
    /// nearly the same pose have nearly the same errors; they are left out. Returns whether the scan was used.
    ///
    /// Cost: proportional to the number of cells within the range of the scanner.
    pub fn add(&mut self, scan: &Scan, pose: &Pose, now_s: f64) -> bool {
        if self.last.as_ref().is_some_and(|(last, last_s)| !is_fresh(pose, last, now_s - last_s)) {
            return false;
        }
        self.last = Some((*pose, now_s));
        let within_m = self.scanning.range_m.unwrap_or(WITHIN_M).min(WITHIN_M);
        let range_m = self.scanning.range_m.or(scan.range_max_m);
        let beams = Beams::new(scan, pose, range_m, (self.scanning.hull_m, within_m));
        self.clear(&beams, within_m);
        self.stand_at(pose.position);
        for hit in &beams.hits {
            let Some(cell) = self.grid.index(*hit) else { continue };
            let offset = hit - self.grid.center(cell);
            self.evidence[cell].hit([offset.x as f32, offset.y as f32]);
        }
        true
    }

    fn clear(&mut self, beams: &Beams, within_m: f64) {
        // Cells just before an echo may contain the surface.
        let short_m = self.scanning.sigma_m + 0.5 * self.grid.cell_m;
        let reach = geometry::Vector::repeat(within_m);
        let (grid, evidence) = (&self.grid, &mut self.evidence);
        for cell in grid.within(beams.eye - reach, beams.eye + reach) {
            let to = grid.center(cell) - beams.eye;
            let far_m = to.norm();
            if self.is_floor[cell]
                && far_m <= within_m
                && beams.clear_towards_m(to).is_some_and(|clear_m| far_m < clear_m - short_m)
            {
                evidence[cell].add(CLEAR);
            }
        }
    }

    /// The floor under the hull is free, even if no ray goes there.
    fn stand_at(&mut self, at: Point) {
        let hull_m = self.scanning.hull_m;
        let reach = geometry::Vector::repeat(hull_m);
        let (grid, evidence) = (&self.grid, &mut self.evidence);
        for cell in grid.within(at - reach, at + reach) {
            if self.is_floor[cell] && (grid.center(cell) - at).norm() <= hull_m {
                evidence[cell].add(CLEAR);
            }
        }
    }

    /// Whether a cell is known to be free floor.
    pub(crate) fn is_free(&self, cell: usize) -> bool {
        self.is_floor[cell] && self.evidence[cell].odds < 0.0
    }

    /// Whether a cell is known to be solid.
    pub(crate) fn is_solid(&self, cell: usize) -> bool {
        self.evidence[cell].odds > 0.0
    }

    /// Whether no scan has shown what is in a cell of the floor.
    pub(crate) fn is_unseen(&self, cell: usize) -> bool {
        self.is_floor[cell] && self.evidence[cell].odds == 0.0
    }

    /// Share of the floor within the wall that scans have shown, 0 to 1. The inside of a column is never shown.
    pub fn share(&self) -> f64 {
        let unseen = (0..self.grid.len()).filter(|cell| self.is_unseen(*cell)).count();
        1.0 - unseen as f64 / self.n_floor.max(1) as f64
    }

    /// Whether a point is on floor that is known to be free.
    pub fn is_free_at(&self, at: Point) -> bool {
        self.grid.index(at).is_some_and(|cell| self.is_free(cell))
    }
}

impl Evidence {
    fn add(&mut self, odds: f32) {
        self.odds = (self.odds + odds).clamp(-MOST_ODDS, MOST_ODDS);
    }

    fn hit(&mut self, offset_m: [f32; 2]) {
        self.add(HIT);
        if self.hits >= MOST_HITS {
            let keep = (MOST_HITS - 1.0) / self.hits;
            (self.hits, self.sum_m) = (self.hits * keep, self.sum_m.map(|sum_m| sum_m * keep));
        }
        self.hits += 1.0;
        for (sum_m, offset_m) in self.sum_m.iter_mut().zip(offset_m) {
            *sum_m += offset_m;
        }
    }
}

fn is_fresh(pose: &Pose, last: &Pose, later_s: f64) -> bool {
    let (moved_m, turned_rad, rested_s) = FRESH;
    (pose.position - last.position).norm() >= moved_m
        || wrap_angle_rad(pose.heading_rad - last.heading_rad).abs() >= turned_rad
        || later_s >= rested_s
}
