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

    /// Takes in shapes that were found: what stands where is not floor, and what is beside it cannot be reached. Gives the
    /// cells that have changed.
    pub(super) fn survey(&mut self, config: &MissionConfig, chart: &Chart, found: &[Shape]) -> Vec<KindRun> {
        let changes = self.surveyor(config, chart).update(chart.world(), chart.map(), found);
        self.coverage.change(&changes);
        changes
    }

    /// Forbids what lies in an outline, which is not on the chart yet. Gives the cells that have changed.
    pub(super) fn forbid(&mut self, config: &MissionConfig, chart: &Chart, outline: &Shape) -> Vec<KindRun> {
        let changes = self.surveyor(config, chart).forbid(chart.world(), outline);
        self.coverage.change(&changes);
        changes
    }

    fn surveyor(&mut self, config: &MissionConfig, chart: &Chart) -> &mut FloorMaker {
        let Self { coverage, surveyor } = self;
        surveyor.get_or_insert_with(|| {
            FloorMaker::of(
                coverage.floor(),
                // As it was before the first find; finds are applied afterwards.
                &chart.world().as_drawn(),
                config.room_m(),
                config.swath_m,
                config.start.position,
            )
        })
    }
}
