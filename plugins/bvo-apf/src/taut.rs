//! Pulls a path taut: first by shortcuts, then by cutting corners until nothing is gained.

use std::cell::Cell;
use steering::{KnownMap, Solid};
use world::{Point, polyline};

/// Distance between the points from which shortcuts are tried, metres.
const SPACING_M: f64 = 0.25;
/// Number of times that every corner is cut.
const ROUNDS: usize = 6;
/// Number of bisections when a corner is cut.
const HALVINGS: usize = 10;

/// Returns a shorter path from the first point to the last, which keeps a margin between the hull and all real solids.
///
/// Parts of the path that do not keep the margin themselves are left as they are.
pub fn pulled(path: &[Point], map: &KnownMap, margin_m: f64) -> Vec<Point> {
    let sight = Sight { map, margin_m, last: Cell::new(0) };
    let is_free = |a: Point, b: Point| sight.is_free(a, b);
    let spacing_m = polyline::length_m(path) / path.len().max(1) as f64;
    let mut way = shortcut(path, (SPACING_M / spacing_m.max(1e-9)).clamp(1.0, 1e6) as usize, is_free);
    for _ in 0..ROUNDS {
        way = corners_cut(&way, is_free);
    }
    shortcut(&way, 1, is_free)
}

/// Whether one point is visible from another. The solid that last blocked the view is checked first, because it usually
/// blocks it again.
struct Sight<'a> {
    map: &'a KnownMap,
    margin_m: f64,
    last: Cell<usize>,
}

impl Sight<'_> {
    fn is_free(&self, a: Point, b: Point) -> bool {
        let keep_m = self.map.hull_m + self.margin_m;
        let blocks = |solid: &Solid| solid.segment_distance_m(a, b, keep_m) < keep_m;
        if self.map.solids.get(self.last.get()).is_some_and(blocks) {
            return false;
        }
        if let Some(blocker) = self.map.solids.iter().position(blocks) {
            self.last.set(blocker);
            return false;
        }
        self.map.wall_distance_m(a, b, keep_m) >= keep_m
    }
}

/// From every corner, skips to the farthest visible point among those a stride apart.
fn shortcut(path: &[Point], stride: usize, is_free: impl Fn(Point, Point) -> bool) -> Vec<Point> {
    let mut way = Vec::new();
    let mut from = 0;
    while let Some(here) = path.get(from) {
        way.push(*here);
        let furthest = (from + 2..path.len()).rev().step_by(stride).find(|to| is_free(*here, path[*to]));
        from = furthest.unwrap_or(from + 1);
    }
    way
}

/// Replaces every corner with the longest free cut across it.
fn corners_cut(path: &[Point], is_free: impl Fn(Point, Point) -> bool) -> Vec<Point> {
    let Some((first, last)) = path.first().zip(path.last()) else { return Vec::new() };
    let mut way = vec![*first];
    for corner in path.windows(3) {
        let (before, here, after) = (way[way.len() - 1], corner[1], corner[2]);
        // The next corner is cut from the middle of the side between the two, so that no side is used twice.
        let middle = nalgebra::center(&here, &after);
        let share =
            largest_share(|share| is_free(here + (before - here) * share, here + (middle - here) * share));
        if share > 1e-3 {
            way.push(here + (before - here) * share);
            way.push(here + (middle - here) * share);
        } else {
            way.push(here);
        }
    }
    way.push(*last);
    way
}

/// The largest share of a cut that is free, by bisection.
fn largest_share(is_free: impl Fn(f64) -> bool) -> f64 {
    if is_free(1.0) {
        return 1.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if is_free(middle) { low = middle } else { high = middle }
    }
    low
}

/// The path in steps of equal length; the last step is shorter.
///
/// At bends, a step is the chord, so the result is slightly shorter than the path.
pub fn paced(way: &[Point], step_m: f64) -> Vec<Point> {
    let mut path: Vec<Point> = way.first().copied().into_iter().collect();
    let mut left_m = step_m;
    for pair in way.windows(2) {
        let (along, length_m) = (pair[1] - pair[0], (pair[1] - pair[0]).norm());
        let mut at_m = left_m;
        while at_m < length_m {
            path.push(pair[0] + along * (at_m / length_m));
            at_m += step_m;
        }
        left_m = at_m - length_m;
    }
    path.extend(way.last().filter(|last| path.last() != Some(*last)));
    path
}

#[cfg(test)]
mod tests {
    use super::*;
    use steering::Solid;
    use world::Boundary;

    #[test]
    fn a_way_round_a_disc_becomes_nearly_the_shortest() {
        let map = KnownMap {
            solids: vec![Solid::disc(0, Point::origin(), 1.0)],
            wall: Boundary::Circle { radius_m: 20.0 },
            hull_m: 0.5,
        };
        let wide = [(-5.0, 0.0), (-4.0, 4.0), (0.0, 6.0), (4.0, 4.0), (5.0, 0.0)];
        let wide: Vec<Point> = wide.iter().map(|(x, y)| Point::new(*x, *y)).collect();
        let taut = pulled(&wide, &map, 0.1);
        let (r, d) = (1.6_f64, 5.0_f64);
        let shortest = 2.0 * (d * d - r * r).sqrt() + r * (std::f64::consts::PI - 2.0 * (r / d).acos());
        let length = polyline::length_m(&taut);
        assert!(length < 1.005 * shortest, "{length} against {shortest}");
        assert!(taut.windows(2).all(|w| map.is_free(w[0], w[1], 0.1 - 1e-9)));
        assert_eq!((taut[0], taut[taut.len() - 1]), (wide[0], wide[4]));
    }

    #[test]
    fn a_paced_way_has_steps_of_one_length_and_both_ends() {
        let way = [Point::origin(), Point::new(1.0, 0.0), Point::new(1.0, 1.05)];
        let path = paced(&way, 0.1);
        assert_eq!((path.len(), path[0], path[path.len() - 1]), (22, way[0], way[2]));
        assert!(path.windows(2).all(|w| (w[1] - w[0]).norm() <= 0.1 + 1e-9));
        assert_eq!(paced(&way[..1], 0.1), way[..1]);
    }

    #[test]
    fn walking_in_and_out_of_a_bay_is_left_out() {
        let map = KnownMap { solids: vec![], wall: Boundary::Circle { radius_m: 20.0 }, hull_m: 0.5 };
        let spur = [(0.0, 0.0), (5.0, 5.0), (5.0, 9.0), (5.0, 5.0), (9.0, 0.0)];
        let spur: Vec<Point> = spur.iter().map(|(x, y)| Point::new(*x, *y)).collect();
        assert!((polyline::length_m(&pulled(&spur, &map, 0.1)) - 9.0).abs() < 1e-9);
    }
}
