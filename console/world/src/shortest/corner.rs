//! The circles that a path can turn about, and the free bearings on them.

use super::bar::{Bar, Bars, TOUCH_M};
use geometry::{Point, Vector, unit_vector};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Difference between bearings that counts as a rounding error, radians.
pub(super) const ROUNDING_RAD: f64 = 1e-7;

/// An interval of bearings, counter-clockwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Span {
    /// The start, in [0, 2 pi), radians.
    pub from_rad: f64,
    /// The end, radians: not less than `from_rad`, and at most a full turn beyond it.
    pub to_rad: f64,
}

/// A span as directions, so that tests need no angles.
#[derive(Debug, Clone, Copy)]
struct Sector {
    from: Vector,
    middle: Vector,
    to: Vector,
    is_wide: bool,
}

impl Sector {
    fn new(span: &Span) -> Self {
        let is_wide = span.to_rad - span.from_rad > PI;
        Self {
            from: unit_vector(span.from_rad),
            middle: unit_vector(f64::midpoint(span.from_rad, span.to_rad)),
            to: unit_vector(span.to_rad),
            is_wide,
        }
    }

    fn contains(&self, direction: Vector) -> bool {
        let (after, before) = (self.from.perp(&direction), direction.perp(&self.to));
        if self.is_wide {
            after >= -ROUNDING_RAD || before >= -ROUNDING_RAD
        } else {
            // A narrow sector must not be mistaken for its opposite.
            let is_ahead = self.middle.dot(&direction) >= -ROUNDING_RAD;
            after >= -ROUNDING_RAD && before >= -ROUNDING_RAD && is_ahead
        }
    }
}

/// A circle that paths can turn about.
#[derive(Debug, Clone)]
pub(super) struct Corner {
    pub center: Point,
    pub radius_m: f64,
    /// The bearings at which nothing else covers the circle; one span of a full turn if the circle is entirely free.
    pub free: Vec<Span>,
    sectors: Vec<Sector>,
}

impl Corner {
    pub(super) fn new(center: Point, radius_m: f64, bars: &Bars, round_wall_m: Option<f64>) -> Self {
        let circle = Circle { center, radius_m };
        let mut covered = Vec::new();
        for bar in bars.near(center, radius_m) {
            circle.cover(bar, &mut covered);
        }
        if let Some(wall_m) = round_wall_m.filter(|wall_m| center.coords.norm() + radius_m > *wall_m) {
            let cuts = circle.cuts_with_circle(Point::origin(), wall_m);
            circle.split(&cuts, &mut covered, |at| at.coords.norm() > wall_m + TOUCH_M);
        }
        let free = complement(covered);
        let sectors = free.iter().map(Sector::new).collect();
        Self { center, radius_m, free, sectors }
    }

    /// Whether the bearing of a unit vector is free.
    pub(super) fn is_free(&self, direction: Vector) -> bool {
        let is_whole = self.free.first().is_some_and(|span| span.to_rad - span.from_rad >= TAU);
        is_whole || self.sectors.iter().any(|sector| sector.contains(direction))
    }

    /// Returns how far a path can turn from a bearing, counter-clockwise and clockwise, radians; `None` where the
    /// bearing is not free.
    pub(super) fn room_rad(&self, bearing_rad: f64) -> Option<(f64, f64)> {
        let (span, past_rad) = self.span(bearing_rad)?;
        if span.to_rad - span.from_rad >= TAU {
            return Some((TAU, TAU));
        }
        Some(((span.to_rad - span.from_rad - past_rad).max(0.0), past_rad.max(0.0)))
    }

    /// Returns the span that contains a bearing, and the angle from its beginning.
    fn span(&self, bearing_rad: f64) -> Option<(&Span, f64)> {
        self.free.iter().find_map(|span| {
            let past_rad = (bearing_rad - span.from_rad + ROUNDING_RAD).rem_euclid(TAU) - ROUNDING_RAD;
            (past_rad <= span.to_rad - span.from_rad + ROUNDING_RAD).then_some((span, past_rad))
        })
    }
}

/// Returns the angle from one bearing to another, counter-clockwise (`turn` 1) or clockwise (-1), in [0, 2 pi). An
/// angle that is a full turn to within rounding errors becomes zero.
pub(super) fn turned_rad(from_rad: f64, to_rad: f64, turn: f64) -> f64 {
    ((to_rad - from_rad) * turn + ROUNDING_RAD).rem_euclid(TAU) - ROUNDING_RAD
}

struct Circle {
    center: Point,
    radius_m: f64,
}

impl Circle {
    fn at(&self, bearing_rad: f64) -> Point {
        self.center + unit_vector(bearing_rad) * self.radius_m
    }

    /// Adds the bearings that a bar covers.
    fn cover(&self, bar: &Bar, covered: &mut Vec<Span>) {
        let along = bar.b - bar.a;
        // If the circle is the round end of a bar of the same thickness, the half that faces along the bar is
        // covered.
        if (bar.radius_m - self.radius_m).abs() < TOUCH_M {
            for (end, along) in [(bar.a, along), (bar.b, -along)] {
                if end == self.center {
                    if along != Vector::zeros() {
                        covered.push(Span::about(along.y.atan2(along.x), FRAC_PI_2));
                    }
                    return;
                }
            }
        }
        let mut cuts = self.cuts_with_circle(bar.a, bar.radius_m);
        if let Some(along) = along.try_normalize(0.0) {
            cuts.extend(self.cuts_with_circle(bar.b, bar.radius_m));
            let across = Vector::new(-along.y, along.x);
            for side in [across, -across] {
                cuts.extend(self.cuts_with_line(bar.a + side * bar.radius_m, side));
            }
        }
        self.split(&cuts, covered, |at| bar.distance_m(at) < -TOUCH_M);
    }

