//! The mission's own map: the drawing, the obstacles found, and the zones drawn during the mission.

use crate::{
    ask::{Site, SiteObstacle, SiteZone},
    config::MissionConfig,
    event::EventKind,
    governor::{Outline, Solid},
};
use nalgebra::{Isometry2, Translation2};
use perception::{Drift, OUT_OF_SIGHT_S, change_m};
use planner_api as api;
use std::sync::Arc;
use world::{Obstacle, ObstacleId, ObstacleMap, Point, Pose, Shape, Sighting, World, Zone, ZoneKind};

/// Distance, metres, by which the estimated position of a found obstacle must change before the obstacle is reported
/// again.
const MOVED_M: f64 = 0.05;
/// Number of sightings in the running mean of a found obstacle's position.
const MEMORY: f64 = 50.0;
/// Maximum distance, metres, by which an outline from a tracker may extend beyond the drawn obstacle that it shows. It
/// allows for errors of the position and of the tracker. An object this close to a drawn obstacle is not added to the
/// chart; the robot still stops before it.
const DRAWN_M: f64 = 0.1;

/// The drawing and the found obstacles, with an index for queries.
#[derive(Clone)]
pub(crate) struct Chart {
    world: World,
    /// Ids of the obstacles on the drawing, in ascending order.
    drawn: Arc<[ObstacleId]>,
    found: Vec<Found>,
    /// The obstacles in sight now, placed using the current estimated pose.
    in_sight: Vec<(ObstacleId, Shape)>,
    map: ObstacleMap,
    /// An index of the drawing alone.
    drawn_map: Arc<ObstacleMap>,
    revision: u32,
    limits: api::Limits,
    swath_m: f64,
    clearance_m: f64,
    seed: u64,
    now_s: f64,
}

#[derive(Clone)]
struct Found {
    id: ObstacleId,
    /// Index into the world's obstacles.
    index: usize,
    sightings: f64,
    reported_at: Point,
    /// The outline as it was last reported; used for obstacles found in scans.
    reported: Shape,
    drift: Drift,
}

/// The changes that sightings have made to the chart.
pub(crate) struct Seen {
    /// Events for new or moved obstacles.
    pub events: Vec<EventKind>,
    /// Whether a plan may have become invalid. A moving obstacle that merely keeps moving does not count; the planner
    /// avoids it step by step.
    pub changes_plans: bool,
}

impl Chart {
    /// The initial chart: the drawing alone.
    pub(crate) fn new(drawing: World, config: &MissionConfig, seed: u64) -> Self {
        let map = ObstacleMap::new(&drawing.boundary, &drawing.obstacles);
        let mut drawn: Vec<_> = drawing.obstacles.iter().filter(|o| o.known).map(|o| o.id).collect();
        drawn.sort_unstable();
        Self {
            world: drawing,
            drawn: drawn.into(),
            found: Vec::new(),
            in_sight: Vec::new(),
            drawn_map: Arc::new(map.clone()),
            map,
            revision: 0,
            limits: config.limits,
            swath_m: config.lane_m(),
            clearance_m: config.clearance_m,
            seed,
            now_s: 0.0,
        }
    }

    /// The tank as known so far.
    pub(crate) fn world(&self) -> &World {
        &self.world
    }

