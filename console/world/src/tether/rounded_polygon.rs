//! A convex polygon with rounded corners: a part of an obstacle that a cable and a robot cannot enter.

use geometry::{
    Point, Shape, Vector,
    polyline::{edges, length_m, nearest_on_segment, segments_cross},
    shape::{bounds_of, mean_of, ring_area_m2},
    unit_vector,
};
use std::f64::consts::TAU;

/// Number of tangents that form the outline of a round core.
const TANGENTS: u32 = 24;
/// Distance from an edge below which the direction away from the edge is only rounding noise, metres.
const ON_EDGE_M: f64 = 1e-9;

/// All points within a radius of the core: a convex polygon, a segment or a point.
#[derive(Debug, Clone)]
pub(super) struct RoundedPolygon {
    /// One point, two points, or more, counter-clockwise.
    core: Vec<Point>,
    radius_m: f64,
    middle: Point,
    reach_m: f64,
    /// A circumscribed polygon, counter-clockwise.
    outline: Vec<Point>,
}

impl RoundedPolygon {
    /// Returns the parts of an obstacle grown by a margin: one part, or one for each segment of a polyline.
    pub(super) fn parts_of(shape: &Shape, margin_m: f64) -> Vec<Self> {
        match shape {
            Shape::Disc { center, radius_m } => vec![Self::new(vec![*center], radius_m + margin_m)],
            Shape::Polygon { vertices } => vec![Self::new(vertices.clone(), margin_m)],
            Shape::Polyline { points, half_width_m } => {
                points.windows(2).map(|w| Self::new(w.to_vec(), half_width_m + margin_m)).collect()
            }
        }
    }

    /// Creates the set of points within a radius of a core, which has at least one point.
    pub(super) fn new(mut core: Vec<Point>, radius_m: f64) -> Self {
        if core.len() > 2 && ring_area_m2(&core) < 0.0 {
            core.reverse();
        }
        let middle = mean_of(&core);
        let reach_m = core.iter().map(|p| (p - middle).norm()).fold(0.0, f64::max) + radius_m;
        let outline = if radius_m > 0.0 { outline_of(&core, radius_m) } else { core.clone() };
        Self { core, radius_m, middle, reach_m, outline }
    }

    /// Returns the south-west and north-east corners of the bounding box.
    pub(super) fn bounds(&self) -> (Point, Point) {
        let far = Vector::new(self.radius_m, self.radius_m);
        let (low, high) = bounds_of(&self.core);
        (low - far, high + far)
    }

    /// Whether a segment certainly stays clear of the shape; a quick test.
    fn is_far_from(&self, a: Point, b: Point) -> bool {
        let nearest = nearest_on_segment(a, b, self.middle);
        (nearest - self.middle).norm_squared() > self.reach_m * self.reach_m
    }

    /// Returns the distance from a segment, metres; zero or negative if the segment touches or enters the shape.
    pub(super) fn distance_m(&self, a: Point, b: Point) -> f64 {
        if let [only] = self.core[..] {
            return (nearest_on_segment(a, b, only) - only).norm() - self.radius_m;
        }
        let from_edges =
            edges(&self.core).map(|(p, q)| between_segments_m(a, b, p, q)).fold(f64::INFINITY, f64::min);
        let inside = self.core.len() > 2 && clip(&self.core, a, b, 0.0).is_some();
        if inside { -from_edges - self.radius_m } else { from_edges - self.radius_m }
    }

    /// Whether a segment enters the shape by more than a tolerance.
    pub(super) fn is_entered_by(&self, a: Point, b: Point, slack_m: f64) -> bool {
        if self.is_far_from(a, b) {
            return false;
        }
        if self.radius_m > slack_m {
            return self.distance_m(a, b) < -slack_m;
        }
        self.core.len() > 2 && clip(&self.core, a, b, slack_m).is_some()
    }

    /// Returns the part of a segment within the outline, as the shares of the segment at which this part begins and
    /// ends.
    pub(super) fn inside(&self, a: Point, b: Point) -> Option<(f64, f64)> {
        if self.is_far_from(a, b) { None } else { clip(&self.outline, a, b, 0.0) }
    }

