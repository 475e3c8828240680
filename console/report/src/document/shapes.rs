//! Outlines of the areas and plates in a report, for other map programs.

use super::layers::Layers;
use crate::{
    drawing::polygons::{Polygon, polygons},
    past_run::PastRun,
};
use account::{Area, MissReason};
use world::{PlateKind, Zone};

/// The outlines of missed areas and plates, along the edges of their cells.
#[derive(Debug, Default)]
pub(crate) struct Shapes {
    /// Outlines of the missed areas, in the order of the account.
    pub(crate) missed: Vec<Vec<Polygon>>,
    /// Outlines of the plates, in the order of the account.
    pub(crate) plates: Vec<PlateShape>,
}

/// A plate on a map.
#[derive(Debug)]
pub(crate) struct PlateShape {
    /// Name of the plate.
    pub(crate) name: String,
    /// Kind of the plate.
    pub(crate) kind: PlateKind,
    /// Outline of the plate.
    pub(crate) polygons: Vec<Polygon>,
}

impl Shapes {
    pub(super) fn of(layers: &Layers<'_>, missed: &[Area<MissReason>]) -> Self {
        let floor = layers.floor();
        let outline = |area: &Area<MissReason>| {
            let cells = layers.gaps.iter().find(|(place, _)| *place == area.at).map(|(_, cells)| cells);
            cells.map_or_else(Vec::new, |cells| polygons(floor, cells))
        };
        let plates = layers.plate_cells().into_iter().map(|(plate, cells)| PlateShape {
            name: plate.name.clone(),
            kind: plate.kind,
            polygons: polygons(floor, &cells),
        });
        Self { missed: missed.iter().map(outline).collect(), plates: plates.collect() }
    }
}

/// The zones of some runs, without duplicates: those of the scenarios, and those drawn during the runs.
pub(super) fn zones(past: &[PastRun]) -> Vec<&Zone> {
    let mut zones: Vec<&Zone> = Vec::new();
    for zone in past.iter().filter_map(|past| past.fold.run()).flat_map(|run| &run.world.zones) {
        if !zones.contains(&zone) {
            zones.push(zone);
        }
    }
    zones
}
