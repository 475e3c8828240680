//! A no-go zone that the operator is drawing on the map.

use mission::outline;
use serde::{Deserialize, Serialize};
use world::Point;

/// A side or radius that is not longer than this counts as not drawn yet, metres.
const LEAST_M: f64 = 1e-6;

/// The form of the zone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Form {
    /// A box between two opposite corners.
    #[default]
    Box,
    /// A circle: its centre, then a point on its edge.
    Circle,
    /// A convex polygon, corner by corner.
    Polygon,
}

impl Form {
    /// The form after this one.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Self::Box => Self::Circle,
            Self::Circle => Self::Polygon,
            Self::Polygon => Self::Box,
        }
    }
}

/// A no-go zone being drawn. The map cursor is its next point.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ZoneDraft {
    /// The form of the zone.
    pub form: Form,
    /// The points that are set, metres, tank frame: a corner or the centre, and for a polygon every corner so far.
    pub points: Vec<Point>,
}

impl ZoneDraft {
    /// A zone with its first point.
    pub fn begun(at: Point) -> Self {
        Self { form: Form::default(), points: vec![at] }
    }

    /// The outline of the zone with the cursor as its last point: corners, metres, tank frame. Fewer than three if the
    /// zone has no area yet.
    pub fn corners(&self, cursor: Point) -> Vec<Point> {
        let Some(first) = self.points.first().copied() else { return Vec::new() };
        match self.form {
            Form::Box if (cursor - first).iter().all(|side_m| side_m.abs() > LEAST_M) => {
                outline::boxed(first, cursor)
            }
            Form::Circle if (cursor - first).norm() > LEAST_M => {
                outline::round(first, (cursor - first).norm())
            }
            Form::Box | Form::Circle => vec![first, cursor],
            Form::Polygon => {
                let mut corners = self.points.clone();
                if !corners.contains(&cursor) {
                    corners.push(cursor);
                }
                corners
            }
        }
    }

    /// Changes the form; only a polygon keeps more than its first point.
    pub fn reshape(&mut self) {
        self.form = self.form.next();
        self.points.truncate(1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cursor_completes_each_form() {
        let cursor = Point::new(3.0, 2.0);
        let mut draft = ZoneDraft::begun(Point::new(1.0, 1.0));
        assert_eq!(draft.corners(cursor).len(), 4);
        assert_eq!(draft.corners(Point::new(3.0, 1.0)).len(), 2, "a box without area");
        draft.reshape();
        let circle = draft.corners(cursor);
        let far = circle.iter().all(|corner| (corner - draft.points[0]).norm() >= 5.0_f64.sqrt() - 1e-9);
        assert!(circle.len() > 8 && far, "the circle goes through the cursor");
        draft.reshape();
        draft.points.push(Point::new(3.0, 1.0));
        assert_eq!(draft.corners(cursor), [Point::new(1.0, 1.0), Point::new(3.0, 1.0), cursor]);
        assert_eq!(draft.corners(Point::new(3.0, 1.0)).len(), 2, "the cursor is on the last corner");
        draft.reshape();
        assert_eq!((draft.form, draft.points.len()), (Form::Box, 1));
    }
}
