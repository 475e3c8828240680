//! Where a shape lies at a height.

use geometry::Point;

/// From where to where, west to east, metres.
pub(super) type Span = (f64, f64);

/// Where a convex polygon lies at a height.
#[inline]
pub(super) fn polygon_span(corners: &[Point], y: f64) -> Option<Span> {
    somewhere(crossings(corners, y).fold(NOWHERE, widened))
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

    /// Where it lies at a height. A tool is asked for it at a hundred heights a tick.
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

/// Less than any place.
const NOWHERE: Span = (f64::INFINITY, f64::NEG_INFINITY);

#[inline]
fn widened((low, high): Span, x: f64) -> Span {
    (low.min(x), high.max(x))
}

#[inline]
fn somewhere((low, high): Span) -> Option<Span> {
    (low <= high).then_some((low, high))
}

/// Where an edge crosses a height.
#[inline]
fn crossing(a: &Point, b: &Point, y: f64) -> Option<f64> {
    ((a.y <= y) != (b.y <= y)).then(|| a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)))
}

/// Where the outline of a polygon crosses a height.
#[inline]
pub(super) fn crossings(corners: &[Point], y: f64) -> impl Iterator<Item = f64> {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    edges.filter_map(move |(a, b)| crossing(a, b, y))
}