    /// Adds those intervals between cuts that are covered at their midpoints.
    fn split(&self, cuts: &[f64], covered: &mut Vec<Span>, is_covered: impl Fn(Point) -> bool) {
        let mut cuts: Vec<f64> = cuts.iter().map(|cut| cut.rem_euclid(TAU)).collect();
        cuts.sort_by(f64::total_cmp);
        let Some(&first) = cuts.first() else {
            if is_covered(self.at(0.0)) {
                covered.push(Span::about(0.0, PI));
            }
            return;
        };
        let ends = cuts.iter().copied().skip(1).chain([first + TAU]);
        for (from_rad, to_rad) in cuts.iter().copied().zip(ends) {
            if is_covered(self.at(f64::midpoint(from_rad, to_rad))) {
                covered.push(Span { from_rad, to_rad });
            }
        }
    }

    /// Returns the bearings at which another circle intersects this one.
    fn cuts_with_circle(&self, center: Point, radius_m: f64) -> Vec<f64> {
        let way = center - self.center;
        let apart_m = way.norm();
        if apart_m < TOUCH_M {
            return Vec::new();
        }
        let cos =
            (self.radius_m.powi(2) + apart_m.powi(2) - radius_m.powi(2)) / (2.0 * apart_m * self.radius_m);
        around(way, cos)
    }

    /// Returns the bearings at which a line intersects the circle; the line is given by a point and its unit normal.
    fn cuts_with_line(&self, on: Point, normal: Vector) -> Vec<f64> {
        around(normal, (on - self.center).dot(&normal) / self.radius_m)
    }
}

/// Returns the two bearings whose angle to a direction has this cosine.
fn around(direction: Vector, cos: f64) -> Vec<f64> {
    if cos.abs() > 1.0 {
        return Vec::new();
    }
    let (middle_rad, half_rad) = (direction.y.atan2(direction.x), cos.acos());
    vec![middle_rad - half_rad, middle_rad + half_rad]
}

impl Span {
    fn about(middle_rad: f64, half_rad: f64) -> Self {
        let from_rad = (middle_rad - half_rad).rem_euclid(TAU);
        Self { from_rad, to_rad: from_rad + 2.0 * half_rad }
    }
}

/// Returns the bearings that no span covers.
fn complement(mut covered: Vec<Span>) -> Vec<Span> {
    covered.sort_by(|a, b| a.from_rad.total_cmp(&b.from_rad));
    let Some(first) = covered.first() else {
        return vec![Span { from_rad: 0.0, to_rad: TAU }];
    };
    // One full turn from the start of the first span. A span that extends beyond the end is carried over to the
    // start.
    let begin_rad = first.from_rad;
    let carried_rad = covered.iter().map(|span| span.to_rad - TAU).fold(begin_rad, f64::max);
    let mut reached_rad = carried_rad;
    let mut free = Vec::new();
    for span in &covered {
        if span.from_rad > reached_rad + TOUCH_M {
            free.push(Span { from_rad: reached_rad.rem_euclid(TAU), to_rad: span.from_rad });
        }
        reached_rad = reached_rad.max(span.to_rad);
    }
    if begin_rad + TAU > reached_rad + TOUCH_M {
        let from_rad = reached_rad.rem_euclid(TAU);
        free.push(Span { from_rad, to_rad: from_rad + begin_rad + TAU - reached_rad });
    }
    free
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn bar() -> impl Strategy<Value = Bar> {
        let at = || (-3.0..3.0_f64, -3.0..3.0_f64).prop_map(|(x, y)| Point::new(x, y));
        (at(), at(), any::<bool>(), 0.1..2.0_f64).prop_map(|(a, b, disc, radius_m)| Bar {
            a,
            b: if disc { a } else { b },
            radius_m,
        })
    }

    proptest! {
        #[test]
        fn a_bearing_is_free_exactly_where_nothing_covers_it(
            bars in prop::collection::vec(bar(), 1..6),
            bearing in 0.0..TAU,
            radius_m in 0.2..2.0_f64,
            wall_m in 0.5..4.0_f64,
        ) {
            let corner = Corner::new(Point::new(0.3, -0.2), radius_m, &Bars::new(bars.clone()), Some(wall_m));
            let at = corner.center + Vector::new(bearing.cos(), bearing.sin()) * radius_m;
            let clear_m = bars.iter().map(|b| b.distance_m(at)).fold(wall_m - at.coords.norm(), f64::min);
            prop_assume!(clear_m.abs() > 1e-5);
            let direction = Vector::new(bearing.cos(), bearing.sin());
            prop_assert_eq!(corner.is_free(direction), clear_m > 0.0);
            prop_assert_eq!(corner.room_rad(bearing).is_some(), clear_m > 0.0);
        }
    }

    #[test]
    fn the_corner_of_a_square_is_free_for_a_quarter_turn() {
        let radius_m = 0.5;
        let at = Point::new(1.0, 1.0);
        let left = Bar { a: Point::new(-1.0, 1.0), b: at, radius_m };
        let below = Bar { a: at, b: Point::new(1.0, -1.0), radius_m };
        let corner = Corner::new(at, radius_m, &Bars::new(vec![left, below]), None);
        assert_eq!(corner.free.len(), 1);
        let (ahead_rad, back_rad) = corner.room_rad(0.2).unwrap();
        assert!((ahead_rad - (FRAC_PI_2 - 0.2)).abs() < 1e-9 && (back_rad - 0.2).abs() < 1e-9);
        let is_free = |rad: f64| corner.is_free(Vector::new(rad.cos(), rad.sin()));
        assert!(is_free(0.0) && is_free(FRAC_PI_2) && !is_free(-0.1) && !is_free(PI));
    }
}
