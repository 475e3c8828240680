//! The floor that the tool can reach.

use crate::floor::raster::{Grain, Raster};
use crate::slit_domain::SlitDomain;
use std::sync::Arc;
use world::{Point, shape::mean_of};

/// The cells of the floor, and which of them the tool can reach.
#[derive(Clone)]
pub(crate) struct ReachableFloor {
    pub raster: Raster,
    /// For each cell, whether the tool can reach it; shared by all candidates.
    pub cells: Arc<[bool]>,
    /// Number of reachable cells.
    pub n: usize,
}

impl ReachableFloor {
    /// The floor that the tool can reach from a domain, in cells with this edge length, metres.
    pub(crate) fn new(domain: &SlitDomain<'_>, cell_m: f64) -> Self {
        Self::in_cells(domain, Grain::of(cell_m))
    }

    /// The floor that the tool can reach from a domain, in the given cells.
    pub(crate) fn in_cells(domain: &SlitDomain<'_>, grain: Grain) -> Self {
        if domain.sealed.area_m2 > 0.0 {
            return Self::of(domain, grain);
        }
        // Cuts remove no floor, so the floor is the same for all domains of the workspace.
        let mut kept =
            domain.workspace.floors.iter().map(|kept| kept.get_or_init(|| (grain, Self::of(domain, grain))));
        kept.find(|(other, _)| *other == grain)
            .map_or_else(|| Self::of(domain, grain), |(_, floor)| floor.clone())
    }

    fn of(domain: &SlitDomain<'_>, grain: Grain) -> Self {
        let workspace = domain.workspace;
        let raster = Raster::over(&workspace.wall, grain, workspace.swath_m);
        let mut free = vec![false; raster.len()];
        for triangle in domain.triangles() {
            raster.fill(&triangle, |cells| free[cells].fill(true));
        }
        let (mut cells, mut is_known) = (free.clone(), free.clone());
        // The tool reaches half a swath beyond the last free cells, just as the mission counts it.
        for cell in raster.rim(&free) {
            let near = raster.near(raster.center(cell), raster.bar_m / 2.0, |other| !is_known[other]);
            for (other, at) in near.collect::<Vec<_>>() {
                (cells[other], is_known[other]) = (workspace.is_floor(at), true);
            }
        }
        // The hull centre may move up to one cell beyond the last free cell, to the edge of the space open to it.
        for cell in raster.rim(&free) {
            let reach_m = raster.bar_m / 2.0 + raster.cell_m;
            let near = raster.near(raster.center(cell), reach_m, |other| !is_known[other]);
            for (other, at) in near.collect::<Vec<_>>() {
                let is_reached = workspace.is_floor(at) && workspace.is_in_reach(at, raster.bar_m / 2.0);
                (cells[other], is_known[other]) = (is_reached, true);
            }
        }
        let n = cells.iter().filter(|reachable| **reachable).count();
        Self { raster, cells: cells.into(), n }
    }

    /// The floor inside some polygons; all of it if there are no polygons.
    pub(crate) fn within(mut self, regions: &[&[Point]]) -> Self {
        if regions.is_empty() {
            return self;
        }
        let mut within = vec![false; self.cells.len()];
        regions.iter().flat_map(|ring| self.cells_in(ring)).for_each(|cell| within[cell] = true);
        self.cells = within.into();
        self.n = self.cells.iter().filter(|reachable| **reachable).count();
        self
    }

    /// The reachable cells inside a polygon. For a polygon that contains no cell centre, the cell at its middle.
    pub(crate) fn cells_in(&self, ring: &[Point]) -> Vec<usize> {
        let mut found = Vec::new();
        self.raster.fill_ring(ring, |cells| found.extend(cells.filter(|cell| self.cells[*cell])));
        if found.is_empty() {
            found.extend(self.raster.cell_at(mean_of(ring)).filter(|cell| self.cells[*cell]));
        }
        found
    }

    /// Whether there is floor to scan within half a swath of a position.
    pub(crate) fn is_near(&self, at: Point) -> bool {
        self.raster.near(at, self.raster.bar_m / 2.0, |cell| self.cells[cell]).next().is_some()
    }

    /// The area, square metres.
    pub(crate) fn area_m2(&self) -> f64 {
        self.n as f64 * self.raster.cell_m * self.raster.cell_m
    }
}
