//! The horizontal extent of a shape at a given y coordinate.

use geometry::Point;

/// The west and east ends, metres.
pub(super) type Span = (f64, f64);

/// Returns the extent of a convex polygon at a given `y`.
#[inline]
pub(super) fn polygon_span(corners: &[Point], y: f64) -> Option<Span> {
    somewhere(crossings(corners, y).fold(NOWHERE, widened))
}

/// All points within a given distance of a segment.
pub(super) struct Capsule {
    ends: [Point; 2],
    reach_m: f64,
    /// The corners of the rectangle along the segment; `None` if the segment has no length.
    sides: Option<[Point; 4]>,
}

impl Capsule {
    pub(super) fn new([a, b]: [Point; 2], reach_m: f64) -> Self {
        let aside = (b - a).try_normalize(1e-12).map(|ahead| nalgebra::vector![-ahead.y, ahead.x] * reach_m);
        let sides = aside.map(|aside| [a + aside, b + aside, b - aside, a - aside]);
        Self { ends: [a, b], reach_m, sides }
    }

    /// Returns the extent of the capsule at a given `y`. Called about a hundred times per tick for a tool.
    #[inline]
    pub(super) fn span(&self, y: f64) -> Option<Span> {
        let mut span = NOWHERE;
        for center in &self.ends {
            let half_m = self.reach_m * self.reach_m - (y - center.y).powi(2);
            if half_m >= 0.0 {
                let half_m = half_m.sqrt();
                span = widened(widened(span, center.x - half_m), center.x + half_m);
            }
        }
        if let Some([a, b, c, d]) = &self.sides {
            for (from, to) in [(a, b), (b, c), (c, d), (d, a)] {
                span = crossing(from, to, y).map_or(span, |x| widened(span, x));
            }
        }
        somewhere(span)
    }
}

/// An empty span.
const NOWHERE: Span = (f64::INFINITY, f64::NEG_INFINITY);

#[inline]
fn widened((low, high): Span, x: f64) -> Span {
    (low.min(x), high.max(x))
}

#[inline]
fn somewhere((low, high): Span) -> Option<Span> {
    (low <= high).then_some((low, high))
}

/// Returns where an edge crosses a given `y`.
#[inline]
fn crossing(a: &Point, b: &Point, y: f64) -> Option<f64> {
    ((a.y <= y) != (b.y <= y)).then(|| a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)))
}

/// Returns where the outline of a polygon crosses a given `y`.
#[inline]
pub(super) fn crossings(corners: &[Point], y: f64) -> impl Iterator<Item = f64> {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    edges.filter_map(move |(a, b)| crossing(a, b, y))
}
