//! Touch-ups: short lanes over what the tour has missed.

use crate::{
    cuts::Cut,
    floor::FloorGrid,
    ground::{Ground, SLACK_M},
    lanes::{Lane, thinned},
    slit::Slit,
};
use world::{Point, Vector, polyline};

/// Distance that touch-ups keep from cuts, metres.
const CUT_M: f64 = 0.03;
/// Touch-ups are looked at this closely, metres.
const STEP_M: f64 = 0.05;

/// Lanes over a group of missed cells, as long as it is and as many as it is wide.
pub fn touch_up(ground: &Ground, slit: &Slit, cuts: &[Cut], grid: &FloorGrid, group: &[usize]) -> Vec<Lane> {
    let points: Vec<Point> = group.iter().map(|cell| grid.center(*cell)).collect();
    let (middle, along) = axis(&points);
    let across = Vector::new(-along.y, along.x);
    let spread = |direction: Vector| {
        let places = points.iter().map(|p| (p - middle).dot(&direction));
        places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| (low.min(s), high.max(s)))
    };
    let ((from, to), (left, right)) = (spread(along), spread(across));
    let n = ((right - left) / ground.swath_m).ceil().max(1.0);
    let mut lanes = Vec::new();
    for k in 0..n as usize {
        let offset = left + (right - left) * (k as f64 + 0.5) / n;
        let strip_m = (right - left) / n / 2.0 + grid.cell_m;
        let own = points.iter().filter(|p| ((*p - middle).dot(&across) - offset).abs() <= strip_m);
        let places = own.map(|p| (p - middle).dot(&along));
        let (own_from, own_to) =
            places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| (low.min(s), high.max(s)));
        let (a, b) = if own_from <= own_to { (own_from, own_to) } else { (from, to) };
        let grow = (0.06 - (b - a)).max(0.0) / 2.0;
        let line =
            [middle + across * offset + along * (a - grow), middle + across * offset + along * (b + grow)];
        let drivable = |aside: fn(&[Cut], Point) -> Point| -> Vec<Lane> {
            let places = polyline::resampled(&line, STEP_M);
            let roomy = places.iter().filter_map(|p| with_room(ground, slit, cuts, aside(cuts, *p)));
            runs(slit, cuts, &roomy.collect::<Vec<_>>())
        };
        let straight = drivable(|_, at| at);
        lanes.extend(if straight.is_empty() { drivable(beside_cuts) } else { straight });
    }
    lanes
}

/// Mean and main direction of some points.
fn axis(points: &[Point]) -> (Point, Vector) {
    let n = points.len().max(1) as f64;
    let middle = Point::from(points.iter().map(|p| p.coords).sum::<Vector>() / n);
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for offset in points.iter().map(|p| p - middle) {
        xx += offset.x * offset.x;
        xy += offset.x * offset.y;
        yy += offset.y * offset.y;
    }
    let angle = (2.0 * xy).atan2(xx - yy) / 2.0;
    (middle, crate::ground::direction(angle))
}

/// The nearest place with room, by walking out of what is in the way.
fn with_room(ground: &Ground, slit: &Slit, cuts: &[Cut], from: Point) -> Option<Point> {
    let mut at = from;
    for _ in 0..12 {
        let wall_m = ground.wall.wall_distance_m(at) - ground.keep_m - SLACK_M;
        let mut worst = (wall_m, inward(ground, at));
        for (part, keep_m) in ground.room.parts_near(at) {
            let (distance_m, away) = part.distance(at);
            // Facets stand out a little.
            let spare_m = distance_m - keep_m * 1.025 - SLACK_M;
            if spare_m < worst.0 {
                worst = (spare_m, away);
            }
        }
        if worst.0 >= -1e-6 {
            break;
        }
        at += worst.1 * (-worst.0 + 1e-4);
    }
    let is_clear = cuts.iter().all(|cut| polyline::distance_m(&cut.line, at) >= CUT_M);
    (is_clear && slit.contains(at)).then_some(at)
}

