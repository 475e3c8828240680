//! The no-go zone that the operator is drawing or is asked about, and the part of the plan that it blocks.

use super::pen::Pen;
use super::{course, ink};
use crate::update::zones;
use crate::view::look::Look;
use ratatui::widgets::canvas::Context;
use world::{Point, Shape, polyline, shape::ring_area_m2};

/// Distance between the points at which the plan is compared with the zone, metres.
const PIECE_M: f64 = 0.1;

impl Pen<'_> {
    /// Draws the outline over the paths, because they may be dense; two points are only a line.
    pub(super) fn zone(&self, ctx: &mut Context<'_>) {
        let Some(corners) = zones::drawn(self.look.model) else { return };
        let ring: Vec<Point> = corners.iter().chain(corners.first()).copied().collect();
        self.draw(ctx, &ring, ink::OUTLINE);
    }

    /// Draws the parts of the plan ahead that the zone in the question blocks.
    pub(super) fn blocked(&self, ctx: &mut Context<'_>) {
        for part in blocked(&self.look) {
            self.draw(ctx, &part, ink::BLOCKED);
        }
    }
}

/// The parts of the plan ahead that the zone in the question blocks.
pub(super) fn blocked(look: &Look) -> Vec<Vec<Point>> {
    let asked = zones::asked(look.model).zip(course::course(look)).zip(look.run.about.as_ref());
    let Some(((mut vertices, course), about)) = asked else { return Vec::new() };
    if ring_area_m2(&vertices) < 0.0 {
        vertices.reverse();
    }
    let (shape, room_m) = (Shape::Polygon { vertices }, about.mission.room_m());
    let ahead = polyline::resampled(&course.track.path[course.leg.0..=course.ahead.1], PIECE_M);
    let is_blocked = |at: &Point| shape.distance_m(*at) < room_m;
    let parts = ahead.split(|at| !is_blocked(at)).filter(|part| part.len() > 1);
    parts.map(<[Point]>::to_vec).collect()
}
