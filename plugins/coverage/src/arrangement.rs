//! The border of a union of convex rings: the pieces of their outlines that no other ring covers.
//!
//! A floor from a map has hundreds of convex obstacles, and their grown outlines overlap nearly everywhere. A piece inside
//! another outline bounds no floor; it would only add unused triangles.

use world::{Point, polyline::edges, shape::bounds_of};

/// A piece of the border: a whole ring, or a line.
#[derive(Debug, PartialEq)]
pub(crate) struct Border {
    pub line: Vec<Point>,
    pub is_closed: bool,
}

/// The border of convex counter-clockwise rings. Where edges of two rings lie within `near_m` of each other, only the
/// edge of the first ring is used, so neighbouring pieces may end up to `near_m` apart.
pub(crate) fn border(rings: &[Vec<Point>], near_m: f64) -> Vec<Border> {
    let boxes: Vec<(Point, Point)> = rings.iter().map(|ring| bounds_of(ring)).collect();
    let border_of = |(own, ring): (usize, &Vec<Point>)| {
        let is_near = |k: &usize| *k != own && may_meet(boxes[own], boxes[*k], near_m);
        let cover = |k: usize| Cover {
            ring: &rings[k],
            bounds: boxes[k],
            depth_m: if k < own { -near_m } else { near_m },
        };
        border_under(ring, &(0..rings.len()).filter(is_near).map(cover).collect::<Vec<_>>(), near_m)
    };
    rings.iter().enumerate().flat_map(border_of).collect()
}

/// A ring that may cover edges of another ring.
struct Cover<'a> {
    ring: &'a [Point],
    bounds: (Point, Point),
    /// Depth inside the ring beyond which the ring covers everything, metres. If the depth is negative, the ring also
    /// covers everything outside it within that distance.
    depth_m: f64,
}

/// The pieces of a ring's outline that its covers leave uncovered.
fn border_under(ring: &[Point], covers: &[Cover<'_>], near_m: f64) -> Vec<Border> {
    let uncovered = |(a, b): (Point, Point)| {
        let near = covers.iter().filter(move |cover| may_meet(bounds_of(&[a, b]), cover.bounds, near_m));
        let covered = near.filter_map(|cover| share_within(cover.ring, a, b, cover.depth_m)).collect();
        let at = move |share: f64| if share < 1.0 { a + (b - a) * share } else { b };
        open_parts(covered).into_iter().map(move |(from, to)| (at(from), at(to)))
    };
    let pieces: Vec<(Point, Point)> = edges(ring).flat_map(uncovered).collect();
    pieces.chunk_by(|piece, next| piece.1 == next.0).map(|chain| joined(chain, ring.len())).collect()
}

/// Joins consecutive pieces into one, which is closed if it contains all the edges of their ring.
fn joined(chain: &[(Point, Point)], n_edges: usize) -> Border {
    let (begin, end) = (chain[0].0, chain[chain.len() - 1].1);
    let is_closed = chain.len() == n_edges && begin == end;
    let corners = chain.iter().map(|(from, _)| *from);
    Border { line: corners.chain((!is_closed).then_some(end)).collect(), is_closed }
}

fn may_meet(a: (Point, Point), b: (Point, Point), near_m: f64) -> bool {
    let gap = (a.0 - b.1).sup(&(b.0 - a.1));
    gap.x <= near_m && gap.y <= near_m
}

/// The part of a segment that lies deeper than `deep_m` inside a convex ring: its start and end, as fractions of the
/// segment.
fn share_within(ring: &[Point], a: Point, b: Point, deep_m: f64) -> Option<(f64, f64)> {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for (p, q) in edges(ring) {
        let along = (q - p).normalize();
        let (start_m, end_m) = (along.perp(&(a - p)) - deep_m, along.perp(&(b - p)) - deep_m);
        match (start_m > 0.0, end_m > 0.0) {
            (true, true) => {}
            (false, false) => return None,
            (true, false) => to = to.min(start_m / (start_m - end_m)),
            (false, true) => from = from.max(start_m / (start_m - end_m)),
        }
    }
    (from < to).then_some((from, to))
}

/// The intervals within 0 to 1 that are not covered.
fn open_parts(mut covered: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    covered.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut open, mut at) = (Vec::new(), 0.0);
    for (from, to) in covered.into_iter().chain([(1.0, 1.0)]) {
        if from > at {
            open.push((at, from));
        }
        at = to.max(at);
    }
    open
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use world::polyline::nearest_on_segment;

    const NEAR_M: f64 = 1e-5;

    fn square(x: f64, y: f64, edge: f64) -> Vec<Point> {
        [(x, y), (x + edge, y), (x + edge, y + edge), (x, y + edge)].map(|(x, y)| Point::new(x, y)).to_vec()
    }

    fn sides(borders: &[Border]) -> Vec<(Point, Point)> {
        let of = |border: &Border| -> Vec<(Point, Point)> {
            let n = border.line.len() - usize::from(!border.is_closed);
            edges(&border.line).take(n).collect()
        };
        borders.iter().flat_map(of).collect()
    }

    #[test]
    fn rings_that_meet_no_other_stay_whole() {
        let rings = [square(0.0, 0.0, 2.0), square(5.0, 0.0, 1.0)];
        let whole = rings.clone().map(|line| Border { line, is_closed: true });
        assert_eq!(border(&rings, NEAR_M), whole);
        assert_eq!(border(&[square(0.0, 0.0, 2.0), square(0.5, 0.5, 1.0)], NEAR_M), whole[..1]);
    }

    proptest! {
        #[test]
        fn the_border_is_what_no_other_ring_covers(
            squares in prop::collection::vec((0..12_i32, 0..12_i32, 1..6_i32), 1..9),
        ) {
            let rings: Vec<Vec<Point>> = squares
                .iter()
                .map(|(x, y, edge)| square(f64::from(*x) / 2.0, f64::from(*y) / 2.0, f64::from(*edge) / 2.0))
                .collect();
            let borders = sides(&border(&rings, NEAR_M));
            let is_inside = |ring: &Vec<Point>, at: Point| share_within(ring, at, at, 1e-3).is_some();
            for (a, b) in rings.iter().flat_map(|ring| edges(ring)) {
                // Corners lie at multiples of half a metre, so this point is not a corner.
                let at = a + (b - a).normalize() * 0.473;
                let out = at + (b - a).normalize().yx().component_mul(&world::Vector::new(1.0, -1.0)) * 0.01;
                let is_border = !rings.iter().any(|ring| is_inside(ring, at) || is_inside(ring, out));
                let n = borders.iter().filter(|(a, b)| (nearest_on_segment(*a, *b, at) - at).norm() < 1e-4).count();
                prop_assert!(if is_border { n == 1 } else { n <= 1 }, "{at}: {n} of {borders:?}");
            }
        }
    }
}
