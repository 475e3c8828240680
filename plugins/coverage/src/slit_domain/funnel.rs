//! The shortest path through a sleeve of triangles (Lee and Preparata 1984).

use world::Point;

/// The shortest path from start to goal through a sleeve: the left and right ends of the sides that it crosses, in order.
///
/// From its apex the funnel sees every side up to the present one between two rims. A side that narrows it moves a rim
/// inward. Where one rim would pass the other, the path bends at the corner of the other rim: that corner is the next apex,
/// and the walk goes on from the side on which it lies.
pub(super) fn funnel(start: Point, goal: Point, sleeve: &[(Point, Point)]) -> Vec<Point> {
    let area = |a: Point, b: Point, c: Point| (b - a).perp(&(c - a));
    let mut path = Vec::with_capacity(8);
    path.push(start);
    let (mut apex, mut left, mut right) = (start, start, start);
    let (mut left_at, mut right_at) = (0, 0);
    let mut k = 0;
    while k <= sleeve.len() {
        let (new_left, new_right) = sleeve.get(k).copied().unwrap_or((goal, goal));
        if area(apex, right, new_right) >= 0.0 {
            if apex == right || area(apex, left, new_right) < 0.0 {
                (right, right_at) = (new_right, k);
            } else {
                path.push(left);
                (apex, right, right_at, k) = (left, left, left_at, left_at + 1);
                continue;
            }
        }
        if area(apex, left, new_left) <= 0.0 {
            if apex == left || area(apex, right, new_left) > 0.0 {
                (left, left_at) = (new_left, k);
            } else {
                path.push(right);
                (apex, left, left_at, k) = (right, right, right_at, right_at + 1);
                continue;
            }
        }
        k += 1;
    }
    path.push(goal);
    path.dedup_by(|a, b| (*a - *b).norm() < 1e-12);
    if path.len() == 1 {
        path.push(goal);
    }
    path
}
