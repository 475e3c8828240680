//! The border of a union: of rings around solid things, the pieces that lie in no other ring.
//!
//! Floors from maps are made of hundreds of convex pieces whose grown outlines overlap nearly everywhere. What lies within
//! another outline bounds nothing: it would only make triangles that nobody uses.

use world::{Point, polyline::edges, shape::bounds_of};

/// A piece of the border: a whole ring, or a line.
#[derive(Debug, PartialEq)]
pub(crate) struct Border {
    pub line: Vec<Point>,
    pub is_closed: bool,
}

/// The border of convex counter-clockwise rings; where pieces of two rings lie within `near_m` of each other, there is one of
/// them only, and pieces that meet may end so far apart.
pub(crate) fn border(rings: &[Vec<Point>], near_m: f64) -> Vec<Border> {
    let boxes: Vec<(Point, Point)> = rings.iter().map(|ring| bounds_of(ring)).collect();
    let mut borders = Vec::new();
    for (own, ring) in rings.iter().enumerate() {
        // Of two pieces in one place that of the first ring counts.
        let others = (0..rings.len()).filter(|k| *k != own && may_meet(boxes[own], boxes[*k], near_m));
        let others: Vec<_> =
            others.map(|k| (&rings[k], boxes[k], if k < own { -near_m } else { near_m })).collect();
        let uncovered = |a: Point, b: Point| {
            let near = others.iter().filter(|(_, around, _)| may_meet(bounds_of(&[a, b]), *around, near_m));
            open_parts(near.filter_map(|(ring, _, deep_m)| share_within(ring, a, b, *deep_m)).collect())
        };
        let mut lines: Vec<Vec<Point>> = vec![Vec::new()];
        for (a, b) in edges(ring) {
            for (from, to) in uncovered(a, b) {
                let at = |share: f64| if share < 1.0 { a + (b - a) * share } else { b };
                let line =
                    lines.last_mut().filter(|line| from == 0.0 && line.last().is_none_or(|last| *last == a));
                match line {
                    Some(line) if line.is_empty() => line.extend([a, at(to)]),
                    Some(line) => line.push(at(to)),
                    None => lines.push(vec![at(from), at(to)]),
                }
            }
        }
        lines.retain(|line| !line.is_empty());
        let n_sides: usize = lines.iter().map(|line| line.len() - 1).sum();
        if let ([line], true) = (&mut lines[..], n_sides == ring.len())
            && line.last() == line.first()
        {
            line.pop();
            borders.push(Border { line: std::mem::take(line), is_closed: true });
            continue;
        }
        borders.extend(lines.into_iter().map(|line| Border { line, is_closed: false }));
    }
    borders
}

fn may_meet(a: (Point, Point), b: (Point, Point), near_m: f64) -> bool {
    let gap = (a.0 - b.1).sup(&(b.0 - a.1));
    gap.x <= near_m && gap.y <= near_m
}

/// The share of a segment that lies deeper than this in a convex ring, metres.
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

/// What some shares of a whole leave of it.
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
                // Corners lie on halves of a metre; here there are none.
                let at = a + (b - a).normalize() * 0.473;
                let out = at + (b - a).normalize().yx().component_mul(&world::Vector::new(1.0, -1.0)) * 0.01;
                let is_border = !rings.iter().any(|ring| is_inside(ring, at) || is_inside(ring, out));
                let n = borders.iter().filter(|(a, b)| (nearest_on_segment(*a, *b, at) - at).norm() < 1e-4).count();
                prop_assert!(if is_border { n == 1 } else { n <= 1 }, "{at}: {n} of {borders:?}");
            }
        }
    }
}
