//! Open paths and closed rings of straight segments: lengths, distances, resampling.

use crate::Point;

/// Length of a path, metres.
///
/// ```
/// use geometry::{Point, polyline::length_m};
/// let path = [Point::new(0.0, 0.0), Point::new(3.0, 0.0), Point::new(3.0, 4.0)];
/// assert_eq!(length_m(&path), 7.0);
/// assert!(length_m(&[]).is_sign_positive());
/// ```
pub fn length_m(path: &[Point]) -> f64 {
    // The sum of an empty iterator of floats is negative zero.
    0.0 + path.windows(2).map(|w| (w[1] - w[0]).norm()).sum::<f64>()
}

/// The point of the segment from `a` to `b` that is nearest to `point`.
///
/// ```
/// use geometry::{Point, polyline::nearest_on_segment};
/// let (a, b) = (Point::new(0.0, 0.0), Point::new(4.0, 0.0));
/// assert_eq!(nearest_on_segment(a, b, Point::new(1.0, 2.0)), Point::new(1.0, 0.0));
/// assert_eq!(nearest_on_segment(a, b, Point::new(9.0, 2.0)), b);
/// ```
#[inline]
pub fn nearest_on_segment(a: Point, b: Point, point: Point) -> Point {
    let along = b - a;
    let squared = along.norm_squared();
    if squared == 0.0 {
        return a;
    }
    a + along * ((point - a).dot(&along) / squared).clamp(0.0, 1.0)
}

/// Distance from a point to an open path, metres; infinite for an empty path.
///
/// ```
/// use geometry::{Point, polyline::distance_m};
/// let path = [Point::new(0.0, 0.0), Point::new(4.0, 0.0)];
/// assert_eq!(distance_m(&path, Point::new(1.0, 2.0)), 2.0);
/// assert!(distance_m(&[], Point::origin()).is_infinite());
/// ```
pub fn distance_m(path: &[Point], point: Point) -> f64 {
    match path {
        [] => f64::INFINITY,
        [only] => (point - only).norm(),
        _ => path
            .windows(2)
            .map(|w| (point - nearest_on_segment(w[0], w[1], point)).norm())
            .fold(f64::INFINITY, f64::min),
    }
}

/// Walks forward from point `from` as long as the next point is at least as close to `at` as the current one, and returns
/// the index at which it stops. If `from` is the last point or beyond it, returns `from`.
///
/// ```
/// use geometry::{Point, polyline::nearest_ahead};
/// let path = [0.0, 1.0, 2.0, 3.0].map(|x| Point::new(x, 0.0));
/// assert_eq!(nearest_ahead(&path, 0, Point::new(2.2, 1.0)), 2);
/// assert_eq!(nearest_ahead(&path, 3, Point::new(2.2, 1.0)), 3);
/// ```
pub fn nearest_ahead(path: &[Point], from: usize, at: Point) -> usize {
    let from_m = |point: &Point| (point - at).norm_squared();
    let going_on = path[from.min(path.len())..].windows(2).take_while(|w| from_m(&w[1]) <= from_m(&w[0]));
    from + going_on.count()
}

/// Whether two segments cross, that is, whether the ends of each are strictly on opposite sides of the other. Segments
/// that only touch do not cross.
///
/// ```
/// use geometry::{Point, polyline::segments_cross};
/// let at = Point::new;
/// assert!(segments_cross(at(-1.0, 0.0), at(1.0, 0.0), at(0.0, -1.0), at(0.0, 1.0)));
/// assert!(!segments_cross(at(-1.0, 0.0), at(1.0, 0.0), at(0.0, 0.0), at(0.0, 1.0)));
/// ```
pub fn segments_cross(a: Point, b: Point, c: Point, d: Point) -> bool {
    let side = |from: Point, to: Point, at: Point| (to - from).perp(&(at - from));
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

/// The edges of a closed polygon, including the edge from the last corner to the first; none if it has no corners.
///
/// ```
/// use geometry::{Point, polyline::edges};
/// let triangle = [Point::new(0.0, 0.0), Point::new(3.0, 0.0), Point::new(0.0, 4.0)];
/// assert_eq!(edges(&triangle).map(|(a, b)| (b - a).norm()).sum::<f64>(), 12.0);
/// ```
pub fn edges(vertices: &[Point]) -> impl Iterator<Item = (Point, Point)> + '_ {
    vertices.iter().copied().zip(vertices.iter().copied().cycle().skip(1)).take(vertices.len())
}

/// Distance from a point, inside or outside, to the edges of a closed polygon, metres; infinite if it has no corners.
///
/// ```
/// use geometry::{Point, polyline::distance_to_ring_m, shape::rectangle};
/// let square = rectangle(Point::new(-1.0, -1.0), Point::new(1.0, 1.0));
/// assert_eq!(distance_to_ring_m(&square, Point::new(0.25, 0.0)), 0.75);
/// ```
pub fn distance_to_ring_m(vertices: &[Point], point: Point) -> f64 {
    edges(vertices)
        .map(|(a, b)| (point - nearest_on_segment(a, b, point)).norm())
        .fold(f64::INFINITY, f64::min)
}

