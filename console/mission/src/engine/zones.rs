//! No-go zones that the operator draws during a mission.

use super::{
    Mission,
    driving::{Driving, Prepare},
    happened::Happened,
    known::Known,
    role::Candidate,
};
use crate::{
    config::TaskConfig,
    event::{EventKind, OfferEnd},
    order::Order,
    phase::Phase,
    standing::PositionTrust,
    zone_cost::ZoneCost,
};
use geometry::PathFollower;
use planner_api::Reason;
use std::f64::consts::TAU;
use world::{Boundary, Point, Shape, Zone, ZoneKind, polyline, shape::ring_area_m2, shortest::GrownFloor};

/// Minimum area of a zone, square metres; a smaller zone was probably drawn by mistake and is refused. A zone with a
/// coordinate beyond [`FARTHEST_M`] is refused, too. The same limits apply to scenarios.
const LEAST_M2: f64 = 0.01;
const FARTHEST_M: f64 = 1e4;
/// Depth at which the hull counts as being in a zone, metres: the estimated position scatters by about this much.
const BREACH_M: f64 = 0.05;
/// Length of the pieces into which a plan is divided to find those that a zone closes, metres.
const PIECE_M: f64 = 0.1;
/// Maximum number of corners of a zone.
const MOST_CORNERS: usize = 64;
/// Sum of the turns of a ring, radians, above which the ring crosses itself; with some room for rounding.
const FULL_TURN_RAD: f64 = TAU + 1e-6;

impl Known {
    /// Refuses an order that the place of the robot, or the map, makes impossible.
    ///
    /// # Errors
    /// The reason, as a sentence.
    pub(super) fn check_place(&self, order: &Order) -> Result<(), String> {
        match order {
            Order::DrawZone(corners) => self.check_zone(corners),
            Order::DriveBack => self.way_back().map(|_| ()),
            _ => Ok(()),
        }
    }

    /// Refuses an impossible zone: one that covers a place where the robot must go, or that the robot cannot leave. Before
    /// the start, a zone that contains the robot is impossible, too; during the mission, it holds the robot.
    ///
    /// # Errors
    /// The reason, as a sentence.
    pub(super) fn check_zone(&self, corners: &[Point]) -> Result<(), String> {
        let is_near = |corner: &Point| corner.x.abs() <= FARTHEST_M && corner.y.abs() <= FARTHEST_M;
        if !corners.iter().all(is_near) {
            return Err(format!("corners of a no-go zone must be within {FARTHEST_M} m of the origin"));
        }
        if corners.len() < 3 || ring_area_m2(corners).abs() < LEAST_M2 {
            return Err(format!("the corners of a no-go zone must enclose at least {LEAST_M2} m²"));
        }
        if corners.len() > MOST_CORNERS {
            return Err(format!(
                "a no-go zone has at most {MOST_CORNERS} corners; this one has {}",
                corners.len()
            ));
        }
        if let Some(dent) = dent(corners) {
            let (x, y) = (dent.x, dent.y);
            return Err(format!(
                "the outline of the zone is not convex at {x:.2}, {y:.2} m; draw several zones instead"
            ));
        }
        let shape = Shape::Polygon { vertices: corners.to_vec() };
        if is_outside(&shape, &self.chart.world().boundary) {
            return Err("the zone lies outside the tank; corners are in metres, tank frame".into());
        }
        let room_m = self.config.room_m();
        let is_within = |place: Point| shape.distance_m(place) < room_m;
        let must_keep = format!("{room_m:.2} m (hull radius and clearance) must stay clear");
        let here = self.locator.position();
        if is_within(here) && self.is_waiting() {
            return Err(format!("the robot is in the zone or too close to it: {must_keep}"));
        }
        let end = match &self.config.task {
            TaskConfig::Cover { .. } | TaskConfig::Survey { .. } if self.config.tether.is_some() => "anchor",
            TaskConfig::Cover { .. } | TaskConfig::Survey { .. } => "start",
            TaskConfig::Goto { .. } => "goal",
            TaskConfig::Follow { .. } => "end of the path",
        };
        let end = self.config.task.end().map(|place| (end, place));
        let anchor = self.config.tether.as_ref().map(|tether| ("anchor", tether.anchor));
        let places: Vec<(&str, Point)> = end.into_iter().chain(anchor).collect();
        if let Some((what, _)) = places.iter().find(|(_, place)| is_within(*place)) {
            return Err(format!("the {what} is in the zone or too close to it: {must_keep}"));
        }
        let (before, behind) = (self.floor_for(room_m, None), self.floor_for(room_m, Some(&shape)));
        let is_way = |floor: &GrownFloor, from, to| floor.shortest(from, to, &mut || true).is_ok();
        let out = if is_within(here) { self.out_of(&shape)? } else { here };
        let is_closed = |place: Point| !is_way(&behind, out, place) && is_way(&before, here, place);
        match places.iter().find(|(_, place)| is_closed(*place)) {
            Some((what, _)) => Err(format!("the zone would block every path from the robot to the {what}")),
            None => Ok(()),
        }
    }

