//! Finds the way back.

use super::super::known::Known;
use crate::{
    tether::{Clearance, Tether},
    way_back::{Home, WayBack},
};
use world::{Obstacle, ObstacleId, Point, World, ZoneKind, polyline, shortest::NoWay};

/// Maximum number of times that a search for a path may ask whether to go on.
const MOST_STEPS: usize = 200_000;
/// Least clearance of a way beside a tether, metres: with less, the robot hardly moves on, and it cannot evade.
const LEAST_CLEARANCE_M: f64 = 0.02;
/// Minimum overlap of the hull with an object, metres, at which a new way is searched for. Found obstacles are placed
/// with about this accuracy.
const DOUBT_M: f64 = 0.02;

impl Known {
    /// The way back from here, with the most room.
    ///
    /// # Errors
    /// The reason why no way was found, as a sentence.
    pub(in crate::engine) fn way_back(&self) -> Result<WayBack, String> {
        let (to, path, slack_m) = match self.resting.as_ref().or(self.tether.as_ref()) {
            Some(tether) if tether.is_left_lying() => {
                let way = self.rest_of_way_beside(tether).map_or_else(|| self.way_beside(tether), Ok);
                (Home::Anchor, way?, Some(tether.excess_m()))
            }
            Some(tether) => (Home::Anchor, self.way_along(tether)?, None),
            None => (Home::Start, self.shortest_way(self.config.start.position)?, None),
        };
        let path = self.without_narrow_end(path);
        let clearance_m = self.hull_clearance_m(&path);
        Ok(WayBack { to, length_m: polyline::length_m(&path), clearance_m, path, slack_m })
    }

    /// The rest of the way beside the tether that was accepted, if the robot was stopped on it and it is still right.
    fn rest_of_way_beside(&self, tether: &Tether) -> Option<Vec<Point>> {
        let back = self.back.as_ref().filter(|back| back.is_beside)?;
        let is_right = tether.beside_lying() == Some(Clearance::Free) && self.is_way_back_free();
        let rest = self.led_from_here(back.follower.remaining().to_vec());
        let is_right = is_right && !self.dead_ends.are_on(&rest, self.config.limits.radius_m);
        (is_right && tether.is_clear(&rest, self.chart.world())).then_some(rest)
    }

    /// The way beside a tether that lies on the floor.
    ///
    /// # Errors
    /// The robot does not fit beside the tether; the remedies.
    fn way_beside(&self, tether: &Tether) -> Result<Vec<Point>, String> {
        let mut fenced = fenced(self.chart.world());
        fenced.obstacles.extend(self.dead_ends.obstacles());
        let least_m = self.config.limits.radius_m + LEAST_CLEARANCE_M;
        let beside = |room_m: f64| {
            tether.way_beside(&fenced, room_m.max(least_m)).filter(|way| self.is_free_from_here(way))
        };
        self.widest(beside).ok_or_else(|| {
            let (cause, remedy) = if tether.torn().is_some() {
                ("the tether is broken and lies on the floor", "")
            } else if tether.is_only_weak() {
                (
                    "the reel is too weak for the tether that is out, and may draw it across the floor at any moment",
                    ", or take the tether up by hand at the reel while the robot stands",
                )
            } else {
                ("the reel does not take the tether up", ", or repair the reel")
            };
            format!(
                "{cause}, and the hull does not fit beside the tether all the way to the anchor with {LEAST_CLEARANCE_M} m of \
                 clearance; end the mission here and \
                 fetch the robot by hand{remedy}"
            )
        })
    }

    /// Whether the rest of the way back is free.
    pub(super) fn is_way_back_free(&self) -> bool {
        self.is_free_from_here(self.back.as_ref().map_or(&[][..], |back| back.follower.remaining()))
    }

    fn is_free_from_here(&self, way: &[Point]) -> bool {
        let room_m = self.config.limits.radius_m - DOUBT_M;
        // The robot may be leaving a place without room.
        let mut ahead = way.iter().skip_while(|at| !self.chart.has_room(**at, room_m));
        ahead.all(|at| self.chart.has_room(*at, room_m))
    }

