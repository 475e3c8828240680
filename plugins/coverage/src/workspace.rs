//! The tank as a coverage planner sees it: the wall, the solid parts, and the space for the hull centre.

use crate::floor::{Grain, ReachableFloor};
use crate::inflation::SLACK_M;
use crate::plane::direction;
use crate::triangulation::Triangulation;
use crate::tuning::choice::CROWDED;
use crate::tuning::rooms::{FEW_PARTS, MOST_LANES_M, MOST_PARTS};
use geometry::convex::{Part, parts_of};
use planner_api::{Code, PlannerError, Result, Site};
use std::f64::consts::{PI, TAU};
use std::sync::OnceLock;
use steering::{Keep, Room, solids};
use world::{
    Boundary, Point, Vector,
    polyline::{self, edges},
    shape::{reflex_corners, ring_area_m2},
    tether::Ground,
};

/// Largest distance of a solid from the end of a cut at which the cut is extended into the solid, as a multiple of the
/// distance to keep. It exceeds 1 because the outlines at which cuts may end are slightly larger than the exact ones.
const ROOT_SHARE: f64 = 1.1;
/// Depth to which a cut is extended into solids, metres.
const ROOT_M: f64 = 0.01;

/// Wall and obstacles of a site, and the distances to keep from them.
pub(crate) struct Workspace {
    pub wall: Boundary,
    /// Convex parts of all solids, no-go zones included.
    pub parts: Vec<Part>,
    /// Radius of the hull, metres.
    pub hull_m: f64,
    /// Distance that the hull centre keeps from any solid, metres.
    pub keep_m: f64,
    /// Width of the floor scanned in one pass, metres.
    pub swath_m: f64,
    pub anchor: Point,
    /// Where the robot starts and ends: the anchor, or the nearest position where the hull fits.
    pub home: Point,
    /// The space for the hull centre, with exact distances.
    pub room: Room,
    /// Whether inner walls bend paths on the floor: a straight wall has inward corners, an obstacle leaves no passage
    /// between itself and the wall, or there are too many obstacles for them to be columns.
    pub is_room: bool,
    triangulation: OnceLock<Triangulation>,
    /// The floor that the tool can reach if no cut seals any off, for several cell sizes; computed when first
    /// requested.
    pub floors: [OnceLock<(Grain, ReachableFloor)>; 3],
    /// The map for the cable; computed when first requested.
    pub ground: OnceLock<Ground>,
}

impl Workspace {
    /// Creates the workspace of a site for a robot on a tether from `anchor`.
    ///
    /// # Errors
    /// The anchor is outside the floor or in an obstacle, or the swath has no width.
    pub(crate) fn new(site: &Site<'_>, anchor: Point) -> Result<Self> {
        let (swath_m, keep_m) = (site.swath_m, site.limits.radius_m + site.clearance_m);
        let (wall, hull_m) = (site.boundary.to_owned(), site.limits.radius_m);
        let parts: Vec<Part> = solids(site).flat_map(|(_, outline)| parts_of(&outline)).collect();
        let refusal = refused_figures(swath_m, keep_m, anchor);
        if let Some((code, why)) = refusal.or_else(|| refused_anchor(&wall, &parts, anchor)) {
            return Err(PlannerError::new(code, why));
        }
        let is_room = has_inner_walls(&wall, &parts, keep_m);
        if let Some(why) = is_room.then(|| too_large(&wall, &parts, swath_m)).flatten() {
            return Err(PlannerError::new(Code::Config, why));
        }
        let room = Room::new(site, Keep { obstacle_m: keep_m, wall_m: keep_m });
        let home = home(&room, anchor);
        let (triangulation, floors, ground) = (OnceLock::new(), Default::default(), OnceLock::new());
        Ok(Self {
            wall,
            parts,
            hull_m,
            keep_m,
            swath_m,
            anchor,
            home,
            room,
            is_room,
            triangulation,
            floors,
            ground,
        })
    }

    /// The floor for the hull centre in triangles; computed when first requested.
    pub(crate) fn triangulation(&self) -> &Triangulation {
        self.triangulation.get_or_init(|| Triangulation::new(&self.wall, &self.parts, self.keep_m))
    }

