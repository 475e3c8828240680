//! Follows preset points in lock step: the target advances with every move, whether or not it was reached. It advances
//! by one point unless configured otherwise.

use crate::{
    descent::{self, Descent},
    outcome::{Shortfall, Walk},
    scene::Scene,
    settings::{FieldSettings, Targets},
    walk::{Move, Walker},
};
use geometry::{Point, polyline};
use planner_api::{Ctx, Result};

/// Stopping near the last point is allowed only in this last share of the list. Otherwise, a push through the middle of
/// a spiral would end the path early, as seems to happen in the paper's runs.
const TAIL_SHARE: f64 = 0.02;

/// Walks along preset points (Wang et al. 2023, section 2).
///
/// In lock step, `path[k]` belongs to the k-th of `points`, counted from the first that is not the start itself. If the
/// start is more than a step away, the robot first moves to the first point. The walk ends within `tolerance_m` of the
/// last point, or at the end of the list.
///
/// # Errors
/// The console requests a stop.
pub fn follow(
    scene: &Scene,
    settings: &FieldSettings,
    preset: &PresetPath<'_>,
    ctx: &Ctx<'_>,
) -> Result<Walk> {
    let points = preset.points;
    let step_m = settings.walking.step_m;
    let Some((&first, &last)) = points.first().zip(points.last()) else {
        return Ok(Walk { path: vec![preset.start], shortfall: None });
    };
    let mut approach = Vec::new();
    let mut start = preset.start;
    if (first - start).norm() > step_m {
        let to_first = Descent { start, goal: first, step_m, tolerance_m: step_m };
        let walk = descent::descend(scene, settings, &to_first, ctx)?;
        if walk.shortfall.is_some() {
            return Ok(walk);
        }
        approach = walk.path;
        start = approach.pop().unwrap_or(start);
    }
    let remaining = if (first - start).norm() < 1e-9 { &points[1..] } else { points };
    let tail_from =
        remaining.len() - ((remaining.len() as f64 * TAIL_SHARE).ceil() as usize).min(remaining.len());
    let mut walker = Walker::new(scene, settings, start);
    let mut lag = Lag::default();
    let mut previous = start;
    let mut index = 0;
    while let Some(&target) = remaining.get(index) {
        ctx.check()?;
        if index >= tail_from && (walker.at() - last).norm() < preset.tolerance_m {
            break;
        }
        let cap_m = if settings.walking.flexible { 2.0 * step_m } else { step_m };
        let expected_m = step_m.min((target - previous).norm());
        walker.advance(&Move { target, step_m, cap_m, expected_m });
        lag.record(walker.at(), target);
        previous = target;
        index = match settings.walking.targets {
            Targets::LockStep => index + 1,
            Targets::Ahead => polyline::nearest_ahead(remaining, index, walker.at()) + 1,
        };
    }
    let shortfall = shortfall(&walker, &lag, preset, last, settings);
    approach.extend(walker.into_path());
    Ok(Walk { path: approach, shortfall })
}

/// Preset points, and the start of the robot.
#[derive(Debug, Clone, Copy)]
pub struct PresetPath<'a> {
    /// The start.
    pub start: Point,
    /// The preset points; no two neighbours are further apart than a step.
    pub points: &'a [Point],
    /// The last point is reached when the robot is within this distance of it, metres.
    pub tolerance_m: f64,
}

#[derive(Default)]
struct Lag {
    most_m: f64,
    at: Point,
}

impl Lag {
    fn record(&mut self, at: Point, target: Point) {
        let lag_m = (target - at).norm();
        if lag_m > self.most_m {
            *self = Self { most_m: lag_m, at };
        }
    }
}

