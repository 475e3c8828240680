//! The estimated results of a plan, before the robot moves: time, coverage, clearance, tether, accuracy, and where on
//! the path each extreme occurs.

mod time;

pub use time::time_s;

use mission::{MissionConfig, TaskConfig};
use positioning::{AccuracyMap, Forecast};
use serde::{Deserialize, Serialize};
use world::{
    CoverageGrid, Floor, ObstacleMap, Point, Shape, World, polyline,
    tether::{BACK_M, Bearing, Cable, OwnGap},
};

/// Distance between the points at which a path is evaluated, metres.
const SAMPLE_M: f64 = 0.1;
/// Number of forecast cells along the longer side of the floor.
const CELLS: f64 = 80.0;

/// A figure and its position on the path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// The figure; metres or radians.
    pub value: f64,
    /// The position, metres, tank frame.
    pub at: Point,
}

/// The tether along a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TetherEstimate {
    /// Greatest length paid out, metres.
    pub length_max: Worst,
    /// Largest wrap on one obstacle, radians.
    pub wrap_max: Worst,
    /// Name of that obstacle; empty if the cable touches none.
    pub wrapped: String,
    /// Largest total wrap, radians.
    pub wrap_total_max_rad: f64,
    /// Length paid out at the end of the path, metres.
    pub end_length_m: f64,
    /// Largest pull at the reel that taking up the tether needs, newtons; absent if the scenario does not describe the
    /// reel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pull_max_n: Option<Worst>,
    /// Least distance from the edge of the hull to its own taut tether beyond the last bend, on the way in, metres; absent if the
    /// scenario does not describe the reel, or if the tether bends nowhere on the way in.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub own_gap_m: Option<Worst>,
}

/// The estimated results of a plan on the drawing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Length of the path, metres.
    pub length_m: f64,
    /// Time to drive the path at the highest speed from which the robot can stop safely, with stops to turn at
    /// corners, seconds.
    pub time_s: f64,
    /// Whether the plan achieves the whole task.
    pub complete: bool,
    /// Share of the reachable floor that the plan scans, 0 to 1; absent for missions without a scan.
    pub reachable: Option<f64>,
    /// Minimum distance from the hull to any solid object, metres.
    pub clearance_min: Option<Worst>,
    /// The tether along the path; absent without a tether.
    pub tether: Option<TetherEstimate>,
    /// Largest 95 % error forecast along the path, metres; absent without stations.
    pub accuracy_worst: Option<Worst>,
    /// Length of the path for which no fix is forecast, metres.
    pub without_fix_m: f64,
}

impl Estimate {
    /// Estimates the results of a path.
    ///
    /// Evaluates the path every tenth of a metre; with a tether, the cable is dragged along the path once.
    pub fn new(mission: &MissionConfig, drawing: &World, path: &[Point], complete: bool) -> Self {
        let sampled = polyline::resampled(path, SAMPLE_M);
        let map = ObstacleMap::new(&drawing.boundary, &drawing.obstacles);
        let (accuracy_worst, without_fix_m) = accuracy(mission, drawing, &sampled);
        Self {
            length_m: polyline::length_m(path),
            time_s: time_s(mission, &map, path),
            complete,
            reachable: reachable(mission, drawing, path),
            clearance_min: clearance(mission, &map, &sampled),
            tether: tether(mission, drawing, &sampled),
            accuracy_worst,
            without_fix_m,
        }
    }
}

fn reachable(mission: &MissionConfig, drawing: &World, path: &[Point]) -> Option<f64> {
    let TaskConfig::Cover { .. } = mission.task else { return None };
    Some(scanned_along(mission.floor(drawing), path, mission.swath_m).fraction_reachable())
}

/// The floor that is scanned along a path with a swath in metres, before anything moves.
pub(crate) fn scanned_along(floor: Floor, path: &[Point], swath_m: f64) -> CoverageGrid {
    let mut grid = CoverageGrid::new(floor);
    for pair in path.windows(2) {
        grid.mark_swath(pair[0], pair[1], swath_m);
    }
    grid
}

fn clearance(mission: &MissionConfig, map: &ObstacleMap, path: &[Point]) -> Option<Worst> {
    let hull_m = mission.limits.radius_m;
    path.iter()
        .map(|at| Worst { value: map.clearance_m(*at) - hull_m, at: *at })
        .min_by(|a, b| a.value.total_cmp(&b.value))
}

