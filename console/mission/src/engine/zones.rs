//! No-go zones that the operator draws during a mission.

use super::{
    Mission,
    driving::{Driving, Prepare},
    known::Known,
    role::Candidate,
};
use crate::{config::TaskConfig, event::EventKind, order::Order};
use planner_api::Reason;
use world::{Boundary, Point, Shape, Zone, ZoneKind, shape::ring_area_m2, shortest::GrownFloor};

/// Minimum area of a zone, square metres; a smaller zone was probably drawn by mistake and is refused. A zone with a
/// coordinate beyond [`FARTHEST_M`] is refused, too. The same limits apply to scenarios.
const LEAST_M2: f64 = 0.01;
const FARTHEST_M: f64 = 1e4;

impl Known {
    /// Refuses an impossible zone: one that contains the robot, or that covers a place where the robot must go.
    ///
    /// # Errors
    /// What is wrong, as a sentence.
    pub(super) fn check_place(&self, order: &Order) -> Result<(), String> {
        let Order::DrawZone(corners) = order else { return Ok(()) };
        let is_near = |corner: &Point| corner.x.abs() <= FARTHEST_M && corner.y.abs() <= FARTHEST_M;
        if !corners.iter().all(is_near) {
            return Err(format!("corners of a no-go zone must be within {FARTHEST_M} m of the origin"));
        }
        if corners.len() < 3 || ring_area_m2(corners).abs() < LEAST_M2 {
            return Err(format!("the corners of a no-go zone must enclose at least {LEAST_M2} m²"));
        }
        let shape = Shape::Polygon { vertices: corners.clone() };
        if is_outside(&shape, &self.chart.world().boundary) {
            return Err("the zone lies outside the tank; corners are in metres, tank frame".into());
        }
        let room_m = self.config.room_m();
        let is_within = |place: Point| shape.distance_m(place) < room_m;
        let must_keep = format!("{room_m:.2} m (hull radius and clearance) must stay clear");
        let here = self.locator.position();
        if is_within(here) {
            return Err(format!("the robot is in the zone or too close to it: {must_keep}"));
        }
        let end = match &self.config.task {
            TaskConfig::Cover { .. } if self.config.tether.is_some() => "anchor",
            TaskConfig::Cover { .. } => "start",
            TaskConfig::Goto { .. } => "goal",
            TaskConfig::Follow { .. } => "end of the path",
        };
        let end = self.config.task.end().map(|place| (end, place));
        let anchor = self.config.tether.as_ref().map(|tether| ("anchor", tether.anchor));
        let places: Vec<(&str, Point)> = end.into_iter().chain(anchor).collect();
        if let Some((what, _)) = places.iter().find(|(_, place)| is_within(*place)) {
            return Err(format!("the {what} is in the zone or too close to it: {must_keep}"));
        }
        let (before, behind) = (self.floor_outside(None), self.floor_outside(Some(&shape)));
        let is_way = |floor: &GrownFloor, to| floor.shortest(here, to, &mut || true).is_ok();
        let is_closed = |place: Point| !is_way(&behind, place) && is_way(&before, place);
        match places.iter().find(|(_, place)| is_closed(*place)) {
            Some((what, _)) => Err(format!("the zone would block every path from the robot to the {what}")),
            None => Ok(()),
        }
    }

    /// The floor that is available to the hull's centre outside the no-go zones: those already drawn and, if given, a new
    /// one.
    fn floor_outside(&self, zone: Option<&Shape>) -> GrownFloor {
        let (world, room_m) = (self.chart.world(), self.config.room_m());
        let zones = world.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo).map(|zone| &zone.shape);
        let solids = world.obstacles.iter().map(|obstacle| &obstacle.shape).chain(zones).chain(zone);
        GrownFloor::new(&world.boundary, room_m, solids.map(|shape| (shape, room_m)))
    }

    /// A name that no other zone has yet.
    fn free_name(&self) -> String {
        let zones = &self.chart.world().zones;
        let is_free = |name: &String| zones.iter().all(|zone| zone.name != *name);
        (1..=zones.len() + 1).map(|n| format!("no-go {n}")).find(is_free).unwrap_or_default()
    }
}

impl Mission {
    /// Closes a part of the floor: the part need not be scanned, and planners receive a map with the zone and plan again.
    /// The active planner keeps to its plan as far as possible.
    pub(super) fn draw_zone(&mut self, corners: &[Point]) {
        let shape = Shape::Polygon { vertices: corners.to_vec() };
        let zone = Zone { name: self.known.free_name(), kind: ZoneKind::NoGo, shape };
        let changes = self.known.floor.forbid(&self.known.config, &self.known.chart, &zone.shape);
        self.known.chart.draw(zone.clone());
        self.happened.push(EventKind::ZoneDrawn { zone });
        if !changes.is_empty() {
            self.happened.push(EventKind::FloorChanged { changes });
        }
        self.end_shadow();
        self.drop_better_plan("a no-go zone was drawn");
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
    }
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
