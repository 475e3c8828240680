//! A planner whose live parameters change while it drives past a column.

use crate::exact_pose;
use geometry::{Limits, Motion, Point, Vector};
use planner_api::{
    Boundary, Command, Config, Obstacle, Outline, Planner, Sensed, Site, Value, testing::Bench,
};

/// Duration of a tick, seconds.
const TICK_S: f64 = 0.1;
/// The path along which the robot drives, from the origin.
const WAY: [Point; 3] = [Point::new(0.5, 0.0), Point::new(1.5, 0.0), Point::new(3.0, 0.0)];

/// The commands of one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Changed {
    /// The command with the first values.
    pub before: Command,
    /// The command of the same planner after the change.
    pub after: Command,
    /// The command of a new planner that was configured with the changed values.
    pub fresh: Command,
}

/// Has a planner with the `fixed` values decide the same tick before and after its live parameters change to the values
/// of `live`. A column stands 0.7 m ahead of the robot, on the left.
///
/// # Panics
/// The planner refuses the values, or a step fails.
pub fn changed<P: Planner>(fixed: &[(&str, f64)], live: &[(&str, f64)]) -> Changed {
    let outline = Outline::Disc { center: Point::new(1.0, 0.55), radius_m: 0.2 };
    let column = [Obstacle { id: 1, outline, discovered: false, velocity_m_per_s: Vector::zeros() }];
    let site = Site {
        revision: 0,
        boundary: Boundary::Circle { radius_m: 8.0 },
        obstacles: &column,
        zones: &[],
        limits: Limits {
            motion: Motion::Point,
            v_max_m_per_s: 0.4,
            w_max_rad_per_s: 1.0,
            radius_m: 0.25,
            sensing_range_m: 3.0,
            acceleration_m_per_s2: 0.5,
            tick_s: TICK_S,
            amphibious: None,
        },
        swath_m: 0.5,
        clearance_m: 0.05,
        seed: 0,
    };
    let bench = Bench::new();
    let values = [fixed, live].concat();
    let step = |planner: &mut P| {
        let sensed = Sensed {
            v_m_per_s: 0.3,
            path_ahead: &WAY,
            targets_ahead: &WAY[2..],
            obstacles: &column,
            ..Sensed::new(0, TICK_S, exact_pose(Point::origin()), WAY[2])
        };
        planner.step(&sensed, &bench.ctx()).expect("the way is free")
    };
    let mut planner: P = bench.configure(fixed, &site).expect("accepts the values");
    let before = step(&mut planner);
    let set: Vec<Value<'_>> = values.iter().map(|&(key, number)| Value { key, number }).collect();
    planner.reconfigure(&Config::new(P::PARAMS, &set), &bench.ctx()).expect("accepts the change");
    let after = step(&mut planner);
    let mut fresh: P = bench.configure(&values, &site).expect("accepts the values");
    Changed { before, after, fresh: step(&mut fresh) }
}
