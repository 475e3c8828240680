//! The map and the obstacles that recorded scans show.
//!
//! The scans take the same way as in a mission without a drawing: `exploration` makes the map, and `perception` finds the
//! obstacles. The poses are those of the log, so nothing is estimated here. Frame: that of the log; metres, radians, seconds.

use exploration::{Exploration, Scanning, SurveyMap};
use import::scan_log::{LoggedScan, ScanLog};
use nalgebra::{Matrix3, Vector3};
use perception::{Perception, Sensor, View};
use std::collections::BTreeMap;
use world::{Boundary, ObstacleId, ObstacleMap, Point, Pose, Shape, Vector, shape::rectangle};

/// Assumed standard deviations of a corrected pose: x and y, metres, and heading, radians.
const POSE_SIGMA: (f64, f64) = (0.02, 0.005);
/// Distance from the scanner within which a track can become an obstacle, metres, and up to which echoes extend the map.
const REACH_M: f64 = 6.0;
/// Width of the floor around the outermost echoes, metres.
const MARGIN_M: f64 = 0.5;
/// Maximum width of a map, metres; a wider one would have cells larger than a column.
const MOST_M: f64 = 150.0;
/// Distance of the wall for the tracker, metres: a log has no drawing, so no echo comes from its wall.
const FAR_M: f64 = 10_000.0;

/// The properties of the scanner that a log does not state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recorded {
    /// Standard deviation of a distance, metres.
    pub sigma_m: f64,
    /// Maximum distance that can be measured, metres.
    pub range_m: f64,
    /// Radius of the robot's hull, metres; echoes from inside it are ignored.
    pub hull_m: f64,
}

/// A log whose scans are too far apart for one map.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "line {line}: the pose {x:.1}, {y:.1} m is {away_m:.0} m from the middle of all scans; a map may be at most {MOST_M} m \
     wide: correct the pose, or split the log"
)]
pub struct TooWide {
    /// The line of the scan that is farthest from the middle of all scans.
    pub line: usize,
    /// Its position, metres.
    pub x: f64,
    /// The same.
    pub y: f64,
    /// Its distance from the middle, metres.
    pub away_m: f64,
}

/// An obstacle that the tracker has found.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundObstacle {
    /// Its last outline.
    pub shape: Shape,
    /// Standard deviation of the outline, metres.
    pub sigma_m: f64,
}

/// What the scans of a log show.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// The floor of the map: a rectangle around everything.
    pub boundary: Boundary,
    /// The map.
    pub map: SurveyMap,
    /// The obstacles that the tracker has found and that later scans have not disproved, in the order of their ids.
    pub found: Vec<FoundObstacle>,
    /// The number of obstacles that later scans have disproved: they moved, or were never there.
    pub gone: usize,
    /// The way of the scanner.
    pub way: Vec<Point>,
    /// The number of scans that could not be used, and the first reason.
    pub unusable: (usize, Option<String>),
}

/// Makes the map of a log, and finds its obstacles.
///
/// Cost: proportional to the number of scans; the memory depends only on the size of the floor.
///
/// # Errors
/// The scans are too far apart for one map.
pub fn shown(log: &ScanLog, recorded: &Recorded) -> Result<Shown, TooWide> {
    let boundary = around(&log.scans);
    let (low, high) = boundary.bounds();
    if (high - low).max() > MOST_M {
        return Err(farthest(&log.scans));
    }
    let scanning =
        Scanning { sigma_m: recorded.sigma_m, range_m: Some(recorded.range_m), hull_m: recorded.hull_m };
    let mut exploration = Exploration::new(&boundary, scanning);
    let sensor =
        Sensor { sigma_m: recorded.sigma_m, range_m: Some(recorded.range_m), rays: None, locates: false };
    let mut perception = Perception::new(sensor);
    let far = box_around([Point::new(-FAR_M, -FAR_M), Point::new(FAR_M, FAR_M)].into_iter(), 0.0);
    let empty = ObstacleMap::new(&far, &[]);
    let mut found: BTreeMap<ObstacleId, FoundObstacle> = BTreeMap::new();
    let (mut gone, mut unusable) = (0, (0, None));
    for logged in &log.scans {
        let not_there = perception.look(&view(logged, recorded, &far, &empty)).not_there;
        if let Some(trouble) = perception.trouble() {
            unusable.0 += 1;
            unusable.1.get_or_insert_with(|| trouble.to_string());
            continue;
        }
        for seen in perception.seen(&logged.pose) {
            found.insert(seen.id, FoundObstacle { shape: seen.shape, sigma_m: seen.sigma_m });
        }
        for (id, _) in not_there {
            gone += usize::from(found.remove(&id).is_some());
        }
        exploration.add(&logged.scan, &logged.pose, logged.t_s);
    }
    let way = log.scans.iter().map(|logged| logged.pose.position).collect();
    let map = exploration.map();
    Ok(Shown { boundary, map, found: found.into_values().collect(), gone, way, unusable })
}

