//! Counts crossings of cuts: lines that a tethered robot must not cross.

use crate::obstacles::Boxes;
use geometry::{Point, Vector};

/// Returns how often a path crosses some cuts, all in the tank frame. A change of sides counts once; a touch without
/// a change counts as zero or two crossings.
///
/// ```
/// use world::{Point, tether::crossings};
/// let cut = vec![Point::new(4.0, 0.0), Point::new(10.0, 0.0)];
/// let path = [Point::new(3.0, -1.0), Point::new(3.0, 1.0), Point::new(6.0, 1.0), Point::new(6.0, -1.0)];
/// assert_eq!(crossings(&path, &[cut]), 1);
/// ```
pub fn crossings(path: &[Point], cuts: &[Vec<Point>]) -> usize {
    let segments = cuts.iter().flat_map(|cut| cut.windows(2).map(|pair| (pair[0], pair[1])));
    if let [a, b] = *path {
        // For a single segment, building a tree takes longer than testing without one.
        return segments.filter(|(p, q)| cross(a, b, *p, *q)).count();
    }
    let segments: Vec<(Point, Point)> = segments.collect();
    let boxes = Boxes::new(segments.iter().map(|(p, q)| (p.inf(q), p.sup(q))));
    let crossed = |a: Point, b: Point| {
        let near = boxes.near(a, b, 0.0).map(|k| segments[k]);
        near.filter(|(p, q)| cross(a, b, *p, *q)).count()
    };
    path.windows(2).map(|pair| crossed(pair[0], pair[1])).sum()
}

/// Whether a segment of the path crosses a segment of a cut.
///
/// The whole path is treated as shifted by an infinitesimal amount (simulation of simplicity, Edelsbrunner and Mücke
/// 1990). Each change of sides therefore counts once, even through corners and along segments of a cut.
fn cross(a: Point, b: Point, p: Point, q: Point) -> bool {
    let apart = |low: f64, high: f64, from: f64, to: f64| low.max(high) < from.min(to);
    if apart(a.x, b.x, p.x, q.x)
        || apart(p.x, q.x, a.x, b.x)
        || apart(a.y, b.y, p.y, q.y)
        || apart(p.y, q.y, a.y, b.y)
    {
        return false;
    }
    let shift_of_path = |p: Point, q: Point, x: Point| is_left(q - p, x - p, 1.0);
    let shift_of_cut = |a: Point, b: Point, x: Point| is_left(b - a, x - a, -1.0);
    shift_of_path(p, q, a) != shift_of_path(p, q, b) && shift_of_cut(a, b, p) != shift_of_cut(a, b, q)
}

/// Whether a point is left of a line through the origin. A point on the line is treated as shifted infinitesimally to
/// the east or west, and by an infinitely smaller amount to the north or south.
fn is_left(along: Vector, at: Vector, shift: f64) -> bool {
    let sides = [along.perp(&at), -along.y * shift, along.x * shift];
    sides.into_iter().find(|side| *side != 0.0).is_some_and(|side| side > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points(of: &[(f64, f64)]) -> Vec<Point> {
        of.iter().map(|(x, y)| Point::new(*x, *y)).collect()
    }

    #[test]
    fn a_path_that_touches_a_cut_and_turns_back_does_not_cross_it() {
        let cuts = [points(&[(0., -1.), (0., 1.)])];
        assert_eq!(crossings(&points(&[(1., 0.), (-1., 0.)]), &cuts), 1);
        assert_eq!(crossings(&points(&[(1., 0.), (0., 0.), (-1., 0.)]), &cuts), 1);
        assert_eq!(crossings(&points(&[(-1., 0.), (0., 0.), (-1., 0.5)]), &cuts) % 2, 0);
        assert_eq!(crossings(&points(&[(1., 2.), (-1., 2.)]), &cuts), 0);
    }

    #[test]
    fn a_path_with_a_corner_on_a_cut_crosses_it_once_in_any_unit() {
        let path = points(&[(4., 1.11), (4., 2.36), (4., 3.61)]);
        assert_eq!(crossings(&path, &[points(&[(2.01, 2.36), (6.23, 2.36)])]), 1);
        for unit in 1..200 {
            let scaled = |of: &[(f64, f64)]| -> Vec<Point> {
                points(of).iter().map(|p| p * (f64::from(unit) / 100.0)).collect()
            };
            let cut = [scaled(&[(-7., 3.), (9., 3.)])];
            assert_eq!(crossings(&scaled(&[(1., -4.), (1., 3.), (1., 5.)]), &cut), 1, "{unit} cm");
            assert_eq!(crossings(&scaled(&[(1., -4.), (1., 3.), (5., 3.), (6., 8.)]), &cut), 1, "{unit} cm");
            assert_eq!(
                crossings(&scaled(&[(1., -4.), (1., 3.), (5., 3.), (6., 1.)]), &cut) % 2,
                0,
                "{unit} cm"
            );
        }
    }

    proptest! {
        #[test]
        fn looking_only_at_what_is_near_leaves_no_crossing_out(
            path in prop::collection::vec((-20..20_i32, -20..20_i32), 2..12),
            cuts in prop::collection::vec(prop::collection::vec((-20..20_i32, -20..20_i32), 2..4), 1..8),
            unit_cm in 1..100_i32,
        ) {
            let line = |of: &[(i32, i32)]| -> Vec<Point> {
                let at = |x: i32| f64::from(x * unit_cm) / 100.0;
                of.iter().map(|(x, y)| Point::new(at(*x), at(*y))).collect()
            };
            let (path, cuts) = (line(&path), cuts.iter().map(|cut| line(cut)).collect::<Vec<_>>());
            let all = || cuts.iter().flat_map(|cut| cut.windows(2));
            let of = |way: &[Point]| all().filter(|cut| cross(way[0], way[1], cut[0], cut[1])).count();
            prop_assert_eq!(crossings(&path, &cuts), path.windows(2).map(of).sum::<usize>());
        }
    }
}