/// A place that is too near to a cut, moved away from it: a strip along a cut is scanned from beside the cut.
fn beside_cuts(cuts: &[Cut], at: Point) -> Point {
    let sides = cuts.iter().flat_map(|cut| cut.line.windows(2));
    let Some((nearest, side)) = sides
        .map(|side| (polyline::nearest_on_segment(side[0], side[1], at), side))
        .min_by(|a, b| (a.0 - at).norm().total_cmp(&(b.0 - at).norm()))
        .filter(|(nearest, _)| (nearest - at).norm() < CUT_M)
    else {
        return at;
    };
    let along = side[1] - side[0];
    let away =
        (at - nearest).try_normalize(1e-9).or_else(|| Vector::new(-along.y, along.x).try_normalize(1e-9));
    nearest + away.unwrap_or_else(Vector::zeros) * (1.1 * CUT_M)
}

fn inward(ground: &Ground, at: Point) -> Vector {
    let step = 1e-4;
    let d = |offset: Vector| ground.wall.wall_distance_m(at + offset);
    let slope = Vector::new(
        d(Vector::new(step, 0.0)) - d(Vector::new(-step, 0.0)),
        d(Vector::new(0.0, step)) - d(Vector::new(0.0, -step)),
    );
    slope.try_normalize(1e-12).unwrap_or_else(Vector::x)
}

/// Pieces of a line that can be driven straight.
fn runs(slit: &Slit, cuts: &[Cut], points: &[Point]) -> Vec<Lane> {
    let mut lanes: Vec<Vec<Point>> = vec![Vec::new()];
    for p in points {
        let current = lanes.last_mut().expect("there is always one");
        match current.last() {
            Some(last) if (p - last).norm() < 1e-3 => {}
            Some(last)
                if (p - last).norm() > 3.0 * STEP_M || crosses(cuts, *last, *p) || !slit.sees(*last, *p) =>
            {
                lanes.push(vec![*p]);
            }
            _ => current.push(*p),
        }
    }
    let long_enough = lanes.into_iter().filter(|line| line.len() > 1);
    long_enough.map(|line| Lane { points: thinned(&line) }).collect()
}

fn crosses(cuts: &[Cut], a: Point, b: Point) -> bool {
    let mut sides = cuts.iter().flat_map(|cut| cut.line.windows(2));
    sides.any(|side| geometry::convex::crossing(a, b, side[0], side[1]).is_some())
}

#[cfg(test)]
mod tests {
    use super::*;
    use trials::tanks::Tank;

    #[test]
    fn a_strip_that_was_missed_along_a_cut_is_scanned_from_beside_it() {
        let boundary = world::Boundary::Circle { radius_m: 5.0 };
        let tank = Tank { boundary, anchor: Point::new(-3.0, 0.0), columns: vec![(Point::origin(), 0.3)] };
        let obstacles = tank.obstacles();
        let ground = Ground::new(&tank.site(&obstacles), tank.anchor).unwrap();
        // Hardly aslant to the lane that is missing.
        let line = vec![Point::origin(), Point::new(5.0, 0.004)];
        let slit = Slit::new(&ground, std::slice::from_ref(&line), ground.home()).unwrap();
        let cuts = [Cut { line, from: 0 }];
        let mut grid = FloorGrid::new(&ground, &slit, 0.05);
        for k in -8..=8 {
            let y = 0.55 * f64::from(k);
            if k != 0 {
                grid.sweep(&[Point::new(-5.0, y), Point::new(5.0, y)]);
            }
        }
        grid.sweep(&[Point::new(-5.0, 0.0), Point::new(-0.6, 0.0)]);
        let missed = grid.missed();
        let lanes = touch_up(&ground, &slit, &cuts, &grid, &missed[0]);
        for lane in &lanes {
            grid.sweep(&lane.points);
        }
        let left = grid.missed().concat().into_iter().filter(|cell| grid.center(*cell).y.abs() < 0.3).count();
        assert!(
            missed[0].len() > 500 && 4 * left < missed[0].len(),
            "{left} of {} cells are left",
            missed[0].len()
        );
        assert!(lanes.iter().all(|lane| !lane.points.windows(2).any(|w| crosses(&cuts, w[0], w[1]))));
    }
}
