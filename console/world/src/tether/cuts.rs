//! Crossings of cuts: lines that a tethered robot never crosses.

use crate::geometry::Point;

/// How often a path crosses some lines; touching a line without changing sides is no crossing.
pub fn crossings(path: &[Point], cuts: &[Vec<Point>]) -> usize {
    let pieces: Vec<(Point, Point)> =
        cuts.iter().flat_map(|cut| cut.windows(2).map(|pair| (pair[0], pair[1]))).collect();
    path.windows(2).map(|pair| pieces.iter().filter(|(p, q)| cross(pair[0], pair[1], *p, *q)).count()).sum()
}

/// Points on a line count as left of it, so each change of sides counts once.
fn cross(a: Point, b: Point, p: Point, q: Point) -> bool {
    let apart = |low: f64, high: f64, from: f64, to: f64| low.max(high) < from.min(to);
    if apart(a.x, b.x, p.x, q.x)
        || apart(p.x, q.x, a.x, b.x)
        || apart(a.y, b.y, p.y, q.y)
        || apart(p.y, q.y, a.y, b.y)
    {
        return false;
    }
    let is_left = |o: Point, to: Point, x: Point| (to - o).perp(&(x - o)) >= 0.0;
    is_left(p, q, a) != is_left(p, q, b) && is_left(a, b, p) != is_left(a, b, q)
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
