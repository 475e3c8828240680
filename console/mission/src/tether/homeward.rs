//! The way home with a cable that the reel cannot take up: beside the cable instead of on it.
//!
//! A weak reel leaves the cable where it lies, along the taut line, so a robot that returned on this line would drive on its
//! cable. Beside it, the cable folds behind the robot, and the reel takes it up as soon as so little is out that its pull
//! suffices. At a column the cable lies between column and robot, so the way keeps to the outer side of each bend.

use super::{LEFT_M, Tether};
use geometry::{Vector, direction_or};
use world::{ObstacleMap, Point, World};

/// Distance between the edge of the hull and the cable, metres: the sag of a cable that the reel can just take up is about
/// as large.
const GAP_M: f64 = 0.3;
/// The shares of the distance to the cable that are tried at each place, in this order.
const SHARES: [f64; 4] = [1.0, 0.7, 0.4, 0.0];
/// Turn below which the way counts as straight, radians.
const STRAIGHT_RAD: f64 = 1e-3;

impl Tether {
    /// The way from the robot to the anchor, with `room_m` metres for the hull's centre. A slack cable is first made taut. If
    /// the reel cannot take the cable up from there, the way leads beside the cable where there is room.
    pub fn way_home(&self, world: &World, room_m: f64) -> Option<Vec<Point>> {
        let Some(mut way) = self.way_to_tauten() else {
            let home = self.return_path(world, room_m)?;
            return Some(if self.is_reel_too_weak() { self.aside(home, world, room_m) } else { home });
        };
        let mut taut = self.clone();
        for at in &way {
            taut.drag_to(*at);
        }
        let home = taut.return_path(world, room_m)?;
        way.extend(taut.aside(home, world, room_m));
        way.dedup_by(|next, before| (*next - *before).norm() < 1e-6);
        Some(way)
    }

    pub(super) fn is_reel_too_weak(&self) -> bool {
        self.pull_needed_n().zip(self.config.reel).is_some_and(|(needed_n, reel)| needed_n > reel.pull_n)
    }

    /// Returns the way beside a return path; the return path itself if the hull does not fit beside it.
    fn aside(&self, home: Vec<Point>, world: &World, room_m: f64) -> Vec<Point> {
        let map = ObstacleMap::new(&world.boundary, &world.obstacles);
        let by_m = self.hull_m + GAP_M;
        let is_good = |way: &Vec<Point>| {
            let mut cable = self.cable.clone();
            cable.drag_along(way);
            let to_anchor = way.len().saturating_sub(1);
            let has_room =
                way[..to_anchor].windows(2).all(|pair| map.segment_clearance_m(pair[0], pair[1]) >= room_m);
            has_room && cable.length_m() <= LEFT_M
        };
        let ways = [true, false].map(|left| beside(&home, left, by_m, |at| map.clearance_m(at) >= room_m));
        ways.into_iter().find(is_good).unwrap_or(home)
    }
}

/// Returns a way beside another one, on the outer side of its bends; beside a straight way, to the `left` of it or to the
/// right. Where the hull does not fit, it runs closer to the other way. Both ways share their ends.
fn beside(way: &[Point], left: bool, by_m: f64, has_room: impl Fn(Point) -> bool) -> Vec<Point> {
    let sides = sides(way, left);
    let (Some(first), Some(last)) = (way.first(), way.last()) else { return Vec::new() };
    let mut beside = vec![*first];
    for (k, pair) in way.windows(2).enumerate() {
        let along = direction_or(pair[1] - pair[0], Vector::x());
        let to_left = Vector::new(-along.y, along.x);
        let near = |at: Point, is_left: bool| {
            let aside = to_left * if is_left { by_m } else { -by_m };
            let share = SHARES.into_iter().find(|share| has_room(at + aside * *share));
            at + aside * share.unwrap_or(0.0)
        };
        // Changes sides as late as possible, because by then the reel has taken up more.
        let is_before_end = k + 2 == way.len() || sides[k] != sides[k + 1];
        let least_m = by_m.min(0.5 * (pair[1] - pair[0]).norm());
        let short_m = if is_before_end { least_m } else { 0.0 };
        // At 45 degrees, the robot is beside the cable before the cable that folds behind it is as long as the hull, and it
        // draws no cable out, which would lie straight ahead of it again.
        let ahead_m = if k == 0 { least_m } else { 0.0 };
        beside.push(near(pair[0] + along * ahead_m, sides[k]));
        beside.push(near(pair[1] - along * short_m, sides[k]));
    }
    beside.push(*last);
    beside
}

/// For each point of a way, whether a way beside it passes on the left: on the outer side of the bend there or, at a
/// straight point, that of the bend before or, before the first bend, after it.
fn sides(way: &[Point], left: bool) -> Vec<bool> {
    let outer = |triple: &[Point]| {
        let [to, from] = [triple[1] - triple[0], triple[2] - triple[1]];
        let turn_rad = to.perp(&from).atan2(to.dot(&from));
        (turn_rad.abs() > STRAIGHT_RAD).then_some(turn_rad < 0.0)
    };
    let bends: Vec<Option<bool>> = way.windows(3).map(outer).collect();
    let mut side = bends.iter().flatten().next().copied().unwrap_or(left);
    let mut sides = vec![side];
    for bend in bends {
        side = bend.unwrap_or(side);
        sides.push(side);
    }
    sides.push(side);
    sides
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::polyline;

    fn points(at: &[(f64, f64)]) -> Vec<Point> {
        at.iter().map(|(x, y)| Point::new(*x, *y)).collect()
    }

    #[test]
    fn the_way_beside_keeps_to_the_outer_side_of_bends() {
        // First a bend to the left, then one to the right.
        let way = points(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (8.0, 4.0)]);
        let found = beside(&way, true, 0.5, |_| true);
        let wanted = points(&[
            (0.0, 0.0),
            (0.5, -0.5),
            (4.0, -0.5),
            (4.5, 0.0),
            (4.5, 3.5),
            (4.0, 4.5),
            (7.5, 4.5),
            (8.0, 4.0),
        ]);
        assert!(found.iter().zip(&wanted).all(|(a, b)| (a - b).norm() < 1e-9), "{found:?}");
        assert_eq!(found.len(), wanted.len());
    }

    #[test]
    fn the_way_beside_a_straight_one_takes_either_side_and_comes_nearer_where_there_is_no_room() {
        let way = points(&[(0.0, 0.0), (6.0, 0.0)]);
        let far_m = |left, room_m: f64| {
            let way = beside(&way, left, 0.5, |at| at.y.abs() <= room_m);
            polyline::resampled(&way, 0.1)
                .iter()
                .map(|at| at.y)
                .fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a })
        };
        assert!((far_m(true, 9.0) - 0.5).abs() < 1e-9 && (far_m(false, 9.0) + 0.5).abs() < 1e-9);
        assert!((far_m(true, 0.4) - 0.35).abs() < 1e-9 && far_m(true, 0.1).abs() < 1e-9);
    }
}
