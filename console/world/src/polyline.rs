//! Paths: lengths, nearest points, walking along.

use crate::geometry::Point;

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

/// Distance from a point to the edges of a closed polygon, metres.
pub fn distance_to_ring_m(vertices: &[Point], point: Point) -> f64 {
    crate::shape::edges(vertices)
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
