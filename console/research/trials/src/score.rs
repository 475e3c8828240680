//! The paper's figures of a planned path, and ours: cross-track, clearance, wall, heading.

use crate::discs;
use serde::{Deserialize, Serialize};
use world::{Point, Vector, polyline};

/// Distance from its preset point within which a planned point is correct, metres; the paper's `T0`.
const CORRECT_M: f64 = 0.2;
/// Distance from the last preset point, metres, within which a path along the spiral must end to arrive.
pub(crate) const ARRIVED_M: f64 = 0.4;
/// Length of path over which a change of heading is measured, metres.
const HEADING_SPAN_M: f64 = 0.2;
/// Distance ahead within which the nearest preset point is searched for, metres.
const WINDOW_M: f64 = 1.5;

/// The agreement of a planned path with its preset points.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Share of planned points within 0.2 m of the preset point of the same index; the paper's P.
    pub precision: f64,
    /// Correct planned points as a share of the preset points; the paper's R.
    pub recall: f64,
    /// Root of the mean squared distance to the preset point of the same index, metres.
    pub rmse_m: f64,
    /// Largest distance to the preset point of the same index, metres.
    pub worst_m: f64,
    /// Share of preset points within 0.2 m of the path.
    pub covered: f64,
    /// Share of planned points within 0.2 m of the preset path, which is followed forward.
    pub cross_track_precision: f64,
    /// Root of the mean squared distance of planned points to the preset path, followed forward, metres.
    pub cross_track_rmse_m: f64,
    /// Largest distance from a planned point to the preset path, metres.
    pub cross_track_worst_m: f64,
}

/// The clearances and turns of a planned path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Safety {
    /// The least distance between the path and an obstacle, metres; infinite without obstacles.
    pub clearance_m: f64,
    /// The least distance between the path and the wall, metres; negative outside.
    pub wall_m: f64,
    /// Largest change of heading over 0.2 m of path, radians, where the preset path itself turns by less than 30
    /// degrees.
    pub heading_step_rad: f64,
    /// Distance between the ends of path and preset path, metres.
    pub missing_m: f64,
}

/// The figures of a path whose k-th point belongs to the k-th preset point.
pub fn score(path: &[Point], preset: &[Point]) -> Score {
    score_paired(path, preset, preset)
}

/// The figures of a path whose k-th point belongs to the k-th of `targets`, which are preset points.
pub fn score_paired(path: &[Point], targets: &[Point], preset: &[Point]) -> Score {
    let lags: Vec<f64> = path.iter().zip(targets).skip(1).map(|(p, q)| (p - q).norm()).collect();
    let offs = cross_track_m(path, preset);
    let (precision, n_correct) = correct(path, targets, CORRECT_M);
    let n_covered = preset.iter().filter(|q| is_covered(path, **q)).count();
    let n_preset = preset.len().max(1) as f64;
    Score {
        precision,
        recall: n_correct / n_preset,
        rmse_m: root_mean_square(&lags),
        worst_m: lags.iter().copied().fold(0.0, f64::max),
        covered: n_covered as f64 / n_preset,
        cross_track_precision: share(&offs),
        cross_track_rmse_m: root_mean_square(&offs),
        cross_track_worst_m: offs.iter().copied().fold(0.0, f64::max),
    }
}

/// Share of planned points within `correct_m` of the preset point of the same index, and the number of them as a share
/// of the preset points: the paper's P and R for its `T0`.
pub fn precision_recall(path: &[Point], preset: &[Point], correct_m: f64) -> (f64, f64) {
    let (precision, n_correct) = correct(path, preset, correct_m);
    (precision, n_correct / preset.len().max(1) as f64)
}

/// The preset points that were the targets of a walk, if the target is always the point after the nearest one ahead:
/// one for each point of the path, which begins at the first preset point.
pub fn targets_ahead(path: &[Point], preset: &[Point]) -> Vec<Point> {
    let mut index = 0;
    let mut targets: Vec<Point> = preset.first().copied().into_iter().collect();
    for at in &path[..path.len().saturating_sub(1)] {
        index = (polyline::nearest_ahead(preset, index, *at) + 1).min(preset.len().saturating_sub(1));
        targets.extend(preset.get(index));
    }
    targets
}

/// Share and number of planned points within `correct_m` of their target, without the start.
fn correct(path: &[Point], targets: &[Point], correct_m: f64) -> (f64, f64) {
    let is_correct = |(p, q): &(&Point, &Point)| (*p - *q).norm() <= correct_m;
    let n_correct = path.iter().zip(targets).skip(1).filter(is_correct).count() as f64;
    (n_correct / path.len().saturating_sub(1).max(1) as f64, n_correct)
}

