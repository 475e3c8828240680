//! The floor that the tool can reach.

use crate::floor::raster::Raster;
use crate::slit_domain::SlitDomain;
use world::{Point, shape::ring_contains};

/// Cells of the floor, and which of them the tool can reach.
#[derive(Clone)]
pub(crate) struct ReachableFloor {
    pub raster: Raster,
    /// Whether the tool can reach a cell.
    pub cells: Vec<bool>,
    /// Number of cells that it can reach.
    pub n: usize,
}

impl ReachableFloor {
    /// The floor that the tool can reach from a domain, in cells with this edge, metres.
    pub(crate) fn new(domain: &SlitDomain<'_>, cell_m: f64) -> Self {
        let workspace = domain.workspace;
        let raster = Raster::over(&workspace.wall, cell_m, workspace.swath_m);
        let mut free = vec![false; raster.len()];
        for triangle in domain.triangles() {
            raster.fill(&triangle, |cells| free[cells].fill(true));
        }
        let is_free = |cell: Option<usize>| cell.is_some_and(|cell| free[cell]);
        let is_at_edge = |cell: usize| !raster.neighbours(cell).take(4).all(is_free);
        let mut cells = free.clone();
        // What the tool reaches beyond the middle of the hull lies within half a swath of the last free cells, as it
        // does when the mission counts.
        for cell in (0..free.len()).filter(|cell| free[*cell] && is_at_edge(*cell)) {
            let near = raster.near(raster.center(cell), raster.bar_m / 2.0, |other| !cells[other]);
            let fresh = near.filter(|(_, at)| workspace.is_floor(*at)).map(|(other, _)| other);
            fresh.collect::<Vec<_>>().into_iter().for_each(|other| cells[other] = true);
        }
        let n = cells.iter().filter(|reachable| **reachable).count();
        Self { raster, cells, n }
    }

    /// The floor within some polygons; all of it without polygons.
    pub(crate) fn within(mut self, regions: &[&[Point]]) -> Self {
        if regions.is_empty() {
            return self;
        }
        for cell in 0..self.cells.len() {
            let at = self.raster.center(cell);
            self.cells[cell] = self.cells[cell] && regions.iter().any(|ring| ring_contains(ring, at));
        }
        self.n = self.cells.iter().filter(|reachable| **reachable).count();
        self
    }

    /// Whether there is floor to scan within half a swath of a place.
    pub(crate) fn is_near(&self, at: Point) -> bool {
        self.raster.near(at, self.raster.bar_m / 2.0, |cell| self.cells[cell]).next().is_some()
    }

    /// Area, square metres.
    pub(crate) fn area_m2(&self) -> f64 {
        self.n as f64 * self.raster.cell_m * self.raster.cell_m
    }
}
