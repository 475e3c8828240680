//! The pull that takes up a simulated cable, beside the pull of the certificate.

use super::{
    FRICTION,
    drive::{law, taut},
    reel,
};
use cable::{Chain, Surfaces};
use serde::{Deserialize, Serialize};
use trials::tanks::Tank;
use world::{Point, polyline, tether::Cable};

/// Number of places on a plan.
const PLACES: usize = 8;
/// Distance that the robot drives toward the cable, metres.
const WAY_M: f64 = 0.3;
/// Distance of the robot in a step, metres.
const STEP_M: f64 = 0.015;
const STEP_S: f64 = 0.05;
/// Least length of the free span, and of the cable, metres: a shorter cable needs no pull to speak of.
const SPAN_M: f64 = 1.0;
const CABLE_M: f64 = 3.0;
/// Halvings of the interval that contains the pull.
const HALVINGS: usize = 9;

/// The two pulls at a place, newtons.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Reeling {
    /// By the certificate.
    pub certified_n: f64,
    /// The least pull of a reel that takes up the simulated cable.
    pub simulated_n: f64,
}

/// Both pulls at some places of a path: the robot drives a short way along its cable, and a reel that is too weak does
/// not take up half of it.
pub(super) fn reeling(tank: &Tank, path: &[Point]) -> Vec<Reeling> {
    let world = tank.world();
    let Some(mut cable) = taut(tank, &world) else { return Vec::new() };
    let surfaces = Surfaces::new(&world.boundary, &world.obstacles, Chain::link_m(100.0));
    let length_m = polyline::length_m(path);
    let mut found = Vec::new();
    let (mut along_m, mut next_m) = (0.0, length_m / (2.0 * PLACES as f64));
    for pair in polyline::resampled(path, 0.1).windows(2) {
        along_m += (pair[1] - pair[0]).norm();
        cable.drag_to(pair[1]);
        if along_m >= next_m && cable.length_m() >= CABLE_M {
            let here = at(&cable, &surfaces);
            next_m += if here.is_some() { length_m / PLACES as f64 } else { 0.1 };
            found.extend(here);
        }
    }
    found
}

/// Both pulls with the robot at the end of a cable; `None` if its free span is too short.
fn at(cable: &Cable, surfaces: &Surfaces) -> Option<Reeling> {
    let line = cable.taut_line();
    let [.., from, robot] = line[..] else { return None };
    let span_m = (robot - from).norm();
    if span_m < SPAN_M {
        return None;
    }
    let back = robot + (from - robot) * (WAY_M / span_m);
    let mut half = cable.clone();
    half.drag_to(robot + (back - robot) * 0.5);
    let certified_n = half.pull_at_anchor_n(reel(0.0).drag(FRICTION));
    let comes = |pull_n: f64| {
        let mut chain = Chain::along(&line, law(pull_n, 100.0))?;
        let before_m = chain.paid_out_m();
        for at in polyline::resampled(&[robot, back], STEP_M) {
            chain.step(at, surfaces, STEP_S);
        }
        Some(before_m - chain.paid_out_m() > WAY_M / 2.0)
    };
    let (mut low_n, mut high_n) = (certified_n / 2.0, certified_n * 2.0);
    for _ in 0..HALVINGS {
        let middle_n = f64::midpoint(low_n, high_n);
        if comes(middle_n)? { high_n = middle_n } else { low_n = middle_n }
    }
    Some(Reeling { certified_n, simulated_n: high_n })
}