/// Clearances and turns of a path in a round tank with columns (centre and radius).
pub fn safety(path: &[Point], preset: &[Point], columns: &[(Point, f64)], radius_m: f64) -> Safety {
    let missing_m = path.last().zip(preset.last()).map_or(f64::INFINITY, |(p, q)| (p - q).norm());
    Safety {
        clearance_m: discs::path_distance_m(columns, path),
        wall_m: path.iter().map(|p| radius_m - p.coords.norm()).fold(f64::INFINITY, f64::min),
        heading_step_rad: heading_step_rad(path, preset, std::f64::consts::FRAC_PI_6),
        missing_m,
    }
}

impl Safety {
    /// Whether the path arrives, keeps the clearance everywhere and never leaves the tank.
    pub fn is_ok(&self, clearance_m: f64) -> bool {
        self.missing_m <= ARRIVED_M && self.clearance_m >= clearance_m - 1e-6 && self.wall_m >= -1e-6
    }
}

/// The least root mean square error that any path with this clearance from columns can have, metres: it follows from
/// the distance of every preset point to the nearest place that is clear of all columns.
///
/// The nearest place is exact for a point inside the circle of one column. For a point inside several circles, it is
/// chosen among the nearest point of each circle and the crossings of the circles.
pub fn floor_rmse_m(preset: &[Point], columns: &[(Point, f64)], clearance_m: f64) -> f64 {
    let circles: Vec<(Point, f64)> = columns.iter().map(|(c, r)| (*c, r + clearance_m)).collect();
    let off: Vec<f64> = preset.iter().map(|p| distance_to_clear_m(*p, &circles)).collect();
    root_mean_square(&off)
}

/// Largest change of heading over 0.2 m of path, radians; places where the preset path itself turns by more than
/// `free_turn_rad` are ignored.
fn heading_step_rad(path: &[Point], preset: &[Point], free_turn_rad: f64) -> f64 {
    let preset_chords = chords(preset);
    let free: Vec<Point> = turns(&preset_chords).filter(|t| t.1 > free_turn_rad).map(|t| t.0).collect();
    let is_free = |at: Point| free.iter().any(|p| (p - at).norm() < 2.0 * HEADING_SPAN_M);
    turns(&chords(path)).filter(|(at, _)| !is_free(*at)).map(|(_, turn)| turn).fold(0.0, f64::max)
}

/// Points every 0.2 m along a path.
fn chords(path: &[Point]) -> Vec<Point> {
    let mut marks: Vec<Point> = path.first().copied().into_iter().collect();
    let mut left_m = HEADING_SPAN_M;
    for pair in path.windows(2) {
        let (along, length_m) = (pair[1] - pair[0], (pair[1] - pair[0]).norm());
        let mut gone_m = 0.0;
        while length_m - gone_m >= left_m {
            gone_m += left_m;
            marks.push(pair[0] + along * (gone_m / length_m));
            left_m = HEADING_SPAN_M;
        }
        left_m -= length_m - gone_m;
    }
    marks
}

fn turns(marks: &[Point]) -> impl Iterator<Item = (Point, f64)> + '_ {
    marks.windows(3).map(|w| {
        let (before, after): (Vector, Vector) = (w[1] - w[0], w[2] - w[1]);
        (w[1], before.perp(&after).atan2(before.dot(&after)).abs())
    })
}

/// Distance of every path point to the preset path, metres; the nearest place on the preset path only moves forward.
fn cross_track_m(path: &[Point], preset: &[Point]) -> Vec<f64> {
    if preset.len() < 2 {
        return path.iter().map(|p| polyline::distance_m(preset, *p)).collect();
    }
    let stations_m = polyline::stations_m(preset);
    let mut nearest = 0;
    let mut off = Vec::with_capacity(path.len());
    for at in path {
        let reach = stations_m.partition_point(|s| *s <= stations_m[nearest] + WINDOW_M).max(nearest + 2);
        let from_leg =
            |index: usize| (*at - polyline::nearest_on_segment(preset[index], preset[index + 1], *at)).norm();
        let legs = nearest..reach.min(preset.len()) - 1;
        let best = legs.map(|index| (from_leg(index), index)).min_by(|a, b| a.0.total_cmp(&b.0));
        let (off_m, index) = best.unwrap_or((from_leg(preset.len() - 2), preset.len() - 2));
        nearest = index;
        off.push(off_m);
    }
    off
}

fn is_covered(path: &[Point], at: Point) -> bool {
    let is_near = |w: &[Point]| {
        let reach_m = CORRECT_M + (w[1] - w[0]).norm();
        (at - w[0]).norm_squared() <= reach_m * reach_m
            && (at - polyline::nearest_on_segment(w[0], w[1], at)).norm() <= CORRECT_M
    };
    path.windows(2).any(is_near)
}