    /// Whether the robot would find no way back along its tether if the zone were drawn, although it finds one now.
    fn blocks_way_back(&self, zone: &Shape) -> bool {
        let mut after = self.clone();
        after.chart.draw(Zone { name: self.free_name(), kind: ZoneKind::NoGo, shape: zone.clone() });
        self.tether.is_some() && after.way_back().is_err() && self.way_back().is_ok()
    }

    /// The nearest place outside a zone that contains the robot, if the zone were drawn.
    ///
    /// # Errors
    /// The robot could not leave the zone; a sentence.
    fn out_of(&self, shape: &Shape) -> Result<Point, String> {
        let mut after = self.chart.clone();
        after.draw(Zone { name: self.free_name(), kind: ZoneKind::NoGo, shape: shape.clone() });
        let blocked =
            || "the robot could not leave the zone; draw a smaller one, or drive it out first".to_owned();
        self.outside(&after, self.config.room_m()).ok_or_else(blocked)
    }

    /// How deep the hull is in a zone according to the estimated position, metres; negative outside.
    fn depth_m(&self, zone: &Shape) -> f64 {
        self.config.limits.radius_m - zone.distance_m(self.position())
    }

    /// The floor that is available to the hull's centre if it needs `room_m` metres of room, outside the no-go zones:
    /// those already drawn and, if given, a new one.
    pub(super) fn floor_for(&self, room_m: f64, zone: Option<&Shape>) -> GrownFloor {
        let world = self.chart.world();
        let zones = world.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo).map(|zone| &zone.shape);
        let solids = world.obstacles.iter().map(|obstacle| &obstacle.shape).chain(zones).chain(zone);
        GrownFloor::new(&world.boundary, room_m, solids.map(|shape| (shape, room_m)))
    }

    /// Reports the no-go zones that the hull enters or leaves, according to a reliable position; returns one that it has
    /// entered in this tick. The estimate scatters, so the hull counts as inside only at some depth.
    pub(super) fn watch_zones(&mut self, happened: &mut Happened) -> Option<String> {
        if !matches!(self.phase, Phase::Running(_) | Phase::Held(_))
            || self.position_trust() != PositionTrust::Good
        {
            return None;
        }
        let mut entered = None;
        for zone in self.chart.world().zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo) {
            let depth_m = self.depth_m(&zone.shape);
            let known = self.breached.iter().position(|name| *name == zone.name);
            match known {
                None if depth_m > BREACH_M => {
                    self.breached.push(zone.name.clone());
                    entered.get_or_insert_with(|| zone.name.clone());
                    happened.push(EventKind::ZoneBreached { zone: zone.name.clone(), depth_m });
                }
                Some(known) if depth_m <= 0.0 => {
                    let zone = self.breached.swap_remove(known);
                    happened.push(EventKind::ZoneLeft { zone });
                }
                _ => {}
            }
        }
        entered
    }

    /// The cost of a zone.
    ///
    /// # Errors
    /// The reason why the zone would be refused, as a sentence.
    fn zone_cost(&self, corners: &[Point], plan: &[Point], drops_offer: bool) -> Result<ZoneCost, String> {
        self.check_zone(corners)?;
        let shape = Shape::Polygon { vertices: corners.to_vec() };
        let room_m = self.config.room_m();
        let pieces = polyline::resampled(plan, PIECE_M);
        let is_closed = |pair: &&[Point]| shape.distance_m(nalgebra::center(&pair[0], &pair[1])) < room_m;
        let path_m: f64 = pieces.windows(2).filter(is_closed).map(|pair| (pair[1] - pair[0]).norm()).sum();
        // An empty sum is -0.0.
        let path_m = path_m + 0.0;
        let mut after = self.floor.clone();
        after.forbid(&self.config, &self.chart, &shape);
        let left = |coverage| self.task.floor_left(coverage).len();
        let cell_m2 = after.coverage.floor().cell_m2();
        let closed = self.floor.coverage.counts().reachable.saturating_sub(after.coverage.counts().reachable);
        let lost = left(&self.floor.coverage).saturating_sub(left(&after.coverage));
        let area_m2 = |cells: usize| cells as f64 * cell_m2;
        let holds = self.depth_m(&shape) > BREACH_M;
        let blocks_way_back = self.blocks_way_back(&shape);
        let (closed_m2, lost_m2) = (area_m2(closed), area_m2(lost));
        Ok(ZoneCost { path_m, closed_m2, lost_m2, drops_offer, holds, blocks_way_back })
    }

    /// A name that no other zone has yet.
    fn free_name(&self) -> String {
        let zones = &self.chart.world().zones;
        let is_free = |name: &String| zones.iter().all(|zone| zone.name != *name);
        (1..=zones.len() + 1).map(|n| format!("no-go {n}")).find(is_free).unwrap_or_default()
    }
}

