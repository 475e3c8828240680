//! Where a shape lies at a height.

use geometry::Point;

/// From where to where, west to east, metres.
pub(super) type Span = (f64, f64);

/// Where a convex polygon lies at a height.
pub(super) fn polygon_span(corners: &[Point], y: f64) -> Option<Span> {
    span_of(crossings(corners, y))
}

/// Everything within a distance of a segment.
pub(super) struct Capsule {
    ends: [Point; 2],
    reach_m: f64,
    /// The corners of what lies beside the segment; none if it has no length.
    sides: Option<[Point; 4]>,
}

impl Capsule {
    pub(super) fn new([a, b]: [Point; 2], reach_m: f64) -> Self {
        let aside = (b - a).try_normalize(1e-12).map(|ahead| nalgebra::vector![-ahead.y, ahead.x] * reach_m);
        let sides = aside.map(|aside| [a + aside, b + aside, b - aside, a - aside]);
        Self { ends: [a, b], reach_m, sides }
    }

    /// Where it lies at a height.
    pub(super) fn span(&self, y: f64) -> Option<Span> {
        let disc = |center: Point| {
            let half_m = self.reach_m * self.reach_m - (y - center.y).powi(2);
            (half_m >= 0.0).then(|| [center.x - half_m.sqrt(), center.x + half_m.sqrt()])
        };
        let of_sides = self.sides.iter().flat_map(|sides| crossings(sides, y));
        span_of(self.ends.into_iter().filter_map(disc).flatten().chain(of_sides))
    }
}

fn span_of(crossed: impl IntoIterator<Item = f64>) -> Option<Span> {
    let ends = |(low, high): Span, x: f64| (low.min(x), high.max(x));
    Some(crossed.into_iter().fold((f64::INFINITY, f64::NEG_INFINITY), ends)).filter(|(low, high)| low <= high)
}

/// Where the outline of a polygon crosses a height.
pub(super) fn crossings(corners: &[Point], y: f64) -> impl Iterator<Item = f64> {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let crossed = edges.filter(move |(a, b)| (a.y <= y) != (b.y <= y));
    crossed.map(move |(a, b)| a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)))
}