    /// The way on which the tether is only reeled in; if it is caught, it is freed first, and if it is slack, it is made taut
    /// first. No-go zones are avoided without changing the side on which any obstacle is passed; a zone in which the robot is
    /// may be left along the tether.
    fn way_along(&self, tether: &Tether) -> Result<Vec<Point>, String> {
        let fenced = fenced(self.chart.world());
        let along = |room_m: f64| {
            let out = self.outside(&self.chart, room_m)?;
            let mut there = tether.clone();
            there.drag_to(out);
            let is_caught = tether.is_snagged();
            let home = if is_caught {
                // Since the robot drove along this path, a no-go zone may have been drawn across it.
                there.way_out(&fenced, room_m).filter(|way| self.is_free_from_here(way))
            } else {
                // The same applies to the path on which a slack cable is made taut.
                let home = there.way_home(&fenced, room_m).filter(|way| self.is_free_from_here(way));
                home.or_else(|| there.return_path(&fenced, room_m))
            }?;
            Some(self.led_from_here(home))
        };
        // No way from the nearest place outside a zone may lead round the zone, while the tether leads straight out of it.
        let out_of_zone = |room_m: f64| {
            let home = self.led_from_here(tether.way_home(&self.around(), room_m)?);
            Some(home).filter(|home| self.is_free_from_here(home))
        };
        self.widest(along)
            .or_else(|| self.widest(out_of_zone))
            .or_else(|| self.retraced(tether))
            .ok_or_else(|| "the hull does not fit through the return path along the tether".into())
    }

    /// The tank with its no-go zones as obstacles, without the zones in which the hull is.
    fn around(&self) -> World {
        let mut world = self.chart.world().clone();
        let (here, hull_m) = (self.position(), self.config.limits.radius_m);
        world.zones.retain(|zone| zone.shape.distance_m(here) > hull_m);
        fenced(&world)
    }

    /// The path driven, backwards; `None` if the hull does not fit everywhere along it.
    fn retraced(&self, tether: &Tether) -> Option<Vec<Point>> {
        let room_m = self.config.limits.radius_m;
        let way: Vec<Point> = tether.way_driven().iter().rev().copied().collect();
        way.iter().all(|at| self.chart.has_room(*at, room_m)).then(|| self.led_from_here(way))
    }

    /// The shortest way to a place for a robot without a tether.
    fn shortest_way(&self, goal: Point) -> Result<Vec<Point>, String> {
        let mut why = "the hull does not fit where the robot is".to_owned();
        let way = |room_m: f64| {
            let start = self.outside(&self.chart, room_m)?;
            let mut steps = 0..MOST_STEPS;
            match self.floor_for(room_m, None).shortest(start, goal, &mut || steps.next().is_some()) {
                Ok(way) => Some(self.led_from_here(way.points())),
                Err(no_way) => {
                    why = words(no_way);
                    None
                }
            }
        };
        self.widest(way).ok_or(why)
    }

    /// The path, with the robot's position as its first point.
    fn led_from_here(&self, mut path: Vec<Point>) -> Vec<Point> {
        path.insert(0, self.position());
        path.dedup_by(|next, before| (*next - *before).norm() < 1e-6);
        path
    }

    /// The path without its last points at which the hull does not fit: an anchor may be close to a wall.
    fn without_narrow_end(&self, mut path: Vec<Point>) -> Vec<Point> {
        let fits = |at: &Point| self.chart.has_room(*at, self.config.limits.radius_m);
        while path.len() > 1 && path.last().is_some_and(|at| !fits(at)) {
            path.pop();
        }
        path
    }

    fn hull_clearance_m(&self, path: &[Point]) -> f64 {
        let map = self.chart.map();
        let at_points = path.iter().map(|at| map.clearance_m(*at));
        let between = path.windows(2).map(|pair| map.segment_clearance_m(pair[0], pair[1]));
        at_points.chain(between).fold(f64::INFINITY, f64::min) - self.config.limits.radius_m
    }
}

/// The tank with its no-go zones as obstacles.
fn fenced(world: &World) -> World {
    let zones = world.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo);
    let solid = zones.map(|zone| Obstacle {
        id: ObstacleId(u32::MAX),
        name: zone.name.clone(),
        shape: zone.shape.clone(),
        known: true,
    });
    World { obstacles: world.obstacles.iter().cloned().chain(solid).collect(), ..world.clone() }
}

/// The reason why no path leads back, as a sentence.
fn words(no_way: NoWay) -> String {
    match no_way {
        NoWay::StartBlocked { .. } => "the hull does not fit where the robot is".into(),
        NoWay::GoalBlocked { by_m, .. } => format!("the start is {by_m:.2} m too close to something solid"),
        NoWay::Unreachable { .. } => "no path leads back to the start".into(),
        NoWay::Stopped => format!("no path found within {MOST_STEPS} search steps"),
    }
}
