//! The floor with the knowledge gained during runs.

use super::{Evidence, Solid};
use mission::event::RunOpened;
use std::collections::BTreeSet;
use world::{Floor, FloorMaker, Obstacle, ObstacleId, Zone, ZoneKind};

/// The floor after the runs: with all obstacles that were found, and with all no-go zones closed off.
pub fn updated_floor(run: &RunOpened, grid: &Floor, evidence: &Evidence, swath_m: f64) -> FloorMaker {
    let mut world = run.world.as_drawn();
    let drawn: BTreeSet<ObstacleId> = world.obstacles.iter().map(|obstacle| obstacle.id).collect();
    for (id, solid) in evidence.found().filter(|(id, _)| !drawn.contains(id)) {
        let (name, shape) = (solid.name.clone(), solid.shape.clone());
        world.obstacles.push(Obstacle { id, name, shape, known: true });
    }
    let zone = |Solid { name, shape }: &Solid| Zone {
        name: name.clone(),
        kind: ZoneKind::NoGo,
        shape: shape.clone(),
    };
    world.zones = evidence.no_go().map(zone).collect();
    let mission = &run.mission;
    FloorMaker::of(grid, &world, mission.room_m(), swath_m, mission.start.position)
}
