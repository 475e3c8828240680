//! The obstacles that the tracker of a vehicle reports.

use std::collections::BTreeMap;
use vehicle::wire::message::Outline;
use world::{ObstacleId, Point, Shape, Sighting};

/// Maximum number of different obstacles in a run.
const MOST_OBSTACLES: usize = 1000;

/// The obstacles so far.
#[derive(Debug, Default)]
pub(super) struct Outlines {
    /// Whether the tracker uses the ids of the scenario.
    drawn_ids: bool,
    ids: BTreeMap<u32, ObstacleId>,
    /// Number of different obstacles, also from before a restart of the vehicle.
    found: usize,
}

impl Outlines {
    /// The vehicle has introduced itself: the ids of its tracker begin again.
    pub(super) fn greet(&mut self, drawn_ids: bool) {
        self.drawn_ids = drawn_ids;
        self.ids.clear();
    }

    /// The outlines as sightings. Obstacles beyond the limit are left out, and are a [`fault`](Self::fault).
    pub(super) fn sightings(&mut self, outlines: &[Outline]) -> Vec<Sighting> {
        outlines
            .iter()
            .filter_map(|outline| Some(Sighting { id: self.id(outline.id)?, shape_in_robot: shape(outline) }))
            .collect()
    }

    fn id(&mut self, id: u32) -> Option<ObstacleId> {
        if let Some(known) = self.ids.get(&id) {
            return Some(*known);
        }
        self.found = self.found.saturating_add(1);
        let number = u32::try_from(self.found).ok().filter(|_| self.found <= MOST_OBSTACLES)?;
        let ours = ObstacleId(if self.drawn_ids { id } else { ObstacleId::FOREIGN.0 + number });
        self.ids.insert(id, ours);
        Some(ours)
    }

    /// The reason why its obstacles cannot be trusted, as a clause.
    pub(super) fn fault(&self) -> Option<String> {
        (self.found > MOST_OBSTACLES).then(|| {
            format!(
                "readings.outlines: more than {MOST_OBSTACLES} obstacles; the same obstacle must keep its id"
            )
        })
    }
}

fn shape(outline: &Outline) -> Shape {
    let Outline { points_m, radius_m, closed, .. } = outline;
    let points: Vec<Point> = points_m.iter().map(|[x, y]| Point::new(*x, *y)).collect();
    match (points.as_slice(), closed) {
        ([center], _) => Shape::Disc { center: *center, radius_m: *radius_m },
        (_, true) => Shape::Polygon { vertices: points },
        (_, false) => Shape::Polyline { points, half_width_m: *radius_m },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outline(id: u32) -> Outline {
        Outline { id, points_m: vec![[1.0, 0.5]], radius_m: 0.2, closed: false }
    }

    fn ids(outlines: &mut Outlines, seen: &[u32]) -> Vec<u32> {
        let seen: Vec<Outline> = seen.iter().map(|id| outline(*id)).collect();
        outlines.sightings(&seen).iter().map(|sighting| sighting.id.0).collect()
    }

    #[test]
    fn a_tracker_that_does_not_know_the_drawing_gets_ids_of_its_own() {
        let mut outlines = Outlines::default();
        outlines.greet(false);
        assert_eq!(ids(&mut outlines, &[1, 5, 1]), [1_000_001, 1_000_002, 1_000_001]);
        outlines.greet(false);
        assert_eq!(ids(&mut outlines, &[5]), [1_000_003], "after a restart, 5 may be any obstacle");
        outlines.greet(true);
        assert_eq!(ids(&mut outlines, &[5, 1]), [5, 1]);
    }

    #[test]
    fn too_many_obstacles_are_a_named_fault() {
        let mut outlines = Outlines::default();
        let all: Vec<u32> = (0..1000).collect();
        assert_eq!(ids(&mut outlines, &all).len(), 1000);
        assert_eq!(outlines.fault(), None);
        assert_eq!(ids(&mut outlines, &[999, 1000]).len(), 1);
        assert!(outlines.fault().is_some_and(|why| why.contains("more than 1000 obstacles")));
    }
}