    /// Returns where a segment enters the outline, as a share of the segment; for sorting.
    pub(super) fn met_at(&self, a: Point, b: Point) -> f64 {
        clip(&self.outline, a, b, 0.0).map_or(0.0, |(first, _)| first)
    }

    /// For a point inside, returns the nearest point outside; for a point outside, `None`.
    pub(super) fn pushed_out(&self, point: Point, slack_m: f64) -> Option<Point> {
        if self.is_far_from(point, point) || self.distance_m(point, point) >= -slack_m {
            return None;
        }
        let inside_core = self.core.len() > 2 && clip(&self.core, point, point, 0.0).is_some();
        let (nearest, normal) = edges(&self.core)
            .map(|(p, q)| (nearest_on_segment(p, q, point), Vector::new(q.y - p.y, p.x - q.x)))
            .min_by(|(p, _), (q, _)| (p - point).norm_squared().total_cmp(&(q - point).norm_squared()))?;
        // On the edge itself, the direction away from it is only rounding noise.
        let off = point - nearest;
        let away = if inside_core || off.norm() < ON_EDGE_M { normal } else { off };
        let away = away.try_normalize(f64::MIN_POSITIVE).unwrap_or_else(Vector::x);
        Some(nearest + away * (self.radius_m + 2.0 * slack_m))
    }

    /// Returns the corners of the shorter detour, for a segment that enters the shape.
    pub(super) fn detour(&self, a: Point, b: Point) -> Vec<Point> {
        self.detour_and_feet(a, b).map_or_else(Vec::new, |(_, way, _)| way)
    }

    /// Returns the shorter detour, with both ends first led out to the outline. From there the detour is clear. Without
    /// this step, an end between the rounded polygon and its outline might be visible from the last corner only through
    /// the polygon.
    pub(super) fn detour_outside(&self, a: Point, b: Point) -> Vec<Point> {
        let Some((enter, mut way, leave)) = self.detour_and_feet(a, b) else { return Vec::new() };
        way.insert(0, enter);
        way.push(leave);
        way
    }

    /// Returns where a segment enters the outline, the corners of the shorter detour, and where the segment leaves the
    /// outline.
    fn detour_and_feet(&self, a: Point, b: Point) -> Option<(Point, Vec<Point>, Point)> {
        let (first, last) = clip(&self.outline, a, b, 0.0)?;
        let (from, enter) = self.on_outline(a + (b - a) * first);
        let (to, leave) = self.on_outline(a + (b - a) * last);
        let left = self.corners(from, to);
        let mut right = self.corners(to, from);
        right.reverse();
        let detour_m = |corners: &[Point]| length_m(&[&[enter][..], corners, &[leave]].concat());
        let is_left = detour_m(&left) <= detour_m(&right);
        Some((enter, if is_left { left } else { right }, leave))
    }

    /// Returns the corners passed when walking counter-clockwise from one edge of the outline to another.
    fn corners(&self, from: usize, to: usize) -> Vec<Point> {
        let n = self.outline.len();
        let steps = (to + n - from) % n;
        (1..=steps).map(|k| self.outline[(from + k) % n]).collect()
    }

    /// Returns the nearest edge of the outline, and the nearest point on it.
    fn on_outline(&self, point: Point) -> (usize, Point) {
        let feet = edges(&self.outline).map(|(p, q)| nearest_on_segment(p, q, point)).enumerate();
        feet.min_by(|(_, p), (_, q)| (p - point).norm_squared().total_cmp(&(q - point).norm_squared()))
            .unwrap_or((0, point))
    }
}

/// Returns a polygon of tangents: those along the edges of the core, and some in all directions.
fn outline_of(core: &[Point], radius_m: f64) -> Vec<Point> {
    let mut bearings: Vec<f64> = (0..TANGENTS).map(|k| TAU * f64::from(k) / f64::from(TANGENTS)).collect();
    if core.len() > 1 {
        bearings.extend(edges(core).map(|(p, q)| (p.x - q.x).atan2(q.y - p.y).rem_euclid(TAU)));
    }
    bearings.sort_by(f64::total_cmp);
    bearings.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
    let tangent = |bearing: f64| {
        let normal = unit_vector(bearing);
        let far = core.iter().map(|p| normal.dot(&p.coords)).fold(f64::NEG_INFINITY, f64::max);
        (normal, far + radius_m)
    };
    let n = bearings.len();
    (0..n)
        .map(|k| {
            let ((m, g), (o, h)) = (tangent(bearings[k]), tangent(bearings[(k + 1) % n]));
            let det = m.perp(&o);
            Point::new((g * o.y - h * m.y) / det, (m.x * h - o.x * g) / det)
        })
        .collect()
}