fn tether(mission: &MissionConfig, drawing: &World, path: &[Point]) -> Option<TetherEstimate> {
    let config = mission.tether.as_ref()?;
    let anchor = config.anchor;
    let drag = config.reel.map(|reel| reel.drag(config.friction));
    let shapes: Vec<Shape> = drawing.obstacles.iter().map(|obstacle| obstacle.shape.clone()).collect();
    let mut cable = Cable::new(anchor, &drawing.boundary, &shapes).ok()?;
    let none = Worst { value: 0.0, at: anchor };
    let mut estimate = TetherEstimate {
        length_max: none,
        wrap_max: none,
        wrapped: String::new(),
        wrap_total_max_rad: 0.0,
        end_length_m: 0.0,
        pull_max_n: drag.map(|_| none),
        own_gap_m: drag.and_then(|_| own_gap(cable.clone(), path, mission.limits.radius_m)),
    };
    // The tether that is still out at the anchor counts, as in the certificate.
    let returns = path.last().is_some_and(|last| (*last - anchor).norm() <= BACK_M);
    for at in path.iter().chain(returns.then_some(&anchor)) {
        cable.drag_to(*at);
        if cable.length_m() > estimate.length_max.value {
            estimate.length_max = Worst { value: cable.length_m(), at: *at };
        }
        if cable.wrap_max_rad() > estimate.wrap_max.value {
            estimate.wrap_max = Worst { value: cable.wrap_max_rad(), at: *at };
            estimate.wrapped = most_wrapped(&cable, drawing);
        }
        if let (Some(drag), Some(most)) = (drag, &mut estimate.pull_max_n) {
            let value = cable.pull_at_anchor_n(drag);
            if value > most.value {
                *most = Worst { value, at: *at };
            }
        }
        estimate.wrap_total_max_rad = estimate.wrap_total_max_rad.max(cable.wrap_total_rad());
    }
    estimate.end_length_m = cable.length_m();
    Some(estimate)
}

fn own_gap(cable: Cable, path: &[Point], hull_m: f64) -> Option<Worst> {
    let OwnGap { gap_m, at } = OwnGap::along(cable, path, hull_m)?;
    Some(Worst { value: gap_m, at })
}

/// Name of the obstacle with the largest wrap of a cable.
fn most_wrapped(cable: &Cable, drawing: &World) -> String {
    let contacts = cable.contacts();
    let most = contacts.iter().max_by(|a, b| a.wrap_rad.abs().total_cmp(&b.wrap_rad.abs()));
    match most.map(|contact| contact.on) {
        Some(Bearing::Obstacle(index)) => drawing.obstacles[index].name.clone(),
        Some(Bearing::Wall) => "wall".to_owned(),
        None => String::new(),
    }
}

/// The largest forecast error on a path, and the length of path without a fix, metres.
fn accuracy(mission: &MissionConfig, drawing: &World, path: &[Point]) -> (Option<Worst>, f64) {
    if drawing.stations.is_empty() {
        return (None, 0.0);
    }
    let map = AccuracyMap::new(drawing, &forecast(mission, drawing));
    let (mut worst, mut without_fix_m) = (None::<Worst>, 0.0);
    for at in path {
        match map.at(*at).and_then(|accuracy| accuracy.error_95_m) {
            Some(value) if worst.is_none_or(|worst| value > worst.value) => {
                worst = Some(Worst { value, at: *at });
            }
            Some(_) => {}
            None => without_fix_m += SAMPLE_M,
        }
    }
    (worst, without_fix_m)
}

