//! Paths resampled at short distances.

use world::{Point, polyline};

/// Length of the longest path that a mission accepts, metres: a longer path comes from a journal that was changed.
const MOST_LENGTH_M: f64 = 1e6;

/// A path with a point at least every `spacing_m`; empty for a path that is too long for any mission and would
/// exhaust the memory.
pub(crate) fn sampled(path: &[Point], spacing_m: f64) -> Vec<Point> {
    let length_m = polyline::length_m(path);
    if length_m <= MOST_LENGTH_M { polyline::resampled(path, spacing_m) } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_that_cannot_be_is_none() {
        let to = |x_m| sampled(&[Point::origin(), Point::new(x_m, 0.0)], 0.5).len();
        assert_eq!(to(2.0), 5);
        assert_eq!((to(1e12), to(1e308), to(f64::NAN), to(f64::INFINITY)), (0, 0, 0, 0));
        assert_eq!(sampled(&[], 0.5), []);
    }
}