fn share(off_m: &[f64]) -> f64 {
    off_m.iter().filter(|m| **m <= CORRECT_M).count() as f64 / off_m.len().max(1) as f64
}

fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

/// Distance from a point to the nearest point outside all circles, metres.
fn distance_to_clear_m(at: Point, circles: &[(Point, f64)]) -> f64 {
    let is_clear = |p: Point| circles.iter().all(|(c, r)| (p - c).norm() >= r - 1e-9);
    if is_clear(at) {
        return 0.0;
    }
    let near: Vec<(Point, f64)> =
        circles.iter().copied().filter(|(c, r)| (at - c).norm() < r + 2.0).collect();
    let mut places: Vec<Point> = Vec::new();
    for (index, (c, r)) in near.iter().enumerate() {
        let out = (at - c).try_normalize(1e-12).unwrap_or_else(Vector::x);
        places.push(c + out * *r);
        for (other, other_r) in &near[index + 1..] {
            places.extend(crossings(*c, *r, *other, *other_r));
        }
    }
    places.into_iter().filter(|p| is_clear(*p)).map(|p| (p - at).norm()).fold(f64::INFINITY, f64::min)
}

fn crossings(a: Point, ra: f64, b: Point, rb: f64) -> Vec<Point> {
    let between = b - a;
    let d = between.norm();
    if d < 1e-9 || d > ra + rb || d < (ra - rb).abs() {
        return Vec::new();
    }
    let along = (d * d + ra * ra - rb * rb) / (2.0 * d);
    let across = (ra * ra - along * along).max(0.0).sqrt();
    let (unit, left) = (between / d, Vector::new(-between.y, between.x) / d);
    [across, -across].map(|h| a + unit * along + left * h).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(n_points: u32) -> Vec<Point> {
        (0..n_points).map(|i| Point::new(f64::from(i) * 0.1, 0.0)).collect()
    }

    #[test]
    fn a_path_beside_its_preset_is_off_by_as_much() {
        let preset = line(50);
        let path: Vec<Point> = preset.iter().map(|p| p + Vector::new(0.0, 0.3)).collect();
        let score = score(&path, &preset);
        assert!((score.rmse_m - 0.3).abs() < 1e-12 && (score.cross_track_rmse_m - 0.3).abs() < 1e-12);
        assert!(score.precision == 0.0 && score.covered == 0.0 && score.cross_track_precision == 0.0);
    }

    #[test]
    fn a_walk_that_skips_preset_points_is_paired_with_those_that_it_was_bound_for() {
        let preset = line(50);
        // From the first to the second, then 0.5 m ahead, and on from there.
        let path = [0.0, 0.1, 0.6, 0.7].map(|x| Point::new(x, 0.0));
        let targets = targets_ahead(&path, &preset);
        let expected = [0, 1, 2, 7].map(|index| preset[index]);
        assert_eq!(targets, expected);
        let score = score_paired(&path, &targets, &preset);
        assert!((score.precision - 2.0 / 3.0).abs() < 1e-12 && (score.recall - 2.0 / 50.0).abs() < 1e-12);
    }

    #[test]
    fn lagging_behind_is_no_cross_track() {
        let preset = line(50);
        let path: Vec<Point> = preset.iter().map(|p| p + Vector::new(-0.3, 0.0)).skip(10).collect();
        let score = score(&path, &preset[10..]);
        assert!(score.rmse_m > 0.29 && score.cross_track_rmse_m < 0.1);
    }

    #[test]
    fn a_corner_is_a_heading_step() {
        let path = [Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(1.0, 1.0)];
        let step_rad = heading_step_rad(&path, &line(10), 1.0);
        assert!((step_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
    }

    #[test]
    fn the_floor_of_a_line_through_one_circle_is_known() {
        // Radial distances 0.3 - |x| over 0.6 m of a line of 6 m: the mean square is 0.018 / 6.
        let preset: Vec<Point> = (0..6001).map(|i| Point::new(f64::from(i) * 1e-3 - 3.0, 0.0)).collect();
        let floor_m = floor_rmse_m(&preset, &[(Point::origin(), 0.0)], 0.3);
        assert!((floor_m - (0.018_f64 / 6.0).sqrt()).abs() < 1e-4);
    }

    #[test]
    fn between_two_circles_the_nearest_clear_place_is_their_crossing() {
        let circles = [(Point::new(-0.2, 0.0), 0.3), (Point::new(0.2, 0.0), 0.3)];
        assert!((distance_to_clear_m(Point::origin(), &circles) - 0.05_f64.sqrt()).abs() < 1e-9);
    }
}
