//! No-go zones that the operator draws under way.

use super::{Mission, slot::Prepare};
use crate::{config::TaskConfig, event::EventKind, phase::Phase};
use planner_api::Reason;
use world::{Point, Shape, Zone, ZoneKind, shape::ring_area_m2};

/// A smaller zone is a slip of the hand, square metres.
const LEAST_M2: f64 = 0.01;

impl Mission {
    /// Refuses a zone in which the robot stands already, or has to go.
    ///
    /// # Errors
    /// What is wrong, as a sentence.
    pub(super) fn check_zone(&self, zone: &Zone) -> Result<(), String> {
        let Shape::Polygon { vertices } = &zone.shape else {
            return Err("a no-go zone is drawn as a polygon".into());
        };
        let is_finite = vertices.iter().all(|corner| corner.x.is_finite() && corner.y.is_finite());
        let area_m2 = ring_area_m2(vertices).abs();
        if zone.kind != ZoneKind::NoGo || !is_finite || area_m2 < LEAST_M2 {
            return Err(format!("a no-go zone needs corners that enclose at least {LEAST_M2} m²"));
        }
        let is_taken = self.chart.world().zones.iter().any(|other| other.name == zone.name);
        if is_taken {
            return Err(format!("there is a zone with the name {} already", zone.name));
        }
        let room_m = self.config.room_m();
        let is_within = |place: Point| zone.shape.distance_m(place) < room_m;
        let must_keep = format!("{room_m:.2} m (hull radius and clearance) have to be left");
        if is_within(self.locator.position()) {
            return Err(format!("the robot stands in the zone or beside it: {must_keep}"));
        }
        let end = match &self.config.task {
            TaskConfig::Cover { anchor, .. } => Some(("anchor", *anchor)),
            TaskConfig::Goto { goal, .. } => Some(("goal", *goal)),
            TaskConfig::Follow { .. } => None,
        };
        match end {
            Some((what, place)) if is_within(place) => {
                Err(format!("the {what} lies in the zone or beside it: {must_keep}"))
            }
            _ => Ok(()),
        }
    }

    /// Forbids a part of the floor: what is in it need not be scanned, and planners begin again with it on their map. The one
    /// that drives keeps to its plan as far as it can.
    pub(super) fn draw_zone(&mut self, zone: &Zone) {
        let changes = self.floor.forbid(&self.config, &self.chart, &zone.shape);
        self.chart.draw(zone.clone());
        self.happened.push(EventKind::ZoneDrawn { zone: zone.clone() });
        if !changes.is_empty() {
            self.happened.push(EventKind::FloorChanged { changes });
        }
        self.end_shadow();
        let next = self.candidate.take().map(|mut slot| {
            self.workers.close(slot.leave_worker());
            slot.choice
        });
        let waiting = self.phase == Phase::Waiting;
        let reason = if waiting { Reason::Start } else { Reason::MapChanged };
        let mut again = self.active.successor(self.active.choice.clone(), reason);
        // Before the start it goes as far as it was: a plan that is on the screen already is made again.
        let stays = waiting && !self.active.has_plan();
        again.prepare = if stays { self.active.prepare } else { Prepare::Plan };
        self.replace_active(again);
        if let Some(choice) = next {
            let from = self.active.choice.id.clone();
            let mut slot = self.active.successor(choice, Reason::Swap { from });
            slot.prepare = Prepare::Plan;
            self.candidate = Some(slot);
        }
    }
}
