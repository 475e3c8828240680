//! Paths: lengths, nearest points, walking along.

use crate::Point;

/// Length of a path, metres.
pub fn length_m(path: &[Point]) -> f64 {
    path.windows(2).map(|w| (w[1] - w[0]).norm()).sum()
}

/// The point of a segment that is nearest to `point`.
pub fn nearest_on_segment(a: Point, b: Point, point: Point) -> Point {
    let along = b - a;
    let squared = along.norm_squared();
    if squared == 0.0 {
        return a;
    }
    a + along * ((point - a).dot(&along) / squared).clamp(0.0, 1.0)
}

/// Distance from a point to an open path, metres; infinite for an empty path.
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

/// The edges of a closed polygon.
pub fn edges(vertices: &[Point]) -> impl Iterator<Item = (Point, Point)> + '_ {
    vertices.iter().copied().zip(vertices.iter().copied().cycle().skip(1)).take(vertices.len())
}

/// Distance from a point to the edges of a closed polygon, metres.
pub fn distance_to_ring_m(vertices: &[Point], point: Point) -> f64 {
    edges(vertices)
        .map(|(a, b)| (point - nearest_on_segment(a, b, point)).norm())
        .fold(f64::INFINITY, f64::min)
}

/// Distance travelled from the start of a path to each of its points, metres.
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

/// The path without its first and last metres; empty if there is nothing between.
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

/// The path with straight pieces split so that no two neighbours are further apart than `spacing_m`.
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