    /// Whether this is a tank, not a room, with more than [`CROWDED`] obstacles; only a few candidates are then worth
    /// computing.
    pub(crate) fn is_crowded(&self) -> bool {
        !self.is_room && self.parts.len() > CROWDED
    }

    /// Whether wall and obstacles leave space for the hull centre at a position.
    pub(crate) fn is_free(&self, at: Point) -> bool {
        self.room.spare_m(at) >= 0.0
    }

    /// Whether there is space for the hull centre within a distance of a position, straight away from the nearest
    /// solid.
    pub(crate) fn is_in_reach(&self, at: Point, reach_m: f64) -> bool {
        /// Step of the differences used to find the direction away, metres.
        const STEP_M: f64 = 1e-4;
        /// Rounding error of the differences, metres.
        const TOLERANCE_M: f64 = 1e-4;
        let lacks_m = -self.room.spare_m(at);
        if lacks_m <= 0.0 || lacks_m > reach_m {
            return lacks_m <= 0.0;
        }
        let rises = |step: Vector| self.room.spare_m(at + step) - self.room.spare_m(at - step);
        let away = Vector::new(rises(Vector::new(STEP_M, 0.0)), rises(Vector::new(0.0, STEP_M)));
        away.try_normalize(0.0).is_some_and(|away| self.room.spare_m(at + away * lacks_m) >= -TOLERANCE_M)
    }

    /// Whether a position is floor: inside the wall and outside all solids.
    pub(crate) fn is_floor(&self, at: Point) -> bool {
        !self.room.is_solid(at)
    }

    /// Extends a cut from solid to solid: an end just outside a wall or an obstacle is continued into that solid, so
    /// that a robot that cuts a corner slightly cannot get around the end.
    pub(crate) fn rooted(&self, cut: &[Point]) -> Vec<Point> {
        let before = cut.first().and_then(|end| self.root(*end));
        let behind = cut.last().and_then(|end| self.root(*end));
        before.into_iter().chain(cut.iter().copied()).chain(behind).collect()
    }

    /// A point slightly inside the nearest solid, if the position is about as far from the solid as the hull centre
    /// must be.
    fn root(&self, at: Point) -> Option<Point> {
        let of_parts = self.parts.iter().map(|part| part.distance(at));
        let (distance_m, away) = of_parts.chain(self.wall_beside(at)).min_by(|a, b| a.0.total_cmp(&b.0))?;
        let is_beside = distance_m > 0.0 && distance_m <= ROOT_SHARE * self.keep_m;
        is_beside.then(|| at - away * (distance_m + ROOT_M))
    }

    /// The distance from the nearest straight wall, metres, and the direction away from it.
    fn wall_beside(&self, at: Point) -> Option<(f64, Vector)> {
        let Boundary::Polygon { vertices } = &self.wall else { return None };
        let off = |(a, b): (Point, Point)| at - polyline::nearest_on_segment(a, b, at);
        let off = edges(vertices).map(off).min_by(|a, b| a.norm().total_cmp(&b.norm()))?;
        Some((off.norm(), off.try_normalize(1e-9)?))
    }

    /// The error returned when the hull does not fit near the anchor.
    pub(crate) fn no_room(&self) -> PlannerError {
        let Self { keep_m, anchor, .. } = self;
        PlannerError::new(
            Code::StartOccupied,
            format!(
                "no room for hull and clearance ({keep_m:.2} m) within 2 m of the anchor ({:.2}, {:.2})",
                anchor.x, anchor.y
            ),
        )
    }
}

/// The reason why a floor between inner walls cannot be planned in time: it is too large or too fragmented. `None` if
/// it can be planned.
fn too_large(wall: &Boundary, parts: &[Part], swath_m: f64) -> Option<String> {
    let Boundary::Polygon { vertices } = wall else { return None };
    let solid_m2: f64 = parts.iter().map(area_m2).sum();
    let floor_m2 = (ring_area_m2(vertices).abs() - solid_m2).max(0.0);
    let most_m2 = MOST_LANES_M * swath_m;
    if floor_m2 > most_m2 {
        return Some(format!(
            "the floor of {floor_m2:.0} m² between walls is too large: with lanes of {swath_m:.2} m at \
             most {most_m2:.0} m² can be planned; divide the map, close parts of it with no-go zones, or \
             choose a wider swath"
        ));
    }
    (parts.len() > MOST_PARTS).then(|| {
        format!(
            "the floor is broken up by {} convex obstacles; at most {MOST_PARTS} can be planned: divide \
             the map, or increase map_tolerance_m to simplify it",
            parts.len()
        )
    })
}

