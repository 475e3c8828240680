//! Places from which the hidden side of an object can be seen.

use crate::{bodies::Body, survey::Exploration, ways::Ways};
use geometry::{Point, unit_vector};

/// Angle at the centre of an object without echoes above which its hidden side is worth a look, radians.
const HIDDEN_RAD: f64 = 1.8;
/// Distance from the hull's room around the object, metres: from there, its whole side is seen.
const BACK_M: f64 = 0.4;
/// Maximum extent of an object that is looked at from behind, metres; longer ones are walls.
const LARGEST_M: f64 = 3.0;

/// A place from which the hidden side of an object can be seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Where the hull's centre can go.
    pub at: Point,
    /// Cost of the way to that place, metres.
    pub cost_m: f64,
}

impl Exploration {
    /// The places from which the hidden sides of objects can be seen, the nearest first.
    pub fn views(&self, ways: &Ways<'_>) -> Vec<View> {
        let mut views: Vec<View> = self.bodies().iter().filter_map(|body| behind(body, ways)).collect();
        views.sort_by(|a, b| a.cost_m.total_cmp(&b.cost_m));
        views
    }
}

fn behind(body: &Body, ways: &Ways<'_>) -> Option<View> {
    let (low, high) = body.bounds();
    let circle =
        body.circle.filter(|circle| circle.gap_rad > HIDDEN_RAD && (high - low).max() < LARGEST_M)?;
    // A few points on one side may lie on a circle of any size.
    let size_m = (high - low).norm();
    let radius_m = circle.radius_m.min(size_m);
    let center = if circle.radius_m > size_m { nalgebra::center(&low, &high) } else { circle.center };
    let at = center + unit_vector(circle.gap_at_rad) * (radius_m + ways.room_m + BACK_M);
    let cell = ways.near(at)?;
    Some(View { at: ways.grid().center(cell), cost_m: ways.cost_m(cell) })
}