fn shortfall(
    walker: &Walker<'_>,
    lag: &Lag,
    preset: &PresetPath<'_>,
    last: Point,
    settings: &FieldSettings,
) -> Option<Shortfall> {
    let missing_m = (walker.at() - last).norm();
    if missing_m >= preset.tolerance_m.max(1e-9) {
        return Some(Shortfall::Short { missing_m, at: walker.at() });
    }
    if let Some(at) = walker.trap() {
        return Some(Shortfall::Trapped { at });
    }
    let allowed_m = settings.walking.max_lag_m;
    (lag.most_m > allowed_m).then_some(Shortfall::Lagged { most_m: lag.most_m, allowed_m, at: lag.at })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        law::{Beside, Law, Repulsion, RotationForm},
        laws::PushForm,
        settings::{MoveLength, Planning, RotationUse, Walking},
        trap::Gate,
        turning::{Reading, SenseRule},
    };
    use planner_api::{Boundary, Limits, Motion, Site, testing::Bench};
    use steering::Flight;

    const SETTINGS: FieldSettings = FieldSettings {
        law: Law {
            k_att: 1.0,
            k_rep: 0.02,
            k_rot: 0.0,
            rho_0_m: 0.6,
            wall_gain: 0.0,
            repulsion: Repulsion::Classic,
            form: PushForm::Khatib,
            nearest_only: false,
            rotation: RotationForm::Smooth,
            beside: Beside::All,
        },
        reading: Reading::Off,
        rule: SenseRule::CounterClockwise,
        gate: Gate::Detected,
        escape: crate::Escape::None,
        planning: Planning::Walked,
        walking: Walking {
            step_m: 0.2,
            targets: Targets::LockStep,
            length: MoveLength::ToTarget,
            goto_step_m: 0.05,
            flexible: false,
            turn_limit_rad: None,
            max_lag_m: 1.0,
        },
        rotation_use: RotationUse::Paper,
        evades: false,
        flight: Flight { guard_m: 0.1, guard_sigmas: 1.0, slow_m: 0.5, min_share: 0.3, stuck_s: 30.0 },
    };

    fn walk(start: Point, points: &[Point], tolerance_m: f64) -> Walk {
        let limits = Limits {
            motion: Motion::Point,
            v_max_m_per_s: 0.4,
            w_max_rad_per_s: 1.0,
            radius_m: 0.0,
            sensing_range_m: 3.0,
            acceleration_m_per_s2: 0.5,
            tick_s: 0.1,
            amphibious: None,
        };
        let site = Site {
            revision: 0,
            boundary: Boundary::Circle { radius_m: 10.0 },
            obstacles: &[],
            zones: &[],
            limits,
            swath_m: 0.5,
            clearance_m: 0.0,
            seed: 0,
        };
        let preset = PresetPath { start, points, tolerance_m };
        follow(&Scene::new(&site), &SETTINGS, &preset, &Bench::new().ctx()).expect("no stop is requested")
    }

    fn line(n_points: u32, spacing_m: f64) -> Vec<Point> {
        (0..n_points).map(|i| Point::new(f64::from(i) * spacing_m, 0.0)).collect()
    }

    #[test]
    fn points_within_a_step_are_met_exactly_one_by_one() {
        let points = line(20, 0.2);
        let walk = walk(points[0], &points, 0.1);
        assert!(walk.shortfall.is_none() && walk.path.len() == points.len());
        assert!(walk.path.iter().zip(&points).all(|(p, q)| (p - q).norm() < 1e-9));
    }

    #[test]
    fn a_path_that_passes_its_end_early_goes_on() {
        // Out and back: the last point is also the first point, so without the rule the walk would end where it begins.
        let mut points = line(40, 0.1);
        points.extend(line(40, 0.1).into_iter().rev().skip(1));
        let walk = walk(points[0], &points, 0.15);
        assert!(walk.shortfall.is_none() && walk.path.len() > 70);
    }

    #[test]
    fn a_start_elsewhere_is_brought_to_the_first_point() {
        let points = line(20, 0.2);
        let walk = walk(Point::new(0.0, -3.0), &points, 0.1);
        assert!(walk.shortfall.is_none());
        assert!((walk.path.last().expect("there is a start") - points[19]).norm() < 0.1);
    }

    #[test]
    fn points_too_far_apart_for_the_step_leave_the_path_short_of_its_end() {
        let points = line(20, 0.3);
        assert!(matches!(walk(points[0], &points, 0.1).shortfall, Some(Shortfall::Short { .. })));
    }
}