    /// Whether a position is at least `room_m` metres from everything solid and from every no-go zone.
    pub(crate) fn has_room(&self, at: Point, room_m: f64) -> bool {
        let mut no_go = self.world.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo);
        self.map.clearance_m(at) >= room_m && no_go.all(|zone| zone.shape.distance_m(at) >= room_m)
    }

    /// Depth of a position in the no-go zones, metres; 0 outside all of them.
    pub(crate) fn depth_m(&self, at: Point) -> f64 {
        let no_go = self.world.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo);
        no_go.map(|zone| -zone.shape.distance_m(at)).fold(0.0, f64::max)
    }

    /// Whether everything that the hull must not touch is at least `reach_m` metres from a position: the obstacles in
    /// sight, where they are seen, and everything on the chart.
    pub(crate) fn is_free(&self, at: Point, reach_m: f64) -> bool {
        let seen_m = |(_, shape): &(ObstacleId, Shape)| shape.distance_m(at);
        self.has_room(at, reach_m) && self.in_sight.iter().all(|seen| seen_m(seen) >= reach_m)
    }

    /// Everything within `reach_m` metres of a position that the hull must not touch. Obstacles in sight are placed where
    /// they are seen. A moving obstacle that has gone out of sight is left out, as are the no-go zones with the names in
    /// `leaving`.
    pub(crate) fn solids(&self, at: Point, reach_m: f64, leaving: &[String]) -> Vec<Solid<'_>> {
        let is_seen = |id: ObstacleId| self.in_sight.iter().any(|(seen, _)| *seen == id);
        let seen = self.in_sight.iter().map(|(_, shape)| (shape, true));
        let near = self.map.within(at, reach_m);
        let charted = near.into_iter().filter(|near| !is_seen(near.id) && !self.is_gone(near.index));
        let charted = charted.map(|near| (&self.world.obstacles[near.index].shape, false));
        let is_closed = |zone: &&Zone| zone.kind == ZoneKind::NoGo && !leaving.contains(&zone.name);
        let zones = self.world.zones.iter().filter(is_closed);
        let shapes = seen.chain(charted).chain(zones.map(|zone| (&zone.shape, false)));
        let near_shapes = shapes.filter(|(shape, _)| shape.distance_m(at) < reach_m);
        let mut solids: Vec<_> =
            near_shapes.map(|(shape, is_seen)| Solid { outline: Outline::Shape(shape), is_seen }).collect();
        if self.world.boundary.wall_distance_m(at) < reach_m {
            solids.push(Solid { outline: Outline::Wall(&self.world.boundary), is_seen: false });
        }
        solids
    }

    /// Whether an obstacle was moving and has been out of sight for too long.
    fn is_gone(&self, index: usize) -> bool {
        let found = self.found.iter().find(|found| found.index == index);
        found.is_some_and(|found| {
            found.drift.velocity().is_some() && self.now_s - found.drift.seen_s() > OUT_OF_SIGHT_S
        })
    }

    /// Distances and neighbours on the chart.
    pub(crate) fn map(&self) -> &ObstacleMap {
        &self.map
    }

    /// Distances on the drawing, without the obstacles found.
    pub(crate) fn drawn_map(&self) -> &ObstacleMap {
        &self.drawn_map
    }

    /// Records the obstacles seen from an estimated pose.
    ///
    /// Even when the position estimate is wrong, the robot sees how far away an obstacle is. Planners therefore avoid
    /// obstacles where they are seen, not where the chart puts them.
    pub(crate) fn sight<'a>(&mut self, seen: impl Iterator<Item = (ObstacleId, &'a Shape)>, from: &Pose) {
        let placed = |(id, shape): (_, &Shape)| (id, shape.transformed(&from.tank_from_robot()));
        self.in_sight = seen.map(placed).collect();
    }

    /// Adds to the chart the sightings made at time `now_s` from an estimated pose, and the obstacles found in scans,
    /// whose positions in the tank are already known. Returns the changes.
    ///
    /// Only obstacles that are not on the drawing are added. A tracker of the simulator recognizes drawn obstacles; other
    /// trackers see a drawn obstacle where the drawing has it.
    pub(crate) fn see(
        &mut self,
        now_s: f64,
        sightings: &[Sighting],
        scanned: &[perception::Seen<'_>],
        from: &Pose,
    ) -> Seen {
        self.now_s = now_s;
        let mut events = Vec::new();
        let mut changes_plans = false;
        for sighting in sightings {
            if self.drawn.binary_search(&sighting.id).is_err() {
                let shape = sighting.shape_in_robot.transformed(&from.tank_from_robot());
                if self.is_drawn(sighting.id, &shape) {
                    continue;
                }
                let did_move = self.velocity(sighting.id).is_some();
                let event = self.place(sighting.id, shape);
                changes_plans |= self.matters(sighting.id, did_move, event.as_ref());
                events.extend(event);
            }
        }
        for seen in scanned {
            let did_move = self.velocity(seen.id).is_some();
            let event = self.place_scanned(seen);
            changes_plans |= self.matters(seen.id, did_move, event.as_ref());
            events.extend(event);
        }
        // Even a small movement since the last report may affect plans, because they are checked against this map.
        if changes_plans || !events.is_empty() {
            self.revision += 1;
            self.map = ObstacleMap::new(&self.world.boundary, &self.world.obstacles);
        }
        Seen { events, changes_plans }
    }

    /// Whether an outline of a foreign tracker is part of a drawn obstacle.
    fn is_drawn(&self, id: ObstacleId, shape: &Shape) -> bool {
        if id < ObstacleId::FOREIGN || self.found.iter().any(|found| found.id == id) {
            return false;
        }
        let (points, half_m): (&[Point], f64) = match shape {
            Shape::Disc { center, radius_m } => (std::slice::from_ref(center), *radius_m),
            Shape::Polygon { vertices } => (vertices, 0.0),
            Shape::Polyline { points, half_width_m } => (points, *half_width_m),
        };
        let covers =
            |drawn: &Obstacle| points.iter().all(|point| drawn.shape.distance_m(*point) + half_m <= DRAWN_M);
        self.world.obstacles.iter().filter(|obstacle| obstacle.known).any(covers)
    }

    /// Whether the last sighting of an obstacle may have made a plan invalid; `event` is the event that reports the
    /// sighting, if there is one.
    fn matters(&self, id: ObstacleId, did_move: bool, event: Option<&EventKind>) -> bool {
        let moves = self.velocity(id).is_some();
        did_move != moves || (event.is_some() && !moves)
    }

    /// Places an obstacle found in scans. Its position and its outline have already been averaged.
    fn place_scanned(&mut self, seen: &perception::Seen<'_>) -> Option<EventKind> {
        let Some(found) = self.found.iter_mut().find(|found| found.id == seen.id) else {
            let event = self.add(seen.id, seen.shape.clone());
            self.found.iter_mut().filter(|found| found.id == seen.id).for_each(|found| {
                found.drift.clone_from(seen.drift);
            });
            return Some(event);
        };
        found.drift.clone_from(seen.drift);
        let obstacle = &mut self.world.obstacles[found.index];
        obstacle.shape.clone_from(&seen.shape);
        if change_m(&found.reported, &seen.shape) < MOVED_M {
            return None;
        }
        found.reported.clone_from(&seen.shape);
        found.reported_at = seen.shape.center();
        Some(EventKind::ObstacleMoved { id: seen.id, obstacle: obstacle.clone() })
    }

    fn place(&mut self, id: ObstacleId, shape: Shape) -> Option<EventKind> {
        let now_s = self.now_s;
        let Some(found) = self.found.iter_mut().find(|found| found.id == id) else {
            return Some(self.add(id, shape));
        };
        found.drift.see(now_s, shape.center());
        if found.drift.velocity().is_some() {
            // For a moving obstacle, a running mean would lag behind.
            found.sightings = 0.0;
        }
        let obstacle = &mut self.world.obstacles[found.index];
        let center = obstacle.shape.center();
        let mean = center + (shape.center() - center) / (found.sightings + 1.0);
        found.sightings = (found.sightings + 1.0).min(MEMORY);
        obstacle.shape = shape.transformed(&shift(mean - shape.center()));
        if (mean - found.reported_at).norm() < MOVED_M {
            return None;
        }
        found.reported_at = mean;
        Some(EventKind::ObstacleMoved { id, obstacle: obstacle.clone() })
    }

    fn add(&mut self, id: ObstacleId, shape: Shape) -> EventKind {
        let name = format!("found {}", self.found.len() + 1);
        let reported_at = shape.center();
        let mut drift = Drift::default();
        drift.see(self.now_s, reported_at);
        let (index, reported) = (self.world.obstacles.len(), shape.clone());
        self.found.push(Found { id, index, sightings: 1.0, reported_at, reported, drift });
        let obstacle = Obstacle { id, name, shape, known: false };
        self.world.obstacles.push(obstacle.clone());
        EventKind::ObstacleFound { obstacle }
    }

    /// Adds a zone.
    pub(crate) fn draw(&mut self, zone: Zone) {
        self.world.zones.push(zone);
        self.revision += 1;
    }

    /// The whole chart, in the form that planners receive.
    pub(crate) fn site(&self) -> Site {
        Site {
            revision: self.revision,
            boundary: self.world.boundary.clone(),
            obstacles: (0..self.world.obstacles.len()).filter_map(|index| self.reported(index)).collect(),
            zones: self
                .world
                .zones
                .iter()
                .map(|zone| SiteZone { kind: zone_kind(zone.kind), outline: zone.shape.clone() })
                .collect(),
            limits: self.limits,
            swath_m: self.swath_m,
            clearance_m: self.clearance_m,
            seed: self.seed,
        }
    }

    /// The obstacles within sensing range of a point, in the form that planners receive. Each is placed where it is seen
    /// now or, if it is out of sight, where the chart has it.
    pub(crate) fn near(&self, point: Point) -> Vec<SiteObstacle> {
        let reach_m = self.limits.sensing_range_m + self.limits.radius_m;
        let near = self.map.within(point, reach_m);
        near.iter()
            .filter_map(|near| self.reported(near.index))
            .map(|obstacle| self.as_seen(obstacle))
            .collect()
    }

    fn as_seen(&self, charted: SiteObstacle) -> SiteObstacle {
        let seen = self.in_sight.iter().find(|(id, _)| id.0 == charted.id);
        match seen {
            Some((_, shape)) => SiteObstacle { outline: shape.clone(), ..charted },
            None => charted,
        }
    }

    /// An obstacle, in the form that planners receive; `None` for a moving obstacle that has gone out of sight.
    fn reported(&self, index: usize) -> Option<SiteObstacle> {
        let obstacle = &self.world.obstacles[index];
        let found = self.found.iter().find(|found| found.index == index);
        let velocity = found.and_then(|found| found.drift.velocity());
        (!self.is_gone(index)).then(|| SiteObstacle {
            id: obstacle.id.0,
            discovered: !obstacle.known,
            velocity_m_per_s: velocity.unwrap_or_default(),
            outline: obstacle.shape.clone(),
        })
    }

    /// Whether an event is about a moving obstacle.
    pub(crate) fn moves(&self, event: &EventKind) -> bool {
        match event {
            EventKind::ObstacleFound { obstacle } | EventKind::ObstacleMoved { obstacle, .. } => {
                self.velocity(obstacle.id).is_some()
            }
            _ => false,
        }
    }

    fn velocity(&self, id: ObstacleId) -> Option<world::Vector> {
        self.found.iter().find(|found| found.id == id)?.drift.velocity()
    }
}

fn shift(by: world::Vector) -> Isometry2<f64> {
    Isometry2::from_parts(Translation2::from(by), nalgebra::UnitComplex::identity())
}

fn zone_kind(kind: ZoneKind) -> api::ZoneKind {
    match kind {
        ZoneKind::NoGo => api::ZoneKind::NoGo,
        ZoneKind::Land => api::ZoneKind::Land,
        ZoneKind::Underwater => api::ZoneKind::Underwater,
    }
}
