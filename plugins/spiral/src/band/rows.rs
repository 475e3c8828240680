//! The limits of a band: linear combinations of its points, and the values permitted for them.

use geometry::convex::Part;
use world::{Point, Vector, polyline};

/// Penalties for solids and for turns.
const SOLID_PENALTY: f64 = 1.0;
const TURN_PENALTY: f64 = 15.0;
/// Distance, in addition to the clearance, within which a segment gets a row for a solid, metres.
const REACH_M: f64 = 0.25;

/// The permitted values of a combination of points.
#[derive(Debug, Clone, Copy)]
pub(super) enum Limit<'a> {
    /// At most this distance to either side along a direction, metres.
    Across(Vector, f64),
    /// At least this distance from the origin in a direction, metres.
    Beyond(Vector, f64),
    /// At least this distance from a part, metres.
    Beside(&'a Part, f64),
    /// Within a circle of this radius about the origin, metres.
    Within(f64),
}

/// A linear combination of neighbouring points with its limit and multiplier.
#[derive(Debug, Clone)]
pub(super) struct Row<'a> {
    /// Identifies the limit and the point, so that the multiplier can be carried over.
    pub key: (u32, u32),
    /// Index of the first point in the combination.
    pub first: usize,
    /// Factors of that point and of the points after it.
    pub factors: Vec<f64>,
    /// The permitted values of the combination.
    pub limit: Limit<'a>,
    /// Weight of the squared distance to the target.
    pub penalty: f64,
    /// The multiplier divided by the penalty.
    pub multiplier: Vector,
    /// A value within the limit.
    pub target: Vector,
}

impl<'a> Row<'a> {
    /// Creates a row with a zero multiplier and the origin as its target.
    pub(super) fn new(key: (u32, u32), first: usize, factors: Vec<f64>, limit: Limit<'a>) -> Self {
        let penalty = if matches!(limit, Limit::Across(..)) { TURN_PENALTY } else { SOLID_PENALTY };
        Row { key, first, factors, limit, penalty, multiplier: Vector::zeros(), target: Vector::zeros() }
    }

    /// Returns the combination of these vectors.
    pub(super) fn of(&self, vector: impl Fn(usize) -> Vector) -> Vector {
        self.factors.iter().enumerate().map(|(k, factor)| vector(self.first + k) * *factor).sum()
    }

    /// Returns the combination of the points of a path.
    pub(super) fn value(&self, way: &[Point]) -> Vector {
        self.of(|index| way[index].coords)
    }
}

impl Limit<'_> {
    /// Returns the nearest value within the limit.
    pub(super) fn nearest(&self, value: Vector) -> Vector {
        match *self {
            Self::Across(direction, most_m) => {
                let across_m = direction.dot(&value);
                value + direction * (across_m.clamp(-most_m, most_m) - across_m)
            }
            Self::Within(most_m) => value.cap_magnitude(most_m),
            Self::Beyond(direction, least_m) => {
                value + direction * (least_m - direction.dot(&value)).max(0.0)
            }
            Self::Beside(part, keep_m) => {
                let (distance_m, away) = part.distance(Point::from(value));
                value + away * (keep_m - distance_m).max(0.0)
            }
        }
    }
}

/// A condition that keeps a path away from a part.
#[derive(Debug, Clone, Copy)]
pub(super) enum Solid<'a> {
    /// A circle that no segment of the path may enter.
    Circle(Point, f64),
    /// Straight sides; the ends of segments keep this distance from them.
    Sides(&'a Part, f64),
}

/// Returns the conditions that keep a path this far from a part. Corners keep the entire path away; sides keep only the
/// ends of its segments away.
pub(super) fn solids_of(part: &Part, keep_m: f64) -> Vec<Solid<'_>> {
    match part {
        Part::Capsule { a, b, half_width_m } if a == b => vec![Solid::Circle(*a, keep_m + half_width_m)],
        Part::Capsule { a, b, half_width_m } => {
            let radius_m = keep_m + half_width_m;
            vec![Solid::Circle(*a, radius_m), Solid::Circle(*b, radius_m), Solid::Sides(part, keep_m)]
        }
        Part::Polygon { vertices } => {
            let corners = vertices.iter().map(|corner| Solid::Circle(*corner, keep_m));
            corners.chain([Solid::Sides(part, keep_m)]).collect()
        }
    }
}

impl<'a> Solid<'a> {
    /// Adds the rows for the parts of a path that are near this solid.
    ///
    /// A segment stays out of a circle if it is beyond a tangent, which the middle of the segment determines. If the
    /// segment's nearest point determined the tangent, two segments that meet on the circle would keep each other
    /// straight.
    pub(super) fn rows(&self, kind: u32, way: &[Point], rows: &mut Vec<Row<'a>>) {
        match *self {
            Self::Circle(center, radius_m) => {
                for (index, w) in way.windows(2).enumerate() {
                    let nearest = polyline::nearest_on_segment(w[0], w[1], center);
                    if (nearest - center).norm_squared() > (radius_m + REACH_M).powi(2) {
                        continue;
                    }
                    let away = w[0].lerp(&w[1], 0.5) - center;
                    let Some(away) = away.try_normalize(1e-9) else { continue };
                    let limit = Limit::Beyond(away, away.dot(&center.coords) + radius_m);
                    let first = 2 * index as u32;
                    rows.push(Row::new((kind, first), index, vec![1.0], limit));
                    rows.push(Row::new((kind, first + 1), index + 1, vec![1.0], limit));
                }
            }
            Self::Sides(part, keep_m) => {
                let near = (0..way.len()).filter(|index| part.distance(way[*index]).0 < keep_m + REACH_M);
                let limit = Limit::Beside(part, keep_m);
                rows.extend(near.map(|index| Row::new((kind, index as u32), index, vec![1.0], limit)));
            }
        }
    }
}
