//! The free floor: the places that the robot's centre can occupy, at a given distance from everything solid or
//! forbidden. It is computed exactly, without cells.
//!
//! The rim of the free floor consists of arcs and straight pieces at that distance from each solid. The point on the
//! rim nearest to a given point is either the foot of a perpendicular on one of these pieces, or a corner where two
//! pieces cross. Points of both kinds are candidates: from any candidate that is free, the tool may reach the given
//! point.

mod passages;
mod rim;

pub(super) use passages::Connected;

use crate::obstacles::{Boxes, ObstacleMap};
use crate::tank::{Obstacle, ObstacleId};
use geometry::{Boundary, Point, Shape, Vector, polyline::nearest_on_segment, polyline::segments_cross};
use rim::{Core, Rim};
use std::collections::BTreeMap;

/// The largest shortfall of a distance that is still accepted, metres, so that an exact fit passes.
pub(super) const TIE_M: f64 = 1e-6;

/// The free floor, tank frame.
#[derive(Clone)]
pub(super) struct Room {
    map: ObstacleMap,
    boundary: Boundary,
    cores: Vec<Core>,
    boxes: Boxes,
    keep_m: f64,
    /// The corners of the rim, grouped in squares with an edge of `square_m`.
    corners: BTreeMap<(i64, i64), Vec<Point>>,
    square_m: f64,
}

impl Room {
    /// Creates the free floor at a distance of `room_m` from a wall and some shapes, for a tool that reaches `reach_m`
    /// to each side.
    pub(super) fn new<'a>(
        boundary: &Boundary,
        shapes: impl Iterator<Item = &'a Shape>,
        room_m: f64,
        reach_m: f64,
    ) -> Self {
        let solids: Vec<Obstacle> = (0..)
            .zip(shapes)
            .map(|(id, shape)| Obstacle {
                id: ObstacleId(id),
                name: String::new(),
                shape: shape.clone(),
                known: true,
            })
            .collect();
        let mut cores = Core::of_wall(boundary);
        cores.extend(solids.iter().flat_map(|solid| Core::of_shape(&solid.shape)));
        let mut room = Self {
            map: ObstacleMap::new(boundary, &solids),
            boundary: boundary.clone(),
            boxes: Boxes::new(cores.iter().map(Core::bounds)),
            cores,
            keep_m: room_m,
            corners: BTreeMap::new(),
            square_m: reach_m.max(room_m).max(TIE_M),
        };
        for corner in room.all_corners() {
            room.corners.entry(room.square(corner)).or_default().push(corner);
        }
        room
    }

    /// Whether a place is free.
    pub(super) fn has(&self, at: Point) -> bool {
        self.map.clearance_m(at) >= self.keep_m - TIE_M
    }

    /// Whether the straight line between two free places is free.
    pub(super) fn is_way(&self, a: Point, b: Point) -> bool {
        let keeps = |core: &Core| core.way_m((a, b)) >= self.keep_m - TIE_M;
        self.boxes.near(a, b, self.keep_m).all(|index| keeps(&self.cores[index]))
    }

    /// Iterates over the corners of the rim.
    pub(super) fn corners(&self) -> impl Iterator<Item = Point> + '_ {
        self.corners.values().flatten().copied()
    }

    /// Returns free places within `reach_m` of a place that is not free, including the nearest one in every region.
    pub(super) fn places_near(&self, at: Point, reach_m: f64) -> impl Iterator<Item = Point> + '_ {
        let within_m = reach_m + TIE_M;
        let feet = self.feet(at).into_iter().filter(move |foot| (foot - at).norm() <= within_m);
        self.corners_near(at, within_m).chain(feet.filter(|foot| self.has(*foot)))
    }

    /// Returns the corners of the rim within a given distance of a place.
    pub(super) fn corners_near(&self, at: Point, within_m: f64) -> impl Iterator<Item = Point> + '_ {
        let (column, row) = self.square(at);
        let squares = (-1..=1).flat_map(move |y| (-1..=1).map(move |x| (column + x, row + y)));
        squares
            .filter_map(|square| self.corners.get(&square))
            .flatten()
            .copied()
            .filter(move |corner| (corner - at).norm() <= within_m)
    }

    /// Returns, for each solid that is too close, the nearest place at the required distance from it.
    fn feet(&self, at: Point) -> Vec<Point> {
        let near = self.boxes.near(at, at, self.keep_m).map(|index| &self.cores[index]);
        let mut feet: Vec<Point> = near.flat_map(|core| core.feet(at, self.keep_m)).collect();
        if let Boundary::Circle { radius_m } = self.boundary {
            let (off_m, inner_m) = (at.coords.norm(), radius_m - self.keep_m);
            if off_m > inner_m && inner_m >= 0.0 {
                feet.push(Point::from(at.coords * (inner_m / off_m)));
            }
        }
        feet
    }

    fn all_corners(&self) -> Vec<Point> {
        let mut rims = Core::rims(&self.cores, self.keep_m);
        if let Boundary::Circle { radius_m } = self.boundary {
            rims.push(Rim::Arc { center: Point::origin(), radius_m: (radius_m - self.keep_m).max(0.0) });
        }
        let boxes = Boxes::new(rims.iter().map(|rim| {
            let (a, b, around_m) = rim.around();
            let margin = Vector::new(around_m, around_m);
            (a.inf(&b) - margin, a.sup(&b) + margin)
        }));
        let mut corners = Vec::new();
        for (index, rim) in rims.iter().enumerate() {
            let (a, b, around_m) = rim.around();
            for other in boxes.near(a, b, around_m).filter(|other| *other > index) {
                corners.extend(rim.crossings(&rims[other]).into_iter().filter(|at| self.has(*at)));
            }
        }
        corners
    }

    fn square(&self, at: Point) -> (i64, i64) {
        ((at.x / self.square_m).floor() as i64, (at.y / self.square_m).floor() as i64)
    }
}

impl Core {
    fn bounds(&self) -> (Point, Point) {
        let margin = Vector::new(self.radius_m, self.radius_m);
        (self.a.inf(&self.b) - margin, self.a.sup(&self.b) + margin)
    }

    /// For a place too close to the core, returns the place at `room_m` from the core in the same direction; if the
    /// first place is on the core's line itself, returns one such place on each side.
    fn feet(&self, at: Point, room_m: f64) -> Vec<Point> {
        let nearest = nearest_on_segment(self.a, self.b, at);
        let away = at - nearest;
        let off_m = self.radius_m + room_m;
        if away.norm() >= off_m {
            return Vec::new();
        }
        let along = self.b - self.a;
        let aside = Vector::new(-along.y, along.x);
        let ways = if away.norm() > TIE_M { vec![away] } else { vec![aside, -aside] };
        let ways = ways.into_iter().filter_map(|way| way.try_normalize(0.0));
        ways.map(|way| nearest + way * off_m).collect()
    }

    /// Returns the distance from the core to a segment, metres.
    fn way_m(&self, (a, b): (Point, Point)) -> f64 {
        if segments_cross(self.a, self.b, a, b) {
            return -self.radius_m;
        }
        let off_m = |from: Point, to: Point, at: Point| (at - nearest_on_segment(from, to, at)).norm();
        let ends_m = off_m(self.a, self.b, a).min(off_m(self.a, self.b, b));
        ends_m.min(off_m(a, b, self.a)).min(off_m(a, b, self.b)) - self.radius_m
    }
}