/// Returns the part of a segment within a convex polygon shrunk by a tolerance, as the shares of the segment at which
/// this part begins and ends.
fn clip(ring: &[Point], a: Point, b: Point, slack_m: f64) -> Option<(f64, f64)> {
    let along = b - a;
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for (p, q) in edges(ring) {
        let edge = q - p;
        let scale = edge.norm();
        if scale == 0.0 {
            continue;
        }
        // The inside is to the left of every edge.
        let depth = edge.perp(&(a - p)) / scale - slack_m;
        let rate = edge.perp(&along) / scale;
        if rate == 0.0 {
            if depth <= 0.0 {
                return None;
            }
        } else if rate > 0.0 {
            first = first.max(-depth / rate);
        } else {
            last = last.min(-depth / rate);
        }
        if first >= last && !(along.norm_squared() == 0.0 && first <= last) {
            return None;
        }
    }
    Some((first, last))
}

/// Returns the distance between two segments, metres; 0 if they cross.
fn between_segments_m(a: Point, b: Point, p: Point, q: Point) -> f64 {
    if segments_cross(a, b, p, q) {
        return 0.0;
    }
    let gap = |s: Point, t: Point, x: Point| (nearest_on_segment(s, t, x) - x).norm_squared();
    gap(a, b, p).min(gap(a, b, q)).min(gap(p, q, a)).min(gap(p, q, b)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_detour_around_a_disc_takes_the_side_on_which_the_segment_passes_its_centre() {
        let disc = RoundedPolygon::new(vec![Point::origin()], 0.5);
        let (a, b) = (Point::new(-2.0, 0.1), Point::new(2.0, 0.1));
        assert!(disc.is_entered_by(a, b, 1e-9));
        let way = disc.detour(a, b);
        assert!(way.len() > 4 && way.iter().all(|p| p.y > 0.0 && p.coords.norm() >= 0.5), "{way:?}");
    }

    #[test]
    fn the_detour_to_a_point_just_behind_a_disc_does_not_cut_into_it() {
        let disc = RoundedPolygon::new(vec![Point::origin()], 0.4);
        let from = Point::new(-5.0, 0.4);
        for step in 1..60 {
            // Points on the disc, behind the point where the line of sight touches the disc.
            let angle = 0.5 * std::f64::consts::PI - 0.02 * f64::from(step);
            let to = Point::new(angle.cos(), angle.sin()) * 0.4;
            let mut way = vec![from];
            way.extend(disc.detour_outside(from, to));
            way.push(to);
            assert!(way.windows(2).all(|w| disc.distance_m(w[0], w[1]) > -1e-9), "{angle}: {way:?}");
        }
    }

    #[test]
    fn a_point_inside_is_pushed_to_the_nearest_edge() {
        let square = vec![Point::new(0., 0.), Point::new(2., 0.), Point::new(2., 2.), Point::new(0., 2.)];
        let out = RoundedPolygon::new(square.clone(), 0.0).pushed_out(Point::new(1.0, 0.2), 1e-9).unwrap();
        assert!((out - Point::new(1.0, 0.0)).norm() < 1e-6, "{out}");
        let out = RoundedPolygon::new(square, 0.3).pushed_out(Point::new(1.0, -0.2), 1e-9).unwrap();
        assert!((out - Point::new(1.0, -0.3)).norm() < 1e-6, "{out}");
    }

    #[test]
    fn a_segment_along_an_edge_does_not_enter() {
        let square = vec![Point::new(0., 0.), Point::new(2., 0.), Point::new(2., 2.), Point::new(0., 2.)];
        let solid = RoundedPolygon::new(square, 0.0);
        assert!(!solid.is_entered_by(Point::new(-1.0, 0.0), Point::new(3.0, 0.0), 1e-9));
        assert!(solid.is_entered_by(Point::new(-1.0, 0.1), Point::new(3.0, 0.1), 1e-9));
    }
}
