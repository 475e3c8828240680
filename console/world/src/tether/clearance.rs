//! The clearance that a path leaves for the hull.

use super::{case::Case, rounded_polygon::RoundedPolygon};
use crate::obstacles::{Boxes, wall_clearance_m};
use geometry::Point;

/// A shortfall in clearance up to this does not count as a collision, metres, because arcs are drawn as chords.
const SPARE_M: f64 = 0.005;
/// The number of steps used to find the narrowest point of a segment.
const NARROW_STEPS: u32 = 200;

/// The clearance of a path from obstacles and wall.
pub(super) struct Clearance {
    /// Number of segments with too little clearance for the hull.
    pub collisions: usize,
    /// Least distance to anything solid, metres; never more than the required clearance.
    pub least_m: f64,
    /// The narrowest point of the first segment with too little clearance, and the name of the nearest obstacle.
    pub first: Option<(Point, String)>,
}

impl Clearance {
    pub(super) fn of(case: &Case<'_>) -> Self {
        let solids: Vec<(usize, RoundedPolygon)> = case
            .obstacles
            .iter()
            .enumerate()
            .flat_map(|(k, o)| {
                RoundedPolygon::parts_of(&o.shape, 0.0).into_iter().map(move |solid| (k, solid))
            })
            .collect();
        let boxes = Boxes::new(solids.iter().map(|(_, solid)| solid.bounds()));
        let mut found = Self { collisions: 0, least_m: case.room_m, first: None };
        for segment in segments(case.path) {
            let near = boxes.near(segment.0, segment.1, case.room_m).map(|index| &solids[index]);
            let nearest = near
                .map(|(k, solid)| (solid.distance_m(segment.0, segment.1), Some(*k)))
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let wall = (wall_clearance_m(case.boundary, segment.0, segment.1), None);
            let (least_m, by) = nearest.filter(|(distance_m, _)| *distance_m < wall.0).unwrap_or(wall);
            found.least_m = found.least_m.min(least_m);
            if least_m < case.room_m - SPARE_M {
                found.collisions += 1;
                let name = by.map_or_else(|| "the wall".to_owned(), |k| case.obstacles[k].name.clone());
                found.first.get_or_insert_with(|| (narrowest(case, &solids, segment, by), name));
            }
        }
        found
    }
}

/// Returns the point of a segment that is nearest to an obstacle or to the wall.
///
/// A segment may lead past a long wall or through a solid, so the minimum is searched for in even steps.
fn narrowest(
    case: &Case<'_>,
    solids: &[(usize, RoundedPolygon)],
    (a, b): (Point, Point),
    by: Option<usize>,
) -> Point {
    let distance_m = |at: Point| match by {
        Some(k) => {
            let of_it = solids.iter().filter(|(index, _)| *index == k);
            of_it.map(|(_, solid)| solid.distance_m(at, at)).fold(f64::INFINITY, f64::min)
        }
        None => wall_clearance_m(case.boundary, at, at),
    };
    let points = (0..=NARROW_STEPS).map(|k| a + (b - a) * (f64::from(k) / f64::from(NARROW_STEPS)));
    points.min_by(|p, q| distance_m(*p).total_cmp(&distance_m(*q))).unwrap_or(a)
}

/// Iterates over the segments of a path; a path of one point has a segment of length zero.
fn segments(path: &[Point]) -> impl Iterator<Item = (Point, Point)> + '_ {
    let single = (path.len() == 1).then(|| (path[0], path[0]));
    path.windows(2).map(|pair| (pair[0], pair[1])).chain(single)
}
