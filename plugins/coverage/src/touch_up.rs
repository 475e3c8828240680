//! Touch-ups: short lanes over floor that the tour has missed.

use crate::floor::SweptFloor;
use crate::inflation::SLACK_M;
use crate::lanes::{Lane, thinned};
use crate::plane::{direction, extent, inward, left_of};
use crate::slit_domain::SlitDomain;
use crate::tuning::touch_ups::{CUT_M, LEAST_LANE_M};
use world::{Point, Vector, polyline};

/// Sampling step along touch-ups, metres.
const STEP_M: f64 = 0.05;
/// Lanes over a group of missed cells: as long as the group, and as many as its width requires.
pub(crate) fn touch_up(domain: &SlitDomain<'_>, swept: &SweptFloor, group: &[usize]) -> Vec<Lane> {
    let points: Vec<Point> = group.iter().map(|cell| swept.raster().center(*cell)).collect();
    let (middle, along) = axis(&points);
    let across = left_of(along);
    // The position of every cell along and across the axis.
    let cells: Vec<(f64, f64)> =
        points.iter().map(|p| p - middle).map(|offset| (offset.dot(&along), offset.dot(&across))).collect();
    let whole = extent(cells.iter().map(|cell| cell.0));
    let (left, right) = extent(cells.iter().map(|cell| cell.1));
    let n = ((right - left) / domain.workspace.swath_m).ceil().max(1.0);
    let half_strip_m = (right - left) / n / 2.0 + swept.raster().cell_m;
    let mut lanes = Vec::new();
    for k in 0..n as usize {
        let offset_m = left + (right - left) * (k as f64 + 0.5) / n;
        let own = cells.iter().filter(|cell| (cell.1 - offset_m).abs() <= half_strip_m);
        let own = extent(own.map(|cell| cell.0));
        let (from, to) = if own.0 <= own.1 { own } else { whole };
        let grow_m = (LEAST_LANE_M - (to - from)).max(0.0) / 2.0;
        let ends = [from - grow_m, to + grow_m].map(|end_m| middle + across * offset_m + along * end_m);
        let places = polyline::resampled(&ends, STEP_M);
        let drivable = |place: &dyn Fn(Point) -> Point| {
            let roomy = places.iter().filter_map(|p| with_room(domain, place(*p)));
            pieces(domain, roomy)
        };
        let straight = drivable(&|at| at);
        lanes.extend(if straight.is_empty() {
            drivable(&|at| beside_cuts(&domain.cuts, at))
        } else {
            straight
        });
    }
    lanes
}

/// The mean and the main direction of some points.
fn axis(points: &[Point]) -> (Point, Vector) {
    let n = points.len().max(1) as f64;
    let middle = Point::from(points.iter().map(|p| p.coords).sum::<Vector>() / n);
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for offset in points.iter().map(|p| p - middle) {
        xx += offset.x * offset.x;
        xy += offset.x * offset.y;
        yy += offset.y * offset.y;
    }
    (middle, direction((2.0 * xy).atan2(xx - yy) / 2.0))
}

/// The nearest position where the hull fits, found by moving away from whatever is in the way.
fn with_room(domain: &SlitDomain<'_>, from: Point) -> Option<Point> {
    let workspace = domain.workspace;
    let mut at = from;
    for _ in 0..12 {
        let wall_m = workspace.wall.wall_distance_m(at) - workspace.keep_m - SLACK_M;
        let mut worst = (wall_m, inward(&workspace.wall, at));
        for (part, keep_m) in workspace.room.parts_near(at) {
            let (distance_m, away) = part.distance(at);
            // The facets of the outline protrude slightly.
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
    let is_clear = domain.cuts.iter().all(|cut| polyline::distance_m(cut, at) >= CUT_M);
    (is_clear && domain.contains(at)).then_some(at)
}

/// Moves a position that is too close to a cut away from it: a strip along a cut is scanned from beside the cut.
fn beside_cuts(cuts: &[Vec<Point>], at: Point) -> Point {
    let sides = cuts.iter().flat_map(|cut| cut.windows(2));
    let Some((nearest, side)) = sides
        .map(|side| (polyline::nearest_on_segment(side[0], side[1], at), side))
        .min_by(|a, b| (a.0 - at).norm().total_cmp(&(b.0 - at).norm()))
        .filter(|(nearest, _)| (nearest - at).norm() < CUT_M)
    else {
        return at;
    };
    let away = (at - nearest).try_normalize(1e-9).or_else(|| left_of(side[1] - side[0]).try_normalize(1e-9));
    nearest + away.unwrap_or_else(Vector::zeros) * (1.1 * CUT_M)
}

/// The pieces of a line that can be driven straight.
fn pieces(domain: &SlitDomain<'_>, points: impl Iterator<Item = Point>) -> Vec<Lane> {
    let mut lanes: Vec<Vec<Point>> = vec![Vec::new()];
    for p in points {
        let current = lanes.last_mut().expect("there is always at least one point");
        match current.last() {
            Some(last) if (p - last).norm() < 1e-3 => {}
            Some(last)
                if (p - last).norm() > 3.0 * STEP_M
                    || domain.crosses_cut(*last, p)
                    || !domain.sees(*last, p) =>
            {
                lanes.push(vec![p]);
            }
            _ => current.push(p),
        }
    }
    lanes.into_iter().filter(|line| line.len() > 1).map(|line| thinned(&line)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::ReachableFloor;
    use crate::workspace::Workspace;
    use trials::tanks::Tank;
    use world::Boundary;

    #[test]
    fn a_strip_that_was_missed_along_a_cut_is_scanned_from_beside_it() {
        let boundary = Boundary::Circle { radius_m: 5.0 };
        let tank = Tank { boundary, anchor: Point::new(-3.0, 0.0), columns: vec![(Point::origin(), 0.3)] };
        let obstacles = tank.obstacles();
        let workspace = Workspace::new(&tank.site(&obstacles), tank.anchor).unwrap();
        // The cut is almost parallel to the missing lane.
        let line = vec![Point::origin(), Point::new(5.0, 0.004)];
        let domain = SlitDomain::new(&workspace, vec![line]).unwrap();
        let mut swept = SweptFloor::new(ReachableFloor::new(&domain, 0.05));
        for k in -8..=8 {
            let y = 0.55 * f64::from(k);
            if k != 0 {
                swept.sweep(&[Point::new(-5.0, y), Point::new(5.0, y)]);
            }
        }
        swept.sweep(&[Point::new(-5.0, 0.0), Point::new(-0.6, 0.0)]);
        let missed = swept.missed();
        let lanes = touch_up(&domain, &swept, &missed[0]);
        for lane in &lanes {
            swept.sweep(lane);
        }
        let left = swept
            .missed()
            .concat()
            .into_iter()
            .filter(|cell| swept.raster().center(*cell).y.abs() < 0.3)
            .count();
        assert!(
            missed[0].len() > 500 && 4 * left < missed[0].len(),
            "{left} of {} cells are left",
            missed[0].len()
        );
        assert!(lanes.iter().all(|lane| !lane.windows(2).any(|w| domain.crosses_cut(w[0], w[1]))));
    }
}
