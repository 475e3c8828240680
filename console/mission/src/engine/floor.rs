//! The floor of the mission, and what of it has been scanned.

use crate::{chart::Chart, config::MissionConfig};
use world::{CoverageGrid, Floor, FloorMaker, KindRun, Shape};

/// The floor and what of it has been scanned.
#[derive(Clone)]
pub(super) struct ScannedFloor {
    pub coverage: CoverageGrid,
    /// Recomputes the floor when an obstacle is found; created for the first one.
    surveyor: Option<FloorMaker>,
}

impl ScannedFloor {
    /// Nothing has been scanned.
    pub(super) fn new(floor: Floor) -> Self {
        Self { coverage: CoverageGrid::new(floor), surveyor: None }
    }

    /// Takes in shapes that were found: what stands where is no floor, and what is beside it cannot be reached. Gives the
    /// cells that have changed.
    pub(super) fn survey(&mut self, config: &MissionConfig, chart: &Chart, found: &[Shape]) -> Vec<KindRun> {
        let Self { coverage, surveyor } = self;
        let surveyor = surveyor.get_or_insert_with(|| {
            FloorMaker::of(
                coverage.floor(),
                // As it was before the first find; finds are applied below.
                &chart.world().as_drawn(),
                config.room_m(),
                config.swath_m,
                config.start.position,
            )
        });
        let changes = surveyor.update(chart.world(), chart.map(), found);
        coverage.change(&changes);
        changes
    }
}