/// Distance along a path from its start to each of its points, metres.
///
/// ```
/// use geometry::{Point, polyline::stations_m};
/// let path = [Point::new(0.0, 0.0), Point::new(3.0, 0.0), Point::new(3.0, 4.0)];
/// assert_eq!(stations_m(&path), [0.0, 3.0, 7.0]);
/// ```
pub fn stations_m(path: &[Point]) -> Vec<f64> {
    let mut travelled = 0.0;
    let mut previous = path.first().copied();
    path.iter()
        .map(|p| {
            travelled += previous.map_or(0.0, |q| (p - q).norm());
            previous = Some(*p);
            travelled
        })
        .collect()
}

/// The changes of heading along a path, radians, from 0 to pi; coincident points are skipped.
///
/// ```
/// use geometry::{Point, polyline::turns_rad};
/// let path = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (1.0, 2.0)].map(|(x, y)| Point::new(x, y));
/// assert_eq!(turns_rad(&path).collect::<Vec<_>>(), [std::f64::consts::FRAC_PI_2]);
/// ```
pub fn turns_rad(path: &[Point]) -> impl Iterator<Item = f64> {
    let mut headings = path.windows(2).filter_map(|pair| (pair[1] - pair[0]).try_normalize(1e-9));
    let mut before = headings.next();
    headings.map(move |heading| {
        let last = before.replace(heading).unwrap_or(heading);
        last.perp(&heading).atan2(last.dot(&heading)).abs()
    })
}

/// The path without its first and last `end_m` metres; empty if it is no longer than twice that.
///
/// ```
/// use geometry::{Point, polyline::without_ends};
/// let path = [Point::new(0.0, 0.0), Point::new(5.0, 0.0)];
/// assert_eq!(without_ends(&path, 1.0), [Point::new(1.0, 0.0), Point::new(4.0, 0.0)]);
/// assert!(without_ends(&path, 3.0).is_empty());
/// ```
pub fn without_ends(path: &[Point], end_m: f64) -> Vec<Point> {
    let stations_m = stations_m(path);
    let (first_m, last_m) = (end_m, stations_m.last().copied().unwrap_or(0.0) - end_m);
    if first_m >= last_m {
        return Vec::new();
    }
    let at = |along_m: f64| {
        let next = stations_m.partition_point(|s| *s <= along_m).clamp(1, path.len() - 1);
        let piece_m = stations_m[next] - stations_m[next - 1];
        path[next - 1] + (path[next] - path[next - 1]) * ((along_m - stations_m[next - 1]) / piece_m)
    };
    let between =
        path.iter().zip(&stations_m).filter(|(_, s)| **s > first_m && **s < last_m).map(|(p, _)| *p);
    std::iter::once(at(first_m)).chain(between).chain(std::iter::once(at(last_m))).collect()
}

/// The path with each segment divided evenly so that neighbouring points are at most `spacing_m` apart.
///
/// ```
/// use geometry::{Point, polyline::resampled};
/// let fine = resampled(&[Point::new(0.0, 0.0), Point::new(1.0, 0.0)], 0.3);
/// assert_eq!(fine.len(), 5);
/// assert_eq!(fine[1], Point::new(0.25, 0.0));
/// ```
pub fn resampled(path: &[Point], spacing_m: f64) -> Vec<Point> {
    let mut points: Vec<Point> = path.first().copied().into_iter().collect();
    for pair in path.windows(2) {
        let along = pair[1] - pair[0];
        let pieces = (along.norm() / spacing_m).ceil().max(1.0) as usize;
        points.extend((1..=pieces).map(|k| pair[0] + along * (k as f64 / pieces as f64)));
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points() -> impl Strategy<Value = Vec<Point>> {
        prop::collection::vec((-50.0..50.0_f64, -50.0..50.0_f64).prop_map(|(x, y)| Point::new(x, y)), 2..12)
    }

    #[test]
    fn a_path_without_its_ends_is_shorter_by_both_and_may_be_gone() {
        let path = [(0.0, 0.0), (0.05, 0.0), (2.0, 0.0), (2.0, 1.0)].map(|(x, y)| Point::new(x, y));
        let inner = without_ends(&path, 0.2);
        assert!((length_m(&inner) - (length_m(&path) - 0.4)).abs() < 1e-12);
        assert!((inner[0] - Point::new(0.2, 0.0)).norm() < 1e-12 && inner.len() == 3);
        assert!(without_ends(&path, 1.5).is_empty() && without_ends(&path[..1], 0.1).is_empty());
        assert!(without_ends(&[], 0.1).is_empty());
    }

    proptest! {
        #[test]
        fn resampling_keeps_the_length(path in points(), spacing in 0.05..5.0_f64) {
            let fine = resampled(&path, spacing);
            prop_assert!((length_m(&fine) - length_m(&path)).abs() < 1e-6);
            prop_assert!(fine.windows(2).all(|w| (w[1] - w[0]).norm() <= spacing + 1e-9));
        }

        #[test]
        fn the_last_station_is_the_length(path in points()) {
            prop_assert!((stations_m(&path).last().unwrap() - length_m(&path)).abs() < 1e-9);
        }
    }
}