/// The scan that is farthest from the median position of all scans.
fn farthest(scans: &[LoggedScan]) -> TooWide {
    let median = |of: fn(&LoggedScan) -> f64| {
        let mut values: Vec<f64> = scans.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or_default()
    };
    let middle = Point::new(median(|scan| scan.pose.position.x), median(|scan| scan.pose.position.y));
    let away = scans.iter().map(|scan| ((scan.pose.position - middle).norm(), scan));
    let worst = away.max_by(|one, other| one.0.total_cmp(&other.0));
    let (away_m, line, at) = worst.map_or((0.0, 0, middle), |(m, scan)| (m, scan.line, scan.pose.position));
    TooWide { line, x: at.x, y: at.y, away_m }
}

fn view<'a>(
    logged: &'a LoggedScan,
    recorded: &Recorded,
    boundary: &'a Boundary,
    map: &'a ObstacleMap,
) -> View<'a> {
    let (place_m, heading_rad) = POSE_SIGMA;
    let sigma = Vector3::new(place_m, place_m, heading_rad);
    View {
        now_s: logged.t_s,
        scan: &logged.scan,
        pose: logged.pose,
        covariance: Matrix3::from_diagonal(&sigma.component_mul(&sigma)),
        boundary,
        charted: &[],
        map,
        hull_m: recorded.hull_m,
        reach_m: REACH_M,
    }
}

/// A rectangle around the way and around all echoes that extend the map.
fn around(scans: &[LoggedScan]) -> Boundary {
    let near = |point: &Point| point.coords.norm() <= REACH_M;
    let points = scans.iter().flat_map(|logged| {
        let echoes = logged.scan.points().filter(near).map(|point| placed(&logged.pose, point));
        echoes.chain([logged.pose.position]).collect::<Vec<_>>()
    });
    box_around(points, MARGIN_M)
}

fn placed(pose: &Pose, point: Point) -> Point {
    pose.tank_from_robot() * point
}

fn box_around(points: impl Iterator<Item = Point>, margin_m: f64) -> Boundary {
    let first = (Point::new(f64::MAX, f64::MAX), Point::new(f64::MIN, f64::MIN));
    let (low, high) = points.fold(first, |(low, high), at| (low.inf(&at), high.sup(&at)));
    let margin = Vector::repeat(margin_m);
    Boundary::Polygon { vertices: rectangle(low - margin, high + margin) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use import::{Input, scan_log};
    use std::fmt::Write;

    const RECORDED: Recorded = Recorded { sigma_m: 0.01, range_m: 20.0, hull_m: 0.2 };

    /// A log in a square room of 8 m with a column of radius 0.25 m at (1.5, 0), round which the scanner drives once.
    fn log() -> ScanLog {
        let (wall, column) = (4.0_f64, (Point::new(1.5, 0.0), 0.25));
        let mut text = String::new();
        for n in 0..120 {
            let bearing = f64::from(n) * std::f64::consts::TAU / 120.0;
            let (x, y) = (1.5 + 1.5 * bearing.cos(), 1.5 * bearing.sin());
            let heading = bearing + std::f64::consts::PI;
            let ray = |k: u32| {
                let (sin, cos) =
                    (heading - std::f64::consts::FRAC_PI_2 + f64::from(k).to_radians()).sin_cos();
                let side = |at: f64, along: f64| {
                    if along.abs() < 1e-9 { f64::MAX } else { (wall.copysign(along) - at) / along }
                };
                let to = column.0 - Point::new(x, y);
                let along = to.x * cos + to.y * sin;
                let rest: f64 = column.1 * column.1 - (to.norm_squared() - along * along);
                let hit = if rest >= 0.0 && along > 0.0 { along - rest.sqrt() } else { f64::MAX };
                hit.min(side(x, cos)).min(side(y, sin))
            };
            let ranges: Vec<String> = (0..181).map(|k| format!("{:.3}", ray(k))).collect();
            let t = f64::from(n) * 0.5;
            writeln!(text, "FLASER 181 {} {x} {y} {heading} 0 0 0 {t} host {t}", ranges.join(" ")).unwrap();
        }
        scan_log::read(&Input::of_bytes("room.log", text.as_bytes()), RECORDED.range_m).unwrap()
    }

    #[test]
    fn a_column_is_found_and_mapped_and_the_walls_are_no_columns() {
        let shown = shown(&log(), &RECORDED).unwrap();
        assert_eq!((shown.unusable.0, shown.gone), (0, 0), "{:?}", shown.unusable);
        let [column] = &shown.map.columns[..] else { panic!("{:?}", shown.map.columns) };
        assert!((column.center - Point::new(1.5, 0.0)).norm() < 0.03, "{column:?}");
        let is_column = |found: &&FoundObstacle| {
            matches!(found.shape, Shape::Disc { center, radius_m }
                if (center - Point::new(1.5, 0.0)).norm() < 0.05 && (radius_m - 0.25).abs() < 0.05)
        };
        assert_eq!(shown.found.iter().filter(is_column).count(), 1, "{:?}", shown.found);
        assert_eq!(shown.way.len(), 120);
    }

    #[test]
    fn a_pose_far_from_all_others_is_named_with_its_line() {
        let mut log = log();
        log.scans[40].pose = Pose::new(1e6, 0.0, 0.0);
        let error = shown(&log, &RECORDED).unwrap_err();
        assert_eq!(error.line, log.scans[40].line);
        assert!(error.to_string().starts_with("line 41: the pose 1000000.0, 0.0 m is 999998 m"), "{error}");
    }
}