impl Mission {
    /// The cost of a no-go zone with these corners (metres, tank frame); nothing changes.
    ///
    /// Cost: a copy of the coverage grid, and one flood fill of the floor.
    ///
    /// # Errors
    /// The reason why [`Order::DrawZone`] would be refused, as a sentence.
    pub fn zone_cost(&self, corners: &[Point]) -> Result<ZoneCost, String> {
        let order = Order::DrawZone(Vec::new());
        self.standing().allows(&order).map_err(|why| why.to_string())?;
        let path = self.driving.course.follower.as_ref().map(PathFollower::remaining);
        let plan = self.known.task.lanes_left().or(path).unwrap_or_default();
        self.known.zone_cost(corners, plan, self.offer_stage().is_some())
    }

    /// Closes a part of the floor: the part need not be scanned, and planners receive a map with the zone and plan again.
    /// The active planner keeps to its plan as far as possible.
    pub(super) fn draw_zone(&mut self, corners: &[Point]) {
        let mut vertices = corners.to_vec();
        if ring_area_m2(corners) < 0.0 {
            vertices.reverse();
        }
        let shape = Shape::Polygon { vertices };
        let zone = Zone { name: self.known.free_name(), kind: ZoneKind::NoGo, shape };
        let changes = self.known.floor.forbid(&self.known.config, &self.known.chart, &zone.shape);
        self.known.chart.draw(zone.clone());
        self.happened.push(EventKind::ZoneDrawn { zone });
        if !changes.is_empty() {
            self.happened.push(EventKind::FloorChanged { changes });
        }
        self.end_shadow();
        self.drop_better_plan(OfferEnd::ZoneDrawn);
        let next = self.preparing.as_ref().map(|preparing| preparing.worker.choice.clone());
        self.drop_preparing();
        let waiting = self.known.is_waiting();
        let reason = if waiting { Reason::Start } else { Reason::MapChanged };
        let again = self.driving.worker.successor(self.driving.worker.choice.clone());
        // Before the start, the old plan is marked for repair, so a plan that is already on the screen is made again.
        let stays = waiting && !self.driving.course.has_plan();
        let prepare = if stays { self.driving.prepare } else { Prepare::Plan };
        self.replace_driving(Driving::new(again, reason, prepare));
        if let Some(choice) = next {
            let reason = Reason::Swap { from: self.driving.id().to_owned() };
            let worker = self.driving.worker.successor(choice);
            self.preparing = Some(Candidate::prepare(worker, reason, None));
        }
        self.doubt_way_back();
    }
}

/// The first corner at which a ring of either orientation turns inward, or turns for the second time round.
fn dent(corners: &[Point]) -> Option<Point> {
    let n = corners.len();
    let side = |k: usize| corners[(k + 1) % n] - corners[k % n];
    let sense = ring_area_m2(corners).signum();
    let mut turned_rad = 0.0;
    (0..n)
        .map(|k| {
            let (into, onward) = (side(k), side(k + 1));
            let turn_rad = sense * into.perp(&onward).atan2(into.dot(&onward));
            (turn_rad, corners[(k + 1) % n])
        })
        .find(|(turn_rad, _)| {
            turned_rad += turn_rad;
            *turn_rad < 0.0 || turned_rad > FULL_TURN_RAD
        })
        .map(|(_, at)| at)
}

/// Whether a shape is outside a wall. With straight walls, everything within the bounding box of the wall counts as
/// inside.
fn is_outside(shape: &Shape, wall: &Boundary) -> bool {
    if let Boundary::Circle { radius_m } = wall {
        return shape.distance_m(Point::origin()) >= *radius_m;
    }
    let ((low, high), (wall_low, wall_high)) = (shape.bounds(), wall.bounds());
    low.x >= wall_high.x || low.y >= wall_high.y || high.x <= wall_low.x || high.y <= wall_low.y
}