/// The accuracy that the mission's estimator can expect from its stations.
pub fn forecast(mission: &MissionConfig, drawing: &World) -> Forecast {
    let (low, high) = drawing.boundary.bounds();
    mission.forecast((high - low).amax() / CELLS)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use world::{Boundary, Obstacle, ObstacleId};

    pub(super) fn mission() -> MissionConfig {
        let limits = serde_json::json!({
            "motion": "unicycle", "v_max_m_per_s": 0.5, "w_max_rad_per_s": 1.0, "radius_m": 0.3, "sensing_range_m": 2.0,
            "acceleration_m_per_s2": 0.5, "tick_s": 0.1
        });
        let mission = serde_json::json!({
            "task": { "goto": { "goal": [2.5, 5.0], "tolerance_m": 0.2 } },
            "start": { "position": [-5.0, 0.0], "heading_rad": 0.0 },
            "start_sigma_m": 0.0, "tick_s": 0.1, "time_limit_s": 100.0, "limits": limits, "swath_m": 0.6,
            "clearance_m": 0.1, "cell_m": 0.1, "position_limit_m": 0.5, "position_lost_hold_s": 2.0, "stuck_s": 30.0,
            "start_heading_sigma_rad": 0.02, "odometry_turn_sigma_per_rad": 0.02, "gyro_sigma_rad_per_s": 0.001,
            "odometry_sigma_per_m": 0.02, "range_sigma_ratio": 0.03,
            "planner": { "id": "rpf", "parameters": {} }, "fallback": null,
        });
        serde_json::from_value(mission).unwrap()
    }

    pub(super) fn drawing() -> World {
        let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
        let obstacle = Obstacle { id: ObstacleId(1), name: "C1".into(), shape: column, known: true };
        World {
            boundary: Boundary::Circle { radius_m: 10.0 },
            obstacles: vec![obstacle],
            stations: Vec::new(),
            zones: Vec::new(),
        }
    }

    #[test]
    fn what_is_worst_is_found_with_its_place() {
        let (mission, drawing) = (mission(), drawing());
        let path = [Point::new(-5.0, 0.0), Point::new(2.5, 0.0), Point::new(2.5, 5.0)];
        let estimate = Estimate::new(&mission, &drawing, &path, true);
        assert!((estimate.length_m - 12.5).abs() < 1e-9);
        let clearance = estimate.clearance_min.unwrap();
        assert!((clearance.at - Point::new(2.5, 0.0)).norm() < 0.2, "{clearance:?}");
        assert!((clearance.value - (1.0 - mission.limits.radius_m)).abs() < 0.02, "{clearance:?}");
        let limits = &mission.limits;
        let drive_s = 12.5 / limits.v_max_m_per_s;
        let turn_s = std::f64::consts::FRAC_PI_2 / limits.w_max_rad_per_s + limits.tick_s;
        // The robot stops twice.
        let stops_s = 2.0 * limits.v_max_m_per_s / limits.acceleration_m_per_s2;
        assert!((estimate.time_s - drive_s - turn_s - stops_s).abs() < 0.1, "{}", estimate.time_s);
        assert_eq!((estimate.tether, estimate.accuracy_worst, estimate.reachable), (None, None, None));
    }

    #[test]
    fn a_tether_left_hooked_on_return_is_as_long_as_the_certificate_says() {
        let anchor = Point::new(-5.0, 0.0);
        let tether = serde_json::json!({
            "anchor": anchor, "friction": 0.3,
            "limits": { "reel_length_m": 40.0, "wrap_max_rad": 9.0, "wrap_total_max_rad": 9.0 },
        });
        let mission = MissionConfig { tether: Some(serde_json::from_value(tether).unwrap()), ..mission() };
        let drawing = drawing();
        // Around the column; the goal is reached within its tolerance, a step before the anchor.
        let path = [
            anchor,
            Point::new(4.0, -1.5),
            Point::new(5.5, 0.0),
            Point::new(4.0, 1.5),
            Point::new(-4.8, 0.1),
        ];
        let estimate = Estimate::new(&mission, &drawing, &path, true).tether.unwrap();
        let shapes = [drawing.obstacles[0].clone()];
        let case = world::tether::Case {
            path: &path,
            anchor,
            cable: None,
            boundary: &drawing.boundary,
            obstacles: &shapes,
            room_m: 0.3,
            limits: mission.tether.as_ref().unwrap().limits,
            pull: None,
            returns: true,
            cuts: &[],
        };
        let left_m = world::tether::certify(&case).unwrap().end_length_m.unwrap();
        assert!(left_m > 18.0, "{left_m}");
        assert!(
            (estimate.end_length_m - left_m).abs() < 0.01 && estimate.length_max.value >= left_m - 0.01,
            "{estimate:?}"
        );
    }

    #[test]
    fn the_own_gap_is_that_of_the_certificate_and_needs_a_reel_that_is_described() {
        let anchor = Point::new(-5.0, 0.0);
        let config = |reel: serde_json::Value| {
            serde_json::from_value::<mission::TetherConfig>(serde_json::json!({
                "anchor": anchor, "friction": 0.3, "reel": reel,
                "limits": { "reel_length_m": 40.0, "wrap_max_rad": 9.0, "wrap_total_max_rad": 9.0 },
            }))
            .unwrap()
        };
        let reel = serde_json::json!({
            "mass_kg_per_m": 0.1, "floor_friction": 0.3, "pull_n": 20.0, "pay_out_n": 0.5, "pull_ratio_max": 0.8,
        });
        // Past the column, and back beside the tether that bends round it.
        let path = [anchor, Point::new(4.0, -1.5), Point::new(6.0, 0.5), Point::new(2.0, -1.8), anchor];
        let gap = |config: mission::TetherConfig| {
            let mission = MissionConfig { tether: Some(config), ..mission() };
            (Estimate::new(&mission, &drawing(), &path, true).tether.unwrap().own_gap_m, mission)
        };
        assert_eq!(gap(config(serde_json::Value::Null)).0, None);
        let (found, mission) = gap(config(reel));
        let tether = mission.tether.as_ref().unwrap();
        let certificate = world::tether::certify(&world::tether::Case {
            path: &path,
            anchor,
            cable: None,
            boundary: &drawing().boundary,
            obstacles: &[drawing().obstacles[0].clone()],
            room_m: mission.limits.radius_m,
            limits: tether.limits,
            pull: tether.reel.map(|reel| reel.limits(tether.friction)),
            returns: true,
            cuts: &[],
        });
        let own_gap = certificate.unwrap().own_gap.unwrap();
        let found = found.unwrap();
        assert!((found.value - own_gap.gap_m).abs() < 0.05, "{found:?} {own_gap:?}");
    }

    #[test]
    fn a_smooth_curve_costs_no_stops() {
        let mission = mission();
        let circle: Vec<Point> = (0..=200)
            .map(|i| {
                let (sin, cos) = (f64::from(i) * 0.03).sin_cos();
                Point::new(7.0 * cos, 7.0 * sin)
            })
            .collect();
        let time_s = Estimate::new(&mission, &drawing(), &circle, true).time_s;
        let start_and_stop_s = mission.limits.v_max_m_per_s / mission.limits.acceleration_m_per_s2;
        let driven_s = polyline::length_m(&circle) / mission.limits.v_max_m_per_s;
        assert!((time_s - driven_s - start_and_stop_s).abs() < 0.1, "{time_s}");
    }
}
