//! The floor of the mission, and the part of it that has been scanned.

use crate::{chart::Chart, config::MissionConfig};
use world::{CoverageGrid, Floor, FloorMaker, KindRun, Shape};

/// The floor, and the part of it that has been scanned.
#[derive(Clone)]
pub(super) struct ScannedFloor {
    pub coverage: CoverageGrid,
    /// Recomputes the floor when an obstacle is found; created when the first obstacle is found.
    surveyor: Option<FloorMaker>,
}

impl ScannedFloor {
    /// A floor on which nothing has been scanned.
    pub(super) fn new(floor: Floor) -> Self {
        Self { coverage: CoverageGrid::new(floor), surveyor: None }
    }

    /// Adds shapes that were found. They are not floor, and they may make the floor beside them unreachable. Returns the
    /// changed cells.
    pub(super) fn survey(&mut self, config: &MissionConfig, chart: &Chart, found: &[Shape]) -> Vec<KindRun> {
        let changes = self.surveyor(config, chart).update(chart.world(), chart.map(), found);
        self.coverage.change(&changes);
        changes
    }

    /// Closes the area inside an outline that is not on the chart yet. Returns the changed cells.
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
                // The floor as it was before anything was found; the found obstacles are applied afterwards.
                &chart.world().as_drawn(),
                config.room_m(),
                config.swath_m,
                config.start.position,
            )
        })
    }
}
