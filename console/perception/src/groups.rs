//! Groups of neighbouring points.

use crate::rays::Rays;
use std::ops::Range;
use world::scan::APART;

/// Number of rays without an echo that a group may contain in a row.
const LOST: usize = 2;
/// Minimum number of points in a group; fewer points count as noise.
pub(crate) const LEAST: usize = 3;
/// Largest extent of a group, metres. A longer surface is divided into several groups, so that their convex outlines
/// stay close to it.
const LONGEST_M: f64 = 1.0;
/// Cosine of the largest angle between a ray and the normal of a surface at which neighbouring points still count as
/// one surface.
const GRAZING: f64 = 0.2;

/// A group: the positions of its rays in the list from which it was made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Group {
    pub rays: Range<usize>,
}

/// Divides the rays in a list, which is in the order of the scan, into groups.
pub(crate) fn groups(rays: &Rays, left: &[usize], sigma_m: f64, found: &mut Vec<Group>) {
    found.clear();
    let mut begin = 0;
    for next in 1..=left.len() {
        let is_joined = next < left.len()
            && are_joined(rays, left[next - 1], left[next], sigma_m)
            && (rays.point(left[next]) - rays.point(left[begin])).norm() < LONGEST_M;
        if !is_joined {
            if next - begin >= LEAST {
                found.push(Group { rays: begin..next });
            }
            begin = next;
        }
    }
}

/// The largest of several groups, unless points outside it are within `near_m` metres of it.
pub(crate) fn apart<'a>(rays: &Rays, list: &'a [usize], parts: &[Group], near_m: f64) -> Option<&'a [usize]> {
    let largest = parts.iter().max_by_key(|part| part.rays.len())?.rays.clone();
    let part = &list[largest.clone()];
    let is_apart =
        |other: &usize| part.iter().all(|ray| (rays.point(*ray) - rays.point(*other)).norm() > near_m);
    let mut others = list[..largest.start].iter().chain(&list[largest.end..]);
    others.all(is_apart).then_some(part)
}

/// Whether two consecutive points can lie on one surface.
fn are_joined(rays: &Rays, one: usize, next: usize, sigma_m: f64) -> bool {
    let between = (next + rays.len() - one) % rays.len();
    if between > LOST + 1 {
        return false;
    }
    let skipped_have_no_echo = (1..between)
        .filter_map(|by| rays.neighbour(one, by as isize))
        .all(|ray| !rays.range_m[ray].is_finite());
    let apart_m = rays.range_m[one].min(rays.range_m[next]) * between as f64 * rays.step_rad();
    let most_m = APART * sigma_m + apart_m / GRAZING;
    skipped_have_no_echo && (rays.range_m[one] - rays.range_m[next]).abs() <= most_m
}

/// Rotates a list of rays in ascending order so that it does not begin in the middle of a group. This matters for a
/// scan all around, which has no first ray.
pub(crate) fn turned(rays: &Rays, left: &mut [usize], sigma_m: f64) {
    let (Some(first), Some(last)) = (left.first(), left.last()) else { return };
    if !rays.is_round() || !are_joined(rays, *last, *first, sigma_m) {
        return;
    }
    let gap = left.windows(2).position(|pair| !are_joined(rays, pair[0], pair[1], sigma_m));
    if let Some(gap) = gap {
        left.rotate_left(gap + 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{column, scan_of};
    use geometry::{Boundary, Pose};
    use world::Scanner;

    #[test]
    fn columns_are_groups_also_across_the_end_of_the_scan() {
        let scanner = Scanner { lost_share: 0.1, ..Scanner::default() };
        // One of the columns is behind the robot, where the scan begins and ends.
        let columns = [column(1, -2.0, 0.0, 0.2), column(2, 1.0, 1.0, 0.15)];
        let scan =
            scan_of(&scanner, &Boundary::Circle { radius_m: 60.0 }, &columns, &Pose::new(0.0, 0.0, 0.0), 2);
        let mut rays = Rays::default();
        rays.take(&scan, &nalgebra::Isometry2::identity());
        let mut left: Vec<usize> = (0..rays.len()).filter(|ray| rays.range_m[*ray].is_finite()).collect();
        let mut found = Vec::new();
        turned(&rays, &mut left, 0.02);
        groups(&rays, &left, 0.02, &mut found);
        assert_eq!(found.len(), 2, "{found:?}");
        for group in &found {
            let at = rays.point(left[group.rays.start]);
            let of =
                |ray: &usize| columns.iter().position(|c| c.shape.distance_m(rays.point(*ray)).abs() < 0.15);
            assert!(
                left[group.rays.clone()].iter().all(|ray| of(ray) == of(&left[group.rays.start])),
                "{at}"
            );
        }
    }
}