fn area_m2(part: &Part) -> f64 {
    match part {
        Part::Polygon { vertices } => ring_area_m2(vertices).abs(),
        Part::Capsule { a, b, half_width_m } => half_width_m * (2.0 * (b - a).norm() + PI * half_width_m),
    }
}

fn has_inner_walls(wall: &Boundary, parts: &[Part], keep_m: f64) -> bool {
    let Boundary::Polygon { vertices } = wall else { return false };
    let is_at_wall = |part: &Part| wall_gap_m(wall, part) < 2.0 * keep_m;
    parts.len() > FEW_PARTS || reflex_corners(vertices).next().is_some() || parts.iter().any(is_at_wall)
}

/// The gap between wall and part, metres; zero or negative if the part reaches the wall.
pub(crate) fn wall_gap_m(wall: &Boundary, part: &Part) -> f64 {
    let corners = part.corners();
    let ends = corners.iter().map(|c| wall.wall_distance_m(c.0) - c.1).fold(f64::INFINITY, f64::min);
    let Boundary::Polygon { vertices } = wall else { return ends };
    edges(vertices).map(|(a, b)| part.segment_distance_m(a, b)).fold(ends, f64::min)
}

/// The largest distance from a part's centre to its outline, metres.
pub(crate) fn reach_m(part: &Part) -> f64 {
    let at = part.middle();
    part.corners().iter().map(|c| (c.0 - at).norm() + c.1).fold(0.0, f64::max)
}

fn refused_figures(swath_m: f64, keep_m: f64, anchor: Point) -> Option<(Code, String)> {
    if !(swath_m.is_finite() && swath_m > 0.0) {
        Some((Code::Config, format!("a swath of {swath_m} m is invalid; it must be above 0")))
    } else if !(keep_m.is_finite() && keep_m >= 0.0) {
        Some((Code::Config, format!("hull and clearance of {keep_m} m are invalid")))
    } else if !(anchor.x.is_finite() && anchor.y.is_finite()) {
        Some((Code::Invalid, "anchor coordinates must be finite numbers".to_owned()))
    } else {
        None
    }
}

fn refused_anchor(wall: &Boundary, parts: &[Part], anchor: Point) -> Option<(Code, String)> {
    let place = format!("the anchor ({:.2}, {:.2}) lies", anchor.x, anchor.y);
    if wall.wall_distance_m(anchor) < 0.0 {
        let message = format!("{place} outside the floor; place it at a hatch or manhole of this tank");
        return Some((Code::StartOutside, message));
    }
    let at = parts.iter().find(|part| part.distance(anchor).0 < 0.0)?.middle();
    let message =
        format!("{place} inside the obstacle at ({:.2}, {:.2}); place it on free floor", at.x, at.y);
    Some((Code::StartOccupied, message))
}

/// The anchor, or the nearest position where the hull fits, on circles of up to 2 m around the anchor.
fn home(room: &Room, anchor: Point) -> Point {
    let is_roomy = |at: &Point| room.spare_m(*at) >= SLACK_M;
    places_around(anchor, 2.0).find(is_roomy).unwrap_or(anchor)
}

/// A position, and positions on circles around it, nearest first, up to a distance, metres.
pub(crate) fn places_around(at: Point, far_m: f64) -> impl Iterator<Item = Point> {
    let circles = (1..=(far_m / 0.025).round() as u32).map(|k| f64::from(k) * 0.025);
    let bearings = || (0..72).map(|k| direction(TAU * f64::from(k) / 72.0));
    let around = circles.flat_map(move |radius_m| bearings().map(move |toward| at + toward * radius_m));
    std::iter::once(at).chain(around)
}
